//! Random numbers that are the same in every run.

/// Uniform numbers in (0, 1) from a linear congruential generator.
pub fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut draw = Draw(seed);
    move || draw.unit()
}

/// Random parameters of scenes, from the same generator.
#[derive(Clone, Debug)]
pub struct Draw(pub u64);

impl Draw {
    /// Number in (0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Number between powers of ten, of any magnitude alike.
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.between(low, high))
    }

    /// One of a list.
    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[((self.unit() * of.len() as f64) as usize).min(of.len() - 1)]
    }
}
