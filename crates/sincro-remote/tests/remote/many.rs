//! Many clients at once, and many steps of one.

use sincro_coppelia::api::Value;

use super::scene::{finished, serve};
use sincro_testing::clients::legacy::Client as Legacy;
use sincro_testing::clients::zmq::Client as Zmq;

#[test]
fn fifty_clients_step_together_and_one_that_goes_holds_nobody() {
    let server = serve();
    let address = server.ports().zmq.unwrap();
    let mut clients: Vec<Zmq> = (0..50).map(|k| Zmq::connect(address, Some(&format!("client {k}")))).collect();
    for client in &mut clients {
        client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    }
    assert_eq!(server.hub().enter().n_clients(), 50);
    clients[0].call("sim.startSimulation", &[]).unwrap();
    for k in 1..=5 {
        clients.iter_mut().for_each(|client| client.send("sim.step", &[]));
        clients.iter_mut().for_each(|client| drop(client.receive()));
        let t = clients[49].real("sim.getSimulationTime", &[]);
        assert!((t - 0.05 * f64::from(k)).abs() < 1e-12, "{t}");
    }
    // one asks for nothing and goes: the others go on
    clients.iter_mut().skip(1).for_each(|client| client.send("sim.step", &[]));
    drop(clients.remove(0));
    clients.iter_mut().for_each(|client| drop(client.receive()));
    let t = clients[0].real("sim.getSimulationTime", &[]);
    assert!((t - 0.3).abs() < 1e-12, "{t}");
}

/// Memory of this process that is in use [bytes]; none where the system does not tell.
fn resident() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<usize>().ok().map(|kib| kib << 10)
}

/// Set in the process of a test that is alone.
const ALONE: &str = "SINCRO_TEST_ALONE";

/// Returns true if this process is the test's own; if not, runs the test in one: beside it others take memory, too.
fn is_alone(test: &str) -> bool {
    if std::env::var_os(ALONE).is_some() {
        return true;
    }
    let own =
        std::process::Command::new(std::env::current_exe().unwrap()).args(["--exact", test]).env(ALONE, "1").output();
    let done = own.unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && said.contains("1 passed"), "{said}{}", String::from_utf8_lossy(&done.stderr));
    false
}

#[test]
fn a_long_run_of_a_client_takes_no_more_memory() {
    if !is_alone("many::a_long_run_of_a_client_takes_no_more_memory") {
        return;
    }
    let server = serve();
    let mut client = Legacy::connect(server.ports().legacy[0]);
    client.start();
    let mut steps = |n: usize| {
        for _ in 0..n {
            client.trigger().unwrap();
            client.inbox.clear();
        }
    };
    steps(3_000);
    // other tests run in the same process: what they take at the time is not taken in every stretch
    let mut stretch = || {
        let before = resident();
        steps(10_000);
        Some(resident()?.saturating_sub(before?))
    };
    if let Some(grown) = (0..3).filter_map(|_| stretch()).min() {
        // a run that kept what the experiment's two seconds keep, for 500 s, would take 4 MB in its table alone
        assert!(grown < 2 << 20, "{grown} bytes in 10 000 steps");
    }
    client.simulation(2);
    let run = finished(&server);
    assert_eq!((run.steps, run.simulated.table.times().len()), (33_000, 401));
}
