//! What can be said of a kind of block: for schemas, for the reference in the documentation, for messages.

use crate::reader::Reader;

/// A block that says what it is and can be made from named parameters.
pub trait Described: Sized {
    /// Its description.
    const KIND: &'static Kind;

    /// The block for a set of parameters. What is wrong with them is noted in the reader; the block is then not used.
    fn read(parameters: &mut Reader<'_>) -> Self;
}

/// Description of a kind of block.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name in files, such as `transfer-function`.
    pub name: &'static str,
    /// The shelf of the library it stands on.
    pub group: Group,
    /// One sentence, in the user's words.
    pub summary: &'static str,
    /// Its equation, with the names of ports and parameters.
    pub equation: &'static str,
    /// What can be given.
    pub parameters: &'static [Parameter],
}

/// Shelves of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Group {
    Sources,
    Maths,
    Nonlinear,
    Continuous,
    Discrete,
    Routing,
    Logic,
    Rotations,
    Robot,
    Scripts,
    Sinks,
}

impl Group {
    /// As a heading.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Sources => "Sources",
            Self::Maths => "Maths",
            Self::Nonlinear => "Nonlinear",
            Self::Continuous => "Continuous",
            Self::Discrete => "Discrete",
            Self::Routing => "Routing",
            Self::Logic => "Logic and comparison",
            Self::Rotations => "Rotations",
            Self::Robot => "Robot",
            Self::Scripts => "Scripts",
            Self::Sinks => "Sinks",
        }
    }
}

/// A parameter of a kind of block.
#[derive(Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its key.
    pub name: &'static str,
    /// What it takes.
    pub takes: Takes,
    /// What it means, with its unit in brackets.
    pub meaning: &'static str,
    /// As it would be written; `None` if it must be given.
    pub default: Option<&'static str>,
}

/// What a parameter takes. Wherever a number stands, a formula of the diagram's parameters may stand as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A number.
    Number,
    /// A number greater than zero.
    Positive,
    /// A whole number from 0 on.
    Count,
    /// A number for all components, or one for each.
    Numbers,
    /// Rows of numbers.
    Matrix,
    /// True or false.
    Flag,
    /// A text.
    Text,
    /// A list of texts.
    Texts,
    /// Names and what they stand for: numbers or formulas.
    Names,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A file of the scene folder.
    File,
}

impl Parameter {
    /// One that must be given.
    #[must_use]
    pub const fn required(name: &'static str, takes: Takes, meaning: &'static str) -> Self {
        Self { name, takes, meaning, default: None }
    }

    /// One with a default.
    #[must_use]
    pub const fn optional(name: &'static str, takes: Takes, meaning: &'static str, default: &'static str) -> Self {
        Self { name, takes, meaning, default: Some(default) }
    }
}
