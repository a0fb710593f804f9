//! Error bars: the same run once more, finer; the difference of the recorded signals estimates the error of the coarser
//! one.
//!
//! This is the error of what the user sees, with everything that piles up over the run, and not the local error that a
//! method estimates of itself.

use sincro_dynamics::world::MethodKind;

use crate::load::Loaded;
use crate::results::ColumnReport;
use crate::run::{FINER, RunError, RunMonitor, RunOptions, Simulated, simulate};
use sincro_scene::experiment::ErrorBar;

/// The recorded columns with their error bars.
pub(super) fn columns(
    loaded: &Loaded,
    run: &Simulated,
    monitor: &mut RunMonitor<'_>,
) -> Result<Vec<ColumnReport>, RunError> {
    let mut columns = ColumnReport::of_table(&run.table);
    if loaded.experiment.error_bar == ErrorBar::None {
        return Ok(columns);
    }
    let finer = simulate(loaded, RunOptions { refined: true, ..RunOptions::default() }, monitor)?;
    let (factor, method) = estimate(run.method);
    // the first column is time, which is exact
    for (k, column) in columns.iter_mut().enumerate().skip(1) {
        // a script may have made another stream in the finer run
        let Some(fine) = finer.table.column(&column.path).map(|c| &c.values) else { continue };
        let coarse = &run.table.columns[k].values;
        let worst = coarse.iter().zip(fine).fold(0.0_f64, |worst, (a, b)| {
            // where both have no value, such as a signal that no script has set yet, they agree
            let difference = if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() };
            if difference.is_nan() { f64::INFINITY } else { worst.max(difference) }
        });
        column.error_bar = Some(factor * worst);
        column.error_bar_method.clone_from(&method);
    }
    columns[0].error_bar_method = "exact: tick times step".into();
    Ok(columns)
}

/// Factor on the difference, and the estimate in words.
fn estimate(method: MethodKind) -> (f64, String) {
    let order = match method {
        MethodKind::SemiImplicitEuler => 1,
        MethodKind::Implicit => 2,
        MethodKind::Rk4 => 4,
        MethodKind::DormandPrince | MethodKind::Stiff => {
            let words = format!("tolerance tightened {FINER}-fold: largest difference from that run");
            return (FINER / (FINER - 1.0), words);
        }
    };
    let power = f64::from(1 << order);
    let factor = power / (power - 1.0);
    (factor, format!("step halved: largest difference from that run times {factor:.3} (order {order})"))
}
