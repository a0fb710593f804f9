//! How much a client may ask for. Larger things are refused, or end the connection that sends them; memory stays bounded.

use std::time::Duration;

/// Connections at once, all protocols together: an asyncio client opens fifty of its own.
pub const CONNECTIONS: usize = 512;
/// Bytes of one message, put together.
pub const MESSAGE: usize = 16 << 20;
/// Depth to which lists and maps may be nested.
pub const DEPTH: usize = 32;
/// Commands in one message of the legacy API.
pub const COMMANDS: usize = 4_096;
/// Commands that one client of the legacy API may have repeated.
pub const STREAMS: usize = 4_096;
/// Bytes of unfinished split transfers of one client of the legacy API.
pub const SPLIT: usize = 64 << 20;
/// Steps in one call of `sim.step(n)`.
pub const STEPS: i64 = 1_000_000;
/// Callbacks of a client within each other.
pub const CALLBACKS: usize = 16;
/// How long a client may take to take an answer.
pub const WRITE: Duration = Duration::from_secs(10);
/// How long a message that has begun may take to be complete.
pub const READ: Duration = Duration::from_secs(30);
