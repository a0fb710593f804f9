//! Free parameters of a fit or of a tuning: `PATH`, `PATH=START`, `PATH=LOW..HIGH` or `PATH=START in LOW..HIGH`.

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::document::{Document, escape};
use sincro_scene::overrides::Override;
use sincro_scene::tree::raw_objects;
use sincro_sim::Loaded;

/// Free parameter of a fit or a tuning: a number in the files of a scene that the search may change within bounds, in
/// the unit of that setting.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeParameter {
    /// Path of the setting as after `--set`, such as `/arm.mass`.
    pub path: String,
    /// Start of the search, between the bounds.
    pub start: f64,
    /// Lower bound, in the parameter's unit; −∞ if there is none.
    pub low: f64,
    /// Upper bound, in the parameter's unit; ∞ if there is none.
    pub high: f64,
}

impl FreeParameter {
    /// Reads an argument of `--free`: `PATH`, `PATH=START`, `PATH=LOW..HIGH` or `PATH=START in LOW..HIGH`. A start that
    /// is not given is the value in the files of `loaded`, or the middle of the bounds.
    ///
    /// # Errors
    ///
    /// A diagnostic if the text is of none of these forms, the bounds are not in order, the start is outside of them,
    /// or there is none.
    pub fn parse(text: &str, loaded: &Loaded) -> Result<Self, Diagnostic> {
        let help = "write PATH, PATH=START, PATH=LOW..HIGH or \"PATH=START in LOW..HIGH\"";
        let refuse = |message: String| Diagnostic::without_location(message).with_help(help);
        let (path, rest) = text.split_once('=').map_or((text.trim(), ""), |(path, rest)| (path.trim(), rest.trim()));
        if path.is_empty() {
            return Err(refuse(format!("`{text}` names nothing")));
        }
        let number = |word: &str| {
            let x: Result<f64, _> = word.trim().parse();
            x.ok().filter(|x| !x.is_nan()).ok_or_else(|| refuse(format!("`{word}` in `{text}` is no number")))
        };
        let bounds = |words: &str| -> Result<(f64, f64), Diagnostic> {
            let (low, high) = words.split_once("..").ok_or_else(|| refuse(format!("`{words}` has no `..`")))?;
            let (low, high) = (number(low)?, number(high)?);
            if low < high { Ok((low, high)) } else { Err(refuse(format!("the bounds of `{path}` are not in order"))) }
        };
        let (start, (low, high)) = match rest.split_once(" in ") {
            Some((start, words)) => (Some(number(start)?), bounds(words)?),
            None if rest.contains("..") => (None, bounds(rest)?),
            None if rest.is_empty() => (None, (f64::NEG_INFINITY, f64::INFINITY)),
            None => (Some(number(rest)?), (f64::NEG_INFINITY, f64::INFINITY)),
        };
        let inside = |x: &f64| *x >= low && *x <= high;
        let in_files = nominal(loaded, path);
        let start = match (start, in_files) {
            (Some(start), _) if inside(&start) => start,
            (Some(_), _) => return Err(refuse(format!("the start of `{path}` is not between its bounds"))),
            (None, Some(value)) if inside(&value) => value,
            (None, _) if low.is_finite() && high.is_finite() => middle(low, high),
            (None, _) => {
                return Err(refuse(format!("`{path}` has no start: its value in the files is not a plain number")));
            }
        };
        Ok(Self { path: path.to_owned(), start, low, high })
    }

    /// Returns the setting that gives the parameter this value, in its unit.
    #[must_use]
    pub fn setting(&self, value: f64) -> Override {
        Override::new(&self.path, &format!("{value:?}"))
    }

    /// Typical size of a change.
    #[must_use]
    pub(crate) fn scale(&self) -> f64 {
        let width = self.high - self.low;
        match self.start.abs() {
            start if start > 0.0 => start,
            _ if width.is_finite() => 0.1 * width,
            _ => 1.0,
        }
    }
}

/// Settings of all values.
#[must_use]
pub(crate) fn settings(fixed: &[Override], free: &[FreeParameter], values: &[f64]) -> Vec<Override> {
    fixed.iter().cloned().chain(free.iter().zip(values).map(|(free, value)| free.setting(*value))).collect()
}

/// Reads all arguments of `--free`, each with one parameter or several, separated by commas; in their order.
///
/// # Errors
///
/// All findings at once: those of [`FreeParameter::parse`], a path that stands twice, or no parameter at all.
pub fn parse_all(texts: &[String], loaded: &Loaded) -> Result<Vec<FreeParameter>, Diagnostics> {
    let (mut all, mut found): (Vec<FreeParameter>, Diagnostics) = (Vec::new(), Diagnostics::new());
    for text in texts.iter().flat_map(|text| text.split(',')).filter(|text| !text.trim().is_empty()) {
        match FreeParameter::parse(text, loaded) {
            Ok(free) if all.iter().any(|known| known.path == free.path) => {
                found.push(Diagnostic::without_location(format!("`{}` is free twice", free.path)));
            }
            Ok(free) => all.push(free),
            Err(problem) => found.push(problem),
        }
    }
    if all.is_empty() && !found.any_error() {
        found.push(Diagnostic::without_location("nothing is free").with_help("add --free PATH"));
    }
    if found.any_error() { Err(found) } else { Ok(all) }
}

/// Middle of two bounds: geometric if both are positive and far apart.
fn middle(low: f64, high: f64) -> f64 {
    if low > 0.0 && high / low > 10.0 { (low * high).sqrt() } else { 0.5 * (low + high) }
}

/// Plain number at a path of the scene or the experiment, as the files have it.
fn nominal(loaded: &Loaded, path: &str) -> Option<f64> {
    if let Some(name) = path.strip_prefix("parameters.") {
        return loaded.experiment.parameters.get(name).copied();
    }
    let object = path.starts_with('/');
    let file = if object { loaded.experiment.scene_path.file_name()?.to_str()? } else { "experiment.toml" };
    let document = Document::parse(&loaded.folder.read(file).ok()?).ok()?;
    let (start, keys) = if object {
        let (object, keys) = path.split_once('.')?;
        (raw_objects(&document).into_iter().find(|o| o.path == object)?.pointer, keys)
    } else {
        (String::new(), path)
    };
    let pointer = keys.split('.').fold(start, |pointer, key| format!("{pointer}/{}", escape(key)));
    document.get(&pointer)?.as_f64()
}
