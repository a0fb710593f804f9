//! Ground as heights over a grid, given in the scene or in a CSV file beside it.

use sincro_dynamics::contact::Surface;

use super::file::HeightFieldFile;
use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location};
use crate::document::Document;
use crate::folder::Folder;

/// The surface of a height field; a problem is noted if it is no grid.
pub(super) fn surface(
    file: &HeightFieldFile,
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Option<Surface> {
    let rows = match (&file.file, &file.heights) {
        (Some(name), _) => {
            let named = Located { value: name.clone(), at: document.at(&format!("{pointer}/file")) };
            from_csv(&named, folder)
        }
        (None, heights) => {
            let rows = heights.iter().flatten().enumerate();
            let place = |k: usize| document.at(&format!("{pointer}/heights/{k}"));
            Ok(rows.map(|(k, row)| Row { heights: row.clone(), at: place(k) }).collect())
        }
    };
    let grid = rows.and_then(|rows| grid(&rows, &document.at(pointer), file.scale));
    match grid {
        Ok((columns, heights)) => Some(Surface::HeightField { columns, heights, size: file.size }),
        Err(diagnostic) => {
            diagnostics.push(diagnostic);
            None
        }
    }
}

/// Heights along x at one y, and where they stand.
struct Row {
    heights: Vec<f64>,
    at: Location,
}

fn grid(rows: &[Row], at: &Location, scale: f64) -> Result<(usize, Vec<f64>), Diagnostic> {
    let columns = rows.first().map_or(0, |row| row.heights.len());
    if let Some(odd) = rows.iter().position(|row| row.heights.len() != columns) {
        let message = format!("row {} has {} heights, the first one {columns}", odd + 1, rows[odd].heights.len());
        return Err(Diagnostic::error(&rows[odd].at, message).with_help("a grid has rows of equal length, along x"));
    }
    if rows.len() < 2 || columns < 2 {
        let message = format!("a height field of {} by {columns} heights spans no ground", rows.len());
        return Err(Diagnostic::error(at, message).with_help("give two rows or more of two heights or more"));
    }
    Ok((columns, rows.iter().flat_map(|row| &row.heights).map(|h| h * scale).collect()))
}

/// Rows of numbers with commas between them; `#` comments; no line of names.
fn from_csv(named: &Located<String>, folder: &Folder) -> Result<Vec<Row>, Diagnostic> {
    let source = folder.read_named(named)?;
    let (mut rows, mut start) = (Vec::new(), 0);
    for line in source.text.split_inclusive('\n') {
        let place = |from: usize, length: usize| Location { source: source.clone(), span: from..from + length };
        let (at, mut cell) = (place(start, line.trim_end().len()), start);
        start += line.len();
        let values = line.split('#').next().unwrap_or("").trim_end();
        if values.trim().is_empty() {
            continue;
        }
        let mut heights = Vec::new();
        for text in values.split(',') {
            match text.trim().parse::<f64>() {
                Ok(x) if x.is_finite() => heights.push(x),
                _ => {
                    let message = format!("`{}` is not a height", text.trim());
                    let at = place(cell + text.len() - text.trim_start().len(), text.trim().len());
                    return Err(Diagnostic::error(&at, message)
                        .with_help("rows of finite numbers with commas between them [m]"));
                }
            }
            cell += text.len() + 1;
        }
        rows.push(Row { heights, at });
    }
    Ok(rows)
}
