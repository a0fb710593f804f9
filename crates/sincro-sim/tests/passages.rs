//! Bounds and surfaces that are passed and left again within a step: an oscillator that just reaches a stop, against
//! its closed form.

use sincro_math::elementary::sin_cos;
use sincro_testing::SceneFolder;
use sincro_testing::random::uniform;

/// Natural frequency [rad/s], restitution, radius of the ball `[m]`.
const OMEGA: f64 = 10.0;
const RESTITUTION: f64 = 0.5;
const RADIUS: f64 = 0.1;

/// Duration of a run `[s]`: less than half a period after the impact.
const DURATION: f64 = 0.3;

/// Last value of a signal of a scene, run at accuracy 1e-12 by an integrator, with a step `[s]`.
fn last_of(scene: &str, (integrator, step): (&str, f64), signal: &str) -> f64 {
    let experiment = format!(
        "title = \"Passage\"\nduration = {DURATION:?}\nstep = {step:?}\nintegrator = \"{integrator}\"\naccuracy = 1e-12\n\
         error_bar = \"none\"\nrecord = [\"{signal}\"]\n"
    );
    let folder = SceneFolder::new().with("scene.toml", scene).with("experiment.toml", &experiment);
    sincro_testing::last(&sincro_testing::run(&folder.load(&[]).unwrap_or_else(|e| panic!("{e}"))), signal)
}

/// Oscillator of amplitude 1 m that meets a stop just before it turns back.
#[derive(Clone, Copy, Debug)]
struct Draw {
    /// Phase before the turning point at which it starts `[rad]`.
    start: f64,
    /// That at which it meets the stop `[rad]`.
    meets: f64,
}

impl Draw {
    /// Position of the stop `[m]`.
    fn bound(self) -> f64 {
        sin_cos(self.meets).1
    }

    /// Position at the end of the run `[m]`.
    fn end(self) -> f64 {
        let (sin, cos) = sin_cos(OMEGA * DURATION - (self.start - self.meets));
        self.bound() * cos - RESTITUTION * sin_cos(self.meets).0 * sin
    }

    fn scene(self, is_contact: bool) -> String {
        let (stop, wall) = if is_contact {
            let wall = format!(
                "[[body]]\nname = \"wall\"\nposition = [{:?}, 0.0, 0.0]\nrotation_deg = [0.0, -90.0, 0.0]\nshape = [{{ plane = {{}} }}]\n\
                 contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n",
                self.bound() + RADIUS
            );
            (String::new(), wall)
        } else {
            let upper = self.bound();
            (format!("limits = {{ lower = -2.0, upper = {upper:?}, restitution = {RESTITUTION:?} }}\n"), String::new())
        };
        format!(
            "[[joint]]\nname = \"slide\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nspring = {{ stiffness = {:?}, rest = 0.0 }}\n{stop}\
             initial = {{ position = {:?}, velocity = {:?} }}\n\n\
             [[body]]\nname = \"ball\"\nparent = \"/slide\"\nmass = 1.0\nshape = [{{ sphere = {{ radius = {RADIUS:?} }} }}]\n\
             contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n\n{wall}",
            OMEGA * OMEGA,
            sin_cos(self.start).1,
            OMEGA * sin_cos(self.start).0,
        )
    }

    /// Deviation of a run from the closed form, at its end `[m]`.
    fn deviation(self, is_contact: bool, integrator: &str) -> f64 {
        (last_of(&self.scene(is_contact), (integrator, 0.005), "/slide.position") - self.end()).abs()
    }
}

/// An impact of whatever is deeper than a nanometre, however short it lasts.
#[test]
fn stops_passed_and_left_within_a_step_are_impacts() {
    let mut random = uniform(71);
    for k in 0..120 {
        let (start, share) = (0.3 + 0.9 * random(), random());
        let draw = Draw { start, meets: 3e-4 + 0.06 * share * share * share };
        for is_contact in [false, true] {
            for integrator in ["auto", "stiff"] {
                let deviation = draw.deviation(is_contact, integrator);
                let what = if is_contact { "surface" } else { "limit" };
                assert!(deviation < 1e-6, "draw {k}, {what}, {integrator}: {deviation:e} m off, {draw:?}");
            }
        }
    }
}

/// An event that ends a step says nothing of what is passed and left before it: a cart that a limited motor drives up
/// to its speed gets there soon after the oscillator has met its stop.
#[test]
fn stops_passed_before_another_event_of_the_step_are_impacts() {
    let mut random = uniform(75);
    for k in 0..60 {
        let (start, share) = (0.3 + 0.9 * random(), random());
        let draw = Draw { start, meets: 3e-4 + 0.06 * share * share * share };
        let force = OMEGA / (start + (1.0 + 2.0 * random()) * draw.meets);
        let cart = format!(
            "\n[[joint]]\nname = \"cart\"\nkind = \"prismatic\"\naxis = [0.0, 1.0, 0.0]\nposition = [0.0, 1.0, 0.0]\n\
             motor = {{ mode = \"velocity\", max_force = {force:?}, command = 1.0 }}\n\n\
             [[body]]\nname = \"load\"\nparent = \"/cart\"\nmass = 1.0\ninertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n"
        );
        for is_contact in [false, true] {
            // a stop that is just reached is met a little earlier or later by the error of fixed steps
            for (integrator, most) in [("auto", 1e-6), ("stiff", 1e-6), ("rk4", 1e-4)] {
                let scene = draw.scene(is_contact) + &cart;
                let deviation = (last_of(&scene, (integrator, 0.005), "/slide.position") - draw.end()).abs();
                let what = if is_contact { "surface" } else { "limit" };
                assert!(deviation < most, "draw {k}, {what}, {integrator}: {deviation:e} m off, {draw:?}, {force} N");
            }
        }
    }
}

/// A rod that turns freely about z at 5 rad/s touches a wall with its tip while that passes by, and turns back.
#[test]
fn tips_that_graze_a_wall_within_a_step_bounce() {
    const RATE: f64 = 5.0;
    let mut random = uniform(72);
    for k in 0..60 {
        let (start, share) = (0.3 + 0.3 * random(), random());
        let meets = 3e-4 + 0.03 * share * share;
        let scene = format!(
            "[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\n\
             initial = {{ position = {:?}, velocity = {RATE:?} }}\n\n\
             [[body]]\nname = \"rod\"\nparent = \"/hinge\"\nmass = 1.0\ncenter_of_mass = [0.5, 0.0, 0.0]\n\
             inertia = {{ xx = 0.01, yy = 0.1, zz = 0.1 }}\n\
             shape = [{{ position = [1.0, 0.0, 0.0], sphere = {{ radius = {RADIUS:?} }} }}]\n\
             contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n\n\
             [[body]]\nname = \"wall\"\nposition = [{:?}, 0.0, 0.0]\nrotation_deg = [0.0, -90.0, 0.0]\nshape = [{{ plane = {{}} }}]\n\
             contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n",
            -start,
            sin_cos(meets).1 + RADIUS
        );
        let expected = -meets - RESTITUTION * (RATE * DURATION - (start - meets));
        let deviation = (last_of(&scene, ("auto", 0.005), "/hinge.position") - expected).abs();
        assert!(deviation < 1e-6, "draw {k}: {deviation:e} rad off, from {start} rad, wall at {meets} rad");
    }
}

/// A body that would be through another one within a step hits it.
#[test]
fn bullets_bounce_from_what_is_thinner_than_a_step() {
    const SHAPES: [&str; 5] = [
        "sphere = { radius = 0.006 }",
        "cuboid = { size = [0.012, 0.3, 0.2] }",
        "capsule = { radius = 0.006, length = 0.2 }",
        "cylinder = { radius = 0.006, length = 0.2 }",
        "cuboid = { size = [0.012, 0.01, 0.02] }",
    ];
    // half of the thickness along x of all of them [m]
    const HALF: f64 = 0.006;
    let mut random = uniform(73);
    for k in 0..10 {
        let (gap, speed) = (0.1 + 0.5 * random(), 5.0 + 30.0 * random());
        for (bullet, target) in SHAPES.iter().flat_map(|bullet| SHAPES.iter().map(move |target| (bullet, target))) {
            let scene = format!(
                "[[joint]]\nname = \"barrel\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\n\
                 initial = {{ position = {:?}, velocity = {speed:?} }}\n\n\
                 [[body]]\nname = \"bullet\"\nparent = \"/barrel\"\nmass = 0.01\nshape = [{{ {bullet} }}]\n\
                 contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n\n\
                 [[body]]\nname = \"target\"\nshape = [{{ {target} }}]\n\
                 contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n",
                -gap - 2.0 * HALF
            );
            let expected = -2.0 * HALF - RESTITUTION * (speed * DURATION - gap);
            let deviation = (last_of(&scene, ("auto", 0.005), "/barrel.position") - expected).abs();
            assert!(deviation < 1e-8, "draw {k}, {bullet} on {target}: {deviation:e} m off, {gap} m at {speed} m/s");
        }
    }
}

/// A sphere on a rail that grazes another one, 1 µm to 10 mm deep, bounces from it.
#[test]
fn spheres_that_graze_each_other_within_a_step_bounce() {
    let mut random = uniform(74);
    for k in 0..100 {
        let (start, speed, share) = (0.5 + 0.4 * random(), 2.0 + 18.0 * random(), random());
        let offset = 2.0 * RADIUS - 1e-6 - 0.01 * share * share * share;
        let scene = format!(
            "[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nposition = [0.0, 0.0, {offset:?}]\n\
             initial = {{ position = {:?}, velocity = {speed:?} }}\n\n\
             [[body]]\nname = \"ball\"\nparent = \"/rail\"\nmass = 1.0\nshape = [{{ sphere = {{ radius = {RADIUS:?} }} }}]\n\
             contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n\n\
             [[body]]\nname = \"other\"\nshape = [{{ sphere = {{ radius = {RADIUS:?} }} }}]\n\
             contact = {{ friction = 0.0, restitution = {RESTITUTION:?} }}\n",
            -start
        );
        let meets = -(4.0 * RADIUS * RADIUS - offset * offset).sqrt();
        let time = (meets + start) / speed;
        let expected =
            if time < DURATION { meets - RESTITUTION * speed * (DURATION - time) } else { speed * DURATION - start };
        let deviation = (last_of(&scene, ("auto", 0.02), "/rail.position") - expected).abs();
        assert!(deviation < 1e-6, "draw {k}: {deviation:e} m off, {offset} m aside at {speed} m/s from {start} m");
    }
}
