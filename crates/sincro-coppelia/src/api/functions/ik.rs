//! Functions: `simIK`, inverse kinematics.

use super::objects::handles;
use super::{Function, Outcome, done, function, one, plain};
use crate::api::convention::{matrix_of, numbers_of_pose, pose_of_matrix, pose_of_numbers};
use crate::api::ik::Element;
use crate::api::{ApiError, Arguments, Handle, Kind, Pose, Search, SimApi, Value};
pub use sincro_conventions::ik_names::CONSTANTS;
use sincro_conventions::ik_names::{ALL, MODE_IK};
pub(super) use sincro_conventions::ik_names::{LIMIT_HIT, NOT_WITHIN_TOLERANCE, OLD};
use sincro_conventions::ik_objects::{IN_ONE, PRISMATIC, REVOLUTE};

/// Functions of `simIK`, named without it.
pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "createEnvironment", tip: "int environmentHandle=simIK.createEnvironment()", run: create },
    Function { name: "eraseEnvironment", tip: "simIK.eraseEnvironment(int environmentHandle)", run: erase },
    Function {
        name: "createGroup",
        tip: "int groupHandle=simIK.createGroup(int environmentHandle,string groupName='')",
        run: create_group,
    },
    Function {
        name: "getGroupHandle",
        tip: "int groupHandle=simIK.getGroupHandle(int environmentHandle,string groupName)",
        run: |d, a| one(d.group_of_name(Some(a.int(0)?), a.text(1)?)?.1),
    },
    Function {
        name: "setGroupCalculation",
        tip: "simIK.setGroupCalculation(int environmentHandle,int groupHandle,int method,float dampingFactor,int maxIterations)",
        run: calculation,
    },
    Function {
        name: "addElementFromScene",
        tip: "int elementHandle=simIK.addElementFromScene(int environmentHandle,int groupHandle,int baseHandle,int tipHandle,int targetHandle,int constraints)",
        run: add,
    },
    Function {
        name: "setElementPrecision",
        tip: "simIK.setElementPrecision(int environmentHandle,int groupHandle,int elementHandle,float[2] precision)",
        run: precision,
    },
    Function {
        name: "setElementWeights",
        tip: "simIK.setElementWeights(int environmentHandle,int groupHandle,int elementHandle,float[2] weights)",
        run: weights,
    },
    Function {
        name: "handleGroup",
        tip: "int result,int flags,float[2] precision=simIK.handleGroup(int environmentHandle,int groupHandle,map options={})",
        run: handle,
    },
    Function { name: "syncFromSim", tip: "simIK.syncFromSim(int environmentHandle,int[] groupHandles)", run: sync },
    Function {
        name: "syncToSim",
        tip: "simIK.syncToSim(int environmentHandle,int[] groupHandles)",
        run: |d, a| d.sync_to_scene(a.int(0)?).and_then(|()| done()),
    },
    Function {
        name: "applyIkEnvironmentToScene",
        tip: "int result,int flags=simIK.applyIkEnvironmentToScene(int environmentHandle,int groupHandle,bool applyOnlyWhenSuccessful=false)",
        run: apply,
    },
    Function {
        name: "applySceneToIkEnvironment",
        tip: "simIK.applySceneToIkEnvironment(int environmentHandle,int groupHandle)",
        run: sync,
    },
    Function {
        name: "doesGroupExist",
        tip: "bool result=simIK.doesGroupExist(int environmentHandle,string groupName)",
        run: |d, a| one(d.group_of_name(Some(a.int(0)?), a.text(1)?).is_ok()),
    },
    Function {
        name: "getGroupCalculation",
        tip: "int method,float dampingFactor,int maxIterations=simIK.getGroupCalculation(int environmentHandle,int groupHandle)",
        run: get_calculation,
    },
    Function {
        name: "setGroupFlags",
        tip: "simIK.setGroupFlags(int environmentHandle,int groupHandle,int flags)",
        run: group_flags,
    },
    Function {
        name: "getGroupFlags",
        tip: "int flags=simIK.getGroupFlags(int environmentHandle,int groupHandle)",
        run: |d, a| {
            let group = d.group(a.int(0)?, a.int(1)?)?;
            one(i64::from(group.is_enabled) | i64::from(group.has_free_steps) << 1)
        },
    },
    Function {
        name: "setElementBase",
        tip: "simIK.setElementBase(int environmentHandle,int groupHandle,int elementHandle,int baseHandle,int constraintsBaseHandle=-1)",
        run: set_base,
    },
    Function {
        name: "getElementBase",
        tip: "int baseHandle,int constraintsBaseHandle=simIK.getElementBase(int environmentHandle,int groupHandle,int elementHandle)",
        run: |d, a| {
            let element = d.element(a.int(0)?, a.int(1)?, a.int(2)?)?;
            let number = |handle: Option<Handle>| Value::from(handle.unwrap_or(Handle(-1)));
            Ok(vec![number(element.base), number(element.axes_of)])
        },
    },
    Function {
        name: "setElementConstraints",
        tip: "simIK.setElementConstraints(int environmentHandle,int groupHandle,int elementHandle,int constraints)",
        run: set_constraints,
    },
    Function {
        name: "getElementConstraints",
        tip: "int constraints=simIK.getElementConstraints(int environmentHandle,int groupHandle,int elementHandle)",
        run: |d, a| one(d.element(a.int(0)?, a.int(1)?, a.int(2)?)?.constraints),
    },
    Function {
        name: "setElementFlags",
        tip: "simIK.setElementFlags(int environmentHandle,int groupHandle,int elementHandle,int flags)",
        run: |d, a| {
            let enabled = a.int(3)? & 1 != 0;
            d.element(a.int(0)?, a.int(1)?, a.int(2)?)?.is_enabled = enabled;
            done()
        },
    },
    Function {
        name: "getElementFlags",
        tip: "int flags=simIK.getElementFlags(int environmentHandle,int groupHandle,int elementHandle)",
        run: |d, a| one(i64::from(d.element(a.int(0)?, a.int(1)?, a.int(2)?)?.is_enabled)),
    },
    Function {
        name: "getElementPrecision",
        tip: "float[2] precision=simIK.getElementPrecision(int environmentHandle,int groupHandle,int elementHandle)",
        run: |d, a| super::list(d.element(a.int(0)?, a.int(1)?, a.int(2)?)?.precision),
    },
    Function {
        name: "getElementWeights",
        tip: "float[2] weights=simIK.getElementWeights(int environmentHandle,int groupHandle,int elementHandle)",
        run: |d, a| super::list(d.element(a.int(0)?, a.int(1)?, a.int(2)?)?.weights),
    },
    Function {
        name: "createDummy",
        tip: "int dummyHandle=simIK.createDummy(int environmentHandle,string dummyName='')",
        run: |d, a| create_own(d, a, if a.has(1) { a.text(1)? } else { "" }, None),
    },
    Function {
        name: "createJoint",
        tip: "int jointHandle=simIK.createJoint(int environmentHandle,int jointType,string jointName='')",
        run: |d, a| create_own(d, a, if a.has(2) { a.text(2)? } else { "" }, Some(a.int(1)?)),
    },
    Function {
        name: "getTargetDummy",
        tip: "int targetDummyHandle=simIK.getTargetDummy(int environmentHandle,int dummyHandle)",
        run: |d, a| {
            let tip = own(d, a, 1)?;
            one(d.own_object(tip).and_then(|own| own.target).map_or(-1, i64::from))
        },
    },
    Function {
        name: "setTargetDummy",
        tip: "simIK.setTargetDummy(int environmentHandle,int dummyHandle,int targetDummyHandle)",
        run: set_target,
    },
    Function {
        name: "addElement",
        tip: "int elementHandle=simIK.addElement(int environmentHandle,int groupHandle,int tipDummyHandle)",
        run: add_own,
    },
    Function {
        name: "getObjectHandle",
        tip: "int objectHandle=simIK.getObjectHandle(int environmentHandle,string objectName)",
        run: |d, a| {
            if let Some(own) = d.environment(a.int(0)?)?.own.find(a.text(1)?) {
                return one(i64::from(own));
            }
            one(d.registry.find(a.text(1)?, Search { from: d.own, ..Search::default() })?)
        },
    },
    Function {
        name: "doesObjectExist",
        tip: "bool result=simIK.doesObjectExist(int environmentHandle,string objectName)",
        run: |d, a| {
            let is_own = d.environment(a.int(0)?)?.own.find(a.text(1)?).is_some();
            one(is_own || d.registry.find(a.text(1)?, Search { from: d.own, ..Search::default() }).is_ok())
        },
    },
    Function {
        name: "eraseObject",
        tip: "simIK.eraseObject(int environmentHandle,int objectHandle)",
        run: |d, a| {
            let object = object(d, a, 1)?;
            match d.own_object(object) {
                Some(_) => d.environment(a.int(0)?)?.own.erase(object.0),
                None => d.remove(object)?,
            }
            done()
        },
    },
    Function {
        name: "getObjectPose",
        tip: "float[7] pose=simIK.getObjectPose(int environmentHandle,int objectHandle,int relativeToObjectHandle=-1)",
        run: |d, a| inside(d, a, "getObjectPose"),
    },
    Function {
        name: "setObjectPose",
        tip: "simIK.setObjectPose(int environmentHandle,int objectHandle,float[7] pose,int relativeToObjectHandle=-1)",
        run: |d, a| inside(d, a, "setObjectPose"),
    },
    Function {
        name: "getObjectMatrix",
        tip: "float[12] matrix=simIK.getObjectMatrix(int environmentHandle,int objectHandle,int relativeToObjectHandle=-1)",
        run: |d, a| inside(d, a, "getObjectMatrix"),
    },
    Function {
        name: "setObjectMatrix",
        tip: "simIK.setObjectMatrix(int environmentHandle,int objectHandle,float[12] matrix,int relativeToObjectHandle=-1)",
        run: |d, a| inside(d, a, "setObjectMatrix"),
    },
    Function {
        name: "setObjectParent",
        tip: "simIK.setObjectParent(int environmentHandle,int objectHandle,int parentObjectHandle,bool keepInPlace=true)",
        run: |d, a| inside(d, a, "setObjectParent"),
    },
    Function {
        name: "getObjectParent",
        tip: "int parentObjectHandle=simIK.getObjectParent(int environmentHandle,int objectHandle)",
        run: |d, a| inside(d, a, "getObjectParent"),
    },
    Function {
        name: "getJointInterval",
        tip: "bool cyclic,float[2] interval=simIK.getJointInterval(int environmentHandle,int jointHandle)",
        run: |d, a| inside(d, a, "getJointInterval"),
    },
    Function {
        name: "setJointInterval",
        tip: "simIK.setJointInterval(int environmentHandle,int jointHandle,bool cyclic,float[2] interval={})",
        run: set_joint_interval,
    },
    Function {
        name: "getJointType",
        tip: "int jointType=simIK.getJointType(int environmentHandle,int jointHandle)",
        run: |d, a| inside(d, a, "getJointType"),
    },
    Function {
        name: "getJointPosition",
        tip: "float position=simIK.getJointPosition(int environmentHandle,int jointHandle)",
        run: joint_position,
    },
    Function {
        name: "setJointPosition",
        tip: "simIK.setJointPosition(int environmentHandle,int jointHandle,float position)",
        run: set_joint_position,
    },
    Function {
        name: "getJointMode",
        tip: "int jointMode=simIK.getJointMode(int environmentHandle,int jointHandle)",
        run: |d, a| {
            let joint = object(d, a, 1)?;
            one(if d.environment(a.int(0)?)?.passive.contains(&joint) { 0 } else { MODE_IK })
        },
    },
    Function {
        name: "setJointMode",
        tip: "simIK.setJointMode(int environmentHandle,int jointHandle,int jointMode)",
        run: set_joint_mode,
    },
    Function {
        name: "computeGroupJacobian",
        tip: "float[] jacobian,float[] errorVector=simIK.computeGroupJacobian(int environmentHandle,int groupHandle)",
        run: |d, a| {
            let (rows, e) = d.group_jacobian(a.int(0)?, a.int(1)?)?;
            Ok(vec![Value::reals(rows.into_iter().flatten()), Value::reals(e)])
        },
    },
    Function {
        name: "getGroupJoints",
        tip: "int[] jointHandles=simIK.getGroupJoints(int environmentHandle,int groupHandle)",
        run: |d, a| Ok(vec![Value::handles(d.group_joints(a.int(0)?, a.int(1)?)?)]),
    },
    Function {
        name: "getJacobian",
        tip: "float[] jacobian,int[2] columnsAndRows=simIK.getJacobian(int environmentHandle,int groupHandle)",
        run: |d, a| {
            let (rows, _) = d.group_jacobian(a.int(0)?, a.int(1)?)?;
            let size = [rows.first().map_or(0, Vec::len), rows.len()].map(|n| Value::Int(n as i64));
            Ok(vec![Value::reals(rows.into_iter().flatten()), Value::List(size.to_vec())])
        },
    },
    Function {
        name: "getManipulability",
        tip: "float manipulability=simIK.getManipulability(int environmentHandle,int groupHandle)",
        run: |d, a| one(d.manipulability(a.int(0)?, a.int(1)?)?),
    },
    Function {
        name: "findConfig",
        tip: "float[] jointPositions=simIK.findConfig(int environmentHandle,int groupHandle,int[] jointHandles,float thresholdDist=0.1,float maxTime=0.5,float[4] metric={1,1,1,0.1})",
        run: find_config,
    },
    Function {
        name: "getConfigForTipPose",
        tip: "float[] jointPositions=simIK.getConfigForTipPose(int environmentHandle,int groupHandle,int[] jointHandles,float thresholdDist=0.1,int maxIterations=1000,float[4] metric={1,1,1,0.1})",
        run: config_for_tip_pose,
    },
    Function {
        name: "findConfigs",
        tip: "float[][] configs=simIK.findConfigs(int environmentHandle,int groupHandle,int[] jointHandles,map params={})",
        run: find_configs,
    },
    Function {
        name: "generatePath",
        tip: "float[] path=simIK.generatePath(int environmentHandle,int groupHandle,int[] jointHandles,int tipHandle,int pathPointCount)",
        run: path,
    },
];

/// Configurations that one search gives at most.
const MAX_CONFIGURATIONS: usize = 100;

/// Moves the joints of the scene as a group is solved.
fn apply(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let outcome = sim.handle_group(a.int(0)?, a.int(1)?, (true, !a.bool_or(2, false)?))?;
    Ok(results(outcome).into_iter().take(2).collect())
}

fn get_calculation(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let group = sim.group(a.int(0)?, a.int(1)?)?;
    let method = i64::from(group.damping > 0.0);
    Ok(vec![Value::Int(method), Value::Real(group.damping), Value::Int(group.iterations as i64)])
}

/// Bit 1 enabled, bit 2 steps without limit; 4 and 8, nothing is applied that is not reached, are so unless an error is
/// allowed.
fn group_flags(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let flags = a.int(2)?;
    if flags & !15 != 0 {
        return Err(ApiError(format!(
            "flags {flags}: enabled 1, no limit of steps 2, 4 and 8 are known; joints stop at their limits"
        )));
    }
    let group = sim.group(a.int(0)?, a.int(1)?)?;
    (group.is_enabled, group.has_free_steps) = (flags & 1 != 0, flags & 2 != 0);
    done()
}

/// An object, or none for −1.
fn optional(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Option<Handle>, ApiError> {
    match a.int_or(k, -1)? {
        -1 => Ok(None),
        _ => object(sim, a, k).map(Some),
    }
}

fn set_base(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (base, axes_of) = (optional(sim, a, 3)?, optional(sim, a, 4)?);
    let changed = Element { base, axes_of, ..sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.clone() };
    sim.check_element(&changed)?;
    *sim.element(a.int(0)?, a.int(1)?, a.int(2)?)? = changed;
    done()
}

fn set_constraints(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let changed = Element { constraints: a.int(3)?, ..sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.clone() };
    sim.check_element(&changed)?;
    *sim.element(a.int(0)?, a.int(1)?, a.int(2)?)? = changed;
    done()
}

/// An object of the scene, or of an environment's own.
fn object(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Handle, ApiError> {
    let raw = a.handle(k)?;
    match sim.own_object(Handle(raw)) {
        Some(_) => Ok(Handle(raw)),
        None => plain(sim, raw),
    }
}

/// An object of the environment's own.
fn own(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Handle, ApiError> {
    let object = object(sim, a, k)?;
    if sim.own_object(object).is_none() {
        let path = &sim.registry.entry(object)?.path;
        let help =
            "simIK.createDummy and simIK.createJoint make such; simIK.addElementFromScene takes those of the scene";
        return Err(ApiError(format!("`{path}` is of the scene, not of the environment alone: {help}")));
    }
    Ok(object)
}

fn create_own(sim: &mut SimApi<'_>, a: Arguments<'_>, name: &str, joint: Option<i64>) -> Outcome {
    let name = if !name.is_empty() {
        name
    } else if joint.is_some() {
        "Joint"
    } else {
        "Dummy"
    };
    let wrong = || {
        let types = "types are revolute 10 and prismatic 11";
        ApiError(format!("no more than {IN_ONE} dummies and joints in an environment, and {types}"))
    };
    one(i64::from(sim.environment(a.int(0)?)?.own.create(name, joint).ok_or_else(wrong)?))
}

/// Links a tip to its target, also for the elements that there are.
fn set_target(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (tip, target) = (own(sim, a, 1)?, optional(sim, a, 2)?);
    let linked = sim.own_object_mut(tip).map(|own| own.target = target.map(|target| target.0));
    linked.ok_or_else(|| ApiError::new("the tip is gone"))?;
    if let Some(target) = target {
        sim.environment(a.int(0)?)?.set_targets(tip, target);
    }
    done()
}

/// The base is the world, and the constraints are those of a pose, until they are set.
fn add_own(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let tip = own(sim, a, 2)?;
    let target = sim.own_object(tip).and_then(|own| own.target).map(Handle);
    let target =
        target.ok_or_else(|| ApiError::new("the tip has no target: link it with simIK.setTargetDummy before"))?;
    one(sim.add_element(a.int(0)?, a.int(1)?, Element::new(None, tip, target, ALL))? as i64)
}

fn set_joint_interval(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let joint = own(sim, a, 1)?;
    let interval = match a.bool_or(2, false)? {
        true => None,
        false => Some(a.reals::<2>(3)?),
    };
    if interval.is_some_and(|[low, range]| !(low.is_finite() && range >= 0.0)) {
        return Err(ApiError(format!(
            "interval {interval:?}, expected the smallest position and a range of 0 or more"
        )));
    }
    let own = sim.own_object_mut(joint).and_then(|own| own.joint.as_mut());
    own.ok_or_else(|| ApiError::new("a dummy has no interval"))?.interval = interval;
    done()
}

/// Pose of an object of the environment's own, relative to another (−1: the world, −11: its parent).
fn relative_to(sim: &mut SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Pose<f64>, ApiError> {
    match a.int_or(k, -1)? {
        -1 => Ok(Pose::identity()),
        -11 => match sim.own_object(Handle(a.handle(1)?)).and_then(|own| own.parent) {
            Some(parent) => sim.ik_pose(Handle(parent)),
            None => Ok(Pose::identity()),
        },
        _ => {
            let other = object(sim, a, k)?;
            sim.ik_pose(other)
        }
    }
}

/// The functions of the scene for an object of the environment's own.
fn of_own(sim: &mut SimApi<'_>, object: Handle, a: Arguments<'_>, name: &str) -> Outcome {
    // (value, against) since 4.6, (against, value) before
    let (value, against) = if matches!(a.get(2), Value::List(_)) { (2, 3) } else { (3, 2) };
    let joint = sim.own_object(object).and_then(|own| own.joint);
    let joint = || joint.ok_or_else(|| ApiError::new("a dummy is no joint"));
    match name {
        "getObjectPose" | "getObjectMatrix" => {
            let pose = relative_to(sim, a, 2)?.inverse().compose(&sim.ik_pose(object)?);
            let is_matrix = name == "getObjectMatrix";
            if is_matrix { super::list(matrix_of(&pose)) } else { super::list(numbers_of_pose(&pose)) }
        }
        "setObjectPose" | "setObjectMatrix" => {
            let pose = match name {
                "setObjectMatrix" => Some(pose_of_matrix(&a.reals::<12>(value)?)),
                _ => pose_of_numbers(a.reals::<7>(value)?),
            };
            let is_finite = |pose: &Pose<f64>| pose.pos.0.iter().all(|x| x.is_finite());
            let pose = pose.filter(is_finite).ok_or_else(|| ApiError::new("the pose is none"))?;
            let place = relative_to(sim, a, against)?.compose(&pose);
            sim.place_own(object, &place)?;
            done()
        }
        "setObjectParent" => {
            let parent = optional(sim, a, 2)?;
            sim.hang_own(object, parent, a.bool_or(3, true)?)?;
            done()
        }
        "getObjectParent" => one(sim.own_object(object).and_then(|own| own.parent).map_or(-1, i64::from)),
        "getJointInterval" => {
            let interval = joint()?.interval;
            Ok(vec![interval.is_none().into(), Value::reals(interval.unwrap_or_default())])
        }
        _ => one(if joint()?.is_sliding { PRISMATIC } else { REVOLUTE }),
    }
}

/// A function of the scene, of an object whose environment it shares.
fn inside(sim: &mut SimApi<'_>, a: Arguments<'_>, name: &str) -> Outcome {
    sim.environment(a.int(0)?)?;
    let given = object(sim, a, 1)?;
    if sim.own_object(given).is_some() {
        return of_own(sim, given, a, name);
    }
    let of_scene = function(name).expect("it is one of the scene's functions");
    (of_scene.run)(sim, Arguments(a.0.get(1..).unwrap_or_default()))
}

fn joint_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = object(sim, a, 1)?;
    if let Some(object) = sim.own_object(own) {
        return one(object.joint.ok_or_else(|| ApiError::new("a dummy has no position"))?.position);
    }
    let q = sim.joint_position(own)?;
    one(sim.environment(a.int(0)?)?.positions.get(&own).copied().unwrap_or(q))
}

fn set_joint_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (joint, q) = (object(sim, a, 1)?, a.real(2)?);
    match sim.own_object(joint) {
        Some(own) if own.joint.is_none() => return Err(ApiError::new("a dummy has no position")),
        Some(_) => {}
        None => drop(sim.joint_position(joint)?),
    }
    if !q.is_finite() {
        return Err(ApiError(format!("position {q} is not finite")));
    }
    sim.keep_position(a.int(0)?, joint, q)?;
    done()
}

fn set_joint_mode(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = object(sim, a, 1)?;
    if sim.own_object(own).is_none() && !matches!(sim.registry.entry(own)?.kind, Kind::Joint(Some(_))) {
        return Err(ApiError(format!("`{}` is no joint", sim.registry.entry(own)?.path)));
    }
    let passive = &mut sim.environment(a.int(0)?)?.passive;
    match a.int(2)? {
        0 => passive.insert(own),
        MODE_IK => passive.remove(&own),
        other => return Err(ApiError(format!("mode {other}: passive 0 and ik 2 are offered"))),
    };
    done()
}

/// Seconds stand for attempts; a threshold and a metric are not needed, since every attempt is solved to the end.
fn find_config(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let seconds = if a.has(4) { a.real(4)? } else { 0.5 };
    one_config(sim, a, seconds)
}

/// As `findConfig`, whose older form it is: a thousand iterations stand for a second.
fn config_for_tip_pose(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let iterations = a.int_or(4, 1_000)?;
    one_config(sim, a, iterations.unsigned_abs() as f64 / 1_000.0)
}

fn one_config(sim: &mut SimApi<'_>, a: Arguments<'_>, seconds: f64) -> Outcome {
    if a.has(6) && a.get(6).as_text() != Some("") {
        return Err(ApiError::new("clients have no validation callbacks here: check what simIK.findConfigs gives"));
    }
    let found = sim.find_configurations((a.int(0)?, a.int(1)?), &handles(a, 2)?, 1, (seconds, 0))?;
    one(found.into_iter().next().map_or(Value::Nil, Value::reals))
}

/// Parameters: `maxTime`, `findMultiple`; others that have no meaning for this search are left out.
fn find_configs(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (mut seconds, mut n) = (0.3, 1);
    if let Value::Map(fields) = a.get(3) {
        for (name, value) in fields {
            let wrong = || ApiError(format!("parameter `{name}` is {}", value.word()));
            match name.as_str() {
                "maxTime" => seconds = value.as_real().filter(|x| x.is_finite()).ok_or_else(wrong)?,
                "findMultiple" => n = if value.as_bool().ok_or_else(wrong)? { MAX_CONFIGURATIONS } else { 1 },
                "maxDist" | "pMetric" | "cMetric" | "findAlt" => {}
                _ => return Err(ApiError(format!("there is no parameter `{name}`: maxTime, findMultiple"))),
            }
        }
    }
    let found = sim.find_configurations((a.int(0)?, a.int(1)?), &handles(a, 2)?, n, (seconds, 0))?;
    Ok(vec![Value::List(found.into_iter().map(Value::reals).collect())])
}

fn path(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if a.has(5) {
        return Err(ApiError::new("clients have no validation callbacks here: check the points of the path"));
    }
    let n = usize::try_from(a.int(4)?).unwrap_or(0);
    let tip = object(sim, a, 3)?;
    let path = sim.generate_path((a.int(0)?, a.int(1)?), &handles(a, 2)?, tip, n)?;
    one(path.map_or(Value::Nil, Value::reals))
}

fn create(sim: &mut SimApi<'_>, _: Arguments<'_>) -> Outcome {
    one(sim.create_environment()? as i64)
}

fn erase(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.erase_environment(a.int(0)?)?;
    done()
}

fn create_group(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    one(sim.create_group(a.int(0)?, if a.has(1) { a.text(1)? } else { "" })? as i64)
}

fn calculation(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let damping = match a.int(2)? {
        0 | 3 => 0.0,
        1 => a.real(3)?,
        other => {
            return Err(ApiError(format!("method {other}: pseudo-inverse 0 and damped least squares 1 are offered")));
        }
    };
    sim.set_calculation(a.int(0)?, a.int(1)?, damping, a.int(4)?)?;
    done()
}

/// Objects have the same handles in environments: the maps that CoppeliaSim returns besides lead each to itself.
fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let base = match a.handle(2)? {
        -1 => None,
        other => Some(plain(sim, other)?),
    };
    let (tip, target) = (super::handle(sim, a, 3)?, super::handle(sim, a, 4)?);
    let element = sim.add_element(a.int(0)?, a.int(1)?, Element::new(base, tip, target, a.int(5)?))?;
    let mut chain = base.map_or_else(|| Ok(vec![tip]), |base| sim.registry.entry(base).map(|_| vec![base, tip]))?;
    let mut at = sim.registry.parent_below(tip, base)?;
    while let Some(handle) = at.filter(|handle| Some(*handle) != base) {
        chain.push(handle);
        at = sim.registry.parent_below(handle, base)?;
    }
    chain.push(target);
    chain.sort_unstable();
    chain.dedup();
    let same = || Value::Numbered(chain.iter().map(|h| (h.0.into(), Value::from(*h))).collect());
    Ok(vec![Value::Int(element as i64), same(), same()])
}

fn two(a: Arguments<'_>, what: &str) -> Result<[f64; 2], ApiError> {
    let numbers = a.reals(3)?;
    if numbers.iter().all(|x| x.is_finite() && *x >= 0.0) {
        return Ok(numbers);
    }
    Err(ApiError(format!("{what} {numbers:?}, expected two numbers that are not negative")))
}

fn precision(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let precision = two(a, "precision")?;
    sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.precision = precision;
    done()
}

fn weights(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let weights = two(a, "weights")?;
    sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.weights = weights;
    done()
}

/// Options: `syncWorlds` puts the joints of the scene there, `allowError` also if not all is reached.
fn handle(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (mut apply, mut allow_error) = (false, false);
    match a.get(2) {
        Value::Map(options) => {
            for (name, value) in options {
                let flag = value.as_bool().ok_or_else(|| ApiError(format!("option `{name}` is no truth value")))?;
                match name.as_str() {
                    "syncWorlds" => apply = flag,
                    "allowError" => allow_error = flag,
                    _ => return Err(ApiError(format!("there is no option `{name}`: syncWorlds, allowError"))),
                }
            }
        }
        Value::Nil => {}
        Value::List(list) if list.is_empty() => {}
        other => return Err(ApiError(format!("argument 3 is {}, expected a map of options", other.word()))),
    }
    Ok(results(sim.handle_group(a.int(0)?, a.int(1)?, (apply, allow_error))?))
}

/// Result, flags and remaining errors, as `handleGroup` gives them.
fn results(outcome: Option<crate::api::ik::Outcome>) -> Vec<Value> {
    let Some(outcome) = outcome else { return vec![Value::Int(0), Value::Int(0), Value::reals([0.0; 2])] };
    let result = if outcome.is_reached { 1_i64 } else { 2 };
    let tolerance = if outcome.is_reached { 0 } else { NOT_WITHIN_TOLERANCE };
    let flags = tolerance | if outcome.hit_limit { LIMIT_HIT } else { 0 };
    vec![result.into(), flags.into(), Value::reals(outcome.errors)]
}

fn sync(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.sync_from_scene(a.int(0)?)?;
    done()
}
