//! The number type whose arithmetic is written down.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::program::Operation;
use super::recorder;
use crate::elementary::{self, Binary, Bits, Unary};
use crate::{Real, Task};

/// Number of a recording ([`record`](super::record)): the result of one operation of the program. Outside of a
/// recording only the zero of [`Default`] exists.
#[derive(Clone, Copy, Debug, Default)]
pub struct Recorded(pub(super) u32);

impl Recorded {
    /// Returns true if both are the result of one operation.
    #[must_use]
    pub fn is_same(self, other: Self) -> bool {
        self.0 == other.0
    }

    fn constant(self) -> Option<f64> {
        recorder::constant(self)
    }
}

/// Recorded numbers can be compared where both are constant, or the same number; any other comparison is a branch.
impl PartialEq for Recorded {
    fn eq(&self, other: &Self) -> bool {
        match (self.constant(), other.constant()) {
            (Some(a), Some(b)) => a == b,
            _ if self.0 == other.0 => true,
            _ => {
                recorder::fail("it compares computed numbers");
                false
            }
        }
    }
}

impl Add for Recorded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        recorder::push(Operation::Add(self.0, other.0))
    }
}

impl Sub for Recorded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        recorder::push(Operation::Sub(self.0, other.0))
    }
}

impl Mul for Recorded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        recorder::push(Operation::Mul(self.0, other.0))
    }
}

impl Div for Recorded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        recorder::push(Operation::Div(self.0, other.0))
    }
}

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        recorder::push(Operation::Neg(self.0))
    }
}

impl AddAssign for Recorded {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Recorded {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Recorded {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Real for Recorded {
    /// More than one, so that an algorithm takes its branch-free way for lanes. The true number of lanes is that of
    /// the recording.
    const LANES: usize = 2;

    // a recording is made once for a scene: one compiled copy of a task for all its callers
    #[inline(never)]
    fn run_hot<T: Task>(task: T) -> T::Output {
        task.run()
    }

    fn splat(x: f64) -> Self {
        recorder::push(Operation::Constant(x))
    }

    /// A constant if it is the same in all lanes of the recording, else a parameter of the program.
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
        recorder::from_lanes(f)
    }

    fn lane(self, _: usize) -> f64 {
        self.constant().unwrap_or_else(|| {
            recorder::fail("it branches on a computed number");
            f64::NAN
        })
    }

    fn sqrt(self) -> Self {
        recorder::push(Operation::Sqrt(self.0))
    }

    fn sin_cos(self) -> (Self, Self) {
        (recorder::push(Operation::Sin(self.0)), recorder::push(Operation::Cos(self.0)))
    }

    fn abs(self) -> Self {
        recorder::push(Operation::Abs(self.0))
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        recorder::push(Operation::IfLess([self.0, bound.0, then.0, otherwise.0]))
    }

    fn unary(self, f: Unary) -> Self {
        recorder::push(Operation::Unary(f, self.0))
    }

    fn binary(self, f: Binary, other: Self) -> Self {
        recorder::push(Operation::Binary(f, self.0, other.0))
    }

    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        match self.constant() {
            Some(x) => Self::splat(f(x).0),
            None => unknown_function(),
        }
    }

    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self {
        match (self.constant(), other.constant()) {
            (Some(x), Some(y)) => Self::splat(f(x, y).0),
            _ => unknown_function(),
        }
    }
}

fn unknown_function() -> Recorded {
    recorder::fail("it calls a function that has no name among the elementary ones");
    Recorded::splat(f64::NAN)
}

impl Bits for Recorded {
    fn copysign(self, sign: Self) -> Self {
        recorder::push(Operation::CopySign(self.0, sign.0))
    }

    fn if_odd(n: Self, odd: Self, even: Self) -> Self {
        recorder::push(Operation::IfOdd([n.0, odd.0, even.0]))
    }

    fn flip_by<const BIT: u32>(self, n: Self) -> Self {
        recorder::push(Operation::FlipBy { x: self.0, n: n.0, bit: BIT })
    }

    fn all_below(self, _: f64) -> bool {
        true
    }
}

/// Sine and cosine of the angle `x` `[rad]`, in this order, as the operations that they are made of; right for |x|
/// below [`elementary::REDUCTION_LIMIT`]. For the back ends of compilers, which write them once as a function.
#[must_use]
pub fn sin_cos_of_operations(x: Recorded) -> (Recorded, Recorded) {
    elementary::sin_cos_lanes(x)
}
