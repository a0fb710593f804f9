//! Validity of rotor theory: violations counted at the end of every base step, under the commands of that step.

use sincro_dynamics::aero::rotor::Validity;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::world::World;

/// Rotor that ran outside the validity of its theory, for one reason, with the times; an entry of
/// [`Simulated::outside`](crate::run::Simulated::outside).
#[derive(Clone, Debug, PartialEq)]
pub struct ValidityViolation {
    /// Path of the rotor.
    pub rotor: String,
    /// Condition of the theory that was violated.
    pub reason: Validity,
    /// Number of base steps that ended outside.
    pub steps: u64,
    /// Total duration of these steps `[s]`.
    pub duration: f64,
    /// Time at the end of the first such step `[s]`.
    pub first: f64,
    /// Time at the end of the last such step `[s]`.
    pub last: f64,
}

/// Counts.
pub(crate) struct Register {
    /// For each rotor and reason: steps, first and last time.
    counts: Vec<[(u64, f64, f64); Validity::REASONS.len()]>,
    zero: Vec<f64>,
}

impl Register {
    pub fn new(model: &Model<f64>) -> Self {
        let none = [(0, 0.0, 0.0); Validity::REASONS.len()];
        Self { counts: vec![none; model.rotors().len()], zero: vec![0.0; model.n_v()] }
    }

    /// Goes on with a model of another structure; `path_of` gives the path now of a rotor of the former one.
    pub fn restructured(&mut self, former: &Model<f64>, model: &Model<f64>, path_of: &dyn Fn(&str) -> Option<String>) {
        let mut new = Self::new(model);
        for (name, counts) in former.names().rotors.iter().zip(&self.counts) {
            let place = path_of(name).and_then(|path| model.names().rotors.iter().position(|rotor| *rotor == path));
            if let Some(k) = place {
                new.counts[k] = *counts;
            }
        }
        *self = new;
    }

    /// Checks every rotor at the end of a step, at time `t` `[s]`.
    pub fn update(&mut self, world: &mut World, t: f64) {
        if self.counts.is_empty() {
            return;
        }
        let Self { counts, zero } = self;
        world.with_state_view(t, |seen| {
            kinematics::motions(seen.model, seen.q, seen.v, zero, seen.scratch);
            let air = seen.model.wind().map(|wind| wind.at(t));
            for (rotor, counts) in seen.model.rotors().iter().zip(counts) {
                let x_wl = &seen.scratch.link_poses()[rotor.link];
                let hub = rotor.hub(&seen.scratch.twist(rotor.link), x_wl, air.as_ref());
                let speed = rotor.speed.value(seen.v, seen.commands, seen.rotors);
                let validity = rotor.validity(speed, &hub, &rotor.load(speed, seen.rotors, &hub), 0);
                if let Some(k) = Validity::REASONS.iter().position(|reason| *reason == validity) {
                    let (n, first, last) = &mut counts[k];
                    *first = if *n == 0 { t } else { *first };
                    (*n, *last) = (*n + 1, t);
                }
            }
        });
    }

    /// Returns the violations, rotor by rotor.
    pub fn close(&self, model: &Model<f64>, step: f64) -> Vec<ValidityViolation> {
        let mut found = Vec::new();
        for (rotor, counts) in model.names().rotors.iter().zip(&self.counts) {
            for (&reason, &(steps, first, last)) in Validity::REASONS.iter().zip(counts) {
                if steps > 0 {
                    let duration = steps as f64 * step;
                    found.push(ValidityViolation { rotor: rotor.clone(), reason, steps, duration, first, last });
                }
            }
        }
        found
    }
}

/// One sentence for each reason and time, with all rotors that it is about.
pub(crate) fn words(found: &[ValidityViolation], n_steps: u64) -> Vec<String> {
    let mut sentences = Vec::new();
    let mut said = vec![false; found.len()];
    for k in 0..found.len() {
        if said[k] {
            continue;
        }
        let one = &found[k];
        let is_same = |o: &ValidityViolation| {
            (o.reason, o.steps, o.first, o.last) == (one.reason, one.steps, one.first, one.last)
        };
        let names: Vec<String> = (k..found.len())
            .filter(|&i| is_same(&found[i]))
            .map(|i| {
                said[i] = true;
                format!("`{}`", found[i].rotor)
            })
            .collect();
        let (who, verb) = if names.len() == 1 { ("rotor", "was") } else { ("rotors", "were") };
        sentences.push(format!(
            "{who} {} {verb} outside what the theory holds for ({}) in {} of {n_steps} steps, {} s in all, between {} s and {} s",
            names.join(", "),
            one.reason.word(),
            one.steps,
            number(one.duration),
            number(one.first),
            number(one.last)
        ));
    }
    sentences
}

/// Times are multiples of a step: nine digits hide the rounding of the product.
fn number(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotors_that_left_together_are_told_together() {
        let outside = |rotor: &str, reason, steps| ValidityViolation {
            rotor: rotor.into(),
            reason,
            steps,
            duration: 0.1 * steps as f64,
            first: 0.30000000000000004,
            last: 1.1,
        };
        let found = [
            outside("/a", Validity::SteepDescent, 3),
            outside("/a", Validity::NegativeThrust, 2),
            outside("/b", Validity::SteepDescent, 3),
            outside("/c", Validity::SteepDescent, 4),
        ];
        assert_eq!(
            words(&found, 20),
            [
                "rotors `/a`, `/b` were outside what the theory holds for (steep descent) in 3 of 20 steps, 0.3 s in all, between 0.3 s \
                 and 1.1 s",
                "rotor `/a` was outside what the theory holds for (negative thrust) in 2 of 20 steps, 0.2 s in all, between 0.3 s and 1.1 s",
                "rotor `/c` was outside what the theory holds for (steep descent) in 4 of 20 steps, 0.4 s in all, between 0.3 s and 1.1 s",
            ]
        );
    }
}
