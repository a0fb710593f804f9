//! Connections of viewers: accepted within limits, and closed when their heads do not come.

use std::io;
use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::Request;
use axum::{Extension, Router};
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use sincro_access::{ConnectionLimits, Connections, Permit};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Notify;
use tokio::time::sleep;
use tower_service::Service;

use super::timed_stream::TimedStream;

/// Connections at once: a page takes about six while it loads and one afterwards.
const LIMITS: ConnectionLimits =
    ConnectionLimits { total: 128, per_address: 64, idle_under_pressure: Duration::from_secs(30) };

/// Tries to find a slot for a newcomer.
const MAX_TRIES: usize = 3;

/// Time that the head of a request may take, the wait for its first byte included.
const HEAD: Duration = Duration::from_secs(10);

/// One connection: its slot, and the signal that it must give it up.
pub(super) struct Line {
    permit: Permit,
    must_close: Arc<Notify>,
}

impl Line {
    /// Notes that a whole message has come.
    pub fn mark_message(&self) {
        self.permit.mark_message();
    }

    /// Completes when the connection must be closed.
    pub async fn closed(&self) {
        self.must_close.notified().await;
    }
}

/// Accepts connections until the process ends.
///
/// # Errors
///
/// None: a connection that cannot be accepted is left out.
pub(super) async fn accept(listener: TcpListener, router: Router) -> io::Result<()> {
    let connections = Connections::new(LIMITS);
    loop {
        let Ok((stream, peer)) = listener.accept().await else {
            // out of file descriptors, say: others must close first
            sleep(Duration::from_millis(100)).await;
            continue;
        };
        let must_close = Arc::new(Notify::new());
        let Some(permit) = admit(&connections, peer.ip(), &must_close).await else { continue };
        tokio::spawn(serve(stream, Arc::new(Line { permit, must_close }), router.clone()));
    }
}

/// Takes a slot; those who must make room for it are given the time to.
async fn admit(connections: &Arc<Connections>, peer: IpAddr, must_close: &Arc<Notify>) -> Option<Permit> {
    for _ in 0..MAX_TRIES {
        let close = must_close.clone();
        let permit = connections.admit(peer, move || close.notify_one());
        // one that was told to close does so now
        tokio::task::yield_now().await;
        if permit.is_some() {
            return permit;
        }
    }
    None
}

/// Serves one connection until it ends; after an upgrade the WebSocket holds the line.
async fn serve(stream: TcpStream, line: Arc<Line>, router: Router) {
    let router: Router = router.layer(Extension(line.clone()));
    let service = service_fn(move |request: Request<Incoming>| router.clone().call(request.map(Body::new)));
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(HEAD);
    let connection = http.serve_connection(TokioIo::new(TimedStream::new(stream)), service).with_upgrades();
    tokio::select! {
        // an error is the peer's: it is gone
        _ = connection => {}
        () = line.closed() => {}
    }
}
