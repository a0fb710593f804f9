//! Hub of all clients: a session behind a lock, and the rule of when it steps.
//!
//! A client that steps (`sim.setStepping`, `simxSynchronous`) holds the simulation until it asks for the next step. The
//! step is made, by whichever thread completes the condition, as soon as every such client has asked and nobody holds a
//! lock. Without any such client the simulation runs by itself, between the calls of the others.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use sincro_access::{ConnectionLimits, Connections};
use sincro_coppelia::api::{ApiError, LegacyPorts, Phase, PortRequest};
use sincro_coppelia::session::{Finished, Session};

use crate::limits::{self, Deadlines};

/// Longest wait before the state of the server is looked at again.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// Ratio of the time that steps take to the time that they simulate, and time that they have taken, from which on the
/// operator is told that the simulation is slow.
const SLOW: f64 = 4.0;
const SLOW_AFTER: Duration = Duration::from_secs(5);

/// Runs that wait to be taken.
const MAX_RUNS: usize = 64;

/// A client, as the hub knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ClientId(u64);

/// Event for the owner of a [`Server`](crate::Server), taken from [`Server::events`](crate::Server::events).
#[derive(Debug)]
pub enum Event {
    /// A run of the session has ended, with its results.
    Finished(Box<Finished>),
    /// Message for the operator: verbosity level as in V-REP (200 error, 300 warning, 450 script, 500 info), text.
    Log(i64, String),
}

/// Options of the hub.
#[derive(Clone, Debug)]
pub(crate) struct HubOptions {
    /// True if the simulation runs no faster than the clock when nobody steps it.
    pub real_time: bool,
    /// Time after which a silent client that holds the simulation is released.
    pub client_timeout: Duration,
    /// Deadlines of connections.
    pub deadlines: Deadlines,
}

/// Session of a server with its attached clients, for as long as the lock of the [`Hub`] is held: [`Hub::enter`] gives
/// it.
pub struct SessionGuard {
    /// Session that all clients act on.
    pub session: Session,
    clients: BTreeMap<ClientId, Client>,
    /// Steps since the run began.
    step: u64,
    next_client: u64,
    /// Error that ended the last run.
    failure: Option<ApiError>,
    events: SyncSender<Event>,
    /// Runs that nobody has taken yet.
    backlog: VecDeque<Finished>,
    publish: Option<Box<dyn FnMut(u64) + Send>>,
    open_port: Option<OpenPort>,
    /// Time that the steps of the run have taken.
    busy: Duration,
    /// True if the operator was told in this run that it is slow.
    is_told_of_pace: bool,
    /// Ports of the legacy API that a script started without a trigger: their clients do not step.
    untriggered: BTreeSet<u16>,
    /// Progress that waiting threads were last woken for.
    told: Progress,
}

/// Progress that threads wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Progress {
    step: u64,
    phase: Phase,
    runs_free: bool,
}

/// Opens a port that a script asked for; gives the line for the terminal.
pub(crate) type OpenPort = Box<dyn FnMut(u16) -> Result<String, String> + Send>;

struct Client {
    key: String,
    /// Port of the legacy API that it came by; none for the other APIs.
    legacy_port: Option<u16>,
    /// Nesting level of stepping: it steps while above 0.
    level: u32,
    desired: u64,
    locks: u32,
    last_seen: Instant,
    connections: u32,
}

/// Session of a server behind its lock, shared by all clients, with the rule of when it steps; see
/// [`Server::hub`](crate::Server::hub).
pub struct Hub {
    guard: Mutex<SessionGuard>,
    /// Wakes the clients that wait for a step.
    moved: Condvar,
    /// Wakes the thread of the free run.
    freed: Condvar,
    /// Threads that wait for the lock: the free run yields to them between steps.
    waiting: AtomicUsize,
    closing: AtomicBool,
    connections: Arc<Connections>,
    options: HubOptions,
}

impl Hub {
    /// Creates a hub over a session; events go to `events`.
    #[must_use]
    pub(crate) fn new(session: Session, options: HubOptions, events: SyncSender<Event>) -> Arc<Self> {
        let guard = SessionGuard {
            session,
            clients: BTreeMap::new(),
            step: 0,
            next_client: 0,
            failure: None,
            events,
            backlog: VecDeque::new(),
            publish: None,
            open_port: None,
            busy: Duration::ZERO,
            is_told_of_pace: false,
            untriggered: BTreeSet::new(),
            told: Progress { step: 0, phase: Phase::Stopped, runs_free: false },
        };
        Arc::new(Self {
            guard: Mutex::new(guard),
            moved: Condvar::new(),
            freed: Condvar::new(),
            waiting: AtomicUsize::new(0),
            closing: AtomicBool::new(false),
            connections: Connections::new(ConnectionLimits {
                total: limits::CONNECTIONS,
                per_address: limits::PER_ADDRESS,
                idle_under_pressure: limits::IDLE_UNDER_PRESSURE,
            }),
            options,
        })
    }

    /// Locks the session for the caller; waits while another thread holds it, which is one step of clients at most. No
    /// step is made until the result is dropped.
    pub fn enter(&self) -> MutexGuard<'_, SessionGuard> {
        self.waiting.fetch_add(1, Ordering::SeqCst);
        // a panic of another thread is a bug of ours that has been printed; the session is still the best there is
        let guard = self.guard.lock().unwrap_or_else(PoisonError::into_inner);
        self.waiting.fetch_sub(1, Ordering::SeqCst);
        guard
    }

    /// Locks the session as [`Hub::enter`] does, if it becomes free within `timeout`; else none. For callers that must
    /// not wait for a script that does not return.
    pub fn try_enter(&self, timeout: Duration) -> Option<MutexGuard<'_, SessionGuard>> {
        let begin = Instant::now();
        self.waiting.fetch_add(1, Ordering::SeqCst);
        let guard = loop {
            match self.guard.try_lock() {
                Ok(guard) => break Some(guard),
                Err(TryLockError::Poisoned(guard)) => break Some(guard.into_inner()),
                Err(TryLockError::WouldBlock) if begin.elapsed() >= timeout => break None,
                Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(1)),
            }
        };
        self.waiting.fetch_sub(1, Ordering::SeqCst);
        guard
    }

    /// Wakes the threads that wait for what has come since the last call; to be called after anything that may allow
    /// the simulation to advance. Most requests of clients change nothing of that, and a thread that wakes for nothing
    /// delays their answers.
    pub(crate) fn wake(&self) {
        match self.guard.try_lock() {
            Ok(mut guard) => self.wake_for_news(&mut guard),
            // whoever holds it may have looked already
            Err(_) => self.wake_all(),
        }
    }

    fn wake_for_news(&self, guard: &mut SessionGuard) {
        let now = Progress { step: guard.step, phase: guard.session.phase(), runs_free: guard.runs_free() };
        let before = std::mem::replace(&mut guard.told, now);
        if now != before {
            self.moved.notify_all();
        }
        if (now.phase, now.runs_free) != (before.phase, before.runs_free) {
            self.freed.notify_all();
        }
    }

    fn wake_all(&self) {
        self.moved.notify_all();
        self.freed.notify_all();
    }

    /// Returns true if the server is being closed.
    #[must_use]
    pub(crate) fn is_closing(&self) -> bool {
        self.closing.load(Ordering::SeqCst)
    }

    /// Ends the free run and every wait.
    pub(crate) fn close(&self) {
        self.closing.store(true, Ordering::SeqCst);
        self.wake_all();
    }

    /// Open connections of all ports of the server together.
    #[must_use]
    pub fn connections(&self) -> &Arc<Connections> {
        &self.connections
    }

    /// Deadlines of connections.
    #[must_use]
    pub(crate) fn deadlines(&self) -> &Deadlines {
        &self.options.deadlines
    }

    /// Detaches a connection of a client; with the last one everything that it holds is released.
    pub(crate) fn detach(&self, id: ClientId) {
        let mut guard = self.enter();
        let Some(client) = guard.clients.get_mut(&id) else { return };
        client.connections -= 1;
        if client.connections == 0 {
            guard.clients.remove(&id);
            guard.try_advance();
        }
        drop(guard);
        self.wake();
    }

    /// One step for a client: waits until all that step together have asked. Returns at once if no run is on, or it is
    /// paused.
    ///
    /// # Errors
    ///
    /// The run has ended by itself: why.
    pub(crate) fn step(&self, id: ClientId) -> Result<(), ApiError> {
        let mut guard = self.enter();
        let Some(target) = guard.ask_step(id) else { return Ok(()) };
        let advanced = guard.advance_if_ready();
        self.wake_for_news(&mut guard);
        advanced?;
        while guard.step < target && guard.session.phase() == Phase::Running && !self.is_closing() {
            guard = self.moved.wait_timeout(guard, POLL_INTERVAL).unwrap_or_else(PoisonError::into_inner).0;
            // it waits for others: that is not silence
            if let Some(client) = guard.clients.get_mut(&id) {
                client.last_seen = Instant::now();
            }
        }
        if guard.step < target && guard.session.phase() == Phase::Stopped {
            return guard.failure.clone().map_or(Ok(()), Err);
        }
        Ok(())
    }

    /// The free run, and the watch over silent clients: a thread of its own, until the hub is closed.
    pub(crate) fn run(&self) {
        let (mut due, mut watched) = (Instant::now(), Instant::now());
        while !self.is_closing() {
            // waiting threads come first
            while self.waiting.load(Ordering::SeqCst) > 0 {
                std::thread::yield_now();
            }
            let mut guard = self.guard.lock().unwrap_or_else(PoisonError::into_inner);
            if watched.elapsed() >= POLL_INTERVAL {
                watched = Instant::now();
                self.release_silent_clients(&mut guard);
            }
            if !guard.runs_free() {
                if guard.session.phase() != Phase::Running {
                    // the session's log has the reason if the run stops
                    let _ = guard.act(Session::idle);
                }
                drop(self.freed.wait_timeout(guard, POLL_INTERVAL).unwrap_or_else(PoisonError::into_inner));
                due = Instant::now();
                continue;
            }
            let now = Instant::now();
            if self.options.real_time && due > now {
                let wait = (due - now).min(POLL_INTERVAL);
                drop(self.freed.wait_timeout(guard, wait).unwrap_or_else(PoisonError::into_inner));
                continue;
            }
            due = due.max(now - POLL_INTERVAL) + Duration::from_secs_f64(guard.session.registry().sample_time());
            // the session's log has the reason if the run stops
            let _ = guard.advance();
            drop(guard);
            self.wake();
        }
    }

    /// Releases the simulation from clients that hold it and have been silent for too long.
    fn release_silent_clients(&self, guard: &mut SessionGuard) {
        guard.forward_events();
        if guard.session.phase() != Phase::Running {
            return;
        }
        let (step, timeout) = (guard.step, self.options.client_timeout);
        let holds = |c: &Client| c.locks > 0 || (c.level > 0 && c.desired <= step);
        let silent = |c: &&mut Client| holds(c) && c.last_seen.elapsed() > timeout;
        let mut released = Vec::new();
        for client in guard.clients.values_mut().filter(silent) {
            (client.level, client.locks) = (0, 0);
            released.push(client.key.clone());
        }
        if released.is_empty() {
            return;
        }
        for key in released {
            let seconds = timeout.as_secs_f64();
            guard.log(300, format!("client {key} has held the simulation without a word for {seconds} s: let go"));
        }
        guard.try_advance();
        self.wake_for_news(guard);
    }
}

/// Returns true if steps that simulate `t` seconds together have taken far longer than that.
fn is_slow(busy: Duration, t: f64) -> bool {
    busy >= SLOW_AFTER && busy.as_secs_f64() > SLOW * t
}

/// Reason why clients of a port do not step.
pub(crate) fn no_trigger(port: u16) -> String {
    format!(
        "synchronous mode has no effect on port {port}, which a script started without a trigger, as in V-REP: simRemoteApi.start({port}, 1300, false, true) has one, and port 19997"
    )
}

impl SessionGuard {
    /// A connection of the client of a key; connections of the same key are one client.
    pub(crate) fn attach(&mut self, key: &str) -> ClientId {
        if let Some((id, client)) = self.clients.iter_mut().find(|(_, c)| c.key == key) {
            client.connections += 1;
            return *id;
        }
        let id = ClientId(self.next_client);
        self.next_client += 1;
        let (desired, last_seen) = (self.step, Instant::now());
        let (key, legacy_port) = (key.to_owned(), None);
        let client = Client { key, legacy_port, level: 0, desired, locks: 0, last_seen, connections: 1 };
        self.clients.insert(id, client);
        id
    }

    /// A connection of a client of the legacy API, by one of its ports.
    pub(crate) fn attach_legacy(&mut self, key: &str, port: Option<u16>) -> ClientId {
        let id = self.attach(key);
        if let Some(client) = self.clients.get_mut(&id) {
            client.legacy_port = port;
        }
        id
    }

    /// Port of a client that may not step, because a script started it without a trigger; else none.
    pub(crate) fn untriggered_port(&self, id: ClientId) -> Option<u16> {
        let port = self.clients.get(&id)?.legacy_port?;
        self.untriggered.contains(&port).then_some(port)
    }

    /// Notes a sign of life of a client.
    pub(crate) fn seen(&mut self, id: ClientId) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.last_seen = Instant::now();
        }
    }

    /// Number of clients that are attached; several connections of one client count once.
    #[must_use]
    pub fn n_clients(&self) -> usize {
        self.clients.len()
    }

    /// Number of clients that step the simulation (`sim.setStepping`, `simxSynchronous`) and for which it waits.
    #[must_use]
    pub fn n_stepping(&self) -> usize {
        self.clients.values().filter(|c| c.level > 0).count()
    }

    /// Returns true if a client steps the simulation.
    #[must_use]
    pub(crate) fn is_stepping(&self, id: ClientId) -> bool {
        self.clients.get(&id).is_some_and(|c| c.level > 0)
    }

    /// A client begins to step, or gives it up once; gives the level before. The levels add up as in the official
    /// server.
    pub(crate) fn set_stepping(&mut self, id: ClientId, on: bool) -> u32 {
        let step = self.step;
        let Some(client) = self.clients.get_mut(&id) else { return 0 };
        let before = client.level;
        if on {
            if before == 0 {
                client.desired = step;
            }
            client.level = client.level.saturating_add(1);
        } else {
            client.level = client.level.saturating_sub(1);
        }
        self.try_advance();
        before
    }

    /// A client gives up stepping altogether.
    pub(crate) fn stop_stepping(&mut self, id: ClientId) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.level = 0;
        }
        self.try_advance();
    }

    /// While a client holds a lock no step is made.
    pub(crate) fn lock(&mut self, id: ClientId, on: bool) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.locks = if on { client.locks.saturating_add(1) } else { client.locks.saturating_sub(1) };
        }
        self.try_advance();
    }

    /// Number of steps of clients since the run began; after a run has ended, that of this run.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.step
    }

    /// Asks for the next step; the count at which it is done, none if nothing runs.
    pub(crate) fn ask_step(&mut self, id: ClientId) -> Option<u64> {
        if self.session.phase() != Phase::Running {
            return None;
        }
        let step = self.step;
        let client = self.clients.get_mut(&id)?;
        client.desired = step + 1;
        client.last_seen = Instant::now();
        Some(step + 1)
    }

    /// Returns true if all that step have asked, and nobody holds a lock.
    fn is_ready(&self) -> bool {
        self.clients.values().all(|c| c.locks == 0 && (c.level == 0 || c.desired > self.step))
    }

    /// Returns true if the simulation runs by itself.
    fn runs_free(&mut self) -> bool {
        self.session.phase() == Phase::Running && self.clients.values().all(|c| c.level == 0 && c.locks == 0)
    }

    /// Makes the step if somebody steps and all of those are ready.
    ///
    /// # Errors
    ///
    /// The run has ended by itself.
    pub(crate) fn advance_if_ready(&mut self) -> Result<(), ApiError> {
        let is_stepped = self.clients.values().any(|c| c.level > 0);
        if is_stepped && self.is_ready() && self.session.phase() == Phase::Running { self.advance() } else { Ok(()) }
    }

    /// Makes the step if it is due; an error is kept for the clients that wait.
    fn try_advance(&mut self) {
        let _ = self.advance_if_ready();
    }

    fn advance(&mut self) -> Result<(), ApiError> {
        let begin = Instant::now();
        let advanced = self.session.step();
        self.step += 1;
        self.watch_pace(begin.elapsed());
        if let Err(error) = &advanced {
            self.failure = Some(error.clone());
            self.run_ended();
        }
        self.announce();
        self.forward_events();
        advanced
    }

    /// Tells the operator once in a run that its steps take much longer than what they simulate.
    fn watch_pace(&mut self, taken: Duration) {
        self.busy += taken;
        let (t, busy) = (self.session.t(), self.busy.as_secs_f64());
        if !self.is_told_of_pace && is_slow(self.busy, t) {
            self.is_told_of_pace = true;
            let help = "`integrator = \"semi-implicit-euler\"` in experiment.toml is faster where bodies touch, and so is a `stiffness` of their contacts";
            let line = format!("the simulation falls behind the clock: {t:.2} s of it took {busy:.0} s; {help}");
            self.session.registry().log(300, line);
        }
    }

    /// Tells the subscribers of version 1 where the run is.
    fn announce(&mut self) {
        let step = self.step;
        if let Some(publish) = &mut self.publish {
            publish(step);
        }
    }

    /// Sets the function that is called with the number of the step, at the start of a run, after every step and at the
    /// end.
    pub(crate) fn on_step(&mut self, publish: Box<dyn FnMut(u64) + Send>) {
        self.publish = Some(publish);
    }

    /// Sets the function that opens ports of the legacy API for scripts, beside those that are open.
    pub(crate) fn on_port(&mut self, ports: LegacyPorts, open: OpenPort) {
        self.session.set_served(ports);
        self.open_port = Some(open);
    }

    /// Opens the ports that scripts have asked for since the last call, and notes which have a trigger.
    fn open_ports(&mut self) {
        for PortRequest { port, is_new, has_trigger } in self.session.registry().take_port_requests() {
            self.set_trigger(port, has_trigger);
            if !is_new {
                continue;
            }
            let Some(open) = &mut self.open_port else { continue };
            let opened = open(port);
            self.session.note_port(port, opened.is_ok());
            let (level, line) = match opened {
                Ok(line) => (450, line),
                Err(line) => (300, line),
            };
            self.session.registry().log(level, line);
        }
    }

    /// Lets the clients of a port of the legacy API step, or not; those that do are let go then.
    fn set_trigger(&mut self, port: u16, has_trigger: bool) {
        if has_trigger {
            self.untriggered.remove(&port);
            return;
        }
        self.untriggered.insert(port);
        for client in self.clients.values_mut().filter(|c| c.legacy_port == Some(port) && c.level > 0) {
            client.level = 0;
            self.session.registry().log(300, no_trigger(port));
        }
    }

    /// Does something with the session, such as starting or stopping a run, and then releases the clients that waited
    /// if the run began or ended. Use it in place of [`SessionGuard::session`] for whatever may change the phase.
    ///
    /// # Errors
    ///
    /// Those of `act`, unchanged.
    pub fn act<T>(&mut self, act: impl FnOnce(&mut Session) -> Result<T, ApiError>) -> Result<T, ApiError> {
        let before = self.session.phase();
        let result = act(&mut self.session);
        self.update_clients(before);
        result
    }

    /// Tells all clients of a change of phase, after something was done with the session while it was in phase
    /// `before`.
    pub(crate) fn update_clients(&mut self, before: Phase) {
        match (before, self.session.phase()) {
            (Phase::Stopped, Phase::Running) => {
                (self.step, self.failure) = (0, None);
                (self.busy, self.is_told_of_pace) = (Duration::ZERO, false);
                self.clients.values_mut().for_each(|c| c.desired = 0);
                self.announce();
            }
            (Phase::Running | Phase::Paused, Phase::Stopped) => {
                self.run_ended();
                self.announce();
            }
            _ => {}
        }
        self.forward_events();
    }

    /// With a run, stepping and locks end: clients ask for them again before the next one, as with the official server.
    fn run_ended(&mut self) {
        for client in self.clients.values_mut() {
            (client.level, client.locks) = (0, 0);
        }
    }

    fn log(&mut self, level: i64, text: String) {
        // nobody may listen, or not fast enough: lines are dropped then
        let _ = self.events.try_send(Event::Log(level, text));
    }

    /// Forwards the log and the finished runs of the session as events. Runs wait until they are taken, up to
    /// [`MAX_RUNS`]; then the oldest are dropped.
    fn forward_events(&mut self) {
        self.open_ports();
        for line in self.session.registry().take_log() {
            self.log(line.level, line.text);
        }
        self.backlog.extend(self.session.take_finished());
        while let Some(finished) = self.backlog.pop_front() {
            if let Err(TrySendError::Full(Event::Finished(finished))) =
                self.events.try_send(Event::Finished(Box::new(finished)))
            {
                self.backlog.push_front(*finished);
                break;
            }
        }
        while self.backlog.len() > MAX_RUNS {
            self.backlog.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_simulation_is_slow_once_it_has_taken_long_and_far_longer_than_it_simulates() {
        assert!(is_slow(Duration::from_secs(6), 1.0));
        assert!(!is_slow(Duration::from_secs(4), 0.1), "it has just begun");
        assert!(!is_slow(Duration::from_secs(60), 30.0), "it is half as fast as the clock");
    }
}
