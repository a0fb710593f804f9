//! Claims about whole pages.

use super::*;
use crate::plot::{Axis, Panel, Role, Series};

fn check(name: &str, deviation: f64, verdict: CheckVerdict) -> CheckRow {
    CheckRow {
        name: name.into(),
        about: "/shoulder.position".into(),
        measured: Some(-0.29700587 + deviation),
        expected: Some(-0.29700587),
        deviation,
        sense: Sense::Equal,
        limit: 2e-9,
        is_relative: false,
        unit: "rad".into(),
        at: Some(1.0),
        verdict,
    }
}

fn figure() -> Figure {
    let x: Vec<f64> = (0..50).map(f64::from).collect();
    let mut panel = Panel::new(Axis::new("angle", "rad"));
    panel.series.push(Series::new("simulated", Role::Simulated, x.clone(), x));
    Figure { title: "Angle".into(), x: Axis::time(), panels: vec![panel], space: None }
}

/// A page without its own script, which must be there once.
fn without_plot_script(page: &str) -> String {
    assert_eq!(page.matches(shell::PLOT_SCRIPT).count(), 1);
    page.replace(shell::PLOT_SCRIPT, "")
}

fn page() -> Page {
    Page {
        title: "Spring".into(),
        figures: vec![figure()],
        checks: vec![check("one", 2e-10, CheckVerdict::Holds), check("two", 1e-10, CheckVerdict::Holds)],
        signals: vec![SignalRow {
            path: "/a".into(),
            unit: "m".into(),
            largest: None,
            error_bar: Some(1e-9),
            method: "refined".into(),
        }],
        energy: Some(Energy { start: 1.0, end: 0.5, work: 0.0, dissipated: 0.5, residual: 1e-12 }),
        ..Page::default()
    }
}

#[test]
fn the_banner_follows_the_checks() {
    let mut page = page();
    assert!(html(&page).contains("both checks hold"));
    page.checks.push(check("three", 1e-8, CheckVerdict::Fails));
    assert!(html(&page).contains("1 of 3 checks fails"));
    page.checks.push(check("four", 0.0, CheckVerdict::NotMade));
    assert!(html(&page).contains("2 of 4 checks fail"));
    page.stop = Some(Stop { time: 1.25, reason: "not finite".into(), help: String::new(), is_good: false });
    assert!(html(&page).contains("the run stopped at t = 1.25 s"));
    assert!(html(&Page::default()).contains("it has no checks"));
}

fn finding() -> FindingRow {
    FindingRow {
        run: "coarse".into(),
        law: "loop-position".into(),
        element: "/crank".into(),
        time: 0.25,
        value: 1.5e-3,
        limit: 1e-9,
        unit: "m".into(),
        help: "take step = 0.001".into(),
    }
}

#[test]
fn a_finding_of_the_audit_leaves_no_good_banner() {
    let mut page = page();
    assert!(html(&page).contains("banner good") && !html(&page).contains("<h2>Audit</h2>"));
    page.findings.push(finding());
    let text = html(&page);
    assert!(text.contains("banner bad") && !text.contains("banner good"));
    assert!(text.contains("the audit has 1 finding; both checks hold"));
    for part in ["<h2>Audit</h2>", "coarse: loop position", "/crank", "0.25 s", "take step = 0.001"] {
        assert!(text.contains(part), "{part}");
    }
    let card = Card { checks: page.checks, n_findings: 1, ..Card::default() };
    let index = index_html(&IndexPage { cards: vec![card], ..IndexPage::default() });
    assert!(index.contains("banner bad") && index.contains("1 of 1 experiments fails"));
}

#[test]
fn a_page_needs_nothing_from_outside() {
    let index = IndexPage { cards: vec![Card { figure: Some(figure()), ..Card::default() }], ..IndexPage::default() };
    for text in [without_plot_script(&html(&page())), index_html(&index)] {
        for outside in ["http://", "https://", "<script", "<link", "@import", "url(", " src="] {
            assert!(!text.contains(outside), "{outside}");
        }
    }
}

#[test]
fn markup_in_a_scene_is_shown_not_obeyed() {
    let evil = "<script>alert('1')</script>";
    let mut page = page();
    page.title = evil.into();
    page.description = evil.into();
    page.up = Some((evil.into(), evil.into()));
    page.stop = Some(Stop { time: 0.0, reason: evil.into(), help: evil.into(), is_good: false });
    page.warnings = vec![evil.into()];
    page.findings = vec![FindingRow {
        run: evil.into(),
        law: evil.into(),
        element: evil.into(),
        unit: evil.into(),
        help: evil.into(),
        ..finding()
    }];
    page.notes = vec![evil.into()];
    page.messages = vec![(evil.into(), evil.into(), evil.into())];
    page.settings = vec![(evil.into(), evil.into())];
    page.figures[0].title = evil.into();
    let row = CheckRow { name: evil.into(), about: evil.into(), unit: evil.into(), ..page.checks[0].clone() };
    page.checks = vec![row.clone()];
    page.signals =
        vec![SignalRow { path: evil.into(), unit: evil.into(), largest: None, error_bar: None, method: evil.into() }];
    let card = Card {
        group: evil.into(),
        title: evil.into(),
        source: evil.into(),
        summary: evil.into(),
        href: evil.into(),
        replay: evil.into(),
        picture: "<svg></svg>".into(),
        figure: Some(page.figures[0].clone()),
        checks: vec![row],
        n_findings: 0,
        stop: page.stop.clone(),
        run_time: evil.into(),
    };
    let index = IndexPage { title: evil.into(), description: evil.into(), cards: vec![card], ..IndexPage::default() };
    assert!(!without_plot_script(&html(&page)).contains("<script"));
    assert!(!index_html(&index).contains("<script"));
}

#[test]
fn cards_of_a_group_stand_under_its_heading() {
    let card = |group: &str| Card { group: group.into(), ..Card::default() };
    let cards = vec![card("Chapter 3"), card("Chapter 3"), card("Others")];
    let text = index_html(&IndexPage { cards, ..IndexPage::default() });
    assert_eq!(text.matches(">Chapter 3</h3>").count(), 1);
    assert!(text.find(">Chapter 3</h3>") < text.find(">Others</h3>"));
    assert_eq!(text.matches("class=\"group\"").count(), 2);
}

#[test]
fn what_scripts_and_clients_said_stands_on_the_page() {
    assert!(!html(&page()).contains("Messages"));
    let messages = vec![("0.25 s".into(), "/arm/tip".into(), "touched".into())];
    let text = html(&Page { messages, ..page() });
    assert!(text.contains("<h2>Messages</h2>") && text.contains("touched") && text.contains("<code>/arm/tip</code>"));
}

#[test]
fn verdicts_are_words_as_well_as_colours() {
    let text = html(&page());
    assert_eq!(text.matches("</span> holds</span>").count(), 2);
}

#[test]
fn digits_show_the_deviation() {
    let text = html(&page());
    assert!(text.contains("−0.2970058698"), "measured");
    assert!(text.contains("−0.2970058700"), "expected");
    assert!(text.contains("2.0×10<sup>−10</sup>") && text.contains("2×10<sup>−9</sup>") && text.contains("10 %"));
}

#[test]
fn a_check_without_numbers_does_not_break_the_table() {
    let mut page = page();
    page.checks = vec![
        CheckRow { measured: None, expected: None, deviation: f64::NAN, ..check("nan", 0.0, CheckVerdict::Fails) },
        CheckRow { limit: 0.0, ..check("exact", 0.0, CheckVerdict::Holds) },
        CheckRow { limit: 0.0, ..check("zero limit", 1.0, CheckVerdict::Fails) },
    ];
    let text = html(&page);
    assert!(text.contains("not a number") && text.contains("exact") && !text.contains("NaN"));
}

#[test]
fn failing_checks_come_first_on_a_card() {
    let mut checks: Vec<CheckRow> = (0..6).map(|i| check(&format!("good {i}"), 0.0, CheckVerdict::Holds)).collect();
    checks.push(check("culprit", 1.0, CheckVerdict::Fails));
    let text = index_html(&IndexPage { cards: vec![Card { checks, ..Card::default() }], ..IndexPage::default() });
    assert!(text.contains("culprit") && !text.contains("good 3"));
    assert!(text.contains("1 of 1 experiments fails (7 checks)"));
}

#[test]
fn contents_lead_to_every_section() {
    let text = html(&page());
    let headings = text.matches("<h2>").count();
    let contents = text.split("class=\"contents\"").nth(1).and_then(|rest| rest.split("</nav>").next()).unwrap_or("");
    assert_eq!(contents.matches("<a href").count(), headings);
    for link in contents.split("href=\"#").skip(1) {
        let name = link.split('"').next().unwrap_or("");
        assert_eq!(text.matches(&format!("id=\"{name}\"")).count(), 1, "{name}");
    }
}

#[test]
fn the_mechanism_is_a_sketch_two_tables_and_an_equation() {
    let joint =
        JointRow { path: "/arm/elbow".into(), kind: "revolute".into(), axes: "y".into(), ..JointRow::default() };
    let body = BodyRow { path: "/arm/rod<1>".into(), mass: "2.5".into(), ..BodyRow::default() };
    let mechanism = Mechanism {
        sketch: "<svg></svg>".into(),
        derivation: "J·ω' = τ, <exact>:\n\n    p = J·ω".into(),
        equation: "M(q) v̇ + c(q, v) = τ".into(),
        sizes: vec![("M".into(), "2 × 2".into())],
        joints: vec![joint; 50],
        bodies: vec![body],
    };
    let text = html(&Page { mechanism: Some(mechanism), ..page() });
    for part in [
        "<h2>Mechanism</h2>",
        "/arm/elbow",
        "rod&lt;1&gt;",
        "2 × 2",
        "and 10 more joints",
        "M(q) v̇",
        "&lt;exact&gt;",
        "p = J·ω</pre>",
    ] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn numbers_for_the_script_stand_in_the_figures_of_a_page_alone() {
    let text = html(&page());
    assert!(text.contains(" data-x=\"") && text.contains(" data-name=\"simulated\""));
    assert!(!crate::plot::svg(&figure(), crate::plot::Size::wide(&figure())).contains("data-"));
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    assert_eq!(html(&page()), html(&page()));
}
