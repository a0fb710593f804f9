//! No allocation in a step after the first, whatever the integrator, and none in recording a row.

use std::path::Path;

use sincro_dynamics::world::MethodKind;
use sincro_sim::load;
use sincro_sim::record::Recorder;
use sincro_sim::run::world_of;

const METHODS: [MethodKind; 5] = [
    MethodKind::SemiImplicitEuler,
    MethodKind::Rk4,
    MethodKind::Implicit,
    MethodKind::DormandPrince,
    MethodKind::Stiff,
];

#[test]
fn a_step_and_a_row_allocate_nothing() {
    // jumps of motors every tick, limits and events, quaternions, external signals
    for name in ["motor-ramp", "flexible-velocity-step", "alexandros-release", "free-body", "two-dof-open-loop"] {
        let loaded = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name), &[]).unwrap();
        for method in METHODS {
            let mut world = world_of(&loaded.scene, &loaded.experiment, method, false);
            let mut recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model).unwrap();
            let step = loaded.experiment.step;
            let mut tick = |k: u32, start: bool| {
                let t = f64::from(k) * step;
                for (command, signal) in world.state.commands.iter_mut().zip(&loaded.scene.commands) {
                    *command = signal.value(t);
                }
                world.advance(t, step).unwrap();
                recorder.row(&world.observe(t + step), t + step, start).len()
            };
            tick(0, true);
            let count = allocation_counter::measure(|| {
                (1..30).for_each(|k| {
                    tick(k, false);
                });
            });
            assert_eq!(count.count_total, 0, "{name} {method:?}");
        }
    }
}
