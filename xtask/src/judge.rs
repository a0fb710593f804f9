//! `cargo xtask judge NAME`: comparisons with other programs and with public files, which take longer than tests and
//! need a package index.

use std::path::Path;
use std::process::Command;

/// A judge: what it does with the workspace's folder; true if its bounds hold.
type Judge = fn(&Path) -> bool;

/// The judges by name.
const JUDGES: &[(&str, Judge)] = &[
    ("accuracy", accuracy),
    ("campaigns", campaigns),
    ("error-bars", error_bars),
    ("exported-c", exported_c),
    ("import", import),
    ("learning", learning),
    ("processors", processors),
];

/// Runs a judge; true if its bounds hold.
pub fn run(root: &Path, name: Option<&str>) -> bool {
    match JUDGES.iter().find(|(known, _)| Some(*known) == name) {
        Some((_, judge)) => judge(root),
        None => {
            let names: Vec<&str> = JUDGES.iter().map(|(name, _)| *name).collect();
            eprintln!("usage: cargo xtask judge {}", names.join(" | "));
            false
        }
    }
}

/// Runs the problems of third parties, compares them with their truths and with MuJoCo, and writes the table of
/// `docs/accuracy.md`.
fn accuracy(root: &Path) -> bool {
    let work = root.join("target/judges/accuracy");
    let venv = work.join("venv");
    let python = venv.join("bin/python");
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(Command::new("python3").args(["-m", "venv"]).arg(&venv))
        && crate::runs(Command::new(&python).args(["-m", "pip", "install", "-q", "mujoco==4.0.0", "numpy"]))
        && crate::runs(
            Command::new(&python)
                .arg(root.join("crates/sincro/tests/judges/accuracy.py"))
                .args([root.join("target/release/sincro"), work])
                .arg("--markdown")
                .arg(root.join("docs/accuracy.md")),
        )
}

/// Makes 10,000 runs in 1, 2 and 7 shards that are killed at random times, and compares the bytes of their tables.
fn campaigns(root: &Path) -> bool {
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(
            Command::new("python3")
                .arg(root.join("crates/sincro/tests/judges/campaigns.py"))
                .args([root.join("target/release/sincro"), root.join("target/judges/campaigns")]),
        )
}

/// Draws mechanisms that switch, close and collide, and holds 2,000 of their signals against their error bars.
fn error_bars(root: &Path) -> bool {
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(
            Command::new("python3")
                .arg(root.join("crates/sincro/tests/judges/error_bars.py"))
                .args([root.join("target/release/sincro"), root.join("target/judges/error-bars")]),
        )
}

/// Exports scenes as C and runs their self-tests with GCC and Clang at all levels, on aarch64 and on a Cortex-M3; needs
/// the Debian packages that the script names.
fn exported_c(root: &Path) -> bool {
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(
            Command::new("python3").arg(root.join("crates/sincro-compile/tests/judges/exported_c.py")).args([
                root.join("target/release/sincro"),
                root.join("scenes"),
                root.join("target/judges/exported-c"),
            ]),
        )
}

/// Imports the robots of public packages, compares their dynamics with Pinocchio and MuJoCo, and writes
/// `docs/import.md`.
fn import(root: &Path) -> bool {
    let work = root.join("target/judges/import");
    let venv = work.join("venv");
    let python = venv.join("bin/python");
    let packages = ["pin==4.1.0", "mujoco==4.0.0", "numpy", "xacro==2.1.1"];
    let program = root.join("target/release/sincro");
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(Command::new("python3").args(["-m", "venv"]).arg(&venv))
        && crate::runs(Command::new(&python).args(["-m", "pip", "install", "-q"]).args(packages))
        && crate::runs(
            Command::new(&python)
                .arg(root.join("crates/sincro-import/tests/judges/judge.py"))
                .args([program.as_path(), work.as_path()])
                .args(["urdf", "sdf", "mjcf", "motion", "bullet", "--markdown"])
                .arg(root.join("docs/import.md")),
        )
}

/// Trains policies for tasks in the box by PPO of stable-baselines3, and writes the learning curves that the notebook
/// shows; needs some gigabytes for PyTorch.
fn learning(root: &Path) -> bool {
    let work = root.join("target/judges/learning");
    let (venv, wheels) = (work.join("venv"), work.join("wheels"));
    let python = venv.join("bin/python");
    let pip = |arguments: &[&str]| {
        let mut command = Command::new(&python);
        command.args(["-m", "pip", "install", "-q"]).args(arguments);
        command
    };
    crate::runs(Command::new("python3").args(["-m", "venv"]).arg(&venv))
        && crate::runs(&mut pip(&["maturin==1.16.0", "gymnasium==1.4.0", "stable-baselines3==2.9.2"]))
        && crate::runs(
            Command::new(venv.join("bin/maturin"))
                .args(["build", "--release", "--manifest-path"])
                .arg(root.join("crates/sincro-python/Cargo.toml"))
                .arg("--out")
                .arg(&wheels),
        )
        && crate::runs(pip(&["--no-index", "--no-deps", "--force-reinstall", "sincro", "--find-links"]).arg(&wheels))
        && crate::runs(
            Command::new(&python)
                .arg(root.join("crates/sincro-python/tests/judges/learning.py"))
                .arg(root.join("docs/notebooks/learning-to-hover.csv"))
                .current_dir(root),
        )
}

/// Runs scenes on emulated processors with and without AVX, and compares their trace hashes with the committed ones;
/// needs the Debian package `qemu-user`.
fn processors(root: &Path) -> bool {
    crate::runs(&mut crate::cargo(&["build", "--release", "--package", "sincro"]))
        && crate::runs(
            Command::new("python3")
                .arg(root.join("crates/sincro/tests/judges/processors.py"))
                .arg(root.join("target/release/sincro"))
                .arg(root.join("tests/regressions/traces.txt"))
                .arg(root.join("target/judges/processors")),
        )
}
