//! Warm start of joint limits and contacts: records of slots, by the joint or the pair of colliders they belong to.

use std::collections::BTreeMap;

use super::Origin;
use crate::model::{ConstraintSet, Model, SLOT_LEN};
use crate::state::State;

/// Place of a slot, whatever its number: a limit of a joint (name, degree of freedom, side), or a point of a pair of
/// colliders (names, each with its number among those of the same name).
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Limit(String, usize, bool),
    Contact([(String, usize); 2], usize),
}

/// Place of each slot; `name_of` gives the name in the former model, none for what is not the same object.
fn places(model: &Model<f64>, name_of: &dyn Fn(&str) -> Option<String>) -> Vec<Option<Place>> {
    let (set, names) = (model.constraints(), model.names());
    let mut all = Vec::with_capacity(set.n_slots());
    for limit in &set.limits {
        let joint = names.joint_info(names.dof_joint[limit.dof]);
        let name = name_of(&joint.name);
        all.push(name.map(|name| Place::Limit(name, limit.dof - joint.v_idx, limit.sign > 0.0)));
    }
    let colliders = numbered(set);
    for pair in &set.pairs {
        let end = |k: usize| Some((name_of(&colliders[k].0)?, colliders[k].1));
        let ends = end(pair.a).zip(end(pair.b)).map(|(a, b)| [a, b]);
        all.resize(set.limits.len() + pair.first, None);
        all.extend((0..pair.slots).map(|k| ends.clone().map(|ends| Place::Contact(ends, k))));
    }
    all
}

/// Each collider with its number among those of its body.
fn numbered(set: &ConstraintSet) -> Vec<(String, usize)> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let number = |collider: &'_ crate::contact::Collider| collider.name.clone();
    let mut all = Vec::with_capacity(set.colliders.len());
    for collider in &set.colliders {
        let n = counts.entry(&collider.name).or_default();
        all.push((number(collider), *n));
        *n += 1;
    }
    all
}

/// Records of the slots that both models have, in the order of the new ones; `empty` is the warm start of the new model
/// without any.
pub(super) fn transfer_contacts(
    (former, before): (&Model<f64>, &State<f64>),
    (model, empty): (&Model<f64>, Vec<f64>),
    origin: &dyn Fn(&str) -> Option<Origin>,
) -> Vec<f64> {
    let mut contacts = empty;
    let Some((fallback, records)) = before.contacts.split_first() else { return contacts };
    if contacts.is_empty() {
        return contacts;
    }
    contacts.truncate(1);
    contacts[0] = *fallback;
    if records.is_empty() {
        return contacts;
    }
    let old: BTreeMap<Place, usize> = places(former, &|name| Some(name.to_owned()))
        .into_iter()
        .enumerate()
        .filter_map(|(slot, place)| place.map(|place| (place, slot)))
        .collect();
    let loaded: BTreeMap<usize, &[f64]> =
        records.chunks_exact(1 + SLOT_LEN).map(|record| (record[0] as usize, &record[1..])).collect();
    let same = |name: &str| origin(name).filter(|origin| origin.is_same).map(|origin| origin.name);
    for (slot, place) in places(model, &same).into_iter().enumerate() {
        let record = place.and_then(|place| old.get(&place)).and_then(|slot| loaded.get(slot));
        if let Some(record) = record {
            contacts.push(slot as f64);
            contacts.extend_from_slice(record);
        }
    }
    contacts
}
