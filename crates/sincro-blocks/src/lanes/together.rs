//! Block of a diagram in lanes that computes all of them together, compiled for the instruction set of the lanes.

use core::any::Any;
use core::fmt::Debug;
use core::marker::PhantomData;

use sincro_math::lanes::{LaneVisitor, dispatch_lanes};
use sincro_math::{Real, Task};

use super::is_in;
use crate::block::{At, Block, Node};
use crate::instance::{DynBlock, RunningBlock};

/// Instances of blocks for all lanes.
pub(super) struct Together<R>(PhantomData<R>);

impl<R: Real> Together<R> {
    /// Instance of a block on all lanes of `R`; none of one that computes them one after the other.
    pub fn instance(template: &dyn DynBlock) -> Option<Box<dyn RunningBlock<R>>> {
        let instance: Box<Box<dyn RunningBlock<R>>> = template.on_lanes()?.downcast().ok()?;
        Some(*instance)
    }
}

/// Instance of a block that can run on the lanes of this processor, a `Box<dyn RunningBlock<R>>`.
pub(crate) fn on_lanes<B: Block>(block: &B) -> Option<Box<dyn Any>> {
    if block.computes_lanes_together() { dispatch_lanes(Instance { block }) } else { None }
}

struct Instance<'a, B> {
    block: &'a B,
}

impl<B: Block> LaneVisitor for Instance<'_, B> {
    type Output = Option<Box<dyn Any>>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Self::Output {
        if !B::IN_LANES || R::IS_SCALAR {
            return None;
        }
        let instance: Box<dyn RunningBlock<R>> =
            Box::new(RunningInLanes { block: self.block.clone(), work: self.block.work::<R>() });
        Some(Box::new(instance))
    }
}

/// Instance of a block on lanes.
#[derive(Clone, Debug)]
struct RunningInLanes<B: Block, R: Real> {
    block: B,
    work: B::Work<R>,
}

// Calls of a block, compiled for the lanes as a whole. No closures: they would not be inlined.

struct Output<'a, B: Block, R: Real> {
    running: &'a mut RunningInLanes<B, R>,
    at: &'a At<'a, R>,
    y: &'a mut [R],
}

impl<B: Block, R: Real> Task for Output<'_, B, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.running.block.output(self.at, &mut self.running.work, self.y);
    }
}

struct Derivatives<'a, B: Block, R: Real> {
    running: &'a mut RunningInLanes<B, R>,
    at: &'a At<'a, R>,
    derivatives: &'a mut [R],
}

impl<B: Block, R: Real> Task for Derivatives<'_, B, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.running.block.derivatives(self.at, &mut self.running.work, self.derivatives);
    }
}

struct Diagonal<'a, B: Block, R: Real> {
    block: &'a B,
    at: &'a At<'a, R>,
    diagonal: &'a mut [R],
}

impl<B: Block, R: Real> Task for Diagonal<'_, B, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.block.neg_jacobian_diagonal(self.at, self.diagonal);
    }
}

struct Update<'a, B: Block, R: Real> {
    running: &'a mut RunningInLanes<B, R>,
    at: &'a At<'a, R>,
    memory: &'a mut [R],
    states: &'a mut [R],
}

impl<B: Block, R: Real> Task for Update<'_, B, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.running.block.update(self.at, &mut self.running.work, self.memory, self.states);
    }
}

impl<B: Block, R: Real> RunningBlock<R> for RunningInLanes<B, R> {
    fn start(&self, _: &Node, _: &mut [R], _: &mut [R]) {}
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]) {
        R::run_hot(Output { running: self, at, y });
    }
    fn derivatives(&mut self, at: &At<'_, R>, derivatives: &mut [R]) {
        R::run_hot(Derivatives { running: self, at, derivatives });
    }
    fn neg_jacobian_diagonal(&self, at: &At<'_, R>, diagonal: &mut [R]) {
        R::run_hot(Diagonal { block: &self.block, at, diagonal });
    }
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]) {
        R::run_hot(Update { running: self, at, memory, states });
    }
    fn zero_crossings(&mut self, _: &At<'_, R>, _: &mut [R]) {}
    fn scheduled_event(&self, _: &[R]) -> f64 {
        f64::INFINITY
    }
    fn handle_events(&mut self, _: &At<'_, R>, _: (&mut [R], &mut [R]), _: bool) -> bool {
        false
    }
    fn save_outside(&self, _: &[R]) -> Option<Vec<u8>> {
        None
    }
    fn restore_outside(&mut self, _: Option<&[u8]>, _: &[R]) {}
    fn boxed_clone(&self) -> Box<dyn RunningBlock<R>> {
        Box::new(self.clone())
    }
}

/// Puts back those numbers of `x` that are not of the `lanes` among the first `n`.
#[inline(always)]
pub(super) fn select<R: Real>(lanes: u64, n: usize, x: &mut [R], kept: &[R]) {
    if lanes == super::all(n) {
        return;
    }
    for (x, kept) in x.iter_mut().zip(kept) {
        *x = R::from_lanes(|lane| if is_in(lanes, lane) { x.lane(lane) } else { kept.lane(lane) });
    }
}
