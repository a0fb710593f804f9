//! FMUs in processes of their own: one for each instance, which may crash without the run.
//!
//! The process is this program again, asked to be a [`serve`]r of one instance; it is spoken to over a pair of
//! connected sockets in the place of its standard input, which have no name and no port. Its answers are read as those
//! of a stranger: whatever an FMU leaves there is an error of the run, not of this process.

mod client;
mod wire;
mod worker;

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use sincro_scene::fmu::{FmuExchange, FmuInstance, FmuInterface, FmuLoader, FmuModel, FmuVariable};

use super::block::Model;
use super::{Folder, ForeignFmu};
use client::Client;
pub use worker::serve;

/// Loader of FMUs whose instances run in processes of their own: `program` with `arguments`, which calls [`serve`].
#[derive(Debug)]
pub struct IsolatedLoader {
    program: PathBuf,
    arguments: Vec<String>,
}

impl IsolatedLoader {
    /// Creates a loader that starts `program` with `arguments` for each instance.
    #[must_use]
    pub fn new(program: PathBuf, arguments: Vec<String>) -> Self {
        Self { program, arguments }
    }
}

impl FmuLoader for IsolatedLoader {
    fn read(&self, bytes: &[u8]) -> Result<Arc<dyn FmuModel>, String> {
        Ok(Arc::new(IsolatedModel {
            // described here, run elsewhere: reading loads nothing
            model: Model::new(ForeignFmu::read(bytes)?),
            bytes: bytes.into(),
            command: (self.program.clone(), self.arguments.clone()),
        }))
    }
}

/// FMU whose instances run in processes of their own.
struct IsolatedModel {
    model: Model,
    bytes: Arc<[u8]>,
    command: (PathBuf, Vec<String>),
}

/// As that of the FMU in this process: hashes of models are made from this text.
impl fmt::Debug for IsolatedModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.model.fmt(f)
    }
}

impl FmuModel for IsolatedModel {
    fn name(&self) -> &str {
        self.model.name()
    }

    fn interfaces(&self) -> &[FmuInterface] {
        self.model.interfaces()
    }

    fn variables(&self) -> &[FmuVariable] {
        self.model.variables()
    }

    fn exchange(&self) -> &FmuExchange {
        self.model.exchange()
    }

    fn can_save(&self, interface: FmuInterface) -> bool {
        self.model.can_save(interface)
    }

    fn instantiate(
        &self,
        interface: FmuInterface,
        parameters: &[(usize, Vec<f64>)],
    ) -> Result<Box<dyn FmuInstance>, String> {
        let mut client = Client::start(&self.command, Folder::new()?)?;
        client.open(&self.bytes, interface, parameters)?;
        Ok(Box::new(client))
    }
}
