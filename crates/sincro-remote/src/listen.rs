//! Listening: one thread a port that accepts, one a connection; deadlines of reading and writing.
//!
//! A message must be complete within [`Deadlines::read`] of its first byte, an answer be taken within
//! [`Deadlines::write`], however the bytes are spread over that time; between messages a connection may be idle for a
//! limited time only.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::ops::Range;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use sincro_access::Permit;

use crate::hub::Hub;
#[cfg(doc)]
use crate::limits::Deadlines;

/// Interval at which a thread that waits for input checks its deadline and whether shutdown has begun.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

/// Stack of a thread that serves a client [bytes]. Scripts run on it, up to Lua's 200 calls of C functions within each
/// other; only what is used of it takes memory.
pub(crate) const STACK: usize = 16 << 20;

/// Accepts connections until the hub is closed; each is served by `serve` in a thread of its own.
pub(crate) fn accept<F>(
    listener: TcpListener,
    hub: &Arc<Hub>,
    name: &'static str,
    serve: F,
) -> io::Result<thread::JoinHandle<()>>
where
    F: Fn(Connection, &Arc<Hub>) + Send + Sync + 'static,
{
    let (hub, serve) = (hub.clone(), Arc::new(serve));
    thread::Builder::new().name(format!("{name} port")).spawn(move || {
        for stream in listener.incoming() {
            if hub.is_closing() {
                return;
            }
            // a connection that failed before it was accepted is none, and one without a slot is closed
            let Ok(stream) = stream else { continue };
            let Some(permit) = admit(&stream, &hub) else { continue };
            let (of_thread, serve) = (hub.clone(), serve.clone());
            // a thread that cannot be started drops the connection and its slot
            let _ = thread::Builder::new().name(format!("{name} client")).stack_size(STACK).spawn(move || {
                if let Ok(connection) = Connection::new(stream, permit, of_thread.clone()) {
                    serve(connection, &of_thread);
                }
            });
        }
    })
}

/// Tries to find a slot for a newcomer.
const MAX_TRIES: usize = 4;

/// Takes a slot for a connection.
fn admit(stream: &TcpStream, hub: &Hub) -> Option<Permit> {
    let peer = stream.peer_addr().ok()?;
    for k in 0..MAX_TRIES {
        let handle = stream.try_clone().ok()?;
        let permit = hub.connections().admit(peer.ip(), move || drop(handle.shutdown(Shutdown::Both)));
        if permit.is_some() || k + 1 == MAX_TRIES {
            return permit;
        }
        // those who were told to close have threads of their own, which are about to end
        thread::sleep(Duration::from_millis(1));
    }
    None
}

/// Wakes a thread that accepts, so that it sees that the hub is closed.
pub(crate) fn wake_listener(address: SocketAddr) {
    let mut address = address;
    if address.ip().is_unspecified() {
        let loopback: IpAddr =
            if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { std::net::Ipv6Addr::LOCALHOST.into() };
        address.set_ip(loopback);
    }
    let _ = TcpStream::connect_timeout(&address, Duration::from_secs(1));
}

/// A connection whose reads and writes end at their deadlines and when the server is closed.
pub(crate) struct Connection {
    stream: TcpStream,
    hub: Arc<Hub>,
    permit: Permit,
    /// Bytes that were read and not asked for yet: a message then costs one system call, not one for each of its parts.
    buffer: Box<[u8; BUFFER]>,
    /// Part of the buffer that is still to be taken.
    unread: Range<usize>,
    stage: Stage,
    /// Bytes that have come since the last whole message.
    received: usize,
    /// Instant by which the present answer must have been taken; none before its first byte.
    write_by: Option<Instant>,
}

/// Progress of the present message.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// No byte of it has come; the connection is closed at the instant.
    Waiting { until: Instant },
    /// Its first byte has come; it must be complete by the instant.
    Begun { until: Instant },
}

/// Size of the read buffer [bytes].
const BUFFER: usize = 4096;

impl Connection {
    fn new(stream: TcpStream, permit: Permit, hub: Arc<Hub>) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(POLL_INTERVAL))?;
        stream.set_write_timeout(Some(POLL_INTERVAL))?;
        let stage = Stage::Begun { until: Instant::now() + hub.deadlines().handshake };
        let (buffer, unread) = (Box::new([0; BUFFER]), 0..0);
        Ok(Self { stream, hub, permit, buffer, unread, stage, received: 0, write_by: None })
    }

    /// Address of the peer, as text.
    pub fn peer(&self) -> String {
        self.stream.peer_addr().map_or_else(|_| "unknown".to_owned(), |a| a.to_string())
    }

    /// Port of this machine that the peer came by; none if the connection has ended already.
    pub fn local_port(&self) -> Option<u16> {
        self.stream.local_addr().ok().map(|address| address.port())
    }

    /// Another handle of the stream, for a thread that only writes.
    pub fn try_clone_stream(&self) -> io::Result<TcpStream> {
        self.stream.try_clone()
    }

    /// Begins to wait for a message. Until this is called first, the deadline of the handshake holds.
    pub fn next_message(&mut self) {
        self.received = 0;
        self.stage = Stage::Waiting { until: Instant::now() + self.hub.deadlines().idle };
    }

    /// Notes that a whole message has come: this connection is in use.
    pub fn end_message(&mut self) {
        self.received = 0;
        self.permit.mark_message();
    }

    /// Notes a control frame of `n` bytes. If nothing else has come, the wait for a message begins anew; a message that
    /// has begun keeps its deadline.
    pub fn pass_control_frame(&mut self, n: usize) {
        self.received = self.received.saturating_sub(n);
        if self.received == 0 {
            self.next_message();
        }
    }

    /// True if the idle time-out has passed before a byte of the present message has come, and the server is not
    /// closing.
    pub fn is_timed_out(&self) -> bool {
        matches!(self.stage, Stage::Waiting { until } if Instant::now() >= until) && !self.hub.is_closing()
    }

    /// Reads `n` bytes onto the end of `out`, in pieces, so that a false length takes no memory.
    ///
    /// # Errors
    ///
    /// The peer has disconnected, a deadline has passed, or the server is being closed.
    pub fn read_appending(&mut self, n: usize, out: &mut Vec<u8>) -> io::Result<()> {
        let mut left = n;
        while left > 0 {
            let piece = left.min(1 << 16);
            let start = out.len();
            out.resize(start + piece, 0);
            self.read_exact(&mut out[start..])?;
            left -= piece;
        }
        Ok(())
    }

    /// Reads what is in the buffer, else what comes: at least a byte, unless the peer has disconnected.
    fn receive(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.unread.is_empty() {
            if out.len() >= BUFFER {
                return receive(&self.stream, out, &self.hub, self.stage);
            }
            self.unread = 0..receive(&self.stream, &mut self.buffer[..], &self.hub, self.stage)?;
        }
        let n = out.len().min(self.unread.len());
        out[..n].copy_from_slice(&self.buffer[self.unread.start..][..n]);
        self.unread.start += n;
        Ok(n)
    }
}

/// Reads from a stream until something comes, the deadline of the stage passes or the server is being closed.
fn receive(mut stream: &TcpStream, out: &mut [u8], hub: &Hub, stage: Stage) -> io::Result<usize> {
    let (Stage::Waiting { until } | Stage::Begun { until }) = stage;
    loop {
        // looked at before every read: a byte now and then does not put the deadline off
        if hub.is_closing() || Instant::now() >= until {
            return Err(ErrorKind::ConnectionAborted.into());
        }
        match stream.read(out) {
            Err(e) if is_pending(&e) => {}
            done => return done,
        }
    }
}

/// True of the errors after which a call is made again.
fn is_pending(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

impl Read for Connection {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let n = self.receive(out)?;
        self.received = self.received.saturating_add(n);
        self.write_by = None;
        if let Stage::Waiting { .. } = self.stage {
            self.stage = Stage::Begun { until: Instant::now() + self.hub.deadlines().read };
        }
        Ok(n)
    }
}

impl Write for Connection {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // what is written between two reads is one answer
        let until = *self.write_by.get_or_insert_with(|| Instant::now() + self.hub.deadlines().write);
        loop {
            if self.hub.is_closing() || Instant::now() >= until {
                return Err(ErrorKind::ConnectionAborted.into());
            }
            match self.stream.write(bytes) {
                Err(e) if is_pending(&e) => {}
                done => return done,
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
