//! Deduction of the units that nobody declared, for display: along wires and against them, by the
//! [`UnitRule`] of each block, component by component.
//!
//! Units that are declared or follow by `Block::units` stand (`units.rs`). All others are claimed by the blocks at both
//! ends of a wire and by the commands of the world. A component whose claims disagree stays without unit, and nothing
//! is deduced from it: a diagram may leave out factors of one with a unit, such as 1/s, so disagreement is no error.

use std::borrow::Cow;

use super::{EARLY, Flat, Input, LATE};
use crate::unit::{Unit, UnitsOfFormulas};
use crate::unit_rule::UnitRule;

/// Units of the components of all outputs, by node; `None` where unknown.
pub(super) type ComponentUnits = Vec<Vec<Option<Unit>>>;

/// Completes `known`, the units of the components of all outputs as far as they are declared or compared.
pub(super) fn deduce(flat: &Flat, order: &[usize], known: ComponentUnits) -> ComponentUnits {
    let rules: Vec<UnitRule> =
        flat.nodes.iter().map(|n| n.template.as_ref().map_or(UnitRule::Unknown, |t| t.unit_rule())).collect();
    let begins = flat.nodes.iter().map(|n| begins(&n.out_widths)).collect();
    let mut deduction = Deduction { flat, order, rules, begins, known, disputed: Vec::new() };
    loop {
        let found = deduction.fill();
        // a claim may come after another one was believed: all are heard again in the end
        let mut disputes = Vec::new();
        deduction.claims(&found, &mut |(node, component), unit| {
            let is_known = deduction.known[node][component].is_some();
            if !is_known && found[node][component].as_ref().is_some_and(|u| !u.is_same(unit)) {
                disputes.push((node, component));
            }
        });
        if disputes.is_empty() {
            return found;
        }
        deduction.disputed.append(&mut disputes);
    }
}

/// First component of each port.
fn begins(widths: &[Option<usize>]) -> Vec<usize> {
    let mut at = 0;
    let begin = |width: &Option<usize>| {
        at += width.unwrap_or(0);
        at - width.unwrap_or(0)
    };
    widths.iter().map(begin).collect()
}

/// Component of the outputs of a node.
type Place = (usize, usize);

/// Receiver of claims: a component and the unit that a block at one end of its wires gives it.
type Claimant<'c> = dyn FnMut(Place, &Unit) + 'c;

struct Deduction<'a> {
    flat: &'a Flat,
    order: &'a [usize],
    rules: Vec<UnitRule>,
    /// First component of each output port, by node.
    begins: Vec<Vec<usize>>,
    known: ComponentUnits,
    /// Components whose claims disagree.
    disputed: Vec<Place>,
}

impl Deduction<'_> {
    /// All units that follow without a disputed one, by claims until nothing is new.
    fn fill(&self) -> ComponentUnits {
        let mut found = self.known.clone();
        loop {
            let mut new: Vec<(Place, Unit)> = Vec::new();
            self.claims(&found, &mut |place, unit| {
                if found[place.0][place.1].is_none() && !self.disputed.contains(&place) {
                    new.push((place, unit.clone()));
                }
            });
            if new.is_empty() {
                return found;
            }
            for ((node, component), unit) in new {
                found[node][component].get_or_insert(unit);
            }
        }
    }

    /// Every unit that a block or command gives to a component, from the units found so far.
    fn claims(&self, found: &ComponentUnits, claim: &mut Claimant<'_>) {
        for &n in self.order.iter().filter(|&&n| n != EARLY && n != LATE) {
            let inputs: Vec<Vec<Place>> = self.flat.nodes[n].inputs.iter().map(|i| self.components(i)).collect();
            self.of_block(n, &inputs, found, claim);
        }
        let world = &self.flat.nodes[LATE];
        for (input, unit) in world.inputs.iter().zip(&world.in_units) {
            if let Some(unit) = unit {
                self.components(input).into_iter().for_each(|place| claim(place, unit));
            }
        }
    }

    /// Components that an input reads.
    fn components(&self, input: &Input) -> Vec<Place> {
        let begin = self.begins[input.node][input.port];
        let width = self.flat.nodes[input.node].out_widths[input.port].unwrap_or(0);
        let range = input.range.clone().unwrap_or(0..width);
        range.map(|k| (input.node, begin + k)).collect()
    }

    fn of_block(&self, n: usize, inputs: &[Vec<Place>], found: &ComponentUnits, claim: &mut Claimant<'_>) {
        let unit = |(node, component): Place| found[node][component].as_ref();
        let outputs: Vec<Place> = (0..found[n].len()).map(|k| (n, k)).collect();
        // a scalar counts for all components
        let component =
            |input: &[Place], k: usize| if input.len() == 1 { input[0] } else { input[k.min(input.len() - 1)] };
        match &self.rules[n] {
            UnitRule::Unknown => {}
            UnitRule::Same(ports) => {
                for (k, &output) in outputs.iter().enumerate() {
                    let places = ports.iter().map(|&port| component(&inputs[port], k)).chain([output]);
                    agree(&places.collect::<Vec<_>>(), &unit, claim);
                }
            }
            UnitRule::Uniform => agree(&[inputs.concat(), outputs].concat(), &unit, claim),
            UnitRule::InOrder => {
                let pairs = inputs.iter().flatten().zip(&outputs);
                pairs.for_each(|(input, output)| agree(&[*input, *output], &unit, claim));
            }
            UnitRule::Components(indices) => {
                let pairs = indices.iter().filter_map(|&k| inputs[0].get(k)).zip(&outputs);
                pairs.for_each(|(input, output)| agree(&[*input, *output], &unit, claim));
            }
            UnitRule::TimesSeconds(powers) => {
                for (port, &power) in powers.iter().enumerate() {
                    let begin = self.begins[n][port];
                    for k in 0..self.flat.nodes[n].out_widths[port].unwrap_or(0) {
                        let (input, output) = (component(&inputs[0], k), (n, begin + k));
                        times_seconds(unit(input), power).inspect(|u| claim(output, u));
                        times_seconds(unit(output), -power).inspect(|u| claim(input, u));
                    }
                }
            }
            UnitRule::Powers(powers) => {
                for (k, &output) in outputs.iter().enumerate() {
                    let factors = inputs.iter().map(|input| unit(component(input, k)));
                    product(factors.zip(powers.iter().copied())).inspect(|u| claim(output, u));
                }
            }
            UnitRule::SquareRoot => {
                for (k, &output) in outputs.iter().enumerate() {
                    let input = component(&inputs[0], k);
                    unit(input).and_then(Unit::sqrt).inspect(|u| claim(output, u));
                    product([(unit(output), 2)].into_iter()).inspect(|u| claim(input, u));
                }
            }
            UnitRule::SumOfProducts => {
                let factors = inputs.iter().map(|input| (shared(input, &unit), 1));
                product(factors).inspect(|u| outputs.iter().for_each(|&output| claim(output, u)));
            }
            UnitRule::Formulas(formulas) => {
                for (k, &output) in outputs.iter().enumerate() {
                    let of_inputs = inputs.iter().map(|input| unit(component(input, k)).cloned());
                    let names: Vec<Option<Unit>> = of_inputs.chain([Unit::parse("s").ok()]).collect();
                    let formula = formulas.get(if formulas.len() == 1 { 0 } else { k });
                    formula.and_then(|f| f.unit(&UnitsOfFormulas, &names)).inspect(|u| claim(output, u));
                }
            }
            UnitRule::Fixed(units) => {
                for (k, &output) in outputs.iter().enumerate() {
                    let fixed = units.get(if units.len() == 1 { 0 } else { k });
                    fixed.and_then(Option::as_ref).inspect(|u| claim(output, u));
                }
            }
        }
    }
}

/// Claims for all of these components the unit that is known of one of them.
fn agree<'u>(places: &[Place], unit: &impl Fn(Place) -> Option<&'u Unit>, claim: &mut Claimant<'_>) {
    for known in places.iter().filter_map(|&place| unit(place)) {
        places.iter().for_each(|&place| claim(place, known));
    }
}

/// Unit that all components have; `None` if one is unknown or two differ.
fn shared<'u>(places: &[Place], unit: &impl Fn(Place) -> Option<&'u Unit>) -> Option<&'u Unit> {
    let first = unit(*places.first()?)?;
    places.iter().all(|&place| unit(place).is_some_and(|u| u.is_same(first))).then_some(first)
}

fn product<'u>(factors: impl Iterator<Item = (Option<&'u Unit>, i8)>) -> Option<Unit> {
    let factors: Option<Vec<(&Unit, i8)>> = factors.map(|(unit, power)| Some((unit?, power))).collect();
    Unit::product(&factors?)
}

fn times_seconds(unit: Option<&Unit>, power: i8) -> Option<Cow<'_, Unit>> {
    let second = Unit::parse("s").expect("a base unit");
    match power {
        0 => unit.map(Cow::Borrowed),
        _ => Unit::product(&[(unit?, 1), (&second, power)]).map(Cow::Owned),
    }
}

#[cfg(test)]
mod tests {
    use crate::compile::{Interface, Terminal, compile};
    use crate::diagram::Diagram;
    use crate::library::continuous::Integrator;
    use crate::library::maths::{Gain, Product, Sqrt, Sum};
    use crate::library::routing::{Mux, Selector};
    use crate::library::sources::Constant;
    use crate::unit::Unit;

    fn world() -> Interface {
        let terminal = |name: &str, unit: &str| Terminal {
            names: vec![name.into()],
            width: 1,
            unit: Unit::parse(unit).ok(),
            is_special: false,
        };
        let mut world = Interface::new(0.001);
        world.measurements = vec![terminal("/joint.position", "rad"), terminal("/joint.velocity", "rad/s")];
        world.commands = vec![terminal("/joint", "N·m")];
        world
    }

    fn units(diagram: &Diagram, name: &str) -> Vec<String> {
        let program = compile(diagram, &world()).unwrap();
        let (.., units) = program.outputs().find(|(path, ..)| path == name).unwrap();
        units.iter().map(|unit| unit.as_ref().map_or("", Unit::text).to_owned()).collect()
    }

    fn declare(diagram: &mut Diagram, name: &str, units: &[&str]) {
        let entry = diagram.entries.iter_mut().find(|e| e.name == name).unwrap();
        entry.unit = units.iter().map(|&unit| unit.to_owned()).collect();
    }

    /// A PID controller of blocks: kp·e + ki·∫e − kd·ω.
    fn controller() -> Diagram {
        let mut d = Diagram::new();
        d.block("target", Constant::new(1.0)).block("error", Sum::new("+-")).block("total", Integrator::new(0.0));
        d.block("kp", Gain::new(3.0)).block("ki", Gain::new(2.0)).block("kd", Gain::new(1.0));
        d.block("torque", Sum::new("++-"));
        d.wire("target", "error.u1").wire("/joint.position", "error.u2").wire("error", "kp").wire("error", "total");
        d.wire("total", "ki").wire("/joint.velocity", "kd");
        d.wire("kp", "torque.u1").wire("ki", "torque.u2").wire("kd", "torque.u3").wire("torque", "/joint");
        d
    }

    #[test]
    fn a_controller_of_gains_has_units_from_both_its_ends() {
        let d = controller();
        for (name, unit) in [("target", "rad"), ("error", "rad"), ("total", "rad·s")] {
            assert_eq!(units(&d, name), [unit], "{name}");
        }
        for name in ["kp", "ki", "kd", "torque"] {
            assert_eq!(units(&d, name), ["N·m"], "{name}");
        }
    }

    #[test]
    fn claims_that_disagree_leave_no_unit_and_are_no_error() {
        // an integral and its integrand are added as if a factor of 1/s stood between them
        let mut d = Diagram::new();
        d.block("rate", Gain::new(2.0)).block("x", Integrator::new(0.0)).block("sum", Sum::new("++"));
        d.block("y", Gain::new(1.0)).wire("/joint.velocity", "rate").wire("rate", "x").wire("x", "sum.u1");
        d.wire("rate", "sum.u2").wire("sum", "y");
        declare(&mut d, "rate", &["rad/s"]);
        assert_eq!(units(&d, "sum"), ["rad/s"]); // known of one of them: `units.rs`
        assert_eq!(units(&d, "x"), [""]);
        assert_eq!(units(&d, "y"), [""]);
    }

    #[test]
    fn products_roots_and_pieces_of_vectors_have_units() {
        let mut d = Diagram::new();
        d.block("square", Product::new(2)).block("root", Sqrt).block("both", Mux::new(2));
        d.block("second", Selector::new(&[1])).block("sum", Sum::new("++"));
        d.wire("/joint.velocity", "square.u1").wire("/joint.velocity", "square.u2").wire("square", "root");
        d.wire("/joint.position", "both.u1").wire("root", "both.u2").wire("both", "second");
        d.wire("both[0]", "sum.u1").wire("/joint.position", "sum.u2");
        assert_eq!(units(&d, "square"), ["rad²/s²"]);
        assert_eq!(units(&d, "root"), ["rad/s"]);
        assert_eq!(units(&d, "both"), ["rad", "rad/s"]);
        assert_eq!(units(&d, "second"), ["rad/s"]);
    }

    #[test]
    fn every_component_may_have_a_declared_unit_of_its_own() {
        let mut d = Diagram::new();
        d.block("pair", Constant { value: vec![1.0, 2.0] }).block("sum", Sum::new("++"));
        d.wire("pair[0]", "sum.u1").wire("/joint.position", "sum.u2");
        declare(&mut d, "pair", &["rad", "m/s"]);
        assert_eq!(units(&d, "pair"), ["rad", "m/s"]);
        declare(&mut d, "pair", &["rad", "m", "m"]);
        let problem = compile(&d, &world()).unwrap_err().iter().next().unwrap().to_string();
        assert!(problem.contains("`pair` has 3 units for 2 components"), "{problem}");
    }
}
