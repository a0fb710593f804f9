//! Thinning of a curve to what a screen can show, without losing a peak. Cost: linear in the points.
//!
//! The screen is cut into columns; of the points of a column only those that reach lowest and highest are kept, in
//! their order. A curve that runs back and forth in x (a path, a phase portrait) is cut by index instead, and
//! the leftmost and rightmost point of each piece are kept as well.

/// A position on the canvas `[px]`.
pub(super) type Point = (f64, f64);

/// Keeps the first and the last point and the extremes of each column; at most `2·columns + 2` points.
pub(super) fn decimate(points: &[Point], columns: usize) -> Vec<Point> {
    let columns = columns.max(2);
    if points.len() <= 2 * columns {
        return points.to_vec();
    }
    let runs_forward = points.windows(2).all(|pair| pair[0].0 <= pair[1].0);
    let mut kept = vec![0];
    if runs_forward {
        by_column(points, columns, &mut kept);
    } else {
        by_index(points, columns / 2, &mut kept);
    }
    kept.push(points.len() - 1);
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| points[index]).collect()
}

fn by_column(points: &[Point], columns: usize, kept: &mut Vec<usize>) {
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    let per_pixel = columns as f64 / (last - first).max(f64::MIN_POSITIVE);
    let column = |point: &Point| (((point.0 - first) * per_pixel) as usize).min(columns - 1);
    let mut start = 0;
    while start < points.len() {
        let here = column(&points[start]);
        let end = start + points[start..].partition_point(|point| column(point) <= here);
        keep_extremes(points, start..end, |point| point.1, kept);
        start = end;
    }
}

fn by_index(points: &[Point], pieces: usize, kept: &mut Vec<usize>) {
    for piece in 0..pieces {
        let range = piece * points.len() / pieces..(piece + 1) * points.len() / pieces;
        keep_extremes(points, range.clone(), |point| point.0, kept);
        keep_extremes(points, range, |point| point.1, kept);
    }
}

/// Adds the first index of the least and of the greatest coordinate in the range.
fn keep_extremes(points: &[Point], range: std::ops::Range<usize>, of: fn(&Point) -> f64, kept: &mut Vec<usize>) {
    let (mut low, mut high) = (range.start, range.start);
    for index in range {
        if of(&points[index]) < of(&points[low]) {
            low = index;
        }
        if of(&points[index]) > of(&points[high]) {
            high = index;
        }
    }
    kept.extend([low, high]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n: usize) -> Vec<Point> {
        (0..n).map(|i| (i as f64 * 0.01, ((i * 7919) % 1009) as f64)).collect()
    }

    #[test]
    fn a_short_curve_is_left_alone() {
        assert_eq!(decimate(&wave(100), 50), wave(100));
    }

    #[test]
    fn a_single_spike_survives() {
        let mut points: Vec<Point> = (0..100_000).map(|i| (i as f64, 0.0)).collect();
        points[73_511].1 = 5.0;
        points[73_512].1 = -5.0;
        let kept = decimate(&points, 300);
        assert!(kept.len() <= 602);
        assert!(kept.contains(&(73_511.0, 5.0)) && kept.contains(&(73_512.0, -5.0)));
    }

    #[test]
    fn ends_and_order_are_kept() {
        let points = wave(50_000);
        let kept = decimate(&points, 400);
        assert_eq!(kept.first(), points.first());
        assert_eq!(kept.last(), points.last());
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn a_path_keeps_its_bounding_box() {
        let points: Vec<Point> = wave(40_000).into_iter().map(|(x, y)| (y * (x % 3.0), y - x)).collect();
        let kept = decimate(&points, 500);
        let bounds = |of: fn(&Point) -> f64, points: &[Point]| {
            points.iter().map(of).fold((f64::MAX, f64::MIN), |(l, h), v| (v.min(l), v.max(h)))
        };
        assert!(kept.len() <= 1002);
        assert_eq!(bounds(|p| p.0, &kept), bounds(|p| p.0, &points));
        assert_eq!(bounds(|p| p.1, &kept), bounds(|p| p.1, &points));
    }

    #[test]
    fn points_above_one_another_do_not_divide_by_zero() {
        let points: Vec<Point> = (0..1000).map(|i| (3.0, i as f64)).collect();
        assert_eq!(decimate(&points, 10), vec![(3.0, 0.0), (3.0, 999.0)]);
    }
}
