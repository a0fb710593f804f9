//! The bars: what sincro wants to reach, first and in the end.
//!
//! Speeds are ratios to a peer run beside us in the same minute; absolute times belong to a machine and an hour.

/// Which way is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Limit {
    /// At least so much.
    AtLeast(f64),
    /// At most so much.
    AtMost(f64),
}

impl Limit {
    /// Returns true if a value keeps the limit; a NaN does not.
    fn holds(self, value: f64) -> bool {
        match self {
            Self::AtLeast(limit) => value >= limit,
            Self::AtMost(limit) => value <= limit,
        }
    }

    /// Distance of a value from the limit, as a factor above 1.
    fn missed_by(self, value: f64) -> f64 {
        match self {
            Self::AtLeast(limit) => limit / value,
            Self::AtMost(limit) => value / limit,
        }
    }

    /// As it stands in the table.
    pub fn words(self) -> String {
        match self {
            Self::AtLeast(limit) => format!("≥ {}", short(limit)),
            Self::AtMost(f64::MAX) => "stable".into(),
            Self::AtMost(limit) => format!("≤ {}", short(limit)),
        }
    }
}

/// A bar on one figure.
#[derive(Debug)]
pub(super) struct Bar {
    /// Key of the figure.
    pub figure: &'static str,
    /// Robot.
    pub model: &'static str,
    /// Whose time over ours is meant; none: our own number.
    pub peer: Option<&'static str>,
    /// To be reached first.
    pub first: Limit,
    /// To be reached in the end.
    pub goal: Limit,
    /// Unit of the number.
    pub unit: &'static str,
}

const fn ratio(figure: &'static str, model: &'static str, peer: &'static str, first: f64, goal: f64) -> Bar {
    let (first, goal) = (Limit::AtLeast(first), Limit::AtLeast(goal));
    Bar { figure, model, peer: Some(peer), first, goal, unit: "×" }
}

const fn most(figure: &'static str, model: &'static str, first: f64, goal: f64, unit: &'static str) -> Bar {
    Bar { figure, model, peer: None, first: Limit::AtMost(first), goal: Limit::AtMost(goal), unit }
}

/// All bars that are measured here.
pub(super) const BARS: [Bar; 35] = [
    ratio("step semi-implicit-euler", "alexandros", "mujoco", 3.0, 7.0),
    ratio("step implicit", "alexandros", "mujoco", 3.0, 6.0),
    ratio("step rk4", "arm2", "mujoco", 5.0, 10.0),
    ratio("step semi-implicit-euler", "humanoid", "mujoco", 1.3, 2.0),
    ratio("step semi-implicit-euler", "humanoid_lying", "mujoco", 1.0, 2.0),
    ratio("step semi-implicit-euler", "heap10", "mujoco", 1.0, 2.0),
    ratio("step semi-implicit-euler", "heap20", "mujoco", 1.0, 2.0),
    ratio("step semi-implicit-euler", "heap40", "mujoco", 1.0, 2.0),
    ratio("step semi-implicit-euler", "heap100", "mujoco", 1.0, 2.0),
    ratio("forward", "alexandros", "pinocchio", 2.5, 7.0),
    ratio("forward", "panda", "pinocchio", 2.5, 7.0),
    ratio("forward", "quad", "pinocchio", 2.5, 7.0),
    ratio("forward", "chain100", "pinocchio", 2.5, 7.0),
    ratio("inverse", "alexandros", "pinocchio", 2.0, 4.0),
    ratio("inverse", "panda", "pinocchio", 2.0, 4.0),
    ratio("inverse", "quad", "pinocchio", 2.0, 4.0),
    ratio("inverse", "chain100", "pinocchio", 2.0, 4.0),
    // single worlds whose equations are compiled in memory: with the feature `jit`
    ratio("step semi-implicit-euler compiled", "alexandros", "mujoco", 6.0, 7.0),
    most("step semi-implicit-euler compiled", "alexandros", 250.0, 200.0, "ns"),
    ratio("forward compiled", "alexandros", "pinocchio", 6.0, 7.0),
    ratio("forward compiled", "panda", "pinocchio", 6.0, 7.0),
    ratio("forward compiled", "quad", "pinocchio", 6.0, 7.0),
    ratio("forward compiled", "chain100", "pinocchio", 6.0, 7.0),
    ratio("batch", "alexandros", "mujoco", 15.0, 26.0),
    Bar {
        figure: "batch threads",
        model: "alexandros",
        peer: None,
        first: Limit::AtLeast(1.8),
        goal: Limit::AtLeast(1.95),
        unit: "×",
    },
    most("growth chain200/chain100", "chain200", 2.1, 2.0, "×"),
    most("diagram of 100 blocks adds", "arm2", 2000.0, 1000.0, "ns"),
    most("flight of 60 s", "quadrotor", 0.15, 0.05, "s"),
    most("legacy message", "adapters", 20.0, 10.0, "µs"),
    most("ZeroMQ call", "adapters", 30.0, 15.0, "µs"),
    most("Lua actuation call", "adapters", 3.0, 1.0, "µs"),
    most("memory", "alexandros", 16.0, 8.0, "kB"),
    most("accuracy first second", "arm2", 1e-5, 1e-6, "rad"),
    most("accuracy energy 10 s", "chain10", 1e-4, 1e-8, ""),
    // a run that stops has no finite error
    most("accuracy first second", "alexandros", f64::MAX, 1e-6, "rad"),
];

impl Bar {
    /// The bar on a figure, if there is one.
    pub fn find(figure: &str, model: &str, peer: Option<&str>) -> Option<&'static Self> {
        BARS.iter().find(|bar| bar.figure == figure && bar.model == model && bar.peer == peer)
    }

    /// Verdict on a value, in words.
    pub fn verdict(&self, value: f64) -> String {
        if self.goal.holds(value) {
            "goal met".into()
        } else if self.first.holds(value) {
            format!("met, goal {}", self.goal.words())
        } else if value.is_finite() {
            format!("missed by a factor {:.2}", self.first.missed_by(value))
        } else {
            "missed".into()
        }
    }

    /// Returns true if a value keeps the first bar.
    pub fn is_met(&self, value: f64) -> bool {
        self.first.holds(value)
    }
}

/// A number in three digits or so.
pub(super) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        format!("{x}")
    } else if !(1e-3..1e5).contains(&size) {
        format!("{x:.1e}").replace(".0e", "e")
    } else if size >= 100.0 {
        format!("{x:.0}")
    } else {
        let text = format!("{x:.*}", if size >= 10.0 { 1 } else { 2 });
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_say_how_far_it_is() {
        let bar = Bar::find("step rk4", "arm2", Some("mujoco")).unwrap();
        assert_eq!(bar.verdict(10.0), "goal met");
        assert_eq!(bar.verdict(5.0), "met, goal ≥ 10");
        assert_eq!(bar.verdict(4.0), "missed by a factor 1.25");
        assert_eq!(bar.verdict(f64::NAN), "missed");
        assert!(Bar::find("step rk4", "arm2", None).is_none());
    }

    #[test]
    fn a_run_that_stops_is_not_stable() {
        let bar = Bar::find("accuracy first second", "alexandros", None).unwrap();
        assert_eq!(bar.verdict(1e-3), "met, goal ≤ 1e-6");
        assert_eq!(bar.verdict(f64::INFINITY), "missed");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([2.1, 7.0, 12.34, 1234.5, 1e-6, 3.21e-7].map(short), ["2.1", "7", "12.3", "1234", "1e-6", "3.2e-7"]);
    }
}
