//! Graphs: what clients and scripts record by `sim.addGraphStream` and `sim.setGraphStreamValue`. Any object of the
//! scene is a graph, a `[[frame]]` named `graph` say; each stream becomes a column of the run, `/graph.name`.

use super::{ApiError, Handle, SimApi};

pub(crate) use sincro_values::graphs::Graphs;

impl SimApi<'_> {
    /// A stream of a graph; that of the same name if there is one. Its number in the graph.
    ///
    /// # Errors
    ///
    /// There is no such object, there are too many streams, or the name is none.
    pub(crate) fn add_stream(&mut self, graph: Handle, name: &str, unit: &str) -> Result<i64, ApiError> {
        let (path, of_run) = (self.registry.entry(graph)?.path.clone(), self.is_running());
        self.registry.graphs.add((graph, &path), (name, unit), of_run)
    }

    /// Sets the value of a stream from now on.
    ///
    /// # Errors
    ///
    /// There is no such object or stream.
    pub(crate) fn set_stream(&mut self, graph: Handle, number: i64, value: f64) -> Result<(), ApiError> {
        let path = &self.registry.entry(graph)?.path.clone();
        self.registry.graphs.set((graph, path), number, value)
    }

    /// Values of a stream are multiplied and shifted before they are recorded.
    ///
    /// # Errors
    ///
    /// There is no such object or stream, or a number is not finite.
    pub(crate) fn scale_stream(&mut self, graph: Handle, number: i64, by: (f64, f64)) -> Result<(), ApiError> {
        let path = &self.registry.entry(graph)?.path.clone();
        self.registry.graphs.scale((graph, path), number, by)
    }

    /// Forgets what the streams of a graph have shown so far, of all graphs if none is given.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(crate) fn clear_graph(&mut self, graph: Option<Handle>) -> Result<(), ApiError> {
        if let Some(graph) = graph {
            self.registry.entry(graph)?;
        }
        self.registry.graphs.clear(graph);
        Ok(())
    }
}
