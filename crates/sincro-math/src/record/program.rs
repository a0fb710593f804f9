//! Straight-line programs: operations in the order of evaluation.

use core::ops::Range;

use super::recorder::{push, record};
use super::{Recorded, Unrecordable};
use crate::Real;
use crate::elementary::{self, Binary, Bits, Unary};

/// Operation of a [`Program`]; operands are indices of earlier operations.
#[derive(Clone, Copy, Debug)]
pub enum Operation {
    /// The same number in every evaluation.
    Constant(f64),
    /// Input number k of the program.
    Input(u32),
    /// Parameter number k of the lane.
    Parameter(u32),
    /// Sum.
    Add(u32, u32),
    /// Difference.
    Sub(u32, u32),
    /// Product.
    Mul(u32, u32),
    /// Quotient.
    Div(u32, u32),
    /// Opposite.
    Neg(u32),
    /// Square root; NaN below zero.
    Sqrt(u32),
    /// Absolute value.
    Abs(u32),
    /// Sine of an angle `[rad]`, as [`elementary::sin_cos`].
    Sin(u32),
    /// Cosine of an angle `[rad]`, as [`elementary::sin_cos`].
    Cos(u32),
    /// Elementary function of one argument.
    Unary(Unary, u32),
    /// Elementary function of two arguments.
    Binary(Binary, u32, u32),
    /// Selection `[a, b, then, otherwise]`: `then` where a < b, else `otherwise`, also where one is NaN.
    IfLess([u32; 4]),
    /// Magnitude of the first, sign of the second.
    CopySign(u32, u32),
    /// Selection `[n, odd, even]`: `odd` where the lowest bit of `n` is set, else `even`.
    IfOdd([u32; 3]),
    /// `x` with its sign flipped where bit `bit` of `n` is set.
    FlipBy {
        /// Number whose sign is flipped.
        x: u32,
        /// Number whose bits are looked at.
        n: u32,
        /// Index of the bit, 0 for the lowest.
        bit: u32,
    },
}

/// Operations are equal if they are the same to the bit, also constants that are no numbers.
impl PartialEq for Operation {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Operation {
    /// Operands, in the order in which [`Operation::apply`] takes their values.
    #[must_use]
    pub fn operands(&self) -> Vec<u32> {
        match *self {
            Self::Constant(_) | Self::Input(_) | Self::Parameter(_) => Vec::new(),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) | Self::CopySign(a, b) => vec![a, b],
            Self::Neg(a) | Self::Sqrt(a) | Self::Abs(a) | Self::Sin(a) | Self::Cos(a) | Self::Unary(_, a) => vec![a],
            Self::Binary(_, a, b) => vec![a, b],
            Self::IfLess(all) => all.to_vec(),
            Self::IfOdd(all) => all.to_vec(),
            Self::FlipBy { x, n, .. } => vec![x, n],
        }
    }

    /// The same operation on other operands.
    #[must_use]
    fn with_operands(&self, to: impl Fn(u32) -> u32) -> Self {
        match *self {
            Self::Constant(_) | Self::Input(_) | Self::Parameter(_) => *self,
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Sub(a, b) => Self::Sub(to(a), to(b)),
            Self::Mul(a, b) => Self::Mul(to(a), to(b)),
            Self::Div(a, b) => Self::Div(to(a), to(b)),
            Self::CopySign(a, b) => Self::CopySign(to(a), to(b)),
            Self::Neg(a) => Self::Neg(to(a)),
            Self::Sqrt(a) => Self::Sqrt(to(a)),
            Self::Abs(a) => Self::Abs(to(a)),
            Self::Sin(a) => Self::Sin(to(a)),
            Self::Cos(a) => Self::Cos(to(a)),
            Self::Unary(f, a) => Self::Unary(f, to(a)),
            Self::Binary(f, a, b) => Self::Binary(f, to(a), to(b)),
            Self::IfLess(all) => Self::IfLess(all.map(to)),
            Self::IfOdd(all) => Self::IfOdd(all.map(to)),
            Self::FlipBy { x, n, bit } => Self::FlipBy { x: to(x), n: to(n), bit },
        }
    }

    /// Result of the operation for the values of its operands.
    ///
    /// # Panics
    ///
    /// If there are fewer values than operands, or if it is an input or a parameter, which have none.
    #[must_use]
    pub fn apply(&self, x: &[f64]) -> f64 {
        match *self {
            Self::Constant(x) => x,
            Self::Input(_) | Self::Parameter(_) => panic!("inputs and parameters are given, not computed"),
            Self::Add(..) => x[0] + x[1],
            Self::Sub(..) => x[0] - x[1],
            Self::Mul(..) => x[0] * x[1],
            Self::Div(..) => x[0] / x[1],
            Self::Neg(_) => -x[0],
            Self::Sqrt(_) => x[0].sqrt(),
            Self::Abs(_) => x[0].abs(),
            Self::Sin(_) => elementary::sin_cos(x[0]).0,
            Self::Cos(_) => elementary::sin_cos(x[0]).1,
            Self::Unary(f, _) => x[0].unary(f),
            Self::Binary(f, ..) => x[0].binary(f, x[1]),
            Self::IfLess(_) => x[0].if_less(x[1], x[2], x[3]),
            Self::CopySign(..) => x[0].copysign(x[1]),
            Self::IfOdd(_) => Bits::if_odd(x[0], x[1], x[2]),
            Self::FlipBy { bit: 0, .. } => x[0].flip_by::<0>(x[1]),
            Self::FlipBy { bit: 1, .. } => x[0].flip_by::<1>(x[1]),
            Self::FlipBy { .. } => panic!("bits 0 and 1 alone are used"),
        }
    }

    /// Numbers by which equal operations are known.
    pub(super) fn key(&self) -> [u64; 5] {
        let kind = match self {
            Self::Constant(x) => return [0, x.to_bits(), 0, 0, 0],
            Self::Input(k) => return [1, u64::from(*k), 0, 0, 0],
            Self::Parameter(k) => return [2, u64::from(*k), 0, 0, 0],
            Self::Add(..) => 3,
            Self::Sub(..) => 4,
            Self::Mul(..) => 5,
            Self::Div(..) => 6,
            Self::Neg(_) => 7,
            Self::Sqrt(_) => 8,
            Self::Abs(_) => 9,
            Self::Sin(_) => 10,
            Self::Cos(_) => 11,
            Self::IfLess(_) => 12,
            Self::CopySign(..) => 13,
            Self::IfOdd(_) => 14,
            Self::FlipBy { bit, .. } => 15 + u64::from(*bit),
            Self::Unary(f, _) => 100 + *f as u64,
            Self::Binary(f, ..) => 200 + *f as u64,
        };
        let operands = self.operands();
        let of = |k: usize| operands.get(k).map_or(0, |x| u64::from(*x));
        [kind, of(0), of(1), of(2), of(3)]
    }
}

/// Straight-line program: what [`record`] returns. It has no operation that no output needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    operations: Vec<Operation>,
    outputs: Vec<u32>,
    n_inputs: usize,
    /// For each parameter its values in the lanes.
    parameters: Vec<Vec<f64>>,
}

impl Program {
    /// Program of the operations that `outputs` need.
    pub(super) fn new(
        all: Vec<Operation>,
        mut outputs: Vec<u32>,
        n_inputs: usize,
        mut parameters: Vec<Vec<f64>>,
    ) -> Self {
        let mut is_needed = vec![false; all.len()];
        for &output in &outputs {
            is_needed[output as usize] = true;
        }
        for k in (0..all.len()).rev().filter(|&k| !all[k].operands().is_empty()) {
            if is_needed[k] {
                all[k].operands().iter().for_each(|&x| is_needed[x as usize] = true);
            }
        }
        // Constants come right before their first use, and operands of sums and products in the order of evaluation:
        // two recordings of one algorithm are equal also where one met a constant earlier, in what nothing needs.
        let (mut new, mut operations): (Vec<Option<u32>>, Vec<Operation>) = (vec![None; all.len()], Vec::new());
        let mut kept = Vec::new();
        let is_constant = |k: u32| matches!(all[k as usize], Operation::Constant(_));
        let emit_constants = |of: &[u32], new: &mut [Option<u32>], operations: &mut Vec<Operation>| {
            for &k in of.iter().filter(|&&k| is_constant(k)) {
                if new[k as usize].is_none() {
                    new[k as usize] = Some(operations.len() as u32);
                    operations.push(all[k as usize]);
                }
            }
        };
        for k in (0..all.len()).filter(|&k| is_needed[k] && !is_constant(k as u32)) {
            emit_constants(&all[k].operands(), &mut new, &mut operations);
            let operation = match all[k] {
                Operation::Parameter(p) => {
                    kept.push(core::mem::take(&mut parameters[p as usize]));
                    Operation::Parameter(kept.len() as u32 - 1)
                }
                other => other.with_operands(|x| new[x as usize].expect("operands come before what needs them")),
            };
            new[k] = Some(operations.len() as u32);
            operations.push(match operation {
                Operation::Add(a, b) => Operation::Add(a.min(b), a.max(b)),
                Operation::Mul(a, b) => Operation::Mul(a.min(b), a.max(b)),
                other => other,
            });
        }
        emit_constants(&outputs, &mut new, &mut operations);
        outputs.iter_mut().for_each(|x| *x = new[*x as usize].expect("outputs are needed"));
        Self { operations, outputs, n_inputs, parameters: kept }
    }

    /// Operations in the order of evaluation.
    #[must_use]
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Indices of the operations whose results are the outputs, in their order.
    #[must_use]
    pub fn outputs(&self) -> &[u32] {
        &self.outputs
    }

    /// Number of inputs.
    #[must_use]
    pub fn n_inputs(&self) -> usize {
        self.n_inputs
    }

    /// Parameters: for each its values in the lanes of the recording.
    #[must_use]
    pub fn parameters(&self) -> &[Vec<f64>] {
        &self.parameters
    }

    /// Number of operations that compute something: all but constants, inputs and parameters.
    #[must_use]
    pub fn n_computed(&self) -> usize {
        self.operations.iter().filter(|x| !x.operands().is_empty()).count()
    }

    /// Returns true if the program calls elementary functions other than sine and cosine.
    #[must_use]
    pub fn has_calls(&self) -> bool {
        self.operations.iter().any(|x| matches!(x, Operation::Unary(..) | Operation::Binary(..)))
    }

    /// Results of the program for recorded inputs, in the recording under way: its operations become part of that.
    ///
    /// # Panics
    ///
    /// If there are fewer `inputs` than the program has, or if its parameters have another number of lanes than the
    /// recording.
    ///
    /// ```
    /// use sincro_math::record::record;
    ///
    /// let square = record(1, 1, |x| vec![x[0] * x[0]]).unwrap();
    /// let fourth = record(1, 1, |x| square.replay(&square.replay(x))).unwrap();
    /// assert_eq!(fourth.evaluate(&[3.0], 0), [81.0]);
    /// ```
    #[must_use]
    pub fn replay(&self, inputs: &[Recorded]) -> Vec<Recorded> {
        let values = self.replayed(inputs);
        self.outputs.iter().map(|&x| values[x as usize]).collect()
    }

    /// Results of all operations for recorded inputs.
    fn replayed(&self, inputs: &[Recorded]) -> Vec<Recorded> {
        let mut values: Vec<Recorded> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            values.push(match operation {
                Operation::Input(k) => inputs[*k as usize],
                Operation::Parameter(k) => Recorded::from_lanes(|lane| self.parameters[*k as usize][lane]),
                other => push(other.with_operands(|x| values[x as usize].0)),
            });
        }
        values
    }

    /// Evaluates the outputs for `inputs`, with the parameters of lane `lane` (others than those of the recording: of
    /// the last one). The bits are those of the recorded algorithm.
    ///
    /// # Panics
    ///
    /// If there are fewer `inputs` than the program has.
    #[must_use]
    pub fn evaluate(&self, inputs: &[f64], lane: usize) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            values.push(match operation {
                Operation::Input(k) => inputs[*k as usize],
                Operation::Parameter(k) => {
                    let of_lanes = &self.parameters[*k as usize];
                    of_lanes[lane.min(of_lanes.len() - 1)]
                }
                other => {
                    let mut x = [0.0; 4];
                    other.operands().iter().zip(&mut x).for_each(|(&k, x)| *x = values[k as usize]);
                    other.apply(&x)
                }
            });
        }
        self.outputs.iter().map(|&x| values[x as usize]).collect()
    }

    /// The same program with each operation on constants and parameters alone done once for every lane: its results are
    /// parameters.
    ///
    /// ```
    /// use sincro_math::Real;
    /// use sincro_math::record::{Recorded, record};
    ///
    /// let masses = [1.0, 4.0];
    /// let program = record(1, 2, |x| vec![x[0] / Recorded::from_lanes(|lane| masses[lane]).sqrt()]).unwrap();
    /// let folded = program.with_folded_parameters();
    /// assert_eq!((program.n_computed(), folded.n_computed()), (2, 1));
    /// assert_eq!(folded.evaluate(&[6.0], 1), [3.0]);
    /// ```
    #[must_use]
    pub fn with_folded_parameters(&self) -> Self {
        let n_lanes = self.parameters.first().map_or(1, Vec::len);
        // values in the lanes, of what no input decides
        let mut known: Vec<Option<Vec<f64>>> = Vec::with_capacity(self.operations.len());
        let (mut operations, mut parameters) = (Vec::with_capacity(self.operations.len()), Vec::new());
        for operation in &self.operations {
            let values = match operation {
                Operation::Input(_) => None,
                Operation::Constant(x) => Some(vec![*x; n_lanes]),
                Operation::Parameter(k) => Some(self.parameters[*k as usize].clone()),
                other => {
                    let operands: Option<Vec<&Vec<f64>>> =
                        other.operands().iter().map(|&x| known[x as usize].as_ref()).collect();
                    operands.map(|x| {
                        let of_lane = |lane: usize| x.iter().map(|x| x[lane]).collect::<Vec<f64>>();
                        (0..n_lanes).map(|lane| other.apply(&of_lane(lane))).collect()
                    })
                }
            };
            operations.push(match &values {
                Some(values) if !matches!(operation, Operation::Constant(_)) => {
                    parameters.push(values.clone());
                    Operation::Parameter(parameters.len() as u32 - 1)
                }
                _ => *operation,
            });
            known.push(values);
        }
        Self::new(operations, self.outputs.clone(), self.n_inputs, parameters)
    }

    /// Program of the same inputs with the partial derivatives of the outputs after them: of all outputs by the first
    /// input of `by`, then by the second, and so on (forward-mode differentiation). A selection has the derivative of
    /// what it selects, an absolute value at zero that from above.
    ///
    /// # Errors
    ///
    /// [`Unrecordable`] if the program looks at bits, as [`sin_cos_of_operations`](super::sin_cos_of_operations) does,
    /// or calls elementary functions ([`Program::has_calls`]).
    ///
    /// ```
    /// use sincro_math::Real;
    /// use sincro_math::record::record;
    ///
    /// let program = record(2, 1, |x| vec![x[0] * x[0] * x[1].sin_cos().0])?; // x² sin y
    /// let with_partials = program.with_partials(0..2)?;
    /// let (s, c) = sincro_math::elementary::sin_cos(0.5);
    /// assert_eq!(with_partials.evaluate(&[3.0, 0.5], 0), [9.0 * s, 6.0 * s, 9.0 * c]);
    /// # Ok::<(), sincro_math::record::Unrecordable>(())
    /// ```
    pub fn with_partials(&self, by: Range<usize>) -> Result<Self, Unrecordable> {
        record(self.n_inputs, self.parameters.first().map_or(1, Vec::len), |inputs| {
            let values = self.replayed(inputs);
            let mut outputs: Vec<Recorded> = self.outputs.iter().map(|&x| values[x as usize]).collect();
            for input in by {
                let partials = self.partials(input as u32, &values);
                outputs.extend(self.outputs.iter().map(|&x| partials[x as usize]));
            }
            outputs
        })
    }

    /// Partial derivatives of all operations by input `by`, in a recording where they have `values`.
    fn partials(&self, by: u32, values: &[Recorded]) -> Vec<Recorded> {
        use Operation::{Abs, Add, Constant, CopySign, Cos, Div, FlipBy, IfLess, IfOdd, Input, Mul, Neg, Parameter};
        use Operation::{Sin, Sqrt, Sub};
        let (zero, one) = (Recorded::zero(), Recorded::one());
        let mut partials: Vec<Recorded> = Vec::with_capacity(self.operations.len());
        for (k, operation) in self.operations.iter().enumerate() {
            let x = |i: u32| values[i as usize];
            let d = |i: u32| partials[i as usize];
            partials.push(match *operation {
                Input(i) => [zero, one][usize::from(i == by)],
                Constant(_) | Parameter(_) => zero,
                Add(a, b) => d(a) + d(b),
                Sub(a, b) => d(a) - d(b),
                Mul(a, b) => d(a) * x(b) + x(a) * d(b),
                Div(a, b) => (d(a) - values[k] * d(b)) / x(b),
                Neg(a) => -d(a),
                Sqrt(a) => d(a) / (Recorded::splat(2.0) * values[k]),
                Abs(a) => x(a).if_less(zero, -d(a), d(a)),
                Sin(a) => x(a).sin_cos().1 * d(a),
                Cos(a) => -(x(a).sin_cos().0 * d(a)),
                IfLess([a, b, then, otherwise]) => x(a).if_less(x(b), d(then), d(otherwise)),
                CopySign(..) | IfOdd(_) | FlipBy { .. } => {
                    super::recorder::fail("it looks at bits, which have no derivative");
                    zero
                }
                Operation::Unary(..) | Operation::Binary(..) => {
                    super::recorder::fail("it calls a function whose derivative is not recorded");
                    zero
                }
            });
        }
        partials
    }
}
