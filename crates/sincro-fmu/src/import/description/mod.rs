//! Model descriptions of foreign FMUs, as far as an importer needs them.

mod clocks;
mod variables;

use std::collections::BTreeMap;

use roxmltree::{Document, Node, ParsingOptions};
use sincro_scene::fmu::{FmuDimension, FmuInterface};

use crate::description::FmiVersion;
pub use clocks::{ClockRule, ForeignClock};
use variables::Definitions;
pub use variables::{ForeignVariable, NumberKind};

/// Most elements that a model description may have.
const MAX_NODES: u32 = 2_000_000;

/// Model description (`modelDescription.xml`) of a foreign FMU, as far as an importer needs it; see
/// [`ForeignFmu::description`](super::ForeignFmu::description).
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignDescription {
    /// Version of the FMI standard that the FMU is written in.
    pub version: FmiVersion,
    /// Name of the model, as its author gave it.
    pub name: String,
    /// Globally unique identifier (FMI 2.0) or instantiation token (FMI 3.0), which instances are made with.
    pub token: String,
    /// Interfaces, co-simulation first, then model exchange.
    pub interfaces: Vec<ForeignInterface>,
    /// Communication step that the FMU proposes `[s]`; none if it proposes none.
    pub step_size: Option<f64>,
    /// Variables, in the order of the file.
    pub variables: Vec<ForeignVariable>,
    /// Input clocks, in the order of the file.
    pub clocks: Vec<ForeignClock>,
    /// Derivatives of the continuous states: indices of variables.
    pub states: Vec<usize>,
    /// Value references of the continuous states, in the order of `states`; empty if the file does not name them.
    pub state_references: Vec<u32>,
    /// Event indicators that are variables: their indices (FMI 3.0).
    pub indicators: Vec<usize>,
    /// Number of event indicators that are no variables (FMI 2.0).
    pub n_indicators: usize,
}

/// Interface of a foreign FMU by which it is simulated, with its capabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignInterface {
    /// Kind of interface.
    pub kind: FmuInterface,
    /// Name of its shared library.
    pub library: String,
    /// True if an instance can save and restore its state.
    pub can_save: bool,
    /// True if a saved state can be written as bytes.
    pub can_serialize: bool,
    /// True if the importer must tell an instance of every accepted step (model exchange).
    pub needs_completed_step: bool,
    /// True if it gives directional derivatives.
    pub has_derivatives: bool,
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
        let token = root.attribute(token_key).ok_or_else(|| format!("modelDescription.xml has no {token_key}"))?;
        let step_size = child(root, "DefaultExperiment").and_then(|node| node.attribute("stepSize"));
        let mut new = Self {
            version,
            name: root.attribute("modelName").unwrap_or("").to_owned(),
            token: token.to_owned(),
            interfaces: interfaces(root, version),
            step_size: step_size.and_then(|text| text.trim().parse().ok()).filter(|h: &f64| *h > 0.0),
            variables: Vec::new(),
            clocks: Vec::new(),
            states: Vec::new(),
            state_references: Vec::new(),
            indicators: Vec::new(),
            n_indicators: 0,
        };
        new.read_variables(root)?;
        new.read_structure(root)?;
        Ok(new)
    }

    fn read_variables(&mut self, root: Node<'_, '_>) -> Result<(), String> {
        let listed = child(root, "ModelVariables").ok_or("modelDescription.xml has no ModelVariables")?;
        let definitions = Definitions::read(root, self.version);
        for node in listed.children().filter(Node::is_element) {
            let variable = definitions.variable(node)?;
            if self.version == FmiVersion::V3 && node.tag_name().name() == "Clock" {
                let clock = clocks::read(node, &definitions, (&variable.name, variable.reference))?;
                self.clocks.extend(clock);
            }
            self.variables.push(variable);
        }
        // dimensions by the places of their structural parameters
        let is_structural = |v: &ForeignVariable| v.causality == "structuralParameter";
        let parameters = self.variables.iter().enumerate().filter(|(_, v)| is_structural(v));
        let parameters: BTreeMap<usize, usize> = parameters.map(|(k, v)| (v.reference as usize, k)).collect();
        for variable in &mut self.variables {
            for dimension in &mut variable.dimensions {
                if let FmuDimension::Parameter(reference) = *dimension {
                    let place = parameters.get(&reference).ok_or_else(|| {
                        format!("a dimension of `{}` is no structural parameter: {reference}", variable.name)
                    })?;
                    *dimension = FmuDimension::Parameter(*place);
                }
            }
        }
        Ok(())
    }

    /// Reads states, event indicators and dependencies of outputs from the structure of the model.
    fn read_structure(&mut self, root: Node<'_, '_>) -> Result<(), String> {
        let Some(structure) = child(root, "ModelStructure") else { return Ok(()) };
        let (list, number) = match self.version {
            FmiVersion::V2 => (["Outputs", "Derivatives", ""], "index"),
            FmiVersion::V3 => (["Output", "ContinuousStateDerivative", "EventIndicator"], "valueReference"),
        };
        let [outputs, derivatives, indicators] = list.map(|name| unknowns(structure, name, self.version));
        let references = self.variables.iter().enumerate().rev().map(|(k, v)| (v.reference as usize, k));
        let references: BTreeMap<usize, usize> = references.collect();
        let place = |text: &str| -> Option<usize> {
            let number: usize = text.trim().parse().ok()?;
            match self.version {
                FmiVersion::V2 => number.checked_sub(1).filter(|k| *k < self.variables.len()),
                FmiVersion::V3 => references.get(&number).copied(),
            }
        };
        let places = |nodes: &[Node<'_, '_>]| -> Result<Vec<usize>, String> {
            let found = nodes.iter().map(|node| {
                let found = node.attribute(number).and_then(place);
                found.ok_or_else(|| format!("line {}: the structure names no variable", line_of(*node)))
            });
            found.collect()
        };
        let (states, indicators) = (places(&derivatives)?, places(&indicators)?);
        let mut fed = vec![false; self.variables.len()];
        for output in &outputs {
            match output.attribute("dependencies") {
                None => fed.fill(true),
                Some(list) => list.split_whitespace().filter_map(place).for_each(|k| fed[k] = true),
            }
        }
        let state_of = |k: &usize| place(&self.variables[*k].derivative_of?.to_string());
        let named: Option<Vec<usize>> = states.iter().map(state_of).collect();
        self.state_references = named.unwrap_or_default().iter().map(|k| self.variables[*k].reference).collect();
        (self.states, self.indicators) = (states, indicators);
        for (variable, fed) in self.variables.iter_mut().zip(fed) {
            variable.feeds_through = fed;
        }
        let declared = root.attribute("numberOfEventIndicators").and_then(|text| text.trim().parse().ok());
        self.n_indicators = declared.filter(|_| self.version == FmiVersion::V2).unwrap_or(0);
        Ok(())
    }

    /// Finds a real variable (64 bits, no array) by its name; none if there is none.
    #[must_use]
    pub fn real(&self, name: &str) -> Option<&ForeignVariable> {
        self.variables.iter().find(|variable| variable.name == name && variable.is_real())
    }

    /// Returns the capabilities of an interface; none if the FMU does not have it.
    #[must_use]
    pub fn interface(&self, kind: FmuInterface) -> Option<&ForeignInterface> {
        self.interfaces.iter().find(|interface| interface.kind == kind)
    }
}

/// Elements of the structure of a model: in FMI 2.0 in lists of their own, in FMI 3.0 in one.
fn unknowns<'a, 'input>(structure: Node<'a, 'input>, name: &str, version: FmiVersion) -> Vec<Node<'a, 'input>> {
    match version {
        FmiVersion::V2 => {
            let list = child(structure, name).filter(|_| !name.is_empty());
            list.into_iter().flat_map(|list| list.children().filter(Node::is_element).collect::<Vec<_>>()).collect()
        }
        FmiVersion::V3 => structure.children().filter(|node| node.tag_name().name() == name).collect(),
    }
}

fn interfaces(root: Node<'_, '_>, version: FmiVersion) -> Vec<ForeignInterface> {
    let kinds = [
        ("CoSimulation", FmuInterface::CoSimulation),
        ("ModelExchange", FmuInterface::ModelExchange),
        ("ScheduledExecution", FmuInterface::ScheduledExecution),
    ];
    let read = |(element, kind): (&str, FmuInterface)| {
        let node = child(root, element)?;
        let is = |v2: &str, v3: &str| is_true(node.attribute(if version == FmiVersion::V2 { v2 } else { v3 }));
        Some(ForeignInterface {
            kind,
            library: node.attribute("modelIdentifier")?.to_owned(),
            can_save: is("canGetAndSetFMUstate", "canGetAndSetFMUState"),
            can_serialize: is("canSerializeFMUstate", "canSerializeFMUState"),
            needs_completed_step: match version {
                FmiVersion::V2 => !is_true(node.attribute("completedIntegratorStepNotNeeded")),
                FmiVersion::V3 => is_true(node.attribute("needsCompletedIntegratorStep")),
            },
            has_derivatives: is("providesDirectionalDerivative", "providesDirectionalDerivatives"),
        })
    };
    kinds.into_iter().filter_map(read).collect()
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.tag_name().name() == name)
}

fn line_of(node: Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

fn is_true(text: Option<&str>) -> bool {
    matches!(text.map(str::trim), Some("true" | "1"))
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
        let own = read.interface(FmuInterface::CoSimulation).unwrap();
        assert_eq!((&*own.library, own.can_save, read.step_size), ("gain", true, Some(0.01)));
        assert_eq!(read.interface(FmuInterface::ModelExchange), None);
        assert_eq!(read.real("u").unwrap().unit.as_ref().unwrap().name, "m");
        assert_eq!(read.real("on"), None);
        assert_eq!(read.variables[1].kind, Some(NumberKind::Boolean));
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
