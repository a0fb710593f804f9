//! Scripts that put bodies elsewhere while a run is on: fixed ones again and again, free ones with a velocity.

use sincro_sim::prelude::*;
use sincro_sim::run::Simulated;
use sincro_testing::scenes::box_above_floor;

use super::world::{open, run};

const EXPERIMENT: &str = r#"
title = "Placing"
duration = 0.2
step = 0.01
record = ["/box_joint/box.position.x", "/box_joint/box.position.z", "energy.balance"]
error_bar = "none"
"#;

/// A post that is fixed in the world, beside a box that falls.
fn placing(code: &str) -> Simulated {
    let post =
        "[[body]]\nname = \"post\"\nposition = [5.0, 0.0, 0.0]\nshape = [{ cuboid = { size = [0.1, 0.1, 1.0] } }]
contact = {}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n";
    let scene = format!("{}\n{post}", box_above_floor(2.0));
    let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)];
    let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run
}

fn said(code: &str) -> Vec<String> {
    placing(code).messages.into_iter().map(|m| m.text).collect()
}

#[test]
fn a_fixed_body_may_be_put_elsewhere_any_number_of_times_within_a_step() {
    let code = |n: usize| {
        format!(
            "function sysCall_actuation()
                local post = sim.getObject('/post')
                for k = 1, {n} do sim.setObjectPosition(post, -1, {{ 5 + k, 0, sim.getSimulationTime() }}) end
                sim.setObjectPosition(post, -1, {{ 6, 0, sim.getSimulationTime() }})
                if sim.getSimulationTime() == 0 then print(sim.getObjectPosition(post, -1)[1]) end
            end"
        )
    };
    let (many, one) = (placing(&code(300)), placing(&code(0)));
    assert_eq!(many.messages[0].text, "6.0");
    assert_eq!(many.trace, one.trace, "the last place of a step is all that counts");
}

#[test]
fn a_busy_thread_that_moves_a_fixed_body_makes_way_for_the_step() {
    let code = "function sysCall_thread()
            local post, n = sim.getObject('/post'), 0
            while true do
                n = n + 1
                sim.setObjectPosition(post, -1, { 5 + 0.001 * n, 0, 0 })
                sim.setInt32Signal('n', n)
            end
        end
        function sysCall_sensing()
            if sim.getSimulationTime() > 0.185 then print(sim.getInt32Signal('n')) end
        end";
    let said = said(code);
    let n: i64 = said[0].parse().unwrap();
    assert!((20 * 15..=20 * 25).contains(&n), "about twenty a step, not a thousand: {n}");
}
