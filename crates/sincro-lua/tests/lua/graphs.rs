//! Values of graphs that scripts set are recorded with the run.

use sincro_coppelia::api::Value;
use sincro_sim::run::{RunMonitor, RunOptions, Simulated, simulate};
use sincro_sim::table::Table;
use sincro_testing::with_scripts;

use super::world::{EXPERIMENT, PENDULUM, folder, run, said, with_script};

fn values(run: &Simulated, name: &str) -> Vec<String> {
    let column = run.table.column(name).unwrap_or_else(|| panic!("no {name}"));
    column.values.iter().map(|x| format!("{x}")).collect()
}

const CODE: &str = "
    function sysCall_init()
        sim = require('sim')
        graph = sim.getObject('/tip')
        height = sim.addGraphStream(graph, 'height (tip)', 'm', 0, { 1, 0, 0 })
        twice = sim.addGraphStream(graph, 'twice', 'm', 0, { 0, 1, 0 })
        sim.setGraphStreamTransformation(graph, twice, 0, 2, 1)
        assert(height == 1 and twice == 2 and sim.addGraphStream(graph, 'twice', 'mm') == 2)
        sim.addGraphCurve(graph, 'xy', 2, { height, twice }, { 0, 0 }, 'm')
    end
    function sysCall_sensing()
        local t = sim.getSimulationTime()
        sim.setGraphStreamValue(graph, height, t)
        if t > 0.005 then sim.setGraphStreamValue(graph, twice, t) end
        if t > 0.025 then simSetGraphUserData(graph, 'late', 7) end
        simHandleGraph(graph, t)
    end";

#[test]
fn streams_of_graphs_are_columns_of_the_run() {
    let run = run(&with_script(CODE, "").unwrap());
    assert_eq!(values(&run, "/hinge/arm/tip.height (tip)"), ["NaN", "0", "0.01", "0.02", "0.03", "0.04"]);
    assert_eq!(values(&run, "/hinge/arm/tip.twice"), ["NaN", "NaN", "1.02", "1.04", "1.06", "1.08"]);
    assert_eq!(values(&run, "/hinge/arm/tip.late"), ["NaN", "NaN", "NaN", "NaN", "7", "7"]);
    let units: Vec<&str> = run.table.columns[3..].iter().map(|c| c.unit.as_str()).collect();
    assert_eq!((run.n_streams, units), (3, vec!["m", "mm", ""]));
}

#[test]
fn they_are_in_the_file_too_and_a_graph_that_is_reset_forgets() {
    let code = "function sysCall_init() g = sim.getObject('/tip') end
        function sysCall_sensing()
            sim.setGraphUserData(g, 'x', sim.getSimulationTime())
            if sim.getSimulationTime() > 0.025 and not done then done = true sim.resetGraph(sim.handle_all) end
        end";
    let loaded = with_script(code, "").unwrap();
    let folder = folder(&[]);
    let path = folder.join("signals.csv");
    let interrupt = std::sync::atomic::AtomicBool::new(false);
    let mut watch = RunMonitor { interrupt: &interrupt, progress: &mut |_| {} };
    let run = simulate(&loaded, RunOptions { csv: Some(&path), ..RunOptions::default() }, &mut watch).unwrap();
    assert_eq!(values(&run, "/hinge/arm/tip.x"), ["NaN", "NaN", "NaN", "NaN", "NaN", "0.04"]);
    let read = Table::read_csv(&path).unwrap();
    assert_eq!(read.columns.last().unwrap().name, "/hinge/arm/tip.x");
    assert_eq!(read.n_rows(), 6);
}

#[test]
fn what_is_wrong_with_a_stream_is_told() {
    let code = "function sysCall_init()
        local g, arm = sim.getObject('/tip'), sim.getObject('/arm')
        local function why(f, ...) print((select(2, pcall(f, ...)):gsub('^.-: ', ''))) end
        sim.addGraphStream(g, 'a', 'm')
        why(sim.addGraphStream, g, '', 'm')
        why(sim.addGraphStream, g, 'two\\nlines', 'm')
        why(sim.addGraphStream, 999, 'a', 'm')
        why(sim.setGraphStreamValue, arm, 1, 0)
        why(sim.setGraphStreamTransformation, g, 1, 1)
        for k = 1, 199 do sim.addGraphStream(g, 'n' .. k, '') end
        why(sim.addGraphStream, g, 'one more', '')
    end";
    let said = said(code);
    let expected = [
        "a stream of a graph has a name and a unit",
        "a stream of a graph has a name and a unit",
        "there is no object with the handle 999",
        "the graph `/hinge/arm` has no stream 1",
        "values are recorded as they are",
        "there are 200 streams of graphs already",
    ];
    assert_eq!(said.len(), expected.len(), "{said:?}");
    assert!(said.iter().zip(expected).all(|(said, expected)| said.contains(expected)), "{said:?}");
}

#[test]
fn a_client_makes_streams_that_stay_and_scripts_make_theirs_anew() {
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n");
    let folder = folder(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", CODE)]);
    let mut session = folder.session(with_scripts(), None);
    let graph = session.call("sim.getObject", &[Value::from("/hinge")]).unwrap().remove(0);
    let stream = session.call("sim.addGraphStream", &[graph.clone(), Value::from("u"), Value::from("N·m")]).unwrap();
    for _ in 0..2 {
        session.start().unwrap();
        session.step().unwrap();
        session.call("sim.setGraphStreamValue", &[graph.clone(), stream[0].clone(), Value::Real(3.0)]).unwrap();
        session.step().unwrap();
        session.stop().unwrap();
        let run = session.take_finished().remove(0).simulated;
        assert_eq!(values(&run, "/hinge.u"), ["NaN", "NaN", "3"]);
        assert_eq!(values(&run, "/hinge/arm/tip.height (tip)"), ["NaN", "0", "0.01"]);
    }
}
