//! Shapes of nodes, as in control textbooks.

use super::canvas::Canvas;
use super::graph::{Node, Shape};
use super::route::Outline;
use super::size::{Extent, HEADING, LABEL, NAME, SMALL, Side, note, short, shows_ports};

/// Draws a node.
pub(super) fn draw(canvas: &mut Canvas, node: &Node, outline: &Outline, extent: &Extent) {
    let (x, y) = (outline.x as f64, outline.y as f64);
    let (width, height) = (outline.width as f64, outline.height as f64);
    let (middle_x, middle_y) = (x + 0.5 * width, y + 0.5 * height);
    canvas.open(format!("{} {}", node.name, node.label).trim());
    match node.shape {
        Shape::Box => canvas.rect("sd-box", (x, y), (width, height), 5.0),
        Shape::Missing => canvas.rect("sd-missing", (x, y), (width, height), 5.0),
        Shape::Sum | Shape::Product => canvas.rect("sd-box", (x, y), (width, height), 0.5 * width),
        Shape::Gain => canvas.path("sd-box", &format!("M{x} {y}L{} {middle_y}L{x} {}z", x + width, y + height)),
        Shape::Bar => canvas.rect("sd-solid", (x, y), (width, height), 1.5),
        Shape::Scope => scope(canvas, (x, y), (width, height)),
        Shape::Saturation => saturation(canvas, (x, y), (width, height)),
        Shape::World => {
            canvas.rect("sd-world", (x, y), (width, height), 7.0);
            let line = y + HEADING as f64 - 4.0;
            canvas.path("sd-line", &format!("M{x} {line}h{width}"));
            canvas.words((middle_x, y + 13.0), "middle", LABEL, "", &node.label);
        }
        Shape::Inner => {
            canvas.rect("sd-box", (x, y), (width, height), 6.0);
            canvas.rect("sd-line", (x + 3.0, y + 3.0), (width - 6.0, height - 6.0), 4.0);
        }
        Shape::Terminal => canvas.rect("sd-port", (x, y), (width, height), 0.5 * height),
    }
    match node.shape {
        Shape::Sum => signs(canvas, node, outline, extent),
        Shape::Product => canvas.words((middle_x, middle_y), "middle", 17.0, "", "×"),
        Shape::Gain => canvas.words((x + 0.36 * width, middle_y), "middle", LABEL, "", &short(&node.label)),
        Shape::Box | Shape::Inner | Shape::Missing | Shape::Terminal => {
            let shift = 0.5 * (ports_width(node, false) - ports_width(node, true));
            canvas.words((middle_x + shift, middle_y), "middle", LABEL, "", &short(&node.label));
        }
        _ => {}
    }
    ports(canvas, node, outline, extent);
    name(canvas, node, outline, extent);
    canvas.close();
}

fn name(canvas: &mut Canvas, node: &Node, outline: &Outline, extent: &Extent) {
    let (x, y) = (outline.x as f64 + 0.5 * outline.width as f64, outline.y as f64);
    let words = short(&node.name);
    let has_wire_above = extent.inputs.iter().any(|(side, _)| *side == Side::Above);
    if extent.is_name_above && has_wire_above {
        canvas.words((x + 6.0, y - 7.0), "start", NAME, "sd-quiet", &words);
    } else if extent.is_name_above {
        canvas.words((x, y - 9.0), "middle", NAME, "sd-quiet", &words);
    } else {
        canvas.words((x, y + outline.height as f64 + 9.0), "middle", NAME, "sd-quiet", &words);
    }
}

/// Names of ports inside, components beside the beginning of their wire.
fn ports(canvas: &mut Canvas, node: &Node, outline: &Outline, extent: &Extent) {
    let (x, y) = (outline.x as f64, outline.y as f64);
    let right = x + outline.width as f64;
    let font = SMALL + 0.5;
    if shows_ports(node, false) {
        for (port, (_, at)) in node.inputs.iter().zip(&extent.inputs) {
            canvas.words((x + 6.0, y + *at as f64), "start", font, "sd-quiet", &short(&port.name));
        }
    }
    for (k, (port, at)) in node.outputs.iter().zip(&extent.outputs).enumerate() {
        if shows_ports(node, true) {
            canvas.words((right - 6.0, y + *at as f64), "end", font, "sd-quiet", &short(&port.name));
        }
        canvas.words((right + 3.0, y + *at as f64 - 7.0), "start", SMALL, "sd-quiet", &note(node, k));
    }
}

fn ports_width(node: &Node, of_outputs: bool) -> f64 {
    let ports = if of_outputs { &node.outputs } else { &node.inputs };
    let widths = ports.iter().map(|port| super::size::text(&short(&port.name), SMALL + 0.5));
    if shows_ports(node, of_outputs) { widths.max().unwrap_or(0) as f64 } else { 0.0 }
}

/// Signs of a sum, inside at its inputs.
fn signs(canvas: &mut Canvas, node: &Node, outline: &Outline, extent: &Extent) {
    let (x, y) = (outline.x as f64, outline.y as f64);
    let (middle, height) = (x + 0.5 * outline.width as f64, outline.height as f64);
    let signs = node.label.chars().chain(std::iter::repeat('+'));
    let is_lone = node.inputs.len() == 1;
    for (sign, (side, at)) in signs.zip(&extent.inputs) {
        let place = match side {
            Side::Left if is_lone => (middle, y + 0.5 * height),
            Side::Left => (x + 9.5, y + *at as f64),
            Side::Above => (middle, y + 9.0),
            Side::Below => (middle, y + height - 9.0),
        };
        let sign = if is_lone { 'Σ' } else { sign };
        canvas.words(place, "middle", 14.0, "", &sign.to_string());
    }
}

/// A screen with a curve.
fn scope(canvas: &mut Canvas, (x, y): (f64, f64), (width, height): (f64, f64)) {
    canvas.rect("sd-box", (x, y), (width, height), 5.0);
    let (left, top, w, h) = (x + 6.0, y + 6.0, width - 12.0, height - 12.0);
    canvas.rect("sd-line", (left, top), (w, h), 2.0);
    let (step, rise) = (0.25 * (w - 6.0), 0.6 * h);
    let start = (left + 3.0, top + 0.5 * h);
    canvas.path("sd-curve", &format!("M{} {}q{} {} {} 0t{} 0", start.0, start.1, step, -rise, 2.0 * step, 2.0 * step));
}

/// A line that ends in two level ones.
fn saturation(canvas: &mut Canvas, (x, y): (f64, f64), (width, height): (f64, f64)) {
    canvas.rect("sd-box", (x, y), (width, height), 5.0);
    let (mx, my) = (x + 0.5 * width, y + 0.5 * height);
    canvas.path("sd-line", &format!("M{} {my}h32M{mx} {}v28", mx - 16.0, my - 14.0));
    canvas.path("sd-curve", &format!("M{} {}h9L{} {}h9", mx - 16.0, my + 9.0, mx + 7.0, my - 9.0));
}
