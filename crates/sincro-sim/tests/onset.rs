//! Motion that begins from rest under a growing load: nothing moves before the instant at which a force reaches its
//! bound, and the acceleration grows from zero after it, v = ½ j (t − t₀)².

use std::sync::atomic::AtomicBool;

use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_testing::SceneFolder;
use sincro_testing::random::Draw;

const G: f64 = 9.81;

/// A scene with the signal to look at, the instant of the onset `[s]` and the growth j of the acceleration.
struct Onset {
    scene: String,
    signal: &'static str,
    at: f64,
    growth: f64,
}

/// A lever without gravity that `held_by` keeps still up to a torque `limit` [N·m], and a constant torque, `preload` of
/// that limit.
fn lever(r: &mut Draw, preload: f64, held_by: impl Fn(f64) -> String) -> Onset {
    let (limit, slope, inertia) = (r.decade(-2.0, 2.0), r.between(1.1, 3.0), r.decade(-2.0, 1.0));
    let (slope, held_by) = (slope * limit, held_by(limit));
    let scene = format!(
        "gravity = [0.0, 0.0, 0.0]\n[[joint]]\nname = \"j\"\nkind = \"revolute\"\n{held_by}\n\
         torque = {{ ramp = {{ start = 0.0, from = {}, slope = {slope} }} }}\n\
         [[body]]\nname = \"lever\"\nparent = \"/j\"\nmass = 1.0\n\
         inertia = {{ xx = {inertia}, yy = {inertia}, zz = {inertia} }}\n",
        -preload * limit
    );
    Onset { scene, signal: "/j.velocity", at: limit / slope, growth: slope / inertia }
}

/// A box of edge 0.2 m on a floor with a force on its centre that grows along `direction`.
fn a_box(mass: f64, friction: f64, [x, y, z]: [f64; 3]) -> String {
    let inertia = 0.04 * mass / 6.0;
    format!(
        "[[body]]\nname = \"floor\"\nshape = [{{ plane = {{}} }}]\ncontact = {{ friction = {friction} }}\n\
         [[joint]]\nname = \"f\"\nkind = \"free\"\ninitial = {{ position = [0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0] }}\n\
         [[body]]\nname = \"box\"\nparent = \"/f\"\nmass = {mass}\n\
         inertia = {{ xx = {inertia}, yy = {inertia}, zz = {inertia} }}\n\
         shape = [{{ cuboid = {{ size = [0.2, 0.2, 0.2] }} }}]\ncontact = {{ friction = {friction} }}\n\
         [[force]]\nname = \"push\"\nparent = \"/f/box\"\nforce = [\
         {{ ramp = {{ start = 0.0, slope = {x} }} }}, {{ ramp = {{ start = 0.0, slope = {y} }} }}, \
         {{ ramp = {{ start = 0.0, slope = {z} }} }}]\n"
    )
}

fn pushed(r: &mut Draw) -> Onset {
    let (mass, friction) = (r.decade(-2.0, 2.0), r.between(0.1, 0.3));
    let limit = friction * mass * G;
    let slope = r.between(1.1, 3.0) * limit;
    Onset {
        scene: a_box(mass, friction, [slope, 0.0, 0.0]),
        signal: "/f.velocity.x",
        at: limit / slope,
        growth: slope / mass,
    }
}

fn lifted(r: &mut Draw) -> Onset {
    let mass = r.decade(-2.0, 2.0);
    let slope = r.between(1.1, 3.0) * mass * G;
    Onset {
        scene: a_box(mass, 0.5, [0.0, 0.0, slope]),
        signal: "/f.velocity.z",
        at: mass * G / slope,
        growth: slope / mass,
    }
}

/// A lever without gravity that a constant torque presses on the stop of its joint.
fn off_its_stop(r: &mut Draw) -> Onset {
    lever(r, 1.0, |_| "limits = { lower = 0.0, upper = 1000.0 }".to_owned())
}

fn run(scene: &str, integrator: &str, signal: &str) -> Campaign {
    let experiment = format!(
        "title = \"Onset\"\nscene = \"scene.toml\"\nduration = 1.0\nstep = 0.005\nintegrator = \"{integrator}\"\n\
         error_bar = \"refine\"\nrecord = [\"{signal}\"]\n"
    );
    let folder = SceneFolder::of(scene, &experiment);
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}\n{scene}"));
    run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
}

/// Demands the exact velocity of what begins to move, within three error bars and to 1e-10.
fn all_begin_in_time(draw: impl Fn(&mut Draw) -> Onset) {
    let mut r = Draw(5);
    for k in 0..12 {
        let Onset { scene, signal, at, growth } = draw(&mut r);
        for integrator in ["auto", "stiff"] {
            let done = run(&scene, integrator, signal);
            let about = format!("draw {k}, {integrator}");
            assert!(done.main.audit.ok && done.report.warnings.is_empty(), "{about}: {:?}", done.report.warnings);
            let column = &done.main.simulated.table.column(signal).unwrap().values;
            let bar = done.report.columns.iter().find(|column| column.path == signal).unwrap().error_bar.unwrap();
            for (tick, v) in column.iter().enumerate() {
                let since = 0.005 * tick as f64 - at;
                let exact = if since > 0.0 { 0.5 * growth * since * since } else { 0.0 };
                let (error, scale) = ((v - exact).abs(), 1.0_f64.max(exact));
                let most = (1e-10 * scale).min(3.0 * bar + 1e-13 * scale);
                assert!(error <= most, "{about}: off by {error:e}, bar {bar:e}, {since} s after the onset\n{scene}");
            }
        }
    }
}

#[test]
fn a_joint_gives_way_where_its_friction_is_exceeded() {
    all_begin_in_time(|r| lever(r, 0.0, |limit| format!("friction = {limit}")));
}

#[test]
fn a_joint_gives_way_where_its_motor_is_exceeded() {
    let motor = |limit| format!("motor = {{ mode = \"velocity\", command = 0.0, max_torque = {limit} }}");
    all_begin_in_time(|r| lever(r, 0.0, motor));
}

#[test]
fn a_box_slides_where_friction_is_exceeded() {
    all_begin_in_time(pushed);
}

#[test]
fn a_box_leaves_the_floor_where_its_weight_is_exceeded() {
    all_begin_in_time(lifted);
}

#[test]
fn a_lever_leaves_its_stop_where_its_load_is_exceeded() {
    all_begin_in_time(off_its_stop);
}
