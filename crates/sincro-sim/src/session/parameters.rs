//! Parameters of the simulator and of objects, by the numbers that clients use for them.

use sincro_dynamics::force::MotorMode;

use super::table::{Handle, Kind};
use super::{Desk, Phase, Refusal};

/// What is answered for the version: the last that had the legacy remote API, which is what clients check for.
const PROGRAM_VERSION: i64 = 40_501;

impl Desk<'_> {
    /// A whole-number parameter of the simulator.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn int_parameter(&self, id: i64) -> Result<i64, Refusal> {
        Ok(match id {
            1 => PROGRAM_VERSION,
            // program revision, instance, platform (Linux), scene id
            2 | 23 | 22 => 0,
            3 => 2,
            // the physics engine is none of those that have a number; MuJoCo's is the nearest in kind
            8 => 4,
            20 => 1,
            29 => self.table.stop_requests,
            _ => return Err(unknown("whole-number", id)),
        })
    }

    /// A number of the simulator.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn float_parameter(&self, id: i64) -> Result<f64, Refusal> {
        match id {
            1 => Ok(self.table.sample_time()),
            3 | 5 => Ok(self.table.base_step()),
            _ => Err(unknown("float", id)),
        }
    }

    /// Sets a number of the simulator: 1, the simulation time step `[s]`, while stopped.
    ///
    /// # Errors
    ///
    /// There is none of that number, or it cannot be set.
    pub fn set_float_parameter(&mut self, id: i64, value: f64) -> Result<(), Refusal> {
        match id {
            1 => self.table.set_sample_time(value),
            3 | 5 => Err(Refusal::new("the physics step is the scene's base step: set `step` in experiment.toml")),
            _ => Err(unknown("float", id)),
        }
    }

    /// A truth value of the simulator.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn bool_parameter(&self, id: i64) -> Result<bool, Refusal> {
        match id {
            // dynamics, scripts and so on are always handled
            0..=12 | 24 => Ok(true),
            // display, real time, waiting for a trigger, and what belongs to windows
            16 | 18 | 19 | 25..=50 => Ok(false),
            _ => Err(unknown("truth", id)),
        }
    }

    /// A vector of the simulator: 0, gravity [m/s²].
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn array_parameter(&self, id: i64) -> Result<[f64; 3], Refusal> {
        if id == 0 { Ok(self.world.model().gravity().0) } else { Err(unknown("vector", id)) }
    }

    /// A text of the simulator: 13, the scene's path.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn string_parameter(&self, id: i64) -> Result<String, Refusal> {
        match id {
            // folders of the program and of its scenes: clients build paths from them that are looked for by their last part
            0 | 1 => Ok(String::new()),
            13 => Ok(self.table.scene_path.clone()),
            14 => Ok(self.table.scene_path.rsplit('/').nth(1).unwrap_or_default().to_owned()),
            _ => Err(unknown("text", id)),
        }
    }

    /// A whole-number parameter of an object.
    ///
    /// # Errors
    ///
    /// There is no such object or parameter.
    pub fn object_int(&mut self, handle: Handle, id: i64) -> Result<i64, Refusal> {
        let entry = self.table.entry(handle)?;
        let mode = |desk: &Self| desk.joint_mode(handle);
        Ok(match (id, &entry.kind) {
            (10, _) => 1,
            (2000, Kind::Joint(_)) => i64::from(mode(self)? != MotorMode::Free),
            (2001, Kind::Joint(_)) => i64::from(matches!(mode(self)?, MotorMode::Position | MotorMode::Spring)),
            (2030, Kind::Joint(_)) => i64::from(mode(self)? == MotorMode::Velocity),
            (2039, Kind::Joint(_)) => control_number(mode(self)?),
            (3003, Kind::Body(_)) => i64::from(entry.frame.link.is_none()),
            (3004, Kind::Body(_)) => 1,
            (3019, Kind::Body(_)) => 0xffff,
            _ => return Err(unknown("whole-number object", id)),
        })
    }

    /// Sets a whole-number parameter of an object: motor on, loop on, control mode of a joint.
    ///
    /// # Errors
    ///
    /// There is no such object or parameter, or it cannot be set.
    pub fn set_object_int(&mut self, handle: Handle, id: i64, value: i64) -> Result<(), Refusal> {
        self.table.entry(handle)?;
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

    /// A number of an object.
    ///
    /// # Errors
    ///
    /// There is no such object or parameter.
    pub fn object_float(&mut self, handle: Handle, id: i64) -> Result<f64, Refusal> {
        let motor =
            |desk: &Self| Ok(desk.joint_motor(handle)?.unwrap_or(sincro_dynamics::force::Motor::new(MotorMode::Free)));
        match id {
            11..=13 => Ok(self.velocity(handle)?.0[(id - 11) as usize]),
            14 => {
                let [x, y, z] = self.velocity(handle)?.0;
                Ok((x * x + y * y + z * z).sqrt())
            }
            2002 => Ok(motor(self)?.kp),
            2012 => self.joint_velocity(handle),
            2017 => motor(self).map(|m: sincro_dynamics::force::Motor<f64>| m.max_velocity),
            2018 => Ok(motor(self)?.stiffness),
            2019 => Ok(motor(self)?.damping),
            3005 => Ok(self.mass(handle)?.mass),
            3000..=3002 => Ok(self.center_velocity(handle)?.0[(id - 3000) as usize]),
            3020..=3022 => Ok(self.center_velocity(handle)?.1[(id - 3020) as usize]),
            _ => Err(unknown("float object", id)),
        }
    }

    /// Sets a number of an object: gains and limits of its motor.
    ///
    /// # Errors
    ///
    /// There is no such object or parameter, or it cannot be set.
    pub fn set_object_float(&mut self, handle: Handle, id: i64, value: f64) -> Result<(), Refusal> {
        self.table.entry(handle)?;
        match id {
            2002 => self.change_motor(handle, |m| m.kp = value),
            2017 => self.change_motor(handle, |m| m.max_velocity = value),
            2018 => self.change_motor(handle, |m| m.stiffness = value),
            2019 => self.change_motor(handle, |m| m.damping = value),
            _ => Err(unknown("float object", id)),
        }
    }

    /// The simulation's state as clients know it, see [`super::constants`].
    #[must_use]
    pub fn simulation_state(&self) -> i64 {
        match self.table.phase {
            Phase::Stopped => 0,
            Phase::Paused => 8,
            Phase::Running if self.world.state.tick == 0 => 16,
            Phase::Running => 17,
        }
    }
}

/// The number of a mode of dynamic control.
fn control_number(mode: MotorMode) -> i64 {
    match mode {
        MotorMode::Free => 0,
        MotorMode::Torque => 1,
        MotorMode::Velocity => 4,
        MotorMode::Position => 8,
        MotorMode::Spring => 12,
    }
}

/// The mode of dynamic control of a number.
fn control_mode(number: i64) -> Result<MotorMode, Refusal> {
    Ok(match number {
        0 => MotorMode::Free,
        1 => MotorMode::Torque,
        4 => MotorMode::Velocity,
        8 => MotorMode::Position,
        12 => MotorMode::Spring,
        _ => {
            return Err(Refusal(format!(
                "{number} is no control mode: free 0, force 1, velocity 4, position 8, spring 12"
            )));
        }
    })
}

fn unknown(what: &str, id: i64) -> Refusal {
    Refusal(format!("there is no {what} parameter {id} here"))
}
