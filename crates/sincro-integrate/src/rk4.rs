//! The classical Runge–Kutta method of order 4. Source: key `hairer1993`, section II.1, table 1.2.

use sincro_math::Real;

use crate::{FixedStep, System, combine};

/// Classical Runge–Kutta method of order 4 with a fixed step, and its working memory: for smooth systems.
#[derive(Clone, Debug)]
pub struct Rk4<R> {
    k: [Vec<R>; 4],
    stage: Vec<R>,
}

impl<R: Real> Rk4<R> {
    /// Creates the method for systems with `dim` unknowns ([`System::dim`]).
    #[must_use]
    pub fn new(dim: usize) -> Self {
        let zero = vec![R::zero(); dim];
        Self { k: [zero.clone(), zero.clone(), zero.clone(), zero.clone()], stage: zero }
    }
}

impl<R: Real> FixedStep<R> for Rk4<R> {
    #[inline(always)]
    fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &mut [R]) {
        let [k1, k2, k3, k4] = &mut self.k;
        // one call in a loop: the right-hand side is large and would be compiled four times
        for stage in 0..4 {
            let (c, from, into): (f64, Option<&Vec<R>>, &mut Vec<R>) = match stage {
                0 => (0.0, None, &mut *k1),
                1 => (0.5, Some(&*k1), &mut *k2),
                2 => (0.5, Some(&*k2), &mut *k3),
                _ => (1.0, Some(&*k3), &mut *k4),
            };
            match from {
                None => self.stage.copy_from_slice(y),
                Some(k) => combine(&mut self.stage, y, c * h, &[(1.0, k)]),
            }
            system.slope(t + c * h, &self.stage, into);
        }
        let sixth = R::splat(h / 6.0);
        let n = y.len();
        let (k1, k2, k3, k4) = (&k1[..n], &k2[..n], &k3[..n], &k4[..n]);
        for i in 0..n {
            y[i] += sixth * ((k1[i] + k4[i]) + R::splat(2.0) * (k2[i] + k3[i]));
        }
        system.rechart(y);
    }
}
