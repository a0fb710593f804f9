//! Functions: drawings and particles, which the viewer shows.

use sincro_sim::runtime_object::{DrawingKind, DrawingStyle};

use super::{Function, Outcome, handle, one};
use crate::api::drawings::{DrawingRequest, ItemLayout};
use crate::api::{ApiError, Arguments, Handle, SimApi};

/// Part of a kind that names the figure.
const FIGURE: i64 = 31;
/// Part of a handle that is no flag.
const HANDLE: i64 = (1 << 22) - 1;
/// `sim.handle_all`.
const HANDLE_ALL: i64 = -2;
// `sim.drawing_…`
const ITEM_COLORS: i64 = 32;
const VERTEX_COLORS: i64 = 64;
const ITEM_SIZES: i64 = 128;
const CYCLIC: i64 = 4096;
const FACING_CAMERA: i64 = 131_072;
const ITEM_TRANSPARENCY: i64 = 524_288;
const PERSISTENT: i64 = 1_048_576;
const LOCAL: i64 = 8_388_608;
/// `sim.handleflag_addmultiple`.
const ADD_MULTIPLE: i64 = 1 << 24;
/// `sim.handleflag_setmultiple`.
const SET_MULTIPLE: i64 = 1 << 22;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "addDrawingObject",
        tip: "int drawingObjectHandle=sim.addDrawingObject(int objectType,float size,float duplicateTolerance,int parentObjectHandle,int maxItemCount,float[3] color=nil)",
        run: add,
    },
    Function {
        name: "addDrawingObjectItem",
        tip: "int result=sim.addDrawingObjectItem(int drawingObjectHandle,float[] itemData)",
        run: item,
    },
    Function {
        name: "removeDrawingObject",
        tip: "sim.removeDrawingObject(int drawingObjectHandle)",
        run: |d, a| remove(d, a, false),
    },
    Function {
        name: "addParticleObject",
        tip: "int particleObjectHandle=sim.addParticleObject(int objectType,float size,float density,any params,float lifeTime,int maxItemCount,float[3] color=nil)",
        run: add_particles,
    },
    Function {
        name: "addParticleObjectItem",
        tip: "sim.addParticleObjectItem(int objectHandle,float[] itemData)",
        run: item,
    },
    Function {
        name: "removeParticleObject",
        tip: "sim.removeParticleObject(int particleObjectHandle)",
        run: |d, a| remove(d, a, true),
    },
    Function {
        name: "addPointCloud",
        tip: "int pointCloudHandle=sim.addPointCloud(int pageMask,int layerMask,int objectHandle,int options,float pointSize,float[] pointCoordinates,float[] defaultColors=nil,float[] pointColors=nil,float[] pointNormals=nil)",
        run: add_points,
    },
];

/// Points in the world, which move with an object, in one colour (0 to 255): those of V-REP 3.
fn add_points(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let points = a.get(5).as_reals().filter(|list| list.len().is_multiple_of(3) && !list.is_empty());
    let points = points.ok_or_else(|| ApiError::new("argument 6 is no list of points, three numbers each"))?;
    let color = a
        .get(6)
        .as_reals()
        .filter(|list| list.len() >= 3)
        .map_or([255; 3], |list| [0, 1, 2].map(|k| list[k].clamp(0.0, 255.0).round() as u8));
    let style = DrawingStyle { kind: DrawingKind::Points, size: a.real(4)?, color, lifetime: 0.0, falls: false };
    let layout = ItemLayout { n_drawn: 3, n_given: 3, is_local: false };
    let (parent, capacity) = (parent(sim, a, 2)?, points.len() as i64 / 3);
    let (is_cyclic, tolerance, is_persistent) = (false, 0.0, false);
    let own =
        sim.add_drawing(DrawingRequest { style, layout, parent, capacity, is_cyclic, tolerance, is_persistent })?;
    sim.draw_items(own, &points, true, false)?;
    one(own)
}

fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let kind = a.int(0)?;
    let has = |flag: i64| kind & flag != 0;
    // positions of an item, and numbers of its direction: a normal, or a quaternion
    let (figure, n_points, n_direction) = match kind & FIGURE {
        0 => (DrawingKind::Points, 1, 0),
        1 => (DrawingKind::Lines, 2, 0),
        2 => (DrawingKind::Triangles, 3, 0),
        3..=6 => (DrawingKind::Balls, 1, if has(FACING_CAMERA) { 0 } else { 3 }),
        7 => (DrawingKind::Balls, 1, 0),
        8 => (DrawingKind::LineStrip, 1, 0),
        9..=12 => (DrawingKind::Balls, 1, 4),
        other => return Err(ApiError(format!("{other} is no figure of a drawing: use sim.drawing_points …"))),
    };
    let is_flat = matches!(figure, DrawingKind::Lines | DrawingKind::LineStrip | DrawingKind::Triangles);
    let has_vertex_colors = has(VERTEX_COLORS) && is_flat;
    let n_color = match (has_vertex_colors, has(ITEM_COLORS)) {
        (true, _) => 3 * n_points,
        (false, true) => 3,
        (false, false) => 0,
    };
    let n_size = usize::from(has(ITEM_SIZES) && figure != DrawingKind::Triangles);
    let n_transparency = usize::from(has(ITEM_TRANSPARENCY) && !has_vertex_colors);
    let n_drawn = 3 * n_points;
    let n_given = n_drawn + n_direction + n_color + n_size + n_transparency;
    let layout = ItemLayout { n_drawn, n_given, is_local: has(LOCAL) };
    let style = DrawingStyle { kind: figure, size: a.real(1)?, color: color(a, 5)?, lifetime: 0.0, falls: false };
    let tolerance = if n_points == 1 { a.real(2)? } else { 0.0 };
    let (parent, capacity) = (parent(sim, a, 3)?, a.int(4)?);
    let (is_cyclic, is_persistent) = (has(CYCLIC), has(PERSISTENT));
    one(sim.add_drawing(DrawingRequest { style, layout, parent, capacity, is_cyclic, tolerance, is_persistent })?)
}

fn add_particles(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let kind = a.int(0)?;
    let has = |flag: i64| kind & flag != 0;
    let more = usize::from(has(1024)) + usize::from(has(2048)) + 3 * usize::from(has(4096));
    let layout = ItemLayout { n_drawn: 6, n_given: 6 + more, is_local: false };
    let lifetime = a.real(4)?;
    let style = DrawingStyle {
        kind: DrawingKind::Particles,
        size: if has(512) { 0.0 } else { a.real(1)? },
        color: color(a, 6)?,
        // 0 is no end
        lifetime: if lifetime == 0.0 { f64::MAX } else { lifetime },
        falls: !has(256),
    };
    let capacity = a.int(5)?;
    let (parent, tolerance, is_cyclic, is_persistent) = (None, 0.0, has(8192), false);
    one(sim.add_drawing(DrawingRequest { style, layout, parent, capacity, is_cyclic, tolerance, is_persistent })?)
}

/// An item, or several with a flag in the handle; none removes all, which gives 0.
fn item(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let given = a.int(0)?;
    let (own, replaces) = (own_handle(given)?, given & SET_MULTIPLE != 0);
    let numbers = match a.has(1) {
        false => Vec::new(),
        true => a.get(1).as_reals().ok_or_else(|| ApiError::new("argument 2 is no list of numbers"))?,
    };
    if numbers.is_empty() {
        sim.clear_drawing(own)?;
        return one(0_i64);
    }
    one(i64::from(sim.draw_items(own, &numbers, replaces || given & ADD_MULTIPLE != 0, replaces)?))
}

/// A drawing, or all of them by `sim.handle_all`.
/// As in V-REP, particles that are not there give −1, a drawing that is not there is an error: scripts keep −1 for
/// particles that they have not made, and remove it.
fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>, particles: bool) -> Outcome {
    let given = a.int(0)?;
    if particles && given != HANDLE_ALL && !sim.has_drawing(given & HANDLE) {
        return one(-1_i64);
    }
    let handle = if given == HANDLE_ALL { None } else { Some(own_handle(given)?) };
    sim.remove_drawing(handle, particles)?;
    one(1_i64)
}

/// A handle without its flags.
fn own_handle(given: i64) -> Result<i64, ApiError> {
    if given < 1 {
        return Err(ApiError(format!("there is no drawing {given}")));
    }
    Ok(given & HANDLE)
}

/// The object that a drawing hangs on; −1 is the world.
fn parent(sim: &mut SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Option<Handle>, ApiError> {
    if a.int_or(k, -1)? == -1 { Ok(None) } else { handle(sim, a, k).map(Some) }
}

/// Red, green, blue from 0 to 1; V-REP gives up to twelve numbers, of which the first three are the colour. Yellow
/// unless given.
fn color(a: Arguments<'_>, k: usize) -> Result<[u8; 3], ApiError> {
    if !a.has(k) {
        return Ok([255, 255, 0]);
    }
    let given = a.get(k).as_reals().filter(|list| list.len() >= 3 && list.iter().all(|x| x.is_finite()));
    let given = given.ok_or_else(|| ApiError(format!("argument {} is no colour of three numbers", k + 1)))?;
    Ok([0, 1, 2].map(|i| (given[i].clamp(0.0, 1.0) * 255.0).round() as u8))
}
