//! What clients and scripts make: points, shapes and sensors that are no part of the scene. Their names, and that they can be taken away again.

use sincro_dynamics::kinematics::Attached;

use super::Refusal;
use super::table::{Entry, Handle, Kind, Table, WORLD};

/// Objects that may exist at once, beyond those of the scene.
const MOST_CREATED: usize = 10_000;

impl Table {
    /// Makes a named point on the world.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub fn create_dummy(&mut self, name: &str) -> Result<Handle, Refusal> {
        self.create(name, Kind::Dummy, WORLD)
    }

    /// Makes an object on the world.
    pub(super) fn create(&mut self, name: &str, kind: Kind, at: Attached<f64>) -> Result<Handle, Refusal> {
        if self.n_created >= MOST_CREATED {
            return Err(Refusal(format!("{MOST_CREATED} objects were made already: remove some")));
        }
        let handle = self.next_handle();
        let mut new_name = name.to_owned();
        let mut k = self.numbers.get(name).copied().unwrap_or(0);
        while self.names.contains_key(&new_name) {
            new_name = format!("{name}{k}");
            k += 1;
        }
        self.numbers.insert(name.to_owned(), k);
        *self.names.entry(new_name.clone()).or_default() += 1;
        let path = format!("/{new_name}");
        self.n_created += 1;
        let entry = Entry { handle, name: new_name, path, kind, is_made: true, parent: None, frame: at, moving: at };
        self.entries.push(Some(entry));
        Ok(handle)
    }

    /// Removes what was made by a client or script.
    ///
    /// # Errors
    ///
    /// There is none, or it belongs to the scene.
    pub fn remove(&mut self, handle: Handle) -> Result<(), Refusal> {
        let entry = self.made(handle, "removed")?;
        let (parent, name, kind) = (entry.parent, entry.name.clone(), entry.kind.clone());
        if let Kind::Vision(k) = kind {
            self.vision.remove(k);
        }
        self.free_name(&name);
        let orphans: Vec<Handle> = self.children(Some(handle)).map(|e| e.handle).collect();
        for orphan in orphans {
            self.entries[orphan.0 as usize - 1].as_mut().expect("a child is there").parent = parent;
        }
        self.entries[handle.0 as usize - 1] = None;
        self.n_created -= 1;
        self.data.retain(|(h, _), _| *h != handle);
        self.senses.forget(handle);
        Ok(())
    }

    /// Gives a point that was made by a client or script another name. What hangs on it keeps its own.
    ///
    /// # Errors
    ///
    /// There is none, it belongs to the scene, or the name is none.
    pub fn rename(&mut self, handle: Handle, name: &str) -> Result<(), Refusal> {
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '#');
        if name.is_empty() || name.len() > 100 || !name.chars().all(is_plain) {
            let short: String = name.chars().take(40).collect();
            return Err(Refusal(format!("`{short}` is no name: up to 100 letters, digits, `_`, `-`")));
        }
        let entry = self.made(handle, "named anew")?;
        let above = entry.path.rsplit_once('/').map_or("", |(above, _)| above).to_owned();
        entry.path = format!("{above}/{name}");
        let before = std::mem::replace(&mut entry.name, name.to_owned());
        self.free_name(&before);
        *self.names.entry(name.to_owned()).or_default() += 1;
        Ok(())
    }

    /// One object less has a name: numbers that have become free are taken again.
    fn free_name(&mut self, name: &str) {
        if let Some(n) = self.names.get_mut(name) {
            *n -= 1;
            if *n == 0 {
                self.names.remove(name);
            }
        }
        self.numbers.clear();
    }

    /// The entry of something that was made by a client or script.
    pub(super) fn made(&mut self, handle: Handle, what: &str) -> Result<&mut Entry, Refusal> {
        let entry = self.entry(handle)?;
        if !entry.is_made {
            return Err(Refusal(format!("`{}` belongs to the scene: it cannot be {what}", entry.path)));
        }
        Ok(self.entries[handle.0 as usize - 1].as_mut().expect("it was found"))
    }
}
