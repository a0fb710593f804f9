//! Work of one call, in operations: its limit, beyond which a call is refused.

use super::ApiError;

/// Operations on pixels (a weight of a kernel, a comparison of two colours) or comparisons of points of one call: about
/// a second.
pub const MAX_OPERATIONS: u64 = 1 << 30;

/// Checks the number of operations of one call; `unit` says which they are, `help` how to take fewer.
///
/// # Errors
///
/// They are more than [`MAX_OPERATIONS`].
pub fn check_operations(n: u64, unit: &str, help: &str) -> Result<(), ApiError> {
    if n <= MAX_OPERATIONS {
        return Ok(());
    }
    Err(ApiError(format!("this takes {n} {unit}, and one call has up to {MAX_OPERATIONS}: {help}")))
}
