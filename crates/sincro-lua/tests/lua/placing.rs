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

#[test]
fn a_ball_is_thrown_by_an_initial_velocity_and_a_reset() {
    for order in ["set() sim.resetDynamicObject(box)", "sim.resetDynamicObject(box) set()"] {
        let code = format!(
            "function sysCall_actuation()
                local box = sim.getObject('/box')
                local function set()
                    sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_x, 2)
                    sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_z, 1)
                    sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_b, 3)
                end
                if math.abs(sim.getSimulationTime() - 0.1) < 1e-9 then
                    {order}
                    local v, w = sim.getObjectVelocity(box)
                    print(v[1], v[3] > 0, w[2])
                end
            end"
        );
        let thrown = placing(&code);
        let text = &thrown.messages[0].text;
        assert!(text.starts_with("2.0\t") && text.ends_with("3.0"), "{text}");
        let x = &thrown.table.column("/box_joint/box.position.x").unwrap().values;
        assert!((x[10], (x[20] - 0.2).abs() < 1e-9) == (0.0, true), "{x:?}");
        let balance = &thrown.table.column("energy.balance").unwrap().values;
        assert!(balance.iter().all(|x| x.abs() < 1e-9), "{balance:?}");
    }
}

#[test]
fn without_a_reset_an_initial_velocity_waits_and_is_used_once() {
    let code = "function sysCall_actuation()
            local box, t = sim.getObject('/box'), sim.getSimulationTime()
            local function speed() return sim.getObjectVelocity(box)[1] end
            local function at(when) return math.abs(t - when) < 1e-9 end
            if at(0.05) then
                sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_x, 2)
                print(speed(), sim.getObjectFloatParam(box, sim.shapefloatparam_init_velocity_x))
            end
            if at(0.1) then print(speed()) sim.setObjectPosition(box, -1, { 0, 0, 2 }) print(speed()) end
            if at(0.12) then sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_x, 0) end
            if at(0.15) then sim.resetDynamicObject(box) print(speed()) sim.resetDynamicObject(box) print(speed()) end
        end";
    assert_eq!(said(code), ["0.0\t2.0", "0.0", "2.0", "0.0", "0.0"]);
}

#[test]
fn an_initial_velocity_that_is_set_before_the_run_begins_is_that_of_the_start() {
    let thrown = placing(
        "function sysCall_init()
            local box = sim.getObject('/box')
            sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_x, 2)
            sim.setObjectFloatParam(box, sim.shapefloatparam_init_velocity_z, 1)
            local v = sim.getObjectVelocity(box)
            print(v[1], v[3])
        end",
    );
    assert_eq!(thrown.messages[0].text, "2.0\t1.0");
    let x = &thrown.table.column("/box_joint/box.position.x").unwrap().values;
    assert!((x[20] - 0.4).abs() < 1e-9, "{x:?}");
    let balance = &thrown.table.column("energy.balance").unwrap().values;
    assert!(balance.iter().all(|x| x.abs() < 1e-9), "{balance:?}");
}
