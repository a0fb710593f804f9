//! Text of a library: one function a program.

use core::fmt::Write;

use sincro_math::elementary::REDUCTION_LIMIT;
use sincro_math::record::{Operation, Program};

use super::OutputForm;
use crate::c::{Dialect, lane_support, number, statement_parts};

/// Magnitude of inputs below which leaving out x·0 is exact: no product of a few of them overflows.
pub const INPUT_LIMIT: f64 = 1e100;

/// Name of the function of program `k`.
pub(super) fn function_name(k: usize) -> String {
    format!("sincro_program_{k}")
}

/// Source of the functions of `programs` on lanes of `width` numbers. Each takes rows of inputs and parameters, the
/// places of the rows of outputs and of results, and the elementary functions; it returns its flags as bits, those of
/// one output after the other, or −1 without writing if an input or angle is too large.
pub(super) fn library(programs: &[(&Program, OutputForm)], width: usize) -> String {
    let mut text = lane_support(width);
    for (k, (program, form)) in programs.iter().enumerate() {
        let has_limit = |x: &Operation| matches!(x, Operation::Sin(_) | Operation::Cos(_) | Operation::Binary(..));
        let has_angles = program.operations().iter().any(has_limit);
        let name = function_name(k);
        _ = writeln!(
            text,
            "\nlong long {name}(const double *in, const double *parameters, double *out, double *results, function *call) {{"
        );
        // in four sums, which do not wait for each other
        text +=
            "    lanes angles = ALL(0.0), size0 = ALL(0.0), size1 = ALL(0.0), size2 = ALL(0.0), size3 = ALL(0.0);\n";
        text +=
            "    (void)parameters;\n    (void)results;\n    (void)call;\n    (void)angles;\n    long long flags = 0;\n";
        for input in 0..program.n_inputs() {
            let sum = input % 4;
            _ = writeln!(text, "    const lanes i{input} = AT(in, {input});");
            if !form.inputs_are_checked {
                _ = writeln!(text, "    size{sum} += absolute(i{input});");
            }
        }
        let size = format!("all_below((size0 + size1) + (size2 + size3), {})", number(INPUT_LIMIT));
        let angles =
            if has_angles { format!(" & all_below(angles, {})", number(REDUCTION_LIMIT)) } else { String::new() };
        let check = format!("    if (!({size}{angles})) return -1;\n");
        let [first_result, first_flag] = form.bounds(program.outputs().len());
        let place = |i: usize| match i {
            i if i >= first_flag => format!("const lanes f{i}"),
            i if i >= first_result => format!("AT(results, {})", i - first_result),
            i => format!("AT(out, {i})"),
        };
        let flags: String = (first_flag..program.outputs().len())
            .map(|i| format!("    flags |= (long long)which_below(ALL(0.5), f{i}) << {};\n", (i - first_flag) * width))
            .collect();
        let [computed, written] = statement_parts(program, Dialect::Lanes, |i| format!("i{i}"), place);
        text += &(computed + &check + &written + &flags);
        text += "    return flags;\n}\n";
    }
    text
}
