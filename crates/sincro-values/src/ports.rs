//! Ports of the legacy API as scripts know them: which are open, which may be opened for them, and where clients step.

use std::collections::BTreeSet;

use crate::ApiError;

/// Ports that scripts may have opened beside those of the command line.
const MAX_SCRIPT_PORTS: usize = 8;
/// The smallest port that is opened for a script.
const MIN_PORT: u16 = 1_024;
/// Port of V-REP's own service, on which clients may always step: a script does not start it again.
const CONTINUOUS_PORT: u16 = 19_997;

/// Request of a script for a TCP port of the legacy API (`simRemoteApi.start`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortRequest {
    /// TCP port.
    pub port: u16,
    /// True if it is to be opened; false if it is open already.
    pub is_new: bool,
    /// True if `simxSynchronous` has effect for the clients of this port (`preEnableTrigger`).
    pub has_trigger: bool,
}

/// TCP ports of the legacy remote API of one server: those that it opened by itself, and those that scripts asked for
/// with `simRemoteApi.start`, at most eight.
#[derive(Clone, Debug, Default)]
pub struct LegacyPorts {
    of_server: BTreeSet<u16>,
    of_scripts: BTreeSet<u16>,
}

impl LegacyPorts {
    /// Creates the set from the TCP ports that a server has opened by itself; without any, the legacy API is not served
    /// and scripts get none.
    #[must_use]
    pub fn new(of_server: impl IntoIterator<Item = u16>) -> Self {
        Self { of_server: of_server.into_iter().collect(), of_scripts: BTreeSet::new() }
    }

    /// Returns true if a TCP port is open, or about to be opened for a script.
    #[must_use]
    pub fn contains(&self, port: u16) -> bool {
        self.of_server.contains(&port) || self.of_scripts.contains(&port)
    }

    /// Adds a TCP port for a script, to be opened before the next step; returns what the server has to do. Port 19997,
    /// V-REP's own, keeps its trigger whatever the script says.
    ///
    /// # Errors
    ///
    /// The legacy API is not served, the port is below 1024, or scripts have eight ports already.
    pub fn add(&mut self, port: u16, has_trigger: bool) -> Result<PortRequest, ApiError> {
        let has_trigger = has_trigger || port == CONTINUOUS_PORT;
        if self.contains(port) {
            return Ok(PortRequest { port, is_new: false, has_trigger });
        }
        if self.of_server.is_empty() {
            return Err(ApiError::new("the server runs without the legacy API"));
        }
        if port < MIN_PORT || self.of_scripts.len() >= MAX_SCRIPT_PORTS {
            let below = MIN_PORT - 1;
            return Err(ApiError(format!("scripts may have up to {MAX_SCRIPT_PORTS} ports above {below} opened")));
        }
        self.of_scripts.insert(port);
        Ok(PortRequest { port, is_new: true, has_trigger })
    }

    /// Removes a TCP port that could not be opened for a script; nothing if it is none of those.
    pub fn remove(&mut self, port: u16) {
        self.of_scripts.remove(&port);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_have_a_few_ports_above_those_of_the_system() {
        let mut ports = LegacyPorts::new([19_997]);
        let open = PortRequest { port: 19_997, is_new: false, has_trigger: true };
        assert_eq!(ports.add(19_997, false).unwrap(), open, "it is open already, with its trigger");
        assert!(ports.add(80, true).unwrap_err().0.contains("above 1023"));
        for port in 0..8 {
            let request = ports.add(20_000 + port, false).unwrap();
            assert!(request.is_new && !request.has_trigger);
        }
        assert!(ports.add(20_008, true).is_err() && !ports.contains(20_008));
        ports.remove(20_000);
        assert!(ports.add(20_008, true).unwrap().has_trigger);
        assert!(ports.contains(20_008) && !ports.contains(20_000));
        assert!(LegacyPorts::default().add(20_000, true).unwrap_err().0.contains("without the legacy API"));
    }
}
