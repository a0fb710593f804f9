//! Defaults: classes of attribute values, each with a parent class.

use std::collections::BTreeMap;

use sincro_scene::diagnostic::Diagnostic;

use super::include::Files;
use super::record::{ACTUATORS, ActuatorRecord};
use crate::findings::Findings;
use crate::source::Element;

/// Tag of the defaults for an element with this tag, which is no equality: all kinds of tendons have one.
fn default_tag(tag: &str) -> &str {
    match tag {
        "fixed" | "spatial" => "tendon",
        own => own,
    }
}

/// A class as it is once its elements are read; later changes of its parent do not count.
struct Class<'d> {
    parent: Option<String>,
    /// Elements of the parent and its own, except for actuators.
    elements: Vec<Element<'d>>,
    actuator: ActuatorRecord<'d>,
}

/// All classes; the one without parent is `main`.
pub(super) struct Defaults<'d> {
    classes: BTreeMap<String, Class<'d>>,
}

impl<'d> Defaults<'d> {
    pub fn new(files: &Files<'d>, all: &[Element<'d>], findings: &mut Findings) -> Self {
        let main = Class { parent: None, elements: Vec::new(), actuator: ActuatorRecord::START };
        let mut defaults = Self { classes: BTreeMap::from([("main".to_owned(), main)]) };
        for element in all {
            defaults.class(files, *element, None, findings);
        }
        defaults
    }

    fn class(&mut self, files: &Files<'d>, element: Element<'d>, parent: Option<&str>, findings: &mut Findings) {
        element.keep();
        let name = match (element.attribute("class"), parent) {
            (None | Some("main"), None) => "main",
            (Some(_), None) => {
                let message = "the outermost class of defaults is `main`, and has no other name";
                return findings.error(element.error(message).with_help("nest the class in another `default`"));
            }
            (None | Some(""), Some(_)) => return findings.error(element.error("a class of defaults has no name")),
            (Some(name), Some(_)) if self.classes.contains_key(name) => {
                let message = format!("there are two classes of defaults with the name `{name}`");
                return findings.error(element.error(message).with_help("rename one of them"));
            }
            (Some(name), Some(_)) => name,
        };
        let around = self.actuators(parent);
        if let Some(above) = parent.and_then(|parent| self.classes.get(parent)) {
            let (elements, actuator) = (above.elements.clone(), above.actuator);
            self.classes.insert(name.to_owned(), Class { parent: parent.map(str::to_owned), elements, actuator });
        }
        let Some(class) = self.classes.get_mut(name) else { return };
        let (inner, own): (Vec<_>, Vec<_>) = files.elements(element).into_iter().partition(|e| e.name() == "default");
        for child in own {
            child.keep();
            if ACTUATORS.contains(&child.name()) {
                findings.take(class.actuator.set(child, &around));
            } else {
                class.elements.push(child);
            }
        }
        for child in inner {
            self.class(files, child, Some(name), findings);
        }
    }

    /// Actuators of a class and the classes around it, its own first.
    fn actuators(&self, class: Option<&str>) -> Vec<ActuatorRecord<'d>> {
        let named = |name: &str| self.classes.get(name);
        let own = std::iter::successors(class.and_then(named), |class| named(class.parent.as_deref()?));
        own.map(|class| class.actuator).collect()
    }

    /// An actuator with its defaults.
    pub fn actuator(&self, element: Element<'d>) -> Result<ActuatorRecord<'d>, Diagnostic> {
        let classes = self.actuators(element.attribute("class").or(Some("main")));
        let (mut record, around) = match classes.split_first() {
            Some((own, around)) => (*own, around),
            None => (ActuatorRecord::START, &[][..]),
        };
        record.set(element, around)?;
        Ok(record)
    }

    /// Reports elements of a class that there is not.
    pub fn check_classes(&self, element: Element<'d>, findings: &mut Findings) {
        for child in element.elements() {
            for key in ["class", "childclass"] {
                match child.peek(key) {
                    Some(name) if child.name() != "default" && !self.classes.contains_key(name) => {
                        findings.error(child.error(format!("there is no class of defaults `{name}`")));
                    }
                    _ => {}
                }
            }
            self.check_classes(child, findings);
        }
    }

    /// The element that gives an attribute of `element`, which is no equality: itself, or a default of its class or of
    /// the classes above.
    pub fn holder(&self, element: Element<'d>, inherited: &str, attribute: &str) -> Option<Element<'d>> {
        self.holder_by_tag(element, default_tag(element.name()), inherited, attribute)
    }

    /// As [`Self::holder`], with the tag of the defaults for `element`.
    fn holder_by_tag(&self, element: Element<'d>, tag: &str, inherited: &str, attribute: &str) -> Option<Element<'d>> {
        self.holders(element, tag, inherited, attribute).pop()
    }

    /// The nearest element that gives one of several attributes of `element`, which is no equality.
    pub fn nearest(&self, element: Element<'d>, inherited: &str, attributes: &[&str]) -> Option<Element<'d>> {
        let gives = |e: &&Element<'d>| attributes.iter().any(|name| e.peek(name).is_some());
        let class = self.classes.get(element.attribute("class").unwrap_or(inherited));
        let tag = default_tag(element.name());
        let defaults = class.into_iter().flat_map(|class| &class.elements).filter(|e| e.name() == tag);
        defaults.chain([&element]).filter(gives).copied().last()
    }

    /// All elements that give an attribute of `element`, the one that counts last.
    fn holders(&self, element: Element<'d>, tag: &str, inherited: &str, attribute: &str) -> Vec<Element<'d>> {
        let class = self.classes.get(element.attribute("class").unwrap_or(inherited));
        let defaults = class.into_iter().flat_map(|class| &class.elements).filter(|e| e.name() == tag);
        defaults.chain([&element]).filter(|e| e.peek(attribute).is_some()).copied().collect()
    }

    /// Text of an attribute.
    pub fn text(&self, element: Element<'d>, class: &str, attribute: &str) -> Option<&'d str> {
        self.holder(element, class, attribute)?.attribute(attribute)
    }

    /// Numbers of an attribute. One that gives fewer of them than the defaults takes the others from these.
    pub fn numbers(&self, e: Element<'d>, class: &str, attribute: &str) -> Result<Option<Vec<f64>>, Diagnostic> {
        self.numbers_by_tag(e, default_tag(e.name()), class, attribute)
    }

    fn numbers_by_tag(
        &self,
        e: Element<'d>,
        tag: &str,
        class: &str,
        attribute: &str,
    ) -> Result<Option<Vec<f64>>, Diagnostic> {
        let mut all = None;
        for holder in self.holders(e, tag, class, attribute) {
            let mut given = holder.numbers(attribute)?.unwrap_or_default();
            given.extend(all.iter().flatten().skip(given.len()));
            all = Some(given);
        }
        Ok(all)
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
        self.numbers_by_tag(e, "equality", "main", attribute)
    }

    /// True if an equality holds from the start.
    pub fn is_active(&self, equality: Element<'d>) -> bool {
        let holder = self.holder_by_tag(equality, "equality", "main", "active");
        holder.and_then(|holder| holder.attribute("active")) != Some("false")
    }
}
