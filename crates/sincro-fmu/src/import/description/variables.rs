//! Variables of a foreign FMU, with the types and units that they refer to.

use std::collections::BTreeMap;

use roxmltree::Node;
use sincro_scene::fmu::{FmuBaseUnit, FmuDimension, FmuUnit};

use super::{child, is_true, line_of};
use crate::description::FmiVersion;

/// Variable of a foreign FMU, from its model description: what an input or output of a diagram or of a
/// [`Wiring`](super::super::Wiring) is connected to.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignVariable {
    /// Name of the variable.
    pub name: String,
    /// Value reference, by which a [`Slave`](super::super::Slave) reads and sets it.
    pub reference: u32,
    /// Numeric type; none for texts, bytes and clocks.
    pub kind: Option<NumberKind>,
    /// Causality (`input`, `output`, `parameter` …); `local` if none is given.
    pub causality: String,
    /// Unit of the values, if one is given.
    pub unit: Option<FmuUnit>,
    /// Dimensions of an array, none for one number; parameters by their index among the variables.
    pub dimensions: Vec<FmuDimension>,
    /// First start value, if one is given.
    pub start: Option<f64>,
    /// True if it changes at events only.
    pub is_discrete: bool,
    /// True for an input on which an output may depend at the same instant.
    pub feeds_through: bool,
    /// Variable that it is the derivative of, by its number in the file: place from 1 on (FMI 2.0), value reference
    /// (FMI 3.0).
    pub(super) derivative_of: Option<u32>,
}

/// Numeric type of a variable of an FMU in the words of FMI 3.0; of FMI 2.0, `Real` is `Float64`, `Integer` and
/// enumerations `Int32`. Values pass as `f64`, so integers beyond 2⁵³ lose digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberKind {
    /// Real number of 64 bits.
    Float64,
    /// Real number of 32 bits.
    Float32,
    /// Integer of 8 bits.
    Int8,
    /// Unsigned integer of 8 bits.
    UInt8,
    /// Integer of 16 bits.
    Int16,
    /// Unsigned integer of 16 bits.
    UInt16,
    /// Integer of 32 bits.
    Int32,
    /// Unsigned integer of 32 bits.
    UInt32,
    /// Integer of 64 bits.
    Int64,
    /// Unsigned integer of 64 bits.
    UInt64,
    /// Truth value, as 0 or 1.
    Boolean,
}

impl NumberKind {
    /// Type of an element of a model description.
    fn of(name: &str, version: FmiVersion) -> Option<Self> {
        Some(match (name, version) {
            ("Real", FmiVersion::V2) | ("Float64", FmiVersion::V3) => Self::Float64,
            ("Integer" | "Enumeration", FmiVersion::V2) | ("Int32", FmiVersion::V3) => Self::Int32,
            ("Boolean", _) => Self::Boolean,
            ("Float32", FmiVersion::V3) => Self::Float32,
            ("Int8", FmiVersion::V3) => Self::Int8,
            ("UInt8", FmiVersion::V3) => Self::UInt8,
            ("Int16", FmiVersion::V3) => Self::Int16,
            ("UInt16", FmiVersion::V3) => Self::UInt16,
            ("UInt32", FmiVersion::V3) => Self::UInt32,
            ("Int64" | "Enumeration", FmiVersion::V3) => Self::Int64,
            ("UInt64", FmiVersion::V3) => Self::UInt64,
            _ => return None,
        })
    }

    /// Returns true for real numbers.
    #[must_use]
    pub fn is_real(self) -> bool {
        matches!(self, Self::Float64 | Self::Float32)
    }
}

impl ForeignVariable {
    /// Returns true if the variable is one real number of 64 bits and no array.
    #[must_use]
    pub fn is_real(&self) -> bool {
        self.kind == Some(NumberKind::Float64) && self.dimensions.is_empty()
    }
}

/// Definitions that variables refer to by name: units, and types with the attributes that variables take over.
pub(super) struct Definitions<'a, 'input> {
    version: FmiVersion,
    units: BTreeMap<&'a str, FmuBaseUnit>,
    types: BTreeMap<&'a str, Node<'a, 'input>>,
}

impl<'a, 'input> Definitions<'a, 'input> {
    pub fn read(root: Node<'a, 'input>, version: FmiVersion) -> Self {
        let elements = |list: &str| {
            let list = child(root, list);
            list.into_iter().flat_map(|list| list.children().filter(Node::is_element).collect::<Vec<_>>())
        };
        let units = elements("UnitDefinitions")
            .filter_map(|unit| Some((unit.attribute("name")?, base_unit(child(unit, "BaseUnit")?)?)));
        let types = elements("TypeDefinitions").filter_map(|of| {
            let typed = if version == FmiVersion::V2 { of.children().find(Node::is_element)? } else { of };
            Some((of.attribute("name")?, typed))
        });
        Self { version, units: units.collect(), types: types.collect() }
    }

    /// Element that has the type of a variable: in FMI 2.0 inside of it, in FMI 3.0 itself.
    pub fn typed(&self, variable: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
        if self.version == FmiVersion::V2 { variable.children().find(Node::is_element) } else { Some(variable) }
    }

    /// Attribute of a typed element, its own or that of its declared type.
    pub fn attribute(&self, typed: Node<'a, 'input>, name: &str) -> Option<&'a str> {
        let declared = || self.types.get(typed.attribute("declaredType")?)?.attribute(name);
        typed.attribute(name).or_else(declared)
    }

    /// Reads a variable; dimensions name structural parameters by their value references for now.
    pub fn variable(&self, node: Node<'a, 'input>) -> Result<ForeignVariable, String> {
        let name = node.attribute("name").ok_or_else(|| format!("line {}: a variable has no name", line_of(node)))?;
        let reference = node.attribute("valueReference").and_then(|text| text.trim().parse().ok());
        let reference = reference.ok_or_else(|| format!("line {}: `{name}` has no valueReference", line_of(node)))?;
        let typed = self.typed(node).ok_or_else(|| format!("line {}: `{name}` has no type", line_of(node)))?;
        let kind = NumberKind::of(typed.tag_name().name(), self.version);
        let is_continuous = match node.attribute("variability") {
            Some(variability) => variability == "continuous",
            None => kind.is_some_and(NumberKind::is_real),
        };
        let dimensions = node.children().filter(|child| child.tag_name().name() == "Dimension");
        let dimensions = dimensions.map(|of| {
            let number = |key: &str| of.attribute(key).and_then(|text| text.trim().parse().ok());
            match (number("start"), number("valueReference")) {
                (Some(n), _) => Ok(FmuDimension::Fixed(n)),
                (None, Some(reference)) => Ok(FmuDimension::Parameter(reference)),
                (None, None) => Err(format!("line {}: a dimension of `{name}` has no size", line_of(of))),
            }
        });
        Ok(ForeignVariable {
            name: name.to_owned(),
            reference,
            kind,
            causality: node.attribute("causality").unwrap_or("local").to_owned(),
            unit: self.unit(typed),
            dimensions: dimensions.collect::<Result<_, _>>()?,
            start: typed.attribute("start").and_then(first_number),
            is_discrete: !is_continuous,
            feeds_through: true,
            derivative_of: typed.attribute("derivative").and_then(|text| text.trim().parse().ok()),
        })
    }

    fn unit(&self, typed: Node<'a, 'input>) -> Option<FmuUnit> {
        let name = self.attribute(typed, "unit")?;
        Some(FmuUnit {
            name: name.to_owned(),
            base: self.units.get(name).copied(),
            is_relative: is_true(self.attribute(typed, "relativeQuantity")),
        })
    }
}

fn first_number(text: &str) -> Option<f64> {
    match text.split_whitespace().next()? {
        "true" => Some(1.0),
        "false" => Some(0.0),
        number => number.parse().ok(),
    }
}

fn base_unit(node: Node<'_, '_>) -> Option<FmuBaseUnit> {
    let number = |key: &str, default: f64| node.attribute(key).map_or(Some(default), |text| text.trim().parse().ok());
    let mut exponents = [0; 8];
    for (exponent, symbol) in exponents.iter_mut().zip(["kg", "m", "s", "A", "K", "rad", "mol", "cd"]) {
        *exponent = node.attribute(symbol).map_or(Some(0), |text| text.trim().parse().ok())?;
    }
    let (factor, offset) = (number("factor", 1.0)?, number("offset", 0.0)?);
    (factor.is_normal() && offset.is_finite()).then_some(FmuBaseUnit { exponents, factor, offset })
}
