//! Clocks of a foreign FMU (FMI 3.0).

use roxmltree::Node;

use super::line_of;
use super::variables::Definitions;

/// Input clock of a foreign FMU: when its importer lets it tick.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignClock {
    /// Name.
    pub name: String,
    /// Value reference.
    pub reference: u32,
    /// When it ticks.
    pub rule: ClockRule,
    /// Order of clocks that tick at the same instant: lower ones first.
    pub priority: u32,
}

/// Rule by which an input clock ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClockRule {
    /// At `shift + k·interval` after the start, both `[s]`.
    Periodic {
        /// Time between ticks.
        interval: f64,
        /// Time of the first tick after the start.
        shift: f64,
    },
    /// Periodic, with interval and shift that the FMU gives at its initialization.
    Calculated,
    /// The FMU gives the time to the next tick after each.
    Changing,
    /// Once, a time after it was set that the FMU gives.
    Countdown,
    /// Whenever the importer wants it.
    Triggered,
}

/// Input clock of an element `Clock`; none for output clocks.
pub(super) fn read<'a, 'input>(
    node: Node<'a, 'input>,
    definitions: &Definitions<'a, 'input>,
    (name, reference): (&str, u32),
) -> Result<Option<ForeignClock>, String> {
    if node.attribute("causality") != Some("input") {
        return Ok(None);
    }
    let number = |key: &str| definitions.attribute(node, key).and_then(|text| text.trim().parse::<f64>().ok());
    // fractions of a second, or of the resolution
    let seconds = |what: &str| {
        let fraction = || Some(number(&format!("{what}Counter"))? / number("resolution")?);
        number(&format!("{what}Decimal")).or_else(fraction)
    };
    let fault = |what: &str| format!("line {}: the clock `{name}` has {what}", line_of(node));
    let rule = match definitions.attribute(node, "intervalVariability") {
        Some("constant" | "fixed" | "tunable") => {
            let interval = seconds("interval").filter(|x| *x > 0.0 && x.is_finite());
            let interval = interval.ok_or_else(|| fault("no interval"))?;
            let shift = seconds("shift").unwrap_or(0.0);
            if !(shift >= 0.0 && shift.is_finite()) {
                return Err(fault("a shift that is none"));
            }
            ClockRule::Periodic { interval, shift }
        }
        Some("calculated") => ClockRule::Calculated,
        Some("changing") => ClockRule::Changing,
        Some("countdown") => ClockRule::Countdown,
        Some("triggered") => ClockRule::Triggered,
        other => return Err(fault(&format!("the intervalVariability `{}`", other.unwrap_or("")))),
    };
    let priority = number("priority").unwrap_or(0.0) as u32;
    Ok(Some(ForeignClock { name: name.to_owned(), reference, rule, priority }))
}
