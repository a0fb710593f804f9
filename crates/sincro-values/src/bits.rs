//! Bits of whole numbers of 32 and 16 bits, for scripts of V-REP (its Lua had no operators for them).

use crate::{ApiError, Arguments, Value};

/// Gives the names of the functions of [`call`] and their call tips to a macro, as literals.
#[macro_export]
macro_rules! for_bits {
    ($table:ident) => {
        $table! {
            "boolOr32" "int result=sim.boolOr32(int value1,int value2)"
            "boolAnd32" "int result=sim.boolAnd32(int value1,int value2)"
            "boolXor32" "int result=sim.boolXor32(int value1,int value2)"
            "boolOr16" "int result=sim.boolOr16(int value1,int value2)"
            "boolAnd16" "int result=sim.boolAnd16(int value1,int value2)"
            "boolXor16" "int result=sim.boolXor16(int value1,int value2)"
        }
    };
}

/// An argument as 32 bits: signed and unsigned numbers that fit.
fn word(a: Arguments<'_>, k: usize) -> Result<u32, ApiError> {
    let x = a.int(k)?;
    let signed = i32::try_from(x).map(|x| x.cast_unsigned());
    signed.or_else(|_| u32::try_from(x)).map_err(|_| ApiError(format!("argument {} is {x}, beyond 32 bits", k + 1)))
}

/// Calls a function on bits by its name: results of 32 bits are signed, those of 16 bits are not.
///
/// # Errors
///
/// An argument is no whole number, or has more than 32 bits.
///
/// # Panics
///
/// There is no function of that name.
pub fn call(name: &str, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let (x, y) = (word(a, 0)?, word(a, 1)?);
    let bits = match &name[..name.len() - 2] {
        "boolOr" => x | y,
        "boolAnd" => x & y,
        "boolXor" => x ^ y,
        _ => unreachable!("`{name}` is no function on bits"),
    };
    let number = if name.ends_with("32") { i64::from(bits.cast_signed()) } else { i64::from(bits & 0xffff) };
    Ok(vec![Value::Int(number)])
}
