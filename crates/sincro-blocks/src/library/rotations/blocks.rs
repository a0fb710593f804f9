//! All blocks of rotations, as a table: each maps one or two arrays to another.

use super::algebra::{
    Convention, angular_velocity, body_torque, conjugate, euler_rates, euler_to_matrix, euler_to_quaternion,
    euler_torque, matrix_to_euler, matrix_to_quaternion, product, quaternion_rate, quaternion_to_matrix, rotate,
};
use crate::library::prelude::*;

/// Block of category rotations, one for each [`Map`]; use the aliases, such as [`EulerToQuaternion`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rotation<const MAP: usize> {
    /// Order and axes of the three Euler angles, for the maps that have them.
    pub convention: Convention,
    /// Option of the map, if it has one: `inverse` of `rotate-vector`, `world` of
    /// `angular-velocity-to-quaternion-rate`, `transposed` of the Euler rates.
    pub option: bool,
}

/// Map between representations of rotations or of their rates, the parameter of [`Rotation`]. Quaternions are (w, x, y,
/// z), matrices 9 numbers row by row, angles `[rad]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// Euler angles to quaternion.
    EulerToQuaternion,
    /// Quaternion to Euler angles.
    QuaternionToEuler,
    /// Euler angles to rotation matrix.
    EulerToMatrix,
    /// Rotation matrix to Euler angles.
    MatrixToEuler,
    /// Quaternion to rotation matrix.
    QuaternionToMatrix,
    /// Rotation matrix to quaternion.
    MatrixToQuaternion,
    /// Vector rotated by a quaternion.
    RotateVector,
    /// Product of two quaternions.
    QuaternionProduct,
    /// Conjugate of a quaternion.
    QuaternionConjugate,
    /// Angular velocity `[rad/s]` to the rate of a quaternion `[1/s]`.
    AngularVelocityToQuaternionRate,
    /// Angular velocity `[rad/s]` to rates of Euler angles `[rad/s]`.
    EulerRates,
    /// Rates of Euler angles `[rad/s]` to angular velocity `[rad/s]`.
    EulerRatesToAngularVelocity,
}

/// Block `euler-to-quaternion`: unit quaternion (w, x, y, z) of three Euler angles `[rad]`; the parameter `convention`
/// gives their order.
pub type EulerToQuaternion = Rotation<{ Map::EulerToQuaternion as usize }>;
/// Block `quaternion-to-euler`: three Euler angles `[rad]` of a quaternion (w, x, y, z), which need not be of unit
/// length. Where the middle angle is ±π/2, yaw (or α) is taken as zero.
pub type QuaternionToEuler = Rotation<{ Map::QuaternionToEuler as usize }>;
/// Block `euler-to-matrix`: rotation matrix (9 numbers, row by row, dimensionless) of three Euler angles `[rad]`.
pub type EulerToMatrix = Rotation<{ Map::EulerToMatrix as usize }>;
/// Block `matrix-to-euler`: three Euler angles `[rad]` of a rotation matrix (9 numbers, row by row). Where the middle
/// angle is ±π/2, yaw (or α) is taken as zero.
pub type MatrixToEuler = Rotation<{ Map::MatrixToEuler as usize }>;
/// Block `quaternion-to-matrix`: rotation matrix (9 numbers, row by row) of a quaternion (w, x, y, z), which need not
/// be of unit length; dimensionless.
pub type QuaternionToMatrix = Rotation<{ Map::QuaternionToMatrix as usize }>;
/// Block `matrix-to-quaternion`: unit quaternion (w, x, y, z) with w ≥ 0 of a rotation matrix (9 numbers, row by row);
/// dimensionless.
pub type MatrixToQuaternion = Rotation<{ Map::MatrixToQuaternion as usize }>;
/// Block `rotate-vector`: vector (3 components, any unit) rotated by a quaternion (w, x, y, z), which need not be of
/// unit length: with q_wb, from components in B to components in W; the reverse with the option `inverse`.
pub type RotateVector = Rotation<{ Map::RotateVector as usize }>;
/// Block `quaternion-product`: product of two quaternions (w, x, y, z), q_wc = q_wb ⊗ q_bc for `u1` and `u2`: first the
/// rotation `u2`, then `u1` (dimensionless).
pub type QuaternionProduct = Rotation<{ Map::QuaternionProduct as usize }>;
/// Block `quaternion-conjugate`: conjugate of a quaternion (w, x, y, z), the inverse rotation if it is of unit length
/// (dimensionless).
pub type QuaternionConjugate = Rotation<{ Map::QuaternionConjugate as usize }>;
/// Block `angular-velocity-to-quaternion-rate`: rate `[1/s]` of a quaternion (w, x, y, z) from the angular velocity `w`
/// (3 components, `[rad/s]`), in the axes of the body or, with the option `world`, of the world.
pub type AngularVelocityToQuaternionRate = Rotation<{ Map::AngularVelocityToQuaternionRate as usize }>;
/// Block `euler-rates`: rates of three Euler angles `[rad/s]` from the angular velocity `w` `[rad/s]` in the axes of
/// the body; with the option `transposed`, torques `[N·m]` about the axes of the body from torques about the axes of
/// the angles, of the same power. Not finite where the middle angle is ±π/2.
pub type EulerRates = Rotation<{ Map::EulerRates as usize }>;
/// Block `euler-rates-to-angular-velocity`: angular velocity `[rad/s]` in the axes of the body from rates of three
/// Euler angles `[rad/s]`: the inverse of [`EulerRates`].
pub type EulerRatesToAngularVelocity = Rotation<{ Map::EulerRatesToAngularVelocity as usize }>;

/// A map as the diagram sees it.
struct Row {
    map: Map,
    kind: Kind,
    /// Name and width of the inputs.
    inputs: &'static [(&'static str, usize)],
    /// Width of the output.
    output: usize,
    /// Label, then that with the option; `…` stands for the convention.
    labels: [&'static str; 2],
}

const CONVENTION: Parameter = Parameter::optional(
    "convention",
    ValueKind::Choice(Convention::WORDS),
    "zyx: roll, pitch, yaw with R = Rz(yaw)·Ry(pitch)·Rx(roll); xyz: α, β, γ with R = Rx(α)·Ry(β)·Rz(γ), as in V-REP",
    "zyx",
);
const INVERSE: Parameter = Parameter::optional("inverse", ValueKind::Flag, "turns back", "false");
const WORLD: Parameter =
    Parameter::optional("world", ValueKind::Flag, "takes the angular velocity in the axes of the world", "false");
const TRANSPOSED: Parameter = Parameter::optional(
    "transposed",
    ValueKind::Flag,
    "transposes the matrix, as for torques and in the laws of Lyapunov's method",
    "false",
);

/// A row whose label does not depend on the option.
const fn row(
    map: Map,
    (name, summary, equation): (&'static str, &'static str, &'static str),
    parameters: &'static [Parameter],
    inputs: &'static [(&'static str, usize)],
    output: usize,
    label: &'static str,
) -> Row {
    let kind = Kind { name, category: Category::Rotations, summary, equation, parameters };
    Row { map, kind, inputs, output, labels: [label; 2] }
}

/// By [`Map`].
const ROWS: [Row; 12] = [
    row(
        Map::EulerToQuaternion,
        ("euler-to-quaternion", "The quaternion of Euler angles.", "y = q(u)"),
        &[CONVENTION],
        &[("u", 3)],
        4,
        "… → q",
    ),
    row(
        Map::QuaternionToEuler,
        ("quaternion-to-euler", "Euler angles of a quaternion.", "u = q(y)"),
        &[CONVENTION],
        &[("u", 4)],
        3,
        "q → …",
    ),
    row(
        Map::EulerToMatrix,
        ("euler-to-matrix", "The rotation matrix of Euler angles.", "y = R(u)"),
        &[CONVENTION],
        &[("u", 3)],
        9,
        "… → R",
    ),
    row(
        Map::MatrixToEuler,
        ("matrix-to-euler", "Euler angles of a rotation matrix.", "u = R(y)"),
        &[CONVENTION],
        &[("u", 9)],
        3,
        "R → …",
    ),
    row(
        Map::QuaternionToMatrix,
        ("quaternion-to-matrix", "The rotation matrix of a quaternion.", "y = R(u/|u|)"),
        &[],
        &[("u", 4)],
        9,
        "q → R",
    ),
    row(
        Map::MatrixToQuaternion,
        ("matrix-to-quaternion", "The quaternion of a rotation matrix.", "u = R(y), w ≥ 0"),
        &[],
        &[("u", 9)],
        4,
        "R → q",
    ),
    Row {
        labels: ["Rv", "Rᵀv"],
        ..row(
            Map::RotateVector,
            ("rotate-vector", "Turns a vector by a quaternion.", "y = R(q)·v, or Rᵀ(q)·v if inverse"),
            &[INVERSE],
            &[("q", 4), ("v", 3)],
            3,
            "",
        )
    },
    row(
        Map::QuaternionProduct,
        ("quaternion-product", "One rotation after another.", "y = u1 ⊗ u2"),
        &[],
        &[("u1", 4), ("u2", 4)],
        4,
        "⊗",
    ),
    row(
        Map::QuaternionConjugate,
        ("quaternion-conjugate", "The rotation back.", "y = (w, −x, −y, −z)"),
        &[],
        &[("u", 4)],
        4,
        "q*",
    ),
    row(
        Map::AngularVelocityToQuaternionRate,
        (
            "angular-velocity-to-quaternion-rate",
            "The rate of a quaternion from an angular velocity.",
            "y = q ⊗ (0, w)/2, or (0, w) ⊗ q/2 with world axes",
        ),
        &[WORLD],
        &[("q", 4), ("w", 3)],
        4,
        "q' = ½q ⊗ ω",
    ),
    Row {
        labels: ["ω → φ'", "E⁻ᵀ·w"],
        ..row(
            Map::EulerRates,
            (
                "euler-rates",
                "Rates of Euler angles from the angular velocity of the body.",
                "y = E⁻¹(euler)·w, or E⁻ᵀ(euler)·w if transposed; w = E(euler)·euler'",
            ),
            &[CONVENTION, TRANSPOSED],
            &[("euler", 3), ("w", 3)],
            3,
            "",
        )
    },
    Row {
        labels: ["φ' → ω", "Eᵀ·τ"],
        ..row(
            Map::EulerRatesToAngularVelocity,
            (
                "euler-rates-to-angular-velocity",
                "The angular velocity of a body, in its own axes, from rates of its Euler angles.",
                "y = E(euler)·rates, or Eᵀ(euler)·rates if transposed",
            ),
            &[CONVENTION, TRANSPOSED],
            &[("euler", 3), ("rates", 3)],
            3,
            "",
        )
    },
];

// a type alias names its row by the map
const _: () = {
    let mut k = 0;
    while k < ROWS.len() {
        assert!(ROWS[k].map as usize == k);
        k += 1;
    }
};

impl<const MAP: usize> Rotation<MAP> {
    const ROW: &'static Row = &ROWS[MAP];

    /// Creates the block for a convention of Euler angles (ignored by maps without them), with its option off.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention, option: false }
    }
}

impl<const MAP: usize> Described for Rotation<MAP> {
    const KIND: &'static Kind = &Self::ROW.kind;

    fn read(p: &mut Reader<'_>) -> Self {
        let mut new = Self::default();
        for parameter in Self::KIND.parameters {
            match parameter.takes {
                ValueKind::Flag => new.option = p.flag(parameter.name),
                _ => new.convention = <Choice as ParameterType<Convention>>::read(p, parameter.name),
            }
        }
        new
    }
}

impl<const MAP: usize> Block for Rotation<MAP> {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn runs_in_lanes(&self) -> bool {
        !matches!(Self::ROW.map, Map::QuaternionToEuler | Map::MatrixToEuler | Map::MatrixToQuaternion)
    }

    fn ports(&self) -> Ports {
        let inputs: Vec<&str> = Self::ROW.inputs.iter().map(|(name, _)| *name).collect();
        Ports::new(&inputs, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        for ((name, expected), width) in Self::ROW.inputs.iter().zip(inputs) {
            if let Some(width) = width
                && width != expected
            {
                return Err(format!("`{name}` has {expected} components here, it gets {width}"));
            }
        }
        Ok(vec![Some(Self::ROW.output)])
    }

    fn unit_rule(&self) -> UnitRule {
        match Self::ROW.map {
            Map::QuaternionToEuler | Map::MatrixToEuler => UnitRule::fixed(["rad"]),
            Map::EulerToQuaternion
            | Map::EulerToMatrix
            | Map::QuaternionToMatrix
            | Map::MatrixToQuaternion
            | Map::QuaternionProduct
            | Map::QuaternionConjugate => UnitRule::fixed(["1"]),
            Map::AngularVelocityToQuaternionRate => UnitRule::fixed(["1/s"]),
            // a matrix without unit times the second input: rates, or torques if transposed
            Map::RotateVector | Map::EulerRates | Map::EulerRatesToAngularVelocity => UnitRule::Same(vec![1]),
        }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let Self { convention, option } = *self;
        match Self::ROW.map {
            Map::EulerToQuaternion => y.copy_from_slice(&euler_to_quaternion(array(at, 0), convention)),
            Map::QuaternionToEuler => {
                y.copy_from_slice(&matrix_to_euler(quaternion_to_matrix(array(at, 0)), convention));
            }
            Map::EulerToMatrix => y.copy_from_slice(&euler_to_matrix(array(at, 0), convention)),
            Map::MatrixToEuler => y.copy_from_slice(&matrix_to_euler(array(at, 0), convention)),
            Map::QuaternionToMatrix => y.copy_from_slice(&quaternion_to_matrix(array(at, 0))),
            Map::MatrixToQuaternion => y.copy_from_slice(&matrix_to_quaternion(array(at, 0))),
            Map::RotateVector => y.copy_from_slice(&rotate(quaternion_to_matrix(array(at, 0)), array(at, 1), option)),
            Map::QuaternionProduct => y.copy_from_slice(&product(array(at, 0), array(at, 1))),
            Map::QuaternionConjugate => y.copy_from_slice(&conjugate(array(at, 0))),
            Map::AngularVelocityToQuaternionRate => {
                y.copy_from_slice(&quaternion_rate(array(at, 0), array(at, 1), option));
            }
            Map::EulerRates => {
                let (angles, u) = (array(at, 0), array(at, 1));
                let product =
                    if option { body_torque(angles, u, convention) } else { euler_rates(angles, u, convention) };
                y.copy_from_slice(&product);
            }
            Map::EulerRatesToAngularVelocity => {
                let (angles, u) = (array(at, 0), array(at, 1));
                let product =
                    if option { euler_torque(angles, u, convention) } else { angular_velocity(angles, u, convention) };
                y.copy_from_slice(&product);
            }
        }
    }

    fn label(&self) -> String {
        let label = Self::ROW.labels[usize::from(self.option)];
        label.replace('…', self.convention.word())
    }
}

/// An input as an array.
#[inline(always)]
fn array<R: Real, const N: usize>(at: &At<'_, R>, input: usize) -> [R; N] {
    let u = at.input(input);
    core::array::from_fn(|k| u[k])
}
