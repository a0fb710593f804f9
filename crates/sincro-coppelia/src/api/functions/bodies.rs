//! Functions: bodies, forces on them, their mass.

use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::{Pose, Sym3, Vec3};

use super::{Function, Outcome, done, handle, one};
use crate::api::convention::{matrix_of, pose_of_matrix};
use crate::api::{ApiError, Arguments, Handle, Kind, Reference, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "addForceAndTorque",
        tip: "sim.addForceAndTorque(int shapeHandle,float[3] force={0,0,0},float[3] torque={0,0,0})",
        run: push,
    },
    Function { name: "addForce", tip: "sim.addForce(int shapeHandle,float[3] position,float[3] force)", run: push_at },
    Function { name: "getShapeMass", tip: "float mass=sim.getShapeMass(int shapeHandle)", run: mass },
    Function {
        name: "getShapeInertia",
        tip: "float[9] inertiaMatrix,float[12] transformationMatrix=sim.getShapeInertia(int shapeHandle)",
        run: inertia,
    },
    Function {
        name: "getShapeMassAndInertia",
        tip: "float mass,float[9] inertiaMatrix,float[3] centerOfMass=sim.getShapeMassAndInertia(int shapeHandle,float[12] matrix=nil)",
        run: both,
    },
    Function { name: "setShapeMass", tip: "sim.setShapeMass(int shapeHandle,float mass)", run: set_mass },
    Function {
        name: "setShapeInertia",
        tip: "sim.setShapeInertia(int shapeHandle,float[9] inertiaMatrix,float[12] transformationMatrix)",
        run: set_inertia,
    },
    Function {
        name: "setShapeMassAndInertia",
        tip: "int result=sim.setShapeMassAndInertia(int shapeHandle,float mass,float[9] inertiaMatrix,float[3] centerOfMass,float[12] matrix=nil)",
        run: set_both,
    },
    Function {
        name: "computeMassAndInertia",
        tip: "int result=sim.computeMassAndInertia(int shapeHandle,float density)",
        run: compute,
    },
    Function {
        name: "setEngineFloatParam",
        tip: "int result=sim.setEngineFloatParam(int paramId,int objectHandle,float floatParam)",
        run: |sim, a| {
            let object = handle(sim, a, 1)?;
            sim.set_engine_float(a.int(0)?, object, a.real(2)?)?;
            one(1_i64)
        },
    },
    Function {
        name: "getEngineFloatParam",
        tip: "float floatParam=sim.getEngineFloatParam(int paramId,int objectHandle)",
        run: |sim, a| {
            let object = handle(sim, a, 1)?;
            one(sim.engine_float(a.int(0)?, object)?)
        },
    },
    Function {
        name: "isDynamicallyEnabled",
        tip: "bool enabled=sim.isDynamicallyEnabled(int objectHandle)",
        run: is_dynamic,
    },
    Function { name: "resetDynamicObject", tip: "int result=sim.resetDynamicObject(int objectHandle)", run: reset },
];

fn body(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Handle, ApiError> {
    handle(sim, a, 0)
}

fn three(a: Arguments<'_>, k: usize) -> Result<[f64; 3], ApiError> {
    if a.has(k) { a.reals(k) } else { Ok([0.0; 3]) }
}

fn push(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    sim.add_force_and_torque(own, three(a, 1)?, three(a, 2)?)?;
    done()
}

fn push_at(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    sim.add_force(own, a.reals(1)?, a.reals(2)?)?;
    done()
}

fn mass(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let shape = super::handle(sim, a, 0)?;
    if sim.registry.entry(shape)?.kind == Kind::Shape {
        sim.check_shape(shape)?;
        return one(sim.shape_mass(shape)?);
    }
    let own = body(sim, a)?;
    one(sim.mass(own)?.mass)
}

fn nine(m: [f64; 6]) -> Value {
    Value::reals(Sym3(m).full().0.into_iter().flatten())
}

/// Mass properties of a body, or of a shape that is none.
fn properties(sim: &mut SimApi<'_>, own: Handle) -> Result<MassProperties, ApiError> {
    if sim.registry.entry(own)?.kind == Kind::Shape {
        sim.check_shape(own)?;
        return sim.shape_mass_properties(own);
    }
    sim.mass(own)
}

fn inertia(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    let mass = properties(sim, own)?;
    let at = sincro_dynamics::spatial::Pose::translation(Vec3(mass.center_of_mass));
    Ok(vec![nine(mass.inertia), Value::reals(matrix_of(&at))])
}

/// About the centre of mass, in the axes of the given frame, the world's if none is given.
fn both(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    let mass = properties(sim, own)?;
    let x_wb = sim.pose(own, Reference::World)?;
    let x_fb = if a.has(1) { pose_of_matrix(&a.reals(1)?).inverse().compose(&x_wb) } else { x_wb };
    let placed = mass.placed(&x_fb.rot, x_fb.pos);
    Ok(vec![Value::Real(mass.mass), nine(placed.inertia), Value::reals(placed.center_of_mass)])
}

/// V-REP keeps the inertia of a unit of mass: it grows with the mass.
fn set_mass(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let shape = super::handle(sim, a, 0)?;
    if sim.registry.entry(shape)?.kind == Kind::Shape {
        sim.check_shape(shape)?;
        return sim.set_shape_mass(shape, a.real(1)?).and_then(|()| done());
    }
    let own = body(sim, a)?;
    let scaled = sim.mass_scaled(own, a.real(1)?)?;
    sim.set_mass(own, scaled)?;
    done()
}

/// Six numbers of a symmetric matrix of nine; the mean of what should be the same, as far as rounding goes.
fn symmetric(a: Arguments<'_>, k: usize) -> Result<Sym3<f64>, ApiError> {
    let m: [f64; 9] = a.reals(k)?;
    let largest = m.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if let Some((i, j)) = [(1, 3), (2, 6), (5, 7)].into_iter().find(|(i, j)| (m[*i] - m[*j]).abs() > 1e-6 * largest) {
        return Err(ApiError(format!("the inertia is not symmetric: {} and {}", m[i], m[j])));
    }
    let mean = |i: usize, j: usize| 0.5 * (m[i] + m[j]);
    Ok(Sym3([m[0], mean(1, 3), mean(2, 6), m[4], mean(5, 7), m[8]]))
}

/// About the centre of mass, which the matrix places in the shape, in the matrix's axes.
fn set_inertia(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    let (inertia, at) = (symmetric(a, 1)?, pose_of_matrix(&a.reals(2)?));
    let mass = sim.mass(own)?.mass;
    let about = MassProperties { mass, center_of_mass: [0.0; 3], inertia: inertia.0 };
    sim.set_mass(own, about.placed(&at.rot, at.pos))?;
    done()
}

/// Centre of mass and inertia are in the given frame, the world if none is given.
fn set_both(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    let (mass, inertia, center_of_mass) = (a.real(1)?, symmetric(a, 2)?.0, a.reals(3)?);
    let x_wb = sim.pose(own, Reference::World)?;
    let x_wf = if a.has(4) { pose_of_matrix(&a.reals(4)?) } else { Pose::identity() };
    let x_bf = x_wb.inverse().compose(&x_wf);
    let given = MassProperties { mass, center_of_mass, inertia };
    sim.set_mass(own, given.placed(&x_bf.rot, x_bf.pos))?;
    one(1_i64)
}

fn compute(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    if sim.registry.entry(own)?.kind == Kind::Shape {
        sim.check_shape(own)?;
        sim.set_shape_density(own, a.real(1)?)?;
        return one(1_i64);
    }
    let mass = sim.mass_at_density(own, a.real(1)?)?;
    sim.set_mass(own, mass)?;
    one(1_i64)
}

fn is_dynamic(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    // a joint acts on what it carries, whatever carries it
    let is_held = match sim.registry.entry(own)?.kind {
        Kind::Joint(_) => sim.registry.joint_modes.contains_key(&own),
        _ => sim.is_fixed(own)?,
    };
    one(sim.is_running() && !is_held)
}

/// The initial velocity that was set for a body takes effect.
fn reset(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(sim, a)?;
    sim.reset_dynamics(own)?;
    one(1_i64)
}
