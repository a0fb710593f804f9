//! Shipped scenes exported as C, compiled and run by the system's compiler: every bit of every state.

use std::path::{Path, PathBuf};
use std::process::Command;

use sincro_compile::scene::{Exported, ReferenceTick, Request, export};
use sincro_scene::overrides::Override;
use sincro_sim::prelude::*;

/// Scenes whose plant, and controller if there is one, can be compiled with fixed steps.
const WHOLE: [&str; 3] = ["two-dof-position", "double-pendulum", "spring-dynamic"];

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

fn exported(name: &str, integrator: &str) -> Exported {
    exported_with(name, &[Override::new("integrator", integrator)])
}

fn exported_with(name: &str, overrides: &[Override]) -> Exported {
    let loaded = load(&scene(name), overrides, Extensions::default()).unwrap_or_else(|found| panic!("{found}"));
    let method = method_for(&loaded).0;
    let mut run = LockStep::new(&loaded, method, false);
    run.start().unwrap();
    let mut reference = Vec::new();
    for k in 0..=loaded.experiment.n_steps.min(2000) {
        if k > 0 {
            run.advance().unwrap();
        }
        let signals = run.control().map_or_else(Vec::new, |control| control.signals().to_vec());
        let state = run.state();
        reference.push(ReferenceTick { q: state.q.clone(), v: state.v.clone(), rotors: state.rotors.clone(), signals });
    }
    let request = Request {
        name: &name.replace('-', "_"),
        title: &loaded.experiment.title,
        model: &loaded.scene.model,
        initial: &loaded.scene.initial,
        commands: &loaded.scene.commands,
        diagram: loaded.controller.as_ref(),
        method,
        h: loaded.experiment.step,
        reference: &reference,
        not_closed: None,
    };
    export(&request).unwrap_or_else(|why| panic!("{name}: {why}"))
}

/// Writes, compiles with `flags` and runs the self-test; its output and whether it is good.
fn self_test(exported: &Exported, name: &str, flags: &[&str]) -> (String, bool) {
    let folder = std::env::temp_dir().join(format!("sincro-c-{}-{name}-{}", std::process::id(), flags.join("")));
    std::fs::create_dir_all(&folder).unwrap();
    for (file, text) in &exported.files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    let sources: Vec<&str> =
        exported.files.iter().map(|(file, _)| file.as_str()).filter(|f| f.ends_with(".c")).collect();
    let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-o", "self-test"];
    let made = Command::new("cc").current_dir(&folder).args(strict).args(flags).args(&sources).output().unwrap();
    assert!(made.status.success(), "{name}: {}", String::from_utf8_lossy(&made.stderr));
    let run = Command::new(folder.join("self-test")).output().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    (String::from_utf8_lossy(&run.stdout).into_owned(), run.status.success())
}

#[test]
fn exported_scenes_have_the_bits_of_the_run() {
    for name in WHOLE {
        for integrator in ["rk4", "semi-implicit-euler"] {
            let exported = exported(name, integrator);
            assert!(exported.missing.is_empty(), "{name}: {:?}", exported.missing);
            assert!(exported.n_test_steps > 100, "{name}");
            let (said, is_good) = self_test(&exported, name, &["-O1"]);
            assert!(is_good && said.contains("as expected"), "{name}, {integrator}: {said}");
        }
    }
}

/// GCC 12 fuses operations of straight-line code in its vectorizer, whatever it is told of contraction.
#[test]
#[cfg(target_arch = "x86_64")]
fn fused_operations_of_the_processor_are_not_used() {
    if !is_x86_feature_detected!("fma") || !is_x86_feature_detected!("avx2") {
        return;
    }
    let exported = exported("free-body", "rk4");
    let (said, is_good) = self_test(&exported, "fused", &["-O2", "-mavx2", "-mfma"]);
    assert!(is_good, "{said}");
}

/// An activation that reaches the end of its range, among the states of elements.
#[test]
fn activations_are_exported_with_the_bits_of_the_run() {
    let motor = "{ mode = \"torque\", command = 2.0, activation = { kind = \"integrator\", range = { upper = 0.3 } } }";
    for integrator in ["rk4", "semi-implicit-euler", "implicit"] {
        let overrides = [Override::new("integrator", integrator), Override::new("/upper.motor", motor)];
        let exported = exported_with("double-pendulum", &overrides);
        assert!(exported.missing.is_empty(), "{integrator}: {:?}", exported.missing);
        let (said, is_good) = self_test(&exported, &format!("activation-{integrator}"), &["-O1"]);
        assert!(is_good && said.contains("as expected"), "{integrator}: {said}");
    }
}

#[test]
fn a_self_test_sees_a_changed_operation() {
    let mut exported = exported("double-pendulum", "rk4");
    let source = exported.files.iter_mut().find(|(file, _)| file == "double_pendulum.c").unwrap();
    let step = source.1.find("plant_step(").unwrap();
    let sum = step + source.1[step..].find(" + ").unwrap();
    source.1.replace_range(sum..sum + 3, " - ");
    let (said, is_good) = self_test(&exported, "changed", &["-O1"]);
    assert!(!is_good && said.contains("-ffp-contract=off"), "{said}");
}
