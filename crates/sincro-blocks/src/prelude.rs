//! Names for drawing diagrams, running them, and writing blocks: `use sincro_blocks::prelude::*`.

pub use sincro_math::Real;

pub use crate::block::{At, Block, Memory, Node, Ports, SampleTimeKind};
pub use crate::compile::{CompileError, Interface, compile};
pub use crate::diagram::Diagram;
pub use crate::kind::{Category, Described, Kind};
pub use crate::parameter::{Choice, Count, Flag, Limits, Number, PerComponent, Positive, Positives, Text};
pub use crate::reader::{ParameterError, Reader, Value};
pub use crate::runner::Runner;
pub use crate::simulator::Simulator;
pub use crate::unit_rule::UnitRule;
pub use crate::{choice, declare_block};
