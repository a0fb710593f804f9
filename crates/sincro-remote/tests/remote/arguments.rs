//! Arguments right and wrong for every name that a client may call, over every protocol.

use sincro_coppelia::api::Value;

use sincro_testing::clients::zmq::map;

/// Functions that start and stop runs, and those on the selection; other tests call them, because here one run
/// continues with its objects.
pub const ELSEWHERE: [&str; 8] = [
    "startSimulation",
    "stopSimulation",
    "closeScene",
    "loadScene",
    "pauseSimulation",
    "copyPasteSelectedObjects",
    "deleteSelectedObjects",
    "scaleSelectedObjects",
];

/// Functions that need what is not here: a script and the grant to change it, sensors, bodies that touch, stops,
/// couplings, groups, a motion, mesh files, the grant to write files.
pub const NEEDS_MORE: [&str; 37] = [
    "setSphericalJointMatrix",
    "getEngineFloatParameter",
    "setEngineFloatParameter",
    "addScript",
    "createScript",
    "setScriptText",
    "associateScriptWithObject",
    "initScript",
    "removeScript",
    "setJointDependency",
    "getContactInfo",
    "readForceSensor",
    "breakForceSensor",
    "launchExecutable",
    "getIkGroupHandle",
    "handleIkGroup",
    "checkIkGroup",
    "getConfigForTipPose",
    "generateIkPath",
    "setIkGroupProperties",
    "setIkElementProperties",
    "moveToConfig_step",
    "moveToConfig_cleanup",
    "moveToPose_step",
    "moveToPose_cleanup",
    "importShape",
    "importMesh",
    "loadModel",
    "saveScene",
    "exportMesh",
    "callScriptFunction",
    "executeScriptString",
    "moveToConfig",
    "moveToPose",
    "rmlMoveToJointPositions",
    "rmlMoveToPosition",
    "moveToPosition",
];

/// Objects to call functions with.
pub struct Things {
    pub joint: Value,
    pub body: Value,
    pub eye: Value,
    pub made: Made,
}

/// Objects that are created for each name, because some functions remove them.
pub struct Made {
    point: Value,
    shapes: [Value; 2],
    sensor: Value,
    collection: Value,
    drawing: Value,
    motion: Value,
    path: Value,
    octree: Value,
    cloud: Value,
}

impl Made {
    /// By a function that calls functions by name.
    pub fn new(mut make: impl FnMut(&str, &[Value]) -> Value) -> Self {
        let point = make("sim.createDummy", &[Value::Real(0.01)]);
        let box_ = [Value::Int(3), Value::reals([0.1, 0.2, 0.3])];
        let shapes = [(); 2].map(|()| make("sim.createPrimitiveShape", &box_));
        let sensor = make("sim.createProximitySensor", &sensor_arguments());
        let collection = make("sim.createCollection", &[Value::Int(0)]);
        let drawing = make("sim.addDrawingObject", &drawing_arguments());
        let (motion, path) = (make("sim.ruckigPos", &motion_arguments()), make("sim.createPath", &path_arguments()));
        let octree = make("sim.createOctree", &[Value::Real(0.1)]);
        let cloud = make("sim.createPointCloud", &[Value::Real(0.02), Value::Int(20)]);
        Self { point, shapes, sensor, collection, drawing, motion, path, octree, cloud }
    }
}

impl Made {
    /// Objects to be removed once a name was called: sensors and shapes that stay are looked at in every step.
    pub fn objects(&self) -> [Value; 6] {
        let [one, other] = &self.shapes;
        [&self.point, one, other, &self.sensor, &self.octree, &self.cloud].map(Value::clone)
    }

    /// The motion, to be removed, too: there may be 1,000.
    pub fn motion(&self) -> Value {
        self.motion.clone()
    }
}

/// A proximity sensor that is a ray of 1 m.
fn sensor_arguments() -> Vec<Value> {
    let numbers = Value::reals([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    vec![Value::Int(34), Value::Int(16), Value::Int(0), Value::List(vec![Value::Int(0); 8]), numbers]
}

/// Lines in the world.
fn drawing_arguments() -> Vec<Value> {
    vec![Value::Int(1), Value::Real(2.0), Value::Real(0.0), Value::Int(-1), Value::Int(10)]
}

/// A path of two control points.
fn path_arguments() -> Vec<Value> {
    vec![Value::reals([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])]
}

/// A motion of one number.
fn motion_arguments() -> Vec<Value> {
    let three = || Value::reals([0.1, 0.2, 0.3]);
    let target = [Value::reals([1.0]), Value::reals([1.0, 0.0])];
    [Value::Int(1), Value::Real(1e-4), Value::Int(-1), three(), three()].into_iter().chain(target).collect()
}

/// Arguments that fit where none of the others do.
pub fn fitting(name: &str, things: &Things) -> Option<Vec<Value>> {
    let Things { joint, body, eye, made } = things;
    let Made { point, shapes: [shape, other], sensor, collection, drawing, motion, path, octree, cloud } = made;
    let three = || Value::reals([0.1, 0.2, 0.3]);
    let turn = || Value::reals([0.0, 0.0, 0.0, 1.0]);
    let pose = || Value::reals([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]);
    let matrix = || Value::reals([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let nine = || Value::reals([0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1]);
    let (int, text) = (Value::Int, || Value::from("tag"));
    Some(match name {
        "getObject" | "getObjectHandle" | "getGraphHandle" => vec![Value::from("/ball")],
        "getObjectChild" => vec![joint.clone(), int(0)],
        "readCustomDataBlock" => vec![joint.clone(), text()],
        "writeCustomDataBlock" => vec![joint.clone(), text(), Value::Bytes(vec![1])],
        "setStringSignal"
        | "setBufferSignal"
        | "setNamedStringParam"
        | "setStringNamedParam"
        | "persistentDataWrite" => {
            vec![text(), Value::Bytes(vec![1])]
        }
        "setModelProperty" | "setObjectProperty" => vec![body.clone(), int(0)],
        "setObjectSpecialProperty" => vec![body.clone(), int(0x3f3)],
        "getScriptSimulationParameter" => vec![joint.clone(), text()],
        "setScriptSimulationParameter" => vec![joint.clone(), text(), text()],
        "setObjectParent" => vec![point.clone(), int(-1), Value::Bool(true)],
        "checkDistance" | "checkCollision" => vec![body.clone(), int(-2)],
        "createPrimitiveShape" => vec![int(3), three()],
        "createPureShape" => vec![int(0), int(16), three(), Value::Real(1.0)],
        "createMeshShape" | "createShape" => {
            vec![
                int(0),
                Value::Real(0.0),
                Value::reals([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
                Value::List(vec![int(0), int(1), int(2)]),
            ]
        }
        "createHeightfieldShape" => {
            vec![int(0), Value::Real(0.0), int(2), int(2), Value::Real(1.0), Value::reals([0.0, 0.1, 0.0, 0.1])]
        }
        "addDrawingObject" => drawing_arguments(),
        "addParticleObject" => {
            vec![int(0), Value::Real(0.1), Value::Real(1.0), Value::Nil, Value::Real(1.0), int(10)]
        }
        "addDrawingObjectItem" | "addParticleObjectItem" => vec![drawing.clone(), Value::reals([0.1; 6])],
        "removeDrawingObject" | "removeParticleObject" => vec![drawing.clone()],
        "createProximitySensor" => sensor_arguments(),
        "checkProximitySensor" => vec![sensor.clone(), int(-2)],
        "checkProximitySensorEx" => vec![sensor.clone(), int(-2), int(1), Value::Real(0.0), Value::Real(0.0)],
        _ if name.ends_with("ProximitySensor") => vec![sensor.clone()],
        "addItemToCollection" => vec![collection.clone(), int(-8), body.clone(), int(0)],
        "addObjectToCollection" => vec![collection.clone(), body.clone(), int(-8), int(0)],
        "emptyCollection" | "removeCollection" | "destroyCollection" | "getCollectionObjects" => {
            vec![collection.clone()]
        }
        "setEngineFloatParam" => vec![int(6003), shape.clone(), Value::Real(0.5)],
        "getEngineFloatParam" => vec![int(6003), shape.clone()],
        "createOctree" => vec![Value::Real(0.1)],
        "createPointCloud" => vec![Value::Real(0.02), int(20)],
        "insertVoxelsIntoOctree" | "removeVoxelsFromOctree" | "checkOctreePointOccupancy" => {
            vec![octree.clone(), int(0), three()]
        }
        "getOctreeVoxels" => vec![octree.clone()],
        "insertObjectIntoOctree" | "subtractObjectFromOctree" => vec![octree.clone(), shape.clone(), Value::Int(0)],
        "insertObjectIntoPointCloud" | "subtractObjectFromPointCloud" => {
            vec![cloud.clone(), shape.clone(), Value::Int(0), Value::Real(0.05)]
        }
        "insertPointsIntoPointCloud" => vec![cloud.clone(), int(0), three()],
        "removePointsFromPointCloud" | "intersectPointsWithPointCloud" => {
            vec![cloud.clone(), int(0), three(), Value::Real(0.1)]
        }
        "getPointCloudPoints" => vec![cloud.clone()],
        "groupShapes" => vec![Value::List(vec![shape.clone(), other.clone()])],
        "ungroupShape" => vec![shape.clone()],
        "scaleObject" => vec![shape.clone(), Value::Real(2.0), Value::Real(2.0), Value::Real(2.0)],
        "scaleObjects" => vec![Value::List(vec![shape.clone()]), Value::Real(0.5), Value::Bool(true)],
        "setShapeColor" => vec![shape.clone(), Value::Nil, int(0), three()],
        "getShapeColor" => vec![shape.clone(), Value::Nil, int(0)],
        "getObjectColor" => vec![shape.clone(), int(0), int(0)],
        "getUserParameter" => vec![joint.clone(), text()],
        "setUserParameter" => vec![joint.clone(), text(), Value::Real(0.5)],
        "msgBox" => vec![int(0), int(0), text(), text()],
        "setObjectColor" => vec![shape.clone(), int(0), int(0), three()],
        "copyPasteObjects" | "removeObjects" => vec![Value::List(vec![point.clone()])],
        "removeObject" | "removeModel" => vec![point.clone()],
        "createJoint" => vec![int(10), int(5), int(0)],
        "createForceSensor" => vec![int(0)],
        "saveModel" => vec![body.clone()],
        "setObjectQuaternion" => vec![body.clone(), int(-1), turn()],
        "setObjectPose" => vec![body.clone(), pose(), int(-1)],
        "setObjectMatrix" => vec![body.clone(), int(-1), matrix()],
        "buildMatrix" | "buildPose" => vec![three(), three()],
        "buildMatrixQ" => vec![three(), turn()],
        "rotateAroundAxis" => vec![matrix(), three(), three(), Value::Real(0.1)],
        "setJointInterval" | "setJointDependency" => return None,
        "setShapeMass" => vec![body.clone(), Value::Real(2.0)],
        "computeMassAndInertia" => vec![body.clone(), Value::Real(1000.0)],
        "setShapeInertia" => vec![body.clone(), nine(), matrix()],
        "setShapeMassAndInertia" => vec![body.clone(), Value::Real(2.0), nine(), three()],
        "addGraphStream" => vec![body.clone(), text(), text()],
        "setGraphStreamValue" => vec![body.clone(), int(1), Value::Real(0.5)],
        "setGraphStreamTransformation" => vec![body.clone(), int(1), int(0), Value::Real(2.0)],
        "setGraphUserData" => vec![body.clone(), text(), Value::Real(0.5)],
        "addGraphCurve" => vec![body.clone(), text()],
        "resetGraph" | "handleGraph" => vec![body.clone(), Value::Real(0.0)],
        "setArrayParam" | "setArrayParameter" => vec![int(0), Value::reals([0.0, 0.0, -9.81])],
        "setObjectAlias" | "setObjectName" => vec![point.clone(), text()],
        "setObjectChildPose" => vec![body.clone(), pose()],
        "setJointMode" => vec![joint.clone(), int(5), int(0)],
        "addForceAndTorque" | "addForce" => vec![body.clone(), three(), three()],
        "getShapeMassAndInertia" => vec![body.clone(), matrix()],
        "getPathInterpolatedConfig" => vec![Value::reals([0.0, 1.0]), Value::reals([0.0, 1.0]), Value::Real(0.5)],
        "createPath" => path_arguments(),
        "resamplePath" => vec![Value::reals([0.0, 1.0]), Value::reals([0.0, 1.0]), int(5)],
        "getClosestPosOnPath" => vec![Value::reals([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]), Value::reals([0.0, 1.0]), three()],
        "insertPathCtrlPoints" => vec![path.clone(), int(0), int(0), int(1), Value::reals([0.5; 6])],
        "cutPathCtrlPoints" => vec![path.clone(), int(-1), int(0)],
        "getClosestPositionOnPath" => vec![path.clone(), three()],
        "getPathLength" | "getPathPosition" => vec![path.clone()],
        "setPathPosition" | "getPositionOnPath" | "getOrientationOnPath" => vec![path.clone(), Value::Real(0.5)],
        "sendData" => vec![int(-2), int(0), text(), Value::Bytes(vec![1])],
        "setObjectSel" | "setObjectSelection" => vec![Value::List(vec![body.clone()])],
        "addObjectToSelection" | "removeObjectFromSelection" => vec![int(-8), body.clone()],
        "unpackTable" => vec![Value::Bytes(vec![0xf6])],
        _ if name.starts_with("unpack") => vec![Value::Bytes(vec![1; 8])],
        "createVisionSensor" => {
            let lens = [0.01, 10.0, 1.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            vec![int(2), Value::reals([2.0, 2.0, 0.0, 0.0]), Value::reals(lens)]
        }
        "transformImage" => vec![Value::Bytes(vec![1; 12]), Value::reals([2.0, 2.0]), int(6)],
        "getScaledImage" => {
            vec![Value::Bytes(vec![1; 12]), Value::reals([2.0, 2.0]), Value::reals([3.0, 5.0]), int(0)]
        }
        "saveImage" => {
            vec![Value::Bytes(vec![1; 12]), Value::reals([2.0, 2.0]), int(0), Value::from(".png"), int(-1)]
        }
        "transformBuffer" => vec![Value::Bytes(vec![1; 12]), int(0), Value::Real(2.0), Value::Real(0.5), int(6)],
        _ if name.starts_with("setVisionSensor") => vec![eye.clone(), Value::Bytes(vec![9; 3 * 16 * 12])],
        _ if name.starts_with("checkVisionSensor") => vec![eye.clone(), body.clone(), Value::Bool(false)],
        _ if name.contains("VisionSensor") => vec![eye.clone()],
        "getExplicitHandling" | "setExplicitHandling" => vec![eye.clone(), int(0)],
        "getShapeBB" | "getShapeMesh" => vec![shape.clone()],
        "getShapeViz" => vec![shape.clone(), int(0)],
        "setLinkDummy" => vec![point.clone(), int(-1)],
        "getLinkDummy" => vec![point.clone()],
        "setPathTargetNominalVelocity" => vec![path.clone(), Value::Real(0.0)],
        "getUIHandle" => vec![text()],
        "createUIButton" => vec![int(500_000), Value::reals([0.0, 0.0]), Value::reals([1.0, 1.0]), int(5)],
        "handleMill" | "resetMill" | "resetMilling" => vec![int(-2)],
        "addPointCloud" => vec![int(0), int(255), int(-1), int(0), Value::Real(5.0), three()],
        // number 1 is that texture
        "createTexture" => vec![Value::from(""), int(0)],
        "readTexture" => vec![int(1)],
        "writeTexture" => {
            vec![int(1), int(0), Value::Bytes(vec![7; 3]), int(0), int(0), int(1), int(1)]
        }
        "loadImage" => vec![int(0), Value::Bytes(bitmap())],
        "getQHull" => vec![Value::reals([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])],
        "reorientShapeBoundingBox" => vec![shape.clone(), int(-1)],
        "alignShapeBB" | "relocateShapeFrame" => vec![shape.clone(), pose()],
        "addObjectCustomData" => vec![joint.clone(), int(5), Value::Bytes(vec![1])],
        "getObjectCustomData" => vec![joint.clone(), int(5)],
        "setUIButtonLabel" => vec![int(500_000), int(1), text()],
        _ if name.contains("UI") => vec![int(500_000), int(1), int(2)],
        "createCollisionObject" | "createDistanceObject" => vec![text(), body.clone(), int(-2)],
        // those that were made under the names before
        "getCollisionHandle" | "getDistanceHandle" => vec![text()],
        "handleCollision" | "readCollision" | "resetCollision" => vec![int(2_000_000)],
        "handleDistance" | "readDistance" | "resetDistance" => vec![int(2_000_001)],
        "boolOr32" | "boolAnd32" | "boolXor32" | "boolOr16" | "boolAnd16" | "boolXor16" => vec![int(6), int(-1)],
        "tubeOpen" => vec![int(0), text(), int(2)],
        "tubeWrite" => vec![int(0), text()],
        "tubeRead" | "tubeStatus" | "tubeClose" => vec![int(0)],
        "setJointForce" | "setJointMaxForce" => vec![joint.clone(), Value::Real(5.0)],
        _ if name.starts_with("readCustom") => vec![joint.clone(), text()],
        "writeCustomTableData" => vec![joint.clone(), text(), map(&[("a", int(1))])],
        _ if name.starts_with("writeCustom") => vec![joint.clone(), text(), Value::Bytes(vec![1])],
        "removeProperty" => vec![joint.clone(), Value::from("customData.tag")],
        "getPropertyName" => vec![joint.clone(), int(0)],
        _ if name.starts_with("get")
            && name.ends_with("Property")
            && !name.contains("Object")
            && !name.contains("Model") =>
        {
            vec![joint.clone(), Value::from("customData.none"), map(&[("noError", Value::Bool(true))])]
        }
        _ if name.starts_with("set") && name.ends_with("Property") && !name.contains("Object") => {
            let value = match name {
                "setBoolProperty" => Value::Bool(true),
                "setStringProperty" => text(),
                "setBufferProperty" => Value::Bytes(vec![1]),
                "setTableProperty" => map(&[("a", int(1))]),
                "setVector2Property" => Value::reals([1.0, 2.0]),
                "setVector3Property" => three(),
                "setQuaternionProperty" => turn(),
                "setPoseProperty" => pose(),
                "setFloatArrayProperty" => three(),
                "setIntArrayProperty" => Value::List(vec![int(1)]),
                _ => int(1),
            };
            vec![joint.clone(), Value::from("customData.tag"), value]
        }
        "wait" => vec![Value::Real(0.05)],
        "moveToConfig_init" => vec![map(&[("pos", Value::reals([0.0])), ("targetPos", Value::reals([1.0]))])],
        "moveToPose_init" => vec![map(&[("pose", pose()), ("targetPose", pose())])],
        "ruckigPos" | "rmlPos" | "rMLPos" => motion_arguments(),
        "ruckigStep" | "rmlStep" | "rMLStep" => vec![motion.clone(), Value::Real(0.05)],
        "ruckigRemove" | "rmlRemove" | "rMLRemove" => vec![motion.clone()],
        "ruckigVel" | "rmlVel" | "rMLVel" => {
            vec![
                int(1),
                Value::Real(1e-4),
                int(-1),
                three(),
                Value::reals([1.0, 2.0]),
                Value::reals([1.0]),
                Value::reals([0.5]),
            ]
        }
        "testCB" => vec![int(1), Value::from("cb@func"), int(2), int(0)],
        _ if name.starts_with("getObjectInt") => vec![joint.clone(), int(2000)],
        _ if name.starts_with("setObjectInt") => vec![joint.clone(), int(2000), int(1)],
        _ if name.starts_with("getObjectFloat") => vec![joint.clone(), int(2012)],
        _ if name.starts_with("setObjectFloat") => vec![joint.clone(), int(2017), Value::Real(1.0)],
        _ => return None,
    })
}

/// A bitmap of one pixel.
fn bitmap() -> Vec<u8> {
    let mut file = b"BM".to_vec();
    for number in [58_u32, 0, 54, 40, 1, 1, 1 | 24 << 16, 0, 4, 0, 0, 0, 0, 0x0003_0201] {
        file.extend(number.to_le_bytes());
    }
    file
}

/// Functions that take the scene's own objects away from those that are called after them.
const STRUCTURAL: [&str; 4] = ["removeObject", "removeModel", "setObjectParent", "removeObjects"];

/// Arguments of many kinds for a function, without the scene's own objects where it would remove them.
pub fn arguments_for(name: &str, joint: &Value, body: &Value) -> Vec<Vec<Value>> {
    let mut all = arguments(joint, body);
    if STRUCTURAL.contains(&name) {
        // true is the handle 1 to a function that takes one, and the numbers of a matrix are handles in a list
        let matrix = &all[5][0].clone();
        let own = [joint, body, &Value::Bool(true), matrix];
        all.retain(|list| own.iter().all(|object| !list.contains(object)));
    }
    all
}

/// Arguments of many kinds; the first ones fit most functions.
pub fn arguments(joint: &Value, body: &Value) -> Vec<Vec<Value>> {
    let three = || Value::reals([0.1, 0.2, 0.3]);
    let matrix = || Value::reals([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    vec![
        vec![joint.clone()],
        vec![body.clone(), Value::Int(-1)],
        vec![joint.clone(), Value::Real(0.1)],
        vec![body.clone(), three(), three()],
        vec![body.clone(), three(), Value::Int(-1)],
        vec![matrix(), matrix(), Value::Real(0.5)],
        vec![Value::Int(450), Value::from("text")],
        vec![Value::from("name"), Value::Real(1.0)],
        vec![Value::from("name"), joint.clone()],
        vec![three(), Value::Int(3)],
        vec![Value::Int(0), Value::Int(0), Value::Int(0)],
        vec![],
        vec![Value::Nil; 3],
        vec![Value::Real(f64::NAN); 3],
        vec![Value::Int(i64::MIN), Value::Int(i64::MAX), Value::Int(-1)],
        vec![Value::Int(0x00ff_ffff), Value::Int(-5)],
        vec![Value::Bool(true), Value::List(vec![Value::List(vec![])]), Value::Map(vec![])],
        vec![Value::Bytes(vec![0xff; 3]), Value::from("\u{1f600}\0")],
        vec![Value::reals([f64::INFINITY; 7]), Value::reals([0.0; 12]), Value::Real(-0.0)],
        vec![Value::from("x".repeat(5000).as_str()); 2],
    ]
}
