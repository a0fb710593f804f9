//! Functions: shapes that are made at run time.

use sincro_dynamics::geometry::polyhedron::Triangles;
use sincro_dynamics::geometry::triangulation::{merged, normals};
use sincro_dynamics::spatial::{Pose, Vec3};

use super::objects::handles;
use super::{Function, Outcome, done, handle, one};
use crate::api::convention::{numbers_of_pose, pose_of_numbers};
use crate::api::shapes::primitive_of;
use crate::api::structure::Role;
use crate::api::{ApiError, Arguments, Handle, Reference, SimApi, Value};
use sincro_scene::scene::Triangles as MeshFile;
use sincro_values::mesh_files::Format;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "createPrimitiveShape",
        tip: "int shapeHandle=sim.createPrimitiveShape(int primitiveType,float[3] sizes,int options=0)",
        run: |d, a| primitive(d, a.int(0)?, a.reals(1)?),
    },
    Function {
        name: "createPureShape",
        tip: "int objectHandle=sim.createPureShape(int primitiveType,int options,float[3] sizes,float mass,int[2] precision={0,0})",
        run: pure,
    },
    Function {
        name: "createMeshShape",
        tip: "int shapeHandle=sim.createMeshShape(int options,float shadingAngle,float[] vertices,int[] indices)",
        run: mesh,
    },
    Function {
        name: "createShape",
        tip: "int shapeHandle=sim.createShape(int options,float shadingAngle,float[] vertices,int[] indices)",
        run: mesh,
    },
    Function {
        name: "createHeightfieldShape",
        tip: "int shapeHandle=sim.createHeightfieldShape(int options,float shadingAngle,int xPointCount,int yPointCount,float xSize,float[] heights)",
        run: heights,
    },
    Function {
        name: "importShape",
        tip: "int shapeHandle=sim.importShape(int fileformat,string pathAndFilename,int options,float identicalVerticeTolerance,float scalingFactor)",
        run: |d, a| import(d, a.text(1)?, a, 4),
    },
    Function {
        name: "importMesh",
        tip: "float[][] vertices,int[][] indices=sim.importMesh(int fileformat,string pathAndFilename,int options,float identicalVerticeTolerance,float scalingFactor)",
        run: read,
    },
    Function { name: "loadModel", tip: "int objectHandle=sim.loadModel(string filename)", run: model },
    Function { name: "saveModel", tip: "int result=sim.saveModel(int modelBaseHandle,string filename='')", run: save },
    Function {
        name: "getShapeGeomInfo",
        tip: "int result,int pureType,float[4] dimensions=sim.getShapeGeomInfo(int shapeHandle)",
        run: info,
    },
    Function {
        name: "getShapeBB",
        tip: "float[3] size,float[7] pose=sim.getShapeBB(int shapeHandle)",
        run: |d, a| {
            let [low, high] = d.shape_box(handle(d, a, 0)?)?;
            let middle = Vec3(std::array::from_fn(|k| 0.5 * (low[k] + high[k])));
            let size = Value::reals((0..3).map(|k| high[k] - low[k]));
            Ok(vec![size, Value::reals(numbers_of_pose(&Pose::translation(middle)))])
        },
    },
    Function {
        name: "getShapeMesh",
        tip: "float[] vertices,int[] indices,float[] normals=sim.getShapeMesh(int shapeHandle)",
        run: mesh_of,
    },
    Function { name: "getShapeViz", tip: "map data=sim.getShapeViz(int shapeHandle,int itemIndex)", run: appearance },
    Function {
        name: "groupShapes",
        tip: "int shapeHandle=sim.groupShapes(int[] shapeHandles,bool merge=false)",
        run: |d, a| {
            let shapes = handles(a, 0)?;
            one(d.group_shapes(&shapes)?)
        },
    },
    Function {
        name: "ungroupShape",
        tip: "int[] simpleShapeHandles=sim.ungroupShape(int shapeHandle)",
        run: |d, a| {
            let own = handle(d, a, 0)?;
            Ok(vec![Value::handles(d.ungroup_shape(own)?)])
        },
    },
    Function {
        name: "scaleObject",
        tip: "sim.scaleObject(int objectHandle,float xScale,float yScale,float zScale,int options=0)",
        run: scale,
    },
    Function {
        name: "scaleObjects",
        tip: "sim.scaleObjects(int[] objectHandles,float scalingFactor,bool scalePositionsToo)",
        run: scale_all,
    },
    Function {
        name: "setShapeColor",
        tip: "sim.setShapeColor(int shapeHandle,string colorName=nil,int colorComponent,float[3] rgbData)",
        run: |d, a| paint(d, a, (2, 3)),
    },
    Function {
        name: "getShapeColor",
        tip: "int result,float[3] rgbData=sim.getShapeColor(int shapeHandle,string colorName=nil,int colorComponent)",
        run: |d, a| color(d, a, 2),
    },
    Function {
        name: "getObjectColor",
        tip: "float[3] rgbData=sim.getObjectColor(int objectHandle,int index,int colorComponent)",
        run: |d, a| color(d, a, 2).map(|mut results| results.split_off(1)),
    },
    Function {
        name: "setObjectColor",
        tip: "int result=sim.setObjectColor(int objectHandle,int index,int colorComponent,float[3] rgbData)",
        run: |d, a| paint(d, a, (2, 3)),
    },
    Function {
        name: "getQHull",
        tip: "float[] verticesOut,int[] indicesOut=sim.getQHull(float[] verticesIn)",
        run: |sim, a| {
            let points = threes(a, 0)?;
            // points in a plane give nothing, as in V-REP
            let Some(mesh) = sim.hull(&points)? else { return done() };
            let [corners, indices, _] = lists(&(mesh.corners, mesh.triangles));
            Ok(vec![corners, indices])
        },
    },
    Function {
        name: "reorientShapeBoundingBox",
        tip: "int result=sim.reorientShapeBoundingBox(int shapeHandle,int relativeToHandle,int reservedSetToZero=0)",
        run: |sim, a| {
            let against = if a.int(1)? == -1 { Reference::World } else { Reference::Object(handle(sim, a, 1)?) };
            sim.reorient(handle(sim, a, 0)?, against)?;
            one(1_i64)
        },
    },
    Function {
        name: "alignShapeBB",
        tip: "int result=sim.alignShapeBB(int shapeHandle,float[7] pose)",
        run: |sim, a| {
            let (own, numbers) = (handle(sim, a, 0)?, a.reals::<7>(1)?);
            if numbers.iter().all(|x| *x == 0.0) {
                sim.reorient(own, Reference::Object(own))?;
                return one(1_i64);
            }
            let turned = pose_of_numbers(numbers).ok_or_else(|| ApiError::new("the quaternion of the pose is zero"))?;
            let x_wo = sim.pose(own, Reference::World)?;
            sim.reframe(own, &Pose { pos: x_wo.pos, rot: turned.rot })?;
            sim.reorient(own, Reference::Object(own))?;
            one(1_i64)
        },
    },
    Function {
        name: "relocateShapeFrame",
        tip: "int result=sim.relocateShapeFrame(int shapeHandle,float[7] pose)",
        run: |sim, a| {
            let (own, numbers) = (handle(sim, a, 0)?, a.reals::<7>(1)?);
            let x_wn = if numbers.iter().all(|x| *x == 0.0) {
                let [low, high] = sim.shape_box(own)?;
                let x_wo = sim.pose(own, Reference::World)?;
                Pose { pos: x_wo.point(Vec3([0, 1, 2].map(|k| 0.5 * (low[k] + high[k])))), rot: x_wo.rot }
            } else {
                pose_of_numbers(numbers).ok_or_else(|| ApiError::new("the quaternion of the pose is zero"))?
            };
            sim.reframe(own, &x_wn)?;
            one(1_i64)
        },
    },
    Function {
        name: "exportMesh",
        tip: "sim.exportMesh(int fileformat,string pathAndFilename,int options,float scalingFactor,float[] vertices,int[] indices)",
        run: export,
    },
];

fn primitive(sim: &mut SimApi<'_>, kind: i64, size: [f64; 3]) -> Outcome {
    let (name, surface, place) = primitive_of(kind, size)?;
    one(sim.create_shape(name, vec![(surface, place)])?)
}

/// Types 0 cuboid, 1 ball, 2 cylinder, 3 cone; option 16 static, 8 respondable.
fn pure(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (kind, options, mass) = (a.int(0)?, a.int(1)?, a.real(3)?);
    let (is_static, is_respondable) = (options & 16 != 0, options & 8 != 0);
    let has_mass = mass.is_finite() && mass > 0.0;
    if !(is_static || has_mass) {
        return Err(ApiError(format!("mass {mass} kg is not positive: a static shape, option 16, needs none")));
    }
    let kind = match kind {
        0..=3 => kind + 3,
        other => return Err(ApiError(format!("{other} is no pure shape: cuboid 0, sphere 1, cylinder 2, cone 3"))),
    };
    let (name, surface, place) = primitive_of(kind, a.reals(2)?)?;
    let own = sim.create_shape(name, vec![(surface, place)])?;
    if !is_static || is_respondable {
        let mass = has_mass.then_some(mass);
        if let Err(refused) = sim.give_role(own, Role { is_static, is_respondable, mass }) {
            sim.remove(own)?;
            return Err(refused);
        }
    }
    one(own)
}

/// Numbers of argument `k` by threes.
pub(super) fn threes(a: Arguments<'_>, k: usize) -> Result<Vec<[f64; 3]>, ApiError> {
    let wrong = || ApiError(format!("argument {} is no list of numbers, three by three", k + 1));
    let list = a.get(k).as_reals().filter(|list| list.len() % 3 == 0).ok_or_else(wrong)?;
    Ok(list.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect())
}

fn mesh(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (corners, triangles) = (threes(a, 2)?, triangles(a, 3)?);
    one(sim.create_mesh(&corners, &triangles)?)
}

/// Triangles of argument `k`.
fn triangles(a: Arguments<'_>, k: usize) -> Result<Vec<[u32; 3]>, ApiError> {
    let index = |x: f64| (x.fract() == 0.0 && (0.0..4e9).contains(&x)).then_some(x as u32);
    let triangle = |t: &[f64; 3]| Some([index(t[0])?, index(t[1])?, index(t[2])?]);
    let triangles = threes(a, k)?.iter().map(triangle).collect::<Option<Vec<_>>>();
    triangles.ok_or_else(|| ApiError(format!("argument {} has indices that are no whole numbers from 0 on", k + 1)))
}

fn heights(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let count = |k: usize| usize::try_from(a.int(k)?).map_err(|_| ApiError::new("the number of points is negative"));
    let (columns, rows, size) = (count(2)?, count(3)?, a.real(4)?);
    let heights = a.get(5).as_reals().ok_or_else(|| ApiError::new("argument 6 is no list of numbers"))?;
    one(sim.create_height_field(columns, rows, size, heights)?)
}

/// Meshes of lists of lists, or of one list each of corners and indices.
fn export(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (format, scale) = (Format::of(a.int(0)?)?, factor(a, 3)?);
    let inner = |k: usize| match a.get(k) {
        Value::List(list) if list.iter().all(|item| matches!(item, Value::List(_))) && !list.is_empty() => list.clone(),
        one => vec![one.clone()],
    };
    let (corners, indices) = (inner(4), inner(5));
    if corners.len() != indices.len() {
        let (n, m) = (corners.len(), indices.len());
        return Err(ApiError(format!("{n} lists of vertices, {m} of indices: expected as many")));
    }
    let mut meshes = Vec::new();
    for (corners, indices) in corners.into_iter().zip(indices) {
        let both = [corners, indices];
        let both = Arguments(&both);
        meshes.push(MeshFile { corners: threes(both, 0)?, triangles: triangles(both, 1)? });
    }
    sim.export_meshes(format, a.text(1)?, scale, &meshes)?;
    done()
}

/// The factor of argument `k`; 0 and nothing leave the file's own size.
fn factor(a: Arguments<'_>, k: usize) -> Result<f64, ApiError> {
    let factor = if a.has(k) { a.real(k)? } else { 1.0 };
    Ok(if factor == 0.0 { 1.0 } else { factor })
}

fn import(sim: &mut SimApi<'_>, name: &str, a: Arguments<'_>, scale: usize) -> Outcome {
    let MeshFile { corners, triangles } = sim.read_mesh(name, factor(a, scale)?)?;
    one(sim.create_mesh(&corners, &triangles)?)
}

/// One mesh, as lists of lists.
fn read(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let MeshFile { corners, triangles } = sim.read_mesh(a.text(1)?, factor(a, 4)?)?;
    let indices = triangles.into_iter().flatten().map(|k| Value::Int(k.into())).collect();
    let corners = Value::reals(corners.into_iter().flatten());
    Ok(vec![Value::List(vec![corners]), Value::List(vec![Value::List(indices)])])
}

/// A mesh of the scene's folder, the text of a model, or a scene file or folder.
fn model(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if let Value::Bytes(bytes) = a.get(0) {
        let text = std::str::from_utf8(bytes).map_err(|_| ApiError::new("the model is no text"))?;
        return one(sim.load_model_text(text)?);
    }
    let name = a.text(0)?;
    let lower = name.to_lowercase();
    if lower.ends_with(".stl") || lower.ends_with(".obj") {
        return import(sim, name, a, usize::MAX);
    }
    if name.contains('\n') {
        return one(sim.load_model_text(name)?);
    }
    one(sim.load_model(name)?)
}

/// The text of a scene file, to be loaded with `loadModel`; or, with a file name, a file of the folder for clients.
fn save(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let text = sim.model_text(own)?;
    let name = if a.has(1) { a.text(1)? } else { "" };
    if name.is_empty() {
        return Ok(vec![Value::Bytes(text.into_bytes())]);
    }
    if sim.own.is_some() && sim.is_running() {
        // kept with the run, whatever folder is meant
        let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
        sim.registry.keep_text(last, text.as_bytes(), false)?;
        return one(1_i64);
    }
    if sim.registry.sent_folder.is_none() {
        return Err(ApiError::new("a file needs a session with `--grant files`; without a name the text is returned"));
    }
    sim.registry.ask_to_save(name, text)?;
    one(1_i64)
}

/// Bit 0: of several parts; bit 1: pure.
fn info(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let info = sim.shape_info(handle(sim, a, 0)?)?;
    let flags = i64::from(info.is_compound) | i64::from(info.primitive != 0) << 1;
    let [x, y, z] = info.size;
    Ok(vec![Value::Int(flags), Value::Int(info.primitive), Value::reals([x, y, z, 0.0])])
}

/// Corners, triangles, and the normal of each triangle at each of its corners, all parts as one mesh.
fn mesh_of(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let parts = sim.meshes(handle(sim, a, 0)?)?;
    Ok(lists(&merged(parts.into_iter().map(|part| part.mesh))).to_vec())
}

/// Numbers of a mesh one after the other: corners, triangles, normals at each corner of each triangle.
fn lists(mesh: &Triangles) -> [Value; 3] {
    let indices = mesh.1.iter().flatten().map(|k| Value::Int((*k).into())).collect();
    let at_corners = normals(mesh).into_iter().flat_map(|n| [n, n, n]).flatten();
    [Value::reals(mesh.0.iter().copied().flatten()), Value::List(indices), Value::reals(at_corners)]
}

/// Mesh and colours (ambient and diffuse, specular, emission) of one part; nothing after the last one.
fn appearance(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let parts = sim.meshes(handle(sim, a, 0)?)?;
    let Some(part) = usize::try_from(a.int(1)?).ok().and_then(|k| parts.get(k)) else { return one(Value::Nil) };
    let [vertices, indices, normals] = lists(&part.mesh);
    let colors = Value::reals(part.color.into_iter().chain([0.0; 6]));
    let named = [("vertices", vertices), ("indices", indices), ("normals", normals), ("colors", colors)];
    let mut map: Vec<(String, Value)> = named.map(|(name, value)| (name.to_owned(), value)).into();
    map.push(("shadingAngle".to_owned(), Value::Real(0.0)));
    one(Value::Map(map))
}

fn scale(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.scale_shape(handle(sim, a, 0)?, [a.real(1)?, a.real(2)?, a.real(3)?])?;
    done()
}

fn scale_all(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (factor, too) = (a.real(1)?, a.bool_or(2, false)?);
    scale_each(sim, &handles(a, 0)?, (factor, too))?;
    done()
}

/// Scales shapes by a factor, with true their positions too: about the world's origin.
pub(super) fn scale_each(sim: &mut SimApi<'_>, shapes: &[Handle], (factor, too): (f64, bool)) -> Result<(), ApiError> {
    for own in shapes {
        sim.scale_shape(*own, [factor; 3])?;
        if too {
            let pose = sim.pose(*own, Reference::World)?;
            let moved = Pose { pos: pose.pos.scale(factor), ..pose };
            sim.set_pose(*own, &moved, Reference::World)?;
        }
    }
    Ok(())
}

/// Component of a colour: 0 ambient and diffuse, 1 diffuse, 2 specular, 3 emission, 4 transparency, 5 auxiliary.
fn component(a: Arguments<'_>, k: usize) -> Result<i64, ApiError> {
    let component = a.int_or(k, 0)?;
    if (0..=5).contains(&component) {
        return Ok(component);
    }
    Err(ApiError(format!("{component} is no component of a colour: expected 0 to 5")))
}

/// Colour of the first part, or what was set of another component than the ambient and diffuse one: black before.
fn color(sim: &mut SimApi<'_>, a: Arguments<'_>, k: usize) -> Outcome {
    let (own, component) = (handle(sim, a, 0)?, component(a, k)?);
    let rgb = sim.color(own)?;
    let set = || sim.registry.component_colors.get(&(own, component)).copied().unwrap_or_default();
    Ok(vec![Value::Int(1), Value::reals(if component == 0 { rgb } else { set() })])
}

/// The ambient and diffuse component is the colour; the others are kept.
fn paint(sim: &mut SimApi<'_>, a: Arguments<'_>, (k, color): (usize, usize)) -> Outcome {
    let own = handle(sim, a, 0)?;
    let component = component(a, k)?;
    let color = match a.get(color).as_reals().as_deref() {
        // a transparency is one number
        Some([x]) if component == 4 => [*x; 3],
        _ => a.reals(color)?,
    };
    if component == 0 {
        sim.paint(own, color)?;
    } else {
        sim.registry.component_colors.insert((own, component), color.map(|x: f64| x.clamp(0.0, 1.0)));
    }
    one(1_i64)
}
