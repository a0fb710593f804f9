//! Claims about what is shown of a linear system.

use sincro_analysis::linear::{Axis, DMatrix, StateSpace};
use sincro_testing::systems::{sampled, servo};

use super::text::text;
use super::*;
use crate::plot::{Size, svg};

#[test]
fn a_sampled_system_is_mapped_on_the_unit_circle() {
    let system = sampled();
    let analysis = Analysis::of("Sampled", &system);
    assert!(text(&analysis).contains("sampled every 0.05 s") && text(&analysis).contains("next x"));
    let figure = figures::map(&analysis, Some(&analysis.channels[0]));
    assert!(svg(&figure, Size::wide(&figure)).contains("unit circle"));
    // up to half the sampling frequency, where the lag has turned by −180° and two ticks by −360°
    let bode = &analysis.channels[0].bode;
    assert!((bode.omega.last().unwrap() - std::f64::consts::PI / 0.05).abs() < 1e-9);
    assert!((bode.phase_deg.last().unwrap() + 540.0).abs() < 1.0, "{:?}", bode.phase_deg.last());
}

#[test]
fn the_text_names_what_matters() {
    let system = servo();
    let text = text(&Analysis::of("Servo", &system));
    assert!(text.contains("linearised at t = 0.5 s, continuous: 3 states, 1 input, 2 outputs"), "{text}");
    assert!(text.contains("u1 is /motor.voltage [V]"), "{text}");
    assert!(text.contains("x3 /motor.current [A]"), "{text}");
    assert!(text.contains("9.54 dB at 2.24 rad/s") && text.contains("25.4° at 1.23 rad/s"), "{text}");
    assert!(text.contains("2 rad/(s·V)"), "{text}");
    assert!(text.contains("controllable: yes, all 3 dimensions"), "{text}");
    assert!(text.lines().all(|line| !line.ends_with(' ') && line.chars().count() < 130), "{text}");
}

#[test]
fn an_open_loop_is_shown_with_its_margins() {
    let system = sampled();
    let open = OpenLoop {
        signal: Axis::new("pid", "N"),
        sample_time: 0.05,
        margins: system.loop_margins(),
        system: system.clone(),
    };
    let analysis = Analysis::of("Sampled", &system).with_loops(std::slice::from_ref(&open));
    let (text, page) = (text(&analysis), html(&analysis));
    assert!(text.contains("open loops, closed by −1") && text.contains("pid [N]"), "{text}");
    assert!(!text.contains("several samples in a period"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() < 130), "{text}");
    assert!(page.contains("Open loops") && page.contains("Bode diagram of the loop opened at pid"));
    assert!(figures(&analysis).iter().any(|(name, _)| name == "loop-01-bode"));
}

#[test]
fn wide_matrices_are_continued_below() {
    let system = StateSpace::from_matrices(
        DMatrix::identity(11, 11),
        DMatrix::zeros(11, 1),
        DMatrix::zeros(1, 11),
        DMatrix::identity(1, 1),
    );
    let system = system.unwrap();
    let text = text(&Analysis::of("Wide", &system));
    assert_eq!(text.lines().filter(|line| line.trim_start().starts_with("d/dt x ")).count(), 3, "{text}");
}

#[test]
fn many_channels_are_listed_not_drawn() {
    let system = StateSpace::from_matrices(
        -DMatrix::identity(3, 3),
        DMatrix::from_element(3, 3, 1.0),
        DMatrix::from_element(3, 3, 1.0),
        DMatrix::zeros(3, 3),
    );
    let system = system.unwrap();
    let analysis = Analysis::of("Many", &system);
    assert_eq!((analysis.channels.len(), analysis.shown().len(), analysis.unshown().len()), (9, 6, 3));
    assert_eq!(super::figures(&analysis).len(), 18);
    assert!(page::html(&analysis).contains("the other 3 are in <code>bode.csv</code>"));
    // the contents lead to every channel that is drawn, and to all else
    let html = page::html(&analysis);
    assert_eq!(html.matches("<a href=\"#").count(), html.matches("<h2>").count());
}

#[test]
fn a_bode_diagram_has_decades_quarter_turns_and_margins() {
    let system = servo();
    let analysis = Analysis::of("Servo", &system);
    let figure = figures::bode(&analysis, &analysis.channels[0]);
    let picture = svg(&figure, Size::wide(&figure));
    for label in [">0.1<", ">100<", ">−180<", ">−270<", "gain margin 9.54 dB at 2.24 rad/s", "phase margin 25.4°"]
    {
        assert!(picture.contains(label), "{label}");
    }
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
}

#[test]
fn a_system_without_inputs_has_its_poles() {
    let (none, a) = (DMatrix::zeros(2, 0), DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, 0.0]));
    let system = StateSpace::from_matrices(a, none.clone(), none.transpose(), DMatrix::zeros(0, 0)).unwrap();
    let analysis = Analysis::of("Free", &system);
    assert!(text(&analysis).contains("± 2j") && page::html(&analysis).contains("<svg"));
}
