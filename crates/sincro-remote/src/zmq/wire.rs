//! ZMTP 3.0 over TCP with the NULL mechanism, as far as REP and PUB need it. Why not a library: a closed connection
//! must be known at once, and a length that a peer makes up must not take memory; and it is this one file.
//!
//! Each side sends a greeting of 64 bytes, then a READY command, then frames: flags (1 more, 2 long, 4 command), length
//! (1 byte, or 8 big endian), body.

use std::io::{self, ErrorKind, Read, Write};

use crate::limits;
use crate::listen::Connection;

const MORE: u8 = 1;
const LONG: u8 = 2;
const COMMAND: u8 = 4;
/// Frames of one message.
const MAX_FRAMES: usize = 16;

/// A frame.
struct Frame {
    flags: u8,
    body: Vec<u8>,
}

/// A connection that has shaken hands.
pub(crate) struct Socket {
    connection: Connection,
    out: Vec<u8>,
}

impl Socket {
    /// Shakes hands as a socket of type `kind`.
    ///
    /// # Errors
    ///
    /// The peer does not speak ZMTP 3 with the NULL mechanism, or has disconnected.
    pub fn accept(mut connection: Connection, kind: &str) -> io::Result<Self> {
        connection.write_all(&greeting())?;
        let mut theirs = [0; 64];
        connection.read_exact(&mut theirs)?;
        if !is_greeting(&theirs) {
            return Err(ErrorKind::InvalidData.into());
        }
        connection.write_all(&ready(kind))?;
        let mut socket = Self { connection, out: Vec::new() };
        let first = socket.frame()?;
        if first.flags & COMMAND == 0 || !first.body.starts_with(b"\x05READY") {
            return Err(ErrorKind::InvalidData.into());
        }
        Ok(socket)
    }

    fn frame(&mut self) -> io::Result<Frame> {
        let mut head = [0; 2];
        self.connection.read_exact(&mut head[..1])?;
        let flags = head[0];
        let length = if flags & LONG == 0 {
            self.connection.read_exact(&mut head[1..])?;
            u64::from(head[1])
        } else {
            let mut long = [0; 8];
            self.connection.read_exact(&mut long)?;
            u64::from_be_bytes(long)
        };
        if flags > 7 || length > limits::MESSAGE as u64 {
            return Err(ErrorKind::InvalidData.into());
        }
        let mut body = Vec::new();
        self.connection.read_appending(length as usize, &mut body)?;
        Ok(Frame { flags, body })
    }

    /// Waits for the next frame that is part of a message; a command before the first one is passed over.
    fn message_frame(&mut self, is_first: bool) -> io::Result<Frame> {
        loop {
            if is_first {
                self.connection.next_message();
            }
            let frame = self.frame()?;
            if frame.flags & COMMAND == 0 {
                return Ok(frame);
            }
        }
    }

    /// Waits for a request: the frames before its empty one, and its body.
    ///
    /// # Errors
    ///
    /// The peer has disconnected or sends something else.
    pub fn receive_request(&mut self) -> io::Result<(Vec<Vec<u8>>, Vec<u8>)> {
        let (mut envelope, mut body, mut is_body, mut n) = (Vec::new(), None, false, 0);
        loop {
            let frame = self.message_frame(n == 0)?;
            n += 1;
            if n > MAX_FRAMES || (is_body && body.is_some()) {
                return Err(ErrorKind::InvalidData.into());
            }
            let has_more = frame.flags & MORE != 0;
            if is_body {
                body = Some(frame.body);
            } else {
                is_body = frame.body.is_empty();
                envelope.push(frame.body);
            }
            if !has_more {
                self.connection.end_message();
                return body.map(|body| (envelope, body)).ok_or_else(|| ErrorKind::InvalidData.into());
            }
        }
    }

    /// Answers a request.
    ///
    /// # Errors
    ///
    /// The peer does not take it.
    pub fn send_answer(&mut self, envelope: &[Vec<u8>], body: &[u8]) -> io::Result<()> {
        self.out.clear();
        for part in envelope {
            write_frame(MORE, part, &mut self.out);
        }
        write_frame(0, body, &mut self.out);
        self.connection.write_all(&self.out)
    }

    /// The connection, for a socket that only sends.
    pub fn connection(&mut self) -> &mut Connection {
        &mut self.connection
    }

    /// Waits for anything, and drops it.
    ///
    /// # Errors
    ///
    /// The peer has disconnected.
    pub fn drop_frame(&mut self) -> io::Result<()> {
        self.frame().map(|_| ())
    }
}

/// Appends a frame of ZMTP 3 (the wire protocol of ZeroMQ) to `out`: `flags` (bit 0: more frames follow, bit 2: a
/// command), length, body. Bodies of 256 bytes and more get the long form by themselves.
pub fn write_frame(flags: u8, body: &[u8], out: &mut Vec<u8>) {
    match u8::try_from(body.len()) {
        Ok(n) => out.extend([flags, n]),
        Err(_) => {
            out.push(flags | LONG);
            out.extend((body.len() as u64).to_be_bytes());
        }
    }
    out.extend(body);
}

/// Greeting that each side of a ZMTP connection sends first, 64 bytes: signature, version 3.0, mechanism NULL.
#[must_use]
pub fn greeting() -> [u8; 64] {
    let mut bytes = [0; 64];
    (bytes[0], bytes[8], bytes[9], bytes[10]) = (0xff, 1, 0x7f, 3);
    bytes[12..16].copy_from_slice(b"NULL");
    bytes
}

/// Returns true if the bytes are the greeting of a peer that speaks version 3 or later of ZMTP with the mechanism NULL.
#[must_use]
pub fn is_greeting(bytes: &[u8; 64]) -> bool {
    let mechanism = bytes[12..32].split(|b| *b == 0).next();
    bytes[0] == 0xff && bytes[9] == 0x7f && bytes[10] >= 3 && mechanism == Some(b"NULL")
}

/// Command READY of the ZMTP handshake, as a whole frame, with the socket type `kind` (`REQ`, `REP`, `PUB` …).
#[must_use]
pub fn ready(kind: &str) -> Vec<u8> {
    let mut body = b"\x05READY\x0bSocket-Type".to_vec();
    body.extend((kind.len() as u32).to_be_bytes());
    body.extend(kind.as_bytes());
    let mut frame = Vec::new();
    write_frame(COMMAND, &body, &mut frame);
    frame
}
