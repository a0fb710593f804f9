//! Ids of the user's objects in a compiled model. The world is no object: where it may stand, the id is an [`Option`].

pub use crate::contact::BodyId;

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
    /// Id of a joint that is not fixed: its index in [`Names::joints`](crate::model::Names::joints).
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// # let mut hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    /// # hinge.motor = vec![Motor::new(MotorMode::Torque)];
    /// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
    /// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0, 0.0, -0.5], inertia: [0.0; 6] };
    /// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
    /// # let model = builder.build()?.0;
    /// let hinge: JointId = model.names().joint_id("hinge").unwrap();
    /// let mut world = World::builder(model).coordinates(hinge, &[0.1]).build()?;
    /// world.step()?;
    /// assert!(world.velocities(hinge)[0] < 0.0); // the pendulum swings back [rad/s]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    JointId
}

id! {
    /// Id of a motor: its index in [`Model::motors`](crate::model::Model::motors), and that of its command.
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// # let mut hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    /// # hinge.motor = vec![Motor::new(MotorMode::Torque)];
    /// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
    /// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0, 0.0, -0.5], inertia: [0.0; 6] };
    /// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
    /// # let model = builder.build()?.0;
    /// let motor: MotorId = model.names().motor_id("hinge").unwrap();
    /// let mut world = World::builder(model).step_size(0.01).build()?;
    /// world.set_command(motor, 1.0); // [N·m]
    /// world.step()?;
    /// assert!((world.state.v[0] - 1.0 / (2.0 * 0.25) * 0.01).abs() < 1e-4); // τ t/(m l²) [rad/s]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    MotorId
}

id! {
    /// Id of a rotor: its index in [`Model::rotors`](crate::model::Model::rotors) and
    /// [`Names::rotors`](crate::model::Names::rotors).
    RotorId
}
