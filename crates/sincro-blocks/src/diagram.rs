//! A diagram as it is drawn: named blocks and wires between their ports.
//!
//! ```
//! use sincro_blocks::diagram::Diagram;
//! use sincro_blocks::library::continuous::Integrator;
//! use sincro_blocks::library::maths::{Gain, Sum};
//! use sincro_blocks::library::sources::Constant;
//! use sincro_blocks::compile::{Interface, compile};
//!
//! // x' = 2 (1 − x)
//! let mut diagram = Diagram::new();
//! diagram.block("target", Constant::new(1.0));
//! diagram.block("error", Sum::new("+-"));
//! diagram.block("rate", Gain::new(2.0));
//! diagram.block("x", Integrator::new(0.0));
//! diagram.wire("target", "error.u1").wire("error", "rate").wire("rate", "x").wire("x", "error.u2");
//! let program = compile(&diagram, &Interface::new(0.001)).unwrap();
//! assert_eq!(program.order(), ["target", "x", "error", "rate"]);
//! ```

use crate::endpoint::Endpoint;
use crate::instance::DynBlock;

/// Block diagram: blocks and wires, on its own or nested in another diagram. Compiled by
/// [`compile`](crate::compile::compile).
///
/// ```
/// use sincro_blocks::library::continuous::Integrator;
/// use sincro_blocks::library::maths::Gain;
/// use sincro_blocks::prelude::*;
///
/// // a harmonic oscillator: x' = v, v' = −4 x
/// let mut diagram = Diagram::new();
/// diagram.block("x", Integrator::new(1.0)).block("v", Integrator::new(0.0)).block("stiffness", Gain::new(-4.0));
/// diagram.wire("v", "x").wire("x", "stiffness").wire("stiffness", "v");
/// let x = Simulator::new(&diagram, 0.001)?.record("x", 1000);
/// assert!((x[1000] - f64::cos(2.0)).abs() < 1e-10); // cos(ω t), ω = 2 rad/s, t = 1 s
/// # Ok::<(), CompileError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Diagram {
    /// Blocks and inner diagrams, in the order in which they were added, which decides among blocks that could be
    /// evaluated in any order.
    pub entries: Vec<Entry>,
    /// Wires, in the order in which they were added.
    pub wires: Vec<Wire>,
    /// Names of its input ports, if it is nested in another diagram.
    pub inputs: Vec<String>,
    /// Names of its output ports.
    pub outputs: Vec<String>,
}

/// Entry of a diagram: a block or inner diagram with its name, sample time and unit.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Name, unique in the diagram: letters, digits, `_` and `-`.
    pub name: String,
    /// Block or inner diagram.
    pub content: Content,
    /// Sample time `[s]` of the block, or of all blocks in an inner diagram that have none of their own; `None` to
    /// inherit it.
    pub sample_time: Option<f64>,
    /// Unit of the outputs, such as `N·m`, or one unit for each component of the outputs, one after the other; empty
    /// if none is declared.
    pub unit: Vec<String>,
}

/// Content of an [`Entry`].
#[derive(Clone, Debug)]
pub enum Content {
    /// Block of a kind of the library, or of one's own.
    Block(Box<dyn DynBlock>),
    /// Inner diagram: name of its definition, and the diagram.
    Diagram(String, Box<Diagram>),
}

/// Wire of a diagram: one or several sources, and a target.
#[derive(Clone, Debug)]
pub struct Wire {
    /// Sources; several are concatenated to one vector, in this order.
    pub from: Vec<Endpoint>,
    /// Target: an input port.
    pub to: Endpoint,
}

impl Diagram {
    /// Creates an empty diagram.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a block under a name that no other entry has; it is continuous, or takes the sample time of its inputs.
    pub fn block(&mut self, name: &str, block: impl DynBlock + 'static) -> &mut Self {
        self.add(name, Content::Block(Box::new(block)), None)
    }

    /// Adds a block with a sample time `[s]`, which must be a multiple of the base step.
    ///
    /// ```
    /// use sincro_blocks::library::maths::Gain;
    /// use sincro_blocks::library::sources::Ramp;
    /// use sincro_blocks::prelude::*;
    ///
    /// let mut diagram = Diagram::new();
    /// diagram.block("ramp", Ramp::new(1.0)).sampled("held", 0.02, Gain::new(1.0)).wire("ramp", "held");
    /// let held = Simulator::new(&diagram, 0.01)?.record("held", 4);
    /// assert_eq!(held, [0.0, 0.0, 0.02, 0.02, 0.04]);
    /// # Ok::<(), CompileError>(())
    /// ```
    pub fn sampled(&mut self, name: &str, sample_time: f64, block: impl DynBlock + 'static) -> &mut Self {
        self.add(name, Content::Block(Box::new(block)), Some(sample_time))
    }

    /// Adds a diagram as a block, named `name`; its ports are its `inputs` and `outputs`. `sample_time` `[s]` is that
    /// of all blocks in it that have none of their own, `None` to inherit it.
    ///
    /// ```
    /// use sincro_blocks::library::maths::Gain;
    /// use sincro_blocks::library::sources::Constant;
    /// use sincro_blocks::prelude::*;
    ///
    /// let mut degrees = Diagram { inputs: vec!["rad".into()], outputs: vec!["deg".into()], ..Diagram::new() };
    /// degrees.block("factor", Gain::new(180.0 / std::f64::consts::PI)).wire("rad", "factor").wire("factor", "deg");
    /// let mut diagram = Diagram::new();
    /// diagram.block("angle", Constant::new(std::f64::consts::PI)).diagram("degrees", degrees, None);
    /// diagram.wire("angle", "degrees.rad");
    /// assert_eq!(Simulator::new(&diagram, 0.001)?.output("degrees/factor"), [180.0]);
    /// # Ok::<(), CompileError>(())
    /// ```
    pub fn diagram(&mut self, name: &str, inner: Self, sample_time: Option<f64>) -> &mut Self {
        self.add(name, Content::Diagram(name.to_owned(), Box::new(inner)), sample_time)
    }

    /// Adds a block or an inner diagram under a name that no other entry has; `sample_time` is its own `[s]`, `None` to
    /// inherit it.
    pub fn add(&mut self, name: &str, content: Content, sample_time: Option<f64>) -> &mut Self {
        self.entries.push(Entry { name: name.to_owned(), content, sample_time, unit: Vec::new() });
        self
    }

    /// Adds a wire between endpoints as [`Endpoint::parse`] reads them, such as `"pid"` to `"/motor"`, `"plant.x[0]"`
    /// to `"error.u2"`, `"[a, b]"` to `"norm"`.
    ///
    /// # Panics
    ///
    /// If a text is not an endpoint: this is for diagrams written in Rust. Unknown names are errors of the compiler.
    pub fn wire(&mut self, from: &str, to: &str) -> &mut Self {
        let from = Endpoint::parse_list(from).unwrap_or_else(|e| panic!("`{from}`: {}", e.message));
        let to = Endpoint::parse(to).unwrap_or_else(|e| panic!("`{to}`: {}", e.message));
        self.wires.push(Wire { from, to });
        self
    }

    /// Entry of that name; `None` if there is none.
    #[must_use]
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }
}
