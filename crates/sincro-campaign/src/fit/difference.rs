//! Derivatives by differences: where a parameter enters a run, or only a number of its model.

/// Width of the wider difference, relative to the scale of a parameter; the narrower is half of it. With Richardson's
/// extrapolation the truncation is of the fourth power, 1e-12, and the rounding of a run at 1e-12 about 1e-9.
pub(super) const WIDTH: f64 = 1e-3;

/// Difference of second order for the derivative by an unknown: central, or one-sided where that would leave its
/// bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Difference {
    /// 0 for a central difference, 1 for one towards larger values, −1 for one towards smaller.
    pub side: f64,
    /// Unit of the widths.
    scale: f64,
}

impl Difference {
    /// The difference at a value; `bounds` as of [`Model::bounds`](super::Model::bounds).
    pub fn at(value: f64, (_, low, high, scale): (f64, f64, f64, f64)) -> Self {
        // the wider difference fits between the bounds to one side or the other
        let scale = scale.min((high - low) / (4.0 * WIDTH));
        let side = match scale * WIDTH {
            h if value - h >= low && value + h <= high => 0.0,
            h if value + 2.0 * h <= high => 1.0,
            _ => -1.0,
        };
        Self { side, scale }
    }

    /// Distances of its two points from the value.
    pub fn steps(self, width: f64) -> [f64; 2] {
        let h = width * self.scale;
        if self.side == 0.0 { [h, -h] } else { [self.side * h, 2.0 * self.side * h] }
    }

    /// Slope from a number at its two points and, if it is one-sided, at the value.
    pub fn slope(self, width: f64, first: f64, second: f64, middle: f64) -> f64 {
        let h = width * self.scale;
        if self.side == 0.0 {
            (first - second) / (2.0 * h)
        } else {
            (4.0 * first - second - 3.0 * middle) / (2.0 * h * self.side)
        }
    }

    /// Slopes of all predicted values; `middle` is empty for a central difference.
    pub fn slopes(self, width: f64, first: &[f64], second: &[f64], middle: &[f64]) -> Vec<f64> {
        let middle = |i: usize| middle.get(i).copied().unwrap_or(0.0);
        (0..first.len()).map(|i| self.slope(width, first[i], second[i], middle(i))).collect()
    }

    /// Richardson's extrapolation of a slope from [`WIDTH`] and half of it.
    pub fn extrapolated(wide: f64, narrow: f64) -> f64 {
        narrow + (narrow - wide) / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_stay_between_the_bounds_and_are_of_second_order() {
        let square = |x: f64| [x * x];
        for (value, low, high, side) in
            [(2.0, 0.0, 9.0, 0.0), (0.0, 0.0, 9.0, 1.0), (9.0, 0.0, 9.0, -1.0), (3.0, 3.0, 3.0 + 1e-6, 1.0)]
        {
            let difference = Difference::at(value, (value, low, high, 2.0));
            assert_eq!(difference.side, side, "{value}");
            let points = difference.steps(WIDTH).map(|step| value + step);
            assert!(points.iter().all(|x| (low..=high).contains(x)), "{points:?}");
            let slope = difference.slopes(WIDTH, &square(points[0]), &square(points[1]), &square(value))[0];
            assert!((slope - 2.0 * value).abs() < 1e-6, "{value}: {slope}");
        }
    }
}
