//! Parameters of the simulator, by the numbers and names that clients use for them.
//!
//! What belongs to windows, editing and the computer has a fixed answer: programs that turn the display off for speed
//! run as they are.

/// Version that clients are told: the last one with the legacy remote API, which is what they check for.
pub const PROGRAM_VERSION: i64 = 40_501;

/// A parameter whose answer is always the same: number, name without `sim.`, answer.
pub type Fixed<T> = (i64, &'static str, T);

/// Whole numbers.
pub const WHOLE: &[Fixed<i64>] = &[
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
/// The physics engine.
pub const DYNAMIC_ENGINE: i64 = 8;
/// Ports that scripts of V-REP 3 choose one from: first, number, next.
pub const PORTS: [i64; 3] = [9, 10, 15];

/// Truth values.
pub const TRUTHS: &[Fixed<bool>] = &[
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
pub const IK_HANDLING: i64 = 4;

/// Truth value of the dynamics.
pub const DYNAMICS_HANDLING: i64 = 6;

/// Truth values of parts of the step that can be switched off: dynamics, inverse kinematics, and objects of V-REP 3 for
/// collisions, distances, geometric constraints and paths, of which a scene has none.
pub const SWITCHES: [i64; 6] = [2, 3, IK_HANDLING, 5, DYNAMICS_HANDLING, 8];

/// Truth values that say which parts a step has.
pub const HANDLING: std::ops::RangeInclusive<i64> = 2..=11;

/// Texts: folders of a program that is not installed. Clients build paths of scenes from them that are looked for by
/// their last part.
pub const TEXTS: &[Fixed<&str>] = &[
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
/// Path and name of the scene's file.
pub const SCENE_PATH: i64 = 13;
/// Folder of the scene.
pub const SCENE_FOLDER: i64 = 14;
/// Name of the scene.
pub const SCENE_NAME: i64 = 15;

/// Number of stop requests.
pub const STOP_REQUESTS: i64 = 29;
/// Base steps in a step of clients.
pub const STEP_DIVIDER: i64 = 7;
/// A random number.
pub const RANDOM: i64 = 0;
/// Seed of these random numbers.
pub const RANDOM_SEED: u64 = 0x5eed;
/// The simulation time step `[s]`.
pub const TIME_STEP: i64 = 1;
/// The physics step `[s]`, in 3.x and later.
pub const PHYSICS_STEP: [i64; 2] = [3, 5];
/// Gravity [m/s²].
pub const GRAVITY: i64 = 0;

/// The rest of the names.
pub const NAMES: &[(&str, i64)] = &[
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

/// The answer of a parameter in one of these lists.
#[must_use]
pub fn fixed<T: Copy>(list: &[Fixed<T>], id: i64) -> Option<T> {
    list.iter().find(|p| p.0 == id).map(|p| p.2)
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
