//! AVX-512 and AVX2 lanes.
//!
//! The intrinsics are `unsafe` because a processor may lack them. The types of this module are private to [`super`]:
//! values of them exist only inside the functions below that are compiled for the instruction set, and those are called
//! only after [`level`] has found it on this processor.
#![allow(unsafe_code)]

use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use core::sync::atomic::{AtomicU8, Ordering};

use super::LaneVisitor;
use crate::Real;
use crate::elementary::{self, Bits};
use crate::real::Task;

/// Instruction set of this processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Baseline,
    Avx2,
    Avx512,
}

/// Asked of the processor once, then one load: it stands before every hot call.
#[inline]
pub(super) fn level() -> Level {
    match KNOWN.load(Ordering::Relaxed) {
        1 => Level::Baseline,
        2 => Level::Avx2,
        3 => Level::Avx512,
        _ => ask(),
    }
}

/// 0 until asked; then what [`level`] says, counted from 1.
static KNOWN: AtomicU8 = AtomicU8::new(0);

#[cold]
fn ask() -> Level {
    let avx512 = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    let (known, level) = if avx512 {
        (3, Level::Avx512)
    } else if is_x86_feature_detected!("avx2") {
        (2, Level::Avx2)
    } else {
        (1, Level::Baseline)
    };
    KNOWN.store(known, Ordering::Relaxed);
    level
}

#[inline]
pub(super) fn lanes_avx512<V: LaneVisitor>(visitor: V) -> V::Output {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
    fn run<V: LaneVisitor>(visitor: V) -> V::Output {
        visitor.visit::<F64x8>()
    }
    assert_eq!(level(), Level::Avx512);
    // SAFETY: the instruction set is there
    unsafe { run(visitor) }
}

#[inline]
pub(super) fn lanes_avx2<V: LaneVisitor>(visitor: V) -> V::Output {
    #[target_feature(enable = "avx2")]
    fn run<V: LaneVisitor>(visitor: V) -> V::Output {
        visitor.visit::<F64x4>()
    }
    assert_ne!(level(), Level::Baseline);
    // SAFETY: the instruction set is there
    unsafe { run(visitor) }
}

/// Four lanes with the thirty-two registers of AVX-512.
#[inline]
pub(super) fn four_lanes_avx512<V: LaneVisitor>(visitor: V) -> V::Output {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
    fn run<V: LaneVisitor>(visitor: V) -> V::Output {
        visitor.visit::<F64x4>()
    }
    assert_eq!(level(), Level::Avx512);
    // SAFETY: the instruction set is there
    unsafe { run(visitor) }
}

#[inline]
pub(super) fn scalar_avx512<T: Task>(task: T) -> T::Output {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
    fn run<T: Task>(task: T) -> T::Output {
        task.run()
    }
    debug_assert_eq!(level(), Level::Avx512);
    // SAFETY: the caller has found the instruction set
    unsafe { run(task) }
}

/// A task on lanes of AVX-512: one copy, whoever calls it.
#[inline]
fn task_avx512<T: Task>(task: T) -> T::Output {
    #[inline(never)]
    #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
    fn run<T: Task>(task: T) -> T::Output {
        task.run()
    }
    // SAFETY: values of the lane type exist only where the instruction set is
    unsafe { run(task) }
}

/// A task on lanes of AVX2.
#[inline]
fn task_avx2<T: Task>(task: T) -> T::Output {
    #[inline(never)]
    #[target_feature(enable = "avx2")]
    fn run<T: Task>(task: T) -> T::Output {
        task.run()
    }
    // SAFETY: as above
    unsafe { run(task) }
}

/// The trait implementations that two vector types share; `$op` are the intrinsics by name.
macro_rules! lanes {
    ($name:ident, $vector:ty, $n:literal, $doc:literal, $task:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident, $set1:ident,
     $load:ident, $store:ident) => {
        #[doc = $doc]
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub(super) struct $name($vector);

        impl $name {
            #[inline(always)]
            fn array(self) -> [f64; $n] {
                let mut out = [0.0; $n];
                // SAFETY: `out` has room for the vector; see the module for the instruction set, here and below
                unsafe { $store(out.as_mut_ptr(), self.0) };
                out
            }
        }

        impl Default for $name {
            #[inline(always)]
            fn default() -> Self {
                Self::splat(0.0)
            }
        }

        impl PartialEq for $name {
            #[inline(always)]
            fn eq(&self, other: &Self) -> bool {
                self.array() == other.array()
            }
        }

        lanes!(@operator $name, Add, add, $add);
        lanes!(@operator $name, Sub, sub, $sub);
        lanes!(@operator $name, Mul, mul, $mul);
        lanes!(@operator $name, Div, div, $div);
        lanes!(@assign $name, AddAssign, add_assign, +);
        lanes!(@assign $name, SubAssign, sub_assign, -);
        lanes!(@assign $name, MulAssign, mul_assign, *);

        impl Real for $name {
            const LANES: usize = $n;

            #[inline(always)]
            fn run_hot<T: Task>(task: T) -> T::Output {
                $task(task)
            }

            #[inline(always)]
            fn splat(x: f64) -> Self {
                Self(unsafe { $set1(x) })
            }

            #[inline(always)]
            fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
                let lanes: [f64; $n] = core::array::from_fn(f);
                Self(unsafe { $load(lanes.as_ptr()) })
            }

            #[inline(always)]
            fn lane(self, k: usize) -> f64 {
                self.array()[k]
            }

            #[inline(always)]
            fn with_lane(self, k: usize, x: f64) -> Self {
                let mut row = self.array();
                row[k] = x;
                Self::from_row(&row)
            }

            #[inline(always)]
            fn from_row(row: &[f64]) -> Self {
                // SAFETY: the slice has as many numbers
                Self(unsafe { $load(row[..$n].as_ptr()) })
            }

            #[inline(always)]
            fn to_row(self, row: &mut [f64]) {
                // SAFETY: the slice has room for as many numbers
                unsafe { $store(row[..$n].as_mut_ptr(), self.0) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                elementary::sin_cos_lanes(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                self.magnitude()
            }

            #[inline(always)]
            fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
                self.select_less(bound, then, otherwise)
            }

            #[inline(always)]
            fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
                let x = self.array();
                Self::from_lanes(|k| f(x[k]).0)
            }

            #[inline(always)]
            fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self {
                let (x, y) = (self.array(), other.array());
                Self::from_lanes(|k| f(x[k], y[k]).0)
            }
        }
    };
    (@operator $name:ident, $trait:ident, $method:ident, $op:ident) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(unsafe { $op(self.0, other.0) })
            }
        }
    };
    (@assign $name:ident, $trait:ident, $method:ident, $op:tt) => {
        impl $trait for $name {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
}

lanes!(
    F64x8,
    __m512d,
    8,
    "Eight lanes of AVX-512.",
    task_avx512,
    _mm512_add_pd,
    _mm512_sub_pd,
    _mm512_mul_pd,
    _mm512_div_pd,
    _mm512_sqrt_pd,
    _mm512_set1_pd,
    _mm512_loadu_pd,
    _mm512_storeu_pd
);

lanes!(
    F64x4,
    __m256d,
    4,
    "Four lanes of AVX2.",
    task_avx2,
    _mm256_add_pd,
    _mm256_sub_pd,
    _mm256_mul_pd,
    _mm256_div_pd,
    _mm256_sqrt_pd,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd
);

const SIGN: f64 = -0.0;

impl Neg for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(SIGN)) })
    }
}

impl Neg for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(SIGN)) })
    }
}

impl F64x8 {
    #[inline(always)]
    fn magnitude(self) -> Self {
        Self(unsafe { _mm512_andnot_pd(_mm512_set1_pd(SIGN), self.0) })
    }

    #[inline(always)]
    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let less = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, bound.0);
            _mm512_mask_blend_pd(less, otherwise.0, then.0)
        })
    }
}

impl F64x4 {
    #[inline(always)]
    fn magnitude(self) -> Self {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(SIGN), self.0) })
    }

    #[inline(always)]
    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let less = _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, bound.0);
            _mm256_blendv_pd(otherwise.0, then.0, less)
        })
    }
}

impl Bits for F64x8 {
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Self(unsafe {
            let mask = _mm512_set1_pd(SIGN);
            _mm512_or_pd(_mm512_andnot_pd(mask, self.0), _mm512_and_pd(mask, sign.0))
        })
    }

    #[inline(always)]
    fn if_odd(n: Self, odd: Self, even: Self) -> Self {
        Self(unsafe {
            let is_odd = _mm512_test_epi64_mask(_mm512_castpd_si512(n.0), _mm512_set1_epi64(1));
            _mm512_mask_blend_pd(is_odd, even.0, odd.0)
        })
    }

    #[inline(always)]
    fn flip_by<const BIT: u32>(self, n: Self) -> Self {
        Self(unsafe {
            let moved = _mm512_sll_epi64(_mm512_castpd_si512(n.0), _mm_cvtsi32_si128(63 - BIT as i32));
            let sign = _mm512_and_pd(_mm512_castsi512_pd(moved), _mm512_set1_pd(SIGN));
            _mm512_xor_pd(self.0, sign)
        })
    }

    #[inline(always)]
    fn all_below(self, limit: f64) -> bool {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.magnitude().0, _mm512_set1_pd(limit)) == 0xff }
    }
}

impl Bits for F64x4 {
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Self(unsafe {
            let mask = _mm256_set1_pd(SIGN);
            _mm256_or_pd(_mm256_andnot_pd(mask, self.0), _mm256_and_pd(mask, sign.0))
        })
    }

    #[inline(always)]
    fn if_odd(n: Self, odd: Self, even: Self) -> Self {
        Self(unsafe {
            // the lowest bit moved to the sign selects
            let sign = _mm256_slli_epi64::<63>(_mm256_castpd_si256(n.0));
            _mm256_blendv_pd(even.0, odd.0, _mm256_castsi256_pd(sign))
        })
    }

    #[inline(always)]
    fn flip_by<const BIT: u32>(self, n: Self) -> Self {
        Self(unsafe {
            let moved = _mm256_sll_epi64(_mm256_castpd_si256(n.0), _mm_cvtsi32_si128(63 - BIT as i32));
            let sign = _mm256_and_pd(_mm256_castsi256_pd(moved), _mm256_set1_pd(SIGN));
            _mm256_xor_pd(self.0, sign)
        })
    }

    #[inline(always)]
    fn all_below(self, limit: f64) -> bool {
        unsafe {
            let below = _mm256_cmp_pd::<_CMP_LT_OQ>(self.magnitude().0, _mm256_set1_pd(limit));
            _mm256_movemask_pd(below) == 0xf
        }
    }
}
