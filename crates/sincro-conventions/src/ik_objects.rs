//! Objects that an environment of `simIK` has of its own: dummies and joints that the scene does not have, such as a
//! copy of a robot's chain for a search.
//!
//! Their handles are numbers of their own, [`FIRST`] and above, so that they stand beside the objects of the scene.

use sincro_geometry::spatial::{Pose, Vec3};

use crate::poses::rotation_of_euler;

/// Smallest handle of such an object; those of the scene are smaller, flags of handles larger.
pub const FIRST: i32 = 1_000_000;
/// Objects that one environment can make.
pub const IN_ONE: usize = 1_000;
/// `simIK.jointtype_revolute`
pub const REVOLUTE: i64 = 10;
/// `simIK.jointtype_prismatic`
pub const PRISMATIC: i64 = 11;

/// Joint of an environment: turns about, or slides along, the z axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnJoint {
    /// True if it slides.
    pub is_sliding: bool,
    /// Position `[rad]` or `[m]`.
    pub position: f64,
    /// Smallest position and range `[rad]` or `[m]`; none if it turns without end.
    pub interval: Option<[f64; 2]>,
}

/// Dummy or joint of an environment.
#[derive(Clone, Debug)]
pub struct OwnObject {
    /// Name, unique or not.
    pub name: String,
    /// Handle of the parent, of this environment or of the scene; none: the world.
    pub parent: Option<i32>,
    /// Pose in the frame that its parent carries, `x_po` `[m]`.
    pub pose: Pose<f64>,
    /// None for a dummy.
    pub joint: Option<OwnJoint>,
    /// Handle of the dummy that it is to reach, if it is a tip.
    pub target: Option<i32>,
}

impl OwnObject {
    /// Frame in which its children have their poses, in the frame that its parent carries: that of a joint has moved.
    #[must_use]
    pub fn carried(&self) -> Pose<f64> {
        let Some(joint) = self.joint else { return self.pose };
        let motion = match joint.is_sliding {
            true => Pose::translation(Vec3([0.0, 0.0, joint.position])),
            false => Pose { rot: rotation_of_euler([0.0, 0.0, joint.position]), pos: Vec3::zero() },
        };
        self.pose.compose(&motion)
    }
}

/// Objects of one environment, by handle.
///
/// ```
/// use sincro_conventions::ik_objects::{OwnObjects, REVOLUTE};
///
/// let mut objects = OwnObjects::new(0);
/// let joint = objects.create("joint", Some(REVOLUTE)).unwrap();
/// assert!(objects.get(joint).unwrap().joint.is_some_and(|joint| joint.interval.is_none()));
/// ```
#[derive(Clone, Debug, Default)]
pub struct OwnObjects {
    first: i32,
    objects: Vec<Option<OwnObject>>,
}

impl OwnObjects {
    /// No objects yet; `environment` counts from 0.
    #[must_use]
    pub fn new(environment: usize) -> Self {
        Self { first: FIRST + (environment * IN_ONE) as i32, objects: Vec::new() }
    }

    /// Creates a dummy, or a joint of the type [`REVOLUTE`] or [`PRISMATIC`], in the world's frame; its handle. None if
    /// there are too many, or the type is another one.
    pub fn create(&mut self, name: &str, joint: Option<i64>) -> Option<i32> {
        let joint = match joint {
            None => None,
            Some(REVOLUTE) => Some(OwnJoint { is_sliding: false, position: 0.0, interval: None }),
            Some(PRISMATIC) => Some(OwnJoint { is_sliding: true, position: 0.0, interval: Some([-0.5, 1.0]) }),
            Some(_) => return None,
        };
        if self.objects.len() >= IN_ONE {
            return None;
        }
        let (parent, pose, target) = (None, Pose::identity(), None);
        self.objects.push(Some(OwnObject { name: name.to_owned(), parent, pose, joint, target }));
        Some(self.first + self.objects.len() as i32 - 1)
    }

    fn place(&self, handle: i32) -> Option<usize> {
        usize::try_from(handle.checked_sub(self.first)?).ok()
    }

    /// Object of a handle.
    #[must_use]
    pub fn get(&self, handle: i32) -> Option<&OwnObject> {
        self.objects.get(self.place(handle)?)?.as_ref()
    }

    /// Object of a handle, to be changed.
    pub fn get_mut(&mut self, handle: i32) -> Option<&mut OwnObject> {
        let place = self.place(handle)?;
        self.objects.get_mut(place)?.as_mut()
    }

    /// Handle of the first object of a name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<i32> {
        let is_it = |object: &Option<OwnObject>| object.as_ref().is_some_and(|object| object.name == name);
        self.objects.iter().position(is_it).map(|k| self.first + k as i32)
    }

    /// Handles of all objects, in the order in which they were made.
    pub fn handles(&self) -> impl Iterator<Item = i32> {
        let made = self.objects.iter().enumerate().filter(|(_, object)| object.is_some());
        made.map(|(k, _)| self.first + k as i32)
    }

    /// Erases an object; its children stay where they are in its frame, now in the world.
    pub fn erase(&mut self, handle: i32) {
        if let Some(place) = self.place(handle).filter(|place| *place < self.objects.len()) {
            self.objects[place] = None;
        }
        for object in self.objects.iter_mut().flatten() {
            if object.parent == Some(handle) {
                object.parent = None;
            }
            if object.target == Some(handle) {
                object.target = None;
            }
        }
    }
}
