//! Collision and distance objects of V-REP 3: named pairs of objects or collections whose state is asked for by handle.
//!
//! In V-REP they belong to the scene; here a script of the scene makes them, by `sim.createCollisionObject` and
//! `sim.createDistanceObject`. They are calculated when they are read, from where everything is then.

use std::collections::BTreeMap;

use sincro_values::stored::check_name;
use sincro_values::{ApiError, Handle};

/// Handle of the first of them: above those of scripts, collections and groups of inverse kinematics.
const FIRST: i64 = 2_000_000;
/// Collision and distance objects that may exist at once.
const MAX_COUNT: usize = 1_000;
/// Result of one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Collision,
    Distance,
}

impl Kind {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Collision => "collision",
            Self::Distance => "distance",
        }
    }

    /// Function that makes one.
    pub(crate) fn maker(self) -> &'static str {
        match self {
            Self::Collision => "sim.createCollisionObject",
            Self::Distance => "sim.createDistanceObject",
        }
    }
}

/// Collision or distance object.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Calculation {
    kind: Kind,
    name: String,
    pair: [Handle; 2],
}

/// Collision and distance objects of a scene by their handles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Calculations {
    all: BTreeMap<i64, Calculation>,
}

impl Calculations {
    pub(crate) fn named(&self, kind: Kind, name: &str) -> Option<i64> {
        self.all.iter().find(|(_, known)| known.kind == kind && known.name == name).map(|(handle, _)| *handle)
    }

    /// Makes one; the handle of a name stays the same when it is given another pair.
    pub(crate) fn make(&mut self, kind: Kind, name: &str, pair: [Handle; 2]) -> Result<i64, ApiError> {
        check_name("collision or distance object", name)?;
        let known = self.named(kind, name);
        if known.is_none() && self.all.len() >= MAX_COUNT {
            return Err(ApiError(format!("there are {MAX_COUNT} collision and distance objects already")));
        }
        let next = FIRST + self.all.len() as i64;
        let handle = known.unwrap_or(next);
        self.all.insert(handle, Calculation { kind, name: name.to_owned(), pair });
        Ok(handle)
    }

    pub(crate) fn pair(&self, kind: Kind, handle: i64) -> Result<[Handle; 2], ApiError> {
        let found = self.all.get(&handle).filter(|found| found.kind == kind);
        found.map(|found| found.pair).ok_or_else(|| {
            let (word, maker) = (kind.word(), kind.maker());
            ApiError(format!("there is no {word} object {handle}: {maker} gives the handles"))
        })
    }

    pub(crate) fn pairs(&self, kind: Kind) -> Vec<[Handle; 2]> {
        self.all.values().filter(|one| one.kind == kind).map(|one| one.pair).collect()
    }
}
