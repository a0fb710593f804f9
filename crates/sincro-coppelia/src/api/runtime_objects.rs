//! Runtime objects: points, shapes and sensors that clients and scripts create and remove; they are no part of the
//! scene.

use sincro_dynamics::kinematics::Attached;

use super::registry::{Entry, Handle, Kind, ObjectRegistry, WORLD};
use super::{ApiError, Entity};

/// Objects that may exist at once, beyond those of the scene.
pub(super) const MAX_CREATED: usize = 10_000;

impl ObjectRegistry {
    /// Creates a dummy, a named frame without mass, at the world's origin and returns its handle. If the name is taken,
    /// a number is appended.
    ///
    /// # Errors
    ///
    /// Clients and scripts have created 10,000 objects already: remove some.
    pub fn create_dummy(&mut self, name: &str) -> Result<Handle, ApiError> {
        self.create(name, Kind::Dummy, WORLD)
    }

    /// Checks that `n` further runtime objects can be created.
    pub(super) fn check_room(&self, n: usize) -> Result<(), ApiError> {
        if self.n_created + n <= MAX_CREATED {
            return Ok(());
        }
        Err(ApiError(format!("{MAX_CREATED} objects were made already: remove some")))
    }

    /// Makes an object on the world.
    pub(super) fn create(&mut self, name: &str, kind: Kind, at: Attached<f64>) -> Result<Handle, ApiError> {
        self.check_room(1)?;
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
        let entry = Entry { handle, name: new_name, path, kind, is_runtime: true, parent: None, frame: at, moving: at };
        self.entries.push(Some(entry));
        Ok(handle)
    }

    /// Number of objects made at run time that are there and no part of the model.
    #[must_use]
    pub fn created_count(&self) -> usize {
        self.n_created
    }

    /// Removes a runtime object; its children pass to its parent, data stored with it are dropped. Its handle is not
    /// used again.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or belongs to the scene.
    pub fn remove(&mut self, handle: Handle) -> Result<(), ApiError> {
        let entry = self.runtime_object(handle, "removed")?;
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
        self.drawings.forget(handle);
        self.parked.remove(&handle);
        self.roles.retain(|(shape, _)| *shape != handle);
        self.masses.remove(&handle);
        self.materials.remove(&handle);
        self.octrees.remove(&handle);
        self.clouds.remove(&handle);
        self.forget_links(handle);
        self.looks.retain(|(owner, _), _| *owner != handle);
        self.component_colors.retain(|(owner, _), _| *owner != handle);
        self.textures.forget(handle);
        self.flags.forget(handle);
        self.forget_entity(Entity::Object(handle));
        Ok(())
    }

    /// Gives a runtime object another name, up to 100 letters, digits, `_`, `-`, `#`. The paths of its children keep
    /// the old one.
    ///
    /// # Errors
    ///
    /// `handle` is no object or belongs to the scene, or the name is empty, too long or has other characters.
    pub fn rename(&mut self, handle: Handle, name: &str) -> Result<(), ApiError> {
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '#');
        if name.is_empty() || name.len() > 100 || !name.chars().all(is_plain) {
            let short: String = name.chars().take(40).collect();
            return Err(ApiError(format!("`{short}` is no name: up to 100 letters, digits, `_`, `-`")));
        }
        let entry = self.runtime_object(handle, "named anew")?;
        let above = entry.path.rsplit_once('/').map_or("", |(above, _)| above).to_owned();
        entry.path = format!("{above}/{name}");
        let before = std::mem::replace(&mut entry.name, name.to_owned());
        self.free_name(&before);
        *self.names.entry(name.to_owned()).or_default() += 1;
        Ok(())
    }

    /// One object less has a name: numbers that have become free are taken again.
    pub(super) fn free_name(&mut self, name: &str) {
        if let Some(n) = self.names.get_mut(name) {
            *n -= 1;
            if *n == 0 {
                self.names.remove(name);
            }
        }
        self.numbers.clear();
    }

    /// The entry of a runtime object.
    pub(super) fn runtime_object(&mut self, handle: Handle, what: &str) -> Result<&mut Entry, ApiError> {
        let entry = self.entry(handle)?;
        if !entry.is_runtime {
            return Err(ApiError(format!("`{}` belongs to the scene: it cannot be {what}", entry.path)));
        }
        Ok(self.entries[handle.0 as usize - 1].as_mut().expect("it was found"))
    }
}
