//! Ids of the user's objects in a compiled model. The world is no object: where it may stand, the id is an [`Option`].

/// Defines an id: an index in one list of the model, which ids of other kinds cannot be mistaken for.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(u32);

        impl $name {
            /// Makes the id of index `index`, counted from 0.
            ///
            /// # Panics
            ///
            /// If the index does not fit in 32 bits.
            #[must_use]
            pub fn new(index: usize) -> Self {
                Self(u32::try_from(index).expect("fewer than 2^32 objects"))
            }

            /// Index in its list, counted from 0.
            #[inline(always)]
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id! {
    /// Id of a body or frame: its index in [`Names::frames`](crate::model::Names::frames).
    BodyId
}

id! {
    /// Id of a joint that is not fixed: its index in [`Names::joints`](crate::model::Names::joints).
    JointId
}

id! {
    /// Id of a motor: its index in [`Model::motors`](crate::model::Model::motors), and that of its command.
    MotorId
}

id! {
    /// Id of a rotor: its index in [`Model::rotors`](crate::model::Model::rotors) and
    /// [`Names::rotors`](crate::model::Names::rotors).
    RotorId
}
