//! Independent equations of the loops of a mechanism, decided once for a run and anew where a position is analysed.
//!
//! Rank is a property of the mechanism, not of one position: at a singular position, such as a parallelogram folded
//! flat, fewer equations are independent than next to it, and off the manifold an overconstrained spatial loop has
//! more. It is therefore decided at the start and at a few nearby configurations that close the loops, and the largest
//! rank counts.

use crate::actuation::DriveKind;
use crate::constraint::rank::{INDEPENDENT, INDEPENDENT_OPEN};
use crate::mechanism::Mechanism;
use crate::recursions::kinematics;
use crate::spatial::Vec3;
use crate::state::displace;

/// Nearby configurations that are looked at, and the number of directions in which they are sought at most.
const TRIALS: usize = 3;
const MAX_DIRECTIONS: u64 = 12;

/// Size of the move to one: of angles `[rad]`, and of distances relative to the mechanism's extent.
const MOVE: f64 = 0.02;

/// Iterations that may close the loops at one.
const MAX_ITERATIONS: usize = 30;

/// Residual of a closed loop relative to the mechanism's extent.
const CLOSED: f64 = 1e-13;

impl Mechanism<f64> {
    /// Decides at coordinates `q` (n_q) which equations of loop joints and gears are used: an independent set, of as
    /// many as are independent there or close by. Returns their number.
    ///
    /// A run keeps the set of its start. Far away the same equations can depend on each other, so analysis decides anew
    /// at each position. Working memory is overwritten; the modes of contacts and drives stay.
    pub fn select_loop_rows(&mut self, q: &[f64]) -> usize {
        let n_bilateral = self.model.constraints().n_bilateral();
        if n_bilateral == 0 || self.constraints.is_none() {
            return 0;
        }
        let base = self.base.clone();
        self.base.copy_from_slice(q);
        kinematics::poses(&self.model, &self.base, &mut self.scratch);
        let extent = self.extent();
        self.projection_scale = extent.min(1.0);
        self.constraints.as_deref_mut().expect("checked").use_all_rows();
        let (mut best, mut found): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
        let (mut sizes, mut squares) = (Vec::new(), Vec::new());
        let mut looked_at = 0;
        for direction in 0..=MAX_DIRECTIONS {
            self.base.copy_from_slice(q);
            self.unlock_joints();
            let moved = (direction > 0).then(|| self.move_along_loops(direction, extent));
            if moved.as_ref().is_some_and(Option::is_none) {
                // nothing moves, in no direction
                break;
            }
            if self.close_loops(extent, moved.flatten().map(|by| (q, by))) {
                looked_at += usize::from(direction > 0);
                self.find_rows(INDEPENDENT, &mut found);
                if found.len() > best.len() {
                    core::mem::swap(&mut best, &mut found);
                    let c = self.constraints.as_deref().expect("checked");
                    sizes.clone_from(&c.row_sizes);
                    squares.clone_from(&c.row_squares);
                }
            }
            if looked_at == TRIALS {
                break;
            }
        }
        if best.is_empty() {
            // the loops cannot be closed here: what the given position says
            self.base.copy_from_slice(q);
            self.find_rows(INDEPENDENT_OPEN, &mut best);
            let c = self.constraints.as_deref().expect("checked");
            sizes.clone_from(&c.row_sizes);
            squares.clone_from(&c.row_squares);
        }
        self.base = base;
        let c = self.constraints.as_deref_mut().expect("checked");
        c.use_rows(&best, n_bilateral);
        c.row_sizes = sizes;
        c.row_squares = squares;
        self.mark_locked();
        best.len()
    }

    /// Lets every degree of freedom move that is one: all but those of force sensors.
    pub(crate) fn unlock_joints(&mut self) {
        self.locked_mask.fill(0.0);
        self.prescribed_acceleration.fill(0.0);
        for drive in self.model.params.drives.iter().filter(|drive| drive.kind == DriveKind::Lock) {
            self.locked_mask[drive.dof] = 1.0;
        }
    }

    /// Assembles the rows of the loops at the chart's origin, factors the mass matrix, and finds the independent ones.
    fn find_rows(&mut self, least: f64, independent: &mut Vec<usize>) {
        let zero = vec![0.0; self.model.n_v()];
        self.place_loops(&zero);
        let c = self.constraints.as_deref_mut().expect("there are loops");
        c.find_independent_rows(&self.model, &self.scratch, least, independent);
    }

    /// Change of velocities that removes the rates of the loops for velocities `v`, at the chart's origin.
    pub(crate) fn velocity_change_of_loops(&mut self, v: &[f64]) -> Vec<f64> {
        let mut kept = Vec::new();
        self.find_rows(INDEPENDENT, &mut kept);
        self.change_by(&kept, Some(v))
    }

    /// Change of coordinates that removes the residuals of the rows `kept`, or, with rates `v`, of these.
    fn change_by(&mut self, kept: &[usize], v: Option<&[f64]>) -> Vec<f64> {
        let mut change = vec![0.0; self.model.n_v()];
        let c = self.constraints.as_deref_mut().expect("there are loops");
        if let Some(v) = v {
            c.motions.place(&self.model, &self.scratch, v);
        }
        c.keep_rows(kept);
        c.project(&self.model, &mut self.scratch, v, &mut change);
        change
    }

    /// Closes the loops from the chart's origin; returns false if they stay open. `moved`: from those coordinates by
    /// that displacement, whose size is kept. Near a singular position, where branches cross, the nearest
    /// configuration that closes the loops may be that position itself, step by step by half the distance.
    fn close_loops(&mut self, extent: f64, mut moved: Option<(&[f64], Vec<f64>)>) -> bool {
        let (mut kept, mut last) = (Vec::new(), f64::INFINITY);
        for _ in 0..MAX_ITERATIONS {
            self.find_rows(INDEPENDENT_OPEN, &mut kept);
            let c = self.constraints.as_deref().expect("there are loops");
            let worst = c.residual.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            // rounding may leave a little more than the limit
            if worst <= CLOSED * extent || (worst >= last && worst <= 1e3 * CLOSED * extent) {
                return true;
            }
            last = worst;
            let change = self.change_by(&kept, None);
            if let Some((from, by)) = &mut moved {
                by.iter_mut().zip(&change).for_each(|(by, change)| *by += *change);
                let largest = self.size_of_move(by, extent);
                if largest < 0.5 * MOVE {
                    by.iter_mut().for_each(|by| *by *= MOVE / largest);
                    self.base.copy_from_slice(from);
                    self.displace_base(by);
                    continue;
                }
            }
            self.displace_base(&change);
        }
        false
    }

    /// Moves the chart's origin a little along the loops, in a direction that depends on `seed`; returns the
    /// displacement, none if nothing can move.
    fn move_along_loops(&mut self, seed: u64, extent: f64) -> Option<Vec<f64>> {
        let mut kept = Vec::new();
        self.find_rows(INDEPENDENT_OPEN, &mut kept);
        let mut random = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut v: Vec<f64> = (0..self.model.n_v())
            .map(|k| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let unit = (random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
                if self.locked_mask[k] > 0.0 { 0.0 } else { unit }
            })
            .collect();
        let change = self.change_by(&kept, Some(&v));
        v.iter_mut().zip(&change).for_each(|(v, change)| *v += *change);
        let largest = self.size_of_move(&v, extent);
        if largest.is_nan() || largest <= 1e-6 {
            return None;
        }
        v.iter_mut().for_each(|v| *v *= MOVE / largest);
        self.displace_base(&v);
        Some(v)
    }

    /// Largest angle of a displacement `[rad]`, or distance relative to the mechanism's extent.
    fn size_of_move(&self, v: &[f64], extent: f64) -> f64 {
        let size = |(k, v): (usize, &f64)| v.abs() / if self.model.is_translation(k) { extent } else { 1.0 };
        v.iter().enumerate().map(size).fold(0.0, f64::max)
    }

    fn displace_base(&mut self, change: &[f64]) {
        displace(&self.model, &self.base, change, &mut self.q);
        core::mem::swap(&mut self.base, &mut self.q);
    }

    /// Largest distance between the origins of links, at the poses last found `[m]`; 1 if all are at one point.
    fn extent(&self) -> f64 {
        let origin = self.scratch.poses.first().map_or(Vec3::zero(), |pose| pose.pos);
        let largest = self.scratch.poses.iter().map(|pose| (pose.pos - origin).norm()).fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}
