//! FMUs in model exchange as blocks: states, events, arrays, units, saved states. Made here by a C compiler.

mod common;

use sincro_fmu::FmiVersion;
use sincro_fmu::import::loader;
use sincro_sim::run::{LockStep, method_for};
use sincro_sim::snapshot::Snapshot;
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::{SceneFolder, run};

use common::{SCENE, compiled};

/// The ball of `ball.c`, with a base unit of its height.
fn description(version: FmiVersion) -> String {
    match version {
        FmiVersion::V2 => r#"<fmiModelDescription fmiVersion="2.0" modelName="ball" guid="{ball}" numberOfEventIndicators="1">
            <ModelExchange modelIdentifier="ball" canGetAndSetFMUstate="true" canSerializeFMUstate="true" providesDirectionalDerivative="true"/>
            <UnitDefinitions><Unit name="cm"><BaseUnit m="1" factor="0.01"/></Unit></UnitDefinitions>
            <ModelVariables>
              <ScalarVariable name="h" valueReference="0" causality="output"><Real unit="cm"/></ScalarVariable>
              <ScalarVariable name="v" valueReference="1"><Real/></ScalarVariable>
              <ScalarVariable name="der(h)" valueReference="2"><Real derivative="1"/></ScalarVariable>
              <ScalarVariable name="der(v)" valueReference="3"><Real derivative="2"/></ScalarVariable>
              <ScalarVariable name="f" valueReference="4" causality="input"><Real start="0"/></ScalarVariable>
              <ScalarVariable name="kick" valueReference="5" causality="input" variability="discrete"><Real start="0"/></ScalarVariable>
              <ScalarVariable name="e" valueReference="6" causality="parameter"><Real start="0.5"/></ScalarVariable>
              <ScalarVariable name="bounces" valueReference="8" causality="output"><Integer/></ScalarVariable>
              <ScalarVariable name="ticks" valueReference="9" causality="output"><Integer/></ScalarVariable>
              <ScalarVariable name="completed" valueReference="10" causality="output"><Integer/></ScalarVariable>
            </ModelVariables>
            <ModelStructure>
              <Outputs><Unknown index="1" dependencies=""/><Unknown index="8" dependencies=""/></Outputs>
              <Derivatives><Unknown index="3"/><Unknown index="4"/></Derivatives>
            </ModelStructure>
          </fmiModelDescription>"#
            .into(),
        FmiVersion::V3 => r#"<fmiModelDescription fmiVersion="3.0" modelName="ball" instantiationToken="{ball}">
            <ModelExchange modelIdentifier="ball" canGetAndSetFMUState="true" canSerializeFMUState="true" needsCompletedIntegratorStep="true"/>
            <UnitDefinitions>
              <Unit name="cm"><BaseUnit m="1" factor="0.01"/></Unit>
              <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
            </UnitDefinitions>
            <TypeDefinitions><Float64Type name="Height" unit="cm"/></TypeDefinitions>
            <ModelVariables>
              <Float64 name="h" valueReference="0" causality="output" declaredType="Height"/>
              <Float64 name="v" valueReference="1"/>
              <Float64 name="der(h)" valueReference="2" derivative="0"/>
              <Float64 name="der(v)" valueReference="3" derivative="1"/>
              <Float64 name="f" valueReference="4" causality="input" start="0"/>
              <Float64 name="kick" valueReference="5" causality="input" variability="discrete" start="0"/>
              <Float64 name="e" valueReference="6" causality="parameter" start="0.5"/>
              <Int32 name="bounces" valueReference="8" causality="output"/>
              <Int32 name="ticks" valueReference="9" causality="output"/>
              <Int32 name="completed" valueReference="10" causality="output"/>
              <UInt64 name="n" valueReference="11" causality="structuralParameter" start="2"/>
              <Float64 name="w" valueReference="12" causality="parameter" start="1 1"><Dimension valueReference="11"/></Float64>
              <Float64 name="scaled" valueReference="13" causality="output"><Dimension valueReference="11"/></Float64>
              <Float64 name="temperature" valueReference="14" causality="input" start="20" unit="degC"/>
              <Float64 name="seen" valueReference="14" causality="output" unit="degC"/>
            </ModelVariables>
            <ModelStructure>
              <Output valueReference="0" dependencies=""/><Output valueReference="8" dependencies=""/>
              <ContinuousStateDerivative valueReference="2"/><ContinuousStateDerivative valueReference="3"/>
              <EventIndicator valueReference="0"/>
            </ModelStructure>
          </fmiModelDescription>"#
            .into(),
    }
}

fn ball(version: FmiVersion) -> Vec<u8> {
    compiled("ball", version, &description(version))
}

/// A scene with the ball as block `ball`, whose force is 2 N from 1 s on.
fn scene(
    version: FmiVersion,
    integrator: &str,
    block: &str,
    wires: &str,
    record: &str,
) -> (SceneFolder, Result<Loaded, String>) {
    let diagram = format!(
        "wires = [\"force -> ball.f\", {wires}]\n\
         block = [{{ name = \"force\", type = \"step\", time = 1.0, to = 2.0 }},\n\
         {{ name = \"kicks\", type = \"step\", sample_time = 0.1, time = 0.2, to = 0.75 }},\n\
         {{ name = \"warmth\", type = \"constant\", value = 300.0, unit = \"K\" }},\n\
         {{ name = \"ball\", type = \"fmu\", file = \"ball.fmu\", {block} }}]\n"
    );
    let experiment = format!(
        "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.2\nstep = 0.05\n\
         integrator = \"{integrator}\"\nerror_bar = \"none\"\nrecord = [{record}]\n"
    );
    let folder = SceneFolder::of(SCENE, &experiment).with("diagram.toml", &diagram);
    std::fs::write(folder.join("ball.fmu"), ball(version)).unwrap();
    let loaded = load(&folder, &[], Extensions { fmus: Some(loader()), ..Extensions::default() });
    (folder, loaded.map_err(|found| found.to_string()))
}

const PLAIN: &str = "inputs = [\"f\"], outputs = [\"h\", \"bounces\", \"ticks\", \"completed\"]";
/// The cart is driven by what changes at time events.
const DRIVEN: &str = "\"ball.ticks -> /slide\"";
const RECORD: &str = "\"ball.h\", \"ball.bounces\", \"ball.ticks\", \"ball.completed\", \"/slide.velocity\"";

fn column(loaded: &Loaded, name: &str) -> Vec<f64> {
    let result = run(loaded);
    result.table.column(name).unwrap_or_else(|| panic!("{name}: {:?}", result.status)).values.clone()
}

/// Height of the ball in closed form: it falls from 1 m, keeps half of its speed, and is lighter from 1 s on.
fn height(t: f64) -> f64 {
    let (mut start, mut h, mut v, mut g) = (0.0_f64, 1.0_f64, 0.0_f64, 9.81_f64);
    loop {
        let landing = start + (v + (v * v + 2.0 * g * h).sqrt()) / g;
        let next = if start < 1.0 { landing.min(1.0) } else { landing };
        let elapsed = t.min(next) - start;
        let (fallen, speed) = (h + v * elapsed - g * elapsed * elapsed / 2.0, v - g * elapsed);
        if t <= next {
            return fallen;
        }
        (start, h, v) = if next == landing { (next, 0.0, -0.5 * speed) } else { (next, fallen, speed) };
        g = if start >= 1.0 { 7.81 } else { g };
    }
}

#[test]
fn state_events_are_located_and_states_are_integrated_with_the_run() {
    for version in [FmiVersion::V2, FmiVersion::V3] {
        for integrator in ["rk4", "dormand-prince", "dormand-prince-8", "implicit", "stiff"] {
            let (_folder, loaded) = scene(version, integrator, PLAIN, DRIVEN, RECORD);
            let loaded = loaded.unwrap();
            let heights = column(&loaded, "ball.h");
            assert_eq!(heights.len(), 25, "{integrator}");
            for (k, h) in heights.iter().enumerate() {
                let expected = height(k as f64 * 0.05);
                // parabolas are exact for all; what is left is where the events are located
                assert!((h - expected).abs() < 1e-9, "{version:?} {integrator}, row {k}: {h} {expected}");
            }
            assert_eq!(column(&loaded, "ball.bounces").last(), Some(&3.0));
            // every accepted step is announced
            assert!(*column(&loaded, "ball.completed").last().unwrap() >= 24.0);
        }
    }
}

#[test]
fn steps_at_velocity_level_handle_events_at_their_ends() {
    let (_folder, loaded) = scene(FmiVersion::V3, "semi-implicit-euler", PLAIN, DRIVEN, RECORD);
    let loaded = loaded.unwrap();
    let bounces = column(&loaded, "ball.bounces");
    // Euler's first landing: h = 1 - 9.81 h² k (k - 1)/2 passes 0 in step 10
    assert_eq!(bounces.iter().position(|n| *n == 1.0), Some(10));
    assert_eq!(column(&loaded, "ball.ticks").last(), Some(&4.0));
}

#[test]
fn bounces_that_accumulate_are_passed() {
    // without a least speed there are infinitely many of them before 1.5 s
    let (folder, loaded) = scene(FmiVersion::V3, "rk4", PLAIN, DRIVEN, RECORD);
    drop(loaded);
    let experiment = std::fs::read_to_string(folder.join("experiment.toml")).unwrap();
    std::fs::write(folder.join("experiment.toml"), experiment.replace("duration = 1.2", "duration = 2.0")).unwrap();
    let loaded = load(&folder, &[], Extensions { fmus: Some(loader()), ..Extensions::default() }).unwrap();
    let heights = column(&loaded, "ball.h");
    assert!(heights.len() == 41 && heights[32..].iter().all(|h| (0.0..1e-4).contains(h)), "{heights:?}");
}

#[test]
fn time_events_happen_at_their_instants() {
    let (_folder, loaded) = scene(FmiVersion::V2, "dormand-prince", PLAIN, DRIVEN, RECORD);
    let ticks = column(&loaded.unwrap(), "ball.ticks");
    for (row, ticks) in ticks.iter().enumerate() {
        assert_eq!(*ticks, (row / 6) as f64, "row {row}");
    }
}

#[test]
fn discrete_inputs_are_set_in_events_alone() {
    let block = PLAIN.replace("[\"f\"]", "[\"f\", \"kick\"]");
    let (_folder, loaded) =
        scene(FmiVersion::V3, "rk4", &block, "\"kicks -> ball.kick\", \"ball.ticks -> /slide\"", RECORD);
    let h = column(&loaded.unwrap(), "ball.h");
    let free = |t: f64| 1.0 - 9.81 * t * t / 2.0;
    assert!((h[4] - free(0.2)).abs() < 1e-12);
    assert!((h[6] - free(0.3) - 0.75 * 0.1).abs() < 1e-12);
}

#[test]
fn arrays_are_vector_ports_and_units_are_converted() {
    let block = "inputs = [\"f\", \"temperature\"], outputs = [\"h\", \"scaled\", \"seen\"], \
                 parameters = { n = 3, w = [2, 3, 4], e = 0.9 }, units = { seen = \"K\" }";
    let record = "\"ball.h\", \"kicks\", \"ball.scaled[0]\", \"ball.scaled[2]\", \"ball.seen\"";
    let wires = "\"warmth -> ball.temperature\"";
    let (_folder, loaded) = scene(FmiVersion::V3, "rk4", block, wires, record);
    let loaded = loaded.unwrap();
    assert_eq!(column(&loaded, "ball.h")[0], 1.0);
    assert_eq!((column(&loaded, "ball.scaled[0]")[0], column(&loaded, "ball.scaled[2]")[1]), (2.0, 12.0));
    // 300 K are 26.85 °C for the FMU, and come back
    assert!((column(&loaded, "ball.seen")[3] - 300.0).abs() < 1e-12);
    let refused = |block: &str| scene(FmiVersion::V3, "rk4", block, wires, record).1.unwrap_err();
    let message = refused(&block.replace("seen = \"K\"", "seen = \"kg\""));
    assert!(message.contains("`seen` of the FMU is in degC, which cannot be converted to kg"), "{message}");
    let message = refused(&block.replace("seen = \"K\"", "seem = \"K\""));
    assert!(message.contains("no port or parameter of the block is `seem`"), "{message}");
    let message = refused(&block.replace("[2, 3, 4]", "[2, 3]"));
    assert!(message.contains("`w` of the FMU has 3 numbers, 2 are given"), "{message}");
    let message = refused(&block.replace("units", "interface = \"co-simulation\", units"));
    assert!(message.contains("does not have this interface") && message.contains("model-exchange"), "{message}");
}

#[test]
fn saved_states_continue_with_the_same_bits() {
    for version in [FmiVersion::V2, FmiVersion::V3] {
        let (_folder, loaded) = scene(version, "dormand-prince", PLAIN, DRIVEN, RECORD);
        let loaded = loaded.unwrap();
        let start = || {
            let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
            lockstep.start().unwrap();
            lockstep
        };
        let mut lockstep = start();
        let advance = |lockstep: &mut LockStep| (0..10).for_each(|_| lockstep.advance().unwrap());
        advance(&mut lockstep);
        let snapshot = lockstep.snapshot(lockstep.trace());
        let bytes = snapshot.to_bytes(&loaded);
        let mut copy = lockstep.fork().lockstep;
        advance(&mut lockstep);
        let reached = lockstep.state().clone();
        assert_eq!(lockstep.control().unwrap().signals().len(), copy.control().unwrap().signals().len());
        // back in the same run, on in a copy, in a run that has not begun, and in one that is elsewhere
        lockstep.restore(&snapshot);
        let mut fresh = start();
        fresh.restore(&Snapshot::from_bytes(&bytes, &loaded).unwrap());
        for run in [&mut lockstep, &mut copy, &mut fresh] {
            advance(run);
            assert_eq!(*run.state(), reached, "{version:?}");
        }
    }
}
