//! `modelDescription.xml` of FMI 2.0 (key `fmi-2`).

use super::variables::write_variables;
use super::xml::{Attribute, Xml, flag, text};
use super::{Description, TOOL};
use crate::variables::{Role, Variable};

pub(super) fn write(of: &Description<'_>) -> String {
    let mut xml = Xml::new();
    let n_indicators = of.kinds.model_exchange.then(|| "0".to_owned());
    xml.begin(
        "fmiModelDescription",
        &[
            text("fmiVersion", "2.0"),
            text("modelName", of.name),
            text("guid", of.token),
            text("description", of.text),
            text("generationTool", TOOL),
            text("variableNamingConvention", "structured"),
            ("numberOfEventIndicators", n_indicators),
        ],
    );
    interfaces(&mut xml, of);
    write_variables(&mut xml, of, write_variable);
    structure(&mut xml, of);
    xml.end();
    xml.finish()
}

fn interfaces(xml: &mut Xml, of: &Description<'_>) {
    let common = |xml: &mut Xml, name: &str, can_save: bool, own: &[Attribute<'_>]| {
        let mut attributes = vec![text("modelIdentifier", of.identifier)];
        attributes.extend_from_slice(own);
        attributes.extend([flag("canGetAndSetFMUstate", can_save), flag("canSerializeFMUstate", can_save)]);
        xml.element(name, &attributes);
    };
    if of.kinds.model_exchange {
        common(xml, "ModelExchange", false, &[flag("providesDirectionalDerivative", true)]);
    }
    if of.kinds.co_simulation {
        let own = [
            flag("canHandleVariableCommunicationStepSize", true),
            flag("providesDirectionalDerivative", of.kinds.model_exchange),
        ];
        common(xml, "CoSimulation", of.can_save, &own);
    }
}

fn write_variable(xml: &mut Xml, k: usize, variable: &Variable, unit: Option<String>) {
    let (causality, variability, initial) = match variable.role {
        Role::Time => ("independent", "continuous", None),
        Role::Fixed(_) => ("parameter", "fixed", Some("exact")),
        Role::Tunable(..) => ("parameter", "tunable", Some("exact")),
        Role::Input(_) => ("input", "continuous", None),
        Role::Output(_) => ("output", "continuous", Some("calculated")),
        Role::State(_) => ("local", "continuous", Some("exact")),
        Role::Derivative(_) => ("local", "continuous", Some("calculated")),
    };
    xml.begin(
        "ScalarVariable",
        &[
            text("name", &*variable.name),
            text("valueReference", k.to_string()),
            text("description", &*variable.description),
            text("causality", causality),
            text("variability", variability),
            ("initial", initial.map(str::to_owned)),
        ],
    );
    // a derivative stands behind its state, counted from 1
    let derivative = if let Role::Derivative(_) = variable.role { Some(k.to_string()) } else { None };
    xml.element(
        "Real",
        &[("unit", unit), ("start", variable.start.map(|x| format!("{x:?}"))), ("derivative", derivative)],
    );
    xml.end();
}

fn structure(xml: &mut Xml, of: &Description<'_>) {
    let places = |pick: fn(&Role) -> bool| {
        let all = of.catalogue.variables.iter().enumerate();
        all.filter(move |(_, variable)| pick(&variable.role)).map(|(k, _)| k + 1)
    };
    let is_output = |role: &Role| matches!(role, Role::Output(_));
    let is_derivative = |role: &Role| matches!(role, Role::Derivative(_));
    // in co-simulation an output is that of the last base step: no input acts on it before the next one
    let dependencies = (!of.kinds.model_exchange).then(String::new);
    let list = |xml: &mut Xml, name: &'static str, unknowns: &[usize], dependencies: &Option<String>| {
        if unknowns.is_empty() {
            return;
        }
        xml.begin(name, &[]);
        for k in unknowns {
            xml.element("Unknown", &[text("index", k.to_string()), ("dependencies", dependencies.clone())]);
        }
        xml.end();
    };
    let outputs: Vec<usize> = places(is_output).collect();
    let derivatives: Vec<usize> = places(is_derivative).collect();
    let initial: Vec<usize> = places(|role| matches!(role, Role::Output(_) | Role::Derivative(_))).collect();
    xml.begin("ModelStructure", &[]);
    list(xml, "Outputs", &outputs, &dependencies);
    list(xml, "Derivatives", &derivatives, &None);
    list(xml, "InitialUnknowns", &initial, &None);
    xml.end();
}
