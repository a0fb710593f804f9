//! Starts that contradict themselves: velocities that open loops, and motors whose commands do.

use std::sync::atomic::AtomicBool;

use sincro_testing::{SceneFolder, repository_scene};

use sincro_scene::overrides::Override;
use sincro_sim::campaign::run_campaign;
use sincro_sim::{Extensions, load};

const EXPERIMENT: &str =
    "format = 2\ntitle = \"Wheels\"\nstep = 0.005\nduration = 0.1\nrecord = [\"/left.position\"]\n";

/// Two wheels geared with ratio −0.25; the lines given are part of their joints.
fn wheels(left: &str, right: &str) -> String {
    let wheel = |name: &str, more: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\n{more}\n\
             [[body]]\nname = \"wheel\"\nparent = \"/{name}\"\nmass = 1.0\ninertia = {{ xx = 1.0, yy = 1.0, zz = 1.0 }}\n"
        )
    };
    let gear = "[[coupling]]\nname = \"gear\"\njoints = [\"/left\", \"/right\"]\nratio = -0.25\n";
    format!("format = 2\n{}{}{gear}", wheel("left", left), wheel("right", right))
}

fn loaded(left: &str, right: &str) -> Result<(), String> {
    SceneFolder::of(&wheels(left, right), EXPERIMENT).load(&[]).map(|_| ())
}

fn velocity(v: f64) -> String {
    format!("initial = {{ velocity = {v:?} }}")
}

fn motor(command: f64, more: &str) -> String {
    format!("motor = {{ mode = \"velocity\", command = {command:?}{more} }}")
}

#[test]
fn velocities_that_open_a_gear_are_refused() {
    let message = loaded(&velocity(4.0), "").unwrap_err();
    assert_eq!(
        message,
        "scene.toml:23:8: error: the initial velocities open coupling `/gear`: its second joint is off by 1.000000e0 rad/s\n  \
         help: it stays closed with the velocities /left = 3.764705882353, /right = -0.941176470588"
    );
    assert_eq!(loaded(&velocity(4.0), &velocity(-1.0)), Ok(()));
    assert_eq!(loaded(&velocity(3.764705882353), &velocity(-0.941176470588)), Ok(()));
}

/// Two cranks joined by a rod, lengths times `k`, in one order or the other.
fn parallelogram(k: f64, velocities: [f64; 2], is_reversed: bool) -> String {
    let crank = |name: &str, x: f64, velocity: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nposition = [{x:?}, 0.0, 0.0]\n\
             initial = {{ position = 0.3, velocity = {velocity:?} }}\n\
             [[body]]\nname = \"bar\"\nparent = \"/{name}\"\nposition = [0.0, 0.0, {:?}]\nmass = 1.0\n\
             inertia = {{ xx = {i:?}, yy = {i:?}, zz = {i:?} }}\n\
             [[frame]]\nname = \"end\"\nparent = \"/{name}\"\nposition = [0.0, 0.0, {:?}]\n",
            -0.5 * k,
            -k,
            i = 0.1 * k * k
        )
    };
    let mut cranks = [crank("left", 0.0, velocities[0]), crank("right", 2.0 * k, velocities[1])];
    if is_reversed {
        cranks.reverse();
    }
    let ends = "between = [\"/left/end\", \"/right/end\"]";
    let rod = format!("[[closure]]\nname = \"rod\"\nkind = \"distance\"\n{ends}\nlength = {:?}\n", 2.0 * k);
    format!("format = 2\n{}{rod}", cranks.concat())
}

#[test]
fn rounded_velocities_pass_in_long_and_short_mechanisms() {
    for (k, is_reversed) in [(1.0, false), (1e3, false), (1e3, true), (1e-3, false), (1e-3, true)] {
        let check = |velocities| SceneFolder::of(&parallelogram(k, velocities, is_reversed), EXPERIMENT).load(&[]);
        // seven figures of a velocity
        assert!(check([1.0, 0.999_999_9]).is_ok(), "{k}");
        let message = check([1.0, 0.0]).map(|_| ()).unwrap_err();
        assert!(message.contains("open closure `/rod`: its ends part at"), "{k} {message}");
        assert!(message.contains("/left = 0.500000000000") && message.contains("/right = 0.500000000000"), "{message}");
    }
}

#[test]
fn motors_that_contradict_a_gear_are_refused() {
    let message = loaded(&motor(4.0, ""), &motor(1.0, "")).unwrap_err();
    assert_eq!(
        message,
        "scene.toml:3:8: error: the commands of the motors of `/left`, `/right` open coupling `/gear`: its second \
         joint is off by 2.000000e0 rad/s\n  \
         help: these motors hold their velocities exactly: give one of them a `max_torque`, or commands that agree"
    );
    assert_eq!(loaded(&motor(4.0, ""), &motor(-1.0, "")), Ok(()));
    assert_eq!(loaded(&motor(4.0, ""), &motor(1.0, ", max_torque = 3.0")), Ok(()));
    assert_eq!(loaded(&motor(4.0, ""), ""), Ok(()));
}

#[test]
fn motors_of_loops_that_hold_are_not_named() {
    // a second pair of wheels below another frame, whose motors agree with their gear
    let pair = wheels(&motor(4.0, ""), &motor(1.0, ""));
    let others = wheels(&motor(4.0, ""), &motor(-1.0, "")).replace("format = 2\n", "");
    let others = others.replace("left", "front").replace("right", "rear").replace("gear", "belt");
    let message = SceneFolder::of(&format!("{pair}{others}"), EXPERIMENT).load(&[]).map(|_| ()).unwrap_err();
    assert!(message.contains("the motors of `/left`, `/right` open coupling `/gear`: its second joint"), "{message}");
    assert!(!message.contains("front") && !message.contains("belt"), "{message}");
}

#[test]
fn a_run_names_the_motors_that_come_to_contradict_a_gear() {
    let later = "motor = { mode = \"velocity\", command = { step = { time = 0.05, to = 4.0 } } }";
    let folder = SceneFolder::of(&wheels(later, &motor(0.0, "")), EXPERIMENT);
    let done = run_campaign(&folder, &[], &folder.load(&[]).unwrap(), None, &AtomicBool::new(false), &mut |_, _| {});
    let audit = done.unwrap().main.audit;
    assert!(!audit.ok);
    let of_gear: Vec<_> = audit.findings.iter().filter(|finding| finding.element == "/gear").collect();
    assert!(!of_gear.is_empty());
    for finding in of_gear {
        assert_eq!(
            finding.help,
            "the motors of `/left`, `/right` hold their velocities exactly, and `/gear` allows only some of them: give \
             one of the motors a `max_torque`, or commands that agree"
        );
    }
}

#[test]
fn velocities_of_a_four_bar_follow_its_crank() {
    let scene = repository_scene("slider-crank");
    let with = |settings: &[(String, String)]| {
        let settings: Vec<Override> = settings.iter().map(|(key, value)| Override::new(key, value)).collect();
        load(&scene, &settings, Extensions::default()).map_err(|diagnostics| diagnostics.to_string())
    };
    let loaded = with(&[]).unwrap();
    let crank = loaded.scene.model.names().joints[0].name.clone();
    let message = with(&[(format!("{crank}.initial.velocity"), "1.5".to_owned())]).unwrap_err();
    let (what, help) = message.split_once("it stays closed with the velocities ").expect("a help with velocities");
    assert!(what.contains("the initial velocities open closure"), "{what}");
    // what the help says is accepted, and moves
    let settings: Vec<(String, String)> = help
        .lines()
        .next()
        .unwrap()
        .split(", ")
        .map(|pair| pair.split_once(" = ").map(|(name, v)| (format!("{name}.initial.velocity"), v.to_owned())).unwrap())
        .collect();
    let moving = with(&settings).unwrap();
    assert!(moving.scene.initial.v[0] > 0.1, "{:?}", moving.scene.initial.v);
}
