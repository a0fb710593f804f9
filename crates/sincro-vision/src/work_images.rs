//! Work image of a sensor with its two buffers.

use crate::WorkImage;

/// Work image of a sensor with its two buffers.
#[derive(Clone, Debug)]
pub struct WorkImages {
    /// Image that filters work on.
    pub work: WorkImage,
    /// Buffers, empty until something is put into them.
    pub buffers: [Option<WorkImage>; 2],
}

impl WorkImages {
    /// Number of pixels of the work image and its buffers.
    #[must_use]
    pub fn n_pixels(&self) -> usize {
        let [columns, rows] = self.work.size();
        columns * rows * (1 + self.buffers.iter().flatten().count())
    }

    /// Buffer `k` (0 or 1) of the size of the work image, black before something was put into it.
    pub fn buffer(&mut self, k: usize) -> &mut WorkImage {
        let size = self.work.size();
        self.buffers[k].get_or_insert_with(|| WorkImage::black(size))
    }
}
