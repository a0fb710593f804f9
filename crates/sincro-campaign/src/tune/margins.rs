//! Stability margins of the loops of a scene, opened at the commands that its diagram gives, at the end of a run,
//! where it has settled if it does.
//!
//! A sampled loop is opened by the run itself ([`open_loops`]). A continuous one follows from the closed loop: what is
//! added to a command appears on it with the sensitivity S = 1/(1 + L). With S = (A, B, C, 1) the open loop is
//! L = S⁻¹ − 1 = (A − BC, B, −C, 0).

use sincro_analysis::linear::{Axis, StateSpace};
use sincro_analysis::linearize::{Request, linearize, open_loops, openable_signals, operating_point};
use sincro_figures::plot::number::significant;
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_scene::record::Probe;
use sincro_sim::Loaded;

/// Margins of one loop; a loop without a crossover has none of that kind.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopMargin {
    /// Signal at which the loop is opened.
    pub signal: String,
    /// Gain margin nearest to 0 dB `[dB]`.
    pub gain_db: Option<f64>,
    /// Phase margin nearest to 0° `[°]`.
    pub phase_deg: Option<f64>,
    /// Modulus margin: smallest distance of the frequency response of the open loop from −1 (dimensionless).
    pub modulus: f64,
}

impl LoopMargin {
    /// Words for the terminal, such as `12 dB, 48°, modulus 0.62`.
    #[must_use]
    pub fn words(&self) -> String {
        let gain = self.gain_db.map_or_else(|| "no gain margin".into(), |x| format!("{} dB", significant(x, 3)));
        let phase = self.phase_deg.map_or_else(|| "no phase margin".into(), |x| format!("{}°", significant(x, 3)));
        format!("{gain}, {phase}, modulus {}", significant(self.modulus, 3))
    }
}

/// Returns the margins of each loop that the diagram of a scene closes by its commands, at the end of the run; empty
/// without a diagram, or where no loop can be opened: a saturated block opens it.
#[must_use]
pub fn margins(loaded: &Loaded) -> Vec<LoopMargin> {
    let Ok(at) = operating_point(loaded, loaded.experiment.duration) else { return Vec::new() };
    let Some(control) = at.control() else { return Vec::new() };
    let entries = loaded.controller.as_ref().map(|c| c.entries()).unwrap_or_default();
    let sampled = openable_signals(loaded, &at);
    let commands = control.wiring().program().commands.iter();
    let mut signals: Vec<String> = Vec::new();
    for command in commands {
        let is_source = |probe: Probe| matches!(probe, Probe::Signal(k) if k == command.signal.start);
        let name = entries.iter().find(|entry| is_source(entry.probe)).map(|entry| entry.name.clone());
        signals.extend(name.filter(|name| !signals.contains(name)));
    }
    let source = std::sync::Arc::new(SourceText { path: "diagram".into(), text: String::new() });
    let located = |name: &String| Located { value: name.clone(), at: Location { source: source.clone(), span: 0..0 } };
    let mut found = Vec::new();
    for signal in &signals {
        if sampled.contains(signal) {
            let Ok(loops) = open_loops(loaded, &at, &[located(signal)]) else { continue };
            found.extend(loops.into_iter().map(|open| LoopMargin {
                signal: signal.clone(),
                gain_db: open.margins.bode.gain_margin().map(|m| m.value),
                phase_deg: open.margins.bode.phase_margin().map(|m| m.value),
                modulus: open.margins.modulus_margin.value,
            }));
            continue;
        }
        let request = Request { inputs: vec![located(signal)], outputs: vec![located(signal)], is_closed: true };
        if let Ok(closed) = linearize(loaded, &at, &request) {
            found.extend(of_sensitivity(signal, &closed.system));
        }
    }
    found
}

/// Margins from the sensitivity at a signal; `None` if nothing comes back to it.
fn of_sensitivity(signal: &str, sensitivity: &StateSpace) -> Option<LoopMargin> {
    let StateSpace { a, b, c, .. } = sensitivity;
    let axis = Axis { name: signal.to_owned(), unit: String::new() };
    let mut open = StateSpace::from_matrices(a - b * c, b.clone(), -c, 0.0 * &sensitivity.d).ok()?;
    (open.inputs, open.outputs) = (vec![axis.clone()], vec![axis]);
    let bode = open.bode(0, 0).ok()?;
    let largest = sensitivity
        .frequency_response(0, 0, &bode.omega)
        .iter()
        .map(|s| sincro_math::elementary::hypot(s.re, s.im).0)
        .fold(1.0, f64::max);
    Some(LoopMargin {
        signal: signal.to_owned(),
        gain_db: bode.gain_margin().map(|m| m.value),
        phase_deg: bode.phase_margin().map(|m| m.value),
        modulus: 1.0 / largest,
    })
}
