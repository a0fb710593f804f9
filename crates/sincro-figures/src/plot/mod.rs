//! Line charts as SVG text: the figures of `report.html` and the `.svg` files beside it.
//!
//! A [`Figure`] is plain data: one x axis shared by one or more [`Panel`]s stacked above one another (a signal and
//! its error; magnitude and phase of a Bode plot). [`svg`] gives a standalone file; the pages of [`crate::report`] have
//! the same picture inline, or a small one without title.
//!
//! A few extreme values do not flatten the rest: the module `robust` says which range is shown, and spikes beyond it
//! are marked at the edge with their value.
//!
//! The same figure always gives the same bytes: numbers are formatted by [`number`], no map is iterated, no clock is
//! read and no transcendental function of the platform is called. A series may hold millions of points; what is
//! written is bounded by `decimate`. Series differ in colour (Okabe–Ito), dash and marker, so that a figure
//! reads on a black and white print and for colour-blind eyes.

mod axis;
mod decimate;
mod draw;
mod layout;
pub mod number;
mod panel;
mod robust;
mod space;
mod style;
mod text;

pub use space::{Space, Track};
pub(crate) use style::PAGE_CSS;
pub(crate) use style::with_light_colors;
pub use text::{escape, escape_raised};
pub(crate) use text::{rich, width as text_width};

/// Chart: a title and panels over one shared x axis, to be drawn with [`svg`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Title above the panels; wraps, and is cut with an ellipsis after three lines.
    pub title: String,
    /// Horizontal axis that all panels share; labelled under the last one.
    pub x: Axis,
    /// Panels from top to bottom; usually one, or two where the second shows the error.
    pub panels: Vec<Panel>,
    /// Curves in space instead of panels.
    pub space: Option<Space>,
}

/// Axis of a chart: label, unit and division. Data are given in the unit of the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Name of the quantity: `time`, `angle`.
    pub label: String,
    /// Unit of the data, shown in brackets behind the label, with a power of ten where needed; may be empty.
    pub unit: String,
    /// True: logarithmic. Values that are not positive cannot be drawn there; they are counted under the figure.
    pub log: bool,
    /// True: an angle in degrees, divided at 15°, 45°, 90° and so on rather than at tens.
    pub degrees: bool,
    /// Range, lower then upper bound, that the axis shows at least, in its unit; `None`: the data alone decide.
    pub range: Option<(f64, f64)>,
}

/// Plot area of a [`Figure`] with a vertical axis of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title in front of the legend; empty for the first panel, whose title is the figure's.
    pub title: String,
    /// Vertical axis.
    pub y: Axis,
    /// Share of the height (dimensionless): a panel of 1.0 is twice as high as one of 0.5.
    pub share: f64,
    /// The curves. References are drawn over simulated ones, whatever the order here; the legend keeps the order.
    pub series: Vec<Series>,
    /// Shaded regions, behind the curves.
    pub bands: Vec<Band>,
    /// Horizontal lines, such as tolerances.
    pub limits: Vec<Limit>,
    /// Auxiliary lines, behind the curves.
    pub guides: Vec<Guide>,
    /// Remark behind the legend, such as a limit of what the panel can show; may be empty.
    pub remark: String,
}

/// Curve or cloud of points of a [`Panel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; an empty name has no entry there.
    pub name: String,
    /// Part in the figure, which decides dash and weight.
    pub role: Role,
    /// Which of the figure's signals it shows, counted from 0; decides colour and marker. A signal, its variants and
    /// its reference carry the same number, in every panel.
    pub signal: usize,
    /// Line or markers that join the points.
    pub stroke: Stroke,
    /// Abscissae in the unit of the x axis. If `x` and `y` differ in length, the rest of the longer one is not drawn.
    pub x: Vec<f64>,
    /// Ordinates in the unit of the y axis. One that is not finite leaves a gap and is counted under the figure.
    pub y: Vec<f64>,
}

/// Part of a series in a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The main run: solid and strong.
    Simulated,
    /// Reference that the run is compared with: thin, dashed, hollow markers, in the colour of the text.
    Reference,
    /// The same run with other settings; the number is that of the variant, from 0.
    Variant(usize),
}

/// Line or markers that join the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// By straight lines.
    Line,
    /// By steps: a value holds until the next one (zero-order hold).
    Steps,
    /// Not at all: a marker at each point.
    Points,
    /// Not at all: a cross at each point, as for poles.
    Crosses,
    /// Not at all: a ring at each point, as for zeros.
    Rings,
}

/// Shaded region between two curves, such as an error bar around a signal. Entry k of the three lists belongs together.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Name in the legend; may be empty.
    pub name: String,
    /// Index of the signal whose colour it takes, as [`Series::signal`].
    pub signal: usize,
    /// Abscissae in the unit of the x axis.
    pub x: Vec<f64>,
    /// Ordinates of the lower edge in the unit of the y axis.
    pub lower: Vec<f64>,
    /// Ordinates of the upper edge in the unit of the y axis.
    pub upper: Vec<f64>,
}

/// Horizontal line of a [`Panel`], such as a tolerance. One that lies far outside the data is not drawn, since it would
/// flatten them: the panel then says so in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Name in the legend: `tolerance`.
    pub name: String,
    /// Ordinate of the line in the unit of the y axis.
    pub value: f64,
}

/// Auxiliary line of a [`Panel`]: a margin of a Bode diagram, a line of equal damping. It does not widen the axes; an
/// infinite coordinate stands for the edge of the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Corners (x, y) of the line, in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Name in the legend; may be empty.
    pub name: String,
    /// Label at its last corner; may be empty.
    pub label: String,
    /// Visual weight.
    pub weight: Weight,
}

/// Visual weight of a [`Guide`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// As the grid.
    Faint,
    /// As the axes.
    Axis,
    /// Dotted, as a limit.
    Dotted,
    /// Thick, to be read.
    Strong,
}

/// Size of a picture in CSS pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Width `[px]`.
    pub width: f64,
    /// Height `[px]`.
    pub height: f64,
}

impl Axis {
    /// Creates a linear axis with a label and the unit of its data as it is shown, such as `m/s`; empty for none.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// Creates the axis of time, in seconds.
    pub fn time() -> Self {
        Self::new("time", "s")
    }
}

impl Panel {
    /// Creates a panel over a vertical axis, without series and title, of share 1.
    pub fn new(y: Axis) -> Self {
        Self {
            title: String::new(),
            y,
            share: 1.0,
            series: Vec::new(),
            bands: Vec::new(),
            limits: Vec::new(),
            guides: Vec::new(),
            remark: String::new(),
        }
    }

    /// Creates the low panel beneath a signal for the error `simulated − reference`, in that signal's unit.
    pub fn error(unit: impl Into<String>) -> Self {
        Self { title: "simulated − reference".into(), share: 0.42, ..Self::new(Axis::new("error", unit)) }
    }
}

impl Stroke {
    /// Returns true if the points stand alone.
    fn is_loose(self) -> bool {
        !matches!(self, Self::Line | Self::Steps)
    }
}

impl Series {
    /// Creates a curve of straight lines for signal 0 from abscissae and ordinates, in the units of the axes.
    pub fn new(name: impl Into<String>, role: Role, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { name: name.into(), role, signal: 0, stroke: Stroke::Line, x, y }
    }

    /// The points, as far as both coordinates go.
    fn points(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

impl Size {
    /// Size at which a figure reads well on a screen: 880 px wide, higher if it has more than one panel.
    pub fn wide(figure: &Figure) -> Self {
        let height = if figure.space.is_some() { 560.0 } else { 130.0 + 280.0 * total_share(figure) };
        Self { width: 880.0, height }
    }

    /// Size at which a figure reads well on a phone: 400 px wide, higher if it has more than one panel.
    pub fn narrow(figure: &Figure) -> Self {
        let height = if figure.space.is_some() { 400.0 } else { 150.0 + 210.0 * total_share(figure) };
        Self { width: 400.0, height }
    }
}

/// Draws the figure as a standalone SVG file: valid XML with its own styles on a light background. The same figure
/// gives the same bytes.
pub fn svg(figure: &Figure, size: Size) -> String {
    draw::picture(figure, size, draw::Kind::Standalone)
}

/// The figure as an `<svg>` element for an HTML page that carries [`PAGE_CSS`] and the colour variables it names.
pub(crate) fn inline_svg(figure: &Figure, size: Size) -> String {
    draw::picture(figure, size, draw::Kind::Inline)
}

/// The first panel alone, small, without title and remarks, for a page that carries [`PAGE_CSS`].
pub(crate) fn thumbnail(figure: &Figure, size: Size) -> String {
    draw::picture(figure, size, draw::Kind::Thumbnail)
}

/// Sum of the panels' shares, at least one panel's worth, at most six.
fn total_share(figure: &Figure) -> f64 {
    figure.panels.iter().map(Panel::usable_share).sum::<f64>().clamp(1.0, 6.0)
}

impl Panel {
    /// The share, kept within what can be drawn.
    fn usable_share(&self) -> f64 {
        if self.share.is_finite() { self.share.clamp(0.2, 5.0) } else { 1.0 }
    }
}

#[cfg(test)]
mod tests;
