//! What the commands of the legacy API do: sensors, collisions; and why those that are not here are not.

use sincro_sim::session::{Desk, Handle, Refusal};

use super::functions::{Call, Reply, counted, ints, reals};

/// Commands that are refused, and why. A client sees return code 8, and the text by `simxGetLastErrors`.
const REFUSED: &[(&[u16], &str)] = &[
    (&[0x1003, 0x1004, 0x1005, 0x1006, 0x1011, 0x1017], "there are no vision sensors here"),
    (&[0x1009], "there are no proximity sensors here: a sensor of kind `height` measures a distance downwards"),
    (&[0x100b], "a ball joint is moved by forces and by its initial state, not put somewhere"),
    (&[0x1010], "force sensors do not break here"),
    (&[0x1014, 0x1015, 0x1016, 0x3009], "there are no consoles here: use simxAddStatusbarMessage"),
    (&[0x1026, 0x300a], "there are no collision objects here: use simxCheckCollision with two bodies"),
    (
        &[0x1027, 0x300b, 0x2010],
        "distances between shapes are not computed here: simxCheckCollision tells what touches",
    ),
    (&[0x102b, 0x102c, 0x102d, 0x300c], "there is nobody to answer a dialog here"),
    (&[0x1029, 0x2001, 0x2002, 0x2003, 0x2004, 0x2005, 0x2006, 0x3005, 0x3007], "there are no user interfaces here"),
    (&[0x101e], "gravity belongs to the scene: change it there, or with --set when it is opened"),
    (&[0x1035], "objects have no model properties here"),
];

/// The answer of a command of this file; none for any other.
pub(super) fn run(desk: &mut Desk<'_>, call: &Call<'_>) -> Option<Reply> {
    match call.function {
        0x100f => Some(force_sensor(desk, call)),
        0x200f => Some(collision(desk, call)),
        0x102e => Some(copies(desk, call)),
        function => {
            let (_, why) = REFUSED.iter().find(|(functions, _)| functions.contains(&function))?;
            Some(Err(Refusal::new(*why)))
        }
    }
}

/// State (bit 0: there are data), force, torque; the numbers are not aligned.
fn force_sensor(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    let (force, torque) = desk.force_sensor(call.handle()?)?;
    let mut data = vec![1];
    data.extend(reals(force.into_iter().chain(torque))?);
    Ok(data)
}

/// Whether two bodies press on each other; −2 is any body.
fn collision(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    let bodies = [Handle(call.ident_int(0)?), Handle(call.ident_int(1)?)];
    for body in bodies.into_iter().filter(|body| body.0 != -2) {
        desk.can_touch(body)?;
    }
    let touches = desk.touches();
    let is_of = |touched: [Handle; 2], body: Handle| body.0 == -2 || touched.contains(&body);
    ints([i32::from(touches.iter().any(|t| bodies.into_iter().all(|body| is_of(t.bodies, body))))])
}

/// Copies of points that were made by clients or scripts.
fn copies(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    let handles = (0..call.data.len() / 4).map(|k| call.int(4 * k).map(Handle)).collect::<Result<Vec<_>, _>>()?;
    let copies = handles.into_iter().map(|handle| desk.copy(handle)).collect::<Result<Vec<_>, _>>()?;
    counted(&copies)
}
