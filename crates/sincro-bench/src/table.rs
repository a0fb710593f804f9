//! Measured rows, for the terminal and for JSON.

use std::io::Write;

use serde_json::{Value, json};

use super::bars::{BARS, Bar, short};
use super::clock::{Sample, Timing};

/// One figure of one robot.
pub(super) struct Row {
    /// Robot.
    pub model: &'static str,
    /// Key of the figure.
    pub figure: &'static str,
    /// Our number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Its timing, if it is a time.
    pub timing: Option<Timing>,
    /// Remark on it; may be empty.
    pub note: String,
    /// The same of peers.
    pub rivals: Vec<Rival>,
}

/// A peer's figure beside ours.
pub(super) struct Rival {
    /// Its name.
    pub peer: &'static str,
    /// The request that it was sent.
    pub request: String,
    /// Its median `[ns]`.
    pub time: Sample,
    /// Its time over ours: how many times faster sincro is.
    pub ratio: f64,
    /// Remark on its number; may be empty.
    pub note: String,
    /// Its last answer.
    pub answer: Value,
}

/// Writes a line to standard output. That nobody reads any more is no failure of a measurement.
pub(super) fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{}", line.trim_end());
}

/// Names the columns.
pub(super) fn say_columns() {
    say(&line(["model", "figure", "sincro", "peer", "", "ratio", "bar", "verdict"]));
}

fn line([model, figure, ours, peer, theirs, ratio, bar, verdict]: [&str; 8]) -> String {
    format!("{model:<15}{figure:<32}{ours:>12}  {peer:<11}{theirs:>9}{ratio:>9}  {bar:<8}{verdict}")
}

impl Row {
    /// Prints it: one line, or one for each peer.
    pub fn say(&self) {
        let ours = quantity(self.value, self.unit);
        if self.rivals.is_empty() {
            let bar = Bar::find(self.figure, self.model, None);
            let first = bar.map_or_else(String::new, |bar| bar.first.words());
            let verdict = remarks(&[&bar.map_or_else(String::new, |bar| bar.verdict(self.value)), &self.note]);
            say(&line([self.model, self.figure, &ours, "", "", "", &first, &verdict]));
        }
        for rival in &self.rivals {
            let bar = Bar::find(self.figure, self.model, Some(rival.peer));
            let first = bar.map_or_else(String::new, |bar| bar.first.words());
            let theirs = quantity(rival.time.cpu, self.unit);
            let verdict = bar.map_or_else(String::new, |bar| bar.verdict(rival.ratio));
            let verdict = remarks(&[&verdict, &self.note, &rival.note]);
            let ratio = format!("{}×", short(rival.ratio));
            say(&line([self.model, self.figure, &ours, rival.peer, &theirs, &ratio, &first, &verdict]));
        }
    }

    /// Everything about it.
    pub fn json(&self) -> Value {
        let rivals = self.rivals.iter().map(|r| {
            json!({ "peer": r.peer, "request": r.request, "cpu_median_ns": r.time.cpu, "median_ns": r.time.wall,
                    "ratio": r.ratio, "note": r.note, "answer": r.answer })
        });
        let timing = self.timing.map(|t| {
            json!({ "cpu_median_ns": t.median.cpu, "cpu_min_ns": t.min.cpu, "median_ns": t.median.wall, "min_ns": t.min.wall,
                    "repetitions": t.repetitions, "units_per_repetition": t.units })
        });
        json!({ "model": self.model, "figure": self.figure, "value": self.value, "unit": self.unit, "timing": timing,
                "note": self.note, "peers": rivals.collect::<Vec<_>>() })
    }

    /// The number that a bar is on.
    fn number(&self, bar: &Bar) -> Option<f64> {
        if self.figure != bar.figure || self.model != bar.model {
            return None;
        }
        match bar.peer {
            None => Some(self.value),
            Some(peer) => self.rivals.iter().find(|r| r.peer == peer).map(|r| r.ratio),
        }
    }
}

fn remarks(parts: &[&str]) -> String {
    let said: Vec<&str> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
    said.join("; ")
}

/// A number with its unit: times in ns, µs or ms.
fn quantity(value: f64, unit: &str) -> String {
    match unit {
        "ns" if value >= 1e6 => format!("{} ms", short(value * 1e-6)),
        "ns" if value >= 1e3 => format!("{} µs", short(value * 1e-3)),
        "" | "×" => format!("{}{unit}", short(value)),
        _ => format!("{} {unit}", short(value)),
    }
}

/// Prints the bars that were measured and what became of them.
pub(super) fn say_bars(rows: &[Row]) {
    let numbers = BARS.iter().map(|bar| (bar, rows.iter().find_map(|row| row.number(bar))));
    let measured: Vec<(&Bar, f64)> = numbers.filter_map(|(bar, number)| Some((bar, number?))).collect();
    if measured.is_empty() {
        return;
    }
    let head = format!("{:<54}{:>12}  {:<10}{:<10}verdict", "bar", "measured", "first", "goal");
    say(&head);
    for (bar, value) in &measured {
        let name = match bar.peer {
            Some(peer) => format!("{}, {} against {peer}", bar.model, bar.figure),
            None => format!("{}, {}", bar.model, bar.figure),
        };
        let (first, goal) = (bar.first.words(), bar.goal.words());
        let (number, verdict) = (quantity(*value, bar.unit), bar.verdict(*value));
        say(&format!("{name:<54}{number:>12}  {first:<10}{goal:<10}{verdict}"));
    }
    let met = measured.iter().filter(|(bar, value)| bar.is_met(*value)).count();
    say(&format!("{met} of {} measured bars met, {} not measured", measured.len(), BARS.len() - measured.len()));
}

/// All bars for JSON.
pub(super) fn bars_json(rows: &[Row]) -> Vec<Value> {
    let each = BARS.iter().map(|bar| {
        let value = rows.iter().find_map(|row| row.number(bar));
        json!({ "model": bar.model, "figure": bar.figure, "peer": bar.peer, "first": bar.first.words(), "goal": bar.goal.words(),
                "value": value, "unit": bar.unit, "met": value.map(|value| bar.is_met(value)) })
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_that_reads_best() {
        assert_eq!(quantity(82.04, "ns"), "82 ns");
        assert_eq!(quantity(1510.0, "ns"), "1.51 µs");
        assert_eq!(quantity(79_900_000.0, "ns"), "79.9 ms");
        assert_eq!(quantity(2.1, "×"), "2.1×");
    }

    #[test]
    fn columns_stand_under_each_other() {
        let head = line(["model", "figure", "sincro", "peer", "", "ratio", "bar", "verdict"]);
        let row =
            line(["alexandros", "step semi-implicit-euler", "0.45 µs", "mujoco", "1.51 µs", "3.3×", "≥ 3", "met"]);
        let at = |text: &str, word: &str| text.split(word).next().unwrap().chars().count();
        assert_eq!(at(&head, "verdict"), at(&row, "met"));
    }
}
