//! Claims about whole figures.

use sincro_math::elementary::{exp, sin_cos};

use super::*;

/// A damped oscillation with reference, error and tolerance.
fn oscillation(n: usize) -> Figure {
    let t: Vec<f64> = (0..n).map(|i| i as f64 * 0.01).collect();
    let y: Vec<f64> = t.iter().map(|t| exp(-0.3 * t).0 * sin_cos(4.0 * t).1).collect();
    let error: Vec<f64> = t.iter().map(|t| 1e-9 * sin_cos(7.0 * t).0).collect();
    let mut main = Panel::new(Axis::new("angle", "rad"));
    main.series.push(Series::new("simulated", Role::Simulated, t.clone(), y.clone()));
    main.series.push(Series::new("reference", Role::Reference, t.clone(), y.clone()));
    let shifted = |by: f64| y.iter().map(|y| y + by).collect();
    main.bands.push(Band {
        name: "error bar".into(),
        signal: 0,
        x: t.clone(),
        lower: shifted(-0.1),
        upper: shifted(0.1),
    });
    let mut error_panel = Panel::error("rad");
    error_panel.series.push(Series::new("", Role::Simulated, t, error));
    error_panel.limits.extend([1e-6, -1e-6].map(|value| Limit { name: "tolerance".into(), value }));
    Figure { title: "Angle".into(), x: Axis::time(), panels: vec![main, error_panel], space: None }
}

fn of_values(y: Vec<f64>) -> Figure {
    let x = (0..y.len()).map(|i| i as f64).collect();
    let mut panel = Panel::new(Axis::new("y", "m"));
    panel.series.push(Series::new("y", Role::Simulated, x, y));
    Figure { title: "t".into(), x: Axis::time(), panels: vec![panel], space: None }
}

fn drawn(figure: &Figure) -> String {
    svg(figure, Size::wide(figure))
}

/// Panics unless every tag is closed in order and no bare `<`, `&` or control character is in the text.
fn assert_balanced(xml: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = xml;
    while let Some(start) = rest.find('<') {
        let length = rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..start + length];
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap_or("");
        assert_eq!(tag.matches('"').count() % 2, 0, "quotes in <{tag}>");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        rest = &rest[start + length + 1..];
    }
    assert!(open.is_empty(), "{open:?} stay open");
    for (at, _) in xml.match_indices('&') {
        let entity = xml[at + 1..].split(';').next().unwrap_or("");
        assert!(["amp", "lt", "gt", "quot", "#39"].contains(&entity), "&{entity}");
    }
}

#[test]
fn a_figure_is_balanced_xml_in_every_form() {
    let figure = oscillation(500);
    assert_balanced(&drawn(&figure));
    assert_balanced(&inline_svg(&figure, Size::narrow(&figure)));
    assert_balanced(&thumbnail(&figure, Size { width: 300.0, height: 170.0 }));
    assert!(drawn(&figure).starts_with(r#"<svg xmlns="http://www.w3.org/2000/svg""#));
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    assert_eq!(drawn(&oscillation(500)), drawn(&oscillation(500)));
}

#[test]
fn markup_in_names_does_not_reach_the_picture() {
    let mut figure = of_values(vec![0.0, 1.0, f64::NAN]);
    let evil = r#"</svg><script x="&">"#;
    figure.title = evil.into();
    figure.x = Axis::new(evil, evil);
    figure.panels[0].y = Axis::new(evil, evil);
    figure.panels[0].title = evil.into();
    figure.panels[0].series[0].name = evil.into();
    figure.panels[0].limits.push(Limit { name: evil.into(), value: 0.5 });
    assert_balanced(&drawn(&figure));
    assert!(!drawn(&figure).contains("<script"));
}

#[test]
fn values_that_are_not_numbers_leave_a_gap_and_a_note() {
    let text = drawn(&of_values(vec![0.0, 1.0, f64::NAN, 2.0, f64::INFINITY, -f64::INFINITY, 3.0, 4.0]));
    assert!(text.contains("3 of 8 values of y are not finite"));
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    assert_balanced(&text);
}

#[test]
fn hardly_any_data_still_give_a_figure() {
    let nothing = Figure::default();
    let empty_panel = Figure { panels: vec![Panel::new(Axis::default())], ..Figure::default() };
    let mut uneven = of_values(vec![1.0, 2.0]);
    uneven.panels[0].series[0].x.clear();
    let cases = [
        vec![],
        vec![f64::NAN],
        vec![7.0],
        vec![0.0; 9],
        vec![1e-320, -1e-320],
        vec![1e300, -1e300],
        vec![1e279, -1e279],
    ];
    for figure in cases.into_iter().map(of_values).chain([nothing, empty_panel, uneven]) {
        let text = drawn(&figure);
        assert_balanced(&text);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}

#[test]
fn a_log_axis_leaves_out_what_is_not_positive() {
    let mut figure = of_values(vec![0.0, 1e-3, -1.0, 1e3]);
    figure.panels[0].y.log = true;
    let text = drawn(&figure);
    assert!(text.contains("2 of 4 values of y are not finite or not positive"));
    assert_balanced(&text);
}

#[test]
fn a_long_run_stays_a_small_file() {
    let text = drawn(&oscillation(400_000));
    assert!(text.len() < 200_000, "{}", text.len());
}

#[test]
fn a_distant_tolerance_is_named_not_drawn() {
    let text = drawn(&oscillation(500));
    assert!(text.contains("(tolerance ±10"));
    assert_eq!(text.matches("class=\"sp-limit\"").count(), 0);
}

#[test]
fn a_long_legend_makes_the_picture_higher() {
    let mut figure = oscillation(50);
    let series = figure.panels[0].series[0].clone();
    figure.panels[0].series = vec![series; 40];
    let height = |figure: &Figure| -> f64 {
        let text = svg(figure, Size { width: 400.0, height: 400.0 });
        let digits = text.split("height=\"").nth(1).and_then(|rest| rest.split('"').next());
        digits.and_then(|digits| digits.parse().ok()).unwrap_or(0.0)
    };
    assert!(height(&figure) > 600.0, "{}", height(&figure));
    assert_eq!(height(&oscillation(50)), 400.0);
}

#[test]
fn an_auxiliary_line_ends_at_the_frame_and_widens_nothing() {
    let mut figure = of_values(vec![0.0, 1.0, 2.0]);
    let plain = drawn(&figure);
    let points = vec![(0.0, 0.0), (1e6, 1e6)];
    figure.panels[0].guides.push(Guide { points, name: String::new(), label: "ζ".into(), weight: Weight::Faint });
    let guided = drawn(&figure);
    let ticks = |text: &str| text.matches("text-anchor=\"end\"").count();
    assert_eq!(ticks(&plain), ticks(&guided));
    // the only line of five pixels on, four off
    let line =
        guided.lines().find(|line| line.contains("5 4")).and_then(|line| line.split("d=\"").nth(1)).unwrap_or("");
    let numbers = line.split(|c: char| !c.is_ascii_digit() && c != '.').filter_map(|n| n.parse::<f64>().ok());
    assert!(numbers.fold(0.0, f64::max) < 880.0, "{line}");
    assert_balanced(&guided);
}

#[test]
fn no_coordinate_is_negative_zero() {
    let text = drawn(&oscillation(500));
    assert!(!text.contains("-0 ") && !text.contains("-0\"") && !text.contains("−0 ") && !text.contains(">−0<"));
}

#[test]
fn a_thumbnail_names_every_curve() {
    let mut figure = oscillation(200);
    let base = figure.panels[0].series[0].clone();
    figure.panels[0].series =
        (0..14).map(|k| Series { name: format!("variant-{k}:/arm/elbow.position"), ..base.clone() }).collect();
    let text = thumbnail(&figure, Size { width: 340.0, height: 186.0 });
    for k in 0..14 {
        assert!(text.contains(&format!("variant-{k}:")), "{k}");
    }
    assert_balanced(&text);
}

#[test]
fn a_spike_stands_at_the_edge_with_its_value() {
    let mut values: Vec<f64> = (0..1000).map(|k| sin_cos(0.05 * f64::from(k)).0).collect();
    values[300] = 512.5;
    let text = drawn(&of_values(values));
    assert!(text.contains("512.5 m") && text.contains("sp-spike") && text.contains("off the scale"), "{text}");
    assert_balanced(&text);
}

#[test]
fn paths_are_cut_in_the_middle() {
    let cut = text::fit_middle("variant:/robot/arm/upper/shoulder/elbow.position", 13.0, 200.0);
    assert!(cut.starts_with("variant:") && cut.ends_with("elbow.position") && cut.contains('…'), "{cut}");
    assert!(text_width(&cut, 13.0) <= 200.0);
}
