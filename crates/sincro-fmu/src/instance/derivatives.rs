//! Partial derivatives of the equations: d(ẋ, y)/d(x, u) along a direction, exact by dual numbers.
//!
//! What is sampled (samples of discrete blocks, latched commands) is held, as it is between two ticks. An output that
//! is no function of dual numbers (the load of a joint) is differentiated by central differences.

use sincro_dynamics::model::Model;
use sincro_math::Dual;
use sincro_scene::record::Probe;
use sincro_sim::diagram_controller::DiagramController;

use super::Instance;
use super::equations::{Equations, Watch};
use super::exchange::Exchange;
use crate::variables::Role;

/// Step of central differences, relative to the value or 1: the cube root of the rounding of a double.
const DIFFERENCE: f64 = 6e-6;

/// Quantity that is differentiated: index of an output, or of a state whose rate it is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Unknown {
    Output(usize),
    Rate(usize),
}

/// Quantity by which is differentiated: index of a state, or of a command that is an input.
#[derive(Clone, Copy, Debug)]
pub(super) enum Known {
    State(usize),
    Input(usize),
}

/// The equations on dual numbers.
#[derive(Debug)]
pub(super) struct Duals {
    equations: Equations<Dual<1>>,
    control: Option<DiagramController<Dual<1>>>,
    /// True if samples and memory of `control` are those of the equations on plain numbers.
    pub is_current: bool,
    x: Vec<Dual<1>>,
    commands: Vec<Dual<1>>,
    rates: Vec<Dual<1>>,
    probes: Vec<Probe>,
    outputs: Vec<Option<Dual<1>>>,
}

impl Exchange {
    /// Writes the derivatives of the unknowns along the direction `seed` of the knowns.
    ///
    /// # Errors
    ///
    /// A value beside the present state, which central differences need, cannot be computed.
    pub(super) fn directional(
        &mut self,
        unknowns: &[Unknown],
        knowns: &[Known],
        seed: &[f64],
        out: &mut [f64],
    ) -> Result<(), String> {
        if seed.iter().all(|s| *s == 0.0) {
            out.fill(0.0);
            return Ok(());
        }
        let missing = self.exact(unknowns, knowns, seed, out);
        if missing.is_empty() {
            return Ok(());
        }
        let rest: Vec<Unknown> = missing.iter().map(|k| unknowns[*k]).collect();
        for (k, x) in missing.into_iter().zip(self.differences(&rest, knowns, seed)?) {
            out[k] = x;
        }
        Ok(())
    }

    /// Writes the derivatives by dual numbers; returns the places of those that have none.
    fn exact(&mut self, unknowns: &[Unknown], knowns: &[Known], seed: &[f64], out: &mut [f64]) -> Vec<usize> {
        let mut duals = self.duals.take().unwrap_or_else(|| Box::new(self.on_duals()));
        let constant = |to: &mut Vec<Dual<1>>, from: &[f64]| {
            to.clear();
            to.extend(from.iter().map(|x| Dual::constant(*x)));
        };
        constant(&mut duals.x, &self.x);
        constant(&mut duals.commands, &self.latched);
        for (known, s) in knowns.iter().zip(seed) {
            match *known {
                Known::State(k) => duals.x[k].partials[0] += s,
                Known::Input(k) => duals.commands[k].partials[0] += s,
            }
        }
        duals.probes.clear();
        duals.probes.extend(unknowns.iter().filter_map(|unknown| match *unknown {
            Unknown::Output(k) => Some(self.probes[k]),
            Unknown::Rate(_) => None,
        }));
        if !duals.is_current {
            let model = self.world.model();
            duals.control = self.control.as_ref().map(|control| DiagramController::cast_from(control, model));
            duals.is_current = true;
        }
        duals.evaluate(self.t);
        let mut outputs = duals.outputs.iter();
        let mut missing = Vec::new();
        for (k, unknown) in unknowns.iter().enumerate() {
            let found = match *unknown {
                Unknown::Rate(state) => Some(duals.rates[state]),
                Unknown::Output(_) => outputs.next().copied().flatten(),
            };
            match found.map(|x| x.partials[0]).filter(|partial| partial.is_finite()) {
                Some(partial) => out[k] = partial,
                None => missing.push(k),
            }
        }
        self.duals = Some(duals);
        missing
    }

    fn on_duals(&self) -> Duals {
        let model = Model::<Dual<1>>::pack(&[self.world.model()]).expect("one model has one structure");
        let n_z = self.control.as_ref().map_or(0, |control| control.runner.state.continuous.len());
        Duals {
            equations: Equations::new(model, &self.world.state, n_z),
            control: None,
            is_current: false,
            x: Vec::new(),
            commands: Vec::new(),
            rates: vec![Dual::constant(0.0); self.x.len()],
            probes: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Derivatives by central differences; states and inputs keep their values.
    fn differences(&mut self, unknowns: &[Unknown], knowns: &[Known], seed: &[f64]) -> Result<Vec<f64>, String> {
        let (x, latched) = (self.x.clone(), self.latched.clone());
        let before = |known: &Known| match *known {
            Known::State(k) => x[k],
            Known::Input(k) => latched[k],
        };
        let largest =
            seed.iter().zip(knowns).fold(0.0, |l: f64, (s, known)| l.max(s.abs() / before(known).abs().max(1.0)));
        let h = DIFFERENCE / largest;
        let mut side = |by: f64| -> Result<Vec<f64>, String> {
            let (mut moved, mut commands) = (x.clone(), latched.clone());
            for (known, s) in knowns.iter().zip(seed) {
                match *known {
                    Known::State(k) => moved[k] += by * s,
                    Known::Input(k) => commands[k] += by * s,
                }
            }
            self.latched.copy_from_slice(&commands);
            self.set_states(&moved)?;
            let mut rates = vec![0.0; moved.len()];
            self.derivatives(&mut rates)?;
            let value = |unknown: &Unknown| match *unknown {
                Unknown::Output(k) => self.output(k),
                Unknown::Rate(k) => rates[k],
            };
            Ok(unknowns.iter().map(value).collect())
        };
        let (plus, minus) = (side(h), side(-h));
        self.latched.copy_from_slice(&latched);
        self.set_states(&x)?;
        Ok(plus?.iter().zip(minus?).map(|(plus, minus)| (plus - minus) / (2.0 * h)).collect())
    }
}

impl Duals {
    fn evaluate(&mut self, t: f64) {
        self.equations.place(&self.x, &self.commands);
        self.outputs.clear();
        self.outputs.resize(self.probes.len(), None);
        let control = self.control.as_mut();
        let watch = &mut Watch { control, probes: &self.probes, values: &mut self.outputs };
        self.equations.evaluate(t, watch);
        self.equations.derivatives(&self.x, &mut self.rates);
    }
}

impl Instance {
    /// Writes the derivatives of the unknowns (outputs, derivatives of states) along the direction `seed` of the knowns
    /// (states, inputs) into `sensitivity`, of the continuous equations at the present instant. Both are given by value
    /// references; `seed[k]` is the change of known k, `sensitivity[k]` that of unknown k, in their units. States and
    /// inputs keep their values. In co-simulation the instant is the communication point, and inputs are those that act
    /// from there on.
    ///
    /// Derivatives are exact; by central differences, to about nine digits, are outputs that are the load of a joint.
    ///
    /// # Errors
    ///
    /// There is no variable of a reference, a known is neither a state nor an input, an unknown is neither an output
    /// nor a derivative, the FMU was exported without model exchange, or a value cannot be computed.
    ///
    /// # Panics
    ///
    /// `sensitivity` is shorter than the unknowns.
    pub fn directional_derivative(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), String> {
        let (unknowns, knowns) = (self.unknowns(unknowns)?, self.knowns(knowns)?);
        self.equations()?.directional(&unknowns, &knowns, seed, sensitivity)
    }

    /// Writes the sensitivity of the sum of `seed[k]` times unknown k to each known into `sensitivity`: the product of
    /// the transposed matrix of derivatives and `seed`. Otherwise as [`Instance::directional_derivative`].
    ///
    /// # Errors
    ///
    /// As [`Instance::directional_derivative`].
    ///
    /// # Panics
    ///
    /// `sensitivity` is shorter than the knowns.
    pub fn adjoint_derivative(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), String> {
        let (unknowns, knowns) = (self.unknowns(unknowns)?, self.knowns(knowns)?);
        let equations = self.equations()?;
        let mut column = vec![0.0; unknowns.len()];
        for (known, sum) in knowns.iter().zip(sensitivity) {
            equations.directional(&unknowns, &[*known], &[1.0], &mut column)?;
            *sum = column.iter().zip(seed).map(|(x, s)| x * s).sum();
        }
        Ok(())
    }

    fn unknowns(&self, references: &[u32]) -> Result<Vec<Unknown>, String> {
        self.roles(references, "neither an output nor a derivative", |role| match *role {
            Role::Output(k) => Some(Unknown::Output(k)),
            Role::Derivative(k) => Some(Unknown::Rate(k)),
            _ => None,
        })
    }

    fn knowns(&self, references: &[u32]) -> Result<Vec<Known>, String> {
        self.roles(references, "neither a state nor an input", |role| match *role {
            Role::State(k) => Some(Known::State(k)),
            Role::Input(k) => Some(Known::Input(k)),
            _ => None,
        })
    }

    fn roles<T>(&self, references: &[u32], wanted: &str, pick: impl Fn(&Role) -> Option<T>) -> Result<Vec<T>, String> {
        let one = |vr: &u32| {
            let variable = self.catalogue.variables.get(*vr as usize);
            let variable = variable.ok_or_else(|| format!("there is no variable {vr}"))?;
            pick(&variable.role).ok_or_else(|| format!("`{}` is {wanted}", variable.name))
        };
        references.iter().map(one).collect()
    }
}
