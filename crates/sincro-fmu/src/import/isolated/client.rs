//! The side of the run: an instance that is a process.

use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use sincro_scene::fmu::{FmuEvents, FmuInstance, FmuInterface, FmuValues};

use super::super::Folder;
use super::wire::{Fields, Frame, Verb};

#[cfg(unix)]
type Connection = std::os::unix::net::UnixStream;
#[cfg(not(unix))]
type Connection = std::io::Empty;

/// Time that a process gets to end by itself.
const GRACE: Duration = Duration::from_secs(2);

/// An instance in a process of its own.
#[derive(Debug)]
pub(super) struct Client {
    connection: Option<Connection>,
    child: Child,
    /// Temporary folder of the process, which cannot remove it after a crash.
    _folder: Folder,
    /// Reason for which it does not answer any more.
    lost: Option<String>,
}

impl Client {
    /// Starts the process.
    #[cfg(unix)]
    pub fn start((program, arguments): &(PathBuf, Vec<String>), folder: Folder) -> Result<Self, String> {
        use std::os::fd::OwnedFd;
        use std::os::unix::process::CommandExt;

        let (own, theirs) = Connection::pair().map_err(|error| format!("no connection can be made: {error}"))?;
        let child = Command::new(program)
            .args(arguments)
            .env("TMPDIR", &folder.0)
            .stdin(OwnedFd::from(theirs))
            .stdout(Stdio::null())
            // an interrupt is for the run, which ends the process
            .process_group(0)
            .spawn()
            .map_err(|error| format!("its process `{}` cannot be started: {error}", program.display()))?;
        Ok(Self { connection: Some(own), child, _folder: folder, lost: None })
    }

    /// Other systems have no pair of sockets without a name.
    #[cfg(not(unix))]
    pub fn start(_: &(PathBuf, Vec<String>), _: Folder) -> Result<Self, String> {
        Err("FMUs run in processes of their own on Unix alone".into())
    }

    /// Hands over the FMU and makes the instance.
    pub fn open(
        &mut self,
        fmu: &[u8],
        interface: FmuInterface,
        parameters: &[(usize, Vec<f64>)],
    ) -> Result<(), String> {
        let places: Vec<usize> = parameters.iter().map(|(k, _)| *k).collect();
        let mut fields = Fields::default().bytes(fmu).code(interface as u8).places(&places);
        for (_, values) in parameters {
            fields = fields.numbers(values);
        }
        self.ask(Verb::Open, fields).map(|_| ())
    }

    /// Asks and waits for the answer.
    fn ask(&mut self, verb: Verb, fields: Fields) -> Result<Frame, String> {
        if let Some(lost) = &self.lost {
            return Err(lost.clone());
        }
        let answer = self.exchange(verb, fields);
        let mut frame = match answer {
            Ok(Some(frame)) => frame,
            Ok(None) => return Err(self.lose(verb, None)),
            Err(error) => return Err(self.lose(verb, Some(error))),
        };
        match frame.code() {
            Ok(0) => Ok(frame),
            Ok(1) => {
                let text = frame.bytes().map(|text| String::from_utf8_lossy(text).into_owned());
                Err(text.unwrap_or_else(|_| "its process gave an answer that is none".to_owned()))
            }
            _ => Err(self.lose(verb, None)),
        }
    }

    fn exchange(&mut self, verb: Verb, fields: Fields) -> std::io::Result<Option<Frame>> {
        let Some(connection) = &mut self.connection else { return Ok(None) };
        Fields::default().code(verb as u8).and(fields).send(connection)?;
        Frame::receive(connection)
    }

    /// Gives the process up and says how it ended.
    fn lose(&mut self, verb: Verb, error: Option<std::io::Error>) -> String {
        self.connection = None;
        let ended = self.wait();
        let how = match (ended, error) {
            (Some(status), _) => how_it_ended(status),
            (None, Some(error)) => format!("cannot be reached ({error})"),
            (None, None) => "does not answer".to_owned(),
        };
        let lost = format!("its process {how} in `{verb:?}`; the run goes no further");
        self.lost = Some(lost.clone());
        lost
    }

    /// Waits for the end of the process, and ends it after a while.
    fn wait(&mut self) -> Option<ExitStatus> {
        let start = Instant::now();
        while start.elapsed() < GRACE {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) => std::thread::sleep(Duration::from_millis(1)),
                Err(_) => break,
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        None
    }
}

/// End of a process in words.
fn how_it_ended(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let meaning = match signal {
            4 => ", an instruction that is none",
            6 => ", it aborted itself",
            7 | 11 => ", an access to memory that is not its own",
            8 => ", an arithmetic error",
            9 => ", it was killed",
            _ => "",
        };
        return format!("crashed (signal {signal}{meaning})");
    }
    match status.code() {
        Some(code) => format!("ended itself with status {code}"),
        None => "ended".to_owned(),
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // it ends when the connection does
        if self.connection.take().is_some() {
            self.wait();
        }
    }
}

fn events(mut answer: Frame) -> Result<FmuEvents, String> {
    let mut next = [0.0];
    answer.fill(&mut next)?;
    Ok(FmuEvents { next: next[0], ends: answer.code()? != 0 })
}

impl FmuInstance for Client {
    fn start(&mut self, t: f64, (places, values): FmuValues<'_>) -> Result<FmuEvents, String> {
        events(self.ask(Verb::Start, Fields::default().numbers(&[t]).places(places).numbers(values))?)
    }

    fn set(&mut self, (places, values): FmuValues<'_>) -> Result<(), String> {
        self.ask(Verb::Set, Fields::default().places(places).numbers(values)).map(|_| ())
    }

    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String> {
        self.ask(Verb::Get, Fields::default().places(places).places(&[values.len()]))?.fill(values)
    }

    fn step(&mut self, t: f64, h: f64) -> Result<(), String> {
        self.ask(Verb::Step, Fields::default().numbers(&[t, h])).map(|_| ())
    }

    fn save(&mut self) -> Result<Vec<u8>, String> {
        self.ask(Verb::Save, Fields::default())?.bytes().map(<[u8]>::to_vec)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), String> {
        self.ask(Verb::Restore, Fields::default().bytes(state)).map(|_| ())
    }

    fn continuous_states(&mut self, states: &mut [f64], nominals: &mut [f64]) -> Result<(), String> {
        let mut answer = self.ask(Verb::States, Fields::default().places(&[states.len()]))?;
        answer.fill(states)?;
        answer.fill(nominals)
    }

    fn set_continuous_states(&mut self, t: f64, states: &[f64]) -> Result<(), String> {
        self.ask(Verb::SetStates, Fields::default().numbers(&[t]).numbers(states)).map(|_| ())
    }

    fn derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), String> {
        self.ask(Verb::Derivatives, Fields::default().places(&[derivatives.len()]))?.fill(derivatives)
    }

    fn event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), String> {
        self.ask(Verb::Indicators, Fields::default().places(&[indicators.len()]))?.fill(indicators)
    }

    fn complete_step(&mut self) -> Result<bool, String> {
        Ok(self.ask(Verb::CompleteStep, Fields::default())?.code()? != 0)
    }

    fn handle_events(&mut self, (places, values): FmuValues<'_>) -> Result<FmuEvents, String> {
        events(self.ask(Verb::HandleEvents, Fields::default().places(places).numbers(values))?)
    }

    fn directional_derivative(
        &mut self,
        unknowns: &[usize],
        knowns: &[usize],
        seed: &[f64],
        change: &mut [f64],
    ) -> Result<bool, String> {
        let fields = Fields::default().places(unknowns).places(knowns).numbers(seed).places(&[change.len()]);
        let mut answer = self.ask(Verb::DirectionalDerivative, fields)?;
        let has = answer.code()? != 0;
        answer.fill(change)?;
        Ok(has)
    }
}
