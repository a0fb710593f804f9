//! Styles of series: colour, dash, marker. Three cues, any one of which is enough for a few curves.
//!
//! Colours are those of Okabe and Ito (*Color Universal Design*, 2008), chosen to be told apart by colour-blind eyes.
//! Elements carry classes; the colours behind the classes are fixed in a standalone file and CSS variables in a page,
//! which gives them three sets: light, dark and print.

use super::{Role, Series};

/// Count of colours; signals beyond share them, and differ in marker.
const N_COLORS: usize = 6;
/// Count of marker shapes; no multiple of the colours, so that pairs repeat late.
const N_MARKERS: usize = 7;
/// Dashes of the variants `[px]`; the main run is solid.
const VARIANT_DASHES: [&str; 5] = ["9 3", "2.5 2.5", "9 3 2 3", "15 4", "5 2 1.5 2 1.5 2"];
/// Dash of a reference `[px]`.
const REFERENCE_DASH: &str = "5 5";

/// Colour variables for light, dark and print, and the classes that use them: goes once into a page with inline
/// figures.
pub(crate) const PAGE_CSS: &str = include_str!("page.css");

/// The styles of a standalone file: the same classes, with the light colours written in place of their variables.
pub(super) fn standalone_css() -> String {
    with_light_colors(PAGE_CSS.split_once("/* classes */").map_or(PAGE_CSS, |(_, rules)| rules))
}

/// Rules with the light colours in place of the variables of [`PAGE_CSS`].
pub(crate) fn with_light_colors(rules: &str) -> String {
    let light = PAGE_CSS.split('}').next().unwrap_or("");
    let colors = light.split(';').filter_map(|line| line[line.find("--")?..].split_once(':'));
    colors.fold(rules.trim().to_owned(), |css, (name, color)| css.replace(&format!("var({name})"), color.trim()))
}

/// Style of one series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    /// Class that gives the colour to stroke.
    pub(super) class: &'static str,
    /// Stroke width `[px]`.
    pub(super) weight: f64,
    /// Value of `stroke-dasharray`; empty for solid.
    pub(super) dash: &'static str,
    /// Shape of its markers.
    pub(super) marker: usize,
    /// Markers are filled, not hollow.
    pub(super) is_filled: bool,
    /// Position in the stack: greater is nearer to the reader.
    pub(super) layer: usize,
}

/// The look of a series in a figure of `n_signals` signals. It does not depend on the panel.
pub(super) fn look(series: &Series, n_signals: usize) -> Look {
    match series.role {
        Role::Simulated => {
            let marker = series.signal % N_MARKERS;
            Look { class: color(series.signal), weight: 2.6, dash: "", marker, is_filled: true, layer: 0 }
        }
        Role::Variant(index) => {
            let slot = index.saturating_add(1).saturating_mul(n_signals).saturating_add(series.signal);
            let dash = VARIANT_DASHES[index % VARIANT_DASHES.len()];
            Look { class: color(slot), weight: 1.7, dash, marker: slot % N_MARKERS, is_filled: true, layer: 1 }
        }
        Role::Reference => {
            let marker = series.signal % N_MARKERS;
            Look { class: "sp-ref", weight: 1.2, dash: REFERENCE_DASH, marker, is_filled: false, layer: 2 }
        }
    }
}

/// Class of a colour slot.
pub(super) fn color(slot: usize) -> &'static str {
    const CLASSES: [&str; N_COLORS] = ["sp-c0", "sp-c1", "sp-c2", "sp-c3", "sp-c4", "sp-c5"];
    CLASSES[slot % N_COLORS]
}

/// Path data of one marker about a centre, which the caller writes in front: `M x y` and then this.
pub(super) fn marker(shape: usize) -> &'static str {
    match shape {
        0 => "m-3.2 0a3.2 3.2 0 1 0 6.4 0a3.2 3.2 0 1 0 -6.4 0z",
        1 => "m-2.9 -2.9h5.8v5.8h-5.8z",
        2 => "m0 -3.9l3.7 6.5h-7.4z",
        3 => "m0 -4.1l3.6 4.1l-3.6 4.1l-3.6 -4.1z",
        4 => "m-2.9 -2.9l5.8 5.8m0 -5.8l-5.8 5.8",
        5 => "m-3.7 0h7.4m-3.7 -3.7v7.4",
        _ => "m0 3.9l3.7 -6.5h-7.4z",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standalone_file_names_no_variable() {
        let css = standalone_css();
        assert!(css.contains("#0072b2") && css.contains("sp-grid") && !css.contains("var("), "{css}");
    }

    #[test]
    fn the_first_series_differ_in_every_cue() {
        let of = |role| look(&Series::new("", role, vec![], vec![]), 1);
        let looks = [of(Role::Simulated), of(Role::Variant(0)), of(Role::Variant(1)), of(Role::Variant(2))];
        for (index, a) in looks.iter().enumerate() {
            for b in &looks[..index] {
                assert!(a.class != b.class && a.dash != b.dash && a.marker != b.marker, "{a:?} {b:?}");
            }
        }
    }
}
