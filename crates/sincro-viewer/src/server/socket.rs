//! One viewer's line: everything of the live state and that it has not seen, at its own pace.
//!
//! A frame message is, little endian: `u32` 2, run, number of frames n, number of signals m, number of points of
//! contact c, 0; n times `[s]` as `f64`; n·m signals as `f64`; n frames as `f32`; n numbers of points as `u32`; c
//! points as `f32`. All else is JSON.

use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError};
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use sincro_sim::replay::{CONTACT, RuntimeEvent};
use tokio::time::{Instant, interval, sleep_until, timeout};

use super::connection::Line;
use crate::live::{Command, LiveState};

/// Least time between two messages of frames.
const PAUSE: Duration = Duration::from_millis(16);
/// Frames in one message at most.
const MAX_FRAMES: usize = 1000;
/// Numbers of the changes of objects in one message, beside the last one.
const MAX_EVENT_NUMBERS: usize = 50_000;

/// Interval of pings, which browsers answer by themselves.
const PING: Duration = Duration::from_secs(20);
/// Silence after which a viewer counts as gone.
const SILENCE: Duration = Duration::from_secs(65);
/// Time that a viewer may take to take a message.
const TAKE: Duration = Duration::from_secs(10);

/// Content that was sent to one viewer.
struct Seen {
    /// Frames of each run, and changes of its objects that were made at run time.
    frames: Vec<(usize, usize)>,
    words: u64,
    engine: String,
}

/// Sends a message; false if the viewer is gone or does not take it in time.
async fn send(socket: &mut WebSocket, message: Message) -> bool {
    matches!(timeout(TAKE, socket.send(message)).await, Ok(Ok(())))
}

/// Serves one viewer until it goes or its line must be closed.
pub(super) async fn attend(
    socket: WebSocket,
    line: Arc<Line>,
    live_state: Arc<LiveState>,
    commands: SyncSender<Command>,
) {
    tokio::select! {
        () = show(socket, &line, live_state, commands) => {}
        () = line.closed() => {}
    }
}

async fn show(mut socket: WebSocket, line: &Line, live_state: Arc<LiveState>, commands: SyncSender<Command>) {
    let mut changes = live_state.watch();
    let (replay, words) = {
        let content = live_state.read();
        (content.replay.clone(), content.last_words())
    };
    if !send(&mut socket, Message::text(replay)).await {
        return;
    }
    let mut seen = Seen { frames: Vec::new(), words, engine: String::new() };
    let mut has_complained = false;
    let (mut ping, mut heard) = (interval(PING), Instant::now());
    loop {
        let started = Instant::now();
        changes.mark_unchanged();
        loop {
            let news = seen.news(&live_state);
            if news.is_empty() {
                break;
            }
            for message in news {
                // a viewer that does not read waits here, and nobody else
                if !send(&mut socket, message).await {
                    return;
                }
            }
        }
        // until something is new and the least pause is over; messages are taken meanwhile
        let mut is_new = false;
        while !(is_new && started.elapsed() >= PAUSE) {
            let answer = tokio::select! {
                changed = changes.changed(), if !is_new => match changed {
                    Ok(()) => {
                        is_new = true;
                        continue;
                    }
                    Err(_) => return,
                },
                () = sleep_until(started + PAUSE), if is_new => continue,
                _ = ping.tick() => {
                    if heard.elapsed() > SILENCE {
                        return;
                    }
                    Some(Message::Ping(Vec::new().into()))
                }
                message = socket.recv() => {
                    heard = Instant::now();
                    line.mark_message();
                    match message {
                        Some(Ok(Message::Text(text))) => take(&text, &commands, &mut has_complained).map(Message::text),
                        Some(Ok(Message::Binary(_))) => {
                            Some(Message::text(refuse("messages are text", &mut has_complained)))
                        }
                        Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                        Some(Ok(_)) => None,
                    }
                }
            };
            if let Some(answer) = answer
                && !send(&mut socket, answer).await
            {
                return;
            }
        }
    }
}

/// Hands a message on; what to answer if it is refused.
fn take(text: &str, commands: &SyncSender<Command>, has_complained: &mut bool) -> Option<String> {
    let command = match Command::parse(text) {
        Ok(command) => command,
        Err(reason) => return Some(refuse(&reason, has_complained)),
    };
    match commands.try_send(command) {
        Ok(()) => None,
        Err(TrySendError::Full(_)) => Some(refuse("too many messages at once", has_complained)),
        Err(TrySendError::Disconnected(_)) => Some(refuse("the simulation has ended", has_complained)),
    }
}

/// The answer to a message that is refused; the first one of a viewer is logged.
fn refuse(reason: &str, has_complained: &mut bool) -> String {
    if !*has_complained {
        eprintln!("a viewer's message was refused: {}", sincro_access::printable(reason));
        *has_complained = true;
    }
    crate::live::refusal(reason)
}

impl Seen {
    /// Content of the live state that was not sent yet, a bounded part of it.
    fn news(&mut self, live_state: &LiveState) -> Vec<Message> {
        let content = live_state.read();
        let mut news = Vec::new();
        for (id, run) in content.runs.iter().enumerate() {
            if id == self.frames.len() {
                news.push(Message::text(run.header.clone()));
                self.frames.push((0, 0));
            }
            let (from, known) = self.frames[id];
            let to = run.times.len().min(from + MAX_FRAMES);
            let mut n_numbers = 0;
            let until = known
                + run.runtime[known..]
                    .iter()
                    .take_while(|event| {
                        let has_room = n_numbers <= MAX_EVENT_NUMBERS;
                        n_numbers += event.change.size();
                        has_room
                    })
                    .count();
            self.frames[id] = (to, until);
            if known < until {
                news.push(Message::text(runtime(id, &run.runtime[known..until])));
            }
            if from < to {
                news.push(Message::binary(frames(id, run, from, to)));
            }
        }
        let known = self.words;
        for (number, text) in content.words.iter().filter(|(number, _)| *number > known) {
            self.words = *number;
            news.push(Message::text(text.clone()));
        }
        let mut engine = serde_json::to_value(&content.engine).expect("plain data has a JSON form");
        engine["type"] = "state".into();
        let engine = engine.to_string();
        if engine != self.engine {
            self.engine.clone_from(&engine);
            news.push(Message::text(engine));
        }
        news
    }
}

/// Changes of objects that scripts have made, as JSON.
fn runtime(id: usize, events: &[RuntimeEvent]) -> String {
    let events = serde_json::to_string(events).expect("plain data has a JSON form");
    format!(r#"{{"type":"runtime","id":{id},"events":{events}}}"#)
}

fn frames(id: usize, run: &crate::live::RunLog, from: usize, to: usize) -> Vec<u8> {
    let n = to - from;
    let points: usize = (from..to).map(|k| run.contacts.count(k)).sum();
    let mut bytes = Vec::with_capacity(24 + n * (12 + 8 * run.n_columns + 4 * run.width) + 4 * CONTACT * points);
    for number in [2, id, n, run.n_columns, points, 0] {
        bytes.extend(u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes());
    }
    run.times[from..to].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    run.rows[from * run.n_columns..to * run.n_columns].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    run.frames[from * run.width..to * run.width].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    (from..to).for_each(|k| bytes.extend((run.contacts.count(k) as u32).to_le_bytes()));
    (from..to).flat_map(|k| run.contacts.frame(k)).for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes
}
