//! Meshes and height fields: what they weigh, that they touch as the shapes they stand for, and what of them is
//! refused.

use std::fmt::Write;

use sincro_math::elementary::sin_cos;
use sincro_scene::scene::ObjectKind;
use sincro_sim::Loaded;
use sincro_sim::run::Simulated;
use sincro_testing::SceneFolder;

const G: f64 = 9.81;

/// Faces of a cuboid, counter-clockwise seen from outside; bit k of a corner's index says on which side of axis k it
/// is.
const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

fn corner(size: [f64; 3], k: usize) -> [f64; 3] {
    std::array::from_fn(|c| if k >> c & 1 == 0 { -0.5 * size[c] } else { 0.5 * size[c] })
}

fn triangles() -> impl Iterator<Item = [usize; 3]> {
    FACES.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])
}

/// A cuboid as OBJ, with quadrangles, and names and textures that say nothing.
fn obj(size: [f64; 3]) -> String {
    let mut text = "# a box\no box\n".to_owned();
    (0..8).map(|k| corner(size, k)).for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
    let face = |f: &[usize; 4]| f.map(|k| format!("{}/1/1", k + 1)).join(" ");
    FACES.iter().for_each(|f| writeln!(text, "f {}", face(f)).unwrap());
    text
}

/// The same as text STL.
fn text_stl(size: [f64; 3]) -> String {
    let mut text = "solid box\n".to_owned();
    for t in triangles() {
        text += "  facet normal 0 0 0\n    outer loop\n";
        t.map(|k| corner(size, k)).iter().for_each(|[x, y, z]| writeln!(text, "      vertex {x} {y} {z}").unwrap());
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid box\n"
}

/// The same as binary STL.
fn binary_stl(size: [f64; 3]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(12_u32.to_le_bytes());
    for t in triangles() {
        bytes.extend([0; 12]);
        t.iter().flat_map(|k| corner(size, *k)).for_each(|x| bytes.extend((x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn folder(scene: &str, record: &str, duration: f64, step: f64) -> SceneFolder {
    let folder = SceneFolder::new().with("scene.toml", scene);
    let experiment = format!(
        "title = \"Test\"\nscene = \"scene.toml\"\nduration = {duration}\nstep = {step}\naccuracy = 1e-10\nrecord = [{record}]\n"
    );
    folder.write("experiment.toml", &experiment);
    folder
}

fn ran(loaded: &Loaded) -> Simulated {
    sincro_testing::run(loaded)
}

fn values<'a>(run: &'a Simulated, name: &str) -> &'a [f64] {
    &run.table.column(name).unwrap_or_else(|| panic!("{name}")).values
}

/// A free body of one shape, over a floor.
fn body(shape: &str, start: &str, floor: &str) -> String {
    format!(
        "[[joint]]\nname = \"air\"\nkind = \"free\"\ninitial = {{ {start} }}\n\n[[body]]\nname = \"it\"\nparent = \"/air\"\n\
         density = 700.0\ncontact = {{ friction = 0.5 }}\nshape = [{{ {shape} }}]\n\n[[body]]\nname = \"floor\"\n\
         contact = {{ friction = 0.5 }}\n{floor}\n"
    )
}

const PLANE: &str = "shape = [{ plane = {} }]";

#[test]
fn a_cuboid_from_any_file_weighs_what_a_cuboid_does() {
    let size = [0.25, 0.5, 0.125]; // exact in single precision too
    let start = "position = [0, 0, 1, 1, 0, 0, 0]";
    let mass = |shape: &str| {
        let folder = folder(&body(shape, start, PLANE), "\"energy.total\"", 0.1, 0.1);
        // points and lines say nothing either
        folder.write("box.obj", &(obj(size) + "p 1\nl 1 2 4\n"));
        folder.write("box.stl", &text_stl(size));
        std::fs::write(folder.join("BINARY.STL"), binary_stl(size)).unwrap();
        folder.write("mm.obj", &obj(size.map(|x| x * 1000.0)));
        let scene = folder.load(&[]).unwrap().scene;
        match scene.object("/air/it").unwrap().kind {
            ObjectKind::Body { mass } => mass,
            _ => unreachable!("it is a body"),
        }
    };
    let exact = mass("cuboid = { size = [0.25, 0.5, 0.125] }");
    for shape in [
        "mesh = { file = \"box.obj\", convex = true }",
        "mesh = { file = \"box.stl\", convex = true }",
        "mesh = { file = \"BINARY.STL\", convex = true }",
        "mesh = { file = \"mm.obj\", scale = 0.001, convex = true }",
        "mesh = { file = \"mm.obj\", scale = [0.001, 0.001, 0.001], convex = true }",
    ] {
        let found = mass(shape);
        assert!((found.mass - exact.mass).abs() < 1e-13 * exact.mass, "{shape} {found:?}");
        for k in 0..6 {
            assert!((found.inertia[k] - exact.inertia[k]).abs() < 1e-13 * exact.inertia[3], "{shape} {found:?}");
        }
        assert!(found.center_of_mass.iter().all(|x| x.abs() < 1e-15), "{shape} {found:?}");
    }
}

#[test]
fn a_cube_of_triangles_slides_and_tips_as_a_cuboid() {
    // thrown flat over the floor: friction brakes it, it comes to rest
    let start = "position = [0, 0, 0.1, 1, 0, 0, 0], velocity = [0, 0, 0, 1.0, 0.5, 0]";
    let run = |shape: &str| {
        let folder = folder(
            &body(shape, start, PLANE),
            "\"/air.position.x\", \"/air.position.y\", \"/air.position.z\"",
            0.5,
            0.01,
        );
        folder.write("box.obj", &obj([0.4, 0.4, 0.2]));
        ran(&folder.load(&[]).unwrap())
    };
    let (solid, mesh) =
        (run("cuboid = { size = [0.4, 0.4, 0.2] }"), run("mesh = { file = \"box.obj\", convex = true }"));
    for name in ["/air.position.x", "/air.position.y", "/air.position.z"] {
        for (a, b) in values(&solid, name).iter().zip(values(&mesh, name)) {
            assert!((a - b).abs() < 1e-10, "{name} {a} {b}");
        }
    }
    // and as the closed form says: v²/(2·μ·g)
    let (x, y) = (values(&mesh, "/air.position.x"), values(&mesh, "/air.position.y"));
    let way = (x.last().unwrap().powi(2) + y.last().unwrap().powi(2)).sqrt();
    assert!((way - 1.25 / (2.0 * 0.5 * G)).abs() < 1e-9, "{way}");
}

/// A ball of 0.1 m at rest on a slope of 0.3 rad about y through the origin, and where its centre is.
fn ball_on_a_slope(floor: &str) -> String {
    let (s, c) = sin_cos(0.3);
    // a hair above, which rounding of the mesh's corners may take
    let r = 0.1 + 1e-12;
    let start = format!("position = [{}, 0, {}, 1, 0, 0, 0]", s * r - c * 0.7, c * r + s * 0.7);
    body("sphere = { radius = 0.1 }", &start, floor)
}

/// Rolling without slipping: s = 5/14·g·sin α·t².
fn rolls_down(run: &Simulated, tolerance: f64) {
    let (sin, cos) = sin_cos(0.3);
    for (k, x) in values(run, "/air.position.x").iter().enumerate() {
        let t = 0.01 * k as f64;
        let expected = sin * 0.1 - cos * (0.7 - 5.0 / 14.0 * G * sin * t * t);
        assert!((x - expected).abs() < tolerance, "{t} {x} {expected}");
    }
}

#[test]
fn a_ball_rolls_down_a_mesh_as_down_a_plane() {
    // its start is 0.7 m up the slope; the mesh is a block 4 m long that is tilted, its top in the origin
    let (record, tilt) = ("\"/air.position.x\"", 0.3_f64.to_degrees());
    let tilted = |shape: &str| format!("rotation_deg = [0, {tilt}, 0]\nshape = [{{ {shape} }}]");
    let plane = folder(&ball_on_a_slope(&tilted("plane = {}")), record, 0.8, 0.01);
    rolls_down(&ran(&plane.load(&[]).unwrap()), 1e-9);
    let mesh =
        folder(&ball_on_a_slope(&tilted("mesh = { file = \"box.obj\" }, position = [0, 0, -0.5]")), record, 0.8, 0.01);
    mesh.write("box.obj", &obj([4.0, 2.0, 1.0]));
    rolls_down(&ran(&mesh.load(&[]).unwrap()), 1e-8);
}

#[test]
fn a_ball_rolls_down_a_height_field_as_down_a_plane() {
    // 41 by 11 heights on the slope itself; rounding of the heights makes its cells meet at 1e-16 rad
    let (sin, cos) = sin_cos(0.3);
    let height = |i: usize| -((i as f64) * 0.1 - 2.0) * sin / cos;
    let row = (0..41).map(|i| format!("{}", height(i))).collect::<Vec<_>>().join(",");
    let rows = format!("# along x\n{row}\n").repeat(11);
    let floor = "shape = [{ height_field = { file = \"slope.csv\", size = [4.0, 1.0] } }]";
    let folder = folder(&ball_on_a_slope(floor), "\"/air.position.x\", \"/air.position.y\"", 0.8, 0.01);
    folder.write("slope.csv", &rows);
    let run = ran(&folder.load(&[]).unwrap());
    rolls_down(&run, 1e-8);
    assert!(values(&run, "/air.position.y").iter().all(|y| y.abs() < 1e-8));
}

#[test]
fn a_ball_swings_in_a_valley_with_the_period_and_the_amplitude_of_a_pendulum() {
    // a trough of radius 1 m along y, compliant so that its edges are no blows; the centre of a ball of 0.1 m that
    // slides swings on 0.9 m: from 0.1 rad the period is 2π√(l/g)·(1 + a²/16), and a quarter of it later it passes the
    // middle
    let (radius, r, a) = (1.0, 0.1, 0.1);
    let heights: Vec<String> = (0..401)
        .map(|i| {
            let x = (f64::from(i) * 0.001) - 0.2;
            format!("{}", radius - (radius * radius - x * x).sqrt())
        })
        .collect();
    let row = format!("[{}]", heights.join(","));
    let floor = format!("shape = [{{ height_field = {{ heights = [{row}, {row}], size = [0.4, 0.4] }} }}]");
    let l = radius - r;
    let (sin, cos) = sin_cos(a);
    let start = format!("position = [{}, 0, {}, 1, 0, 0, 0]", l * sin, radius - l * cos);
    let scene = body("sphere = { radius = 0.1 }", &start, &floor)
        .replace("friction = 0.5", "friction = 0.0, stiffness = 1e6, dissipation = 5.0");
    let quarter = 0.25 * core::f64::consts::TAU * (l / G).sqrt() * (1.0 + a * a / 16.0);
    let step = 0.001;
    let folder = folder(&format!("allow_overlap = true\n{scene}"), "\"/air.position.x\"", 2.0, step);
    let run = ran(&folder.load(&[]).unwrap());
    let x = values(&run, "/air.position.x");
    let k = x.windows(2).position(|w| w[0] > 0.0 && w[1] <= 0.0).expect("it passes the middle");
    let t = step * (k as f64 + x[k] / (x[k] - x[k + 1]));
    assert!((t / quarter - 1.0).abs() < 5e-3, "{t} {quarter}");
    // without friction it comes as far on the other side, half a period later, and back after another half,
    let extreme = |halves: f64| {
        let around = (2.0 * halves * quarter / step) as usize;
        let near = &x[around - 50..around + 50];
        near.iter().copied().fold(0.0, |far: f64, x| if x.abs() > far.abs() { x } else { far })
    };
    // but for what the compliant floor dissipates at the edges of the grid, less than half a percent a swing
    let start = l * sin;
    let shares = [extreme(1.0) / -start, extreme(2.0) / start];
    assert!((0.995..1.0).contains(&shares[0]) && (0.99..shares[0]).contains(&shares[1]), "{shares:?}");
}

/// Diagnostics of a mesh file.
fn refused(name: &str, bytes: &[u8], keys: &str) -> String {
    let shape = format!("mesh = {{ file = \"{name}\"{keys} }}");
    let folder = folder(&body(&shape, "position = [0, 0, 1, 1, 0, 0, 0]", PLANE), "\"energy.total\"", 0.1, 0.1);
    std::fs::write(folder.join(name), bytes).unwrap();
    folder.load(&[]).map_or_else(|message| message, |_| "loads".into())
}

#[test]
fn meshes_that_enclose_nothing_are_refused_by_name() {
    let size = [1.0; 3];
    let whole = obj(size);
    let says = |text: &str, expected: &[&str]| {
        let message = refused("m.obj", text.as_bytes(), "");
        expected.iter().for_each(|part| assert!(message.contains(part), "{message}\nlacks\n{part}"));
    };
    let open = whole.trim_end().rsplit_once('\n').unwrap().0;
    says(
        open,
        &[
            "the mesh `m.obj` is not closed: no other triangle has the edge of triangle",
            "fill the hole",
            "scene.toml:11:",
        ],
    );
    says(
        &whole.replace("f 1/1/1 5/1/1 7/1/1 3/1/1", "f 3/1/1 7/1/1 5/1/1 1/1/1"),
        &["run along the edge from", "the same way"],
    );
    let inside: String = whole
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            ["f", a, b, c, d] => format!("f {d} {c} {b} {a}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    says(&inside, &["is inside out: its volume is -", "turn them all over"]);
    says(&whole.replace("v 0.5 0.5 0.5", "v 0.5 nan 0.5"), &["is not finite: corner 8"]);
    says(&whole.replace("v 0.5 0.5 0.5", "v 0.5 0.5"), &["m.obj:10:1: error: `v` has fewer than three numbers"]);
    says(&whole.replace("8/1/1", "9/1/1"), &["there is no corner `9/1/1`", "8 corners stand above this line"]);
    says(&whole.replace("o box", "curv2 1 2"), &["m.obj:2:1: error: `curv2` is not read"]);
    says("", &["has fewer than four triangles"]);
    let binary = binary_stl(size);
    let message = refused("m.stl", &binary[..200], "");
    assert!(message.contains("its head tells of 12 triangles, which take 684 bytes, and it has 200"), "{message}");
    let message = refused("m.ply", b"ply", "");
    assert!(message.contains("a mesh is an STL or an OBJ file"), "{message}");
    let message = refused("flat.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n", ", convex = true");
    assert!(message.contains("the convex hull of `flat.obj` has no volume"), "{message}");
    let message = refused("m.obj", whole.as_bytes(), "");
    assert!(message.contains("body `/air/it` moves and has a mesh that may be hollow"), "{message}");
    let message = refused("m.obj", whole.as_bytes(), ", scale = 0.0");
    assert!(message.contains("`scale` of the mesh `m.obj` is [0.0]"), "{message}");
    let message = refused("m.obj", whole.as_bytes(), ", scale = [1, 2]");
    assert!(message.contains("`scale` of the mesh `m.obj` is [1.0, 2.0]"), "{message}");
}

#[test]
fn height_fields_that_are_no_grid_are_refused() {
    let says = |field: &str, csv: &str, expected: &str| {
        let floor = format!("shape = [{{ height_field = {{ {field}, size = [1.0, 1.0] }} }}]");
        let scene = body("sphere = { radius = 0.1 }", "position = [0, 0, 1, 1, 0, 0, 0]", &floor);
        let folder = folder(&scene, "\"energy.total\"", 0.1, 0.1);
        folder.write("h.csv", csv);
        let message = folder.load(&[]).map_or_else(|message| message, |_| "loads".into());
        assert!(message.contains(expected), "{message}\nlacks\n{expected}");
    };
    says("heights = [[0, 0, 0], [0, 0]]", "", "row 2 has 2 heights, the first one 3");
    says("heights = [[0, 0, 0]]", "", "a height field of 1 by 3 heights spans no ground");
    says("file = \"h.csv\"", "0,0\n0,high\n", "h.csv:2:3: error: `high` is not a height");
    says("file = \"h.csv\"", "0,0\n0,inf\n", "h.csv:2:3: error: `inf` is not a height");
    says("file = \"h.csv\"", "0,0\n0\n", "h.csv:2:1: error: row 2 has 1 heights, the first one 2");
    says("file = \"g.csv\"", "", "there is no file `g.csv`");
    says("file = \"h.csv\"", "0,0\n0,0\n", "loads");
}
