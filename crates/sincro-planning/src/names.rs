//! Numbers of algorithms and kinds of spaces.

/// Names of algorithms of `simOMPL.Algorithm` in the order of their numbers, the first of which is
/// [`FIRST_ALGORITHM`]. All of them mean RRT-Connect here.
pub const ALGORITHMS: [&str; 25] = [
    "BiTRRT",
    "BITstar",
    "BKPIECE1",
    "CForest",
    "EST",
    "FMT",
    "KPIECE1",
    "LazyPRM",
    "LazyPRMstar",
    "LazyRRT",
    "LBKPIECE1",
    "LBTRRT",
    "PDST",
    "PRM",
    "PRMstar",
    "pRRT",
    "pSBL",
    "RRT",
    "RRTConnect",
    "RRTstar",
    "SBL",
    "SPARS",
    "SPARStwo",
    "STRIDE",
    "TRRT",
];
/// Number of the first algorithm.
pub const FIRST_ALGORITHM: i64 = 30_001;

/// Names of `simOMPL.StateSpaceType` in the order of their numbers, the first of which is [`FIRST_SPACE`].
pub const SPACES: [&str; 7] =
    ["position2d", "pose2d", "position3d", "pose3d", "joint_position", "dubins", "cyclic_joint_position"];
/// Number of the first kind of space.
pub const FIRST_SPACE: i64 = 50_001;

/// Names and numbers of a table of constants of `simOMPL`: `Algorithm` and `StateSpaceType`.
pub fn tables() -> [(&'static str, Vec<(&'static str, i64)>); 2] {
    let numbered = |names: &[&'static str], first: i64| names.iter().copied().zip(first..).collect();
    [("Algorithm", numbered(&ALGORITHMS, FIRST_ALGORITHM)), ("StateSpaceType", numbered(&SPACES, FIRST_SPACE))]
}

/// Functions of `simOMPL` that are not offered, each with the reason; scripts have the first.
pub const ABSENT: [(&str, &str); 7] = [
    (
        "setStateValidationCallback",
        "clients are not called back in a search: a script can have the function, or collision pairs",
    ),
    (
        "setGoalCallback",
        "goals are states or pairs of dummies: simOMPL.setGoalState, addGoalState and setGoal give them",
    ),
    ("setProjectionEvaluationCallback", "RRT-Connect needs no projections"),
    ("setValidStateSamplerCallback", "states are drawn within the bounds of the state spaces"),
    ("projectStates", "RRT-Connect needs no projections"),
    ("setDubinsParams", "cars that cannot turn on the spot are not planned for: take the state space pose2d"),
    ("getPlannerData", "the trees of a search are not kept: simOMPL.getPath gives the path"),
];
