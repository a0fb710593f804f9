//! Pictures as bytes: columns and rows of pixels of some bytes each, row by row.

/// Picture whose left and right, or top and bottom, have changed places.
///
/// ```
/// use sincro_vision::pictures::flipped;
///
/// assert_eq!(flipped(&[1, 2, 3, 4], [2, 2], 1, [true, false]), [2, 1, 4, 3]);
/// ```
///
/// # Panics
///
/// There are fewer bytes than columns times rows times `width`.
#[must_use]
pub fn flipped(bytes: &[u8], [columns, rows]: [usize; 2], width: usize, [across, up]: [bool; 2]) -> Vec<u8> {
    let mut out = Vec::with_capacity(bytes.len());
    for j in 0..rows {
        let row = if up { rows - 1 - j } else { j };
        for i in 0..columns {
            let column = if across { columns - 1 - i } else { i };
            let k = width * (row * columns + column);
            out.extend_from_slice(&bytes[k..k + width]);
        }
    }
    out
}

/// Picture of another size and number of bytes for each pixel: of the nearest pixel, or smooth, the mean of the four
/// about a place. Bytes that the given picture does not have are 255.
///
/// # Panics
///
/// There are fewer bytes than columns times rows times bytes of a pixel.
#[must_use]
pub fn scaled(
    bytes: &[u8],
    (from, width): ([usize; 2], usize),
    (to, out_width): ([usize; 2], usize),
    is_smooth: bool,
) -> Vec<u8> {
    let mut out = Vec::with_capacity(to[0] * to[1] * out_width);
    for j in 0..to[1] {
        for i in 0..to[0] {
            let [x, y] = [0, 1].map(|k| ([i, j][k] as f64 + 0.5) * from[k] as f64 / to[k] as f64 - 0.5);
            for c in 0..out_width {
                out.push(if c < width { sample(bytes, (from, width, c), (x, y), is_smooth) } else { 255 });
            }
        }
    }
    out
}

/// Channel `c` at a place between pixels.
fn sample(
    bytes: &[u8],
    ([columns, rows], width, c): ([usize; 2], usize, usize),
    (x, y): (f64, f64),
    is_smooth: bool,
) -> u8 {
    let at = |i: f64, j: f64| {
        let (i, j) = (i.clamp(0.0, columns as f64 - 1.0) as usize, j.clamp(0.0, rows as f64 - 1.0) as usize);
        f64::from(bytes[width * (j * columns + i) + c])
    };
    if !is_smooth {
        return at(x.round(), y.round()) as u8;
    }
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    let low = at(i, j) * (1.0 - s) + at(i + 1.0, j) * s;
    let high = at(i, j + 1.0) * (1.0 - s) + at(i + 1.0, j + 1.0) * s;
    (low * (1.0 - t) + high * t + 0.5) as u8
}

/// Picture of `width` bytes for each pixel (1 grey, 3 or more red, green, blue) as a bitmap of Windows, 24 bits a
/// pixel without compression; rows from the bottom, as here.
#[must_use]
pub fn bitmap(pixels: &[u8], [columns, rows]: [usize; 2], width: usize) -> Vec<u8> {
    let line = (3 * columns).next_multiple_of(4);
    let size = 54 + line * rows;
    let mut file = Vec::with_capacity(size);
    file.extend(b"BM");
    for number in [size, 0, 54, 40, columns, rows] {
        file.extend((number as u32).to_le_bytes());
    }
    // one plane of 24 bits, no compression, 72 dots an inch
    file.extend([1, 0, 24, 0]);
    for number in [0, (line * rows) as u32, 2835, 2835, 0, 0] {
        file.extend(number.to_le_bytes());
    }
    for row in pixels.chunks_exact(width * columns) {
        for pixel in row.chunks_exact(width) {
            let [red, green, blue] = if width == 1 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
            file.extend([blue, green, red]);
        }
        file.extend(std::iter::repeat_n(0, line - 3 * columns));
    }
    file
}
