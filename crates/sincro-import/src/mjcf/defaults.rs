//! Defaults: classes of attribute values, each with a parent class.

use std::collections::BTreeMap;

use sincro_scene::diagnostic::Diagnostic;

use super::include::Files;
use crate::source::Element;

/// Kinds of actuators share their defaults.
const ACTUATORS: [&str; 10] =
    ["general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion", "dcmotor"];

/// Tag of the defaults for an element with this tag, which is no equality: all kinds of tendons have one.
fn default_tag(tag: &str) -> &str {
    match tag {
        "fixed" | "spatial" => "tendon",
        own => own,
    }
}

#[derive(Default)]
struct Class<'d> {
    parent: Option<String>,
    elements: Vec<Element<'d>>,
}

/// All classes; the one without parent is `main`.
pub(super) struct Defaults<'d> {
    classes: BTreeMap<String, Class<'d>>,
}

/// Deepest nesting of classes.
const MAX_DEPTH: usize = 64;

impl<'d> Defaults<'d> {
    pub fn new(files: &Files<'d>, all: &[Element<'d>]) -> Self {
        let mut defaults = Self { classes: BTreeMap::from([("main".to_owned(), Class::default())]) };
        for element in all {
            defaults.class(files, *element, None);
        }
        defaults
    }

    fn class(&mut self, files: &Files<'d>, element: Element<'d>, parent: Option<&str>) {
        element.keep();
        let name = match (element.attribute("class"), parent) {
            (Some(name), _) => name.to_owned(),
            (None, _) => "main".to_owned(),
        };
        let top = parent.is_none() && name != "main";
        let parent = if top { Some("main") } else { parent };
        let class = self.classes.entry(name.clone()).or_default();
        if class.parent.is_none() && name != "main" {
            class.parent = parent.map(str::to_owned);
        }
        for child in files.elements(element) {
            if child.name() == "default" {
                self.class(files, child, Some(&name));
            } else {
                child.keep();
                self.classes.entry(name.clone()).or_default().elements.push(child);
            }
        }
    }

    /// The element that gives an attribute of `element`, which is no equality: itself, or a default of its class or of
    /// the classes above.
    pub fn holder(&self, element: Element<'d>, inherited: &str, attribute: &str) -> Option<Element<'d>> {
        self.holder_by_tag(element, default_tag(element.name()), inherited, attribute)
    }

    /// As [`Self::holder`], with the tag of the defaults for `element`.
    fn holder_by_tag(&self, element: Element<'d>, tag: &str, inherited: &str, attribute: &str) -> Option<Element<'d>> {
        if element.peek(attribute).is_some() {
            return Some(element);
        }
        let fits = |e: &Element<'d>| {
            let same = e.name() == tag || (ACTUATORS.contains(&tag) && ACTUATORS.contains(&e.name()));
            same && e.peek(attribute).is_some()
        };
        let mut class = element.attribute("class").unwrap_or(inherited).to_owned();
        for _ in 0..MAX_DEPTH {
            let known = self.classes.get(&class)?;
            if let Some(found) = known.elements.iter().rev().find(|e| fits(e)) {
                return Some(*found);
            }
            class = known.parent.clone()?;
        }
        None
    }

    /// The elements that set an actuator, one after the other: of its class, the outermost one first, and itself.
    pub fn actuators(&self, element: Element<'d>) -> Vec<Element<'d>> {
        let mut all = vec![element];
        let mut class = element.attribute("class").unwrap_or("main").to_owned();
        for _ in 0..MAX_DEPTH {
            let Some(known) = self.classes.get(&class) else { break };
            all.extend(known.elements.iter().rev().filter(|e| ACTUATORS.contains(&e.name())));
            let Some(above) = known.parent.clone() else { break };
            class = above;
        }
        all.reverse();
        all
    }

    /// Text of an attribute.
    pub fn text(&self, element: Element<'d>, class: &str, attribute: &str) -> Option<&'d str> {
        self.holder(element, class, attribute)?.attribute(attribute)
    }

    /// Numbers of an attribute.
    pub fn numbers(&self, e: Element<'d>, class: &str, attribute: &str) -> Result<Option<Vec<f64>>, Diagnostic> {
        let Some(holder) = self.holder(e, class, attribute) else { return Ok(None) };
        holder.numbers(attribute)
    }

    /// First number of an attribute.
    pub fn number(&self, e: Element<'d>, class: &str, attribute: &str) -> Result<Option<f64>, Diagnostic> {
        Ok(self.numbers(e, class, attribute)?.and_then(|n| n.first().copied()))
    }

    /// Three numbers of an attribute.
    pub fn vector(&self, e: Element<'d>, class: &str, attribute: &str) -> Result<Option<[f64; 3]>, Diagnostic> {
        let Some(holder) = self.holder(e, class, attribute) else { return Ok(None) };
        holder.vector(attribute)
    }

    /// Numbers of an attribute of an equality: joints and tendons have equalities of the same name as theirs.
    pub fn equality_numbers(&self, e: Element<'d>, attribute: &str) -> Result<Option<Vec<f64>>, Diagnostic> {
        let Some(holder) = self.holder_by_tag(e, "equality", "main", attribute) else { return Ok(None) };
        holder.numbers(attribute)
    }

    /// True if an equality holds from the start.
    pub fn is_active(&self, equality: Element<'d>) -> bool {
        let holder = self.holder_by_tag(equality, "equality", "main", "active");
        holder.and_then(|holder| holder.attribute("active")) != Some("false")
    }
}
