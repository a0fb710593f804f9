//! Blocks without their types: what a diagram holds and what a run calls. Who writes a block implements [`Block`]; the
//! rest follows.

use core::any::Any;
use core::fmt::Debug;

use sincro_math::record::Recorded;
use sincro_math::{Dual, Real};

use crate::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
use crate::kind::Kind;
use crate::unit::Unit;
use crate::unit_rule::UnitRule;

/// Kind of numbers on which a diagram can run: `f64` for simulation, `Dual<1>` for derivatives, [`Recorded`] for
/// compilation.
pub trait Number: Real {
    /// Creates an instance of `template` that runs on numbers of this kind.
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

impl Number for Recorded {
    fn instance(template: &dyn DynBlock) -> Box<dyn RunningBlock<Self>> {
        template.on_recorded()
    }
}

/// Block of any kind, as a diagram holds it: [`Block`] without its type. Implemented for every [`Block`].
pub trait DynBlock: Debug + Send + Sync {
    /// Description of the block's kind: name, category, parameters, equation.
    fn kind(&self) -> &'static Kind;
    /// Names of the inputs and outputs; see [`Block::ports`].
    fn ports(&self) -> Ports;
    /// Widths of the outputs, as far as they follow from those of the inputs; see [`Block::widths`].
    ///
    /// # Errors
    ///
    /// A message about widths that do not fit each other.
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String>;
    /// Units of the outputs, as far as they follow from those of the inputs; see [`Block::units`].
    ///
    /// # Errors
    ///
    /// A message about units that do not fit each other.
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String>;
    /// Relation between the units of inputs and outputs; see [`Block::unit_rule`].
    fn unit_rule(&self) -> UnitRule;
    /// Sample time, as far as it follows from kind and parameters; see [`Block::sample_time_kind`].
    fn sample_time_kind(&self) -> SampleTimeKind;
    /// Returns true if the outputs depend on the present value of input port `input` (counted from 0); see
    /// [`Block::has_direct_feedthrough`].
    fn has_direct_feedthrough(&self, input: usize) -> bool;
    /// Numbers of continuous and discrete states; see [`Block::memory`].
    fn memory(&self, node: &Node) -> Memory;
    /// Checks parameters against the compiled diagram; see [`Block::check`].
    ///
    /// # Errors
    ///
    /// Message and help, in this order.
    fn check(&self, node: &Node) -> Result<(), (String, String)>;
    /// First instant after time `t` at which the outputs jump because of time alone `[s]`; see
    /// [`Block::next_time_event`].
    fn next_time_event(&self, t: f64) -> f64;
    /// Number of zero-crossing functions, `None` for blocks without events of their own; see
    /// [`Block::zero_crossing_count`].
    fn zero_crossing_count(&self) -> Option<usize>;
    /// Highest frequency of a source up to time `until` `[s]`, in `[Hz]`; see [`Block::highest_frequency`].
    fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64;
    /// Remark for the report at the end of a run, from the discrete states `memory`; see [`Block::notice`].
    fn notice(&self, node: &Node, memory: &[f64]) -> Option<String>;
    /// Reason for outputs that are not finite, if the block knows one; see [`Block::fault`].
    fn fault(&self) -> Option<String>;
    /// Text in the box of the block in a drawing; see [`Block::label`].
    fn label(&self) -> String;
    /// Creates an instance that runs on `f64`.
    fn on_numbers(&self) -> Box<dyn RunningBlock<f64>>;
    /// Creates an instance that runs on dual numbers, for linearisation.
    fn on_duals(&self) -> Box<dyn RunningBlock<Dual<1>>>;
    /// Creates an instance that runs on recorded numbers, to be compiled.
    fn on_recorded(&self) -> Box<dyn RunningBlock<Recorded>>;
    /// Returns true if the block computes all lanes together: [`Block::IN_LANES`].
    fn computes_lanes_together(&self) -> bool;
    /// Creates an instance that runs on the lanes `R` of this processor, a `Box<dyn RunningBlock<R>>`; `None` if the
    /// block computes them one after the other: [`Block::IN_LANES`].
    fn on_lanes(&self) -> Option<Box<dyn Any>>;
    /// Copy of the block with the same parameters.
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
    fn unit_rule(&self) -> UnitRule {
        Block::unit_rule(self)
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
    fn zero_crossing_count(&self) -> Option<usize> {
        Block::zero_crossing_count(self)
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
    fn on_recorded(&self) -> Box<dyn RunningBlock<Recorded>> {
        Box::new(Running { block: self.clone(), work: self.work() })
    }
    fn computes_lanes_together(&self) -> bool {
        B::IN_LANES && self.runs_in_lanes()
    }
    fn on_lanes(&self) -> Option<Box<dyn Any>> {
        crate::lanes::on_lanes(self)
    }
    fn boxed_clone(&self) -> Box<dyn DynBlock> {
        Box::new(self.clone())
    }
}

/// Instance of a block that runs on numbers of type `R`: parameters and buffers; states are passed to it. Created by
/// [`Number::instance`], called by a [`Runner`](crate::runner::Runner).
pub trait RunningBlock<R>: Debug + Send + Sync {
    /// Writes the initial continuous and discrete states; see [`Block::start`].
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]);
    /// Computes the components of all outputs into `y`; see [`Block::output`].
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]);
    /// Computes the time derivatives of the continuous states; see [`Block::derivatives`].
    fn derivatives(&mut self, at: &At<'_, R>, derivatives: &mut [R]);
    /// Computes the diagonal of `−∂f/∂x` `[1/s]`; see [`Block::neg_jacobian_diagonal`].
    fn neg_jacobian_diagonal(&self, at: &At<'_, R>, diagonal: &mut [R]);
    /// Computes the discrete states of the next tick into `memory`; see [`Block::update`].
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]);
    /// Computes the zero-crossing functions; see [`Block::zero_crossings`].
    fn zero_crossings(&mut self, at: &At<'_, R>, values: &mut [R]);
    /// Next time event that the block has scheduled `[s]`; see [`Block::scheduled_event`].
    fn scheduled_event(&self, memory: &[R]) -> f64;
    /// Handles the events of this instant, with discrete and continuous states; see [`Block::handle_events`].
    fn handle_events(&mut self, at: &At<'_, R>, state: (&mut [R], &mut [R]), is_step_end: bool) -> bool;
    /// State that is kept outside of the diagram; see [`Block::save_outside`].
    fn save_outside(&self, memory: &[R]) -> Option<Vec<u8>>;
    /// Takes it back; see [`Block::restore_outside`].
    fn restore_outside(&mut self, saved: Option<&[u8]>, memory: &[R]);
    /// Copy of the instance with its buffers.
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
    fn zero_crossings(&mut self, at: &At<'_, R>, values: &mut [R]) {
        self.block.zero_crossings(at, &mut self.work, values);
    }
    fn scheduled_event(&self, memory: &[R]) -> f64 {
        self.block.scheduled_event(memory)
    }
    fn handle_events(&mut self, at: &At<'_, R>, state: (&mut [R], &mut [R]), is_step_end: bool) -> bool {
        self.block.handle_events(at, &mut self.work, state, is_step_end)
    }
    fn save_outside(&self, memory: &[R]) -> Option<Vec<u8>> {
        self.block.save_outside(&self.work, memory)
    }
    fn restore_outside(&mut self, saved: Option<&[u8]>, memory: &[R]) {
        self.block.restore_outside(&mut self.work, saved, memory);
    }
    fn boxed_clone(&self) -> Box<dyn RunningBlock<R>> {
        Box::new(self.clone())
    }
}
