//! Structure of a model: what never changes once it is built.

use std::sync::Arc;

use super::{Dof, Link, Names};
use crate::actuation::spring::NonlinearSpring;
use crate::actuation::{
    Activation, AppliedTorque, AppliedWrench, Bushing, ElasticGear, GravityField, SpringDamper, Winding,
};
use crate::aero::AirDrag;
use crate::aero::rotor::MountedRotor;
use crate::aero::wind::Wind;

/// Tree of links with its elements, shared by all copies of a [`Model`](super::Model), whose methods read it.
#[derive(Clone, Debug)]
pub struct Structure<R> {
    /// Moving links, parents before children.
    pub(crate) links: Vec<Link<R>>,
    /// Passive properties of each degree of freedom.
    pub(crate) dofs: Vec<Dof<R>>,
    /// Torques that are functions of time.
    pub(crate) applied: Vec<AppliedTorque>,
    /// External forces.
    pub(crate) wrenches: Vec<AppliedWrench<R>>,
    /// Windings of direct-current motors, in the order of their motors.
    pub(crate) windings: Vec<Winding<R>>,
    /// Activations of actuators, in the order of their commands.
    pub(crate) activations: Vec<Activation<R>>,
    pub(crate) rotors: Vec<MountedRotor<R>>,
    pub(crate) drags: Vec<AirDrag<R>>,
    pub(crate) spring_dampers: Vec<SpringDamper<R>>,
    pub(crate) elastic_gears: Vec<ElasticGear<R>>,
    pub(crate) bushings: Vec<Bushing<R>>,
    pub(crate) wind: Option<Arc<Wind>>,
    pub(crate) gravity_field: Option<Arc<GravityField>>,
    /// Number of coordinates.
    pub(crate) n_q: usize,
    /// Links of ball and free joints with springs.
    pub(crate) sprung: Vec<usize>,
    pub(crate) nonlinear_springs: Vec<NonlinearSpring>,
    pub(crate) names: Arc<Names>,
}
