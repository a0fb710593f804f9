//! `simxCallScriptFunction`: whole numbers, numbers, texts and bytes to a function of a script, and the same four back.

use sincro_coppelia::api::{ApiError, Handle, Search, Value};

use super::functions::{Call, Reply};
use super::message::{float, int, text};
use crate::hub::SessionGuard;
use crate::zmq::kind_of;

/// Runs the function.
pub(super) fn run(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let kind = call.ident_int(0)?;
    let (object, n) = call.ident.get(4..).and_then(text).ok_or_else(short)?;
    let (function, _) = call.ident.get(4 + n..).and_then(text).ok_or_else(short)?;
    let arguments = arguments(call.data)?;
    let results = guard.act(|session| {
        // without a name the number is the handle of the script, which is that of its object here
        let handle = match object {
            "" => Handle(kind),
            name => session.registry().find(name, Search::default())?,
        };
        session.call_script(handle, kind_of(kind.into()), function, &arguments)
    })?;
    reply(&results)
}

fn short() -> ApiError {
    ApiError::new("the call of a script is shorter than it should be")
}

/// Counts, then the values; what is not there is no value.
fn arguments(data: &[u8]) -> Result<Vec<Value>, ApiError> {
    let mut counts = [0; 4];
    for (k, count) in counts.iter_mut().enumerate() {
        let n = int(data, 4 * k).and_then(|n| usize::try_from(n).ok());
        *count = n.filter(|n| *n <= data.len()).ok_or_else(short)?;
    }
    let [n_ints, n_floats, n_texts, n_bytes] = counts;
    let mut at = 16;
    let mut next = |n: usize| {
        at += n;
        at - n
    };
    let ints = (0..n_ints).map(|_| int(data, next(4)).map(|x| Value::Int(x.into()))).collect::<Option<Vec<_>>>();
    let floats = (0..n_floats).map(|_| float(data, next(4)).map(Value::Real)).collect::<Option<Vec<_>>>();
    let mut texts = Vec::new();
    for _ in 0..n_texts {
        let from = next(0);
        let (found, n) = data.get(from..).filter(|rest| !rest.is_empty()).and_then(text).ok_or_else(short)?;
        next(n);
        texts.push(Value::from(found));
    }
    let from = next(0);
    let bytes = data.get(from..from + n_bytes).ok_or_else(short)?;
    let (ints, floats) = (ints.ok_or_else(short)?, floats.ok_or_else(short)?);
    Ok(vec![Value::List(ints), Value::List(floats), Value::List(texts), Value::Bytes(bytes.to_vec())])
}

/// The four results in the layout of the arguments; what the function did not give is empty.
fn reply(results: &[Value]) -> Reply {
    let list = |k: usize| match results.get(k) {
        Some(Value::List(list)) => Ok(&list[..]),
        None | Some(Value::Nil) => Ok(&[][..]),
        Some(Value::Map(map)) if map.is_empty() => Ok(&[][..]),
        Some(other) => Err(ApiError(format!("result {} of the function is {}, expected a list", k + 1, other.word()))),
    };
    let wrong = |what: &str| ApiError(format!("the function gave a list that has something else than {what}"));
    let ints = list(0)?.iter().map(|x| x.as_int().and_then(|x| i32::try_from(x).ok())).collect::<Option<Vec<_>>>();
    let ints = ints.ok_or_else(|| wrong("whole numbers"))?;
    let floats = list(1)?.iter().map(Value::as_real).collect::<Option<Vec<_>>>().ok_or_else(|| wrong("numbers"))?;
    let texts = list(2)?.iter().map(Value::as_bytes).collect::<Option<Vec<_>>>().ok_or_else(|| wrong("texts"))?;
    let bytes = match results.get(3) {
        None | Some(Value::Nil) => &[][..],
        Some(other) => other.as_bytes().ok_or_else(|| wrong("bytes"))?,
    };
    let counts = [ints.len(), floats.len(), texts.len(), bytes.len()];
    let mut data: Vec<u8> = counts.into_iter().flat_map(|n| (n as i32).to_le_bytes()).collect();
    data.extend(ints.iter().flat_map(|x| x.to_le_bytes()));
    data.extend(floats.iter().flat_map(|x| (*x as f32).to_le_bytes()));
    for text in texts {
        data.extend(text.iter().filter(|b| **b != 0));
        data.push(0);
    }
    data.extend(bytes);
    Ok(data)
}
