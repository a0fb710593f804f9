//! Functions: pictures as bytes, wherever they come from.

use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments, SimApi, Value};
use sincro_scene::camera::{MAX_PIXELS, png};
use sincro_values::numbers::NumberFormat;
use sincro_vision::pictures::{bitmap, flipped, scaled};

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
    Ok(vec![Value::Bytes(flipped(bytes, size, width, [options & 2 != 0, options & 4 != 0]))])
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
    let out = scaled(bytes, (from, width), (to, out_width), options & 16 == 0);
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
    let file =
        if extension == "bmp" { bitmap(&turned, size, channels.width()) } else { png::encode(&turned, size, channels) };
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
    if sim.registry.sent_folder.is_none() && !(sim.own.is_some() && sim.is_running()) {
        return Err(ApiError(format!(
            "`{name}` is not written: in a run scripts save pictures, clients with `sincro serve --grant files`; `.png` gives the picture back as bytes"
        )));
    }
    sim.keep_file(name, file)
}

/// Numbers as others: offset + multiplier · number.
fn transform_buffer(_: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let format = |k: usize| {
        let number = a.int(k)?;
        let known = "sim.buffer_uint8, int8, uint16, int16, uint32, int32, float and double";
        NumberFormat::of(number)
            .ok_or_else(|| ApiError(format!("{number} is no format of numbers that is known here: {known}")))
    };
    let (from, to) = (format(1)?, format(4)?);
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
