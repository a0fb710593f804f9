//! Blocks without their types: what a diagram holds and what a run calls. Who writes a block implements [`Block`]; the
//! rest follows.

use core::fmt::Debug;

use sincro_math::{Dual, Real};

use crate::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use crate::kind::Kind;
use crate::unit::Unit;

/// The kinds of numbers on which a diagram can run: `f64`, and `Dual<1>` for derivatives.
pub trait Number: Real {
    /// Instance of a block that runs on numbers of this kind.
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

/// A block of any type, as it stands in a diagram. Implemented for every [`Block`].
pub trait DynBlock: Debug + Send + Sync {
    /// Description of the block's kind: name, parameters, equation.
    fn kind(&self) -> &'static Kind;
    /// Names of the inputs and outputs; see [`Block::ports`].
    fn ports(&self) -> Ports;
    /// Widths of the outputs; see [`Block::widths`].
    ///
    /// # Errors
    ///
    /// Widths that do not fit each other, in words.
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String>;
    /// Units of the outputs; see [`Block::units`].
    ///
    /// # Errors
    ///
    /// Units that do not fit each other, in words.
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String>;
    /// Sample time, as far as it follows from kind and parameters; see [`Block::sample_time_kind`].
    fn sample_time_kind(&self) -> SampleTimeKind;
    /// Returns true if the outputs depend on the present value of an input; see [`Block::has_direct_feedthrough`].
    fn has_direct_feedthrough(&self, input: usize) -> bool;
    /// Number of states; see [`Block::memory`].
    fn memory(&self, node: &Node) -> Memory;
    /// Checks parameters against the compiled diagram; see [`Block::check`].
    ///
    /// # Errors
    ///
    /// The error, and a help for it.
    fn check(&self, node: &Node) -> Result<(), (String, String)>;
    /// Next time event after `t` `[s]`; see [`Block::next_time_event`].
    fn next_time_event(&self, t: f64) -> f64;
    /// Highest frequency of a source `[Hz]`; see [`Block::highest_frequency`].
    fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64;
    /// Remark for the end of a run; see [`Block::notice`].
    fn notice(&self, node: &Node, memory: &[f64]) -> Option<String>;
    /// Reason for outputs that are not finite; see [`Block::fault`].
    fn fault(&self) -> Option<String>;
    /// Text in its box in a drawing; see [`Block::label`].
    fn label(&self) -> String;
    /// Instance of the block that runs on `f64`, in its initial state.
    fn on_numbers(&self) -> Box<dyn RunningBlock<f64>>;
    /// Instance that runs on dual numbers.
    fn on_duals(&self) -> Box<dyn RunningBlock<Dual<1>>>;
    /// A copy.
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
    fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64 {
        Block::highest_frequency(self, until, is_sampled)
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
pub trait RunningBlock<R>: Debug + Send + Sync {
    /// Writes the initial states; see [`Block::start`].
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]);
    /// Computes the outputs; see [`Block::output`].
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]);
    /// Computes the derivatives of the continuous states; see [`Block::derivatives`].
    fn derivatives(&mut self, at: &At<'_, R>, derivatives: &mut [R]);
    /// Diagonal of `−∂f/∂x` [1/s]; see [`Block::neg_jacobian_diagonal`].
    fn neg_jacobian_diagonal(&self, at: &At<'_, R>, diagonal: &mut [R]);
    /// Computes the discrete states of the next tick; see [`Block::update`].
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]);
    /// A copy.
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
