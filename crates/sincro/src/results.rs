//! Files of a run's results: report, replay, figures, frames.

use std::panic::resume_unwind;
use std::path::Path;
use std::thread;

use sincro_figures::campaign;
use sincro_figures::plot::{Figure, Size, svg};
use sincro_figures::report::{self, Card, Page};
use sincro_scene::camera::png;
use sincro_scene::scene::Camera;
use sincro_sim::campaign::{Campaign, CompletedRun};
use sincro_sim::controller::SavedImage;
use sincro_sim::file::{FileError, prepare};
use sincro_sim::replay::Trajectory;
use sincro_sim::{Loaded, file};
use sincro_viewer::replay::Replay;
use sincro_viewer::{embed, picture};

/// Size of a picture of a run `[px]`.
const FRAME: (f64, f64) = (960.0, 540.0);
/// Pictures of a run per simulated second [1/s], and their greatest number.
const FRAMES: (f64, usize) = (30.0, 1800);
/// Size of the picture on a card `[px]`.
const CARD: (f64, f64) = (320.0, 150.0);

/// Size of the labelled picture of a report `[px]`.
const SKETCH: (f64, f64) = (880.0, 420.0);

/// Link of a page to another one, such as from a report back to its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link<'a> {
    /// Text of the link, without markup.
    pub label: &'a str,
    /// Address, relative to the page that has the link.
    pub href: &'a str,
}

/// Writes `report.html`, `replay.json` and the figures as SVG files of an experiment that was run into the folder
/// `out`, which must exist; `index` is the page that the report links back to.
///
/// # Errors
///
/// A file cannot be written; the error has its path.
pub fn write(loaded: &Loaded, campaign: &Campaign, out: &Path, index: Option<Link<'_>>) -> Result<(), FileError> {
    write_with(loaded, campaign, out, index, embed::replay)
}

/// Writes what [`write()`] writes, for one of many runs whose folders stand beside each other: the program that shows
/// the replays is written once, beside `out`, and the report refers to it.
///
/// # Errors
///
/// A file cannot be written; the error has its path.
pub fn write_one_of_many(loaded: &Loaded, campaign: &Campaign, out: &Path) -> Result<(), FileError> {
    for (name, content) in embed::assets() {
        let path = out.with_file_name(name);
        if std::fs::metadata(&path).is_ok_and(|file| file.len() == content.len() as u64) {
            continue;
        }
        write_text(&path, content)?;
    }
    write_with(loaded, campaign, out, None, |replay| embed::linked_replay(replay, ".."))
}

fn write_with(
    loaded: &Loaded,
    campaign: &Campaign,
    out: &Path,
    index: Option<Link<'_>>,
    embed: impl Fn(&str) -> String + Sync,
) -> Result<(), FileError> {
    let page = campaign::page(loaded, campaign);
    let drawing = main_drawing(campaign, &page);
    let folder = out.join("figures");
    prepare(&folder)?;
    let replay = || {
        let replay = Replay::of_campaign(loaded, campaign, drawing).to_json();
        write_text(&out.join("replay.json"), &replay)?;
        Ok(embed(&replay))
    };
    let figures = || {
        write_figures(&page.figures, &folder)?;
        write_images(&campaign.main.simulated.images, out)
    };
    let (replay, figures) = thread::scope(|scope| {
        let replay = scope.spawn(replay);
        let figures = figures();
        (replay.join().unwrap_or_else(|panic| resume_unwind(panic)), figures)
    });
    figures?;
    let up = index.map(|link| (link.label.to_owned(), link.href.to_owned()));
    let page = with_mechanism(Page { replay: replay?, up, ..page }, campaign);
    write_text(&out.join("report.html"), &report::html(&page))
}

/// Drawing of the diagram of the main run, as it stands on the page; none without a diagram.
fn main_drawing(campaign: &Campaign, page: &Page) -> Option<String> {
    let (_, drawing) = page.diagrams.first()?;
    campaign.main.controller.as_ref().map(|_| drawing.clone())
}

/// Writes figures as SVG files into a folder.
fn write_figures(figures: &[Figure], folder: &Path) -> Result<(), FileError> {
    for (k, figure) in figures.iter().enumerate() {
        let name = format!("{:02}-{}.svg", k + 1, file_name(&figure.title));
        write_text(&folder.join(name), &svg(figure, Size::wide(figure)))?;
    }
    Ok(())
}

/// Writes the pictures that scripts have saved into the folder `images` of a result, the texts into `files`.
pub(crate) fn write_images(images: &[SavedImage], out: &Path) -> Result<(), FileError> {
    for image in images {
        let is_picture = image.name.ends_with(".png") || image.name.ends_with(".bmp");
        let folder = out.join(if is_picture { "images" } else { "files" });
        prepare(&folder)?;
        file::write_atomically(&folder.join(&image.name), &image.bytes)?;
    }
    Ok(())
}

/// Report of an experiment that was run as one HTML text that needs no other file, with its replay and the program that
/// shows it.
#[must_use]
pub fn report_html(loaded: &Loaded, campaign: &Campaign) -> String {
    let page = campaign::page(loaded, campaign);
    let replay = Replay::of_campaign(loaded, campaign, main_drawing(campaign, &page));
    report::html(&with_mechanism(Page { replay: embed::replay(&replay.to_json()), ..page }, campaign))
}

/// The page with the labelled picture of the scene at its start, and its equations.
fn with_mechanism(mut page: Page, campaign: &Campaign) -> Page {
    let main = &campaign.main;
    let first = main.simulated.trajectory.as_ref().filter(|trajectory| trajectory.n_frames() > 0);
    if let (Some(mechanism), Some(trajectory)) = (&mut page.mechanism, first) {
        mechanism.sketch = picture::sketch(&main.view, trajectory.frame(0), SKETCH);
    }
    if let Some(mechanism) = &mut page.mechanism {
        mechanism.derivation = equations(Path::new(&campaign.report.scene_path)).unwrap_or_default();
    }
    page
}

/// Section `Equations` of the README in the folder of a scene; `None`: there is none.
fn equations(folder: &Path) -> Option<String> {
    let readme = std::fs::read_to_string(folder.join("README.md")).ok()?;
    report::derivation::section_of(&readme, "Equations").map(str::to_owned)
}

/// Replay of an experiment that was run, with the drawing of its block diagram: the content of `replay.json`.
#[must_use]
pub fn replay(loaded: &Loaded, campaign: &Campaign) -> Replay {
    let draw = |controller| campaign::diagram(controller, "", &campaign.report.scene, true);
    Replay::of_campaign(loaded, campaign, loaded.controller.as_ref().map(draw))
}

/// Card of an experiment that was run for an index page of many, with a picture of the scene half way through the run;
/// `href` is the address of its report, relative to the index.
#[must_use]
pub fn card(loaded: &Loaded, campaign: &Campaign, href: &str) -> Card {
    let card = campaign::card(loaded, campaign, href);
    Card { replay: format!("{href}#sincro-viewer"), picture: half_way(campaign), ..card }
}

/// Picture of the scene half way through the run as SVG; empty if no frames were taken.
fn half_way(campaign: &Campaign) -> String {
    let main = &campaign.main;
    let still = |trajectory: &Trajectory| picture::still(&main.view, trajectory.frame(trajectory.n_frames() / 2), CARD);
    main.simulated.trajectory.as_ref().filter(|trajectory| trajectory.n_frames() > 0).map(still).unwrap_or_default()
}

/// Writes pictures of a run as SVG files `frames/0001.svg` … into the folder `out`: 30 per simulated second, 1800 at
/// most. Nothing if the run has no trajectory.
///
/// # Errors
///
/// A file cannot be written; the error has its path.
pub fn write_frames(done: &CompletedRun, out: &Path) -> Result<(), FileError> {
    let Some(trajectory) = &done.simulated.trajectory else { return Ok(()) };
    let folder = out.join("frames");
    prepare(&folder)?;
    for (k, picture) in picture::strip(&done.view, trajectory, FRAMES, FRAME).iter().enumerate() {
        write_text(&folder.join(format!("{:04}.svg", k + 1)), picture)?;
    }
    Ok(())
}

/// Writes pictures of a run, taken by a camera of the scene, as PNG files `frames/0001.png` … into the folder `out`: 30
/// per simulated second, 1800 at most. `camera` is its index in the objects of the scene (see
/// [`camera`](crate::camera)); nothing if it is none or the run has no trajectory.
///
/// # Errors
///
/// A file cannot be written; the error has its path.
pub fn write_camera_frames(loaded: &Loaded, done: &CompletedRun, camera: usize, out: &Path) -> Result<(), FileError> {
    let Some(trajectory) = &done.simulated.trajectory else { return Ok(()) };
    let resolution = [FRAME.0 as usize, FRAME.1 as usize];
    let Some(mut camera) = Camera::of_scene(&loaded.scene, camera, resolution) else { return Ok(()) };
    let folder = out.join("frames");
    prepare(&folder)?;
    for (n, k) in trajectory.evenly_spaced(FRAMES.0, FRAMES.1).into_iter().enumerate() {
        let q: Vec<f64> = trajectory.layout.coordinates(trajectory.frame(k)).iter().copied().map(f64::from).collect();
        let image = camera.render(&q);
        let bytes = png::encode(image.rgb(), image.resolution(), png::Channels::Rgb);
        file::write_atomically(&folder.join(format!("{:04}.png", n + 1)), &bytes)?;
    }
    Ok(())
}

/// Writes a run as an MCAP file at `path`, for Foxglove, Lichtblick or Rerun. A file that is there is replaced.
///
/// # Errors
///
/// The file cannot be written; the error has its path.
#[cfg(feature = "adapters")]
pub fn write_mcap(done: &CompletedRun, path: &Path) -> Result<(), FileError> {
    sincro_viewer::mcap::write(done, path)
}

/// Writes a text file, whole or not at all: a file of that name that is there is replaced at once or stays as it was.
///
/// # Errors
///
/// The file cannot be written; the error has its path.
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    file::write_atomically(path, text.as_bytes())
}

/// A title as part of a file's name.
fn file_name(title: &str) -> String {
    let mut name = String::new();
    for c in title.to_lowercase().chars() {
        if c.is_ascii_alphanumeric() {
            name.push(c);
        } else if !name.ends_with('-') {
            name.push('-');
        }
    }
    let name = name.trim_matches('-');
    name.get(..48).unwrap_or(name).trim_matches('-').to_owned()
}
