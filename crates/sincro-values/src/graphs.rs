//! Graphs: what clients and scripts record by `sim.addGraphStream` and `sim.setGraphStreamValue`. Any object of the
//! scene is a graph, a `[[frame]]` named `graph` say; each stream becomes a column of the run, `/graph.name`.

use crate::{ApiError, Handle};

/// Streams that may exist at once.
const MAX_STREAMS: usize = 200;
/// Bytes of a name or unit.
const MAX_LABEL_LEN: usize = 100;

/// A stream of a graph.
#[derive(Clone, Debug, PartialEq)]
pub struct Stream {
    graph: Handle,
    /// Its number in the graph, from 1: stays when others go.
    number: i64,
    name: String,
    /// Name of its column.
    pub column: String,
    /// Its unit, as it was given.
    pub unit: String,
    /// Latest value; not a number before the first.
    pub value: f64,
    factor: f64,
    offset: f64,
    /// Made during a run: removed when the next one starts.
    of_run: bool,
}

/// The streams of all graphs.
#[derive(Clone, Debug, Default)]
pub struct Graphs {
    streams: Vec<Stream>,
    /// Streams whose past is to be forgotten.
    cleared: Vec<usize>,
}

impl Graphs {
    /// All streams, in the order in which they were made; those of a run stay until the next one.
    #[must_use]
    pub fn streams(&self) -> &[Stream] {
        &self.streams
    }

    /// Takes the streams whose past is to be forgotten.
    pub fn take_cleared(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.cleared)
    }

    /// Forgets what the last run made.
    pub fn forget_run(&mut self) {
        self.streams.retain(|stream| !stream.of_run);
        self.streams.iter_mut().for_each(|stream| stream.value = f64::NAN);
        self.cleared.clear();
    }

    /// Adds a stream to a graph of a path, or gives that of the same name another unit; its number in the graph. One
    /// that is made during a run ends with it.
    ///
    /// # Errors
    ///
    /// There are too many streams, or the name is none.
    pub fn add(
        &mut self,
        (graph, path): (Handle, &str),
        (name, unit): (&str, &str),
        of_run: bool,
    ) -> Result<i64, ApiError> {
        let is_plain = |text: &str| text.len() <= MAX_LABEL_LEN && !text.chars().any(char::is_control);
        if name.is_empty() || !is_plain(name) || !is_plain(unit) {
            return Err(ApiError(format!(
                "a stream of a graph has a name and a unit of up to {MAX_LABEL_LEN} bytes in one line"
            )));
        }
        if let Some(k) = self.place(graph, name) {
            unit.clone_into(&mut self.streams[k].unit);
            return Ok(self.streams[k].number);
        }
        if self.streams.len() >= MAX_STREAMS {
            return Err(ApiError(format!("there are {MAX_STREAMS} streams of graphs already")));
        }
        let (name, unit, column) = (name.to_owned(), unit.to_owned(), format!("{path}.{name}"));
        let number = self.streams.iter().filter(|s| s.graph == graph).map(|s| s.number).max().unwrap_or(0) + 1;
        let (value, factor, offset) = (f64::NAN, 1.0, 0.0);
        self.streams.push(Stream { graph, number, name, column, unit, value, factor, offset, of_run });
        Ok(number)
    }

    fn stream(&mut self, (graph, path): (Handle, &str), number: i64) -> Result<&mut Stream, ApiError> {
        let found = self.streams.iter_mut().find(|s| s.graph == graph && s.number == number);
        found.ok_or_else(|| {
            ApiError(format!("the graph `{path}` has no stream {number}: addGraphStream gives their numbers"))
        })
    }

    /// Sets the value of a stream of a graph from now on.
    ///
    /// # Errors
    ///
    /// There is no such stream.
    pub fn set(&mut self, graph: (Handle, &str), number: i64, value: f64) -> Result<(), ApiError> {
        let stream = self.stream(graph, number)?;
        stream.value = stream.factor * value + stream.offset;
        Ok(())
    }

    /// Values of a stream are multiplied and shifted before they are recorded.
    ///
    /// # Errors
    ///
    /// There is no such stream, or a number is not finite.
    pub fn scale(&mut self, graph: (Handle, &str), number: i64, (factor, offset): (f64, f64)) -> Result<(), ApiError> {
        if !(factor.is_finite() && offset.is_finite()) {
            return Err(ApiError(format!("factor {factor} and offset {offset}, expected numbers")));
        }
        let stream = self.stream(graph, number)?;
        (stream.factor, stream.offset) = (factor, offset);
        Ok(())
    }

    /// Forgets what the streams of a graph have shown so far, of all graphs if none is given.
    pub fn clear(&mut self, graph: Option<Handle>) {
        for (k, stream) in self.streams.iter_mut().enumerate().filter(|(_, s)| graph.is_none_or(|g| s.graph == g)) {
            stream.value = f64::NAN;
            if !self.cleared.contains(&k) {
                self.cleared.push(k);
            }
        }
    }

    fn place(&self, graph: Handle, name: &str) -> Option<usize> {
        self.streams.iter().position(|s| s.graph == graph && s.name == name)
    }
}
