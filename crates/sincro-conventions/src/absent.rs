//! Functions of V-REP and CoppeliaSim that are not here: why, and what to do instead. They are not listed to clients.

/// The rows of a table such as `absent.txt`: names below a text, each with it.
pub fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut why = "";
    table.lines().filter(|line| !line.starts_with('#')).flat_map(move |line| {
        if !line.starts_with(' ') {
            why = line;
        }
        line.strip_prefix("  ")
            .unwrap_or_default()
            .split(' ')
            .filter(|name| !name.is_empty())
            .map(move |name| (name, why))
    })
}

/// Functions that are not offered, each with the reason.
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    rows(include_str!("absent.txt"))
}

/// Reason why a function of V-REP or CoppeliaSim is not offered, with what to do instead: the text of the error that
/// callers get. `name` is the present name without `sim.`; none if the function is offered, or unknown.
#[must_use]
pub fn why_absent(name: &str) -> Option<&'static str> {
    all().find(|(absent, _)| *absent == name).map(|(_, why)| why)
}

/// Present names, without `sim.`, of the functions of V-REP and CoppeliaSim that are not offered; [`why_absent`] has
/// the reason of each.
pub fn absent() -> impl Iterator<Item = &'static str> {
    all().map(|(name, _)| name)
}
