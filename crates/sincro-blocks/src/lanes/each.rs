//! Block of a diagram in lanes that computes one lane after the other.

use sincro_math::Real;

use super::{Clock, is_in};
use crate::block::At;
use crate::instance::RunningBlock;
use crate::program::Step;

/// Instances of one block, one for each lane.
pub(super) struct Each {
    instances: Vec<Option<Box<dyn RunningBlock<f64>>>>,
    /// Ranges of the inputs in a list of theirs alone.
    ports: Vec<(u32, u32)>,
}

/// All that a block reads, in lanes.
pub(super) struct Inputs<'a, R> {
    pub signals: &'a [R],
    pub states: &'a [R],
    pub memory: &'a [R],
}

impl<'a, R> Inputs<'a, R> {
    /// Instant of a block that looks at no clock.
    #[inline(always)]
    pub fn at(&self, step: &'a Step) -> At<'a, R> {
        At {
            t: f64::NAN,
            time_event: f64::INFINITY,
            tick: 0,
            node: &step.node,
            states: self.states,
            memory: self.memory,
            signals: self.signals,
            ports: &step.ports,
        }
    }
}

/// Working memory: rows of lanes, and the numbers of one lane.
#[derive(Default)]
pub(super) struct Buffers {
    inputs: Vec<f64>,
    outputs: Vec<f64>,
    of_lane: Vec<f64>,
    new: Vec<f64>,
}

impl Each {
    pub fn new(step: &Step) -> Self {
        let mut start = 0;
        let ports = step.ports.iter().map(|(_, len)| {
            let port = (start, *len);
            start += len;
            port
        });
        Self { ports: ports.collect(), instances: Vec::new() }
    }

    /// Puts an instance into a lane.
    pub fn put(&mut self, lane: usize, instance: Box<dyn RunningBlock<f64>>) {
        if self.instances.len() <= lane {
            self.instances.resize_with(lane + 1, || None);
        }
        self.instances[lane] = Some(instance);
    }

    pub fn instance(&self, lane: usize) -> &dyn RunningBlock<f64> {
        self.instances[lane].as_deref().expect("the lane has begun")
    }

    pub fn instance_mut(&mut self, lane: usize) -> &mut dyn RunningBlock<f64> {
        self.instances[lane].as_deref_mut().expect("the lane has begun")
    }

    /// Lets `act` change `out` in each of the `lanes`.
    #[inline(always)]
    pub fn run<R: Real>(
        &mut self,
        (step, inputs): (&Step, &Inputs<'_, R>),
        (lanes, clocks): (u64, &[Clock]),
        out: [&mut [R]; 2],
        buffers: &mut Buffers,
        act: impl Fn(&mut dyn RunningBlock<f64>, &At<'_, f64>, [&mut [f64]; 2]),
    ) {
        let Buffers { inputs: rows, outputs, of_lane, new } = buffers;
        rows.clear();
        for (start, len) in &step.ports {
            // inputs without direct feedthrough may not be known yet
            let range = *start as usize..(*start + *len) as usize;
            match inputs.signals.get(range) {
                Some(signals) => append(signals, rows),
                None => rows.resize(rows.len() + *len as usize * R::LANES, f64::NAN),
            }
        }
        let n_signals = rows.len() / R::LANES;
        append(inputs.states, rows);
        let n_states = inputs.states.len();
        append(inputs.memory, rows);
        outputs.clear();
        append(out[0], outputs);
        append(out[1], outputs);
        let n_first = out[0].len();
        for (lane, clock) in clocks.iter().enumerate().filter(|(lane, _)| is_in(lanes, *lane)) {
            column(rows, lane, R::LANES, of_lane);
            column(outputs, lane, R::LANES, new);
            let (signals, rest) = of_lane.split_at(n_signals);
            let (states, memory) = rest.split_at(n_states);
            let at = At {
                t: clock.t,
                time_event: clock.time_event,
                tick: clock.tick,
                node: &step.node,
                states,
                memory,
                signals,
                ports: &self.ports,
            };
            let (first, second) = new.split_at_mut(n_first);
            act(self.instances[lane].as_deref_mut().expect("the lane has begun"), &at, [first, second]);
            for (row, x) in outputs.chunks_exact_mut(R::LANES).zip(new.iter()) {
                row[lane] = *x;
            }
        }
        let [first, second] = out;
        for (to, row) in first.iter_mut().chain(second).zip(outputs.chunks_exact(R::LANES)) {
            *to = R::from_row(row);
        }
    }
}

/// Appends a row of lanes for each number.
#[inline(always)]
fn append<R: Real>(numbers: &[R], rows: &mut Vec<f64>) {
    let start = rows.len();
    rows.resize(start + numbers.len() * R::LANES, 0.0);
    for (row, x) in rows[start..].chunks_exact_mut(R::LANES).zip(numbers) {
        x.to_row(row);
    }
}

/// Copies the numbers of one lane.
#[inline(always)]
fn column(rows: &[f64], lane: usize, n_lanes: usize, to: &mut Vec<f64>) {
    to.clear();
    to.extend(rows.iter().skip(lane).step_by(n_lanes));
}
