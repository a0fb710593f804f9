//! Parameters of the simulator, by the numbers and names that clients use for them. Those of objects are in
//! `parameters.rs`.
//!
//! What belongs to windows, editing and the computer has a fixed answer, and takes settings without effect: programs
//! that turn the display off for speed run as they are.

use sincro_conventions::simulator::{
    DYNAMIC_ENGINE, DYNAMICS_HANDLING, Fixed, GRAVITY, HANDLING, PHYSICS_STEP, RANDOM, RANDOM_SEED, SCENE_FOLDER,
    SCENE_NAME, SCENE_PATH, STEP_DIVIDER, STOP_REQUESTS, SWITCHES, TEXTS, TIME_STEP, TRUTHS, WHOLE, fixed,
};

use super::{ApiError, ObjectRegistry, Phase, SimApi};

impl ObjectRegistry {
    /// Returns true if the dynamics are switched off: everything stays where it is, unless it is put elsewhere.
    pub(crate) fn is_motion_held(&self) -> bool {
        self.switched_off.contains(&DYNAMICS_HANDLING)
    }
}

impl SimApi<'_> {
    /// Sets all velocities to zero; in a run the change of the energy counts as work.
    fn bring_to_rest(&mut self) {
        self.count_as_work(|sim| sim.world.state.v.fill(0.0));
    }

    /// Whole-number parameter of the simulator by V-REP's number `id` (`sim.intparam_…`), without unit: 7 base steps in
    /// a step of clients, 29 number of stop requests; others, such as the version, have fixed answers.
    ///
    /// # Errors
    ///
    /// There is no whole-number parameter of that number.
    pub fn int_parameter(&self, id: i64) -> Result<i64, ApiError> {
        match id {
            STOP_REQUESTS => Ok(self.registry.stop_requests),
            STEP_DIVIDER => Ok((self.registry.sample_time() / self.registry.base_step()).round() as i64),
            _ => known(WHOLE, id, "whole-number"),
        }
    }

    /// Accepts a setting of the whole-number parameter of the simulator with V-REP's number `id` (`sim.intparam_…`)
    /// without effect, so that programs which set windows or verbosity run.
    ///
    /// # Errors
    ///
    /// There is no whole-number parameter of that number, or it would change how the world is computed (8 physics
    /// engine, 7 step divider): the message has the key of the experiment instead.
    pub fn set_int_parameter(&self, id: i64) -> Result<(), ApiError> {
        match id {
            DYNAMIC_ENGINE => Err(ApiError::new(
                "there is one way to compute the world, exact but for the error bar: choose the integrator by `method` in experiment.toml",
            )),
            STEP_DIVIDER => {
                Err(ApiError::new("the physics step is the scene's base step: set `step` in experiment.toml"))
            }
            _ => self.int_parameter(id).map(|_| ()),
        }
    }

    /// Real parameter of the simulator by V-REP's number `id` (`sim.floatparam_…`): 1 step of clients `[s]`, 3 and 5
    /// base step `[s]`, 0 a random number from 0 to 1, another one at each call and the same ones in each run.
    ///
    /// # Errors
    ///
    /// There is no real parameter of that number.
    pub fn float_parameter(&mut self, id: i64) -> Result<f64, ApiError> {
        match id {
            RANDOM => {
                self.registry.n_random += 1;
                let bits = sincro_math::random::splitmix64(RANDOM_SEED, self.registry.n_random);
                Ok((bits >> 11) as f64 / (1_u64 << 53) as f64)
            }
            TIME_STEP => Ok(self.registry.sample_time()),
            _ if PHYSICS_STEP.contains(&id) => Ok(self.registry.base_step()),
            _ => Err(unknown("float", id)),
        }
    }

    /// Sets the real parameter of the simulator with V-REP's number `id` (`sim.floatparam_…`): 1, the step of clients
    /// `[s]`, while stopped. In a run it stays as it is, as in V-REP, and a message says so once.
    ///
    /// # Errors
    ///
    /// There is no real parameter of that number, it is the base step (set `step` of the experiment), or the value is
    /// no whole multiple of the base step while stopped.
    pub fn set_float_parameter(&mut self, id: i64, value: f64) -> Result<(), ApiError> {
        match id {
            TIME_STEP if self.is_running() => {
                self.tell_of_step(value);
                Ok(())
            }
            TIME_STEP => self.registry.set_sample_time(value),
            _ if PHYSICS_STEP.contains(&id) => {
                Err(ApiError::new("the physics step is the scene's base step: set `step` in experiment.toml"))
            }
            _ => Err(unknown("float", id)),
        }
    }

    /// Says once in a run that its step stays as it is, if another one is asked for.
    fn tell_of_step(&mut self, dt: f64) {
        let now = self.registry.sample_time();
        if (dt - now).abs() > 1e-6 * now && !std::mem::replace(&mut self.registry.is_told_of_step, true) {
            let why = "it is set while the simulation is stopped";
            self.log(300, &format!("a time step of {dt} s is not taken, it stays {now} s in this run: {why}"));
        }
    }

    /// Truth value of the simulator by V-REP's number `id` (`sim.boolparam_…`), always the same: what belongs to
    /// windows is false, what belongs to the step is true.
    ///
    /// # Errors
    ///
    /// There is no truth value of that number.
    pub fn bool_parameter(&self, id: i64) -> Result<bool, ApiError> {
        let now = known(TRUTHS, id, "truth")?;
        Ok(if SWITCHES.contains(&id) { !self.registry.switched_off.contains(&id) } else { now })
    }

    /// Accepts a setting of the truth value of the simulator with V-REP's number `id` (`sim.boolparam_…`) without
    /// effect, so that programs which turn the display off run; parts of the step that can be are switched off and
    /// on: 4 inverse kinematics of groups that the step solves, 6 dynamics, and 2, 3, 5, 8, which a scene has none of.
    ///
    /// # Errors
    ///
    /// There is no truth value of that number, or it would leave out another part of the step (7, 9 to 11: sensors,
    /// motions of joints).
    pub fn set_bool_parameter(&mut self, id: i64, value: bool) -> Result<(), ApiError> {
        let now = self.bool_parameter(id)?;
        if SWITCHES.contains(&id) {
            if value {
                self.registry.switched_off.remove(&id);
            } else if self.registry.switched_off.insert(id) && id == DYNAMICS_HANDLING && self.is_running() {
                self.bring_to_rest();
            }
            return Ok(());
        }
        if HANDLING.contains(&id) && value != now {
            return Err(ApiError::new(
                "sensors and motions of joints are part of every step: they are not switched off",
            ));
        }
        Ok(())
    }

    /// Vector parameter of the simulator by V-REP's number `id` (`sim.arrayparam_…`): 0, gravity `[m/s²]` as x, y, z in
    /// world axes.
    ///
    /// # Errors
    ///
    /// There is no vector parameter of that number.
    pub fn array_parameter(&self, id: i64) -> Result<[f64; 3], ApiError> {
        if id == GRAVITY { Ok(self.world.model().gravity().0) } else { Err(unknown("vector", id)) }
    }

    /// Sets the vector parameter of the simulator with V-REP's number `id` (`sim.arrayparam_…`): 0, gravity `[m/s²]` as
    /// x, y, z in world axes.
    ///
    /// # Errors
    ///
    /// There is no vector parameter of that number, or a number is not finite.
    pub fn set_array_parameter(&mut self, id: i64, value: [f64; 3]) -> Result<(), ApiError> {
        if id == GRAVITY { self.set_gravity(value) } else { Err(unknown("vector", id)) }
    }

    /// Text parameter of the simulator by V-REP's number `id` (`sim.stringparam_…`): 13 path of the scene file, 14 its
    /// folder, 15 name of the scene; others are empty.
    ///
    /// # Errors
    ///
    /// There is no text parameter of that number.
    pub fn string_parameter(&self, id: i64) -> Result<String, ApiError> {
        let path = &self.registry.scene_path;
        let (folder, _) = path.rsplit_once('/').unwrap_or_default();
        match id {
            SCENE_PATH => Ok(path.clone()),
            SCENE_FOLDER => Ok(folder.to_owned()),
            SCENE_NAME => Ok(folder.rsplit('/').next().unwrap_or_default().to_owned()),
            _ => known(TEXTS, id, "text").map(str::to_owned),
        }
    }

    /// State of the simulation as the number that `sim.getSimulationState` gives: 0 stopped, 8 paused, 16 before the
    /// first step of a run, 17 running.
    #[must_use]
    pub fn simulation_state(&self) -> i64 {
        match self.registry.phase {
            Phase::Stopped => 0,
            Phase::Paused => 8,
            Phase::Running if self.world.state.tick == 0 => 16,
            Phase::Running => 17,
        }
    }
}

/// The answer of a parameter that is always the same.
fn known<T: Copy>(list: &[Fixed<T>], id: i64, kind: &str) -> Result<T, ApiError> {
    fixed(list, id).ok_or_else(|| unknown(kind, id))
}

/// There is no parameter of that number.
pub(super) fn unknown(kind: &str, id: i64) -> ApiError {
    ApiError(format!("there is no {kind} parameter {id} here"))
}
