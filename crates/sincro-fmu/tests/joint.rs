//! The example `examples/fmi/joint`: an FMU is the whole controller, another one the drive of a joint. They are made
//! here by a C compiler.

mod common;

use std::path::{Path, PathBuf};

use sincro_fmu::FmiVersion;
use sincro_fmu::import::loader;
use sincro_sim::run::Simulated;
use sincro_sim::{Extensions, load};
use sincro_testing::{SceneFolder, run};

use common::compiled_in;

/// The same joint with the motor and the law of sincro itself.
const OWN_MOTOR: &str = "motor = { mode = \"voltage\", resistance = 1.2, inductance = 0.8e-3, torque_constant = 0.05, gear_ratio = 30.0, max_voltage = 100.0 }";
const OWN_DIAGRAM: &str = "
    wires = [\"reference -> law.r\", \"/joint.position -> law.q\", \"/joint.velocity -> law.w\", \"law -> /joint\"]
    block = [
        { name = \"reference\", type = \"step\", sample_time = 0.002, time = 0.1, to = 1.0 },
        { name = \"law\", type = \"expression\", sample_time = 0.002, expression = \"min(max(60*(r - q) - 4*w, -24), 24)\" },
    ]
";

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/fmi/joint")
}

/// The example with its FMUs, in a folder of its own.
fn with_fmus() -> SceneFolder {
    let read = |name: &str| std::fs::read_to_string(example().join(name)).unwrap();
    let folder =
        SceneFolder::of(&read("scene.toml"), &read("experiment.toml")).with("diagram.toml", &read("diagram.toml"));
    for name in ["drive", "controller"] {
        let fmu = compiled_in(&example(), name, FmiVersion::V2, &read(&format!("{name}.xml")));
        std::fs::write(folder.join(format!("{name}.fmu")), fmu).unwrap();
    }
    folder
}

#[test]
fn a_drive_and_a_controller_that_are_fmus_move_a_joint_as_those_of_the_scene() {
    let extensions = Extensions { fmus: Some(loader()), ..Extensions::default() };
    let loaded = load(&with_fmus(), &[], extensions).unwrap();
    let of_fmus = run(&loaded);
    let own_scene = std::fs::read_to_string(example().join("scene.toml")).unwrap();
    let own_scene = own_scene.replace("motor = { mode = \"torque\" }", OWN_MOTOR);
    let own_experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 2.0\nstep = 0.001\n\
        record = [\"/joint.position\", \"/joint.velocity\"]\n";
    let own = SceneFolder::of(&own_scene, own_experiment).with("diagram.toml", OWN_DIAGRAM);
    let own = run(&load(&own, &[], Extensions::default()).unwrap());
    for name in ["/joint.position", "/joint.velocity"] {
        let column = |result: &Simulated| {
            result.table.column(name).unwrap_or_else(|| panic!("{name}: {:?}", result.status)).values.clone()
        };
        let (ours, theirs) = (column(&own), column(&of_fmus));
        assert_eq!(ours.len(), 2001);
        let worst = ours.iter().zip(&theirs).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        println!("{name}: {worst:e}");
        // the same equations with sums in another order: 2,000 steps of rounding
        assert!(worst < 1e-9, "{name}: {worst}");
    }
    // the arm arrives: what is left is the sag under gravity
    let position = of_fmus.table.column("/joint.position").unwrap().values[2000];
    assert!((0.8..1.0).contains(&position), "{position}");
    // another run begins anew
    assert_eq!(run(&loaded).trace, of_fmus.trace);
}
