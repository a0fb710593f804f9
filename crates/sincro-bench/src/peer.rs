//! A peer as a child process that answers one JSON line for each request line (`crates/sincro-bench/peers`).

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::clock::Sample;

/// Longest wait for the first line, in which a peer may compile itself.
const START_TIMEOUT: Duration = Duration::from_secs(600);
/// Longest wait for an answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(120);
/// Longest wait for the end after `quit`.
const END_TIMEOUT: Duration = Duration::from_secs(5);

/// Whom to measure beside us.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Against {
    /// MuJoCo: `pip install 'mujoco>=4'`
    Mujoco,
    /// Pinocchio: `pip install 'pin>=4' cmeel-eigen`, and g++
    Pinocchio,
    /// Both
    All,
}

/// A peer that answers.
pub(super) struct Peer {
    /// `mujoco` or `pinocchio`.
    pub name: &'static str,
    /// Its first answer: name and version.
    pub hello: Value,
    child: Child,
    input: Option<ChildStdin>,
    answers: Receiver<String>,
    complaints: Arc<Mutex<String>>,
}

impl Peer {
    /// Starts the peer's script beside the folder of models and waits until it is ready.
    pub fn start(name: &'static str, models: &Path, build_dir: &Path) -> Result<Self, String> {
        let script = models.join("../peers").join(format!("{name}_bench.py"));
        if !script.is_file() {
            return Err(format!("{name}: there is no script `{}`", script.display()));
        }
        let mut command = Command::new("python3");
        command.arg(&script).arg("--models").arg(models).arg("--serve");
        if name == "pinocchio" {
            command.arg("--builds").arg("portable").arg("--build-dir").arg(build_dir);
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|e| format!("{name}: `python3` cannot be started: {e}"))?;
        let output = child.stdout.take().expect("piped");
        let (send, answers) = channel();
        thread::spawn(move || {
            BufReader::new(output).lines().map_while(Result::ok).try_for_each(|line| send.send(line))
        });
        let complaints = Arc::default();
        listen(child.stderr.take().expect("piped"), &complaints);
        let mut peer = Self { name, hello: Value::Null, input: child.stdin.take(), child, answers, complaints };
        peer.hello = peer.answer(START_TIMEOUT)?;
        if peer.hello["protocol"] != 1 {
            return Err(format!("{name}: speaks protocol {}, not 1", peer.hello["protocol"]));
        }
        Ok(peer)
    }

    /// Its version.
    pub fn version(&self) -> &str {
        self.hello["version"].as_str().unwrap_or("?")
    }

    /// The answer to a request.
    pub fn ask(&mut self, request: &str) -> Result<Value, String> {
        let Some(input) = &mut self.input else { return Err(format!("{} has ended", self.name)) };
        let sent = writeln!(input, "{request}").and_then(|()| input.flush());
        if sent.is_err() {
            return Err(self.last_words());
        }
        let answer = self.answer(ANSWER_TIMEOUT)?;
        match answer["error"].as_str() {
            Some(error) => Err(format!("{}: {error}", self.name)),
            None => Ok(answer),
        }
    }

    /// A timing in ns, with the answer it stood in. Batches on several threads have no processor time: that of the wall
    /// stands there.
    pub fn time(&mut self, request: &str) -> Result<(Sample, Value), String> {
        let answer = self.ask(request)?;
        let wall = answer["median_ns"].as_f64();
        let wall = wall.ok_or_else(|| format!("{}: no time in the answer to `{request}`", self.name))?;
        Ok((Sample { wall, cpu: answer["cpu_median_ns"].as_f64().unwrap_or(wall) }, answer))
    }

    fn answer(&mut self, timeout: Duration) -> Result<Value, String> {
        match self.answers.recv_timeout(timeout) {
            Ok(line) => serde_json::from_str(&line).map_err(|e| format!("{}: `{line}` is not JSON: {e}", self.name)),
            Err(RecvTimeoutError::Timeout) => {
                self.end(Duration::ZERO);
                Err(format!("{}: no answer within {} s, ended", self.name, timeout.as_secs()))
            }
            Err(RecvTimeoutError::Disconnected) => Err(self.last_words()),
        }
    }

    /// Last lines of its error output before it ended.
    fn last_words(&mut self) -> String {
        self.end(END_TIMEOUT);
        let status = self.child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
        // the listener may not have read the last line yet
        thread::sleep(Duration::from_millis(50));
        let said = self.complaints.lock().expect("the listener does not panic");
        match said.lines().last() {
            Some(line) if status.ends_with(": 3") => line.to_owned(),
            Some(line) => format!("{} ended ({status}): {line}", self.name),
            None => format!("{} ended ({status})", self.name),
        }
    }

    /// `quit`, closed input, and if that does not help within `grace`, killed.
    fn end(&mut self, grace: Duration) {
        if let Some(mut input) = self.input.take() {
            let _ = writeln!(input, "quit");
        }
        let deadline = Instant::now() + grace;
        while matches!(self.child.try_wait(), Ok(None)) {
            if Instant::now() >= deadline {
                let _ = self.child.kill();
                let _ = self.child.wait();
                return;
            }
            thread::sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        self.end(END_TIMEOUT);
    }
}

/// Keeps what comes on the error output; what takes long is passed on.
fn listen(errors: impl std::io::Read + Send + 'static, kept: &Arc<Mutex<String>>) {
    let kept = Arc::clone(kept);
    thread::spawn(move || {
        for line in BufReader::new(errors).lines().map_while(Result::ok) {
            if line.starts_with("compiling") {
                eprintln!("pinocchio: {line}");
            }
            let mut kept = kept.lock().expect("nobody panics with it");
            kept.push_str(&line);
            kept.push('\n');
        }
    });
}

/// Compares the peer's accelerations with ours: names and lists as [`super::subjects::accelerations`] gives them; to
/// 1e-6 of the largest.
pub(super) fn agreement(ours: &[(String, Vec<f64>)], answer: &Value) -> Result<f64, String> {
    let theirs = &answer["acceleration"];
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    for (name, values) in ours {
        let list = theirs[name].as_array().filter(|list| list.len() == values.len());
        let list = list.ok_or_else(|| format!("the peer's model has no such joint at body `{name}`"))?;
        for (x, y) in values.iter().zip(list) {
            let y = y.as_f64().unwrap_or(f64::NAN);
            largest = largest.max(x.abs());
            // a NaN must not pass for agreement
            worst = if (x - y).is_nan() { f64::INFINITY } else { worst.max((x - y).abs()) };
        }
    }
    let share = worst / largest.max(f64::MIN_POSITIVE);
    let all = theirs.as_object().map_or(0, serde_json::Map::len) == ours.len();
    if share <= 1e-6 && all { Ok(share) } else { Err(format!("accelerations differ by {share:.1e} of the largest")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agreement_is_of_every_body_and_to_a_millionth() {
        let ours = [("a".to_owned(), vec![100.0]), ("b".to_owned(), vec![1.0])];
        let theirs = |a: f64, b: f64| serde_json::json!({ "acceleration": { "a": [a], "b": [b] } });
        assert!(agreement(&ours, &theirs(100.0, 1.000_09)).is_ok());
        assert!(agreement(&ours, &theirs(100.0, 1.000_11)).is_err());
        assert!(agreement(&ours[..1], &theirs(100.0, 1.0)).is_err());
        assert!(agreement(&ours, &serde_json::json!({})).is_err());
    }

    #[test]
    fn a_missing_script_is_said_so() {
        let problem = Peer::start("mujoco", Path::new("/nowhere/models"), Path::new("")).err().unwrap();
        assert!(problem.contains("there is no script"), "{problem}");
    }
}
