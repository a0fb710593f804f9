//! Text of a library: one function a program.

use core::fmt::Write;

use sincro_math::elementary::REDUCTION_LIMIT;
use sincro_math::record::{Operation, Program};

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
        let has_angles = program.operations().iter().any(|x| matches!(x, Operation::Sin(_) | Operation::Cos(_)));
        let name = function_name(k);
        _ = writeln!(text, "\nint {name}(const double *in, const double *parameters, double *out) {{");
        // in four sums, which do not wait for each other
        text +=
            "    lanes angles = ALL(0.0), size0 = ALL(0.0), size1 = ALL(0.0), size2 = ALL(0.0), size3 = ALL(0.0);\n";
        text += "    (void)parameters;\n    (void)angles;\n";
        for input in 0..program.n_inputs() {
            let sum = input % 4;
            _ = writeln!(text, "    const lanes i{input} = AT(in, {input});\n    size{sum} += absolute(i{input});");
        }
        let size = format!("all_below((size0 + size1) + (size2 + size3), {})", number(INPUT_LIMIT));
        let angles =
            if has_angles { format!(" & all_below(angles, {})", number(REDUCTION_LIMIT)) } else { String::new() };
        let check = format!("    if (!({size}{angles})) return 0;\n");
        let [computed, written] =
            statement_parts(program, Dialect::Lanes, |i| format!("i{i}"), |i| format!("AT(out, {i})"));
        text += &(computed + &check + &written);
        text += "    return 1;\n}\n";
    }
    text
}
