//! Layout of a figure, measured from the text and the data before anything is drawn.
//!
//! From top to bottom: title, then for each panel a header (its title and legend) and the plot area, then tick labels
//! and label of the shared x axis, then notes. The left margin fits the widest tick label of all panels.

use super::axis::{Scale, is_drawable};
use super::number::short;
use super::robust::{DataRange, range};
use super::text::{fit_middle, width, wrap};
use super::{Figure, Limit, Panel, Size};

/// A plot area is never lower than this `[px]`.
const MIN_AREA: f64 = 56.0;
/// That of a thumbnail never lower than this `[px]`.
const MIN_THUMBNAIL_AREA: f64 = 112.0;
/// Free border around everything `[px]`.
const BORDER: f64 = 8.0;

/// Font sizes `[px]` and what they imply.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fonts {
    pub(super) title: f64,
    pub(super) label: f64,
    pub(super) tick: f64,
    /// Length of a legend sample.
    pub(super) sample: f64,
    /// True: no title, remarks, notes, and only the first panel.
    pub(super) is_thumbnail: bool,
}

impl Fonts {
    /// Sizes of a full figure.
    pub(super) const FULL: Self = Self { title: 15.0, label: 13.0, tick: 12.0, sample: 35.0, is_thumbnail: false };
    /// Sizes of a thumbnail.
    pub(super) const THUMBNAIL: Self = Self { title: 0.0, label: 11.0, tick: 10.5, sample: 22.0, is_thumbnail: true };

    /// Distance of lines of label text.
    pub(super) fn row(&self) -> f64 {
        self.label + if self.is_thumbnail { 3.0 } else { 7.0 }
    }
}

/// The measured figure.
#[derive(Debug)]
pub(super) struct Layout<'a> {
    pub(super) fonts: Fonts,
    /// The size asked for, made large enough to draw in, and higher if the legends need it.
    pub(super) size: Size,
    /// Lines of the title.
    pub(super) title: Vec<String>,
    /// Left and right end of all plot areas.
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) x: Scale,
    /// Unit of the shared x axis.
    pub(super) x_unit: &'a str,
    pub(super) panels: Vec<PanelLayout<'a>>,
    /// Lines under the figure that say what could not be drawn.
    pub(super) notes: Vec<String>,
}

/// One measured panel.
#[derive(Debug)]
pub(super) struct PanelLayout<'a> {
    pub(super) panel: &'a Panel,
    pub(super) header: Vec<Entry>,
    /// Baseline of the header's first row.
    pub(super) header_baseline: f64,
    /// Top and bottom of the plot area.
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) y: Scale,
    /// Range of the values, and the spikes beyond it.
    pub(super) data: DataRange,
}

/// A piece of a header: a title, a legend entry or a remark.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) sample: Sample,
    pub(super) text: String,
    /// Distance from the left end of the plot area.
    pub(super) x: f64,
    pub(super) row: usize,
}

/// Sample in front of a legend entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample {
    /// Nothing: it is the panel's title.
    Title,
    /// Nothing: it is a remark.
    Remark,
    /// The line of that series.
    Series(usize),
    /// The shade of that band.
    Band(usize),
    /// The line of a limit.
    Limit,
    /// That auxiliary line.
    Guide(usize),
}

impl<'a> Layout<'a> {
    /// Measures a figure for a canvas.
    pub(super) fn new(figure: &'a Figure, size: Size, fonts: Fonts) -> Self {
        let size = usable(size);
        let n_panels = if fonts.is_thumbnail { 1 } else { usize::MAX };
        let shown: Vec<&Panel> = figure.panels.iter().take(n_panels).collect();
        let title = match fonts.is_thumbnail {
            true => Vec::new(),
            false => wrap(&figure.title, fonts.title * 1.06, size.width - 2.0 * BORDER, 3),
        };
        let notes = if fonts.is_thumbnail { Vec::new() } else { notes(figure) };
        let below = 8.0 + fonts.tick + fonts.row() + notes.len() as f64 * fonts.row() + BORDER;
        let above = BORDER + title.len() as f64 * (fonts.title + 6.0) + if title.is_empty() { 0.0 } else { 5.0 };
        let panels = stack(&shown, above, size.height - below, size.width, fonts);
        // A long legend makes the picture higher rather than its plots lower than can be read.
        let bottom = panels.last().map_or(0.0, |panel| panel.bottom);
        let size = Size { height: size.height.max(bottom + below), ..size };
        let left = left_margin(&panels, fonts);
        let right = (size.width - BORDER - 12.0).max(left + 20.0);
        let x = x_scale(figure, right - left, fonts);
        Self { fonts, size, title, left, right, x, x_unit: &figure.x.unit, panels, notes }
    }
}

/// Places headers and plot areas between `top` and `bottom`.
fn stack<'a>(shown: &[&'a Panel], top: f64, bottom: f64, width: f64, fonts: Fonts) -> Vec<PanelLayout<'a>> {
    let ranges: Vec<DataRange> = shown.iter().map(|panel| DataRange::of(panel)).collect();
    let available = width - if fonts.is_thumbnail { 56.0 } else { 100.0 };
    let headers: Vec<Vec<Entry>> =
        shown.iter().zip(&ranges).map(|(panel, data)| header(panel, data, available, fonts)).collect();
    let heights: Vec<f64> = headers.iter().enumerate().map(|(i, header)| header_height(i, header, fonts)).collect();
    let shares: f64 = shown.iter().map(|panel| panel.usable_share()).sum();
    let free = bottom - top - heights.iter().sum::<f64>();
    let mut cursor = top;
    let mut panels = Vec::new();
    for (((panel, header), height), data) in shown.iter().zip(headers).zip(heights).zip(ranges) {
        let gap = if panels.is_empty() { 0.0 } else { 12.0 };
        let header_baseline = cursor + gap + fonts.label;
        let area_top = cursor + height;
        let least = if fonts.is_thumbnail { MIN_THUMBNAIL_AREA } else { MIN_AREA };
        let area_bottom = area_top + (free * panel.usable_share() / shares).max(least);
        let y = Scale::of(&panel.y, y_range(panel, &data), ((area_bottom - area_top) / 34.0) as usize);
        panels.push(PanelLayout { panel, header, header_baseline, top: area_top, bottom: area_bottom, y, data });
        cursor = area_bottom;
    }
    panels
}

fn header_height(index: usize, header: &[Entry], fonts: Fonts) -> f64 {
    let gap = if index == 0 { 0.0 } else { 12.0 };
    let rows = header.iter().map(|entry| entry.row + 1).max().unwrap_or(0);
    gap + rows as f64 * fonts.row() + 4.0
}

/// Title and legend of a panel, flowing into rows of that width. A thumbnail has the names of the curves alone.
fn header(panel: &Panel, data: &DataRange, available: f64, fonts: Fonts) -> Vec<Entry> {
    let curves = panel.series.iter().enumerate().map(|(i, series)| (Sample::Series(i), series.name.clone()));
    let mut pieces = Vec::new();
    if fonts.is_thumbnail {
        pieces.extend(curves);
    } else {
        pieces.push((Sample::Title, panel.title.clone()));
        pieces.extend(curves);
        pieces.extend(panel.bands.iter().enumerate().map(|(i, band)| (Sample::Band(i), band.name.clone())));
        pieces.extend(panel.guides.iter().enumerate().map(|(i, guide)| (Sample::Guide(i), guide.name.clone())));
        pieces.extend(limit_pieces(panel, data));
        pieces.extend(spike_remark(panel, data).map(|remark| (Sample::Remark, remark)));
        pieces.push((Sample::Remark, panel.remark.clone()));
    }
    pieces.retain(|(_, text)| !text.trim().is_empty());
    let (mut x, mut row) = (0.0, 0);
    let mut entries: Vec<Entry> = Vec::new();
    for (sample, text) in pieces {
        let lead = if matches!(sample, Sample::Title | Sample::Remark) { 0.0 } else { fonts.sample + 6.0 };
        let text = fit_middle(&text, fonts.label, available - lead);
        let length = lead + width(&text, fonts.label);
        if x > 0.0 && x + length > available {
            (x, row) = (0.0, row + 1);
        }
        entries.push(Entry { sample, text, x, row });
        x += length + 20.0;
    }
    entries
}

/// One legend entry for each name of a drawn limit, one remark for each that lies too far away.
fn limit_pieces(panel: &Panel, data: &DataRange) -> Vec<(Sample, String)> {
    let mut pieces: Vec<(Sample, String)> = Vec::new();
    for limit in &panel.limits {
        let sign = if has_mirror_image(limit, panel) { "±" } else { "" };
        let size = if sign.is_empty() { limit.value } else { limit.value.abs() };
        let value = format!("{} {sign}{} {}", limit.name, short(size, 3), panel.y.unit);
        let piece = match is_near(limit.value, data.shown) {
            true => (Sample::Limit, value.trim_end().to_owned()),
            false => (Sample::Remark, format!("({} is off the scale)", value.trim_end())),
        };
        if !pieces.contains(&piece) {
            pieces.push(piece);
        }
    }
    pieces
}

fn has_mirror_image(limit: &Limit, panel: &Panel) -> bool {
    limit.value != 0.0 && panel.limits.iter().any(|other| other.name == limit.name && other.value == -limit.value)
}

/// Returns true if a limit can be shown without flattening the data: within one height of them.
pub(super) fn is_near(limit: f64, data: Option<(f64, f64)>) -> bool {
    let Some((low, high)) = data else { return limit.is_finite() };
    let room = high - low;
    room == 0.0 || (low - room..=high + room).contains(&limit)
}

/// Number of the spikes of a panel and the greatest one; `None`: there is none.
fn spike_remark(panel: &Panel, data: &DataRange) -> Option<String> {
    let greatest = data.spikes.first()?;
    let value = format!("{} {}", short(greatest.y, 4), panel.y.unit);
    Some(match data.spikes.len() {
        1 => format!("(a spike of {} is off the scale)", value.trim_end()),
        n => format!("({n} spikes are off the scale, the greatest of {})", value.trim_end()),
    })
}

fn y_range(panel: &Panel, data: &DataRange) -> Option<(f64, f64)> {
    let near = panel.limits.iter().map(|limit| limit.value).filter(|&value| is_near(value, data.shown));
    let (low, high) = range(near.chain(data.shown.into_iter().flat_map(|(low, high)| [low, high])), panel.y.log)?;
    // A little air, so that no peak touches the frame.
    let air = if panel.y.log { 0.0 } else { 0.03 * (high - low) };
    Some((low - air, high + air))
}

/// Border, rotated label, gap, widest tick label, gap.
fn left_margin(panels: &[PanelLayout], fonts: Fonts) -> f64 {
    let labels = panels.iter().flat_map(|panel| &panel.y.major);
    let widest = labels.map(|tick| width(&tick.label, fonts.tick)).fold(0.0, f64::max);
    BORDER + fonts.label + 10.0 + widest + 8.0
}

/// The shared x axis with as many labels as fit beside one another.
fn x_scale(figure: &Figure, length: f64, fonts: Fonts) -> Scale {
    let curves = figure.panels.iter().flat_map(|panel| panel.series.iter().flat_map(|series| &series.x));
    let bands = figure.panels.iter().flat_map(|panel| panel.bands.iter().flat_map(|band| &band.x));
    let data = range(curves.chain(bands).copied(), figure.x.log);
    let mut max_ticks = ((length / 70.0) as usize).max(2);
    loop {
        let scale = Scale::of(&figure.x, data, max_ticks);
        let widest = scale.major.iter().map(|tick| width(&tick.label, fonts.tick)).fold(0.0, f64::max);
        let closest = scale.major.windows(2).map(|pair| pair[1].at - pair[0].at).fold(1.0, f64::min);
        if widest + 12.0 <= closest * length || max_ticks <= 2 {
            return scale;
        }
        max_ticks -= 1;
    }
}

/// Count of the values that cannot be drawn, in words.
fn notes(figure: &Figure) -> Vec<String> {
    let mut notes = Vec::new();
    for panel in &figure.panels {
        for series in &panel.series {
            let is_lost = |&(x, y): &(f64, f64)| !is_drawable(x, figure.x.log) || !is_drawable(y, panel.y.log);
            let lost = series.points().filter(is_lost).count();
            let reason = if figure.x.log || panel.y.log { "not finite or not positive" } else { "not finite" };
            if lost > 0 {
                notes.push(format!(
                    "{lost} of {} values of {} are {reason} and leave gaps.",
                    series.points().count(),
                    series.name
                ));
            }
        }
    }
    notes.truncate(3);
    notes
}

/// A size in which at least the axes have room.
fn usable(size: Size) -> Size {
    let at_least = |value: f64, least: f64| if value.is_finite() { value.max(least) } else { least };
    Size { width: at_least(size.width, 160.0), height: at_least(size.height, 100.0) }
}
