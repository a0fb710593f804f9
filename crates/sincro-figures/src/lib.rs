//! Figures and report pages as SVG and HTML text.
//!
//! - [`plot`]: line charts, from plain data;
//! - `draw`: block diagrams in a layered layout;
//! - [`linear`]: Bode diagrams, maps of poles and zeros, step responses and tables of a linear system;
//! - [`report`]: the pages of one run, of two runs and of many, from plain data;
//! - [`campaign`]: from the results of a run to its figures and its page.
//!
//! The same data always give the same bytes. Nothing here writes a file, reads a clock or knows an adapter: the 3-D
//! replay of a page is HTML text that the caller puts in ([`report::Page::replay`]).
//!
//! ```
//! use sincro_figures::plot::{Axis, Figure, Panel, Role, Series, Size, svg};
//!
//! let mut panel = Panel::new(Axis::new("angle", "rad"));
//! panel.series.push(Series::new("hinge", Role::Simulated, vec![0.0, 1.0, 2.0], vec![0.1, 0.3, 0.2]));
//! let figure = Figure { title: "Pendulum".into(), x: Axis::time(), panels: vec![panel], space: None };
//! assert!(svg(&figure, Size::wide(&figure)).starts_with("<svg"));
//! ```

pub mod campaign;
mod draw;
#[cfg(feature = "linear")]
pub mod linear;
pub mod plot;
pub mod report;
