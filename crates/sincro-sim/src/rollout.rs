//! Many worlds of one structure at once: lanes within a processor, threads across them.
//!
//! The result does not depend on the number of threads: each world has the bits it would have alone.

use sincro_dynamics::batch::{self, BatchSettings, BatchWorld};
use sincro_dynamics::model::PackError;

/// Advances all worlds by [`BatchSettings::n_steps`] steps, several in SIMD lanes and on `threads` threads (0: one per
/// processor). Each world's [`BatchWorld::record`] and final state are filled in; they do not depend on the number of
/// threads.
///
/// ```
/// use sincro_dynamics::batch::{BatchSettings, BatchWorld};
/// use sincro_dynamics::joint::JointKind;
/// use sincro_dynamics::model::{BodySpec, JointSpec, ModelBuilder, NodeId, Shape};
/// use sincro_dynamics::spatial::{Pose, Vec3};
/// use sincro_dynamics::state::State;
/// use sincro_dynamics::world::MethodKind;
///
/// // a hundred pendulums of different length
/// let mut worlds: Vec<BatchWorld> = (0..100)
///     .map(|k| {
///         let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
///         let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
///         let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
///         let at = Pose::translation(Vec3([0.0, 0.0, -0.5 - 0.01 * k as f64]));
///         let ball = BodySpec { mass: Shape::Sphere { radius: 0.05 }.mass_properties(1000.0) };
///         builder.body("ball", hinge, at, ball);
///         let model = builder.build().unwrap().0;
///         let mut state = State::new(&model);
///         state.q[0] = 0.3;
///         BatchWorld::new(model, state)
///     })
///     .collect();
/// let settings = BatchSettings { method: MethodKind::Rk4, h: 0.001, n_steps: 1000, record_every: 100 };
/// sincro_sim::rollout::rollout(&mut worlds, &settings, 2).unwrap();
/// assert_eq!(worlds[99].record.len(), 11 * 2);
/// ```
///
/// # Errors
///
/// [`PackError`] if the worlds differ in more than their numbers: they must have the same structure.
pub fn rollout(worlds: &mut [BatchWorld], settings: &BatchSettings, threads: usize) -> Result<(), PackError> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if threads == 0 { available } else { threads };
    let width = sincro_math::lanes::width();
    // whole bundles to each thread, so that lanes are full wherever they can be
    let bundles = worlds.len().div_ceil(width);
    let share = bundles.div_ceil(threads).max(1) * width;
    if share >= worlds.len() {
        return batch::advance(worlds, settings);
    }
    std::thread::scope(|scope| {
        let parts: Vec<_> =
            worlds.chunks_mut(share).map(|part| scope.spawn(move || batch::advance(part, settings))).collect();
        parts.into_iter().try_for_each(|part| part.join().expect("a batch does not panic"))
    })
}
