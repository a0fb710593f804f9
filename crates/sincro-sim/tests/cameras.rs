//! Cameras of scenes: where they stand, that they change no run, and what is refused.

use sincro_sim::replay::SceneView;
use sincro_testing::SceneFolder;

const SCENE: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]

[[body]]
name = "rod"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.5, 0.0, 0.0]
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"#;

const CAMERA: &str = r#"
[[camera]]
name = "eye"
parent = "/hinge/rod"
position = [1.0, -2.0, 0.0]
look_at = [1.0, 0.0, 0.0]
"#;

fn folder(scene: &str) -> SceneFolder {
    let folder = SceneFolder::new().with("scene.toml", scene);
    folder.write(
        "experiment.toml",
        "title = \"t\"\nscene = \"scene.toml\"\nduration = 0.5\nstep = 0.01\nrecord = [\"/hinge.position\"]\n",
    );
    folder
}

#[test]
fn a_camera_rides_on_what_carries_it_and_looks_where_it_is_told() {
    let loaded = folder(&format!("{SCENE}{CAMERA}")).load(&[]).unwrap();
    let view = SceneView::new(&loaded.scene);
    let eye = view.objects.iter().find(|o| o.path == "/hinge/rod/eye").unwrap();
    assert_eq!((eye.mover, eye.camera.as_ref().unwrap().field_of_view_deg), (Some(0), 38.0));
    // z of the camera is y of the rod, its y is z
    let [x, y, z, qx, qy, qz, qw] = eye.pose;
    assert_eq!([x, y, z], [1.0, -2.0, 0.0]);
    let ahead = [2.0 * (qx * qz + qw * qy), 2.0 * (qy * qz - qw * qx), 1.0 - 2.0 * (qx * qx + qy * qy)];
    let up = [2.0 * (qx * qy - qw * qz), 1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz + qw * qx)];
    for (found, expected) in [(ahead, [0.0, 1.0, 0.0]), (up, [0.0, 0.0, 1.0])] {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }
}

#[test]
fn a_camera_changes_no_run_and_no_model() {
    let hash = |scene: &str| {
        let loaded = folder(scene).load(&[]).unwrap();
        let signals = sincro_scene::record::catalogue(&loaded.scene.model).len();
        (sincro_testing::run(&loaded).trace.to_string(), signals)
    };
    assert_eq!(hash(SCENE), hash(&format!("{SCENE}{CAMERA}")));
    assert_eq!(hash(SCENE), hash(&format!("{SCENE}{CAMERA}resolution = [320, 240]")));
}

/// Replaced text, replacement, and expected message.
const REFUSED: &[(&str, &str, &str)] = &[
    ("look_at = [1.0, 0.0, 0.0]", "look_at = [1.0, -2.0, 0.0]", "error: camera `eye` stands where it looks at"),
    ("look_at = [1.0, 0.0, 0.0]", "field_of_view_deg = 190.0", "camera `eye` has a field of view of 190°"),
    ("look_at = [1.0, 0.0, 0.0]", "field_of_view_deg = 0.0", "`field_of_view_deg` is 0"),
    (
        "look_at = [1.0, 0.0, 0.0]",
        "look_at = [1.0, 0.0, 0.0]\nrotation_deg = [0.0, 0.0, 0.0]",
        "`look_at` and `rotation_deg` exclude each other",
    ),
    ("look_at = [1.0, 0.0, 0.0]", "quaternion_wxyz = [0.0, 0.0, 0.0, 0.0]", "has no direction"),
    ("look_at = [1.0, 0.0, 0.0]", "look_at = [1.0, 0.0]", "`look_at` has 2 entries"),
    ("look_at = [1.0, 0.0, 0.0]", "lookat = [1.0, 0.0, 0.0]", "did you mean `look_at`?"),
    ("look_at = [1.0, 0.0, 0.0]", "near = 0.1", "camera `eye` has `near`, but no `resolution`"),
    ("look_at = [1.0, 0.0, 0.0]", "external_input = true", "camera `eye` has `external_input`, but no `resolution`"),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [0, 8]", "camera `eye` has a resolution of 0 × 8 pixels"),
    (
        "look_at = [1.0, 0.0, 0.0]",
        "resolution = [100000, 100000]",
        "expected 1 to 4096 columns and rows, and at most 4194304",
    ),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [64]", "`resolution` has 1 entries"),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [8, 8]\nnear = 0.0", "camera `eye` has a picture that begins at 0 m"),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [8, 8]\nnear = nan", "`near` is not a number"),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [8, 8]\nfar = 0.01", "camera `eye` has a picture that ends at 0.01 m"),
    (
        "look_at = [1.0, 0.0, 0.0]",
        "resolution = [8, 8]\northographic_height = -1.0",
        "camera `eye` has a picture -1 m high",
    ),
    (
        "look_at = [1.0, 0.0, 0.0]",
        "resolution = [8, 8]\northographic_height = 1.0\nfield_of_view_deg = 30.0",
        "`field_of_view_deg` and `orthographic_height` exclude each other",
    ),
    ("look_at = [1.0, 0.0, 0.0]", "resolution = [8, 8]\nbackground = \"grey\"", "`grey` is not a colour"),
    (
        "parent = \"/hinge/rod\"\nposition",
        "parent = \"/hinge/rot\"\nposition",
        "there is no object `/hinge/rot` to hang `eye` on",
    ),
    (
        "[[camera]]",
        "[[frame]]\nname = \"lens\"\nparent = \"/hinge/rod/eye\"\n[[camera]]",
        "`/hinge/rod/eye` is a camera, it carries nothing",
    ),
];

#[test]
fn cameras_that_cannot_be_are_refused_in_words() {
    let mut wrong = Vec::new();
    for (from, to, expected) in REFUSED {
        let words = folder(&format!("{SCENE}{}", CAMERA.replace(from, to))).load(&[]).expect_err(to);
        wrong.extend((!words.contains(expected)).then(|| format!("{expected}\n--- said\n{words}\n")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
