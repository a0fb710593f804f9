//! Goals and limits as formulas of measures, and measures in one line.

use sincro_math::expression::Expression;
use sincro_scene::diagnostic::Diagnostic;

use crate::measure::{measure_of_word, words_of_measures};

/// Names of measures as formulas write them: letters and digits, everything else `_`.
fn slug(name: &str) -> String {
    let name = name.strip_prefix("check: ").unwrap_or(name);
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(c.to_ascii_lowercase());
        } else if !out.ends_with('_') {
            out.push('_');
        }
    }
    let out = out.trim_matches('_').to_owned();
    if out.starts_with(|c: char| c.is_ascii_digit()) { format!("_{out}") } else { out }
}

/// Words of a formula.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
}

/// Reads a formula of measures.
fn parse(text: &str, measures: &[String]) -> Result<Expression, Diagnostic> {
    let names: Vec<String> = measures.iter().map(|name| slug(name)).collect();
    let is_used = |name: &str| words(text).any(|word| word == name);
    let double = (1..names.len()).find(|k| is_used(&names[*k]) && names[..*k].contains(&names[*k]));
    if let Some(k) = double {
        let problem = Diagnostic::without_location(format!("`{}` in `{text}` is the name of two measures", names[k]));
        return Err(problem.with_help("give them names that differ in letters or digits, without accents"));
    }
    // a name without letters or digits cannot be written, one that is there twice is not used
    let name = |k: usize| match names[k].as_str() {
        "" => format!("measure_{k}_without_letters"),
        name if names[..k].iter().any(|other| other == name) => format!("{name}_double_{k}"),
        name => name.to_owned(),
    };
    let names: Vec<String> = (0..names.len()).map(name).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Expression::parse(text, &names).map_err(|error| {
        let problem = Diagnostic::without_location(format!("`{text}`: {}", error.message));
        let known = format!("measures are: {}", names.join(", "));
        problem.with_help(error.help.map_or_else(|| known.clone(), |help| format!("{help}; {known}")))
    })
}

/// Goal of a tuning: a formula of the measures of a run, whose value is minimised.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Text of the formula.
    pub text: String,
    formula: Expression,
}

impl Goal {
    /// Reads a goal, a formula of the measures named `measures`, in which every character but letters and digits is
    /// written as `_`, such as `iae + 0.1*max_torque`.
    ///
    /// # Errors
    ///
    /// A diagnostic with the known measures, if it is no formula of them or a name fits two of them.
    pub fn parse(text: &str, measures: &[String]) -> Result<Self, Diagnostic> {
        Ok(Self { text: text.to_owned(), formula: parse(text, measures)? })
    }

    /// Returns the value of the goal; `measures` has one value for each name of [`Goal::parse`], in that order. NaN if
    /// a measure that it uses has no value.
    #[must_use]
    pub fn value(&self, measures: &[f64]) -> f64 {
        self.formula.eval(measures, &mut self.formula.scratch())
    }
}

/// Limit of a tuning, an inequality of formulas of the measures: `FORMULA <= FORMULA` or `FORMULA >= FORMULA`.
///
/// ```
/// use sincro_campaign::tune::Limit;
///
/// let limit = Limit::parse("overshoot <= 0.05", &["overshoot".into(), "iae".into()]).unwrap();
/// assert_eq!(limit.violation(&[0.04, 1.0]), 0.0);
/// assert!((limit.violation(&[0.06, 1.0]) - 0.2).abs() < 1e-12); // by a fifth of 0.05
/// ```
#[derive(Clone, Debug)]
pub struct Limit {
    /// Text of the inequality.
    pub text: String,
    left: Expression,
    right: Expression,
    is_upper: bool,
}

impl Limit {
    /// Reads a limit, such as `overshoot <= 0.05`; names of measures as in [`Goal::parse`].
    ///
    /// # Errors
    ///
    /// A diagnostic if it has no `<=` or `>=`, or a side is no formula of the measures.
    pub fn parse(text: &str, measures: &[String]) -> Result<Self, Diagnostic> {
        let (sides, is_upper) = match (text.split_once("<="), text.split_once(">=")) {
            (Some(sides), _) => (sides, true),
            (None, Some(sides)) => (sides, false),
            (None, None) => {
                let problem = Diagnostic::without_location(format!("`{text}` is no limit"));
                return Err(problem.with_help("write MEASURE <= NUMBER or MEASURE >= NUMBER"));
            }
        };
        let (left, right) = (parse(sides.0.trim(), measures)?, parse(sides.1.trim(), measures)?);
        Ok(Self { text: text.to_owned(), left, right, is_upper })
    }

    /// Returns the value of the left side; `measures` has one value for each name of [`Limit::parse`], in that order.
    #[must_use]
    pub fn left(&self, measures: &[f64]) -> f64 {
        self.left.eval(measures, &mut self.left.scratch())
    }

    /// Returns the violation of the limit relative to the magnitude of its right side; 0 if it is kept, ∞ if a measure
    /// has no value. `measures` as in [`Limit::left`].
    #[must_use]
    pub fn violation(&self, measures: &[f64]) -> f64 {
        let (left, right) = (self.left(measures), self.right.eval(measures, &mut self.right.scratch()));
        let beyond = if self.is_upper { left - right } else { right - left };
        if beyond.is_nan() { f64::INFINITY } else { beyond.max(0.0) / right.abs().max(1e-9) }
    }
}

/// Returns `[[measure]]` tables, text of a plan file, for measures of one line each: `NAME = MEASURE(FORMULA)` with
/// signals in braces, such as `iae = integral(abs(1 - {/shaft.position}))`.
///
/// # Errors
///
/// A diagnostic that shows the first line that is not of this form.
pub fn measure_tables(lines: &[String]) -> Result<String, Diagnostic> {
    let mut out = String::new();
    for line in lines {
        let refuse = |message: String| {
            Diagnostic::without_location(message)
                .with_help("write NAME=MEASURE(FORMULA), signals in braces: iae=integral(abs(1 - {/shaft.position}))")
        };
        let (name, rest) = line.split_once('=').ok_or_else(|| refuse(format!("`{line}` has no `=`")))?;
        let (word, rest) = rest.split_once('(').ok_or_else(|| refuse(format!("`{line}` has no measure")))?;
        let formula = rest.trim().strip_suffix(')').ok_or_else(|| refuse(format!("`{line}` has no `)` at its end")))?;
        let word = word.trim();
        if measure_of_word(word).is_none() {
            let known = words_of_measures().join(", ");
            return Err(refuse(format!("there is no measure `{word}`")).with_help(format!("measures are: {known}")));
        }
        let (mut text, mut signals, mut rest) = (String::new(), Vec::<String>::new(), formula);
        while let Some((before, behind)) = rest.split_once('{') {
            let (signal, behind) = behind.split_once('}').ok_or_else(|| refuse(format!("`{line}` has no `}}`")))?;
            let k = signals.iter().position(|known| known == signal).unwrap_or_else(|| {
                signals.push(signal.to_owned());
                signals.len() - 1
            });
            text += &format!("{before}signal_{k}");
            rest = behind;
        }
        text += rest;
        let list: Vec<String> =
            signals.iter().enumerate().map(|(k, s)| format!("signal_{k} = {}", quoted(s))).collect();
        out += &format!(
            "[[measure]]\nname = {}\nformula = {}\nsignals = {{ {} }}\nmeasure = {}\n",
            quoted(name.trim()),
            quoted(&text),
            list.join(", "),
            quoted(word)
        );
    }
    Ok(out)
}

/// A text as TOML writes it.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_and_limits_are_formulas_of_measures() {
        let names = ["iae".to_owned(), "check: rise time, 10–90 %".to_owned()];
        let goal = Goal::parse("iae + 0.5*rise_time_10_90", &names).unwrap();
        assert_eq!(goal.value(&[1.0, 4.0]), 3.0);
        let limit = Limit::parse("iae <= 2", &names).unwrap();
        assert_eq!((limit.violation(&[1.0, 0.0]), limit.violation(&[3.0, 0.0])), (0.0, 0.5));
        assert_eq!(limit.violation(&[f64::NAN, 0.0]), f64::INFINITY);
        assert!(Goal::parse("ise", &names).unwrap_err().help.unwrap().contains("iae"));
        assert!(Limit::parse("iae < 2", &names).is_err());
        let double = ["iae".to_owned(), "IAE".to_owned(), "ύψος".to_owned(), "ise".to_owned()];
        assert!(Goal::parse("iae", &double).unwrap_err().message.contains("two measures"));
        assert_eq!(Goal::parse("2*ise", &double).unwrap().value(&[1.0, 2.0, 3.0, 4.0]), 8.0);
    }

    #[test]
    fn a_measure_in_one_line_becomes_a_table() {
        let text = measure_tables(&["iae=integral(abs({/a.b} - {/a.b}) + {c[0]})".to_owned()]).unwrap();
        assert!(text.contains("formula = \"abs(signal_0 - signal_0) + signal_1\""), "{text}");
        assert!(measure_tables(&["iae".to_owned()]).is_err() && measure_tables(&["a=sum({b})".to_owned()]).is_err());
    }
}
