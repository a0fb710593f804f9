//! Several worlds side by side, or numbers of one, in the lanes of vector registers.
//!
//! A computation that wants lanes is a [`LaneVisitor`]: generic over the number type, all of it `#[inline(always)]`.
//! [`dispatch_lanes`] compiles it for each vector instruction set and runs the widest that this processor has;
//! [`dispatch_four_lanes`] does so with four lanes on every processor. A portable binary so gets vector speed.
//!
//! The vector types are not nameable outside: whoever holds one has come through the dispatch, on a processor that has
//! it.

mod array;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::Lanes;

use crate::Real;
use crate::real::Task;

/// Computation over any kind of number, to be run by [`dispatch_lanes`] or [`dispatch_four_lanes`]. Its `visit` must be
/// `#[inline(always)]`, and so must everything that it calls, to be compiled for the instruction set that runs it.
///
/// ```
/// use sincro_math::{LaneVisitor, Real, lanes};
///
/// struct Squares;
/// impl LaneVisitor for Squares {
///     type Output = f64;
///     #[inline(always)]
///     fn visit<R: Real>(self) -> f64 {
///         let x = R::from_lanes(|k| k as f64); // one number in each lane
///         (x * x).lane(R::LANES - 1)
///     }
/// }
/// let last = (lanes::width() - 1) as f64;
/// assert_eq!(lanes::dispatch_lanes(Squares), last * last);
/// ```
pub trait LaneVisitor {
    /// Result type.
    type Output;

    /// Runs the computation on numbers of type `R`, bundles of [`Real::LANES`] lanes, and returns its result.
    fn visit<R: Real>(self) -> Self::Output;
}

/// Runs `visitor` on the widest lanes of this processor (8 with AVX-512, 4 with AVX2), or on `f64` if it has neither;
/// returns the visitor's result.
#[inline]
pub fn dispatch_lanes<V: LaneVisitor>(visitor: V) -> V::Output {
    #[cfg(target_arch = "x86_64")]
    match x86::level() {
        x86::Level::Avx512 => return x86::lanes_avx512(visitor),
        x86::Level::Avx2 => return x86::lanes_avx2(visitor),
        x86::Level::Baseline => {}
    }
    visitor.visit::<f64>()
}

/// Runs `visitor` on four lanes, whatever this processor has: sums over four lanes have the same bits everywhere.
/// Returns the visitor's result.
#[inline]
pub fn dispatch_four_lanes<V: LaneVisitor>(visitor: V) -> V::Output {
    #[cfg(target_arch = "x86_64")]
    match x86::level() {
        x86::Level::Avx512 => return x86::four_lanes_avx512(visitor),
        x86::Level::Avx2 => return x86::lanes_avx2(visitor),
        x86::Level::Baseline => {}
    }
    four_lanes_baseline(visitor)
}

/// Four lanes for every processor: one copy, whoever calls it.
#[inline(never)]
fn four_lanes_baseline<V: LaneVisitor>(visitor: V) -> V::Output {
    visitor.visit::<Lanes<4>>()
}

/// Runs `task` compiled for the thirty-two registers of AVX-512 where there are (AVX2 alone brings a scalar nothing).
#[inline]
pub(crate) fn run_scalar<T: Task>(task: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    if x86::level() == x86::Level::Avx512 {
        return x86::scalar_avx512(task);
    }
    scalar_baseline(task)
}

/// A task for every processor: one copy, whoever calls it.
#[inline(never)]
fn scalar_baseline<T: Task>(task: T) -> T::Output {
    task.run()
}

/// Number of lanes with which [`dispatch_lanes`] runs on this processor: 8, 4 or 1.
#[must_use]
pub fn width() -> usize {
    struct Width;
    impl LaneVisitor for Width {
        type Output = usize;
        #[inline(always)]
        fn visit<R: Real>(self) -> usize {
            R::LANES
        }
    }
    dispatch_lanes(Width)
}

/// Writes the sines of `angles` `[rad]`, then their cosines, to `to`, many at a time: for compiled programs, whose
/// calls cost more than what they call. The bits are those of [`Real::sin_cos`].
///
/// # Panics
///
/// If the angles are no whole rows of [`width`] numbers, or `to` is not twice as long.
pub fn sines_and_cosines(angles: &[f64], to: &mut [f64]) {
    struct Sines<'a>(&'a [f64], &'a mut [f64]);
    impl LaneVisitor for Sines<'_> {
        type Output = ();
        #[inline(always)]
        fn visit<R: Real>(self) {
            let Self(angles, to) = self;
            assert!(angles.len() % R::LANES == 0 && to.len() == 2 * angles.len(), "whole rows");
            let (sines, cosines) = to.split_at_mut(angles.len());
            let rows = sines.chunks_exact_mut(R::LANES).zip(cosines.chunks_exact_mut(R::LANES));
            for (angles, (sines, cosines)) in angles.chunks_exact(R::LANES).zip(rows) {
                let (sine, cosine) = R::from_row(angles).sin_cos();
                sine.to_row(sines);
                cosine.to_row(cosines);
            }
        }
    }
    dispatch_lanes(Sines(angles, to));
}

/// Name of the instruction set that [`dispatch_lanes`] uses on this processor, for reports: `AVX-512`, `AVX2` or
/// `baseline`.
#[must_use]
pub fn instruction_set() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    match x86::level() {
        x86::Level::Avx512 => return "AVX-512",
        x86::Level::Avx2 => return "AVX2",
        x86::Level::Baseline => {}
    }
    "baseline"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_lanes_have_the_same_bits_on_every_processor() {
        struct Sum<'a>(&'a [f64]);
        impl LaneVisitor for Sum<'_> {
            type Output = [u64; 4];
            #[inline(always)]
            fn visit<R: Real>(self) -> [u64; 4] {
                let (mut sum, mut lanes) = (R::zero(), [0.0; 4]);
                for row in self.0.chunks_exact(4) {
                    sum += R::from_row(row) * R::splat(row[0]).sqrt();
                }
                sum.to_row(&mut lanes);
                lanes.map(f64::to_bits)
            }
        }
        let numbers: Vec<f64> = (0..400).map(|k| 0.1 + (k * k % 17) as f64 / 3.0).collect();
        let baseline = four_lanes_baseline(Sum(&numbers));
        assert_eq!(dispatch_four_lanes(Sum(&numbers)), baseline);
        #[cfg(target_arch = "x86_64")]
        if x86::level() != x86::Level::Baseline {
            assert_eq!(x86::lanes_avx2(Sum(&numbers)), baseline);
        }
    }

    #[test]
    fn one_lane_changes_alone() {
        struct Change;
        impl LaneVisitor for Change {
            type Output = ();
            #[inline(always)]
            fn visit<R: Real>(self) {
                let numbers = R::from_lanes(|k| k as f64);
                for k in 0..R::LANES {
                    let changed = numbers.with_lane(k, -1.0);
                    (0..R::LANES).for_each(|l| assert_eq!(changed.lane(l), if l == k { -1.0 } else { l as f64 }));
                }
            }
        }
        dispatch_lanes(Change);
        dispatch_four_lanes(Change);
        four_lanes_baseline(Change);
        Change.visit::<f64>();
        assert_eq!(2.0.with_lane(3, 5.0), 5.0);
    }

    #[test]
    fn rows_of_sines_have_the_bits_of_single_ones() {
        let angles: Vec<f64> = (0..2 * width()).map(|k| 0.7 * k as f64 - 3.0).chain(vec![1e7; width()]).collect();
        let mut to = vec![0.0; 2 * angles.len()];
        sines_and_cosines(&angles, &mut to);
        for (k, angle) in angles.iter().enumerate() {
            assert_eq!((to[k], to[angles.len() + k]), Real::sin_cos(*angle), "{angle}");
        }
    }

    /// Every operation once, on a value that differs in each lane.
    struct Everything;

    impl LaneVisitor for Everything {
        type Output = Vec<(f64, f64)>;

        #[inline(always)]
        fn visit<R: Real>(self) -> Self::Output {
            let inputs =
                [0.0, -0.0, 1.5, -2.25, 3.0, -4.5, 1e7, 3.3e-9, f64::NAN, 700.0, -0.7, f64::INFINITY, 1e300, 5e-324];
            let mut out = Vec::new();
            for (i, &input) in inputs.iter().enumerate() {
                let x = R::from_lanes(|k| input + 0.37 * k as f64);
                let y = R::splat(inputs[(i + 3) % inputs.len()]);
                let (s, c) = x.sin_cos();
                let mut z = (x + y) * s - c / (y - R::splat(0.3));
                z += (-x).abs().sqrt();
                z -= x.if_less(y, s, c);
                z *= x.min(y) - x.max(y) + y.clamp_abs(R::one());
                for k in 0..R::LANES {
                    out.push((k as f64, z.lane(k)));
                    out.push((k as f64, s.lane(k)));
                    out.push((k as f64, c.lane(k)));
                }
            }
            out
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let reference = Everything.visit::<Lanes<8>>();
        let of_lane = |all: &[(f64, f64)], k: f64| -> Vec<u64> {
            // a NaN may differ in sign and payload between instruction sets; that it is one may not
            let canonical = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
            all.iter().filter(|(lane, _)| *lane == k).map(|(_, x)| canonical(*x)).collect()
        };
        let agree = |lanes: &[(f64, f64)], width: usize| {
            for k in 0..width {
                assert_eq!(of_lane(&reference, k as f64), of_lane(lanes, k as f64), "lane {k} of {width}");
            }
        };
        agree(&dispatch_lanes(Everything), width());
        // the four lanes of AVX2 also where the dispatch takes the eight of AVX-512
        #[cfg(target_arch = "x86_64")]
        if x86::level() != x86::Level::Baseline {
            agree(&x86::lanes_avx2(Everything), 4);
        }
        struct Scalar;
        impl Task for Scalar {
            type Output = Vec<(f64, f64)>;
            #[inline(always)]
            fn run(self) -> Self::Output {
                Everything.visit::<f64>()
            }
        }
        assert_eq!(of_lane(&reference, 0.0), of_lane(&run_scalar(Scalar), 0.0));
    }
}
