//! From a plan file to a plan: distributions, grids, correlations, measures.

use std::path::{Path, PathBuf};

use sincro_math::elementary::{exp, ln};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};
use sincro_scene::overrides::Override;
use sincro_scene::suggest;
use sincro_sim::table::Table;
use toml::Spanned;

use super::file::{ChecksFile, MeasureFile, ParameterFile, PlanFile};
use super::read::Places;
use super::{Checks, Design, MAX_RUNS, Parameter, Plan};
use crate::design::{Distribution, sobol};
use crate::measure::{MeasurePlan, Source, Subject, measure_of_word, words_of_measures};

/// Most values of one factor of a grid.
const MAX_POINTS: usize = 1_000_000;

/// The plan of a file.
pub(super) fn resolve(file: PlanFile, places: &Places) -> Result<Plan, Diagnostics> {
    let mut found = Diagnostics::new();
    let folder = places.source.path.parent().unwrap_or(Path::new("")).to_path_buf();
    let mut tables = Tables { folder: folder.clone(), read: Vec::new() };
    let mut parameters: Vec<Parameter> = Vec::new();
    for parameter in &file.parameter {
        match resolve_parameter(parameter, places, &mut tables) {
            Ok(parameter) => parameters.push(parameter),
            Err(problem) => found.push(problem),
        }
    }
    let measures: Vec<MeasurePlan> =
        file.measure.iter().filter_map(|m| resolve_measure(m, places).map_err(|p| found.push(p)).ok()).collect();
    let n_drawn = parameters.iter().filter(|p| !p.distribution.is_grid()).count();
    let design = resolve_design(&file, places, &mut found);
    let n_draws = resolve_draws(&file, places, design, n_drawn, &mut found);
    let confidence = file.confidence.as_ref().map_or(0.95, |c| *c.get_ref());
    if let Some(confidence) = file.confidence.as_ref().filter(|c| !(0.5..1.0).contains(c.get_ref())) {
        found.push(places.error(confidence, "the confidence is a probability from 0.5 to below 1, such as 0.95"));
    }
    let most = max_drawn(design);
    if let Some(at) = file.design.as_ref().filter(|_| n_drawn > most) {
        let problem =
            places.error(at, format!("the design `{}` has at most {most} parameters, not {n_drawn}", design.word()));
        found.push(problem.with_help("take design = \"latin-hypercube\""));
    }
    let correlation = resolve_correlation(&file, places, &parameters, &mut found);
    if design == Design::Saltelli {
        refuse_for_saltelli(&file, places, &parameters, correlation.is_some(), &mut found);
    }
    let names = parameters.iter().map(|p| p.name.as_str()).chain(measures.iter().map(|m| m.name.as_str()));
    refuse_doubles(names, places, &mut found);
    let checks = match file.checks.as_ref().map(|c| (c, c.get_ref())) {
        None if measures.is_empty() => Checks::All,
        None => Checks::None,
        Some((_, ChecksFile::Names(names))) => Checks::Named(names.clone()),
        Some((_, ChecksFile::Word(word))) if word == "all" => Checks::All,
        Some((_, ChecksFile::Word(word))) if word == "none" => Checks::None,
        Some((at, ChecksFile::Word(word))) => {
            let problem = places.error(at, format!("`{word}` is not known for `checks`"));
            found.push(problem.with_help("write \"all\", \"none\" or a list of names of checks"));
            Checks::None
        }
    };
    if let Some(n) = file.rows_per_part.as_ref().filter(|n| *n.get_ref() == 0) {
        found.push(places.error(n, "`rows_per_part` is 0").with_help("write 1 or more, or leave it away"));
    }
    if let Some(n) = file.signals_every.as_ref().filter(|n| *n.get_ref() == 0) {
        found.push(places.error(n, "`signals_every` is 0").with_help("write 1 for every recorded row, or more"));
    }
    for (i, signal) in file.signals.iter().enumerate() {
        let name = signal.get_ref();
        if file.signals[..i].iter().any(|other| other.get_ref() == name) {
            found.push(places.error(signal, format!("`{name}` is kept twice")).with_help("leave one of them out"));
        }
    }
    refuse_twice(&file, places, &mut found);
    let located = |s: &Spanned<String>| Located { value: s.get_ref().clone(), at: places.of(s) };
    let mut variants: Vec<Located<String>> = file.variants.iter().map(located).collect();
    if variants.is_empty() {
        variants.push(Located { value: "main".into(), at: places.start() });
    }
    let setting = |(path, value): (&Spanned<String>, &Spanned<toml::Value>)| {
        let text = Override::new(path.get_ref(), &value.get_ref().to_string());
        Override { path: located(path), value: Located { value: text.value.value, at: places.of(value) } }
    };
    let set = file.set.iter().map(setting).collect();
    let plan = Plan {
        title: file.title.clone(),
        description: file.description.clone(),
        scene: file.scene.as_ref().map_or_else(|| folder.to_owned(), |scene| folder.join(scene.get_ref())),
        seed: file.seed,
        random_seeds: file.random_seeds,
        confidence,
        design,
        n_draws,
        parameters,
        correlation,
        variants,
        set,
        measures,
        checks,
        signals: file.signals.iter().map(located).collect(),
        signals_every: file.signals_every.as_ref().map_or(1, |n| (*n.get_ref()).max(1)),
        rows_per_part: file.rows_per_part.as_ref().map(|n| (*n.get_ref()).min(1 << 20)),
        source: places.source.clone(),
    };
    if plan.n_runs() > MAX_RUNS {
        let problem = Diagnostic::error(
            &places.start(),
            format!("{} are more than a campaign has", words_of_runs(plan.n_runs())),
        );
        found.push(problem.with_help(format!("make fewer: at most {MAX_RUNS}")));
    }
    if found.any_error() { Err(found.sorted()) } else { Ok(plan) }
}

fn words_of_runs(n: u64) -> String {
    if n == u64::MAX { "over 10¹⁹ runs".into() } else { format!("{n} runs") }
}

fn resolve_design(file: &PlanFile, places: &Places, found: &mut Diagnostics) -> Design {
    let Some(word) = &file.design else { return Design::LatinHypercube };
    let known: Vec<&str> = Design::ALL.iter().map(|d| d.word()).collect();
    Design::ALL.into_iter().find(|d| d.word() == word.get_ref()).unwrap_or_else(|| {
        let problem = places.error(word, format!("there is no design `{}`", word.get_ref()));
        found.push(problem.with_help(suggest::help(word.get_ref(), &known, "designs")));
        Design::Random
    })
}

fn resolve_draws(file: &PlanFile, places: &Places, design: Design, n_drawn: usize, found: &mut Diagnostics) -> u64 {
    let needs = n_drawn > 0 || file.random_seeds;
    match &file.runs {
        None if !needs => 1,
        None => {
            let problem = Diagnostic::error(&places.start(), "`runs` is missing: something is drawn at random");
            found.push(problem.with_help("add runs = 200, the number of draws for each variant and point of the grid"));
            1
        }
        Some(runs) if *runs.get_ref() == 0 => {
            found.push(places.error(runs, "`runs` is 0"));
            1
        }
        Some(runs) if design == Design::Saltelli => {
            let (n, block) = (*runs.get_ref(), n_drawn as u64 + 2);
            if !n.is_multiple_of(block) {
                let problem = places.error(runs, format!("the design `saltelli` needs a multiple of {block} runs"));
                found.push(problem.with_help(format!(
                    "{} parameters take blocks of {block}: write runs = {}",
                    n_drawn,
                    n.div_ceil(block) * block
                )));
            }
            n
        }
        Some(runs) => *runs.get_ref(),
    }
}

fn refuse_for_saltelli(
    file: &PlanFile,
    places: &Places,
    parameters: &[Parameter],
    is_correlated: bool,
    found: &mut Diagnostics,
) {
    let Some(at) = &file.design else { return };
    let tables = parameters.iter().filter(|p| matches!(p.distribution, Distribution::Table { .. })).count();
    if is_correlated || tables > 1 {
        let problem = places.error(at, "Sobol' indices are those of independent parameters");
        found.push(
            problem.with_help("take design = \"sobol\", or leave correlations and tables of several columns away"),
        );
    }
    let drawn = parameters.iter().filter(|p| !p.distribution.is_grid()).count();
    if drawn == 0 {
        found.push(places.error(at, "the design `saltelli` needs parameters that are drawn"));
    }
}

fn refuse_doubles<'a>(names: impl Iterator<Item = &'a str>, places: &Places, found: &mut Diagnostics) {
    let mut seen: Vec<&str> = crate::row::FIXED.to_vec();
    for name in names {
        if seen.contains(&name) {
            let problem = Diagnostic::error(&places.start(), format!("two columns of the results are called `{name}`"));
            found.push(problem.with_help("give a parameter or a measure another `name`"));
        }
        seen.push(name);
    }
}

/// Refuses variants that are named twice and paths that two parameters set.
fn refuse_twice(file: &PlanFile, places: &Places, found: &mut Diagnostics) {
    for (k, variant) in file.variants.iter().enumerate() {
        if file.variants[..k].iter().any(|other| other.get_ref() == variant.get_ref()) {
            found.push(places.error(variant, format!("the variant `{}` is named twice", variant.get_ref())));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for path in file.parameter.iter().flat_map(|p| std::iter::once(&p.get_ref().path).chain(&p.get_ref().also)) {
        if seen.contains(&path.get_ref().as_str()) {
            let problem = places.error(path, format!("`{}` is set by two parameters", path.get_ref()));
            found.push(problem.with_help("a number takes its value from one parameter"));
        }
        seen.push(path.get_ref());
    }
}

/// Tables of values that were read.
struct Tables {
    folder: PathBuf,
    read: Vec<(String, Table)>,
}

fn resolve_parameter(
    parameter: &Spanned<ParameterFile>,
    places: &Places,
    tables: &mut Tables,
) -> Result<Parameter, Diagnostic> {
    let file = parameter.get_ref();
    let located = |s: &Spanned<String>| Located { value: s.get_ref().clone(), at: places.of(s) };
    let given = [
        file.uniform.is_some(),
        file.log_uniform.is_some(),
        file.normal.is_some(),
        file.log_normal.is_some(),
        file.values.is_some(),
        file.range.is_some(),
        file.table.is_some(),
    ];
    let refuse = |message: String| Diagnostic::error(&places.of(&file.path), message);
    let path = file.path.get_ref();
    let n_given = given.iter().filter(|given| **given).count();
    if n_given != 1 {
        let problem = refuse(format!("`{path}` has {n_given} of the keys that say its values, not one"));
        return Err(problem.with_help("uniform, log_uniform, normal, log_normal, values, range or table"));
    }
    let distribution = distribution(file, places, tables)?;
    let is_sound = match &distribution {
        Distribution::Uniform { from, to } => from.is_finite() && to.is_finite() && from < to,
        Distribution::LogUniform { from, to } => *from > 0.0 && to.is_finite() && from < to,
        Distribution::Normal { mean, std, min, max } => {
            mean.is_finite() && *std > 0.0 && std.is_finite() && min < max && !min.is_nan() && !max.is_nan()
        }
        Distribution::LogNormal { median, sigma } => {
            *median > 0.0 && median.is_finite() && *sigma > 0.0 && sigma.is_finite()
        }
        Distribution::Table { values, .. } | Distribution::Grid(values) => {
            !values.is_empty() && values.iter().all(|x| x.is_finite())
        }
    };
    if !is_sound {
        let help = "bounds in ascending order (positive for logarithms), positive standard deviations, finite values";
        return Err(refuse(format!("the values of `{path}` mean nothing")).with_help(help));
    }
    if let Distribution::Normal { mean, std, min, max } = &distribution {
        let (low, high) = ((min - mean) / std, (max - mean) / std);
        if crate::design::normal_cdf(high) - crate::design::normal_cdf(low) < 1e-12 {
            return Err(refuse(format!("the bounds of `{path}` leave nothing of its distribution")));
        }
    }
    Ok(Parameter {
        name: file.name.clone().unwrap_or_else(|| path.clone()),
        paths: std::iter::once(&file.path).chain(&file.also).map(located).collect(),
        unit: file.unit.clone(),
        is_integer: file.integer,
        distribution,
    })
}

fn distribution(file: &ParameterFile, places: &Places, tables: &mut Tables) -> Result<Distribution, Diagnostic> {
    if let Some(b) = &file.uniform {
        return Ok(Distribution::Uniform { from: b.from, to: b.to });
    }
    if let Some(b) = &file.log_uniform {
        return Ok(Distribution::LogUniform { from: b.from, to: b.to });
    }
    if let Some(n) = &file.normal {
        let (min, max) = (n.min.unwrap_or(f64::NEG_INFINITY), n.max.unwrap_or(f64::INFINITY));
        return Ok(Distribution::Normal { mean: n.mean, std: n.std, min, max });
    }
    if let Some(n) = &file.log_normal {
        return Ok(Distribution::LogNormal { median: n.median, sigma: n.sigma });
    }
    if let Some(range) = &file.range {
        if range.points == 0 || range.points > MAX_POINTS {
            let message = format!("a range has from 1 to {MAX_POINTS} points");
            return Err(Diagnostic::error(&places.of(&file.path), message));
        }
        let share = |k: usize| if range.points == 1 { 0.0 } else { k as f64 / (range.points - 1) as f64 };
        let value = |k: usize| match range.log {
            // the ends are exact
            _ if k == 0 => range.from,
            _ if k + 1 == range.points => range.to,
            false => range.from + share(k) * (range.to - range.from),
            true => exp(ln(range.from).0 + share(k) * (ln(range.to).0 - ln(range.from).0)).0,
        };
        return Ok(Distribution::Grid((0..range.points).map(value).collect()));
    }
    if let Some(table) = &file.table {
        let name = table.file.get_ref();
        let k = match tables.read.iter().position(|(known, _)| known == name) {
            Some(k) => k,
            None => {
                let read = Table::read_csv(&tables.folder.join(name));
                let read = read.map_err(|error| places.error(&table.file, error.to_string()))?;
                tables.read.push((name.clone(), read));
                tables.read.len() - 1
            }
        };
        let columns = &tables.read[k].1;
        let column = columns.column(table.column.get_ref()).ok_or_else(|| {
            let known: Vec<&str> = columns.columns.iter().map(|c| c.name.as_str()).collect();
            let problem = places.error(&table.column, format!("`{name}` has no column `{}`", table.column.get_ref()));
            problem.with_help(suggest::help(table.column.get_ref(), &known, "columns"))
        })?;
        return Ok(Distribution::Table { file: k, values: column.values.as_slice().into() });
    }
    Ok(Distribution::Grid(file.values.clone().unwrap_or_default().into()))
}

/// Cholesky factor of the correlation matrix of the drawn parameters.
fn resolve_correlation(
    file: &PlanFile,
    places: &Places,
    parameters: &[Parameter],
    found: &mut Diagnostics,
) -> Option<Vec<Vec<f64>>> {
    if file.correlation.is_empty() {
        return None;
    }
    let drawn: Vec<&str> = parameters.iter().filter(|p| !p.distribution.is_grid()).map(|p| p.name.as_str()).collect();
    let n = drawn.len();
    let mut matrix: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for correlation in &file.correlation {
        let of = correlation.get_ref();
        let places_of: Vec<Option<usize>> =
            of.between.iter().map(|name| drawn.iter().position(|d| d == name)).collect();
        let (Some(i), Some(j)) = (places_of[0], places_of[1]) else {
            let problem = places.error(correlation, "a correlation is between two parameters that are drawn");
            found.push(problem.with_help(format!("by their names: {}", drawn.join(", "))));
            continue;
        };
        if i == j || of.value.is_nan() || of.value.abs() >= 1.0 {
            found.push(places.error(correlation, "a correlation lies between −1 and 1 and has two parameters"));
            continue;
        }
        let file_of = |name: &str| {
            let of = parameters.iter().find(|p| p.name == name).map(|p| &p.distribution);
            if let Some(Distribution::Table { file, .. }) = of { Some(*file) } else { None }
        };
        let is_joint = |name: &&str| {
            file_of(name).is_some_and(|file| drawn.iter().filter(|d| file_of(d) == Some(file)).count() > 1)
        };
        if let Some(name) = [drawn[i], drawn[j]].iter().find(|name| is_joint(name)) {
            let message =
                format!("`{name}` is drawn with other columns of its table, which say how they vary together");
            let problem = places.error(correlation, message);
            found.push(problem.with_help("leave the correlation away, or draw only one column of that table"));
            continue;
        }
        matrix[i][j] = of.value;
        matrix[j][i] = of.value;
    }
    let factor = cholesky(&matrix);
    if factor.is_none()
        && let Some(first) = file.correlation.first()
    {
        found.push(places.error(first, "no random numbers have all these correlations: the matrix is not positive"));
    }
    factor
}

fn cholesky(a: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = a.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            l[i][j] = match a[i][j] - sum {
                rest if i == j && rest > 1e-12 => rest.sqrt(),
                _ if i == j => return None,
                rest => rest / l[j][j],
            };
        }
    }
    Some(l)
}

fn resolve_measure(measure: &Spanned<MeasureFile>, places: &Places) -> Result<MeasurePlan, Diagnostic> {
    let file = measure.get_ref();
    let located = |s: &Spanned<String>| Located { value: s.get_ref().clone(), at: places.of(s) };
    let subject = match (&file.signal, &file.formula) {
        (Some(signal), None) => Subject::Signal(located(signal)),
        (None, Some(formula)) => Subject::Formula {
            text: located(formula),
            signals: file.signals.iter().map(|(alias, signal)| (alias.clone(), located(signal))).collect(),
        },
        _ => {
            let problem = places.error(measure, format!("the measure `{}` has not one subject", file.name));
            return Err(problem.with_help("give it a `signal`, or a `formula` with its `signals`"));
        }
    };
    let word = file.measure.as_ref().map_or("final", |word| word.get_ref());
    let kind = measure_of_word(word).ok_or_else(|| {
        let problem = Diagnostic::error(
            &file.measure.as_ref().map_or(places.start(), |m| places.of(m)),
            format!("there is no measure `{word}`"),
        );
        problem.with_help(suggest::help(word, &words_of_measures(), "measures"))
    })?;
    Ok(MeasurePlan {
        name: file.name.clone(),
        source: Source {
            subject,
            kind,
            at: file.at,
            window: file.window.map(|[a, b]| (a, b)),
            target: file.target,
            band: file.band.unwrap_or(0.02),
        },
        unit: file.unit.clone(),
        at_most: file.at_most,
        at_least: file.at_least,
        location: places.of(measure),
    })
}

/// Largest number of parameters of a design.
fn max_drawn(design: Design) -> usize {
    match design {
        Design::Random | Design::LatinHypercube => usize::MAX,
        Design::Sobol => sobol::MAX_DIMENSIONS,
        Design::Saltelli => sobol::MAX_DIMENSIONS / 2,
    }
}
