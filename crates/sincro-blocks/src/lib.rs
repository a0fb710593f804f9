//! What diagrams do: blocks with ports, state and sample time, wired into a diagram that runs in lock-step with a world.
//!
//! A [`diagram::Diagram`] is drawn (in Rust here, in TOML through `sincro-sim`), [`compile::compile`]d into a [`program::Program`], and run by a
//! [`runner::Runner`]. The [`library`] has the blocks; whoever needs another one implements [`block::Block`] and [`kind::Described`].
//!
//! # Semantics
//!
//! - **Time** is a tick count times the base step. A block with a sample time is evaluated at multiples of it, which are whole multiples of
//!   the base step; in between its outputs are held (zero-order hold).
//! - **Zero latency.** At a tick, measurements are taken, every block that is due is evaluated once, each after those it depends on, and the
//!   commands act from that same instant on. There is no delay but those that are drawn.
//! - **Direct feed-through.** Most blocks need their inputs at once; `unit-delay`, `integrator`, strictly proper transfer functions and
//!   the like do not. A circle of blocks that all need their inputs at once is an algebraic loop, and an error.
//! - **Continuous** blocks have states that are integrated together with the world, by the same method, with the same error
//!   control. What they depend on is evaluated wherever the integrator looks; sampled blocks hold meanwhile.
//! - **Memory changes at ticks**: once all outputs of a tick are known, delays, counters and hystereses take their new values, for the next
//!   tick. A relay or a rate limiter therefore changes at ticks only, even among continuous blocks.
//! - **Order** is stable: of blocks that could be evaluated next, the one written first.
//!
//! No files, clocks, threads or robots in this crate.

pub mod block;
pub mod compile;
pub mod diagram;
pub mod endpoint;
pub mod instance;
pub mod kind;
pub mod library;
pub mod parameter;
pub mod program;
pub mod reader;
pub mod runner;
pub mod simulator;
pub mod suggest;
pub mod unit;
