//! Tendons: fixed and spatial ones without wrapping, their springs, dampers and stops, equalities that hold them, and
//! actuators on them.
//!
//! Stops and equalities are soft in the source: with the time constant T and the damping ratio ζ of `solref` a
//! constraint with the mass m behaves as a spring of stiffness m/(T ζ)² with a damper 2 m/T, and with negative numbers
//! −k, −c as m k and m c. Source: key `mjcf`, solver parameters; m is that of the robot along the tendon at its
//! reference ([`tendon_mass`]).

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::record::Range;
use crate::export::UNLIMITED;
use crate::findings::Findings;
use crate::path_mass::tendon_mass;
use crate::robot::{Robot, Tendon, TendonLimits, TendonPath};
use crate::source::Element;

/// Time constant `[s]` and damping ratio of soft constraints where the source gives none.
const SOLREF: [f64; 2] = [0.02, 1.0];

/// A tendon as equalities and actuators refer to it.
pub(super) struct KnownTendon {
    /// Its path; the reason if it has none here.
    pub path: Result<TendonPath, String>,
    /// Length at zero coordinates in the source, less that of the path here: of references `[m]`.
    pub offset: f64,
    /// Length at the reference of the source `[m]`.
    pub reference: f64,
    /// Length of the path here at the coordinates of springs, at which a spring without length of its own rests `[m]`.
    pub rest: f64,
    /// Range of lengths in the source, whether it limits or not `[m]`.
    pub range: Option<[f64; 2]>,
}

/// Stiffness and damping of a soft constraint with a mass `[kg]`, from the numbers of its `solref`.
pub(super) fn softness(solref: Option<Vec<f64>>, mass: f64) -> (f64, f64) {
    let given = solref.unwrap_or_default();
    let [one, two] = [0, 1].map(|k| given.get(k).copied().unwrap_or(SOLREF[k]));
    if one <= 0.0 && two <= 0.0 {
        return (-mass * one, -mass * two);
    }
    let [time, ratio] = [one.max(1e-6), two.max(1e-3)];
    (mass / (time * time * ratio * ratio), 2.0 * mass / time)
}

impl<'d> Reader<'d> {
    /// Friction and armature of all tendons of one joint, which are those of the joint.
    pub(super) fn joint_properties(&self, tendons: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for element in self.files.elements(tendons) {
            for key in ["frictionloss", "armature"] {
                let done = self.joint_property(element, key, robot);
                findings.take(done);
            }
        }
    }

    /// All tendons. One without force only measures, and is kept for actuators on it.
    pub(super) fn tendons(&mut self, tendons: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for element in self.files.elements(tendons) {
            element.keep();
            let made = self.tendon(element, robot, findings);
            findings.take(made);
        }
    }

    /// Friction or armature of a tendon.
    fn joint_property(&self, e: Element<'d>, key: &str, robot: &mut Robot) -> Result<(), Diagnostic> {
        let Some(x) = self.defaults.number(e, "main", key)?.filter(|x| *x != 0.0) else { return Ok(()) };
        if x < 0.0 {
            return Err(e.error(format!("`{key}` of a tendon is negative")));
        }
        if key == "frictionloss" && e.peek("name").is_some_and(|name| self.held.contains(name)) {
            e.change("its `frictionloss` is left out: an equality holds its length");
            return Ok(());
        }
        // a tendon that is none is an error of its own, which `tendons` finds
        let Ok(known) = self.known_tendon(e, robot) else { return Ok(()) };
        let Ok(TendonPath::Joints(shares)) = known.path else {
            return Err(e.error(format!("`{key}` of a tendon through sites has no counterpart")));
        };
        let &[(joint, coefficient)] = &shares[..] else {
            return Err(e
                .error(format!("`{key}` of a tendon of several joints has no counterpart"))
                .with_help("of a tendon of one joint it has: that of the joint"));
        };
        let joint = &mut robot.joints[joint];
        let (list, own) = match key {
            "armature" => (&mut joint.armature, x * coefficient * coefficient),
            _ => (&mut joint.friction, x * coefficient.abs()),
        };
        *list = vec![list.first().copied().unwrap_or(0.0) + own];
        e.change(&format!("its `{key}` is that of joint `{}`, by {own}", joint.name));
        Ok(())
    }

    fn tendon(&mut self, e: Element<'d>, robot: &mut Robot, findings: &mut Findings) -> Result<(), Diagnostic> {
        let name = e.attribute("name").map_or_else(|| format!("tendon{}", self.tendons.len() + 1), str::to_owned);
        let known = self.known_tendon(e, robot)?;
        let acts = self.acting(e)?;
        match (&known.path, &acts) {
            (_, None) => e.change("it exerts no force of its own: actuators and equalities on it are elements"),
            (Err(why), Some(key)) => {
                return Err(e.error(format!("tendon `{name}` acts (`{key}`), and {why}: it has no counterpart")));
            }
            (Ok(path), Some(_)) => {
                let mut tendon = Tendon {
                    name: name.clone(),
                    at: e.location(),
                    path: path.clone(),
                    stiffness: self.linear(e, "stiffness")?,
                    damping: self.linear(e, "damping")?,
                    preload: 0.0,
                    free_length: [known.rest; 2],
                    limits: None,
                    actuator: None,
                    command: 0.0,
                    activation: None,
                };
                // one number is both ends, whatever the defaults give
                let holder = self.defaults.holder(e, "main", "springlength");
                if let Some(lengths) = holder.map(|e| e.numbers("springlength")).transpose()?.flatten()
                    // these stand for the length at the start
                    && lengths.iter().any(|x| *x != -1.0)
                {
                    let [low, high] = [lengths[0], *lengths.last().unwrap_or(&lengths[0])];
                    tendon.free_length = [low - known.offset, high.max(low) - known.offset];
                }
                if let Some([low, high]) = self.tendon_range(e)? {
                    match tendon_mass(robot, path) {
                        Some(mass) => {
                            let (stiffness, damping) = softness(self.defaults.numbers(e, "main", "solreflimit")?, mass);
                            let range = [low - known.offset, high - known.offset];
                            tendon.limits = Some(TendonLimits { range, stiffness, damping });
                            e.change(&format!("stops with the stiffness and damping of {mass:.4} kg along it"));
                        }
                        None => {
                            findings.warn(e.error(format!("`range` of tendon `{name}` is left out: it moves nothing")));
                            e.drop("it moves nothing");
                        }
                    }
                }
                let has_force = tendon.limits.is_some() || tendon.stiffness != 0.0 || tendon.damping != 0.0;
                if has_force {
                    robot.tendons.push(tendon);
                }
            }
        }
        self.tendons.insert(name, known);
        Ok(())
    }

    /// The key by which a tendon exerts a force of its own.
    fn acting(&self, e: Element<'d>) -> Result<Option<&'static str>, Diagnostic> {
        for key in ["stiffness", "damping"] {
            if self.defaults.numbers(e, "main", key)?.is_some_and(|n| n.iter().any(|x| *x != 0.0)) {
                return Ok(Some(key));
            }
        }
        Ok(self.tendon_range(e)?.map(|_| "range"))
    }

    /// Range of lengths, if it is one that limits.
    fn tendon_range(&self, e: Element<'d>) -> Result<Option<[f64; 2]>, Diagnostic> {
        // a length has two ends
        let range = Range::of(&self.defaults, e, "main", ["range", "limited"])?;
        let range = self.limiting_range(e, range, "range", "limited")?;
        Ok(range.map(|ends| ends.map(|x| x.clamp(-UNLIMITED, UNLIMITED))))
    }

    /// A stiffness or damping, which is a polynomial in the source, of which here the first number may be given.
    fn linear(&self, e: Element<'d>, key: &str) -> Result<f64, Diagnostic> {
        let numbers = self.defaults.numbers(e, "main", key)?.unwrap_or_default();
        if numbers.iter().skip(1).any(|x| *x != 0.0) {
            return Err(e.error(format!("`{key}` of a tendon is a polynomial, which has no counterpart")));
        }
        Ok(numbers.first().copied().unwrap_or(0.0))
    }

    /// Path of a tendon, and its lengths.
    pub(super) fn known_tendon(&self, e: Element<'d>, robot: &Robot) -> Result<KnownTendon, Diagnostic> {
        let parts = self.files.elements(e);
        parts.iter().for_each(|part| part.keep());
        let range = match self.defaults.numbers(e, "main", "range")?.as_deref() {
            Some(&[low, high]) => Some([low, high]),
            _ => None,
        };
        if e.name() == "fixed" {
            let (shares, offset) = self.shares(e, &parts, robot)?;
            let rest = shares.iter().map(|(joint, share)| share * self.rests[*joint]).sum();
            return Ok(KnownTendon { path: Ok(TendonPath::Joints(shares)), offset, reference: offset, rest, range });
        }
        let mut through = Vec::new();
        let mut reason = None;
        for part in parts {
            match part.name() {
                "site" => {
                    let name = part.attribute("site").unwrap_or_default();
                    let Some(&site) = self.sites.get(name) else {
                        return Err(part.error(format!("there is no site `{name}`")));
                    };
                    through.push(site);
                }
                "geom" => reason = Some("it wraps around a geom".to_owned()),
                "pulley" => reason = Some("it runs over a pulley".to_owned()),
                other => return Err(part.error(format!("a tendon has no `{other}`"))),
            }
        }
        if through.len() < 2 && reason.is_none() {
            return Err(e.error("a spatial tendon runs through two sites or more"));
        }
        let length = |starts: &[f64]| {
            let places: Vec<_> = through.iter().map(|site| robot.link_pose(Some(*site), starts).pos).collect();
            places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
        };
        let (reference, rest) = (length(&[]), length(&self.rests));
        let path = reason.map_or_else(|| Ok(TendonPath::Through(through)), Err);
        Ok(KnownTendon { path, offset: 0.0, reference, rest, range })
    }

    /// Joints of a fixed tendon with their coefficients, and its length at their references.
    fn shares(
        &self,
        tendon: Element<'d>,
        parts: &[Element<'d>],
        robot: &Robot,
    ) -> Result<(Vec<(usize, f64)>, f64), Diagnostic> {
        let mut shares: Vec<(usize, f64)> = Vec::new();
        let mut offset = 0.0;
        for part in parts {
            let name = part.attribute("joint").unwrap_or_default();
            let Some(&joint) = self.joints.get(name) else {
                return Err(part.error(format!("there is no joint `{name}`")));
            };
            if robot.joints[joint].kind.dofs() != 1 {
                return Err(part.error(format!("joint `{name}` has not one degree of freedom")));
            }
            if shares.iter().any(|(known, _)| *known == joint) {
                return Err(part
                    .error(format!("joint `{name}` stands twice in a tendon"))
                    .with_help("give it once, with the sum of the coefficients"));
            }
            let coefficient = part.number("coef")?.unwrap_or(0.0);
            offset += coefficient * self.references[joint];
            shares.push((joint, coefficient));
        }
        if shares.is_empty() {
            return Err(tendon.error("a fixed tendon has no joint").with_help("give it one, or remove it"));
        }
        Ok((shares, offset))
    }

    pub(super) fn tendon_of(&self, e: Element<'d>, key: &str) -> Result<Option<&KnownTendon>, Diagnostic> {
        let Some(name) = e.attribute(key) else { return Ok(None) };
        self.tendons.get(name).map(Some).ok_or_else(|| e.error(format!("there is no tendon `{name}`")))
    }

    /// Names of the tendons whose length equalities hold.
    pub(super) fn held_names(&self, equality: Element<'d>) -> Vec<String> {
        let holds =
            |e: &Element<'d>| e.name() == "tendon" && e.peek("tendon2").is_none() && self.defaults.is_active(*e);
        let held = self.files.elements(equality).into_iter().filter(holds);
        held.filter_map(|e| e.peek("tendon1").map(str::to_owned)).collect()
    }

    /// ℓ₁ − ℓ₁₀ = Σ cₖ (ℓ₂ − ℓ₂₀)ᵏ: a linear one as a stiff tendon, a polynomial between the lengths of one joint each
    /// as a coupling of these.
    pub(super) fn held_tendon(
        &mut self,
        e: Element<'d>,
        robot: &mut Robot,
        findings: &mut Findings,
    ) -> Result<(), Diagnostic> {
        let c = e.numbers("polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]);
        let get = |k: usize| c.get(k).copied().unwrap_or(if k == 1 { 1.0 } else { 0.0 });
        let Some(first) = self.tendon_of(e, "tendon1")? else { return Err(e.error("it names no tendon")) };
        let second = self.tendon_of(e, "tendon2")?;
        let no_path = |why: &String| e.error(format!("a tendon that is held has no counterpart: {why}"));
        let path = first.path.as_ref().map_err(no_path)?;
        let mut length = first.reference - first.offset + get(0);
        let path = match second {
            None => path.clone(),
            Some(second) => {
                let other = second.path.as_ref().map_err(no_path)?;
                let (TendonPath::Joints(one), TendonPath::Joints(two)) = (path, other) else {
                    return Err(e.error("two tendons through sites that are coupled have no counterpart"));
                };
                if (2..5).any(|k| get(k) != 0.0) {
                    let (&[(first, a)], &[(second, b)]) = (&one[..], &two[..]) else {
                        return Err(e
                            .error("tendons of several joints coupled by a polynomial have no counterpart")
                            .with_help("a linear one has, and one between tendons of one joint each"));
                    };
                    if a == 0.0 || b == 0.0 || first == second {
                        return Err(e.error("the lengths of the tendons that it couples are not those of two joints"));
                    }
                    // a q₁ = Σ cₖ (b q₂)ᵏ from the references
                    let [offset, ratio, higher @ ..]: [f64; 5] = std::array::from_fn(|k| get(k) * b.powi(k as i32) / a);
                    e.change("a gear between the joints of two tendons: a [[coupling]]");
                    let follows = || format!("{}-follows", robot.joints[first].name);
                    let name = e.peek("name").map_or_else(follows, str::to_owned);
                    let (at, joints) = (e.location(), [second, first]);
                    robot.gears.push(crate::robot::Gear { name, at, joints, ratio, offset, higher });
                    return Ok(());
                }
                length -= get(1) * (second.reference - second.offset);
                let mut shares = one.clone();
                for (joint, coefficient) in two {
                    match shares.iter_mut().find(|(known, _)| known == joint) {
                        Some((_, sum)) => *sum -= get(1) * coefficient,
                        None => shares.push((*joint, -get(1) * coefficient)),
                    }
                }
                TendonPath::Joints(shares)
            }
        };
        let name = e.peek("name").map_or_else(|| format!("held{}", robot.tendons.len() + 1), str::to_owned);
        let Some(mass) = tendon_mass(robot, &path) else {
            findings.warn(e.error(format!("equality `{name}` is left out: its tendon moves nothing")));
            e.drop("it moves nothing");
            return Ok(());
        };
        let (stiffness, damping) = softness(self.defaults.equality_numbers(e, "solref")?, mass);
        e.change(&format!("a stiff [[tendon]], with the stiffness and damping of {mass:.4} kg along it"));
        let name = if robot.tendons.iter().any(|t| t.name == name) { format!("{name}-held") } else { name };
        robot.tendons.push(Tendon {
            name,
            at: e.location(),
            path,
            stiffness,
            damping,
            preload: 0.0,
            free_length: [length; 2],
            limits: None,
            actuator: None,
            command: 0.0,
            activation: None,
        });
        Ok(())
    }
}
