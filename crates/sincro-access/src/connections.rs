//! Slots for connections: a limit in total and for each address, so that one peer cannot lock out the others.
//!
//! When no slot is free, the connection that is least missed makes room: first those that have not sent a whole message
//! yet, the oldest of them first, then those that have been idle for longer than
//! [`ConnectionLimits::idle_under_pressure`], the longest idle first. If all are in use, the newcomer is refused.

use std::collections::BTreeMap;
use std::net::{IpAddr, Ipv4Addr};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Limits of the connections of one server, given to [`Connections::new`].
#[derive(Clone, Copy, Debug)]
pub struct ConnectionLimits {
    /// Connections at once from all addresses together.
    pub total: usize,
    /// Connections at once from one address (IPv4 address; /64 network of IPv6; the loopback networks count as one).
    pub per_address: usize,
    /// Idle time after which a connection makes room for a newcomer when no slot is free.
    pub idle_under_pressure: Duration,
}

/// Table of the open connections of a server: each takes a slot with [`Connections::admit`], so that one peer cannot
/// lock out the others.
///
/// ```
/// use sincro_access::{ConnectionLimits, Connections};
/// use std::time::Duration;
///
/// let limits = ConnectionLimits { total: 2, per_address: 1, idle_under_pressure: Duration::from_secs(60) };
/// let connections = Connections::new(limits);
/// let first = connections.admit("10.0.0.1".parse()?, || { /* ends this connection */ }).expect("a slot is free");
/// first.mark_message();
/// assert!(connections.admit("10.0.0.1".parse()?, || ()).is_none(), "the address has its one connection");
/// drop(first);
/// assert!(connections.is_empty());
/// # Ok::<(), std::net::AddrParseError>(())
/// ```
pub struct Connections {
    limits: ConnectionLimits,
    start: Instant,
    slots: Mutex<Slots>,
}

#[derive(Default)]
struct Slots {
    next: u64,
    open: BTreeMap<u64, Slot>,
}

struct Slot {
    network: IpAddr,
    activity: Arc<Activity>,
    close: Box<dyn Fn() + Send + Sync>,
    /// True once it was told to close; it counts against [`MAX_CLOSING`] until it has.
    is_closing: bool,
}

/// Connections that were told to close and have not yet, at most: their threads may be waiting for something else.
const MAX_CLOSING: usize = 64;

/// Use of one connection so far.
#[derive(Debug, Default)]
struct Activity {
    /// True once a whole message has come.
    is_proven: AtomicBool,
    /// Time of the last message, or of the beginning [ms since the server started].
    last: AtomicU64,
}

/// Slot that a connection holds in [`Connections`]; keep it as long as the connection, dropping it frees the slot.
pub struct Permit {
    connections: Arc<Connections>,
    id: u64,
    activity: Arc<Activity>,
}

impl Connections {
    /// Creates the empty table of one server, shared by the threads that serve it.
    #[must_use]
    pub fn new(limits: ConnectionLimits) -> Arc<Self> {
        Arc::new(Self { limits, start: Instant::now(), slots: Mutex::default() })
    }

    /// Number of connections that are open and were not told to close.
    #[must_use]
    pub fn len(&self) -> usize {
        self.lock().open.values().filter(|slot| !slot.is_closing).count()
    }

    /// Returns true if no connection is open that was not told to close.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes a slot for a new connection from the IP address `peer`. If none is free, the connection that is least
    /// missed is closed; none if all are in use, and the newcomer is to be refused. `close` must end the new
    /// connection; it may be called at any time from any thread.
    pub fn admit(self: &Arc<Self>, peer: IpAddr, close: impl Fn() + Send + Sync + 'static) -> Option<Permit> {
        let network = network_of(peer);
        let now = self.now();
        let mut slots = self.lock();
        let in_use = slots.open.values().filter(|slot| !slot.is_closing);
        let (n, of_peer) = in_use.fold((0, 0), |(n, m), slot| (n + 1, m + usize::from(slot.network == network)));
        if of_peer >= self.limits.per_address {
            self.check_stored_size(&mut slots, now, Some(network))?;
        } else if n >= self.limits.total {
            self.check_stored_size(&mut slots, now, None)?;
        }
        let (id, activity) = (slots.next, Arc::new(Activity::default()));
        activity.last.store(now, Ordering::Relaxed);
        slots.next += 1;
        slots.open.insert(id, Slot { network, activity: activity.clone(), close: Box::new(close), is_closing: false });
        drop(slots);
        Some(Permit { connections: self.clone(), id, activity })
    }

    /// Closes the connection that is least missed, of one network if one is given; none if all are in use.
    fn check_stored_size(&self, slots: &mut Slots, now: u64, network: Option<IpAddr>) -> Option<()> {
        let limit = u64::try_from(self.limits.idle_under_pressure.as_millis()).unwrap_or(u64::MAX);
        if slots.open.values().filter(|slot| slot.is_closing).count() >= MAX_CLOSING {
            return None;
        }
        let of_network = |slot: &Slot| network.is_none_or(|wanted| wanted == slot.network);
        let candidates = slots.open.iter().filter(|(_, slot)| !slot.is_closing && of_network(slot));
        let ranked = candidates.filter_map(|(id, slot)| {
            let is_proven = slot.activity.is_proven.load(Ordering::Relaxed);
            let last = slot.activity.last.load(Ordering::Relaxed);
            (!is_proven || now.saturating_sub(last) > limit).then_some((is_proven, last, *id))
        });
        let (_, _, id) = ranked.min()?;
        let slot = slots.open.get_mut(&id)?;
        slot.is_closing = true;
        (slot.close)();
        Some(())
    }

    fn now(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_millis()).unwrap_or(u64::MAX)
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Permit {
    /// Records that a whole message has arrived on the connection just now: it counts as in use, no longer as idle or
    /// unused.
    pub fn mark_message(&self) {
        self.activity.is_proven.store(true, Ordering::Relaxed);
        self.activity.last.store(self.connections.now(), Ordering::Relaxed);
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.connections.lock().open.remove(&self.id);
    }
}

/// The network that counts as one peer.
fn network_of(peer: IpAddr) -> IpAddr {
    let peer = peer.to_canonical();
    match peer {
        _ if peer.is_loopback() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V4(_) => peer,
        IpAddr::V6(address) => IpAddr::V6((u128::from(address) >> 64 << 64).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    const LIMITS: ConnectionLimits =
        ConnectionLimits { total: 6, per_address: 3, idle_under_pressure: Duration::from_secs(60) };

    fn ip(text: &str) -> IpAddr {
        text.parse().unwrap()
    }

    #[test]
    fn an_address_has_its_share_and_no_more() {
        let all = Connections::new(LIMITS);
        let used = |address: &str| {
            let permit = all.admit(ip(address), || panic!("it is in use")).expect("a slot is free");
            permit.mark_message();
            permit
        };
        let mut first: Vec<Permit> = (0..3).map(|_| used("10.0.0.1")).collect();
        assert!(all.admit(ip("10.0.0.1"), || {}).is_none(), "its share is in use");
        assert!(all.admit(ip("::ffff:10.0.0.1"), || {}).is_none(), "the same address in another form");
        let _second: Vec<Permit> = (0..3).map(|k| used(&format!("10.0.1.{k}"))).collect();
        assert!(all.admit(ip("10.0.2.1"), || {}).is_none(), "all slots are in use");
        first.pop();
        assert_eq!(all.len(), 5);
        assert!(all.admit(ip("10.0.2.1"), || {}).is_some());
    }

    #[test]
    fn networks_count_as_one() {
        let all = Connections::new(ConnectionLimits { per_address: 1, ..LIMITS });
        let used = |address: &str| all.admit(ip(address), || {}).inspect(Permit::mark_message);
        let _a = used("127.0.0.1").unwrap();
        assert!(used("127.0.0.2").is_none() && used("::1").is_none());
        let _b = used("2001:db8::1").unwrap();
        assert!(used("2001:db8::2").is_none() && used("2001:db8:0:1::1").is_some());
    }

    #[test]
    fn a_connection_that_has_said_nothing_makes_room() {
        let all = Connections::new(LIMITS);
        let closed = Arc::new(AtomicUsize::new(0));
        let admit = |n: usize| {
            let closed = closed.clone();
            all.admit(ip("127.0.0.1"), move || closed.store(n, Ordering::Relaxed))
        };
        let (a, _b, c) = (admit(1).unwrap(), admit(2).unwrap(), admit(3).unwrap());
        a.mark_message();
        let _d = admit(4).expect("the second makes room");
        assert_eq!((closed.load(Ordering::Relaxed), all.len()), (2, 3));
        c.mark_message();
        let e = admit(5).expect("the fourth makes room");
        assert_eq!(closed.load(Ordering::Relaxed), 4);
        e.mark_message();
        assert!(admit(6).is_none(), "all are in use and none is idle");
    }

    #[test]
    fn connections_that_do_not_close_bound_those_that_may_come() {
        let all = Connections::new(LIMITS);
        // their threads wait for something else and never drop what they hold
        let held: Vec<Permit> = (0..500).filter_map(|_| all.admit(ip("127.0.0.1"), || {})).collect();
        assert_eq!((held.len(), all.len()), (3 + MAX_CLOSING, 3));
        drop(held);
        assert!(all.admit(ip("127.0.0.1"), || {}).is_some());
    }

    #[test]
    fn an_idle_connection_makes_room() {
        let all = Connections::new(ConnectionLimits { idle_under_pressure: Duration::ZERO, ..LIMITS });
        let used = || all.admit(ip("127.0.0.1"), || {}).inspect(Permit::mark_message);
        let _open: Vec<Permit> = (0..3).filter_map(|_| used()).collect();
        std::thread::sleep(Duration::from_millis(3));
        assert!(used().is_some());
    }
}
