//! Parameters of the simulator, by the numbers and names that clients use for them. Those of objects are in
//! `parameters.rs`.
//!
//! What belongs to windows, editing and the computer has a fixed answer, and takes settings without effect: programs
//! that turn the display off for speed run as they are.

use super::{ApiError, ObjectRegistry, Phase, SimApi};

/// Version that clients are told: the last one with the legacy remote API, which is what they check for.
const PROGRAM_VERSION: i64 = 40_501;

/// A parameter whose answer is always the same: number, name without `sim.`, answer.
type Fixed<T> = (i64, &'static str, T);

/// Whole numbers.
const WHOLE: &[Fixed<i64>] = &[
    (0, "intparam_error_report_mode", 0),
    (1, "intparam_program_version", PROGRAM_VERSION),
    (2, "intparam_instance_count", 1),
    (4, "intparam_compilation_version", 1),
    (5, "intparam_current_page", 0),
    // none of those that have a number; MuJoCo's is the nearest in kind
    (DYNAMIC_ENGINE, "intparam_dynamic_engine", 4),
    (PORTS[0], "intparam_server_port_start", 19_997),
    (PORTS[1], "intparam_server_port_range", 100),
    (11, "intparam_visible_layers", 0xff),
    (12, "intparam_infotext_style", 0),
    (14, "intparam_edit_mode_type", 0),
    // always the same: a port that is open already is accepted
    (PORTS[2], "intparam_server_port_next", 19_997),
    (16, "intparam_qt_version", 0),
    // Linux
    (19, "intparam_platform", 2),
    (20, "intparam_scene_unique_id", 1),
    (22, "intparam_mouse_x", 0),
    (23, "intparam_mouse_y", 0),
    (24, "intparam_core_count", 1),
    (26, "intparam_idle_fps", 0),
    (27, "intparam_prox_sensor_select_down", 0),
    (28, "intparam_prox_sensor_select_up", 0),
    (30, "intparam_program_revision", 0),
    (31, "intparam_mouse_buttons", 0),
    (32, "intparam_dynamic_warning_disabled_mask", 0),
    (34, "intparam_scene_index", 0),
    (36, "intparam_speedmodifier", 0),
    (38, "intparam_job_count", 1),
    (39, "intparam_program_full_version", PROGRAM_VERSION * 100),
    (40, "intparam_verbosity", 450),
    (41, "intparam_statusbarverbosity", 450),
    (42, "intparam_dlgverbosity", 100),
    (43, "intparam_videoencoder_index", 0),
    (44, "intparam_exitcode", 0),
    (46, "intparam_mouseclickcounterdown", 0),
    (47, "intparam_mouseclickcounterup", 0),
];
const DYNAMIC_ENGINE: i64 = 8;
/// Ports that scripts of V-REP 3 choose one from: first, number, next.
const PORTS: [i64; 3] = [9, 10, 15];

/// Truth values.
const TRUTHS: &[Fixed<bool>] = &[
    (0, "boolparam_hierarchy_visible", false),
    (1, "boolparam_console_visible", false),
    (2, "boolparam_collision_handling_enabled", true),
    (3, "boolparam_distance_handling_enabled", true),
    (4, "boolparam_ik_handling_enabled", true),
    (5, "boolparam_gcs_handling_enabled", true),
    (6, "boolparam_dynamics_handling_enabled", true),
    (7, "boolparam_joint_motion_handling_enabled", true),
    (8, "boolparam_path_motion_handling_enabled", true),
    (9, "boolparam_proximity_sensor_handling_enabled", true),
    (10, "boolparam_vision_sensor_handling_enabled", true),
    (11, "boolparam_mill_handling_enabled", false),
    (12, "boolparam_browser_visible", false),
    (13, "boolparam_scene_and_model_load_messages", false),
    (15, "boolparam_shape_textures_are_visible", false),
    (16, "boolparam_display_enabled", false),
    (17, "boolparam_infotext_visible", false),
    (18, "boolparam_statustext_open", false),
    (19, "boolparam_fog_enabled", false),
    (20, "boolparam_rml2_available", true),
    (21, "boolparam_rml4_available", true),
    (22, "boolparam_mirrors_enabled", false),
    (23, "boolparam_aux_clip_planes_enabled", false),
    (25, "boolparam_realtime_simulation", false),
    (26, "boolparam_use_glfinish_cmd", false),
    (29, "boolparam_video_recording_triggered", false),
    (33, "boolparam_fullscreen", false),
    (34, "boolparam_headless", true),
    (35, "boolparam_hierarchy_toolbarbutton_enabled", false),
    (36, "boolparam_browser_toolbarbutton_enabled", false),
    (37, "boolparam_objectshift_toolbarbutton_enabled", false),
    (38, "boolparam_objectrotate_toolbarbutton_enabled", false),
    (39, "boolparam_force_calcstruct_all_visible", false),
    (40, "boolparam_force_calcstruct_all", false),
    (41, "boolparam_exit_request", false),
    (42, "boolparam_play_toolbarbutton_enabled", false),
    (43, "boolparam_pause_toolbarbutton_enabled", false),
    (44, "boolparam_stop_toolbarbutton_enabled", false),
    (45, "boolparam_waiting_for_trigger", false),
    (48, "boolparam_rosinterface_donotrunmainscript", false),
    (49, "boolparam_online_mode", false),
    (58, "boolparam_execunsafe", false),
];

/// Truth value of the inverse kinematics of groups that each step solves.
pub(super) const IK_HANDLING: i64 = 4;

/// Truth value of the dynamics.
const DYNAMICS_HANDLING: i64 = 6;

/// Truth values of parts of the step that can be switched off: dynamics, inverse kinematics, and objects of V-REP 3 for
/// collisions, distances, geometric constraints and paths, of which a scene has none.
const SWITCHES: [i64; 6] = [2, 3, IK_HANDLING, 5, DYNAMICS_HANDLING, 8];

/// Truth values that say which parts a step has.
const HANDLING: std::ops::RangeInclusive<i64> = 2..=11;

/// Texts: folders of a program that is not installed. Clients build paths of scenes from them that are looked for by
/// their last part.
const TEXTS: &[Fixed<&str>] = &[
    (0, "stringparam_application_path", ""),
    (1, "stringparam_video_filename", ""),
    (2, "stringparam_app_arg1", ""),
    (3, "stringparam_app_arg2", ""),
    (4, "stringparam_app_arg3", ""),
    (5, "stringparam_app_arg4", ""),
    (6, "stringparam_app_arg5", ""),
    (7, "stringparam_app_arg6", ""),
    (8, "stringparam_app_arg7", ""),
    (9, "stringparam_app_arg8", ""),
    (10, "stringparam_app_arg9", ""),
    (16, "stringparam_remoteapi_temp_file_dir", ""),
    (118, "stringparam_scene_unique_id", ""),
    (119, "stringparam_machine_id", ""),
    (127, "stringparam_tempdir", ""),
    (128, "stringparam_tempscenedir", ""),
    (129, "stringparam_datadir", ""),
    (132, "stringparam_scenedefaultdir", ""),
    (133, "stringparam_modeldefaultdir", ""),
    (SCENE_PATH, "stringparam_scene_path_and_name", ""),
    (SCENE_FOLDER, "stringparam_scene_path", ""),
    (SCENE_NAME, "stringparam_scene_name", ""),
];
const SCENE_PATH: i64 = 13;
const SCENE_FOLDER: i64 = 14;
const SCENE_NAME: i64 = 15;

/// Number of stop requests.
const STOP_REQUESTS: i64 = 29;
/// Base steps in a step of clients.
const STEP_DIVIDER: i64 = 7;
/// A random number.
const RANDOM: i64 = 0;
/// Seed of these random numbers.
const RANDOM_SEED: u64 = 0x5eed;
/// The simulation time step `[s]`.
const TIME_STEP: i64 = 1;
/// The physics step `[s]`, in 3.x and later.
const PHYSICS_STEP: [i64; 2] = [3, 5];
/// Gravity [m/s²].
const GRAVITY: i64 = 0;

/// The rest of the names.
const NAMES: &[(&str, i64)] = &[
    ("intparam_stop_request_counter", STOP_REQUESTS),
    ("intparam_dynamic_step_divider", STEP_DIVIDER),
    ("floatparam_rand", RANDOM),
    ("floatparam_simulation_time_step", TIME_STEP),
    ("floatparam_dynamic_step_size", PHYSICS_STEP[0]),
    ("floatparam_physicstimestep", PHYSICS_STEP[1]),
    ("arrayparam_gravity", GRAVITY),
];

/// The names of all of them, without `sim.`, and their numbers.
pub fn names() -> impl Iterator<Item = (&'static str, i64)> {
    let whole = WHOLE.iter().map(|p| (p.1, p.0));
    let truths = TRUTHS.iter().map(|p| (p.1, p.0));
    let texts = TEXTS.iter().map(|p| (p.1, p.0));
    whole.chain(truths).chain(texts).chain(NAMES.iter().copied())
}

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
            _ => fixed(WHOLE, id, "whole-number"),
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
        let now = fixed(TRUTHS, id, "truth")?;
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
            _ => fixed(TEXTS, id, "text").map(str::to_owned),
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

fn fixed<T: Copy>(list: &[Fixed<T>], id: i64, kind: &str) -> Result<T, ApiError> {
    list.iter().find(|p| p.0 == id).map(|p| p.2).ok_or_else(|| unknown(kind, id))
}

/// There is no parameter of that number.
pub(super) fn unknown(kind: &str, id: i64) -> ApiError {
    ApiError(format!("there is no {kind} parameter {id} here"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn a_number_and_a_name_mean_one_parameter() {
        let all: Vec<_> = names().collect();
        let distinct: BTreeSet<_> = all.iter().map(|(name, _)| name).collect();
        assert_eq!(distinct.len(), all.len());
        let numbered: BTreeSet<_> = all.iter().map(|(name, id)| (name.split("param_").next(), id)).collect();
        assert_eq!(numbered.len(), all.len());
    }
}
