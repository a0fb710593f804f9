//! Functions: bits of whole numbers of 32 and 16 bits, for scripts of V-REP (its Lua had no operators for them).

use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "boolOr32",
        tip: "int result=sim.boolOr32(int value1,int value2)",
        run: |_, a| bits32(a, |x, y| x | y),
    },
    Function {
        name: "boolAnd32",
        tip: "int result=sim.boolAnd32(int value1,int value2)",
        run: |_, a| bits32(a, |x, y| x & y),
    },
    Function {
        name: "boolXor32",
        tip: "int result=sim.boolXor32(int value1,int value2)",
        run: |_, a| bits32(a, |x, y| x ^ y),
    },
    Function {
        name: "boolOr16",
        tip: "int result=sim.boolOr16(int value1,int value2)",
        run: |_, a| bits16(a, |x, y| x | y),
    },
    Function {
        name: "boolAnd16",
        tip: "int result=sim.boolAnd16(int value1,int value2)",
        run: |_, a| bits16(a, |x, y| x & y),
    },
    Function {
        name: "boolXor16",
        tip: "int result=sim.boolXor16(int value1,int value2)",
        run: |_, a| bits16(a, |x, y| x ^ y),
    },
];

/// An argument as 32 bits: signed and unsigned numbers that fit.
fn word(a: Arguments<'_>, k: usize) -> Result<u32, ApiError> {
    let x = a.int(k)?;
    let signed = i32::try_from(x).map(|x| x.cast_unsigned());
    signed.or_else(|_| u32::try_from(x)).map_err(|_| ApiError(format!("argument {} is {x}, beyond 32 bits", k + 1)))
}

fn bits32(a: Arguments<'_>, f: fn(u32, u32) -> u32) -> Outcome {
    one(i64::from(f(word(a, 0)?, word(a, 1)?).cast_signed()))
}

fn bits16(a: Arguments<'_>, f: fn(u32, u32) -> u32) -> Outcome {
    one(i64::from(f(word(a, 0)? & 0xffff, word(a, 1)? & 0xffff)))
}
