//! Images whose results can be told by hand.

use sincro_vision::{ColorSpace, DepthLens, Sampling, WorkImage, gaussian};

/// White where the picture has `#`, its first line at the top.
fn drawn(lines: &[&str]) -> WorkImage {
    let intensities = lines.iter().rev().flat_map(|line| line.chars().map(|c| if c == '#' { 1.0 } else { 0.0 }));
    WorkImage::from_intensities([lines[0].len(), lines.len()], intensities)
}

fn lines(image: &WorkImage) -> Vec<String> {
    let row = |row: &[[f64; 3]]| row.iter().map(|pixel| if pixel[0] > 0.5 { '#' } else { '.' }).collect();
    image.pixels().chunks(image.size()[0]).rev().map(row).collect()
}

#[test]
fn bytes_come_back() {
    let bytes: Vec<u8> = (0..48).map(|k| 5 * k).collect();
    assert_eq!(WorkImage::from_rgb([4, 4], &bytes).rgb(), bytes);
}

#[test]
fn pixels_that_touch_by_a_corner_are_one_blob() {
    let mut image = drawn(&["##....", "##...#", "..#..#", ".....#"]);
    let blobs = image.blobs(0.5, 0.0);
    // numbered from the bottom left
    assert_eq!(blobs.len(), 2);
    assert_eq!(blobs.iter().map(|blob| blob.size * 24.0).collect::<Vec<_>>(), [3.0, 5.0]);
    let column = &blobs[0];
    assert!((column.center[0] - 5.5 / 6.0).abs() < 1e-12 && (column.center[1] - 1.5 / 4.0).abs() < 1e-12, "{column:?}");
    assert!(column.extent[0].abs() < 1e-12 && (column.extent[1] - 2.0 / 4.0).abs() < 1e-12, "{column:?}");
}

#[test]
fn components_that_meet_late_are_one_blob() {
    // from the bottom two arms, joined at the top
    let mut image = drawn(&["#####", "#...#", "#.#.#"]);
    assert_eq!(image.blobs(0.5, 0.0).iter().map(|blob| blob.size * 15.0).collect::<Vec<_>>(), [9.0, 1.0]);
}

#[test]
fn small_blobs_are_removed() {
    let mut image = drawn(&["#...", "..##", "..##"]);
    assert_eq!(image.blobs(0.5, 0.1).len(), 1);
    assert_eq!(lines(&image), ["....", "..##", "..##"]);
}

#[test]
fn an_oblique_bar_has_its_angle_and_sides() {
    let mut image = WorkImage::black([100, 100]);
    for k in -3..=3 {
        // 45°, 40 pixels to the right and up
        let y = 30.0 + f64::from(k);
        image.draw_line([30.0, y], [70.0, y + 40.0], [1.0; 3]);
    }
    let blob = image.blobs(0.5, 0.01)[0];
    let quarter = std::f64::consts::FRAC_PI_4;
    assert!((blob.angle.abs() - quarter).abs() < 0.02, "{blob:?}");
    assert!((blob.center[0] - 0.505).abs() < 0.01 && (blob.center[1] - 0.505).abs() < 0.01, "{blob:?}");
    let (long, short) = (blob.extent[0].max(blob.extent[1]), blob.extent[0].min(blob.extent[1]));
    assert!((long - 0.60).abs() < 0.03 && (short - 0.042).abs() < 0.02, "{blob:?}");
}

#[test]
fn blobs_get_colors_and_their_rectangles_are_drawn() {
    let mut image = drawn(&["#...", "....", "..##"]);
    let blobs = image.colored_blobs(0.5, 0.0);
    assert_eq!((image.pixels()[2], image.pixels()[8]), ([0.8, 0.0, 0.0], [0.0, 0.8, 0.0]));
    image.draw_blob(&blobs[0], [0.0, 0.0, 1.0]);
    assert_eq!(image.pixels()[2], [0.0, 0.0, 1.0]);
}

#[test]
fn a_selection_parts_the_image() {
    let bytes = [255, 0, 0, 0, 255, 0, 230, 10, 10, 0, 0, 255];
    let whole = WorkImage::from_rgb([4, 1], &bytes);
    let mut red = whole.clone();
    let rest = red.select_color([1.0, 0.0, 0.0], [0.15; 3], ColorSpace::Rgb, true);
    assert_eq!(red.rgb(), [255, 0, 0, 0, 0, 0, 230, 10, 10, 0, 0, 0]);
    assert_eq!(rest.rgb(), [0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 255]);
    let mut others = whole.clone();
    let removed = others.select_color([1.0, 0.0, 0.0], [0.15; 3], ColorSpace::Rgb, false);
    assert_eq!((others.rgb(), removed.rgb()), (rest.rgb(), red.rgb()));
    // hues a little below and above red, with a nominal hue of 0 and of 1
    for hue in [0.0, 1.0] {
        let mut image = WorkImage::from_rgb([3, 1], &[255, 20, 0, 255, 0, 20, 0, 255, 0]);
        image.select_color([hue, 1.0, 0.5], [0.05, 0.2, 0.2], ColorSpace::Hsl, true);
        assert_eq!(image.rgb(), [255, 20, 0, 255, 0, 20, 0, 0, 0], "{hue}");
    }
}

#[test]
fn near_colors_become_one() {
    let mut image = WorkImage::from_rgb([4, 1], &[100, 100, 100, 110, 100, 100, 200, 0, 0, 101, 101, 101]);
    assert!(image.segment_colors(0.1, 10).is_complete);
    assert_eq!(image.rgb(), [100, 100, 100, 100, 100, 100, 200, 0, 0, 100, 100, 100]);
    let before = image.clone();
    assert!(!image.segment_colors(0.0, 1).is_complete, "more than one color");
    assert_eq!(image, before);
}

#[test]
fn moments_tell_where_a_bar_is_and_how_it_lies() {
    let mut image = drawn(&["....", "####", "....", "...."]);
    let moments = image.binarize(0.5);
    assert_eq!((moments.proportion, moments.center), (0.25, [1.5 / 4.0, 2.0 / 4.0]));
    assert_eq!((moments.angle, moments.roundness), (0.0, 0.0));
    let mut upright = drawn(&[".#..", ".#..", ".#..", "...."]);
    assert!((upright.binarize(0.5).angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    let mut square = drawn(&["##", "##"]);
    assert_eq!(square.binarize(0.5).roundness, 1.0);
    assert_eq!(WorkImage::black([4, 2]).binarize(0.5).center, [0.125, 0.25]);
}

#[test]
fn edges_are_where_intensities_differ() {
    let mut image = drawn(&["......", "......", "...###", "...###", "...###", "......", "......"]);
    image.detect_edges(0.2);
    assert_eq!(lines(&image)[1..6], ["......", "...###", "...#.#", "...###", "......"]);
}

#[test]
fn a_blur_keeps_an_even_image() {
    for side in [3, 5] {
        let kernel = gaussian(side);
        assert!((kernel.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let mut image = WorkImage::black([7, 5]);
        image.fill([0.25, 0.5, 0.75]);
        image.convolve(&kernel);
        let middle = image.pixels()[17];
        assert!((0..3).all(|c| (middle[c] - [0.25, 0.5, 0.75][c]).abs() < 1e-12), "{middle:?}");
    }
    let mut image = drawn(&["...", ".#.", "..."]);
    image.sharpen();
    assert_eq!(lines(&image), ["...", ".#.", "..."]);
}

#[test]
fn images_are_flipped_shifted_and_cut() {
    let image = drawn(&["##..", "#...", "...."]);
    let mut other = image.clone();
    other.flip_horizontally();
    assert_eq!(lines(&other), ["..##", "...#", "...."]);
    other.flip_vertically();
    assert_eq!(lines(&other), ["....", "...#", "..##"]);
    let mut other = image.clone();
    other.shift([0.5, -0.34], false);
    assert_eq!(lines(&other), ["....", "..##", "..#."]);
    let mut other = image.clone();
    other.shift([-0.25, 0.0], true);
    assert_eq!(lines(&other), ["#..#", "...#", "...."]);
    let mut other = image.clone();
    let removed = other.cut_rectangle([0.5, 1.0]);
    assert_eq!(
        (lines(&other), lines(&removed)[0].as_str()),
        (vec![".#..".to_owned(), "....".into(), "....".into()], "#...")
    );
    let mut round = WorkImage::black([4, 4]);
    round.fill([1.0; 3]);
    round.cut_circle(1.0);
    assert_eq!(lines(&round), [".##.", "####", "####", ".##."]);
}

#[test]
fn images_are_added_and_scaled() {
    let half = WorkImage::from_intensities([2, 1], [0.25, 0.75]);
    let mut sum = half.clone();
    sum.add(&half);
    assert_eq!(sum.pixels(), [[0.5; 3], [1.0; 3]]);
    sum.subtract(&half);
    sum.multiply(&half);
    assert_eq!(sum.pixels(), [[0.0625; 3], [0.1875; 3]]);
    sum.normalize();
    assert_eq!(sum.pixels(), [[0.0; 3], [1.0; 3]]);
    sum.scale_intensity(0.5, 1.0, true);
    assert_eq!(sum.pixels(), [[0.5; 3], [1.0; 3]]);
    sum.scale_and_offset([0.0; 3], [0.5; 3], [0.25; 3], ColorSpace::Rgb);
    assert_eq!(sum.pixels(), [[0.5; 3], [0.75; 3]]);
}

#[test]
fn changes_are_told_once() {
    let mut before = WorkImage::black([2, 1]);
    let now = WorkImage::from_intensities([2, 1], [0.5, 0.0]);
    let mut image = now.clone();
    let changed = image.changed_pixels(&mut before, 0.1);
    assert_eq!((changed.len(), changed[0].is_brighter, changed[0].at), (1, true, [0, 0]));
    assert_eq!(image.pixels(), [[1.0; 3], [0.5; 3]]);
    assert!(now.clone().changed_pixels(&mut before, 0.1).is_empty());
    assert!(!WorkImage::black([2, 1]).changed_pixels(&mut before, 0.1)[0].is_brighter);
}

#[test]
fn points_lie_on_a_wall() {
    // a wall 2 m before the sensor, 90° wide and high
    let lens = DepthLens { near: 1.0, far: 5.0, half: [1.0, 1.0], is_perspective: true };
    let wall = WorkImage::from_intensities([64, 64], std::iter::repeat_n(0.25, 64 * 64));
    let points = wall.points(&lens, [3, 3], Sampling::Grid);
    let expected = [[-2.0, -2.0], [0.0, -2.0], [2.0, -2.0], [-2.0, 0.0], [0.0, 0.0]];
    for (got, want) in points.iter().zip(expected) {
        assert_eq!((got.0[0], got.0[1], got.0[2]), (want[0], want[1], 2.0));
    }
    assert_eq!(points[4].0[3], 2.0);
    let angles = wall.points(&lens, [5, 1], Sampling::Angles);
    let tangent = std::f64::consts::SQRT_2 - 1.0;
    assert!((angles[1].0[0] + 2.0 * tangent).abs() < 1e-12 && angles[1].0[1] == 0.0, "{:?}", angles[1]);
    let scan = wall.points(&lens, [1, 3], Sampling::Scan(1.0));
    assert!(
        (scan[2].0[1] - 2.0 * sincro_math::elementary::tan(0.5).0).abs() < 1e-12 && scan[2].0[0] == 0.0,
        "{:?}",
        scan[2]
    );
    // nothing is farther than the far distance
    let far = WorkImage::from_intensities([4, 4], std::iter::repeat_n(1.0, 16));
    assert!(far.points(&lens, [2, 2], Sampling::Grid).iter().all(|point| (point.0[3] - 5.0).abs() < 1e-12));
    let parallel = DepthLens { is_perspective: false, ..lens };
    assert_eq!(wall.points(&parallel, [2, 1], Sampling::Angles)[1].0, [1.0, 0.0, 2.0, 2.0]);
    // x is to the left: the right column is read for the least x
    let half = WorkImage::from_intensities([2, 1], [0.0, 1.0]);
    assert_eq!(half.points(&parallel, [2, 1], Sampling::Grid)[0].0[2], 5.0);
}
