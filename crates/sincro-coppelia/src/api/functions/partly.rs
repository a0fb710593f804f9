//! Functions that are offered with less than V-REP and CoppeliaSim have: what is missing. For `docs/compatibility.md`.

use super::{Function, properties, ui};
use sincro_conventions::absent::rows;

/// Functions, each with what of it is not offered.
fn parts() -> impl Iterator<Item = (&'static str, &'static str)> {
    rows(include_str!("partly.txt"))
}

/// Functions that only scripts have as told here, each with what of it is not offered.
fn parts_in_scripts() -> impl Iterator<Item = (&'static str, &'static str)> {
    rows(include_str!("partly_in_scripts.txt"))
}

/// Missing part of a function that is offered with less than V-REP and CoppeliaSim have, for the table of
/// `docs/compatibility.md`. `name` is the present name, those of `simIK` and `simUI` with their module; none if nothing
/// is missing.
#[must_use]
pub fn missing_part(name: &str) -> Option<&'static str> {
    let is_in = |list: &[Function], name: &str| list.iter().any(|f| f.name == name);
    let by_table = if let Some(name) = name.strip_prefix("simUI.") {
        let is_shown = is_in(ui::SHOWN, name).then_some("taken without effect: nothing is shown");
        is_shown.or_else(|| {
            let what = "there is no window: values are kept and given back, nothing is pressed or called";
            (is_in(ui::FUNCTIONS, name) || is_in(ui::KEPT, name)).then_some(what)
        })
    } else if super::is_display_only(name) {
        Some("taken without effect: nothing is drawn")
    } else {
        let is_property = is_in(properties::TYPED, name) || is_in(properties::FUNCTIONS, name);
        is_property.then_some("the properties that correspond to functions, customData, signal")
    };
    parts().find(|(partly, _)| *partly == name).map(|(_, what)| what).or(by_table)
}

/// Missing part of a function in scripts, where clients have it whole or not at all, for `docs/compatibility.md`.
/// `name` is the present name without `sim.`; none if scripts have it as clients do.
#[must_use]
pub fn missing_in_scripts(name: &str) -> Option<&'static str> {
    parts_in_scripts().find(|(partly, _)| *partly == name).map(|(_, what)| what)
}

/// Present names of the functions for which [`missing_in_scripts`] has a text.
pub fn partly_in_scripts() -> impl Iterator<Item = &'static str> {
    parts_in_scripts().map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_modules_and_properties_come_from_their_tables() {
        let properties = super::super::functions().map(|f| f.name).filter(|name| {
            let is_object = ["getObjectProperty", "setObjectProperty"].contains(name);
            name.ends_with("Property") && !is_object
        });
        let of_ui = super::super::ui_functions().map(|f| format!("simUI.{}", f.name));
        let whole: Vec<String> =
            properties.map(str::to_owned).chain(of_ui).filter(|name| missing_part(name).is_none()).collect();
        assert_eq!(whole, Vec::<String>::new());
    }

    #[test]
    fn what_is_offered_partly_is_offered() {
        let absent: Vec<_> =
            parts().map(|(name, _)| name).filter(|name| super::super::function(name).is_none()).collect();
        assert_eq!(absent, Vec::<&str>::new());
    }
}
