//! Names for writing a block of the library.

pub(super) use sincro_math::{Real, elementary};

pub(super) use super::{short, short_list};
pub(super) use crate::block::{At, Block, Memory, Node, Ports, SAME_INSTANT, SampleTimeKind, elementwise, fill, of};
pub(super) use crate::kind::{Category, Described, Kind, Parameter, ValueKind};
pub(super) use crate::parameter::*;
pub(super) use crate::reader::{Formula, Matrix, Reader};
pub(super) use crate::unit::{Unit, common};
pub(super) use crate::unit_rule::UnitRule;
pub(super) use crate::{choice, declare_block, declare_parameters};
