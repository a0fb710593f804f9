//! Rows of the results: one for each run, in columns of numbers and texts.

use sincro_sim::formats::parquet::Values;

/// Columns that every campaign has, beside its parameters and measures.
pub const FIXED: [&str; 11] =
    ["k", "sample", "variant", "seed", "status", "t_end", "good", "failed_checks", "findings", "trace", "reason"];

/// Columns before the parameters.
pub const N_LEADING: usize = 4;

/// Number and type of the columns of a table of runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Names of the measures, those of checks included.
    pub measures: Vec<String>,
}

/// Result of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the run.
    pub k: u64,
    /// Number of the sample.
    pub sample: u64,
    /// Name of the variant.
    pub variant: String,
    /// Seed of the scene.
    pub seed: u64,
    /// Values of the parameters.
    pub parameters: Vec<f64>,
    /// Values of the measures; NaN where there is none.
    pub measures: Vec<f64>,
    /// `completed`, `ended` at a bound as intended, `stopped` or `refused`.
    pub status: &'static str,
    /// Time of the last row `[s]`.
    pub t_end: f64,
    /// True if it came to its end, all limits are kept and all measured checks hold.
    pub is_good: bool,
    /// Number of measured checks that fail; one that cannot be made is no failure.
    pub n_failed: u64,
    /// Number of findings of the audit.
    pub n_findings: u64,
    /// Hash of all its states; empty if it was refused.
    pub trace: String,
    /// Reason of a stop or refusal; else empty.
    pub reason: String,
}

impl Layout {
    /// Columns with their names, empty.
    #[must_use]
    pub fn columns(&self) -> Vec<(String, Values)> {
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

    /// Index of the first column behind the measures.
    #[must_use]
    pub fn trailing(&self) -> usize {
        N_LEADING + self.parameters.len() + self.measures.len()
    }

    /// Rows as columns.
    #[must_use]
    pub fn group(&self, rows: &[Row]) -> Vec<Values> {
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
