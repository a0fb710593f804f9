//! Functions: pictures as bytes, wherever they come from.

use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments, SimApi, Value};
use sincro_scene::camera::{MAX_PIXELS, png};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "transformImage",
        tip: "buffer image=sim.transformImage(buffer image,int[2] resolution,int options)",
        run: transform,
    },
    Function {
        name: "getScaledImage",
        tip: "buffer imageOut,int[2] effectiveResolutionOut=sim.getScaledImage(buffer imageIn,int[2] resolutionIn,int[2] desiredResolutionOut,int options)",
        run: scale,
    },
    Function {
        name: "saveImage",
        tip: "buffer image=sim.saveImage(buffer image,int[2] resolution,int options,string filename,int quality)",
        run: save,
    },
    Function {
        name: "transformBuffer",
        tip: "buffer outBuffer=sim.transformBuffer(buffer inBuffer,int inFormat,float multiplier,float offset,int outFormat)",
        run: transform_buffer,
    },
];

/// Longest name of a file.
const MAX_NAME_LEN: usize = 200;

/// Columns and rows in argument `k`.
fn resolution(a: Arguments<'_>, k: usize) -> Result<[usize; 2], ApiError> {
    let sides = a.reals::<2>(k)?;
    let side = |x: f64| if x.fract() == 0.0 && (1.0..1e6).contains(&x) { x as usize } else { 0 };
    let [columns, rows] = sides.map(side);
    if columns == 0 || rows == 0 || columns * rows > MAX_PIXELS {
        let [x, y] = sides;
        return Err(ApiError(format!("a picture of {x} × {y} pixels cannot be: expected at most {MAX_PIXELS} in all")));
    }
    Ok([columns, rows])
}

/// The bytes of argument 0, `width` for each pixel.
fn pixels<'a>(a: Arguments<'a>, [columns, rows]: [usize; 2], width: usize) -> Result<&'a [u8], ApiError> {
    let (bytes, n) = (a.bytes(0)?, columns * rows * width);
    if bytes.len() != n {
        return Err(ApiError(format!(
            "the picture has {} bytes, expected {columns}·{rows}·{width} = {n}",
            bytes.len()
        )));
    }
    Ok(bytes)
}

/// Left and right, or top and bottom, change places.
fn transform(_: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (size, options) = (resolution(a, 1)?, a.int_or(2, 0)?);
    let width = if options & 1 != 0 { 4 } else { 3 };
    let bytes = pixels(a, size, width)?;
    let [columns, rows] = size;
    let mut out = Vec::with_capacity(bytes.len());
    for j in 0..rows {
        let row = if options & 4 != 0 { rows - 1 - j } else { j };
        for i in 0..columns {
            let column = if options & 2 != 0 { columns - 1 - i } else { i };
            let k = width * (row * columns + column);
            out.extend_from_slice(&bytes[k..k + width]);
        }
    }
    Ok(vec![Value::Bytes(out)])
}

/// Another size: the nearest pixel, or the mean of the four about a place.
fn scale(_: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (from, wanted, options) = (resolution(a, 1)?, resolution(a, 2)?, a.int_or(3, 0)?);
    let (width, out_width) = (if options & 1 != 0 { 4 } else { 3 }, if options & 2 != 0 { 4 } else { 3 });
    let bytes = pixels(a, from, width)?;
    let to = match options & 12 {
        0 => wanted,
        kind => kept_ratio(from, wanted, kind == 8)?,
    };
    let is_smooth = options & 16 == 0;
    let mut out = Vec::with_capacity(to[0] * to[1] * out_width);
    for j in 0..to[1] {
        for i in 0..to[0] {
            let place = [i, j].into_iter().zip(from).zip(to);
            let place: Vec<f64> = place.map(|((k, n), m)| (k as f64 + 0.5) * n as f64 / m as f64 - 0.5).collect();
            for c in 0..out_width {
                out.push(if c < width {
                    sample(bytes, (from, width, c), (place[0], place[1]), is_smooth)
                } else {
                    255
                });
            }
        }
    }
    Ok(vec![Value::Bytes(out), Value::List(to.map(|n| Value::Int(n as i64)).to_vec())])
}

/// The size with the ratio of `from` that fits into `wanted`, or that covers it.
fn kept_ratio(from: [usize; 2], wanted: [usize; 2], covers: bool) -> Result<[usize; 2], ApiError> {
    let [x, y] = [0, 1].map(|k| wanted[k] as f64 / from[k] as f64);
    let factor = if covers { x.max(y) } else { x.min(y) };
    let size = from.map(|n| ((n as f64 * factor).round() as usize).max(1));
    if size[0].saturating_mul(size[1]) > MAX_PIXELS {
        return Err(ApiError(format!("the picture would have more than {MAX_PIXELS} pixels")));
    }
    Ok(size)
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

/// Extensions of pictures that V-REP writes and sincro does not: their content is PNG here.
const OTHER_EXTENSIONS: [&str; 9] = ["jpg", "jpeg", "tga", "tif", "tiff", "gif", "ppm", "xbm", "xpm"];

/// A picture as a file: its bytes for a name that is an extension alone, such as `.png`; else it is kept with the run
/// that a script makes it in, or, of a client, written into the folder for files of clients.
fn save(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (size, options, name) = (resolution(a, 1)?, a.int_or(2, 0)?, a.text(3)?);
    let channels = match options & 3 {
        0 => png::Channels::Rgb,
        1 => png::Channels::Rgba,
        2 => png::Channels::Grey,
        _ => return Err(ApiError::new("the format of the picture is none of rgb 0, rgba 1, grey 2")),
    };
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let Some((stem, extension)) = last.rsplit_once('.').map(|(stem, e)| (stem, e.to_ascii_lowercase())) else {
        return Err(ApiError(format!("`{last}` has no extension: `.png` and `.bmp` are written")));
    };
    let is_other = OTHER_EXTENSIONS.contains(&&*extension);
    if !(is_other && !stem.is_empty() || matches!(&*extension, "png" | "bmp")) {
        let extension: String = extension.chars().take(20).collect();
        return Err(ApiError(format!("pictures are not written as `.{extension}`: `.png` and `.bmp` are")));
    }
    let bytes = pixels(a, size, channels.width())?;
    // pictures here are V-REP's, from the bottom; it saves the first row as the upper one
    let width = size[0] * channels.width();
    let turned: Vec<u8> = bytes.chunks_exact(width).rev().flatten().copied().collect();
    let file = if extension == "bmp" { bitmap(&turned, size, channels) } else { png::encode(&turned, size, channels) };
    if stem.is_empty() {
        return Ok(vec![Value::Bytes(file)]);
    }
    let name = if is_other { format!("{last}.png") } else { format!("{stem}.{extension}") };
    check_file_name(&name)?;
    if is_other {
        sim.log(300, &format!("the picture `{last}` is saved as `{name}`: pictures are not written as `.{extension}`"));
    }
    keep(sim, name, file)?;
    one(1_i64)
}

/// Checks that a name is one of a file in a folder that is given, and leads to no other.
///
/// # Errors
///
/// It is no plain name.
pub(crate) fn check_file_name(name: &str) -> Result<(), ApiError> {
    let is_plain = !name.is_empty()
        && name.len() <= MAX_NAME_LEN
        && !name.starts_with('.')
        && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | ' '));
    if is_plain {
        return Ok(());
    }
    let short: String = name.chars().take(100).collect();
    Err(ApiError(format!("`{short}` is no name of a file here: letters, digits, `.`, `_`, `-` and spaces, no folders")))
}

/// Keeps the file of a picture.
fn keep(sim: &mut SimApi<'_>, name: String, file: Vec<u8>) -> Result<(), ApiError> {
    if sim.own.is_some() && sim.is_running() {
        return sim.registry.keep_image(&name, file);
    }
    if sim.registry.sent_folder.is_none() {
        return Err(ApiError(format!(
            "`{name}` is not written: in a run scripts save pictures, clients with `sincro serve --grant files`; `.png` gives the picture back as bytes"
        )));
    }
    sim.registry.ask_to_save_image(name, file)
}

/// A picture as a bitmap of Windows, 24 bits a pixel without compression; rows from the bottom, as here.
fn bitmap(pixels: &[u8], [columns, rows]: [usize; 2], channels: png::Channels) -> Vec<u8> {
    let (width, line) = (channels.width(), (3 * columns).next_multiple_of(4));
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

/// Type of a number in a buffer: V-REP's number for it, its size in bytes.
#[derive(Clone, Copy, PartialEq)]
enum Sort {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    Single,
    Double,
}

impl Sort {
    fn of(number: i64) -> Option<Self> {
        Some(match number {
            0 => Self::U8,
            1 => Self::I8,
            2 => Self::U16,
            3 => Self::I16,
            4 => Self::U32,
            5 => Self::I32,
            6 => Self::Single,
            7 => Self::Double,
            _ => return None,
        })
    }

    fn width(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::Single => 4,
            Self::Double => 8,
        }
    }

    fn read(self, b: &[u8]) -> f64 {
        match self {
            Self::U8 => b[0].into(),
            Self::I8 => i8::from_le_bytes([b[0]]).into(),
            Self::U16 => u16::from_le_bytes([b[0], b[1]]).into(),
            Self::I16 => i16::from_le_bytes([b[0], b[1]]).into(),
            Self::I32 => i32::from_le_bytes([b[0], b[1], b[2], b[3]]).into(),
            Self::U32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]).into(),
            Self::Single => f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into(),
            Self::Double => f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]),
        }
    }

    /// Writes a number; one out of range is clamped.
    fn write(self, x: f64, out: &mut Vec<u8>) {
        match self {
            Self::U8 => out.push(x as u8),
            Self::I8 => out.extend((x as i8).to_le_bytes()),
            Self::I16 => out.extend((x as i16).to_le_bytes()),
            Self::I32 => out.extend((x as i32).to_le_bytes()),
            Self::U16 => out.extend((x as u16).to_le_bytes()),
            Self::U32 => out.extend((x as u32).to_le_bytes()),
            Self::Single => out.extend((x as f32).to_le_bytes()),
            Self::Double => out.extend(x.to_le_bytes()),
        }
    }
}

/// Numbers as others: offset + multiplier · number.
fn transform_buffer(_: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let sort = |k: usize| {
        let number = a.int(k)?;
        let known = "sim.buffer_uint8, int8, uint16, int16, uint32, int32, float and double";
        Sort::of(number)
            .ok_or_else(|| ApiError(format!("{number} is no format of numbers that is known here: {known}")))
    };
    let (from, to) = (sort(1)?, sort(4)?);
    let (multiplier, offset, bytes) = (a.real(2)?, a.real(3)?, a.bytes(0)?);
    if !bytes.len().is_multiple_of(from.width()) {
        return Err(ApiError(format!("{} bytes are no whole number of numbers of {}", bytes.len(), from.width())));
    }
    let mut out = Vec::with_capacity(bytes.len() / from.width() * to.width());
    for number in bytes.chunks_exact(from.width()) {
        to.write(offset + multiplier * from.read(number), &mut out);
    }
    Ok(vec![Value::Bytes(out)])
}
