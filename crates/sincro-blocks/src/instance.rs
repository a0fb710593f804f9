//! Blocks without their types: what a diagram holds and what a run calls.

use core::fmt::Debug;

use sincro_math::{Dual, Real};

use crate::block::{At, Block, Memory, Node, Pace, Ports};
use crate::kind::{Described, Kind};
use crate::unit::Unit;

/// The numbers that a diagram can run on.
pub trait Number: Real {
    /// A block that runs on them.
    fn instance(template: &dyn Template) -> Box<dyn Instance<Self>>;
}

impl Number for f64 {
    fn instance(template: &dyn Template) -> Box<dyn Instance<Self>> {
        template.on_numbers()
    }
}

impl Number for Dual<1> {
    fn instance(template: &dyn Template) -> Box<dyn Instance<Self>> {
        template.on_duals()
    }
}

/// A block of any kind, as it stands in a diagram. Implemented for every [`Block`] that is [`Described`].
#[allow(missing_docs)] // the verbs of `Block`
pub trait Template: Debug + Send + Sync {
    fn kind(&self) -> &'static Kind;
    fn ports(&self) -> Ports;
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String>;
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String>;
    fn pace(&self) -> Pace;
    fn feeds_through(&self, input: usize) -> bool;
    fn memory(&self, node: &Node) -> Memory;
    fn check(&self, node: &Node) -> Result<(), (String, String)>;
    fn next_corner(&self, t: f64) -> f64;
    fn fault(&self) -> Option<String>;
    fn label(&self) -> String;
    fn on_numbers(&self) -> Box<dyn Instance<f64>>;
    fn on_duals(&self) -> Box<dyn Instance<Dual<1>>>;
    fn boxed_clone(&self) -> Box<dyn Template>;
}

impl Clone for Box<dyn Template> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

impl<B: Block + Described> Template for B {
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
    fn pace(&self) -> Pace {
        Block::pace(self)
    }
    fn feeds_through(&self, input: usize) -> bool {
        Block::feeds_through(self, input)
    }
    fn memory(&self, node: &Node) -> Memory {
        Block::memory(self, node)
    }
    fn check(&self, node: &Node) -> Result<(), (String, String)> {
        Block::check(self, node)
    }
    fn next_corner(&self, t: f64) -> f64 {
        Block::next_corner(self, t)
    }
    fn fault(&self) -> Option<String> {
        Block::fault(self)
    }
    fn label(&self) -> String {
        Block::label(self)
    }
    fn on_numbers(&self) -> Box<dyn Instance<f64>> {
        Box::new(Running { block: self.clone(), work: self.work() })
    }
    fn on_duals(&self) -> Box<dyn Instance<Dual<1>>> {
        Box::new(Running { block: self.clone(), work: self.work() })
    }
    fn boxed_clone(&self) -> Box<dyn Template> {
        Box::new(self.clone())
    }
}

/// A block that runs on numbers of type `R`.
#[allow(missing_docs)] // the verbs of `Block`
pub trait Instance<R>: Debug + Send + Sync {
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]);
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]);
    fn slope(&mut self, at: &At<'_, R>, slope: &mut [R]);
    fn decay(&self, at: &At<'_, R>, decay: &mut [R]);
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]);
    fn boxed_clone(&self) -> Box<dyn Instance<R>>;
}

impl<R: Real> Clone for Box<dyn Instance<R>> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

#[derive(Clone, Debug)]
struct Running<B: Block, R: Real> {
    block: B,
    work: B::Work<R>,
}

impl<B: Block, R: Real> Instance<R> for Running<B, R> {
    fn start(&self, node: &Node, states: &mut [R], memory: &mut [R]) {
        self.block.start(node, states, memory);
    }
    fn output(&mut self, at: &At<'_, R>, y: &mut [R]) {
        self.block.output(at, &mut self.work, y);
    }
    fn slope(&mut self, at: &At<'_, R>, slope: &mut [R]) {
        self.block.slope(at, &mut self.work, slope);
    }
    fn decay(&self, at: &At<'_, R>, decay: &mut [R]) {
        self.block.decay(at, decay);
    }
    fn update(&mut self, at: &At<'_, R>, memory: &mut [R], states: &mut [R]) {
        self.block.update(at, &mut self.work, memory, states);
    }
    fn boxed_clone(&self) -> Box<dyn Instance<R>> {
        Box::new(self.clone())
    }
}
