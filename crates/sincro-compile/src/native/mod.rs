//! Programs compiled for the lanes of this processor by the system's C compiler, and loaded.
//!
//! A library is made once and kept in a cache (`$XDG_CACHE_HOME/sincro/compiled`, else `~/.cache/sincro/compiled`) by
//! the hash of its text and the compiler's options; two processes may make the same one at once. Whatever comes from
//! compiler or cache is compared with [`Program::evaluate`] bit by bit before it is used. The compiler is `CC`, or
//! `cc`; the environment variable `SINCRO_COMPILE=off` forbids it.
//!
//! What is not compiled here is run by the recursions themselves, with the same bits: compiled programs are faster,
//! and nothing else.

mod cache;
mod compiler;
mod library;
mod text;

use core::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sincro_math::record::Program;

use crate::Obstacle;
use crate::comparison::{self, ROUNDS};
use library::{Function, LoadedLibrary};
pub use text::INPUT_LIMIT;

/// Largest number of operations of the programs of one library: compilers take more than their number's time.
const MAX_OPERATIONS: usize = 40_000;

/// Places of a program's outputs: the first are its outputs proper, results and flags follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputForm {
    /// Numbers of outputs in two groups of results. Each group goes to an array of its own, all results of a lane after
    /// those of the lane before, and without the signs of zeros.
    pub n_results: [usize; 2],
    /// Number of outputs that are flags, 7 at most: they are true above 0.5, and come as bits.
    pub n_flags: usize,
    /// True if the program refuses inputs for which its first flag is true in a lane that counts.
    pub refuses_by_flag: bool,
    /// True if the caller knows that the magnitudes of the inputs add up to less than [`INPUT_LIMIT`].
    pub inputs_are_checked: bool,
}

impl OutputForm {
    /// First result of each group and first flag among `n` outputs.
    fn bounds(self, n: usize) -> [usize; 3] {
        let [_, second] = self.n_results;
        let first_flag = n - self.n_flags;
        [first_flag - self.n_results.iter().sum::<usize>(), first_flag - second, first_flag]
    }
}

/// Program that runs on all lanes of the processor at once, with the bits of [`Program::evaluate`] in each.
#[derive(Clone)]
pub struct NativeProgram {
    library: Arc<LoadedLibrary>,
    function: Function,
    n_inputs: usize,
    n_parameters: usize,
    n_outputs: usize,
    form: OutputForm,
    width: usize,
}

impl fmt::Debug for NativeProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NativeProgram").field("n_inputs", &self.n_inputs).finish_non_exhaustive()
    }
}

/// Programs that were compiled together.
#[derive(Clone, Debug)]
pub struct Native {
    /// The programs, in the order in which they were given.
    pub programs: Vec<NativeProgram>,
    /// Time for compiling, loading and comparing.
    pub elapsed: Duration,
    /// True if the library was in the cache.
    pub is_cached: bool,
}

/// Compiles programs for the lanes of this processor ([`sincro_math::lanes::width`]).
///
/// # Errors
///
/// [`Obstacle`]: the processor has one lane, the programs are too long, there is no compiler or cache, or what the
/// compiler made differs from the programs by a bit.
///
/// ```
/// use sincro_math::Real;
/// use sincro_math::record::record;
///
/// let program = record(2, 1, |x| vec![x[0] * x[1].sin_cos().0]).unwrap();
/// if let Ok(native) = sincro_compile::native::compile(&[&program]) {
///     let width = sincro_math::lanes::width();
///     let inputs: Vec<f64> = (0..2 * width).map(|k| 0.1 * k as f64).collect(); // row by row
///     let mut outputs = vec![0.0; width];
///     assert!(native.programs[0].evaluate(&inputs, &[], &mut outputs));
///     assert_eq!(outputs[1], program.evaluate(&[inputs[1], inputs[width + 1]], 0)[0]);
/// }
/// ```
pub fn compile(programs: &[&Program]) -> Result<Native, Obstacle> {
    let programs: Vec<_> = programs.iter().map(|program| (*program, OutputForm::default())).collect();
    compile_in_form(&programs)
}

/// As [`compile`], of programs whose outputs have places of their own.
///
/// # Errors
///
/// As [`compile`].
pub fn compile_in_form(programs: &[(&Program, OutputForm)]) -> Result<Native, Obstacle> {
    let start = Instant::now();
    if crate::is_forbidden() {
        return Err(Obstacle::new("SINCRO_COMPILE=off forbids it"));
    }
    let width = sincro_math::lanes::width();
    if width == 1 {
        return Err(Obstacle::new("this processor has neither AVX2 nor AVX-512"));
    }
    let n_operations: usize = programs.iter().map(|(program, _)| program.operations().len()).sum();
    if n_operations > MAX_OPERATIONS {
        let words = format!("it has {n_operations} operations, more than {MAX_OPERATIONS}");
        return Err(Obstacle::new(words));
    }
    let text = text::library(programs, width);
    let options = compiler::options();
    let folder = cache::folder()?;
    let path = folder.join(cache::name(&text, &options));
    let of_cache = if path.exists() { load(&path, programs, width).ok() } else { None };
    let is_cached = of_cache.is_some();
    let programs = match of_cache {
        Some(programs) => programs,
        None => {
            let made = cache::temporary(&folder);
            let loaded = compiler::run(&text, &options, made.path()).and_then(|()| load(made.path(), programs, width));
            let loaded = loaded.map_err(Obstacle::new)?;
            cache::publish(made, &path);
            loaded
        }
    };
    Ok(Native { programs, elapsed: start.elapsed(), is_cached })
}

/// Loads a library and compares it with the programs.
fn load(
    path: &std::path::Path,
    programs: &[(&Program, OutputForm)],
    width: usize,
) -> Result<Vec<NativeProgram>, String> {
    let library = Arc::new(LoadedLibrary::open(path)?);
    let of = |(k, (program, form)): (usize, &(&Program, OutputForm))| {
        let new = NativeProgram {
            function: library.function(&text::function_name(k))?,
            library: Arc::clone(&library),
            n_inputs: program.n_inputs(),
            n_parameters: program.parameters().len(),
            n_outputs: form.bounds(program.outputs().len())[0],
            form: *form,
            width,
        };
        new.compare(program)?;
        Ok(new)
    };
    programs.iter().enumerate().map(of).collect()
}

impl NativeProgram {
    /// Number of lanes: the length of the rows of inputs and outputs.
    #[inline]
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Evaluates the program in all lanes: `inputs`, `parameters` and `outputs` have one row of [`width`](Self::width)
    /// numbers for each of the program's. Returns false, with `outputs` as they were, where the program does not have
    /// the bits of its algorithm: for angles of 1e6 rad and more and for inputs of 1e100 and more.
    ///
    /// # Panics
    ///
    /// If an array has another length.
    #[inline]
    pub fn evaluate(&self, inputs: &[f64], parameters: &[f64], outputs: &mut [f64]) -> bool {
        assert_eq!(inputs.len(), self.n_inputs * self.width, "one row an input");
        assert_eq!(parameters.len(), self.n_parameters * self.width, "one row a parameter");
        assert_eq!(outputs.len(), self.n_outputs * self.width, "one row an output");
        assert_eq!(self.form, OutputForm::default(), "there are neither results nor flags");
        self.library.call(self.function, inputs.as_ptr(), parameters, outputs.as_mut_ptr(), [&mut [], &mut []], 0) >= 0
    }

    /// As [`evaluate`](Self::evaluate), of a program with results and flags. Returns the flags: bit `k·width + lane` is
    /// that of flag `k`; none, with all arrays as they were, where the program refuses the inputs. Lanes of the bits
    /// `uncounted` may have any first flag ([`OutputForm::refuses_by_flag`]).
    ///
    /// # Panics
    ///
    /// If an array has another length.
    #[inline]
    pub fn evaluate_in_form(
        &self,
        inputs: &[f64],
        parameters: &[f64],
        outputs: &mut [f64],
        results: [&mut [f64]; 2],
        uncounted: u64,
    ) -> Option<u64> {
        assert_eq!(inputs.len(), self.n_inputs * self.width, "one row an input");
        assert_eq!(parameters.len(), self.n_parameters * self.width, "one row a parameter");
        assert_eq!(outputs.len(), self.n_outputs * self.width, "one row an output");
        self.check_results(&results);
        let outputs = outputs.as_mut_ptr();
        let flags = self.library.call(self.function, inputs.as_ptr(), parameters, outputs, results, uncounted);
        u64::try_from(flags).ok()
    }

    /// As [`evaluate_in_form`](Self::evaluate_in_form), with the outputs in place of the first inputs.
    ///
    /// # Panics
    ///
    /// If an array has another length, or there are more outputs than inputs.
    #[inline]
    pub fn evaluate_in_form_in_place(
        &self,
        rows: &mut [f64],
        parameters: &[f64],
        results: [&mut [f64]; 2],
        uncounted: u64,
    ) -> Option<u64> {
        self.check_rows(rows, parameters);
        self.check_results(&results);
        let rows = rows.as_mut_ptr();
        let flags = self.library.call(self.function, rows.cast_const(), parameters, rows, results, uncounted);
        u64::try_from(flags).ok()
    }

    /// As [`evaluate`](Self::evaluate), with the outputs in place of the first inputs.
    ///
    /// # Panics
    ///
    /// If an array has another length, or there are more outputs than inputs.
    #[inline]
    pub fn evaluate_in_place(&self, rows: &mut [f64], parameters: &[f64]) -> bool {
        self.check_rows(rows, parameters);
        assert_eq!(self.form, OutputForm::default(), "there are neither results nor flags");
        let rows = rows.as_mut_ptr();
        self.library.call(self.function, rows.cast_const(), parameters, rows, [&mut [], &mut []], 0) >= 0
    }

    /// Checks the lengths of rows that are inputs and outputs.
    #[inline]
    fn check_rows(&self, rows: &[f64], parameters: &[f64]) {
        assert_eq!(rows.len(), self.n_inputs * self.width, "one row an input");
        assert!(self.n_outputs <= self.n_inputs, "outputs take the place of inputs");
        assert_eq!(parameters.len(), self.n_parameters * self.width, "one row a parameter");
    }

    #[inline]
    fn check_results(&self, results: &[&mut [f64]; 2]) {
        for (results, n) in results.iter().zip(self.form.n_results) {
            assert_eq!(results.len(), n * self.width, "a result a lane");
        }
    }

    /// Compares the outputs with the program's, for random inputs of many sizes.
    fn compare(&self, program: &Program) -> Result<(), String> {
        let width = self.width;
        let [n_first, n_second] = self.form.n_results;
        let [mut outputs, mut first, mut second] = [self.n_outputs, n_first, n_second].map(|n| vec![0.0; n * width]);
        // a parameter has a value for each world: those of the first lanes
        let parameters = rows_of_parameters(program, 0, width);
        let mut n_compared = 0;
        for round in 0..ROUNDS {
            let inputs: Vec<f64> = (0..(self.n_inputs * width) as u64).map(|k| comparison::number(round, k)).collect();
            let results = [&mut first[..], &mut second];
            let Some(flags) = self.evaluate_in_form(&inputs, &parameters, &mut outputs, results, u64::MAX) else {
                continue;
            };
            n_compared += 1;
            for lane in 0..width {
                let of_lane: Vec<f64> = inputs.iter().skip(lane).step_by(width).copied().collect();
                let wanted = program.evaluate(&of_lane, lane);
                let (wanted, wanted_flags) = wanted.split_at(wanted.len() - self.form.n_flags);
                let (wanted, wanted_results) = wanted.split_at(self.n_outputs);
                let unsigned: Vec<f64> = wanted_results.iter().map(|x| x + 0.0).collect();
                let found = outputs.iter().skip(lane).step_by(width);
                let found =
                    found.chain(&first[lane * n_first..][..n_first]).chain(&second[lane * n_second..][..n_second]);
                let wanted = wanted.iter().chain(&unsigned);
                let flag = |k: usize| flags >> (k * width + lane) & 1 == 1;
                if found.zip(wanted).any(|(a, b)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan()))
                    || wanted_flags.iter().enumerate().any(|(k, x)| flag(k) != (*x > 0.5))
                {
                    return Err("what the compiler made differs from the program by a bit".to_owned());
                }
            }
        }
        if n_compared == 0 { Err("what the compiler made refuses all inputs".to_owned()) } else { Ok(()) }
    }
}

/// Rows of the parameters of `width` worlds from world `first` on; where there are fewer, the last one is repeated.
#[must_use]
pub fn rows_of_parameters(program: &Program, first: usize, width: usize) -> Vec<f64> {
    let of =
        |values: &Vec<f64>| -> Vec<f64> { (first..first + width).map(|k| values[k.min(values.len() - 1)]).collect() };
    program.parameters().iter().flat_map(of).collect()
}
