//! Claims about whole drawings, on textbook diagrams and on random ones.

use core::any::Any;

use sincro_blocks::block::{Memory, Node, Ports, SampleTimeKind};
use sincro_blocks::instance::{DynBlock, RunningBlock};
use sincro_blocks::kind::{Category, Kind};
use sincro_blocks::library::continuous::Integrator;
use sincro_blocks::library::discrete::UnitDelay;
use sincro_blocks::library::maths::{Gain, Sum};
use sincro_blocks::library::sources::Constant;
use sincro_blocks::unit::Unit;
use sincro_blocks::unit_rule::UnitRule;
use sincro_math::Dual;
use sincro_math::record::Recorded;

use super::route::{Point, Run};
use super::*;

/// A drawing whose layouts are found anew.
fn drawn(diagram: &Diagram, options: &Options) -> String {
    draw(diagram, options, &mut Layouts::default())
}

/// A block that can only be drawn.
#[derive(Clone, Debug)]
struct Sham {
    kind: &'static Kind,
    label: &'static str,
    ports: Ports,
}

impl DynBlock for Sham {
    fn kind(&self) -> &'static Kind {
        self.kind
    }
    fn ports(&self) -> Ports {
        self.ports.clone()
    }
    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        unimplemented!("never compiled")
    }
    fn units(&self, _: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        unimplemented!("never compiled")
    }
    fn unit_rule(&self) -> UnitRule {
        unimplemented!("never compiled")
    }
    fn sample_time_kind(&self) -> SampleTimeKind {
        SampleTimeKind::Inherited
    }
    fn has_direct_feedthrough(&self, _: usize) -> bool {
        true
    }
    fn memory(&self, _: &Node) -> Memory {
        Memory::default()
    }
    fn check(&self, _: &Node) -> Result<(), (String, String)> {
        Ok(())
    }
    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }
    fn zero_crossing_count(&self) -> Option<usize> {
        None
    }
    fn highest_frequency(&self, _: f64, _: bool) -> f64 {
        0.0
    }
    fn notice(&self, _: &Node, _: &[f64]) -> Option<String> {
        None
    }
    fn fault(&self) -> Option<String> {
        None
    }
    fn label(&self) -> String {
        self.label.into()
    }
    fn on_numbers(&self) -> Box<dyn RunningBlock<f64>> {
        unimplemented!("never run")
    }
    fn on_duals(&self) -> Box<dyn RunningBlock<Dual<1>>> {
        unimplemented!("never run")
    }
    fn on_recorded(&self) -> Box<dyn RunningBlock<Recorded>> {
        unimplemented!("never run")
    }
    fn computes_lanes_together(&self) -> bool {
        false
    }
    fn on_lanes(&self) -> Option<Box<dyn Any>> {
        None
    }
    fn boxed_clone(&self) -> Box<dyn DynBlock> {
        Box::new(self.clone())
    }
}

fn sham(name: &'static str, label: &'static str, inputs: &[&str], outputs: &[&str]) -> Content {
    let kind = Kind { name, category: Category::Sources, summary: "", equation: "", parameters: &[] };
    Content::Block(Box::new(Sham { kind: Box::leak(Box::new(kind)), label, ports: Ports::new(inputs, outputs) }))
}

/// Two motors under proportional control.
fn position_control() -> Diagram {
    let mut d = Diagram::new();
    for k in 1..=2 {
        let name = |what: &str| format!("{what}{k}");
        d.add(&name("reference"), sham("table", "", &[], &["y"]), None);
        d.block(&name("error"), Sum::new("+-")).block(&name("kp"), Gain::new(12.5 * f64::from(k)));
        d.sampled(&name("delay"), 0.001, UnitDelay::new(0.0));
        d.wire(&name("reference"), &format!("error{k}.u1")).wire(&name("error"), &name("kp"));
        d.wire(&name("kp"), &format!("/motor{k}")).wire(&format!("/motor{k}.position"), &name("delay"));
        d.wire(&name("delay"), &format!("error{k}.u2"));
    }
    d
}

/// Two loops without anything on the way back.
fn plain_loops() -> Diagram {
    let mut d = Diagram::new();
    for k in 1..=2 {
        d.block(&format!("target{k}"), Constant::new(1.0)).block(&format!("error{k}"), Sum::new("+-"));
        d.block(&format!("gain{k}"), Gain::new(8.0)).wire(&format!("target{k}"), &format!("error{k}.u1"));
        d.wire(&format!("error{k}"), &format!("gain{k}")).wire(&format!("gain{k}"), &format!("/joint{k}"));
        d.wire(&format!("/joint{k}.position"), &format!("error{k}.u2"));
    }
    d
}

fn pid() -> Diagram {
    let mut d = Diagram { inputs: vec!["target".into(), "speed".into()], outputs: vec!["u".into()], ..Diagram::new() };
    d.block("error", Sum::new("+-")).block("kp", Gain::new(2.0)).block("ki", Gain::new(0.4));
    d.block("integral", Integrator::new(0.0)).block("all", Sum::new("++"));
    d.add("limit", sham("saturation", "", &["u"], &["y"]), None);
    d.wire("target", "error.u1").wire("speed", "error.u2").wire("error", "kp").wire("error", "ki");
    d.wire("ki", "integral").wire("kp", "all.u1").wire("integral", "all.u2").wire("all", "limit").wire("limit", "u");
    d
}

/// A velocity loop, drawn once and used twice.
fn velocity_control() -> Diagram {
    let mut d = Diagram::new();
    d.add("profile", sham("trapezoid", "", &[], &["y"]), None);
    d.block("half", Gain::new(0.5));
    for k in 1..=2 {
        let name = format!("loop{k}");
        d.add(&name, Content::Diagram("velocity-pi".into(), Box::new(pid())), None);
        d.wire(if k == 1 { "profile" } else { "half" }, &format!("loop{k}.target"));
        d.wire(&format!("/wheel{k}.velocity"), &format!("loop{k}.speed")).wire(&name, &format!("/wheel{k}"));
    }
    d.wire("profile", "half");
    d.add("watch", sham("scope", "", &["u1", "u2"], &[]), None);
    d.wire("/wheel1.velocity", "watch.u1").wire("/wheel2.velocity", "watch.u2");
    d
}

fn state_feedback() -> Diagram {
    let mut d = Diagram::new();
    d.block("reference", Constant::new(0.3));
    d.add("k", sham("matrix-gain", "K", &["u"], &["y"]), None);
    d.block("balance", Sum::new("+-"));
    d.add("limit", sham("saturation", "", &["u"], &["y"]), None);
    d.add("screen", sham("scope", "", &["u"], &[]), None);
    d.wire("[/cart.position, /cart.velocity, /pole.angle, /pole.rate]", "k");
    d.wire("reference", "balance.u1").wire("k", "balance.u2").wire("balance", "limit").wire("limit", "/cart");
    d.wire("limit", "screen");
    d
}

/// A plant without a world: x' = 2 (1 − x) − x₂ …, with components, a product and a self-loop.
fn odd_ends() -> Diagram {
    let mut d = Diagram::new();
    d.block("target", Constant::new(1.0)).block("error", Sum::new("+--")).block("rate", Gain::new(2.0));
    d.block("x", Integrator::new(0.0)).block("memory", UnitDelay::new(0.0)).block("alone", UnitDelay::new(0.0));
    d.add("state-estimator-with-a-long-name", sham("kalman-filter", "", &["u", "y"], &["x", "p"]), None);
    d.add("times", sham("product", "", &["u1", "u2"], &["y"]), None);
    d.wire("target", "error.u1").wire("error", "rate").wire("rate", "x").wire("x", "error.u2");
    d.wire("memory", "memory").wire("memory", "error.u3").wire("rate", "state-estimator-with-a-long-name.u");
    d.wire("x", "state-estimator-with-a-long-name.y").wire("state-estimator-with-a-long-name.x[0]", "times.u1");
    d.wire("state-estimator-with-a-long-name.x[1:3]", "times.u2").wire("nowhere", "noone");
    d
}

/// Blocks in random wires, a fifth of them back.
fn random(n: usize, seed: u64) -> Diagram {
    let mut state = seed;
    let mut draw = move |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n
    };
    let mut d = Diagram::new();
    for k in 0..n {
        let name = format!("b{k}");
        match draw(6) {
            0 => d.block(&name, Sum::new("+-")),
            1 => d.block(&name, Gain::new(k as f64)),
            2 => d.block(&name, Sum::new("+-+")),
            3 => d.add(&name, sham("observer", "", &["u1", "u2"], &["a", "b"]), None),
            4 if k % 3 == 0 => d.block(&name, Constant::new(k as f64)),
            _ => d.block(&name, Integrator::new(0.0)),
        };
    }
    for k in 1..n {
        let Content::Block(block) = &d.entries[k].content else { continue };
        for port in block.ports().inputs {
            let is_back = draw(10) == 0;
            let from = if is_back { draw(n) } else { k - 1 - draw(k.min(8)) };
            let from = match draw(8) {
                0 => format!("/motor{}.position", draw(4)),
                1 => format!("[b{from}, b{}]", k - 1),
                _ => format!("b{from}"),
            };
            d.wire(&from, &format!("b{k}.{port}"));
        }
    }
    for motor in 0..4 {
        d.wire(&format!("b{}", n - 1 - 3 * motor), &format!("/motor{motor}"));
    }
    d
}

fn chain(n: usize) -> Diagram {
    let mut d = Diagram::new();
    for k in 0..n {
        d.block(&format!("g{k}"), Gain::new(1.0));
        if k > 0 {
            d.wire(&format!("g{}", k - 1), &format!("g{k}"));
        }
    }
    d
}

fn examples() -> Vec<(&'static str, Diagram)> {
    let mut all = vec![
        ("position", position_control()),
        ("velocity", velocity_control()),
        ("lqr", state_feedback()),
        ("loops", plain_loops()),
        ("odd", odd_ends()),
        ("pid", pid()),
        ("one", chain(1)),
        ("hundred", chain(100)),
        ("empty", Diagram::new()),
        ("random40", random(40, 7)),
        ("random100", random(100, 3)),
    ];
    all.extend((0..12).map(|seed| ("random60", random(60, seed))));
    all
}

fn laid_out(diagram: &Diagram) -> (Graph, Layout) {
    let mut graph = Graph::new(diagram, "World");
    let (layout, _) = Layout::new(&mut graph);
    (graph, layout)
}

/// Returns true if two pieces have more than a place in common.
fn shares(a: &(Point, Point), b: &(Point, Point)) -> bool {
    let range = |p: i64, q: i64| (p.min(q), p.max(q));
    let meets = |(a, b): (i64, i64), (c, d): (i64, i64)| a < d && c < b;
    let is_upright = |p: &(Point, Point)| p.0.0 == p.1.0;
    match (is_upright(a), is_upright(b)) {
        (true, true) => a.0.0 == b.0.0 && meets(range(a.0.1, a.1.1), range(b.0.1, b.1.1)),
        (false, false) => a.0.1 == b.0.1 && meets(range(a.0.0, a.1.0), range(b.0.0, b.1.0)),
        _ => false,
    }
}

#[test]
fn every_block_and_wire_is_drawn() {
    for (name, diagram) in examples() {
        let text = drawn(&diagram, &Options::default());
        for entry in &diagram.entries {
            assert!(text.contains(&format!("<title>{} ", entry.name)), "{name}: {}", entry.name);
        }
        let (graph, layout) = laid_out(&diagram);
        let n_ends: usize = diagram.wires.iter().map(|w| if w.from.len() == 1 { 1 } else { w.from.len() + 1 }).sum();
        let heads: usize = layout.runs.iter().map(|run| run.heads.len()).sum();
        assert_eq!((graph.nets.iter().map(|net| net.to.len()).sum::<usize>(), heads), (n_ends, n_ends), "{name}");
        for run in &layout.runs {
            assert_connected(name, run);
        }
    }
}

/// All heads can be reached from the start along the pieces.
fn assert_connected(name: &str, run: &Run) {
    let touches = |p: Point, (a, b): &(Point, Point)| {
        (a.0.min(b.0)..=a.0.max(b.0)).contains(&p.0) && (a.1.min(b.1)..=a.1.max(b.1)).contains(&p.1)
    };
    let mut is_reached: Vec<bool> = run.pieces.iter().map(|piece| touches(run.start, piece)).collect();
    for _ in 0..run.pieces.len() {
        for k in 0..run.pieces.len() {
            let joins = |j: usize| {
                let (a, b) = (&run.pieces[k], &run.pieces[j]);
                touches(a.0, b) || touches(a.1, b) || touches(b.0, a) || touches(b.1, a)
            };
            is_reached[k] |= (0..run.pieces.len()).any(|j| is_reached[j] && joins(j));
        }
    }
    assert!(is_reached.iter().all(|reached| *reached), "{name}: a wire in pieces {run:?}");
    for (head, _) in &run.heads {
        assert!(run.pieces.iter().any(|piece| touches(*head, piece)), "{name}: {head:?} is not reached: {run:?}");
    }
}

#[test]
fn boxes_do_not_overlap() {
    for (name, diagram) in examples() {
        let (graph, layout) = laid_out(&diagram);
        for (k, a) in layout.outlines.iter().enumerate() {
            for (j, b) in layout.outlines[..k].iter().enumerate() {
                let (a, b) = (a.room, b.room);
                let is_apart = a.2 <= b.0 || b.2 <= a.0 || a.3 <= b.1 || b.3 <= a.1;
                assert!(is_apart, "{name}: `{}` and `{}`", graph.nodes[k].name, graph.nodes[j].name);
            }
        }
    }
}

#[test]
fn wires_do_not_run_through_boxes() {
    for (name, diagram) in examples() {
        let (graph, layout) = laid_out(&diagram);
        for (net, run) in layout.runs.iter().enumerate() {
            for (a, b) in &run.pieces {
                for (node, o) in layout.outlines.iter().enumerate() {
                    let ends_here =
                        graph.nets[net].from.node == node || graph.nets[net].to.iter().any(|to| to.node == node);
                    // at its own boxes a wire may cross the room for texts, but never the outline
                    let room = if ends_here { (o.x, o.y, o.x + o.width, o.y + o.height) } else { o.room };
                    let runs_through = a.0.max(b.0) > room.0
                        && a.0.min(b.0) < room.2
                        && a.1.max(b.1) > room.1
                        && a.1.min(b.1) < room.3;
                    assert!(!runs_through, "{name}: {a:?}–{b:?} through `{}` {o:?}", graph.nodes[node].name);
                }
            }
        }
    }
}

#[test]
fn two_wires_never_share_a_piece() {
    for (name, diagram) in examples() {
        let (_, layout) = laid_out(&diagram);
        for (k, a) in layout.runs.iter().enumerate() {
            for (j, b) in layout.runs[..k].iter().enumerate() {
                for p in &a.pieces {
                    assert!(!b.pieces.iter().any(|q| shares(p, q)), "{name}: nets {k} and {j} at {p:?}");
                }
            }
        }
    }
}

#[test]
fn the_same_diagram_gives_the_same_picture() {
    for (_, diagram) in examples() {
        assert_eq!(drawn(&diagram, &Options::default()), drawn(&diagram, &Options::default()));
    }
}

#[test]
fn known_layouts_give_the_same_picture() {
    let mut layouts = Layouts::default();
    let mut n_known = 0;
    for _ in 0..2 {
        for (name, diagram) in examples() {
            let picture = draw(&diagram, &Options::default(), &mut layouts);
            assert_eq!(picture, drawn(&diagram, &Options::default()), "{name}");
        }
        assert!(n_known == 0 || n_known == layouts.0.len());
        n_known = layouts.0.len();
    }
    // one block less is another layout
    let mut other = pid();
    other.entries.pop();
    let picture = draw(&other, &Options::default(), &mut layouts);
    assert_eq!(picture, drawn(&other, &Options::default()));
    assert_ne!(picture, drawn(&pid(), &Options::default()));
    assert_eq!(layouts.0.len(), n_known + 1);
}

#[test]
fn signals_go_from_left_to_right_and_the_world_stands_at_the_end() {
    let (graph, layout) = laid_out(&position_control());
    let x = |name: &str| layout.outlines[graph.nodes.iter().position(|node| node.name == name).unwrap()].x;
    assert!(x("reference1") < x("error1") && x("error1") < x("kp1"));
    assert!(layout.outlines.iter().all(|outline| outline.x <= x("")));
}

#[test]
fn markup_in_names_does_not_reach_the_picture() {
    let evil = "</svg><script x=\"&\">";
    let mut d = chain(2);
    d.entries[0].name = evil.into();
    d.inputs.push(evil.into());
    let text = drawn(&d, &Options { title: evil.into(), world: evil.into(), ..Options::default() });
    assert!(!text.contains("<script") && text.contains("&lt;script"));
}

#[test]
fn a_standalone_file_names_no_variable() {
    assert!(!drawn(&pid(), &Options::default()).contains("var("));
    assert!(!drawn(&pid(), &Options { is_inline: true, ..Options::default() }).contains("<style"));
}

/// Writes the examples for the eye: `SINCRO_DRAW=folder cargo test -p sincro draw`.
#[test]
fn examples_can_be_looked_at() {
    let Ok(folder) = std::env::var("SINCRO_DRAW") else { return };
    let (css, inline) = (crate::plot::PAGE_CSS, Options { is_inline: true, ..Options::default() });
    let pictures: String = examples().iter().take(5).map(|(_, diagram)| drawn(diagram, &inline)).collect();
    let page = format!("<style>{css}{DRAW_CSS}body {{ background: var(--sp-paper); }}</style>{pictures}");
    std::fs::write(format!("{folder}/page.html"), page).unwrap();
    for (name, diagram) in examples().iter().take(11) {
        let options = Options { title: (*name).into(), ..Options::default() };
        std::fs::write(format!("{folder}/{name}.svg"), drawn(diagram, &options)).unwrap();
    }
}
