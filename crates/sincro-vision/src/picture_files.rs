//! Pictures from files: PNG (ISO/IEC 15948) of eight bits a channel without interlacing, and BMP of 24 or 32 bits
//! without compression; of JPEG the size alone.

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

/// Pixels of the largest picture that is read.
pub const MAX_PIXELS: usize = 1 << 24;
/// First bytes of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Picture of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Numbers of columns and rows.
    pub size: [usize; 2],
    /// Red, green, blue and opacity (0 to 255) of each pixel, row by row from the top, each from left to right.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Red, green and blue of each pixel, in the same order.
    #[must_use]
    pub fn rgb(&self) -> Vec<u8> {
        self.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }
}

/// Columns and rows of the picture in a PNG, BMP or JPEG file; none if it is another file.
#[must_use]
pub fn size_of(file: &[u8]) -> Option<[usize; 2]> {
    let side = |n: u32| usize::try_from(n).ok().filter(|n| *n > 0);
    let [columns, rows] = if file.starts_with(PNG) {
        [big_endian(file, 16)?, big_endian(file, 20)?]
    } else if file.starts_with(b"BM") {
        [little_endian(file, 18)?, little_endian(file, 22)?.cast_signed().unsigned_abs()]
    } else {
        jpeg_size(file)?
    };
    Some([side(columns)?, side(rows)?])
}

/// Decodes the picture of a PNG or BMP file.
///
/// # Errors
///
/// The file is another one, of a kind that is not read, damaged, or larger than [`MAX_PIXELS`]; the text says which.
pub fn decode(file: &[u8]) -> Result<Picture, &'static str> {
    let size = size_of(file).ok_or("it is no PNG or BMP file")?;
    if size[0].checked_mul(size[1]).is_none_or(|n| n > MAX_PIXELS) {
        return Err("it has too many pixels");
    }
    match file {
        file if file.starts_with(PNG) => png(file, size),
        file if file.starts_with(b"BM") => bmp(file, size),
        _ => Err("JPEG files are not read: give it as PNG"),
    }
}

fn big_endian(file: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(file.get(at..at + 4)?.try_into().ok()?))
}

fn little_endian(file: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(file.get(at..at + 4)?.try_into().ok()?))
}

/// Size in the first frame header of a JPEG file.
fn jpeg_size(file: &[u8]) -> Option<[u32; 2]> {
    if !file.starts_with(b"\xff\xd8") {
        return None;
    }
    let mut at = 2;
    loop {
        let [0xff, marker, high, low, ..] = *file.get(at..)? else { return None };
        // frame headers but for tables of Huffman codes, arithmetic conditions and extensions
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let [rows, columns] =
                [at + 5, at + 7].map(|k| Some(u16::from_be_bytes([*file.get(k)?, *file.get(k + 1)?])));
            return Some([columns?.into(), rows?.into()]);
        }
        at += 2 + usize::from(u16::from_be_bytes([high, low]));
    }
}

fn png(file: &[u8], size: [usize; 2]) -> Result<Picture, &'static str> {
    const CUT: &str = "the PNG file ends early or is damaged";
    let [depth, kind, _, _, interlacing] = *file.get(24..29).ok_or(CUT)? else { return Err(CUT) };
    // grey, red green blue, palette, grey and opacity, red green blue and opacity
    let width = match kind {
        0 | 3 => 1,
        2 => 3,
        4 => 2,
        6 => 4,
        _ => return Err(CUT),
    };
    if depth != 8 || interlacing != 0 {
        return Err("PNG files are read with eight bits a channel, not interlaced");
    }
    let (mut palette, mut packed, mut at): (&[u8], Vec<u8>, usize) = (&[], Vec::new(), 8);
    loop {
        let n = big_endian(file, at).ok_or(CUT)? as usize;
        let name = file.get(at + 4..at + 8).ok_or(CUT)?;
        let data = file.get(at + 8..).and_then(|rest| rest.get(..n)).ok_or(CUT)?;
        match name {
            b"PLTE" => palette = data,
            b"IDAT" => packed.extend_from_slice(data),
            b"IEND" => break,
            _ => {}
        }
        at += 12 + n;
    }
    let row = size[0] * width;
    let lines = decompress_to_vec_zlib_with_limit(&packed, (row + 1) * size[1]).map_err(|_| CUT)?;
    if lines.len() != (row + 1) * size[1] {
        return Err(CUT);
    }
    let (mut rgba, mut above) = (Vec::with_capacity(4 * size[0] * size[1]), vec![0_u8; row]);
    for line in lines.chunks_exact(row + 1) {
        let mut now = line[1..].to_vec();
        unfilter(line[0], width, &above, &mut now).ok_or(CUT)?;
        for pixel in now.chunks_exact(width) {
            rgba.extend(match *pixel {
                [grey] if kind == 0 => [grey, grey, grey, 255],
                [index] => {
                    let color = palette.get(3 * usize::from(index)..).and_then(|c| c.get(..3)).ok_or(CUT)?;
                    [color[0], color[1], color[2], 255]
                }
                [grey, opacity] => [grey, grey, grey, opacity],
                [red, green, blue] => [red, green, blue, 255],
                [red, green, blue, opacity, ..] => [red, green, blue, opacity],
                [] => return Err(CUT),
            });
        }
        above = now;
    }
    Ok(Picture { size, rgba })
}

/// Undoes the filter of a row: each byte was stored as the difference to a prediction from the bytes to the left, above
/// and above to the left.
fn unfilter(filter: u8, width: usize, above: &[u8], row: &mut [u8]) -> Option<()> {
    for k in 0..row.len() {
        let before = |line: &[u8]| k.checked_sub(width).map_or(0, |k| line[k]);
        let (left, up, corner) = (before(row), above[k], before(above));
        let prediction = match filter {
            0 => 0,
            1 => left,
            2 => up,
            3 => u16::midpoint(left.into(), up.into()) as u8,
            4 => paeth(left, up, corner),
            _ => return None,
        };
        row[k] = row[k].wrapping_add(prediction);
    }
    Some(())
}

/// Nearest of left, up and corner to left + up − corner.
fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let p = i16::from(left) + i16::from(up) - i16::from(corner);
    let distance = |x: u8| (p - i16::from(x)).abs();
    if distance(left) <= distance(up) && distance(left) <= distance(corner) {
        left
    } else if distance(up) <= distance(corner) {
        up
    } else {
        corner
    }
}

fn bmp(file: &[u8], size: [usize; 2]) -> Result<Picture, &'static str> {
    const CUT: &str = "the BMP file ends early or is damaged";
    let (start, rows) = (little_endian(file, 10).ok_or(CUT)?, little_endian(file, 22).ok_or(CUT)?.cast_signed());
    let (bits, compression) = (little_endian(file, 28).ok_or(CUT)? & 0xffff, little_endian(file, 30).ok_or(CUT)?);
    if !matches!(bits, 24 | 32) || !matches!(compression, 0 | 3) {
        return Err("BMP files are read with 24 or 32 bits a pixel, not compressed");
    }
    let width = bits as usize / 8;
    let stride = (size[0] * width).next_multiple_of(4);
    let lines = file.get(start as usize..).and_then(|rest| rest.get(..stride * size[1])).ok_or(CUT)?;
    let mut lines: Vec<&[u8]> = lines.chunks_exact(stride).collect();
    // from the bottom unless the number of rows is negative
    if rows > 0 {
        lines.reverse();
    }
    let pixels = lines.iter().flat_map(|line| line[..size[0] * width].chunks_exact(width));
    let rgba = pixels.flat_map(|p| [p[2], p[1], p[0], p.get(3).copied().unwrap_or(255)]).collect();
    Ok(Picture { size, rgba })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::bitmap;

    /// Chunk of a PNG file; its checksum is not read.
    fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
        [&(data.len() as u32).to_be_bytes()[..], name, data, &[0; 4]].concat()
    }

    fn png_of([columns, rows]: [u32; 2], kind: u8, lines: &[u8]) -> Vec<u8> {
        let head = [&columns.to_be_bytes()[..], &rows.to_be_bytes(), &[8, kind, 0, 0, 0]].concat();
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(lines, 6);
        let palette = [9, 8, 7, 1, 2, 3];
        [PNG, &chunk(b"IHDR", &head), &chunk(b"PLTE", &palette), &chunk(b"IDAT", &packed), &chunk(b"IEND", &[])]
            .concat()
    }

    #[test]
    fn every_filter_of_png_is_undone() {
        // the same row of grey 10, 20, 40 by each filter, given the row above
        let lines = [
            [0, 10, 20, 40],
            [1, 10, 10, 20],
            [2, 0, 0, 0],
            // half of left and above: 5, 15, 30
            [3, 5, 5, 10],
            // nearest to left + above − corner: 10 above, 20 above, 40 above
            [4, 0, 0, 0],
        ]
        .concat();
        let picture = decode(&png_of([3, 5], 0, &lines)).unwrap();
        assert_eq!(picture.size, [3, 5]);
        let row = [10, 20, 40].map(|x| [x, x, x, 255]).concat();
        assert_eq!(picture.rgba, row.repeat(5));
    }

    #[test]
    fn palettes_and_opacity_are_read() {
        let palette = decode(&png_of([2, 1], 3, &[0, 1, 0])).unwrap();
        assert_eq!(palette.rgba, [1, 2, 3, 255, 9, 8, 7, 255]);
        assert_eq!(decode(&png_of([1, 1], 6, &[0, 1, 2, 3, 4])).unwrap().rgba, [1, 2, 3, 4]);
        assert_eq!(decode(&png_of([1, 1], 4, &[0, 7, 9])).unwrap().rgba, [7, 7, 7, 9]);
    }

    #[test]
    fn a_bitmap_is_read_as_it_was_written() {
        // the lower row first, as `bitmap` takes them
        let rows = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];
        let picture = decode(&bitmap(&rows, [2, 2], 3)).unwrap();
        let rgb: Vec<u8> = picture.rgba.chunks_exact(4).flat_map(|p| p[..3].to_vec()).collect();
        assert_eq!(rgb, [&rows[6..], &rows[..6]].concat());
    }

    #[test]
    fn a_jpeg_tells_its_size_and_nothing_more() {
        let file = [0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 1, 0xff, 0xc0, 0, 11, 8, 0, 3, 0, 5, 1, 1, 0x11, 0];
        assert_eq!(size_of(&file), Some([5, 3]));
        assert!(decode(&file).is_err_and(|why| why.contains("PNG")));
    }

    #[test]
    fn damaged_files_are_refused() {
        let whole = png_of([3, 1], 0, &[0, 1, 2, 3]);
        for n in 0..whole.len() - 1 {
            assert!(decode(&whole[..n]).is_err() || n > whole.len() - 12, "{n} bytes");
        }
        assert!(decode(&png_of([3, 1], 0, &[0, 1, 2])).is_err());
        assert!(decode(&png_of([1, 1], 3, &[0, 2])).is_err());
        assert!(decode(&png_of([1, 1], 0, &[5, 2])).is_err());
        assert!(decode(b"BM").is_err() && decode(b"").is_err());
    }
}
