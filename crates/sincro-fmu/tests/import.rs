//! FMUs of others as blocks and controllers: made here by a C compiler, and hostile ones.

mod common;

use sincro_fmu::FmiVersion;
use sincro_fmu::archive::pack;
use sincro_fmu::import::{FmuController, ForeignFmu, NumberKind, Slave, Wiring, loader};
use sincro_fmu::platform::Platform;
use sincro_scene::record::Recorder;
use sincro_sim::run::{LockStep, method_for};
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::{SceneFolder, run};

use common::{SCENE, compiled};

const STEP: f64 = 0.01;

fn description(version: FmiVersion) -> String {
    match version {
        FmiVersion::V2 => r#"<fmiModelDescription fmiVersion="2.0" modelName="plant" guid="{plant}">
            <CoSimulation modelIdentifier="plant"/>
            <ModelVariables>
              <ScalarVariable name="drive.u" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>
              <ScalarVariable name="y" valueReference="1" causality="output"><Real unit="N"/></ScalarVariable>
              <ScalarVariable name="z" valueReference="2" causality="output"><Real/></ScalarVariable>
              <ScalarVariable name="gain" valueReference="3" causality="parameter"><Real start="1"/></ScalarVariable>
            </ModelVariables>
          </fmiModelDescription>"#
            .into(),
        FmiVersion::V3 => r#"<fmiModelDescription fmiVersion="3.0" modelName="plant" instantiationToken="{plant}">
            <CoSimulation modelIdentifier="plant"/>
            <ModelVariables>
              <Float64 name="drive.u" valueReference="0" causality="input" start="0"/>
              <Float64 name="y" valueReference="1" causality="output" unit="N"/>
              <Float64 name="z" valueReference="2" causality="output"/>
              <Float64 name="gain" valueReference="3" causality="parameter" start="1"/>
            </ModelVariables>
          </fmiModelDescription>"#
            .into(),
    }
}

/// The plant of `plant.c` as an FMU.
fn plant(version: FmiVersion) -> Vec<u8> {
    compiled("plant", version, &description(version))
}

fn extensions() -> Extensions {
    Extensions { fmus: Some(loader()), ..Extensions::default() }
}

fn experiment(record: &str) -> String {
    format!(
        "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 0.5\nstep = {STEP}\nrecord = [{record}]\n"
    )
}

/// A scene whose diagram has the plant as a block.
fn with_block(fmu: &[u8], block: &str) -> (SceneFolder, Result<Loaded, String>) {
    let diagram = format!(
        "wires = [\"source -> plant.drive_u\", \"plant.y -> /slide\"]\n\
         block = [{{ name = \"source\", type = \"sine\", sample_time = {STEP}, amplitude = 2.0, frequency_hz = 1.0 }}, {block}]\n"
    );
    let folder = SceneFolder::of(SCENE, &experiment("\"source\", \"plant.y\", \"plant.z\", \"/slide.position\""))
        .with("diagram.toml", &diagram);
    std::fs::write(folder.join("plant.fmu"), fmu).unwrap();
    let loaded = load(&folder, &[], extensions()).map_err(|found| found.to_string());
    (folder, loaded)
}

const BLOCK: &str =
    "{ name = \"plant\", type = \"fmu\", file = \"plant.fmu\", sample_time = 0.01, parameters = { gain = 3.0 } }";

#[test]
fn an_fmu_is_a_block() {
    for version in [FmiVersion::V2, FmiVersion::V3] {
        let (_folder, loaded) = with_block(&plant(version), BLOCK);
        let loaded = loaded.unwrap();
        let first = run(&loaded);
        let column = |name: &str| first.table.column(name).unwrap().values.clone();
        let (u, y, z) = (column("source"), column("plant.y"), column("plant.z"));
        let mut sum = 0.0;
        for k in 0..u.len() {
            assert_eq!((y[k], z[k]), (sum, 3.0 * u[k]), "{version:?}, row {k}");
            sum += STEP * u[k];
        }
        assert!(column("/slide.position").last().unwrap().abs() > 1e-3);
        // another run begins anew
        assert_eq!(run(&loaded).trace, first.trace);
    }
}

#[test]
fn going_back_to_the_middle_of_a_run_is_refused_by_name() {
    let (_folder, loaded) = with_block(&plant(FmiVersion::V2), BLOCK);
    let loaded = loaded.unwrap();
    let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
    lockstep.start().unwrap();
    for _ in 0..5 {
        lockstep.advance().unwrap();
    }
    let snapshot = lockstep.snapshot(lockstep.trace());
    for _ in 0..5 {
        lockstep.advance().unwrap();
    }
    lockstep.restore(&snapshot);
    let stopped = format!("{:?}", lockstep.advance().unwrap_err());
    assert!(stopped.contains("the FMU `plant`: its state after"), "{stopped}");
    assert!(stopped.contains("is not part of what was saved or copied"), "{stopped}");
    let mut copy = LockStep::new(&loaded, method_for(&loaded).0, false).fork().lockstep;
    copy.start().unwrap();
    copy.advance().unwrap();
}

#[test]
fn wrong_blocks_are_refused_where_they_stand() {
    let fmu = plant(FmiVersion::V3);
    let refused = |fmu: &[u8], block: &str| with_block(fmu, block).1.unwrap_err();
    let with = |more: &str| BLOCK.replace("parameters = { gain = 3.0 }", more);
    assert!(refused(&fmu, &with("inputs = [\"drive.v\"]")).contains("no input `drive.v`"));
    assert!(refused(&fmu, &with("parameters = { gian = 1.0 }")).contains("did you mean `gain`?"));
    assert!(refused(b"no zip", &with("")).contains("no zip archive"));
    assert!(refused(&fmu, &BLOCK.replace("plant.fmu", "other.fmu")).contains("there is no file"));
    let other = pack(&[
        ("modelDescription.xml".into(), description(FmiVersion::V2).into_bytes()),
        ("binaries/win64/plant.dll".into(), Vec::new()),
    ]);
    let message = refused(&other.unwrap(), BLOCK);
    assert!(
        message.contains("has no library for linux64; it has: win64") || cfg!(not(target_os = "linux")),
        "{message}"
    );
    let slip = pack(&[("../../evil".into(), Vec::new())]).unwrap();
    assert!(refused(&slip, BLOCK).contains("outside the folder"));
    // a program without the adapter
    let folder = with_block(&fmu, BLOCK).0;
    assert!(load(&folder, &[], Extensions::default()).unwrap_err().to_string().contains("cannot load FMUs"));
}

#[test]
fn a_library_that_is_none_stops_the_run_with_a_reason() {
    let platform = Platform::here().unwrap();
    let fmu = pack(&[
        ("modelDescription.xml".into(), description(FmiVersion::V2).into_bytes()),
        (format!("binaries/{}/plant.{}", platform.folder(FmiVersion::V2), platform.ending()), b"nonsense".to_vec()),
    ]);
    let (_folder, loaded) = with_block(&fmu.unwrap(), BLOCK);
    let status = format!("{:?}", run(&loaded.unwrap()).status);
    assert!(status.contains("the library of the FMU cannot be loaded"), "{status}");
}

#[test]
fn an_fmu_commands_a_scene_in_lock_step() {
    let fmu = ForeignFmu::read(&plant(FmiVersion::V3)).unwrap();
    let experiment = format!("title = \"t\"\nduration = 1.0\nstep = {STEP}\nrecord = [\"/slide.position\"]\n");
    let folder = SceneFolder::of(&SCENE.replace("motor =", "initial = { position = 1.0 }, motor ="), &experiment);
    let loaded = load(&folder, &[], Extensions::default()).unwrap();
    let mut slave = Slave::new(&fmu, "spring").unwrap();
    slave.start(0.0, &[(NumberKind::Float64, 3, -4.0)]).unwrap();
    assert!(slave.save().unwrap_err().contains("`plant` cannot save its state"));
    let measured = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &[]).unwrap();
    let wiring = Wiring { measured, inputs: vec![0], outputs: vec![(2, 0)], every: 1, step: STEP };
    let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
    lockstep.attach(Box::new(FmuController::new("spring", slave, wiring)));
    lockstep.start().unwrap();
    // a spring of 4 N/m on 1 kg that is held over each step: x[k+1] = x + h v − 2 h² x, v[k+1] = v − 4 h x
    let (mut x, mut v) = (1.0_f64, 0.0_f64);
    for _ in 0..100 {
        lockstep.advance().unwrap();
        (x, v) = (x + STEP * v - 2.0 * STEP * STEP * x, v - 4.0 * STEP * x);
        assert!((lockstep.state().q[0] - x).abs() < 1e-9);
    }
}
