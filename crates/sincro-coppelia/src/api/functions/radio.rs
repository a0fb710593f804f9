//! Functions: wireless data between scripts, from antenna to antenna.

use super::objects::owner;
use super::{Function, Outcome, one, plain};
use crate::api::radio::{Antenna, Packet, Receivers, Wanted};
use crate::api::{ApiError, Arguments, Handle, Reference, SimApi, Value};

/// `sim.handle_all`, `sim.handle_tree`, `sim.handle_chain`.
const ALL: i32 = -2;
const TREE: i32 = -6;
const CHAIN: i32 = -7;
/// Object that has no antenna: the sender or receiver is anywhere.
const NONE: i32 = -1;
/// `sim.handle_self`.
const SELF: i32 = -4;
/// Range if nothing is said `[m]`.
const RANGE: f64 = 100.0;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "sendData",
        tip: "int result=sim.sendData(int targetID,int dataHeader,string dataName,buffer data,int antennaHandle=sim.handle_self,float actionRadius=100,float emissionAngle1=math.pi,float emissionAngle2=math.pi*2,float persistence=0)",
        run: send,
    },
    Function {
        name: "receiveData",
        tip: "buffer data,int senderID,int dataHeader,string dataName=sim.receiveData(int dataHeader=-1,string dataName=nil,int antennaHandle=sim.handle_self,int index=-1)",
        run: receive,
    },
];

/// Position of the antenna that is argument `k`; none if there is none.
fn antenna(sim: &mut SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Option<[f64; 3]>, ApiError> {
    let raw = if a.has(k) { a.handle(k)? } else { SELF };
    if raw == NONE || (raw == SELF && sim.own.is_none()) {
        return Ok(None);
    }
    let object = plain(sim, raw)?;
    Ok(Some(sim.pose(object, Reference::World)?.pos.0))
}

/// Data for all, for the script of an object, or for those below or above the script that sends.
fn send(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (target, header, name, bytes) = (a.handle(0)?, a.int(1)?, a.text(2)?, a.bytes(3)?);
    let range = if a.has(5) { a.real(5)? } else { RANGE };
    if range.is_nan() || range < 0.0 {
        return Err(ApiError(format!("argument 6, the range, is {range} m, expected 0 or more")));
    }
    for (k, whole) in [(6, std::f64::consts::PI), (7, std::f64::consts::TAU)] {
        if a.has(k) && (a.real(k)?.is_nan() || a.real(k)? < whole - 1e-6) {
            let words = "antennas send in all directions here: leave the angle away";
            return Err(ApiError(format!("argument {} is an angle of emission: {words}", k + 1)));
        }
    }
    let persistence = if a.has(8) { a.real(8)?.max(0.0) } else { 0.0 };
    let receivers = match target {
        ALL | 0 => Receivers::All,
        TREE => Receivers::These(below(sim)?.into_iter().collect()),
        CHAIN => Receivers::These(above(sim)?.into_iter().collect()),
        other => Receivers::These([Handle(owner_of(sim, other)?)].into()),
    };
    let antenna = antenna(sim, a, 4)?.map(|position| Antenna { position, range });
    sim.registry.check_stored_size(name.len() + bytes.len())?;
    // what is not said to persist is there for one step after the next one has begun
    let step = sim.registry.sample_time();
    let (sent, until) = (sim.t, sim.t + persistence.max(1.5 * step));
    let (sender, name, bytes) = (sim.own, name.to_owned(), bytes.to_vec());
    let taken = Default::default();
    sim.registry.radio.send(Packet { sender, receivers, header, name, bytes, antenna, sent, until, taken })?;
    one(1_i64)
}

/// Number of the object of a script, or of the object itself.
fn owner_of(sim: &mut SimApi<'_>, raw: i32) -> Result<i32, ApiError> {
    Ok(owner(sim, Arguments(&[Value::Int(raw.into())]), 0)?.0)
}

fn sender(sim: &SimApi<'_>) -> Result<Handle, ApiError> {
    sim.own.ok_or_else(|| ApiError::new("argument 1 is a target relative to a script, and none calls"))
}

fn below(sim: &SimApi<'_>) -> Result<Vec<Handle>, ApiError> {
    let own = sender(sim)?;
    let chain = |h: Handle| std::iter::successors(Some(h), |h| sim.registry.entry(*h).ok().and_then(|e| e.parent));
    let all = sim.registry.entries().map(|e| e.handle);
    Ok(all.filter(|h| *h != own && chain(*h).take(1_000).any(|above| above == own)).collect())
}

fn above(sim: &SimApi<'_>) -> Result<Vec<Handle>, ApiError> {
    let own = sender(sim)?;
    let parent = |h: &Handle| sim.registry.entry(*h).ok().and_then(|e| e.parent);
    Ok(std::iter::successors(Some(own), parent).skip(1).take(1_000).collect())
}

/// The oldest data on their way that fit; nil if there are none.
fn receive(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let header = Some(a.int_or(0, -1)?).filter(|header| *header != -1);
    let name = if a.has(1) { Some(a.text(1)?) } else { None };
    let position = antenna(sim, a, 2)?;
    let index = usize::try_from(a.int_or(3, -1)?).ok();
    let wanted = Wanted { own: sim.own, header, name, position, index };
    let t = sim.t;
    let Some(packet) = sim.registry.radio.receive(t, &wanted) else { return one(Value::Nil) };
    let sender = packet.sender.map_or(Value::Int(-1), Value::from);
    Ok(vec![Value::Bytes(packet.bytes.clone()), sender, Value::Int(packet.header), Value::from(&*packet.name)])
}
