//! Sessions of temporary scene folders, and servers of them on loopback.

use std::ops::{Deref, DerefMut};
use std::path::Path;
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::Duration;

use sincro_coppelia::session::{Finished, Session};
use sincro_remote::hub::Event;
use sincro_remote::{Options, ServeError, Server};
use sincro_scene::overrides::Override;
use sincro_sim::Extensions;

use crate::folder::SceneFolder;

/// A session together with the temporary folder that it was opened from. It dereferences to the session.
pub struct OpenSession {
    session: Session,
    folder: SceneFolder,
}

impl OpenSession {
    /// Opens a session with settings; panics with the diagnostics.
    #[must_use]
    pub fn open(folder: SceneFolder, overrides: &[Override], extensions: Extensions, sample_time: Option<f64>) -> Self {
        let session = Session::open(&folder, overrides, extensions, sample_time);
        Self { session: session.unwrap_or_else(|diagnostics| panic!("{diagnostics}")), folder }
    }

    /// Serves the session; panics with the error.
    #[must_use]
    pub fn serve(self, options: &Options) -> ServedSession {
        self.try_serve(options).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Serves the session.
    ///
    /// # Errors
    ///
    /// Those of [`Server::start`].
    pub fn try_serve(self, options: &Options) -> Result<ServedSession, ServeError> {
        Ok(ServedSession { server: Server::start(self.session, options)?, folder: self.folder })
    }
}

impl Deref for OpenSession {
    type Target = Session;

    fn deref(&self) -> &Session {
        &self.session
    }
}

impl DerefMut for OpenSession {
    fn deref_mut(&mut self) -> &mut Session {
        &mut self.session
    }
}

/// A server together with the temporary folder of its scene. It dereferences to the server.
pub struct ServedSession {
    server: Server,
    folder: SceneFolder,
}

impl ServedSession {
    /// The scene's folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

impl Deref for ServedSession {
    type Target = Server;

    fn deref(&self) -> &Server {
        &self.server
    }
}

/// Options of a server on loopback: every protocol on a free port, no client timeout that a slow machine would reach.
#[must_use]
pub fn options() -> Options {
    let client_timeout = Duration::from_secs(600);
    Options { legacy: vec![0], zmq: Some(0), ws: Some(0), client_timeout, ..Options::default() }
}

/// Waits for the next run that ends.
#[must_use]
pub fn finished(server: &Server) -> Finished {
    loop {
        if let Event::Finished(finished) = server.events().recv_timeout(Duration::from_secs(60)).unwrap() {
            return *finished;
        }
    }
}

/// Port of this machine that is free now, and stays so: it lies below those that the system gives to servers which ask
/// for any, and no other test of this process gets it.
///
/// # Panics
///
/// If all ports of the range are taken.
#[must_use]
pub fn free_port() -> u16 {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    let first = std::process::id() % 10_000;
    let next = |_| {
        let next = u32::from(NEXT.fetch_add(1, Ordering::Relaxed));
        20_000 + ((first * 7 + next) % 10_000) as u16
    };
    let is_free = |port: &u16| std::net::TcpListener::bind(("127.0.0.1", *port)).is_ok();
    (0..10_000).map(next).find(is_free).expect("a port between 20000 and 29999 is free")
}
