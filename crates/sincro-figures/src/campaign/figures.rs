//! Which figures a run has, and what is drawn in them.
//!
//! A figure shows recorded signals of one unit, what the checks expect of them, the variants over them, and under them
//! the difference from what is expected, with the error bar of the run as a band and the tolerance as lines.

use sincro_scene::experiment::{Plot, Variant, path_components};
use sincro_sim::Loaded;
use sincro_sim::campaign::{Campaign, CompletedRun};
use sincro_sim::check::{Outcome, Series as Expected};
use sincro_sim::table::{Column, Table};

use super::digits::Rounding;
use crate::plot::{Axis, Band, Figure, Limit, Panel, Role, Series, Space, Stroke, Track};

/// Most signals in a figure that nobody asked for.
const MAX_SIGNALS: usize = 4;
/// Instants closer than this are the same `[s]`.
const SAME_INSTANT: f64 = 1e-9;

/// Figures of the results of an experiment: the sweep first, if it has one, then the plots that the experiment asks
/// for, or without any one for each kind of recorded signal.
#[must_use]
pub fn all(loaded: &Loaded, campaign: &Campaign) -> Vec<Figure> {
    let mut figures = sweep_figures(loaded, campaign);
    let plots = &loaded.experiment.plots;
    let (table, n_streams) = (&campaign.main.simulated.table, campaign.main.simulated.n_streams);
    let (recorded, streams) = table.columns.split_at(table.columns.len() - n_streams);
    if plots.is_empty() {
        figures.extend(groups(recorded).iter().map(|names| {
            let title = group_title(names);
            figure(&title, names, None, Below::default(), campaign)
        }));
    } else {
        figures.extend(plots.iter().map(|plot| asked_for(plot, campaign)));
    }
    let of_graphs = graphs(streams).into_iter();
    figures.extend(of_graphs.map(|(title, names)| figure(&title, &names, None, Below::default(), campaign)));
    figures
}

fn asked_for(plot: &Plot, campaign: &Campaign) -> Figure {
    if plot.is_path {
        return path(plot, campaign);
    }
    let names: Vec<&str> = plot.signals.iter().map(|s| s.value.as_str()).collect();
    let reference = plot.reference.as_ref().map(|r| Expected { times: r.keys.to_vec(), values: r.values.to_vec() });
    figure(&plot.title, &names, reference, Below::of(plot), campaign)
}

/// Paths in space, each with those of the variants.
fn path(plot: &Plot, campaign: &Campaign) -> Figure {
    let wanted = Below::of(plot);
    let mut space = Space::default();
    let mut add = |name: &str, role: Role, signal: usize, vector: &str, table: &Table| {
        let columns = path_components(vector).into_iter().find_map(|names| {
            let [x, y, z] = names.map(|name| table.column(&name));
            Some([x?, y?, z?])
        });
        let Some([x, y, z]) = columns else { return };
        let points = (0..table.n_rows()).map(|k| [x.values[k], y.values[k], z.values[k]]).collect();
        space.unit.clone_from(&x.unit);
        space.tracks.push(Track { name: name.to_owned(), role, signal, points });
    };
    for (k, signal) in plot.signals.iter().enumerate() {
        let of_variant = signal.value.split_once(':').and_then(|(of, vector)| {
            let (_, done) = campaign.variants.iter().find(|(variant, _)| variant.name == of)?;
            Some((vector, done))
        });
        if let Some((vector, done)) = of_variant {
            add(&signal.value, Role::Simulated, k, vector, &done.simulated.table);
            continue;
        }
        add(&signal.value, Role::Simulated, k, &signal.value, &campaign.main.simulated.table);
        for (v, (variant, done)) in campaign.variants.iter().enumerate().filter(|(_, (v, _))| wanted.draws(v)) {
            let name = variant_label(&variant.name, &signal.value, plot.signals.len());
            add(&name, Role::Variant(v), k, &signal.value, &done.simulated.table);
        }
    }
    Figure { title: plot.title.clone(), space: Some(space), ..Figure::default() }
}

/// Streams by their graph and unit, as clients and scripts made them.
fn graphs(streams: &[Column]) -> Vec<(String, Vec<&str>)> {
    let mut figures: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for column in streams {
        let graph = column.name.split_once('.').map_or(&*column.name, |(graph, _)| graph);
        match figures.iter_mut().find(|(g, unit, _)| *g == graph && *unit == column.unit) {
            Some((.., names)) => names.push(&column.name),
            None => figures.push((graph, &column.unit, vec![&column.name])),
        }
    }
    let title = |graph: &str| format!("Graph {graph}");
    figures.into_iter().map(|(graph, _, names)| (title(graph), names)).collect()
}

/// Recorded signals by what they are (`position`, `velocity`), at most [`MAX_SIGNALS`] together; time is the first
/// column.
fn groups(columns: &[Column]) -> Vec<Vec<&str>> {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for column in columns.iter().skip(1) {
        let key = format!("{} {}", quantity(&column.name), column.unit);
        match groups.iter_mut().find(|(k, names)| *k == key && names.len() < MAX_SIGNALS) {
            Some((_, names)) => names.push(&column.name),
            None => groups.push((key, vec![&column.name])),
        }
    }
    groups.into_iter().map(|(_, names)| names).collect()
}

/// `position` of `/arm/hinge.position.x`; `energy` of `energy.total`.
fn quantity(name: &str) -> &str {
    match name.split_once('.') {
        Some((object, rest)) if object.starts_with('/') => rest.split('.').next().unwrap_or(rest),
        Some((head, _)) => head,
        None => name.split('[').next().unwrap_or(name),
    }
}

fn group_title(names: &[&str]) -> String {
    if let [one] = names
        && *one == quantity(one)
    {
        return (*one).to_owned();
    }
    let what = quantity(names[0]).replace('_', " ");
    let what = what[..1].to_uppercase() + &what[1..];
    match names {
        [one] => format!("{what}: {one}"),
        _ => what,
    }
}

/// Options of a plot beside its signals.
#[derive(Clone, Copy, Default)]
struct Below<'a> {
    compares_variants: Option<bool>,
    variants: Option<&'a [String]>,
}

impl<'a> Below<'a> {
    fn of(plot: &'a Plot) -> Self {
        Self { compares_variants: plot.compares_variants, variants: plot.variants.as_deref() }
    }

    fn draws(&self, variant: &Variant) -> bool {
        self.variants.is_none_or(|names| names.contains(&variant.name))
    }
}

/// A figure of recorded signals, a panel for each unit; `reference` is drawn with the first one instead of what the
/// checks say.
fn figure(title: &str, names: &[&str], reference: Option<Expected>, wanted: Below<'_>, campaign: &Campaign) -> Figure {
    let mut by_unit: Vec<(&str, Vec<Drawn<'_>>)> = Vec::new();
    for drawn in names.iter().filter_map(|name| Drawn::find(name, campaign)) {
        let unit = drawn.column.unit.as_str();
        match by_unit.iter_mut().find(|(known, _)| *known == unit) {
            Some((_, list)) => list.push(drawn),
            None => by_unit.push((unit, vec![drawn])),
        }
    }
    let mut reference = reference;
    let panels = by_unit.iter().flat_map(|(unit, drawn)| panels(drawn, unit, reference.take(), wanted, campaign));
    let mut panels: Vec<Panel> = panels.collect();
    if panels.is_empty() {
        panels.push(Panel::new(Axis::new("", "")));
    }
    Figure { title: title.to_owned(), x: Axis::time(), panels, space: None }
}

/// Quantities of the signals, each once: `position, offset`.
fn quantities(drawn: &[Drawn<'_>]) -> String {
    let mut all: Vec<String> = Vec::new();
    for quantity in drawn.iter().map(|d| quantity(&d.column.name).replace('_', " ")) {
        if !all.contains(&quantity) {
            all.push(quantity);
        }
    }
    // more than an axis is long
    if all.len() > 3 { String::new() } else { all.join(", ") }
}

/// Signals of one unit, and below them how far they are from what is expected, or variants from the main run.
fn panels(
    drawn: &[Drawn<'_>],
    unit: &str,
    reference: Option<Expected>,
    wanted: Below<'_>,
    campaign: &Campaign,
) -> Vec<Panel> {
    let mut panel = Panel::new(Axis::new(quantities(drawn), unit));
    let mut error = Panel::error(unit);
    let mut rounding = None;
    for (k, Drawn { name, column, done, of_variant }) in drawn.iter().enumerate() {
        let times = done.simulated.table.times();
        panel.series.push(curve(column, name, Role::Simulated, k, times));
        let checked = expected_of(&done.outcomes, &column.name);
        let given = if k == 0 { reference.clone().map(|r| (r, None)) } else { None };
        if let Some((expected, tolerance)) = given.or(checked) {
            let label = if drawn.len() > 1 { format!("expected {name}") } else { "expected".to_owned() };
            let found = add_reference(&mut panel, &mut error, (k, column, times), (expected, &label), tolerance);
            rounding = Rounding::coarser(rounding, found);
            add_band(&mut error, k, column, done, times);
        }
        let others = if *of_variant { &[][..] } else { &campaign.variants };
        for (v, (variant, done)) in others.iter().enumerate().filter(|(_, (variant, _))| wanted.draws(variant)) {
            let other = &done.simulated.table;
            if let Some(same) = other.column(&column.name) {
                let label = variant_label(&variant.name, &column.name, drawn.len());
                panel.series.push(curve(same, &label, Role::Variant(v), k, other.times()));
            }
        }
    }
    error.remark = rounding.map(|rounding| rounding.remark(unit)).unwrap_or_default();
    let below = match wanted.compares_variants {
        Some(true) => comparison(drawn, unit, wanted, campaign),
        Some(false) => error,
        None if error.series.is_empty() => comparison(drawn, unit, wanted, campaign),
        None => error,
    };
    if below.series.is_empty() { vec![panel] } else { vec![panel, below] }
}

/// Name of a variant's curve in a legend: the variant's, and the signal's where there are several.
fn variant_label(variant: &str, signal: &str, n_signals: usize) -> String {
    if n_signals > 1 { format!("{variant}:{signal}") } else { variant.to_owned() }
}

/// Differences of the variants from the main run, where they have rows at the same times.
fn comparison(drawn: &[Drawn<'_>], unit: &str, wanted: Below<'_>, campaign: &Campaign) -> Panel {
    let mut panel = Panel { title: "variant − main run".into(), ..Panel::error(unit) };
    panel.y.label = "difference".into();
    let times = campaign.main.simulated.table.times();
    for (k, Drawn { column, .. }) in drawn.iter().enumerate().filter(|(_, d)| !d.of_variant) {
        let variants = campaign.variants.iter().enumerate().filter(|(_, (variant, _))| wanted.draws(variant));
        for (v, (_, done)) in variants {
            let other = &done.simulated.table;
            let Some(same) = other.column(&column.name) else { continue };
            let (mut x, mut y) = (Vec::new(), Vec::new());
            for (t, value) in other.times().iter().zip(&same.values) {
                let at = times.partition_point(|row| *row < t - SAME_INSTANT);
                if times.get(at).is_some_and(|row| (row - t).abs() <= SAME_INSTANT) {
                    x.push(*t);
                    y.push(value - column.values[at]);
                }
            }
            panel.series.push(Series { signal: k, ..Series::new("", Role::Variant(v), x, y) });
        }
    }
    panel
}

/// A signal in a figure: of the main run, drawn with its variants, or of one variant alone, as `variant:signal`.
struct Drawn<'a> {
    name: &'a str,
    column: &'a Column,
    done: &'a CompletedRun,
    of_variant: bool,
}

impl<'a> Drawn<'a> {
    fn find(name: &'a str, campaign: &'a Campaign) -> Option<Self> {
        let main = &campaign.main;
        if let Some(column) = main.simulated.table.column(name) {
            return Some(Self { name, column, done: main, of_variant: false });
        }
        let (of, signal) = name.split_once(':')?;
        let (_, done) = campaign.variants.iter().find(|(variant, _)| variant.name == of)?;
        let column = done.simulated.table.column(signal)?;
        Some(Self { name, column, done, of_variant: true })
    }
}

fn curve(column: &Column, name: &str, role: Role, signal: usize, times: &[f64]) -> Series {
    // commands hold from tick to tick, mean torques over the step that ends
    let stroke = if column.name.ends_with(".command") { Stroke::Steps } else { Stroke::Line };
    let series = Series::new(name, role, times.to_vec(), column.values.clone());
    Series { signal, stroke, ..series }
}

/// Expectation of a signal by the checks, and the tolerance if it is absolute: the check that looks at most rows, of
/// those the strictest.
fn expected_of(outcomes: &[Outcome], name: &str) -> Option<(Expected, Option<f64>)> {
    let of_signal = outcomes.iter().filter(|o| o.signal.as_deref() == Some(name) && o.series.is_some());
    let widest = of_signal.max_by(|a, b| a.n_rows.cmp(&b.n_rows).then(b.limit.total_cmp(&a.limit)))?;
    Some((widest.series.clone()?, (!widest.relative).then_some(widest.limit)))
}

/// Adds an expected curve, and the difference from it below. Returns the rounding of the reference where it limits what
/// the difference shows.
fn add_reference(
    panel: &mut Panel,
    error: &mut Panel,
    (signal, column, times): (usize, &Column, &[f64]),
    (expected, label): (Expected, &str),
    tolerance: Option<f64>,
) -> Option<Rounding> {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (t, value) in expected.times.iter().zip(&expected.values) {
        let at = times.partition_point(|row| *row < t - SAME_INSTANT);
        if times.get(at).is_some_and(|row| (row - t).abs() <= SAME_INSTANT) {
            x.push(*t);
            y.push(column.values[at] - value);
        }
    }
    let rounding = Rounding::limiting(&expected.values, &y);
    let reference = Series::new(label, Role::Reference, expected.times, expected.values);
    panel.series.push(Series { signal, ..reference });
    error.series.push(Series { signal, ..Series::new("", Role::Simulated, x, y) });
    if let (Some(tolerance), true) = (tolerance, error.limits.is_empty()) {
        error.limits.extend([tolerance, -tolerance].map(|value| Limit { name: "tolerance".into(), value }));
    }
    rounding
}

/// The error bar of the run around zero difference.
fn add_band(error: &mut Panel, signal: usize, column: &Column, done: &CompletedRun, times: &[f64]) {
    let bar = done.columns.iter().find(|c| c.path == column.name).and_then(|c| c.error_bar);
    let (Some(bar), Some(first), Some(last)) = (bar, times.first(), times.last()) else { return };
    if bar > 0.0 && bar.is_finite() {
        let name = if signal == 0 { "error bar of the run" } else { "" };
        error.bands.push(Band {
            name: name.into(),
            signal,
            x: vec![*first, *last],
            lower: vec![-bar; 2],
            upper: vec![bar; 2],
        });
    }
}

/// Static characteristics: one figure for each signal that the sweep's checks look at, or for all.
fn sweep_figures(loaded: &Loaded, campaign: &Campaign) -> Vec<Figure> {
    let (Some((sweep, outcomes)), Some(plan)) = (&campaign.sweep, &loaded.experiment.sweep) else {
        return Vec::new();
    };
    let runs = sweep.ascending();
    let table = sweep.table(&runs);
    let checked = |c: &&Column| outcomes.iter().any(|o| o.signal.as_deref() == Some(c.name.as_str()));
    let chosen: Vec<&Column> = table.columns.iter().skip(1).filter(checked).collect();
    let chosen = if chosen.is_empty() { table.columns.iter().skip(1).collect() } else { chosen };
    let one = |column: &&Column| {
        let mut panel = Panel::new(Axis::new(quantity(&column.name).replace('_', " "), column.unit.as_str()));
        let mut error = Panel::error(column.unit.as_str());
        let mut series = curve(column, &column.name, Role::Simulated, 0, table.times());
        series.stroke = Stroke::Points;
        panel.series.push(series);
        if let Some((expected, tolerance)) = expected_of(outcomes, &column.name) {
            let series = (0, *column, table.times());
            let rounding = add_reference(&mut panel, &mut error, series, (expected, "expected"), tolerance);
            error.remark = rounding.map(|rounding| rounding.remark(&column.unit)).unwrap_or_default();
        }
        error.series.iter_mut().for_each(|s| s.stroke = Stroke::Points);
        let panels = if error.series.is_empty() { vec![panel] } else { vec![panel, error] };
        let parameter = plan.parameter.value.rsplit('.').next().unwrap_or("parameter");
        let title = format!("Final {} over {}", quantity(&column.name), plan.parameter.value);
        Figure { title, x: Axis::new(parameter, sweep.unit.as_str()), panels, space: None }
    };
    chosen.iter().map(one).collect()
}
