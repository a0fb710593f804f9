//! Functions that the emitted statements call: square root, absolute value, sine and cosine, selections by bits.

use sincro_math::elementary::REDUCTION_LIMIT;

use super::{Dialect, number, sine_statements};

/// Support for `double`, free of the C library: functions whose names start with `prefix`, as far as they are needed
/// for absolute values, square roots and sines.
pub(crate) fn scalar_support(prefix: &str, absolute: bool, root: bool, sine: bool) -> String {
    let mut text = String::new();
    if absolute || root || sine {
        text += &bit_support(prefix);
    }
    if absolute || sine {
        text += &absolute_support(prefix);
    }
    if root {
        text += &root_support(prefix);
    }
    if sine {
        text += &sine_support(prefix);
    }
    text
}

fn bit_support(prefix: &str) -> String {
    format!(
        r"/* ---- numbers and their bits ---- */

static uint64_t {prefix}bits(double x) {{
    union {{ double number; uint64_t bits; }} both;
    both.number = x;
    return both.bits;
}}

static double {prefix}from_bits(uint64_t bits) {{
    union {{ double number; uint64_t bits; }} both;
    both.bits = bits;
    return both.number;
}}
"
    )
}

fn absolute_support(prefix: &str) -> String {
    format!(
        r"
static double {prefix}absolute(double x) {{
    return {prefix}from_bits({prefix}bits(x) & UINT64_C(0x7fffffffffffffff));
}}
"
    )
}

fn root_support(prefix: &str) -> String {
    format!(
        r"
/* Square root, correctly rounded, digit by digit. */
static double {prefix}square_root(double x) {{
    uint64_t bits = {prefix}bits(x), rest, twice = 0, root = 0, digit;
    int exponent;
    if (!(x > 0.0) || bits == UINT64_C(0x7ff0000000000000)) {{
        return x < 0.0 ? 0.0 / 0.0 : x; /* zeros, infinity and NaN stay */
    }}
    exponent = (int)(bits >> 52);
    bits &= UINT64_C(0x000fffffffffffff);
    if (exponent == 0) {{ /* subnormal */
        exponent = 1;
        while ((bits >> 52) == 0) {{
            bits <<= 1;
            exponent -= 1;
        }}
    }} else {{
        bits |= UINT64_C(0x0010000000000000);
    }}
    exponent -= 1023;
    if (exponent & 1) {{
        bits <<= 1;
        exponent -= 1;
    }}
    /* 54 digits of the root: 53, and one to round by */
    rest = bits << 1;
    for (digit = UINT64_C(1) << 53; digit != 0; digit >>= 1) {{
        const uint64_t trial = twice + digit;
        if (trial <= rest) {{
            twice = trial + digit;
            rest -= trial;
            root += digit;
        }}
        rest <<= 1;
    }}
    root += rest != 0 ? root & 1 : 0;
    return {prefix}from_bits((root >> 1) + ((uint64_t)(exponent / 2 + 1022) << 52));
}}
"
    )
}

fn sine_support(prefix: &str) -> String {
    let limit = number(REDUCTION_LIMIT);
    let sine = sine_statements(Dialect::Double { prefix });
    format!(
        r"
static double {prefix}copy_sign(double x, double sign) {{
    const uint64_t mask = UINT64_C(0x8000000000000000);
    return {prefix}from_bits(({prefix}bits(x) & ~mask) | ({prefix}bits(sign) & mask));
}}

static double {prefix}if_odd(double n, double odd, double even) {{
    return ({prefix}bits(n) & 1) != 0 ? odd : even;
}}

static double {prefix}flip_by_0(double x, double n) {{
    return {prefix}from_bits({prefix}bits(x) ^ (({prefix}bits(n) << 63) & UINT64_C(0x8000000000000000)));
}}

static double {prefix}flip_by_1(double x, double n) {{
    return {prefix}from_bits({prefix}bits(x) ^ (({prefix}bits(n) << 62) & UINT64_C(0x8000000000000000)));
}}

/* Sine and cosine of x [rad]; absolute error below 1.8e-16. NaN from 1e6 rad on. */
static void {prefix}sine_cosine(double x, double *sine, double *cosine) {{
    if (!({prefix}absolute(x) < {limit})) {{
        *sine = 0.0 / 0.0;
        *cosine = 0.0 / 0.0;
        return;
    }}
{sine}}}
"
    )
}
