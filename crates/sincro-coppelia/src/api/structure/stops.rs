//! Stops of joints that are made and taken away.

use serde_json::{Map, Value};

use super::table;
use crate::api::registry::Handle;
use crate::api::{ApiError, SimApi};

impl SimApi<'_> {
    /// Gives a joint stops at the coordinates `[lower, upper]` (`[rad]` or `[m]`) in place of those that it has; for
    /// none it has no stops from now on.
    ///
    /// # Errors
    ///
    /// The scene's file is not known, or the joint cannot have stops.
    pub(in crate::api) fn replace_stops(&mut self, handle: Handle, stops: Option<[f64; 2]>) -> Result<(), ApiError> {
        if let Some(keys) = self.registry.parked.get_mut(&handle) {
            let kind = keys.get("kind").and_then(Value::as_str);
            if !matches!((kind, stops), (Some("revolute"), _) | (Some("prismatic"), Some(_))) {
                return Err(ApiError::new(
                    "only revolute and prismatic joints have stops, and revolute ones can be cyclic",
                ));
            }
            put_stops(keys, stops);
            return Ok(());
        }
        let path = self.model_path(handle)?;
        let mut edit = self.draft()?;
        let (list, keys) = edit.draft.table(&path).ok_or_else(|| ApiError(format!("there is no joint `{path}`")))?;
        let (list, mut keys) = (list.to_owned(), keys.clone());
        put_stops(&mut keys, stops);
        edit.draft.replace(&path, &list, keys);
        self.rebuild(edit)?;
        if let Some([lower, upper]) = stops {
            // a stop that was there before has been carried over
            let dof = self.registry.joint(handle)?.v_idx;
            self.world.set_limits(dof, [Some(lower), Some(upper)]);
        }
        Ok(())
    }

    /// Stops `[rad]` or `[m]` of a joint that was made and moves nothing yet, lower and upper one; none if it has none
    /// or is part of the model.
    pub(in crate::api) fn parked_stops(&self, handle: Handle) -> Option<[f64; 2]> {
        let stops = self.registry.parked.get(&handle)?.get("limits")?;
        let bound = |key: &str| stops.get(key).and_then(Value::as_f64);
        Some([bound("lower")?, bound("upper")?])
    }
}

fn put_stops(keys: &mut Map<String, Value>, stops: Option<[f64; 2]>) {
    match stops {
        Some([lower, upper]) => {
            let limits = table([("lower", lower.into()), ("upper", upper.into())]);
            keys.insert("limits".into(), Value::Object(limits));
        }
        None => {
            keys.remove("limits");
        }
    }
}
