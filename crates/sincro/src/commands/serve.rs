//! `sincro serve`: a scene for clients of V-REP and CoppeliaSim.

use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use crate::extensions::extensions;
use clap::Args;
use sincro_coppelia::session::{Files, Finished, Grants, Session};
use sincro_remote::hub::Event;
use sincro_remote::{Options, Server};
use sincro_sim::campaign::judge;
use sincro_sim::file::FileError;
use sincro_sim::results::Status;

use super::console;
use super::run::{interrupt, parse_settings, scene_name};
use crate::{Exit, diagnostics, present};

/// How often it is looked whether to end, and what is attached.
const GLANCE: Duration = Duration::from_millis(250);
/// How often speed is told on a terminal.
const TELL: Duration = Duration::from_secs(5);

/// What `serve` takes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
    scene: PathBuf,
    /// Set a number of the scene (/link.mass=2) or of the experiment (parameters.m=3); may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Port of the legacy remote API; may be repeated, 0 takes any free one [default: 19997 and 19999]
    #[arg(long, value_name = "PORT")]
    legacy_port: Vec<u16>,
    /// Port of the ZeroMQ remote API; the one after it is for clients of version 1
    #[arg(long, value_name = "PORT", default_value_t = 23000)]
    zmq_port: u16,
    /// Port of the WebSocket remote API
    #[arg(long, value_name = "PORT", default_value_t = 23050)]
    ws_port: u16,
    /// Address to listen on; 0.0.0.0 lets other machines in
    #[arg(long, value_name = "ADDR", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Step of the clients `[s]`, V-REP's simulation time step [default: simulation_step of the experiment]
    #[arg(long, value_name = "S", alias = "client-step")]
    simulation_step: Option<f64>,
    /// Let clients do what they may not by themselves: send files and load scenes from them, run texts in the scene's scripts; may be repeated
    #[arg(long, value_enum, value_name = "WHAT")]
    grant: Vec<Grant>,
    /// Run no faster than the clock when no client steps
    #[arg(long)]
    real_time: bool,
    /// A client that steps and stays silent for so long is let go `[s]`
    #[arg(long, value_name = "S", default_value_t = 600.0)]
    client_timeout: f64,
    /// Where the runs go, each in a folder run-1, run-2 … [default: results/SCENE-served]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What clients may be let do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Grant {
    /// Send files to a folder beside the runs, and load scenes from it.
    Files,
    /// Run texts in the scene's scripts.
    Scripts,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let (mut session, options) = match prepare(arguments) {
        Ok(prepared) => prepared,
        Err(exit) => return exit,
    };
    let name = scene_name(&arguments.scene);
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("results").join(format!("{name}-served")));
    session.grant(Grants {
        files: arguments.grant.contains(&Grant::Files).then(|| Files::new(out.join("received"))),
        evaluation: arguments.grant.contains(&Grant::Scripts),
    });
    diagnostics::print_problems(&session.loaded().warnings);
    let title = session.loaded().experiment.title.clone();
    let server = match Server::start(session, &options) {
        Ok(server) => server,
        Err(error) => return diagnostics::refuse(&error.message, Some(&error.help)),
    };
    print_ports(&title, &server);
    let interrupt = interrupt();
    let mut watch = Watch { out, n_runs: 0, clients: 0, told: Instant::now(), step: 0 };
    while !interrupt.load(Ordering::Relaxed) {
        match server.events().recv_timeout(GLANCE) {
            Ok(event) => watch.event(event),
            Err(RecvTimeoutError::Timeout) => watch.glance(&server),
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    // a run that is on is ended and kept
    let _ = server.hub().enter().act(Session::stop);
    while let Ok(event) = server.events().try_recv() {
        watch.event(event);
    }
    Exit::Holds
}

fn prepare(arguments: &Arguments) -> Result<(Session, Options), Exit> {
    let overrides = parse_settings(&arguments.set).map_err(|p| diagnostics::refuse_problems(&p))?;
    let session = Session::open(&arguments.scene, &overrides, extensions(), arguments.simulation_step);
    let session = session.map_err(|problems| diagnostics::refuse_problems(&problems))?;
    let patience = Duration::try_from_secs_f64(arguments.client_timeout).ok().filter(|d| !d.is_zero());
    let Some(patience) = patience else {
        let message = format!("--client-timeout {} is no time", arguments.client_timeout);
        return Err(diagnostics::refuse(&message, Some("give seconds above 0")));
    };
    let legacy = if arguments.legacy_port.is_empty() { vec![19997, 19999] } else { arguments.legacy_port.clone() };
    let options = Options {
        bind: arguments.bind,
        legacy,
        zmq: Some(arguments.zmq_port),
        ws: Some(arguments.ws_port),
        real_time: arguments.real_time,
        patience,
    };
    Ok((session, options))
}

fn print_ports(title: &str, server: &Server) {
    let list = |all: &[SocketAddr]| all.iter().map(SocketAddr::to_string).collect::<Vec<_>>().join(", ");
    let ports = server.ports();
    let dt = server.hub().enter().session.table().sample_time();
    say!("{title}");
    say!("  legacy remote API   {}", list(&ports.legacy));
    say!("  ZeroMQ remote API   {} (step counter {})", list(ports.zmq.as_slice()), list(ports.zmq_steps.as_slice()));
    say!("  WebSocket           {}", list(ports.ws.as_slice()));
    say!("  one step of a client is {} s; Ctrl-C ends", console::short(dt));
}

/// What is told, and the runs that are kept.
struct Watch {
    out: PathBuf,
    n_runs: usize,
    clients: usize,
    told: Instant,
    step: u64,
}

impl Watch {
    fn event(&mut self, event: Event) {
        match event {
            Event::Log(level, text) if level <= 300 => eprintln!("warning: {text}"),
            Event::Log(_, text) => say!("  {text}"),
            Event::Finished(finished) => self.keep(*finished),
        }
    }

    /// Who is attached, and how fast it goes.
    fn glance(&mut self, server: &Server) {
        let mut floor = server.hub().enter();
        let (clients, step, t) = (floor.n_clients(), floor.steps(), floor.session.t());
        let runs = floor.session.phase() != sincro_coppelia::session::Phase::Stopped;
        drop(floor);
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
        self.n_runs += 1;
        let out = self.out.join(format!("run-{}", self.n_runs));
        let (n, t) = (finished.steps, finished.simulated.table.times().last().copied().unwrap_or(0.0));
        let hash = finished.simulated.trace;
        let how = match &finished.simulated.status {
            Status::Stopped { reason, .. } => format!("stopped: {reason}"),
            Status::Ended { reason, .. } => format!("ended: {reason}"),
            Status::Completed | Status::Interrupted { .. } => "ended".to_owned(),
        };
        match write(&finished, &out) {
            Ok(()) => say!(
                "  run {} {how} after {} of clients, {} s recorded, trace {hash}: {}",
                self.n_runs,
                diagnostics::count(n as usize, "step"),
                console::short(t),
                out.join("report.html").display()
            ),
            Err(error) => eprintln!("error: {error}"),
        }
    }
}

/// The run as any other: signals, `run.json`, figures, report.
fn write(finished: &Finished, out: &Path) -> Result<(), FileError> {
    sincro_sim::file::prepare(out)?;
    let loaded = &finished.loaded;
    let folder = loaded.experiment.scene_path.parent().unwrap_or(Path::new("."));
    finished.simulated.table.write_csv(&out.join("signals.csv"))?;
    let campaign = judge(folder, loaded, finished.simulated.clone());
    campaign.report.write(out)?;
    present::write(loaded, &campaign, out, None)
}
