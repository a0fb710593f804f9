//! FMUs in processes of their own: the same bits, and crashes that end the run alone. The process is this test again.
#![cfg(unix)]

mod common;

use sincro_fmu::FmiVersion;
use sincro_fmu::import::isolated::{IsolatedLoader, serve};
use sincro_fmu::import::loader;
use sincro_scene::fmu::FmuLoader;
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::{SceneFolder, run};

use common::{SCENE, compiled};

/// Word among the arguments by which a test knows that it is the process of an FMU.
const WORKER: &str = "be-the-process-of-an-fmu";

#[test]
fn serves_an_instance() {
    if std::env::args().any(|word| word == WORKER) {
        serve().unwrap();
    }
}

fn isolated() -> &'static dyn FmuLoader {
    let arguments = ["--exact", "serves_an_instance", WORKER, "--nocapture"].map(str::to_owned);
    Box::leak(Box::new(IsolatedLoader::new(std::env::current_exe().unwrap(), arguments.to_vec())))
}

const PLANT: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="plant" guid="{plant}">
    <CoSimulation modelIdentifier="plant"/>
    <ModelVariables>
      <ScalarVariable name="u" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>
      <ScalarVariable name="y" valueReference="1" causality="output"><Real/></ScalarVariable>
      <ScalarVariable name="gain" valueReference="3" causality="parameter"><Real start="1"/></ScalarVariable>
    </ModelVariables>
  </fmiModelDescription>"#;

const BALL: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="ball" instantiationToken="{ball}">
    <ModelExchange modelIdentifier="ball" canGetAndSetFMUState="true" canSerializeFMUState="true"/>
    <ModelVariables>
      <Float64 name="h" valueReference="0" causality="output"/>
      <Float64 name="der(h)" valueReference="2"/>
      <Float64 name="der(v)" valueReference="3"/>
      <Float64 name="u" valueReference="4" causality="input"/>
      <Int32 name="ticks" valueReference="9" causality="output"/>
    </ModelVariables>
    <ModelStructure>
      <Output valueReference="0" dependencies=""/><Output valueReference="9" dependencies=""/>
      <ContinuousStateDerivative valueReference="2"/><ContinuousStateDerivative valueReference="3"/>
      <EventIndicator valueReference="0"/>
    </ModelStructure>
  </fmiModelDescription>"#;

fn scene(fmu: &[u8], block: &str, amplitude: f64, loader: &'static dyn FmuLoader) -> (SceneFolder, Loaded) {
    let diagram = format!(
        "wires = [\"source -> foreign.u\", {block}\n\
         {{ name = \"source\", type = \"sine\", sample_time = 0.01, amplitude = {amplitude:?}, frequency_hz = 1.0 }}]\n"
    );
    let experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\n\
                      error_bar = \"none\"\nrecord = [\"/slide.position\"]\n";
    let folder = SceneFolder::of(SCENE, experiment).with("diagram.toml", &diagram);
    std::fs::write(folder.join("foreign.fmu"), fmu).unwrap();
    let loaded = load(&folder, &[], Extensions { fmus: Some(loader), ..Extensions::default() }).unwrap();
    (folder, loaded)
}

const STEPPED: &str = "\"foreign -> /slide\"]\nblock = [{ name = \"foreign\", type = \"fmu\", file = \"foreign.fmu\", \
                       sample_time = 0.01, parameters = { gain = 0.1 } },";
const EXCHANGED: &str =
    "\"foreign.ticks -> /slide\"]\nblock = [{ name = \"foreign\", type = \"fmu\", file = \"foreign.fmu\" },";

#[test]
fn isolated_runs_have_the_same_bits() {
    let plant = compiled("plant", FmiVersion::V2, PLANT);
    let ball = compiled("ball", FmiVersion::V3, BALL);
    for (fmu, block) in [(&plant, STEPPED), (&ball, EXCHANGED)] {
        let (here, there) = (scene(fmu, block, 2.0, loader()), scene(fmu, block, 2.0, isolated()));
        let (here, there) = (run(&here.1), run(&there.1));
        assert_eq!(format!("{:?}", here.status), "Completed");
        assert!(here.table.column("/slide.position").unwrap().values.last().unwrap().abs() > 1e-3);
        assert_eq!((here.trace, format!("{:?}", here.status)), (there.trace, format!("{:?}", there.status)));
    }
}

#[test]
fn crash_ends_the_run_and_names_the_fmu() {
    let plant = compiled("plant", FmiVersion::V2, PLANT);
    // the plant refuses inputs above 100 and crashes above 1000
    let status = |amplitude: f64| format!("{:?}", run(&scene(&plant, STEPPED, amplitude, isolated()).1).status);
    let refused = status(500.0);
    assert!(refused.contains("the FMU `plant`: DoStep of the FMU failed with status 3"), "{refused}");
    let crashed = status(1e5);
    assert!(crashed.contains("the FMU `plant`: its process crashed (signal 11"), "{crashed}");
    assert!(crashed.contains("in `Step`") && crashed.contains("Stopped"), "{crashed}");
}

#[test]
fn worker_that_is_none_is_named() {
    let plant = compiled("plant", FmiVersion::V2, PLANT);
    for (program, message) in [("/nonexistent", "cannot be started"), ("/bin/true", "its process ended itself")] {
        let loader = Box::leak(Box::new(IsolatedLoader::new(program.into(), Vec::new())));
        let status = format!("{:?}", run(&scene(&plant, STEPPED, 1.0, loader).1).status);
        assert!(status.contains("the FMU `plant`") && status.contains(message), "{status}");
    }
}
