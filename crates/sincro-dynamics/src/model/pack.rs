//! Several models of one build packed into lanes, and one model lifted into another kind of number.

use std::sync::Arc;

use sincro_math::{Dual, Real};

use super::{Dof, Link, Model, ModelParams, Structure};
use crate::actuation::bushing::LinkFrame;
use crate::actuation::spring_damper::{JointShare, LineActuator, LinkPoint, Path, Segment};
use crate::actuation::{Activation, ActivationDynamics, AppliedTorque, AppliedWrench, Motor};
use crate::actuation::{Bushing, ElasticGear, ForceLaw, SpringDamper, Winding};
use crate::aero::AirDrag;
use crate::aero::rotor::{MountedRotor, SpeedSource};
use crate::joint::Friction;
use crate::spatial::{Mat3, Pose, RigidInertia, Sym3, Vec3};

/// Error of [`Model::pack`]: the models differ in the structure of the part that it names, such as `links and joints`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackError(pub &'static str);

impl std::fmt::Display for PackError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "models differ in their {}: only numbers may differ between the worlds of a batch", self.0)
    }
}

impl std::error::Error for PackError {}

/// Makes a number of one kind from a function that finds it in a model.
type NumberOf<'a, R> = &'a dyn Fn(&dyn Fn(&Model<f64>) -> f64) -> R;

impl<R: Real> Model<R> {
    /// Packs models of one structure into the lanes of `R`, `models[k]` into lane k; the last one fills the remaining
    /// lanes.
    ///
    /// # Errors
    ///
    /// [`PackError`] if the models differ in more than their numbers; it names the part.
    ///
    /// # Panics
    ///
    /// If `models` is empty.
    pub fn pack(models: &[&Model<f64>]) -> Result<Self, PackError> {
        let first = models[0];
        for other in &models[1..] {
            same_structure(first, other)?;
        }
        let of = |k: usize| models[k.min(models.len() - 1)];
        Ok(Self::assemble(models, &|f| R::from_lanes(|k| f(of(k)))))
    }

    /// Model of the structure of the first of `models`, with every number by `num` from what a function finds in all of
    /// them; signals and constraints are those of `models` in lanes.
    fn assemble(models: &[&Model<f64>], num: NumberOf<'_, R>) -> Self {
        let first = models[0];
        let of = |k: usize| models[k.min(models.len() - 1)];
        let vec3 = |f: &dyn Fn(&Model<f64>) -> Vec3<f64>| Vec3(core::array::from_fn(|i| num(&|m| f(m)[i])));
        let mat3 = |f: &dyn Fn(&Model<f64>) -> Mat3<f64>| {
            Mat3(core::array::from_fn(|i| core::array::from_fn(|j| num(&|m| f(m).0[i][j]))))
        };
        let links = (0..first.links.len()).map(|l| Link {
            parent: first.links[l].parent,
            kind: first.links[l].kind,
            turned: first.links[l].turned,
            shift: first.links[l].shift,
            has_children: first.links[l].has_children,
            is_last_child: first.links[l].is_last_child,
            q_idx: first.links[l].q_idx,
            v_idx: first.links[l].v_idx,
            origin: vec3(&|m| m.links[l].origin),
            base_rotation: mat3(&|m| m.links[l].base_rotation),
            sign: num(&|m| m.links[l].sign),
            axis: vec3(&|m| m.links[l].axis),
            pitch: num(&|m| m.links[l].pitch),
        });
        let inertias = (0..first.links.len()).map(|l| RigidInertia {
            mass: num(&|m| m.params.inertias[l].mass),
            moment: vec3(&|m| m.params.inertias[l].moment),
            rotational: Sym3(core::array::from_fn(|i| num(&|m| m.params.inertias[l].rotational.0[i]))),
        });
        let dofs = (0..first.dofs.len()).map(|d| Dof {
            armature: num(&|m| m.dofs[d].armature),
            stiffness: num(&|m| m.dofs[d].stiffness),
            rest: num(&|m| m.dofs[d].rest),
            damping: num(&|m| m.dofs[d].damping),
            friction: Friction {
                sliding: num(&|m| m.dofs[d].friction.sliding),
                at_rest: num(&|m| m.dofs[d].friction.at_rest),
                stribeck_velocity: num(&|m| m.dofs[d].friction.stribeck_velocity),
                load_coefficient: num(&|m| m.dofs[d].friction.load_coefficient),
            },
            torque: num(&|m| m.dofs[d].torque),
            q_idx: first.dofs[d].q_idx,
        });
        let motors = (0..first.params.motors.len()).map(|i| Motor {
            dof: first.params.motors[i].dof,
            mode: first.params.motors[i].mode,
            max_torque: num(&|m| m.params.motors[i].max_torque),
            kp: num(&|m| m.params.motors[i].kp),
            max_velocity: num(&|m| m.params.motors[i].max_velocity),
            stiffness: num(&|m| m.params.motors[i].stiffness),
            damping: num(&|m| m.params.motors[i].damping),
        });
        let windings = first.windings.iter().enumerate().map(|(i, w)| Winding {
            motor: w.motor,
            dof: w.dof,
            state: w.state,
            resistance: num(&|m| m.windings[i].resistance),
            inductance: num(&|m| m.windings[i].inductance),
            torque_constant: num(&|m| m.windings[i].torque_constant),
            back_emf_constant: num(&|m| m.windings[i].back_emf_constant),
            gear_ratio: num(&|m| m.windings[i].gear_ratio),
            rotor_inertia: num(&|m| m.windings[i].rotor_inertia),
            max_voltage: num(&|m| m.windings[i].max_voltage),
        });
        let activations = first.activations.iter().enumerate().map(|(i, own)| Activation {
            command: own.command,
            state: own.state,
            dynamics: match own.dynamics {
                ActivationDynamics::Integrator => ActivationDynamics::Integrator,
                ActivationDynamics::Filter { .. } => ActivationDynamics::Filter {
                    time_constant: num(&|m| m.activations[i].time_constant().unwrap_or(1.0)),
                },
            },
            input_range: core::array::from_fn(|k| num(&|m| m.activations[i].input_range[k])),
            range: core::array::from_fn(|k| num(&|m| m.activations[i].range[k])),
            initial: num(&|m| m.activations[i].initial),
        });
        let lanes = |f: &dyn Fn(&Model<f64>) -> crate::signal::Signal| (0..R::LANES).map(|k| f(of(k))).collect();
        let applied = (0..first.applied.len())
            .map(|i| AppliedTorque { dof: first.applied[i].dof, signal: lanes(&|m| m.applied[i].signal[0].clone()) });
        let wrenches = (0..first.wrenches.len()).map(|i| AppliedWrench {
            link: first.wrenches[i].link,
            in_body: first.wrenches[i].in_body,
            input: first.wrenches[i].input,
            pose: Pose { rot: mat3(&|m| m.wrenches[i].pose.rot), pos: vec3(&|m| m.wrenches[i].pose.pos) },
            force: core::array::from_fn(|c| lanes(&|m| m.wrenches[i].force[c][0].clone())),
            torque: core::array::from_fn(|c| lanes(&|m| m.wrenches[i].torque[c][0].clone())),
        });
        let rotors = (0..first.rotors.len()).map(|i| MountedRotor {
            link: first.rotors[i].link,
            pose: Pose { rot: mat3(&|m| m.rotors[i].pose.rot), pos: vec3(&|m| m.rotors[i].pose.pos) },
            law: first.rotors[i].law.clone(),
            speed: match first.rotors[i].speed {
                SpeedSource::Lag { command, state, .. } => {
                    let lag = |m: &Model<f64>| m.rotors[i].speed.lag().unwrap_or((1.0, 0.0));
                    SpeedSource::Lag { command, state, time_constant: num(&|m| lag(m).0), initial: num(&|m| lag(m).1) }
                }
                SpeedSource::Command(k) => SpeedSource::Command(k),
                SpeedSource::Particles { command, state } => SpeedSource::Particles { command, state },
                SpeedSource::Joint { dof, sign } => SpeedSource::Joint { dof, sign },
            },
            density: first.rotors[i].density,
            atmosphere: first.rotors[i].atmosphere.clone(),
            inertia: first.rotors[i].inertia,
            ground_effect: first.rotors[i].ground_effect,
        });
        let drags = (0..first.drags.len()).map(|i| AirDrag {
            link: first.drags[i].link,
            pose: Pose { rot: mat3(&|m| m.drags[i].pose.rot), pos: vec3(&|m| m.drags[i].pose.pos) },
            area: vec3(&|m| m.drags[i].area),
            linear: vec3(&|m| m.drags[i].linear),
            density: first.drags[i].density,
            atmosphere: first.drags[i].atmosphere.clone(),
        });
        let spring_dampers = (0..first.spring_dampers.len()).map(|i| {
            let of_first = &first.spring_dampers[i];
            let number = |f: &dyn Fn(&SpringDamper<f64>) -> f64| num(&|m| f(&m.spring_dampers[i]));
            SpringDamper {
                path: match &of_first.path {
                    Path::Lines(segments) => {
                        let segment = |s: usize| Segment {
                            ends: core::array::from_fn(|e| LinkPoint {
                                link: segments[s].ends[e].link,
                                position: vec3(&|m| m.spring_dampers[i].segments()[s].ends[e].position),
                            }),
                        };
                        Path::Lines((0..segments.len()).map(segment).collect())
                    }
                    Path::Joints(shares) => {
                        let share = |(s, share): (usize, &JointShare<f64>)| JointShare {
                            dof: share.dof,
                            coordinate: share.coordinate,
                            coefficient: number(&|x| x.shares()[s].coefficient),
                        };
                        Path::Joints(shares.iter().enumerate().map(share).collect())
                    }
                },
                free_length: number(&|s| s.free_length),
                law: ForceLaw {
                    stiffness: number(&|s| s.law.stiffness),
                    damping: number(&|s| s.law.damping),
                    preload: number(&|s| s.law.preload),
                    nonlinear: of_first.law.nonlinear.clone(),
                },
                tension_only: of_first.tension_only,
                actuator: of_first.actuator.map(|a| LineActuator {
                    command: a.command,
                    max_force: number(&|s| s.actuator.map_or(f64::INFINITY, |a| a.max_force)),
                }),
            }
        });
        let elastic_gears = first.elastic_gears.iter().enumerate().map(|(i, gear)| ElasticGear {
            dofs: gear.dofs,
            coordinates: gear.coordinates,
            ratio: num(&|m| m.elastic_gears[i].ratio),
            offset: num(&|m| m.elastic_gears[i].offset),
            stiffness: num(&|m| m.elastic_gears[i].stiffness),
            damping: num(&|m| m.elastic_gears[i].damping),
            backlash: num(&|m| m.elastic_gears[i].backlash),
        });
        let bushings = first.bushings.iter().enumerate().map(|(i, own)| Bushing {
            ends: core::array::from_fn(|e| LinkFrame {
                link: own.ends[e].link,
                pose: Pose {
                    rot: mat3(&|m| m.bushings[i].ends[e].pose.rot),
                    pos: vec3(&|m| m.bushings[i].ends[e].pose.pos),
                },
            }),
            stiffness: core::array::from_fn(|k| num(&|m| m.bushings[i].stiffness[k])),
            damping: core::array::from_fn(|k| num(&|m| m.bushings[i].damping[k])),
        });
        let params = ModelParams {
            gravity: vec3(&|m| m.params.gravity),
            inertias: inertias.collect(),
            masses: first.params.masses.clone(),
            motors: motors.collect(),
            drives: first.params.drives.clone(),
            constraints: Arc::clone(&first.params.constraints),
        };
        let structure = Structure {
            links: links.collect(),
            dofs: dofs.collect(),
            applied: applied.collect(),
            wrenches: wrenches.collect(),
            windings: windings.collect(),
            activations: activations.collect(),
            rotors: rotors.collect(),
            drags: drags.collect(),
            spring_dampers: spring_dampers.collect(),
            elastic_gears: elastic_gears.collect(),
            bushings: bushings.collect(),
            wind: first.wind.clone(),
            gravity_field: first.gravity_field.clone(),
            n_q: first.n_q,
            sprung: first.sprung.clone(),
            nonlinear_springs: first.nonlinear_springs.clone(),
            names: Arc::clone(&first.names),
        };
        Self::new(structure, params)
    }
}

impl Model<Dual<1>> {
    /// Lifts `models[0]` to dual numbers whose derivatives come from the same model at other values of what is
    /// differentiated by: `derivative` gets one number of all `models`, in their order, and returns its derivative at
    /// the first. Limits of joints and contacts are left out.
    ///
    /// # Errors
    ///
    /// [`PackError`] if the models differ in a part whose numbers carry no derivatives, such as signals, frames, limits
    /// and laws of contact; it names the part.
    ///
    /// # Panics
    ///
    /// If `models` is empty.
    pub fn differentiated(models: &[&Model<f64>], derivative: &dyn Fn(&[f64]) -> f64) -> Result<Self, PackError> {
        let first = models[0];
        for other in &models[1..] {
            same_structure(first, other)?;
            same_functions(first, other)?;
        }
        let mut model = Self::assemble(models, &|f| {
            let values: Vec<f64> = models.iter().map(|m| f(m)).collect();
            let is_constant = values.iter().all(|x| *x == values[0]);
            Dual { value: values[0], partials: [if is_constant { 0.0 } else { derivative(&values) }] }
        });
        model.params.constraints = Arc::default();
        Ok(model)
    }
}

/// Refuses models that differ in functions of time or in the places of frames, which are the same numbers in all lanes.
fn same_functions(a: &Model<f64>, b: &Model<f64>) -> Result<(), PackError> {
    let torques = |m: &Model<f64>| m.applied.iter().map(|x| x.signal.clone()).collect::<Vec<_>>();
    let forces = |m: &Model<f64>| m.wrenches.iter().map(|x| (x.force.clone(), x.torque.clone())).collect::<Vec<_>>();
    let frames = |m: &Model<f64>| m.names.frames.iter().map(|x| x.pose).collect::<Vec<_>>();
    let checks = [
        (torques(a) == torques(b), "applied torques over time"),
        (forces(a) == forces(b), "external forces over time"),
        (frames(a) == frames(b), "places of bodies and frames in their links"),
    ];
    checks.iter().find(|(same, _)| !same).map_or(Ok(()), |(_, what)| Err(PackError(what)))
}

fn same_structure(a: &Model<f64>, b: &Model<f64>) -> Result<(), PackError> {
    let links = |m: &Model<f64>| -> Vec<_> {
        m.links.iter().map(|l| (l.parent, l.kind, l.turned, l.shift, l.q_idx, l.v_idx)).collect()
    };
    let motors = |m: &Model<f64>| -> Vec<_> { m.params.motors.iter().map(|x| (x.dof, x.mode)).collect() };
    let windings = |m: &Model<f64>| -> Vec<_> { m.windings.iter().map(|w| (w.motor, w.state)).collect() };
    let activations = |m: &Model<f64>| -> Vec<_> {
        m.activations.iter().map(|x| (x.command, x.state, x.time_constant().is_some())).collect()
    };
    let applied = |m: &Model<f64>| -> Vec<_> { m.applied.iter().map(|x| x.dof).collect() };
    let wrenches = |m: &Model<f64>| -> Vec<_> { m.wrenches.iter().map(|x| (x.link, x.in_body, x.input)).collect() };
    let rotors = |m: &Model<f64>| -> Vec<_> {
        m.rotors
            .iter()
            .map(|x| (x.link, x.law.clone(), x.speed.structure(), x.density, x.inertia, x.ground_effect))
            .collect()
    };
    let drags = |m: &Model<f64>| -> Vec<_> { m.drags.iter().map(|x| (x.link, x.density)).collect() };
    let lines = |m: &Model<f64>| -> Vec<_> {
        let structure = |s: &SpringDamper<f64>| {
            let links: Vec<_> = s.segments().iter().map(|segment| segment.ends.map(|e| e.link)).collect();
            let dofs: Vec<_> = s.shares().iter().map(|share| share.dof).collect();
            (links, dofs, s.tension_only, s.law.nonlinear.clone(), s.actuator.map(|a| a.command))
        };
        m.spring_dampers.iter().map(structure).collect()
    };
    let gears = |m: &Model<f64>| -> Vec<_> { m.elastic_gears.iter().map(|gear| gear.dofs).collect() };
    let bushings = |m: &Model<f64>| -> Vec<_> { m.bushings.iter().map(|x| x.ends.map(|end| end.link)).collect() };
    let friction = |m: &Model<f64>| -> Vec<_> { m.dofs.iter().map(|x| !x.friction.is_none()).collect() };
    let checks = [
        (links(a) == links(b), "links and joints"),
        (motors(a) == motors(b), "motors"),
        (windings(a) == windings(b), "windings of motors"),
        (activations(a) == activations(b), "activations of actuators"),
        (applied(a) == applied(b), "applied torques"),
        (wrenches(a) == wrenches(b), "external forces"),
        (rotors(a) == rotors(b), "rotors"),
        (drags(a) == drags(b), "drag elements"),
        (gears(a) == gears(b), "elastic gears"),
        (bushings(a) == bushings(b), "bushings"),
        (lines(a) == lines(b), "springs and dampers between two points, and tendons"),
        (a.wind == b.wind, "wind"),
        (a.gravity_field == b.gravity_field, "gravity over the position"),
        (a.params.constraints == b.params.constraints, "loop joints, limits and contacts"),
        (friction(a) == friction(b), "set of joints with Coulomb friction"),
        (a.nonlinear_springs == b.nonlinear_springs, "nonlinear springs of joints"),
        (a.sprung == b.sprung, "set of ball and free joints with springs"),
    ];
    checks.iter().find(|(same, _)| !same).map_or(Ok(()), |(_, what)| Err(PackError(what)))
}
