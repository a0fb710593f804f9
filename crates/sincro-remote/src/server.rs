//! The server: a session, its ports and its threads.

use std::fmt;
use std::io::ErrorKind;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use sincro_access::Guard;
use sincro_coppelia::api::LegacyPorts;
use sincro_coppelia::session::Session;

use crate::hub::{Event, Hub, HubOptions, OpenPort};
use crate::limits::Deadlines;
use crate::{legacy, listen, ws, zmq};

/// Events that wait to be taken.
const EVENTS: usize = 1_024;

/// Options of a [`Server`]. By default it serves all three remote APIs on loopback at the ports of V-REP and
/// CoppeliaSim, as fast as it can.
#[derive(Clone, Debug)]
pub struct Options {
    /// Address to listen on; loopback by default, so that no other machine reaches it.
    pub bind: IpAddr,
    /// TCP ports of the legacy API, 0 for any free one; empty: it is not served.
    pub legacy: Vec<u16>,
    /// TCP port of the ZeroMQ API, the one after it for its version 1, 0 for any free ones; none: it is not served.
    pub zmq: Option<u16>,
    /// TCP port of the WebSocket API, 0 for any free one; none: it is not served.
    pub ws: Option<u16>,
    /// True if the simulation runs no faster than the clock when no client steps it.
    pub real_time: bool,
    /// Time after which a silent client that holds the simulation is released; 10 min by default.
    pub client_timeout: Duration,
    /// Deadlines of connections; one that misses them is closed.
    pub deadlines: Deadlines,
    /// True to serve the legacy and the ZeroMQ API beyond loopback although their clients cannot authenticate: whoever
    /// reaches the ports may then drive the simulation.
    pub unauthenticated: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            bind: Ipv4Addr::LOCALHOST.into(),
            legacy: vec![19997, 19999],
            zmq: Some(23000),
            ws: Some(23050),
            real_time: false,
            client_timeout: Duration::from_secs(600),
            deadlines: Deadlines::default(),
            unauthenticated: false,
        }
    }
}

impl Options {
    /// Refuses to open ports to other machines that do not authenticate their clients, unless that is what the user
    /// asks for.
    fn check(&self) -> Result<(), ServeError> {
        let has_open = !self.legacy.is_empty() || self.zmq.is_some();
        if !has_open && self.ws.is_none() {
            return Err(ServeError {
                message: "no port is left to be served".into(),
                help: "leave out one of --no-legacy, --no-zmq and --no-ws".into(),
            });
        }
        if self.zmq == Some(u16::MAX) {
            return Err(ServeError {
                message: format!("port {} leaves none after it for clients of version 1", u16::MAX),
                help: "take a smaller one with --zmq-port".into(),
            });
        }
        if self.bind.is_loopback() || self.unauthenticated || !has_open {
            return Ok(());
        }
        Err(ServeError {
            message: format!(
                "on {} everybody who reaches this machine could drive the simulation: clients of the legacy and the ZeroMQ API have no password",
                self.bind
            ),
            help: "add --unauthenticated if that is meant (a closed network), serve only WebSocket, which has a token (--no-legacy --no-zmq), or \
                   stay on loopback and forward the ports (ssh -L 23000:127.0.0.1:23000 HOST)"
                .into(),
        })
    }
}

/// Error of [`Server::start`]: the first port or option that keeps the server from starting.
#[derive(Debug)]
pub struct ServeError {
    /// Reason, with the port or address.
    pub message: String,
    /// Remedy, with the options of `sincro serve`.
    pub help: String,
}

impl fmt::Display for ServeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}

impl std::error::Error for ServeError {}

/// Addresses (IP address and TCP port) that a [`Server`] listens on; ports that were given as 0 are the ones it got.
#[derive(Clone, Debug, Default)]
pub struct Ports {
    /// Addresses of the legacy API, in the order of the options; empty if it is not served.
    pub legacy: Vec<SocketAddr>,
    /// Address of the ZeroMQ API; none if it is not served.
    pub zmq: Option<SocketAddr>,
    /// Address of its step counter, for clients of version 1; none if it is not served.
    pub zmq_steps: Option<SocketAddr>,
    /// Address of the WebSocket API; none if it is not served.
    pub ws: Option<SocketAddr>,
}

/// Server of the remote APIs of V-REP and CoppeliaSim over one session; it serves in threads of its own until it is
/// dropped.
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// use sincro_coppelia::session::Session;
/// use sincro_remote::{Options, Server};
///
/// let session = Session::open(&scene, &[], Default::default(), None)?;
/// // the ZeroMQ API alone, on free ports of loopback
/// let server = Server::start(session, &Options { legacy: Vec::new(), zmq: Some(0), ws: None, ..Options::default() })?;
/// assert!(server.ports().zmq.is_some_and(|address| address.ip().is_loopback()));
/// assert_eq!(server.hub().enter().n_clients(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Server {
    hub: Arc<Hub>,
    ports: Ports,
    ws_guard: Option<Arc<Guard>>,
    threads: Vec<JoinHandle<()>>,
    script_ports: ScriptPorts,
    events: Receiver<Event>,
}

/// Ports that scripts have opened, with their threads.
type ScriptPorts = Arc<Mutex<Vec<(SocketAddr, JoinHandle<()>)>>>;

impl Server {
    /// Opens the ports and starts to serve a session; the simulation begins when a client starts it.
    ///
    /// # Errors
    ///
    /// No port is asked for, a port is in use or not allowed, the address is not one of this machine, no thread can be
    /// started, or ports without authentication would be open to other machines without [`Options::unauthenticated`].
    /// Nothing is served then; the error has a remedy.
    pub fn start(session: Session, options: &Options) -> Result<Self, ServeError> {
        options.check()?;
        let open = |port: u16, flag: &str| open(options.bind, port, flag);
        let legacy = options.legacy.iter().map(|p| open(*p, "--legacy-port")).collect::<Result<Vec<_>, _>>()?;
        let zmq = options.zmq.map(|p| open(p, "--zmq-port")).transpose()?;
        let steps =
            options.zmq.map(|p| open(if p == 0 { 0 } else { p.saturating_add(1) }, "--zmq-port")).transpose()?;
        let ws = options.ws.map(|p| open(p, "--ws-port")).transpose()?;
        let address = |l: &TcpListener| l.local_addr().expect("a listener has an address");
        let ports = Ports {
            legacy: legacy.iter().map(address).collect(),
            zmq: zmq.as_ref().map(address),
            zmq_steps: steps.as_ref().map(address),
            ws: ws.as_ref().map(address),
        };
        let (send, events) = sync_channel(EVENTS);
        let hub_options = HubOptions {
            real_time: options.real_time,
            client_timeout: options.client_timeout,
            deadlines: options.deadlines,
        };
        let hub = Hub::new(session, hub_options, send);
        let mut threads = Vec::new();
        let failed =
            |e| ServeError { message: format!("no thread can be started: {e}"), help: "close programs".into() };
        for listener in legacy {
            threads.push(listen::accept(listener, &hub, "legacy", legacy::serve).map_err(failed)?);
        }
        let publisher = zmq::Publisher::default();
        if let Some(listener) = zmq {
            let publisher = publisher.clone();
            let serve = move |connection, hub: &Arc<Hub>| zmq::serve(connection, hub, &publisher);
            threads.push(listen::accept(listener, &hub, "zmq", serve).map_err(failed)?);
        }
        if let Some(listener) = steps {
            let of_hub = publisher.clone();
            hub.enter().on_step(Box::new(move |step| of_hub.publish(step)));
            let serve = move |connection, hub: &Arc<Hub>| publisher.serve(connection, hub.deadlines().idle);
            threads.push(listen::accept(listener, &hub, "zmq steps", serve).map_err(failed)?);
        }
        let ws_guard = ports.ws.map(|address| Arc::new(Guard::for_api(address)));
        if let (Some(listener), Some(guard)) = (ws, ws_guard.clone()) {
            let serve = move |connection, hub: &Arc<Hub>| ws::serve(connection, hub, &guard);
            threads.push(listen::accept(listener, &hub, "ws", serve).map_err(failed)?);
        }
        let script_ports = ScriptPorts::default();
        open_for_scripts(&hub, &ports, options.bind, &script_ports);
        let of_run = hub.clone();
        let run =
            std::thread::Builder::new().name("simulation".into()).stack_size(listen::STACK).spawn(move || of_run.run());
        threads.push(run.map_err(failed)?);
        Ok(Self { hub, ports, ws_guard, threads, script_ports, events })
    }

    /// Addresses that the server listens on.
    #[must_use]
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// Link of the WebSocket API with its token, `ws://…/?token=…`: pages need the token everywhere, programs beyond
    /// loopback only. None if that API is not served.
    #[must_use]
    pub fn ws_link(&self) -> Option<String> {
        self.ws_guard.as_ref().map(|guard| guard.link("ws"))
    }

    /// Session behind its lock, for an owner that looks at it or acts on it beside the clients.
    #[must_use]
    pub fn hub(&self) -> &Arc<Hub> {
        &self.hub
    }

    /// Events for the owner, in their order: messages and runs that have ended. Take them regularly: while 1,024 of
    /// them wait, further messages are dropped, and of further runs the newest 64 are kept.
    #[must_use]
    pub fn events(&self) -> &Receiver<Event> {
        &self.events
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.hub.close();
        let ports = &self.ports;
        let all = ports.legacy.iter().chain(&ports.zmq).chain(&ports.zmq_steps).chain(&ports.ws);
        all.copied().for_each(listen::wake_listener);
        for (address, thread) in self.script_ports.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
            listen::wake_listener(address);
            let _ = thread.join();
        }
        for thread in self.threads.drain(..) {
            // a thread that panicked has said so
            let _ = thread.join();
        }
    }
}

/// Lets scripts open ports of the legacy API (`simRemoteApi.start`), where that is served at all.
fn open_for_scripts(hub: &Arc<Hub>, ports: &Ports, bind: IpAddr, opened: &ScriptPorts) {
    let (legacy, weak, opened) = (ports.legacy.clone(), Arc::downgrade(hub), opened.clone());
    let known = LegacyPorts::new(legacy.iter().map(SocketAddr::port));
    let open_port: OpenPort = Box::new(move |port| {
        let mut opened = opened.lock().unwrap_or_else(PoisonError::into_inner);
        let is_open = legacy.iter().chain(opened.iter().map(|(address, _)| address)).any(|a| a.port() == port);
        if is_open {
            return Ok(format!("port {port} of the legacy remote API is open"));
        }
        let refused =
            |why: &str| Err(format!("port {port} of the legacy remote API is not opened for a script: {why}"));
        // seen under the lock of `opened`: what is pushed then is joined when the server is dropped
        let Some(hub) = weak.upgrade().filter(|hub| !hub.is_closing()) else {
            return refused("the server is being closed");
        };
        let listener = match open(bind, port, "--legacy-port") {
            Ok(listener) => listener,
            Err(error) => return refused(&error.message),
        };
        let Ok(address) = listener.local_addr() else { return refused("it has no address") };
        match listen::accept(listener, &hub, "legacy", legacy::serve) {
            Ok(thread) => opened.push((address, thread)),
            Err(error) => return refused(&error.to_string()),
        }
        Ok(format!("port {port} of the legacy remote API was opened for a script"))
    });
    hub.enter().on_port(known, open_port);
}

/// A listener; the standard library sets `SO_REUSEADDR` where a port would else stay taken after the last server has
/// ended.
fn open(bind: IpAddr, port: u16, flag: &str) -> Result<TcpListener, ServeError> {
    TcpListener::bind((bind, port)).map_err(|e| match e.kind() {
        ErrorKind::AddrInUse => ServeError {
            message: format!("port {port} is in use on {bind}"),
            help: format!("another simulator may be running: end it, or take another port with {flag}"),
        },
        ErrorKind::AddrNotAvailable => ServeError {
            message: format!("{bind} is no address of this machine"),
            help: "give one that is with --bind, or 0.0.0.0 for all".into(),
        },
        ErrorKind::PermissionDenied => ServeError {
            message: format!("port {port} is not allowed for this user"),
            help: format!("take one above 1023 with {flag}"),
        },
        _ => ServeError {
            message: format!("port {port} on {bind} cannot be opened: {e}"),
            help: format!("see {flag} and --bind"),
        },
    })
}
