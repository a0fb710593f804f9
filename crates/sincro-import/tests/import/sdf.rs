//! SDF.

use crate::folder::{Folder, entry};

const FOUR_BAR: &str = r#"<sdf version="1.9"><model name="bars">
  <link name="ground"><inertial><mass>1</mass></inertial></link>
  <link name="left"><pose>0 0 0.5 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.01</izz></inertia></inertial></link>
  <link name="top"><pose>0.5 0 1 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link>
  <link name="right"><pose>1 0 0.5 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.01</izz></inertia></inertial></link>
  <joint name="hold" type="fixed"><parent>world</parent><child>ground</child></joint>
  <joint name="a" type="revolute"><pose relative_to="ground"/><parent>ground</parent><child>left</child><axis><xyz>0 1 0</xyz></axis></joint>
  <joint name="b" type="revolute"><pose>-0.5 0 0 0 0 0</pose><parent>left</parent><child>top</child><axis><xyz>0 1 0</xyz><dynamics><damping>0.1</damping></dynamics></axis></joint>
  <joint name="c" type="revolute"><pose>0 0 -0.5 0 0 0</pose><parent>ground</parent><child>right</child><axis><xyz>0 1 0</xyz></axis></joint>
  <joint name="d" type="revolute"><pose>0 0 0.5 0 0 0</pose><parent>top</parent><child>right</child><axis><xyz>0 1 0</xyz></axis></joint>
  <plugin name="p" filename="libp.so"/>
</model></sdf>"#;

#[test]
fn a_second_joint_closes_a_loop() {
    let folder = Folder::new();
    let imported = folder.import("bars.sdf", FOUR_BAR).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    assert_eq!(scene.model.n_v(), 3);
    assert_eq!(scene.freedom().dofs(), 1);
    assert!(entry(&imported, "joint[d]").words.contains("closes a loop"));
    assert!(entry(&imported, "plugin[p]").words.contains("plugin"));
    assert!(imported.report.differences().is_empty(), "{:?}", imported.report.differences());
}

#[test]
fn models_move_freely_unless_something_holds_them() {
    let folder = Folder::new();
    let free =
        FOUR_BAR.replace(r#"<joint name="hold" type="fixed"><parent>world</parent><child>ground</child></joint>"#, "");
    let n_v = |text: &str| folder.open(&folder.import("bars.sdf", text).unwrap()).scene.model.n_v();
    assert_eq!(n_v(&free), 9);
    assert_eq!(n_v(&free.replace("<model name=\"bars\">", "<model name=\"bars\"><static>true</static>")), 3);
}

#[test]
fn places_follow_frames_and_nested_models() {
    let text = r#"<sdf version="1.9"><world name="w"><gravity>0 0 -1.6</gravity><model name="outer"><pose>1 0 0 0 0 0</pose>
      <frame name="mark"><pose>0 2 0 0 0 1.5707963267948966</pose></frame>
      <link name="base"/>
      <model name="inner"><pose relative_to="mark">1 0 0 0 0 0</pose><link name="arm"><inertial><mass>3</mass></inertial></link></model>
      <joint name="j" type="fixed"><parent>base</parent><child>inner::arm</child></joint>
      <joint name="w" type="fixed"><parent>world</parent><child>base</child></joint></model></world></sdf>"#;
    let folder = Folder::new();
    let imported = folder.import("w.sdf", text).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let arm = scene.objects.iter().find(|o| o.name == "inner__arm").unwrap();
    let mut p = arm.pose;
    let mut at = arm.parent;
    while let Some(k) = at {
        p = scene.objects[k].pose.compose(&p);
        at = scene.objects[k].parent;
    }
    // 1 along the turned x of the mark: along y of the world
    assert!(p.pos.0.iter().zip([1.0, 3.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", p.pos);
    assert_eq!(scene.model.gravity()[2], -1.6);
}

#[test]
fn frames_in_circles_are_refused() {
    let text = r#"<sdf version="1.9"><model name="m"><frame name="a"><pose relative_to="b"/></frame>
      <frame name="b"><pose relative_to="a"/></frame><link name="l"><inertial><mass>1</mass></inertial></link></model></sdf>"#;
    assert!(Folder::new().import("m.sdf", text).unwrap_err().to_string().contains("circle"));
}

#[test]
fn cameras_look_along_x_and_have_the_height_that_follows_from_the_width() {
    let folder = Folder::new();
    let text = r#"<sdf version="1.9"><model name="r"><link name="base"><inertial><mass>1</mass></inertial>
      <sensor name="eye" type="camera"><pose>0.1 0 0.2 0 0 1.5707963267948966</pose><camera>
        <horizontal_fov>1.5707963267948966</horizontal_fov><image><width>200</width><height>100</height></image>
        <clip><near>0.05</near><far>8</far></clip></camera></sensor></link></model></sdf>"#;
    let imported = folder.import("eye.sdf", text).unwrap();
    let scene = folder.open(&imported).scene;
    let eye = scene.objects.iter().find(|o| o.path.ends_with("/eye")).unwrap();
    // turned by 90° about z it looks along y; up is z, left is −x
    let expected = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    for (k, axis) in expected.iter().enumerate() {
        for i in 0..3 {
            assert!((eye.pose.rot.0[i][k] - axis[i]).abs() < 1e-15, "{:?}", eye.pose.rot);
        }
    }
    let line = imported.scene().lines().find(|line| line.starts_with("field_of_view_deg")).unwrap().to_owned();
    let degrees: f64 = line.split_once(" = ").unwrap().1.parse().unwrap();
    let half = sincro_math::elementary::atan2(0.5, 1.0).0;
    assert!((degrees - 2.0 * half.to_degrees()).abs() < 1e-12, "{line}");
    assert!(imported.scene().contains("near = 0.05\nfar = 8.0"), "{}", imported.scene());
}
