//! Equations that the linearisation eliminates, against closed forms: gears, joints stuck in friction, joints at a
//! limit, stacks that stick, velocity and position motors.

use sincro_analysis::linear::Complex;
use sincro_analysis::linearize::{Linearization, ReducedKind, Request, linearize, operating_point};
use sincro_math::elementary::{atan2, hypot, sin_cos};
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_testing::SceneFolder;

const G: f64 = 9.81;

/// Mass [kg], distance of its centre from the pivot [m], and moment of inertia about the pivot [kg·m²] of the pendulum.
const M: f64 = 0.7;
const L: f64 = 0.4;
const J: f64 = 0.7 * 0.4 * 0.4 + 0.02;

fn name(text: &str) -> Located<String> {
    let source = std::sync::Arc::new(SourceText { path: "test".into(), text: text.into() });
    Located { value: text.into(), at: Location { source, span: 0..text.len() } }
}

/// Pendulum of 0.7 kg on a revolute joint `hinge` of a parent, hanging in the x–z plane.
fn pendulum(parent: &str, more: &str) -> String {
    format!(
        "[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\nparent = \"{parent}\"\naxis = [0.0, -1.0, 0.0]\n{more}\
         [[body]]\nname = \"bob\"\nparent = \"{}/hinge\"\nmass = 0.7\ncenter_of_mass = [0.0, 0.0, -0.4]\n\
         inertia = {{ xx = 0.02, yy = 0.02, zz = 0.02 }}\n",
        parent.trim_end_matches('/')
    )
}

/// Cart of 2 kg on a rail along x.
fn cart(more: &str) -> String {
    format!(
        "[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\n{more}\
         [[body]]\nname = \"cart\"\nparent = \"/rail\"\nmass = 2.0\ninertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n"
    )
}

fn linearized(scene: &str, inputs: &[&str], outputs: &[&str]) -> Linearization {
    let experiment =
        "title = \"t\"\nscene = \"scene.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"energy.balance\"]\n";
    let folder = SceneFolder::of(scene, experiment);
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    let at = operating_point(&loaded, 0.0).unwrap();
    let names = |list: &[&str]| list.iter().map(|text| name(text)).collect();
    let request = Request { inputs: names(inputs), outputs: names(outputs), is_closed: false };
    linearize(&loaded, &at, &request).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// Poles that are not exactly zero, and the number of those that are.
fn poles(linear: &Linearization) -> (Vec<Complex<f64>>, usize) {
    let all: Vec<Complex<f64>> = linear.system.poles().iter().map(|mode| mode.pole).collect();
    let (zero, other): (Vec<_>, Vec<_>) = all.into_iter().partition(|p| p.re == 0.0 && p.im == 0.0);
    (other, zero.len())
}

/// The poles are ±j√`square` and `n_zero` at zero.
fn assert_swings(linear: &Linearization, square: f64, n_zero: usize) {
    let (found, zeros) = poles(linear);
    assert_eq!((found.len(), zeros), (2, n_zero), "{found:?} {:?}", linear.reduction);
    for pole in found {
        let size = square.sqrt();
        assert!((pole.im.abs() - size).abs() <= 1e-10 * size && pole.re.abs() <= 1e-10 * size, "{pole} {size}");
    }
}

fn assert_eliminated(linear: &Linearization, expected: &[(&str, ReducedKind, usize)]) {
    let found: Vec<(&str, ReducedKind, usize)> =
        linear.reduction.elements.iter().map(|e| (e.name.as_str(), e.kind, e.equations)).collect();
    assert_eq!(found, expected);
}

/// Pendulum geared to a disc by q₂ = r q₁: (J + r² J₂) q₁'' = −m g l q₁ + r τ₂.
#[test]
fn a_gear_adds_the_reflected_inertia_and_the_torque_times_the_ratio() {
    let (ratio, disc) = (-3.5, 0.03);
    for is_second_first in [false, true] {
        let wheel = "[[joint]]\nname = \"shaft\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nposition = [0.5, 0.0, 0.0]\n\
                     motor = { mode = \"torque\" }\n[[body]]\nname = \"disc\"\nparent = \"/shaft\"\nmass = 1.0\n\
                     inertia = { xx = 0.03, yy = 0.03, zz = 0.03 }\n";
        let hanging = pendulum("/", "");
        let gear = format!("[[coupling]]\nname = \"gear\"\njoints = [\"/hinge\", \"/shaft\"]\nratio = {ratio:?}\n");
        let scene = if is_second_first { [wheel, &hanging, &gear].concat() } else { [&hanging, wheel, &gear].concat() };
        let linear = linearized(&scene, &["/shaft"], &["/hinge.position", "/shaft.position"]);
        let inertia = J + ratio * ratio * disc;
        assert_swings(&linear, M * G * L / inertia, 0);
        assert_eliminated(&linear, &[("/gear", ReducedKind::Loop, 1)]);
        assert_eq!((linear.reduction.rank, linear.reduction.holonomic_rank), (1, 1));
        // static: m g l q₁ = r τ₂
        for (output, factor) in [(0, 1.0), (1, ratio)] {
            let expected = factor * ratio / (M * G * L);
            let gain = linear.system.gain(0, output).unwrap();
            assert!((gain - expected).abs() < 1e-11 * expected.abs(), "{gain} {expected}");
        }
    }
}

#[test]
fn a_velocity_motor_moves_the_other_wheel_of_its_gear() {
    let wheel = |name: &str, x: f64, motor: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nposition = [{x:?}, 0.0, 0.0]\n{motor}\
             [[body]]\nname = \"disc\"\nparent = \"/{name}\"\nmass = 1.0\ninertia = {{ xx = 0.03, yy = 0.03, zz = 0.03 }}\n"
        )
    };
    let scene = wheel("a", 0.0, "motor = { mode = \"velocity\" }\n")
        + &wheel("b", 0.5, "")
        + "[[coupling]]\nname = \"gear\"\njoints = [\"/a\", \"/b\"]\nratio = 2.5\noffset = 0.0\n";
    let linear = linearized(&scene, &["/a"], &["/a.velocity", "/b.velocity", "/b.position"]);
    assert_eq!(linear.system.n_states(), 1);
    assert_eliminated(&linear, &[("/gear", ReducedKind::Loop, 1), ("/a", ReducedKind::MotorInput, 1)]);
    assert!((linear.system.d[(0, 0)] - 1.0).abs() < 1e-13 && (linear.system.d[(1, 0)] - 2.5).abs() < 1e-13);
    let rate = linear.system.c[(2, 0)] * linear.system.b[(0, 0)];
    assert!((rate - 2.5).abs() < 1e-13 && linear.system.a[(0, 0)] == 0.0, "{rate}");
}

/// On a rail that friction holds, a pendulum swings about a fixed pivot, and no force on the cart moves it.
#[test]
fn a_joint_stuck_in_friction_is_held() {
    let scene = cart("friction = 2.0\nmotor = { mode = \"torque\" }\n") + &pendulum("/rail/cart", "");
    let linear = linearized(&scene, &["/rail"], &["/rail.position", "/rail/cart/hinge.position"]);
    assert_swings(&linear, M * G * L / J, 0);
    assert_eliminated(&linear, &[("/rail", ReducedKind::Stuck, 1)]);
    assert!(linear.system.b.iter().all(|x| *x == 0.0) && linear.system.d.iter().all(|x| *x == 0.0));
    // sliding it is not held: 4 states, and the friction does not depend on the speed
    let sliding = cart("friction = 2.0\ninitial = { velocity = 1.0 }\n") + &pendulum("/rail/cart", "");
    let linear = linearized(&sliding, &[], &[]);
    assert_eq!((linear.system.n_states(), linear.reduction.elements.len()), (4, 0));
}

/// Pressed against the end of its rail a cart does not move, but for a force that pulls it away.
#[test]
fn a_joint_pressed_against_a_limit_is_held() {
    let slope = 0.3;
    let (s, c) = sin_cos(slope);
    let gravity = format!("gravity = [{:?}, 0.0, {:?}]\n", G * s, -G * c);
    let scene = gravity
        + &cart("limits = { upper = 0.0 }\nmotor = { mode = \"torque\" }\n")
        + &pendulum("/rail/cart", &format!("initial = {{ position = {slope:?} }}\n"));
    let linear = linearized(&scene, &["/rail"], &["/rail.position", "/rail/cart/hinge.position"]);
    assert!(linear.drift() < 1e-12, "{:?}", linear.rate);
    assert_swings(&linear, M * G * L / J, 0);
    assert_eliminated(&linear, &[("/rail", ReducedKind::AtLimit, 1)]);
    assert!(linear.system.b.iter().all(|x| x.abs() < 1e-14));
}

/// On a stack of two boxes that stick: fixed pivot. The three horizontal coordinates of each box stay, as states on
/// which nothing depends: sticking is no equation of positions.
#[test]
fn a_stack_that_sticks_is_held() {
    let box_at = |name: &str, z: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"free\"\ninitial = {{ position = [0.0, 0.0, {z:?}, 1.0, 0.0, 0.0, 0.0] }}\n\
             [[body]]\nname = \"block\"\nparent = \"/{name}\"\nmass = 4.0\nshape = [ {{ cuboid = {{ size = [0.6, 0.5, 0.4] }} }} ]\n\
             contact = {{ friction = 0.7 }}\n"
        )
    };
    let scene = "[[body]]\nname = \"floor\"\nshape = [ { plane = {} } ]\ncontact = { friction = 0.7 }\n".to_owned()
        + &box_at("a", 0.2)
        + &box_at("b", 0.6)
        + &pendulum("/b", "");
    let linear = linearized(&scene, &[], &["/b/hinge.position"]);
    let (found, zeros) = poles(&linear);
    assert_eq!((found.len(), zeros), (2, 6), "{found:?} {:?}", linear.reduction.words());
    let size = (M * G * L / J).sqrt();
    assert!(found.iter().all(|p| (p.im.abs() - size).abs() < 1e-9 * size && p.re.abs() < 1e-9 * size), "{found:?}");
    // 6 of 12 + 1 coordinates, all of 12 + 1 speeds but one
    assert_eq!((linear.reduction.holonomic_rank, linear.reduction.rank), (6, 12));
    let kinds: Vec<ReducedKind> = linear.reduction.elements.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [ReducedKind::Contact, ReducedKind::Contact, ReducedKind::Sticking, ReducedKind::Sticking]);
}

/// Pendulum on a cart driven at the velocity u: J q'' = −m g l q − m l u', so q/u = −m l s/(J s² + m g l).
#[test]
fn a_pendulum_follows_the_velocity_of_its_pivot() {
    let scene = cart("motor = { mode = \"velocity\" }\n") + &pendulum("/rail/cart", "");
    let linear =
        linearized(&scene, &["/rail"], &["/rail/cart/hinge.position", "/rail/cart/hinge.velocity", "/rail.velocity"]);
    assert_swings(&linear, M * G * L / J, 1);
    assert_eliminated(&linear, &[("/rail", ReducedKind::MotorInput, 1)]);
    for omega in [0.3, 2.0, 4.7, 30.0] {
        let s = Complex::new(0.0, omega);
        // a positive angle moves the bob to +x, a jump of the pivot to +x leaves it behind
        let angle = s * (-M * L) / (s * s * J + M * G * L);
        for (output, expected) in [(0, angle), (1, angle * s), (2, Complex::new(1.0, 0.0))] {
            let found = linear.system.frequency_response(0, output, &[omega])[0];
            let error = hypot(found.re - expected.re, found.im - expected.im).0;
            assert!(error < 1e-11 * (1.0 + hypot(expected.re, expected.im).0), "{omega}, {output}: {found} {expected}");
        }
    }
    // a motor that is no input holds its joint
    let driven = cart("motor = { mode = \"velocity\" }\n") + &pendulum("/rail/cart", "motor = { mode = \"torque\" }\n");
    let linear = linearized(&driven, &["/rail/cart/hinge"], &[]);
    assert_swings(&linear, M * G * L / J, 0);
    assert_eliminated(&linear, &[("/rail", ReducedKind::HeldMotor, 1)]);
}

/// A position motor without bound follows q' = kp (u − q).
#[test]
fn a_position_motor_is_a_lag() {
    let scene = cart("motor = { mode = \"position\", kp = 7.0, max_velocity = 100.0 }\n") + &pendulum("/rail/cart", "");
    let linear = linearized(&scene, &["/rail"], &["/rail.position"]);
    let (found, _) = poles(&linear);
    assert!(found.iter().any(|p| (p.re + 7.0).abs() < 1e-9 && p.im.abs() < 1e-12), "{found:?}");
    assert_eq!(found.len(), 3, "{found:?}");
    assert!((linear.system.gain(0, 0).unwrap() - 1.0).abs() < 1e-12);
}

/// Slider-crank driven at the crank: x = r cos θ + √(l² − r² sin² θ), and no state but the angle.
#[test]
fn a_driven_crank_gives_the_velocity_of_its_slider() {
    let (r, l, theta) = (0.1, 0.3, 0.8);
    let (s, c) = sin_cos(theta);
    let root = f64::sqrt(l * l - r * r * s * s);
    let pin = -theta - atan2(r * s, root).0;
    let body = |parent: &str, mass: f64, x: f64| {
        format!(
            "[[body]]\nname = \"link\"\nparent = \"{parent}\"\nmass = {mass:?}\ncenter_of_mass = [{x:?}, 0.0, 0.0]\n\
             inertia = {{ xx = 0.001, yy = 0.001, zz = 0.001 }}\n"
        )
    };
    let scene = format!(
        "[[joint]]\nname = \"crank\"\nkind = \"revolute\"\naxis = [0.0, -1.0, 0.0]\ninitial = {{ position = {theta:?} }}\n\
         motor = {{ mode = \"velocity\" }}\n{}\
         [[joint]]\nname = \"pin\"\nkind = \"revolute\"\nparent = \"/crank\"\nposition = [{r:?}, 0.0, 0.0]\naxis = [0.0, -1.0, 0.0]\n\
         initial = {{ position = {pin:?} }}\n{}\
         [[joint]]\nname = \"slide\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\ninitial = {{ position = {:?} }}\n{}\
         [[frame]]\nname = \"end\"\nparent = \"/crank/pin\"\nposition = [{l:?}, 0.0, 0.0]\n[[frame]]\nname = \"eye\"\nparent = \"/slide\"\n\
         [[closure]]\nname = \"wrist\"\nkind = \"point\"\nbetween = [\"/crank/pin/end\", \"/slide/eye\"]\n",
        body("/crank", 0.4, 0.05),
        body("/crank/pin", 0.6, 0.15),
        r * c + root,
        body("/slide", 0.5, 0.0)
    );
    let linear = linearized(&scene, &["/crank"], &["/slide.velocity", "/slide.position"]);
    let slope = -r * s - r * r * s * c / root;
    assert_eq!(linear.system.n_states(), 1, "{:?}", linear.reduction.words());
    assert!((linear.system.d[(0, 0)] - slope).abs() < 1e-12, "{} {slope}", linear.system.d);
    // whichever coordinate is the state
    let rate = linear.system.c[(1, 0)] * linear.system.b[(0, 0)] + linear.system.d[(1, 0)];
    assert!((rate - slope).abs() < 1e-12, "{rate} {slope}");
}
