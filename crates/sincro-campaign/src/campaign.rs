//! A campaign that is ready to run: its plan with the scene loaded once, and run `k` of it.

use std::hash::Hasher;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::check::{Check, Expected, Measure, Sense};
use sincro_scene::open::settings_with;
use sincro_scene::overrides::Override;
use sincro_scene::record::Recorder;
use sincro_scene::suggest;
use sincro_sim::Loaded;
use sincro_sim::campaign::audit;
use sincro_sim::check::{Verdict, evaluate};
use sincro_sim::results::Status;
use sincro_sim::run::{RunError, RunMonitor, RunOptions, simulate};
use sincro_sim::table::Table;
use twox_hash::XxHash3_64;

use crate::plan::{Checks, Plan, RunPoint};
use crate::row::{Layout, Row};

/// Campaign that is ready to run: a plan with its scene loaded once. [`Campaign::run`] makes one run of it,
/// [`crate::run_shard`] all.
///
/// ```
/// use std::sync::atomic::AtomicBool;
///
/// use sincro_campaign::{Campaign, Plan};
/// use sincro_sim::prelude::{Extensions, load};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/plan.toml"); // where the plan would stand
/// let text = r#"
///     scene = "acrobot"
///     runs = 3
///     set = { duration = 0.1 }
///     parameter = [{ path = "/shoulder.initial.position", uniform = { from = 0.0, to = 0.2 } }]
///     measure = [{ name = "angle", signal = "/shoulder.position", unit = "rad" }]
/// "#;
/// let plan = Plan::parse(path.as_ref(), text.to_owned())?;
/// let campaign = Campaign::new(plan, |folder, settings| load(folder, settings, Extensions::default()))?;
/// let row = campaign.run(0, &AtomicBool::new(false))?.expect("not interrupted");
/// assert_eq!((campaign.plan.n_runs(), row.status), (3, "completed"));
/// assert!((0.0..0.2).contains(&row.parameters[0]) && row.measures[0] < row.parameters[0]); // it swings back
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Campaign {
    /// Plan as it was read.
    pub plan: Plan,
    /// Scene and experiment with the settings of the plan, before those of variants and parameters.
    pub loaded: Loaded,
    /// Parts of the experiment in the order of the plan.
    variants: Vec<VariantPlan>,
    /// Names of the result columns of parameters and measures, in their order.
    pub layout: Layout,
    /// Hash of everything that the results depend on (plan, scene files, model, tables, version): 16 hexadecimal
    /// digits. Results of equal hashes may be put together.
    pub input: String,
}

/// A part of the experiment: its settings and its checks.
#[derive(Clone, Debug)]
struct VariantPlan {
    name: String,
    settings: Vec<Override>,
    /// Checks that are measured, each with its place among the measures.
    checks: Vec<(usize, Check)>,
    own_checks: Vec<Check>,
    inherits: bool,
    /// Settings that take away what rows do not need; the motion is the same.
    light: Vec<Override>,
}

/// Description of a parameter or measure, which the manifest of a campaign keeps beside the results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// Unit as text; may be empty.
    pub unit: String,
    /// Distribution or kind of measure in English, such as `uniform from 1 to 2`.
    pub words: String,
    /// Upper limit of a good run, in the column's unit, if there is one.
    pub at_most: Option<f64>,
    /// Lower limit of a good run, in the column's unit, if there is one.
    pub at_least: Option<f64>,
}

impl Campaign {
    /// Prepares a plan; `load` opens a scene folder with settings, usually `sincro_sim::load` with the extensions of
    /// the program. The paths of all parameters are tried before anything runs.
    ///
    /// # Errors
    ///
    /// All findings at once: those of `load`, variants and checks that do not exist, formulas that mean nothing, a
    /// campaign without measures, paths of parameters that reach nothing.
    pub fn new(
        plan: Plan,
        load: impl Fn(&std::path::Path, &[Override]) -> Result<Loaded, Diagnostics>,
    ) -> Result<Self, Diagnostics> {
        let loaded = load(&plan.scene, &plan.set)?;
        let mut found = Diagnostics::new();
        let mut variants = Vec::new();
        let mut checks: Vec<String> = Vec::new();
        for name in &plan.variants {
            let known = &loaded.experiment.variants;
            let (settings, own, inherits) = if name.value == "main" {
                (plan.set.clone(), Vec::new(), true)
            } else if let Some(variant) = known.iter().find(|v| v.name == name.value) {
                (settings_with(&plan.set, &variant.set), variant.checks.clone(), variant.inherit_checks)
            } else {
                let names: Vec<&str> = ["main"].into_iter().chain(known.iter().map(|v| v.name.as_str())).collect();
                let problem = Diagnostic::error(&name.at, format!("there is no variant `{}`", name.value));
                found.push(problem.with_help(suggest::help(&name.value, &names, "parts of this experiment")));
                continue;
            };
            let inherited = if inherits { loaded.experiment.checks.as_slice() } else { &[] };
            let measured = |check: &&Check| match &plan.checks {
                // a reference is that of the files as they are, not of drawn numbers
                Checks::All => !matches!(check.expected, Expected::Reference(_)),
                Checks::None => false,
                Checks::Named(names) => names.contains(&check.name),
            };
            let mut of_variant = Vec::new();
            for check in own.iter().chain(inherited).filter(measured) {
                let place = checks.iter().position(|known| *known == check.name).unwrap_or_else(|| {
                    checks.push(check.name.clone());
                    checks.len() - 1
                });
                of_variant.push((plan.measures.len() + place, check.clone()));
            }
            // a check that wants a divergence ends its run
            let ends = own.iter().chain(inherited).any(|check| check.measure == Measure::Divergence);
            let unneeded = ["plot", "variant", "check"].into_iter();
            let unneeded = unneeded.filter(|key| *key != "check" || (of_variant.is_empty() && !ends));
            variants.push(VariantPlan {
                light: unneeded.map(|key| Override::new(key, "[]")).collect(),
                name: name.value.clone(),
                settings,
                checks: of_variant,
                own_checks: own,
                inherits,
            });
        }
        if let Checks::Named(names) = &plan.checks {
            for name in names.iter().filter(|name| !checks.contains(name)) {
                let all = loaded.experiment.checks.iter().map(|c| c.name.as_str());
                let all: Vec<&str> = all.collect();
                let problem = Diagnostic::without_location(format!("there is no check `{name}` to be measured"));
                found.push(problem.with_help(suggest::help(name, &all, "checks")));
            }
        }
        for measure in &plan.measures {
            found.merge(measure.check(&loaded.experiment).err().unwrap_or_default());
        }
        let layout = Layout {
            parameters: plan.parameters.iter().map(|p| p.name.clone()).collect(),
            measures: plan
                .measures
                .iter()
                .map(|m| m.name.clone())
                .chain(checks.iter().map(|c| check_column(c)))
                .collect(),
        };
        if layout.measures.is_empty() {
            let problem = Diagnostic::without_location("the campaign measures nothing".to_owned());
            found.push(problem.with_help("add a [[measure]] to the plan, or checks to the scene"));
        }
        if found.any_error() {
            return Err(found.sorted());
        }
        let input = input_hash(&plan, &loaded);
        let campaign = Self { plan, loaded, variants, layout, input };
        campaign.try_paths()?;
        Ok(campaign)
    }

    /// Refuses parameters whose path reaches nothing and signals that are not there, before anything runs.
    fn try_paths(&self) -> Result<(), Diagnostics> {
        for variant_idx in 0..self.variants.len() {
            // a drawn value may be refused, and that is a result; but then other values are not
            let runs = (0..16_u64).map(|k| k * self.variants.len() as u64 + variant_idx as u64);
            let mut first = None;
            let found = runs
                .filter(|k| *k == variant_idx as u64 || *k < self.plan.n_runs())
                .find_map(|k| self.loaded_at(&self.plan.point(k)).map_err(|refused| first.get_or_insert(refused)).ok());
            match (found, first) {
                (Some(Loaded { experiment, scene, controller, .. }), _) => {
                    let entries = controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
                    Recorder::new(&experiment.record, &scene.model, &entries)?;
                }
                (None, Some(first)) => return Err(first),
                (None, None) => {}
            }
        }
        Ok(())
    }

    /// Returns the settings of a run: those of the plan, of its variant, of its parameters, in this order; later ones
    /// win. `point` comes from [`Plan::point`] of the same plan.
    #[must_use]
    pub fn settings(&self, point: &RunPoint) -> Vec<Override> {
        let variant = &self.variants[point.variant_idx];
        variant.settings.iter().cloned().chain(self.plan.settings(point)).collect()
    }

    /// Name of the part of the experiment of a run.
    #[must_use]
    fn variant_name(&self, point: &RunPoint) -> &str {
        &self.variants[point.variant_idx].name
    }

    /// Returns the scene of a run with all its settings, its checks, and the signals that its measures need recorded;
    /// `point` comes from [`Plan::point`] of the same plan.
    ///
    /// # Errors
    ///
    /// The findings of the scene, if it refuses the values of the parameters.
    pub fn loaded_at(&self, point: &RunPoint) -> Result<Loaded, Diagnostics> {
        self.loaded_with(point, &[])
    }

    /// As [`Campaign::loaded_at`], with further settings `more` behind those of the run: they win.
    ///
    /// # Errors
    ///
    /// The findings of the scene, if it refuses the values.
    pub fn loaded_with(&self, point: &RunPoint, more: &[Override]) -> Result<Loaded, Diagnostics> {
        let variant = &self.variants[point.variant_idx];
        let settings: Vec<Override> = self.settings(point).into_iter().chain(more.iter().cloned()).collect();
        let mut loaded = self.loaded.with_overrides_without_variants(&settings)?;
        let of_measures = self.plan.measures.iter().flat_map(|m| m.source.subject.signals());
        for signal in of_measures.chain(&self.plan.signals) {
            if !loaded.experiment.record.iter().any(|known| known.value == signal.value) {
                loaded.experiment.record.push(signal.clone());
            }
        }
        let experiment = &mut loaded.experiment;
        let inherited = if variant.inherits { std::mem::take(&mut experiment.checks) } else { Vec::new() };
        experiment.checks = variant.own_checks.iter().cloned().chain(inherited).collect();
        experiment.keep_one_run();
        if variant.name != "main" {
            experiment.title += &format!(" ({})", variant.name);
        }
        Ok(loaded)
    }

    /// Makes run `k` (from 0, below [`Plan::n_runs`]) and returns its row; `None` if `interrupt` became true before its
    /// end. A scene that refuses the values gives a row with the status `refused`.
    ///
    /// # Errors
    ///
    /// [`RunError::Diagnostics`]: the run could not be begun, such as for a measured signal that does not exist.
    pub fn run(&self, k: u64, interrupt: &AtomicBool) -> Result<Option<Row>, RunError> {
        self.run_with(k, &[], interrupt)
    }

    /// As [`Campaign::run`], with further settings `more` behind those of the run: they win.
    ///
    /// # Errors
    ///
    /// As [`Campaign::run`].
    pub fn run_with(&self, k: u64, more: &[Override], interrupt: &AtomicBool) -> Result<Option<Row>, RunError> {
        let point = self.plan.point(k);
        let mut row = Row {
            k,
            sample: point.sample,
            variant: self.variant_name(&point).to_owned(),
            seed: point.seed.unwrap_or(self.loaded.experiment.seed),
            parameters: point.values.clone(),
            measures: vec![f64::NAN; self.layout.measures.len()],
            status: "refused",
            t_end: 0.0,
            is_good: false,
            n_failed: 0,
            n_findings: 0,
            trace: String::new(),
            reason: String::new(),
            series: Vec::new(),
        };
        // what a row does not need is not read: references, variants, plots
        let light = self.variants[point.variant_idx].light.iter().cloned();
        let more: Vec<Override> = more.iter().cloned().chain(light).collect();
        let loaded = match self.loaded_with(&point, &more) {
            Ok(loaded) => loaded,
            Err(found) => {
                let first = found.0.into_iter().find(Diagnostic::is_error);
                row.reason = first.map_or_else(String::new, |problem| problem.message);
                return Ok(Some(row));
            }
        };
        let mut monitor = RunMonitor { interrupt, progress: &mut |_| {} };
        let run = simulate(&loaded, RunOptions::default(), &mut monitor)?;
        row.t_end = run.table.times().last().copied().unwrap_or(0.0);
        row.trace = run.trace.to_string();
        if !self.plan.signals.is_empty() {
            row.series = self.series(&run.table);
        }
        row.n_findings = audit(&loaded, &run, None).findings.len() as u64;
        match &run.status {
            Status::Completed => row.status = "completed",
            Status::Ended { .. } => row.status = "ended",
            Status::Stopped { reason, .. } => {
                row.status = "stopped";
                row.reason.clone_from(reason);
            }
            Status::Interrupted { .. } => return Ok(None),
        }
        let stopped = run.status.stopped_at();
        let is_whole = run.status.is_good();
        let mut keeps = is_whole;
        for (j, measure) in self.plan.measures.iter().enumerate() {
            let check = measure.check(&loaded.experiment)?;
            let value = evaluate(&[check], &run.table, stopped).first().and_then(|o| o.measured).unwrap_or(f64::NAN);
            row.measures[j] = if is_whole { value } else { f64::NAN };
            let is_above = measure.at_least.is_none_or(|bound| value >= bound);
            keeps &= is_above && measure.at_most.is_none_or(|bound| value <= bound);
        }
        for (j, check) in &self.variants[point.variant_idx].checks {
            // limits may be formulas of parameters that the run sets
            let own = loaded.experiment.checks.iter().find(|c| c.name == check.name).unwrap_or(check);
            let outcomes = evaluate(std::slice::from_ref(own), &run.table, stopped);
            let Some(outcome) = outcomes.first() else { continue };
            row.measures[*j] = outcome.measured.filter(|_| is_whole).unwrap_or(f64::NAN);
            row.n_failed += u64::from(outcome.verdict == Verdict::Fails);
        }
        row.is_good = keeps && row.n_failed == 0;
        Ok(Some(row))
    }

    /// Series of the signals that are kept, with their times first.
    fn series(&self, table: &Table) -> Vec<Vec<f64>> {
        let every = usize::try_from(self.plan.signals_every).unwrap_or(usize::MAX);
        let thin = |values: &[f64]| values.iter().copied().step_by(every).collect::<Vec<f64>>();
        let signal = |name: &String| table.column(name).map_or(&[][..], |c| c.values.as_slice());
        let signals = self.plan.signals.iter().map(|name| thin(signal(&name.value)));
        std::iter::once(thin(table.times())).chain(signals).collect()
    }

    /// Descriptions of the parameters.
    #[must_use]
    pub(crate) fn parameter_columns(&self) -> Vec<Column> {
        let column = |p: &crate::plan::Parameter| Column {
            name: p.name.clone(),
            unit: p.unit.clone(),
            words: p.distribution.words(),
            at_most: None,
            at_least: None,
        };
        self.plan.parameters.iter().map(column).collect()
    }

    /// Descriptions of the measures.
    #[must_use]
    pub(crate) fn measure_columns(&self) -> Vec<Column> {
        let own = self.plan.measures.iter().map(|m| Column {
            name: m.name.clone(),
            unit: m.unit.clone(),
            words: m.source.kind.word().to_owned(),
            at_most: m.at_most,
            at_least: m.at_least,
        });
        let mut all: Vec<Column> = own.collect();
        for (j, check) in self.variants.iter().flat_map(|v| &v.checks) {
            if *j == all.len() {
                let bound = match check.expected {
                    Expected::Value(value) => Some(value),
                    _ => None,
                };
                all.push(Column {
                    name: self.layout.measures[*j].clone(),
                    unit: String::new(),
                    words: format!("{} of a check", check.measure.word()),
                    at_most: bound.filter(|_| check.sense == Sense::AtMost),
                    at_least: bound.filter(|_| check.sense == Sense::AtLeast),
                });
            }
        }
        all
    }
}

/// Name of the column of a check.
fn check_column(name: &str) -> String {
    format!("check: {name}")
}

/// Hash of the plan, the files of the scene, the settings and the version.
fn input_hash(plan: &Plan, loaded: &Loaded) -> String {
    let mut hasher = XxHash3_64::with_seed(0);
    let mut add = |text: &str| {
        hasher.write(&(text.len() as u64).to_le_bytes());
        hasher.write(text.as_bytes());
    };
    add(env!("CARGO_PKG_VERSION"));
    add(&plan.source.text);
    let mut sources: Vec<(String, &str)> = loaded
        .sources
        .iter()
        .map(|source| {
            (source.path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned()), source.text.as_str())
        })
        .collect();
    sources.sort();
    for (name, text) in &sources {
        add(name);
        add(text);
    }
    // meshes and tables are in the numbers of the model and of the draws
    add(&sincro_sim::trace::plant_hash(loaded));
    for parameter in &plan.parameters {
        if let crate::design::Distribution::Table { values, .. } = &parameter.distribution {
            values.iter().for_each(|value| add(&value.to_bits().to_string()));
        }
    }
    format!("{:016x}", hasher.finish())
}
