//! Text of a library: one function a program.

use core::fmt::Write;

use sincro_math::elementary::REDUCTION_LIMIT;
use sincro_math::record::Program;

use crate::c::{Dialect, lane_support, number, statement_parts};

/// Magnitude of inputs below which leaving out x·0 is exact: no product of a few of them overflows.
const INPUT_LIMIT: f64 = 1e100;

/// Name of the function of program `k`.
pub(super) fn function_name(k: usize) -> String {
    format!("sincro_program_{k}")
}

/// Source of the functions of `programs` on lanes of `width` numbers. Each takes rows of inputs and parameters, and the
/// place of the rows of outputs; it returns 1, or 0 without writing if an input or angle is too large.
pub(super) fn library(programs: &[&Program], width: usize) -> String {
    let mut text = lane_support(width);
    for (k, program) in programs.iter().enumerate() {
        _ = writeln!(
            text,
            "\nint {}(const double *in, const double *parameters, double *out) {{\n    lanes angles = ALL(0.0), size = ALL(0.0);\n    (void)parameters;",
            function_name(k)
        );
        for input in 0..program.n_inputs() {
            _ = writeln!(text, "    const lanes i{input} = AT(in, {input});\n    size += absolute(i{input});");
        }
        let check = format!(
            "    if (!all_below(size, {}) || !all_below(angles, {})) return 0;\n",
            number(INPUT_LIMIT),
            number(REDUCTION_LIMIT)
        );
        let [computed, written] =
            statement_parts(program, Dialect::Lanes, |i| format!("i{i}"), |i| format!("AT(out, {i})"));
        text += &(computed + &check + &written);
        text += "    return 1;\n}\n";
    }
    text
}
