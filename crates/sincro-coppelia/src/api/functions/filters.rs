//! Functions: `simVision`, filters on the pictures of vision sensors.
//!
//! A filter works on the work image of a sensor, which has two buffers beside it. As in CoppeliaSim each gives first
//! whether it triggers the sensor (`binaryWorkImg` alone may), then what it has found, as packed floats.

use sincro_math::elementary::{atan2, sin_cos};
use sincro_values::work::MAX_OPERATIONS;
use sincro_vision::{ColorSpace, Moments, Sampling, WorkImage, gaussian};

pub(super) use sincro_conventions::absent::VISION as ABSENT;

use super::{Function, Outcome, handle};
use crate::api::filters::WorkImages;
use crate::api::{ApiError, Arguments, Handle, Reference, SimApi, Value, Vec3};

/// Added to a handle for points in the world instead of the frame of the sensor.
const IN_WORLD: i32 = 0x0080_0000;
/// Operations on a pixel of the search for blobs and the smallest rectangles about them.
const PER_BLOB_PIXEL: u64 = 64;
/// Operations on a point that is computed from a depth.
const PER_POINT: u64 = 64;
/// Points that one call may give.
const MAX_POINTS: i64 = 1 << 20;
/// Times that a kernel is applied in one call.
const MAX_PASSES: i64 = 100;
/// Operations on a pixel of filters without a kernel: the conversion of a colour.
const PER_PIXEL: u64 = 8;
/// Colours that a segmentation may find; fewer in large images, whose comparisons one call could not make.
const MAX_COLORS: usize = 1_024;

/// Functions of `simVision`, named without it.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "sensorImgToWorkImg",
        tip: "simVision.sensorImgToWorkImg(int visionSensorHandle)",
        run: |d, a| load(d, a, false),
    },
    Function {
        name: "sensorDepthMapToWorkImg",
        tip: "simVision.sensorDepthMapToWorkImg(int visionSensorHandle)",
        run: |d, a| load(d, a, true),
    },
    Function {
        name: "workImgToSensorImg",
        tip: "simVision.workImgToSensorImg(int visionSensorHandle,bool removeBuffer=true)",
        run: store,
    },
    Function { name: "releaseBuffers", tip: "simVision.releaseBuffers(int visionSensorHandle)", run: release },
    Function {
        name: "workImgToBuffer1",
        tip: "simVision.workImgToBuffer1(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.buffers[0] = Some(images.work.clone())),
    },
    Function {
        name: "workImgToBuffer2",
        tip: "simVision.workImgToBuffer2(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.buffers[1] = Some(images.work.clone())),
    },
    Function {
        name: "swapBuffers",
        tip: "simVision.swapBuffers(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.buffers.swap(0, 1)),
    },
    Function {
        name: "buffer1ToWorkImg",
        tip: "simVision.buffer1ToWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.work = images.buffer(0).clone()),
    },
    Function {
        name: "buffer2ToWorkImg",
        tip: "simVision.buffer2ToWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.work = images.buffer(1).clone()),
    },
    Function {
        name: "swapWorkImgWithBuffer1",
        tip: "simVision.swapWorkImgWithBuffer1(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, std::mem::swap)),
    },
    Function {
        name: "addWorkImgToBuffer1",
        tip: "simVision.addWorkImgToBuffer1(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, |work, buffer| buffer.add(work))),
    },
    Function {
        name: "subtractWorkImgFromBuffer1",
        tip: "simVision.subtractWorkImgFromBuffer1(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, |work, buffer| buffer.subtract(work))),
    },
    Function {
        name: "addBuffer1ToWorkImg",
        tip: "simVision.addBuffer1ToWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, |work, buffer| work.add(buffer))),
    },
    Function {
        name: "subtractBuffer1FromWorkImg",
        tip: "simVision.subtractBuffer1FromWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, |work, buffer| work.subtract(buffer))),
    },
    Function {
        name: "multiplyWorkImgWithBuffer1",
        tip: "simVision.multiplyWorkImgWithBuffer1(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| with_buffer(images, |work, buffer| work.multiply(buffer))),
    },
    Function {
        name: "horizontalFlipWorkImg",
        tip: "simVision.horizontalFlipWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.work.flip_horizontally()),
    },
    Function {
        name: "verticalFlipWorkImg",
        tip: "simVision.verticalFlipWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.work.flip_vertically()),
    },
    Function {
        name: "normalizeWorkImg",
        tip: "simVision.normalizeWorkImg(int visionSensorHandle)",
        run: |d, a| edit(d, a, |images| images.work.normalize()),
    },
    Function {
        name: "sharpenWorkImg",
        tip: "simVision.sharpenWorkImg(int visionSensorHandle)",
        run: |d, a| filter(d, a, PER_PIXEL + 9, |images| images.work.sharpen()),
    },
    Function {
        name: "uniformImgToWorkImg",
        tip: "simVision.uniformImgToWorkImg(int visionSensorHandle,float[3] color)",
        run: |d, a| {
            let color = a.reals::<3>(1)?;
            edit(d, a, |images| images.work.fill(color))
        },
    },
    Function {
        name: "colorSegmentationOnWorkImg",
        tip: "simVision.colorSegmentationOnWorkImg(int visionSensorHandle,float maxColorColorDistance)",
        run: segment,
    },
    Function {
        name: "intensityScaleOnWorkImg",
        tip: "simVision.intensityScaleOnWorkImg(int visionSensorHandle,float start,float end,bool greyScale)",
        run: |d, a| {
            let (start, end, is_grey) = (a.real(1)?, a.real(2)?, a.bool_or(3, false)?);
            edit(d, a, |images| images.work.scale_intensity(start, end, is_grey))
        },
    },
    Function {
        name: "selectiveColorOnWorkImg",
        tip: "simVision.selectiveColorOnWorkImg(int visionSensorHandle,float[3] color,float[3] colorTolerance,bool rgbSpace,bool keepColor,bool removedPartToBuffer1)",
        run: select,
    },
    Function {
        name: "scaleAndOffsetWorkImg",
        tip: "simVision.scaleAndOffsetWorkImg(int visionSensorHandle,float[3] preOffset,float[3] scaling,float[3] postOffset,bool rgbSpace)",
        run: |d, a| {
            let (pre, scale, post) = (a.reals::<3>(1)?, a.reals::<3>(2)?, a.reals::<3>(3)?);
            let space = space(a, 4)?;
            edit(d, a, |images| images.work.scale_and_offset(pre, scale, post, space))
        },
    },
    Function {
        name: "binaryWorkImg",
        tip: "bool trigger,buffer packet=simVision.binaryWorkImg(int visionSensorHandle,float threshold,float oneProportion,float oneTol,float xCenter,float xCenterTol,float yCenter,float yCenterTol,float orient,float orientTol,float roundness,bool enableTrigger,float[3] overlayColor=nil)",
        run: binary,
    },
    Function {
        name: "blobDetectionOnWorkImg",
        tip: "bool trigger,buffer packet=simVision.blobDetectionOnWorkImg(int visionSensorHandle,float threshold,float minBlobSize,bool modifyWorkImg,float[3] overlayColor=nil)",
        run: blobs,
    },
    Function {
        name: "edgeDetectionOnWorkImg",
        tip: "simVision.edgeDetectionOnWorkImg(int visionSensorHandle,float threshold)",
        run: |d, a| {
            let threshold = a.real(1)?;
            filter(d, a, PER_PIXEL + 9, |images| images.work.detect_edges(threshold))
        },
    },
    Function {
        name: "shiftWorkImg",
        tip: "simVision.shiftWorkImg(int visionSensorHandle,float[2] shift,bool wrapAround)",
        run: |d, a| {
            let (shift, wraps) = (a.reals::<2>(1)?, a.bool_or(2, false)?);
            edit(d, a, |images| images.work.shift(shift, wraps))
        },
    },
    Function {
        name: "circularCutWorkImg",
        tip: "simVision.circularCutWorkImg(int visionSensorHandle,float radius,bool copyToBuffer1)",
        run: |d, a| {
            let (radius, to_buffer) = (a.real(1)?, a.bool_or(2, false)?);
            edit(d, a, |images| {
                let removed = images.work.cut_circle(radius);
                keep_removed(images, removed, to_buffer);
            })
        },
    },
    Function {
        name: "rectangularCutWorkImg",
        tip: "simVision.rectangularCutWorkImg(int visionSensorHandle,float[2] sizes,bool copyToBuffer1)",
        run: |d, a| {
            let (sizes, to_buffer) = (a.reals::<2>(1)?, a.bool_or(2, false)?);
            edit(d, a, |images| {
                let removed = images.work.cut_rectangle(sizes);
                keep_removed(images, removed, to_buffer);
            })
        },
    },
    Function {
        name: "matrix3x3OnWorkImg",
        tip: "simVision.matrix3x3OnWorkImg(int visionSensorHandle,int passes,float multiplier,float[9] matrix=nil)",
        run: |d, a| convolve::<9>(d, a, 3),
    },
    Function {
        name: "matrix5x5OnWorkImg",
        tip: "simVision.matrix5x5OnWorkImg(int visionSensorHandle,int passes,float multiplier,float[25] matrix=nil)",
        run: |d, a| convolve::<25>(d, a, 5),
    },
    Function {
        name: "coordinatesFromWorkImg",
        tip: "bool trigger,buffer packet,buffer colors=simVision.coordinatesFromWorkImg(int visionSensorHandle,int[2] xyPointCount,bool evenlySpacedInAngularSpace,bool returnColorInfo=false)",
        run: |d, a| {
            let sampling = if a.bool_or(2, false)? { Sampling::Angles } else { Sampling::Grid };
            points(d, a, sampling)
        },
    },
    Function {
        name: "velodyneDataFromWorkImg",
        tip: "bool trigger,buffer packet,buffer colors=simVision.velodyneDataFromWorkImg(int visionSensorHandle,int[2] xyPointCount,float vAngle,bool returnColorInfo=false)",
        run: |d, a| {
            let elevation = a.real(2)?;
            points(d, a, Sampling::Scan(elevation))
        },
    },
    Function {
        name: "changedPixelsOnWorkImg",
        tip: "bool trigger,buffer packet=simVision.changedPixelsOnWorkImg(int visionSensorHandle,float threshold)",
        run: changes,
    },
];

/// Nothing triggers, nothing is found.
fn silent() -> Outcome {
    Ok(vec![Value::Bool(false)])
}

/// Changes the work image of a sensor or its buffers.
fn edit(sim: &mut SimApi<'_>, a: Arguments<'_>, change: impl FnOnce(&mut WorkImages)) -> Outcome {
    filter(sim, a, PER_PIXEL, change)
}

/// Changes the work image of a sensor or its buffers by so many operations on each pixel.
fn filter(sim: &mut SimApi<'_>, a: Arguments<'_>, per_pixel: u64, change: impl FnOnce(&mut WorkImages)) -> Outcome {
    let own = handle(sim, a, 0)?;
    count(sim, own, per_pixel)?;
    change(sim.work_images(own)?);
    silent()
}

/// Counts operations on each pixel of a work image, before they are done.
fn count(sim: &mut SimApi<'_>, own: Handle, per_pixel: u64) -> Result<(), ApiError> {
    let n = n_pixels(sim, own)? as u64;
    sim.count_operations(n.saturating_mul(per_pixel))
}

fn n_pixels(sim: &mut SimApi<'_>, own: Handle) -> Result<usize, ApiError> {
    let [columns, rows] = sim.work_images(own)?.work.size();
    Ok(columns * rows)
}

/// Changes the work image or the first buffer.
fn with_buffer(images: &mut WorkImages, change: impl FnOnce(&mut WorkImage, &mut WorkImage)) {
    images.buffer(0);
    if let WorkImages { work, buffers: [Some(buffer), _] } = images {
        change(work, buffer);
    }
}

fn keep_removed(images: &mut WorkImages, removed: WorkImage, to_buffer: bool) {
    if to_buffer {
        images.buffers[0] = Some(removed);
    }
}

fn load(sim: &mut SimApi<'_>, a: Arguments<'_>, is_of_depths: bool) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.load_work_image(own, is_of_depths)?;
    count(sim, own, PER_PIXEL)?;
    silent()
}

/// The work image stays: filters may follow.
fn store(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    a.bool_or(1, true)?;
    count(sim, own, PER_PIXEL)?;
    sim.store_work_image(own)?;
    silent()
}

fn release(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.release_work_images(own)?;
    silent()
}

fn space(a: Arguments<'_>, k: usize) -> Result<ColorSpace, ApiError> {
    Ok(if a.bool_or(k, true)? { ColorSpace::Rgb } else { ColorSpace::Hsl })
}

fn segment(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, distance) = (handle(sim, a, 0)?, a.real(1)?);
    let max_colors = MAX_COLORS.min(MAX_OPERATIONS as usize / n_pixels(sim, own)?.max(1));
    let done = sim.work_images(own)?.work.segment_colors(distance, max_colors);
    sim.count_operations(done.n_comparisons)?;
    if done.is_complete {
        return silent();
    }
    Err(ApiError(format!(
        "there are more than {max_colors} colours at a distance of {distance}: take a larger distance"
    )))
}

fn select(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (color, tolerance, space) = (a.reals::<3>(1)?, a.reals::<3>(2)?, space(a, 3)?);
    let (keeps, to_buffer) = (a.bool_or(4, true)?, a.bool_or(5, false)?);
    edit(sim, a, |images| {
        let removed = images.work.select_color(color, tolerance, space, keeps);
        keep_removed(images, removed, to_buffer);
    })
}

/// Numbers as single precision, which is what scripts and clients unpack.
fn packed(numbers: impl IntoIterator<Item = f64>) -> Value {
    Value::Bytes(numbers.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect())
}

/// Colour of what is drawn over the work image; none if it is not given.
fn overlay(a: Arguments<'_>, k: usize) -> Result<Option<[f64; 3]>, ApiError> {
    if a.has(k) { a.reals::<3>(k).map(Some) } else { Ok(None) }
}

fn binary(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let mut numbers = [0.0; 10];
    for (k, x) in numbers.iter_mut().enumerate() {
        *x = a.real(k + 1)?;
    }
    let [threshold, proportion, proportion_tol, x, x_tol, y, y_tol, angle, angle_tol, roundness] = numbers;
    let (may_trigger, color) = (a.bool_or(11, false)?, overlay(a, 12)?);
    count(sim, own, PER_PIXEL)?;
    let work = &mut sim.work_images(own)?.work;
    let found = work.binarize(threshold);
    if let Some(color) = color.filter(|_| found.proportion > 0.0) {
        draw_cross(work, &found, color);
    }
    let is_near = |wanted: f64, got: f64, tolerance: f64| (wanted - got).abs() < tolerance;
    let triggers = may_trigger
        && is_near(proportion, found.proportion, proportion_tol)
        && is_near(x, found.center[0], x_tol)
        && is_near(y, found.center[1], y_tol)
        && turn(angle, found.angle) < angle_tol
        && found.roundness <= roundness;
    let packet = [found.proportion, found.center[0], found.center[1], found.angle, found.roundness];
    Ok(vec![Value::Bool(triggers), packed(packet)])
}

/// Angle between two directions, 0 to π `[rad]`.
fn turn(a: f64, b: f64) -> f64 {
    let (sin, cos) = sin_cos(a - b);
    atan2(sin.abs(), cos).0
}

/// Cross at the centre of what was found, of nine pixels each way.
fn draw_cross(work: &mut WorkImage, found: &Moments, color: [f64; 3]) {
    let size = work.size().map(|n| n as f64);
    let [x, y] = [0, 1].map(|axis| found.center[axis] * size[axis] + 0.5);
    work.draw_line([x - 4.0, y], [x + 4.0, y], color);
    work.draw_line([x, y - 4.0], [x, y + 4.0], color);
}

/// Number of blobs, number of values of each (6), and of each its share of the pixels, angle, centre, width and height.
fn blobs(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (threshold, min_size, is_colored) = (a.real(1)?, a.real(2)?, a.bool_or(3, false)?);
    let color = overlay(a, 4)?;
    count(sim, own, PER_BLOB_PIXEL)?;
    let work = &mut sim.work_images(own)?.work;
    let found = if is_colored { work.colored_blobs(threshold, min_size) } else { work.blobs(threshold, min_size) };
    if let Some(color) = color {
        found.iter().for_each(|blob| work.draw_blob(blob, color));
    }
    let head = [found.len() as f64, 6.0];
    let values = found
        .iter()
        .flat_map(|blob| [blob.size, blob.angle, blob.center[0], blob.center[1], blob.extent[0], blob.extent[1]]);
    Ok(vec![Value::Bool(false), packed(head.into_iter().chain(values))])
}

/// A kernel, the Gaussian one if none is given, times a factor, so many times.
fn convolve<const N: usize>(sim: &mut SimApi<'_>, a: Arguments<'_>, side: usize) -> Outcome {
    let (passes, factor) = (a.int(1)?, a.real(2)?);
    let kernel = if a.has(3) { a.reals::<N>(3)?.to_vec() } else { gaussian(side) };
    if !(0..=MAX_PASSES).contains(&passes) {
        return Err(ApiError(format!("{passes} passes: expected 0 to {MAX_PASSES}")));
    }
    let kernel: Vec<f64> = kernel.into_iter().map(|weight| weight * factor).collect();
    let per_pixel = passes as u64 * kernel.len() as u64;
    filter(sim, a, per_pixel, |images| (0..passes).for_each(|_| images.work.convolve(&kernel)))
}

/// Numbers of columns and rows, then x, y, z and distance of each point; with the colours of the first buffer, three
/// bytes each and three more, if they are asked for.
fn points(sim: &mut SimApi<'_>, a: Arguments<'_>, sampling: Sampling) -> Outcome {
    let own = handle(sim, a, 0)?;
    let counts = a.reals::<2>(1)?;
    let wants_colors = a.bool_or(3, false)?;
    let is_count = |n: f64| n.fract() == 0.0 && n >= 1.0;
    if !counts.into_iter().all(is_count) || counts[0] * counts[1] > MAX_POINTS as f64 {
        let [columns, rows] = counts;
        return Err(ApiError(format!(
            "{columns} × {rows} points: expected at least one each way, {MAX_POINTS} in all"
        )));
    }
    let raw = a.handle(0)?;
    let pose = if raw > 0 && raw & IN_WORLD != 0 { Some(sim.pose(own, Reference::World)?) } else { None };
    let lens = sim.depth_lens(own)?;
    sim.count_operations((counts[0] * counts[1]) as u64 * PER_POINT)?;
    let images = sim.work_images(own)?;
    let found = images.work.points(&lens, counts.map(|n| n as usize), sampling);
    let numbers = found.iter().flat_map(|([x, y, z, distance], _)| {
        let local = Vec3([*x, *y, *z]);
        let at = pose.as_ref().map_or(local, |pose| pose.point(local));
        [at[0], at[1], at[2], *distance]
    });
    let mut results = vec![Value::Bool(false), packed(counts.into_iter().chain(numbers))];
    if let (true, Some(buffer)) = (wants_colors, &images.buffers[0]) {
        let rgb = buffer.rgb();
        let mut bytes: Vec<u8> = found.iter().flat_map(|(_, k)| rgb[3 * k..3 * k + 3].iter().copied()).collect();
        bytes.extend([0; 3]);
        results.push(Value::Bytes(bytes));
    }
    Ok(results)
}

/// For each pixel that has changed since the last call 1 (brighter) or −1, its column and its row.
fn changes(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, threshold) = (handle(sim, a, 0)?, a.real(1)?);
    count(sim, own, PER_PIXEL)?;
    let images = sim.work_images(own)?;
    images.buffer(1);
    let WorkImages { work, buffers: [_, Some(before)] } = images else { return silent() };
    let changed = work.changed_pixels(before, threshold);
    let numbers = changed
        .iter()
        .flat_map(|pixel| [if pixel.is_brighter { 1.0 } else { -1.0 }, pixel.at[0] as f64, pixel.at[1] as f64]);
    let packet = packed(numbers);
    Ok(if changed.is_empty() { vec![Value::Bool(false)] } else { vec![Value::Bool(false), packet] })
}
