//! Pictures as PNG (ISO/IEC 15948): eight bits a channel, rows that differ little from the one before them.

use miniz_oxide::deflate::compress_to_vec_zlib;

/// Channels of the pixels of a PNG file, one byte each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// One channel: intensity.
    Grey,
    /// Three channels: red, green, blue.
    Rgb,
    /// Four channels: red, green, blue, opacity.
    Rgba,
}

impl Channels {
    /// Returns the number of bytes per pixel: 1, 3 or 4.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }

    /// The format's own number.
    fn number(self) -> u8 {
        match self {
            Self::Grey => 0,
            Self::Rgb => 2,
            Self::Rgba => 6,
        }
    }
}

/// Encodes an image as a PNG file and returns its bytes. `pixels` holds `columns · rows` pixels of [`Channels::width`]
/// bytes, row by row from the bottom of the picture as in [`Image`](crate::Image), each from left to right.
///
/// # Panics
///
/// If `pixels` has another length.
#[must_use]
pub fn encode(pixels: &[u8], [columns, rows]: [usize; 2], channels: Channels) -> Vec<u8> {
    let width = columns * channels.width();
    assert_eq!(pixels.len(), width * rows, "bytes of a picture");
    let mut filtered = Vec::with_capacity((width + 1) * rows);
    let mut above: &[u8] = &[];
    for row in pixels.chunks_exact(width.max(1)).rev() {
        // filter 2: each byte minus the one above it; nothing is above the first row
        filtered.push(2);
        filtered.extend(row.iter().enumerate().map(|(k, x)| x.wrapping_sub(above.get(k).copied().unwrap_or(0))));
        above = row;
    }
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut head = Vec::with_capacity(13);
    head.extend((columns as u32).to_be_bytes());
    head.extend((rows as u32).to_be_bytes());
    head.extend([8, channels.number(), 0, 0, 0]);
    chunk(*b"IHDR", &head, &mut file);
    chunk(*b"IDAT", &compress_to_vec_zlib(&filtered, 6), &mut file);
    chunk(*b"IEND", &[], &mut file);
    file
}

fn chunk(name: [u8; 4], data: &[u8], file: &mut Vec<u8>) {
    file.extend((data.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(name);
    file.extend(data);
    let sum = crc32fast::hash(&file[start..]);
    file.extend(sum.to_be_bytes());
}

#[cfg(test)]
mod tests {
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    use super::*;

    #[test]
    fn rows_come_from_the_top_and_the_sums_are_those_of_the_format() {
        // the sum of an empty chunk IEND is in every PNG file
        let pixels: Vec<u8> = (0..2 * 3 * 3).map(|k| 10 * k).collect();
        let file = encode(&pixels, [2, 3], Channels::Rgb);
        assert!(file.ends_with(&[0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82]));
        assert_eq!(file[16..29], [0, 0, 0, 2, 0, 0, 0, 3, 8, 2, 0, 0, 0]);
        let length = u32::from_be_bytes(file[33..37].try_into().unwrap()) as usize;
        let rows = decompress_to_vec_zlib(&file[41..41 + length]).unwrap();
        let mut above = vec![0_u8; 6];
        for (row, expected) in rows.chunks(7).zip(pixels.chunks(6).rev()) {
            assert_eq!(row[0], 2);
            let found: Vec<u8> = row[1..].iter().zip(&above).map(|(x, up)| x.wrapping_add(*up)).collect();
            assert_eq!(found, expected);
            above = found;
        }
    }
}
