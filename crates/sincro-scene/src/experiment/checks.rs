//! Checks as written to checks as evaluated: formulas read, references found, times looked up.

use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_blocks::unit::Unit;
use sincro_math::expression::{Expression, is_name};

use super::check::{Check, Expected, Measure, Reference, Sense, Subject};
use super::file::{CheckFile, NumberOrFormula, ReferenceFile};
use super::grid::{Grid, short};
use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location};
use crate::document::{Document, escape};
use crate::folder::Folder;
use crate::series::{self, Query};

/// Key along which rows are aligned.
pub(super) enum Keys {
    /// Times of a run.
    Run(Grid),
    /// Values of the parameter of a sweep.
    Sweep(Vec<f64>),
}

/// Reads checks and references of one run, variant or sweep.
pub(super) struct CheckReader<'a> {
    pub document: &'a Document,
    pub folder: &'a Folder,
    pub parameters: Arc<[(String, f64)]>,
    pub keys: Keys,
    /// True if checks of times without recorded rows are refused.
    pub check_times: bool,
    pub diagnostics: &'a mut Diagnostics,
}

/// The unit that is written at `at`; what cannot be read is noted.
pub(super) fn parsed_unit(text: &str, at: &Location, diagnostics: &mut Diagnostics) -> Option<Unit> {
    let parsed = Unit::parse(text);
    let help = "units are products such as N·m/rad, m/s^2, kg·m²";
    parsed.map_err(|message| diagnostics.push(Diagnostic::error(at, message).with_help(help))).ok()
}

impl CheckReader<'_> {
    /// The checks of the list `check` in the table at `pointer`; those with errors are left out, noted as problems.
    pub fn list(&mut self, files: &[CheckFile], pointer: &str) -> Vec<Check> {
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        let mut checks = Vec::new();
        for (k, file) in files.iter().enumerate() {
            let pointer = format!("{pointer}/check/{k}");
            let location = self.document.title_at(&pointer);
            let (line, _) = location.line_column();
            if let Some(first) = names.insert(&file.name, line) {
                let diagnostic = Diagnostic::error(&location, format!("there are two checks `{}`", file.name));
                self.diagnostics.push(diagnostic.with_help(format!("the other one is in line {first}")));
            }
            checks.extend(self.check(file, &pointer, location));
        }
        checks
    }

    fn check(&mut self, file: &CheckFile, pointer: &str, location: Location) -> Option<Check> {
        let aliases = self.aliases(file, pointer);
        let slots: Vec<String> = aliases
            .iter()
            .map(|(alias, _)| alias.clone())
            .chain(["t".to_owned()])
            .chain(self.parameters.iter().map(|(name, _)| name.clone()))
            .collect();
        let what = self.subject(file, pointer, &slots);
        let unit = self.unit(file, pointer);
        let expected = self.expected(file, pointer, &slots);
        let (sense, tolerance) = self.sense(file, pointer);
        let target = self.step_response(file, pointer);
        self.divergence(file, pointer);
        let measure = if file.diverges.is_some() { Measure::Divergence } else { Measure::from(file.measure) };
        self.times(file, pointer, "");
        if file.floor.is_some() && !file.relative {
            let at = self.document.key_at(&format!("{pointer}/floor"));
            let diagnostic = Diagnostic::error(&at, "`floor` without `relative = true`");
            self.diagnostics.push(diagnostic.with_help("it is the least divisor of a relative difference"));
        }
        Some(Check {
            name: file.name.clone(),
            what: what?,
            aliases,
            unit,
            parameters: self.parameters.clone(),
            expected: expected?,
            sense,
            measure,
            target,
            band: file.band.unwrap_or(0.02),
            at: file.at,
            window: file.window.map(|[from, to]| (from, to)),
            tolerance: tolerance?,
            relative: file.relative,
            floor: file.floor.unwrap_or(0.0),
            location,
        })
    }

    fn aliases(&mut self, file: &CheckFile, pointer: &str) -> Vec<(String, Located<String>)> {
        let mut aliases = Vec::new();
        for (alias, signal) in file.signals.iter().flatten() {
            let inner = format!("{pointer}/signals/{}", escape(alias));
            let help = if !is_name(alias) {
                Some("formulas know names of letters, digits and `_` that begin with a letter")
            } else if alias == "t" || alias == "pi" {
                Some("it has a meaning of its own in formulas")
            } else if self.parameters.iter().any(|(name, _)| name == alias) {
                Some("a parameter has that name; give the signal another one")
            } else {
                None
            };
            if let Some(help) = help {
                let at = self.document.key_at(&inner);
                self.diagnostics
                    .push(Diagnostic::error(&at, format!("`{alias}` cannot stand for a signal")).with_help(help));
            }
            aliases.push((alias.clone(), Located { value: signal.clone(), at: self.document.at(&inner) }));
        }
        aliases
    }

    fn subject(&mut self, file: &CheckFile, pointer: &str, slots: &[String]) -> Option<Subject> {
        match (&file.signal, &file.formula) {
            (Some(signal), None) => {
                let at = self.document.at(&format!("{pointer}/signal"));
                Some(Subject::Signal(Located { value: signal.clone(), at }))
            }
            (Some(_), Some(_)) => {
                let at = self.document.key_at(&format!("{pointer}/formula"));
                let diagnostic = Diagnostic::error(&at, "`signal` and `formula` exclude each other");
                self.diagnostics.push(diagnostic.with_help("name the signals of a formula: signals = { x = \"…\" }"));
                None
            }
            (None, Some(formula)) => self.formula(formula, &format!("{pointer}/formula"), slots).map(Subject::Formula),
            (None, None) => {
                let at = self.document.key_at(&format!("{pointer}/signals"));
                let diagnostic = Diagnostic::error(&at, format!("`formula` is missing in check `{}`", file.name));
                self.diagnostics.push(
                    diagnostic.with_help("`signals` names what a formula is made of; `signal` is checked as it is"),
                );
                None
            }
        }
    }

    fn unit(&mut self, file: &CheckFile, pointer: &str) -> Option<Unit> {
        let text = file.unit.as_ref()?;
        let at = self.document.at(&format!("{pointer}/unit"));
        if file.formula.is_none() {
            let diagnostic = Diagnostic::error(&at, "`unit` is that of a formula");
            self.diagnostics.push(diagnostic.with_help("a signal has a unit of its own; leave `unit` out"));
            return None;
        }
        parsed_unit(text, &at, self.diagnostics)
    }

    fn expected(&mut self, file: &CheckFile, pointer: &str, slots: &[String]) -> Option<Expected> {
        if let Some(bound) = &file.diverges {
            return self.of_parameters(bound, &format!("{pointer}/diverges")).map(Expected::Value);
        }
        if let Some(reference) = &file.reference {
            return self.reference(reference, &format!("{pointer}/reference")).map(Expected::Reference);
        }
        let keys = [("value", &file.value), ("at_most", &file.at_most), ("at_least", &file.at_least)];
        let (key, given) = keys.into_iter().find_map(|(key, given)| Some((key, given.as_ref()?)))?;
        match given {
            NumberOrFormula::Number(x) => Some(Expected::Value(*x)),
            NumberOrFormula::Formula(text) => {
                self.formula(text, &format!("{pointer}/{key}"), slots).map(Expected::Formula)
            }
        }
    }

    /// Comparison and tolerance; none, with a diagnostic, if they are missing.
    fn sense(&mut self, file: &CheckFile, pointer: &str) -> (Sense, Option<f64>) {
        let bound = match (&file.at_most, &file.at_least) {
            (Some(_), _) => Some((Sense::AtMost, "at_most")),
            (None, Some(_)) => Some((Sense::AtLeast, "at_least")),
            (None, None) if file.diverges.is_some() => Some((Sense::AtLeast, "diverges")),
            (None, None) => None,
        };
        let Some((sense, key)) = bound else {
            if file.tolerance.is_none() {
                let at = self.document.title_at(pointer);
                let diagnostic = Diagnostic::error(&at, format!("`tolerance` is missing in check `{}`", file.name));
                self.diagnostics
                    .push(diagnostic.with_help("it is the largest difference that holds; `at_most` needs none"));
            }
            return (Sense::Equal, file.tolerance);
        };
        let given = [("tolerance", file.tolerance.is_some()), ("relative", file.relative)];
        for (other, _) in given.into_iter().filter(|(_, is_given)| *is_given) {
            let at = self.document.key_at(&format!("{pointer}/{other}"));
            let diagnostic = Diagnostic::error(&at, format!("`{other}` has no meaning with `{key}`"));
            self.diagnostics.push(diagnostic.with_help(format!("leave it out: `{key}` is exact")));
        }
        (sense, Some(0.0))
    }

    /// Final value of the step of a measure, if given; refuses keys that belong to other measures.
    fn step_response(&mut self, file: &CheckFile, pointer: &str) -> Option<f64> {
        let measure = Measure::from(file.measure);
        let given = [
            ("target", file.target.is_some() && !measure.is_of_step(), "`overshoot`, `rise-time` and `settling-time`"),
            ("band", file.band.is_some() && measure != Measure::SettlingTime, "`settling-time`"),
        ];
        for (key, _, owners) in given.into_iter().filter(|(_, is_wrong, _)| *is_wrong) {
            let at = self.document.key_at(&format!("{pointer}/{key}"));
            let diagnostic =
                Diagnostic::error(&at, format!("`{key}` has no meaning for the measure `{}`", measure.word()));
            self.diagnostics.push(diagnostic.with_help(format!("it belongs to {owners}")));
        }
        self.of_parameters(file.target.as_ref()?, &format!("{pointer}/target"))
    }

    /// A number, or a formula of the parameters alone.
    pub fn of_parameters(&mut self, given: &NumberOrFormula, pointer: &str) -> Option<f64> {
        match given {
            NumberOrFormula::Number(x) => Some(*x),
            NumberOrFormula::Formula(text) => {
                let parameters = self.parameters.clone();
                let names: Vec<String> = parameters.iter().map(|(name, _)| name.clone()).collect();
                let formula = self.formula(text, pointer, &names)?;
                let values: Vec<f64> = parameters.iter().map(|(_, x)| *x).collect();
                Some(formula.eval(&values, &mut formula.scratch()))
            }
        }
    }

    /// Refuses what has no meaning for a divergence: it is the first passage of one signal's magnitude through a
    /// number.
    fn divergence(&mut self, file: &CheckFile, pointer: &str) {
        let Some(bound) = &file.diverges else { return };
        let mut refuse = |key: &str, message: &str, help: &str| {
            let at = self.document.key_at(&format!("{pointer}/{key}"));
            self.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
        };
        if matches!(self.keys, Keys::Sweep(_)) {
            let help = "a sweep compares final values; let a `variant` diverge";
            refuse("diverges", "`diverges` has no meaning in a sweep", help);
        }
        if file.signals.is_some() {
            refuse("signals", "`diverges` looks at one signal", "give signal = \"…\", which is recorded");
        }
        if file.at.is_some() {
            refuse("at", "`at` has no meaning with `diverges`", "give a `window` in which it must leave the bound");
        }
        if self.document.get(&format!("{pointer}/measure")).is_some() {
            refuse("measure", "`measure` has no meaning with `diverges`", "leave it out");
        }
        if matches!(bound, NumberOrFormula::Number(x) if *x < 0.0) {
            refuse("diverges", "a magnitude is always beyond a negative bound", "give a bound of 0 or more");
        }
    }

    /// The formula at `pointer`, which reads `slots`; none, with the problem noted, if it is not understood.
    pub fn formula(&mut self, text: &str, pointer: &str, slots: &[String]) -> Option<Expression> {
        let names: Vec<&str> = slots.iter().map(String::as_str).collect();
        match Expression::parse(text, &names) {
            Ok(formula) => Some(formula),
            Err(error) => {
                let at = inside_string(&self.document.at(pointer), text, &error.span);
                let diagnostic = Diagnostic::error(&at, format!("formula: {}", error.message));
                let unknown = error.message.starts_with("unknown name");
                self.diagnostics.push(match error.help {
                    Some(help) => diagnostic.with_help(help),
                    None if unknown => diagnostic.with_help(format!("it knows {}", known(&names))),
                    None => diagnostic,
                });
                None
            }
        }
    }

    /// A reference; none, with problems noted, if it is not there.
    pub fn reference(&mut self, file: &ReferenceFile, pointer: &str) -> Option<Reference> {
        let is_sweep = matches!(self.keys, Keys::Sweep(_));
        let (own, other) = if is_sweep { ("parameter", "time") } else { ("time", "parameter") };
        if self.document.get(&format!("{pointer}/{other}")).is_some() {
            let at = self.document.key_at(&format!("{pointer}/{other}"));
            let diagnostic = Diagnostic::error(&at, format!("`{other}` has no meaning here"));
            self.diagnostics.push(diagnostic.with_help(format!("rows are lined up by `{own}`")));
            return None;
        }
        let key_pointer = format!("{pointer}/{own}");
        let written = if is_sweep { &file.parameter } else { &file.time };
        let key = match written {
            Some(key) => Located { value: key.clone(), at: self.document.at(&key_pointer) },
            None if is_sweep => {
                let diagnostic = Diagnostic::error(&self.document.at(pointer), "`parameter` is missing in `reference`");
                self.diagnostics.push(diagnostic.with_help("it names the column of the values of the swept parameter"));
                return None;
            }
            None => Located { value: "t".into(), at: self.document.at(pointer) },
        };
        let located = |key: &str, value: &String| Located {
            value: value.clone(),
            at: self.document.at(&format!("{pointer}/{key}")),
        };
        let (name, column) = (located("file", &file.file), located("column", &file.column));
        let query = Query { file: &name, key: &key, column: &column };
        let [keys, values] = &*series::read(self.folder, &query, self.diagnostics)?;
        Some(Reference {
            file: self.folder.path_of(&file.file),
            key_column: key.value,
            column: column.value,
            scale: file.scale,
            offset: file.offset,
            keys: keys.as_slice().into(),
            values: values.iter().map(|x| file.scale * x + file.offset).collect(),
            location: column.at,
        })
    }

    /// Refuses checks of the main run that cannot be made on a variant which inherits them.
    pub fn inherited_times(&mut self, files: &[CheckFile], variant: &str) {
        for (k, file) in files.iter().enumerate() {
            self.times(file, &format!("/check/{k}"), &format!("in variant `{variant}` "));
        }
    }

    fn times(&mut self, file: &CheckFile, pointer: &str, of: &str) {
        if !self.check_times {
            return;
        }
        let refused = match (file.at, file.window) {
            (Some(at), _) => self.keys.refuse_at(at).map(|found| ("at", found)),
            (None, Some([from, to])) => self.keys.refuse_window(from, to).map(|found| ("window", found)),
            (None, None) => None,
        };
        if let Some((key, (message, help))) = refused {
            let at = self.document.at(&format!("{pointer}/{key}"));
            self.diagnostics.push(Diagnostic::error(&at, format!("{of}{message}")).with_help(help));
        }
    }
}

impl Keys {
    /// Reason for which nothing is recorded at `at`, with advice.
    fn refuse_at(&self, at: f64) -> Option<(String, String)> {
        match self {
            Self::Run(grid) if !grid.contains(at) => Some((
                format!("{at} s is outside of the run, which lasts {} s", grid.duration),
                "use a time within the run, or a longer duration".into(),
            )),
            Self::Run(grid) => {
                let (before, after) = grid.rows_around(at);
                let help = format!("use {} or {}", short(before), short(after));
                (before != after).then(|| (format!("no row is recorded at {at} s"), help))
            }
            Self::Sweep(values) => {
                let near = values.iter().copied().reduce(|a, b| if (b - at).abs() < (a - at).abs() { b } else { a })?;
                let missed = (near - at).abs() > 1e-9 * at.abs().max(near.abs());
                missed.then(|| (format!("the sweep has no value {at}"), format!("the nearest is {near}")))
            }
        }
    }

    /// Reason for which a window is empty, or reaches too far.
    fn refuse_window(&self, from: f64, to: f64) -> Option<(String, String)> {
        if from > to {
            return Some((
                format!("the window ends at {to}, before it begins at {from}"),
                "give the earlier end first".into(),
            ));
        }
        match self {
            Self::Run(grid) if !grid.contains(from) || !grid.contains(to) => Some((
                format!("the window from {from} s to {to} s is not inside the run, which lasts {} s", grid.duration),
                format!("use times from 0 to {}", grid.duration),
            )),
            Self::Run(grid) => {
                let ((before, after), last) = (grid.rows_around(from), grid.rows_around(to).0);
                let empty = before != after && after > last;
                let help = format!("rows are recorded at {} s and {} s", short(before), short(after));
                empty.then(|| (format!("no row is recorded from {from} s to {to} s"), help))
            }
            Self::Sweep(values) => {
                let empty = !values.is_empty() && !values.iter().any(|x| *x >= from && *x <= to);
                empty.then(|| (format!("the sweep has no value from {from} to {to}"), "widen the window".into()))
            }
        }
    }
}

fn known(names: &[&str]) -> String {
    let mut all: Vec<String> = Vec::new();
    for name in names.iter().map(|n| format!("`{n}`")) {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all.join(", ")
}

/// The place of a part of a string's value in the file; the whole string if it was written with escapes.
fn inside_string(at: &Location, value: &str, part: &std::ops::Range<usize>) -> Location {
    let written = at.text();
    match written.find(value).filter(|_| !value.is_empty()) {
        Some(quote) => {
            let start = at.span.start + quote;
            Location { source: at.source.clone(), span: start + part.start..start + part.end }
        }
        None => at.clone(),
    }
}
