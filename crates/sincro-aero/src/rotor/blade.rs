//! The blade-element momentum rotor: thrust and torque of a rigid rotor with constant chord and pitch, from its speed
//! and the velocity of its hub.
//!
//! One square root of an equation in one unknown ([`super::momentum`]), then two polynomials; about a hundred
//! operations.
//!
//! T = 2ρA (S − k₁V w), S = k₁θ₀(⅔V² + h²);
//! Q = ρAR [σ(c₀ + c₂θ₀²)(V² + h²)/8 + 4k₁w(Vθ₀/3 − w/2) + ¼σc₂w(w − 4θ₀V/3)].
//!
//! Source: key `leishman2006`, blade elements with a uniform inflow (linear lift, drag c₀ + c₂α², small angles, no tip
//! loss, no reversed flow), averaged over a turn; the inflow from momentum after key `glauert1926`. In axial flight the
//! middle term of QΩ is T w. Written with velocities instead of ratios to ΩR, so that it stays finite at Ω = 0.
//!
//! | symbol | meaning | unit | usual symbol |
//! |---|---|---|---|
//! | R, A = πR² | radius and area of the disc | m, m² | |
//! | σ = n c/(πR) | solidity | | |
//! | k₁ = σ Clα/8 | lift of all blades, as a ratio | | |
//! | θ₀ | collective pitch | rad | |
//! | c₀, c₂ | drag polar | , 1/rad² | Cd0, kCd |
//! | V = ΩR | velocity of the tips | m/s | Vt |
//! | h, v | hub's velocity in the plane and along the axis, relative to the air | m/s | μV, λcV |
//! | w | inflow | m/s | λV |
//!
//! A rotor that turns backwards is its mirror image: T(Ω, v) = −T(−Ω, −v), and so w and Q. The mirror jumps at Ω = 0 if
//! there is velocity in the plane; a rotor at rest is outside what the theory says anything about
//! ([`Validity::Standing`]).

use core::f64::consts::{FRAC_PI_2, PI};

use sincro_math::Real;

use super::momentum::Balance;
use super::{Load, Spin, limited, outside};
use sincro_geometry::spatial::Vec3;
use sincro_math::error::InvalidParameters;

/// Profile drag of a blade section over its angle of attack α: `c_d = c₀ + c₂ α²`. Part of a [`RotorSpec`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// Drag coefficient c₀ at zero angle of attack (dimensionless), 0 to 1000.
    pub cd0: f64,
    /// Growth of the drag coefficient with the square of the angle of attack, c₂ `[1/rad²]`, 0 to 1000.
    pub k_cd: f64,
}

/// Geometry and section coefficients of a rotor with blades of constant chord and pitch: the argument of
/// [`Rotor::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorSpec {
    /// Radius of the disc `[m]`, 1e-6 to 1e6.
    pub radius: f64,
    /// Chord of a blade `[m]`, 1e-6 to 1e6.
    pub chord: f64,
    /// Number of blades, at least 1.
    pub n_blades: u32,
    /// Slope of the section's lift coefficient over the angle of attack `[1/rad]`, 1e-6 to 1000; 2π for a thin airfoil.
    pub lift_slope: f64,
    /// Collective pitch of the blades `[rad]`, −π/2 to π/2; constant along the blade.
    pub collective_pitch: f64,
    /// Profile drag of the section.
    pub drag: Drag,
    /// Sense of rotation at positive speed.
    pub spin: Spin,
}

/// Range of validity of a rotor's theory: `Valid`, or the reason for which a load is finite but not to be trusted.
///
/// From [`MountedRotor::validity`](super::MountedRotor::validity) or the law's own `validity`; runs count the steps
/// outside the range by these reasons and report them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Validity {
    /// The theory holds.
    Valid,
    /// The rotor does not turn: the load is finite, but not accurate.
    Standing,
    /// Descent faster than half the induced velocity with little forward speed: towards the vortex ring, where the flow
    /// has no steady tube that momentum theory could balance.
    SteepDescent,
    /// The rotor pushes backwards: momentum theory holds in the mirror, the blades' sections work upside down.
    NegativeThrust,
    /// Forward speed above half that of the tips: reversed flow and stall on the retreating blade, which are left out.
    HighAdvance,
    /// The advance ratio is outside the table that was measured: the coefficients are those of its end.
    OutsideTable,
    /// The law gave a load that is not a number.
    NotANumber,
}

impl Validity {
    /// Every variant except `Valid`, in the order of the reports: the index of an entry is that of its counter.
    pub const REASONS: [Self; 6] = [
        Self::Standing,
        Self::SteepDescent,
        Self::NegativeThrust,
        Self::HighAdvance,
        Self::OutsideTable,
        Self::NotANumber,
    ];

    /// Word or words for it in reports and files, such as `standing` or `steep descent`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Valid => "valid",
            Self::Standing => "standing",
            Self::SteepDescent => "steep descent",
            Self::NegativeThrust => "negative thrust",
            Self::HighAdvance => "fast forward flight",
            Self::OutsideTable => "outside its table",
            Self::NotANumber => "not a number",
        }
    }
}

/// Blade-element momentum rotor: thrust, torque and inflow from rotor speed and velocity of the hub. For flight with
/// climb, descent, forward speed and wind.
///
/// ```
/// use sincro_aero::rotor::{Drag, Rotor, RotorSpec, Spin};
/// use sincro_geometry::spatial::Vec3;
///
/// let rotor = Rotor::new(RotorSpec {
///     radius: 0.2032,
///     chord: 0.025,
///     n_blades: 4,
///     lift_slope: 5.7,
///     collective_pitch: 0.1412,
///     drag: Drag { cd0: 0.0087, k_cd: 0.4 },
///     spin: Spin::CounterClockwise,
/// })
/// .unwrap();
/// let hover = rotor.evaluate(1.225, 720.6, Vec3([0.0, 0.0, 0.0]));
/// assert!((hover.thrust - 25.273).abs() < 1e-3); // a quarter of 10.305 kg
/// let climb = rotor.evaluate(1.225, 720.6, Vec3([0.0, 0.0, 1.0]));
/// assert!(climb.thrust < hover.thrust);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    spec: RotorSpec,
    /// A `[m²]`
    area: f64,
    /// σ
    solidity: f64,
    /// k₁
    lift: f64,
    /// σ(c₀ + c₂θ₀²)/8
    profile: f64,
    /// ¼σc₂
    incidence_drag: f64,
}

/// The flow at the hub of a rotor that turns forwards, or of the mirror image of one that does not.
#[derive(Clone, Copy)]
struct Flow<R> {
    /// −1 in the mirror, else 1.
    mirror: R,
    /// V
    tip: R,
    balance: Balance<R>,
}

impl Rotor {
    /// Creates the rotor of `spec` and computes what depends on the geometry alone (solidity, area, lift factor).
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] with one sentence for each field of `spec` that is out of the range stated there, not a
    /// number, or, of `n_blades`, zero.
    pub fn new(spec: RotorSpec) -> Result<Self, InvalidParameters> {
        let problems = problems(&spec);
        if !problems.is_empty() {
            return Err(InvalidParameters::new(problems));
        }
        let solidity = f64::from(spec.n_blades) * spec.chord / (PI * spec.radius);
        let pitch = spec.collective_pitch;
        Ok(Self {
            spec,
            area: PI * spec.radius * spec.radius,
            solidity,
            lift: solidity * spec.lift_slope / 8.0,
            profile: solidity * (spec.drag.cd0 + spec.drag.k_cd * pitch * pitch) / 8.0,
            incidence_drag: 0.25 * solidity * spec.drag.k_cd,
        })
    }

    /// Geometry and section coefficients from which the rotor was made.
    #[must_use]
    pub fn spec(&self) -> &RotorSpec {
        &self.spec
    }

    /// Area of the disc, π R² `[m²]`.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Solidity σ = n c/(π R), the ratio of blade area to disc area (dimensionless).
    #[must_use]
    pub fn solidity(&self) -> f64 {
        self.solidity
    }

    /// Thrust, reaction torque, inflow and power in air of `density` `[kg/m³]`, at `speed` `[rad/s]` (negative:
    /// backwards), with the hub moving at `velocity` `[m/s]` relative to the air, in the rotor's axes (z along the
    /// thrust).
    ///
    /// Finite for finite arguments (velocities beyond [`MAX_VELOCITY`](super::MAX_VELOCITY) count as that); NaN for
    /// others. On dual numbers the derivatives are exact.
    #[inline(always)]
    pub fn evaluate<R: Real>(&self, density: f64, speed: R, velocity: Vec3<R>) -> Load<R> {
        let flow = self.flow(speed, velocity);
        let w = flow.balance.inflow();
        self.load(density, &flow, w)
    }

    /// Load in ground effect: as [`evaluate`](Self::evaluate), with the hub at `height` `[m]` above level ground.
    ///
    /// The ground holds part of the induced velocity v_i back: w = v + κ v_i, κ = 1 − (R/4z)²/(1 + (h/v_i)²), with the
    /// height z, climb velocity v and in-plane velocity h. Source: key `cheeseman1955`, equations for hover and forward
    /// flight; v_i in the last term is that far from the ground. Heights below R/2, where the source sees its potential
    /// flow fail, count as R/2.
    #[inline(always)]
    pub fn evaluate_near_ground<R: Real>(&self, density: f64, speed: R, velocity: Vec3<R>, height: R) -> Load<R> {
        let mut flow = self.flow(speed, velocity);
        let balance = flow.balance;
        let induced = balance.inflow() - balance.climb;
        let square = induced * induced;
        let forward = square / (square + balance.in_plane_squared).max(R::splat(f64::MIN_POSITIVE));
        let ratio = R::splat(0.25 * self.spec.radius) / height.max(R::splat(0.5 * self.spec.radius));
        let kappa = R::one() - ratio * ratio * forward;
        // (w − v)/κ·√(w² + h²) + a w − S = 0, times κ, is the balance with κ a and κ S
        flow.balance = Balance { relief: kappa * balance.relief, supply: kappa * balance.supply, ..balance };
        let w = flow.balance.inflow();
        flow.balance = balance;
        self.load(density, &flow, w)
    }

    /// Thrust, torque and power of blade elements in an inflow `w` `[m/s]`.
    #[inline(always)]
    fn load<R: Real>(&self, density: f64, flow: &Flow<R>, w: R) -> Load<R> {
        let Flow { mirror, tip, balance } = *flow;
        let pitch = self.spec.collective_pitch;
        // T = 2ρA (S − k₁V w)
        let thrust = R::splat(2.0 * density * self.area) * (balance.supply - balance.relief * w);
        // Q/(ρAR), term by term: profile, induced, incidence
        let profile = R::splat(self.profile) * (tip * tip + balance.in_plane_squared);
        let induced = R::splat(4.0 * self.lift) * w * (R::splat(pitch / 3.0) * tip - R::splat(0.5) * w);
        let incidence = R::splat(self.incidence_drag) * w * (w - R::splat(4.0 * pitch / 3.0) * tip);
        let drag = R::splat(density * self.area) * ((profile + induced) + incidence);
        let reaction = R::splat(-self.spec.spin.sign() * self.spec.radius) * drag;
        let gyroscopic = [R::zero(); 2];
        Load { thrust: mirror * thrust, torque: mirror * reaction, inflow: mirror * w, power: drag * tip, gyroscopic }
    }

    /// Validity of `load`, which [`Rotor::evaluate`] returned for the same `speed` `[rad/s]` and `velocity` `[m/s]`
    /// (hub relative to the air, rotor axes). Of lanes, that of number `lane` is examined.
    #[must_use]
    pub fn validity<R: Real>(&self, speed: R, velocity: Vec3<R>, load: &Load<R>, lane: usize) -> Validity {
        let flow = self.flow(speed.lane(lane), Vec3(velocity.0.map(|x| x.lane(lane))));
        let Flow { mirror, tip, balance } = flow;
        // T/(2ρA), the square of the induced velocity in hover
        let thrust = balance.supply - balance.relief * (mirror * load.inflow.lane(lane));
        let induced = thrust.max(0.0).sqrt();
        let in_plane = balance.in_plane_squared.sqrt();
        if tip == 0.0 {
            Validity::Standing
        } else if balance.climb < -0.5 * induced && in_plane < 2.0 * induced {
            Validity::SteepDescent
        } else if thrust < 0.0 {
            Validity::NegativeThrust
        } else if in_plane > 0.5 * tip {
            Validity::HighAdvance
        } else {
            Validity::Valid
        }
    }

    #[inline(always)]
    fn flow<R: Real>(&self, speed: R, velocity: Vec3<R>) -> Flow<R> {
        let mirror = speed.if_less(R::zero(), R::splat(-1.0), R::one());
        let tip = limited(speed).abs() * R::splat(self.spec.radius);
        let [x, y, z] = velocity.0;
        // no closure: it would not be compiled for lanes
        let (x, y, z) = (limited(x), limited(y), limited(z));
        let square = x * x + y * y;
        // a square that underflows has no slope either: its root would make one of 1/0
        let in_plane_squared = square.if_less(R::splat(f64::MIN_POSITIVE), R::zero(), square);
        let supply =
            R::splat(self.lift * self.spec.collective_pitch) * (R::splat(2.0 / 3.0) * (tip * tip) + in_plane_squared);
        let balance = Balance { climb: mirror * z, in_plane_squared, relief: R::splat(self.lift) * tip, supply };
        Flow { mirror, tip, balance }
    }
}

fn problems(spec: &RotorSpec) -> Vec<String> {
    let mut out = Vec::new();
    let length = (1e-6, 1e6);
    out.extend(outside("radius", spec.radius, length, "m"));
    out.extend(outside("chord", spec.chord, length, "m"));
    out.extend(outside("lift_slope", spec.lift_slope, (1e-6, 1e3), "1/rad"));
    out.extend(outside("collective_pitch", spec.collective_pitch, (-FRAC_PI_2, FRAC_PI_2), "rad"));
    out.extend(outside("cd0", spec.drag.cd0, (0.0, 1e3), ""));
    out.extend(outside("k_cd", spec.drag.k_cd, (0.0, 1e3), "1/rad²"));
    if spec.n_blades == 0 {
        out.push("`n_blades` is 0: a rotor has at least one blade".to_owned());
    }
    out
}
