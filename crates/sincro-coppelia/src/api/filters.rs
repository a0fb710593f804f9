//! Work images of vision sensors, on which filters work, and what a script makes of a picture: a trigger and packets of
//! numbers. The filters are those of `sincro-vision`.

use sincro_vision::{DepthLens, Sensors, WorkImage, WorkImages};

use super::registry::Handle;
use super::vision::Sensors as Handled;
use super::{ApiError, Reference, SimApi, Vec3};
use sincro_scene::camera::{Layer, Lens};

/// Pixels that all work images and their buffers may have together: 4 Mi, which take 100 MB.
const MAX_WORK_PIXELS: usize = 1 << 22;
/// Packets that a script may add to the reading of one sensor.
const MAX_PACKETS: usize = 1_000;
/// Numbers of all packets of one reading together.
const MAX_PACKET_LEN: usize = 1 << 22;

/// Operations on pixels or points in the time of one instruction of a script, about 10 ns.
const OPERATIONS_PER_INSTRUCTION: u64 = 8;

/// Result of the filters of one sensor since its last handling.
#[derive(Clone, Debug, Default)]
pub(super) struct Filtered {
    images: Option<WorkImages>,
    /// Statistics of the picture before the filters.
    statistics: Option<[f64; 15]>,
    is_triggered: bool,
    packets: Vec<Vec<f64>>,
}

impl Filtered {
    /// Forgets the reading of the last handling; the work image stays.
    pub fn begin(&mut self) {
        (self.statistics, self.is_triggered) = (None, false);
        self.packets.clear();
    }
}

/// Reading of a vision sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct VisionReading {
    /// True if the sensor's script has triggered it.
    pub is_triggered: bool,
    /// Statistics of the picture ([`sincro_scene::camera::Image::statistics`]), then what the sensor's script has
    /// added.
    pub packets: Vec<Vec<f64>>,
}

/// Properties of a vision sensor that its script is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisionInput {
    /// Numbers of columns and rows.
    pub resolution: [usize; 2],
    /// Distances of the near and far planes `[m]`.
    pub clipping_planes: [f64; 2],
    /// Angle over the longer side `[rad]`, 0 of a parallel projection.
    pub view_angle: f64,
    /// Length of the longer side `[m]`, 0 of a perspective projection.
    pub view_size: f64,
}

/// Refuses packets of a script that are more than one reading has: their number and that of all their numbers.
///
/// # Errors
///
/// They are too many.
pub fn check_packets(n_packets: usize, n_numbers: usize) -> Result<(), ApiError> {
    if n_packets > MAX_PACKETS || n_numbers > MAX_PACKET_LEN {
        return Err(ApiError(format!(
            "a reading has up to {MAX_PACKETS} packets of {MAX_PACKET_LEN} numbers together"
        )));
    }
    Ok(())
}

impl SimApi<'_> {
    /// Adds operations to the work of this call.
    pub(super) fn add_operations(&mut self, n: u64) {
        self.n_operations = self.n_operations.saturating_add(n);
    }

    /// Work of image filters, octrees and point clouds since this was made, in instructions of a script that take about
    /// the same time.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.n_operations.div_ceil(OPERATIONS_PER_INSTRUCTION)
    }

    /// Reading of a vision sensor: its trigger, the statistics of its image as it was before filters, dimensionless
    /// from 0 to 1 (five minima, five maxima and five means of intensity, red, green, blue and depth), and the packets
    /// of its script. None if there is nothing to tell before its first handling.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no vision sensor.
    pub fn read_vision(&mut self, handle: Handle) -> Result<Option<VisionReading>, ApiError> {
        let filtered = self.registry.filtered(handle)?;
        let (statistics, is_triggered, packets) =
            (filtered.statistics, filtered.is_triggered, filtered.packets.clone());
        let Some(statistics) = statistics.map_or_else(|| self.vision_statistics(handle), |known| Ok(Some(known)))?
        else {
            return Ok(None);
        };
        Ok(Some(VisionReading { is_triggered, packets: [vec![statistics.to_vec()], packets].concat() }))
    }

    /// Prepares a vision sensor for its script, which may change its image: keeps the statistics. Returns what the
    /// script is told.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no vision sensor.
    pub fn begin_filters(&mut self, handle: Handle) -> Result<VisionInput, ApiError> {
        let statistics = self.vision_statistics(handle)?;
        let filtered = self.registry.filtered(handle)?;
        filtered.begin();
        filtered.statistics = statistics;
        let optics = self.registry.vision_sensor(handle)?.optics;
        Ok(VisionInput {
            resolution: optics.resolution,
            clipping_planes: [optics.near, optics.far],
            view_angle: optics.view_angle(),
            view_size: optics.view_size(),
        })
    }

    /// Sets what the script of a vision sensor has made of its image: the trigger and packets of numbers.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no vision sensor, or there are too many packets or numbers.
    pub fn set_vision_result(
        &mut self,
        handle: Handle,
        is_triggered: bool,
        packets: Vec<Vec<f64>>,
    ) -> Result<(), ApiError> {
        check_packets(packets.len(), packets.iter().map(Vec::len).sum())?;
        let filtered = self.registry.filtered(handle)?;
        (filtered.is_triggered, filtered.packets) = (is_triggered, packets);
        Ok(())
    }

    fn check_work_pixels(&mut self, handle: Handle, n: usize) -> Result<(), ApiError> {
        let own = self.registry.filtered(handle)?.images.as_ref().map_or(0, WorkImages::n_pixels);
        let all: usize = self
            .registry
            .all_filtered()
            .filter_map(|filtered| filtered.images.as_ref())
            .map(WorkImages::n_pixels)
            .sum();
        // two buffers may follow
        if all - own + 3 * n <= MAX_WORK_PIXELS {
            return Ok(());
        }
        Err(ApiError(format!(
            "work images and their buffers would have more than {MAX_WORK_PIXELS} pixels: give the sensors a lower \
             resolution, or release them with simVision.releaseBuffers"
        )))
    }
}

impl SimApi<'_> {
    /// Picture of a vision sensor as of its last handling, or its depths (0 near plane, 1 far plane).
    fn picture(&mut self, handle: Handle, is_of_depths: bool) -> Result<WorkImage, ApiError> {
        let size = self.registry.vision_sensor(handle)?.optics.resolution;
        let image = self.vision_image(handle)?;
        Ok(if is_of_depths {
            WorkImage::from_intensities(size, image.depths(image.whole(), false))
        } else {
            WorkImage::from_rgb(size, image.rgb())
        })
    }
}

impl Sensors for SimApi<'_> {
    fn sensor(&self, handle: i32) -> Result<Handle, ApiError> {
        super::functions::plain(self, handle)
    }

    fn load(&mut self, handle: Handle, is_of_depths: bool) -> Result<(), ApiError> {
        let size = self.registry.vision_sensor(handle)?.optics.resolution;
        self.check_work_pixels(handle, size[0] * size[1])?;
        let work = self.picture(handle, is_of_depths)?;
        let images = &mut self.registry.filtered(handle)?.images;
        match images {
            Some(images) if images.work.size() == size => images.work = work,
            _ => *images = Some(WorkImages { work, buffers: [None, None] }),
        }
        Ok(())
    }

    fn images(&mut self, handle: Handle) -> Result<&mut WorkImages, ApiError> {
        let size = self.registry.vision_sensor(handle)?.optics.resolution;
        let help = "call simVision.sensorImgToWorkImg or sensorDepthMapToWorkImg before";
        let images = self.registry.filtered(handle)?.images.as_mut();
        images
            .filter(|images| images.work.size() == size)
            .ok_or_else(|| ApiError(format!("there is no work image: {help}")))
    }

    fn release(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.registry.filtered(handle)?.images = None;
        Ok(())
    }

    fn store(&mut self, handle: Handle) -> Result<(), ApiError> {
        let work = self.images(handle)?.work.clone();
        self.show(handle, &work)
    }

    fn take(&mut self, handle: Handle, is_of_depths: bool) -> Result<WorkImage, ApiError> {
        self.handle_vision(Handled::One(handle))?;
        self.picture(handle, is_of_depths)
    }

    fn size(&self, handle: Handle) -> Result<[usize; 2], ApiError> {
        Ok(self.registry.vision_sensor(handle)?.optics.resolution)
    }

    fn show(&mut self, handle: Handle, image: &WorkImage) -> Result<(), ApiError> {
        let whole = self.vision_image(handle)?.whole();
        self.write_vision(handle, whole, Layer { is_grey: false, cut_off: None }, &image.rgb())
    }

    fn lens(&self, handle: Handle) -> Result<DepthLens, ApiError> {
        let optics = self.registry.vision_sensor(handle)?.optics;
        let (height, [columns, rows]) = (optics.half_height(), optics.resolution);
        let half = [height * columns as f64 / rows as f64, height];
        let is_perspective = matches!(optics.lens, Lens::Perspective(_));
        Ok(DepthLens { near: optics.near, far: optics.far, half, is_perspective })
    }

    fn in_world(&mut self, handle: Handle, point: [f64; 3]) -> Result<[f64; 3], ApiError> {
        Ok(self.pose(handle, Reference::World)?.point(Vec3(point)).0)
    }

    fn spend(&mut self, operations: u64) {
        self.add_operations(operations);
    }
}
