//! `sincro view`: a scene or a finished run in the browser.

use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

use clap::Args;
use sincro_viewer::film::FORMAT;
use sincro_viewer::live::{Engine, Source};
use sincro_viewer::server::{Server, Show};

use super::run::{parse_settings, scene_name};
use crate::extensions::extensions;
use crate::{Exit, diagnostics};

/// What `view` takes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of a scene, to run it live, or of a finished run, to look at it again
    what: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Port to listen at [default: any free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Camera of the scene to begin with [default: its first one]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Address to listen at; beyond this machine the page's address has a token
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Print the address and open no browser
    #[arg(long)]
    no_browser: bool,
}

/// What `replay` takes.
#[derive(Debug, Args)]
pub(crate) struct ReplayArguments {
    /// Folder of a finished run
    run: PathBuf,
    /// Camera of the scene to begin with [default: its first one]
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
    let is_run = arguments.what.join("replay.json").is_file() && !arguments.what.join("experiment.toml").is_file();
    let show = if is_run { replay_of(&arguments.what) } else { live(arguments) };
    let address = SocketAddr::new(arguments.bind, arguments.port);
    show.map_or_else(|exit| exit, |show| serve(show, address, arguments.camera.as_deref(), arguments.no_browser))
}

/// Shows a finished run.
pub(crate) fn replay(arguments: &ReplayArguments) -> Exit {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, arguments.port));
    let show = replay_of(&arguments.run);
    show.map_or_else(|exit| exit, |show| serve(show, address, arguments.camera.as_deref(), arguments.no_browser))
}

/// The path of a camera of what is shown, named by it or by its last part.
fn camera_of(show: &Show, name: &str) -> Result<String, Exit> {
    let cameras = show.cameras();
    let found = cameras.iter().find(|path| *path == name || path.rsplit('/').next() == Some(name));
    found.cloned().ok_or_else(|| {
        let help = match cameras.as_slice() {
            [] => "the scene has none: add a [[camera]] to it".to_owned(),
            _ => format!("cameras here: {}", cameras.join(", ")),
        };
        diagnostics::refuse(&format!("there is no camera `{name}`"), Some(&help))
    })
}

fn replay_of(run: &Path) -> Result<Show, Exit> {
    let file = run.join("replay.json");
    let text = std::fs::read_to_string(&file).map_err(|e| {
        let message = format!("`{}` cannot be read: {e}", file.display());
        diagnostics::refuse(&message, Some("name the folder that `sincro run` wrote, such as results/SCENE"))
    })?;
    if !text.starts_with(&format!("{{\"format\":\"{FORMAT}\"")) {
        let message = format!("`{}` is no replay that this version of sincro shows", file.display());
        return Err(diagnostics::refuse(&message, Some("run the scene again with this version")));
    }
    Ok(Show::Film(text.into()))
}

fn live(arguments: &Arguments) -> Result<Show, Exit> {
    let settings = parse_settings(&arguments.set).map_err(|problems| diagnostics::refuse_problems(&problems))?;
    let world = scene_name(&arguments.what);
    let draw = Box::new(move |controller: &_| super::draw::drawing(controller, "", &world, true));
    let engine = Engine::open(Source { folder: arguments.what.clone(), settings, extensions: extensions(), draw })
        .map_err(|problems| diagnostics::refuse_problems(&problems))?;
    let board = engine.board();
    Ok(Show::Live(board, engine.start()))
}

fn serve(show: Show, address: SocketAddr, camera: Option<&str>, no_browser: bool) -> Exit {
    let camera = match camera.map(|name| camera_of(&show, name)).transpose() {
        Ok(camera) => camera,
        Err(exit) => return exit,
    };
    let server = match Server::bind(address, show) {
        Ok(server) => server,
        Err(error) => {
            let message = format!("cannot listen at {address}: {error}");
            return diagnostics::refuse(&message, Some("take another --port, or leave it out for any free one"));
        }
    };
    let url = camera.map_or_else(|| server.url(), |path| format!("{}#camera={path}", server.url()));
    say!("{url}");
    if std::io::stdout().is_terminal() {
        eprintln!("Ctrl-C ends it");
        if !no_browser {
            open_browser(&url);
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
