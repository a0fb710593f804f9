//! `sincro view`: a scene or a finished run in the browser.

use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

use clap::Args;
use sincro::view::{self, Server, ViewerContent};

use super::robot_file::SceneSource;
use super::run::parse_settings;
use crate::{Exit, diagnostics};

/// Arguments of `view`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of a scene or a robot file (URDF, SDF, MJCF), to run it live, or of a finished run, to replay it
    what: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Port to listen at [default: any free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Initial camera [default: its first one]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Address to listen at; 0.0.0.0 lets other machines in that have the link with its token
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Print the address and open no browser
    #[arg(long)]
    no_browser: bool,
}

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub(crate) struct ReplayArguments {
    /// Folder of a finished run
    run: PathBuf,
    /// Initial camera [default: its first one]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Port to listen at [default: any free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address and open no browser
    #[arg(long)]
    no_browser: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let source = match SceneSource::open(&arguments.what) {
        Ok(source) => source,
        Err(exit) => return exit,
    };
    let is_run = view::is_finished_run(&arguments.what);
    let show = if is_run { replay_of(&arguments.what) } else { live(arguments, source.folder()) };
    let address = SocketAddr::new(arguments.bind, arguments.port);
    show.map_or_else(|exit| exit, |show| serve(show, address, arguments.camera.as_deref(), arguments.no_browser))
}

/// Shows a finished run.
pub(crate) fn replay(arguments: &ReplayArguments) -> Exit {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, arguments.port));
    let show = replay_of(&arguments.run);
    show.map_or_else(|exit| exit, |show| serve(show, address, arguments.camera.as_deref(), arguments.no_browser))
}

fn replay_of(run: &Path) -> Result<ViewerContent, Exit> {
    view::replay(run).map_err(|error| diagnostics::refuse(&error.message, Some(error.help)))
}

fn live(arguments: &Arguments, scene: &Path) -> Result<ViewerContent, Exit> {
    let overrides =
        parse_settings(&arguments.set).map_err(|diagnostics| diagnostics::refuse_diagnostics(&diagnostics))?;
    view::live(scene, overrides).map_err(|diagnostics| diagnostics::refuse_diagnostics(&diagnostics))
}

fn serve(show: ViewerContent, address: SocketAddr, camera: Option<&str>, no_browser: bool) -> Exit {
    let camera = match camera.map(|name| view::camera(&show, name).map_err(|all| (name, all))).transpose() {
        Ok(camera) => camera,
        Err((name, all)) => return diagnostics::refuse_camera(name, &all),
    };
    let server = match Server::bind(address, show) {
        Ok(server) => server,
        Err(error) => {
            let message = format!("cannot listen at {address}: {error}");
            return diagnostics::refuse(&message, Some("take another --port, or leave it out for any free one"));
        }
    };
    let fragment = camera.map_or_else(String::new, |path| format!("#camera={path}"));
    say!("{}{fragment}", server.url());
    if std::io::stdout().is_terminal() {
        eprintln!("Ctrl-C ends it");
        if !no_browser {
            // other users of the machine can read a command line: what stands in it works once
            open_browser(&format!("{}{fragment}", server.single_use_url()));
        }
    }
    match server.run() {
        Ok(()) => Exit::Holds,
        Err(error) => diagnostics::refuse(&format!("the server failed: {error}"), None),
    }
}

/// Asks the desktop to show an address; who has none reads it on the terminal.
fn open_browser(url: &str) {
    let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let quiet = std::process::Stdio::null;
    let _ = std::process::Command::new(opener).arg(url).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn();
}
