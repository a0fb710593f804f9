//! Tubes: pairs of queues that scripts and clients open by name, as V-REP 3 has them.

use std::collections::VecDeque;

use crate::ApiError;
use crate::stored::check_name;

/// Ends that may be open at once.
const MAX_ENDS: usize = 1_000;
/// Packets that an end keeps at most; the oldest are dropped.
const MAX_PACKETS: usize = 10_000;

/// All open ends.
#[derive(Clone, Debug, Default)]
pub struct Tubes {
    ends: Vec<Option<End>>,
}

#[derive(Clone, Debug)]
struct End {
    key: (i64, String),
    partner: Option<usize>,
    capacity: usize,
    /// Packets that have not been read.
    received: VecDeque<Vec<u8>>,
}

impl Tubes {
    /// Opens an end; the first open one of the same name without a partner becomes its partner.
    pub fn open(&mut self, (header, name): (i64, &str), capacity: usize) -> Result<usize, ApiError> {
        check_name("tube", name)?;
        let free = self.ends.iter().position(Option::is_none).unwrap_or(self.ends.len());
        if free >= MAX_ENDS {
            return Err(ApiError(format!("{MAX_ENDS} tubes are open already: close some")));
        }
        let key = (header, name.to_owned());
        let fits = |end: &Option<End>| end.as_ref().is_some_and(|end| end.partner.is_none() && end.key == key);
        let partner = self.ends.iter().position(fits);
        let capacity = capacity.clamp(1, MAX_PACKETS);
        let end = Some(End { key, partner, capacity, received: VecDeque::new() });
        if free == self.ends.len() {
            self.ends.push(end);
        } else {
            self.ends[free] = end;
        }
        if let Some(other) = partner.and_then(|k| self.ends[k].as_mut()) {
            other.partner = Some(free);
        }
        Ok(free)
    }

    fn end(&mut self, number: i64) -> Result<&mut End, ApiError> {
        let found = usize::try_from(number).ok().and_then(|k| self.ends.get_mut(k)?.as_mut());
        found.ok_or_else(|| ApiError(format!("there is no open tube {number}")))
    }

    /// Closes an end of a tube.
    ///
    /// # Errors
    ///
    /// No end has that number.
    pub fn close(&mut self, number: i64) -> Result<(), ApiError> {
        let partner = self.end(number)?.partner;
        self.ends[number as usize] = None;
        if let Some(other) = partner.and_then(|k| self.ends[k].as_mut()) {
            other.partner = None;
        }
        Ok(())
    }

    /// True if the packet was sent, false if nobody has the other end.
    pub fn write(&mut self, number: i64, packet: &[u8]) -> Result<bool, ApiError> {
        let Some(partner) = self.end(number)?.partner else { return Ok(false) };
        if let Some(other) = self.ends[partner].as_mut() {
            if other.received.len() == other.capacity {
                other.received.pop_front();
            }
            other.received.push_back(packet.to_vec());
        }
        Ok(true)
    }

    /// The oldest packet that was not read.
    pub fn read(&mut self, number: i64) -> Result<Option<Vec<u8>>, ApiError> {
        Ok(self.end(number)?.received.pop_front())
    }

    /// True if the other end is open; packets to be read here and there.
    pub fn status(&mut self, number: i64) -> Result<(bool, usize, usize), ApiError> {
        let end = self.end(number)?;
        let (partner, to_read) = (end.partner, end.received.len());
        let written = partner.and_then(|k| self.ends[k].as_ref()).map_or(0, |other| other.received.len());
        Ok((partner.is_some(), to_read, written))
    }

    /// Bytes that wait to be read, and those of names.
    pub fn total(&self) -> usize {
        let of_end = |end: &End| end.key.1.len() + end.received.iter().map(Vec::len).sum::<usize>();
        self.ends.iter().flatten().map(of_end).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_arrive_in_order_at_the_other_end_until_one_is_closed() {
        let mut tubes = Tubes::default();
        let (a, stranger) = (tubes.open((0, "t"), 2).unwrap() as i64, tubes.open((1, "t"), 2).unwrap() as i64);
        assert!(!tubes.write(a, b"lost").unwrap());
        let b = tubes.open((0, "t"), 2).unwrap() as i64;
        for packet in [b"1", b"2", b"3"] {
            assert!(tubes.write(a, packet).unwrap());
        }
        assert_eq!(tubes.status(a).unwrap(), (true, 0, 2));
        assert_eq!(tubes.read(b).unwrap(), Some(b"2".to_vec()), "the oldest of three went: two are kept");
        assert_eq!((tubes.read(b).unwrap(), tubes.read(b).unwrap()), (Some(b"3".to_vec()), None));
        assert_eq!(tubes.read(stranger).unwrap(), None);
        tubes.close(b).unwrap();
        assert!(tubes.read(b).is_err() && !tubes.write(a, b"4").unwrap());
    }
}
