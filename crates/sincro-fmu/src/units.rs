//! Units of sincro as FMI has them: names in Modelica's way (`N.m`, `rad/s2`) with their base units.

use std::collections::BTreeMap;

use sincro_blocks::unit::Unit;

/// Unit definitions of a model description.
#[derive(Debug, Default)]
pub(crate) struct Units(BTreeMap<String, (f64, [i8; 6])>);

/// Attributes of a base unit, in the order of [`Unit::dimension`].
pub(crate) const BASES: [&str; 6] = ["kg", "m", "s", "A", "K", "rad"];

impl Units {
    /// The name of a unit, defined from now on; none for no unit, or one without meaning.
    pub(crate) fn add(&mut self, text: &str) -> Option<String> {
        let dimension = Unit::parse(text).ok().filter(|_| !matches!(text, "" | "1"))?.dimension();
        let name = modelica(text);
        self.0.insert(name.clone(), dimension);
        Some(name)
    }

    /// Names, factors and exponents, in alphabetical order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&str, f64, &[i8; 6])> {
        self.0.iter().map(|(name, (factor, exponents))| (name.as_str(), *factor, exponents))
    }
}

/// The name of a unit in Modelica's way.
fn modelica(text: &str) -> String {
    let letter = |c: char| match c {
        '·' | '*' => Some('.'),
        '²' => Some('2'),
        '³' => Some('3'),
        '⁴' => Some('4'),
        '¹' => Some('1'),
        '⁻' => Some('-'),
        '^' | ' ' => None,
        c => Some(c),
    };
    text.chars().filter_map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_named_as_in_modelica() {
        let mut units = Units::default();
        assert_eq!(units.add("N·m").as_deref(), Some("N.m"));
        assert_eq!(units.add("rad/s²").as_deref(), Some("rad/s2"));
        assert_eq!(units.add("kg·m²/s").as_deref(), Some("kg.m2/s"));
        assert_eq!(units.add("1"), None);
        assert_eq!(units.add("bananas"), None);
        assert_eq!(units.iter().map(|(name, ..)| name).collect::<Vec<_>>(), ["N.m", "kg.m2/s", "rad/s2"]);
    }
}
