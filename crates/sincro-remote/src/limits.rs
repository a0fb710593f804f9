//! Limits of a client's requests. Larger ones are refused, or end the connection that sends them; memory stays bounded.

use std::time::Duration;

/// Open connections of a server at once, all protocols together: an asyncio client opens fifty of its own.
pub const CONNECTIONS: usize = 512;
/// Open connections of a server at once from one address (the loopback networks count as one).
pub const PER_ADDRESS: usize = 256;
/// Idle time after which a connection makes room for a newcomer when all of [`CONNECTIONS`] are in use.
pub const IDLE_UNDER_PRESSURE: Duration = Duration::from_secs(60);
/// Largest message of a client `[bytes]`, all its packets or frames put together; a larger one ends the connection.
pub const MESSAGE: usize = 16 << 20;
/// Depth to which lists and maps of a message may be nested; a deeper one is refused.
pub const DEPTH: usize = 32;
/// Commands in one message of the legacy API; a message with more is refused as a whole.
pub const COMMANDS: usize = 4_096;
/// Commands that one client of the legacy API may have repeated (streaming); further ones are refused.
pub const STREAMS: usize = 4_096;
/// Unfinished split transfers of one client of the legacy API, all together `[bytes]`; a piece beyond it is refused
/// with its transfer.
pub const SPLIT: usize = 64 << 20;
/// Largest number of steps of clients in one call of `sim.step(n)`; a larger one is refused.
pub const STEPS: i64 = 1_000_000;
/// Callbacks of one client that may be unanswered at once, nested in each other; a further one is refused.
pub const CALLBACKS: usize = 16;
/// Deadlines of the connections of a server, part of [`Options`](crate::Options); a connection that misses one is
/// closed.
#[derive(Clone, Copy, Debug)]
pub struct Deadlines {
    /// Time from the beginning of a connection to the end of its handshake; 10 s by default.
    pub handshake: Duration,
    /// Time from the first byte of a message to its last; 30 s by default.
    pub read: Duration,
    /// Time from the first byte of an answer to its last, in which the client must take it; 10 s by default.
    pub write: Duration,
    /// Time between two messages; one hour by default.
    pub idle: Duration,
}

impl Default for Deadlines {
    fn default() -> Self {
        Self {
            handshake: Duration::from_secs(10),
            read: Duration::from_secs(30),
            write: Duration::from_secs(10),
            idle: Duration::from_secs(3600),
        }
    }
}
