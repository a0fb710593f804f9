//! Types and ranges of parameters, for declarations of blocks: after `as` in [`declare_block!`](crate::declare_block).
//!
//! | type | field | values |
//! |---|---|---|
//! | [`Number`] | `f64` | finite |
//! | [`Limit`] | `f64` | may be infinite |
//! | [`Positive`] | `f64` | greater than 0 |
//! | [`Count`], [`PositiveCount`] | `usize` | whole, from 0 or 1 on |
//! | [`InputCount`], [`PortCount`] | `usize` | whole, from 1 to 1000 or 10 000 |
//! | [`PerComponent`], [`Limits`], [`Positives`] | `Vec<f64>` | one for all or one for each; finite, any, > 0 |
//! | [`List`] | `Vec<f64>` | numbers with a meaning of their own, such as coefficients |
//! | [`Rows`] | [`Matrix`] | rows of numbers |
//! | [`Flag`] | `bool` | true or false |
//! | [`Text`], [`File`] | `String` | a text, a file of the scene folder |
//! | [`Texts`] | `Vec<String>` | texts |
//! | [`Choice`] | an enum of [`choice!`](crate::choice) | one of its words |
//! | [`OptionalParameter`] | `Option` of another type | `None` if it is left out |

use crate::kind::{Parameter, ValueKind};
use crate::reader::{Matrix, Reader};

/// Type and range of a parameter that a block holds as a `T`: stands after `as` in
/// [`declare_block!`](crate::declare_block). Implemented by the types of this module.
pub trait ParameterType<T> {
    /// Description for the reference, the schema and messages.
    const VALUE_KIND: ValueKind;

    /// Reads the parameter `key`. Errors are noted in the reader, and a valid placeholder is returned.
    fn read(reader: &mut Reader<'_>, key: &str) -> T;

    /// Number of components, if the parameter is one number for all components or one for each; by default `None`.
    fn width(_value: &T) -> Option<usize> {
        None
    }
}

/// Implements [`ParameterType`] by one method of the [`Reader`].
macro_rules! parameter_types {
    ($($(#[$attribute:meta])* $name:ident: $type:ty, $takes:expr, $read:ident $(, $width:expr)?;)*) => {$(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        pub enum $name {}

        impl ParameterType<$type> for $name {
            const VALUE_KIND: ValueKind = $takes;

            fn read(reader: &mut Reader<'_>, key: &str) -> $type {
                reader.$read(key)
            }
            $(
                fn width(value: &$type) -> Option<usize> {
                    $width(value)
                }
            )?
        }
    )*};
}

parameter_types! {
    /// A finite number.
    Number: f64, ValueKind::Number, number;
    /// A number that may be infinite, written as `inf` or `-inf`.
    Limit: f64, ValueKind::Number, limit;
    /// A number greater than zero.
    Positive: f64, ValueKind::Positive, positive;
    /// A whole number from 0 on.
    Count: usize, ValueKind::Count, count;
    /// A whole number from 1 on.
    PositiveCount: usize, ValueKind::Count, positive_count;
    /// Number of inputs, from 1 to 1000.
    InputCount: usize, ValueKind::Count, input_count;
    /// Number of inputs, from 1 on and at most [`MAX_PORTS`](crate::reader::MAX_PORTS).
    PortCount: usize, ValueKind::Count, positive_port_count;
    /// A finite number for all components, or one for each.
    PerComponent: Vec<f64>, ValueKind::Numbers, numbers, length;
    /// As [`PerComponent`], each of which may be infinite.
    Limits: Vec<f64>, ValueKind::Numbers, limits, length;
    /// As [`PerComponent`], each greater than zero.
    Positives: Vec<f64>, ValueKind::Numbers, positives, length;
    /// Finite numbers, at least one, that have nothing to do with components.
    List: Vec<f64>, ValueKind::Numbers, numbers;
    /// Rows of numbers of equal length.
    Rows: Matrix, ValueKind::Matrix, matrix;
    /// True or false.
    Flag: bool, ValueKind::Flag, flag;
    /// A text.
    Text: String, ValueKind::Text, text;
    /// The name of a file of the scene folder.
    File: String, ValueKind::File, text;
    /// A list of texts.
    Texts: Vec<String>, ValueKind::Texts, texts;
}

fn length(list: &[f64]) -> Option<usize> {
    Some(list.len())
}

/// Optional parameter of type `P`: `None` if it is left out. Its declared default stands in the reference documentation
/// only.
#[derive(Clone, Copy, Debug)]
pub struct OptionalParameter<P>(P);

impl<T, P: ParameterType<T>> ParameterType<Option<T>> for OptionalParameter<P> {
    const VALUE_KIND: ValueKind = P::VALUE_KIND;

    fn read(reader: &mut Reader<'_>, key: &str) -> Option<T> {
        reader.has(key).then(|| P::read(reader, key))
    }

    fn width(value: &Option<T>) -> Option<usize> {
        value.as_ref().and_then(P::width)
    }
}

/// Parameter that is one of the words of an enum declared by [`choice!`](crate::choice).
///
/// ```
/// use sincro_blocks::prelude::*;
///
/// choice! {
///     /// Edge of a signal.
///     pub enum Edge {
///         /// From false to true.
///         Rising = "rising",
///         /// From true to false.
///         Falling = "falling",
///     }
/// }
/// declare_block! {
///     /// Counts edges.
///     pub struct EdgeCount("edge-count", Logic): "y = number of edges of u" {
///         /// Edge that counts.
///         pub edge: Edge as Choice = "rising",
///     }
/// }
/// # impl Block for EdgeCount {
/// #     type Work<R: Real> = ();
/// #     fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), _: &mut [R]) {}
/// # }
/// assert_eq!(EdgeCount::with_defaults().edge, Edge::Rising);
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Choice {}

impl<T: Words> ParameterType<T> for Choice {
    const VALUE_KIND: ValueKind = ValueKind::Choice(T::WORDS);

    fn read(reader: &mut Reader<'_>, key: &str) -> T {
        T::ALL[reader.choice(key)]
    }
}

/// Enum whose variants have words in files; implemented by [`choice!`](crate::choice), read as [`Choice`].
pub trait Words: Copy + PartialEq + 'static {
    /// All variants.
    const ALL: &'static [Self];
    /// Their words, in the same order.
    const WORDS: &'static [&'static str];

    /// Word of the variant in a file.
    #[must_use]
    fn word(self) -> &'static str {
        Self::ALL.iter().zip(Self::WORDS).find(|(variant, _)| **variant == self).map_or("", |(_, word)| word)
    }
}

/// Declares an enum of the words that a parameter may be; the parameter is then declared `as Choice`.
///
/// ```
/// use sincro_blocks::parameter::Words;
///
/// sincro_blocks::choice! {
///     /// Rounding of a number.
///     pub enum Rounding {
///         /// To the next whole number below.
///         Down = "down",
///         /// To the next whole number above.
///         Up = "up",
///     }
/// }
/// assert_eq!((Rounding::Up.word(), Rounding::WORDS), ("up", &["down", "up"][..]));
/// ```
#[macro_export]
macro_rules! choice {
    (
        $(#[$attribute:meta])*
        $visibility:vis enum $name:ident { $($(#[$variant_attribute:meta])* $variant:ident = $word:literal),* $(,)? }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name {
            $($(#[$variant_attribute])* $variant,)*
        }

        impl $crate::parameter::Words for $name {
            const ALL: &'static [Self] = &[$(Self::$variant),*];
            const WORDS: &'static [&'static str] = &[$($word),*];
        }
    };
}

/// Set of parameters declared together, such as those shared by several blocks; implemented by
/// [`declare_parameters!`](crate::declare_parameters).
pub trait ParameterSet: Sized {
    /// Descriptions, in the order of the declaration.
    const PARAMETERS: &'static [Parameter];

    /// Reads all parameters, each on its own: checks against each other come later. Errors are noted in the reader.
    fn read(reader: &mut Reader<'_>) -> Self;

    /// Names and lengths of the parameters that are one number for all components or one for each, in the order of
    /// their declaration.
    fn widths(&self) -> Vec<(&'static str, usize)>;
}

/// Declares a struct of parameters, as [`declare_block!`](crate::declare_block) does for a block, for several blocks
/// that share them.
#[macro_export]
macro_rules! declare_parameters {
    (
        $(#[$attribute:meta])*
        $visibility:vis struct $set:ident {
            $($(#[doc = $doc:literal])+ $parameter_visibility:vis $parameter:ident: $type:ty as $takes:ty $(= $default:literal)?),* $(,)?
        }
        $(with { $($(#[$field_attribute:meta])* $field_visibility:vis $field:ident: $field_type:ty = $initial:expr),* $(,)? })?
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility struct $set {
            $($(#[doc = $doc])+ $parameter_visibility $parameter: $type,)*
            $($($(#[$field_attribute])* $field_visibility $field: $field_type,)*)?
        }

        impl $crate::parameter::ParameterSet for $set {
            const PARAMETERS: &'static [$crate::kind::Parameter] = &[$($crate::kind::Parameter {
                name: stringify!($parameter),
                takes: <$takes as $crate::parameter::ParameterType<$type>>::VALUE_KIND,
                doc: (concat!($($doc),+) as &str).trim_ascii(),
                default: $crate::parameter::first(&[$($default)?]),
            }),*];

            fn read(reader: &mut $crate::reader::Reader<'_>) -> Self {
                Self {
                    $($parameter: <$takes as $crate::parameter::ParameterType<$type>>::read(reader, stringify!($parameter)),)*
                    $($($field: $initial,)*)?
                }
            }

            fn widths(&self) -> Vec<(&'static str, usize)> {
                let widths = [$((
                    stringify!($parameter),
                    <$takes as $crate::parameter::ParameterType<$type>>::width(&self.$parameter),
                )),*];
                widths.into_iter().filter_map(|(name, width)| Some((name, width?))).collect()
            }
        }
    };
}

/// First default of a list with at most one entry, `None` of an empty one; for the macro
/// [`declare_parameters!`](crate::declare_parameters) only.
#[doc(hidden)]
#[must_use]
pub const fn first(defaults: &[&'static str]) -> Option<&'static str> {
    match defaults {
        [first, ..] => Some(first),
        [] => None,
    }
}
