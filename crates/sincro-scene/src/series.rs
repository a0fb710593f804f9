//! Columns of CSV files: reference series and tables of signals.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};
use crate::folder::Folder;
use crate::suggest;

/// Which columns of which file, and where that was written.
pub struct Query<'a> {
    /// The file, relative to the folder.
    pub file: &'a Located<String>,
    /// Column that increases strictly: times, or values of a parameter.
    pub key: &'a Located<String>,
    /// Column of values.
    pub column: &'a Located<String>,
}

/// Reads two columns of finite numbers, the key and the values, row by row and equally long; none, with problems noted,
/// if they are not there, are not numbers, or the key does not increase. Those that the folder has are not read again.
pub fn read(folder: &Folder, query: &Query<'_>, diagnostics: &mut Diagnostics) -> Option<Arc<[Vec<f64>; 2]>> {
    let source = match folder.read_named(query.file) {
        Ok(source) => source,
        Err(diagnostic) => {
            diagnostics.push(diagnostic);
            return None;
        }
    };
    let names = [&query.key.value, &query.column.value].map(String::clone);
    match folder.columns.get((source.path.clone(), names), |_| columns(&source, query)) {
        Ok(columns) => Some(columns),
        Err(found) => {
            diagnostics.merge(found);
            None
        }
    }
}

/// Reads one column of finite numbers, in the order of the rows.
///
/// # Errors
///
/// Why there is none, in words, with the place in the file where there is one.
pub fn column(folder: &Folder, file: &str, column: &str) -> Result<Vec<f64>, String> {
    let located = |text: &str| {
        let source = Arc::new(SourceText { path: "diagram".into(), text: text.to_owned() });
        Located { value: text.to_owned(), at: Location { source, span: 0..text.len() } }
    };
    let words = |diagnostic: Diagnostic| match diagnostic.help {
        Some(help) => format!("{} ({help})", diagnostic.message),
        None => diagnostic.message,
    };
    let source = folder.read_named(&located(file)).map_err(words)?;
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(source.text.as_bytes());
    let header = reader.headers().map_err(|e| format!("`{file}` is not a CSV file: {e}"))?.clone();
    let names: Vec<&str> = header.iter().collect();
    let index = column_index(&names, &located(column), &source).map_err(words)?;
    let mut numbers = Vec::new();
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(|e| format!("`{file}` is not a CSV file: {e}"))? {
        let cell = Cells { source: &source, row: &row, names: &names };
        numbers.push(cell.number(index).map_err(|p| format!("{}: {}", cell.at(index), words(p)))?);
    }
    Ok(numbers)
}

fn columns(source: &Arc<SourceText>, query: &Query<'_>) -> Result<[Vec<f64>; 2], Diagnostics> {
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(source.text.as_bytes());
    let header = reader.headers().map_err(|e| csv_diagnostic(source, &e))?.clone();
    let names: Vec<&str> = header.iter().collect();
    let key_idx = column_index(&names, query.key, source);
    let value_idx = column_index(&names, query.column, source);
    let (key_idx, value_idx) = match (key_idx, value_idx) {
        (Ok(key), Ok(value)) => (key, value),
        (key, value) => return Err(Diagnostics(key.err().into_iter().chain(value.err()).collect())),
    };
    let (mut keys, mut values) = (Vec::new(), Vec::new());
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(|e| csv_diagnostic(source, &e))? {
        let cell = Cells { source, row: &row, names: &names };
        let key = cell.number(key_idx)?;
        if keys.last().is_some_and(|last| key <= *last) {
            let last = keys[keys.len() - 1];
            let message = format!("`{}` {key} does not come after {last}", query.key.value);
            let diagnostic = Diagnostic::error(&cell.at(key_idx), message);
            return Err(diagnostic.with_help("rows are ordered, each later than the one before").into());
        }
        keys.push(key);
        values.push(cell.number(value_idx)?);
    }
    if keys.is_empty() {
        let at = Location { source: source.clone(), span: 0..0 };
        return Err(Diagnostic::error(&at, "the file has no rows below its header").into());
    }
    Ok([keys, values])
}

fn column_index(names: &[&str], wanted: &Located<String>, source: &SourceText) -> Result<usize, Diagnostic> {
    names.iter().position(|name| *name == wanted.value).ok_or_else(|| {
        let message = format!("`{}` has no column `{}`", source.path.display(), wanted.value);
        Diagnostic::error(&wanted.at, message).with_help(suggest::help(&wanted.value, names, "columns"))
    })
}

/// One row and where its cells stand.
struct Cells<'a> {
    source: &'a Arc<SourceText>,
    row: &'a csv::StringRecord,
    names: &'a [&'a str],
}

impl Cells<'_> {
    fn number(&self, index: usize) -> Result<f64, Diagnostic> {
        let text = &self.row[index];
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => {
                let message = format!("`{text}` in column `{}` is not a finite number", self.names[index]);
                Err(Diagnostic::error(&self.at(index), message)
                    .with_help("numbers have a decimal point, columns are separated by commas"))
            }
        }
    }

    fn at(&self, index: usize) -> Location {
        let byte = self.row.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
        Location { source: self.source.clone(), span: cell_span(&self.source.text, byte, index) }
    }
}

/// Bytes of a cell of the row that begins at `start`; exact where no cell before it is quoted.
fn cell_span(text: &str, start: usize, index: usize) -> Range<usize> {
    let mut start = start.min(text.len());
    loop {
        let rest = &text[start..];
        let skipped = rest.len() - rest.trim_start_matches(['\r', '\n']).len();
        start += skipped;
        if skipped == 0 && !rest.starts_with('#') {
            break;
        }
        if text[start..].starts_with('#') {
            start += text[start..].find('\n').unwrap_or(text.len() - start);
        }
    }
    let line = text[start..].lines().next().unwrap_or("");
    let before: usize = line.split(',').take(index).map(|cell| cell.len() + 1).sum();
    let cell = line.get(before..).unwrap_or("").split(',').next().unwrap_or("");
    let shift = start + before + cell.len() - cell.trim_start().len();
    shift..shift + cell.trim().len()
}

fn csv_diagnostic(source: &Arc<SourceText>, error: &csv::Error) -> Diagnostics {
    let start = error.position().map_or(0, |p| usize::try_from(p.byte()).unwrap_or(0));
    let at = Location { source: source.clone(), span: cell_span(&source.text, start, 0) };
    let diagnostic = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Diagnostic::error(&at, format!("the row has {len} cells, the header {expected_len}"))
                .with_help("every row has one cell a column")
        }
        _ => Diagnostic::error(&at, format!("not a CSV file: {error}")),
    };
    diagnostic.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn located(text: &str) -> Located<String> {
        let source = Arc::new(SourceText { path: "experiment.toml".into(), text: text.into() });
        Located { value: text.into(), at: Location { source, span: 0..text.len() } }
    }

    fn of(csv: &str, column: &str) -> Result<(Vec<f64>, Vec<f64>), String> {
        let source = Arc::new(SourceText { path: "r.csv".into(), text: csv.into() });
        let query = Query { file: &located("r.csv"), key: &located("t"), column: &located(column) };
        columns(&source, &query).map(Into::into).map_err(|diagnostics| diagnostics.to_string())
    }

    #[test]
    fn two_columns_are_read() {
        assert_eq!(of("t, x ,y\n# note\n0,1,2\r\n1,3,-4e-1\n", "y").unwrap(), (vec![0.0, 1.0], vec![2.0, -0.4]));
    }

    #[test]
    fn an_unknown_column_is_told_with_those_there_are() {
        assert_eq!(
            of("t,theta1,theta2\n0,1,2\n", "theta3").unwrap_err(),
            "experiment.toml:1:1: error: `r.csv` has no column `theta3`\n  help: did you mean `theta2`? columns: `t`, `theta1`, \
             `theta2`"
        );
    }

    #[test]
    fn bad_cells_are_pointed_at() {
        let not_a_number = "r.csv:4:4: error: `abc` in column `x` is not a finite number";
        assert!(of("t,x\n0, 1\n# c\n1, abc\n", "x").unwrap_err().starts_with(not_a_number));
        assert!(of("t,x\n0,inf\n", "x").unwrap_err().starts_with("r.csv:2:3: error: `inf`"));
        assert!(of("t,x\n0,1\n0,2\n", "x").unwrap_err().starts_with("r.csv:3:1: error: `t` 0 does not come after 0"));
        assert!(
            of("t,x\n0,1\n1\n", "x").unwrap_err().starts_with("r.csv:3:1: error: the row has 1 cells, the header 2")
        );
        assert!(of("t,x\n", "x").unwrap_err().starts_with("r.csv:1:1: error: the file has no rows"));
    }
}
