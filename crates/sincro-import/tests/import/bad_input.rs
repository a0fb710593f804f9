//! Input that is broken or hostile: refused with a reason, no panic, no unbounded memory.

use sincro_import::{Options, import};

use crate::folder::Folder;

#[test]
fn truncated_files_are_refused() {
    let folder = Folder::new();
    let whole = "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/></inertial></link></robot>";
    assert!(folder.import("r.urdf", whole).is_ok());
    for end in 0..whole.len() {
        assert!(folder.import("r.urdf", &whole[..end]).is_err(), "{end}");
    }
}

#[test]
fn entities_do_not_expand() {
    let mut text = String::from("<!DOCTYPE robot [<!ENTITY a0 \"aaaaaaaaaa\">");
    for k in 1..30 {
        text += &format!("<!ENTITY a{k} \"&a{0};&a{0};&a{0};&a{0};\">", k - 1);
    }
    text += "]><robot name=\"&a29;\"/>";
    let refused = Folder::new().import("r.urdf", &text).unwrap_err().to_string();
    assert!(refused.contains("document type"), "{refused}");
}

#[test]
fn deep_nesting_is_refused_before_it_is_parsed() {
    let n = 300_000;
    let text = format!("<robot name=\"r\">{}{}</robot>", "<a>".repeat(n), "</a>".repeat(n));
    assert!(Folder::new().import("r.urdf", &text).unwrap_err().to_string().contains("nested"));
}

#[test]
fn names_do_not_lead_out_of_the_robot() {
    let folder = Folder::new();
    let secret = folder.file("secret.stl", crate::folder::tetrahedron());
    for uri in ["package://a/../../../secret.stl", "../../../secret.stl", &format!("file://{}", secret.display())] {
        let text = format!(
            "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh filename=\"{uri}\"/></geometry></visual></link></robot>"
        );
        let imported = folder.import("a/b/c/d/r.urdf", &text).unwrap();
        assert!(imported.warnings[0].message.contains("leads out"), "{uri}: {:?}", imported.warnings);
    }
}

#[test]
fn large_meshes_are_not_read() {
    let folder = Folder::new();
    let mesh = folder.file("huge.stl", []);
    std::fs::OpenOptions::new().write(true).open(mesh).unwrap().set_len(1 << 30).unwrap();
    let text = "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh filename=\"huge.stl\"/></geometry></visual></link></robot>";
    let imported = folder.import("r.urdf", text).unwrap();
    assert!(imported.warnings[0].message.contains("larger than"), "{:?}", imported.warnings);
}

#[test]
fn changed_bytes_never_panic() {
    let seeds = [
        (
            "r.urdf",
            "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial><collision><geometry><box size=\"1 1 1\"/></geometry></collision></link><joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"1\"/></joint></robot>",
        ),
        (
            "r.sdf",
            "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><inertial><mass>1</mass></inertial></link><link name=\"b\"><pose>1 0 0 0 0 0</pose><inertial><mass>1</mass></inertial></link><joint name=\"j\" type=\"ball\"><parent>a</parent><child>b</child></joint></model></sdf>",
        ),
        (
            "r.xml",
            "<mujoco><default><joint damping=\"1\"/></default><worldbody><body name=\"a\"><joint name=\"j\" axis=\"0 1 0\" range=\"-1 1\"/><geom size=\"0.1 0.1\" type=\"capsule\"/></body></worldbody><actuator><position joint=\"j\" kp=\"2\"/></actuator></mujoco>",
        ),
    ];
    // 7000 rounds are ten million bytes
    let rounds = std::env::var("SINCRO_FUZZ_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(150);
    let folder = Folder::new();
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = move |n: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % n as u64) as usize
    };
    let pieces: [&[u8]; 12] =
        [b"<", b">", b"\"", b"/", b"-1", b"1e308", b"nan", b"0", b"name", b"\xff", b"&lt;", b"   "];
    for (name, seed) in seeds {
        for _ in 0..rounds {
            let mut bytes = seed.as_bytes().to_vec();
            for _ in 0..=next(4) {
                let (at, piece) = (next(bytes.len()), pieces[next(pieces.len())]);
                let end = (at + next(6)).min(bytes.len());
                bytes.splice(at..end, piece.iter().copied());
            }
            let _ = import(&folder.file(name, &bytes), &Options::default());
        }
    }
}

/// Actuators, tendons, equalities, height fields and keyframes with every number replaced by numbers that are too
/// small, too large or none: each file is refused with a reason, or its scene was read again.
#[test]
fn numbers_of_all_sizes_never_panic() {
    let seed = r#"<mujoco><compiler angle="radian"/><default><position kp="3" kv="1" timeconst="0.2"/></default>
<asset><hfield name="h" nrow="2" ncol="2" size="1 2 0.5 0.1" elevation="0 1 2 3"/></asset><worldbody>
<geom type="hfield" hfield="h"/><body name="r" pos="0 0 3"><freejoint/><geom size="0.1"/></body><site name="w"/>
<body name="a"><joint name="j" axis="0 1 0" range="-1 2" ref="0.25"/><geom size="0.1" pos="0.2 0 0"/><site name="s"/>
<body name="b"><joint name="k" axis="0 1 0"/><geom size="0.1" pos="0.2 0 0"/></body></body></worldbody>
<tendon><fixed name="t" range="-1 2" stiffness="3" springlength="0.1 0.2"><joint joint="j" coef="0.5"/><joint joint="k" coef="2"/></fixed>
<fixed name="u" frictionloss="0.1" armature="0.2"><joint joint="k" coef="-2"/></fixed></tendon>
<equality><joint joint1="k" joint2="j" polycoef="0.1 0.5 0.2 0.3 0.4"/><tendon tendon1="t" tendon2="u" polycoef="0.1 0.5"/></equality>
<actuator><general name="g" joint="j" gear="2" gainprm="3" biastype="affine" biasprm="0 -2 -1" dyntype="filter" dynprm="0.1" ctrlrange="-1 2" actrange="-0.5 0.7" forcerange="-3 3"/>
<intvelocity joint="k" gear="2" kp="3" kv="1" actrange="0.1 0.5"/><position tendon="t" inheritrange="0.5"/>
<cylinder tendon="u" area="3" diameter="0.4" bias="0 -1 -2" timeconst="0.3"/><motor site="s" gear="1 2 3 4 5 6"/></actuator>
<keyframe><key name="n" qpos="0 0 3 1 0 0 0 0.3 0.2" ctrl="1 2 3 4 5" act="0.1 0.2 0.3 0.4"/></keyframe></mujoco>"#;
    let folder = Folder::new();
    folder.import("whole.xml", seed).unwrap_or_else(|found| panic!("{found}"));
    let bytes = seed.as_bytes();
    let mut numbers: Vec<std::ops::Range<usize>> = Vec::new();
    for (k, byte) in bytes.iter().enumerate() {
        let is_part = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
        match numbers.last_mut() {
            Some(last) if last.end == k && is_part(*byte) => last.end = k + 1,
            _ if is_part(*byte) && matches!(bytes[k - 1], b'"' | b' ') => numbers.push(k..k + 1),
            _ => {}
        }
    }
    assert!(numbers.len() > 90, "{}", numbers.len());
    for range in numbers {
        for other in ["0", "-1", "1e308", "-1e308", "1e-308", "nan", "inf", "1e400", "", "0 0", "1 -1", "x"] {
            let text = format!("{}{other}{}", &seed[..range.start], &seed[range.end..]);
            let _ = import(&folder.file("r.xml", &text), &Options::default());
        }
    }
    for end in (0..seed.len()).step_by(7) {
        assert!(folder.import("r.xml", &seed[..end]).is_err(), "{end}");
    }
}
