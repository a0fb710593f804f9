//! Text of a library: one function a program.

use core::fmt::Write;

use sincro_math::elementary::REDUCTION_LIMIT;
use sincro_math::record::{Operation, Program};

use super::OutputForm;
use crate::c::{Dialect, StatementParts, lane_support, number, statement_parts};

/// Magnitude of inputs below which leaving out x·0 is exact: no product of a few of them overflows.
pub const INPUT_LIMIT: f64 = 1e100;

/// Name of the function of program `k`.
pub(super) fn function_name(k: usize) -> String {
    format!("sincro_program_{k}")
}

/// Source of the functions of `programs` on lanes of `width` numbers. Each takes rows of inputs and parameters, the
/// places of the rows of outputs and of the two groups of results, lanes whose first flag does not count, and the
/// elementary functions; it returns its flags as bits, those of one output after the other, or −1 without writing if it
/// refuses the inputs: an input or angle is too large, or a flag says so.
pub(super) fn library(programs: &[(&Program, OutputForm)], width: usize) -> String {
    let mut text = lane_support(width);
    for (k, (program, form)) in programs.iter().enumerate() {
        let has_limit = |x: &Operation| matches!(x, Operation::Sin(_) | Operation::Cos(_) | Operation::Binary(..));
        let has_angles = program.operations().iter().any(has_limit);
        let name = function_name(k);
        _ = writeln!(
            text,
            "\nlong long {name}(const double *in, const double *parameters, double *out, double *results0, double *results1, unsigned long long uncounted, function *call) {{"
        );
        // in four sums, which do not wait for each other
        text +=
            "    lanes angles = ALL(0.0), size0 = ALL(0.0), size1 = ALL(0.0), size2 = ALL(0.0), size3 = ALL(0.0);\n";
        text += "    (void)parameters;\n    (void)results0;\n    (void)results1;\n    (void)uncounted;\n    (void)call;\n    (void)angles;\n    long long flags = 0;\n";
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
        let n_outputs = program.outputs().len();
        let [first_result, of_second_group, first_flag] = form.bounds(n_outputs);
        let place = |i: usize| match i {
            i if i >= first_flag => format!("const lanes f{i}"),
            i if i >= first_result => format!("const lanes r{i}"),
            i => format!("AT(out, {i})"),
        };
        let StatementParts { computed, outputs } = statement_parts(program, Dialect::Lanes, |i| format!("i{i}"), place);
        let (written, named) = outputs.split_at(first_result);
        text += &(computed + &named.concat());
        for i in first_flag..n_outputs {
            let shift = (i - first_flag) * width;
            _ = writeln!(text, "    flags |= (long long)which_below(ALL(0.5), f{i}) << {shift};");
        }
        text += &check;
        if form.refuses_by_flag {
            let every_lane = (1_u32 << width) - 1;
            _ = writeln!(text, "    if (flags & {every_lane} & ~uncounted) return -1;");
        }
        text += &written.concat();
        for (group, range) in [first_result..of_second_group, of_second_group..first_flag].into_iter().enumerate() {
            let n = range.len();
            for (k, i) in range.enumerate() {
                _ = writeln!(text, "    put(r{i} + ALL(0.0), results{group} + {k}, {n});");
            }
        }
        text += "    return flags;\n}\n";
    }
    text
}
