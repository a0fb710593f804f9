//! A TCP stream whose writes must make progress: what waits to be taken is taken within a deadline, or the stream
//! fails.

use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Sleep, sleep};

/// Time from the instant at which a peer stops taking bytes to the one at which it has taken all that waits.
const WRITE: Duration = Duration::from_secs(10);

/// See the head of this file.
pub(super) struct TimedStream {
    stream: TcpStream,
    /// Deadline of what waits to be written; none while nothing does.
    deadline: Option<Pin<Box<Sleep>>>,
}

impl TimedStream {
    /// Puts a stream under the deadline.
    pub fn new(stream: TcpStream) -> Self {
        Self { stream, deadline: None }
    }

    /// Fails once the deadline has passed; starts it if none runs.
    fn poll_deadline(&mut self, context: &mut Context<'_>) -> Poll<io::Error> {
        let deadline = self.deadline.get_or_insert_with(|| Box::pin(sleep(WRITE)));
        ready!(deadline.as_mut().poll(context));
        Poll::Ready(io::ErrorKind::TimedOut.into())
    }
}

impl AsyncRead for TimedStream {
    fn poll_read(self: Pin<&mut Self>, context: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for TimedStream {
    fn poll_write(self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        // part of it being taken does not put the deadline off
        if this.deadline.is_some()
            && let Poll::Ready(error) = this.poll_deadline(context)
        {
            return Poll::Ready(Err(error));
        }
        match Pin::new(&mut this.stream).poll_write(context, bytes) {
            Poll::Pending => this.poll_deadline(context).map(Err),
            done => done,
        }
    }

    /// Called when all that waited was written: the deadline ends.
    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        let flushed = ready!(Pin::new(&mut this.stream).poll_flush(context));
        this.deadline = None;
        Poll::Ready(flushed)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}
