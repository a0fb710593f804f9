//! Separating axes and face clipping: contact points of two convex polytopes.
//!
//! The direction of largest separation (or least penetration) of two polytopes is the normal of a face of one of them,
//! or perpendicular to an edge of each (separating axis theorem; key `gottschalk1996`). A face is chosen wherever an
//! edge pair is no better by more than a tolerance: two boxes that lie on each other have both, equal but for rounding,
//! and only the faces keep the boxes level. The opposing face of the other polytope (incident face) is clipped against
//! the side planes of the first one (reference face); the vertices that remain are the contact points.
//!
//! A point is a material point of the body whose face was clipped, over the plane of the other: exact for flat faces
//! that rest, tilt and slide.

use parry3d_f64::math::Vector;
use parry3d_f64::shape::ConvexPolyhedron;

use super::{Shape, Surface};
use crate::spatial::{Pose, Vec3};

/// Tolerance between the separations of two directions, and distance of points that are merged `[m]`.
const ALIKE: f64 = 1e-6;

/// Separation by which another kind of contact must be better to take the place of the former one `[m]`.
const HYSTERESIS: f64 = 2e-5;

/// Tolerance of points outside of an outline `[m]`.
const ON_OUTLINE: f64 = 1e-9;

/// Sine of the angle between two edges below which they are parallel.
const PARALLEL: f64 = 1e-6;

/// Sine of the angle between crossing edges, and cosine of that between their normal and a face's, of six degrees: with
/// less the face is taken where bodies have touched before.
const ALMOST_PARALLEL: f64 = 0.104_528_463;
const ALMOST_ALONG: f64 = 0.994_521_895;

/// Sine of the angle between two edges, or an edge and a side, below which their crossing stays where it is found: it
/// would move too fast.
const CUTS: f64 = 1e-2;

/// Sine of the angle between two edges of one polytope below which they count as one direction.
const ONE_DIRECTION: f64 = 1e-12;

/// Maximum number of pairs of edge directions that are looked at before pairs of edges: those of boxes and prisms with
/// few sides.
const MAX_DIRECTIONS: usize = 16;

/// Maximum number of edges; hulls with more are left to the general algorithm, since all pairs of edges may be tested.
const MAX_EDGES: usize = 90;

#[derive(Clone, Copy, Debug)]
struct Face {
    normal: Vec3<f64>,
    /// Its outline, counter-clockwise seen from outside: part of `loops`.
    first: usize,
    len: usize,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [usize; 2],
    faces: [usize; 2],
    /// Number by which features know it.
    number: usize,
    /// Number of its direction.
    direction: usize,
}

/// Convex polytope in the frame of its link, prepared for [`FaceClipper::find`]: vertices, faces, edges.
#[derive(Clone, Debug)]
pub struct Polytope {
    vertices: Vec<Vec3<f64>>,
    faces: Vec<Face>,
    loops: Vec<usize>,
    edges: Vec<Edge>,
    /// First edge of each direction.
    directions: Vec<usize>,
    center: Vec3<f64>,
}

impl Polytope {
    /// Creates the polytope of a cuboid or hull whose frame stands at `pose` in its link `[m]`. `None` for other
    /// surfaces, for hulls without volume and for those with more than 90 edges, which the general narrow phase takes.
    pub fn new(surface: &Surface, pose: &Pose<f64>) -> Option<Self> {
        let convex_hull = match surface {
            Surface::Solid(Shape::Cuboid { size }) => {
                let corner = |k: usize| Vector::from_array(corner(k, size));
                // faces of a box with normals along ±x, ±y, ±z, outlines counter-clockwise from outside
                let faces: [[u32; 4]; 6] =
                    [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
                let triangles: Vec<[u32; 3]> =
                    faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
                ConvexPolyhedron::from_convex_mesh((0..8).map(corner).collect(), &triangles)
            }
            Surface::Hull(points) => {
                let points: Vec<Vector> = points.iter().map(|p| Vector::from_array(*p)).collect();
                ConvexPolyhedron::from_convex_hull(&points)
            }
            _ => None,
        }?;
        (convex_hull.edges().len() <= MAX_EDGES).then(|| Self::from_library(&convex_hull, pose))
    }

    fn from_library(convex_hull: &ConvexPolyhedron, pose: &Pose<f64>) -> Self {
        let vertices: Vec<_> = convex_hull.points().iter().map(|p| pose.point(Vec3([p.x, p.y, p.z]))).collect();
        let loops: Vec<usize> = convex_hull.vertices_adj_to_face().iter().map(|k| *k as usize).collect();
        let face = |first: usize, len: usize| {
            // from the outline, as exact as the vertices
            let at = |k: usize| vertices[loops[first + k]];
            let normal = (1..len - 1).fold(Vec3::zero(), |n, k| n + (at(k) - at(0)).cross(at(k + 1) - at(0)));
            Face { normal: normal.scale(1.0 / normal.norm()), first, len }
        };
        let outlines = convex_hull.faces().iter().map(|f| (f.first_vertex_or_edge, f.num_vertices_or_edges));
        let faces = outlines.map(|(first, len)| face(first as usize, len as usize)).collect();
        let mut edges: Vec<Edge> = Vec::new();
        let mut directions: Vec<usize> = Vec::new();
        for (number, e) in convex_hull.edges().iter().enumerate() {
            if e.faces[0] == e.faces[1] {
                // between triangles that were joined to one face
                continue;
            }
            let ends = e.vertices.map(|k| k as usize);
            let along = |ends: [usize; 2]| vertices[ends[1]] - vertices[ends[0]];
            let is_along = |k: &usize| {
                let (u, w) = (along(ends), along(edges[*k].ends));
                u.cross(w).norm() <= ONE_DIRECTION * u.norm() * w.norm()
            };
            let direction = directions.iter().position(is_along).unwrap_or(directions.len());
            if direction == directions.len() {
                directions.push(edges.len());
            }
            edges.push(Edge { ends, faces: e.faces.map(|k| k as usize), number, direction });
        }
        let sum = vertices.iter().fold(Vec3::zero(), |a, b| a + *b);
        let center = sum.scale(1.0 / vertices.len() as f64);
        Self { vertices, faces, loops, edges, directions, center }
    }
}

fn corner(k: usize, size: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| if k >> c & 1 == 0 { -0.5 * size[c] } else { 0.5 * size[c] })
}

/// Place of a contact point on its polytopes: what it moves with. Vectors are of any length; those of the polytope that
/// has the point are in its link frame, those of the polytope that has the plane in the other one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// With the polytope of the point: a vertex.
    Vertex,
    /// Along an edge of the polytope of the point, as a side of the face in the plane cuts it.
    CutEdge {
        /// Along the edge.
        edge: Vec3<f64>,
        /// Normal of the side, of the polytope of the plane.
        side: Vec3<f64>,
    },
    /// With a vertex of the face in the plane, in the face of the other polytope over it.
    OverVertex {
        /// Normal of that face, of the polytope of the point.
        face: Vec3<f64>,
    },
    /// On two edges that cross; the normal of the plane points along their vector product.
    Crossing {
        /// Along the edge of the polytope of the point.
        edge: Vec3<f64>,
        /// Along that of the polytope of the plane.
        other: Vec3<f64>,
    },
}

impl Place {
    /// The same with the vectors of each polytope turned into its own frame.
    fn seen_from(self, of_point: impl Fn(Vec3<f64>) -> Vec3<f64>, of_plane: impl Fn(Vec3<f64>) -> Vec3<f64>) -> Self {
        match self {
            Self::Vertex => Self::Vertex,
            Self::CutEdge { edge, side } => Self::CutEdge { edge: of_point(edge), side: of_plane(side) },
            Self::OverVertex { face } => Self::OverVertex { face: of_point(face) },
            Self::Crossing { edge, other } => Self::Crossing { edge: of_point(edge), other: of_plane(other) },
        }
    }
}

/// Contact point found by [`FaceClipper::find`]: a point of one polytope over a plane of the other, each in the frame
/// of its own link. Its signed distance is that of the point from the plane.
#[derive(Clone, Copy, Debug)]
pub struct PointOnPlane {
    /// True if the point belongs to the first polytope and the plane to the second; false for the reverse.
    pub is_on_first: bool,
    /// Point, in the link frame of its polytope `[m]`.
    pub point: Vec3<f64>,
    /// Point on the plane, in the link frame of the other polytope `[m]`: of one that is not a vertex the one under it.
    pub origin: Vec3<f64>,
    /// Unit normal of the plane, from its polytope towards the point, in the link frame of the plane's polytope.
    pub normal: Vec3<f64>,
    /// Place of the point on the polytopes.
    pub place: Place,
    /// Identifier of the faces, edges or vertices that the point comes from, nonzero: equal in successive steps as long
    /// as the same ones touch, so that contact forces can be carried over.
    pub feature: u32,
}

/// Feature of a point that a face gave: which polytope has the reference face, the two faces, and the vertex or the
/// crossing of two edges in the outline.
fn face_feature(first_leads: bool, faces: [usize; 2], corner: u32) -> u32 {
    let [reference, incident] = faces.map(|face| face as u32 % 64);
    1 + u32::from(first_leads) + 4 * (reference + 64 * (incident + 64 * corner))
}

/// Feature of the point of two crossing edges.
fn edge_feature(edges: [usize; 2]) -> u32 {
    let [one, two] = edges.map(|edge| edge as u32 % 256);
    3 + 4 * (one + 256 * two)
}

/// Kind of contact of two polytopes: kept from step to step until another one is better by 20 µm, so that it does not
/// alternate by rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactKind {
    /// No former contact: the best kind is taken.
    #[default]
    Unknown,
    /// The reference face is one of the second polytope.
    SecondFace,
    /// The reference face is one of the first polytope.
    FirstFace,
    /// Two edges cross.
    Edges,
}

impl ContactKind {
    /// Kind of the contact that gave a point with this [`PointOnPlane::feature`]; unknown for 0.
    #[must_use]
    pub fn of(feature: u32) -> Self {
        match feature % 4 {
            1 => Self::SecondFace,
            2 => Self::FirstFace,
            3 => Self::Edges,
            _ => Self::Unknown,
        }
    }
}

/// Corner of a clipped outline.
#[derive(Clone, Copy, Debug)]
struct Corner {
    point: Vec3<f64>,
    /// Number of the corner: of a vertex, or of the crossing of an edge with a side plane.
    id: u32,
    /// Number of the edge that leads to the next corner: of the incident face, or of a side plane.
    edge: u32,
}

/// Numbers of side planes start here, those of edges below.
const SIDE: u32 = 64;

/// Number of the crossing of an edge with a side plane; vertices have smaller ones.
fn crossing(edge: u32, side: u32) -> u32 {
    64 + (edge % 128) * 64 + side % 64
}

/// Edge and side plane of the crossing with this number, each by its number in its outline; `None` for the edge that
/// another side plane has cut along. None for vertices.
fn crossed(id: u32) -> Option<(Option<usize>, usize)> {
    let of_edge = id.checked_sub(64)?;
    let edge = of_edge / 64;
    Some(((edge < SIDE).then_some(edge as usize), (of_edge % 64) as usize))
}

/// Place of corner `id` of the incident face, cut by the sides of the face of the leading polytope; all vectors are in
/// the frame of the first polytope.
fn place((lead, face): (&Placed<'_>, usize), (other, incident): (&Placed<'_>, usize), id: u32) -> Place {
    match crossed(id) {
        None => Place::Vertex,
        Some((None, _)) => Place::OverVertex { face: other.normal(incident) },
        Some((Some(edge), side)) => {
            let edge = other.side(incident, edge);
            let side = lead.normal(face).cross(lead.side(face, side + lead.shape.faces[face].len - 1));
            let cuts = edge.dot(side).abs() > CUTS * edge.norm() * side.norm();
            if cuts { Place::CutEdge { edge, side } } else { Place::Vertex }
        }
    }
}

/// Working memory of the contact search of polytopes: made once, used for all pairs, so that no search allocates after
/// the first.
#[derive(Clone, Debug, Default)]
pub struct FaceClipper {
    vertices: Vec<Vec3<f64>>,
    normals: Vec<Vec3<f64>>,
    outline: Vec<Corner>,
    cut: Vec<Corner>,
    sides: [Vec<Sides>; 2],
}

/// Vertices and normals of a polytope in a common frame.
struct Placed<'a> {
    shape: &'a Polytope,
    vertices: &'a [Vec3<f64>],
    normals: &'a [Vec3<f64>],
}

impl Placed<'_> {
    fn normal(&self, face: usize) -> Vec3<f64> {
        // of the first polytope, which is in its own frame, the list is empty
        self.normals.get(face).copied().unwrap_or(self.shape.faces[face].normal)
    }

    fn outline(&self, face: usize) -> impl Iterator<Item = Vec3<f64>> {
        let Face { first, len, .. } = self.shape.faces[face];
        self.shape.loops[first..first + len].iter().map(|k| self.vertices[*k])
    }

    /// Vector along side `k` of a face, from its corner `k` to the next one.
    fn side(&self, face: usize, k: usize) -> Vec3<f64> {
        let Face { first, len, .. } = self.shape.faces[face];
        let corner = |k: usize| self.vertices[self.shape.loops[first + k % len]];
        corner(k + 1) - corner(k)
    }

    /// Vector along an edge.
    fn edge(&self, edge: &Edge) -> Vec3<f64> {
        self.vertices[edge.ends[1]] - self.vertices[edge.ends[0]]
    }

    /// Face with the largest separation from another polytope, and that separation.
    fn best_face(&self, other: &[Vec3<f64>]) -> (usize, f64) {
        let mut best = (0, f64::NEG_INFINITY);
        'faces: for face in 0..self.shape.faces.len() {
            let n = self.normal(face);
            let level = n.dot(self.vertices[self.shape.loops[self.shape.faces[face].first]]);
            let mut nearest = f64::INFINITY;
            for v in other {
                nearest = nearest.min(n.dot(*v));
                if nearest - level <= best.1 {
                    continue 'faces;
                }
            }
            best = (face, nearest - level);
        }
        best
    }
}

impl FaceClipper {
    /// Finds the contact points of polytopes `a` and `b` and hands each to `emit`: at most `max_points`, none if the
    /// polytopes are farther apart than `margin` `[m]`.
    ///
    /// `x_ab` is the pose of b's link in that of a `[m]`; `former` is the kind of their contact in the step before
    /// ([`ContactKind::of`] one of its points), which is kept while it is as good.
    #[allow(clippy::too_many_arguments)]
    pub fn find(
        &mut self,
        a: &Polytope,
        b: &Polytope,
        x_ab: &Pose<f64>,
        former: ContactKind,
        margin: f64,
        max_points: usize,
        mut emit: impl FnMut(PointOnPlane),
    ) {
        let Self { vertices, normals, outline, cut, sides } = self;
        vertices.clear();
        vertices.extend(b.vertices.iter().map(|v| x_ab.point(*v)));
        normals.clear();
        normals.extend(b.faces.iter().map(|f| x_ab.rot.mul_vec(f.normal)));
        let one = Placed { shape: a, vertices: &a.vertices, normals: &[] };
        let two = Placed { shape: b, vertices, normals };
        let (face_1, depth_1) = one.best_face(two.vertices);
        if depth_1 > margin {
            return;
        }
        let (face_2, depth_2) = two.best_face(one.vertices);
        if depth_2 > margin {
            return;
        }
        let of_faces = depth_1.max(depth_2);
        let face_normal = if depth_1 >= depth_2 { one.normal(face_1) } else { -two.normal(face_2) };
        if let Some((edges, n, depth)) = best_edges(&one, &two, of_faces + edge_handicap(former), sides)
            && !(former != ContactKind::Unknown && is_like_a_face(&one, &two, edges, n.dot(face_normal)))
        {
            if depth <= margin {
                emit(edge_point(&one, &two, edges, n, x_ab));
            }
            return;
        }
        let first_leads = match former {
            ContactKind::FirstFace => depth_1 >= depth_2 - HYSTERESIS,
            ContactKind::SecondFace => depth_1 > depth_2 + HYSTERESIS,
            ContactKind::Unknown | ContactKind::Edges => depth_1 >= depth_2 - ALIKE,
        };
        let (lead, face, other) = if first_leads { (&one, face_1, &two) } else { (&two, face_2, &one) };
        let incident = cut_outline(lead, face, other, outline, cut);
        let n = lead.normal(face);
        let origin = lead.vertices[lead.shape.loops[lead.shape.faces[face].first]];
        outline.retain(|corner| n.dot(corner.point - origin) <= margin);
        thin_out(outline, max_points);
        for Corner { point, id, .. } in outline.iter() {
            let own = |p: Vec3<f64>| x_ab.rot.tr_mul_vec(p - x_ab.pos);
            let turn = |v: Vec3<f64>| x_ab.rot.tr_mul_vec(v);
            let feature = face_feature(first_leads, [face, incident], *id);
            let place = place((lead, face), (other, incident), *id);
            let place = if first_leads { place.seen_from(turn, |v| v) } else { place.seen_from(|v| v, turn) };
            // the sides and vertices that cut a point off go through the plane under it
            let origin = if place == Place::Vertex { origin } else { *point - n.scale(n.dot(*point - origin)) };
            emit(if first_leads {
                PointOnPlane { is_on_first: false, point: own(*point), origin, normal: n, place, feature }
            } else {
                PointOnPlane { is_on_first: true, point: *point, origin: own(origin), normal: turn(n), place, feature }
            });
        }
    }
}

/// Returns true if crossing edges are nearly parallel or their normal is close to that of the best face, by its cosine
/// `along_face`: where the point of such a contact lies is a matter of small angles, and a body on it would never rest.
fn is_like_a_face(one: &Placed<'_>, two: &Placed<'_>, [i, j]: [usize; 2], along_face: f64) -> bool {
    let (u, w) = (one.edge(&one.shape.edges[i]), two.edge(&two.shape.edges[j]));
    u.cross(w).norm() < ALMOST_PARALLEL * u.norm() * w.norm() || along_face.abs() > ALMOST_ALONG
}

/// Separation by which edges must be better than faces `[m]`.
fn edge_handicap(former: ContactKind) -> f64 {
    match former {
        ContactKind::Unknown => ALIKE,
        ContactKind::FirstFace | ContactKind::SecondFace => HYSTERESIS,
        ContactKind::Edges => -HYSTERESIS,
    }
}

/// Clips the incident face, the face of `other` that opposes a face most, to the outline of that face; merges
/// coincident points. Returns the incident face.
fn cut_outline(
    lead: &Placed<'_>,
    face: usize,
    other: &Placed<'_>,
    outline: &mut Vec<Corner>,
    cut: &mut Vec<Corner>,
) -> usize {
    let n = lead.normal(face);
    let against = |k: usize| n.dot(other.normal(k));
    let facing = (1..other.shape.faces.len()).fold(0, |best, k| if against(k) < against(best) { k } else { best });
    outline.clear();
    let corners = (0..).zip(other.outline(facing));
    outline.extend(corners.map(|(id, point)| Corner { point, id, edge: id }));
    let mut from = lead.outline(face).last().unwrap_or_default();
    for (side, to) in (SIDE..).zip(lead.outline(face)) {
        let inwards = n.cross(to - from);
        let inwards = inwards.scale(1.0 / inwards.norm());
        let inside = |p: &Vec3<f64>| inwards.dot(*p - from);
        cut.clear();
        for k in 0..outline.len() {
            let (p, q) = (outline[k], outline[(k + 1) % outline.len()]);
            let (at_p, at_q) = (inside(&p.point), inside(&q.point));
            if at_p >= -ON_OUTLINE {
                // along the side plane from here, where the rest is cut off
                cut.push(if at_q < -ON_OUTLINE && at_p <= ON_OUTLINE { Corner { edge: side, ..p } } else { p });
            }
            if (at_p < -ON_OUTLINE && at_q > ON_OUTLINE) || (at_p > ON_OUTLINE && at_q < -ON_OUTLINE) {
                let point = p.point + (q.point - p.point).scale(at_p / (at_p - at_q));
                let edge = if at_p > 0.0 { side } else { p.edge };
                cut.push(Corner { point, id: crossing(p.edge, side), edge });
            }
        }
        core::mem::swap(outline, cut);
        from = to;
    }
    cut.clear();
    for p in outline.iter() {
        if cut.iter().all(|known| (p.point - known.point).norm() > ALIKE) {
            cut.push(*p);
        }
    }
    core::mem::swap(outline, cut);
    facing
}

/// Reduces the points to `max_points`: those go first whose removal reduces the area least.
fn thin_out(points: &mut Vec<Corner>, max_points: usize) {
    while points.len() > max_points {
        let n = points.len();
        let area = |k: usize| {
            let (before, at, after) = (points[(k + n - 1) % n].point, points[k].point, points[(k + 1) % n].point);
            (before - at).cross(after - at).norm()
        };
        let least = (1..n).fold(0, |best, k| if area(k) < area(best) { k } else { best });
        points.remove(least);
    }
}

/// Pair of edges with the largest separation, if that is above `least` `[m]`: edges, normal from two to one, and
/// separation.
fn best_edges(
    one: &Placed<'_>,
    two: &Placed<'_>,
    least: f64,
    sides: &mut [Vec<Sides>; 2],
) -> Option<([usize; 2], Vec3<f64>, f64)> {
    if one.shape.directions.len() * two.shape.directions.len() > MAX_DIRECTIONS {
        return best_edges_along(one, two, least, u64::MAX, sides);
    }
    let mut separations = [f64::NEG_INFINITY; MAX_DIRECTIONS];
    find_separations(one, two, &mut separations);
    let most = separations.iter().copied().filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    // no pair of edges is separated by more than the polytopes are across their directions
    let above =
        |bound: f64| (0..MAX_DIRECTIONS).fold(0, |mask, k| mask | u64::from(separations[k] + 2.0 * ALIKE > bound) << k);
    let found = best_edges_along(one, two, least, above(least.max(most)), sides);
    match found {
        Some((_, _, depth)) if depth > most - ALIKE => found,
        // the search was that of all that may be better
        _ if most <= least => found,
        _ => best_edges_along(one, two, least, above(least), sides),
    }
}

/// Separation of two polytopes across each pair of their edge directions `[m]`; −∞ for those that are parallel, ∞ where
/// rounding says whether they are, which each pair of edges decides for itself.
fn find_separations(one: &Placed<'_>, two: &Placed<'_>, separations: &mut [f64; MAX_DIRECTIONS]) {
    let n_two = two.shape.directions.len();
    for (i, e) in one.shape.directions.iter().enumerate() {
        let u = one.edge(&one.shape.edges[*e]);
        for (j, f) in two.shape.directions.iter().enumerate() {
            let w = two.edge(&two.shape.edges[*f]);
            let across = u.cross(w);
            let (size, parallel) = (across.norm(), PARALLEL * u.norm() * w.norm());
            separations[i * n_two + j] = if size < 0.5 * parallel {
                f64::NEG_INFINITY
            } else if size < 2.0 * parallel {
                f64::INFINITY
            } else {
                let n = across.scale(1.0 / size);
                let ([from_1, to_1], [from_2, to_2]) = (extent(one, n), extent(two, n));
                (from_2 - to_1).max(from_1 - to_2)
            };
        }
    }
}

/// The same of the pairs of edges whose directions have a bit in `directions`.
fn best_edges_along(
    one: &Placed<'_>,
    two: &Placed<'_>,
    least: f64,
    directions: u64,
    sides: &mut [Vec<Sides>; 2],
) -> Option<([usize; 2], Vec3<f64>, f64)> {
    for list in sides.iter_mut() {
        list.clear();
        list.reserve(MAX_EDGES);
    }
    if directions == 0 {
        return None;
    }
    let n_two = two.shape.directions.len();
    let bit = |e: &Edge, f: &Edge| directions >> ((e.direction * n_two + f.direction) % MAX_DIRECTIONS) & 1 == 1;
    let [on_one, on_two] = sides;
    find_sides(two, one, |e| two.shape.directions.iter().any(|f| bit(e, &two.shape.edges[*f])), on_one);
    find_sides(one, two, |f| one.shape.directions.iter().any(|e| bit(&one.shape.edges[*e], f)), on_two);
    let mut best = None;
    let mut known = least;
    for ((i, e), of_u) in one.shape.edges.iter().enumerate().zip(on_one) {
        if of_u.along == 0 {
            continue;
        }
        let (p, u) = (one.vertices[e.ends[0]], one.edge(e));
        let [a, b] = e.faces.map(|f| one.normal(f));
        let ba = b.cross(a);
        for ((j, f), of_w) in two.shape.edges.iter().enumerate().zip(&*on_two) {
            // only edges whose arcs on the Gauss map cross can touch; the arc from a to b has its pole along the edge
            if !bit(e, f) || !of_u.lies_between(f.faces) || !of_w.lies_between(e.faces) {
                continue;
            }
            let [c, d] = f.faces.map(|f| -two.normal(f));
            // on the same half of the sphere
            if c.dot(ba) * b.dot(d.cross(c)) <= 0.0 {
                continue;
            }
            let (q, w) = (two.vertices[f.ends[0]], two.edge(f));
            let across = u.cross(w);
            let size = across.norm();
            if size < PARALLEL * u.norm() * w.norm() {
                continue;
            }
            let outwards = if across.dot(p - one.shape.center) < 0.0 { -1.0 } else { 1.0 };
            let n = across.scale(outwards / size);
            let depth = n.dot(q - p);
            // where arcs only touch, rounding says whether they cross: the edges must be the outermost ones along n
            if depth > known && depth <= separation(one, two, n) + ALIKE {
                best = Some(([i, j], -n, depth));
                known = depth;
            }
        }
    }
    best
}

/// Separation of two polytopes along a unit vector from the first one to the second.
fn separation(one: &Placed<'_>, two: &Placed<'_>, n: Vec3<f64>) -> f64 {
    extent(two, n)[0] - extent(one, n)[1]
}

/// Least and largest coordinate of a polytope along a vector.
fn extent(of: &Placed<'_>, n: Vec3<f64>) -> [f64; 2] {
    let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
    for v in of.vertices {
        let at = n.dot(*v);
        extent = [if at < extent[0] { at } else { extent[0] }, if at > extent[1] { at } else { extent[1] }];
    }
    extent
}

/// Faces of a polytope whose normals point along an edge of another, and against it: a bit each. With [`MAX_EDGES`] it
/// has 60 faces at most.
#[derive(Clone, Copy, Debug, Default)]
struct Sides {
    along: u64,
    against: u64,
}

impl Sides {
    /// Returns true if one of the faces points along the edge, and the other against it.
    fn lies_between(self, [a, b]: [usize; 2]) -> bool {
        (self.along >> a & self.against >> b | self.against >> a & self.along >> b) & 1 == 1
    }
}

/// Sides of the faces of one polytope to those edges of another that are looked at; the others lie between no faces.
fn find_sides(of: &Placed<'_>, on: &Placed<'_>, is_looked_at: impl Fn(&Edge) -> bool, sides: &mut Vec<Sides>) {
    sides.clear();
    for edge in &on.shape.edges {
        let mut found = Sides::default();
        if !is_looked_at(edge) {
            sides.push(found);
            continue;
        }
        let along = on.edge(edge);
        for face in 0..of.shape.faces.len() {
            let product = of.normal(face).dot(along);
            found.along |= u64::from(product > 0.0) << face;
            found.against |= u64::from(product < 0.0) << face;
        }
        sides.push(found);
    }
}

/// Contact point of two crossing edges: the first one's nearest point over a plane through the second one.
fn edge_point(one: &Placed<'_>, two: &Placed<'_>, edges: [usize; 2], n: Vec3<f64>, x_ab: &Pose<f64>) -> PointOnPlane {
    let line = |placed: &Placed<'_>, k: usize| {
        let [from, to] = placed.shape.edges[k].ends.map(|v| placed.vertices[v]);
        (from, to - from)
    };
    let ((p, u), (q, w)) = (line(one, edges[0]), line(two, edges[1]));
    let r = q - p;
    let (uu, ww, uw) = (u.dot(u), w.dot(w), u.dot(w));
    let square = uu * ww - uw * uw;
    let nearest = (r.dot(u) * ww - r.dot(w) * uw) / square;
    let along = nearest.clamp(0.0, 1.0);
    let point = p + u.scale(along);
    let own = |v: Vec3<f64>| x_ab.rot.tr_mul_vec(v);
    let feature = edge_feature([one.shape.edges[edges[0]].number, two.shape.edges[edges[1]].number]);
    let u = if u.cross(w).dot(n) < 0.0 { -u } else { u };
    let crosses = nearest == along && square > CUTS * CUTS * uu * ww;
    let place = if crosses { Place::Crossing { edge: u, other: w }.seen_from(|v| v, own) } else { Place::Vertex };
    PointOnPlane { is_on_first: true, point, origin: own(q - x_ab.pos), normal: own(n), place, feature }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Mat3, Quat};

    fn brick() -> Polytope {
        let surface = Surface::Solid(Shape::Cuboid { size: [0.24, 0.12, 0.08] });
        Polytope::new(&surface, &Pose::identity()).unwrap()
    }

    /// Points and signed distances of a brick in a pose over one at rest.
    fn first_contact(x_ab: &Pose<f64>) -> Vec<(Vec3<f64>, f64)> {
        let mut points = Vec::new();
        FaceClipper::default().find(&brick(), &brick(), x_ab, ContactKind::Unknown, 1e-3, 8, |p: PointOnPlane| {
            let place = |p: Vec3<f64>, is_first: bool| if is_first { p } else { x_ab.point(p) };
            let (point, origin) = (place(p.point, p.is_on_first), place(p.origin, !p.is_on_first));
            let n = if p.is_on_first { x_ab.rot.mul_vec(p.normal) } else { p.normal };
            points.push((point, n.dot(point - origin)));
        });
        points
    }

    fn turned(axis: usize, angle: f64, pos: [f64; 3]) -> Pose<f64> {
        let (sin, cos) = sincro_math::elementary::sin_cos(angle);
        let rot = match axis {
            0 => Mat3::rotation::<0>(sin, cos),
            1 => Mat3::rotation::<1>(sin, cos),
            _ => Mat3::rotation::<2>(sin, cos),
        };
        Pose { rot, pos: Vec3(pos) }
    }

    #[test]
    fn a_brick_on_a_brick_stands_on_four_corners_whatever_rounding_says() {
        for axis in 0..3 {
            for tilt in [0.0, 1e-16, -3e-16, 1e-13, -1e-10] {
                let points = first_contact(&turned(axis, tilt, [0.0, 0.0, 0.08 - 1e-13]));
                assert_eq!(points.len(), 4, "axis {axis}, tilt {tilt:e}: {points:?}");
                assert!(points.iter().all(|(_, gjk)| gjk.abs() < 1e-10));
            }
        }
    }

    #[test]
    fn a_brick_that_is_turned_touches_with_an_octagon_and_one_that_overhangs_with_what_is_left() {
        let octagon = first_contact(&turned(2, 0.8, [0.0, 0.0, 0.08]));
        assert_eq!(octagon.len(), 8, "{octagon:?}");
        let shifted = first_contact(&turned(2, 0.0, [0.1, 0.0, 0.08]));
        let x = |f: fn(f64, f64) -> f64, start: f64| shifted.iter().fold(start, |a, (p, _)| f(a, p[0]));
        assert_eq!(shifted.len(), 4);
        assert!((x(f64::min, 1.0) + 0.02).abs() < 1e-15 && (x(f64::max, -1.0) - 0.12).abs() < 1e-15);
    }

    #[test]
    fn a_brick_on_its_corner_and_crossed_edges_touch_in_one_point() {
        // an edge along x over an edge along y: both bricks stand on edge
        let half = |a: f64, b: f64| 0.5 * (a * a + b * b).sqrt();
        let up = half(0.12, 0.08);
        let lower = turned(0, sincro_math::elementary::atan2(0.12, 0.08).0, [0.0; 3]);
        let quarter = turned(2, core::f64::consts::FRAC_PI_2, [0.0, 0.0, 2.0 * up + 1e-4]);
        let upper = quarter.compose(&turned(0, sincro_math::elementary::atan2(0.12, 0.08).0, [0.0; 3]));
        let points = first_contact(&lower.inverse().compose(&upper));
        assert_eq!(points.len(), 1, "{points:?}");
        assert!((points[0].1 - 1e-4).abs() < 1e-12, "{points:?}");
    }

    #[test]
    fn bricks_with_touching_faces_touch_there_however_both_are_turned() {
        // arcs of the Gauss map that only touch were taken for crossing ones, and the bricks for 0.03 m apart
        let mut seed = 1_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for _ in 0..2000 {
            let world = Quat::exp(Vec3(std::array::from_fn(|_| 6.0 * number()))).matrix();
            let shift = Vec3([0.2 * number(), 0.1 * number(), 0.08]);
            let (a, b) = (Pose { rot: world, pos: Vec3::zero() }, Pose { rot: world, pos: world.mul_vec(shift) });
            let found = first_contact(&a.inverse().compose(&b));
            assert!(found.len() >= 4, "{found:?}");
            assert!(found.iter().all(|(_, distance)| distance.abs() < 1e-15), "{found:?}");
        }
    }

    #[test]
    fn features_stay_while_a_brick_slides_and_are_all_different() {
        let features = |pose: &Pose<f64>| {
            let mut found = Vec::new();
            FaceClipper::default()
                .find(&brick(), &brick(), pose, ContactKind::Unknown, 1e-3, 8, |p: PointOnPlane| found.push(p.feature));
            found
        };
        let before = features(&turned(2, 0.8, [0.01, 0.0, 0.08]));
        let after = features(&turned(2, 0.81, [0.012, 0.003, 0.0801]));
        assert_eq!(before, after);
        let mut different = before.clone();
        different.sort_unstable();
        different.dedup();
        assert!(before.len() >= 6 && different.len() == before.len() && !different.contains(&0), "{before:?}");
    }

    #[test]
    fn the_kind_of_contact_is_kept_until_another_is_clearly_better() {
        let first_leads = |tilt: f64, former: ContactKind| {
            let mut found = Vec::new();
            let pose = turned(0, tilt, [0.0, 0.0, 0.08]);
            FaceClipper::default().find(&brick(), &brick(), &pose, former, 1e-3, 8, |p: PointOnPlane| {
                found.push(ContactKind::of(p.feature))
            });
            assert!(found.len() == 4 && found.iter().all(|kind| *kind == found[0]), "{found:?}");
            found[0]
        };
        // both faces separate the bricks alike where they lie flat on each other
        for kind in [ContactKind::FirstFace, ContactKind::SecondFace] {
            assert_eq!(first_leads(1e-5, kind), kind);
        }
        assert_eq!(first_leads(0.0, ContactKind::Unknown), ContactKind::FirstFace);
    }

    #[test]
    fn the_best_edges_are_those_of_all_pairs() {
        let prism: Vec<[f64; 3]> = (0..6)
            .map(|k| [[0.1, 0.0], [-0.05, 0.08], [-0.06, -0.07]][k % 3])
            .enumerate()
            .map(|(k, [x, y])| [x, y, if k < 3 { -0.1 } else { 0.12 }])
            .collect();
        let prism = Polytope::new(&Surface::Hull(prism), &Pose::identity()).unwrap();
        assert_eq!((brick().directions.len(), prism.directions.len()), (3, 4));
        let (mut state, mut found) = (1_u64, 0);
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for k in 0..20_000 {
            let (a, b) = match k % 4 {
                0 | 2 => (brick(), brick()),
                1 => (prism.clone(), brick()),
                _ => (prism.clone(), prism.clone()),
            };
            // any rotation, or multiples of 30 degrees, where directions are parallel and separations equal
            let angle = |x: f64| if k % 3 == 0 { std::f64::consts::PI * (12.0 * x).floor() / 6.0 } else { 6.3 * x };
            let rot = (0..3).fold(Mat3::identity(), |r, axis| r.mul(&turned(axis, angle(number()), [0.0; 3]).rot));
            let pos = Vec3(std::array::from_fn(|_| 0.3 * number() - 0.15));
            let x_ab = Pose { rot, pos };
            let vertices: Vec<_> = b.vertices.iter().map(|v| x_ab.point(*v)).collect();
            let normals: Vec<_> = b.faces.iter().map(|f| x_ab.rot.mul_vec(f.normal)).collect();
            let one = Placed { shape: &a, vertices: &a.vertices, normals: &[] };
            let two = Placed { shape: &b, vertices: &vertices, normals: &normals };
            let former = [ContactKind::Unknown, ContactKind::FirstFace, ContactKind::Edges][k / 12 % 3];
            let of_faces = one.best_face(two.vertices).1.max(two.best_face(one.vertices).1);
            let least = of_faces + edge_handicap(former);
            let mut sides = Default::default();
            let all = best_edges_along(&one, &two, least, u64::MAX, &mut sides);
            assert_eq!(best_edges(&one, &two, least, &mut sides), all, "draw {k}: {x_ab:?}");
            found += u32::from(all.is_some());
        }
        assert!((2_000..18_000).contains(&found), "{found} of 20000");
    }

    #[test]
    fn bricks_far_apart_do_not_touch() {
        assert!(first_contact(&turned(2, 0.3, [0.0, 0.0, 0.09])).is_empty());
        assert!(first_contact(&turned(2, 0.3, [0.3, 0.0, 0.0])).is_empty());
    }
}
