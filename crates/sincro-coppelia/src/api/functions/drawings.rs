//! Functions: drawings and particles, which the viewer shows.

use sincro_sim::runtime_object::{DrawingKind, DrawingStyle};

use super::{Function, Outcome, handle, one};
use crate::api::drawings::{DrawingRequest, ItemLayout};
use crate::api::{ApiError, Arguments, Handle, SimApi};

/// Part of a kind that names the figure.
const FIGURE: i64 = 31;
/// Part of a handle that is no flag.
const HANDLE: i64 = (1 << 22) - 1;
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
    Function { name: "removeDrawingObject", tip: "sim.removeDrawingObject(int drawingObjectHandle)", run: remove },
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
    Function { name: "removeParticleObject", tip: "sim.removeParticleObject(int particleObjectHandle)", run: remove },
];

fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let kind = a.int(0)?;
    let has = |flag: i64| kind & flag != 0;
    let (itemcolors, vertexcolors, itemsizes, facing, itemtransparency) =
        (has(32), has(64), has(128), has(131_072), has(524_288));
    // figure, positions of an item, whether a normal belongs to it
    let (figure, n_points, has_normal) = match kind & FIGURE {
        0 => (DrawingKind::Points, 1, false),
        1 => (DrawingKind::Lines, 2, false),
        2 => (DrawingKind::Triangles, 3, false),
        7 => (DrawingKind::Balls, 1, false),
        8 => (DrawingKind::LineStrip, 1, false),
        3..=6 | 9..=12 => (DrawingKind::Balls, 1, !facing),
        other => return Err(ApiError(format!("{other} is no figure of a drawing: use sim.drawing_points …"))),
    };
    let colors = 3 * (usize::from(itemcolors) + n_points * usize::from(vertexcolors));
    let sizes = usize::from(itemsizes) + usize::from(itemtransparency);
    let n_drawn = 3 * n_points;
    let layout = ItemLayout {
        n_drawn,
        n_given: n_drawn + 3 * usize::from(has_normal) + colors + sizes,
        tolerance: a.real(2)?,
        is_local: has(8_388_608),
    };
    let style = DrawingStyle { kind: figure, size: a.real(1)?, color: color(a, 5)?, lifetime: 0.0, falls: false };
    let (parent, capacity) = (parent(sim, a, 3)?, a.int(4)?);
    let (is_cyclic, is_persistent) = (has(4096), has(1_048_576));
    one(sim.add_drawing(DrawingRequest { style, layout, parent, capacity, is_cyclic, is_persistent })?)
}

fn add_particles(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let kind = a.int(0)?;
    let has = |flag: i64| kind & flag != 0;
    let more = usize::from(has(1024)) + usize::from(has(2048)) + 3 * usize::from(has(4096));
    let layout = ItemLayout { n_drawn: 6, n_given: 6 + more, tolerance: 0.0, is_local: false };
    let lifetime = a.real(4)?;
    let style = DrawingStyle {
        kind: DrawingKind::Particles,
        size: if has(512) { 0.0 } else { a.real(1)? },
        color: color(a, 6)?,
        // 0 is no end
        lifetime: if lifetime > 0.0 { lifetime } else { f64::MAX },
        falls: !has(256),
    };
    let capacity = a.int(5)?;
    one(sim.add_drawing(DrawingRequest {
        style,
        layout,
        parent: None,
        capacity,
        is_cyclic: has(8192),
        is_persistent: false,
    })?)
}

/// An item, or several with a flag in the handle; none removes all.
fn item(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let given = a.int(0)?;
    let numbers = match a.has(1) {
        false => Vec::new(),
        true => a.get(1).as_reals().ok_or_else(|| ApiError::new("argument 2 is no list of numbers"))?,
    };
    let own = given & HANDLE;
    if given & SET_MULTIPLE != 0 {
        sim.draw_items(own, &[], true)?;
    }
    one(i64::from(sim.draw_items(own, &numbers, given & (ADD_MULTIPLE | SET_MULTIPLE) != 0)?))
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    // −2 is `sim.handle_all`
    let given = a.int(0)?;
    sim.remove_drawing((given != -2).then_some(given & HANDLE))?;
    one(1_i64)
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
