//! Clocks of FMUs in co-simulation and model exchange: input clocks tick at their instants; what has no port is refused
//! by name. The FMU is made here by a C compiler.

mod common;

use sincro_fmu::FmiVersion;
use sincro_fmu::import::loader;
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::{SceneFolder, run};

use common::{SCENE, compiled};

const DESCRIPTION: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="clocks" instantiationToken="{clocks}">
    <ModelExchange modelIdentifier="clocks"/>
    <CoSimulation modelIdentifier="clocks" hasEventMode="true" canHandleVariableCommunicationStepSize="true"/>
    <ModelVariables>
      <Float64 name="u" valueReference="0" causality="input" start="0"/>
      <Float64 name="s" valueReference="1" causality="output" variability="discrete" clocks="100"/>
      <Float64 name="x" valueReference="2" causality="output"/>
      <Float64 name="der(x)" valueReference="3" derivative="2"/>
      <Int32 name="samples" valueReference="4" causality="output" clocks="100"/>
      <Int32 name="laters" valueReference="5" causality="output" clocks="101"/>
      <Int32 name="fulls" valueReference="6" causality="output"/>
      <Clock name="sample" valueReference="100" causality="input" intervalVariability="constant" intervalDecimal="0.03" shiftDecimal="0.015"/>
      <Clock name="later" valueReference="101" causality="input" intervalVariability="countdown"/>
      <Clock name="full" valueReference="102" causality="output" intervalVariability="triggered" clocks="100 101"/>
      MORE
    </ModelVariables>
    <ModelStructure>
      <Output valueReference="1" dependencies=""/><Output valueReference="2" dependencies=""/>
      <Output valueReference="4" dependencies=""/><Output valueReference="5" dependencies=""/>
      <Output valueReference="6" dependencies=""/>
      <ContinuousStateDerivative valueReference="3"/>
    </ModelStructure>
  </fmiModelDescription>"#;

const OUTPUTS: &str = "outputs = [\"s\", \"x\", \"samples\", \"laters\", \"fulls\"]";

/// A scene in which a sine is the input of the FMU.
fn scene(block: &str, more: &str) -> (SceneFolder, Result<Loaded, String>) {
    let diagram = format!(
        "wires = [\"source -> fmu.u\"]\n\
         block = [{{ name = \"source\", type = \"sine\", sample_time = 0.1, amplitude = 2.0, frequency_hz = 0.7, phase = 0.3 }},\n\
         {{ name = \"fmu\", type = \"fmu\", file = \"clocks.fmu\", {block} }}]\n"
    );
    let experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 2.0\nstep = 0.1\n\
        integrator = \"rk4\"\nerror_bar = \"none\"\n\
        record = [\"source\", \"fmu.s\", \"fmu.x\", \"fmu.samples\", \"fmu.laters\", \"fmu.fulls\"]\n";
    let folder = SceneFolder::of(SCENE, experiment).with("diagram.toml", &diagram);
    let fmu = compiled("clocks", FmiVersion::V3, &DESCRIPTION.replace("MORE", more));
    std::fs::write(folder.join("clocks.fmu"), fmu).unwrap();
    let loaded = load(&folder, &[], Extensions { fmus: Some(loader()), ..Extensions::default() });
    (folder, loaded.map_err(|found| found.to_string()))
}

/// State of the FMU after all ticks until `t`, of the inputs that are held from each multiple of 0.1 s on: s, x,
/// numbers of ticks of the three clocks.
fn expected(t: f64, inputs: &[f64]) -> [f64; 5] {
    let [mut s, mut x, mut samples, mut laters, mut fulls] = [0.0; 5];
    let mut ticks: Vec<(f64, bool)> = (0..100)
        .flat_map(|k| {
            let at = 0.015 + 0.03 * f64::from(k);
            let later = (k % 2 == 1).then_some((at + 0.004, false));
            [Some((at, true)), later].into_iter().flatten()
        })
        .collect();
    ticks.retain(|tick| tick.0 < t);
    ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = 0.0;
    for (at, is_sample) in ticks {
        x += s * (at - last);
        last = at;
        if is_sample {
            s = inputs[(at / 0.1) as usize];
            samples += 1.0;
        } else {
            laters += 1.0;
        }
        if (samples + laters) % 3.0 == 0.0 {
            fulls += 1.0;
        }
    }
    [s, x + s * (t - last), samples, laters, fulls]
}

#[test]
fn input_clocks_tick_at_their_instants_within_a_step() {
    for interface in ["interface = \"co-simulation\", sample_time = 0.1", "interface = \"model-exchange\""] {
        let (_folder, loaded) = scene(&format!("{interface}, {OUTPUTS}"), "");
        let result = run(&loaded.unwrap_or_else(|why| panic!("{interface}: {why}")));
        let column = |name: &str| {
            result.table.column(name).unwrap_or_else(|| panic!("{interface}: {:?}", result.status)).values.clone()
        };
        let inputs = column("source");
        let rows = ["fmu.s", "fmu.x", "fmu.samples", "fmu.laters", "fmu.fulls"].map(column);
        assert_eq!(rows[0].len(), 21, "{interface}: {:?}", result.status);
        for k in 0..rows[0].len() {
            let wanted = expected(0.1 * k as f64, &inputs);
            for (row, wanted) in rows.iter().zip(wanted) {
                assert!((row[k] - wanted).abs() < 1e-12, "{interface}, row {k}: {} {wanted}", row[k]);
            }
        }
        assert!(rows[3].last().is_some_and(|laters| *laters > 30.0));
    }
}

#[test]
fn clocks_without_ports_are_refused_by_name() {
    let refused = |block: &str, more: &str| scene(block, more).1.unwrap_err();
    let output = refused("sample_time = 0.1, outputs = [\"full\"]", "");
    assert!(output.contains("`full`"), "{output}");
    let timed = refused("sample_time = 0.1, inputs = [\"u\", \"sample\"]", "");
    assert!(timed.contains("`sample`"), "{timed}");
    let triggered =
        "<Clock name=\"push\" valueReference=\"103\" causality=\"input\" intervalVariability=\"triggered\"/>";
    for interface in ["interface = \"co-simulation\", sample_time = 0.1", "interface = \"model-exchange\""] {
        let pushed = refused(&format!("{interface}, inputs = [\"u\", \"push\"]"), triggered);
        assert!(pushed.contains("`push` of the FMU is a clock"), "{pushed}");
        assert!(pushed.contains("scheduled execution alone"), "{pushed}");
    }
    let wrong = "<Clock name=\"odd\" valueReference=\"104\" causality=\"input\" intervalVariability=\"sometimes\"/>";
    let odd = refused("sample_time = 0.1", wrong);
    assert!(odd.contains("`odd`") && odd.contains("sometimes"), "{odd}");
}
