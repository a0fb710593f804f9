//! `modelDescription.xml` of FMI 3.0 (key `fmi-3`).

use super::variables::write_variables;
use super::xml::{Attribute, Xml, flag, number, text};
use super::{Description, TOOL};
use crate::variables::{Role, Variable};

pub(super) fn write(of: &Description<'_>) -> String {
    let mut xml = Xml::new();
    xml.begin(
        "fmiModelDescription",
        &[
            text("fmiVersion", "3.0"),
            text("modelName", of.name),
            text("instantiationToken", of.token),
            text("description", of.text),
            text("generationTool", TOOL),
            text("variableNamingConvention", "structured"),
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
        attributes.extend([flag("canGetAndSetFMUState", can_save), flag("canSerializeFMUState", can_save)]);
        attributes.extend_from_slice(own);
        xml.element(name, &attributes);
    };
    if of.kinds.model_exchange {
        let own = [flag("providesDirectionalDerivatives", true), flag("providesAdjointDerivatives", true)];
        common(xml, "ModelExchange", false, &own);
    }
    if of.kinds.co_simulation {
        common(
            xml,
            "CoSimulation",
            of.can_save,
            &[
                flag("providesDirectionalDerivatives", of.kinds.model_exchange),
                flag("providesAdjointDerivatives", of.kinds.model_exchange),
                flag("canHandleVariableCommunicationStepSize", true),
                number("fixedInternalStepSize", of.base_step),
                flag("canReturnEarlyAfterIntermediateUpdate", true),
                flag("providesIntermediateUpdate", true),
                flag("mightReturnEarlyFromDoStep", true),
            ],
        );
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
    // a derivative stands behind its state
    let derivative = if let Role::Derivative(_) = variable.role { Some((k - 1).to_string()) } else { None };
    xml.element(
        "Float64",
        &[
            text("name", &*variable.name),
            text("valueReference", k.to_string()),
            text("description", &*variable.description),
            text("causality", causality),
            text("variability", variability),
            ("initial", initial.map(str::to_owned)),
            ("unit", unit),
            ("start", variable.start.map(|x| format!("{x:?}"))),
            ("derivative", derivative),
        ],
    );
}

fn structure(xml: &mut Xml, of: &Description<'_>) {
    let element = |xml: &mut Xml, name: &str, k: u32, dependencies: Option<String>| {
        xml.element(name, &[text("valueReference", k.to_string()), ("dependencies", dependencies)]);
    };
    let outputs: Vec<u32> =
        of.catalogue.with_role(|role| matches!(role, Role::Output(_)).then_some(())).map(|(vr, ..)| vr).collect();
    let derivatives: Vec<u32> =
        of.catalogue.with_role(|role| matches!(role, Role::Derivative(_)).then_some(())).map(|(vr, ..)| vr).collect();
    xml.begin("ModelStructure", &[]);
    for vr in &outputs {
        // in co-simulation an output is that of the last base step: no input acts on it before the next one
        element(xml, "Output", *vr, (!of.kinds.model_exchange).then(String::new));
    }
    for vr in &derivatives {
        element(xml, "ContinuousStateDerivative", *vr, None);
    }
    let mut initial: Vec<u32> = outputs.iter().chain(&derivatives).copied().collect();
    initial.sort_unstable();
    for vr in initial {
        element(xml, "InitialUnknown", vr, None);
    }
    xml.end();
}
