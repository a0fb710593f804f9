//! Motion along one axis in pieces of constant jerk.

/// State of motion along one axis. `u` stands for the unit of the axis: m, rad, or any other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Position `[u]`.
    pub p: f64,
    /// Velocity `[u/s]`.
    pub v: f64,
    /// Acceleration `[u/s²]`.
    pub a: f64,
}

impl Point {
    /// State after a time `t` `[s]` with the constant jerk `jerk` `[u/s³]`.
    #[must_use]
    pub fn after(self, t: f64, jerk: f64) -> Self {
        let Self { p, v, a } = self;
        Self { p: p + t * (v + t * (a / 2.0 + t * jerk / 6.0)), v: v + t * (a + t * jerk / 2.0), a: a + t * jerk }
    }

    /// The same motion seen the other way round.
    pub(super) fn mirrored(self) -> Self {
        Self { p: -self.p, v: -self.v, a: -self.a }
    }

    /// The velocity that is left if the acceleration is taken to zero at once.
    pub(super) fn rest_velocity(self, max_jerk: f64) -> f64 {
        self.v + self.a * self.a.abs() / (2.0 * max_jerk)
    }
}

/// Limits of a motion along one axis, an input of [`plan`](crate::plan); `u` stands for the unit of the axis.
/// Largest values are positive, lowest ones negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest velocity `[u/s]`.
    pub max_velocity: f64,
    /// Lowest velocity `[u/s]`.
    pub min_velocity: f64,
    /// Largest acceleration `[u/s²]`.
    pub max_acceleration: f64,
    /// Lowest acceleration `[u/s²]`.
    pub min_acceleration: f64,
    /// Largest magnitude of the jerk `[u/s³]`.
    pub max_jerk: f64,
}

impl Limits {
    /// Creates limits that are the same in both directions: magnitudes of velocity `[u/s]`, acceleration `[u/s²]` and
    /// jerk `[u/s³]`, all positive.
    #[must_use]
    pub fn symmetric(velocity: f64, acceleration: f64, jerk: f64) -> Self {
        Self {
            max_velocity: velocity,
            min_velocity: -velocity,
            max_acceleration: acceleration,
            min_acceleration: -acceleration,
            max_jerk: jerk,
        }
    }

    pub(super) fn mirrored(self) -> Self {
        Self {
            max_velocity: -self.min_velocity,
            min_velocity: -self.max_velocity,
            max_acceleration: -self.min_acceleration,
            min_acceleration: -self.max_acceleration,
            ..self
        }
    }
}

/// A time with one jerk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Piece {
    pub duration: f64,
    pub jerk: f64,
}

/// Most pieces of a motion: back into the limits (4), to a velocity (3), there (1), to the last velocity (3).
pub(super) const MAX_PIECES: usize = 12;

/// Pieces one after the other, in place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pieces {
    list: [Piece; MAX_PIECES],
    n: usize,
}

impl Pieces {
    /// One more; none of no duration.
    pub fn push(&mut self, duration: f64, jerk: f64) {
        if duration > 0.0 {
            self.list[self.n] = Piece { duration, jerk };
            self.n += 1;
        }
    }

    pub fn extend(&mut self, others: &Self) {
        others.iter().for_each(|piece| self.push(piece.duration, piece.jerk));
    }

    pub fn iter(&self) -> impl Iterator<Item = &Piece> {
        self.list[..self.n].iter()
    }

    pub fn duration(&self) -> f64 {
        self.iter().map(|piece| piece.duration).sum()
    }

    /// State at the end of the pieces.
    pub fn end(&self, start: Point) -> Point {
        self.iter().fold(start, |x, piece| x.after(piece.duration, piece.jerk))
    }

    /// Jerks multiplied by a factor.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.list.iter_mut().for_each(|piece| piece.jerk *= factor);
        self
    }
}

/// Planned motion along one axis: pieces of constant jerk from a start to a goal, and constant velocity from there on.
/// [`plan`](crate::plan) makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    pub(super) start: Point,
    pub(super) pieces: Pieces,
    end: Point,
    duration: f64,
}

impl Profile {
    /// Ends at `end` exactly: what rounding leaves is dropped there.
    pub(super) fn new(start: Point, pieces: Pieces, end: Point) -> Self {
        Self { start, pieces, end, duration: pieces.duration() }
    }

    /// Duration of the motion until the goal is reached `[s]`.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// State at the end of the motion: position, velocity and acceleration; from there on the velocity stays.
    #[must_use]
    pub fn end(&self) -> Point {
        self.end
    }

    /// State at a time `t` `[s]` since the start; the start for a negative `t`, and motion with the last velocity
    /// behind the end.
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        if t >= self.duration {
            return Point { p: self.end.p + self.end.v * (t - self.duration), ..self.end };
        }
        let (mut x, mut left) = (self.start, t.max(0.0));
        for piece in self.pieces.iter() {
            if left <= piece.duration {
                return x.after(left, piece.jerk);
            }
            x = x.after(piece.duration, piece.jerk);
            left -= piece.duration;
        }
        x
    }

    pub(super) fn mirrored(self) -> Self {
        let pieces = self.pieces.scaled(-1.0);
        Self { start: self.start.mirrored(), pieces, end: self.end.mirrored(), duration: self.duration }
    }

    /// States at the ends of its pieces and where its acceleration passes zero within: its velocity and acceleration
    /// are within those.
    pub(super) fn corners(&self) -> impl Iterator<Item = Point> {
        let mut x = self.start;
        self.pieces.iter().flat_map(move |piece| {
            let turn = if piece.jerk == 0.0 { -1.0 } else { -x.a / piece.jerk };
            let top = (turn > 0.0 && turn < piece.duration).then(|| x.after(turn, piece.jerk));
            x = x.after(piece.duration, piece.jerk);
            [top, Some(x)].into_iter().flatten()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_the_ends_of_pieces_and_the_tops_of_velocity_within() {
        // from 1 m/s² to −1 m/s² in 2 s, the fastest at half of it; then no jerk
        let start = Point { p: 0.0, v: 0.5, a: 1.0 };
        let mut pieces = Pieces::default();
        pieces.push(2.0, -1.0);
        pieces.push(1.0, 0.0);
        let end = pieces.end(start);
        let corners: Vec<(f64, f64)> = Profile::new(start, pieces, end).corners().map(|x| (x.v, x.a)).collect();
        assert_eq!(corners, [(1.0, 0.0), (0.5, -1.0), (-0.5, -1.0)]);
    }
}
