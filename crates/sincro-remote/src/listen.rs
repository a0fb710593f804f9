//! Listening: one thread a port that accepts, one a connection.

use std::io::{self, ErrorKind, Read};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::ops::Range;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use crate::hub::Hub;
use crate::limits;

/// How often a thread that waits for input looks whether the server is being closed.
const GLANCE: Duration = Duration::from_millis(200);

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
            // a connection that failed before it was accepted is none
            let Ok(stream) = stream else { continue };
            if !hub.admit() {
                continue;
            }
            let (of_thread, serve) = (hub.clone(), serve.clone());
            let spawned =
                thread::Builder::new().name(format!("{name} client")).stack_size(512 << 10).spawn(move || {
                    if let Ok(connection) = Connection::new(stream, of_thread.clone()) {
                        serve(connection, &of_thread);
                    }
                    of_thread.leave();
                });
            if spawned.is_err() {
                hub.leave();
            }
        }
    })
}

/// Wakes a thread that accepts, so that it sees that the hub is closed.
pub(crate) fn nudge(address: SocketAddr) {
    let mut address = address;
    if address.ip().is_unspecified() {
        address.set_ip(std::net::Ipv4Addr::LOCALHOST.into());
    }
    let _ = TcpStream::connect_timeout(&address, Duration::from_secs(1));
}

/// A connection whose reads end when the server is closed.
pub(crate) struct Connection {
    stream: TcpStream,
    hub: Arc<Hub>,
    /// What has come and was not asked for yet: a message then costs one call of the system, not one for each of its parts.
    ahead: Box<[u8; AHEAD]>,
    /// Its part that is still to be taken.
    waiting: Range<usize>,
}

/// Bytes that are read ahead.
const AHEAD: usize = 4096;

impl Connection {
    fn new(stream: TcpStream, hub: Arc<Hub>) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(GLANCE))?;
        stream.set_write_timeout(Some(limits::WRITE))?;
        Ok(Self { stream, hub, ahead: Box::new([0; AHEAD]), waiting: 0..0 })
    }

    /// Who it is.
    pub fn peer(&self) -> String {
        self.stream.peer_addr().map_or_else(|_| "unknown".to_owned(), |a| a.to_string())
    }

    /// For writing.
    pub fn stream(&mut self) -> &mut TcpStream {
        &mut self.stream
    }

    /// Fills a buffer. A message may begin whenever it likes (`is_start`), but once begun it must go on.
    pub fn fill(&mut self, buffer: &mut [u8], is_start: bool) -> io::Result<()> {
        let (mut done, mut since) = (0, Instant::now());
        while done < buffer.len() {
            match self.read(&mut buffer[done..]) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(n) => {
                    done += n;
                    since = Instant::now();
                }
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    let has_begun = !is_start || done > 0;
                    if self.hub.is_closing() || (has_begun && since.elapsed() > limits::READ) {
                        return Err(ErrorKind::TimedOut.into());
                    }
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(e),
            }
        }
        Ok(())
    }

    /// What waits, else what comes: at least a byte, unless the peer has gone.
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.waiting.is_empty() {
            if out.len() >= AHEAD {
                return self.stream.read(out);
            }
            self.waiting = 0..self.stream.read(&mut self.ahead[..])?;
        }
        let n = out.len().min(self.waiting.len());
        out[..n].copy_from_slice(&self.ahead[self.waiting.start..][..n]);
        self.waiting.start += n;
        Ok(n)
    }

    /// Reads `n` bytes onto the end of `out`, in pieces, so that a length that was made up takes no memory.
    pub fn take(&mut self, n: usize, out: &mut Vec<u8>) -> io::Result<()> {
        let mut left = n;
        while left > 0 {
            let piece = left.min(1 << 16);
            let start = out.len();
            out.resize(start + piece, 0);
            self.fill(&mut out[start..], false)?;
            left -= piece;
        }
        Ok(())
    }
}
