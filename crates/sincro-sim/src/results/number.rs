//! Numbers that JSON cannot hold: written as null, listed at the end of the file, read as NaN.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{AuditReport, CheckReport, ColumnReport, EnergyReport, RunReport};

pub(super) use crate::number::{deserialize, serialize};

/// The report, and by JSON pointer what its nulls were.
#[derive(Serialize)]
struct Whole<'a> {
    #[serde(flatten)]
    report: &'a RunReport,
    not_finite: BTreeMap<String, String>,
}

/// The text of `run.json`.
pub(super) fn to_json(report: &RunReport) -> String {
    let mut found = Found::default();
    found.report(report);
    let whole = Whole { report, not_finite: found.0 };
    let mut text =
        serde_json::to_string_pretty(&whole).expect("a report is JSON: its keys are texts, its types our own");
    text.push('\n');
    text
}

/// Numbers that are not finite, by JSON pointer.
#[derive(Default)]
struct Found(BTreeMap<String, String>);

impl Found {
    fn report(&mut self, report: &RunReport) {
        self.number("", "wall_time_s", report.wall_time_s);
        self.number("", "real_time_factor", report.real_time_factor);
        self.part("", &report.columns, report.energy.as_ref(), &report.checks);
        self.audit("/audit", &report.audit);
        if let Some(sweep) = &report.sweep {
            self.part("/sweep", &sweep.columns, None, &sweep.checks);
            self.audit("/sweep/audit", &sweep.audit);
        }
        for (k, variant) in report.variants.iter().enumerate() {
            let at = format!("/variants/{k}");
            self.number(&at, "wall_time_s", variant.wall_time_s);
            self.part(&at, &variant.columns, variant.energy.as_ref(), &variant.checks);
            self.audit(&format!("{at}/audit"), &variant.audit);
        }
    }

    fn part(&mut self, at: &str, columns: &[ColumnReport], energy: Option<&EnergyReport>, checks: &[CheckReport]) {
        for (k, column) in columns.iter().enumerate() {
            self.option(&format!("{at}/columns/{k}"), "error_bar", column.error_bar);
        }
        if let Some(energy) = energy {
            self.energy(&format!("{at}/energy"), energy);
        }
        for (k, check) in checks.iter().enumerate() {
            let at = format!("{at}/checks/{k}");
            self.option(&at, "measured", check.measured);
            self.option(&at, "expected", check.expected);
            self.option(&at, "deviation", check.deviation);
        }
    }

    fn audit(&mut self, at: &str, audit: &AuditReport) {
        for (list, findings) in [("findings", &audit.findings), ("laws", &audit.laws)] {
            for (k, finding) in findings.iter().enumerate() {
                let at = format!("{at}/{list}/{k}");
                self.number(&at, "value", finding.value);
                self.number(&at, "limit", finding.limit);
            }
        }
    }

    fn energy(&mut self, at: &str, energy: &EnergyReport) {
        self.number(at, "kinetic_start", energy.kinetic_start);
        self.number(at, "kinetic_end", energy.kinetic_end);
        self.number(at, "potential_start", energy.potential_start);
        self.number(at, "potential_end", energy.potential_end);
        self.number(at, "work", energy.work);
        self.number(at, "dissipated", energy.dissipated);
        self.number(at, "residual", energy.residual);
    }

    fn option(&mut self, at: &str, field: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.number(at, field, value);
        }
    }

    fn number(&mut self, at: &str, field: &str, value: f64) {
        if !value.is_finite() {
            self.0.insert(format!("{at}/{field}"), value.to_string());
        }
    }
}
