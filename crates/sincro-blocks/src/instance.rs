//! Blocks without their types: what a diagram holds and what a run calls.

use core::fmt::Debug;

use sincro_math::{Dual, Real};

use crate::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use crate::kind::Kind;
use crate::unit::Unit;

/// The numbers that a diagram can run on.
pub trait Number: Real {
    /// A block that runs on them.
    fn instance(template: &dyn DynBlock) -> Box<dyn RunningBlock<Self>>;
}

impl Number for f64 {
    fn instance(template: &dyn DynBlock) -> Box<dyn RunningBlock<Self>> {
        template.on_numbers()
    }
}

impl Number for Dual<1> {
    fn instance(template: &dyn DynBlock) -> Box<dyn RunningBlock<Self>> {
        template.on_duals()
    }
}

/// A block of any kind, as it stands in a diagram. Implemented for every [`Block`] that is [`Described`].
#[allow(missing_docs)] // the verbs of `Block`
pub trait DynBlock: Debug + Send + Sync {
    fn kind(&self) -> &'static Kind;
    fn ports(&self) -> Ports;
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String>;
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String>;
    fn sample_time_kind(&self) -> SampleTimeKind;
    fn has_direct_feedthrough(&self, input: usize) -> bool;
    fn memory(&self, node: &Node) -> Memory;
    fn check(&self, node: &Node) -> Result<(), (String, String)>;
    fn next_time_event(&self, t: f64) -> f64;
    fn notice(&self, node: &Node, memory: &[f64]) -> Option<String>;
    fn fault(&self) -> Option<String>;
    fn label(&self) -> String;
    fn on_numbers(&self) -> Box<dyn RunningBlock<f64>>;
    fn on_duals(&self) -> Box<dyn RunningBlock<Dual<1>>>;
    fn boxed_clone(&self) -> Box<dyn DynBlock>;
}

impl Clone for Box<dyn DynBlock> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

impl<B: Block> DynBlock for B {
    fn kind(&self) -> &'static Kind {
        B::KIND
    }
    fn ports(&self) -> Ports {
        Block::ports(self)
    }
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Block::widths(self, inputs)
    }
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Block::units(self, inputs)
    }
    fn sample_time_kind(&self) -> SampleTimeKind {
        Block::sample_time_kind(self)
    }
    fn has_direct_feedthrough(&self, input: usize) -> bool {
        Block::has_direct_feedthrough(self, input)
    }
    fn memory(&self, node: &Node) -> Memory {
        Block::memory(self, node)
    }
    fn check(&self, node: &Node) -> Result<(), (String, String)> {
        Block::check(self, node)
    }
    fn next_time_event(&self, t: f64) -> f64 {
        Block::next_time_event(self, t)
    }
    fn notice(&self, node: &Node, memory: &[f64]) -> Option<String> {
        Block::notice(self, node, memory)
    }
    fn fault(&self) -> Option<String> {
        Block::fault(self)
    }
    fn label(&self) -> String {
        Block::label(self)
    }
    fn on_numbers(&self) -> Box<dyn RunningBlock<f64>> {
        Box::new(Running { block: self.clone(), work: self.work() })
    }
    fn on_duals(&self) -> Box<dyn RunningBlock<Dual<1>>> {
        Box::new(Running { block: self.clone(), work: self.work() })
    }
    fn boxed_clone(&self) -> Box<dyn DynBlock> {
        Box::new(self.clone())
    }
}

/// A block that runs on numbers of type `R`.
#[allow(missing_docs)] // the verbs of `Block`
pub trait RunningBlock<R>: Debug + Send + Sync {
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]);
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]);
    fn derivatives(&mut self, at: &At<'_, R>, derivatives: &mut [R]);
    fn neg_jacobian_diagonal(&self, at: &At<'_, R>, diagonal: &mut [R]);
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]);
    fn boxed_clone(&self) -> Box<dyn RunningBlock<R>>;
}

impl<R: Real> Clone for Box<dyn RunningBlock<R>> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

#[derive(Clone, Debug)]
struct Running<B: Block, R: Real> {
    block: B,
    work: B::Work<R>,
}

impl<B: Block, R: Real> RunningBlock<R> for Running<B, R> {
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]) {
        self.block.start(node, states, memory);
    }
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]) {
        self.block.output(at, &mut self.work, y);
    }
    fn derivatives(&mut self, at: &At<'_, R>, derivatives: &mut [R]) {
        self.block.derivatives(at, &mut self.work, derivatives);
    }
    fn neg_jacobian_diagonal(&self, at: &At<'_, R>, diagonal: &mut [R]) {
        self.block.neg_jacobian_diagonal(at, diagonal);
    }
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]) {
        self.block.update(at, &mut self.work, memory, states);
    }
    fn boxed_clone(&self) -> Box<dyn RunningBlock<R>> {
        Box::new(self.clone())
    }
}
