//! MJCF.

use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::Motion;
use sincro_dynamics::state::State;

use crate::folder::{Folder, dropped, entry};

const HOPPER: &str = r#"<mujoco model="hopper">
  <compiler angle="degree"/>
  <default><joint damping="1" armature="0.1"/><default class="knee"><joint damping="3" range="-60 0"/></default>
    <motor gear="50" ctrlrange="-1 1" ctrllimited="true"/></default>
  <option timestep="0.002" gravity="0 0 -9.8"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 0.1" conaffinity="1" rgba="0.8 0.8 0.8 1"/>
    <body name="torso" pos="0 0 1.25">
      <joint name="x" type="slide" axis="1 0 0" armature="0" damping="0"/>
      <joint name="z" type="slide" axis="0 0 1" armature="0" damping="0" ref="1.25"/>
      <joint name="pitch" type="hinge" axis="0 1 0" pos="0 0 0.1" armature="0" damping="0"/>
      <geom type="capsule" fromto="0 0 0.2 0 0 -0.2" size="0.05"/>
      <site name="imu" pos="0 0 0.1"/>
      <body name="shin" pos="0 0 -0.2">
        <joint name="knee" class="knee" axis="0 -1 0" stiffness="5" springref="-10"/>
        <geom type="box" size="0.03 0.03 0.2" pos="0 0 -0.2" mass="2" euler="0 0 90"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="m" joint="knee"/></actuator>
  <sensor><gyro site="imu"/><accelerometer site="imu"/><framepos objtype="body" objname="shin"/></sensor>
  <keyframe><key name="bent" qpos="0 1.25 0 -0.5"/></keyframe>
</mujoco>"#;

#[test]
fn several_joints_of_a_body_are_a_chain() {
    let folder = Folder::new();
    let imported = folder.import("hopper.xml", HOPPER).unwrap_or_else(|found| panic!("{found}"));
    let opened = folder.open(&imported);
    let scene = &opened.scene;
    assert_eq!(scene.model.n_v(), 4);
    assert!(imported.report.differences().is_empty(), "{:?}", imported.report.differences());
    let path = "/x/z/pitch/torso/knee";
    let knee = scene.model.names().joint(path).unwrap();
    let dof = scene.model.dofs()[knee.v_idx];
    assert_eq!((dof.damping, dof.armature, dof.stiffness), (3.0, 0.1, 5.0), "defaults of the class and of main");
    assert!((dof.rest + 10.0_f64.to_radians()).abs() < 1e-15);
    assert_eq!(scene.model.motors()[0].max_torque, 50.0);
    assert_eq!(opened.experiment.variants[0].name, "bent");
    assert_eq!(scene.sensors.len(), 1, "gyro and accelerometer are one unit");
}

#[test]
fn poses_are_written_as_people_write_them() {
    let folder = Folder::new();
    // a body that hangs on a hinge through the origin of the world, turned by 90°
    let text = r#"<mujoco><worldbody><body name="arm" pos="0 0 0.1625" quat="0.7071067811865475 0.7071067811865475 0 0">
  <joint name="pan" pos="0 -0.1625 0" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
  <geom type="box" size="1 1 1" quat="0.7071067811865475 0 0 0.7071067811865475"/>
  <geom type="box" size="1 1 1" quat="0.5 0.1 0.7 0.5"/>
</body></worldbody></mujoco>"#;
    let imported = folder.import("arm.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let scene = imported.scene();
    assert!(
        scene.contains("rotation_deg = [90.0, 0.0, 0.0]") && scene.contains("position = [0.0, 0.1625, 0.0]"),
        "{scene}"
    );
    assert!(!scene.contains("e-1"), "{scene}");
    assert!(scene.contains("rotation_deg = [0.0, 0.0, 90.0]") && scene.contains("quaternion_wxyz = [0.5, "), "{scene}");
}

#[test]
fn mass_comes_from_the_geoms_where_the_format_says_so() {
    let folder = Folder::new();
    let imported = folder.import("hopper.xml", HOPPER).unwrap();
    let scene = folder.open(&imported).scene;
    let pi = std::f64::consts::PI;
    let torso = 1000.0 * (pi * 0.05_f64.powi(2) * 0.4 + 4.0 / 3.0 * pi * 0.05_f64.powi(3));
    assert!((scene.model.total_mass() - torso - 2.0).abs() < 1e-12);
}

/// A body without geoms keeps what it is given; only −1 stands for the length of a tendon at the start.
#[test]
fn given_masses_and_negative_free_lengths_are_kept() {
    let folder = Folder::new();
    let text = r#"<mujoco><compiler inertiafromgeom="true"/><worldbody>
        <body name="a"><joint name="x" type="slide" axis="1 0 0"/>
          <inertial pos="0 0 0" mass="2" diaginertia="0.1 0.1 0.1"/>
          <body name="b"><inertial pos="0 0 0" mass="7" diaginertia="1 1 1"/><geom type="sphere" size="0.1" mass="1"/></body>
        </body></worldbody>
      <tendon><fixed name="t" stiffness="10" springlength="-0.5"><joint joint="x" coef="1"/></fixed>
        <fixed name="u" stiffness="10" springlength="-1"><joint joint="x" coef="1"/></fixed></tendon></mujoco>"#;
    let imported = folder.import("own.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let model = &folder.open(&imported).scene.model;
    assert_eq!(model.total_mass(), 3.0);
    let free: Vec<f64> = model.spring_dampers().iter().map(|tendon| tendon.free_length).collect();
    assert_eq!(free, [-0.5, 0.0]);
}

#[test]
fn a_geom_that_gives_mass_is_not_left_out() {
    let folder = Folder::new();
    let text = |inertial: &str| {
        format!(
            r#"<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody><body name="a"><freejoint/>
            {inertial}<geom type="mesh" mesh="m"/><geom type="sphere" size="0.1"/></body></worldbody></mujoco>"#
        )
    };
    let told = folder.import("own.xml", &text("")).unwrap_err().to_string();
    assert!(told.contains("a geom gives its body mass, and cannot be read"), "{told}");
    let given = r#"<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>"#;
    assert!(folder.import("own.xml", &text(given)).is_ok());
}

/// Pairs that are excluded, forces that are disabled or bounded, and bodies in frames.
#[test]
fn exclusions_flags_frames_and_limits_of_force_are_read() {
    let folder = Folder::new();
    let text = r#"<mujoco><worldbody>
        <body name="base"><geom type="box" size="0.1 0.1 0.1"/>
          <frame pos="0 0 0.1"><body name="first"><joint name="a" axis="0 1 0" actuatorfrcrange="-1.2 1.2" damping="2"/>
            <geom type="sphere" size="0.05" mass="1"/></body></frame>
          <frame pos="0 0 0.3"><body name="second"><joint name="b" axis="0 1 0" stiffness="3"/>
            <geom type="sphere" size="0.05" mass="1"/></body></frame>
        </body></worldbody>
      <contact><exclude body1="base" body2="first"/></contact>
      <actuator><motor name="m" joint="a"/><position name="p" joint="b" kp="5" forcerange="-3 3"/></actuator></mujoco>"#;
    let imported = folder.import("own.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let names: Vec<&str> =
        scene.model.names().joints.iter().map(|joint| joint.name.rsplit('/').next().unwrap()).collect();
    assert_eq!(names, ["a", "b"]);
    let limits: Vec<f64> = scene.model.motors().iter().map(|motor| motor.max_torque).collect();
    assert_eq!(limits, [1.2, 3.0]);
    let pairs = &scene.model.constraints().pairs;
    // the base stands in the world: `second` touches it and `first`, which does not touch the base
    assert_eq!(pairs.iter().filter(|pair| !pair.is_ignored).count(), 2, "{}", imported.scene());
    assert!(imported.scene().contains("between = [\"/base\", \"/base/a/first\"]\ntouches = false"));

    let without = text.replace(
        "<worldbody>",
        r#"<option><flag contact="disable" passive="disable" actuation="disable" energy="enable"/></option><worldbody>"#,
    );
    let scene = folder.open(&folder.import("own.xml", &without).unwrap_or_else(|found| panic!("{found}"))).scene;
    let dofs = scene.model.dofs();
    assert!(dofs.iter().all(|dof| dof.damping == 0.0 && dof.stiffness == 0.0) && scene.model.motors().is_empty());
    assert!(scene.model.constraints().pairs.is_empty());
}

/// Flags beside keyframes, tendons of one force alone, and equalities of tendons.
#[test]
fn disabled_forces_leave_nothing_behind() {
    let with = |flags: &str| {
        let folder = Folder::new();
        let text = format!(
            r#"<mujoco><option><flag {flags}/></option><worldbody><geom type="plane" size="1 1 1"/><body name="b" pos="0 0 1">
              <joint name="a" axis="0 1 0" actuatorfrcrange="-1 1" actuatorfrclimited="false"/><geom type="sphere" size="0.05"/></body></worldbody>
            <contact><exclude body1="world" body2="b"/></contact>
            <tendon><fixed name="t" range="-1 1"><joint joint="a" coef="1"/></fixed>
              <fixed name="s" stiffness="3"><joint joint="a" coef="1"/></fixed><fixed name="h"><joint joint="a" coef="2"/></fixed></tendon>
            <equality><tendon tendon1="h" solref="-100 -2"/></equality>
            <actuator><motor name="m" joint="a"/><position name="p" tendon="s" kp="2"/></actuator>
            <keyframe><key name="k" qpos="0.1" ctrl="0.5 0.2"/></keyframe></mujoco>"#
        );
        let imported = folder.import("own.xml", &text).unwrap_or_else(|found| panic!("{flags}: {found}"));
        let model = folder.open(&imported).scene.model;
        let limits: Vec<f64> = model.motors().iter().map(|motor| motor.max_torque).collect();
        (model.names().spring_dampers.len(), limits, model.constraints().pairs.iter().filter(|p| !p.is_ignored).count())
    };
    let infinite = vec![f64::INFINITY];
    assert_eq!(with("energy=\"enable\""), (4, infinite.clone(), 0));
    assert_eq!(with("limit=\"disable\""), (3, infinite.clone(), 0));
    assert_eq!(with("spring=\"disable\""), (3, infinite.clone(), 0));
    assert_eq!(with("equality=\"disable\""), (3, infinite.clone(), 0));
    assert_eq!(with("constraint=\"disable\""), (2, infinite, 0));
    assert_eq!(with("actuation=\"disable\""), (3, vec![], 0));
}

/// Two assets of one file, each with a rule of its own for the mass.
#[test]
fn a_mesh_has_the_mass_of_its_own_asset() {
    let folder = Folder::new();
    let mass = |order: &str| {
        // two tetrahedra that share a face, of volumes 1/6 and 5/6
        folder.file(
            "two.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n",
        );
        let text = format!(
            r#"<mujoco><asset><mesh name="solid" file="two.obj" inertia="exact"/><mesh name="skin" file="two.obj" inertia="shell"/></asset>
            <worldbody><body name="a"><freejoint/><geom type="mesh" mesh="{order}" density="1"/></body></worldbody></mujoco>"#
        );
        let imported = folder.import("own.xml", &text).unwrap_or_else(|found| panic!("{found}"));
        folder.open(&imported).scene.model.total_mass()
    };
    // the area of the surface, not its volume
    let (solid, skin) = (mass("solid"), mass("skin"));
    assert!((solid - 1.0).abs() < 1e-9, "{solid}");
    assert!((skin - solid).abs() > 0.1, "{skin} and {solid}");
}

#[test]
fn references_shift_coordinates() {
    let folder = Folder::new();
    let imported = folder.import("hopper.xml", HOPPER).unwrap();
    assert!(imported.scene().contains("limits = { lower = -1.0471975511965976, upper = 0.0 }"), "{}", imported.scene());
    let scene = folder.open(&imported).scene;
    assert_eq!(scene.initial.q, vec![0.0; 4]);
}

#[test]
fn unread_parts_are_told() {
    let folder = Folder::new();
    let imported = folder.import("hopper.xml", HOPPER).unwrap();
    let dropped = dropped(&imported);
    assert!(dropped.iter().any(|d| d.ends_with("sensor/framepos")), "{dropped:?}");
    assert!(dropped.iter().any(|d| d.ends_with("option/@timestep")), "{dropped:?}");
    assert!(entry(&imported, "motor[m]").words.contains("50 times the control"));
}

#[test]
fn includes_stand_in_place_and_circles_end() {
    let folder = Folder::new();
    folder.file("parts/arm.xml", r#"<mujoco><body name="arm"><joint name="j"/><geom size="0.1"/></body></mujoco>"#);
    let text = r#"<mujoco><worldbody><include file="parts/arm.xml"/></worldbody></mujoco>"#;
    let scene = folder.open(&folder.import("m.xml", text).unwrap()).scene;
    assert!(scene.object("/j/arm").is_some());
    folder.file("a.xml", r#"<mujoco><include file="b.xml"/><worldbody/></mujoco>"#);
    folder.file("b.xml", r#"<mujoco><include file="a.xml"/></mujoco>"#);
    assert!(sincro_import::import(&folder.path().join("a.xml"), &sincro_import::Options::default()).is_err());
    let outside = text.replace("parts/arm.xml", "../../../../etc/passwd");
    assert!(folder.import("m.xml", &outside).unwrap_err().to_string().contains("is not included"));
}

#[test]
fn features_without_counterpart_are_refused_by_name() {
    let folder = Folder::new();
    for (feature, part, words) in [
        ("<option density=\"1.2\"/>", "", "fluid forces"),
        ("<extension><plugin plugin=\"x\"/></extension>", "", "plugins"),
        (
            "<tendon><spatial name=\"t\" stiffness=\"3\"><site site=\"imu\"/><pulley divisor=\"2\"/></spatial></tendon>",
            "",
            "tendon `t` acts (`stiffness`), and it runs over a pulley",
        ),
        (
            "<tendon><fixed name=\"t\" stiffness=\"3 1\"><joint joint=\"knee\" coef=\"1\"/></fixed></tendon>",
            "",
            "polynomial",
        ),
        ("<tendon><fixed name=\"t\"><joint joint=\"nee\" coef=\"1\"/></fixed></tendon>", "", "there is no joint `nee`"),
        ("<equality><joint joint1=\"knee\" polycoef=\"0.5\"/></equality>", "", "held at a position"),
        ("", "<flexcomp name=\"f\"/>", "flexcomp"),
    ] {
        let text = HOPPER
            .replace("</mujoco>", &format!("{feature}</mujoco>"))
            .replace("<body name=\"shin\"", &format!("{part}<body name=\"shin\""));
        let refused = folder.import("hopper.xml", &text).unwrap_err().to_string();
        assert!(refused.contains(words), "{words}: {refused}");
    }
}

/// 1/(j M⁻¹ jᵀ) at zero coordinates for a row of coefficients.
fn mass_along(model: &Model<f64>, row: &[(usize, f64)]) -> f64 {
    let n = model.n_v();
    let mut mass = vec![0.0; n * n];
    mass_matrix(model, &State::new(model).q, &mut Scratch::new(model), &mut mass);
    let mut j = vec![0.0; n];
    row.iter().for_each(|(k, c)| j[*k] = *c);
    // Gauss without pivots: the matrix is positive definite
    let mut x = j.clone();
    for k in 0..n {
        for i in k + 1..n {
            let factor = mass[i * n + k] / mass[k * n + k];
            (k..n).for_each(|l| mass[i * n + l] -= factor * mass[k * n + l]);
            x[i] -= factor * x[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|l| mass[k * n + l] * x[l]).sum();
        x[k] = (x[k] - sum) / mass[k * n + k];
    }
    1.0 / j.iter().zip(&x).map(|(a, b)| a * b).sum::<f64>()
}

#[test]
fn a_spring_given_by_its_time_constant_has_the_inertia_of_its_joint() {
    let folder = Folder::new();
    let text = HOPPER.replace("springref=\"-10\"", "springref=\"-10\" springdamper=\"0.2 0.5\"");
    let imported = folder.import("hopper.xml", &text).unwrap();
    let model = &folder.open(&imported).scene.model;
    let knee = model.names().joint("/x/z/pitch/torso/knee").unwrap();
    let (dof, inertia) = (model.dofs()[knee.v_idx], mass_along(model, &[(knee.v_idx, 1.0)]));
    assert!((dof.stiffness - inertia / 0.01).abs() < 1e-9 * dof.stiffness, "{} {inertia}", dof.stiffness);
    assert!((dof.damping - inertia / 0.1).abs() < 1e-9 * dof.damping);
    assert!((dof.rest + 10.0_f64.to_radians()).abs() < 1e-15);
}

#[test]
fn tendons_keep_their_forces() {
    let folder = Folder::new();
    let text = HOPPER
        .replace(
            "<site name=\"imu\" pos=\"0 0 0.1\"/>",
            "<site name=\"imu\" pos=\"0 0 0.1\"/><site name=\"hip\" pos=\"0.1 0 0\"/>",
        )
        .replace("<geom type=\"box\"", "<site name=\"heel\" pos=\"0.05 0 -0.3\"/><geom type=\"box\"")
        .replace(
            "</mujoco>",
            r#"<tendon>
                <fixed name="f" stiffness="30" damping="2" springlength="0.1 0.2" range="-1 1" solreflimit="0.01 2">
                  <joint joint="z" coef="2"/><joint joint="knee" coef="-0.5"/></fixed>
                <spatial name="s" stiffness="40"><site site="imu"/><site site="hip"/><site site="heel"/></spatial>
                <fixed name="silent"><joint joint="knee" coef="3"/></fixed>
              </tendon>
              <actuator><position name="servo" tendon="silent" kp="50" gear="2" ctrlrange="-1 1"/>
                <general name="pull" tendon="s" gainprm="7" gear="-1" forcerange="-5 5"/></actuator>
              <equality><tendon name="held" tendon1="silent" polycoef="0.3 0 0 0 0" solref="-1000 -20"/></equality></mujoco>"#,
        );
    let imported = folder.import("hopper.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let model = &scene.model;
    let names: Vec<&str> = model.names().spring_dampers.iter().map(String::as_str).collect();
    assert_eq!(names, ["/f", "/s", "/held", "/servo", "/pull"]);
    let [fixed, spatial, held, servo, pull] = model.spring_dampers() else { panic!() };
    let knee = model.names().joint("/x/z/pitch/torso/knee").unwrap();
    let z = model.names().joint("/x/z").unwrap();
    // z has the reference 1.25: the length is 2 (z + 1.25) − 0.5 knee
    let shares: Vec<_> = fixed.shares().iter().map(|share| (share.dof, share.coefficient)).collect();
    assert_eq!(shares, [(z.v_idx, 2.0), (knee.v_idx, -0.5)]);
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} {b}");
    let force = |length: f64, rate: f64| fixed.forces(length - 2.5, rate, &[0.0; 8]).total();
    close(force(0.15, 0.0), 0.0);
    close(force(0.3, 0.5), -30.0 * 0.1 - 2.0 * 0.5);
    close(force(-0.2, 0.0), 30.0 * 0.3);
    // mass along it: M at zero coordinates by the difference of the stop's force, stiffness m/(T ζ)²
    let (stop, spring) = (force(1.1, 0.0), -30.0 * 0.9);
    let mass = (spring - stop) / 0.1 * (0.01 * 2.0_f64).powi(2);
    close(mass, mass_along(model, &[(z.v_idx, 2.0), (knee.v_idx, -0.5)]));
    close(force(1.1, 3.0), -30.0 * 0.9 - 6.0 - mass / 4e-4 * 0.1 - 2.0 * mass / 0.01 * 3.0);
    assert_eq!(spatial.segments().len(), 2);
    // MuJoCo's tendon_lengthspring, with the knee at its springref
    let length = 0.6559315184738755;
    close(spatial.forces(length + 0.1, 0.0, &[0.0; 8]).total(), -4.0);
    // held: stiffness 1000 m, damping 20 m with the mass along the knee
    let mass = mass_along(model, &[(knee.v_idx, 3.0)]);
    close(held.law.stiffness, 1000.0 * mass);
    close(held.law.damping, 20.0 * mass);
    close(held.free_length, 0.3);
    close(servo.law.stiffness, 200.0);
    close(servo.free_length, 0.0);
    close(servo.actuator.unwrap().max_force, 100.0);
    close(pull.actuator.unwrap().max_force, 5.0);
    assert!(entry(&imported, "position[servo]").words.contains("100 times the control"));
    assert!(entry(&imported, "general[pull]").words.contains("-7 times the control"));
}

#[test]
fn an_actuator_on_a_site_is_a_force_with_input() {
    let folder = Folder::new();
    let rotor = "<actuator><motor name=\"rotor\" site=\"imu\" gear=\"0 0 1 0 0 -0.02\"/></actuator></mujoco>";
    let imported = folder.import("hopper.xml", &HOPPER.replace("</mujoco>", rotor)).unwrap();
    let scene = folder.open(&imported).scene;
    assert_eq!(scene.model.names().inputs, ["/x/z/pitch/torso/imu/rotor"]);
    assert!(scene.model.wrenches()[0].in_body);
    // `gear` of the defaults is 50 in its first component alone
    let words = &entry(&imported, "motor[rotor]").words;
    assert!(words.contains("force [0.0, 0.0, 1.0] N, torque [0.0, 0.0, -0.02] N·m"), "{words}");
    assert!(imported.scene().contains("for a control of 1: force [0.0, 0.0, 1.0] N"), "{}", imported.scene());
}

#[test]
fn equalities_close_loops_and_couple_joints() {
    let folder = Folder::new();
    let text = HOPPER.replace(
        "</mujoco>",
        "<equality><connect body1=\"shin\" anchor=\"0 0 -0.4\"/><joint joint1=\"knee\" joint2=\"pitch\" polycoef=\"0 -1 0 0 0\"/></equality></mujoco>",
    );
    let scene = folder.open(&folder.import("hopper.xml", &text).unwrap()).scene;
    assert_eq!(scene.model.constraints().loop_joints.len(), 1);
    assert_eq!(scene.model.constraints().gears[0].ratio, -1.0);
}

#[test]
fn cameras_look_where_mujocos_do() {
    let folder = Folder::new();
    let text = r#"<mujoco><worldbody>
      <camera name="overview" pos="0 -2 1" xyaxes="1 0 0 0 0 1" fovy="60"/>
      <body name="arm" pos="0 0 1"><joint name="j" axis="0 1 0"/><geom type="sphere" size="0.1" mass="1"/>
        <camera name="eye" pos="0.1 0 0" quat="1 0 0 0" resolution="64 48"/>
        <camera name="follower" mode="trackcom" pos="1 0 0"/></body>
    </worldbody></mujoco>"#;
    let imported = folder.import("eyes.xml", text).unwrap();
    assert_eq!(dropped(&imported), Vec::<String>::new());
    assert!(entry(&imported, "camera[follower]").words.contains("trackcom"));
    let scene = folder.open(&imported).scene;
    let axes = |ending: &str| {
        let object = scene.objects.iter().find(|o| o.path.ends_with(ending)).unwrap();
        let column = |k: usize| [0, 1, 2].map(|i| object.pose.rot.0[i][k]);
        [0, 1, 2].map(column)
    };
    let close = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-15)
    };
    // x of MuJoCo's picture is right, ours left; it looks along −z, ours along z: here along the world's y
    assert!(close(axes("/overview"), [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]), "{:?}", axes("/overview"));
    assert!(close(axes("/eye"), [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]), "{:?}", axes("/eye"));
    assert!(imported.scene().contains("field_of_view_deg = 60.0"), "{}", imported.scene());
    assert!(imported.scene().contains("field_of_view_deg = 45.0\nresolution = [64, 48]"), "{}", imported.scene());
    let wrong = text.replace("fovy=\"60\"", "fovy=\"200\"");
    assert!(folder.import("wrong.xml", &wrong).unwrap_err().to_string().contains("`fovy` is 200"));
}

/// A body of 2 kg that a weld holds 0.1 m off its place, and a mocap body that carries another.
const WELDS: &str = r#"<mujoco><worldbody>
  <body name="box" pos="0 0 1"><freejoint name="f"/><geom type="box" size="0.1 0.2 0.3" mass="2"/></body>
  <body name="arm" pos="1 0 0"><joint name="j" axis="0 1 0"/><inertial pos="0.5 0 0" mass="3" diaginertia="0.1 0.2 0.3"/>
    <body name="hand" pos="0.5 0 0"/></body>
  <body name="target" mocap="true" pos="1.5 0 0"/>
</worldbody><equality>
  <weld name="seat" body1="world" body2="box" relpose="0.1 0 1 1 0 0 0" solimp="0.95 0.95 0.001"/>
  <weld name="grasp" body1="target" body2="hand" solref="0.01 2" solimp="0.98 0.98 0.001"/>
  <connect name="idle" body1="target" body2="world" anchor="0.2 0 0"/>
</equality></mujoco>"#;

#[test]
fn open_welds_and_those_to_mocap_bodies_are_bushings() {
    let folder = Folder::new();
    let imported = folder.import("welds.xml", WELDS).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let model = &scene.model;
    assert!(model.constraints().loop_joints.is_empty(), "{}", imported.scene());
    assert_eq!(model.names().bushings, ["/seat", "/grasp"]);
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} {b}");
    let [seat, grasp] = model.bushings() else { panic!() };
    // m/((1 − d) (T ζ)²) and 2 m/((1 − d) T) of 2 kg, and a quarter of them for the harmonic mean of its moments;
    // T = 0.02 s, ζ = 1, d = 0.95
    let moment = 3.0 / [0.16 + 0.36, 0.04 + 0.36, 0.04 + 0.16].iter().map(|x| 12.0 / (2.0 * x)).sum::<f64>();
    for (found, mass) in [(0, 2.0), (2, 2.0), (3, 0.25 * moment), (5, 0.25 * moment)] {
        close(seat.stiffness[found], mass / (0.05 * 4e-4));
        close(seat.damping[found], 2.0 * mass / (0.05 * 0.02));
    }
    let mut scratch = Scratch::new(model);
    sincro_dynamics::kinematics::motions(model, &scene.initial.q, &scene.initial.v, &scene.initial.v, &mut scratch);
    let poses = scratch.link_poses();
    let at = seat.motion(|link| (Motion::zero(), poses[link]));
    close(at.deflection[0], -0.1);
    // MuJoCo takes 0.5 m in the parent for the centre of mass of the hand, which has no mass: it is 1 m from the hinge,
    // of which the arm has 0.2 + 3·0.5² kg·m², and moves along one axis of three
    let inertia = 0.95;
    close(grasp.stiffness[2], 3.0 * inertia / (0.02 * 4e-4));
    close(grasp.damping[4], 0.25 * 2.0 * 3.0 * inertia / (0.02 * 0.01));
    let words = &entry(&imported, "weld[seat]").words;
    assert!(
        words.contains("open at the start by 1.000e-1")
            && words.contains("for 2.0000 kg and 0.0531 kg·m², times (`torquescale`/2)² = 0.5²"),
        "{words}"
    );
    assert!(entry(&imported, "weld[grasp]").words.contains("to a mocap body"));
    assert!(entry(&imported, "body[target]").words.contains("where a client may move it"));
    assert_eq!(dropped(&imported), ["mujoco/equality/connect[idle]"]);
    assert!(imported.warnings.iter().any(|w| w.to_string().contains("`idle` is left out: it moves nothing")));
}

/// A body that a soft equality holds at a mocap body, 0.5 m off its centre of mass.
fn held_off_centre(equality: &str) -> String {
    format!(
        r#"<mujoco><worldbody>
  <body name="box"><freejoint/><inertial pos="0 0 0" mass="2" diaginertia="0.02 0.02 0.02"/><site name="grip" pos="0.5 0 0"/></body>
  <body name="target" mocap="true" pos="0.5 0 0"><site name="tip"/></body>
</worldbody><equality><{equality} name="held" site1="tip" site2="grip" solimp="0.95 0.95 0.001"/></equality></mujoco>"#
    )
}

/// The figures are those of MuJoCo 4.0.0, load over deflection, after 20 s with a steady force of 1 N, or torque of
/// 0.01 N·m, at the site; the deflection is known to 1e-8 of it.
#[test]
fn soft_equalities_yield_under_a_steady_load_as_in_mujoco() {
    let measured = [
        ("connect", 99_999.999_567, 0.0),
        ("weld", 100_000.000_491, 250.000_000_314),
        ("weld torquescale=\"2\"", 100_000.0, 1000.0),
        ("weld torquescale=\"0\"", 100_000.0, 0.0),
    ];
    for (equality, force, torque) in measured {
        let folder = Folder::new();
        let imported = folder.import("held.xml", &held_off_centre(equality)).unwrap_or_else(|found| panic!("{found}"));
        let scene = folder.open(&imported).scene;
        let [held] = scene.model.bushings() else { panic!("{equality}: {}", imported.scene()) };
        for k in 0..3 {
            assert!((held.stiffness[k] - force).abs() < 1e-7 * force, "{equality}: {held:?}");
            assert!((held.stiffness[3 + k] - torque).abs() <= 1e-7 * torque, "{equality}: {held:?}");
        }
    }
}

/// A rim that a wheel turns about its centre of mass: MuJoCo gives it no inverse mass, and holds it rigidly.
#[test]
fn an_anchor_on_a_body_that_turns_about_its_centre_of_mass_has_the_mass_there() {
    let text = r#"<mujoco><worldbody><body name="wheel"><joint axis="0 0 1"/>
      <inertial pos="0 0 0" mass="2" diaginertia="0.1 0.1 0.1"/></body><body name="target" mocap="true" pos="0.5 0 0"/>
    </worldbody><equality><connect name="rim" body1="target" body2="wheel"/></equality></mujoco>"#;
    let folder = Folder::new();
    let imported = folder.import("wheel.xml", text).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let [rim] = scene.model.bushings() else { panic!("{}", imported.scene()) };
    // 0.1 kg·m² at 0.5 m, along one axis of three
    let mass = 3.0 * 0.1 / 0.25;
    assert!((rim.stiffness[1] - mass / (0.05 * 4e-4)).abs() < 1e-9 * rim.stiffness[1], "{rim:?}");
    assert!(entry(&imported, "connect[rim]").words.contains("rigidly"), "{}", entry(&imported, "connect[rim]").words);
}

/// A chain of three hinges with a fixed tendon, and actuators.
pub fn actuated(actuators: &str) -> String {
    let body = |k: usize| {
        format!(
            r#"<body name="b{k}" pos="0 0 0.2"><joint name="j{k}" axis="0 1 0" range="-1 2"/><inertial pos="0 0 0.1" mass="1" diaginertia="0.01 0.01 0.01"/>"#
        )
    };
    let bodies: String = (0..3).map(body).collect();
    format!(
        r#"<mujoco><compiler angle="radian"/><worldbody>{bodies}</body></body></body></worldbody>
<tendon><fixed name="t"><joint joint="j0" coef="0.5"/><joint joint="j2" coef="-1"/></fixed></tendon>
<actuator>{actuators}</actuator></mujoco>"#
    )
}

#[test]
fn activations_are_those_of_motors_and_tendons_in_units_of_their_commands() {
    let folder = Folder::new();
    let text = actuated(
        r#"<general name="a" joint="j0" gear="3" gainprm="-2" dyntype="filter" dynprm="0.07" ctrlrange="-1 0.8" actrange="-0.5 0.7" actearly="true"/>
<intvelocity name="b" joint="j1" gear="2" kp="15" kv="1" inheritrange="0.5"/>
<cylinder name="c" tendon="t" timeconst="0.3" area="4"/>
<position name="d" joint="j2" kp="5" kv="1" timeconst="0.1"/>"#,
    );
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let model = folder.open(&imported).scene.model;
    let of = |k: usize| {
        let own = model.activations()[k];
        (own.command, own.time_constant(), own.range, own.input_range, own.initial)
    };
    let all = [f64::NEG_INFINITY, f64::INFINITY];
    let scaled = |range: [f64; 2], scale: f64| [range[1] * scale, range[0] * scale];
    // the torque is gain·gear times the activation
    assert_eq!(of(0), (0, Some(0.07), scaled([-0.5, 0.7], -6.0), scaled([-1.0, 0.8], -6.0), 0.0));
    // half of the range about its middle, and angles of the joint, which are those of the actuator over its gear
    assert_eq!(of(1), (1, None, [-0.125, 0.625], all, 0.0));
    assert_eq!(of(2), (2, Some(0.1), all, all, 0.0));
    assert_eq!(of(3), (3, Some(0.3), all, all, 0.0));
    assert_eq!((model.motors()[1].stiffness, model.motors()[1].damping), (60.0, 4.0));
    assert!(entry(&imported, "general[a]").words.contains("`actearly`"), "{}", entry(&imported, "general[a]").words);
    assert!(model.spring_dampers()[0].actuator.is_some());
}

#[test]
fn activations_without_counterpart_are_refused_by_name() {
    let folder = Folder::new();
    for (actuator, word) in [
        (r#"<muscle name="m" joint="j0"/>"#, "a `muscle` has no counterpart"),
        (r#"<general name="m" joint="j0" dyntype="muscle"/>"#, "its activation is of type `muscle`"),
        (r#"<general name="m" joint="j0" dyntype="user"/>"#, "its activation is of type `user`"),
        (r#"<damper name="m" joint="j0" kv="2" ctrlrange="0 1"/>"#, "a `damper` has no counterpart"),
        (
            r#"<general name="m" joint="j0" dyntype="filter" biastype="affine" biasprm="0 0 1"/>"#,
            "is no spring and damper",
        ),
    ] {
        let imported = folder.import("m.xml", &actuated(actuator)).unwrap_or_else(|found| panic!("{found}"));
        let words = &entry(&imported, "[m]").words;
        assert!(words.contains(word), "{actuator}: {words}");
    }
}

#[test]
fn a_reference_shifts_the_activation_of_a_servo() {
    let folder = Folder::new();
    let text = actuated(r#"<position name="d" joint="j1" kp="5" timeconst="0.1" actrange="-1 2"/>"#)
        .replace(r#"name="j1" axis="0 1 0""#, r#"name="j1" axis="0 1 0" ref="0.25""#);
    let imported = folder.import("m.xml", &text).unwrap_or_else(|found| panic!("{found}"));
    let scene = folder.open(&imported).scene;
    let own = scene.model.activations()[0];
    assert_eq!((own.initial, own.range), (-0.25, [-1.25, 1.75]));
    assert_eq!(scene.initial.rotors, [-0.25]);
}

#[test]
fn equalities_with_a_polynomial_are_couplings() {
    let folder = Folder::new();
    let with = |equality: &str| {
        actuated("").replace("</mujoco>", &format!("<equality>{equality}</equality></mujoco>")).replace(
            "</tendon>",
            r#"<fixed name="one"><joint joint="j0" coef="2"/></fixed><fixed name="two"><joint joint="j1" coef="0.5"/></fixed></tendon>"#,
        )
    };
    let gear = |equality: &str| {
        let imported = folder.import("m.xml", &with(equality)).unwrap_or_else(|found| panic!("{found}"));
        let opened = folder.open(&imported).scene;
        let gear = opened.model.constraints().gears[0].clone();
        assert!(gear.residual::<f64>(&opened.initial.q).abs() < 1e-15, "{:?}", opened.initial.q);
        (gear.dofs, gear.offset, gear.ratio, gear.higher)
    };
    let joints = gear(r#"<joint joint1="j2" joint2="j0" polycoef="0.1 -0.5 0.25 0.02 -0.3"/>"#);
    assert_eq!(joints, ([0, 2], 0.1, -0.5, [0.25, 0.02, -0.3]));
    // 2 q₀ = 0.2 + 0.5 (q₁/2) − (q₁/2)³
    let tendons = gear(r#"<tendon tendon1="one" tendon2="two" polycoef="0.2 0.5 0 -1 0"/>"#);
    assert_eq!(tendons, ([1, 0], 0.1, 0.125, [0.0, -0.0625, 0.0]));
    let refused = folder.import("m.xml", &with(r#"<tendon tendon1="t" tendon2="two" polycoef="0 1 0.5"/>"#));
    let refused = refused.map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("tendons of several joints coupled by a polynomial"), "{refused}");
}

#[test]
fn height_fields_stand_in_the_world_with_their_elevations() {
    use sincro_dynamics::contact::Surface;
    let folder = Folder::new();
    let mut bytes = Vec::new();
    bytes.extend([2_i32, 3].into_iter().flat_map(i32::to_le_bytes));
    bytes.extend([4.0_f32, 5.0, 7.0, 1.0, 2.0, 3.0].into_iter().flat_map(f32::to_le_bytes));
    folder.file("ground.bin", bytes);
    let text = |asset: &str| {
        format!(
            r#"<mujoco><asset><hfield name="h" size="1 2 0.6 0.1" {asset}/></asset><worldbody>
<geom type="hfield" hfield="h" pos="0 0 0.5" friction="0.7 0 0"/>
<body name="b" pos="0 0 3"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"#
        )
    };
    let field = |asset: &str| {
        let imported = folder.import("m.xml", &text(asset)).unwrap_or_else(|found| panic!("{found}"));
        let colliders = folder.open(&imported).scene.model.constraints().colliders.clone();
        let found = colliders.iter().find_map(|collider| match &collider.surface {
            Surface::HeightField { columns, heights, size } => {
                Some((*columns, heights.clone(), *size, collider.pose.pos.0))
            }
            _ => None,
        });
        found.unwrap_or_else(|| panic!("{}", imported.scene()))
    };
    // from the least y on; from 0 at the lowest to 0.6 m
    let expected: Vec<f64> = [3.0, 4.0, 6.0, 0.0, 1.0, 2.0].iter().map(|h| h * (0.6 / 6.0)).collect();
    let place = [0.0, 0.0, 0.5];
    assert_eq!(field(r#"nrow="2" ncol="3" elevation="1 2 3 4 5 7""#), (3, expected.clone(), [2.0, 4.0], place));
    assert_eq!(field(r#"file="ground.bin""#), (3, expected, [2.0, 4.0], place));
    assert_eq!(field(r#"nrow="200" ncol="300""#), (2, vec![0.0; 4], [2.0, 4.0], place));
    let image = folder.import("m.xml", &text(r#"file="ground.png""#)).unwrap();
    assert!(entry(&image, "geom").words.contains("its heights are an image"), "{}", entry(&image, "geom").words);
    folder.file("short.bin", [0_u8; 21]);
    let short = folder.import("m.xml", &text(r#"file="short.bin""#)).unwrap();
    assert!(entry(&short, "geom").words.contains("no grid of 0 by 0"), "{}", entry(&short, "geom").words);
    for (asset, words) in [
        (r#"nrow="2" ncol="3" elevation="1 2 3""#, "`elevation` has 3 numbers, not 2 by 3"),
        (r#"nrow="1" ncol="3""#, "1 by 3 heights spans no ground"),
    ] {
        let refused = folder.import("m.xml", &text(asset)).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}
