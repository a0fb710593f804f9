//! Parameters of objects, by the numbers that clients use for them. Those of the simulator are in `program.rs`.

use sincro_dynamics::actuation::MotorMode;
use sincro_dynamics::contact::Surface;

use super::lens::{vision_float, vision_int};
use super::program::unknown;
use super::registry::{Handle, Kind};
use super::senses::handle_of;
use super::structure::Role;
use super::{ApiError, SimApi};

/// Message for a runtime shape that is no body of the model.
pub(super) const STATIC: &str = "a shape that is made is static and touches nothing; the parameters 3003 (static) = 0 and 3004 (respondable) = 1 make it a body that moves and touches";

/// Whole-number parameters of what a shape looks like in windows: culling, wireframe, edges.
const LOOK_INTS: [i64; 4] = [3014, 3015, 3024, 3027];
/// Real ones: place, orientation and scale of its texture, shading angle, angle of its edges.
const LOOK_FLOATS: [i64; 10] = [3006, 3007, 3008, 3009, 3010, 3011, 3012, 3013, 3025, 3026];

/// Number of the parameter that is the type of the link of a dummy.
const LINK_TYPE: i64 = 10_000;
/// Type of the links that there are: `sim.dummy_linktype_dynamics_loop_closure`.
const CLOSURE: i64 = 0;

impl SimApi<'_> {
    /// Whole-number parameter of an object by V-REP's number `id`, without unit: 2000 motor on, 2001 control loop on,
    /// 2039 control mode of a joint, 3003 static and 3004 respondable of a shape, 1002 and 1003 columns and rows of a
    /// vision sensor `[px]`, 4002 the entity that a proximity sensor detects, 10 visibility layers; all are in
    /// `docs/compatibility.md`.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or the object has no whole-number parameter of that number.
    pub fn object_int(&mut self, handle: Handle, id: i64) -> Result<i64, ApiError> {
        let entry = self.registry.entry(handle)?;
        let mode = |sim: &Self| sim.joint_mode(handle);
        Ok(match (id, &entry.kind) {
            (10, _) => self.registry.visibility_layer(handle),
            (1008, Kind::Vision(_)) => self.registry.shown_number(handle)?,
            (4002, Kind::Proximity) => self.detected_number(handle)?,
            (_, Kind::Vision(_)) => vision_int(&self.registry.vision_sensor(handle)?.optics, id)?,
            (2000, Kind::Joint(_)) => i64::from(mode(self)? != MotorMode::Free),
            (2001, Kind::Joint(_)) => i64::from(matches!(mode(self)?, MotorMode::Position | MotorMode::Spring)),
            (2030, Kind::Joint(_)) => i64::from(mode(self)? == MotorMode::Velocity),
            (2039, Kind::Joint(_)) => control_number(mode(self)?),
            (3003, Kind::Shape) => 1,
            (3004, Kind::Shape) => 0,
            (3003, Kind::Body(_)) => i64::from(self.is_static(handle)?),
            (3004, Kind::Body(_)) => i64::from(self.is_respondable(handle)?),
            (3019, Kind::Body(_) | Kind::Shape) => self.respondable_mask(handle),
            (3016..=3018 | 3028, Kind::Body(_) | Kind::Shape) => self.shape_int(handle, id)?,
            (LINK_TYPE, Kind::Dummy | Kind::Frame) => CLOSURE,
            (id, Kind::Body(_) | Kind::Shape) if LOOK_INTS.contains(&id) => self.look(handle, id) as i64,
            _ => return Err(unknown("whole-number object", id)),
        })
    }

    /// Whole-number parameter of the geometry of a shape: 3016 of several parts, 3017 and 3018 of convex ones alone,
    /// 3028 number of its parts.
    fn shape_int(&self, handle: Handle, id: i64) -> Result<i64, ApiError> {
        let own = self.registry.entry(handle)?.handle;
        let parts = self.registry.senses.pieces().filter(|piece| handle_of(piece) == own);
        let is_convex = |surface: &Surface| !matches!(surface, Surface::Mesh(..) | Surface::HeightField { .. });
        let (n, n_convex) =
            parts.fold((0, 0), |(n, n_convex), part| (n + 1, n_convex + i64::from(is_convex(part.geometry.surface()))));
        Ok(match id {
            3016 => i64::from(n > 1),
            3028 => n,
            _ => i64::from(n == n_convex),
        })
    }

    /// Number of what a shape looks like in windows, as it was set; 0 before.
    fn look(&self, handle: Handle, id: i64) -> f64 {
        self.registry.looks.get(&(handle, id)).copied().unwrap_or(0.0)
    }

    /// Keeps a number of what a shape looks like in windows: nothing shows it.
    fn set_look(&mut self, handle: Handle, id: i64, value: f64) -> Result<(), ApiError> {
        let entry = self.registry.entry(handle)?;
        if !matches!(entry.kind, Kind::Body(_) | Kind::Shape) {
            return Err(ApiError(format!("`{}` is no shape", entry.path)));
        }
        self.registry.looks.insert((handle, id), value);
        Ok(())
    }

    /// Sets a whole-number parameter of an object by V-REP's number `id`, without unit: 2000 motor on, 2001 control
    /// loop on, 2039 control mode of a joint (0 free, 1 force, 4 velocity, 8 position, 12 spring), 3004 respondable of
    /// a body, 4002 the entity that a proximity sensor detects (−1 all), 10 the visibility layers, those of vision
    /// sensors.
    ///
    /// # Errors
    ///
    /// `handle` is no object, the object has no whole-number parameter of that number or it belongs to the scene file,
    /// or the value is not allowed.
    pub fn set_object_int(&mut self, handle: Handle, id: i64, value: i64) -> Result<(), ApiError> {
        let entry = self.registry.entry(handle)?;
        match (id, &entry.kind) {
            (10, _) => return self.set_visibility_layer(handle, value),
            (_, Kind::Vision(_)) => return self.set_vision_int(handle, id, value),
            (_, Kind::Body(_) | Kind::Shape) if LOOK_INTS.contains(&id) => {
                return self.set_look(handle, id, value as f64);
            }
            (4002, Kind::Proximity) => return self.set_detected(handle, value),
            (LINK_TYPE, Kind::Dummy | Kind::Frame) if value == CLOSURE => return Ok(()),
            (LINK_TYPE, Kind::Dummy | Kind::Frame) => {
                return Err(ApiError(format!(
                    "a link of type {value} is none here: linked dummies join bodies (sim.dummy_linktype_dynamics_loop_closure)"
                )));
            }
            _ => {}
        }
        if id == 3019 && matches!(entry.kind, Kind::Body(_) | Kind::Shape) {
            return self.set_respondable_mask(handle, value);
        }
        if let (3003 | 3004, Some(role)) = (id, self.role(handle)) {
            match (id, value != 0) {
                (3003, is_static) => role.is_static = is_static,
                (_, is_respondable) => role.is_respondable = is_respondable,
            }
            return Ok(());
        }
        let entry = self.registry.entry(handle)?;
        if entry.kind == Kind::Shape && matches!(id, 3003 | 3004) {
            // static and not respondable it is
            let (is_static, is_respondable) = (id != 3003, id == 3004);
            return match (value != 0) == (id == 3003) {
                true => Ok(()),
                false => self.give_role(handle, Role { is_static, is_respondable, mass: None }),
            };
        }
        let is_body = matches!(entry.kind, Kind::Body(_));
        match id {
            3004 if is_body && value != 0 && !self.has_contact(handle) => return self.add_contact(handle),
            3004 if is_body => return self.set_respondable(handle, value != 0),
            3003 if is_body => return self.set_static(handle, value != 0),
            _ => {}
        }
        let mode = match id {
            2000 if value == 0 => MotorMode::Free,
            2000 if self.joint_mode(handle)? == MotorMode::Free => MotorMode::Velocity,
            2000 => return Ok(()),
            2001 if value != 0 => MotorMode::Position,
            2001 => MotorMode::Velocity,
            2039 => control_mode(value)?,
            _ => return Err(unknown("whole-number object", id)),
        };
        self.set_joint_mode(handle, mode)
    }

    /// Real parameter of an object by V-REP's number `id`, in SI units.
    ///
    /// - Any object: 11–13 velocity x, y, z, world axes, and 14 its magnitude `[m/s]`.
    /// - Body or shape: 15–17 smallest and 18–20 largest x, y, z of what it consists of, in its frame `[m]`.
    /// - Joint: 2002 position gain `[1/s]`, 2012 velocity and 2017 its limit `[rad/s]` or `[m/s]`, 2018 stiffness
    ///   `[N·m/rad]` or `[N/m]`, 2019 damping `[N·m·s/rad]` or `[N·s/m]`.
    /// - Body: 3005 mass `[kg]`, 3000–3002 velocity `[m/s]` and 3020–3022 angular velocity `[rad/s]` of its centre of
    ///   mass, world axes.
    /// - Vision sensor: 1000 near and 1001 far end of its view `[m]`, 1004 view angle `[rad]`, 1005 view size `[m]`.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or the object has no real parameter of that number.
    pub fn object_float(&mut self, handle: Handle, id: i64) -> Result<f64, ApiError> {
        let motor = |sim: &Self| {
            Ok(sim.joint_motor(handle)?.unwrap_or(sincro_dynamics::actuation::Motor::new(MotorMode::Free)))
        };
        if let (1000.., Kind::Vision(_)) = (id, &self.registry.entry(handle)?.kind) {
            return vision_float(&self.registry.vision_sensor(handle)?.optics, id);
        }
        match id {
            11..=13 => Ok(self.velocity(handle)?.0[(id - 11) as usize]),
            14 => {
                let [x, y, z] = self.velocity(handle)?.0;
                Ok((x * x + y * y + z * z).sqrt())
            }
            15..=20 => {
                let [low, high] = self.shape_box(handle)?;
                Ok(if id < 18 { low[(id - 15) as usize] } else { high[(id - 18) as usize] })
            }
            2002 => Ok(motor(self)?.kp),
            2012 => self.joint_velocity(handle),
            2017 => motor(self).map(|m: sincro_dynamics::actuation::Motor<f64>| m.max_velocity),
            2018 => Ok(motor(self)?.stiffness),
            2019 => Ok(motor(self)?.damping),
            3005 => Ok(self.mass(handle)?.mass),
            3000..=3002 => self.initial_velocity(handle, (id - 3000) as usize),
            3020..=3022 => self.initial_velocity(handle, (id - 3020) as usize + 3),
            _ if LOOK_FLOATS.contains(&id) => Ok(self.look(handle, id)),
            _ => Err(unknown("float object", id)),
        }
    }

    /// Sets a real parameter of an object by V-REP's number `id`, with the numbers and units of
    /// [`SimApi::object_float`]: gains and limits of a motor (2002, 2017–2019), mass of a body (3005), its initial
    /// velocity (3000–3002, 3020–3022; in a run for `resetDynamicObject`), those of vision sensors.
    ///
    /// # Errors
    ///
    /// `handle` is no object, the object has no real parameter of that number or it cannot be set now, or the value is
    /// not allowed.
    pub fn set_object_float(&mut self, handle: Handle, id: i64, value: f64) -> Result<(), ApiError> {
        if let Kind::Vision(_) = self.registry.entry(handle)?.kind {
            return self.set_vision_float(handle, id, value);
        }
        match id {
            2002 => self.change_motor(handle, |m| m.kp = value),
            2017 => self.change_motor(handle, |m| m.max_velocity = value),
            2018 => self.change_motor(handle, |m| m.stiffness = value),
            2019 => self.change_motor(handle, |m| m.damping = value),
            3005 => self.mass_scaled(handle, value).and_then(|mass| self.set_mass(handle, mass)),
            3000..=3002 => self.set_initial_velocity(handle, (id - 3000) as usize, value),
            3020..=3022 => self.set_initial_velocity(handle, (id - 3020) as usize + 3, value),
            _ if LOOK_FLOATS.contains(&id) => self.set_look(handle, id, value),
            _ => Err(unknown("float object", id)),
        }
    }
}

/// The number of a mode of dynamic control.
fn control_number(mode: MotorMode) -> i64 {
    match mode {
        MotorMode::Free => 0,
        // the API has no voltages: the motor is one that gives a torque
        MotorMode::Torque | MotorMode::Voltage => 1,
        MotorMode::Velocity => 4,
        MotorMode::Position => 8,
        MotorMode::Spring => 12,
    }
}

/// The mode of dynamic control of a number.
fn control_mode(number: i64) -> Result<MotorMode, ApiError> {
    Ok(match number {
        0 => MotorMode::Free,
        1 => MotorMode::Torque,
        4 => MotorMode::Velocity,
        8 => MotorMode::Position,
        12 => MotorMode::Spring,
        _ => {
            return Err(ApiError(format!(
                "{number} is no control mode: free 0, force 1, velocity 4, position 8, spring 12"
            )));
        }
    })
}
