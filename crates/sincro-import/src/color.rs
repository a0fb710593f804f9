//! Colours: red, green and blue of a byte each.

/// Red, green and blue of numbers from 0 to 1.
pub(crate) fn rgb(rgba: &[f64]) -> Option<[u8; 3]> {
    let byte = |x: f64| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
    match rgba {
        [r, g, b, ..] => Some([byte(*r), byte(*g), byte(*b)]),
        _ => None,
    }
}
