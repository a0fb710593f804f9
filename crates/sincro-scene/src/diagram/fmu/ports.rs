//! Ports of an FMU: which variables they are, how wide, in which unit.
//!
//! A port carries SI units, or the unit that the block's `units` give it; the values of the FMU are converted on the
//! way in and out: `port = factor·value + offset`.

use sincro_blocks::reader::Reader;
use sincro_blocks::unit::Unit;

use crate::fmu::{FmuDimension, FmuModel, FmuUnit, FmuVariable};
use crate::suggest;

/// Largest number of components of one port.
const MAX_WIDTH: usize = 1_000_000;

/// Port or parameter of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Port {
    /// Name of the port.
    pub name: String,
    /// Index of the variable.
    pub place: usize,
    /// Number of components.
    pub width: usize,
    /// Unit of the port; none if it is not known.
    pub unit: Option<Unit>,
    /// `port = factor·value + offset`.
    factor: f64,
    offset: f64,
}

impl Port {
    /// Number for the FMU of the number at the port.
    pub fn to_fmu(&self, x: f64) -> f64 {
        // an exact copy where nothing is converted
        if self.factor == 1.0 && self.offset == 0.0 { x } else { (x - self.offset) / self.factor }
    }

    /// Number at the port of the number of the FMU.
    pub fn of_fmu(&self, x: f64) -> f64 {
        if self.factor == 1.0 && self.offset == 0.0 { x } else { self.factor * x + self.offset }
    }

    /// Change at the port per change of the number of the FMU.
    pub fn factor(&self) -> f64 {
        self.factor
    }
}

/// Reads the ports and parameters of a block, with what they have in common: the FMU, its structural parameters, and
/// the units that were asked for.
pub(super) struct PortReader<'a> {
    model: &'a dyn FmuModel,
    /// Values of structural parameters, by the index of the variable.
    structure: Vec<(usize, f64)>,
    /// Names with units.
    units: Vec<(String, String)>,
    used: Vec<bool>,
}

impl<'a> PortReader<'a> {
    pub fn new(p: &mut Reader<'_>, model: &'a dyn FmuModel, given: &[(String, Vec<f64>)]) -> Self {
        let units = if p.has("units") { p.named_texts("units") } else { Vec::new() };
        let is_structural = |v: &FmuVariable| v.causality == "structuralParameter";
        let of_file = model.variables().iter().enumerate().filter(|(_, v)| is_structural(v));
        let structure = of_file.map(|(k, v)| {
            let set = given.iter().find(|(name, values)| *name == v.name && values.len() == 1);
            (k, set.map_or(v.start.unwrap_or(0.0), |(_, values)| values[0]))
        });
        Self { model, structure: structure.collect(), used: vec![false; units.len()], units }
    }

    /// Ports of one causality: those that are named, or all.
    pub fn ports(&mut self, p: &mut Reader<'_>, key: &str, causality: &str) -> Vec<Port> {
        let variables = self.model.variables();
        let places: Vec<usize> = if p.has(key) {
            p.texts(key).iter().filter_map(|name| self.place(p, key, name, &[causality])).collect()
        } else {
            let is_port = |v: &FmuVariable| v.causality == causality && !v.is_clock;
            (0..variables.len()).filter(|k| is_port(&variables[*k])).collect()
        };
        let mut ports: Vec<Port> = Vec::new();
        for k in places {
            let port = self.port(p, key, k);
            if ports.iter().any(|known| known.name == port.name) {
                let help = format!("give `{key}` with one of them");
                p.fault(key, format!("two {causality}s of the FMU would be the port `{}`", port.name), help);
            }
            ports.push(port);
        }
        ports
    }

    /// Parameters with their values, in the units of the variables: structural ones first.
    pub fn parameters(&mut self, p: &mut Reader<'_>, given: &[(String, Vec<f64>)]) -> Vec<(usize, Vec<f64>)> {
        let mut parameters = Vec::new();
        for (name, values) in given {
            let causalities = ["parameter", "structuralParameter", "input", "local", "output"];
            let Some(k) = self.place(p, "parameters", name, &causalities) else { continue };
            let port = self.port(p, "parameters", k);
            let is_structural = self.model.variables()[k].causality == "structuralParameter";
            if values.len() != port.width {
                let message = format!("`{name}` of the FMU has {} numbers, {} are given", port.width, values.len());
                p.fault("parameters", message, "give as many, those of a matrix row by row");
                continue;
            }
            let values = values.iter().map(|x| port.to_fmu(*x)).collect();
            parameters.insert(if is_structural { 0 } else { parameters.len() }, (k, values));
        }
        parameters
    }

    /// Faults of units that belong to nothing.
    pub fn finish(self, p: &mut Reader<'_>) {
        for ((name, _), _) in self.units.iter().zip(&self.used).filter(|(_, used)| !**used) {
            let known: Vec<&str> = self.model.variables().iter().map(|v| &*v.name).collect();
            let help = suggest::help(name, &known, "there are");
            p.fault("units", format!("no port or parameter of the block is `{name}`"), help);
        }
    }

    /// Number of components of a variable.
    pub fn width(&self, variable: &FmuVariable) -> usize {
        let size = |dimension: &FmuDimension| match *dimension {
            FmuDimension::Fixed(n) => n,
            FmuDimension::Parameter(k) => {
                self.structure.iter().find(|(of, _)| *of == k).map_or(0, |(_, n)| *n as usize)
            }
        };
        variable.dimensions.iter().map(size).fold(1, usize::saturating_mul)
    }

    /// Place of a variable that is named.
    fn place(&self, p: &mut Reader<'_>, key: &str, name: &str, causalities: &[&str]) -> Option<usize> {
        let variables = self.model.variables();
        let fits = |v: &FmuVariable| causalities.contains(&&*v.causality);
        let found = variables.iter().position(|v| v.name == name && fits(v));
        if found.is_none() {
            let known: Vec<&str> = variables.iter().filter(|v| fits(v)).map(|v| &*v.name).collect();
            let help = suggest::help(name, &known, "there are");
            p.fault(key, format!("the FMU has no {} `{name}`", causalities[0]), help);
        }
        found
    }

    fn port(&mut self, p: &mut Reader<'_>, key: &str, place: usize) -> Port {
        let variable = &self.model.variables()[place];
        let width = self.width(variable);
        if width > MAX_WIDTH {
            p.fault(key, format!("`{}` of the FMU has {width} numbers", variable.name), "take smaller dimensions");
        }
        let name = port_name(&variable.name);
        let is_asked = |(asked, _): &&(String, String)| *asked == variable.name || *asked == name;
        let asked = self.units.iter().position(|entry| is_asked(&entry));
        let mut wanted = None;
        if let Some(k) = asked {
            self.used[k] = true;
            match Unit::parse(&self.units[k].1) {
                Ok(unit) => wanted = Some(unit),
                Err(message) => p.fault("units", message, "units are products such as N·m/rad, m/s^2, kg·m²"),
            }
        }
        let (unit, factor, offset) = match conversion(variable.unit.as_ref(), wanted.as_ref()) {
            Ok(found) => found,
            Err(message) => {
                p.fault("units", format!("`{}` of the FMU {message}", variable.name), "give a unit of the same kind");
                (None, 1.0, 0.0)
            }
        };
        Port { name, place, width: width.min(MAX_WIDTH), unit, factor, offset }
    }
}

/// Unit of a port, with factor and offset from the number of the FMU to that of the port.
fn conversion(unit: Option<&FmuUnit>, wanted: Option<&Unit>) -> Result<(Option<Unit>, f64, f64), String> {
    let Some(unit) = unit else { return Ok((wanted.cloned(), 1.0, 0.0)) };
    let own = Unit::parse(&unit.name.replace('.', "·")).ok();
    let Some(base) = unit.base else { return of_known(unit, own, wanted) };
    let exponents: [i8; 6] = std::array::from_fn(|k| base.exponents[k]);
    let offset = if unit.is_relative { 0.0 } else { base.offset };
    if base.exponents[6..] != [0, 0] {
        // moles and candelas: converted, but no unit that is compared
        return match wanted {
            Some(wanted) => Err(format!("is in {}, which cannot be converted to {wanted}", unit.name)),
            None => Ok((None, base.factor, offset)),
        };
    }
    if let Some(wanted) = wanted {
        let (size, dimension) = wanted.dimension();
        if dimension != exponents {
            return Err(format!("is in {}, which cannot be converted to {wanted}", unit.name));
        }
        return Ok((Some(wanted.clone()), base.factor / size, offset / size));
    }
    // its own name, where that is the SI unit
    let is_own = |own: &Unit| own.dimension() == (1.0, exponents);
    let plain = own.filter(is_own).map_or_else(|| Unit::parse(&si_text(exponents)), Ok);
    Ok((plain.ok(), base.factor, offset))
}

/// The same for a unit that the FMU does not define: by its name.
fn of_known(unit: &FmuUnit, own: Option<Unit>, wanted: Option<&Unit>) -> Result<(Option<Unit>, f64, f64), String> {
    let Some(own) = own else {
        return match wanted {
            Some(wanted) => Err(format!("is in {}, which the FMU does not define: no way to {wanted}", unit.name)),
            None => Ok((None, 1.0, 0.0)),
        };
    };
    let (factor, exponents) = own.dimension();
    match wanted {
        Some(wanted) if wanted.dimension().1 == exponents => {
            Ok((Some(wanted.clone()), factor / wanted.dimension().0, 0.0))
        }
        Some(wanted) => Err(format!("is in {}, which cannot be converted to {wanted}", unit.name)),
        None if factor == 1.0 => Ok((Some(own), 1.0, 0.0)),
        None => Ok((Unit::parse(&si_text(exponents)).ok(), factor, 0.0)),
    }
}

/// Product of SI units with these exponents of kilogram, metre, second, ampere, kelvin, radian.
fn si_text(exponents: [i8; 6]) -> String {
    let factors = ["kg", "m", "s", "A", "K", "rad"].iter().zip(exponents).filter(|(_, e)| *e != 0);
    let text = factors.map(|(symbol, e)| format!("{symbol}^{e}")).collect::<Vec<_>>().join("·");
    let text = text.replace("^1·", "·");
    let text = text.strip_suffix("^1").map_or(text.clone(), str::to_owned);
    if text.is_empty() { "1".to_owned() } else { text }
}

/// Name of a port: letters, digits and `_`.
fn port_name(variable: &str) -> String {
    let plain: String = variable.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let plain = plain.trim_matches('_');
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain.to_owned() } else { format!("p{plain}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmu::FmuBaseUnit;

    fn unit(name: &str, exponents: [i8; 8], factor: f64, offset: f64) -> FmuUnit {
        FmuUnit { name: name.into(), base: Some(FmuBaseUnit { exponents, factor, offset }), is_relative: false }
    }

    #[test]
    fn values_are_converted_to_si_or_to_what_is_asked_for() {
        let celsius = unit("degC", [0, 0, 0, 0, 1, 0, 0, 0], 1.0, 273.15);
        let (si, factor, offset) = conversion(Some(&celsius), None).unwrap();
        assert_eq!((si.unwrap().to_string(), factor, offset), ("K".to_owned(), 1.0, 273.15));
        let difference = FmuUnit { is_relative: true, ..celsius.clone() };
        assert_eq!(conversion(Some(&difference), None).unwrap().2, 0.0);
        let speed = unit("km/h", [0, 1, -1, 0, 0, 0, 0, 0], 1.0 / 3.6, 0.0);
        let (si, factor, _) = conversion(Some(&speed), None).unwrap();
        assert_eq!((si.unwrap().to_string(), factor), ("m·s^-1".to_owned(), 1.0 / 3.6));
        let millimetres = Unit::parse("mm/s").unwrap();
        assert_eq!(conversion(Some(&speed), Some(&millimetres)).unwrap().1, 1.0 / 3.6 / 1e-3);
        let refused = conversion(Some(&celsius), Some(&millimetres)).unwrap_err();
        assert_eq!(refused, "is in degC, which cannot be converted to mm/s");
        let torque = unit("N.m", [1, 2, -2, 0, 0, 0, 0, 0], 1.0, 0.0);
        assert_eq!(conversion(Some(&torque), None).unwrap().0.unwrap().to_string(), "N·m");
        let amount = unit("mol", [0, 0, 0, 0, 0, 0, 1, 0], 1.0, 0.0);
        assert_eq!(conversion(Some(&amount), None).unwrap(), (None, 1.0, 0.0));
    }

    #[test]
    fn units_that_are_not_defined_go_by_their_names() {
        let degrees = FmuUnit { name: "deg".into(), base: None, is_relative: false };
        let (si, factor, _) = conversion(Some(&degrees), None).unwrap();
        assert_eq!((si.unwrap().to_string(), factor), ("rad".to_owned(), std::f64::consts::PI / 180.0));
        let parsecs = FmuUnit { name: "pc".into(), base: None, is_relative: false };
        assert_eq!(conversion(Some(&parsecs), None).unwrap(), (None, 1.0, 0.0));
        assert!(conversion(Some(&parsecs), Some(&Unit::parse("m").unwrap())).unwrap_err().contains("not define"));
    }

    #[test]
    fn names_of_ports_are_plain() {
        assert_eq!(port_name("der(x)"), "der_x");
        assert_eq!(port_name("a.b[1,2]"), "a_b_1_2");
        assert_eq!(port_name("1st"), "p1st");
    }
}
