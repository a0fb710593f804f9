//! Messages of the legacy API as packets: a head of three 16-bit integers (1, length of the payload, packets to come),
//! then the payload.

use std::io::{self, ErrorKind, Read, Write};

use crate::limits;
use crate::listen::Connection;

/// Size of the head of a packet `[bytes]`: three 16-bit whole numbers, little endian.
pub const HEAD: usize = 6;
/// Bytes of a payload in packets that are sent: all that clients of every version take.
pub(crate) const PAYLOAD: usize = 1294;

/// Receives one message.
///
/// # Errors
///
/// The connection has ended, or sent something else.
pub(crate) fn receive(connection: &mut Connection, message: &mut Vec<u8>) -> io::Result<()> {
    message.clear();
    loop {
        let mut head = [0; HEAD];
        connection.read_exact(&mut head)?;
        let (length, left) = parse_head(&head).ok_or(ErrorKind::InvalidData)?;
        if message.len() + length > limits::MESSAGE {
            return Err(ErrorKind::InvalidData.into());
        }
        connection.read_appending(length, message)?;
        if left == 0 {
            connection.end_message();
            return Ok(());
        }
    }
}

/// Reads the head of a packet: length of its payload `[bytes]`, then the number of packets of the message that follow.
/// None if it is no head of a packet.
#[must_use]
pub fn parse_head(head: &[u8; HEAD]) -> Option<(usize, u16)> {
    let word = |k: usize| i16::from_le_bytes([head[k], head[k + 1]]);
    let (length, left) = (word(2), word(4));
    (word(0) == 1 && length >= 0 && left >= 0).then_some((length as usize, left as u16))
}

/// Sends a message; all its packets but the last are of the same length.
///
/// # Errors
///
/// The connection does not take it, or it is too long for the counter of packets.
pub(crate) fn send(connection: &mut Connection, message: &[u8]) -> io::Result<()> {
    // a message of up to 32767 usual packets; beyond it larger ones, which the client takes too
    let payload = PAYLOAD.max(message.len().div_ceil(i16::MAX as usize));
    let n = message.len().div_ceil(payload).max(1);
    if payload > i16::MAX as usize {
        return Err(ErrorKind::InvalidInput.into());
    }
    let mut bytes = Vec::with_capacity(message.len() + n * HEAD);
    for k in 0..n {
        let part = &message[k * payload..message.len().min((k + 1) * payload)];
        for word in [1, part.len() as i16, (n - 1 - k) as i16] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(part);
    }
    connection.write_all(&bytes)
}
