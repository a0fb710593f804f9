//! Functions: signals.

use super::{Function, Outcome, done, one};
use crate::api::{Arguments, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "setInt32Signal", tip: "sim.setInt32Signal(string signalName,int signalValue)", run: set_int },
    Function { name: "getInt32Signal", tip: "int signalValue=sim.getInt32Signal(string signalName)", run: int },
    Function {
        name: "clearInt32Signal",
        tip: "sim.clearInt32Signal(string signalName)",
        run: |d, a| one(d.registry.integers.clear(text(a)?) as i64),
    },
    Function { name: "setFloatSignal", tip: "sim.setFloatSignal(string signalName,float signalValue)", run: set_float },
    Function { name: "getFloatSignal", tip: "float signalValue=sim.getFloatSignal(string signalName)", run: float },
    Function {
        name: "clearFloatSignal",
        tip: "sim.clearFloatSignal(string signalName)",
        run: |d, a| one(d.registry.floats.clear(text(a)?) as i64),
    },
    Function {
        name: "setStringSignal",
        tip: "sim.setStringSignal(string signalName,string signalValue)",
        run: set_string,
    },
    Function { name: "getStringSignal", tip: "string signalValue=sim.getStringSignal(string signalName)", run: string },
    Function {
        name: "clearStringSignal",
        tip: "sim.clearStringSignal(string signalName)",
        run: |d, a| one(d.registry.strings.clear(text(a)?) as i64),
    },
    Function {
        name: "setBufferSignal",
        tip: "sim.setBufferSignal(string signalName,buffer signalValue)",
        run: set_buffer,
    },
    Function { name: "getBufferSignal", tip: "buffer signalValue=sim.getBufferSignal(string signalName)", run: buffer },
    Function {
        name: "getSignalName",
        tip: "string signalName=sim.getSignalName(int signalIndex,int signalType)",
        run: name,
    },
];

/// No name stands for all.
fn text<'a>(a: Arguments<'a>) -> Result<&'a str, crate::api::ApiError> {
    if a.has(0) { a.text(0) } else { Ok("") }
}

/// The value of a signal; none of one that is not set, which clients tell from nil by the number of results.
fn if_set(value: Option<Value>) -> Outcome {
    Ok(value.into_iter().collect())
}

fn set_int(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.integers.set(a.text(0)?, a.int(1)?, sim.registry.phase.is_on())?;
    done()
}

fn int(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if_set(sim.registry.integers.get(a.text(0)?).map(|x| Value::Int(*x)))
}

fn set_float(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.floats.set(a.text(0)?, a.real(1)?, sim.registry.phase.is_on())?;
    done()
}

fn float(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if_set(sim.registry.floats.get(a.text(0)?).map(|x| Value::Real(*x)))
}

/// Sets a text, or a buffer: bytes that a client gives as such.
fn set_string(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if let Value::Bytes(_) = a.get(1) {
        return set_buffer(sim, a);
    }
    sim.registry.check_stored_size(a.bytes(1)?.len())?;
    sim.registry.strings.set(a.text(0)?, a.bytes(1)?.to_vec(), sim.registry.phase.is_on())?;
    done()
}

fn string(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if_set(sim.registry.strings.value(a.text(0)?))
}

fn set_buffer(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.check_stored_size(a.bytes(1)?.len())?;
    sim.registry.strings.set_buffer(a.text(0)?, a.bytes(1)?.to_vec(), sim.registry.phase.is_on())?;
    done()
}

fn buffer(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if_set(sim.registry.strings.get(a.text(0)?).map(|x| Value::Bytes(x.clone())))
}

/// Signals by number: 0 whole numbers, 1 numbers, 2 texts.
fn name(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (k, registry) = (a.int(0)?, &sim.registry);
    let Ok(k) = usize::try_from(k) else { return Ok(vec![Value::Nil]) };
    let name = match a.int(1)? {
        0 => registry.integers.names().nth(k),
        1 => registry.floats.names().nth(k),
        _ => registry.strings.names().nth(k),
    };
    one(name.map_or(Value::Nil, Value::from))
}
