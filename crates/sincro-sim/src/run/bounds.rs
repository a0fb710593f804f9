//! Bounds at which a run ends, looked for in each recorded row.

use crate::table::Table;
use sincro_scene::experiment::Experiment;
use sincro_scene::experiment::stop::StopWhen;

/// The bounds of one run, with the columns they look at.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    any: Vec<(StopWhen, usize)>,
    all: Vec<(StopWhen, usize, bool)>,
}

impl Bounds {
    /// Bounds of an experiment's main run, or of one of its variants.
    pub fn new(experiment: &Experiment, variant: Option<&str>, table: &Table) -> Self {
        let column = |stop: &StopWhen| table.columns.iter().position(|c| c.name == stop.signal.value);
        let of_variant = variant.and_then(|name| experiment.variants.iter().find(|v| v.name == name));
        let (own, inherits) = match of_variant {
            Some(variant) => (&variant.checks[..], variant.inherit_checks),
            None => (&[][..], true),
        };
        let inherited = experiment.checks.iter().filter(|_| inherits);
        let checks = own.iter().chain(inherited).filter_map(StopWhen::of);
        Self {
            any: experiment.stops.iter().filter_map(|stop| Some((stop.clone(), column(stop)?))).collect(),
            all: checks.filter_map(|stop| column(&stop).map(|k| (stop, k, false))).collect(),
        }
    }

    /// Reason for which the run ends with the last row of a table, if it does.
    pub fn reached(&mut self, table: &Table) -> Option<String> {
        let last = |column: usize| table.columns[column].values.last().copied().unwrap_or(f64::NAN);
        let words = |stop: &StopWhen, k: usize| stop.words(last(k), &table.columns[k].unit);
        if let Some((stop, k)) = self.any.iter().find(|(stop, k)| stop.is_reached(last(*k))) {
            return Some(words(stop, *k));
        }
        let mut newest = None;
        for (stop, k, is_reached) in self.all.iter_mut().filter(|(.., is_reached)| !is_reached) {
            if stop.is_reached(last(*k)) {
                *is_reached = true;
                newest = Some(words(stop, *k));
            }
        }
        newest.filter(|_| self.all.iter().all(|(.., is_reached)| *is_reached))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_scene::diagnostic::{Located, Location, SourceText};
    use sincro_scene::experiment::stop::Side;

    fn stop(side: Side) -> StopWhen {
        let source = std::sync::Arc::new(SourceText { path: "experiment.toml".into(), text: String::new() });
        let at = Location { source, span: 0..0 };
        StopWhen { signal: Located { value: "/j.position".into(), at }, side, bound: 1.0 }
    }

    #[test]
    fn all_divergences_but_any_bound_end_a_run() {
        let mut table = Table::new([("t", "s"), ("/j.position", "rad"), ("/k.position", "rad")], 4);
        table.push_row(&[0.0, 2.0, 0.0]);
        let mut bounds =
            Bounds { any: vec![], all: vec![(stop(Side::Beyond), 1, false), (stop(Side::Beyond), 2, false)] };
        assert_eq!(bounds.reached(&table), None);
        table.push_row(&[0.1, 0.0, -3.0]);
        assert_eq!(bounds.reached(&table).unwrap(), "`/j.position` is -3 rad, beyond the bound of 1 rad");
        let mut any = Bounds { any: vec![(stop(Side::Below), 2)], all: vec![(stop(Side::Beyond), 1, false)] };
        assert_eq!(any.reached(&table).unwrap(), "`/j.position` is -3 rad, below the bound of 1 rad");
    }
}
