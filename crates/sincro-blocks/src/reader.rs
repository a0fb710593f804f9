//! Reader of parameters: values by name, as any file format gives them, become the fields of a block.
//!
//! A [`Reader`] hands out parameters with the type that a block wants and notes everything that is wrong with them, so
//! that all problems are reported at once.

use std::collections::BTreeMap;

use sincro_math::expression::{Expression, is_name};

use crate::kind::{Kind, ValueKind};
use crate::suggest;

/// Value of a parameter as given, in the terms of every file format (TOML, JSON, Lua tables).
///
/// ```
/// use sincro_blocks::prelude::*;
///
/// assert_eq!(Value::from(2.5), Value::Number(2.5));
/// assert_eq!(Value::from("2·mass"), Value::Text("2·mass".into())); // a formula, where a number is wanted
/// assert_eq!(Value::from(vec![1.0, 2.0]), Value::List(vec![Value::Number(1.0), Value::Number(2.0)]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// Text; where a number is expected, a formula of the diagram's parameters.
    Text(String),
    /// List of values.
    List(Vec<Value>),
    /// Table of names and values, in the order of the file.
    Table(Vec<(String, Value)>),
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Self::Flag(flag)
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(list: Vec<T>) -> Self {
        Self::List(list.into_iter().map(Into::into).collect())
    }
}

/// Error of a parameter of a block, collected by a [`Reader`].
///
/// ```
/// use sincro_blocks::library::continuous::LowPass;
/// use sincro_blocks::prelude::*;
/// use sincro_blocks::reader::NoFiles;
/// use std::collections::BTreeMap;
///
/// let (given, names) = (BTreeMap::from([("time_constant".to_owned(), Value::from(-1.0))]), BTreeMap::new());
/// let mut reader = Reader::new(LowPass::KIND, &given, &names, &NoFiles);
/// let _filter = LowPass::read(&mut reader);
/// let errors: Vec<ParameterError> = reader.finish();
/// assert_eq!((errors.len(), &errors[0].path[..]), (1, &["time_constant".to_owned()][..]));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterError {
    /// Path to the value: the parameter's key, then indices (counted from 0) and names inside it; empty if the
    /// parameter is missing.
    pub path: Vec<String>,
    /// Range of the wrong bytes in the text of the value, if it is a formula that does not parse; else `None`.
    pub span: Option<core::ops::Range<usize>>,
    /// Description of the error.
    pub message: String,
    /// Suggested correction.
    pub help: String,
}

impl core::fmt::Display for ParameterError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}\nhelp: {}", self.message, self.help)
    }
}

impl std::error::Error for ParameterError {}

/// Access to the files that parameters name, relative to the folder of the scene; implemented by programs that may read
/// files ([`NoFiles`] by others).
pub trait Files {
    /// Numbers of the column named `column` in the CSV file `file`, row by row.
    ///
    /// # Errors
    ///
    /// A message with the reason: no such file or column, or an entry that is not a number.
    fn column(&self, file: &str, column: &str) -> Result<Vec<f64>, String>;

    /// Content of the text file `file`; by default an error.
    ///
    /// # Errors
    ///
    /// A message with the reason for which it cannot be read.
    fn text(&self, file: &str) -> Result<String, String> {
        Err(format!("the file `{file}` cannot be read here"))
    }

    /// Content of the binary file `file`; by default an error.
    ///
    /// # Errors
    ///
    /// A message with the reason for which it cannot be read.
    fn bytes(&self, file: &str) -> Result<Vec<u8>, String> {
        Err(format!("the file `{file}` cannot be read here"))
    }
}

/// Access to no files: every request is an error.
#[derive(Clone, Copy, Debug)]
pub struct NoFiles;

impl Files for NoFiles {
    fn column(&self, file: &str, _: &str) -> Result<Vec<f64>, String> {
        Err(format!("the file `{file}` cannot be read here"))
    }
}

/// Limit on the number of ports of one block.
pub const MAX_PORTS: usize = 10_000;

/// Reader of the parameters of one block: returns values, checked and with defaults, and collects the errors. Used by
/// [`Described::read`](crate::kind::Described::read). Methods that read a parameter panic if the kind has none of that
/// key.
///
/// ```
/// use sincro_blocks::library::maths::Gain;
/// use sincro_blocks::prelude::*;
/// use sincro_blocks::reader::NoFiles;
/// use std::collections::BTreeMap;
///
/// // a gain that is given by a formula of the diagram's parameters
/// let given = BTreeMap::from([("gain".to_owned(), Value::from("2*mass*g"))]);
/// let names = BTreeMap::from([("mass".to_owned(), 1.5), ("g".to_owned(), 9.81)]);
/// let mut reader = Reader::new(Gain::KIND, &given, &names, &NoFiles);
/// let weight = Gain::read(&mut reader);
/// assert!(reader.finish().is_empty());
/// assert_eq!(weight.gain, [2.0 * 1.5 * 9.81]);
/// ```
pub struct Reader<'a> {
    kind: &'static Kind,
    given: &'a BTreeMap<String, Value>,
    scope: &'a BTreeMap<String, f64>,
    files: &'a dyn Files,
    faults: Vec<ParameterError>,
}

impl<'a> Reader<'a> {
    /// Creates a reader of the parameters `given` to a block of `kind`; formulas in them know the names of `scope`,
    /// whose values are in SI units.
    #[must_use]
    pub fn new(
        kind: &'static Kind,
        given: &'a BTreeMap<String, Value>,
        scope: &'a BTreeMap<String, f64>,
        files: &'a dyn Files,
    ) -> Self {
        let mut reader = Self { kind, given, scope, files, faults: Vec::new() };
        reader.look_for_unknown();
        reader
    }

    fn look_for_unknown(&mut self) {
        for key in self.given.keys() {
            if self.kind.parameters.iter().any(|p| p.name == key) {
                continue;
            }
            let known: Vec<&str> = self.kind.parameters.iter().map(|p| p.name).collect();
            let all = if known.is_empty() { "it has none".into() } else { format!("it has {}", known.join(", ")) };
            let help = match suggest::nearest(key, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`? {all}"),
                None => all,
            };
            let message = format!("`{}` has no parameter `{key}`", self.kind.name);
            self.faults.push(ParameterError { path: vec![key.clone()], span: None, message, help });
        }
    }

    /// Returns everything that was wrong with the parameters, in the order in which it was found; empty if nothing was.
    #[must_use]
    pub fn finish(self) -> Vec<ParameterError> {
        self.faults
    }

    /// Names that formulas may use (the diagram's parameters), with their values in SI units.
    #[must_use]
    pub fn scope(&self) -> &'a BTreeMap<String, f64> {
        self.scope
    }

    /// Returns true if the parameter is given, false if its default applies.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.given.contains_key(key)
    }

    /// Parameter as it is given; `None` if it is not.
    #[must_use]
    pub fn raw(&self, key: &str) -> Option<&'a Value> {
        self.given.get(key)
    }

    /// Records an error of the parameter `key`: message and help.
    pub fn fault(&mut self, key: &str, message: impl Into<String>, help: impl Into<String>) {
        self.fault_at(&[key], None, message, help);
    }

    /// Records an error inside a parameter. `path` is its key, then indices and names; `span` the range of wrong bytes
    /// in a formula, if there is one.
    pub fn fault_at(
        &mut self,
        path: &[&str],
        span: Option<core::ops::Range<usize>>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let path = path.iter().map(|step| (*step).to_owned()).collect();
        self.faults.push(ParameterError { path, span, message: message.into(), help: help.into() });
    }

    /// The parameter or its default; none, with a fault, if it must be given.
    fn value(&mut self, key: &str) -> Option<Value> {
        if let Some(value) = self.given.get(key) {
            return Some(value.clone());
        }
        let parameter = self.kind.parameters.iter().find(|p| p.name == key);
        let parameter = parameter.unwrap_or_else(|| panic!("`{}` describes no parameter `{key}`", self.kind.name));
        match parameter.default {
            Some(text) => Some(default_value(text, parameter.takes)),
            None => {
                let message = format!("`{}` needs the parameter `{key}`: {}", self.kind.name, parameter.meaning());
                self.faults.push(ParameterError {
                    path: Vec::new(),
                    span: None,
                    message,
                    help: format!("give {key} = …"),
                });
                None
            }
        }
    }

    /// Reads a finite number, in the parameter's unit (NaN after a fault).
    pub fn number(&mut self, key: &str) -> f64 {
        match self.value(key) {
            Some(value) => self.numeric(&value, &[key]),
            None => f64::NAN,
        }
    }

    /// Reads a number that may be infinite, written as `inf` or `-inf` in a text, in the parameter's unit (NaN after a
    /// fault).
    pub fn limit(&mut self, key: &str) -> f64 {
        match self.value(key) {
            Some(value) => self.numeric_or_infinite(&value, &[key]),
            None => f64::NAN,
        }
    }

    /// Reads one number for all components, or one for each, as [`Reader::limit`] does; never empty (NaN after a
    /// fault).
    pub fn limits(&mut self, key: &str) -> Vec<f64> {
        match self.value(key) {
            Some(Value::List(list)) if !list.is_empty() => {
                list.iter().enumerate().map(|(k, x)| self.numeric_or_infinite(x, &[key, &k.to_string()])).collect()
            }
            Some(Value::List(_)) => {
                self.fault(key, format!("`{key}` is empty"), "give at least one number");
                vec![f64::NAN]
            }
            Some(value) => vec![self.numeric_or_infinite(&value, &[key])],
            None => vec![f64::NAN],
        }
    }

    /// Reads a finite number greater than zero, in the parameter's unit (1 after a fault).
    pub fn positive(&mut self, key: &str) -> f64 {
        let x = self.number(key);
        if x <= 0.0 {
            self.fault(key, format!("`{key}` is {x}"), "it must be greater than 0");
        }
        if x > 0.0 { x } else { 1.0 }
    }

    /// Reads a whole number from 0 on, below 10⁹ (0 after a fault).
    pub fn count(&mut self, key: &str) -> usize {
        let x = self.number(key);
        let is_whole = x >= 0.0 && x.fract() == 0.0 && x < 1e9;
        if !is_whole && !x.is_nan() {
            self.fault(key, format!("`{key}` is {}", plain(x)), "it must be a whole number from 0 on");
        }
        if is_whole { x as usize } else { 0 }
    }

    /// Reads a whole number from 1 on, below 10⁹ (1 after a fault).
    pub fn positive_count(&mut self, key: &str) -> usize {
        let x = self.number(key);
        let is_whole = x >= 1.0 && x.fract() == 0.0 && x < 1e9;
        if !is_whole && !x.is_nan() {
            self.fault(key, format!("`{key}` is {}", plain(x)), "it must be a whole number from 1 on");
        }
        if is_whole { x as usize } else { 1 }
    }

    /// Reads a number of ports, from 1 to [`MAX_PORTS`] (1 after a fault).
    pub fn positive_port_count(&mut self, key: &str) -> usize {
        let n = self.count(key);
        if n > MAX_PORTS {
            self.fault(key, format!("`{key}` is {n}"), format!("a block has at most {MAX_PORTS}"));
            return 1;
        }
        if n == 0 {
            self.fault(key, format!("`{key}` is 0"), "it must be 1 or more");
        }
        n.max(1)
    }

    /// Reads a number of inputs, from 1 to 1000 (the nearest of these after a fault).
    pub fn input_count(&mut self, key: &str) -> usize {
        let n = self.count(key);
        if !(1..=1000).contains(&n) {
            self.fault(key, format!("`{key}` is {n}"), "it must be from 1 to 1000");
        }
        n.clamp(1, 1000)
    }

    /// Reads one finite number for all components, or one for each, in the parameter's unit; never empty (NaN after a
    /// fault).
    pub fn numbers(&mut self, key: &str) -> Vec<f64> {
        match self.value(key) {
            Some(Value::List(list)) => {
                if list.is_empty() {
                    self.fault(key, format!("`{key}` is empty"), "give at least one number");
                    return vec![f64::NAN];
                }
                list.iter().enumerate().map(|(k, x)| self.numeric(x, &[key, &k.to_string()])).collect()
            }
            Some(value) => vec![self.numeric(&value, &[key])],
            None => vec![f64::NAN],
        }
    }

    /// Reads a list of whole numbers from `least` on and below a million; a number is a list of one.
    pub fn counts(&mut self, key: &str, least: usize) -> Vec<usize> {
        let list = self.numbers(key);
        if let Some(bad) = list.iter().find(|x| x.fract() != 0.0 || !(least as f64..1e6).contains(*x)) {
            self.fault(
                key,
                format!("`{key}` has {}", crate::library::short(*bad)),
                format!("{key} are whole numbers from {least} on"),
            );
        }
        list.iter().map(|x| *x as usize).collect()
    }

    /// Reads one number greater than zero for all components, or one for each, in the parameter's unit; never empty (1
    /// after a fault).
    pub fn positives(&mut self, key: &str) -> Vec<f64> {
        let mut list = self.numbers(key);
        for k in 0..list.len() {
            if list[k] <= 0.0 {
                self.fault(key, format!("`{key}` has {}", list[k]), "every number must be greater than 0");
                list[k] = 1.0;
            }
        }
        list
    }

    /// Reads a matrix from rows of equal length, in the parameter's unit; a list of numbers is one row, a number is 1 ×
    /// 1 (a 1 × 1 matrix of NaN after a fault).
    pub fn matrix(&mut self, key: &str) -> Matrix {
        let rows: Vec<Vec<f64>> = match self.value(key) {
            Some(Value::List(list)) if list.iter().any(|row| matches!(row, Value::List(_))) => {
                let row = |(i, row): (usize, &Value)| match row {
                    Value::List(row) => row
                        .iter()
                        .enumerate()
                        .map(|(k, x)| self.numeric(x, &[key, &i.to_string(), &k.to_string()]))
                        .collect(),
                    x => vec![self.numeric(x, &[key, &i.to_string()])],
                };
                list.iter().enumerate().map(row).collect()
            }
            Some(Value::List(list)) => {
                vec![list.iter().enumerate().map(|(k, x)| self.numeric(x, &[key, &k.to_string()])).collect()]
            }
            Some(value) => vec![vec![self.numeric(&value, &[key])]],
            None => vec![vec![f64::NAN]],
        };
        let columns = rows.first().map_or(0, Vec::len);
        if let Some(bad) = rows.iter().position(|row| row.len() != columns) {
            let message = format!("row 0 of `{key}` has {columns} numbers, row {bad} has {}", rows[bad].len());
            self.fault(key, message, "all rows of a matrix are of the same length");
            return Matrix { rows: 1, columns: 1, entries: vec![f64::NAN] };
        }
        Matrix { rows: rows.len(), columns, entries: rows.concat() }
    }

    /// Reads `true` or `false` (`false` after a fault).
    pub fn flag(&mut self, key: &str) -> bool {
        match self.value(key) {
            Some(Value::Flag(flag)) => flag,
            Some(_) => {
                self.fault(key, format!("`{key}` is not true or false"), "write true or false");
                false
            }
            None => false,
        }
    }

    /// Reads a text (empty after a fault).
    pub fn text(&mut self, key: &str) -> String {
        match self.value(key) {
            Some(Value::Text(text)) => text,
            Some(_) => {
                self.fault(key, format!("`{key}` is not a text"), "put it in quotes");
                String::new()
            }
            None => String::new(),
        }
    }

    /// Reads the content of the text file that the parameter names (empty after a fault).
    pub fn text_file(&mut self, key: &str) -> String {
        let name = self.text(key);
        self.files.text(&name).unwrap_or_else(|message| {
            self.fault(key, message, "name a file of the scene folder");
            String::new()
        })
    }

    /// Reads the content of the binary file that the parameter names; `None` after a fault.
    pub fn binary_file(&mut self, key: &str) -> Option<Vec<u8>> {
        let name = self.text(key);
        let read = self.files.bytes(&name);
        read.map_err(|message| self.fault(key, message, "name a file of the scene folder")).ok()
    }

    /// Reads a list of texts; one text is a list of one, numbers are written out (empty after a fault).
    pub fn texts(&mut self, key: &str) -> Vec<String> {
        match self.value(key) {
            Some(Value::Text(text)) => vec![text],
            Some(Value::List(list)) => {
                let mut texts = Vec::new();
                for (k, item) in list.iter().enumerate() {
                    match item {
                        Value::Text(text) => texts.push(text.clone()),
                        Value::Number(x) => texts.push(format!("{x:?}")),
                        _ => self.fault_at(&[key, &k.to_string()], None, "this is not a text", "put it in quotes"),
                    }
                }
                texts
            }
            Some(_) => {
                self.fault(key, format!("`{key}` is not a list of texts"), "write [\"…\", \"…\"]");
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    /// Reads one of the words of the parameter's [`ValueKind::Choice`]; returns its index (0 after a fault).
    pub fn choice(&mut self, key: &str) -> usize {
        let parameter = self.kind.parameters.iter().find(|p| p.name == key);
        let Some(ValueKind::Choice(words)) = parameter.map(|p| p.takes) else {
            panic!("`{}` describes no choice `{key}`", self.kind.name)
        };
        let text = self.text(key);
        words.iter().position(|word| *word == text).unwrap_or_else(|| {
            let near = suggest::nearest(&text, words.iter().copied());
            let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
            // what is no text at all has been noted
            if self.given.get(key).is_none_or(|value| matches!(value, Value::Text(_))) {
                self.fault(key, format!("`{key}` is `{text}`"), format!("{near}it is one of {}", words.join(", ")));
            }
            0
        })
    }

    /// Reads a table of names with finite numbers, in the order of the file (empty after a fault, NaN for a wrong
    /// entry).
    pub fn named_numbers(&mut self, key: &str) -> Vec<(String, f64)> {
        match self.value(key) {
            Some(Value::Table(table)) => {
                table.iter().map(|(name, x)| (name.clone(), self.numeric(x, &[key, name]))).collect()
            }
            Some(_) => {
                self.fault(key, format!("`{key}` is not a table"), "write { name = number, … }");
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    /// Reads a table of names with finite numbers, each one or a list (of lists, row by row), in the order of the file
    /// (empty after a fault, NaN for a wrong number).
    pub fn named_lists(&mut self, key: &str) -> Vec<(String, Vec<f64>)> {
        match self.value(key) {
            Some(Value::Table(table)) => table
                .iter()
                .map(|(name, x)| {
                    let mut flat = Vec::new();
                    self.flatten(x, &[key, name], &mut flat);
                    (name.clone(), flat)
                })
                .collect(),
            Some(_) => {
                self.fault(key, format!("`{key}` is not a table"), "write { name = number, list = [1, 2], … }");
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    fn flatten(&mut self, value: &Value, path: &[&str], flat: &mut Vec<f64>) {
        match value {
            Value::List(list) => list.iter().for_each(|x| self.flatten(x, path, flat)),
            Value::Flag(flag) => flat.push(f64::from(u8::from(*flag))),
            _ => flat.push(self.numeric(value, path)),
        }
    }

    /// Reads a table of names with formulas as texts, in the order of the file (empty after a fault).
    pub fn named_texts(&mut self, key: &str) -> Vec<(String, String)> {
        match self.value(key) {
            Some(Value::Table(table)) => {
                let mut list = Vec::new();
                for (name, item) in table {
                    match item {
                        Value::Text(text) => list.push((name, text)),
                        Value::Number(x) => list.push((name, format!("{x:?}"))),
                        _ => self.fault_at(&[key, &name], None, "this is not a formula", "put it in quotes"),
                    }
                }
                list
            }
            Some(_) => {
                self.fault(key, format!("`{key}` is not a table"), "write { name = \"formula\", … }");
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    /// Parses `text` as a formula of `names` and of the diagram's parameters, which are put in as numbers; `None` after
    /// a fault, which is recorded at `path` (key, indices, names).
    pub fn formula(&mut self, path: &[&str], text: &str, names: &[&str]) -> Option<Formula> {
        let constants: Vec<(&str, f64)> = self
            .scope
            .iter()
            .filter(|(name, _)| !names.contains(&name.as_str()))
            .map(|(name, x)| (name.as_str(), *x))
            .collect();
        let all: Vec<&str> = names.iter().copied().chain(constants.iter().map(|(name, _)| *name)).collect();
        match Expression::parse(text, &all) {
            Ok(expression) => {
                Some(Formula { expression, n_names: names.len(), constants: constants.iter().map(|c| c.1).collect() })
            }
            Err(error) => {
                let known = match &all[..] {
                    _ if !error.message.starts_with("unknown name") => String::new(),
                    [] => "it knows no names: there are no parameters".to_owned(),
                    all => format!("it knows {}", all.join(", ")),
                };
                self.fault_at(
                    path,
                    Some(error.span.clone()),
                    error.message.clone(),
                    error.help.clone().unwrap_or(known),
                );
                None
            }
        }
    }

    /// Records a fault of the parameter `key` if `name` cannot be a name in formulas.
    pub fn check_name(&mut self, key: &str, name: &str) {
        if !is_name(name) {
            let help = "names have letters, digits and `_` and begin with a letter";
            self.fault(key, format!("`{name}` cannot be a name in formulas"), help);
        }
    }

    /// Reads the column named `column` of the CSV file `file`, row by row, for a parameter of a series; empty after a
    /// fault, which is recorded at `key`.
    pub fn column(&mut self, key: &str, file: &str, column: &str) -> Vec<f64> {
        match self.files.column(file, column) {
            Ok(numbers) => numbers,
            Err(message) => {
                self.fault(key, message, "the path is relative to the scene's folder");
                Vec::new()
            }
        }
    }

    fn numeric_or_infinite(&mut self, value: &Value, path: &[&str]) -> f64 {
        match value {
            Value::Text(text) if text == "inf" => f64::INFINITY,
            Value::Text(text) if text == "-inf" => f64::NEG_INFINITY,
            Value::Number(x) if x.is_infinite() => *x,
            value => self.numeric(value, path),
        }
    }

    fn numeric(&mut self, value: &Value, path: &[&str]) -> f64 {
        match value {
            Value::Number(x) if x.is_finite() => *x,
            Value::Number(x) => {
                self.fault_at(path, None, format!("`{}` is {x}", shown(path)), "it must be a finite number");
                f64::NAN
            }
            Value::Text(text) => self.formula(path, text, &[]).map_or(f64::NAN, |formula| {
                let x = formula.expression.eval(&formula.constants, &mut formula.expression.scratch());
                if !x.is_finite() {
                    let message = format!("`{}`: `{text}` is {x}", shown(path));
                    self.fault_at(path, None, message, "it must be a finite number");
                }
                x
            }),
            _ => {
                let help = "write a number, or a formula of the diagram's parameters in quotes";
                self.fault_at(path, None, format!("`{}` is not a number", shown(path)), help);
                f64::NAN
            }
        }
    }
}

/// Formula of a block's parameter, from [`Reader::formula`], with the diagram's parameters put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    /// Compiled formula; the first `n_names` of its names are the caller's, the others have the values of `constants`.
    pub expression: Expression,
    /// Number of names for which the caller gives values.
    pub n_names: usize,
    /// Values of the other names, in their order, in SI units.
    pub constants: Vec<f64>,
}

/// Matrix of a block's parameter, stored row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries, row by row: `rows` × `columns` numbers, in the unit of the parameter.
    pub entries: Vec<f64>,
}

impl Matrix {
    /// Creates a matrix from rows of equal length; entries keep their units.
    ///
    /// # Panics
    ///
    /// If the rows differ in length.
    #[must_use]
    pub fn from_rows(rows: &[&[f64]]) -> Self {
        let columns = rows.first().map_or(0, |row| row.len());
        assert!(rows.iter().all(|row| row.len() == columns), "rows of one length");
        Self { rows: rows.len(), columns, entries: rows.concat() }
    }

    /// Entry in row `i` and column `k`, both counted from 0, in its unit. Panics if they are beyond the matrix.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, i: usize, k: usize) -> f64 {
        self.entries[i * self.columns + k]
    }
}

/// Steps to a value as one would write them: `value[1]`, `expressions.y`.
fn shown(path: &[&str]) -> String {
    let mut text = String::new();
    for step in path {
        match step.parse::<usize>() {
            Ok(k) => text.push_str(&format!("[{k}]")),
            Err(_) if text.is_empty() => text.push_str(step),
            Err(_) => text.push_str(&format!(".{step}")),
        }
    }
    text
}

/// A number without a tail of zeros.
fn plain(x: f64) -> String {
    if x.abs() < 1e15 { format!("{x}") } else { format!("{x:e}") }
}

/// A default as it stands in a description.
fn default_value(text: &str, takes: ValueKind) -> Value {
    match takes {
        ValueKind::Flag => Value::Flag(text == "true"),
        ValueKind::Texts | ValueKind::Matrix if text == "[]" => Value::List(Vec::new()),
        ValueKind::Names | ValueKind::NumberLists => Value::Table(Vec::new()),
        ValueKind::Text | ValueKind::Choice(_) | ValueKind::File => Value::Text(text.to_owned()),
        _ if text == "[]" => Value::List(Vec::new()),
        _ => text.parse().map_or_else(|_| Value::Text(text.to_owned()), Value::Number),
    }
}
