//! Timing: processor time of the thread and time on the wall, in repetitions long enough for the clock.
//!
//! Processor time is what figures and ratios are made of: on a machine that does other things too, the wall says more
//! about those.

use std::time::{Duration, Instant};

/// Shortest repetition `[s]`: shorter, and the clock shows.
const REPETITION_S: f64 = 0.010;
/// Repetitions of a round at least, unless a single call is longer than [`SLOW_S`].
const MIN_REPETITIONS: usize = 3;
/// A call longer than this is repeated once a round `[s]`.
const SLOW_S: f64 = 0.050;

/// Something to be timed: `run(n)` makes n calls, each of which does `units` of what is counted.
pub(super) struct Subject {
    run: Box<dyn FnMut(u64)>,
    units: f64,
    /// Remark on the figure, such as that a smaller step was timed; empty if there is none.
    pub note: String,
}

impl Subject {
    /// A call does one unit.
    pub fn new(mut call: impl FnMut() + 'static) -> Self {
        Self { run: Box::new(move |n| (0..n).for_each(|_| call())), units: 1.0, note: String::new() }
    }

    /// The same, a call doing `units`.
    pub fn with_units(self, units: f64) -> Self {
        Self { units, ..self }
    }

    /// The same with another remark after its own.
    #[cfg(feature = "jit")]
    pub fn with_added_note(self, note: &str) -> Self {
        let notes = [&*self.note, note].into_iter().filter(|note| !note.is_empty()).collect::<Vec<_>>().join("; ");
        self.with_note(notes)
    }

    /// The same with a remark.
    pub fn with_note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }
}

/// Time per unit `[ns]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// On the wall.
    pub wall: f64,
    /// Processor time of this thread only.
    pub cpu: f64,
}

/// Median and minimum over repetitions `[ns]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// Medians.
    pub median: Sample,
    /// Minima.
    pub min: Sample,
    /// Repetitions made.
    pub repetitions: usize,
    /// Units in each of them.
    pub units: f64,
}

/// A subject being timed, round by round.
pub(super) struct Meter {
    subject: Subject,
    calls: u64,
    samples: Vec<Sample>,
}

impl Meter {
    /// Warms the subject up and finds how many calls make a repetition.
    pub fn new(subject: Subject) -> Self {
        let mut meter = Self { subject, calls: 1, samples: Vec::new() };
        loop {
            let seconds = meter.repetition_seconds();
            if seconds >= REPETITION_S {
                return meter;
            }
            // towards the goal, not past it by much, however wrong a first short measurement was
            let factor = (1.2 * REPETITION_S / seconds.max(1e-9)).clamp(1.5, 10.0);
            meter.calls = (meter.calls as f64 * factor).ceil() as u64;
        }
    }

    fn repetition_seconds(&mut self) -> f64 {
        let sample = self.repetition();
        sample.cpu.max(sample.wall) * 1e-9 * self.calls as f64 * self.subject.units
    }

    fn repetition(&mut self) -> Sample {
        let (wall, cpu) = (Instant::now(), thread_time());
        (self.subject.run)(self.calls);
        let (cpu, wall) = (thread_time().saturating_sub(cpu), wall.elapsed());
        let per_unit = 1e9 / (self.calls as f64 * self.subject.units);
        Sample { wall: wall.as_secs_f64() * per_unit, cpu: cpu.as_secs_f64() * per_unit }
    }

    /// Repetitions for about `seconds`; their medians.
    pub fn round(&mut self, seconds: f64) -> Sample {
        let first = self.samples.len();
        let start = Instant::now();
        loop {
            let clock = Instant::now();
            let sample = self.repetition();
            self.samples.push(sample);
            let enough = clock.elapsed().as_secs_f64() > SLOW_S || self.samples.len() - first >= MIN_REPETITIONS;
            if enough && start.elapsed().as_secs_f64() >= seconds {
                return medians(&self.samples[first..]);
            }
        }
    }

    /// All rounds together.
    pub fn timing(&self) -> Timing {
        let least = |f: fn(&Sample) -> f64| self.samples.iter().map(f).fold(f64::INFINITY, f64::min);
        Timing {
            median: medians(&self.samples),
            min: Sample { wall: least(|s| s.wall), cpu: least(|s| s.cpu) },
            repetitions: self.samples.len(),
            units: self.calls as f64 * self.subject.units,
        }
    }

    /// The subject's remark.
    pub fn note(&self) -> &str {
        &self.subject.note
    }
}

fn medians(samples: &[Sample]) -> Sample {
    let of = |f: fn(&Sample) -> f64| median(samples.iter().map(f).collect());
    Sample { wall: of(|s| s.wall), cpu: of(|s| s.cpu) }
}

/// The middle value; of an even number the mean of the two in the middle. NaN of none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ if n % 2 == 1 => values[n / 2],
        _ => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// Processor time of the calling thread.
#[cfg(unix)]
fn thread_time() -> Duration {
    processor_time(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(unix)]
fn processor_time(clock: rustix::time::ClockId) -> Duration {
    let time = rustix::time::clock_gettime(clock);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Time on the wall in place of processor time, where a thread's processor time cannot be had.
#[cfg(not(unix))]
fn thread_time() -> Duration {
    use std::sync::LazyLock;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

/// Runs `work`; how many processors it had on average, all its threads together. None where that cannot be found out.
#[cfg(unix)]
pub(super) fn processors_had(work: impl FnOnce()) -> Option<f64> {
    let process = || processor_time(rustix::time::ClockId::ProcessCPUTime);
    let (wall, cpu) = (Instant::now(), process());
    work();
    Some(process().saturating_sub(cpu).as_secs_f64() / wall.elapsed().as_secs_f64())
}

/// Runs `work`; how many processors it had cannot be found out here.
#[cfg(not(unix))]
pub(super) fn processors_had(work: impl FnOnce()) -> Option<f64> {
    work();
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(Vec::new()).is_nan());
    }

    #[test]
    fn a_call_counts_as_its_units() {
        let work = || {
            std::hint::black_box((0..1000).fold(0.0_f64, |sum, k| sum + f64::from(k).sqrt()));
        };
        let mut meter = Meter::new(Subject::new(work).with_units(2.0));
        meter.round(0.0);
        let timing = meter.timing();
        assert_eq!(timing.units, 2.0 * meter.calls as f64);
        assert_eq!(timing.repetitions, meter.samples.len());
        assert!(timing.min.wall <= timing.median.wall);
    }
}
