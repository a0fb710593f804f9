//! A client of the legacy remote API at protocol level: what the C library sends and keeps, without its thread.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

/// Mode of a command: once.
pub const ONCE: i32 = 0x1_0000;
/// Mode of a command: repeated with every step.
pub const STREAM: i32 = 0x2_0000;
/// Mode of a command: repeated, in pieces.
pub const SPLIT: i32 = 0x3_0000;
/// Mode of a command: its repetition ends.
pub const DISCONTINUE: i32 = 0x5_0000;

/// A reply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reply {
    /// True if the command failed.
    pub failed: bool,
    /// Simulation time `[ms]`.
    pub time: i32,
    /// Data.
    pub data: Vec<u8>,
    /// Size of the whole reply, of which this may be a piece `[bytes]`.
    pub full_size: i32,
    /// Offset of this piece `[bytes]`.
    pub offset: i32,
}

/// A command to be sent.
#[derive(Clone, Debug)]
pub struct Command {
    /// Function and mode.
    pub code: i32,
    /// Identification: handles, or a name with its zero.
    pub ident: Vec<u8>,
    /// Data.
    pub data: Vec<u8>,
    /// Period of a repeated command `[ms]`.
    pub delay: u16,
    /// Full size and offset of a command in pieces.
    pub piece: Option<(i32, i32)>,
}

impl Command {
    /// A command with its identification and data.
    pub fn new(function: i32, mode: i32, ident: &[u8], data: &[u8]) -> Self {
        Self { code: function | mode, ident: ident.to_vec(), data: data.to_vec(), delay: 0, piece: None }
    }

    /// Bytes of the command in a message.
    pub fn bytes(&self) -> Vec<u8> {
        let size = (26 + self.ident.len() + self.data.len()) as i32;
        let (full, offset) = self.piece.unwrap_or((size, 0));
        let mut out = Vec::new();
        out.extend(size.to_le_bytes());
        out.extend(full.to_le_bytes());
        out.extend((self.ident.len() as u16).to_le_bytes());
        out.extend(offset.to_le_bytes());
        out.extend(self.code.to_le_bytes());
        out.extend(self.delay.to_le_bytes());
        out.extend([0; 6]);
        out.extend(&self.ident);
        out.extend(&self.data);
        out
    }
}

/// A connection.
pub struct Client {
    stream: TcpStream,
    id: i32,
    /// State byte of the last reply that had commands.
    pub state: u8,
    /// Message number of the last reply that had commands.
    pub reply_id: i32,
    /// Version byte of the last reply.
    pub version: u8,
    /// Replies by function and identification, as the library keeps them.
    pub inbox: BTreeMap<(u16, Vec<u8>), Reply>,
    /// Packets of the last reply.
    pub packets: usize,
}

/// Numbers as the wire has them.
pub fn ints(list: &[i32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Numbers as the wire has them.
pub fn floats(list: &[f32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A text with its zero.
pub fn text(text: &str) -> Vec<u8> {
    [text.as_bytes(), &[0]].concat()
}

impl Reply {
    /// Integer at a byte.
    pub fn int(&self, at: usize) -> i32 {
        i32::from_le_bytes(self.data[at..at + 4].try_into().unwrap())
    }

    /// Float number `k`.
    pub fn float(&self, k: usize) -> f32 {
        f32::from_le_bytes(self.data[4 * k..4 * k + 4].try_into().unwrap())
    }
}

impl Client {
    /// Connects.
    pub fn connect(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_nodelay(true).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        Self { stream, id: 0, state: 0, reply_id: -1, version: 0, inbox: BTreeMap::new(), packets: 0 }
    }

    /// The socket below, for bytes that are no messages.
    pub fn stream(&mut self) -> &mut TcpStream {
        &mut self.stream
    }

    /// Sends one message and takes its reply.
    pub fn exchange(&mut self, commands: &[Command]) -> Vec<(u16, Reply)> {
        let mut message = vec![0, 0, 11];
        message.extend(self.id.to_le_bytes());
        message.extend([0; 8]);
        message.extend([0; 3]);
        commands.iter().for_each(|c| message.extend(c.bytes()));
        self.send_packets(&message, 1294);
        let reply = self.receive();
        assert_eq!(i32::from_le_bytes(reply[3..7].try_into().unwrap()), self.id, "the id of the message is echoed");
        self.id += 1;
        self.read(&reply)
    }

    /// Sends a message in packets of at most `payload` bytes.
    pub fn send_packets(&mut self, message: &[u8], payload: usize) {
        let n = message.len().div_ceil(payload).max(1);
        for (k, part) in message.chunks(payload).enumerate() {
            let head = [1, part.len() as i16, (n - 1 - k) as i16];
            let head: Vec<u8> = head.into_iter().flat_map(i16::to_le_bytes).collect();
            self.stream.write_all(&[&head, part].concat()).unwrap();
        }
    }

    /// One message; its packets must be as the library wants them.
    pub fn receive(&mut self) -> Vec<u8> {
        let (mut message, mut first, mut expected) = (Vec::new(), 0, None);
        self.packets = 0;
        loop {
            let mut head = [0; 6];
            self.stream.read_exact(&mut head).unwrap();
            let word = |k: usize| i16::from_le_bytes([head[k], head[k + 1]]);
            assert_eq!(word(0), 1);
            let (n, left) = (word(2) as usize, word(4));
            assert!(expected.is_none_or(|e| e == left), "packets count down");
            expected = Some(left - 1);
            self.packets += 1;
            first = first.max(n);
            assert!(left == 0 || n == first, "all packets but the last are of one length");
            let start = message.len();
            message.resize(start + n, 0);
            self.stream.read_exact(&mut message[start..]).unwrap();
            if left == 0 {
                return message;
            }
        }
    }

    fn read(&mut self, message: &[u8]) -> Vec<(u16, Reply)> {
        self.version = message[2];
        let (mut rest, mut all) = (&message[18..], Vec::new());
        if !rest.is_empty() {
            self.state = message[17];
            self.reply_id = i32::from_le_bytes(message[3..7].try_into().unwrap());
        }
        while !rest.is_empty() {
            let int = |k: usize| i32::from_le_bytes(rest[k..k + 4].try_into().unwrap());
            let (size, n_ident) = (int(0) as usize, u16::from_le_bytes([rest[8], rest[9]]) as usize);
            let reply = Reply {
                failed: rest[24] & 1 != 0,
                time: int(20),
                data: rest[26 + n_ident..size].to_vec(),
                full_size: int(4),
                offset: int(10),
            };
            let function = int(14) as u16;
            self.inbox.insert((function, rest[26..26 + n_ident].to_vec()), reply.clone());
            all.push((function, reply));
            rest = &rest[size..];
        }
        all
    }

    /// A blocking call.
    ///
    /// # Errors
    ///
    /// The reply, if the command failed.
    pub fn call(&mut self, function: i32, ident: &[u8], data: &[u8]) -> Result<Reply, Reply> {
        self.exchange(&[Command::new(function, ONCE, ident, data)]);
        let reply = self.inbox.remove(&(function as u16, ident.to_vec())).unwrap();
        if reply.failed { Err(reply) } else { Ok(reply) }
    }

    /// Handle of an object by its name.
    pub fn handle(&mut self, name: &str) -> i32 {
        self.call(0x3001, &text(name), &[]).unwrap().int(0)
    }

    /// Position of a joint.
    pub fn joint_position(&mut self, joint: i32) -> f32 {
        self.call(0x1001, &ints(&[joint]), &[]).unwrap().float(0)
    }

    /// Sets the target velocity of a joint.
    pub fn set_velocity(&mut self, joint: i32, velocity: f32) {
        self.call(0x1008, &ints(&[joint]), &floats(&[velocity])).unwrap();
    }

    /// Triggers a step in synchronous mode.
    ///
    /// # Errors
    ///
    /// The reply, if the command failed.
    pub fn trigger(&mut self) -> Result<Reply, Reply> {
        self.call(0x0003, &[], &[])
    }

    /// Synchronous mode, then start.
    pub fn start(&mut self) {
        self.call(0x0001, &[], &[]).unwrap();
        self.simulation(0);
    }

    /// Starts (0), pauses (1) or stops (2) the simulation.
    pub fn simulation(&mut self, what: i32) {
        self.call(0x1007, &ints(&[what]), &[]).unwrap();
    }

    /// Program version: what `simxGetPingTime` asks for.
    pub fn ping(&mut self) -> i32 {
        self.call(0x1021, &ints(&[1]), &[]).unwrap().int(0)
    }

    /// Messages of errors since the last call.
    pub fn last_errors(&mut self) -> Vec<String> {
        let reply = self.call(0x0004, &[], &[]).unwrap();
        let texts = String::from_utf8(reply.data[4..].to_vec()).unwrap();
        let list: Vec<String> = texts.split_terminator('\0').map(str::to_owned).collect();
        assert_eq!(list.len() as i32, reply.int(0));
        list
    }
}
