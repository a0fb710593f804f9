//! Sessions of temporary scene folders, and servers of them on loopback.

use std::ops::{Deref, DerefMut};
use std::path::Path;
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
