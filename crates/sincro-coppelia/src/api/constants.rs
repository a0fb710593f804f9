//! The constants that clients and scripts know, with the numbers that travel over the wire.
//!
//! `constants.txt` holds the whole table of V-REP and CoppeliaSim; the numbers that this program itself depends on, and
//! names that are spelt otherwise there, are in a table here and with the parameters of the simulator.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use super::program;

/// Constants of the API that clients and scripts see as `sim.NAME`, each name once: the name without `sim.` (or `sim_`)
/// and its value, a number without unit: a code, handle or bit mask.
pub fn constants() -> impl Iterator<Item = (&'static str, i64)> {
    static FURTHER: OnceLock<Vec<(&'static str, i64)>> = OnceLock::new();
    let further = FURTHER.get_or_init(|| {
        let known: BTreeSet<&str> = own().map(|(name, _)| name).collect();
        table().into_iter().filter(|(name, _)| !known.contains(&**name)).map(|(n, x)| (&*n.leak(), x)).collect()
    });
    own().chain(further.iter().copied())
}

fn own() -> impl Iterator<Item = (&'static str, i64)> {
    CONSTANTS.iter().copied().chain(program::names())
}

/// The rows of `constants.txt`: a prefix, then names with their values.
fn table() -> Vec<(String, i64)> {
    let mut all = Vec::new();
    for line in include_str!("constants.txt").lines().filter(|line| !line.starts_with('#')) {
        let mut words = line.split(' ');
        let prefix = words.next().unwrap_or_default();
        for (name, value) in words.filter_map(|word| word.split_once('=')) {
            let value = value.parse().expect("constants.txt holds whole numbers");
            all.push((format!("{prefix}_{name}"), value));
        }
    }
    all
}

/// Those that are no parameters of the simulator.
const CONSTANTS: &[(&str, i64)] = &[
    ("handle_world", -1),
    ("handle_all", -2),
    ("handle_all_except_explicit", -3),
    ("handle_self", -4),
    ("handle_main_script", -5),
    ("handle_mainscript", -5),
    ("handle_tree", -6),
    ("handle_chain", -7),
    ("handle_single", -8),
    ("handle_default", -9),
    ("handle_parent", -11),
    ("handle_scene", -12),
    ("handle_app", -13),
    ("handle_inverse", -14),
    ("handleflag_reljointbaseframe", HANDLE_JOINT_BASE as i64),
    ("handleflag_axis", 0x0040_0000),
    ("handleflag_greyscale", 0x0040_0000),
    ("handleflag_codedstring", 0x0040_0000),
    ("handleflag_depthbuffermeters", 0x0080_0000),
    ("handleflag_resetforce", 0x0040_0000),
    ("handleflag_resettorque", 0x0080_0000),
    ("handleflag_abscoords", 0x0080_0000),
    ("handleflag_rawvalue", 0x0100_0000),
    ("handleflag_wxyzquat", HANDLE_WXYZ as i64),
    ("handleflag_silenterror", 0x0200_0000),
    ("object_shape_type", 0),
    ("sceneobject_shape", 0),
    ("object_joint_type", 1),
    ("sceneobject_joint", 1),
    ("object_graph_type", 2),
    ("object_camera_type", 3),
    ("object_dummy_type", 4),
    ("sceneobject_dummy", 4),
    ("object_proximitysensor_type", 5),
    ("proximitysensor_pyramid_subtype", 30),
    ("proximitysensor_pyramid", 30),
    ("proximitysensor_cylinder_subtype", 31),
    ("proximitysensor_cylinder", 31),
    ("proximitysensor_disc_subtype", 32),
    ("proximitysensor_disc", 32),
    ("proximitysensor_cone_subtype", 33),
    ("proximitysensor_cone", 33),
    ("proximitysensor_ray_subtype", 34),
    ("proximitysensor_ray", 34),
    ("colorcomponent_ambient", 0),
    ("colorcomponent_ambient_diffuse", 0),
    ("colorcomponent_diffuse", 1),
    ("colorcomponent_specular", 2),
    ("colorcomponent_emission", 3),
    ("object_path_type", 8),
    ("object_visionsensor_type", 9),
    ("object_forcesensor_type", 12),
    ("object_light_type", 13),
    ("appobj_object_type", 109),
    ("joint_revolute_subtype", 10),
    ("joint_revolute", 10),
    ("joint_prismatic_subtype", 11),
    ("joint_prismatic", 11),
    ("joint_spherical_subtype", 12),
    ("joint_spherical", 12),
    ("jointmode_passive", 0),
    ("jointmode_kinematic", 0),
    ("jointmode_ik", 2),
    ("jointmode_dependent", 4),
    ("jointmode_force", 5),
    ("jointmode_dynamic", 5),
    ("jointdynctrl_free", 0),
    ("jointdynctrl_force", 1),
    ("jointdynctrl_velocity", 4),
    ("jointdynctrl_position", 8),
    ("jointdynctrl_spring", 12),
    ("jointdynctrl_callback", 16),
    ("ruckig_phasesync", 0),
    ("ruckig_timesync", 1),
    ("ruckig_nosync", 3),
    ("ruckig_minvel", 0x100),
    ("ruckig_minaccel", 0x200),
    ("rml_phase_sync_if_possible", 0),
    ("rml_only_time_sync", 1),
    ("rml_only_phase_sync", 2),
    ("rml_no_sync", 3),
    ("rml_keep_target_vel", 0),
    ("rml_recompute_trajectory", 4),
    ("rml_disable_extremum_motion_states_calc", 8),
    ("rml_keep_current_vel_if_fallback_strategy", 16),
    ("primitiveshape_plane", 1),
    ("primitiveshape_disc", 2),
    ("primitiveshape_cuboid", 3),
    ("primitiveshape_spheroid", 4),
    ("primitiveshape_cylinder", 5),
    ("primitiveshape_cone", 6),
    ("primitiveshape_heightfield", 7),
    ("primitiveshape_capsule", 8),
    ("pure_primitive_plane", 1),
    ("pure_primitive_disc", 2),
    ("pure_primitive_cuboid", 3),
    ("pure_primitive_spheroid", 4),
    ("pure_primitive_cylinder", 5),
    ("pure_primitive_cone", 6),
    ("pure_primitive_heightfield", 7),
    ("simulation_stopped", 0),
    ("simulation_paused", 8),
    ("simulation_advancing", 16),
    ("simulation_advancing_firstafterstop", 16),
    ("simulation_advancing_running", 17),
    ("simulation_advancing_lastbeforepause", 19),
    ("simulation_advancing_firstafterpause", 20),
    ("simulation_advancing_abouttostop", 21),
    ("simulation_advancing_lastbeforestop", 22),
    ("scripttype_mainscript", 0),
    ("scripttype_main", 0),
    ("scripttype_childscript", 1),
    ("scripttype_simulation", 1),
    ("scripttype_addonscript", 2),
    ("scripttype_addon", 2),
    ("scripttype_customizationscript", 6),
    ("scripttype_customization", 6),
    ("scripttype_sandboxscript", 8),
    ("scripttype_sandbox", 8),
    ("ikresult_not_performed", 0),
    ("ikresult_success", 1),
    ("ikresult_fail", 2),
    ("physics_bullet", 0),
    ("physics_ode", 1),
    ("physics_vortex", 2),
    ("physics_newton", 3),
    ("physics_mujoco", 4),
    ("verbosity_none", 100),
    ("verbosity_errors", 200),
    ("verbosity_warnings", 300),
    ("verbosity_loadinfos", 400),
    ("verbosity_scripterrors", 420),
    ("verbosity_scriptwarnings", 430),
    ("verbosity_scriptinfos", 450),
    ("verbosity_infos", 500),
    ("verbosity_debug", 600),
    ("jointintparam_motor_enabled", 2000),
    ("jointintparam_ctrl_enabled", 2001),
    ("jointfloatparam_pid_p", 2002),
    ("jointfloatparam_pid_i", 2003),
    ("jointfloatparam_pid_d", 2004),
    ("jointfloatparam_velocity", 2012),
    ("jointfloatparam_upper_limit", 2017),
    ("jointfloatparam_maxvel", 2036),
    ("jointfloatparam_kc_k", 2018),
    ("jointfloatparam_kc_c", 2019),
    ("jointintparam_velocity_lock", 2030),
    ("jointintparam_dynctrlmode", 2039),
    ("shapefloatparam_init_velocity_x", 3000),
    ("shapefloatparam_init_velocity_y", 3001),
    ("shapefloatparam_init_velocity_z", 3002),
    ("shapeintparam_static", 3003),
    ("shapeintparam_respondable", 3004),
    ("shapefloatparam_mass", 3005),
    ("shapeintparam_respondable_mask", 3019),
    ("shapefloatparam_init_velocity_a", 3020),
    ("shapefloatparam_init_velocity_b", 3021),
    ("shapefloatparam_init_velocity_g", 3022),
    ("visionfloatparam_near_clipping", 1000),
    ("visionfloatparam_far_clipping", 1001),
    ("visionintparam_resolution_x", 1002),
    ("visionintparam_resolution_y", 1003),
    ("visionfloatparam_perspective_angle", 1004),
    ("visionfloatparam_ortho_size", 1005),
    ("visionintparam_disabled_light_components", 1006),
    ("visionintparam_rendering_attributes", 1007),
    ("visionintparam_entity_to_render", 1008),
    ("visionintparam_render_mode", 1017),
    ("visionintparam_perspective_operation", 1018),
    ("visionintparam_rgbignored", 1020),
    ("visionintparam_depthignored", 1021),
    ("buffer_uint8", 0),
    ("buffer_int8", 1),
    ("buffer_uint16", 2),
    ("buffer_int16", 3),
    ("buffer_uint32", 4),
    ("buffer_int32", 5),
    ("buffer_float", 6),
    ("buffer_double", 7),
    ("objfloatparam_abs_x_velocity", 11),
    ("objfloatparam_abs_y_velocity", 12),
    ("objfloatparam_abs_z_velocity", 13),
    ("objfloatparam_abs_rot_velocity", 14),
    ("objintparam_visibility_layer", 10),
];

/// Flag that a client adds to the first handle of a call about poses: the reference is the joint's frame on the side of
/// its parent.
pub(crate) const HANDLE_JOINT_BASE: i32 = 0x0040_0000;
/// Flag that a client adds to the first handle of a call about poses: quaternions are in the order w, x, y, z.
pub(crate) const HANDLE_WXYZ: i32 = 0x0100_0000;
/// Bound of handles: all bits from it on are flags.
pub(crate) const HANDLE_FLAGS: i32 = 0x0010_0000;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn a_name_has_one_value_in_all_tables() {
        let table: BTreeMap<String, i64> = table().into_iter().collect();
        let differ: Vec<_> = own().filter(|(name, x)| table.get(*name).is_some_and(|other| other != x)).collect();
        assert_eq!(differ, Vec::new());
    }

    #[test]
    fn names_occur_once_and_those_of_drawing_and_particles_are_known() {
        let mut names: Vec<&str> = constants().map(|(name, _)| name).collect();
        let n = names.len();
        names.sort_unstable();
        names.dedup();
        assert!(names.len() == n && n > 1_400, "{} of {n} names", names.len());
        for name in [
            "drawing_discpoints",
            "drawing_discpts",
            "particle_roughspheres",
            "handle_tree",
            "message_eventcallback_mainscriptabouttobecalled",
        ] {
            assert!(names.binary_search(&name).is_ok(), "{name}");
        }
    }

    /// Numbers that the class for Octave and MATLAB has are those of the table.
    #[test]
    fn constants_of_rem_api_are_those_of_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/clients/octave/remApi.m");
        let text = std::fs::read_to_string(path).unwrap();
        let all: BTreeMap<&str, i64> = constants().collect();
        let given =
            text.lines().filter_map(|line| line.trim().strip_prefix("sim_")?.strip_suffix(';')?.split_once(" = "));
        let given: Vec<(&str, i64)> = given.filter_map(|(name, x)| Some((name, x.parse().ok()?))).collect();
        assert!(given.len() > 400, "{}", given.len());
        let differ: Vec<_> = given.iter().filter(|(name, x)| all.get(name).is_some_and(|known| known != x)).collect();
        assert_eq!(differ, Vec::<&(&str, i64)>::new());
    }
}
