//! Signals of a diagram's scopes are recorded and plotted, through bundles and from the world too.

use sincro_testing::scenes;

#[test]
fn scopes_record_and_plot_what_their_wires_come_from() {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "damping = 0.5", "damping = 0.5\nmotor = { mode = \"torque\" }");
    folder.write(
        "experiment.toml",
        "title = \"T\"\nscene = \"scene.toml\"\ndiagram = \"d.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"energy.total\"]\n",
    );
    folder.write(
        "d.toml",
        r#"wires = ["[/shoulder.position, k] -> look.u1", "/shoulder.velocity -> k", "k -> /shoulder", "/shoulder.acceleration -> look.u2"]
[[block]]
name = "k"
type = "gain"
gain = -2
[[block]]
name = "look"
type = "scope"
title = "Shoulder"
inputs = 2
"#,
    );
    let loaded = folder.load(&[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let recorded: Vec<&str> = loaded.experiment.record.iter().map(|r| r.value.as_str()).collect();
    assert_eq!(recorded, ["energy.total", "/shoulder.position", "k", "/shoulder.acceleration"]);
    let plot = &loaded.experiment.plots[0];
    assert_eq!((plot.title.as_str(), plot.signals.len()), ("Shoulder", 3));
}
