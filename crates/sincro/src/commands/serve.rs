//! `sincro serve`: a scene for clients of V-REP and CoppeliaSim.

use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use clap::Args;
use sincro::scene_name;
use sincro::serve::{ArchiveLevel, ArchivedRun, Deadlines, Event, Options, RunArchive, Server, open, received_folder};
use sincro_access::printable;
use sincro_coppelia::session::{Files, Finished, Grants, Session};
use sincro_sim::results::Status;

use super::console;
use super::robot_file::SceneSource;
use super::run::{interrupt, parse_settings};
use crate::{Exit, diagnostics};

/// Interval at which interrupts and new clients are polled.
const POLL_INTERVAL: Duration = Duration::from_millis(250);
/// Time that scripts have for what they do last when the server is ended; then they are stopped.
const LAST_CALL: Duration = Duration::from_secs(5);
/// Interval at which the speed is printed on a terminal.
const TELL: Duration = Duration::from_secs(5);

/// Arguments of `serve`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
    scene: PathBuf,
    /// Set a number of the scene (/link.mass=2) or of the experiment (parameters.m=3); may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Port of the legacy remote API; may be repeated, 0 takes any free one [default: 19997 and 19999]
    #[arg(long, value_name = "PORT")]
    legacy_port: Vec<u16>,
    /// Do not serve the legacy remote API
    #[arg(long, conflicts_with = "legacy_port")]
    no_legacy: bool,
    /// Port of the ZeroMQ remote API; the one after it is for clients of version 1
    #[arg(long, value_name = "PORT", default_value_t = 23000)]
    zmq_port: u16,
    /// Do not serve the ZeroMQ remote API
    #[arg(long, conflicts_with = "zmq_port")]
    no_zmq: bool,
    /// Port of the WebSocket remote API
    #[arg(long, value_name = "PORT", default_value_t = 23050)]
    ws_port: u16,
    /// Do not serve the WebSocket remote API
    #[arg(long, conflicts_with = "ws_port")]
    no_ws: bool,
    /// Address to listen on; 0.0.0.0 lets other machines in, WebSocket with its token, the others with
    /// --unauthenticated
    #[arg(long, value_name = "ADDR", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Beyond loopback let everybody who reaches the legacy and ZeroMQ ports drive the simulation: their clients have
    /// no password
    #[arg(long)]
    unauthenticated: bool,
    /// Step of the clients `[s]`, V-REP's simulation time step [default: simulation_step of the experiment]
    #[arg(long, value_name = "S", alias = "client-step")]
    simulation_step: Option<f64>,
    /// Let clients do what they may not by themselves: send files and load scenes from them, run texts in the scene's
    /// scripts; may be repeated
    #[arg(long, value_enum, value_name = "WHAT")]
    grant: Vec<Grant>,
    /// Run no faster than the clock when no client steps
    #[arg(long)]
    real_time: bool,
    /// Start the simulation at once, for clients that expect one that is running
    #[arg(long)]
    start: bool,
    /// A client that steps and stays silent for so long is let go `[s]`
    #[arg(long, value_name = "S", default_value_t = 600.0)]
    client_timeout: f64,
    /// A connection that says nothing for so long is closed `[s]`
    #[arg(long, value_name = "S", default_value_t = 3600.0)]
    idle_timeout: f64,
    /// Extent of what is written of each run
    #[arg(long, value_enum, value_name = "WHAT", default_value = "full")]
    record: RecordFlag,
    /// Number of runs that are kept; then the oldest one is deleted
    #[arg(long, value_name = "N", default_value = "100", value_parser = count)]
    keep: NonZeroUsize,
    /// Folder of the runs, each in a folder run-1, run-2 … of its own [default: results/SCENE-served]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Values of `--record`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum RecordFlag {
    /// Nothing.
    None,
    /// signals.csv and run.json.
    Signals,
    /// As `sincro run`: figures, replay and report too.
    Full,
}

impl From<RecordFlag> for ArchiveLevel {
    fn from(flag: RecordFlag) -> Self {
        match flag {
            RecordFlag::None => Self::None,
            RecordFlag::Signals => Self::Signals,
            RecordFlag::Full => Self::Full,
        }
    }
}

/// Permissions that clients can be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Grant {
    /// Send files to a folder beside the runs, and load scenes from it.
    Files,
    /// Run texts in the scene's scripts.
    Scripts,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let source = match SceneSource::open(&arguments.scene) {
        Ok(source) => source,
        Err(exit) => return exit,
    };
    let (mut session, options) = match prepare(arguments, source.folder()) {
        Ok(prepared) => prepared,
        Err(exit) => return exit,
    };
    let name = scene_name(source.folder());
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("results").join(format!("{name}-served")));
    session.grant(Grants {
        files: arguments.grant.contains(&Grant::Files).then(|| Files::new(received_folder(&out))),
        evaluation: arguments.grant.contains(&Grant::Scripts),
    });
    diagnostics::print_diagnostics(&session.loaded().warnings);
    let title = session.loaded().experiment.title.clone();
    let server = match Server::start(session, &options) {
        Ok(server) => server,
        Err(error) => return diagnostics::refuse(&error.message, Some(&error.help)),
    };
    // once the ports are open: scripts may open further ones
    let started = if arguments.start { server.hub().enter().act(Session::start) } else { Ok(()) };
    if let Err(error) = started {
        return diagnostics::refuse(&error.0, None);
    }
    print_ports(&title, &server);
    let interrupt = interrupt();
    let recorder = RunArchive::new(out, arguments.record.into(), arguments.keep);
    let mut watch = Watch { recorder, clients: 0, told: Instant::now(), step: 0 };
    while !interrupt.load(Ordering::Relaxed) {
        match server.events().recv_timeout(POLL_INTERVAL) {
            Ok(event) => watch.event(event),
            Err(RecvTimeoutError::Timeout) => watch.poll(&server),
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    // a run that is on is ended and kept, unless a script that does not return holds it
    std::thread::spawn(|| {
        std::thread::sleep(LAST_CALL);
        sincro::abort_running_scripts();
    });
    match server.hub().try_enter(2 * LAST_CALL) {
        Some(mut guard) => drop(guard.act(Session::close)),
        None => {
            eprintln!("error: the simulation does not answer; the run that is on is lost");
            std::process::exit(3);
        }
    }
    while let Ok(event) = server.events().try_recv() {
        watch.event(event);
    }
    Exit::Holds
}

fn prepare(arguments: &Arguments, scene: &Path) -> Result<(Session, Options), Exit> {
    let overrides = parse_settings(&arguments.set).map_err(|p| diagnostics::refuse_diagnostics(&p))?;
    let session = open(scene, &overrides, arguments.simulation_step);
    let session = session.map_err(|found| diagnostics::refuse_diagnostics(&found))?;
    let client_timeout = seconds("--client-timeout", arguments.client_timeout)?;
    let idle = seconds("--idle-timeout", arguments.idle_timeout)?;
    let legacy = match arguments.legacy_port.as_slice() {
        _ if arguments.no_legacy => Vec::new(),
        [] => vec![19997, 19999],
        ports => ports.to_vec(),
    };
    let options = Options {
        bind: arguments.bind,
        legacy,
        zmq: (!arguments.no_zmq).then_some(arguments.zmq_port),
        ws: (!arguments.no_ws).then_some(arguments.ws_port),
        real_time: arguments.real_time,
        client_timeout,
        deadlines: Deadlines { idle, ..Deadlines::default() },
        unauthenticated: arguments.unauthenticated,
    };
    Ok((session, options))
}

/// A number of runs, at least one.
fn count(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "expected a whole number from 1 on; `--record none` keeps no run".to_owned())
}

/// The value of a flag as a time above zero.
fn seconds(flag: &str, value: f64) -> Result<Duration, Exit> {
    Duration::try_from_secs_f64(value)
        .ok()
        .filter(|time| !time.is_zero())
        .ok_or_else(|| diagnostics::refuse(&format!("{flag} {value} is no time"), Some("give seconds above 0")))
}

fn print_ports(title: &str, server: &Server) {
    let list = |all: &[SocketAddr]| all.iter().map(SocketAddr::to_string).collect::<Vec<_>>().join(", ");
    let ports = server.ports();
    let dt = server.hub().enter().session.registry().sample_time();
    say!("{title}");
    if !ports.legacy.is_empty() {
        say!("  legacy remote API   {}", list(&ports.legacy));
    }
    if let (Some(zmq), Some(steps)) = (ports.zmq, ports.zmq_steps) {
        say!("  ZeroMQ remote API   {zmq} (step counter {steps})");
    }
    if let (Some(ws), Some(link)) = (ports.ws, server.ws_link()) {
        say!("  WebSocket           {ws}");
        say!("    from a web page   {link}");
    }
    say!("  one step of a client is {} s; Ctrl-C ends", console::short(dt));
}

/// State of the terminal output, and count of the runs that were written.
struct Watch {
    recorder: RunArchive,
    clients: usize,
    told: Instant,
    step: u64,
}

impl Watch {
    fn event(&mut self, event: Event) {
        match event {
            Event::Log(level, text) if level <= 300 => eprintln!("warning: {}", printable(&text)),
            Event::Log(_, text) => say!("  {}", printable(&text)),
            Event::Finished(finished) => self.keep(*finished),
        }
    }

    /// Prints changes of the number of clients, and the speed.
    fn poll(&mut self, server: &Server) {
        // a script may hold it: then there is nothing new to tell
        let Some(mut guard) = server.hub().try_enter(POLL_INTERVAL) else { return };
        let (clients, step, t) = (guard.n_clients(), guard.steps(), guard.session.t());
        let runs = guard.session.phase() != sincro_coppelia::api::Phase::Stopped;
        drop(guard);
        if clients != self.clients {
            say!("  {} attached", diagnostics::count(clients, "client"));
            self.clients = clients;
        }
        let passed = self.told.elapsed();
        if passed >= TELL {
            let made = step.saturating_sub(self.step);
            if runs && std::io::stdout().is_terminal() {
                let rate = made as f64 / passed.as_secs_f64();
                say!("  t = {} s, {} steps/s", console::short(t), console::short(rate));
            }
            (self.told, self.step) = (Instant::now(), step);
        }
    }

    fn keep(&mut self, finished: Finished) {
        let (n, t) = (finished.steps, finished.simulated.table.times().last().copied().unwrap_or(0.0));
        let hash = finished.simulated.trace;
        let how = match &finished.simulated.status {
            Status::Stopped { reason, .. } => format!("stopped: {}", printable(reason)),
            Status::Ended { reason, .. } => format!("ended: {reason}"),
            Status::Completed | Status::Interrupted { .. } => "ended".to_owned(),
        };
        match self.recorder.store(&finished) {
            Ok(ArchivedRun { number, path }) => say!(
                "  run {number} {how} after {} of clients, {} s recorded, trace {hash}{}",
                diagnostics::count(n as usize, "step"),
                console::short(t),
                path.map_or_else(String::new, |path| format!(": {}", path.display()))
            ),
            Err(error) => eprintln!("error: {error}"),
        }
    }
}
