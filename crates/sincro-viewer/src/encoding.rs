//! Arrays of numbers as text, for the data inside a page: little endian, in Base64 (RFC 4648, with padding).

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Base64 text of numbers of double precision.
pub(crate) fn doubles(numbers: impl IntoIterator<Item = f64>) -> String {
    STANDARD.encode(numbers.into_iter().flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

/// Base64 text of numbers of single precision.
pub(crate) fn singles<'a>(numbers: impl IntoIterator<Item = &'a f32>) -> String {
    STANDARD.encode(numbers.into_iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_little_endian_and_padded() {
        assert_eq!(doubles([]), "");
        // 1.0 is 3f f0 00 00 00 00 00 00 from its most significant byte on
        assert_eq!(doubles([1.0]), "AAAAAAAA8D8=");
        assert_eq!(singles(&[1.0, -2.0]), "AACAPwAAAMA=");
    }
}
