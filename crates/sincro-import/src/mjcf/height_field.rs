//! Height fields of assets: elevations in the model or in a binary file, which are scaled to the range from 0 to 1.
//!
//! Source: key `mjcf`, asset `hfield`. Elevations in the model come from the greatest y on, those of a file from the
//! least. A binary file has the numbers of rows and columns as 32-bit integers, then the elevations as 32-bit floats,
//! all little-endian.

use std::sync::Arc;

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::geom::asset_name;
use crate::resolve::Resolver;
use crate::robot::Shape;
use crate::source::Element;

/// Largest number of heights.
const MAX_HEIGHTS: usize = 1 << 18;

impl<'d> Reader<'d> {
    /// Name and shape of a height field; the reason if it has no counterpart.
    pub(super) fn height_field(&self, e: Element<'d>) -> Result<(String, Result<Shape, String>), Diagnostic> {
        let file = self.asset_file(e);
        let name = asset_name(e, file.as_deref());
        let size = e.numbers("size")?.unwrap_or_default();
        let &[x, y, height, _] = &size[..] else {
            return Err(e.error(format!("`size` of a height field has {} numbers, not four", size.len())));
        };
        if !size.iter().all(|x| x.is_finite() && *x > 0.0) {
            return Err(e.error("`size` of a height field is not positive").with_help("give half lengths and heights"));
        }
        let count = |key: &str| -> Result<usize, Diagnostic> { Ok(e.number(key)?.unwrap_or(0.0).max(0.0) as usize) };
        let (n_rows, n_columns) = (count("nrow")?, count("ncol")?);
        let elevation = e.numbers("elevation")?;
        let rows = match (file, elevation) {
            (Some(file), _) => match self.rows_of_file(&file) {
                Ok(rows) => rows,
                Err(why) => return Ok((name, Err(why))),
            },
            (None, _) if n_rows < 2 || n_columns < 2 => {
                return Err(e.error(format!("a height field of {n_rows} by {n_columns} heights spans no ground")));
            }
            (None, Some(heights)) if heights.len() == n_rows.saturating_mul(n_columns) => {
                heights.chunks(n_columns).rev().map(<[f64]>::to_vec).collect()
            }
            (None, Some(heights)) => {
                let message = format!("`elevation` has {} numbers, not {n_rows} by {n_columns}", heights.len());
                return Err(e.error(message));
            }
            // heights that a program is to give
            (None, None) => {
                e.change("it is flat: the file gives no heights");
                vec![vec![0.0; 2]; 2]
            }
        };
        if rows.iter().map(Vec::len).sum::<usize>() > MAX_HEIGHTS {
            return Ok((name, Err(format!("more than {MAX_HEIGHTS} heights are not read"))));
        }
        let all = || rows.iter().flatten().copied();
        if !all().all(f64::is_finite) {
            return Err(e.error("an elevation of a height field is not finite"));
        }
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        // a flat one is at its bottom
        let scale = if high > low { height / (high - low) } else { 0.0 };
        let rows = rows.iter().map(|row| row.iter().map(|h| (h - low) * scale).collect()).collect();
        let shape = Shape::HeightField { name: name.clone(), rows: Arc::new(rows), size: [2.0 * x, 2.0 * y] };
        Ok((name, Ok(shape)))
    }

    /// Rows of a binary file, from the least y on; the reason if it is none.
    fn rows_of_file(&self, file: &str) -> Result<Vec<Vec<f64>>, String> {
        if file.to_ascii_lowercase().ends_with(".png") {
            return Err(format!("its heights are an image, `{file}`, which is not read"));
        }
        let path = Resolver::new(&self.folder, &[]).find(file)?;
        let n = std::fs::metadata(&path).map_err(|why| format!("`{file}`: {why}"))?.len();
        if n > 8 + 4 * MAX_HEIGHTS as u64 {
            return Err(format!("`{file}` has {n} bytes: more than {MAX_HEIGHTS} heights are not read"));
        }
        let bytes = std::fs::read(&path).map_err(|why| format!("`{file}`: {why}"))?;
        let words: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]).collect();
        let [n_rows, n_columns, heights @ ..] = &words[..] else { return Err(format!("`{file}` has no heights")) };
        let [n_rows, n_columns] = [n_rows, n_columns].map(|word| i32::from_le_bytes(*word).max(0) as usize);
        if n_rows < 2 || n_columns < 2 || heights.len() != n_rows.saturating_mul(n_columns) {
            let n = heights.len();
            return Err(format!("`{file}` has {n} heights, which are no grid of {n_rows} by {n_columns}"));
        }
        let row = |row: &[[u8; 4]]| row.iter().map(|word| f64::from(f32::from_le_bytes(*word))).collect();
        Ok(heights.chunks(n_columns).map(row).collect())
    }
}
