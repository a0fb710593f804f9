//! Wireless data that scripts and clients send each other (`sim.sendData`, `sim.receiveData`). What is sent can be
//! received at once, by every receiver once, in the order in which it was sent.

use std::collections::{BTreeSet, VecDeque};

use crate::{ApiError, Handle};

/// Packets that wait at most; the oldest are dropped.
const MAX_PACKETS: usize = 1_000;

/// Place and range of an antenna: who is within receives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Antenna {
    /// Position in the world `[m]`.
    pub position: [f64; 3],
    /// Range `[m]`.
    pub range: f64,
}

/// Receivers of a packet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Receivers {
    /// Everybody.
    All,
    /// One, or those below the sender.
    These(BTreeSet<Handle>),
}

/// Data on their way.
#[derive(Clone, Debug)]
pub struct Packet {
    /// Object of the script that sent it; none: a client.
    pub sender: Option<Handle>,
    /// Who may receive it.
    pub receivers: Receivers,
    /// Number and name that it is known by.
    pub header: i64,
    /// Name that it is known by.
    pub name: String,
    /// The data.
    pub bytes: Vec<u8>,
    /// Antenna of the sender; none: it is received anywhere.
    pub antenna: Option<Antenna>,
    /// Time at which it was sent `[s]`.
    pub sent: f64,
    /// Time after which it is gone `[s]`.
    pub until: f64,
    /// Who has received it already; none: a client.
    pub taken: BTreeSet<Option<Handle>>,
}

/// Request of a receiver.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// Object of the script that asks; none: a client.
    pub own: Option<Handle>,
    /// Number; none: any.
    pub header: Option<i64>,
    /// Name; none: any.
    pub name: Option<&'a str>,
    /// Position of the receiver's antenna `[m]`; none: anywhere.
    pub position: Option<[f64; 3]>,
    /// Place among all that fit; none: the first, which is then received no more.
    pub index: Option<usize>,
}

/// All data on their way.
#[derive(Clone, Debug, Default)]
pub struct Radio {
    packets: VecDeque<Packet>,
}

impl Radio {
    /// Sends a packet.
    pub fn send(&mut self, packet: Packet) -> Result<(), ApiError> {
        crate::stored::check_name("wireless packet", &packet.name)?;
        self.packets.retain(|other| other.until >= packet.sent);
        if self.packets.len() == MAX_PACKETS {
            self.packets.pop_front();
        }
        self.packets.push_back(packet);
        Ok(())
    }

    /// A packet that is on its way at `t` `[s]` and that the receiver wants.
    pub fn receive(&mut self, t: f64, wanted: &Wanted<'_>) -> Option<&Packet> {
        let fits = |packet: &&mut Packet| {
            let is_meant = match &packet.receivers {
                Receivers::All => wanted.own.is_none() || packet.sender != wanted.own,
                Receivers::These(list) => wanted.own.is_some_and(|own| list.contains(&own)),
            };
            let distance = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
            let is_near = match (packet.antenna, wanted.position) {
                (Some(antenna), Some(at)) => distance(antenna.position, at) <= antenna.range * antenna.range,
                _ => true,
            };
            let is_called = wanted.header.is_none_or(|header| header == packet.header)
                && wanted.name.is_none_or(|name| name == packet.name);
            let is_there = packet.sent <= t && t <= packet.until;
            is_meant && is_near && is_called && is_there && !packet.taken.contains(&wanted.own)
        };
        let found = self.packets.iter_mut().filter(fits).nth(wanted.index.unwrap_or(0))?;
        if wanted.index.is_none() {
            found.taken.insert(wanted.own);
        }
        Some(found)
    }

    /// Bytes of all that is on its way.
    pub fn total(&self) -> usize {
        self.packets.iter().map(|packet| packet.bytes.len() + packet.name.len()).sum()
    }
}
