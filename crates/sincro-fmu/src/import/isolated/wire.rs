//! Messages between a run and the process of an FMU: frames of a length and fields, little endian, numbers as bits.

use std::io::{self, Read, Write};

/// Longest frame that is read `[bytes]`: 3 GiB, an FMU of the largest size.
const MAX_FRAME: u64 = 3 << 30;

/// Request to an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verb {
    Open,
    Start,
    Set,
    Get,
    Step,
    Save,
    Restore,
    States,
    SetStates,
    Derivatives,
    Indicators,
    CompleteStep,
    HandleEvents,
    DirectionalDerivative,
}

impl Verb {
    pub const ALL: [Self; 14] = [
        Self::Open,
        Self::Start,
        Self::Set,
        Self::Get,
        Self::Step,
        Self::Save,
        Self::Restore,
        Self::States,
        Self::SetStates,
        Self::Derivatives,
        Self::Indicators,
        Self::CompleteStep,
        Self::HandleEvents,
        Self::DirectionalDerivative,
    ];
}

/// Fields of a frame that is written.
#[derive(Debug, Default)]
pub(super) struct Fields(Vec<u8>);

impl Fields {
    pub fn code(mut self, code: u8) -> Self {
        self.0.push(code);
        self
    }

    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.extend((bytes.len() as u64).to_le_bytes());
        self.0.extend(bytes);
        self
    }

    pub fn numbers(mut self, numbers: &[f64]) -> Self {
        self.0.extend((numbers.len() as u64).to_le_bytes());
        numbers.iter().for_each(|x| self.0.extend(x.to_le_bytes()));
        self
    }

    pub fn places(mut self, places: &[usize]) -> Self {
        self.0.extend((places.len() as u64).to_le_bytes());
        places.iter().for_each(|k| self.0.extend((*k as u64).to_le_bytes()));
        self
    }

    /// These fields and behind them others.
    pub fn and(mut self, others: Self) -> Self {
        self.0.extend(others.0);
        self
    }

    /// Writes the frame at once.
    pub fn send(self, to: &mut impl Write) -> io::Result<()> {
        let mut frame = (self.0.len() as u64).to_le_bytes().to_vec();
        frame.extend(self.0);
        to.write_all(&frame)?;
        to.flush()
    }
}

/// Frame that was read, field by field; whatever does not fit is an error.
#[derive(Debug)]
pub(super) struct Frame {
    bytes: Vec<u8>,
    at: usize,
}

impl Frame {
    /// Reads a frame; none at the end of the connection.
    pub fn receive(from: &mut impl Read) -> io::Result<Option<Self>> {
        let mut length = [0; 8];
        match from.read_exact(&mut length) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
            Err(error) => return Err(error),
        }
        let length = u64::from_le_bytes(length);
        if length > MAX_FRAME {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a message is too long"));
        }
        // grows with what arrives, not with what is promised
        let mut bytes = Vec::new();
        from.take(length).read_to_end(&mut bytes)?;
        Ok((bytes.len() as u64 == length).then_some(Self { bytes, at: 0 }))
    }

    fn take(&mut self, n: usize) -> Result<&[u8], String> {
        let end = self.at.checked_add(n).filter(|end| *end <= self.bytes.len());
        let end = end.ok_or("a message is too short")?;
        let field = &self.bytes[self.at..end];
        self.at = end;
        Ok(field)
    }

    fn word(&mut self) -> Result<u64, String> {
        Ok(u64::from_le_bytes(self.take(8)?.try_into().expect("eight bytes")))
    }

    pub fn code(&mut self) -> Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    pub fn bytes(&mut self) -> Result<&[u8], String> {
        let n = usize::try_from(self.word()?).map_err(|_| "a message is too short")?;
        self.take(n)
    }

    fn words(&mut self) -> Result<Vec<u64>, String> {
        let n = usize::try_from(self.word()?).ok().and_then(|n| n.checked_mul(8)).ok_or("a message is too short")?;
        let bytes = self.take(n)?;
        Ok(bytes.chunks_exact(8).map(|x| u64::from_le_bytes(x.try_into().expect("eight bytes"))).collect())
    }

    pub fn numbers(&mut self) -> Result<Vec<f64>, String> {
        Ok(self.words()?.into_iter().map(f64::from_bits).collect())
    }

    pub fn places(&mut self) -> Result<Vec<usize>, String> {
        let wide = self.words()?;
        wide.into_iter().map(|k| usize::try_from(k).map_err(|_| "a place is too large".to_owned())).collect()
    }

    /// Reads numbers into a slice of as many.
    pub fn fill(&mut self, numbers: &mut [f64]) -> Result<(), String> {
        let read = self.numbers()?;
        if read.len() != numbers.len() {
            return Err("a message has another number of numbers".into());
        }
        numbers.copy_from_slice(&read);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_come_back_bit_by_bit() {
        let numbers = [0.1, -0.0, f64::INFINITY, f64::from_bits(1)];
        let mut pipe = Vec::new();
        Fields::default().code(7).numbers(&numbers).places(&[3, 0]).bytes(b"ab").send(&mut pipe).unwrap();
        let mut frame = Frame::receive(&mut pipe.as_slice()).unwrap().unwrap();
        assert_eq!(frame.code(), Ok(7));
        assert_eq!(frame.numbers().unwrap().map_bits(), numbers.to_vec().map_bits());
        assert_eq!((frame.places().unwrap(), frame.bytes().unwrap().to_vec()), (vec![3, 0], b"ab".to_vec()));
        assert!(frame.code().is_err());
    }

    trait Bits {
        fn map_bits(self) -> Vec<u64>;
    }

    impl Bits for Vec<f64> {
        fn map_bits(self) -> Vec<u64> {
            self.into_iter().map(f64::to_bits).collect()
        }
    }

    #[test]
    fn damaged_frames_are_refused() {
        assert!(Frame::receive(&mut &b""[..]).unwrap().is_none());
        assert!(Frame::receive(&mut &[9, 0, 0, 0, 0, 0, 0, 0, 1][..]).unwrap().is_none());
        assert!(Frame::receive(&mut &[0xff; 16][..]).is_err());
        let mut pipe = Vec::new();
        Fields::default().places(&[usize::MAX / 4]).send(&mut pipe).unwrap();
        pipe[8] = 0xff;
        assert!(Frame::receive(&mut pipe.as_slice()).unwrap().unwrap().numbers().is_err());
    }
}
