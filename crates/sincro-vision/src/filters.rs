//! The functions of `simVision`: filters on the pictures of vision sensors, by name.
//!
//! A filter works on the work image of a sensor, which has two buffers beside it. As in CoppeliaSim each gives first
//! whether it triggers the sensor (`binaryWorkImg` alone may), then what it has found, as packed floats.

use sincro_math::elementary::{atan2, sin_cos};
use sincro_values::work::{MAX_OPERATIONS, check_operations};
use sincro_values::{ApiError, Arguments, Handle, Value};

use crate::spherical::origins;
use crate::work_images::WorkImages;
use crate::{ColorSpace, DepthLens, Moments, Sampling, WorkImage, gaussian};

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
/// Pixels that the pictures may have from which one of all directions is put together.
const MAX_PIXELS: usize = 1 << 22;
/// Colours that a segmentation may find; fewer in large images, whose comparisons one call could not make.
const MAX_COLORS: usize = 1_024;

/// Return values of a filter: whether it triggers the sensor, then what it has found.
type Outcome = Result<Vec<Value>, ApiError>;

/// Vision sensors with their pictures and work images.
pub trait Sensors {
    /// Finds a vision sensor, flags of its handle taken off.
    ///
    /// # Errors
    ///
    /// There is no such object.
    fn sensor(&self, handle: i32) -> Result<Handle, ApiError>;
    /// Work image of a sensor with its buffers.
    ///
    /// # Errors
    ///
    /// It is no vision sensor, or has no work image.
    fn images(&mut self, sensor: Handle) -> Result<&mut WorkImages, ApiError>;
    /// Makes the picture of a sensor, or its depths, its work image.
    ///
    /// # Errors
    ///
    /// It is no vision sensor, or all work images would have too many pixels.
    fn load(&mut self, sensor: Handle, is_of_depths: bool) -> Result<(), ApiError>;
    /// Takes the picture of a sensor now, and returns it, or its depths (0 near plane, 1 far plane); of a sensor with
    /// external input the picture that was written.
    ///
    /// # Errors
    ///
    /// It is no vision sensor.
    fn take(&mut self, sensor: Handle, is_of_depths: bool) -> Result<WorkImage, ApiError>;
    /// Numbers of columns and rows of a sensor.
    ///
    /// # Errors
    ///
    /// It is no vision sensor.
    fn size(&self, sensor: Handle) -> Result<[usize; 2], ApiError>;
    /// Makes an image of the size of a sensor its picture.
    ///
    /// # Errors
    ///
    /// It is no vision sensor.
    fn show(&mut self, sensor: Handle, image: &WorkImage) -> Result<(), ApiError>;
    /// Makes the work image of a sensor its picture.
    ///
    /// # Errors
    ///
    /// It is no vision sensor, or has no work image.
    fn store(&mut self, sensor: Handle) -> Result<(), ApiError>;
    /// Frees the work image of a sensor and its buffers.
    ///
    /// # Errors
    ///
    /// It is no vision sensor.
    fn release(&mut self, sensor: Handle) -> Result<(), ApiError>;
    /// Lens of a sensor whose depths are turned into points.
    ///
    /// # Errors
    ///
    /// It is no vision sensor.
    fn lens(&self, sensor: Handle) -> Result<DepthLens, ApiError>;
    /// Point of the frame of a sensor in the world `[m]`.
    ///
    /// # Errors
    ///
    /// It is gone.
    fn in_world(&mut self, sensor: Handle, point: [f64; 3]) -> Result<[f64; 3], ApiError>;
    /// Adds operations on pixels to the work of the call.
    fn spend(&mut self, operations: u64);
}

/// Gives the names of the functions of [`call`](crate::call()) and their call tips, one after the other, to a macro, as
/// literals.
#[macro_export]
macro_rules! for_filters {
    ($table:ident) => {
        $table! {
            "sensorImgToWorkImg" "simVision.sensorImgToWorkImg(int visionSensorHandle)"
            "sensorDepthMapToWorkImg" "simVision.sensorDepthMapToWorkImg(int visionSensorHandle)"
            "workImgToSensorImg" "simVision.workImgToSensorImg(int visionSensorHandle,bool removeBuffer=true)"
            "releaseBuffers" "simVision.releaseBuffers(int visionSensorHandle)"
            "handleSpherical" "simVision.handleSpherical(int rgbVisionSensorHandle,int[6] activeVisionSensorHandles,float horizontalAngle,float verticalAngle,int depthVisionSensorHandle=-1)"
            "workImgToBuffer1" "simVision.workImgToBuffer1(int visionSensorHandle)"
            "workImgToBuffer2" "simVision.workImgToBuffer2(int visionSensorHandle)"
            "swapBuffers" "simVision.swapBuffers(int visionSensorHandle)"
            "buffer1ToWorkImg" "simVision.buffer1ToWorkImg(int visionSensorHandle)"
            "buffer2ToWorkImg" "simVision.buffer2ToWorkImg(int visionSensorHandle)"
            "swapWorkImgWithBuffer1" "simVision.swapWorkImgWithBuffer1(int visionSensorHandle)"
            "addWorkImgToBuffer1" "simVision.addWorkImgToBuffer1(int visionSensorHandle)"
            "subtractWorkImgFromBuffer1" "simVision.subtractWorkImgFromBuffer1(int visionSensorHandle)"
            "addBuffer1ToWorkImg" "simVision.addBuffer1ToWorkImg(int visionSensorHandle)"
            "subtractBuffer1FromWorkImg" "simVision.subtractBuffer1FromWorkImg(int visionSensorHandle)"
            "multiplyWorkImgWithBuffer1" "simVision.multiplyWorkImgWithBuffer1(int visionSensorHandle)"
            "horizontalFlipWorkImg" "simVision.horizontalFlipWorkImg(int visionSensorHandle)"
            "verticalFlipWorkImg" "simVision.verticalFlipWorkImg(int visionSensorHandle)"
            "normalizeWorkImg" "simVision.normalizeWorkImg(int visionSensorHandle)"
            "sharpenWorkImg" "simVision.sharpenWorkImg(int visionSensorHandle)"
            "uniformImgToWorkImg" "simVision.uniformImgToWorkImg(int visionSensorHandle,float[3] color)"
            "colorSegmentationOnWorkImg" "simVision.colorSegmentationOnWorkImg(int visionSensorHandle,float maxColorColorDistance)"
            "intensityScaleOnWorkImg" "simVision.intensityScaleOnWorkImg(int visionSensorHandle,float start,float end,bool greyScale)"
            "selectiveColorOnWorkImg" "simVision.selectiveColorOnWorkImg(int visionSensorHandle,float[3] color,float[3] colorTolerance,bool rgbSpace,bool keepColor,bool removedPartToBuffer1)"
            "scaleAndOffsetWorkImg" "simVision.scaleAndOffsetWorkImg(int visionSensorHandle,float[3] preOffset,float[3] scaling,float[3] postOffset,bool rgbSpace)"
            "binaryWorkImg" "bool trigger,buffer packet=simVision.binaryWorkImg(int visionSensorHandle,float threshold,float oneProportion,float oneTol,float xCenter,float xCenterTol,float yCenter,float yCenterTol,float orient,float orientTol,float roundness,bool enableTrigger,float[3] overlayColor=nil)"
            "blobDetectionOnWorkImg" "bool trigger,buffer packet=simVision.blobDetectionOnWorkImg(int visionSensorHandle,float threshold,float minBlobSize,bool modifyWorkImg,float[3] overlayColor=nil)"
            "edgeDetectionOnWorkImg" "simVision.edgeDetectionOnWorkImg(int visionSensorHandle,float threshold)"
            "shiftWorkImg" "simVision.shiftWorkImg(int visionSensorHandle,float[2] shift,bool wrapAround)"
            "circularCutWorkImg" "simVision.circularCutWorkImg(int visionSensorHandle,float radius,bool copyToBuffer1)"
            "rectangularCutWorkImg" "simVision.rectangularCutWorkImg(int visionSensorHandle,float[2] sizes,bool copyToBuffer1)"
            "matrix3x3OnWorkImg" "simVision.matrix3x3OnWorkImg(int visionSensorHandle,int passes,float multiplier,float[9] matrix=nil)"
            "matrix5x5OnWorkImg" "simVision.matrix5x5OnWorkImg(int visionSensorHandle,int passes,float multiplier,float[25] matrix=nil)"
            "coordinatesFromWorkImg" "bool trigger,buffer packet,buffer colors=simVision.coordinatesFromWorkImg(int visionSensorHandle,int[2] xyPointCount,bool evenlySpacedInAngularSpace,bool returnColorInfo=false)"
            "velodyneDataFromWorkImg" "bool trigger,buffer packet,buffer colors=simVision.velodyneDataFromWorkImg(int visionSensorHandle,int[2] xyPointCount,float vAngle,bool returnColorInfo=false)"
            "changedPixelsOnWorkImg" "bool trigger,buffer packet=simVision.changedPixelsOnWorkImg(int visionSensorHandle,float threshold)"
        }
    };
}

/// Calls the function of `simVision` of a name without it.
///
/// # Errors
///
/// Its arguments are not those of the function, it would take too long, or there is no such function.
pub fn call(sensors: &mut impl Sensors, name: &str, a: Arguments<'_>) -> Outcome {
    match name {
        "sensorImgToWorkImg" => load(sensors, a, false),
        "sensorDepthMapToWorkImg" => load(sensors, a, true),
        "workImgToSensorImg" => store(sensors, a),
        "releaseBuffers" => release(sensors, a),
        "handleSpherical" => spherical(sensors, a),
        "workImgToBuffer1" => edit(sensors, a, |images| images.buffers[0] = Some(images.work.clone())),
        "workImgToBuffer2" => edit(sensors, a, |images| images.buffers[1] = Some(images.work.clone())),
        "swapBuffers" => edit(sensors, a, |images| images.buffers.swap(0, 1)),
        "buffer1ToWorkImg" => edit(sensors, a, |images| images.work = images.buffer(0).clone()),
        "buffer2ToWorkImg" => edit(sensors, a, |images| images.work = images.buffer(1).clone()),
        "swapWorkImgWithBuffer1" => edit(sensors, a, |images| with_buffer(images, std::mem::swap)),
        "addWorkImgToBuffer1" => edit(sensors, a, |images| with_buffer(images, |work, buffer| buffer.add(work))),
        "subtractWorkImgFromBuffer1" => {
            edit(sensors, a, |images| with_buffer(images, |work, buffer| buffer.subtract(work)))
        }
        "addBuffer1ToWorkImg" => edit(sensors, a, |images| with_buffer(images, |work, buffer| work.add(buffer))),
        "subtractBuffer1FromWorkImg" => {
            edit(sensors, a, |images| with_buffer(images, |work, buffer| work.subtract(buffer)))
        }
        "multiplyWorkImgWithBuffer1" => {
            edit(sensors, a, |images| with_buffer(images, |work, buffer| work.multiply(buffer)))
        }
        "horizontalFlipWorkImg" => edit(sensors, a, |images| images.work.flip_horizontally()),
        "verticalFlipWorkImg" => edit(sensors, a, |images| images.work.flip_vertically()),
        "normalizeWorkImg" => edit(sensors, a, |images| images.work.normalize()),
        "sharpenWorkImg" => filter(sensors, a, PER_PIXEL + 9, |images| images.work.sharpen()),
        "uniformImgToWorkImg" => {
            let color = a.reals::<3>(1)?;
            edit(sensors, a, |images| images.work.fill(color))
        }
        "colorSegmentationOnWorkImg" => segment(sensors, a),
        "intensityScaleOnWorkImg" => {
            let (start, end, is_grey) = (a.real(1)?, a.real(2)?, a.bool_or(3, false)?);
            edit(sensors, a, |images| images.work.scale_intensity(start, end, is_grey))
        }
        "selectiveColorOnWorkImg" => select(sensors, a),
        "scaleAndOffsetWorkImg" => {
            let (pre, scale, post) = (a.reals::<3>(1)?, a.reals::<3>(2)?, a.reals::<3>(3)?);
            let space = space(a, 4)?;
            edit(sensors, a, |images| images.work.scale_and_offset(pre, scale, post, space))
        }
        "binaryWorkImg" => binary(sensors, a),
        "blobDetectionOnWorkImg" => blobs(sensors, a),
        "edgeDetectionOnWorkImg" => {
            let threshold = a.real(1)?;
            filter(sensors, a, PER_PIXEL + 9, |images| images.work.detect_edges(threshold))
        }
        "shiftWorkImg" => {
            let (shift, wraps) = (a.reals::<2>(1)?, a.bool_or(2, false)?);
            edit(sensors, a, |images| images.work.shift(shift, wraps))
        }
        "circularCutWorkImg" => {
            let (radius, to_buffer) = (a.real(1)?, a.bool_or(2, false)?);
            edit(sensors, a, |images| {
                let removed = images.work.cut_circle(radius);
                keep_removed(images, removed, to_buffer);
            })
        }
        "rectangularCutWorkImg" => {
            let (sizes, to_buffer) = (a.reals::<2>(1)?, a.bool_or(2, false)?);
            edit(sensors, a, |images| {
                let removed = images.work.cut_rectangle(sizes);
                keep_removed(images, removed, to_buffer);
            })
        }
        "matrix3x3OnWorkImg" => convolve::<9, _>(sensors, a, 3),
        "matrix5x5OnWorkImg" => convolve::<25, _>(sensors, a, 5),
        "coordinatesFromWorkImg" => {
            let sampling = if a.bool_or(2, false)? { Sampling::Angles } else { Sampling::Grid };
            points(sensors, a, sampling)
        }
        "velodyneDataFromWorkImg" => {
            let elevation = a.real(2)?;
            points(sensors, a, Sampling::Scan(elevation))
        }
        "changedPixelsOnWorkImg" => changes(sensors, a),
        _ => Err(ApiError(format!("there is no simVision.{name}"))),
    }
}

/// Adds operations on pixels to the work of the call, before or after they are done.
fn spend(sensors: &mut impl Sensors, n: u64) -> Result<(), ApiError> {
    check_operations(n, "operations on pixels", "take fewer passes, or give the sensor a lower resolution")?;
    sensors.spend(n);
    Ok(())
}

/// Nothing triggers, nothing is found.
fn silent() -> Outcome {
    Ok(vec![Value::Bool(false)])
}

/// Changes the work image of a sensor or its buffers.
fn edit<S: Sensors>(sensors: &mut S, a: Arguments<'_>, change: impl FnOnce(&mut WorkImages)) -> Outcome {
    filter(sensors, a, PER_PIXEL, change)
}

/// Changes the work image of a sensor or its buffers by so many operations on each pixel.
fn filter<S: Sensors>(
    sensors: &mut S,
    a: Arguments<'_>,
    per_pixel: u64,
    change: impl FnOnce(&mut WorkImages),
) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    count(sensors, own, per_pixel)?;
    change(sensors.images(own)?);
    silent()
}

/// Counts operations on each pixel of a work image, before they are done.
fn count<S: Sensors>(sensors: &mut S, own: Handle, per_pixel: u64) -> Result<(), ApiError> {
    let n = n_pixels(sensors, own)? as u64;
    spend(sensors, n.saturating_mul(per_pixel))
}

fn n_pixels<S: Sensors>(sensors: &mut S, own: Handle) -> Result<usize, ApiError> {
    let [columns, rows] = sensors.images(own)?.work.size();
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

fn load<S: Sensors>(sensors: &mut S, a: Arguments<'_>, is_of_depths: bool) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    sensors.load(own, is_of_depths)?;
    count(sensors, own, PER_PIXEL)?;
    silent()
}

/// The work image stays: filters may follow.
fn store<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    a.bool_or(1, true)?;
    count(sensors, own, PER_PIXEL)?;
    sensors.store(own)?;
    silent()
}

/// A picture of all directions from those of six sensors, in colours in one sensor, of distances in another one.
fn spherical<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let find = |sensors: &S, handle: i64| {
        let handle = i32::try_from(handle).map_err(|_| ApiError(format!("there is no object {handle}")))?;
        sensors.sensor(handle)
    };
    let targets = [a.int(0)?, a.int_or(4, -1)?];
    let six: [f64; 6] = a.reals(1)?;
    let six = six.iter().map(|handle| find(sensors, *handle as i64)).collect::<Result<Vec<_>, ApiError>>()?;
    let side = sensors.size(six[0])?[0];
    for own in &six {
        if sensors.size(*own)? != [side; 2] {
            return Err(ApiError::new("the six sensors need as many rows as columns, all the same"));
        }
    }
    if 6 * side * side > MAX_PIXELS {
        return Err(ApiError(format!("the six pictures have more than {MAX_PIXELS} pixels: give the sensors fewer")));
    }
    let lens = sensors.lens(six[0])?;
    let range = lens.far - lens.near;
    for (target, is_of_depths) in targets.into_iter().zip([false, true]).filter(|(target, _)| *target != -1) {
        let own = find(sensors, target)?;
        let size = sensors.size(own)?;
        sensors.spend(PER_POINT * (size[0] * size[1]) as u64);
        let mut pictures: [Option<WorkImage>; 6] = [const { None }; 6];
        let mut image = WorkImage::black(size);
        for (pixel, origin) in image.pixels.iter_mut().zip(origins(size, [a.real(2)?, a.real(3)?], side)) {
            let picture = match &mut pictures[origin.sensor] {
                Some(picture) => picture,
                none => none.insert(sensors.take(six[origin.sensor], is_of_depths)?),
            };
            let seen = picture.pixels[origin.pixel];
            // along the ray instead of the axis, in the range between the planes
            let far = |depth: f64| (((lens.near + range * depth) * origin.stretch - lens.near) / range).min(1.0);
            *pixel = if is_of_depths { seen.map(far) } else { seen };
        }
        sensors.show(own, &image)?;
    }
    Ok(Vec::new())
}

fn release<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    sensors.release(own)?;
    silent()
}

fn space(a: Arguments<'_>, k: usize) -> Result<ColorSpace, ApiError> {
    Ok(if a.bool_or(k, true)? { ColorSpace::Rgb } else { ColorSpace::Hsl })
}

fn segment<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let (own, distance) = (sensors.sensor(a.handle(0)?)?, a.real(1)?);
    let max_colors = MAX_COLORS.min(MAX_OPERATIONS as usize / n_pixels(sensors, own)?.max(1));
    let done = sensors.images(own)?.work.segment_colors(distance, max_colors);
    spend(sensors, done.n_comparisons)?;
    if done.is_complete {
        return silent();
    }
    Err(ApiError(format!(
        "there are more than {max_colors} colours at a distance of {distance}: take a larger distance"
    )))
}

fn select<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let (color, tolerance, space) = (a.reals::<3>(1)?, a.reals::<3>(2)?, space(a, 3)?);
    let (keeps, to_buffer) = (a.bool_or(4, true)?, a.bool_or(5, false)?);
    edit(sensors, a, |images| {
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

fn binary<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    let mut numbers = [0.0; 10];
    for (k, x) in numbers.iter_mut().enumerate() {
        *x = a.real(k + 1)?;
    }
    let [threshold, proportion, proportion_tol, x, x_tol, y, y_tol, angle, angle_tol, roundness] = numbers;
    let (may_trigger, color) = (a.bool_or(11, false)?, overlay(a, 12)?);
    count(sensors, own, PER_PIXEL)?;
    let work = &mut sensors.images(own)?.work;
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
fn blobs<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
    let (threshold, min_size, is_colored) = (a.real(1)?, a.real(2)?, a.bool_or(3, false)?);
    let color = overlay(a, 4)?;
    count(sensors, own, PER_BLOB_PIXEL)?;
    let work = &mut sensors.images(own)?.work;
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
fn convolve<const N: usize, S: Sensors>(sensors: &mut S, a: Arguments<'_>, side: usize) -> Outcome {
    let (passes, factor) = (a.int(1)?, a.real(2)?);
    let kernel = if a.has(3) { a.reals::<N>(3)?.to_vec() } else { gaussian(side) };
    if !(0..=MAX_PASSES).contains(&passes) {
        return Err(ApiError(format!("{passes} passes: expected 0 to {MAX_PASSES}")));
    }
    let kernel: Vec<f64> = kernel.into_iter().map(|weight| weight * factor).collect();
    let per_pixel = passes as u64 * kernel.len() as u64;
    filter(sensors, a, per_pixel, |images| (0..passes).for_each(|_| images.work.convolve(&kernel)))
}

/// Numbers of columns and rows, then x, y, z and distance of each point; with the colours of the first buffer, three
/// bytes each and three more, if they are asked for.
fn points<S: Sensors>(sensors: &mut S, a: Arguments<'_>, sampling: Sampling) -> Outcome {
    let own = sensors.sensor(a.handle(0)?)?;
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
    let is_in_world = raw > 0 && raw & IN_WORLD != 0;
    let lens = sensors.lens(own)?;
    spend(sensors, (counts[0] * counts[1]) as u64 * PER_POINT)?;
    let found = sensors.images(own)?.work.points(&lens, counts.map(|n| n as usize), sampling);
    let mut numbers = Vec::with_capacity(4 * found.len());
    for ([x, y, z, distance], _) in &found {
        let at = if is_in_world { sensors.in_world(own, [*x, *y, *z])? } else { [*x, *y, *z] };
        numbers.extend([at[0], at[1], at[2], *distance]);
    }
    let mut results = vec![Value::Bool(false), packed(counts.into_iter().chain(numbers))];
    if let (true, Some(buffer)) = (wants_colors, &sensors.images(own)?.buffers[0]) {
        let rgb = buffer.rgb();
        let mut bytes: Vec<u8> = found.iter().flat_map(|(_, k)| rgb[3 * k..3 * k + 3].iter().copied()).collect();
        bytes.extend([0; 3]);
        results.push(Value::Bytes(bytes));
    }
    Ok(results)
}

/// For each pixel that has changed since the last call 1 (brighter) or −1, its column and its row.
fn changes<S: Sensors>(sensors: &mut S, a: Arguments<'_>) -> Outcome {
    let (own, threshold) = (sensors.sensor(a.handle(0)?)?, a.real(1)?);
    count(sensors, own, PER_PIXEL)?;
    let images = sensors.images(own)?;
    images.buffer(1);
    let WorkImages { work, buffers: [_, Some(before)] } = images else { return silent() };
    let changed = work.changed_pixels(before, threshold);
    let numbers = changed
        .iter()
        .flat_map(|pixel| [if pixel.is_brighter { 1.0 } else { -1.0 }, pixel.at[0] as f64, pixel.at[1] as f64]);
    let packet = packed(numbers);
    Ok(if changed.is_empty() { vec![Value::Bool(false)] } else { vec![Value::Bool(false), packet] })
}
