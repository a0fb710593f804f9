//! Constants and older names of `simIK`.

use crate::ik_objects::{PRISMATIC, REVOLUTE};

/// `simIK.constraint_pose`
pub const ALL: i64 = 31;
/// `simIK.jointmode_ik`
pub const MODE_IK: i64 = 2;
/// `simIK.calc_notwithintolerance`
pub const NOT_WITHIN_TOLERANCE: i64 = 16;
/// `simIK.calc_limithit`
pub const LIMIT_HIT: i64 = 64;

/// Constants that scripts and clients see as `simIK.NAME`: the name without `simIK.` and its value, a number without
/// unit (a code, handle or bit mask).
pub const CONSTANTS: &[(&str, i64)] = &[
    ("method_pseudo_inverse", 0),
    ("method_damped_least_squares", 1),
    ("method_undamped_pseudo_inverse", 3),
    ("jointtype_revolute", REVOLUTE),
    ("jointtype_prismatic", PRISMATIC),
    ("jointmode_passive", 0),
    ("jointmode_ik", MODE_IK),
    ("handle_world", -1),
    ("handle_parent", -11),
    ("handleflag_tipdummy", 0x0040_0000),
    ("group_enabled", 1),
    ("group_ignoremaxsteps", 2),
    ("group_restoreonbadlin", 4),
    ("group_restoreonbadang", 8),
    ("constraint_x", 1),
    ("constraint_y", 2),
    ("constraint_z", 4),
    ("constraint_alpha_beta", 8),
    ("constraint_gamma", 16),
    ("constraint_position", 7),
    ("constraint_orientation", 24),
    ("constraint_pose", ALL),
    ("result_not_performed", 0),
    ("result_success", 1),
    ("result_fail", 2),
    ("calc_notwithintolerance", NOT_WITHIN_TOLERANCE),
    ("calc_limithit", LIMIT_HIT),
];

/// Older names of functions of `simIK`, each with its present name, both without `simIK.`.
pub const OLD: &[(&str, &str)] = &[
    ("createIkEnvironment", "createEnvironment"),
    ("eraseIkEnvironment", "eraseEnvironment"),
    ("createIkGroup", "createGroup"),
    ("setIkGroupCalculation", "setGroupCalculation"),
    ("addIkElementFromScene", "addElementFromScene"),
    ("addIkElement", "addElement"),
    ("getLinkedDummy", "getTargetDummy"),
    ("setLinkedDummy", "setTargetDummy"),
    ("setIkElementPrecision", "setElementPrecision"),
    ("setIkElementWeights", "setElementWeights"),
    ("handleIkGroup", "handleGroup"),
    ("getIkGroupHandle", "getGroupHandle"),
    ("doesIkGroupExist", "doesGroupExist"),
    ("getIkGroupCalculation", "getGroupCalculation"),
    ("setIkGroupFlags", "setGroupFlags"),
    ("getIkGroupFlags", "getGroupFlags"),
    ("setIkElementBase", "setElementBase"),
    ("getIkElementBase", "getElementBase"),
    ("setIkElementConstraints", "setElementConstraints"),
    ("getIkElementConstraints", "getElementConstraints"),
    ("setIkElementFlags", "setElementFlags"),
    ("getIkElementFlags", "getElementFlags"),
    ("getIkElementPrecision", "getElementPrecision"),
    ("getIkElementWeights", "getElementWeights"),
];
