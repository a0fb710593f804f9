//! Masses and shapes.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// File, what is replaced, by what, and what is said.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "scene.toml",
        "density = 1000.0",
        r#"density = 1000.0
mass = 1.0"#,
        r#"scene.toml:14:1: error: body `rod`: `mass` and `density` both say what it weighs
  help: leave one of them out"#,
    ),
    (
        "scene.toml",
        r#"density = 1000.0
"#,
        "",
        r#"scene.toml:14:11: error: body `rod`: a shape has no density
  help: give `density` for the body or for each shape [kg/m³], or `mass` [kg]"#,
    ),
    (
        "scene.toml",
        r#"density = 1000.0
shape"#,
        "#",
        r#"scene.toml:12:8: error: body `rod`: it has no mass
  help: give `density` and shapes, or `mass` and `inertia`; what has no mass is a frame"#,
    ),
    (
        "scene.toml",
        "shape = [",
        "# [",
        r#"scene.toml:14:1: error: body `rod`: `density` without shapes
  help: give shapes, or `mass` and `inertia`"#,
    ),
    (
        "scene.toml",
        r#"mass = 0.5
"#,
        "",
        r#"scene.toml:31:1: error: body `hand`: `inertia` without `mass`
  help: give the mass too [kg]"#,
    ),
    (
        "scene.toml",
        "inertia = {",
        "# {",
        r#"scene.toml:31:1: error: body `hand`: `mass` without `inertia` and without shapes
  help: give `inertia` too, or shapes that say how the mass is distributed"#,
    ),
    (
        "scene.toml",
        "density = 1000.0",
        r#"density = 1000.0
center_of_mass = [0, 0, 0]"#,
        r#"scene.toml:15:1: error: body `rod`: `center_of_mass` without `mass` and `inertia`
  help: it goes with `mass` and `inertia`; else the shapes say where it is"#,
    ),
    (
        "scene.toml",
        "density = 1000.0\nshape = [ {",
        "mass = 2.0\ninertia = { xx = 1, yy = 1, zz = 1 }\nshape = [ { density = 500.0,",
        r"loads
scene.toml:16:13: warning: the density of a shape of `rod` has no effect
  help: `mass` and `inertia` are given, shapes only show",
    ),
    (
        "scene.toml",
        "xx = 0.001",
        "xx = 0.1",
        r#"loads
scene.toml:32:11: warning: no rigid body has the inertia of `/shoulder/rod/tip/wrist/hand`: its largest principal moment 1.000000e-1 kg·m² exceeds the sum of the others by 98.0 %
  help: check the figures (triangle inequality); the run goes on with them as they stand"#,
    ),
    (
        "scene.toml",
        "xx = 0.001",
        "xx = -0.1",
        r#"scene.toml:32:11: error: inertia of `/shoulder/rod/tip/wrist/hand` has a negative principal moment, -1.000000e-1 kg·m²
  help: every principal moment must be zero (a point) or positive"#,
    ),
    (
        "scene.toml",
        "#8a5a2b",
        "brown",
        r##"scene.toml:15:94: error: `brown` is not a colour
  help: write "#rrggbb", such as "#8a5a2b""##,
    ),
    (
        "scene.toml",
        "position = [0.0, 0.0, 0.25]",
        "quaternion_wxyz = [0, 0, 0, 0]",
        r#"scene.toml:15:75: error: the quaternion [0.0, 0.0, 0.0, 0.0] has no direction
  help: no rotation is [1, 0, 0, 0]: w, x, y, z"#,
    ),
    (
        "scene.toml",
        "radius = 0.05",
        "radius = 1e200",
        r#"scene.toml:14:11: error: mass inf kg of `/shoulder/rod` is not positive
  help: give a positive mass; an object without mass is a frame
scene.toml:15:9: error: centre of mass of `/shoulder/rod` is not finite
  help: give three numbers in m
scene.toml:15:9: error: inertia of `/shoulder/rod` is not finite
  help: give numbers in kg·m²"#,
    ),
];

#[test]
fn bodies_are_checked() {
    for (file, from, to, said) in CASES {
        assert_eq!(refused(file, from, to), *said, "{from:?} replaced by {to:?}");
    }
}
