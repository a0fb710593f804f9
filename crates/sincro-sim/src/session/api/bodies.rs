//! Shelf: bodies, forces on them, their mass.

use sincro_dynamics::spatial::{Sym3, Vec3};

use super::{Function, Outcome, done, handle, one};
use crate::session::convention::{matrix_of, pose_of_matrix};
use crate::session::{Arguments, Desk, Handle, Reference, Refusal, Value};

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
    Function {
        name: "isDynamicallyEnabled",
        tip: "bool enabled=sim.isDynamicallyEnabled(int objectHandle)",
        run: is_dynamic,
    },
    Function { name: "resetDynamicObject", tip: "int result=sim.resetDynamicObject(int objectHandle)", run: reset },
];

fn body(desk: &Desk<'_>, a: Arguments<'_>) -> Result<Handle, Refusal> {
    handle(desk, a, 0)
}

fn three(a: Arguments<'_>, k: usize) -> Result<[f64; 3], Refusal> {
    if a.has(k) { a.reals(k) } else { Ok([0.0; 3]) }
}

fn push(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    desk.add_force_and_torque(own, three(a, 1)?, three(a, 2)?)?;
    done()
}

fn push_at(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    desk.add_force(own, a.reals(1)?, a.reals(2)?)?;
    done()
}

fn mass(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    one(desk.mass(own)?.mass)
}

fn nine(m: [f64; 6]) -> Value {
    Value::reals(Sym3(m).full().0.into_iter().flatten())
}

fn inertia(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    let mass = desk.mass(own)?;
    let at = sincro_dynamics::spatial::Pose::translation(Vec3(mass.center_of_mass));
    Ok(vec![nine(mass.inertia), Value::reals(matrix_of(&at))])
}

/// About the centre of mass, in the axes of the given frame, the world's if none is given.
fn both(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    let mass = desk.mass(own)?;
    let x_wb = desk.pose(own, Reference::World)?;
    let x_fb = if a.has(1) { pose_of_matrix(&a.reals(1)?).inverse().compose(&x_wb) } else { x_wb };
    let placed = mass.placed(&x_fb.rot, x_fb.pos);
    Ok(vec![Value::Real(mass.mass), nine(placed.inertia), Value::reals(placed.center_of_mass)])
}

fn is_dynamic(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    let own = body(desk, a)?;
    one(desk.is_running() && desk.table.entry(own)?.frame.link.is_some())
}

/// The engine has no copies of objects that could be out of date: there is nothing to do.
fn reset(desk: &mut Desk<'_>, a: Arguments<'_>) -> Outcome {
    body(desk, a)?;
    one(1_i64)
}
