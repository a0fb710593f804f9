//! Model descriptions of foreign FMUs, as far as co-simulation needs them.

use roxmltree::{Document, Node, ParsingOptions};

use crate::description::FmiVersion;

/// Most elements that a model description may have.
const MAX_NODES: u32 = 2_000_000;

/// Model description (`modelDescription.xml`) of a foreign FMU, as far as co-simulation needs it; see
/// [`ForeignFmu::description`](super::ForeignFmu::description).
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignDescription {
    /// Version of the FMI standard that the FMU is written in.
    pub version: FmiVersion,
    /// Name of the model, as its author gave it.
    pub name: String,
    /// Globally unique identifier (FMI 2.0) or instantiation token (FMI 3.0), which instances are made with.
    pub token: String,
    /// Name of the shared library for co-simulation; none if it has no co-simulation.
    pub co_simulation: Option<String>,
    /// True if an instance can save and restore its state.
    pub can_save: bool,
    /// True unless the description says that no output depends on an input at the same instant.
    pub has_feedthrough: bool,
    /// Communication step that the FMU proposes `[s]`; none if it proposes none.
    pub step_size: Option<f64>,
    /// Variables, in the order of the file.
    pub variables: Vec<ForeignVariable>,
}

/// Variable of a foreign FMU, from its model description: what an input or output of a diagram or of a
/// [`Wiring`](super::Wiring) is connected to.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignVariable {
    /// Name of the variable.
    pub name: String,
    /// Value reference, by which a [`Slave`](super::Slave) reads and sets it.
    pub reference: u32,
    /// Numeric type; none for texts and bytes.
    pub kind: Option<NumberKind>,
    /// Causality (`input`, `output`, `parameter` …); `local` if none is given.
    pub causality: String,
    /// Unit of the values, if one is given.
    pub unit: Option<String>,
    /// True if it is an array, which is not connected.
    pub is_array: bool,
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
}

impl ForeignVariable {
    /// Numeric type of the variable; none if it is no number, or an array.
    #[must_use]
    pub fn number(&self) -> Option<NumberKind> {
        self.kind.filter(|_| !self.is_array)
    }

    /// Returns true if the variable is one real number of 64 bits and no array.
    #[must_use]
    pub fn is_real(&self) -> bool {
        self.number() == Some(NumberKind::Float64)
    }
}

impl ForeignDescription {
    /// Reads the text of a `modelDescription.xml`.
    ///
    /// # Errors
    ///
    /// It is no XML, or not one of FMI 2.0 or 3.0; with the line.
    pub(crate) fn read(xml: &str) -> Result<Self, String> {
        let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(xml, options)
            .map_err(|error| format!("modelDescription.xml is no XML: {error}"))?;
        let root = document.root_element();
        if root.tag_name().name() != "fmiModelDescription" {
            return Err(format!("modelDescription.xml begins with `{}`", root.tag_name().name()));
        }
        let version = match root.attribute("fmiVersion").unwrap_or("") {
            "2.0" => FmiVersion::V2,
            text if text.starts_with("3.") => FmiVersion::V3,
            other => return Err(format!("it is an FMU of FMI {other}: 2.0 and 3.0 are imported")),
        };
        let token_key = if version == FmiVersion::V2 { "guid" } else { "instantiationToken" };
        let co_simulation = child(root, "CoSimulation");
        let save_key = if version == FmiVersion::V2 { "canGetAndSetFMUstate" } else { "canGetAndSetFMUState" };
        let step_size = child(root, "DefaultExperiment").and_then(|node| node.attribute("stepSize"));
        let listed = child(root, "ModelVariables").ok_or("modelDescription.xml has no ModelVariables")?;
        let variables = listed.children().filter(Node::is_element).map(|node| variable(node, version));
        Ok(Self {
            version,
            name: root.attribute("modelName").unwrap_or("").to_owned(),
            token: root
                .attribute(token_key)
                .ok_or_else(|| format!("modelDescription.xml has no {token_key}"))?
                .to_owned(),
            co_simulation: co_simulation.and_then(|node| node.attribute("modelIdentifier")).map(str::to_owned),
            can_save: co_simulation.is_some_and(|node| is_true(node.attribute(save_key))),
            has_feedthrough: has_feedthrough(root, version),
            step_size: step_size.and_then(|text| text.trim().parse().ok()).filter(|h: &f64| *h > 0.0),
            variables: variables.collect::<Result<_, _>>()?,
        })
    }

    /// Finds a real variable (64 bits, no array) by its name; none if there is none.
    #[must_use]
    pub fn real(&self, name: &str) -> Option<&ForeignVariable> {
        self.variables.iter().find(|variable| variable.name == name && variable.is_real())
    }
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.tag_name().name() == name)
}

/// Returns true unless all outputs say that they depend on nothing.
fn has_feedthrough(root: Node<'_, '_>, version: FmiVersion) -> bool {
    let Some(structure) = child(root, "ModelStructure") else { return true };
    let outputs = match version {
        FmiVersion::V2 => child(structure, "Outputs").map(|list| list.children().collect::<Vec<_>>()),
        FmiVersion::V3 => Some(structure.children().filter(|node| node.tag_name().name() == "Output").collect()),
    };
    let is_free = |node: &Node<'_, '_>| node.attribute("dependencies").is_some_and(|list| list.trim().is_empty());
    !outputs.unwrap_or_default().iter().filter(|node| node.is_element()).all(is_free)
}

fn is_true(text: Option<&str>) -> bool {
    matches!(text.map(str::trim), Some("true" | "1"))
}

fn variable(node: Node<'_, '_>, version: FmiVersion) -> Result<ForeignVariable, String> {
    let line = || node.document().text_pos_at(node.range().start).row;
    let name = node.attribute("name").ok_or_else(|| format!("line {}: a variable has no name", line()))?;
    let reference = node.attribute("valueReference").and_then(|text| text.trim().parse().ok());
    let reference = reference.ok_or_else(|| format!("line {}: `{name}` has no valueReference", line()))?;
    let typed = if version == FmiVersion::V2 { node.children().find(Node::is_element) } else { Some(node) };
    let typed = typed.ok_or_else(|| format!("line {}: `{name}` has no type", line()))?;
    Ok(ForeignVariable {
        name: name.to_owned(),
        reference,
        kind: NumberKind::of(typed.tag_name().name(), version),
        causality: node.attribute("causality").unwrap_or("local").to_owned(),
        unit: typed.attribute("unit").map(str::to_owned),
        is_array: version == FmiVersion::V3 && child(node, "Dimension").is_some(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const XML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
        <fmiModelDescription fmiVersion="2.0" modelName="gain" guid="{1}">
          <CoSimulation modelIdentifier="gain" canGetAndSetFMUstate="true"/>
          <DefaultExperiment stepSize="0.01"/>
          <ModelVariables>
            <ScalarVariable name="u" valueReference="0" causality="input"><Real start="0" unit="m"/></ScalarVariable>
            <ScalarVariable name="on" valueReference="1"><Boolean/></ScalarVariable>
          </ModelVariables>
        </fmiModelDescription>"#;

    #[test]
    fn variables_are_read() {
        let read = ForeignDescription::read(XML).unwrap();
        assert_eq!((read.version, &*read.name, &*read.token), (FmiVersion::V2, "gain", "{1}"));
        assert_eq!((read.co_simulation.as_deref(), read.can_save, read.step_size), (Some("gain"), true, Some(0.01)));
        assert_eq!(read.real("u").unwrap().unit.as_deref(), Some("m"));
        assert_eq!(read.real("on"), None);
        assert_eq!(read.variables[1].number(), Some(NumberKind::Boolean));
    }

    #[test]
    fn other_texts_are_refused() {
        let refused = |xml: &str| ForeignDescription::read(xml).unwrap_err();
        assert!(refused("nonsense").contains("no XML"));
        assert!(refused("<a/>").contains("begins with `a`"));
        assert!(refused(&XML.replace("2.0", "1.0")).contains("FMI 1.0"));
        assert!(refused(&XML.replace("valueReference=\"1\"", "")).contains("line 7: `on` has no valueReference"));
        // no entities: they are how a small text becomes a large one
        let bomb = "<!DOCTYPE a [<!ENTITY b \"bbbb\"><!ENTITY c \"&b;&b;&b;\">]><a>&c;</a>";
        assert!(refused(bomb).contains("no XML"));
        assert!(ForeignDescription::read(&"<a>".repeat(100_000)).is_err());
    }

    #[test]
    fn changed_texts_never_panic() {
        let n: u64 = std::env::var("SINCRO_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(20_000);
        let mut seed = 3_u64;
        let mut draw = |n: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % n
        };
        for _ in 0..n {
            let mut bytes = XML.as_bytes().to_vec();
            for _ in 0..1 + draw(6) {
                if bytes.is_empty() {
                    break;
                }
                let at = draw(bytes.len());
                match draw(4) {
                    0 => bytes[at] = b"<>/=\"'&;! \0\xffa9"[draw(14)],
                    1 => drop(bytes.remove(at)),
                    2 => bytes.truncate(at.max(1)),
                    _ => {
                        let piece = bytes[at..(at + draw(40)).min(bytes.len())].to_vec();
                        let to = draw(bytes.len());
                        bytes.splice(to..to, piece);
                    }
                }
            }
            let _ = ForeignDescription::read(&String::from_utf8_lossy(&bytes));
        }
    }
}
