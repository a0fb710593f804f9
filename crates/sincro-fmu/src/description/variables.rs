//! Parts that both versions share: units, categories of messages, default experiment, and the list of variables.

use super::Description;
use super::xml::{Attribute, Xml, number, text};
use crate::units::{BASES, Units};
use crate::variables::Variable;

/// Writes everything from the units to the variables; `write_variable` writes one, given its place and the name of its
/// unit.
pub(super) fn write_variables(
    xml: &mut Xml,
    of: &Description<'_>,
    write_variable: impl Fn(&mut Xml, usize, &Variable, Option<String>),
) {
    let mut units = Units::default();
    let named: Vec<Option<String>> = of.catalogue.variables.iter().map(|v| units.add(&v.unit)).collect();
    write_units(xml, &units);
    log_categories(xml);
    default_experiment(xml, of);
    xml.begin("ModelVariables", &[]);
    for (k, (variable, unit)) in of.catalogue.variables.iter().zip(named).enumerate() {
        write_variable(xml, k, variable, unit);
    }
    xml.end();
}

fn write_units(xml: &mut Xml, units: &Units) {
    if units.iter().next().is_none() {
        return;
    }
    xml.begin("UnitDefinitions", &[]);
    for (name, factor, exponents) in units.iter() {
        xml.begin("Unit", &[text("name", name)]);
        let mut attributes: Vec<Attribute<'_>> = BASES
            .iter()
            .zip(exponents)
            .filter(|(_, exponent)| **exponent != 0)
            .map(|(base, exponent)| text(base, exponent.to_string()))
            .collect();
        if factor != 1.0 {
            attributes.push(number("factor", factor));
        }
        xml.element("BaseUnit", &attributes);
        xml.end();
    }
    xml.end();
}

fn log_categories(xml: &mut Xml) {
    xml.begin("LogCategories", &[]);
    for (name, description) in LOG_CATEGORIES {
        xml.element("Category", &[text("name", name), text("description", description)]);
    }
    xml.end();
}

/// Categories of messages, and their meanings.
const LOG_CATEGORIES: [(&str, &str); 4] = [
    ("logStatusError", "calls that failed, and why"),
    ("logStatusWarning", "warnings of the scene when it is loaded"),
    ("logEvents", "messages of scripts; why a simulation ended"),
    ("logTrace", "hash of all states of the run, when it ends"),
];

fn default_experiment(xml: &mut Xml, of: &Description<'_>) {
    let attributes = [number("startTime", 0.0), number("stopTime", of.stop_time), number("stepSize", of.step_size)];
    xml.element("DefaultExperiment", &attributes);
}
