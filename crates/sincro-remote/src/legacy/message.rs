//! Messages of the legacy API: a head of 18 bytes, then commands of 26 bytes, an identification and data each. Little
//! endian.

use crate::limits;

/// Bytes of a message's head.
pub(crate) const MESSAGE_HEAD: usize = 18;
/// Bytes of a command's head.
pub(crate) const COMMAND_HEAD: usize = 26;
/// Version of the protocol.
pub(crate) const VERSION: u8 = 11;

/// Head of a message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Head {
    /// Number of the message.
    pub id: i32,
    /// Clock of the client `[ms]`.
    pub client_time: i32,
    /// Clock of the server `[ms]`.
    pub server_time: i32,
    /// Number of the scene.
    pub scene: u16,
    /// Bit 0: a run is on; bit 1: it is paused; bit 2: real time.
    pub state: u8,
}

impl Head {
    /// Reads the head from the start of a message; none if that is no head.
    #[must_use]
    pub(crate) fn parse(bytes: &[u8]) -> Option<Self> {
        let b = bytes.get(..MESSAGE_HEAD)?;
        let int = |k: usize| i32::from_le_bytes([b[k], b[k + 1], b[k + 2], b[k + 3]]);
        Some(Self {
            id: int(3),
            client_time: int(7),
            server_time: int(11),
            scene: u16::from_le_bytes([b[15], b[16]]),
            state: b[17],
        })
    }

    /// Appends the head to `out`.
    pub(crate) fn write(&self, out: &mut Vec<u8>) {
        out.extend([0, 0, VERSION]);
        for x in [self.id, self.client_time, self.server_time] {
            out.extend(x.to_le_bytes());
        }
        out.extend(self.scene.to_le_bytes());
        out.push(self.state);
    }
}

/// Operation mode of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Once.
    Once,
    /// Again and again.
    Stream,
    /// Once, sent and answered in pieces.
    SplitOnce,
    /// Again and again, in pieces.
    SplitStream,
    /// No longer.
    Discontinue,
}

/// Command of a message of the legacy API, as it was sent; [`commands`] reads it. Its head is 26 bytes, little endian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command<'a> {
    /// Number of the function in the low 16 bits, operation mode (once, streaming, split, discontinue) in the rest.
    pub code: i32,
    /// Size of the whole command `[bytes]`; larger than this one if it is a piece of a split transfer.
    pub full_size: i32,
    /// Offset of `data` in the whole data of a split transfer `[bytes]`.
    pub offset: i32,
    /// Shortest time between two executions `[ms]` if it is repeated; largest piece `[bytes]` if it is split.
    pub delay: u16,
    /// Flags; bit 0: the command does not replace one with the same code and identification.
    pub status: u8,
    /// Identification of its subject: handles as 32-bit whole numbers, or a text that ends with a zero byte.
    pub ident: &'a [u8],
    /// Arguments, in the encoding of the function.
    pub data: &'a [u8],
}

impl<'a> Command<'a> {
    /// Number of the function: the low 16 bits of [`Command::code`].
    #[must_use]
    pub fn function(&self) -> u16 {
        self.code as u16
    }

    /// Mode of operation; none if there is none of that number, or if it is never sent.
    #[must_use]
    pub(crate) fn mode(&self) -> Option<Mode> {
        Some(match self.code as u32 >> 16 {
            0 | 1 => Mode::Once,
            2 => Mode::Stream,
            3 => Mode::SplitOnce,
            4 => Mode::SplitStream,
            5 => Mode::Discontinue,
            _ => return None,
        })
    }
}

/// Splits a message of the legacy API, head included, into its commands, in their order; the slices point into the
/// message.
///
/// # Errors
///
/// The message is cut short, a length does not fit, or it has more than [`COMMANDS`](crate::limits::COMMANDS) commands.
/// Nothing of it is to be executed; the text says why.
pub fn commands(message: &[u8]) -> Result<Vec<Command<'_>>, &'static str> {
    let mut rest = message.get(MESSAGE_HEAD..).ok_or("a message is shorter than its head")?;
    let mut commands = Vec::new();
    while !rest.is_empty() {
        if commands.len() == limits::COMMANDS {
            return Err("a message has too many commands");
        }
        let head = rest.get(..COMMAND_HEAD).ok_or("a command is shorter than its head")?;
        let word = |k: usize| u16::from_le_bytes([head[k], head[k + 1]]);
        let at = |k: usize| int(head, k).unwrap_or(0);
        let size = usize::try_from(at(0)).ok().filter(|n| (COMMAND_HEAD..=rest.len()).contains(n));
        let size = size.ok_or("a command has a length that the message does not have")?;
        let ident_end = COMMAND_HEAD + word(8) as usize;
        let ident = rest.get(COMMAND_HEAD..ident_end).filter(|_| ident_end <= size);
        let ident = ident.ok_or("an identification is longer than its command")?;
        commands.push(Command {
            code: at(14),
            full_size: at(4),
            offset: at(10),
            delay: word(18),
            status: head[24],
            ident,
            data: &rest[ident_end..size],
        });
        rest = &rest[size..];
    }
    Ok(commands)
}

/// Header of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ReplyHead {
    /// As in the command.
    pub code: i32,
    /// Simulation time at execution `[ms]`; 0 while stopped.
    pub time: i32,
    /// True if it failed.
    pub failed: bool,
    /// Whole size of a reply in pieces and where this one stands; none if it is whole.
    pub piece: Option<(i32, i32)>,
}

/// Appends a reply to `out`: its head, its identifier, its data.
pub(crate) fn write_reply(head: &ReplyHead, ident: &[u8], data: &[u8], out: &mut Vec<u8>) {
    let size = (COMMAND_HEAD + ident.len() + data.len()) as i32;
    let (full, offset) = head.piece.unwrap_or((size, 0));
    out.extend(size.to_le_bytes());
    out.extend(full.to_le_bytes());
    out.extend((ident.len() as u16).to_le_bytes());
    out.extend(offset.to_le_bytes());
    out.extend(head.code.to_le_bytes());
    out.extend(0_u16.to_le_bytes());
    out.extend(head.time.to_le_bytes());
    out.extend([u8::from(head.failed), 0]);
    out.extend(ident);
    out.extend(data);
}

/// The 32-bit whole number at byte `at`, little endian; none if the bytes end before it does.
#[must_use]
pub(crate) fn int(bytes: &[u8], at: usize) -> Option<i32> {
    Some(i32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

/// The 32-bit float at byte `at`, little endian, as a double in the unit of the message's field; none if the bytes end
/// before it does.
#[must_use]
pub(crate) fn float(bytes: &[u8], at: usize) -> Option<f64> {
    Some(f32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?).into())
}

/// `N` floats from byte `at` on, as [`float`] reads each.
#[must_use]
pub(crate) fn floats<const N: usize>(bytes: &[u8], at: usize) -> Option<[f64; N]> {
    let mut out = [0.0; N];
    for (k, x) in out.iter_mut().enumerate() {
        *x = float(bytes, at + 4 * k)?;
    }
    Some(out)
}

/// The text that the bytes begin with, up to a zero or their end, and the bytes that it takes with its zero; none if it
/// is not UTF-8.
#[must_use]
pub(crate) fn text(bytes: &[u8]) -> Option<(&str, usize)> {
    let end = bytes.iter().position(|b| *b == 0);
    let text = std::str::from_utf8(&bytes[..end.unwrap_or(bytes.len())]).ok()?;
    Some((text, end.map_or(bytes.len(), |n| n + 1)))
}
