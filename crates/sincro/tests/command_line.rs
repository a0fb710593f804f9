//! The contract of the command line, on the program as it is built: files, exit status, messages.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sincro_testing::scenes::ROD_PENDULUM;
use sincro_testing::{CommandLine, Exit, SceneFolder};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

/// Puts the folder `pendulum` into a folder; `experiment` and `scene` are put behind what is always there.
fn pendulum(folder: &SceneFolder, experiment: &str, scene: &str) -> PathBuf {
    std::fs::create_dir_all(folder.join("pendulum")).unwrap();
    folder.write("pendulum/experiment.toml", &format!("{EXPERIMENT}{experiment}"));
    folder.write("pendulum/scene.toml", &format!("{ROD_PENDULUM}{scene}"));
    folder.join("pendulum")
}

const EXPERIMENT: &str = r#"
title = "A <pendulum> & more"
scene = "scene.toml"
duration = 0.5
step = 0.01
record = ["/hinge.position", "energy.balance", "/hinge/rod.position.z"]

[[check]]
name = "no energy appears or is lost"
signal = "energy.balance"
value = 0.0
tolerance = 1e-7
"#;

/// Runs a scene into `out`; standard output, standard error, exit status.
fn run(scene: &Path, out: &Path, more: &[&str]) -> (String, String, i32) {
    let Exit { stdout, stderr, status } = SINCRO.run(scene, out, more);
    (stdout, stderr, status)
}

#[test]
fn a_run_writes_what_the_contract_says() {
    let folder = SceneFolder::new();
    let (scene, out) = (pendulum(&folder, "", ""), folder.join("out"));
    let (stdout, stderr, exit) = run(&scene, &out, &[]);
    assert_eq!(exit, 0, "{stdout}{stderr}");
    assert!(stdout.contains("the check holds"), "{stdout}");
    let csv = fs::read_to_string(out.join("signals.csv")).unwrap();
    assert_eq!(csv.lines().next(), Some("t,/hinge.position,energy.balance,/hinge/rod.position.z"));
    assert_eq!(csv.lines().count(), 52);
    let json = fs::read_to_string(out.join("run.json")).unwrap();
    for key in ["model_hash", "trace_hash", "columns", "error_bar", "checks", "wall_time_s", "real_time_factor"] {
        assert!(json.contains(&format!("\"{key}\"")), "{key}");
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("A &lt;pendulum&gt; &amp; more") && !page.contains("<pendulum>"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http") && !page.contains("<script src"));
    assert!(page.contains("id=\"sincro-film\"") && out.join("replay.json").is_file());
    assert!(fs::read_dir(out.join("figures")).unwrap().count() >= 2);
    assert!(!out.join("signals.csv.partial").exists());
}

#[test]
fn signals_of_different_units_do_not_share_an_axis() {
    let folder = SceneFolder::new();
    let plot = "\n[[plot]]\ntitle = \"Both\"\nsignals = [\"/hinge.position\", \"/hinge/rod.position.z\"]\n";
    let scene = pendulum(&folder, plot, "");
    let out = folder.join("out");
    assert_eq!(run(&scene, &out, &[]).2, 0);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let from = page.find(">Both<").expect("the plot is there");
    let figure = &page[from..from + page[from..].find("</figure>").unwrap()];
    assert!(figure.contains("[rad]") && figure.contains("[m]"), "{figure:.2000}");
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let folder = SceneFolder::new();
    let scene = pendulum(&folder, "", "");
    let signals = |name: &str| {
        run(&scene, &folder.join(name), &[]);
        fs::read(folder.join(name).join("signals.csv")).unwrap()
    };
    assert_eq!(signals("one"), signals("two"));
}

#[test]
fn a_check_that_fails_is_status_one() {
    let folder = SceneFolder::new();
    let scene = pendulum(
        &folder,
        "[[check]]\nname = \"wrong\"\nsignal = \"/hinge.position\"\nat = 0.5\nvalue = 7.0\ntolerance = 0.1\n",
        "",
    );
    let (stdout, _, exit) = run(&scene, &folder.join("out"), &[]);
    assert_eq!(exit, 1);
    assert!(stdout.contains("FAIL  wrong") && stdout.contains("expected 7.0000000"), "{stdout}");
}

#[test]
fn findings_of_the_audit_are_status_one_and_no_green_banner() {
    let folder = SceneFolder::new();
    let motor = "motor = { mode = \"velocity\", command = { sine = { amplitude = 1.0, frequency_hz = 400.0 } } }\n";
    let scene = pendulum(&folder, "", "");
    fs::write(scene.join("scene.toml"), ROD_PENDULUM.replacen("\n\n[[body]]", &format!("\n{motor}\n[[body]]"), 1))
        .unwrap();
    let out = folder.join("out");
    let (stdout, stderr, exit) = run(&scene, &out, &[]);
    assert_eq!(exit, 1, "{stdout}{stderr}");
    assert!(
        stdout.contains("ok    no energy") && stdout.contains("the audit has 1 finding; the check holds"),
        "{stdout}"
    );
    assert!(stdout.contains("audit: source frequency of /hinge is 400 Hz at t = 0 s, allowed 50 Hz"), "{stdout}");
    assert!(stdout.contains("help: take step = "), "{stdout}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("class=\"banner bad\"") && !page.contains("class=\"banner good\""));
    assert!(page.contains("<h2>Audit</h2>") && page.contains("source frequency") && page.contains("Hz"));
    let json = fs::read_to_string(out.join("run.json")).unwrap();
    assert!(
        json.contains("\"audit\": {\n    \"ok\": false") && json.contains("\"law\": \"source-frequency\""),
        "{json}"
    );
    // known before a run
    let checked = SINCRO.call(&["check", scene.to_str().unwrap()]);
    assert_eq!((checked.status, checked.stdout.contains("audit: source frequency")), (1, true));
    assert_eq!(run(&scene, &folder.join("fine"), &["--step", "0.001"]).2, 0);
}

#[test]
fn settings_reach_scene_and_experiment() {
    let folder = SceneFolder::new();
    let (scene, out) = (pendulum(&folder, "", ""), folder.join("out"));
    let set = ["--set", "/hinge.initial.position=0.5", "--until", "0.2", "--step", "0.02", "--integrator", "rk4"];
    let (_, stderr, exit) = run(&scene, &out, &set);
    assert!(exit <= 1, "{stderr}");
    let csv = fs::read_to_string(out.join("signals.csv")).unwrap();
    assert_eq!(csv.lines().nth(1).unwrap().split(',').nth(1), Some("0.5"));
    assert_eq!(csv.lines().count(), 12);
    let json = SINCRO.call(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--json"]).stdout;
    assert!(json.trim_start().starts_with('{') && json.contains("\"dormand-prince\""));
}

#[test]
fn bad_input_is_status_two_and_writes_nothing() {
    let folder = SceneFolder::new();
    let out = folder.join("out");
    let cases: [(&str, &str, &[&str], &str); 13] = [
        ("", "[[body]]\nname = \"x\"\nmasss = 1.0\n", &[], "masss"),
        (
            "",
            "[[body]]\nname = \"x\"\nparent = \"/hing\"\nmass = 1.0\ninertia = { xx = 1, yy = 1, zz = 1 }\n",
            &[],
            "/hing",
        ),
        ("", "[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\n", &[], "hinge"),
        ("", "[[joint]]\nname = \"lonely\"\nkind = \"revolute\"\n", &[], "lonely"),
        ("", "gravity = = 3\n", &[], "scene.toml"),
        ("record_every = \"two\"\n", "", &[], "record_every"),
        ("", "", &["--set", "/hinge.axis=[0, 0, 0]"], "axis"),
        ("", "", &["--set", "/hinge/rod.density=-1"], "density"),
        ("", "", &["--set", "/nobody.mass=1"], "/nobody"),
        ("", "", &["--set", "step=0"], "step"),
        ("", "", &["--until", "-1"], "duration"),
        ("", "", &["--accuracy", "1e-23"], "1e-14"),
        ("", "", &["--set", "record=[\"/hinge.positon\"]"], "positon"),
    ];
    for (experiment, scene, more, named) in cases {
        let folder = pendulum(&folder, "", "");
        let with = |file: &str, base: &str, text: &str| {
            // top-level keys must stand before the tables
            let whole = if text.starts_with('[') { format!("{base}{text}") } else { format!("{text}{base}") };
            fs::write(folder.join(file), whole).unwrap();
        };
        with("experiment.toml", EXPERIMENT, experiment);
        with("scene.toml", ROD_PENDULUM, scene);
        let (stdout, stderr, exit) = run(&folder, &out, more);
        assert_eq!(exit, 2, "{experiment}{scene}{more:?}: {stdout}{stderr}");
        assert!(stderr.contains("error") && stderr.contains(named), "{named}: {stderr}");
        assert!(!out.exists(), "{named}: something was written");
    }
    let (_, stderr, exit) = run(&folder.join("nowhere"), &out, &[]);
    assert!(exit == 2 && stderr.contains("nowhere"), "{stderr}");
}

#[test]
fn negative_numbers_are_values_and_refused_by_what_they_mean() {
    let folder = SceneFolder::new();
    let scene = pendulum(&folder, "", "");
    let cases: [(&str, &[&str], &str); 6] = [
        ("linearize", &["--at", "-1"], "there is no operating point at -1 s"),
        ("trim", &["--from", "-1"], "there is no operating point at -1 s"),
        ("run", &["--seed", "-1"], "expected a whole number from 0 on"),
        ("run", &["--accuracy", "-1"], "`accuracy` is -1"),
        ("tune", &["--budget", "-1"], "expected a whole number from 0 on"),
        ("check", &["--mutate", "-1"], "-1"),
    ];
    for (command, more, said) in cases {
        let run = Command::new(env!("CARGO_BIN_EXE_sincro")).arg(command).arg(&scene).args(more).output().unwrap();
        let stderr = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{command} {more:?}: {stderr}");
        assert!(stderr.contains(said) && !stderr.contains("unexpected argument"), "{command} {more:?}: {stderr}");
    }
}

/// Mass on a rail under a sampled gain.
fn sampled_rail() -> SceneFolder {
    let scene = "[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\ndamping = 3.0\nmotor = { mode = \"torque\" }\n[[body]]\nname = \"cart\"\n\
                 parent = \"/rail\"\nmass = 2.0\ninertia = { xx = 1.0, yy = 1.0, zz = 1.0 }\n";
    let diagram = "wires = [\"/rail.position -> control -> /rail\"]\n[[block]]\nname = \"control\"\ntype = \"gain\"\ngain = -40.0\n\
                   unit = \"N\"\nsample_time = 0.02\n";
    let experiment = "title = \"Rail\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\n\
                      record = [\"/rail.position\"]\n";
    SceneFolder::of(&format!("gravity = [0.0, 0.0, 0.0]\n{scene}"), experiment).with("diagram.toml", diagram)
}

#[test]
fn a_sampled_loop_is_opened_by_name() {
    let folder = sampled_rail();
    let scene = folder.to_str().unwrap();
    let program = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));
    let out = folder.join("linear");
    let found = program.call(&["linearize", scene, "--sampled", "--loop", "/rail", "--out", out.to_str().unwrap()]);
    assert_eq!(found.status, 0, "{}", found.stderr);
    assert!(found.stdout.contains("open loops, closed by −1"), "{}", found.stdout);
    let json = fs::read_to_string(out.join("linearization.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["loops"][0]["samples_per_period"], 1);
    assert!(json["loops"][0]["phase_margins_deg"][0]["value"].as_f64().unwrap() > 0.0, "{json}");
    assert!(out.join("figures/loop-01-bode.svg").is_file());
    // without a name the signals are listed
    let found = program.call(&["linearize", scene, "--sampled"]);
    assert!(found.stdout.contains("open a loop with --loop at one of `control`"), "{}", found.stdout);
}

#[test]
fn wrong_names_and_values_of_an_analysis_are_refused_and_nothing_is_written() {
    let folder = sampled_rail();
    let scene = folder.to_str().unwrap();
    let program = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));
    let out = folder.join("linear");
    let cases: [(&[&str], &str); 11] = [
        (&["linearize", "--sampled", "--loop", "contrl"], "there is no signal `contrl`"),
        (&["linearize", "--sampled", "--loop", "/rail.position"], "no block of the diagram gives `/rail.position`"),
        (&["linearize", "--loop", "control"], "--sampled"),
        (&["linearize", "--at", "nan"], "there is no operating point at NaN s"),
        (&["linearize", "--input", "/nowhere"], "there is no input `/nowhere`"),
        (&["linearize", "--output", "/rail.positon"], "there is no signal `/rail.positon`"),
        (&["linearize", "--lqr-q", "nan,1", "--lqr-r", "1"], "--lqr-q"),
        (&["trim", "--want", "/rail.position=nan"], "is no signal with a value"),
        (&["trim", "--want", "/rail.position"], "is no signal with a value"),
        (&["trim", "--free", "/nowhere"], "there is no input `/nowhere`"),
        (&["trim", "--from", "inf"], "there is no operating point at inf s"),
    ];
    for (arguments, said) in cases {
        let all = [&[arguments[0], scene], &arguments[1..], &["--out", out.to_str().unwrap()]].concat();
        let found = program.call(&all);
        assert!(found.status == 2 && found.stderr.contains(said), "{arguments:?}: {} {}", found.status, found.stderr);
        assert!(!out.exists(), "{arguments:?}");
    }
}

#[test]
fn results_that_cannot_be_written_are_refused_before_the_run() {
    let folder = SceneFolder::new();
    let scene = pendulum(&folder, "", "");
    fs::write(folder.join("file"), "in the way").unwrap();
    let (_, stderr, exit) = run(&scene, &folder.join("file/below"), &[]);
    assert!(exit == 2 && stderr.contains("file") && stderr.contains("--out"), "{stderr}");
}

#[test]
fn a_run_that_blows_up_is_status_three_and_keeps_its_rows() {
    let folder = SceneFolder::new();
    let joint = "[[joint]]\nname = \"stiff\"\nparent = \"/hinge/rod\"\nkind = \"revolute\"\ndamping = 1e6\n";
    let body = "[[body]]\nname = \"tip\"\nparent = \"/hinge/rod/stiff\"\nposition = [0.1, 0.0, 0.0]\ndensity = 1000.0\nshape = [{ sphere = { radius = 0.05 } }]\n";
    let (scene, out) = (pendulum(&folder, "", &format!("{joint}{body}")), folder.join("out"));
    let (stdout, _, exit) = run(&scene, &out, &["--integrator", "rk4", "--set", "/hinge/rod/stiff.initial.velocity=1"]);
    assert_eq!(exit, 3, "{stdout}");
    // announced before it diverges, then explained
    assert!(
        stdout.contains("warning: joint `/hinge/rod/stiff`") && stdout.contains("is too fast for `rk4`"),
        "{stdout}"
    );
    assert!(stdout.contains("stopped: ") && stdout.contains("in tick") && stdout.contains("implicit"), "{stdout}");
    let rows = fs::read_to_string(out.join("signals.csv")).unwrap().lines().count();
    assert!((2..52).contains(&rows), "{rows}");
    let (stdout, _, exit) = run(&scene, &out, &["--set", "/hinge/rod/stiff.initial.velocity=1"]);
    assert!(exit <= 1 && stdout.contains("stiff"), "auto takes it in its stride: {stdout}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_recorded() {
    let folder = SceneFolder::new();
    let (scene, out) = (pendulum(&folder, "", ""), folder.join("out"));
    let mut child = Command::new(env!("CARGO_BIN_EXE_sincro"))
        .args(["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()])
        .args(["--until", "50000", "--set", "record_every=1000"])
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    while !folder.join(".out.running/signals.csv.partial").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
        assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8(output.stdout).unwrap().contains("interrupted at t ="));
    let json = fs::read_to_string(out.join("run.json")).unwrap();
    assert!(json.contains("\"interrupted\"") && out.join("signals.csv").is_file());
}

#[test]
fn check_looks_a_scene_over_and_writes_nothing() {
    let folder = SceneFolder::new();
    let scene = pendulum(&folder, "", "");
    let output = SINCRO.call(&["check", scene.to_str().unwrap(), "--signals"]);
    let stdout = output.stdout;
    assert_eq!(output.status, 0, "{stdout}");
    let compiled = "compilable: the accelerations, not the steps: the steps of a method with error control differ";
    for words in ["revolute joint", "1 degree of freedom", "/hinge.position", "dormand-prince", compiled] {
        assert!(stdout.contains(words), "{words}: {stdout}");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// The energy balance notices nothing; a check of the angle notices what moves it.
#[test]
fn mutate_names_the_numbers_that_no_check_notices() {
    let mutate = |checks: &str, more: &[&str]| {
        let folder = SceneFolder::new();
        let scene = pendulum(&folder, checks, "");
        let output = SINCRO.call(&[&["check", scene.to_str().unwrap(), "--mutate", "1e-2"], more].concat());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is written");
        (output.stdout, output.stderr, output.status)
    };
    let counts = |stdout: &str| {
        let last = stdout.lines().last().unwrap().to_owned();
        let (all, unnoticed) = last.split_once(" numbers, ").unwrap();
        (all.parse::<usize>().unwrap(), unnoticed.strip_suffix(" unnoticed").unwrap().parse::<usize>().unwrap())
    };
    let (blind, _, status) = mutate("", &[]);
    let (all, unnoticed) = counts(&blind);
    assert!(status == 1 && unnoticed > 0 && unnoticed <= all, "{blind}");
    assert!(blind.contains("unnoticed  /hinge.initial.position") && blind.contains("scene.toml:"), "{blind}");
    assert!(blind.contains("left alone: a factor does not change them"), "{blind}");

    // a variant's checks count too
    let angle =
        "[[variant]]\nname = \"same\"\n[[variant.check]]\nname = \"angle\"\nsignal = \"/hinge.position\"\nat = 0.5\n";
    let seen = {
        let folder = SceneFolder::new();
        let scene = pendulum(&folder, "", "");
        let (_, _, status) = run(&scene, &folder.join("out"), &[]);
        assert_eq!(status, 0);
        let csv = fs::read_to_string(folder.join("out/signals.csv")).unwrap();
        csv.lines().last().unwrap().split(',').nth(1).unwrap().to_owned()
    };
    let (sharp, _, _) = mutate(&format!("{angle}value = {seen}\ntolerance = 1e-8\n"), &[]);
    assert_eq!(counts(&sharp).0, all);
    assert!(counts(&sharp).1 < unnoticed && !sharp.contains("unnoticed  /hinge.initial.position"), "{sharp}");

    // what fails already tells nothing, and a share of zero is none
    let (_, failing, status) = mutate(&format!("{angle}value = 7.0\ntolerance = 1e-8\n"), &[]);
    assert!(status == 2 && failing.contains("the scene as it is fails already: same: angle"), "{failing}");
    let (_, zero, status) = mutate("", &["--mutate=0"]);
    assert!(status == 2, "{zero}");
}

#[test]
fn reproduce_makes_one_page_of_all_scenes() {
    let folder = SceneFolder::new();
    pendulum(&folder, "", "");
    let out = folder.join("out");
    let scenes = folder.to_str().unwrap();
    let output = SINCRO.call(&["reproduce", "--scenes", scenes, "--out", out.to_str().unwrap()]);
    assert_eq!(output.status, 0, "{}", output.stderr);
    let index = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(index.contains("pendulum/report.html") && out.join("pendulum/report.html").is_file());
}

#[test]
fn a_bad_diagram_is_status_two_and_writes_nothing() {
    let folder = SceneFolder::new();
    let (scene, out) = (pendulum(&folder, "", ""), folder.join("out"));
    fs::write(scene.join("experiment.toml"), format!("diagram = \"d.toml\"\n{EXPERIMENT}")).unwrap();
    fs::write(scene.join("d.toml"), "wires = [\"/hinge.position -> pdi\"]\n").unwrap();
    let (_, stderr, exit) = run(&scene, &out, &[]);
    assert!(exit == 2 && stderr.contains("there is no block `pdi`") && stderr.contains("d.toml:1:"), "{stderr}");
    assert!(!out.exists());
}

#[test]
fn a_block_that_stops_the_run_is_status_three_and_keeps_its_rows() {
    let folder = SceneFolder::new();
    let (scene, out) = (pendulum(&folder, "", ""), folder.join("out"));
    fs::write(scene.join("experiment.toml"), format!("diagram = \"d.toml\"\n{EXPERIMENT}")).unwrap();
    let root = "[[block]]\nname = \"root\"\ntype = \"expression\"\ninputs = [\"u\"]\nexpression = \"sqrt(0.1 - u)\"\nsample_time = 0.01\n";
    let clock = "[[block]]\nname = \"clock\"\ntype = \"clock\"\n";
    fs::write(scene.join("d.toml"), format!("wires = [\"clock -> root\"]\n{root}{clock}")).unwrap();
    let (stdout, _, exit) = run(&scene, &out, &[]);
    assert_eq!(exit, 3, "{stdout}");
    assert!(stdout.contains("block `root` (expression) gave NaN in tick 11"), "{stdout}");
    let rows = fs::read_to_string(out.join("signals.csv")).unwrap().lines().count();
    assert!((11..=13).contains(&rows), "{rows}");
}

#[test]
fn blocks_lists_the_library_and_shows_one() {
    let all = SINCRO.call(&["blocks"]);
    assert!(all.status == 0 && all.stdout.contains("transfer-function"));
    let one = SINCRO.call(&["blocks", "low-pass"]).stdout;
    assert!(one.contains("type = \"low-pass\"") && one.contains("time_constant = 1.0"), "{one}");
    let none = SINCRO.call(&["blocks", "gian"]);
    assert!(none.status == 2 && none.stderr.contains("did you mean `gain`?"));
}

#[test]
fn runs_are_compared_to_the_bit() {
    let folder = SceneFolder::new();
    let scene = pendulum(&folder, "", "");
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.join(name));
    run(&scene, &a, &["--mcap"]);
    run(&scene, &b, &[]);
    run(&scene, &c, &["--set", "/hinge.initial.position=1.1"]);
    assert!(fs::read(a.join("run.mcap")).unwrap().starts_with(b"\x89MCAP0\r\n") && !b.join("run.mcap").exists());
    let page = folder.join("diff.html");
    let diff = |first: &Path, second: &Path| {
        let words = [first, second, &page].map(|path| path.to_str().unwrap());
        let output = SINCRO.call(&["diff", words[0], words[1], "--out", words[2]]);
        (output.stdout, output.stderr, output.status)
    };
    let (stdout, _, exit) = diff(&a, &b);
    assert!(exit == 0 && stdout.contains("the same, bit for bit"), "{stdout}");
    let (stdout, _, exit) = diff(&a, &c);
    assert!(exit == 1 && stdout.contains("they part in tick 0") && stdout.contains("/hinge.position"), "{stdout}");
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("id=\"sincro-film\"") && html.contains("/hinge.initial.position = 1.1"));
    let (_, stderr, exit) = diff(&a, &folder.join("nothing"));
    assert!(exit != 0 && stderr.contains("cannot read"), "{stderr}");
}

#[test]
fn a_folder_that_is_no_run_is_not_shown() {
    let folder = SceneFolder::new();
    let output = SINCRO.call(&["replay", folder.to_str().unwrap(), "--no-browser"]);
    assert!(output.status == 2 && output.stderr.contains("replay.json"), "{}", output.stderr);
    fs::write(folder.join("replay.json"), "{}").unwrap();
    let output = SINCRO.call(&["view", folder.to_str().unwrap(), "--no-browser"]);
    assert!(output.status == 2 && output.stderr.contains("is no replay that this version"), "{}", output.stderr);
}

#[test]
fn a_camera_of_the_scene_takes_the_pictures_of_a_run() {
    let folder = SceneFolder::new();
    let lens = "[[camera]]\nname = \"side\"\nposition = [0.0, -2.0, 0.0]\nlook_at = [0.0, 0.0, 0.0]\n";
    let eye = lens.replace("side", "eye").replace("-2.0", "-1.5") + "resolution = [40, 30]\n";
    let (scene, out) = (pendulum(&folder, "", &format!("{lens}{eye}")), folder.join("out"));
    let (_, stderr, _) = run(&scene, &out, &["--frames", "--camera", "eye"]);
    let pictures: Vec<Vec<u8>> = (1..=16).map(|k| fs::read(out.join(format!("frames/{k:04}.png"))).unwrap()).collect();
    assert!(!out.join("frames/0017.png").exists(), "30 a second, half a second: {stderr}");
    for picture in &pictures {
        assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n") && picture[16..24] == [0, 0, 0, 40, 0, 0, 0, 30]);
    }
    assert!(pictures[0] != pictures[15], "the rod swings");
    // one that is no vision sensor has the size of the other pictures
    run(&scene, &out, &["--frames", "--camera", "/side"]);
    assert_eq!(fs::read(out.join("frames/0001.png")).unwrap()[16..24], [0, 0, 3, 192, 0, 0, 2, 28]);
    let (_, stderr, exit) = run(&scene, &folder.join("none"), &["--frames", "--camera", "eve"]);
    assert!(exit == 2 && stderr.contains("there is no camera `eve`"), "{stderr}");
    assert!(stderr.contains("cameras here: /side, /eye") && !folder.join("none").exists(), "{stderr}");
    let (_, stderr, exit) = run(&scene, &out, &["--camera", "eye"]);
    assert!(exit == 2 && stderr.contains("--frames"), "{stderr}");
}
