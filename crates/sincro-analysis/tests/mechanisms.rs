//! Linearisation, trim and regulators of mechanisms with closed loops, against equations of one degree of freedom that
//! are derived here from positions alone.

use sincro_analysis::linear::{Complex, DMatrix, DVector, lqr};
use sincro_analysis::linearize::{Linearization, Request, TrimRequest, Trimmed, linearize, operating_point, trim};
use sincro_dynamics::initial;
use sincro_math::elementary::sin_cos;
use sincro_math::random::SplitMix64;
use sincro_sim::Loaded;
use sincro_sim::run::LockStep;
use sincro_testing::SceneFolder;

/// Derivative of a function of one variable.
type Differentiation<'a> = &'a dyn Fn(&dyn Fn(f64) -> f64) -> f64;

/// Speed [m/s], its four eigenvalues (real, imaginary) [1/s], and the number of printed digits.
type Published = (f64, [(f64, f64); 4], i32);

const G: f64 = 9.81;

/// Rotation of the world: roll, pitch and yaw in degrees, and its matrix.
#[derive(Clone, Copy)]
struct Turn {
    rpy_deg: [f64; 3],
    matrix: [[f64; 3]; 3],
}

impl Turn {
    fn of(rpy_deg: [f64; 3]) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = rpy_deg.map(|a| sin_cos(a.to_radians()));
        let matrix = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ];
        Self { rpy_deg, matrix }
    }

    fn of_vector(&self, v: [f64; 3]) -> [f64; 3] {
        self.matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }
}

fn list(v: [f64; 3]) -> String {
    format!("[{:?}, {:?}, {:?}]", v[0], v[1], v[2])
}

/// A body of a scene with its joint; children name their parent.
struct Link {
    joint: &'static str,
    parent: &'static str,
    kind: &'static str,
    position: [f64; 3],
    axis: [f64; 3],
    start: f64,
    mass: f64,
    com: [f64; 3],
    inertia: [f64; 3],
    more: &'static str,
}

fn scene(links: &[Link], rest: &str, gravity: [f64; 3], turn: Turn) -> String {
    let mut text = format!("gravity = {}\n", list(turn.of_vector(gravity)));
    for link in links {
        let (position, rotation) = match link.parent {
            "" => (turn.of_vector(link.position), format!("rotation_deg = {}\n", list(turn.rpy_deg))),
            _ => (link.position, format!("parent = \"{}\"\n", link.parent)),
        };
        text += &format!(
            "[[joint]]\nname = \"{}\"\nkind = \"{}\"\n{rotation}position = {}\naxis = {}\n{}initial = {{ position = {:?} }}\n",
            link.joint,
            link.kind,
            list(position),
            list(link.axis),
            link.more,
            link.start
        );
        let [xx, yy, zz] = link.inertia;
        text += &format!(
            "[[body]]\nname = \"link\"\nparent = \"{}/{}\"\nmass = {:?}\ncenter_of_mass = {}\ninertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {zz:?} }}\n",
            link.parent,
            link.joint,
            link.mass,
            list(link.com)
        );
    }
    text + rest
}

fn folder(scene: &str) -> SceneFolder {
    let experiment =
        "title = \"t\"\nscene = \"scene.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"energy.balance\"]\n";
    SceneFolder::of(scene, experiment)
}

fn frame(name: &str, parent: &str, position: [f64; 3]) -> String {
    format!("[[frame]]\nname = \"{name}\"\nparent = \"{parent}\"\nposition = {}\n", list(position))
}

const ROD: f64 = 1.0 / 12.0;

/// Two four-bar linkages in a row, all bars 1 m and 1 kg; gravity along −y.
fn four_bar(start: f64, turn: Turn, is_reversed: bool, motor: &'static str) -> SceneFolder {
    let bar = |joint, parent, position, start, com, inertia, more| Link {
        joint,
        parent,
        kind: "revolute",
        position,
        axis: [0.0, 0.0, 1.0],
        start,
        mass: 1.0,
        com,
        inertia,
        more,
    };
    let upright = |joint, x, more| bar(joint, "", [x, 0.0, 0.0], start, [0.0, 0.5, 0.0], [ROD, 1e-4, ROD], more);
    let across = |joint, parent| bar(joint, parent, [0.0, 1.0, 0.0], -start, [0.5, 0.0, 0.0], [1e-4, ROD, ROD], "");
    let mut links = vec![
        upright("v0", 0.0, motor),
        across("h0", "/v0"),
        upright("v1", 1.0, ""),
        across("h1", "/v1"),
        upright("v2", 2.0, ""),
    ];
    if is_reversed {
        links.rotate_left(4);
        links.swap(1, 3);
        links.swap(2, 4);
    }
    let rest = frame("end", "/v0/h0", [1.0, 0.0, 0.0])
        + &frame("end", "/v1/h1", [1.0, 0.0, 0.0])
        + &frame("top", "/v1", [0.0, 1.0, 0.0])
        + &frame("top", "/v2", [0.0, 1.0, 0.0])
        + "[[closure]]\nname = \"pin0\"\nkind = \"hinge\"\nbetween = [\"/v0/h0/end\", \"/v1/top\"]\n"
        + "[[closure]]\nname = \"pin1\"\nkind = \"hinge\"\nbetween = [\"/v1/h1/end\", \"/v2/top\"]\n";
    folder(&scene(&links, &rest, [0.0, -G, 0.0], turn))
}

/// Crank of 0.1 m, rod of 0.3 m, slider along x; gravity along −z; a crank angle of −π/2 hangs.
///
/// `order` is that of the crank (0), the rod (1) and the slider (2) in the file.
fn slider_crank_in(order: [usize; 3], crank: f64, turn: Turn) -> SceneFolder {
    let (s, c) = sin_cos(crank);
    let sin_rod = -0.1 * s / 0.3;
    let rod = sincro_math::elementary::atan2(sin_rod, (1.0 - sin_rod * sin_rod).sqrt()).0;
    let x = 0.1 * c + (0.09 - 0.01 * s * s).sqrt();
    let link = |joint, parent, kind, position, axis, start, mass, com, i: f64| Link {
        joint,
        parent,
        kind,
        position,
        axis,
        start,
        mass,
        com,
        inertia: [i, i, i],
        more: "",
    };
    let up = [0.0, -1.0, 0.0]; // a positive angle turns x towards z
    let links = [
        link("crank", "", "revolute", [0.0; 3], up, crank, 0.4, [0.05, 0.0, 0.0], 4e-4),
        link("pin", "/crank", "revolute", [0.1, 0.0, 0.0], up, rod - crank, 0.6, [0.15, 0.0, 0.0], 4.6e-3),
        link("slide", "", "prismatic", [0.0; 3], [1.0, 0.0, 0.0], x, 0.5, [0.0; 3], 1e-4),
    ];
    let [a, b, c] = links;
    let mut links = [Some(a), Some(b), Some(c)];
    let links = order.map(|k| links[k].take().expect("each once"));
    let rest = frame("end", "/crank/pin", [0.3, 0.0, 0.0])
        + &frame("eye", "/slide", [0.0; 3])
        + "[[closure]]\nname = \"wrist\"\nkind = \"point\"\nbetween = [\"/crank/pin/end\", \"/slide/eye\"]\n";
    folder(&scene(&links, &rest, [0.0, 0.0, -G], turn))
}

fn slider_crank(crank: f64, turn: Turn) -> SceneFolder {
    slider_crank_in([0, 1, 2], crank, turn)
}

/// Rod of Bricard's mechanism, of 1 kg, on a hinge at its zero.
fn bricard_rod(
    joint: &'static str,
    parent: &'static str,
    position: [f64; 3],
    axis: [f64; 3],
    com: [f64; 3],
    inertia: [f64; 3],
) -> Link {
    Link { joint, parent, kind: "revolute", position, axis, start: 0.0, mass: 1.0, com, inertia, more: "" }
}

/// Bricard's mechanism (IFToMM A04): five rods, six hinges at right angles; gravity along −y.
fn bricard(turn: Turn) -> SceneFolder {
    let (l, t) = (1.0 / 600.0, 1.01 / 12.0);
    let rod = bricard_rod;
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let links = [
        rod("j0", "", [0.0; 3], y, [0.5, 0.0, 0.0], [l, t, t]),
        rod("j1", "/j0", x, z, [0.0, -0.5, 0.0], [t, l, t]),
        rod("j2", "/j0/j1", [0.0, -1.0, 0.0], x, [0.0, 0.0, 0.5], [t, t, l]),
        rod("j3", "/j0/j1/j2", z, y, [-0.5, 0.0, 0.0], [l, t, t]),
        rod("j4", "/j0/j1/j2/j3", [-1.0, 0.0, 0.0], z, [0.0, 0.5, 0.0], [t, l, t]),
    ];
    let ground = format!(
        "[[frame]]\nname = \"P5\"\nposition = {}\nrotation_deg = {}\n",
        list(turn.of_vector(z)),
        list(turn.rpy_deg)
    );
    let rest = frame("P5", "/j0/j1/j2/j3/j4", y)
        + &ground
        + "[[closure]]\nname = \"ring\"\nkind = \"hinge\"\naxis = [1.0, 0.0, 0.0]\nbetween = [\"/j0/j1/j2/j3/j4/P5\", \"/P5\"]\n";
    folder(&scene(&links, &rest, [0.0, -G, 0.0], turn))
}

/// The same mechanism with the tree from the other end: what closes the ring is the first joint.
fn bricard_reversed(turn: Turn) -> SceneFolder {
    let (l, t) = (1.0 / 600.0, 1.01 / 12.0);
    let rod = bricard_rod;
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let links = [
        rod("r5", "", z, x, [0.0, -0.5, 0.0], [t, l, t]),
        rod("r4", "/r5", [0.0, -1.0, 0.0], z, [0.5, 0.0, 0.0], [l, t, t]),
        rod("r3", "/r5/r4", x, y, [0.0, 0.0, -0.5], [t, t, l]),
        rod("r2", "/r5/r4/r3", [0.0, 0.0, -1.0], x, [0.0, 0.5, 0.0], [t, l, t]),
        rod("r1", "/r5/r4/r3/r2", y, z, [-0.5, 0.0, 0.0], [l, t, t]),
    ];
    let rest = frame("P0", "/r5/r4/r3/r2/r1", [-1.0, 0.0, 0.0])
        + &format!("[[frame]]\nname = \"P0\"\nrotation_deg = {}\n", list(turn.rpy_deg))
        + "[[closure]]\nname = \"ring\"\nkind = \"hinge\"\naxis = [0.0, 1.0, 0.0]\nbetween = [\"/r5/r4/r3/r2/r1/P0\", \"/P0\"]\n";
    folder(&scene(&links, &rest, [0.0, -G, 0.0], turn))
}

fn loaded(folder: &SceneFolder, set: &[&str]) -> Loaded {
    folder.load(set).unwrap_or_else(|message| panic!("{message}"))
}

fn linearized(folder: &SceneFolder) -> Linearization {
    let loaded = loaded(folder, &[]);
    let at = operating_point(&loaded, 0.0).unwrap();
    linearize(&loaded, &at, &Request::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn trimmed(loaded: &Loaded) -> Trimmed {
    let at = operating_point(loaded, 0.0).unwrap();
    trim(loaded, &at, &TrimRequest::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn poles(linear: &Linearization) -> Vec<Complex<f64>> {
    linear.system.poles().iter().map(|mode| mode.pole).collect()
}

fn modulus(z: Complex<f64>) -> f64 {
    sincro_math::elementary::hypot(z.re, z.im).0
}

/// The poles are ±√`square`, and there are no others.
fn assert_poles(linear: &Linearization, square: f64) {
    let found = poles(linear);
    assert_eq!(found.len(), 2, "{found:?} {:?}", linear.reduction);
    for pole in found {
        let (is, other) = if square > 0.0 { (pole.re, pole.im) } else { (pole.im, pole.re) };
        let size = square.abs().sqrt();
        assert!((is.abs() - size).abs() <= 1e-9 * size && other.abs() <= 1e-9 * size, "{pole} {size}");
    }
}

/// The parallelograms turn as one: T = ½·(3·⅓ + 2)·θ'², V = (3·½ + 2)·g·cos θ.
const FOUR_BAR: f64 = 3.5 * G / 3.0;

const TURNS: [[f64; 3]; 3] = [[0.0; 3], [31.0, -47.0, 112.0], [-140.0, 20.0, 75.0]];

/// The fixed rotations, and others drawn at random with a fixed seed.
fn turns(n_random: usize) -> impl Iterator<Item = Turn> {
    let mut random = SplitMix64::new(17);
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.unit();
    let drawn: Vec<[f64; 3]> =
        (0..n_random).map(|_| [uniform(-180.0, 180.0), uniform(-89.0, 89.0), uniform(-180.0, 180.0)]).collect();
    TURNS.into_iter().chain(drawn).map(Turn::of)
}

#[test]
fn a_four_bar_has_the_poles_of_its_one_degree_of_freedom() {
    for turn in turns(5) {
        for is_reversed in [false, true] {
            let hanging = linearized(&four_bar(core::f64::consts::PI, turn, is_reversed, ""));
            assert_poles(&hanging, -FOUR_BAR);
            assert_poles(&linearized(&four_bar(0.0, turn, is_reversed, "")), FOUR_BAR);
            let words = hanging.reduction.words().join("\n");
            assert!(words.contains("closed loops and gears: `/pin0`, `/pin1` (10 equations)"), "{words}");
            assert_eq!((hanging.reduction.rank, hanging.reduction.holonomic_rank), (4, 4));
        }
    }
}

/// Pole squared of a mechanism of one degree of freedom at an equilibrium `at`: −V″/m, from the positions of points
/// with mass and the rotations of bodies, by differences of eighth order.
fn pole_squared(
    at: f64,
    potential: impl Fn(f64) -> f64,
    inertia: impl Fn(&dyn Fn(&dyn Fn(f64) -> f64) -> f64) -> f64,
) -> f64 {
    let h = 0.02;
    let second = |f: &dyn Fn(f64) -> f64| {
        let c = [-205.0 / 72.0, 8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0];
        let pair = |k: usize| f(at + k as f64 * h) + f(at - k as f64 * h);
        (c[0] * f(at) + (1..5).map(|k| c[k] * pair(k)).sum::<f64>()) / (h * h)
    };
    let first = |f: &dyn Fn(f64) -> f64| {
        let c = [0.0, 4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
        (1..5).map(|k| c[k] * (f(at + k as f64 * h) - f(at - k as f64 * h))).sum::<f64>() / h
    };
    -second(&potential) / inertia(&first)
}

#[test]
fn a_slider_crank_has_the_poles_of_its_one_degree_of_freedom() {
    // T = ½·(J + m₁r²/4 + (m₂ + m₃)·r²)·θ'² where the crank hangs, V = ½·g·r·(m₁ + m₂)·sin θ
    let (r, m1, m2, m3, j) = (0.1, 0.4, 0.6, 0.5, 4e-4);
    let inertia = j + m1 * r * r / 4.0 + (m2 + m3) * r * r;
    let square = -0.5 * G * r * (m1 + m2) / inertia;
    // the rod is on the crank, so it comes after it
    let orders = [[0, 1, 2], [2, 0, 1], [0, 2, 1]];
    for (k, turn) in turns(6).enumerate() {
        let order = orders[k % 3];
        assert_poles(&linearized(&slider_crank_in(order, -core::f64::consts::FRAC_PI_2, turn)), square);
        assert_poles(&linearized(&slider_crank_in(order, core::f64::consts::FRAC_PI_2, turn)), -square);
        // from elsewhere trim finds it
        let loaded = loaded(&slider_crank_in(order, -1.1, turn), &[]);
        let found = trimmed(&loaded);
        let crank = found.trim.states.iter().find(|(axis, _)| axis.name == "/crank.position").unwrap().1;
        assert!((crank + core::f64::consts::FRAC_PI_2).abs() < 1e-9, "{crank}");
        assert!(initial::constraint_residuals(&loaded.scene.model, found.at.state())[0].distance < 1e-12);
        assert_poles(&linearize(&loaded, &found.at, &Request::default()).unwrap(), square);
    }
}

type Matrix = [[f64; 3]; 3];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn times(a: &Matrix, v: [f64; 3]) -> [f64; 3] {
    a.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn rotation(axis: usize, angle: f64) -> Matrix {
    let (s, c) = sin_cos(angle);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = [[0.0; 3]; 3];
    m[axis][axis] = 1.0;
    (m[i][i], m[j][j], m[i][j], m[j][i]) = (c, c, -s, s);
    m
}

/// Orientations of the five rods of Bricard's mechanism, starts of the rods, and the residual of the last hinge.
fn bricard_chain(angles: &[f64]) -> ([Matrix; 5], [[f64; 3]; 6], Vec<f64>) {
    let axes = [1, 2, 0, 1, 2];
    let rods = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut turned = rotation(0, 0.0);
    let mut orientations = [turned; 5];
    let mut points = [[0.0; 3]; 6];
    for k in 0..5 {
        turned = product(&turned, &rotation(axes[k], angles[k]));
        orientations[k] = turned;
        let rod = times(&turned, rods[k]);
        points[k + 1] = core::array::from_fn(|i| points[k][i] + rod[i]);
    }
    let axis = times(&turned, [1.0, 0.0, 0.0]);
    let p = points[5];
    (orientations, points, vec![p[0], p[1], p[2] - 1.0, axis[1], axis[2]])
}

/// The other angles for a first angle, by Gauss–Newton's method from near ones.
fn bricard_angles(first: f64, near: &[f64]) -> Vec<f64> {
    let mut angles = near.to_vec();
    angles[0] = first;
    for _ in 0..50 {
        let residual = DVector::from_vec(bricard_chain(&angles).2);
        let column = |k: usize| {
            let at = |by: f64| {
                let mut moved = angles.clone();
                moved[k] += by;
                DVector::from_vec(bricard_chain(&moved).2)
            };
            (at(1e-6) - at(-1e-6)) / 2e-6
        };
        let jacobian = DMatrix::from_columns(&(1..5).map(column).collect::<Vec<_>>());
        let step = jacobian.svd(true, true).solve(&residual, 1e-6).unwrap();
        for k in 1..5 {
            angles[k] -= step[k - 1];
        }
    }
    angles
}

#[test]
fn bricards_mechanism_has_the_poles_of_its_one_degree_of_freedom() {
    let loaded = loaded(&bricard(Turn::of([0.0; 3])), &[]);
    let found = trimmed(&loaded);
    let opening = &initial::constraint_residuals(&loaded.scene.model, found.at.state())[0];
    assert!(opening.distance < 1e-11 && opening.angle < 1e-11, "{opening:?}");
    let linear = linearize(&loaded, &found.at, &Request::default()).unwrap();
    let start: Vec<f64> = found.at.state().q.clone();
    let angles = |first: f64| {
        // in small steps, so that the branch stays
        let n = 1 + ((first - start[0]).abs() / 0.01) as usize;
        (1..=n)
            .fold(start.clone(), |near, k| bricard_angles(start[0] + (first - start[0]) * k as f64 / n as f64, &near))
    };
    let middle = |points: &[[f64; 3]; 6], k: usize, i: usize| 0.5 * (points[k][i] + points[k + 1][i]);
    let potential = |first: f64| {
        let points = bricard_chain(&angles(first)).1;
        (0..5).map(|k| G * middle(&points, k, 1)).sum()
    };
    let inertia = |derivative: Differentiation<'_>| {
        let (along, across) = (1.0 / 600.0, 1.01 / 12.0);
        let now = bricard_chain(&start).0;
        let mut sum = 0.0;
        for k in 0..5 {
            for i in 0..3 {
                sum += derivative(&|first| middle(&bricard_chain(&angles(first)).1, k, i)).powi(2);
            }
            // ω from R' Rᵀ, into the axes of the rod
            let rate: Matrix = core::array::from_fn(|i| {
                core::array::from_fn(|j| derivative(&|first| bricard_chain(&angles(first)).0[k][i][j]))
            });
            let transposed: Matrix = core::array::from_fn(|i| core::array::from_fn(|j| now[k][j][i]));
            let spin = product(&transposed, &rate);
            let w = [spin[2][1], spin[0][2], spin[1][0]];
            let own = [0, 1, 2, 0, 1][k];
            sum += (0..3).map(|i| if i == own { along } else { across } * w[i] * w[i]).sum::<f64>();
        }
        sum
    };
    let square = pole_squared(start[0], potential, inertia);
    assert_poles(&linear, square);
    assert_eq!(linear.reduction.rank, 4);

    // turned in space, and with the tree from the other end, it is the same mechanism
    let energy = |run: &LockStep| run.fork().lockstep.world().energy().potential;
    for turn in turns(8) {
        for folder in [bricard(turn), bricard_reversed(turn)] {
            let loaded = self::loaded(&folder, &[]);
            let turned = trimmed(&loaded);
            assert!((energy(&turned.at) - energy(&found.at)).abs() < 1e-9, "{:?}", turn.rpy_deg);
            let opening = &initial::constraint_residuals(&loaded.scene.model, turned.at.state())[0];
            assert!(opening.distance < 1e-10 && opening.angle < 1e-10, "{opening:?}");
            let linear = linearize(&loaded, &turned.at, &Request::default()).unwrap();
            assert_poles(&linear, square);
        }
    }
}

/// A scene can be started from every state that trim finds.
#[test]
fn trimmed_states_are_accepted_as_starts() {
    let folder = slider_crank(-0.4, Turn::of([0.0; 3]));
    let found = trimmed(&loaded(&folder, &[]));
    let set: Vec<String> = ["/crank", "/crank/pin", "/slide"]
        .iter()
        .zip(&found.trim.states)
        .map(|(joint, (_, x))| format!("{joint}.initial.position={x:?}"))
        .collect();
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    let again = loaded(&folder, &set);
    let at = operating_point(&again, 0.0).unwrap();
    let once_more = trim(&again, &at, &TrimRequest::default()).unwrap();
    assert_eq!(once_more.trim.iterations, 0);
}

/// The regulator of the reduced system holds the upright four-bar in a run of the scene with the gain in its diagram,
/// whatever its place in space and the order of its bodies.
#[test]
fn a_regulator_stabilises_the_upright_four_bar() {
    let motor = "motor = { mode = \"torque\" }\n";
    let mut gains: Vec<[f64; 2]> = Vec::new();
    for (turn, is_reversed) in turns(4).zip([false, true].into_iter().cycle()) {
        let linear = linearized(&four_bar(0.0, turn, is_reversed, motor));
        let system = &linear.system;
        // independent is the first bar in the file
        let [position, velocity] = [0, 1].map(|k| system.states[k].name.clone());
        assert!(position.ends_with(".position") && velocity.ends_with(".velocity") && system.n_states() == 2);
        let weights = DMatrix::from_diagonal(&DVector::from_column_slice(&[10.0, 1.0]));
        let design = lqr(&system.a, &system.b, &weights, &DMatrix::from_element(1, 1, 0.1)).unwrap();
        gains.push([design.k[0], design.k[1]]);
        let folder = four_bar(0.05, turn, is_reversed, motor);
        folder.write(
            "diagram.toml",
            &format!(
                "wires = [\"[{position}, {velocity}] -> feedback -> /v0\"]\n[[block]]\nname = \"feedback\"\ntype = \"matrix-gain\"\nunit = \"N·m\"\ngain = [[{:?}, {:?}]]\n",
                -design.k[0], -design.k[1]
            ),
        );
        folder.write(
            "experiment.toml",
            "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 6.0\nstep = 0.01\nrecord = [\"/v0.position\"]\n",
        );
        let loaded = loaded(&folder, &[]);
        let mut run = operating_point(&loaded, 6.0).unwrap();
        assert!(run.state().q.iter().all(|q| q.abs() < 1e-3), "{:?}", run.state().q);
        assert!(run.world().statistics().fallback_steps == 0);
    }
    // all bars turn as one: the same equation and the same regulator
    for gain in &gains {
        assert!((0..2).all(|k| (gain[k] - gains[0][k]).abs() < 1e-7 * gains[0][k].abs()), "{gains:?}");
    }
}

/// Benchmark bicycle: rear frame on a free joint, wheels as discs that roll without slipping. Published eigenvalues:
/// key `meijaard2007`, table 2.
fn bicycle(speed: f64) -> SceneFolder {
    let (s, c) = sin_cos(core::f64::consts::PI / 10.0);
    let wheel = |name: &str, parent: &str, position: [f64; 3], radius: f64, mass: f64, xx: f64, yy: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nparent = \"{parent}\"\nposition = {}\naxis = [0.0, 1.0, 0.0]\n\
             initial = {{ velocity = {:?} }}\n[[body]]\nname = \"wheel\"\nparent = \"{parent}/{name}\"\nmass = {mass:?}\n\
             inertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {xx:?} }}\n\
             shape = [ {{ cylinder = {{ radius = {radius:?}, length = 1e-30 }}, rotation_deg = [90.0, 0.0, 0.0] }} ]\n\
             contact = {{ friction = 1.0 }}\n",
            list(position),
            speed / radius
        )
    };
    let text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[[body]]\nname = \"ground\"\nshape = [ {{ plane = {{}} }} ]\ncontact = {{ friction = 1.0 }}\n\
         [[joint]]\nname = \"frame\"\nkind = \"free\"\ninitial = {{ position = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], velocity = [0.0, 0.0, 0.0, {speed:?}, 0.0, 0.0] }}\n\
         [[body]]\nname = \"rider\"\nparent = \"/frame\"\nmass = 85.0\ncenter_of_mass = [0.3, 0.0, 0.9]\n\
         inertia = {{ xx = 9.2, yy = 11.0, zz = 2.8, xz = -2.4 }}\n\
         [[joint]]\nname = \"steer\"\nkind = \"revolute\"\nparent = \"/frame\"\nposition = [1.1, 0.0, 0.0]\naxis = {}\n\
         [[body]]\nname = \"fork\"\nparent = \"/frame/steer\"\nmass = 4.0\ncenter_of_mass = [-0.2, 0.0, 0.7]\n\
         inertia = {{ xx = 0.05892, yy = 0.06, zz = 0.00708, xz = 0.00756 }}\n",
        list([-s, 0.0, c])
    ) + &wheel("rear", "/frame", [0.0, 0.0, 0.3], 0.3, 2.0, 0.0603, 0.12)
        + &wheel("front", "/frame/steer", [-0.08, 0.0, 0.35], 0.35, 3.0, 0.1405, 0.28);
    folder(&text)
}

#[test]
fn the_bicycle_has_its_published_eigenvalues() {
    // (speed, eigenvalues, digits after the point)
    let published: [Published; 4] = [
        (
            0.0,
            [(-3.13164324790656, 0.0), (3.13164324790656, 0.0), (-5.53094371765393, 0.0), (5.53094371765393, 0.0)],
            14,
        ),
        (
            4.6,
            [
                (-13.29863951577, 0.0),
                (-0.62121272698, 0.0),
                (-0.37796622628, 3.87284191563),
                (-0.37796622628, -3.87284191563),
            ],
            11,
        ),
        (
            5.0,
            [
                (-14.07838969280, 0.0),
                (-0.322866429004, 0.0),
                (-0.775341882196, 4.464867713789),
                (-0.775341882196, -4.464867713789),
            ],
            11,
        ),
        (
            10.0,
            [
                (-24.62459635017, 0.0),
                (0.16105338653, 0.0),
                (-3.72016840437, 10.90681139476),
                (-3.72016840437, -10.90681139476),
            ],
            11,
        ),
    ];
    for (speed, expected, digits) in published {
        let linear = linearized(&bicycle(speed));
        let found: Vec<Complex<f64>> = poles(&linear).into_iter().filter(|p| modulus(*p) > 0.0).collect();
        assert_eq!(found.len(), 4, "{speed} m/s: {found:?}\n{:?}", linear.reduction.words());
        for (re, im) in expected {
            let nearest = found.iter().map(|p| modulus(p - Complex::new(re, im))).fold(f64::INFINITY, f64::min);
            eprintln!("{speed} m/s: {re} {im} differs by {nearest:.1e}");
            // half a unit of the last digit, and rounding of the computation
            assert!(
                nearest <= 0.71 * f64::powi(10.0, -digits) + 2e-13,
                "{speed} m/s: {re} {im}: {nearest:e} {found:?}"
            );
        }
    }
}
