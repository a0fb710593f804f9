//! Where all clients meet: a session behind a lock, and the rule of when it steps.
//!
//! A client that steps (`sim.setStepping`, `simxSynchronous`) holds the simulation until it asks for the next step. The step is made, by whichever
//! thread completes the condition, as soon as every such client has asked and nobody holds a lock. Without any such client the simulation
//! runs by itself, between the calls of the others.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use sincro_access::{ConnectionLimits, Connections};
use sincro_coppelia::session::{Finished, Phase, Refusal, Session};

use crate::limits::{self, Deadlines};

/// Longest wait before the state of the server is looked at again.
const GLANCE: Duration = Duration::from_millis(100);

/// Runs that wait to be taken.
const MOST_RUNS: usize = 64;

/// A client, as the hub knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClientId(u64);

/// What is told to whoever runs the server.
#[derive(Debug)]
pub enum Event {
    /// A run has ended.
    Finished(Box<Finished>),
    /// A line for the terminal: level as in V-REP, and text.
    Log(i64, String),
}

/// How the hub is to behave.
#[derive(Clone, Debug)]
pub struct Manner {
    /// Whether the simulation runs no faster than the clock when nobody steps it.
    pub real_time: bool,
    /// How long a client that steps may stay silent before it is let go.
    pub patience: Duration,
    /// Deadlines of connections.
    pub deadlines: Deadlines,
}

/// The session and who is attached.
pub struct Floor {
    /// The session.
    pub session: Session,
    clients: BTreeMap<ClientId, Client>,
    /// Steps since the run began.
    step: u64,
    next_client: u64,
    /// Why the last run ended by itself.
    failure: Option<Refusal>,
    events: SyncSender<Event>,
    /// Runs that nobody has taken yet.
    backlog: VecDeque<Finished>,
    publish: Option<Box<dyn FnMut(u64) + Send>>,
}

struct Client {
    key: String,
    /// How often it has asked to step, less how often it has given up: it steps while above 0.
    level: u32,
    desired: u64,
    locks: u32,
    last_seen: Instant,
    connections: u32,
}

/// Where all clients meet.
pub struct Hub {
    floor: Mutex<Floor>,
    moved: Condvar,
    /// Threads that want the floor: the free run lets them in between steps.
    waiting: AtomicUsize,
    closing: AtomicBool,
    connections: Arc<Connections>,
    manner: Manner,
}

impl Hub {
    /// Over a session; events go to `events`.
    #[must_use]
    pub fn new(session: Session, manner: Manner, events: SyncSender<Event>) -> Arc<Self> {
        let floor = Floor {
            session,
            clients: BTreeMap::new(),
            step: 0,
            next_client: 0,
            failure: None,
            events,
            backlog: VecDeque::new(),
            publish: None,
        };
        Arc::new(Self {
            floor: Mutex::new(floor),
            moved: Condvar::new(),
            waiting: AtomicUsize::new(0),
            closing: AtomicBool::new(false),
            connections: Connections::new(ConnectionLimits {
                total: limits::CONNECTIONS,
                per_address: limits::PER_ADDRESS,
                idle_under_pressure: limits::IDLE_UNDER_PRESSURE,
            }),
            manner,
        })
    }

    /// Takes the floor.
    pub fn enter(&self) -> MutexGuard<'_, Floor> {
        self.waiting.fetch_add(1, Ordering::SeqCst);
        // a panic of another thread is a bug of ours that has been printed; the session is still the best there is
        let floor = self.floor.lock().unwrap_or_else(PoisonError::into_inner);
        self.waiting.fetch_sub(1, Ordering::SeqCst);
        floor
    }

    /// Takes the floor if it is free within a time: a script that does not return may hold it.
    pub fn try_enter(&self, patience: Duration) -> Option<MutexGuard<'_, Floor>> {
        let begin = Instant::now();
        self.waiting.fetch_add(1, Ordering::SeqCst);
        let floor = loop {
            match self.floor.try_lock() {
                Ok(floor) => break Some(floor),
                Err(TryLockError::Poisoned(floor)) => break Some(floor.into_inner()),
                Err(TryLockError::WouldBlock) if begin.elapsed() >= patience => break None,
                Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(1)),
            }
        };
        self.waiting.fetch_sub(1, Ordering::SeqCst);
        floor
    }

    /// Wakes whoever waits for a step; to be called after anything that may let the simulation go on.
    pub fn wake(&self) {
        self.moved.notify_all();
    }

    /// Whether the server is being closed.
    #[must_use]
    pub fn is_closing(&self) -> bool {
        self.closing.load(Ordering::SeqCst)
    }

    /// Ends the free run and every wait.
    pub fn close(&self) {
        self.closing.store(true, Ordering::SeqCst);
        self.wake();
    }

    /// The connections of all ports.
    #[must_use]
    pub fn connections(&self) -> &Arc<Connections> {
        &self.connections
    }

    /// Deadlines of connections.
    #[must_use]
    pub fn deadlines(&self) -> &Deadlines {
        &self.manner.deadlines
    }

    /// One connection less of a client; with the last one all that it holds is let go.
    pub fn detach(&self, id: ClientId) {
        let mut floor = self.enter();
        let Some(client) = floor.clients.get_mut(&id) else { return };
        client.connections -= 1;
        if client.connections == 0 {
            floor.clients.remove(&id);
            floor.go_on();
        }
        drop(floor);
        self.wake();
    }

    /// One step for a client: waits until all that step together have asked. Returns at once if no run is on, or it is paused.
    ///
    /// # Errors
    ///
    /// The run has ended by itself: why.
    pub fn step(&self, id: ClientId) -> Result<(), Refusal> {
        let mut floor = self.enter();
        let Some(target) = floor.ask_step(id) else { return Ok(()) };
        let made = floor.advance_if_ready();
        self.wake();
        made?;
        while floor.step < target && floor.session.phase() == Phase::Running && !self.is_closing() {
            floor = self.moved.wait_timeout(floor, GLANCE).unwrap_or_else(PoisonError::into_inner).0;
            // it waits for others: that is not silence
            if let Some(client) = floor.clients.get_mut(&id) {
                client.last_seen = Instant::now();
            }
        }
        if floor.step < target && floor.session.phase() == Phase::Stopped {
            return floor.failure.clone().map_or(Ok(()), Err);
        }
        Ok(())
    }

    /// The free run, and the watch over silent clients: a thread of its own, until the hub is closed.
    pub fn run(&self) {
        let (mut due, mut watched) = (Instant::now(), Instant::now());
        while !self.is_closing() {
            // whoever waits comes first
            while self.waiting.load(Ordering::SeqCst) > 0 {
                std::thread::yield_now();
            }
            let mut floor = self.floor.lock().unwrap_or_else(PoisonError::into_inner);
            if watched.elapsed() >= GLANCE {
                watched = Instant::now();
                self.let_silent_go(&mut floor);
            }
            if !floor.runs_free() {
                if floor.session.phase() == Phase::Paused {
                    // what stops the run is told by the session's log
                    let _ = floor.act(Session::idle);
                }
                drop(self.moved.wait_timeout(floor, GLANCE).unwrap_or_else(PoisonError::into_inner));
                due = Instant::now();
                continue;
            }
            let now = Instant::now();
            if self.manner.real_time && due > now {
                let wait = (due - now).min(GLANCE);
                drop(self.moved.wait_timeout(floor, wait).unwrap_or_else(PoisonError::into_inner));
                continue;
            }
            due = due.max(now - GLANCE) + Duration::from_secs_f64(floor.session.table().sample_time());
            // what stops the run is told by the session's log
            let _ = floor.advance();
            drop(floor);
            self.wake();
        }
    }

    /// Lets go of clients that hold the simulation and have been silent for too long.
    fn let_silent_go(&self, floor: &mut Floor) {
        floor.pass_on();
        if floor.session.phase() != Phase::Running {
            return;
        }
        let (step, patience) = (floor.step, self.manner.patience);
        let holds = |c: &Client| c.locks > 0 || (c.level > 0 && c.desired <= step);
        let silent = |c: &&mut Client| holds(c) && c.last_seen.elapsed() > patience;
        let mut told = Vec::new();
        for client in floor.clients.values_mut().filter(silent) {
            (client.level, client.locks) = (0, 0);
            told.push(client.key.clone());
        }
        if told.is_empty() {
            return;
        }
        for key in told {
            let seconds = patience.as_secs_f64();
            floor.log(300, format!("client {key} has held the simulation without a word for {seconds} s: let go"));
        }
        floor.go_on();
        self.wake();
    }
}

impl Floor {
    /// A connection of the client of a key; connections of the same key are one client.
    pub fn attach(&mut self, key: &str) -> ClientId {
        if let Some((id, client)) = self.clients.iter_mut().find(|(_, c)| c.key == key) {
            client.connections += 1;
            return *id;
        }
        let id = ClientId(self.next_client);
        self.next_client += 1;
        let (desired, last_seen) = (self.step, Instant::now());
        self.clients.insert(id, Client { key: key.to_owned(), level: 0, desired, locks: 0, last_seen, connections: 1 });
        id
    }

    /// A client has said something.
    pub fn seen(&mut self, id: ClientId) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.last_seen = Instant::now();
        }
    }

    /// Clients attached.
    #[must_use]
    pub fn n_clients(&self) -> usize {
        self.clients.len()
    }

    /// Whether a client steps the simulation.
    #[must_use]
    pub fn is_stepping(&self, id: ClientId) -> bool {
        self.clients.get(&id).is_some_and(|c| c.level > 0)
    }

    /// A client begins to step, or gives it up once; gives the level before. The levels add up as in the official server.
    pub fn set_stepping(&mut self, id: ClientId, on: bool) -> u32 {
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
        self.go_on();
        before
    }

    /// A client gives up stepping altogether.
    pub fn stop_stepping(&mut self, id: ClientId) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.level = 0;
        }
        self.go_on();
    }

    /// While a client holds a lock no step is made.
    pub fn lock(&mut self, id: ClientId, on: bool) {
        if let Some(client) = self.clients.get_mut(&id) {
            client.locks = if on { client.locks.saturating_add(1) } else { client.locks.saturating_sub(1) };
        }
        self.go_on();
    }

    /// Steps since the run began.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.step
    }

    /// Asks for the next step; the count at which it is done, none if nothing runs.
    pub fn ask_step(&mut self, id: ClientId) -> Option<u64> {
        if self.session.phase() != Phase::Running {
            return None;
        }
        let step = self.step;
        let client = self.clients.get_mut(&id)?;
        client.desired = step + 1;
        client.last_seen = Instant::now();
        Some(step + 1)
    }

    /// Whether all that step have asked, and nobody holds a lock.
    fn is_ready(&self) -> bool {
        self.clients.values().all(|c| c.locks == 0 && (c.level == 0 || c.desired > self.step))
    }

    /// Whether the simulation runs by itself.
    fn runs_free(&mut self) -> bool {
        self.session.phase() == Phase::Running && self.clients.values().all(|c| c.level == 0 && c.locks == 0)
    }

    /// Makes the step if somebody steps and all of those are ready.
    ///
    /// # Errors
    ///
    /// The run has ended by itself.
    pub fn advance_if_ready(&mut self) -> Result<(), Refusal> {
        let is_stepped = self.clients.values().any(|c| c.level > 0);
        if is_stepped && self.is_ready() && self.session.phase() == Phase::Running { self.advance() } else { Ok(()) }
    }

    /// After something that others may have waited for; a failure is kept for those who wait.
    fn go_on(&mut self) {
        let _ = self.advance_if_ready();
    }

    fn advance(&mut self) -> Result<(), Refusal> {
        let made = self.session.step();
        self.step += 1;
        if let Err(refusal) = &made {
            self.failure = Some(refusal.clone());
            self.run_ended();
        }
        self.announce();
        self.pass_on();
        made
    }

    /// Tells the subscribers of version 1 where the run is.
    fn announce(&mut self) {
        let step = self.step;
        if let Some(publish) = &mut self.publish {
            publish(step);
        }
    }

    /// What is called with the number of the step, at the start of a run, after every step and at the end.
    pub fn on_step(&mut self, publish: Box<dyn FnMut(u64) + Send>) {
        self.publish = Some(publish);
    }

    /// Does something with the session, and keeps the clients in step with what that did to the run.
    ///
    /// # Errors
    ///
    /// Those of `act`.
    pub fn act<T>(&mut self, act: impl FnOnce(&mut Session) -> Result<T, Refusal>) -> Result<T, Refusal> {
        let before = self.session.phase();
        let result = act(&mut self.session);
        self.follow(before);
        result
    }

    /// After something was done with the session while it was in phase `before`.
    pub fn follow(&mut self, before: Phase) {
        match (before, self.session.phase()) {
            (Phase::Stopped, Phase::Running) => {
                (self.step, self.failure) = (0, None);
                self.clients.values_mut().for_each(|c| c.desired = 0);
                self.announce();
            }
            (Phase::Running | Phase::Paused, Phase::Stopped) => {
                self.run_ended();
                self.announce();
            }
            _ => {}
        }
        self.pass_on();
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

    /// Passes on what the session has to say. Runs wait until they are taken, up to [`MOST_RUNS`]; then the oldest are dropped.
    fn pass_on(&mut self) {
        for line in self.session.table().take_log() {
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
        while self.backlog.len() > MOST_RUNS {
            self.backlog.pop_front();
        }
    }
}
