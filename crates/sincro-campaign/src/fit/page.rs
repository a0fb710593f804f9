//! `report.html` of a fit: values with their intervals, what the data cannot tell, then pictures.

use sincro_figures::plot::number::{short, significant};
use sincro_figures::plot::{Axis, Figure, Limit, Panel, Role, Series, Stroke, escape, escape_raised};
use sincro_figures::report::figure;
use sincro_figures::report::shell::{PLOT_SCRIPT, cell, document, list, paragraph, sections, settings, table};

use super::Fit;
use super::exact::unit;

/// Columns whose figures are drawn.
const MAX_FIGURES: usize = 8;

/// The page.
pub(super) fn html(fit: &Fit<'_>) -> String {
    let all = [
        ("Parameters", estimates(fit)),
        ("Identifiability", identifiability(fit)),
        ("Data and model", figures(fit)),
        ("Whiteness", whiteness(fit)),
        ("Held back", validation(fit)),
        ("Correlation", correlation(fit)),
        ("Settings", settings(&setting_rows(fit))),
    ]
    .map(|(heading, content)| (heading.to_owned(), content));
    let title = format!("{}: fit", fit.title);
    document(&title, "report", &(header(fit) + &sections(&all) + PLOT_SCRIPT))
}

fn header(fit: &Fit<'_>) -> String {
    let (n, identifiable) =
        (fit.inference.estimates.len(), fit.inference.estimates.iter().filter(|e| e.is_identifiable).count());
    let (class, symbol, words) = match (fit.solution.has_converged, identifiable == n) {
        (false, _) => ("bad", "✗", "the fit has not converged".to_owned()),
        (true, false) => ("bad", "✗", format!("{identifiable} of {n} parameters are identifiable")),
        (true, true) => ("good", "✓", format!("all {n} parameters are identifiable")),
    };
    format!(
        "<header>\n<h1>{}</h1>\n{}<div class=\"banner {class}\" role=\"status\"><p class=\"verdict\"><span aria-hidden=\"true\">{symbol}</span> \
         {words}</p></div>\n</header>\n",
        escape(&format!("{}: fit", fit.title)),
        paragraph(
            "lead",
            &format!(
                "Fitted to {} measured values in {}.",
                fit.inference.n_values,
                match fit.model.sets.len() {
                    1 => "one file".to_owned(),
                    n => format!("{n} files"),
                }
            )
        )
    )
}

fn estimates(fit: &Fit<'_>) -> String {
    let names = fit.model.names();
    let rows: Vec<String> = (0..names.len())
        .map(|k| {
            let of = &fit.inference.estimates[k];
            let num = |label: &str, x: f64, digits: usize| cell(label, "num", &escape_raised(&significant(x, digits)));
            let (low, high) = (of.value - of.half_width, of.value + of.half_width);
            let (std, low, high) = if of.is_identifiable {
                (num("Std", of.std, 2), num("From", low, 5), num("To", high, 5))
            } else {
                (cell("Std", "num", "not identifiable"), cell("From", "num", "–"), cell("To", "num", "–"))
            };
            let bound = if fit.solution.at_bound[k] { " <small>at its bound</small>" } else { "" };
            [
                cell("Parameter", "name", &format!("<code>{}</code>{bound}", escape(&names[k]))),
                num("Start", fit.model.bounds(k).0, 5),
                num("Value", of.value, 6),
                std,
                low,
                high,
            ]
            .concat()
        })
        .collect();
    let columns =
        [("", "Parameter"), ("num", "Start"), ("num", "Value"), ("num", "Std"), ("num", "From"), ("num", "To")];
    table("fold", &columns, &rows)
        + &format!(
            "<p class=\"key\">From and to: the interval at {} % confidence, from the sensitivities at the solution and the spread of the \
             residuals. Run with these values: <code>{}</code></p>\n",
            short(100.0 * fit.options.confidence, 4),
            escape(&fit.command())
        )
}

fn identifiability(fit: &Fit<'_>) -> String {
    let words: Vec<String> =
        fit.inference.unidentifiable.iter().map(|unidentifiable| fit.unidentifiable_words(unidentifiable)).collect();
    let singular: Vec<String> = fit.inference.singular.iter().map(|s| significant(*s, 2)).collect();
    let verdict =
        if words.is_empty() { paragraph("", "Every parameter is identifiable from these data.") } else { list(&words) };
    format!(
        "{verdict}<p class=\"key\">Singular values of the sensitivities, each parameter in units of its value, relative to the largest: {}. A \
         combination of parameters with a small one hardly changes what was measured.</p>\n",
        escape_raised(&singular.join(", "))
    )
}

fn figures(fit: &Fit<'_>) -> String {
    let figures: String = fit
        .columns()
        .into_iter()
        .take(MAX_FIGURES)
        .map(|(set, column, range)| {
            let label = column.signal.rsplit('/').next().unwrap_or(&column.signal);
            let unit = unit(fit.model.loaded, &column.signal);
            let mut panel = Panel::new(Axis::new(label, unit.clone()));
            let series = |name: &str, role, stroke, y: &[f64]| Series {
                stroke,
                ..Series::new(name, role, set.times.clone(), y.to_vec())
            };
            panel.series.push(series("start", Role::Variant(0), Stroke::Line, &fit.predicted.0[range.clone()]));
            panel.series.push(series("fitted", Role::Simulated, Stroke::Line, &fit.predicted.1[range.clone()]));
            panel.series.push(series("measured", Role::Reference, Stroke::Points, &column.values));
            let mut below =
                Panel { title: "fitted − measured".into(), share: 0.5, ..Panel::new(Axis::new("residual", unit)) };
            let residuals: Vec<f64> = fit.solution.residuals[range].iter().map(|r| r / column.weight).collect();
            below.series.push(series("", Role::Simulated, Stroke::Points, &residuals));
            let title = format!("{} in {}", column.column, set.path.display());
            figure(&Figure { title, x: Axis::time(), panels: vec![panel, below], space: None })
        })
        .collect();
    format!("<div class=\"figures\">\n{figures}</div>\n")
}

fn whiteness(fit: &Fit<'_>) -> String {
    let figures: String = fit
        .columns()
        .into_iter()
        .zip(fit.whiteness())
        .take(MAX_FIGURES)
        .filter_map(|((_, column, _), white)| {
            let white = white?;
            let mut panel = Panel::new(Axis::new("autocorrelation", ""));
            let lags: Vec<f64> = (1..=white.autocorrelation.len()).map(|k| k as f64).collect();
            panel.series.push(Series {
                stroke: Stroke::Points,
                ..Series::new(
                    format!("p = {}", significant(white.p_value, 2)),
                    Role::Simulated,
                    lags,
                    white.autocorrelation,
                )
            });
            panel.limits.push(Limit { name: "white noise, 19 of 20".into(), value: white.bound });
            panel.limits.push(Limit { name: String::new(), value: -white.bound });
            let title = format!("Residuals of {}", column.column);
            Some(figure(&Figure { title, x: Axis::new("lag", "samples"), panels: vec![panel], space: None }))
        })
        .collect();
    if figures.is_empty() {
        return figures;
    }
    format!(
        "<div class=\"figures\">\n{figures}</div>\n<p class=\"key\">Residuals of a model that misses nothing are white noise. p is the \
         probability that white noise is as correlated (Ljung and Box); below 0.01 the model misses something, and the intervals above are too narrow.</p>\n"
    )
}

fn validation(fit: &Fit<'_>) -> String {
    let rows: Vec<String> = fit
        .validation
        .iter()
        .map(|(set, predicted)| {
            let share = super::share(set, predicted);
            [
                cell("File", "name", &escape(&set.path.display().to_string())),
                cell("Fit", "num", &format!("{} %", significant(100.0 * share, 4))),
            ]
            .concat()
        })
        .collect();
    table("fold", &[("", "File"), ("num", "Fit")], &rows)
}

fn correlation(fit: &Fit<'_>) -> String {
    let names = fit.model.names();
    if names.len() < 2 {
        return String::new();
    }
    let head: Vec<String> = (1..=names.len()).map(|k| k.to_string()).collect();
    let mut columns = vec![("", "Parameter")];
    columns.extend(head.iter().map(|k| ("num", k.as_str())));
    let rows: Vec<String> = fit
        .inference
        .correlation
        .iter()
        .enumerate()
        .map(|(k, row)| {
            let cells: String =
                row.iter().zip(&head).map(|(x, label)| cell(label, "num", &significant(*x, 2))).collect();
            cell("Parameter", "name", &format!("{} <code>{}</code>", k + 1, escape(&names[k]))) + &cells
        })
        .collect();
    table("fold", &columns, &rows)
}

fn setting_rows(fit: &Fit<'_>) -> Vec<(String, String)> {
    let files: Vec<String> = fit.model.sets.iter().map(|set| set.path.display().to_string()).collect();
    vec![
        ("data".into(), files.join(", ")),
        ("loss".into(), fit.options.loss.word().into()),
        ("method".into(), "Levenberg–Marquardt within bounds".into()),
        ("start".into(), fit.shot.as_ref().map_or_else(|| "as given".to_owned(), super::Shot::words)),
        ("sensitivities".into(), fit.solution.sensitivities.words(&fit.model.names()).join("; ")),
        ("iterations".into(), fit.solution.n_iterations.to_string()),
        ("runs".into(), fit.model.n_runs().to_string()),
        ("runs on dual numbers".into(), fit.model.n_dual_runs().to_string()),
        ("standard deviation of the residuals, weighted".into(), significant(fit.inference.sigma, 4)),
        ("sincro".into(), env!("CARGO_PKG_VERSION").into()),
    ]
}
