//! Numbers and tables as bytes, little-endian, and back: functions such as `packFloatTable` and `unpackTable`.

use crate::numbers::NumberFormat::{self, Double, I32, Single, U8, U16, U32};
use crate::{ApiError, Arguments, Value, cbor, unpack};

/// Numbers of one call.
const MAX_NUMBERS: usize = 1 << 22;

/// Gives the names of the functions of [`call`] and their call tips to a macro, as literals.
#[macro_export]
macro_rules! for_buffers {
    ($table:ident) => {
        $table! {
            "packFloatTable" "buffer data=sim.packFloatTable(float[] floatNumbers,int startFloatIndex=0,int floatCount=0)"
            "packDoubleTable" "buffer data=sim.packDoubleTable(float[] doubleNumbers,int startDoubleIndex=0,int doubleCount=0)"
            "packInt32Table" "buffer data=sim.packInt32Table(int[] int32Numbers,int startInt32Index=0,int int32Count=0)"
            "packUInt32Table" "buffer data=sim.packUInt32Table(int[] uint32Numbers,int startUInt32Index=0,int uint32Count=0)"
            "packUInt16Table" "buffer data=sim.packUInt16Table(int[] uint16Numbers,int startUint16Index=0,int uint16Count=0)"
            "packUInt8Table" "buffer data=sim.packUInt8Table(int[] uint8Numbers,int startUint8Index=0,int uint8count=0)"
            "unpackFloatTable" "float[] floatNumbers=sim.unpackFloatTable(buffer data,int startFloatIndex=0,int floatCount=0,int additionalByteOffset=0)"
            "unpackDoubleTable" "float[] doubleNumbers=sim.unpackDoubleTable(buffer data,int startDoubleIndex=0,int doubleCount=0,int additionalByteOffset=0)"
            "unpackInt32Table" "int[] int32Numbers=sim.unpackInt32Table(buffer data,int startInt32Index=0,int int32Count=0,int additionalByteOffset=0)"
            "unpackUInt32Table" "int[] uint32Numbers=sim.unpackUInt32Table(buffer data,int startUint32Index=0,int uint32Count=0,int additionalByteOffset=0)"
            "unpackUInt16Table" "int[] uint16Numbers=sim.unpackUInt16Table(buffer data,int startUint16Index=0,int uint16Count=0,int additionalByteOffset=0)"
            "unpackUInt8Table" "int[] uint8Numbers=sim.unpackUInt8Table(buffer data,int startUint8Index=0,int uint8count=0)"
            "packTable" "buffer data=sim.packTable(map aTable,int scheme=0)"
            "unpackTable" "map aTable=sim.unpackTable(buffer data)"
        }
    };
}

/// Calls a function that packs or unpacks by its name.
///
/// # Errors
///
/// An argument is no list of numbers, no bytes or no place, or there are too many numbers.
///
/// # Panics
///
/// There is no function of that name.
pub fn call(name: &str, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    match name {
        "packTable" => {
            let mut packed = Vec::new();
            cbor::encode(a.get(0), &mut packed);
            Ok(vec![packed.into()])
        }
        "unpackTable" => unpack::read(a.bytes(0)?).map_err(ApiError).map(|value| vec![value]),
        "packFloatTable" => pack(Single, a),
        "packDoubleTable" => pack(Double, a),
        "packInt32Table" => pack(I32, a),
        "packUInt32Table" => pack(U32, a),
        "packUInt16Table" => pack(U16, a),
        "packUInt8Table" => pack(U8, a),
        "unpackFloatTable" => unpacked(Single, a),
        "unpackDoubleTable" => unpacked(Double, a),
        "unpackInt32Table" => unpacked(I32, a),
        "unpackUInt32Table" => unpacked(U32, a),
        "unpackUInt16Table" => unpacked(U16, a),
        "unpackUInt8Table" => unpacked(U8, a),
        _ => unreachable!("`{name}` neither packs nor unpacks"),
    }
}

/// A place or count that may be left out.
fn size(a: Arguments<'_>, k: usize) -> Result<usize, ApiError> {
    let n = a.int_or(k, 0)?;
    usize::try_from(n).map_err(|_| ApiError(format!("argument {} is {n}, expected 0 or more", k + 1)))
}

/// Number of elements out of `n`: a `count` of 0 means all.
fn some_of(n: usize, count: usize) -> Result<usize, ApiError> {
    let n = if count == 0 { n } else { n.min(count) };
    if n > MAX_NUMBERS { Err(ApiError(format!("{n} numbers are more than {MAX_NUMBERS} in one call"))) } else { Ok(n) }
}

fn pack(format: NumberFormat, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let Value::List(list) = a.get(0) else {
        return Err(ApiError(format!("argument 1 is {}, expected a list of numbers", a.get(0).word())));
    };
    let (first, count) = (size(a, 1)?, size(a, 2)?);
    let n = some_of(list.len().saturating_sub(first), count)?;
    let mut packed = Vec::with_capacity(n * format.width());
    for value in list.iter().skip(first).take(n) {
        let wrong = || ApiError(format!("the list has {}, expected numbers", value.word()));
        format.write(value.as_real().ok_or_else(wrong)?, &mut packed);
    }
    Ok(vec![packed.into()])
}

fn unpacked(format: NumberFormat, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let packed = a.bytes(0)?;
    let (first, count, offset) = (size(a, 1)?, size(a, 2)?, size(a, 3)?);
    let all = packed.get(offset..).unwrap_or_default().chunks_exact(format.width()).skip(first);
    let n = some_of(all.len(), count)?;
    let number = |chunk: &[u8]| {
        let x = format.read(chunk);
        if format.is_whole() { Value::Int(x as i64) } else { Value::Real(x) }
    };
    Ok(vec![Value::List(all.take(n).map(number).collect())])
}
