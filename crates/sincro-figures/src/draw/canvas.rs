//! SVG text under construction.

use crate::plot::number::coordinate;
use crate::plot::{escape, rich};

/// The content of an SVG element.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    pub text: String,
}

impl Canvas {
    pub fn path(&mut self, class: &str, data: &str) {
        self.text.push_str(&format!("<path class=\"{class}\" d=\"{data}\"/>\n"));
    }

    /// A rectangle with rounded corners.
    pub fn rect(&mut self, class: &str, (x, y): (f64, f64), (width, height): (f64, f64), radius: f64) {
        let [x, y, width, height, radius] = [x, y, width, height, radius].map(coordinate);
        self.text.push_str(&format!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"{radius}\"/>\n"
        ));
    }

    pub fn circle(&mut self, class: &str, (x, y): (f64, f64), radius: f64) {
        let [x, y, radius] = [x, y, radius].map(coordinate);
        self.text.push_str(&format!("<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>\n"));
    }

    /// Text with the middle of its small letters at a height; `anchor` is start, middle or end.
    pub fn words(&mut self, (x, y): (f64, f64), anchor: &str, font: f64, class: &str, words: &str) {
        if words.is_empty() {
            return;
        }
        let (x, y, size) = (coordinate(x), coordinate(y + 0.35 * font), coordinate(font));
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        let content = rich(words, font);
        self.text.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{class}>{content}</text>\n"
        ));
    }

    /// Opens a group with the full text of what may be cut in it.
    pub fn open(&mut self, title: &str) {
        self.text.push_str(&format!("<g><title>{}</title>\n", escape(title)));
    }

    pub fn close(&mut self) {
        self.text.push_str("</g>\n");
    }
}
