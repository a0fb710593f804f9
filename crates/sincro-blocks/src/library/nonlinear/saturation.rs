//! `y = u`, between `lower` and `upper`; counts, if asked to, the ticks at which it limits.
//!
//! Otherwise a command that no actuator can follow is lost in silence: a negative squared speed of a rotor, a torque
//! beyond the motor's.

use crate::library::prelude::*;

declare_block! {
    /// Limits a signal.
    pub struct Saturation("saturation", Nonlinear): "y = min(max(u, lower), upper)" {
        /// Least y.
        pub lower: Vec<f64> as Limits = "-inf",
        /// Greatest y.
        pub upper: Vec<f64> as Limits = "inf",
        /// Counts the ticks at which it limits and reports them at the end of the run.
        pub report: bool as Flag = "false",
    }
}

/// Its memory for each limit, if it counts: how many ticks, the first, its time, the component that was limited then,
/// and what was asked for.
const COUNT: usize = 0;
const FIRST: usize = 1;
const COMPONENT: usize = 2;
const ASKED: usize = 3;
const LAST: usize = 4;
const N_MEMORY: usize = 5;

impl Saturation {
    /// Creates the block with the same limits for all components.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower: vec![lower], upper: vec![upper], report: false }
    }

    #[inline(always)]
    fn limited<R: Real>(&self, u: R, i: usize) -> R {
        u.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)))
    }
}

/// `was limited to its least value once: at t = 0.5 s, where y was to be -3, not 0`.
fn one_side(node: &Node, memory: &[f64], word: &str, bound: &[f64]) -> Option<String> {
    let [ticks, first, component, asked, last] = [COUNT, FIRST, COMPONENT, ASKED, LAST].map(|k| memory[k]);
    if ticks == 0.0 {
        return None;
    }
    let i = component as usize;
    let which = if node.n_out() > 1 { format!("[{i}]") } else { String::new() };
    let (asked, bound) = (short(asked), short(of(bound, i)));
    let place = format!("at t = {first:.6} s, where y{which} was to be {asked}, not {bound}");
    Some(match ticks {
        1.0 => format!("was limited to its {word} value once: {place}"),
        _ => format!("was limited to its {word} value in {ticks} samples: first {place}, last at t = {last:.6} s"),
    })
}

impl Block for Saturation {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    fn runs_in_lanes(&self) -> bool {
        !self.report
    }

    fn validate(&mut self, p: &mut Reader<'_>) {
        super::check_limits(p, &self.lower, &self.upper);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.limited(at.component(0, i), i);
        }
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: 0, discrete: if self.report { 2 * N_MEMORY } else { 0 } }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        if !self.report {
            return;
        }
        let asked = |i: usize| at.component(0, i).lane(0);
        let sides = [
            (0..at.node.n_out()).find(|i| asked(*i) < of(&self.lower, *i)),
            (0..at.node.n_out()).find(|i| asked(*i) > of(&self.upper, *i)),
        ];
        for (side, i) in sides.into_iter().enumerate().filter_map(|(side, i)| Some((side, i?))) {
            let memory = &mut memory[side * N_MEMORY..][..N_MEMORY];
            if memory[COUNT].lane(0) == 0.0 {
                memory[FIRST] = R::splat(at.t);
                memory[COMPONENT] = R::splat(i as f64);
                memory[ASKED] = R::splat(asked(i));
            }
            memory[COUNT] += R::splat(1.0);
            memory[LAST] = R::splat(at.t);
        }
    }

    fn notice(&self, node: &Node, memory: &[f64]) -> Option<String> {
        let sides = memory.chunks_exact(N_MEMORY).zip([("least", &self.lower), ("greatest", &self.upper)]);
        let told: Vec<String> =
            sides.filter_map(|(memory, (word, bound))| one_side(node, memory, word, bound)).collect();
        (!told.is_empty()).then(|| told.join("; "))
    }

    fn label(&self) -> String {
        format!("{} … {}", short_list(&self.lower), short_list(&self.upper))
    }
}
