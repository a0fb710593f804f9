//! Functions: numbers and tables as bytes, little-endian, and back.

use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments, Value, cbor, unpack};
use sincro_values::numbers::NumberFormat::{self, Double, I32, Single, U8, U16, U32};

/// Numbers of one call.
const MAX_NUMBERS: usize = 1 << 22;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "packFloatTable",
        tip: "buffer data=sim.packFloatTable(float[] floatNumbers,int startFloatIndex=0,int floatCount=0)",
        run: |_, a| pack(Single, a),
    },
    Function {
        name: "packDoubleTable",
        tip: "buffer data=sim.packDoubleTable(float[] doubleNumbers,int startDoubleIndex=0,int doubleCount=0)",
        run: |_, a| pack(Double, a),
    },
    Function {
        name: "packInt32Table",
        tip: "buffer data=sim.packInt32Table(int[] int32Numbers,int startInt32Index=0,int int32Count=0)",
        run: |_, a| pack(I32, a),
    },
    Function {
        name: "packUInt32Table",
        tip: "buffer data=sim.packUInt32Table(int[] uint32Numbers,int startUInt32Index=0,int uint32Count=0)",
        run: |_, a| pack(U32, a),
    },
    Function {
        name: "packUInt16Table",
        tip: "buffer data=sim.packUInt16Table(int[] uint16Numbers,int startUint16Index=0,int uint16Count=0)",
        run: |_, a| pack(U16, a),
    },
    Function {
        name: "packUInt8Table",
        tip: "buffer data=sim.packUInt8Table(int[] uint8Numbers,int startUint8Index=0,int uint8count=0)",
        run: |_, a| pack(U8, a),
    },
    Function {
        name: "unpackFloatTable",
        tip: "float[] floatNumbers=sim.unpackFloatTable(buffer data,int startFloatIndex=0,int floatCount=0,int additionalByteOffset=0)",
        run: |_, a| unpacked(Single, a),
    },
    Function {
        name: "unpackDoubleTable",
        tip: "float[] doubleNumbers=sim.unpackDoubleTable(buffer data,int startDoubleIndex=0,int doubleCount=0,int additionalByteOffset=0)",
        run: |_, a| unpacked(Double, a),
    },
    Function {
        name: "unpackInt32Table",
        tip: "int[] int32Numbers=sim.unpackInt32Table(buffer data,int startInt32Index=0,int int32Count=0,int additionalByteOffset=0)",
        run: |_, a| unpacked(I32, a),
    },
    Function {
        name: "unpackUInt32Table",
        tip: "int[] uint32Numbers=sim.unpackUInt32Table(buffer data,int startUint32Index=0,int uint32Count=0,int additionalByteOffset=0)",
        run: |_, a| unpacked(U32, a),
    },
    Function {
        name: "unpackUInt16Table",
        tip: "int[] uint16Numbers=sim.unpackUInt16Table(buffer data,int startUint16Index=0,int uint16Count=0,int additionalByteOffset=0)",
        run: |_, a| unpacked(U16, a),
    },
    Function {
        name: "unpackUInt8Table",
        tip: "int[] uint8Numbers=sim.unpackUInt8Table(buffer data,int startUint8Index=0,int uint8count=0)",
        run: |_, a| unpacked(U8, a),
    },
    Function {
        name: "packTable",
        tip: "buffer data=sim.packTable(map aTable,int scheme=0)",
        run: |_, a| {
            let mut packed = Vec::new();
            cbor::encode(a.get(0), &mut packed);
            one(packed)
        },
    },
    Function {
        name: "unpackTable",
        tip: "map aTable=sim.unpackTable(buffer data)",
        run: |_, a| unpack::read(a.bytes(0)?).map_err(ApiError).map(|value| vec![value]),
    },
];

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

fn pack(format: NumberFormat, a: Arguments<'_>) -> Outcome {
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
    one(packed)
}

fn unpacked(format: NumberFormat, a: Arguments<'_>) -> Outcome {
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
