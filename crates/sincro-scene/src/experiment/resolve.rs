//! From the experiment file as written to an [`Experiment`]; all problems at once.

use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_math::expression::is_name;

use super::checks::{CheckReader, Keys, parsed_unit};
use super::file::{
    DifferenceFile, ErrorBarFile, ExperimentFile, PlotFile, PlotKindFile, RangeFile, StopFile, SweepFile,
};
use super::grid::Grid;
use super::stop::{Side, StopWhen};
use super::task;
use super::{ErrorBar, Experiment, Plot, SMALLEST_ACCURACY, Sweep, Variant, path_components};
use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::{Document, escape};
use crate::folder::Folder;
use crate::overrides::Override;
use crate::record::is_float_signal;

/// Most values of a sweep: a slip of the pen in `step` must not fill the memory.
const MAX_SWEEP: f64 = 1e6;

/// Resolves a document that fits the schema. With `check_times`, checks that look where nothing is recorded are
/// refused.
pub(crate) fn resolve(document: &Document, folder: &Folder, check_times: bool) -> (Option<Experiment>, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let file: ExperimentFile = match serde_json::from_value(document.root.clone()) {
        Ok(file) => file,
        Err(e) => {
            let diagnostic = Diagnostic::error(&document.at(""), format!("the experiment cannot be read: {e}"));
            return (None, diagnostic.into());
        }
    };
    let mut resolver = Resolver { document, folder, file: &file, check_times, diagnostics: &mut diagnostics };
    let experiment = resolver.experiment();
    (experiment, diagnostics)
}

struct Resolver<'a> {
    document: &'a Document,
    folder: &'a Folder,
    file: &'a ExperimentFile,
    check_times: bool,
    diagnostics: &'a mut Diagnostics,
}

impl Resolver<'_> {
    fn experiment(&mut self) -> Option<Experiment> {
        let file = self.file;
        self.parameter_names();
        let grid = Grid { duration: file.duration, step: file.step, record_every: file.record_every };
        let n_steps = self.steps(&grid);
        self.accuracy();
        let simulation_ticks = self.simulation_ticks();
        let record = self.record();
        self.check_units();
        let parameters: Arc<[(String, f64)]> = file.parameters.iter().map(|(k, x)| (k.clone(), *x)).collect();
        let checks = self.reader(&parameters, Keys::Run(grid)).list(&file.check, "");
        let stops = self.stops(&parameters, grid);
        let sweep = file.sweep.as_ref().map(|sweep| self.sweep(sweep, &parameters));
        let variants = self.variants(&parameters, grid);
        let plots = self.plots(&parameters, grid);
        let task = task::of_file(file.task.as_ref(), grid, &mut self.reader(&parameters, Keys::Run(grid)));
        let scene_path = self.folder.path_of(&file.scene);
        Some(Experiment {
            title: file.title.clone(),
            description: file.description.clone(),
            scene_path,
            duration: file.duration,
            step: file.step,
            n_steps: n_steps?,
            simulation_ticks,
            record_every: file.record_every,
            integrator: file.integrator,
            accuracy: file.accuracy,
            error_bar: file.error_bar.into(),
            seed: file.seed,
            record,
            units: file.units.clone(),
            parameters: file.parameters.clone(),
            stops,
            checks,
            sweep,
            variants,
            plots,
            task,
        })
    }

    fn reader<'s>(&'s mut self, parameters: &Arc<[(String, f64)]>, keys: Keys) -> CheckReader<'s> {
        CheckReader {
            document: self.document,
            folder: self.folder,
            parameters: parameters.clone(),
            keys,
            check_times: self.check_times,
            diagnostics: self.diagnostics,
        }
    }

    fn error(&mut self, pointer: &str, message: impl Into<String>, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(&self.document.at(pointer), message).with_help(help));
    }

    /// Refuses an accuracy beyond double precision.
    fn accuracy(&mut self) {
        let accuracy = self.file.accuracy;
        if accuracy < SMALLEST_ACCURACY {
            let message = format!("`accuracy` is {accuracy:e}, beyond double precision");
            self.error("/accuracy", message, format!("the smallest useful value is {SMALLEST_ACCURACY:e}"));
        }
    }

    /// Base steps in a step of scripts and clients.
    fn simulation_ticks(&mut self) -> u64 {
        let (Some(dt), step) = (self.file.simulation_step, self.file.step) else { return 1 };
        let ticks = (dt / step).round();
        if !(1.0..=1e9).contains(&ticks) || (ticks * step - dt).abs() > 1e-9 * dt {
            let message = format!("`simulation_step` is {dt} s, no whole multiple of the base step, {step} s");
            let near = ticks.max(1.0) * step;
            let help = format!("simulation_step = {near}, or another `step`");
            self.diagnostics.push(Diagnostic::error(&self.document.at("/simulation_step"), message).with_help(help));
            return 1;
        }
        ticks as u64
    }

    fn parameter_names(&mut self) {
        for name in self.file.parameters.keys() {
            let reserved = name == "t" || name == "pi";
            if is_name(name) && !reserved {
                continue;
            }
            let message = format!("`{name}` cannot be the name of a parameter");
            let help = if reserved {
                format!("`{name}` has a meaning of its own in formulas")
            } else {
                "formulas know names of letters, digits and `_` that begin with a letter".into()
            };
            let at = self.document.key_at(&format!("/parameters/{}", escape(name)));
            self.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
        }
    }

    fn steps(&mut self, grid: &Grid) -> Option<u64> {
        match grid.n_steps() {
            Ok(n) if n % grid.record_every != 0 => {
                let every = grid.record_every;
                let message = format!("the end of the run is not recorded: {n} steps, one row every {every}");
                let at = self.document.at("/record_every");
                let diagnostic = Diagnostic::error(&at, message).as_warning();
                self.diagnostics.push(diagnostic.with_help("let `record_every` divide the number of steps"));
                Some(n)
            }
            Ok(n) => Some(n),
            Err((message, help)) => {
                self.error("/duration", message, help);
                None
            }
        }
    }

    fn record(&mut self) -> Vec<Located<String>> {
        let mut record: Vec<Located<String>> = Vec::new();
        for (k, name) in self.file.record.iter().enumerate() {
            let pointer = format!("/record/{k}");
            if let Some(first) = record.iter().find(|known| known.value == *name) {
                let (line, column) = first.at.line_column();
                self.error(
                    &pointer,
                    format!("`{name}` is recorded twice"),
                    format!("first in line {line}, column {column}"),
                );
            } else {
                record.push(Located { value: name.clone(), at: self.document.at(&pointer) });
            }
        }
        record
    }

    /// Refuses units of signals that have one of their own, and texts that are no units.
    fn check_units(&mut self) {
        for (name, text) in &self.file.units {
            let pointer = format!("/units/{}", escape(name));
            if !is_float_signal(name) {
                let message = format!("`{name}` is no float signal");
                let help = "all other signals have a unit of their own; blocks take one as `unit` in the diagram";
                let at = self.document.key_at(&pointer);
                self.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
            }
            parsed_unit(text, &self.document.at(&pointer), self.diagnostics);
        }
    }

    fn stops(&mut self, parameters: &Arc<[(String, f64)]>, grid: Grid) -> Vec<StopWhen> {
        let file = self.file;
        let mut stops = Vec::new();
        for (k, StopFile { signal, above, below, beyond }) in file.stop_when.iter().enumerate() {
            let pointer = format!("/stop_when/{k}");
            let sides =
                [("above", above, Side::Above), ("below", below, Side::Below), ("beyond", beyond, Side::Beyond)];
            for (key, bound, side) in sides {
                let Some(bound) = bound else { continue };
                let at = format!("{pointer}/{key}");
                let Some(bound) = self.reader(parameters, Keys::Run(grid)).of_parameters(bound, &at) else { continue };
                if side == Side::Beyond && bound < 0.0 {
                    self.error(&at, format!("a magnitude is always beyond {bound}"), "give a bound of 0 or more");
                }
                let signal = Located { value: signal.clone(), at: self.document.at(&format!("{pointer}/signal")) };
                stops.push(StopWhen { signal, side, bound });
            }
        }
        stops
    }

    fn sweep(&mut self, file: &SweepFile, parameters: &Arc<[(String, f64)]>) -> Sweep {
        let values = match (&file.range, &file.values) {
            (Some(range), _) => self.range(range),
            (None, values) => values.clone().unwrap_or_default(),
        };
        if let Some(k) = (1..values.len()).find(|&k| values[..k].contains(&values[k])) {
            self.error(&format!("/sweep/values/{k}"), format!("{} is run twice", values[k]), "leave one of them out");
        }
        let checks = self.reader(parameters, Keys::Sweep(values.clone())).list(&file.check, "/sweep");
        let parameter = Located { value: file.parameter.clone(), at: self.document.at("/sweep/parameter") };
        let also = file.also.iter().enumerate();
        let also =
            also.map(|(k, path)| Located { value: path.clone(), at: self.document.at(&format!("/sweep/also/{k}")) });
        Sweep { parameter, also: also.collect(), values, checks }
    }

    fn range(&mut self, &RangeFile { from, to, step }: &RangeFile) -> Vec<f64> {
        let n = ((to - from) / step).round();
        let pointer = "/sweep/range/step";
        if step == 0.0 || !n.is_finite() || n < 0.0 {
            let message = format!("steps of {step} do not lead from {from} to {to}");
            self.error(pointer, message, "the step is not zero and goes from `from` towards `to`");
            return Vec::new();
        }
        if n > MAX_SWEEP {
            self.error(pointer, format!("{n:e} values from {from} to {to}"), "use a larger step");
            return Vec::new();
        }
        if (from + n * step - to).abs() > 1e-9 * (to - from).abs() {
            let message = format!("from {from} to {to} is not a whole number of steps of {step}");
            let last = super::grid::short(from + ((to - from) / step).floor() * step);
            self.error("/sweep/range/to", message, format!("use {last}, or another step"));
            return Vec::new();
        }
        (0..=n as u64).map(|k| from + k as f64 * step).collect()
    }

    fn variants(&mut self, parameters: &Arc<[(String, f64)]>, main: Grid) -> Vec<Variant> {
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let mut variants = Vec::new();
        for (k, file) in self.file.variant.iter().enumerate() {
            let pointer = format!("/variant/{k}");
            self.variant_name(&file.name, &pointer, &mut names);
            let mut set = Vec::new();
            for path in file.set.keys() {
                let inner = format!("{pointer}/set/{}", escape(path));
                let value = self.document.at(&inner);
                set.push(Override {
                    path: Located { value: path.clone(), at: self.document.key_at(&inner) },
                    value: Located { value: value.text().to_owned(), at: value },
                });
            }
            let own = own_parameters(parameters, &file.set);
            let inherited = if file.inherit_checks { &self.file.check[..] } else { &[] };
            let mut reader = self.reader(&own, Keys::Run(own_grid(main, &file.set)));
            reader.inherited_times(inherited, &file.name);
            let checks = reader.list(&file.check, &pointer);
            variants.push(Variant {
                name: file.name.clone(),
                description: file.description.clone(),
                set,
                inherit_checks: file.inherit_checks,
                checks,
                location: self.document.title_at(&pointer),
            });
        }
        variants
    }

    fn variant_name(&mut self, name: &str, pointer: &str, names: &mut BTreeMap<String, usize>) {
        let good = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
        let pointer = format!("{pointer}/name");
        // the name becomes the name of a folder of results
        if name.is_empty() || name.starts_with('.') || !name.chars().all(good) {
            let help = "names have letters a–z and A–Z, digits, `_`, `-` and `.`";
            self.error(&pointer, format!("`{name}` is not a name of a variant"), help);
        }
        let (line, _) = self.document.at(&pointer).line_column();
        if let Some(first) = names.insert(name.to_owned(), line) {
            self.error(
                &pointer,
                format!("there are two variants `{name}`"),
                format!("the other one is in line {first}"),
            );
        }
    }

    /// Refuses a path whose components are not recorded, and what it cannot show.
    fn path(&mut self, k: usize, signals: &[String]) {
        let recorded = |name: &String| self.file.record.contains(name);
        let missing: Vec<usize> = (0..signals.len())
            .filter(|i| {
                let vector = signals[*i].rsplit(':').next().unwrap_or("");
                !path_components(vector).iter().any(|names| names.iter().all(recorded))
            })
            .collect();
        for i in missing {
            let name = &signals[i];
            let message =
                format!("the three components of `{name}` are not recorded, so that its path cannot be drawn");
            let help = format!("add `{name}.x`, `{name}.y` and `{name}.z` to `record`");
            self.error(&format!("/plot/{k}/signals/{i}"), message, help);
        }
        for key in ["reference", "difference"] {
            let pointer = format!("/plot/{k}/{key}");
            if self.document.get(&pointer).is_some() {
                let at = self.document.key_at(&pointer);
                let diagnostic = Diagnostic::error(&at, format!("`{key}` has no meaning in a plot of kind `path`"));
                self.diagnostics.push(diagnostic.with_help("leave it out, or draw lines over time"));
            }
        }
    }

    fn plots(&mut self, parameters: &Arc<[(String, f64)]>, grid: Grid) -> Vec<Plot> {
        let mut plots = Vec::new();
        for (k, PlotFile { title, kind, signals, reference, difference, variants }) in self.file.plot.iter().enumerate()
        {
            let pointer = format!("/plot/{k}");
            let is_path = *kind == PlotKindFile::Path;
            if is_path {
                self.path(k, signals);
            }
            let located = |(i, name): (usize, &String)| Located {
                value: name.clone(),
                at: self.document.at(&format!("{pointer}/signals/{i}")),
            };
            let signals = signals.iter().enumerate().map(located).collect();
            let mut reader = self.reader(parameters, Keys::Run(grid));
            let reference = reference.as_ref().and_then(|file| reader.reference(file, &format!("{pointer}/reference")));
            let compares_variants = difference.map(|d| d == DifferenceFile::Variants);
            for (i, name) in variants.iter().flatten().enumerate() {
                let known: Vec<&str> = self.file.variant.iter().map(|v| v.name.as_str()).collect();
                if !known.contains(&name.as_str()) {
                    let help = crate::suggest::help(name, &known, "variants");
                    self.error(&format!("{pointer}/variants/{i}"), format!("there is no variant `{name}`"), help);
                }
            }
            plots.push(Plot {
                title: title.clone(),
                is_path,
                signals,
                reference,
                compares_variants,
                variants: variants.clone(),
            });
        }
        plots
    }
}

/// The times of a variant: those of the main run but for what it sets.
fn own_grid(main: Grid, set: &BTreeMap<String, serde_json::Value>) -> Grid {
    let number = |key: &str| set.get(key).and_then(serde_json::Value::as_f64).filter(|x| *x > 0.0);
    Grid {
        duration: number("duration").unwrap_or(main.duration),
        step: number("step").unwrap_or(main.step),
        record_every: set.get("record_every").and_then(serde_json::Value::as_u64).unwrap_or(main.record_every).max(1),
    }
}

/// The parameters of a variant: those of the main run but for what it sets.
fn own_parameters(main: &Arc<[(String, f64)]>, set: &BTreeMap<String, serde_json::Value>) -> Arc<[(String, f64)]> {
    let own = |name: &str| set.get(&format!("parameters.{name}")).and_then(serde_json::Value::as_f64);
    main.iter().map(|(name, x)| (name.clone(), own(name).unwrap_or(*x))).collect()
}

impl From<ErrorBarFile> for ErrorBar {
    fn from(file: ErrorBarFile) -> Self {
        match file {
            ErrorBarFile::Refine => Self::Refine,
            ErrorBarFile::None => Self::None,
        }
    }
}
