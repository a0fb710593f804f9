//! Functions that the statements on lanes call: vectors of the GNU dialect of C, which gcc and clang have.

use super::{Dialect, sine_statements};

/// Support for `lanes`, vectors of `width` numbers: selections by comparison and by bits, square root, sine and cosine.
///
/// Statements may use a pointer `call` to the elementary functions by their number, and the macros `ALL(x)`, a number
/// in all lanes, and `AT(array, k)`, row `k` of an array of rows of `width` numbers. Sines are right for angles within
/// the limit of their reduction: the caller looks at them, by the sum of their magnitudes in `angles`.
pub(crate) fn lane_support(width: usize) -> String {
    let bytes = 8 * width;
    let all = vec!["(x)"; width].join(", ");
    let root = match width {
        4 | 8 if cfg!(target_arch = "x86_64") => {
            "    lanes root;\n    __asm__(\"vsqrtpd %1, %0\" : \"=v\"(root) : \"v\"(x));\n    return root;\n".to_owned()
        }
        _ => format!("    int k;\n    for (k = 0; k < {width}; k++) x[k] = __builtin_sqrt(x[k]);\n    return x;\n"),
    };
    let if_less = match width {
        8 if cfg!(target_arch = "x86_64") => {
            "    lanes result;\n    __asm__(\"vcmppd $17, %2, %1, %%k1\\n\\tvblendmpd %3, %4, %0 %{%%k1%}\" : \"=v\"(result) : \"v\"(a), \"v\"(b), \"v\"(then), \"v\"(otherwise) : \"k1\");\n    return result;\n".to_owned()
        }
        _ => "    return selected((bits)(a < b), then, otherwise);\n".to_owned(),
    };
    // 17: ordered, less than, without a signal
    let which_below = match width {
        8 if cfg!(target_arch = "x86_64") => {
            "    int mask;\n    __asm__(\"vcmppd $17, %2, %1, %%k1\\n\\tkmovb %%k1, %0\" : \"=r\"(mask) : \"v\"(x), \"v\"(bound) : \"k1\");\n    return mask;\n".to_owned()
        }
        4 if cfg!(target_arch = "x86_64") => {
            "    int mask;\n    lanes below;\n    __asm__(\"vcmppd $17, %3, %2, %1\\n\\tvmovmskpd %1, %0\" : \"=r\"(mask), \"=&x\"(below) : \"x\"(x), \"x\"(bound));\n    return mask;\n".to_owned()
        }
        _ => {
            let each: Vec<String> = (0..width).map(|k| format!("((x[{k}] < bound[{k}]) << {k})")).collect();
            format!("    return {};\n", each.join(" | "))
        }
    };
    let every_lane = (1_u32 << width) - 1;
    let sine = sine_statements(Dialect::Lanes);
    format!(
        r#"typedef double lanes __attribute__((vector_size({bytes})));
typedef double row __attribute__((vector_size({bytes}), aligned(8), may_alias));
typedef unsigned long long bits __attribute__((vector_size({bytes})));

#define ALL(x) ((lanes){{{all}}})
#define BITS(x) ((bits){{{all}}})
#define AT(array, k) (*(row *)((array) + {width} * (k)))
#define INLINE static inline __attribute__((always_inline))

INLINE lanes selected(bits mask, lanes a, lanes b) {{
    return (lanes)((mask & (bits)a) | (~mask & (bits)b));
}}

INLINE lanes if_less(lanes a, lanes b, lanes then, lanes otherwise) {{
{if_less}}}

INLINE lanes absolute(lanes x) {{
    return (lanes)((bits)x & BITS(0x7fffffffffffffffull));
}}

INLINE lanes square_root(lanes x) {{
{root}}}

INLINE lanes copy_sign(lanes x, lanes sign) {{
    const bits mask = BITS(0x8000000000000000ull);
    return (lanes)(((bits)x & ~mask) | ((bits)sign & mask));
}}

INLINE lanes if_odd(lanes n, lanes odd, lanes even) {{
    return selected(BITS(0) - ((bits)n & BITS(1)), odd, even);
}}

INLINE lanes flip_by_0(lanes x, lanes n) {{
    return (lanes)((bits)x ^ ((bits)n << 63));
}}

INLINE lanes flip_by_1(lanes x, lanes n) {{
    return (lanes)((bits)x ^ (((bits)n << 62) & BITS(0x8000000000000000ull)));
}}

/* Writes the lanes to places a distance apart. */
INLINE void put(lanes x, double *to, int distance) {{
    int k;
    if (distance == 1) *(row *)to = x;
    else for (k = 0; k < {width}; k++) to[k * distance] = x[k];
}}

/* Sine and cosine of x [rad] below the limit of the reduction. */
INLINE void sine_cosine(lanes x, lanes *sine, lanes *cosine) {{
{sine}}}

/* Lanes where x is below a bound, as bits; not those that are no numbers. */
INLINE int which_below(lanes x, lanes bound) {{
{which_below}}}

/* True if all lanes are below a limit; false for those that are no numbers. */
INLINE int all_below(lanes x, double limit) {{
    return which_below(x, ALL(limit)) == {every_lane};
}}

/* A huge number where x is zero and y is not above it, else 0. */
INLINE lanes if_undecided(lanes x, lanes y) {{
    return selected((bits)(x == ALL(0.0)) & ~(bits)(ALL(0.0) < y), ALL(1e300), ALL(0.0));
}}

typedef double function(int, double, double);

/* Function number f of each lane; those of one argument take x alone. */
static lanes called(function *call, int f, lanes x, lanes y) {{
    lanes result = x;
    int k;
    for (k = 0; k < {width}; k++) result[k] = call(f, x[k], y[k]);
    return result;
}}
"#
    )
}
