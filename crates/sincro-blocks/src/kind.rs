//! Descriptions of kinds of blocks: what schemas, the reference in the documentation and messages are derived from.

use std::collections::BTreeMap;

use crate::reader::{NoFiles, Reader, Value};

/// Block type with a description of its kind, that can be made from named parameters.
///
/// [`declare_block!`](crate::declare_block) implements it.
///
/// ```
/// use sincro_blocks::library::nonlinear::Saturation;
/// use sincro_blocks::prelude::*;
///
/// // what a file format needs: the name of the block and those of its parameters
/// let names: Vec<&str> = Saturation::KIND.parameters.iter().map(|parameter| parameter.name).collect();
/// assert_eq!((Saturation::KIND.name, names), ("saturation", vec!["lower", "upper", "report"]));
/// ```
pub trait Described: Sized {
    /// Description of the kind of block.
    const KIND: &'static Kind;

    /// Names and lengths of the parameters that are one number for all components or one for each; by default none.
    fn parameter_widths(&self) -> Vec<(&'static str, usize)> {
        Vec::new()
    }

    /// Creates the block from a set of parameters. Errors in them are noted in the reader ([`Reader::finish`] returns
    /// them); the block is then not to be used.
    fn read(parameters: &mut Reader<'_>) -> Self;

    /// Block with all parameters at their defaults; those without a default are NaN, 1 or empty, and still to be set.
    #[must_use]
    fn with_defaults() -> Self {
        static NOTHING: BTreeMap<String, Value> = BTreeMap::new();
        static NO_SCOPE: BTreeMap<String, f64> = BTreeMap::new();
        Self::read(&mut Reader::new(Self::KIND, &NOTHING, &NO_SCOPE, &NoFiles))
    }
}

/// Description of a kind of block: the source of schemas, reference documentation and messages.
///
/// ```
/// use sincro_blocks::library::continuous::Integrator;
/// use sincro_blocks::prelude::*;
///
/// let kind: &Kind = Integrator::KIND;
/// assert_eq!((kind.name, kind.category), ("integrator", Category::Continuous));
/// assert!(kind.parameters.iter().any(|parameter| parameter.name == "initial" && parameter.default == Some("0")));
/// ```
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// Name in files, such as `transfer-function`.
    pub name: &'static str,
    /// Category of the library.
    pub category: Category,
    /// Summary in one sentence.
    pub summary: &'static str,
    /// Equation, with the names of ports and parameters.
    pub equation: &'static str,
    /// Parameters, in the order of the reference documentation.
    pub parameters: &'static [Parameter],
}

/// Category of a kind of block, which orders the library and its reference documentation.
///
/// ```
/// use sincro_blocks::library::continuous::Pid;
/// use sincro_blocks::prelude::*;
///
/// assert_eq!(Pid::KIND.category, Category::Continuous);
/// assert_eq!(Category::Logic.title(), "Logic and comparison");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Category {
    /// Signals that depend on time alone.
    Sources,
    /// Functions of signals without memory.
    Maths,
    /// Products and composition of matrices.
    Matrices,
    /// Limits, dead zones, hysteresis, tables.
    Nonlinear,
    /// Blocks with continuous states: integrators, transfer functions, PID.
    Continuous,
    /// Blocks with discrete states: delays, filters, discrete PID.
    Discrete,
    /// Adaptive laws.
    Adaptation,
    /// Composition and selection of signals.
    Routing,
    /// Comparison, logic and counting.
    Logic,
    /// Quaternions, rotation matrices, Euler angles.
    Rotations,
    /// Functions of the robot's model.
    Robot,
    /// Blocks written as scripts or taken from other programs.
    Scripts,
    /// Plots and terminations.
    Sinks,
}

impl Category {
    /// Title of the category for headings, such as `Logic and comparison`.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Sources => "Sources",
            Self::Maths => "Maths",
            Self::Matrices => "Matrices",
            Self::Nonlinear => "Nonlinear",
            Self::Continuous => "Continuous",
            Self::Discrete => "Discrete",
            Self::Adaptation => "Adaptation",
            Self::Routing => "Routing",
            Self::Logic => "Logic and comparison",
            Self::Rotations => "Rotations",
            Self::Robot => "Robot",
            Self::Scripts => "Scripts",
            Self::Sinks => "Sinks",
        }
    }
}

/// Description of a parameter of a kind of block; entry of [`Kind::parameters`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Key in files.
    pub name: &'static str,
    /// Type and range of the value.
    pub takes: ValueKind,
    /// Meaning, with its unit in brackets, as a phrase or as the sentence of a doc comment; see [`Parameter::meaning`].
    pub doc: &'static str,
    /// Default as it would be written; `None` if the parameter must be given.
    pub default: Option<&'static str>,
}

/// Type and range of a parameter's value. Where a number stands, a formula of the diagram's parameters may stand as
/// text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// Finite number.
    Number,
    /// Finite number greater than zero.
    Positive,
    /// Whole number from 0 on.
    Count,
    /// One number for all components, or a list of one for each.
    Numbers,
    /// List of rows of numbers.
    Matrix,
    /// True or false.
    Flag,
    /// Text.
    Text,
    /// List of texts.
    Texts,
    /// Table of names with numbers or formulas.
    Names,
    /// Table of names with numbers or lists of numbers.
    NumberLists,
    /// One of the listed words.
    Choice(&'static [&'static str]),
    /// Name of a file in the folder of the scene.
    File,
}

impl Parameter {
    /// Description of a parameter that must be given: key, type, and meaning with its unit in brackets.
    #[must_use]
    pub const fn required(name: &'static str, takes: ValueKind, doc: &'static str) -> Self {
        Self { name, takes, doc, default: None }
    }

    /// Description of a parameter with a default, written as in a file: key, type, meaning with its unit in brackets.
    #[must_use]
    pub const fn optional(name: &'static str, takes: ValueKind, doc: &'static str, default: &'static str) -> Self {
        Self { name, takes, doc, default: Some(default) }
    }

    /// Meaning as a phrase for tables and messages: the sentence ``Instant of the jump `[s]`.`` becomes
    /// `instant of the jump [s]`; a text that is no sentence stays as it is.
    #[must_use]
    pub fn meaning(&self) -> String {
        let Some(sentence) = self.doc.strip_suffix('.') else { return self.doc.to_owned() };
        let mut phrase = String::new();
        let mut rest = sentence;
        while let Some((before, unit, after)) =
            rest.split_once("`[").and_then(|(before, rest)| rest.split_once("]`").map(|(u, after)| (before, u, after)))
        {
            phrase += &format!("{before}[{unit}]");
            rest = after;
        }
        phrase += rest;
        let mut letters = phrase.chars();
        match (letters.next(), letters.next()) {
            (Some(first), second) if first.is_ascii_uppercase() && !second.is_some_and(char::is_uppercase) => {
                first.to_ascii_lowercase().to_string() + &phrase[1..]
            }
            _ => phrase,
        }
    }
}

/// Declares a block: its struct, its description, and how it is read from parameters, each parameter in one place.
///
/// ```
/// # use sincro_blocks::{block::Block, declare_block, kind::Described, parameter::{Flag, PerComponent}};
/// declare_block! {
///     /// Multiplies by a constant.
///     ///
///     /// The first line is the summary in the reference of all blocks.
///     pub struct Amplifier("amplifier", Maths): "y = gain·u" {
///         /// Factor `[unit of y / unit of u]`, one for all components or one for each.
///         pub gain: Vec<f64> as PerComponent,
///         /// Changes the sign.
///         pub inverting: bool as Flag = "false",
///     }
/// }
/// # impl Block for Amplifier {
/// #     type Work<R: sincro_math::Real> = ();
/// #     fn output<R: sincro_math::Real>(&self, _: &sincro_blocks::block::At<'_, R>, (): &mut (), _: &mut [R]) {}
/// # }
/// let parameter = &Amplifier::KIND.parameters[0];
/// assert_eq!(parameter.meaning(), "factor [unit of y / unit of u], one for all components or one for each");
/// assert_eq!((parameter.default, Amplifier::KIND.parameters[1].default), (None, Some("false")));
/// ```
///
/// After `as` stands the type and range of a parameter, from [`parameter`](crate::parameter); after `=` its default as
/// it would be written in a file. Without a default a parameter must be given. Parameters are checked against each
/// other in [`Block::validate`](crate::block::Block::validate), which also computes fields that are derived from them,
/// declared as `with { name: Type = initial_value, … }` after the parameters.
#[macro_export]
macro_rules! declare_block {
    (
        #[doc = $summary:literal] $(#[$attribute:meta])*
        $visibility:vis struct $block:ident($name:literal, $category:ident): $equation:literal;
    ) => {
        #[doc = $summary] $(#[$attribute])*
        ///
        #[doc = concat!("`", $equation, "`")]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        $visibility struct $block;

        impl $crate::kind::Described for $block {
            const KIND: &'static $crate::kind::Kind = &$crate::kind::Kind {
                name: $name,
                category: $crate::kind::Category::$category,
                summary: ($summary as &str).trim_ascii(),
                equation: $equation,
                parameters: &[],
            };

            fn read(_: &mut $crate::reader::Reader<'_>) -> Self {
                Self
            }
        }
    };
    (
        #[doc = $summary:literal] $(#[$attribute:meta])*
        $visibility:vis struct $block:ident($name:literal, $category:ident): $equation:literal {
            $($(#[doc = $doc:literal])+ $parameter_visibility:vis $parameter:ident: $type:ty as $takes:ty $(= $default:literal)?),* $(,)?
        }
        $(with { $($(#[$field_attribute:meta])* $field_visibility:vis $field:ident: $field_type:ty = $initial:expr),* $(,)? })?
    ) => {
        $crate::declare_parameters! {
            #[doc = $summary] $(#[$attribute])*
            #[doc = ""]
            #[doc = concat!("`", $equation, "`")]
            $visibility struct $block {
                $($(#[doc = $doc])+ $parameter_visibility $parameter: $type as $takes $(= $default)?),*
            }
            $(with { $($(#[$field_attribute])* $field_visibility $field: $field_type = $initial),* })?
        }

        impl $crate::kind::Described for $block {
            const KIND: &'static $crate::kind::Kind = &$crate::kind::Kind {
                name: $name,
                category: $crate::kind::Category::$category,
                summary: ($summary as &str).trim_ascii(),
                equation: $equation,
                parameters: <Self as $crate::parameter::ParameterSet>::PARAMETERS,
            };

            fn parameter_widths(&self) -> Vec<(&'static str, usize)> {
                $crate::parameter::ParameterSet::widths(self)
            }

            fn read(reader: &mut $crate::reader::Reader<'_>) -> Self {
                let mut new = <Self as $crate::parameter::ParameterSet>::read(reader);
                $crate::block::Block::validate(&mut new, reader);
                new
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_becomes_a_phrase_and_a_phrase_stays() {
        let meaning = |doc: &'static str| Parameter::required("x", ValueKind::Number, doc).meaning();
        assert_eq!(meaning("Instant of the jump `[s]`."), "instant of the jump [s]");
        assert_eq!(meaning("CSV file `[a]` beside `y[3]`."), "CSV file [a] beside `y[3]`");
        assert_eq!(meaning("Lua text with `y[3]`"), "Lua text with `y[3]`");
    }
}
