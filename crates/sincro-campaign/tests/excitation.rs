//! Inputs that tell most, on scenes where the answer is known.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_campaign::fit::excitation::planned;
use sincro_campaign::fit::{Excitation, SignalChoice, parse_all};
use sincro_sim::{Extensions, Loaded, load};

static GO: AtomicBool = AtomicBool::new(false);

fn bench() -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/identification/motor");
    load(&path, &[], Extensions::default()).unwrap()
}

fn excitation<'a>(loaded: &'a Loaded, free: &str, input: &str) -> Excitation<'a> {
    Excitation {
        loaded,
        set: Vec::new(),
        free: parse_all(&[free.to_owned()], loaded).unwrap(),
        input: parse_all(&[input.to_owned()], loaded).unwrap(),
        data: vec![planned(loaded, &choices(), 0.05).unwrap()],
        confidence: 0.95,
        budget: 60,
        seed: 1,
    }
}

#[test]
fn the_greatest_amplitude_tells_most_and_intervals_are_inverse_to_it() {
    let loaded = bench();
    let input = "/shaft.motor.command.sine.amplitude=1..12";
    let found = excitation(&loaded, "/shaft.motor.resistance,/shaft.damping", input).search(&GO, &mut |_, _| {});
    let found = found.unwrap().unwrap();
    assert!((found.after.input[0] - 12.0).abs() < 1e-3, "{found:?}");
    // the motor is linear: twice the voltage of the scene, half the intervals
    for (before, after) in found.before.half_widths.iter().zip(&found.after.half_widths) {
        assert!((before / after - 2.0).abs() < 1e-3, "{before} {after}");
    }
}

#[test]
fn a_faster_swing_tells_the_inductance() {
    let loaded = bench();
    let free = "/shaft.motor.inductance,/shaft/flywheel.inertia.zz";
    let search = || {
        let input = "/shaft.motor.command.sine.angular_frequency=0.5..30";
        excitation(&loaded, free, input).search(&GO, &mut |_, _| {}).unwrap().unwrap()
    };
    let found = search();
    println!(
        "{} rad/s, intervals {:?} to {:?}",
        found.after.input[0], found.before.half_widths, found.after.half_widths
    );
    assert!(found.after.input[0] > 4.0 && found.after.half_widths[0] < 0.5 * found.before.half_widths[0]);
    let again = search();
    assert_eq!((found.after, found.history), (again.after, again.history), "the same seed, the same bits");
}

#[test]
fn an_input_that_tells_nothing_has_no_intervals() {
    let loaded = bench();
    let mut excitation = excitation(
        &loaded,
        "/shaft.motor.resistance,/shaft.damping",
        "/shaft.motor.command.sine.amplitude=0 in 0..1e-300",
    );
    excitation.budget = 1;
    let found = excitation.search(&GO, &mut |_, _| {}).unwrap().unwrap();
    assert!(found.before.log_det.is_infinite() && found.before.half_widths.iter().all(|x| x.is_infinite()));
    assert!(excitation.text(&found).contains("not identifiable"));
}

#[test]
fn predicted_intervals_are_those_of_a_fit() {
    use sincro_campaign::fit::{DataSet, Fit, FitOptions, Model};
    let loaded = bench();
    let free = "/shaft.motor.resistance=1.2,/shaft.motor.inductance=0.06,/shaft.motor.torque_constant=0.3,\
                /shaft.damping=0.01,/shaft/flywheel.inertia.zz=0.02";
    let predicted = {
        let mut excitation = excitation(&loaded, free, "/shaft.motor.command.sine.amplitude=1..12");
        excitation.budget = 1;
        excitation.data = vec![planned(&loaded, &choices(), 0.02).unwrap()];
        excitation.search(&GO, &mut |_, _| {}).unwrap().unwrap().before.half_widths
    };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/identification/data/motor.csv");
    let choices =
        ["/shaft.velocity=speed@0.05", "/shaft.current=current@0.02"].map(|c| SignalChoice::parse(c).unwrap());
    let sets = [DataSet::read(&file, &choices, &[]).unwrap()];
    let model = Model::new(&loaded, &[], parse_all(&[free.to_owned()], &loaded).unwrap(), &sets, false, &GO);
    let fit = Fit::new("motor".into(), model, FitOptions::default(), &[]).unwrap();
    for (predicted, found) in predicted.iter().zip(&fit.inference.estimates) {
        assert!((predicted / found.half_width - 1.0).abs() < 0.1, "{predicted} {}", found.half_width);
    }
}

fn choices() -> [SignalChoice; 2] {
    ["/shaft.velocity@0.05", "/shaft.current@0.02"].map(|text| SignalChoice::parse(text).unwrap())
}
