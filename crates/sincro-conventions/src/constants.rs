//! The constants that clients and scripts know, with the numbers that travel over the wire.
//!
//! `constants.txt` holds the whole table of V-REP and CoppeliaSim; flags that this program has constants for, and names
//! that are spelt otherwise there, are in a table here and with the parameters of the simulator.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use crate::simulator;

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
    CONSTANTS.iter().copied().chain(simulator::names())
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
    ("handleflag_reljointbaseframe", HANDLE_JOINT_BASE as i64),
    ("handleflag_wxyzquat", HANDLE_WXYZ as i64),
    ("rml_phase_sync_if_possible", 0),
    ("rml_only_time_sync", 1),
    ("rml_only_phase_sync", 2),
    ("rml_no_sync", 3),
    ("rml_keep_target_vel", 0),
    ("rml_recompute_trajectory", 4),
    ("rml_disable_extremum_motion_states_calc", 8),
    ("rml_keep_current_vel_if_fallback_strategy", 16),
];

/// Flag that a client adds to the first handle of a call about poses: the reference is the joint's frame on the side of
/// its parent.
pub const HANDLE_JOINT_BASE: i32 = 0x0040_0000;
/// Flag that a client adds to the first handle of a call about poses: quaternions are in the order w, x, y, z.
pub const HANDLE_WXYZ: i32 = 0x0100_0000;
/// Bound of handles: all bits from it on are flags.
pub const HANDLE_FLAGS: i32 = 0x0010_0000;

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
