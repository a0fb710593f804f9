//! Numbers in buffers: their types and their bytes, little-endian.

/// Type of a number in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 32 bits.
    I32,
    /// Floating point, 32 bits.
    Single,
    /// Floating point, 64 bits.
    Double,
}

impl NumberFormat {
    /// Format of V-REP's number for it (`sim.buffer_uint8` 0 … `sim.buffer_double` 7); none for other numbers.
    #[must_use]
    pub fn of(number: i64) -> Option<Self> {
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

    /// Size of one number `[bytes]`.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::Single => 4,
            Self::Double => 8,
        }
    }

    /// Returns true if numbers of the format are whole.
    #[must_use]
    pub fn is_whole(self) -> bool {
        !matches!(self, Self::Single | Self::Double)
    }

    /// Reads a number from the first bytes, which are at least [`NumberFormat::width`].
    ///
    /// # Panics
    ///
    /// There are fewer bytes.
    #[must_use]
    pub fn read(self, b: &[u8]) -> f64 {
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

    /// Writes a number; casts saturate: what does not fit becomes the nearest that does.
    pub fn write(self, x: f64, out: &mut Vec<u8>) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_and_those_out_of_range_are_clamped() {
        for (number, largest) in [(0, 255.0), (1, 127.0), (2, 65_535.0), (3, 32_767.0), (4, 4_294_967_295.0)] {
            let format = NumberFormat::of(number).unwrap();
            let mut bytes = Vec::new();
            format.write(7.0, &mut bytes);
            format.write(1e12, &mut bytes);
            assert_eq!(bytes.len(), 2 * format.width());
            assert_eq!([format.read(&bytes), format.read(&bytes[format.width()..])], [7.0, largest]);
            assert!(format.is_whole());
        }
        assert_eq!(NumberFormat::of(8), None);
    }
}
