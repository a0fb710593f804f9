//! Model descriptions that were damaged at random: an FMU that can be read, or a refusal; no panic, no endless reading.
//!
//! `SINCRO_FUZZ=1000000 cargo test --release -p sincro-fmu --test hostile` draws as many; by default a few thousand.

use sincro_fmu::FmiVersion;
use sincro_fmu::archive::pack;
use sincro_fmu::import::loader;
use sincro_fmu::platform::Platform;
use sincro_math::random::SplitMix64;

const V2: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="ball" guid="{ball}" numberOfEventIndicators="1">
  <ModelExchange modelIdentifier="ball" canGetAndSetFMUstate="true" providesDirectionalDerivative="true"/>
  <CoSimulation modelIdentifier="ball" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions><Unit name="cm"><BaseUnit m="1" factor="0.01"/></Unit></UnitDefinitions>
  <TypeDefinitions><SimpleType name="Height"><Real unit="cm"/></SimpleType></TypeDefinitions>
  <ModelVariables>
    <ScalarVariable name="h" valueReference="0" causality="output"><Real declaredType="Height"/></ScalarVariable>
    <ScalarVariable name="v" valueReference="1"><Real start="2"/></ScalarVariable>
    <ScalarVariable name="der(h)" valueReference="2"><Real derivative="1"/></ScalarVariable>
    <ScalarVariable name="der(v)" valueReference="3"><Real derivative="2"/></ScalarVariable>
    <ScalarVariable name="f" valueReference="4" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="on" valueReference="5" causality="parameter"><Boolean start="true"/></ScalarVariable>
    <ScalarVariable name="n" valueReference="6" causality="output" variability="discrete"><Integer/></ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs><Unknown index="1" dependencies="2 5" dependenciesKind="dependent fixed"/><Unknown index="7"/></Outputs>
    <Derivatives><Unknown index="3"/><Unknown index="4"/></Derivatives>
  </ModelStructure>
</fmiModelDescription>"#;

const V3: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="ball" instantiationToken="{ball}">
  <ModelExchange modelIdentifier="ball" needsCompletedIntegratorStep="true"/>
  <CoSimulation modelIdentifier="ball" hasEventMode="true"/>
  <ScheduledExecution modelIdentifier="ball"/>
  <UnitDefinitions><Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit></UnitDefinitions>
  <TypeDefinitions><Float64Type name="Warmth" unit="degC"/><EnumerationType name="E"><Item name="a" value="1"/></EnumerationType></TypeDefinitions>
  <ModelVariables>
    <Float64 name="x" valueReference="0" causality="output" declaredType="Warmth"/>
    <Float64 name="der(x)" valueReference="1" derivative="0"/>
    <UInt64 name="n" valueReference="2" causality="structuralParameter" start="2"/>
    <Float64 name="A" valueReference="3" causality="parameter" start="1 0 0 1"><Dimension valueReference="2"/><Dimension start="2"/></Float64>
    <Float32 name="u" valueReference="4" causality="input" start="0 0"><Dimension valueReference="2"/></Float32>
    <Enumeration name="e" declaredType="E" valueReference="5" causality="output"/>
    <Clock name="c" valueReference="6" causality="input" intervalVariability="constant" intervalDecimal="0.5" shiftDecimal="0.1"/>
    <Clock name="d" valueReference="7" causality="input" intervalVariability="fixed" resolution="1000" intervalCounter="10"/>
    <Clock name="t" valueReference="8" causality="input" intervalVariability="triggered" priority="3"/>
    <Clock name="o" valueReference="9" causality="output" intervalVariability="triggered" clocks="6"/>
    <String name="s" valueReference="10"><Start value="text"/></String>
    <Binary name="b" valueReference="11" causality="input"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="0" dependencies="4" dependenciesKind="constant"/>
    <ContinuousStateDerivative valueReference="1"/><EventIndicator valueReference="0"/>
  </ModelStructure>
</fmiModelDescription>"#;

/// Values that number parsers, tables by index and allocations stumble over.
const ODD: [&str; 16] = [
    "",
    "-1",
    "0",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999999",
    "NaN",
    "inf",
    "1e308",
    "-1e-320",
    "1 2 3 4 5",
    "true",
    "&#0;",
    "&amp;",
    "\u{1F980}",
];

fn damaged(text: &str, random: &mut SplitMix64) -> Vec<u8> {
    let mut draw = |n: usize| (random.unit() * n as f64) as usize;
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..1 + draw(3) {
        let (at, len) = (draw(bytes.len()), 1 + draw(60));
        let end = (at + len).min(bytes.len());
        match draw(7) {
            0 => bytes[at] ^= 1 << draw(8),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copied = bytes[at..end].to_vec();
                let to = draw(bytes.len());
                bytes.splice(to..to, copied);
            }
            // the value of an attribute
            3 | 4 => {
                let quotes: Vec<usize> = (0..bytes.len()).filter(|k| bytes[*k] == b'"').collect();
                let k = 2 * draw((quotes.len() / 2).max(1));
                if let [Some(from), Some(to)] = [quotes.get(k), quotes.get(k + 1)] {
                    bytes.splice(from + 1..*to, ODD[draw(ODD.len())].bytes());
                }
            }
            // a line elsewhere, or twice
            5 => {
                let lines: Vec<&[u8]> = bytes.split(|byte| *byte == b'\n').collect();
                let (from, to) = (draw(lines.len()), draw(lines.len()));
                let mut moved: Vec<&[u8]> = lines.clone();
                moved.insert(to, lines[from]);
                bytes = moved.join(&b'\n');
            }
            _ => bytes.truncate(at.max(1)),
        }
        if bytes.is_empty() {
            bytes.push(b'<');
        }
    }
    bytes
}

#[test]
fn damaged_descriptions_are_read_or_refused() {
    let asked = std::env::var("SINCRO_FUZZ").ok().and_then(|text| text.parse::<usize>().ok());
    let n = asked.unwrap_or(4_000);
    let platform = Platform::here().unwrap();
    let mut random = SplitMix64::new(2026);
    let mut counts = [0_usize; 2];
    for k in 0..n {
        let (text, version) = if k % 2 == 0 { (V2, FmiVersion::V2) } else { (V3, FmiVersion::V3) };
        let library = format!("binaries/{}/ball.{}", platform.folder(version), platform.ending());
        let files = [("modelDescription.xml".to_owned(), damaged(text, &mut random)), (library, b"none".to_vec())];
        let read = loader().read(&pack(&files).unwrap());
        if let Ok(model) = &read {
            // what diagrams ask for
            assert!(!model.interfaces().is_empty());
            let n = model.variables().len();
            assert!(model.exchange().states.iter().chain(&model.exchange().crossings).all(|place| *place < n));
        }
        counts[usize::from(read.is_ok())] += 1;
    }
    println!("{} refused, {} read", counts[0], counts[1]);
    assert!(counts.iter().all(|count| *count > n / 20), "{counts:?}: damage is of both kinds");
}
