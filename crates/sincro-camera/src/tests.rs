//! Pictures of surfaces whose pictures are known.

use std::sync::Arc;

use sincro_geometry::Shape;
use sincro_geometry::Surface;
use sincro_geometry::spatial::{Mat3, Pose, Vec3};
use sincro_geometry::{Geometry, Ray};

use crate::*;

const SQUARE: Optics = Optics { resolution: [240, 180], near: 0.1, far: 50.0, lens: Lens::Perspective(0.9) };

/// A piece that is kept.
#[derive(Clone)]
struct Piece {
    geometry: Arc<Geometry>,
    color: [u8; 3],
    pose: Pose<f64>,
}

impl Piece {
    fn visible(&self) -> VisiblePiece<'_> {
        VisiblePiece { geometry: &self.geometry, color: self.color, pose: self.pose }
    }
}

fn piece(surface: Surface, pose: Pose<f64>, color: [u8; 3]) -> Piece {
    Piece { geometry: Arc::new(Geometry::new(surface).unwrap()), color, pose }
}

fn at(x: f64, y: f64, z: f64) -> Pose<f64> {
    Pose::translation(Vec3([x, y, z]))
}

fn ball(radius: f64) -> Surface {
    Surface::Solid(Shape::Sphere { radius })
}

fn block(size: [f64; 3]) -> Surface {
    Surface::Solid(Shape::Cuboid { size })
}

/// A turned frame, its columns orthonormal.
fn turned() -> Mat3<f64> {
    let z = Vec3([0.3, 0.8, -0.5]);
    let z = z.scale(1.0 / z.norm());
    let x = Vec3([0.0, 0.2, 1.0]).cross(z);
    let x = x.scale(1.0 / x.norm());
    let y = z.cross(x);
    Mat3(std::array::from_fn(|row| [x[row], y[row], z[row]]))
}

/// Axes of a camera that looks along `ahead`, the world's z up.
fn facing(ahead: [f64; 3]) -> Mat3<f64> {
    let z = Vec3(ahead).scale(1.0 / Vec3(ahead).norm());
    let x = Vec3([0.0, 0.0, 1.0]).cross(z);
    let x = x.scale(1.0 / x.norm());
    let y = z.cross(x);
    Mat3(std::array::from_fn(|row| [x[row], y[row], z[row]]))
}

/// The picture from a camera's pose.
fn picture(pieces: Vec<Piece>, x_wc: &Pose<f64>, optics: &Optics) -> Image {
    let mut image = Image::new(optics);
    Renderer::new().draw(pieces.iter().map(Piece::visible), (x_wc, optics), BACKGROUND, &mut image);
    image
}

/// The ray of each pixel in the camera's axes (x left, y up, z ahead), z = 1.
fn rays(optics: &Optics) -> impl Iterator<Item = Vec3<f64>> {
    let ([w, h], pixel) = (optics.resolution, optics.pixel());
    let middle = move |k: usize, n: usize| (k as f64 + 0.5 - 0.5 * n as f64) * pixel;
    (0..w * h).map(move |k| Vec3([-middle(k % w, w), middle(k / w, h), 1.0]))
}

#[test]
fn a_ball_is_seen_where_its_cone_of_tangents_is_and_as_far_as_it_is() {
    // off the axis its outline is an ellipse: the rays within asin(r/|c|) of the way to its centre
    let (center, radius) = (Vec3([0.4, -0.25, 3.0]), 0.7);
    let pose = Pose { rot: turned(), pos: Vec3([1.0, -2.0, 0.5]) };
    let image =
        picture(vec![piece(ball(radius), Pose::translation(pose.point(center)), [200, 30, 30])], &pose, &SQUARE);
    let (mut inside, mut seen) = (0, 0);
    for (k, ray) in rays(&SQUARE).enumerate() {
        let along = ray.dot(center);
        let is_inside = along * along > ray.dot(ray) * (center.dot(center) - radius * radius);
        inside += usize::from(is_inside);
        seen += usize::from(image.pieces()[k] == 0);
        assert_eq!(image.pieces()[k] == 0, is_inside, "pixel {k}");
        if is_inside {
            // |t d − c|² = r², the smaller root; depth is t, for the ray has z = 1
            let (a, b, c) = (ray.dot(ray), along, center.dot(center) - radius * radius);
            let t = c / (b + (b * b - a * c).sqrt());
            assert!((image.depth()[k] - t).abs() < 1e-12, "pixel {k}: {} {t}", image.depth()[k]);
        } else {
            assert_eq!(image.depth()[k], SQUARE.far);
            assert_eq!(image.rgb()[3 * k..3 * k + 3], BACKGROUND);
        }
    }
    // the ellipse has semi-axes sin φ cos φ/(cos²θ − sin²φ) and sin φ/√(cos²θ − sin²φ), φ half its cone's angle, θ that
    // to its axis
    let (square, gap) = (center.dot(center) - radius * radius, center[2] * center[2] - radius * radius);
    let area = std::f64::consts::PI * radius * radius * square.sqrt() / (gap * gap.sqrt());
    let pixels = area / (SQUARE.pixel() * SQUARE.pixel());
    assert_eq!(inside, seen);
    // a pixel on the outline is in or out: 0.29 of a pixel each, about 2 √(π A) of them, four standard deviations
    let most = 4.0 * 0.29 * (2.0 * (std::f64::consts::PI * pixels).sqrt()).sqrt();
    assert!((seen as f64 - pixels).abs() < most, "{seen} pixels, an ellipse of {pixels}, {most}");
}

#[test]
fn a_plane_is_as_far_as_its_equation_says() {
    let pose = Pose { rot: facing([0.2, 1.0, -0.1]), pos: Vec3([0.0, 0.0, 2.0]) };
    let image = picture(vec![piece(Surface::HalfSpace, Pose::identity(), [128; 3])], &pose, &SQUARE);
    let mut seen = 0;
    for (k, ray) in rays(&SQUARE).enumerate() {
        let down = pose.rot.mul_vec(ray)[2];
        let t = -2.0 / down;
        let is_seen = down < 0.0 && t < SQUARE.far;
        assert_eq!(image.pieces()[k] == 0, is_seen, "pixel {k}");
        if is_seen {
            seen += 1;
            assert!((image.depth()[k] - t).abs() < 1e-12 * t.max(1.0));
        }
    }
    assert!(seen > 10_000 && seen < 240 * 180, "{seen}: a horizon is in the picture");
}

#[test]
fn what_is_nearer_hides_what_is_behind_in_whatever_order_they_are_given() {
    let near = || piece(block([1.0, 1.0, 0.2]), at(0.0, 0.0, 2.0), [255, 0, 0]);
    let far = || piece(block([4.0, 4.0, 0.2]), at(0.0, 0.0, 5.0), [0, 255, 0]);
    let one = picture(vec![near(), far()], &Pose::identity(), &SQUARE);
    let two = picture(vec![far(), near()], &Pose::identity(), &SQUARE);
    assert_eq!(one.depth(), two.depth());
    assert_eq!(one.rgb(), two.rgb());
    let middle = 90 * 240 + 120;
    assert!((one.depth()[middle] - 1.9).abs() < 1e-12);
    // from 1.9 m a metre takes up this many pixels, the block behind reaches beyond it on all sides
    let width = (1.0 / 1.9 / SQUARE.pixel()).round() as usize;
    let row = &one.pieces()[90 * 240..91 * 240];
    assert_eq!(row.iter().filter(|k| **k == 0).count().abs_diff(width), 0);
    assert!(row.iter().filter(|k| **k == 1).count() > 40);
}

#[test]
fn x_points_to_the_left_and_rows_come_from_the_bottom() {
    let boxes = [([1.0, 0.0], [255, 0, 0]), ([-1.0, 0.0], [0, 255, 0]), ([0.0, 1.0], [0, 0, 255])];
    let pieces = boxes.map(|([x, y], color)| piece(block([0.3; 3]), at(x, y, 4.0), color));
    for lens in [Lens::Perspective(0.9), Lens::Orthographic(3.0)] {
        let optics = Optics { lens, ..SQUARE };
        let image = picture(pieces.to_vec(), &Pose::identity(), &optics);
        let middle = |k: u32| {
            let own = image.pieces().iter().enumerate().filter(|(_, piece)| **piece == k);
            let (mut sum, mut n) = ([0.0; 2], 0.0);
            for (place, _) in own {
                (sum[0], sum[1], n) = (sum[0] + (place % 240) as f64, sum[1] + (place / 240) as f64, n + 1.0);
            }
            sum.map(|x| x / n)
        };
        let [left, right, top] = [0, 1, 2].map(middle);
        assert!(left[0] < 110.0 && (left[1] - 89.5).abs() < 1e-9, "+x is left: {left:?}");
        assert!(right[0] > 130.0 && (right[1] - 89.5).abs() < 1e-9, "−x is right: {right:?}");
        assert!(top[1] > 100.0 && (top[0] - 119.5).abs() < 1e-9, "+y is up, in a later row: {top:?}");
    }
}

#[test]
fn an_orthographic_picture_shows_sizes_as_they_are() {
    let optics = Optics { lens: Lens::Orthographic(2.0), resolution: [300, 200], near: 0.1, far: 20.0 };
    let pieces = vec![piece(ball(0.5), at(0.3, -0.2, 4.0), [9, 9, 9]), piece(ball(0.5), at(-0.9, 0.3, 15.0), [9; 3])];
    let image = picture(pieces, &Pose::identity(), &optics);
    for (k, ray) in rays(&optics).enumerate() {
        let inside = |x: f64, y: f64| 0.25 - (ray[0] - x) * (ray[0] - x) - (ray[1] - y) * (ray[1] - y);
        let (first, second) = (inside(0.3, -0.2), inside(-0.9, 0.3));
        let depth = if first > 0.0 {
            4.0 - first.sqrt()
        } else if second > 0.0 {
            15.0 - second.sqrt()
        } else {
            20.0
        };
        assert!((image.depth()[k] - depth).abs() < 1e-12, "pixel {k}");
    }
}

#[test]
fn the_rectangle_of_a_piece_holds_all_of_it() {
    // every shape near, far, beside, across the near plane, about the camera: the same picture as without rectangles
    let shapes = [
        ball(0.6),
        block([0.2, 1.4, 0.6]),
        Surface::Solid(Shape::Capsule { radius: 0.1, length: 1.5 }),
        Surface::Solid(Shape::Cylinder { radius: 0.5, length: 0.3 }),
        Surface::Solid(Shape::Cone { radius: 0.4, length: 1.0 }),
        Surface::Hull(vec![[0.0; 3], [0.9, 0.0, 0.1], [0.0, 0.7, 0.0], [0.1, 0.1, 1.1]]),
        Surface::HeightField { columns: 3, heights: vec![0.0, 0.2, -0.1, 0.4, 0.3, 0.0], size: [1.2, 0.8] },
    ];
    let places =
        [[0.0, 0.0, 3.0], [0.9, 0.3, 1.0], [0.1, 0.2, 0.3], [-0.4, 0.1, -0.1], [5.0, 0.0, 1.0], [0.0, 1.2, 2.0]];
    let mut seen = 0;
    for lens in [Lens::Perspective(1.1), Lens::Orthographic(1.5)] {
        let optics = Optics { lens, resolution: [40, 30], near: 0.2, far: 6.0 };
        for surface in &shapes {
            for [x, y, z] in places {
                let pose = Pose { rot: turned(), pos: Vec3([x, y, z]) };
                let piece = piece(surface.clone(), pose, [0; 3]);
                let image = picture(vec![piece.clone()], &Pose::identity(), &optics);
                let meets = |ray: &Ray| {
                    let (origin, direction) = (ray.origin - pose.pos, ray.direction);
                    let [origin, direction] = [origin, direction].map(|v| pose.rot.tr_mul_vec(v));
                    piece.geometry.cast_ray(&Ray { origin, direction }, 100.0)
                };
                for (k, ray) in rays(&optics).enumerate() {
                    let (origin, way) = match lens {
                        Lens::Perspective(_) => (ray.scale(0.2), ray.scale(1.0 / ray.norm())),
                        Lens::Orthographic(_) => (Vec3([ray[0], ray[1], 0.2]), Vec3([0.0, 0.0, 1.0])),
                    };
                    let ray = Ray { origin, direction: way };
                    let hit = meets(&ray).filter(|hit| ray.at(hit.distance)[2] < 5.999_999);
                    // where a camera is inside a body, or the near plane cuts it, both see through it
                    let eye = Ray { origin: Vec3::zero(), direction: way };
                    let is_about = matches!(lens, Lens::Perspective(_)) && meets(&eye).is_none();
                    if is_about {
                        continue;
                    }
                    let is_seen = image.pieces()[k] == 0;
                    seen += usize::from(is_seen);
                    assert_eq!(is_seen, hit.is_some(), "{surface:?} at {x} {y} {z}, {lens:?}, pixel {k}");
                }
            }
        }
    }
    assert!(seen > 2_000, "{seen}");
}

#[test]
fn a_surface_that_faces_the_sun_has_the_color_that_the_sum_of_light_gives() {
    // from above: normal z, n·sun = 1.6/√(0.25 + 0.49 + 2.56), the sky half and half
    let down = Mat3([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
    let optics = Optics { resolution: [4, 4], ..SQUARE };
    let gray = piece(Surface::HalfSpace, Pose::identity(), [0x80, 0x80, 0x80]);
    let image = picture(vec![gray], &Pose { rot: down, pos: Vec3([0.0, 0.0, 2.0]) }, &optics);
    let sun = 2.1 * 1.6 / 3.3_f64.sqrt();
    let red = |linear: f64| 255.0 * (1.055 * sincro_math::elementary::pow(linear, 1.0 / 2.4).0 - 0.055);
    // 0x80 is 0.2159 in linear measure, the grey of the sky's other side 0.2664
    let expected = red(0.215_861 * (sun + 1.5 * (0.5 * 1.0 + 0.5 * 0.266_356)) / std::f64::consts::PI);
    assert!((f64::from(image.rgb()[0]) - expected).abs() < 1.0, "{} {expected}", image.rgb()[0]);
    // three channels of a grey surface differ only by the tint of the sky
    assert!(image.rgb()[..3].iter().all(|x| x.abs_diff(image.rgb()[0]) < 4));
}

#[test]
fn parts_and_statistics_are_those_of_the_pixels() {
    let near = piece(block([1.0, 1.0, 0.2]), at(0.0, 0.0, 2.0), [255, 0, 0]);
    let optics = Optics { resolution: [8, 6], near: 0.5, far: 4.5, lens: Lens::Perspective(0.9) };
    let image = picture(vec![near], &Pose::identity(), &optics);
    let part = Part { position: [2, 1], size: [3, 2] };
    let bytes = image.bytes(part, Layer::RGB);
    assert_eq!(bytes.len(), 18);
    for (n, k) in [8 + 2, 8 + 3, 8 + 4, 16 + 2, 16 + 3, 16 + 4].into_iter().enumerate() {
        assert_eq!(bytes[3 * n..3 * n + 3], image.rgb()[3 * k..3 * k + 3]);
    }
    let masked = image.bytes(image.whole(), Layer { is_grey: true, cut_off: Some(0.5) });
    for (k, pixel) in masked.chunks(2).enumerate() {
        assert_eq!(pixel[1], if image.pieces()[k] == 0 { 255 } else { 0 });
    }
    let share = (1.9 - 0.5) / 4.0;
    let depths: Vec<f64> = image.depths(image.whole(), false).collect();
    let stats = image.statistics();
    let seen = image.pieces().iter().filter(|k| **k == 0).count() as f64 / 48.0;
    assert!((stats[4] - share).abs() < 1e-12 && stats[9] == 1.0, "{stats:?}");
    assert!((stats[14] - (share * seen + 1.0 - seen)).abs() < 1e-12);
    assert!((depths.iter().sum::<f64>() / 48.0 - stats[14]).abs() < 1e-12);
    let green: f64 = image.rgb().iter().skip(1).step_by(3).map(|x| f64::from(*x)).sum();
    assert!((stats[12] - green / 48.0 / 255.0).abs() < 1e-12);
    assert_eq!((stats[2], stats[7]), (0.0, f64::from(BACKGROUND[1]) / 255.0));
    for wrong in [[[6, 0], [3, 1]], [[0, 5], [1, 2]], [[0, 0], [0, 3]], [[usize::MAX, 0], [2, 1]]] {
        assert!(!image.has(&Part { position: wrong[0], size: wrong[1] }), "{wrong:?}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let wrong = |change: fn(&mut Optics)| {
        let mut optics = SQUARE;
        change(&mut optics);
        optics.check().unwrap_err()
    };
    assert_eq!(SQUARE.check(), Ok(()));
    assert_eq!(wrong(|o| o.resolution = [0, 10]).key, "resolution");
    assert_eq!(wrong(|o| o.resolution = [100_000, 100_000]).key, "resolution");
    assert_eq!(wrong(|o| o.resolution = [4096, 4096]).key, "resolution");
    assert_eq!(wrong(|o| o.near = 0.0).key, "near");
    assert_eq!(wrong(|o| o.near = f64::NAN).key, "near");
    assert_eq!(wrong(|o| o.far = 0.1).key, "far");
    assert_eq!(wrong(|o| o.far = f64::INFINITY).key, "far");
    let all = Optics { resolution: [0, 1], near: -1.0, far: -2.0, lens: Lens::Orthographic(0.0) }.invalid_settings();
    let keys: Vec<&str> = all.iter().map(|wrong| wrong.key).collect();
    assert_eq!(keys, ["resolution", "near", "far", "orthographic_height"]);
    assert_eq!(wrong(|o| o.lens = Lens::Perspective(f64::NAN)).key, "field_of_view_deg");
    assert_eq!(wrong(|o| o.lens = Lens::Orthographic(-1.0)).key, "orthographic_height");
}

#[test]
fn angles_and_sizes_of_the_longer_side_come_back() {
    for resolution in [[320, 200], [200, 320], [64, 64]] {
        let optics = Optics { resolution, ..SQUARE };
        let ratio = resolution[0] as f64 / resolution[1] as f64;
        let again = optics.with_view_angle(optics.view_angle());
        assert!((again.half_height() - optics.half_height()).abs() < 1e-12);
        let expected =
            if ratio > 1.0 { 2.0 * sincro_math::elementary::atan(optics.half_height() * ratio).0 } else { 0.9 };
        assert!((optics.view_angle() - expected).abs() < 1e-12);
        let flat = optics.with_view_size(3.0);
        assert!((flat.view_size() - 3.0).abs() < 1e-12);
        assert!((flat.half_height() - 1.5 / ratio.max(1.0)).abs() < 1e-12);
    }
}

#[test]
fn a_picture_of_the_same_size_takes_no_new_memory() {
    let pieces = [piece(ball(0.5), at(0.0, 0.0, 3.0), [9; 3]), piece(Surface::HalfSpace, at(0.0, 0.0, -1.0), [9; 3])];
    let (mut renderer, mut image) = (Renderer::new(), Image::new(&SQUARE));
    let mut draw = || {
        renderer.draw(pieces.iter().map(Piece::visible), (&Pose::identity(), &SQUARE), BACKGROUND, &mut image);
    };
    draw();
    assert_eq!(allocation_counter::measure(draw).count_total, 0);
}
