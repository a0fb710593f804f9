//! Puts a measured figure together as SVG text.

use super::layout::{Fonts, Layout};
use super::number::coordinate;
use super::panel;
use super::style::standalone_css;
use super::text::{escape, fit, rich, width};
use super::{Figure, Role, Size};

/// Use of the SVG text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A file.
    Standalone,
    /// A figure within a page.
    Inline,
    /// A small figure within a page.
    Thumbnail,
}

/// Facts about the whole figure that every panel must know, so that a signal looks the same in all of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context {
    /// Count of signals, of which each has a colour.
    pub(super) n_signals: usize,
    /// Runs carry markers, because there is more than one.
    pub(super) marks_runs: bool,
}

/// Draws the figure.
pub(super) fn picture(figure: &Figure, size: Size, kind: Kind) -> String {
    if let Some(space) = &figure.space {
        return super::space::picture(figure, space, size, kind);
    }
    let fonts = if kind == Kind::Thumbnail { Fonts::THUMBNAIL } else { Fonts::FULL };
    let layout = Layout::new(figure, size, fonts);
    let context = context(figure);
    let mut canvas = Canvas::open(&figure.title, layout.size, kind);
    for (row, line) in layout.title.iter().enumerate() {
        let baseline = 8.0 + fonts.title + row as f64 * (fonts.title + 6.0);
        canvas.bold_text((8.0, baseline), fonts.title, line);
    }
    for at in &layout.panels {
        canvas.open_group("sp-panel");
        panel::draw(&mut canvas, &layout, at, context);
        canvas.close_group();
    }
    draw_x_axis(&mut canvas, &layout, figure);
    canvas.close()
}

fn context(figure: &Figure) -> Context {
    let all = || figure.panels.iter().flat_map(|panel| &panel.series);
    let n_signals = all().map(|series| series.signal.saturating_add(1)).max().unwrap_or(1);
    let runs = |panel: &super::Panel| panel.series.iter().filter(|series| series.role != Role::Reference).count();
    Context { n_signals, marks_runs: figure.panels.iter().any(|panel| runs(panel) > 1) }
}

/// Tick labels and label of the shared axis, and the notes under it.
fn draw_x_axis(canvas: &mut Canvas, layout: &Layout, figure: &Figure) {
    let fonts = layout.fonts;
    let Some(last) = layout.panels.last() else { return };
    let tick_baseline = last.bottom + 6.0 + fonts.tick;
    for tick in &layout.x.major {
        let x = layout.left + tick.at * (layout.right - layout.left);
        let half = 0.5 * width(&tick.label, fonts.tick);
        let x = x.min(layout.size.width - 2.0 - half);
        canvas.text((x, tick_baseline), "middle", fonts.tick, "sp-quiet sp-x-tick", &tick.label);
    }
    let (label, bracket) = layout.x.caption(&figure.x);
    let label_baseline = tick_baseline + fonts.row() - 2.0;
    let middle = 0.5 * (layout.left + layout.right);
    canvas.text((middle, label_baseline), "middle", fonts.label, "", format!("{label} {bracket}").trim());
    for (row, note) in layout.notes.iter().enumerate() {
        let baseline = label_baseline + (row + 1) as f64 * fonts.row();
        let note = fit(note, fonts.tick, layout.size.width - 16.0);
        canvas.text((8.0, baseline), "start", fonts.tick, "sp-quiet", &note);
    }
}

/// SVG text under construction.
pub(super) struct Canvas {
    text: String,
    /// Carries the numbers by which a page's script reads values and magnifies.
    has_script_data: bool,
}

impl Canvas {
    pub(super) fn open(title: &str, size: Size, kind: Kind) -> Self {
        let (width, height) = (coordinate(size.width), coordinate(size.height));
        let title = escape(title);
        let mut text = String::new();
        match kind {
            Kind::Standalone => text.push_str(&format!(
                concat!(
                    r#"<svg xmlns="http://www.w3.org/2000/svg" class="sp" role="img" width="{}" height="{}" "#,
                    r#"viewBox="0 0 {} {}" font-family="Helvetica, Arial, sans-serif">"#,
                    "\n<title>{}</title>\n<style>\n{}\n</style>\n",
                    "<rect class=\"sp-paper\" width=\"100%\" height=\"100%\"/>\n"
                ),
                width,
                height,
                width,
                height,
                title,
                standalone_css()
            )),
            Kind::Inline | Kind::Thumbnail => text.push_str(&format!(
                "<svg class=\"sp\" role=\"img\" aria-label=\"{title}\" viewBox=\"0 0 {width} {height}\">\n"
            )),
        }
        Self { text, has_script_data: kind == Kind::Inline }
    }

    pub(super) fn close(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// A path; nothing if it has no data. `attributes` are written as they are.
    pub(super) fn path(&mut self, class: &str, attributes: &str, data: &str) {
        if !data.is_empty() {
            let gap = if attributes.is_empty() { "" } else { " " };
            self.text.push_str(&format!("<path class=\"{class}\"{gap}{attributes} d=\"{data}\"/>\n"));
        }
    }

    /// Text with its baseline at a place; `anchor` is start, middle or end.
    pub(super) fn text(&mut self, at: (f64, f64), anchor: &str, font_size: f64, class: &str, text: &str) {
        let anchor = if anchor == "start" { String::new() } else { format!(r#" text-anchor="{anchor}""#) };
        let class = if class.is_empty() { String::new() } else { format!(r#" class="{class}""#) };
        self.write_text(at, &format!("{anchor}{class}"), font_size, text);
    }

    pub(super) fn bold_text(&mut self, at: (f64, f64), font_size: f64, text: &str) {
        self.write_text(at, r#" font-weight="600""#, font_size, text);
    }

    /// Text that reads upwards, centred on a place.
    pub(super) fn rotated_text(&mut self, at: (f64, f64), font_size: f64, text: &str) {
        let turn =
            format!(r#" text-anchor="middle" transform="rotate(-90 {} {})""#, coordinate(at.0), coordinate(at.1));
        self.write_text(at, &turn, font_size, text);
    }

    fn write_text(&mut self, at: (f64, f64), attributes: &str, font_size: f64, text: &str) {
        let (x, y, size) = (coordinate(at.0), coordinate(at.1), coordinate(font_size));
        let content = rich(text, font_size);
        self.text.push_str(&format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{attributes}>{content}</text>\n"));
    }

    /// An attribute for the script of a page; empty in files and thumbnails.
    pub(super) fn script_data(&self, name: &str, value: &str) -> String {
        if self.has_script_data { format!(r#" data-{name}="{}""#, escape(value)) } else { String::new() }
    }

    /// Opens a region (left, top, right, bottom) outside of which nothing shows, and whose upper left corner is the new
    /// origin; `data` is for the script of a page.
    pub(super) fn open_clip(&mut self, (left, top, right, bottom): (f64, f64, f64, f64), data: &[(&str, String)]) {
        let (x, y) = (coordinate(left), coordinate(top));
        let (width, height) = (coordinate(right - left), coordinate(bottom - top));
        let data: String = data.iter().map(|(name, value)| self.script_data(name, value)).collect();
        self.text.push_str(&format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"{data}>\n"));
    }

    /// Opens a group.
    pub(super) fn open_group(&mut self, class: &str) {
        self.text.push_str(&format!("<g class=\"{class}\">\n"));
    }

    /// Closes the group.
    pub(super) fn close_group(&mut self) {
        self.text.push_str("</g>\n");
    }

    /// Closes the region.
    pub(super) fn close_clip(&mut self) {
        self.text.push_str("</svg>\n");
    }
}
