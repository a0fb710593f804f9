//! One client of the legacy API: what it has repeated, what it has sent in pieces, how it is answered.

use std::collections::BTreeMap;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sincro_coppelia::api::{ApiError, Phase};

use super::commands::{self, FINISH, GET_HANDLE, LAST_ERRORS, SYNCHRONOUS_OFF, SYNCHRONOUS_ON, TAKE_STRING, TRIGGER};
use super::functions::Call;
use super::message::{self, Command, Head, Mode, ReplyHead};
use crate::hub::{self, ClientId, Hub, SessionGuard};
use crate::limits;

/// Errors that are kept for `simxGetLastErrors`.
const MAX_ERRORS: usize = 50;
/// Function and identification: commands that have both the same are the same command.
type Key = (u16, Vec<u8>);

/// A command that is repeated.
struct Stream {
    code: i32,
    data: Vec<u8>,
    pause: Duration,
    last: Option<Instant>,
    /// Longest piece of an answer, for those in pieces.
    piece: Option<usize>,
}

/// An answer that goes out in pieces, one a message.
struct Outgoing {
    code: i32,
    ident: Vec<u8>,
    time: i32,
    failed: bool,
    data: Vec<u8>,
    sent: usize,
    piece: usize,
}

/// A client.
pub(super) struct Client {
    hub: Arc<Hub>,
    id: ClientId,
    started: Instant,
    streams: BTreeMap<Key, Stream>,
    /// Pieces of commands, by function and identification.
    pieces: BTreeMap<Key, Vec<u8>>,
    outgoing: VecDeque<Outgoing>,
    errors: VecDeque<String>,
}

/// An answer that is not whole yet: in what mode, and its data.
struct Answer {
    failed: bool,
    data: Vec<u8>,
}

impl Client {
    pub fn new(hub: Arc<Hub>, id: ClientId) -> Self {
        Self {
            hub,
            id,
            started: Instant::now(),
            streams: BTreeMap::new(),
            pieces: BTreeMap::new(),
            outgoing: VecDeque::new(),
            errors: VecDeque::new(),
        }
    }

    /// Executes a message and writes the reply; returns true if the connection continues.
    ///
    /// # Errors
    ///
    /// It is no message: nothing was done.
    pub fn answer(&mut self, bytes: &[u8], out: &mut Vec<u8>) -> Result<bool, &'static str> {
        let head = Head::parse(bytes).ok_or("a message is shorter than its head")?;
        let commands = message::commands(bytes)?;
        out.clear();
        // the head is written over at the end, when its state is known
        Head::default().write(out);
        let (hub, mut goes_on) = (self.hub.clone(), true);
        let mut guard = hub.enter();
        guard.seen(self.id);
        let triggers = |c: &&Command<'_>| c.function() == TRIGGER;
        for command in commands.iter().filter(|c| !triggers(c)) {
            goes_on &= command.function() != FINISH;
            self.command(&mut guard, command, out);
        }
        let mut stepped = false;
        if let Some(trigger) = commands.iter().find(triggers) {
            let result = self.ready_to_step(&mut guard);
            drop(guard);
            let result = result.and_then(|()| hub.step(self.id));
            stepped = result.is_ok();
            guard = hub.enter();
            let answer = self.judged(result.map(|()| Vec::new()), trigger.function());
            self.reply(&mut guard, trigger.code, trigger.ident, &answer, out);
        }
        self.repeat(&mut guard, stepped, out);
        self.send_pieces(out);
        let state = state(&mut guard);
        drop(guard);
        hub.wake();
        let server_time = self.started.elapsed().as_millis() as i32;
        let mut written = Vec::with_capacity(message::MESSAGE_HEAD);
        Head { id: head.id, client_time: head.client_time, server_time, scene: 1, state }.write(&mut written);
        out[..message::MESSAGE_HEAD].copy_from_slice(&written);
        Ok(goes_on)
    }

    fn ready_to_step(&self, guard: &mut SessionGuard) -> Result<(), ApiError> {
        if let Some(port) = guard.untriggered_port(self.id) {
            return Err(ApiError(hub::no_trigger(port)));
        }
        if !guard.is_stepping(self.id) {
            return Err(ApiError::new("synchronous mode is off: a trigger does nothing"));
        }
        if guard.session.phase() != Phase::Running {
            return Err(ApiError::new("the simulation does not run: a trigger does nothing"));
        }
        Ok(())
    }

    fn command(&mut self, guard: &mut SessionGuard, command: &Command<'_>, out: &mut Vec<u8>) {
        let key = (command.function(), command.ident.to_vec());
        match command.mode() {
            None => self.fail(guard, command, "this mode of operation is never sent", out),
            Some(Mode::Once) => {
                let answer = self.execute(guard, key.0, command.ident, command.data);
                self.reply(guard, command.code, command.ident, &answer, out);
            }
            Some(Mode::Stream) => {
                self.keep(guard, key, command.data.to_vec(), command, None, out);
            }
            Some(Mode::SplitOnce | Mode::SplitStream) => self.piece(guard, key, command, out),
            Some(Mode::Discontinue) => {
                self.streams.remove(&key);
                self.pieces.remove(&key);
                self.outgoing.retain(|o| (o.code as u16, &o.ident) != (key.0, &key.1));
                self.reply(guard, command.code, command.ident, &Answer { failed: false, data: Vec::new() }, out);
            }
        }
    }

    /// Keeps a command to be repeated; the same command is replaced.
    fn keep(
        &mut self,
        guard: &mut SessionGuard,
        key: Key,
        data: Vec<u8>,
        command: &Command<'_>,
        piece: Option<usize>,
        out: &mut Vec<u8>,
    ) {
        if self.streams.len() >= limits::STREAMS && !self.streams.contains_key(&key) {
            return self.fail(guard, command, "too many commands are streamed: discontinue some", out);
        }
        let pause = if piece.is_some() { 0 } else { command.delay };
        let last = self.streams.get(&key).and_then(|known| known.last);
        let pause = Duration::from_millis(pause.into());
        self.streams.insert(key, Stream { code: command.code, data, pause, last, piece });
    }

    /// A piece of a command; executed when it is complete.
    fn piece(&mut self, guard: &mut SessionGuard, key: Key, command: &Command<'_>, out: &mut Vec<u8>) {
        let total = command.full_size as i64 - (message::COMMAND_HEAD + command.ident.len()) as i64;
        let (offset, n) = (command.offset as i64, command.data.len() as i64);
        let taken: usize = self.pieces.values().map(Vec::len).sum();
        let whole = self.pieces.entry(key.clone()).or_default();
        // pieces come in order; one at the start begins again
        if offset == 0 {
            whole.clear();
        }
        if total < n || offset != whole.len() as i64 || offset + n > total || taken + command.data.len() > limits::SPLIT
        {
            self.pieces.remove(&key);
            return self.fail(guard, command, "a piece of a split command does not fit what came before it", out);
        }
        whole.extend_from_slice(command.data);
        if (whole.len() as i64) < total {
            return;
        }
        let data = self.pieces.remove(&key).unwrap_or_default();
        let piece = usize::from(command.delay).max(100);
        if command.mode() == Some(Mode::SplitStream) {
            return self.keep(guard, key, data, command, Some(piece), out);
        }
        let answer = self.execute(guard, key.0, command.ident, &data);
        self.send_later(guard, command.code, &key, answer, piece);
    }

    fn send_later(&mut self, guard: &mut SessionGuard, code: i32, key: &Key, answer: Answer, piece: usize) {
        let time = time_ms(guard);
        let Answer { failed, data } = answer;
        self.outgoing.push_back(Outgoing { code, ident: key.1.clone(), time, failed, data, sent: 0, piece });
    }

    /// Executes what is repeated and due. After a step everything is: what is read with it must not be older.
    fn repeat(&mut self, guard: &mut SessionGuard, stepped: bool, out: &mut Vec<u8>) {
        let now = Instant::now();
        let due = |s: &Stream| stepped || s.last.is_none_or(|last| now - last >= s.pause);
        let keys: Vec<Key> = self.streams.iter().filter(|(_, s)| due(s)).map(|(k, _)| k.clone()).collect();
        for key in keys {
            let is_going_out = self.outgoing.iter().any(|o| (o.code as u16, &o.ident) == (key.0, &key.1));
            let Some(stream) = self.streams.get_mut(&key) else { continue };
            if is_going_out {
                continue;
            }
            stream.last = Some(now);
            let (code, piece) = (stream.code, stream.piece);
            let data = std::mem::take(&mut stream.data);
            let answer = self.execute(guard, key.0, &key.1, &data);
            let has_delivered = key.0 == TAKE_STRING && !answer.failed;
            if has_delivered {
                self.streams.remove(&key);
            } else if let Some(stream) = self.streams.get_mut(&key) {
                stream.data = data;
            }
            match piece {
                Some(piece) => self.send_later(guard, code, &key, answer, piece),
                None => self.reply(guard, code, &key.1, &answer, out),
            }
        }
    }

    /// One piece of every answer that goes out in pieces.
    fn send_pieces(&mut self, out: &mut Vec<u8>) {
        for answer in &mut self.outgoing {
            let end = answer.data.len().min(answer.sent + answer.piece);
            let part = &answer.data[answer.sent..end];
            let full = (message::COMMAND_HEAD + answer.ident.len() + answer.data.len()) as i32;
            let head = ReplyHead {
                code: answer.code,
                time: answer.time,
                failed: answer.failed,
                piece: Some((full, answer.sent as i32)),
            };
            message::write_reply(&head, &answer.ident, part, out);
            answer.sent = end;
        }
        self.outgoing.retain(|answer| answer.sent < answer.data.len());
    }

    fn execute(&mut self, guard: &mut SessionGuard, function: u16, ident: &[u8], data: &[u8]) -> Answer {
        let result = match function {
            SYNCHRONOUS_ON | SYNCHRONOUS_OFF if guard.untriggered_port(self.id).is_some() => {
                let port = guard.untriggered_port(self.id).unwrap_or_default();
                Err(ApiError(hub::no_trigger(port)))
            }
            SYNCHRONOUS_ON => {
                if !guard.is_stepping(self.id) {
                    guard.set_stepping(self.id, true);
                }
                Ok(Vec::new())
            }
            SYNCHRONOUS_OFF => {
                guard.stop_stepping(self.id);
                Ok(Vec::new())
            }
            FINISH => Ok(Vec::new()),
            LAST_ERRORS => Ok(self.take_errors()),
            // a trigger that is streamed or split would step without being asked
            TRIGGER => Err(ApiError::new("a trigger is sent once, not streamed")),
            _ => commands::run(guard, &Call { function, ident, data }),
        };
        self.judged(result, function)
    }

    fn judged(&mut self, result: Result<Vec<u8>, ApiError>, function: u16) -> Answer {
        match result {
            Ok(data) => Answer { failed: false, data },
            Err(ApiError(message)) => {
                if self.errors.len() == MAX_ERRORS {
                    self.errors.pop_front();
                }
                self.errors.push_back(format!("{message} ({})", commands::shown(function)));
                // a getter of a handle answers −1 to those that do not look at the status
                let data = if function == GET_HANDLE { (-1_i32).to_le_bytes().to_vec() } else { Vec::new() };
                Answer { failed: true, data }
            }
        }
    }

    fn take_errors(&mut self) -> Vec<u8> {
        let mut data = (self.errors.len() as i32).to_le_bytes().to_vec();
        for error in self.errors.drain(..) {
            data.extend(error.bytes().filter(|b| *b != 0));
            data.push(0);
        }
        data
    }

    fn fail(&mut self, guard: &mut SessionGuard, command: &Command<'_>, why: &str, out: &mut Vec<u8>) {
        let answer = self.judged(Err(ApiError::new(why)), command.function());
        self.reply(guard, command.code, command.ident, &answer, out);
    }

    fn reply(&self, guard: &mut SessionGuard, code: i32, ident: &[u8], answer: &Answer, out: &mut Vec<u8>) {
        let head = ReplyHead { code, time: time_ms(guard), failed: answer.failed, piece: None };
        message::write_reply(&head, ident, &answer.data, out);
    }
}

/// Simulation time as replies carry it [ms].
fn time_ms(guard: &mut SessionGuard) -> i32 {
    let t = if guard.session.phase() == Phase::Stopped { 0.0 } else { guard.session.t() };
    (t * 1000.0).round() as i32
}

fn state(guard: &mut SessionGuard) -> u8 {
    match guard.session.phase() {
        Phase::Stopped => 0,
        Phase::Running => 1,
        Phase::Paused => 3,
    }
}
