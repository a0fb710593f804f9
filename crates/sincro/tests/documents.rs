//! The README, the tutorial and the how-to pages do what they say: their files are written, their commands run.
//!
//! A line that is a path in backquotes and a colon names the file of the fenced block behind it. In a block of the kind
//! `console` every line that begins with `$ sincro` is run in the folder of the page, in order, and must end with
//! status 0, or with N where the line ends with `# exit N`. Commands that serve (`view`, `serve`, `replay`) must say
//! where, and are then ended.
//! Commands of other programs are not run; they must be among those of [`FOREIGN`].

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;

use sincro_testing::{CommandLine, SceneFolder};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

/// Programs whose commands stand in the pages and are not run here.
const FOREIGN: [&str; 10] = ["cargo", "git", "tar", "sudo", "python3", "pip", "mdbook", "rustup", "cc", "./self-test"];

/// Pages whose commands are run.
const PAGES: [&str; 16] = [
    "tutorial.md",
    "from-vrep-simulink.md",
    "from-mujoco.md",
    "from-drake.md",
    "how-to/install.md",
    "how-to/robot.md",
    "how-to/parameters.md",
    "how-to/controller.md",
    "how-to/contact.md",
    "how-to/sensors.md",
    "how-to/compare.md",
    "how-to/linearize.md",
    "how-to/results.md",
    "how-to/script.md",
    "campaigns.md",
    "export-c.md",
];

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// A piece of a page that does something.
#[derive(Debug)]
enum Piece {
    File(String, String),
    Command(String),
}

/// The files and commands of a page, in order.
fn pieces(text: &str) -> Vec<Piece> {
    let (mut pieces, mut named, mut block): (Vec<Piece>, Option<String>, Option<(String, String)>) =
        (Vec::new(), None, None);
    for line in text.lines() {
        match (&mut block, line.strip_prefix("```")) {
            (None, Some(kind)) => block = Some((kind.to_owned(), String::new())),
            (Some(_), Some(_)) => {
                let (kind, content) = block.take().unwrap_or_default();
                match named.take() {
                    Some(name) => pieces.push(Piece::File(name, content)),
                    None if kind == "console" => {
                        let commands = content.lines().filter_map(|line| line.strip_prefix("$ "));
                        pieces.extend(commands.map(|command| Piece::Command(command.to_owned())));
                    }
                    None => {}
                }
            }
            (Some((_, content)), None) => {
                content.push_str(line);
                content.push('\n');
            }
            (None, None) if line.trim().is_empty() => {}
            (None, None) => {
                let name = line.strip_prefix('`').and_then(|rest| rest.strip_suffix("`:"));
                named = name.filter(|name| !name.contains('`')).map(str::to_owned);
            }
        }
    }
    pieces
}

/// Words of a command; quotes hold words together.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), String::new(), None);
    for c in command.chars() {
        match (c, quote) {
            ('\'' | '"', None) => quote = Some(c),
            (c, Some(q)) if c == q => quote = None,
            (' ', None) if !word.is_empty() => words.push(std::mem::take(&mut word)),
            (' ', None) => {}
            (c, _) => word.push(c),
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

fn run(page: &str, folder: &Path, command: &str) {
    let (line, status) = match command.rsplit_once("# exit ") {
        Some((line, status)) => (line.trim(), status.trim().parse().unwrap()),
        None => (command.trim(), 0),
    };
    let words = words(line);
    let (program, arguments) = words.split_first().unwrap();
    if program != "sincro" {
        assert!(FOREIGN.contains(&program.as_str()), "{page}: `{command}` is run by nobody");
        return;
    }
    let mut arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if ["view", "replay", "serve"].contains(&arguments[0]) {
        return serves(page, folder, &mut arguments);
    }
    let output = SINCRO.command(&arguments).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let said = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{page}: `{command}`\n{said}");
}

/// Starts a command that serves, reads where, ends it.
fn serves(page: &str, folder: &Path, arguments: &mut Vec<&str>) {
    let is_view = arguments[0] != "serve";
    let more: &[&str] =
        if is_view { &["--no-browser"] } else { &["--legacy-port", "0", "--zmq-port", "0", "--ws-port", "0"] };
    arguments.extend(more);
    let mut command = SINCRO.command(arguments);
    let mut child = command.current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn().unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
    let mark = if is_view { "http://" } else { "127.0.0.1" };
    let found = lines.take(6).any(|line| line.contains(mark));
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(found, "{page}: `{}` does not say where it serves", arguments.join(" "));
}

/// A folder in which the scenes of the project are at their place.
fn folder_with_scenes() -> SceneFolder {
    let folder = SceneFolder::new();
    let scenes = docs().join("../scenes").canonicalize().unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(&scenes, folder.join("scenes")).unwrap();
    #[cfg(windows)]
    std::os::windows::fs::symlink_dir(&scenes, folder.join("scenes")).unwrap();
    folder
}

/// Does everything that a page says, in a folder of its own.
fn follow(page: &str) {
    let folder = folder_with_scenes();
    let text = fs::read_to_string(docs().join(page)).unwrap();
    let pieces = pieces(&text);
    assert!(pieces.iter().any(|piece| matches!(piece, Piece::Command(_))), "{page} has no command");
    for piece in pieces {
        match piece {
            Piece::File(name, content) => {
                let path = folder.join(&name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, content).unwrap();
            }
            Piece::Command(command) => run(page, &folder, &command),
        }
    }
}

#[test]
fn the_tutorial_does_what_it_says() {
    follow(PAGES[0]);
}

#[test]
fn the_pages_for_those_who_come_from_elsewhere_do_what_they_say() {
    PAGES[1..4].iter().for_each(|page| follow(page));
}

#[test]
fn the_how_to_pages_do_what_they_say() {
    PAGES[4..].iter().for_each(|page| follow(page));
}

/// Its commands are those of a checkout: `cargo run --release -- COMMAND`.
#[test]
fn the_readme_does_what_it_says() {
    let folder = folder_with_scenes();
    let text = fs::read_to_string(docs().join("../README.md")).unwrap();
    let commands = text.lines().filter_map(|line| line.strip_prefix("cargo run --release -- "));
    let mut n_run = 0;
    // all experiments are run, and speed is measured, elsewhere
    for command in commands.filter(|command| !command.starts_with("reproduce") && !command.starts_with("bench")) {
        let command = command.split(" #").next().unwrap_or(command).trim();
        // with another number or step the checks do not hold: "see which checks notice"
        let fails = command.starts_with("run") && (command.contains("--set") || command.contains("--step"));
        let status = if fails { " # exit 1" } else { "" };
        run("README.md", &folder, &format!("sincro {command}{status}"));
        n_run += 1;
    }
    assert!(n_run >= 6, "{n_run} commands of the README were run");
}

#[test]
fn every_page_with_commands_is_followed() {
    for folder in ["", "how-to"] {
        for entry in fs::read_dir(docs().join(folder)).unwrap().flatten() {
            let path = entry.path();
            let Ok(text) = fs::read_to_string(&path) else { continue };
            let name = path.strip_prefix(docs()).unwrap().display().to_string();
            if text.contains("```console\n") {
                assert!(PAGES.contains(&name.as_str()), "{name} has commands that no test runs");
            }
        }
    }
}

#[test]
fn the_scenes_of_a_newcomer_run_and_their_checks_hold() {
    let folder = SceneFolder::new();
    for name in ["cart-two-pendulums", "arm-on-table", "quadrotor-arm"] {
        let scene = docs().join("../examples/newcomer").join(name);
        let exit = SINCRO.run(&scene, &folder.join(name), &[]);
        assert_eq!(exit.status, 0, "{name}: {}{}", exit.stdout, exit.stderr);
    }
}

/// Targets of the links of a page that are files beside it.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|link| !link.contains("://"))
}

/// Scene and variants of every row of the table of a page about the thesis.
fn rows_of_the_thesis(page: &str) -> Vec<(String, Vec<String>)> {
    let text = fs::read_to_string(docs().join(page)).unwrap();
    let rows = text.lines().filter(|line| line.starts_with("| ") && line.contains("](../scenes/"));
    let cells =
        rows.map(|row| row.trim_matches('|').split(" | ").map(str::trim).map(str::to_owned).collect::<Vec<_>>());
    // the rows of five cells are those of the table, the others those of single figures
    cells
        .filter(|cells| cells.len() == 5)
        .map(|cells| {
            let scene = links(&cells[2]).next().unwrap().trim_start_matches("../scenes/").to_owned();
            (scene, cells[3].split(", ").map(|variant| variant.trim_matches('`').to_owned()).collect())
        })
        .collect()
}

#[test]
fn every_scene_and_variant_of_the_thesis_is_there_in_both_languages() {
    let rows = rows_of_the_thesis("thesis.md");
    assert_eq!(rows, rows_of_the_thesis("tesis.md"));
    assert!(rows.len() > 30, "{} rows", rows.len());
    for (scene, variants) in &rows {
        let file = sincro_testing::repository_scene(scene).join("experiment.toml");
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        for variant in variants.iter().filter(|variant| *variant != "main") {
            let name = format!("[[variant]]\nname = \"{variant}\"");
            assert!(text.contains(&name), "{scene} has no variant {variant}");
        }
    }
    // no scene of the thesis's chapters is left out
    let of_the_thesis = ["motor-", "spring-", "two-dof-", "flexible-", "alexandros-", "quadrotor-", "aerial-"];
    let scenes = fs::read_dir(sincro_testing::repository_scene("motor-step").parent().unwrap()).unwrap();
    for scene in scenes.map(|entry| entry.unwrap().file_name().into_string().unwrap()) {
        let belongs = of_the_thesis.iter().any(|start| scene.starts_with(start));
        assert!(!belongs || rows.iter().any(|(known, _)| *known == scene), "{scene} is in no row of docs/thesis.md");
    }
}

#[test]
fn links_lead_somewhere_and_the_book_has_every_page() {
    let summary = fs::read_to_string(docs().join("SUMMARY.md")).unwrap();
    for folder in ["", "how-to"] {
        for entry in fs::read_dir(docs().join(folder)).unwrap().flatten() {
            let path = entry.path();
            if path.extension().is_none_or(|extension| extension != "md") {
                continue;
            }
            let name = path.strip_prefix(docs()).unwrap().display().to_string();
            let text = fs::read_to_string(&path).unwrap();
            for link in links(&text) {
                let file = link.split('#').next().unwrap_or("");
                let target = path.parent().unwrap().join(file);
                assert!(file.is_empty() || target.exists(), "{name}: the link `{link}` leads nowhere");
            }
            assert!(name == "SUMMARY.md" || summary.contains(&format!("]({name})")), "SUMMARY.md lacks {name}");
        }
    }
}
