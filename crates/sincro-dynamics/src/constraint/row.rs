//! Constraint rows in world coordinates: Jacobians, rates and accelerations.
//!
//! A row is J v = Wₐ·Vₐ − W_b·V_b, with V the twist of a link and W a wrench of unit magnitude, both about the world's
//! origin in world axes, or a sum of joint rates. Its rate is J v̇ + J̇ v = Wₐ·Aₐ − W_b·A_b + Ẇₐ·Vₐ − Ẇ_b·V_b, with A
//! the spatial acceleration, so that no centripetal or Coriolis term appears. The world has no twist, and the
//! acceleration that gravity gives the base of the recursions. Source: key `featherstone2008`, chapters 2 and 8.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `wa`, `wb` | wrench of the row on link a, and against it on link b | 1, m |
//! | `wa_dot`, `wb_dot` | their rates | 1/s, m/s |

use sincro_math::Real;

use crate::contact::candidate::LinkMotions;
use crate::joint::WORLD;
use crate::kinematics::UnitColumn;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::{Force, Motion, Vec3};

/// One row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<R> {
    pub a: u32,
    pub b: u32,
    pub wa: Force<R>,
    pub wb: Force<R>,
    pub wa_dot: Force<R>,
    pub wb_dot: Force<R>,
    /// Degrees of freedom and coefficients of a row over joint rates; `WORLD` for none.
    pub joints: [(u32, R); 2],
    /// Velocity bias J̇ v of a row over joint rates whose coefficients vary; `None` if they are constant.
    pub bias: Option<R>,
}

impl<R: Real> Row<R> {
    /// A row between two links with the same wrench on both.
    pub fn between(a: u32, b: u32, w: Force<R>, w_dot: Force<R>) -> Self {
        Self { a, b, wa: w, wb: w, wa_dot: w_dot, wb_dot: w_dot, joints: [(WORLD, R::zero()); 2], bias: None }
    }

    /// p of this row and q of another between the same links.
    pub fn combined(&self, other: &Self, p: R, q: R) -> Self {
        let of = |x: &Force<R>, y: &Force<R>| x.scale(p) + y.scale(q);
        Self {
            wa: of(&self.wa, &other.wa),
            wb: of(&self.wb, &other.wb),
            wa_dot: of(&self.wa_dot, &other.wa_dot),
            wb_dot: of(&self.wb_dot, &other.wb_dot),
            ..*self
        }
    }

    /// J v for the twists of links and the joint rates `v`.
    fn rate(&self, twist: impl Fn(u32) -> Motion<R>, v: &[R]) -> R {
        let mut sum = twist(self.a).dot(&self.wa) - twist(self.b).dot(&self.wb);
        for (k, c) in self.joints {
            if k != WORLD {
                sum += c * v[k as usize];
            }
        }
        sum
    }

    /// A row over joint rates.
    pub fn of_joints(joints: [(u32, R); 2]) -> Self {
        let o = Force::zero();
        Self { a: WORLD, b: WORLD, wa: o, wb: o, wa_dot: o, wb_dot: o, joints, bias: None }
    }
}

/// A force along `f` through the point `c`, as a wrench about the world's origin.
#[inline(always)]
pub(crate) fn force_at<R: Real>(c: Vec3<R>, f: Vec3<R>) -> Force<R> {
    Force { ang: c.cross(f), lin: f }
}

/// Rate of [`force_at`] for a moving point and a turning direction.
#[inline(always)]
pub(crate) fn force_rate<R: Real>(c: Vec3<R>, f: Vec3<R>, c_dot: Vec3<R>, f_dot: Vec3<R>) -> Force<R> {
    Force { ang: c_dot.cross(f) + c.cross(f_dot), lin: f_dot }
}

/// Twists, accelerations and joint axes about the world's origin, world axes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motions<R> {
    pub twist: Vec<Motion<R>>,
    accel: Vec<Motion<R>>,
    columns: Vec<Motion<R>>,
    base: Motion<R>,
}

impl<R: Real> Motions<R> {
    pub fn new(model: &Model<R>) -> Self {
        let n = model.links.len();
        Self {
            twist: vec![Motion::zero(); n],
            accel: vec![Motion::zero(); n],
            columns: vec![Motion::zero(); model.n_v()],
            base: Motion::zero(),
        }
    }

    /// From a scratch whose poses are known: joint axes, and twists for the joint rates `v`.
    pub fn place(&mut self, model: &Model<R>, scratch: &Scratch<R>, v: &[R]) {
        for (i, link) in model.links.iter().enumerate() {
            let pose = &scratch.poses[i];
            let mut twist = if link.parent == WORLD { Motion::zero() } else { self.twist[link.parent as usize] };
            for j in 0..link.kind.n_v() {
                let k = link.v_idx as usize + j;
                let s = link.kind.dispatch(UnitColumn { link, j });
                let ang = pose.rot.mul_vec(s.ang);
                let column = Motion { ang, lin: pose.rot.mul_vec(s.lin) + pose.pos.cross(ang) };
                self.columns[k] = column;
                twist += Motion { ang: column.ang.scale(v[k]), lin: column.lin.scale(v[k]) };
            }
            self.twist[i] = twist;
        }
    }

    /// Accelerations of the links as forward dynamics left them, gravity of the base included.
    pub fn accelerate(&mut self, model: &Model<R>, scratch: &Scratch<R>) {
        self.base = Motion { ang: Vec3::zero(), lin: -model.params.gravity };
        for (i, out) in self.accel.iter_mut().enumerate() {
            let (a, pose) = (&scratch.links[i].a, &scratch.poses[i]);
            let ang = pose.rot.mul_vec(a.ang);
            *out = Motion { ang, lin: pose.rot.mul_vec(a.lin) + pose.pos.cross(ang) };
        }
    }

    /// Velocities of the links for other joint rates than the twists were placed for, at the same poses; they take the
    /// place of the accelerations.
    pub fn place_velocities(&mut self, model: &Model<R>, v: &[R]) {
        for (i, link) in model.links.iter().enumerate() {
            let mut twist = if link.parent == WORLD { Motion::zero() } else { self.accel[link.parent as usize] };
            for k in link.v_idx as usize..link.v_idx as usize + link.kind.n_v() {
                twist += Motion { ang: self.columns[k].ang.scale(v[k]), lin: self.columns[k].lin.scale(v[k]) };
            }
            self.accel[i] = twist;
        }
    }

    /// J v of a row for the joint rates of [`Motions::place_velocities`].
    pub fn placed_rate(&self, row: &Row<R>, v: &[R]) -> R {
        row.rate(|link| self.placed_twist_of(link), v)
    }

    /// Twist of a link about the world's origin for the joint rates of [`Motions::place_velocities`]; zero for the
    /// world.
    pub fn placed_twist_of(&self, link: u32) -> Motion<R> {
        if link == WORLD { Motion::zero() } else { self.accel[link as usize] }
    }

    /// Axes of the joints, one a degree of freedom.
    pub fn columns(&self) -> &[Motion<R>] {
        &self.columns
    }

    /// Poses of `scratch` with the twists placed here.
    pub fn at<'a>(&'a self, scratch: &'a Scratch<R>) -> LinkMotions<'a, R> {
        LinkMotions { poses: &scratch.poses, twists: &self.twist }
    }

    /// Twist of a link about the world's origin; zero for the world.
    pub fn twist_of(&self, link: u32) -> Motion<R> {
        if link == WORLD { Motion::zero() } else { self.twist[link as usize] }
    }

    /// Velocity [m/s] of the point of a link that is at `p` in the world.
    pub fn velocity_of(&self, link: u32, p: Vec3<R>) -> Vec3<R> {
        let v = self.twist_of(link);
        v.lin + v.ang.cross(p)
    }

    /// J v of a row, `v` the joint rates that the twists were placed for.
    pub fn rate(&self, row: &Row<R>, v: &[R]) -> R {
        row.rate(|link| self.twist_of(link), v)
    }

    /// J v̇ + J̇ v of a row, `v_dot` the joint accelerations that forward dynamics gave.
    pub fn acceleration(&self, row: &Row<R>, v_dot: &[R]) -> R {
        let accel = |link: u32| if link == WORLD { self.base } else { self.accel[link as usize] };
        let mut sum = accel(row.a).dot(&row.wa) - accel(row.b).dot(&row.wb) + self.twist_of(row.a).dot(&row.wa_dot)
            - self.twist_of(row.b).dot(&row.wb_dot);
        for (k, c) in row.joints {
            if k != WORLD {
                sum += c * v_dot[k as usize];
            }
        }
        if let Some(bias) = row.bias {
            sum += bias;
        }
        sum
    }

    /// The row of the Jacobian, `n_v` numbers.
    pub fn jacobian(&self, model: &Model<R>, row: &Row<R>, out: &mut [R]) {
        out.fill(R::zero());
        self.add_chain(model, row.a, &row.wa, R::one(), out);
        self.add_chain(model, row.b, &row.wb, -R::one(), out);
        for (k, c) in row.joints {
            if k != WORLD {
                out[k as usize] += c;
            }
        }
    }

    fn add_chain(&self, model: &Model<R>, link: u32, w: &Force<R>, sign: R, out: &mut [R]) {
        let mut at = link;
        while at != WORLD {
            let link = &model.links[at as usize];
            let first = link.v_idx as usize;
            for k in first..first + link.kind.n_v() {
                out[k] += sign * self.columns[k].dot(w);
            }
            at = link.parent;
        }
    }
}
