//! The state of a world: the numbers that a snapshot needs to continue bit for bit.
//!
//! The step-size control of a method with error control ([`World::control`](crate::world::World::control)) and the
//! parameters of the model ([`ModelParams`](crate::model::ModelParams)) are values of their own, which a snapshot keeps
//! beside the state.

use sincro_complementarity::{RESERVED_SLOTS, SLOT_LEN};
use sincro_math::Real;

use crate::joint::StageKind;
use crate::model::Model;
use crate::spatial::{Quat, Vec3};

/// State of a world: generalized coordinates and velocities, commands, modes, warm start, totals.
///
/// | field | meaning | length |
/// |---|---|---|
/// | `q` | joint coordinates `[rad]`, `[m]`, quaternions (w, x, y, z) | `n_q` |
/// | `v` | joint velocities [rad/s], [m/s] | `n_v` |
/// | `commands` | latched: of motors, six of each external force that takes them, of rotors | [`Model::n_commands`] |
/// | `drives` | state of each drive: locked (0) or saturated upwards (+1) or downwards (−1) | drives |
/// | `contacts` | warm start: fallback, then slot, multipliers and contact mode of each loaded slot | 1 + 8 × slots, or 0 |
/// | `totals` | work, dissipation and motor impulses since the start ([`crate::state`]) | 2 + motors |
/// | `rotors` | speed of each rotor with a lag; of a stock propeller its mass flow this tick; currents of windings; activations | [`Model::n_rotor_states`] |
/// | `tick` | base steps done | |
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// let initial = State { q: vec![0.5], ..State::new(&model) }; // a pendulum at 0.5 rad, at rest
/// let mut world = World::builder(model).state(initial.clone()).build()?;
/// world.step()?;
/// let after_one = world.state.clone();
/// world.state = initial; // back to the start: the same step gives the same bits
/// world.step()?;
/// assert_eq!(world.state, after_one);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct State<R> {
    /// Coordinates `[rad]`, `[m]`, quaternions (w, x, y, z); n_q, a joint's at
    /// [`JointInfo::q_idx`](crate::model::JointInfo).
    pub q: Vec<R>,
    /// Velocities `[rad/s]`, `[m/s]`; n_v, a joint's at [`JointInfo::v_idx`](crate::model::JointInfo).
    pub v: Vec<R>,
    /// Latched commands, each in the unit of its actuator, in the order of [`Model::n_commands`].
    pub commands: Vec<R>,
    /// State of each drive, in the order of [`Model::drives`]: 0 locked, +1 or −1 saturated upwards or downwards.
    pub drives: Vec<R>,
    /// Warm start of the constraint solver; see the table.
    pub contacts: Vec<R>,
    /// Integrated work `[J]`, dissipated energy `[J]`, then the impulse of each motor `[N·m·s]` or `[N·s]`.
    pub totals: Vec<R>,
    /// Rotor states, in the order of the rotors that have one: speed of a rotor with a lag `[rad/s]`, mass flow of a
    /// stock propeller during the present tick `[kg/s]`; then the current of each winding with inductance `[A]`;
    /// then the activation of each actuator that has one.
    pub rotors: Vec<R>,
    /// Number of base steps since the start.
    pub tick: u64,
}

impl<R: Real> State<R> {
    /// State at rest, with all coordinates zero (quaternions: no rotation), commands and currents zero, rotors and
    /// activations at their initial values.
    #[must_use]
    pub fn new(model: &Model<R>) -> Self {
        let mut q = vec![R::zero(); model.n_q()];
        for link in model.links() {
            match link.kind {
                StageKind::Ball => q[link.q_idx as usize] = R::one(),
                StageKind::Free => q[link.q_idx as usize + 3] = R::one(),
                _ => {}
            }
        }
        let mut rotors: Vec<R> = model.rotors().iter().filter_map(|rotor| rotor.speed.initial()).collect();
        rotors.resize(model.n_rotor_states() - model.activations().len(), R::zero());
        rotors.extend(model.activations().iter().map(|activation| activation.initial));
        Self {
            q,
            v: vec![R::zero(); model.n_v()],
            commands: vec![R::zero(); model.n_commands()],
            drives: vec![R::zero(); model.n_drives()],
            contacts: empty_contacts(model),
            totals: vec![R::zero(); 2 + model.motors().len()],
            rotors,
            tick: 0,
        }
    }

    /// Bytes that it takes on the heap; for memory statistics.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        let n = self.q.len()
            + self.v.len()
            + self.commands.len()
            + self.drives.len()
            + self.contacts.len()
            + self.totals.len()
            + self.rotors.len();
        n * size_of::<R>()
    }
}

/// Warm start without any loaded slot, with memory for the usual number of them.
fn empty_contacts<R: Real>(model: &Model<R>) -> Vec<R> {
    let n_slots = model.constraints().n_slots();
    let mut contacts =
        Vec::with_capacity(if n_slots > 0 { 1 + (1 + SLOT_LEN) * n_slots.min(RESERVED_SLOTS) } else { 0 });
    contacts.extend((n_slots > 0).then(R::zero));
    contacts
}

/// Moves coordinates along a tangent vector: `out = q ⊕ step`, with `q` and `out` of `n_q` entries and `step` of `n_v`,
/// in the units of v times seconds. `out` may not overlap `q`.
///
/// Plain coordinates: a sum. Quaternions: the rotation by the step's angular part, in child axes. The position of a
/// free joint: moved by the step's linear part, turned from child to parent axes.
#[inline(always)]
pub fn displace<R: Real>(model: &Model<R>, q: &[R], step: &[R], out: &mut [R]) {
    if !model.has_quaternions() {
        for ((out, q), step) in out.iter_mut().zip(q).zip(step) {
            *out = *q + *step;
        }
        return;
    }
    for link in model.links() {
        let (i, k) = (link.q_idx as usize, link.v_idx as usize);
        match link.kind {
            StageKind::Ball => turn(&q[i..i + 4], &step[k..k + 3], &mut out[i..i + 4]),
            StageKind::Free => {
                let rot = Quat::from_slice(&q[i + 3..]).matrix();
                let shift = rot.mul_vec(Vec3([step[k + 3], step[k + 4], step[k + 5]]));
                for c in 0..3 {
                    out[i + c] = q[i + c] + shift[c];
                }
                turn(&q[i + 3..i + 7], &step[k..k + 3], &mut out[i + 3..i + 7]);
            }
            _ => out[i] = q[i] + step[k],
        }
    }
}

#[inline(always)]
fn turn<R: Real>(q: &[R], step: &[R], out: &mut [R]) {
    let turn = Quat::exp(Vec3([step[0], step[1], step[2]]));
    Quat::from_slice(q).mul(&turn).normalized().write(out);
}
