//! What is integrated together with a mechanism and may drive it between ticks: a block diagram, for one.
//!
//! The mechanism does not know what it is. At every evaluation it is first asked for the commands at that instant, then, with the
//! accelerations that follow, for the rates of its own states. y = (the mechanism's, z).

use sincro_math::Real;

use crate::integrate::{Implicit, System};
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::scratch::Scratch;

/// Something with continuous states of its own.
pub trait Attachment<R: Real> {
    /// Its states z, as they are between steps.
    fn states(&mut self) -> &mut [R];

    /// Told before a sub-step: the instant of a jump at its end, else infinite.
    fn set_corner(&mut self, corner: f64);

    /// The first instant after `t` at which it jumps or has a corner because of time alone.
    fn next_corner(&self, t: f64) -> f64;

    /// Writes the commands that it determines at this instant, with the states `z`; the others are held.
    fn drive(&mut self, seen: &mut Seen<'_, R>, z: &[R], commands: &mut [R]);

    /// The rates of `z`, with the accelerations and motor torques that follow from the commands just given.
    fn slope(&mut self, seen: &mut Seen<'_, R>, response: Response<'_, R>, z: &[R], slope: &mut [R]);

    /// −∂slopeᵢ/∂zᵢ at the instant of the last [`Attachment::slope`], as far as known [1/s]; taken at the new state by implicit methods.
    fn decay(&mut self, decay: &mut [R]);
}

/// A mechanism looked at by its attachment.
#[derive(Debug)]
pub struct Seen<'a, R> {
    /// Time `[s]`.
    pub t: f64,
    /// The model.
    pub model: &'a Model<R>,
    /// Coordinates.
    pub q: &'a [R],
    /// Velocities.
    pub v: &'a [R],
    /// States of rotors.
    pub rotors: &'a [R],
    /// Commands as they were last given; empty while they are being written.
    pub commands: &'a [R],
    /// Memory for kinematics, of any content.
    pub scratch: &'a mut Scratch<R>,
}

/// What follows from the commands.
#[derive(Clone, Copy, Debug)]
pub struct Response<'a, R> {
    /// Accelerations [rad/s²] or [m/s²].
    pub accelerations: &'a [R],
    /// Smooth torque of each motor [N·m] or `[N]`; empty unless totals are tracked.
    pub motor_torque: &'a [R],
}

/// No attachment.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl<R: Real> Attachment<R> for Alone {
    fn states(&mut self) -> &mut [R] {
        &mut []
    }
    fn set_corner(&mut self, _: f64) {}
    fn next_corner(&self, _: f64) -> f64 {
        f64::INFINITY
    }
    #[inline(always)]
    fn drive(&mut self, _: &mut Seen<'_, R>, _: &[R], _: &mut [R]) {}
    #[inline(always)]
    fn slope(&mut self, _: &mut Seen<'_, R>, _: Response<'_, R>, _: &[R], _: &mut [R]) {}
    fn decay(&mut self, _: &mut [R]) {}
}

/// State view of a mechanism at the coordinates last placed and the velocities in `y`.
#[inline(always)]
fn seen<'a, R: Real>(mechanism: &'a mut Mechanism<R>, t: f64, y: &'a [R]) -> Seen<'a, R> {
    let n = mechanism.model.n_v();
    let (v, rotors) = (&y[n..2 * n], &y[mechanism.rotor_states()]);
    let (model, q, commands) = (&mechanism.model, &*mechanism.q, &*mechanism.commands);
    Seen { t, model, q, v, rotors, commands, scratch: &mut mechanism.scratch }
}

/// A mechanism with its attachment as one system.
#[derive(Debug)]
pub struct Coupled<'a, R, A: ?Sized> {
    /// The mechanism.
    pub mechanism: &'a mut Mechanism<R>,
    /// What is attached.
    pub attachment: &'a mut A,
    /// Memory as long as z.
    pub decay: &'a mut [R],
}

impl<R: Real, A: Attachment<R> + ?Sized> Coupled<'_, R, A> {
    #[inline(always)]
    fn drive(&mut self, t: f64, own: &[R], z: &[R]) {
        let mut commands = core::mem::take(&mut self.mechanism.commands);
        self.attachment.drive(&mut seen(self.mechanism, t, own), z, &mut commands);
        self.mechanism.commands = commands;
    }

    #[inline(always)]
    fn rates(&mut self, t: f64, own: &[R], own_slope: &[R], z: &[R], slope: &mut [R]) {
        let n = self.mechanism.model().n_v();
        let torques = self.mechanism.take_motor_torque();
        let response = Response { accelerations: &own_slope[n..2 * n], motor_torque: &torques };
        self.attachment.slope(&mut seen(self.mechanism, t, own), response, z, slope);
        self.mechanism.put_motor_torque(torques);
    }
}

impl<R: Real, A: Attachment<R> + ?Sized> System<R> for Coupled<'_, R, A> {
    #[inline(always)]
    fn dim(&self) -> usize {
        self.mechanism.dim() + self.decay.len()
    }

    #[inline(always)]
    fn is_controlled(&self, k: usize) -> bool {
        k >= self.mechanism.dim() || self.mechanism.is_controlled(k)
    }

    #[inline(always)]
    fn slope(&mut self, t: f64, y: &[R], slope: &mut [R]) {
        let (own, z) = y.split_at(self.mechanism.dim());
        let (own_slope, z_slope) = slope.split_at_mut(own.len());
        self.mechanism.place(own);
        self.drive(t, own, z);
        self.mechanism.slope(t, own, own_slope);
        self.rates(t, own, own_slope, z, z_slope);
    }

    #[inline(always)]
    fn implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]) {
        let (own, z) = y.split_at(self.mechanism.dim());
        let (own_slope, z_slope) = slope.split_at_mut(own.len());
        self.mechanism.place(own);
        self.drive(t, own, z);
        self.mechanism.implicit_slope(t, h, implicit, own, own_slope);
        if z.is_empty() {
            return;
        }
        self.rates(t, own, own_slope, z, z_slope);
        self.attachment.decay(self.decay);
        for (slope, decay) in z_slope.iter_mut().zip(&*self.decay) {
            *slope = *slope / (R::one() + R::splat(h) * *decay);
        }
    }

    #[inline(always)]
    fn rechart(&mut self, y: &mut [R]) {
        let n = self.mechanism.dim();
        self.mechanism.rechart(&mut y[..n]);
    }

    fn magnitude(&self, y: &[R], k: usize) -> f64 {
        let n = self.mechanism.dim();
        if k < n { self.mechanism.magnitude(&y[..n], k) } else { y[k].lane(0).abs() }
    }
}
