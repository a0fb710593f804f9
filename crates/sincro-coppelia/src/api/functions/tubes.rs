//! Functions: tubes of V-REP. Two ends of one name are connected; what is written into one is read from the other.

use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "tubeOpen",
        tip: "int tubeHandle=sim.tubeOpen(int dataHeader,string dataName,int readBufferSize,bool notUsed=false)",
        run: open,
    },
    Function { name: "tubeWrite", tip: "int result=sim.tubeWrite(int tubeHandle,buffer data)", run: write },
    Function {
        name: "tubeRead",
        tip: "buffer data=sim.tubeRead(int tubeHandle,bool blockingOperation=false)",
        run: read,
    },
    Function {
        name: "tubeStatus",
        tip: "int status,int readPacketsCount,int writtenPacketsCount=sim.tubeStatus(int tubeHandle)",
        run: status,
    },
    Function { name: "tubeClose", tip: "int result=sim.tubeClose(int tubeHandle)", run: close },
];

fn open(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let capacity = usize::try_from(a.int_or(2, 1)?).map_err(|_| ApiError::new("the size of the buffer is negative"))?;
    let name = a.text(1)?;
    sim.registry.check_stored_size(name.len())?;
    one(sim.registry.tubes.open((a.int(0)?, name), capacity)? as i64)
}

fn close(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.tubes.close(a.int(0)?)?;
    one(1_i64)
}

fn write(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let bytes = a.bytes(1)?;
    sim.registry.check_stored_size(bytes.len())?;
    one(i64::from(sim.registry.tubes.write(a.int(0)?, bytes)?))
}

/// A blocking read gives nothing at once, too: the simulation does not wait for it.
fn read(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    one(sim.registry.tubes.read(a.int(0)?)?.map_or(Value::Nil, Value::Bytes))
}

fn status(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (is_connected, to_read, written) = sim.registry.tubes.status(a.int(0)?)?;
    Ok(vec![Value::Int(is_connected.into()), Value::Int(to_read as i64), Value::Int(written as i64)])
}
