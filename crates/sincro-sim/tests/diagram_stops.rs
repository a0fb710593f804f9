//! Blocks that stop giving numbers: the run stops, says which block and when, and keeps its rows.

use sincro_sim::results::Status;
use sincro_testing::scenes;

/// Runs the sprung arm with a diagram; how many rows there are, tick, reason, help.
fn stops(wires: &str, blocks: &str, integrator: &str) -> (usize, u64, String, String) {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "damping = 0.5", "damping = 0.5\nmotor = { mode = \"torque\" }");
    let experiment = format!(
        "title = \"T\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\n\
         integrator = \"{integrator}\"\nerror_bar = \"none\"\nrecord = [\"/shoulder.position\"]\n"
    );
    folder.write("experiment.toml", &experiment);
    folder.write("diagram.toml", &format!("wires = [{wires}]\n{blocks}"));
    let loaded = folder.load(&[]).unwrap();
    let run = sincro_testing::run(&loaded);
    match run.status {
        Status::Stopped { tick, reason, help, .. } => (run.table.n_rows(), tick, reason, help),
        other => panic!("{other:?}"),
    }
}

const CLOCK: &str = "[[block]]\nname = \"clock\"\ntype = \"clock\"\n";

fn expression(formula: &str) -> String {
    format!("{CLOCK}[[block]]\nname = \"f\"\ntype = \"expression\"\ninputs = [\"u\"]\nexpression = \"{formula}\"\n")
}

#[test]
fn a_division_by_zero_names_block_and_tick() {
    let blocks = format!(
        "{CLOCK}[[block]]\nname = \"one\"\ntype = \"constant\"\nvalue = 1\n[[block]]\nname = \"ratio\"\ntype = \"divide\"\n[[block]]\nname = \"late\"\ntype = \"expression\"\ninputs = [\"u\"]\nexpression = \"max(0.5 - u, 0)\"\nsample_time = 0.01\n"
    );
    let wires = r#""clock -> late", "one -> ratio.u1", "late -> ratio.u2", "ratio -> /shoulder""#;
    let (rows, tick, reason, help) = stops(wires, &blocks, "auto");
    assert_eq!(tick, 50);
    assert!(reason.contains("block `ratio` (divide) gave inf in tick 50 at t = 0.5") && help.contains("divisor"));
    assert!(rows >= 50, "{rows}");
}

#[test]
fn roots_and_logarithms_of_negative_numbers_name_the_block() {
    for integrator in ["semi-implicit-euler", "rk4", "implicit", "dormand-prince", "dormand-prince-8", "stiff"] {
        for formula in ["sqrt(0.255 - u)", "ln(0.255 - u)"] {
            let (_, tick, reason, help) = stops(r#""clock -> f -> /shoulder""#, &expression(formula), integrator);
            println!("{integrator} {formula}: {tick} {reason} {help}");
            assert!(reason.contains("block `f` (expression)"), "{integrator} {formula}: {reason}");
            assert!((25..=26).contains(&tick), "{integrator}: {tick}");
            assert!(help.contains("root or logarithm"), "{help}");
        }
    }
}

#[test]
fn a_loop_that_grows_without_bound_names_its_first_block() {
    let blocks = "[[block]]\nname = \"x\"\ntype = \"unit-delay\"\ninitial = 1\n[[block]]\nname = \"grow\"\ntype = \"gain\"\ngain = 1e9\n";
    let wires = r#""x -> grow -> x""#;
    let (rows, tick, reason, help) = stops(wires, blocks, "auto");
    assert_eq!((rows, tick), (35, 34));
    assert!(reason.contains("block `grow` (gain) gave inf") && help.contains("without bound"), "{reason} {help}");
}
