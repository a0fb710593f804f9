//! Programs compiled in memory for one world, by Cranelift: without a compiler of the system, in milliseconds.
//!
//! Functions on numbers of double precision, without lanes, for single worlds and live runs. Every operation is the one
//! of the program, in its order of operands, and none is contracted; the sines and cosines whose angles are known at
//! the same time are found together, in the lanes of [`sincro_math::lanes`]. Whatever is compiled is compared with
//! [`Program::evaluate`] bit by bit before it is used. The environment variable `SINCRO_COMPILE=off` forbids it.
//!
//! Numbers that no program keeps the bits of are refused, and left to the algorithm itself: inputs of 1e100 and more
//! ([`INPUT_LIMIT`](crate::native::INPUT_LIMIT)), and results that are not finite.

mod code;
mod layout;
mod order;
mod translation;

use core::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sincro_math::compiled::CompiledFunction;
use sincro_math::record::Program;

use crate::Obstacle;
use crate::comparison::{self, ROUNDS};
use code::{Code, Function};

/// Largest number of operations of the programs that are compiled together: about a second of compilation.
const MAX_OPERATIONS: usize = 100_000;

/// Program compiled for one world, with the bits of [`Program::evaluate`].
#[derive(Clone)]
pub struct JittedProgram {
    code: Arc<Code>,
    function: Function,
    n_inputs: usize,
    n_outputs: usize,
    parameters: Vec<f64>,
}

impl fmt::Debug for JittedProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("JittedProgram").field("n_inputs", &self.n_inputs).finish_non_exhaustive()
    }
}

/// Programs that were compiled together.
#[derive(Clone, Debug)]
pub struct Jitted {
    /// The programs, in the order in which they were given.
    pub programs: Vec<JittedProgram>,
    /// Time for compiling them.
    pub elapsed: Duration,
    /// Time for comparing them with what they were compiled from.
    pub compared: Duration,
}

/// Compiles programs for this processor.
///
/// # Errors
///
/// [`Obstacle`]: `SINCRO_COMPILE=off` forbids it, the programs are too long, the processor is none that Cranelift
/// knows, or what it made differs from the programs by a bit.
///
/// ```
/// use sincro_math::Real;
/// use sincro_math::record::record;
///
/// let program = record(2, 1, |x| vec![x[0] * x[1].sin_cos().0]).unwrap();
/// let jitted = sincro_compile::jit::compile(&[&program]).unwrap();
/// let mut outputs = [0.0];
/// assert!(jitted.programs[0].evaluate(&[2.0, 0.3], &mut outputs));
/// assert_eq!(outputs[..], program.evaluate(&[2.0, 0.3], 0));
/// ```
pub fn compile(programs: &[&Program]) -> Result<Jitted, Obstacle> {
    let start = Instant::now();
    if crate::is_forbidden() {
        return Err(Obstacle::new("SINCRO_COMPILE=off forbids it"));
    }
    let n_operations: usize = programs.iter().map(|program| program.operations().len()).sum();
    if n_operations > MAX_OPERATIONS {
        let words = format!("it has {n_operations} operations, more than {MAX_OPERATIONS}");
        return Err(Obstacle::new(words));
    }
    let (code, functions) = Code::new(programs).map_err(Obstacle::new)?;
    let code = Arc::new(code);
    let of = |(function, program): (Function, &&Program)| JittedProgram {
        code: Arc::clone(&code),
        function,
        n_inputs: program.n_inputs(),
        n_outputs: program.outputs().len(),
        // those of the first world
        parameters: program.parameters().iter().map(|values| values[0]).collect(),
    };
    let jitted: Vec<JittedProgram> = functions.into_iter().zip(programs).map(of).collect();
    let elapsed = start.elapsed();
    for (jitted, program) in jitted.iter().zip(programs) {
        jitted.compare(program)?;
    }
    Ok(Jitted { programs: jitted, elapsed, compared: start.elapsed() - elapsed })
}

impl CompiledFunction for JittedProgram {
    #[inline]
    fn evaluate(&self, inputs: &[f64], outputs: &mut [f64]) -> bool {
        Self::evaluate(self, inputs, outputs)
    }
}

impl JittedProgram {
    /// Number of inputs.
    #[must_use]
    pub fn n_inputs(&self) -> usize {
        self.n_inputs
    }

    /// Number of outputs.
    #[must_use]
    pub fn n_outputs(&self) -> usize {
        self.n_outputs
    }

    /// Evaluates the program with the parameters of its first world. Returns false, with `outputs` undefined, where it
    /// need not have the bits of its algorithm: for inputs of 1e100 and more, and for results that are not finite.
    ///
    /// # Panics
    ///
    /// If an array has another length.
    #[inline]
    pub fn evaluate(&self, inputs: &[f64], outputs: &mut [f64]) -> bool {
        assert_eq!(inputs.len(), self.n_inputs, "a number an input");
        assert_eq!(outputs.len(), self.n_outputs, "a number an output");
        self.code.call(self.function, inputs, &self.parameters, outputs)
    }

    /// Compares the outputs with the program's, for random inputs of many sizes.
    fn compare(&self, program: &Program) -> Result<(), Obstacle> {
        let mut outputs = vec![0.0; self.n_outputs];
        let mut n_compared = 0;
        for round in 0..ROUNDS {
            let inputs: Vec<f64> = (0..self.n_inputs as u64).map(|k| comparison::number(round, k)).collect();
            if !self.evaluate(&inputs, &mut outputs) {
                continue;
            }
            n_compared += 1;
            let wanted = program.evaluate(&inputs, 0);
            if outputs.iter().zip(&wanted).any(|(a, b)| a.to_bits() != b.to_bits()) {
                return Err(Obstacle::new("what was compiled differs from the program by a bit"));
            }
        }
        if n_compared == 0 { Err(Obstacle::new("what was compiled refuses all inputs")) } else { Ok(()) }
    }
}
