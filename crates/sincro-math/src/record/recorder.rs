//! The recording of a thread: operations pushed by recorded numbers, made simpler where that is exact.

use core::cell::RefCell;
use core::fmt;
use std::collections::BTreeMap;

use super::program::{Operation, Program};
use super::recorded::Recorded;

/// Index of the constant +0, which a recorded number is by default.
const ZERO: u32 = 0;

thread_local! {
    static RECORDER: RefCell<Option<Recorder>> = const { RefCell::new(None) };
}

/// Reason for which an algorithm cannot be recorded, in words that continue "it cannot be compiled: ".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unrecordable(pub String);

impl fmt::Display for Unrecordable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unrecordable {}

/// Records the operations of `algorithm`, which takes `n_inputs` numbers and returns its results. `n_lanes` is the
/// number of worlds that the program is for: numbers that [`Real::from_lanes`](crate::Real::from_lanes) finds different
/// among them are its parameters.
///
/// # Errors
///
/// [`Unrecordable`] if the algorithm asks for the value of a number that is not known yet, or calls a function of its
/// own by [`Real::map`](crate::Real::map).
///
/// # Panics
///
/// If the thread is recording already.
///
/// ```
/// use sincro_math::Real;
/// use sincro_math::record::record;
///
/// fn kinetic_energy<R: Real>(mass: f64, v: R) -> R {
///     R::splat(0.5 * mass) * v * v
/// }
///
/// let program = record(1, 1, |inputs| vec![kinetic_energy(2.0, inputs[0])]).unwrap();
/// assert_eq!(program.evaluate(&[3.0], 0), [9.0]);
/// assert_eq!(program.n_computed(), 1); // 0.5·2 is 1, and 1·v is v
/// let refused = record(1, 1, |inputs| vec![if inputs[0].lane(0) > 0.0 { inputs[0] } else { -inputs[0] }]);
/// assert_eq!(refused.unwrap_err().to_string(), "it branches on a computed number");
/// ```
pub fn record(
    n_inputs: usize,
    n_lanes: usize,
    algorithm: impl FnOnce(&[Recorded]) -> Vec<Recorded>,
) -> Result<Program, Unrecordable> {
    /// Ends the recording of this thread, also when the algorithm panics.
    struct End;
    impl Drop for End {
        fn drop(&mut self) {
            RECORDER.set(None);
        }
    }
    let old = RECORDER.replace(Some(Recorder::new(n_lanes)));
    assert!(old.is_none(), "one recording at a time");
    let _end = End;
    let inputs: Vec<Recorded> = (0..n_inputs).map(|k| push(Operation::Input(k as u32))).collect();
    let outputs = algorithm(&inputs);
    let recorder = RECORDER.take().expect("it is recording");
    match recorder.failure {
        Some(reason) => Err(Unrecordable(reason.to_owned())),
        None => {
            let outputs = outputs.iter().map(|x| x.0).collect();
            Ok(Program::new(recorder.operations, outputs, n_inputs, recorder.parameters))
        }
    }
}

struct Recorder {
    operations: Vec<Operation>,
    /// Index of each operation that is there, by its key.
    known: BTreeMap<[u64; 5], u32>,
    n_lanes: usize,
    /// Values of each parameter in the lanes.
    parameters: Vec<Vec<f64>>,
    /// Index of each parameter that is there, by the bits of its values.
    known_parameters: BTreeMap<Vec<u64>, u32>,
    failure: Option<&'static str>,
}

/// Adds an operation to the recording of this thread, or finds its result there.
pub(super) fn push(operation: Operation) -> Recorded {
    Recorded(with(|recorder| recorder.push(operation)))
}

/// Value of a number that is the same in every evaluation.
pub(super) fn constant(x: Recorded) -> Option<f64> {
    if x.0 == ZERO { Some(0.0) } else { with(|recorder| recorder.constant(x.0)) }
}

/// Notes why the recording fails; the first reason stays.
pub(super) fn fail(reason: &'static str) {
    with(|recorder| {
        recorder.failure.get_or_insert(reason);
    });
}

pub(super) fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Recorded {
    let n_lanes = with(|recorder| recorder.n_lanes);
    let values: Vec<f64> = (0..n_lanes).map(&mut f).collect();
    let same = values.iter().all(|x| x.to_bits() == values[0].to_bits());
    Recorded(with(|recorder| {
        if same {
            return recorder.push(Operation::Constant(values[0]));
        }
        let bits: Vec<u64> = values.iter().map(|x| x.to_bits()).collect();
        let next = recorder.parameters.len() as u32;
        let k = *recorder.known_parameters.entry(bits).or_insert(next);
        if k == next {
            recorder.parameters.push(values);
        }
        recorder.push(Operation::Parameter(k))
    }))
}

fn with<T>(f: impl FnOnce(&mut Recorder) -> T) -> T {
    RECORDER.with_borrow_mut(|recorder| f(recorder.as_mut().expect("recorded numbers exist in a recording only")))
}

impl Recorder {
    fn new(n_lanes: usize) -> Self {
        let mut new = Self {
            operations: Vec::new(),
            known: BTreeMap::new(),
            n_lanes: n_lanes.max(1),
            parameters: Vec::new(),
            known_parameters: BTreeMap::new(),
            failure: None,
        };
        assert_eq!(new.add(Operation::Constant(0.0)), ZERO);
        new
    }

    fn constant(&self, x: u32) -> Option<f64> {
        match self.operations[x as usize] {
            Operation::Constant(x) => Some(x),
            _ => None,
        }
    }

    fn negated(&self, x: u32) -> Option<u32> {
        match self.operations[x as usize] {
            Operation::Neg(x) => Some(x),
            _ => None,
        }
    }

    fn add(&mut self, operation: Operation) -> u32 {
        let key = operation.key();
        if let Some(&k) = self.known.get(&key) {
            return k;
        }
        let k = self.operations.len() as u32;
        self.operations.push(operation);
        self.known.insert(key, k);
        k
    }

    fn number(&mut self, x: f64) -> u32 {
        self.add(Operation::Constant(x))
    }

    /// Adds an operation in its simplest form.
    fn push(&mut self, operation: Operation) -> u32 {
        use Operation::{Abs, Add, Constant, CopySign, Cos, Div, FlipBy, IfLess, IfOdd, Input, Mul, Neg, Parameter};
        use Operation::{Sin, Sqrt, Sub};
        if !matches!(operation, Constant(_) | Input(_) | Parameter(_)) {
            let operands = operation.operands();
            let constants: Option<Vec<f64>> = operands.iter().map(|&x| self.constant(x)).collect();
            if let Some(constants) = constants {
                return self.number(operation.apply(&constants));
            }
        }
        let is = |recorder: &Self, x: u32, value: f64| recorder.constant(x).is_some_and(|x| x == value);
        match operation {
            Add(a, b) if is(self, b, 0.0) => a,
            Add(a, b) if is(self, a, 0.0) => b,
            Add(a, b) => match (self.negated(a), self.negated(b)) {
                (_, Some(b)) => self.push(Sub(a, b)),
                (Some(a), None) => self.push(Sub(b, a)),
                _ => self.add(Add(a.min(b), a.max(b))),
            },
            Sub(a, b) if is(self, b, 0.0) => a,
            Sub(a, b) => match self.negated(b) {
                Some(b) => self.push(Add(a, b)),
                None => self.add(Sub(a, b)),
            },
            Mul(a, b) if is(self, a, 0.0) || is(self, b, 0.0) => ZERO,
            Mul(a, b) if is(self, a, 1.0) => b,
            Mul(a, b) if is(self, b, 1.0) => a,
            Mul(a, b) if is(self, a, -1.0) => self.push(Neg(b)),
            Mul(a, b) if is(self, b, -1.0) => self.push(Neg(a)),
            Mul(a, b) => match (self.negated(a), self.negated(b)) {
                (None, None) => self.add(Mul(a.min(b), a.max(b))),
                (Some(a), Some(b)) => self.push(Mul(a, b)),
                (of_a, of_b) => {
                    let product = self.push(Mul(of_a.unwrap_or(a), of_b.unwrap_or(b)));
                    self.push(Neg(product))
                }
            },
            Div(a, b) if is(self, b, 1.0) => a,
            Neg(a) => match self.negated(a) {
                Some(a) => a,
                None => self.add(Neg(a)),
            },
            IfLess([_, _, then, otherwise]) if then == otherwise => then,
            IfLess([a, b, then, otherwise]) if self.constant(a).is_some() && self.constant(b).is_some() => {
                if self.constant(a) < self.constant(b) { then } else { otherwise }
            }
            Div(..)
            | Sqrt(_)
            | Abs(_)
            | Sin(_)
            | Cos(_)
            | IfLess(_)
            | Operation::Unary(..)
            | Operation::Binary(..)
            | CopySign(..)
            | IfOdd(_)
            | FlipBy { .. }
            | Constant(_)
            | Input(_)
            | Parameter(_) => self.add(operation),
        }
    }
}
