//! `sincro sweep`, `fit` and `tune` as a user has them: shards that are killed, folders of others, damaged files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use sincro_testing::{CommandLine, SceneFolder};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A plan of 60 short runs of the compliant arm.
fn plan(folder: &Path) -> PathBuf {
    let path = folder.join("plan.toml");
    let text = format!(
        "scene = {:?}\nruns = 60\nrows_per_part = 4\n[set]\nduration = 1.0\n\
         [[parameter]]\nname = \"K1\"\npath = \"/motor1/spring1.spring.stiffness\"\nuniform = {{ from = 2.0, to = 4.0 }}\n\
         [[measure]]\nname = \"miss\"\nsignal = \"miss\"\nat_most = 0.5\n",
        root().join("scenes/alexandros-position").display().to_string()
    );
    fs::write(&path, text).unwrap();
    path
}

fn call(arguments: &[&str]) -> String {
    let exit = SINCRO.call(arguments);
    assert_eq!(exit.status, 0, "{arguments:?}\n{}{}", exit.stdout, exit.stderr);
    exit.stdout
}

#[test]
fn killed_shards_leave_the_bytes_of_an_undisturbed_campaign() {
    let folder = SceneFolder::new();
    let plan = plan(&folder);
    let (plan, whole, shared) = (plan.to_str().unwrap(), folder.join("whole"), folder.join("shared"));
    call(&["sweep", plan, "--out", whole.to_str().unwrap(), "--replays", "1", "--quiet"]);
    let shared = shared.to_str().unwrap();
    for (shard, milliseconds) in [("1/3", 60), ("3/3", 150), ("1/3", 100), ("2/3", 220)] {
        let mut child = SINCRO.command(&["sweep", plan, "--out", shared, "--shard", shard, "--quiet"]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(milliseconds));
        // SIGKILL, unless it has come to its end
        let _ = child.kill();
        child.wait().unwrap();
    }
    for shard in ["1/3", "2/3", "3/3"] {
        call(&["sweep", plan, "--out", shared, "--shard", shard]);
    }
    call(&["sweep", "collect", shared, "--replays", "0"]);
    let table = fs::read(whole.join("runs.parquet")).unwrap();
    assert!(fs::read(folder.join("shared/runs.parquet")).unwrap() == table);
    // the worst run was made again: its trace is the one in the table
    let again = fs::read_dir(whole.join("runs")).unwrap().next().unwrap().unwrap().path();
    let report = fs::read_to_string(again.join("run.json")).unwrap();
    let trace = report.split("\"trace_hash\": \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    assert!(table.windows(trace.len()).any(|bytes| bytes == trace.as_bytes()), "{trace}");
}

#[test]
fn shards_that_begin_at_the_same_instant_share_a_new_folder() {
    let folder = SceneFolder::new();
    let plan = plan(&folder);
    let (plan, shared) = (plan.to_str().unwrap(), folder.join("shared"));
    let shard = |k: usize| {
        let shard = format!("{k}/15");
        let command =
            ["sweep", plan, "--out", shared.to_str().unwrap(), "--shard", &shard, "--threads", "1", "--quiet"];
        (shard.clone(), SINCRO.command(&command).stderr(Stdio::piped()).spawn().unwrap())
    };
    let started: Vec<_> = (1..=15).map(shard).collect();
    for (shard, child) in started {
        let exit = child.wait_with_output().unwrap();
        assert!(exit.status.success(), "{shard}: {}", String::from_utf8_lossy(&exit.stderr));
    }
    call(&["sweep", "collect", shared.to_str().unwrap(), "--replays", "0"]);
}

#[test]
fn what_is_missing_damaged_or_foreign_is_named() {
    let folder = SceneFolder::new();
    let plan = plan(&folder);
    let (path, out) = (plan.to_str().unwrap(), folder.join("out"));
    let out_text = out.to_str().unwrap();
    call(&["sweep", path, "--out", out_text, "--shard", "1/2", "--quiet"]);
    let exit = SINCRO.call(&["sweep", "collect", out_text]);
    assert!(exit.status == 3 && exit.stderr.contains("28 runs are missing: 4–7, 12–15"), "{}", exit.stderr);
    assert!(!out.join("runs.parquet").exists());
    assert!(call(&["sweep", "status", out_text]).contains("8 of 15 parts"));

    call(&["sweep", path, "--out", out_text, "--quiet", "--replays", "0"]);
    let part = out.join("parts/part-000000008-000000011.parquet");
    let whole = fs::read(&part).unwrap();
    for damaged in [whole[..whole.len() / 2].to_vec(), {
        let mut b = whole.clone();
        b[40] ^= 1;
        b
    }] {
        fs::write(&part, damaged).unwrap();
        let exit = SINCRO.call(&["sweep", "collect", out_text]);
        assert!(exit.status == 2 && exit.stderr.contains("part-000000008"), "{}", exit.stderr);
    }
    fs::write(&part, &whole).unwrap();
    fs::copy(&part, out.join("parts/part-000000009-000000012.parquet")).unwrap();
    let exit = SINCRO.call(&["sweep", "collect", out_text]);
    assert!(exit.status == 2 && exit.stderr.contains("not a part of this campaign"), "{}", exit.stderr);

    fs::remove_file(out.join("parts/part-000000009-000000012.parquet")).unwrap();
    let lock = fs::File::create(out.join(".lock")).unwrap();
    lock.lock().unwrap();
    let exit = SINCRO.call(&["sweep", "collect", out_text]);
    assert!(exit.status == 2 && exit.stderr.contains("another process collects"), "{}", exit.stderr);
    drop(lock);
    call(&["sweep", "collect", out_text, "--replays", "0"]);

    let other = fs::read_to_string(&plan).unwrap().replace("to = 4.0", "to = 5.0");
    fs::write(&plan, other).unwrap();
    let exit = SINCRO.call(&["sweep", path, "--out", out_text]);
    assert!(exit.status == 2 && exit.stderr.contains("another campaign"), "{}", exit.stderr);
    let exit = SINCRO.call(&["sweep", path, "--out", folder.join("..").to_str().unwrap()]);
    assert!(exit.status == 2 && exit.stderr.contains("no part of a campaign"), "{}", exit.stderr);
}

#[test]
fn the_number_of_threads_does_not_show() {
    let folder = SceneFolder::new();
    let plan = plan(&folder);
    let table = |threads: &str| {
        let out = folder.join(threads);
        let flags = ["--threads", threads, "--replays", "0", "--quiet"];
        call(&[&["sweep", plan.to_str().unwrap(), "--out", out.to_str().unwrap()][..], &flags].concat());
        fs::read(out.join("runs.parquet")).unwrap()
    };
    assert!(table("1") == table("5"));
}

#[test]
fn the_example_plan_runs() {
    let folder = SceneFolder::new();
    let (plan, out) = (root().join("examples/sweeps/pid-tuning.toml"), folder.join("out"));
    let said = call(&["sweep", plan.to_str().unwrap(), "--out", out.to_str().unwrap(), "--replays", "0"]);
    assert!(said.contains("of 200 runs are good") && said.contains("worst run"), "{said}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for heading in ["Yield", "Worst runs", "Distributions", "Sensitivities", "Response surfaces", "Scatter matrix"] {
        assert!(page.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
}

#[test]
fn a_tuning_beats_the_gains_of_the_files_at_their_overshoot_and_is_the_same_again() {
    let folder = SceneFolder::new();
    let scene = root().join("scenes/pid-tuning");
    let tune = |name: &str| {
        let out = folder.join(name);
        let free = "parameters.kp=4 in 1..12,parameters.ki=12 in 1..80,parameters.kd=0.24 in 0.02..1";
        let measure = "iae=integral(abs(1 - {/shaft.position}))";
        let fixed = ["tune", scene.to_str().unwrap(), "--free", free, "--measure", measure, "--goal", "iae"];
        let more = ["--subject", "overshoot <= 0.0127936", "--budget", "80", "--out", out.to_str().unwrap()];
        let said = call(&[&fixed[..], &more].concat());
        (said, fs::read(out.join("tune.json")).unwrap())
    };
    let (said, bytes) = tune("first");
    assert!(said.contains("goal iae: 0.15508 → 0.") && said.contains(", kept"), "{said}");
    let text = String::from_utf8(bytes.clone()).unwrap();
    let goals: Vec<f64> = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("\"goal\": "))
        .filter_map(|rest| rest.trim_end_matches(',').parse().ok())
        .collect();
    let (least, most) =
        (goals.iter().copied().fold(f64::INFINITY, f64::min), goals.iter().copied().fold(0.0, f64::max));
    assert!(goals.len() == 2 && least < 0.8 * most, "{text}");
    assert!(tune("second").1 == bytes);
}

#[test]
fn identification_says_what_it_cannot_do() {
    let root = root();
    let scene = |name: &str| root.join("scenes").join(name).display().to_string();
    let data = |name: &str| root.join("examples/identification/data").join(name).display().to_string();
    let refused = |arguments: &[&str], words: &str| {
        let exit = SINCRO.call(arguments);
        assert_eq!(exit.status, 2, "{arguments:?}\n{}{}", exit.stdout, exit.stderr);
        assert!(exit.stderr.contains(words), "{words}\n{}", exit.stderr);
    };
    let (spring, servo, ramp) = (scene("spring-dynamic"), scene("pid-tuning"), scene("motor-ramp"));
    let design = ["fit", &spring, "--free", "/shoulder.damping", "--design"];
    let with =
        |more: &[&'static str]| -> Vec<String> { design.iter().chain(more).map(|word| (*word).to_owned()).collect() };
    for (more, words) in [
        (["/shoulder.initial.velocity=-6..6", "--signal", "/shoulder.position"], "the noise of `/shoulder.position`"),
        (["/shoulder.initial.velocity", "--signal", "/shoulder.position@0.1"], "of `--design` has no bounds"),
    ] {
        let arguments = with(&more);
        refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), words);
    }
    let torque = "/motor.motor_torque=torque@2e-14";
    let exact = ["--signal", torque, "--free", "/motor/link.inertia.zz=2e-12", "--exact"];
    let of_ramp = data("ramp.csv");
    let all: Vec<&str> = ["fit", &ramp, "--data", &of_ramp].into_iter().chain(exact).collect();
    refused(&all, "no exact derivative by `/motor/link.inertia.zz`: the motor of joint `/motor` has a torque limit");
    let of_spring = data("spring.csv");
    let shooting = ["--signal", "/shaft.position=angle", "--free", "/shaft.damping", "--shooting", "5"];
    let all: Vec<&str> = ["fit", &servo, "--data", &of_spring].into_iter().chain(shooting).collect();
    refused(&all, "multiple shooting cannot be done: the scene has a diagram");
    refused(&["sweep", &servo, "--out", "nowhere"], "the experiment has no campaign");
}
