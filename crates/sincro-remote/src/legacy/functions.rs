//! Calls of the legacy API: their arguments, the data of their replies; and the functions of the simulation as a whole.

use sincro_coppelia::api::{ApiError, Handle, SimApi};
use sincro_coppelia::session::Session;

use super::message::{float, int, text};
use crate::hub::SessionGuard;

/// A command as a function sees it.
#[derive(Clone, Copy)]
pub(super) struct Call<'a> {
    pub function: u16,
    pub ident: &'a [u8],
    pub data: &'a [u8],
}

/// Data of a reply.
pub(super) type Reply = Result<Vec<u8>, ApiError>;

impl<'a> Call<'a> {
    /// The object that the identification begins with.
    pub fn handle(&self) -> Result<Handle, ApiError> {
        Ok(Handle(self.ident_int(0)?))
    }

    /// The parameter that the identification names.
    pub fn parameter(&self) -> Result<i64, ApiError> {
        Ok(self.ident_int(0)?.into())
    }

    pub fn ident_int(&self, k: usize) -> Result<i32, ApiError> {
        int(self.ident, 4 * k).ok_or_else(|| ApiError::new("the identification is shorter than it should be"))
    }

    pub fn name(&self) -> Result<&'a str, ApiError> {
        text(self.ident).map(|(text, _)| text).ok_or_else(|| ApiError::new("the name is not UTF-8"))
    }

    pub fn int(&self, at: usize) -> Result<i32, ApiError> {
        int(self.data, at).ok_or_else(short)
    }

    pub fn float(&self, at: usize) -> Result<f64, ApiError> {
        float(self.data, at).ok_or_else(short)
    }

    pub fn floats<const N: usize>(&self, at: usize) -> Result<[f64; N], ApiError> {
        super::message::floats(self.data, at).ok_or_else(short)
    }
}

fn short() -> ApiError {
    ApiError::new("the data is shorter than it should be")
}

/// An empty reply.
pub(super) fn done() -> Reply {
    Ok(Vec::new())
}

/// An empty reply after something that gives nothing.
pub(super) fn after(result: Result<(), ApiError>) -> Reply {
    result.and_then(|()| done())
}

pub(super) fn ints(list: impl IntoIterator<Item = i32>) -> Reply {
    Ok(list.into_iter().flat_map(i32::to_le_bytes).collect())
}

pub(super) fn reals(list: impl IntoIterator<Item = f64>) -> Reply {
    Ok(list.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect())
}

/// A handle list with its length before it.
pub(super) fn counted(list: &[Handle]) -> Reply {
    ints([list.len() as i32].into_iter().chain(list.iter().map(|h| h.0)))
}

/// Starts, pauses or stops.
pub(super) fn simulation(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let what = call.ident_int(0)?;
    after(guard.act(|session| match what {
        0 => session.start(),
        1 => session.pause(),
        2 => {
            session.registry().stop_requests += 1;
            session.stop()
        }
        _ => Err(ApiError(format!("{what} is neither start 0 nor pause 1 nor stop 2"))),
    }))
}

pub(super) fn close(guard: &mut SessionGuard, _: &Call<'_>) -> Reply {
    after(guard.act(Session::stop))
}

/// A console that is not shown: its handle.
pub(super) fn console(_: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    call.name()?;
    ints([1])
}

/// Taken without effect: nothing is shown.
pub(super) fn nothing(_: &mut SimApi<'_>, _: &Call<'_>) -> Reply {
    done()
}

pub(super) fn log(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    sim.log(450, call.name()?);
    done()
}
