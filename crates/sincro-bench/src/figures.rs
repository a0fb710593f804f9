//! The figures: which there are, and how each is measured, alone or in turn with peers.

use sincro_dynamics::world::MethodKind;
use sincro_scene::scene::Scene;
use sincro_sim::rollout::Compile;
use sincro_sim::run::method_word;

use super::clock::{Meter, Sample, Subject, median, processors_had};
use super::models::{Robot, robot};
use super::peer::{Peer, agreement};
use super::subjects::{self, WORLDS};
use super::table::{Rival, Row};
use super::{Options, accuracy, complain};

/// Turns of ours and of the peer's in a comparison.
const ROUNDS: usize = 5;
/// Robots whose batches are measured.
const BATCHES: [&str; 5] = ["alexandros", "arm2", "quad", "panda", "chain10"];

/// Kinds of figures, to choose among.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FigureKind {
    /// A step of 5 ms by each method
    Step,
    /// Accelerations from torques: the recursion alone
    Forward,
    /// Torques from accelerations
    Inverse,
    /// Accelerations of a world with everything that acts in it
    Rates,
    /// Many worlds at once
    Batch,
    /// Time of 200 links over that of 100
    Growth,
    /// Time that a block diagram adds to a step
    Diagram,
    /// Cost of a message of a client and of a call of a script
    #[value(alias = "doors")]
    Adapters,
    /// A picture of 256 × 256 pixels of what a camera sees
    Picture,
    /// A minute of the quadrotor's flight test, controller and recording included
    Flight,
    /// Bytes of one world
    Memory,
    /// Errors at default settings
    Accuracy,
}

/// A figure that is timed: its key, our subject, and what to ask peers for.
struct Timed {
    figure: &'static str,
    requests: Vec<(&'static str, String)>,
    /// True: time on the wall counts, because several threads work.
    on_wall: bool,
    subject: fn(&Scene, usize) -> Subject,
}

impl Timed {
    fn new(figure: &'static str, requests: &[(&'static str, String)], subject: fn(&Scene, usize) -> Subject) -> Self {
        Self { figure, requests: requests.to_vec(), on_wall: false, subject }
    }
}

/// Robots that touch something: a world's step, all that is in it.
const TOUCHING: [&str; 6] = ["humanoid", "humanoid_lying", "heap10", "heap20", "heap40", "heap100"];

/// The timed figures of a robot. MuJoCo has no call for a recursion alone: `mj_forward` stands beside a world's rates,
/// and
/// `mj_inverse`, which does more than our inverse dynamics, beside that; no bar is on either.
fn timed(kind: FigureKind, model: &str, threads: usize) -> Vec<Timed> {
    let step = |word: &str| ("mujoco", format!("step {model} {word} 0.005"));
    let pin = |verb: &str| ("pinocchio", format!("{verb} {model}"));
    match kind {
        FigureKind::Step if TOUCHING.contains(&model) => {
            let euler = |scene: &Scene, _| subjects::step(scene, MethodKind::SemiImplicitEuler, false);
            vec![Timed::new("step semi-implicit-euler", &[step("euler")], euler)]
        }
        FigureKind::Picture if model.starts_with("humanoid") => {
            vec![Timed::new("picture 256 × 256", &[], |scene, _| subjects::picture(scene))]
        }
        _ if TOUCHING.contains(&model) => Vec::new(),
        FigureKind::Step => {
            let mut figures = steps(model);
            compiled(kind, model, &mut figures);
            figures
        }
        FigureKind::Forward => {
            let mut figures = vec![Timed::new("forward", &[pin("forward")], |scene, _| subjects::forward(scene))];
            compiled(kind, model, &mut figures);
            figures
        }
        FigureKind::Inverse => {
            let requests = [pin("inverse"), ("mujoco", format!("inverse {model}"))];
            vec![Timed::new("inverse", &requests, |scene, _| subjects::inverse(scene))]
        }
        FigureKind::Rates => {
            vec![Timed::new("rates", &[("mujoco", format!("forward {model}"))], |scene, _| subjects::rates(scene))]
        }
        FigureKind::Batch if BATCHES.contains(&model) => {
            let request = |threads: usize| ("mujoco", format!("batch {model} euler 0.005 {threads} {WORLDS}"));
            let mut figures = vec![
                Timed::new("batch", &[request(1)], |scene, _| subjects::batch(scene, 1, Compile::IfPossible)),
                Timed::new("batch not compiled", &[request(1)], |scene, _| subjects::batch(scene, 1, Compile::Never)),
            ];
            if threads > 1 {
                let several = Timed::new("batch, several threads", &[request(threads)], |scene, threads| {
                    subjects::batch(scene, threads, Compile::IfPossible)
                });
                figures.push(Timed { on_wall: true, ..several });
            }
            if model == "panda" {
                figures.push(Timed::new("batch with limits", &[], |_, _| subjects::limited_batch(true)));
                figures.push(Timed::new("batch with limits, alone", &[], |_, _| subjects::limited_batch(false)));
            }
            figures
        }
        _ => Vec::new(),
    }
}

/// Steps of a robot by each method.
fn steps(model: &str) -> Vec<Timed> {
    let step = |word: &str| ("mujoco", format!("step {model} {word} 0.005"));
    vec![
        Timed::new(
            "step semi-implicit-euler",
            &[step("euler"), ("pinocchio", format!("step {model} euler 0.005"))],
            |scene, _| subjects::step(scene, MethodKind::SemiImplicitEuler, false),
        ),
        Timed::new("step semi-implicit-euler, totals", &[], |scene, _| {
            subjects::step(scene, MethodKind::SemiImplicitEuler, true)
        }),
        Timed::new("step implicit", &[step("implicit")], |scene, _| subjects::step(scene, MethodKind::Implicit, false)),
        Timed::new("step rk4", &[step("rk4")], |scene, _| subjects::step(scene, MethodKind::Rk4, false)),
        Timed::new("step default", &[], |scene, _| default_step(scene, false)),
        Timed::new("step default, totals", &[], |scene, _| default_step(scene, true)),
    ]
}

/// Adds the figures of equations that are compiled in memory, if this program has that.
#[cfg(not(feature = "jit"))]
fn compiled(_: FigureKind, _: &str, _: &mut Vec<Timed>) {}

/// Adds the figures of equations that are compiled in memory.
#[cfg(feature = "jit")]
fn compiled(kind: FigureKind, model: &str, figures: &mut Vec<Timed>) {
    let step = |word: &str| ("mujoco", format!("step {model} {word} 0.005"));
    if kind == FigureKind::Forward {
        let request = ("pinocchio", format!("forward {model}"));
        figures.push(Timed::new("forward compiled", &[request], |scene, _| super::compiled::forward(scene)));
        return;
    }
    figures.extend([
        Timed::new("step semi-implicit-euler compiled", &[step("euler")], |scene, _| {
            super::compiled::step(scene, MethodKind::SemiImplicitEuler)
        }),
        Timed::new("step rk4 compiled", &[step("rk4")], |scene, _| super::compiled::step(scene, MethodKind::Rk4)),
    ]);
}

fn default_step(scene: &Scene, totals: bool) -> Subject {
    let method = subjects::default_method(scene);
    let subject = subjects::step(scene, method, totals);
    let note = [method_word(method), &subject.note].join(" ");
    subject.with_note(note.trim_end())
}

/// A measurement under way.
pub(super) struct Session<'a> {
    options: &'a Options,
    /// Peers that answer.
    pub peers: Vec<Peer>,
    robots: Vec<Robot>,
    /// Rows measured so far.
    pub rows: Vec<Row>,
}

impl<'a> Session<'a> {
    /// Nothing measured yet.
    pub fn new(options: &'a Options, peers: Vec<Peer>, robots: Vec<Robot>) -> Self {
        Self { options, peers, robots, rows: Vec::new() }
    }

    fn wants(&self, kind: FigureKind) -> bool {
        self.options.figure.is_empty() || self.options.figure.contains(&kind)
    }

    fn kinds(&self) -> Vec<FigureKind> {
        let all = [
            FigureKind::Step,
            FigureKind::Rates,
            FigureKind::Forward,
            FigureKind::Inverse,
            FigureKind::Batch,
            FigureKind::Picture,
        ];
        all.into_iter().filter(|kind| self.wants(*kind)).collect()
    }

    /// Estimated duration `[s]`.
    pub fn estimate(&self) -> f64 {
        let seconds = self.options.seconds_per_figure;
        let mut sum = 2.0;
        for robot in &self.robots {
            for kind in self.kinds() {
                for figure in timed(kind, robot.name, self.threads()) {
                    let asked = figure.requests.iter().filter(|r| self.peers.iter().any(|p| p.name == r.0)).count();
                    sum += if asked == 0 { seconds + 0.1 } else { asked as f64 * (3.0 * seconds + 0.3) };
                }
            }
        }
        sum
    }

    fn threads(&self) -> usize {
        usize::from(self.options.threads)
    }

    /// Measures everything that is wanted, printing row by row.
    pub fn measure(&mut self) {
        for peer in &mut self.peers {
            // a round of the peer is a turn's share of the figure's time
            let share = self.options.seconds_per_figure / ROUNDS as f64;
            if let Err(problem) = peer.ask(&format!("seconds {share}")) {
                complain(&problem);
            }
        }
        let robots = std::mem::take(&mut self.robots);
        for robot in &robots {
            let agreeing = self.agreeing(robot);
            for kind in self.kinds() {
                for figure in timed(kind, robot.name, self.threads()) {
                    let row = self.time(robot, &figure, &agreeing);
                    self.push(row);
                }
            }
            self.measure_rest(robot);
        }
        let both = ["chain100", "chain200"].iter().all(|name| robots.iter().any(|robot| robot.name == *name));
        if both && self.wants(FigureKind::Growth) {
            self.measure_growth();
        }
        if self.options.only.is_empty() && self.wants(FigureKind::Adapters) {
            self.measure_adapters();
        }
        if self.options.only.is_empty() && self.wants(FigureKind::Flight) {
            self.measure_flight();
        }
    }

    /// Messages of clients, on the wall because another thread answers; and a script's call.
    fn measure_adapters(&mut self) {
        let seconds = self.options.seconds_per_figure;
        match super::adapters::clients() {
            Ok(pairs) => {
                let figures = [("legacy message", "simxGetJointPosition"), ("ZeroMQ call", "sim.getJointPosition")];
                for ((figure, call), (with, without)) in figures.into_iter().zip(pairs) {
                    let (value, whole) = least(with, without, seconds);
                    let note =
                        format!("{call}; shortest round trip {:.1} µs on the wall, less that of an echo", whole * 1e-3);
                    self.push_adapter(figure, value * 1e-3, note);
                }
            }
            Err(problem) => complain(&problem),
        }
        match super::adapters::script() {
            Ok((with, without)) => {
                let (value, whole) = added(with, without, seconds, |sample| sample.cpu);
                let note = format!("sysCall_actuation without host calls; of {whole:.0} ns, semi-implicit step");
                self.push_adapter("Lua actuation call", value * 1e-3, note);
            }
            Err(problem) => complain(&problem),
        }
    }

    fn push_adapter(&mut self, figure: &'static str, value: f64, note: String) {
        self.push(Row { model: "adapters", figure, value, unit: "µs", timing: None, note, rivals: Vec::new() });
    }

    /// A minute of flight: processor time, as everywhere here, and beside it the wall, which is what a user waits for.
    fn measure_flight(&mut self) {
        let mut meter = match super::flight::flight() {
            Ok(subject) => Meter::new(subject),
            Err(problem) => return complain(&problem),
        };
        (0..ROUNDS).for_each(|_| {
            meter.round(self.options.seconds_per_figure / ROUNDS as f64);
        });
        let timing = meter.timing();
        let (value, wall) = (timing.median.cpu * 1e-9, timing.median.wall * 1e-9);
        let note = format!("{:.0} times real time; {wall:.3} s on the wall", super::flight::SECONDS / value);
        let (model, figure) = ("quadrotor", "flight of 60 s");
        self.push(Row { model, figure, value, unit: "s", timing: Some(timing), note, rivals: Vec::new() });
    }

    fn push(&mut self, row: Row) {
        row.say();
        self.rows.push(row);
    }

    /// The peers that compute the same accelerations for a robot.
    fn agreeing(&mut self, robot: &Robot) -> Vec<&'static str> {
        let ours = subjects::accelerations(&robot.scene);
        let mut agreeing = Vec::new();
        for peer in self.peers.iter_mut().filter(|peer| !robot.touches() || peer.name == "mujoco") {
            let answer = peer.ask(&format!("acceleration {}", robot.name));
            match answer.and_then(|answer| agreement(&ours, &answer)) {
                Ok(_) => agreeing.push(peer.name),
                Err(problem) => {
                    complain(&format!("{}: {problem}; not compared with {}", robot.name, peer.name));
                }
            }
        }
        agreeing
    }

    /// One timed figure, in turn with every peer that has it.
    fn time(&mut self, robot: &Robot, figure: &Timed, agreeing: &[&str]) -> Row {
        let mut meter = Meter::new((figure.subject)(&robot.scene, self.threads()));
        let seconds = self.options.seconds_per_figure;
        let mut rivals = Vec::new();
        for (name, request) in figure.requests.iter().filter(|(name, _)| agreeing.contains(name)) {
            let peer = self.peers.iter_mut().find(|peer| peer.name == *name).expect("it agrees");
            match in_turn(&mut meter, peer, request, seconds / ROUNDS as f64, figure.on_wall) {
                Ok(rival) => rivals.push(rival),
                Err(problem) => complain(&problem),
            }
        }
        if rivals.is_empty() {
            (0..ROUNDS).for_each(|_| {
                meter.round(seconds / ROUNDS as f64);
            });
        }
        let timing = meter.timing();
        let value = if figure.on_wall { timing.median.wall } else { timing.median.cpu };
        let note = match figure.on_wall {
            true => format!("{} threads {}", self.threads(), meter.note()).trim_end().to_owned(),
            false => meter.note().to_owned(),
        };
        Row { model: robot.name, figure: figure.figure, value, unit: "ns", timing: Some(timing), note, rivals }
    }

    /// Memory and accuracy of a robot, and the gain of threads.
    fn measure_rest(&mut self, robot: &Robot) {
        let row = |figure, value, unit, note: &str| {
            let note = note.to_owned();
            Row { model: robot.name, figure, value, unit, timing: None, note, rivals: Vec::new() }
        };
        let default = method_word(subjects::default_method(&robot.scene));
        if self.wants(FigureKind::Batch) && robot.name == "alexandros" && self.threads() == 2 {
            let (gain, note) = thread_gain(&robot.scene, self.options.seconds_per_figure);
            self.push(row("batch threads", gain, "×", &note));
        }
        if self.wants(FigureKind::Diagram) && robot.name == "arm2" {
            for (figure, with, without) in super::diagrams::figures() {
                let (added, whole) = added(with, without, self.options.seconds_per_figure, |sample| sample.cpu);
                self.push(row(figure, added, "ns", &format!("of {whole:.0} ns, semi-implicit step")));
            }
        }
        if self.wants(FigureKind::Memory) {
            let bytes = subjects::memory(&robot.scene, subjects::default_method(&robot.scene));
            self.push(row("memory", bytes as f64 * 1e-3, "kB", &format!("{default}; the model left out")));
        }
        if self.wants(FigureKind::Accuracy) && matches!(robot.name, "arm2" | "alexandros") {
            let error = accuracy::joint_error(&robot.scene, 1.0);
            self.push(row("accuracy first second", error, "rad", default));
        }
        if self.wants(FigureKind::Accuracy) && robot.name == "chain10" {
            let error = accuracy::energy_error(&robot.scene, 10.0);
            let note = format!("{default}; share of the largest kinetic energy");
            self.push(row("accuracy energy 10 s", error, "", &note));
        }
    }

    /// Time of a step of 200 links over that of 100.
    fn measure_growth(&mut self) {
        let meter = |name| {
            let scene = robot(name).expect("it compiled before").scene;
            Meter::new(subjects::step(&scene, MethodKind::SemiImplicitEuler, false))
        };
        let (mut short, mut long) = (meter("chain100"), meter("chain200"));
        let share = self.options.seconds_per_figure / ROUNDS as f64;
        let mut ratios = Vec::new();
        let mut before = short.round(share);
        for _ in 0..ROUNDS {
            let now = long.round(share);
            let after = short.round(share);
            ratios.extend([now.cpu / before.cpu, now.cpu / after.cpu]);
            before = after;
        }
        let note = "semi-implicit step".to_owned();
        let (figure, value) = ("growth chain200/chain100", median(ratios));
        self.push(Row { model: "chain200", figure, value, unit: "×", timing: None, note, rivals: Vec::new() });
    }
}

/// Added time: the median of the differences of neighbours, measured in turn; and the time of the whole `[ns]`.
fn added(with: Subject, without: Subject, seconds: f64, of: fn(Sample) -> f64) -> (f64, f64) {
    let (mut with, mut without) = (Meter::new(with), Meter::new(without));
    let share = seconds / ROUNDS as f64;
    let (mut differences, mut whole) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (long, short) = (with.round(share), without.round(share));
        differences.push(of(long) - of(short));
        whole.push(of(long));
    }
    (median(differences), median(whole))
}

/// Added time on the wall, and the time of the whole `[ns]`: between the shortest of each, since another thread answers
/// and a busy machine only ever adds.
fn least(with: Subject, without: Subject, seconds: f64) -> (f64, f64) {
    let (mut with, mut without) = (Meter::new(with), Meter::new(without));
    for _ in 0..2 * ROUNDS {
        with.round(seconds / ROUNDS as f64);
        without.round(seconds / ROUNDS as f64);
    }
    let whole = with.timing().min.wall;
    (whole - without.timing().min.wall, whole)
}

/// Ours, peer, ours, peer … ours: the ratio is the median of the ratios of neighbours.
fn in_turn(meter: &mut Meter, peer: &mut Peer, request: &str, share: f64, on_wall: bool) -> Result<Rival, String> {
    let of = |sample: Sample| if on_wall { sample.wall } else { sample.cpu };
    let (mut ratios, mut times) = (Vec::new(), Vec::new());
    let mut before = meter.round(share);
    let mut last = serde_json::Value::Null;
    for _ in 0..ROUNDS {
        let (theirs, answer) = peer.time(request)?;
        let after = meter.round(share);
        ratios.extend([of(theirs) / of(before), of(theirs) / of(after)]);
        times.push(theirs);
        (before, last) = (after, answer);
    }
    let time = Sample {
        wall: median(times.iter().map(|t| t.wall).collect()),
        cpu: median(times.iter().map(|t| of(*t)).collect()),
    };
    let mut note = if last["diverged"] == true { format!("{} diverges at 5 ms", peer.name) } else { String::new() };
    if let (Some(contacts), Some(rows)) = (last["contacts"].as_f64(), last["rows"].as_f64()) {
        note += &format!("{}: {contacts:.1} contacts, {rows:.1} rows in all", peer.name);
    }
    Ok(Rival { peer: peer.name, request: request.to_owned(), time, ratio: median(ratios), note, answer: last })
}

/// Gain of two threads over one, and a remark; the shortest times, because whatever else runs on the machine only
/// takes away. The remark says how many processors two threads were given: with one of them busy elsewhere no gain can
/// be seen.
fn thread_gain(scene: &Scene, seconds: f64) -> (f64, String) {
    let [mut one, mut two] = [1, 2].map(|threads| Meter::new(subjects::batch(scene, threads, Compile::IfPossible)));
    let (share, mut most) = (seconds / ROUNDS as f64, 0.0_f64);
    for _ in 0..ROUNDS {
        one.round(share);
        let had = processors_had(|| {
            two.round(share);
        });
        most = most.max(had.unwrap_or(f64::NAN));
    }
    let gain = one.timing().min.wall / two.timing().min.wall;
    let had = if most > 0.0 { format!("; at best {most:.2} processors were free") } else { String::new() };
    (gain, format!("2 threads against one, shortest times on the wall{had}"))
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

    use super::*;

    #[test]
    fn the_former_name_of_the_adapters_is_taken() {
        assert_eq!(FigureKind::from_str("doors", false), Ok(FigureKind::Adapters));
        assert_eq!(FigureKind::from_str("adapters", false), Ok(FigureKind::Adapters));
    }
}
