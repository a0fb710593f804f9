//! Rows of the results: one for each run, in columns of numbers and texts.

use sincro_sim::formats::parquet::Values;

/// Columns that every campaign has, beside its parameters and measures.
pub(crate) const FIXED: [&str; 11] =
    ["k", "sample", "variant", "seed", "status", "t_end", "good", "failed_checks", "findings", "trace", "reason"];

/// Columns before the parameters.
pub(crate) const N_LEADING: usize = 4;

/// Column layout of a campaign's results: `k`, `sample`, `variant`, `seed`, then the parameters, the measures, and
/// `status`, `t_end`, `good`, `failed_checks`, `findings`, `trace`, `reason`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Names of the parameters' columns, in the order of the plan.
    pub parameters: Vec<String>,
    /// Names of the measures' columns: those of the plan in its order, then measured checks as `check: NAME`.
    pub measures: Vec<String>,
}

/// Result of one run of a campaign, a row of the table of results; made by [`crate::Campaign::run`].
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the run, from 0.
    pub k: u64,
    /// Number of the sample, from 0; runs of one sample differ in their variant only.
    pub sample: u64,
    /// Name of the variant; `main` is the experiment itself.
    pub variant: String,
    /// Seed that the scene ran with.
    pub seed: u64,
    /// Values of the parameters, in the order of [`Layout::parameters`] and in their units.
    pub parameters: Vec<f64>,
    /// Values of the measures, in the order of [`Layout::measures`] and in their units; NaN where there is none.
    pub measures: Vec<f64>,
    /// Status: `completed`, `ended` at a stop condition as intended, `stopped` by a failure, or `refused` by the scene.
    pub status: &'static str,
    /// Time of the last recorded row `[s]`; 0 if the run was refused.
    pub t_end: f64,
    /// True if the run completed or ended as intended, within all limits, and no measured check fails.
    pub is_good: bool,
    /// Number of measured checks that fail; one that cannot be evaluated does not count.
    pub n_failed: u64,
    /// Number of findings of the audit.
    pub n_findings: u64,
    /// Hash of all states of the run, which tells whether a repetition is identical; empty if it was refused.
    pub trace: String,
    /// Reason in English of a stop or refusal; else empty.
    pub reason: String,
    /// Series of the signals that the plan keeps, for the table of signals: the times `[s]`, then each signal in the
    /// order of the plan and in its unit; empty if it keeps none, or the run was refused.
    pub series: Vec<Vec<f64>>,
}

impl Layout {
    /// Columns with their names, empty.
    #[must_use]
    pub(crate) fn columns(&self) -> Vec<(String, Values)> {
        let (ints, texts) = (Values::Ints(Vec::new()), Values::Texts(Vec::new()));
        let fixed = |name: &str| {
            let kind = match name {
                "variant" | "status" | "trace" | "reason" => &texts,
                "t_end" => &Values::Doubles(Vec::new()),
                _ => &ints,
            };
            (name.to_owned(), kind.clone())
        };
        let doubles = |name: &String| (name.clone(), Values::Doubles(Vec::new()));
        let leading = FIXED[..N_LEADING].iter().map(|name| fixed(name));
        let own = self.parameters.iter().chain(&self.measures).map(doubles);
        leading.chain(own).chain(FIXED[N_LEADING..].iter().map(|name| fixed(name))).collect()
    }

    /// Rows as columns.
    #[must_use]
    pub(crate) fn group(&self, rows: &[Row]) -> Vec<Values> {
        let ints = |of: &dyn Fn(&Row) -> u64| Values::Ints(rows.iter().map(|row| of(row) as i64).collect());
        let texts = |of: &dyn Fn(&Row) -> String| Values::Texts(rows.iter().map(of).collect());
        let doubles = |of: &dyn Fn(&Row) -> f64| Values::Doubles(rows.iter().map(of).collect());
        let mut all = vec![ints(&|r| r.k), ints(&|r| r.sample), texts(&|r| r.variant.clone()), ints(&|r| r.seed)];
        all.extend((0..self.parameters.len()).map(|j| doubles(&|r| r.parameters[j])));
        all.extend((0..self.measures.len()).map(|j| doubles(&|r| r.measures[j])));
        all.extend([
            texts(&|r| r.status.to_owned()),
            doubles(&|r| r.t_end),
            ints(&|r| u64::from(r.is_good)),
            ints(&|r| r.n_failed),
            ints(&|r| r.n_findings),
            texts(&|r| r.trace.clone()),
            texts(&|r| r.reason.clone()),
        ]);
        all
    }
}
