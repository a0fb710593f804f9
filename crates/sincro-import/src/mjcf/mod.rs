//! Reader of MuJoCo's XML format.
//!
//! Source: key `mjcf`. Includes are put in place, defaults are resolved, several joints of a body become a chain, mass
//! properties come from the geoms where the format says so. Features of the dynamics without a counterpart are refused
//! by name: tendons that wrap or run over pulleys and act, fluid forces, plugins, soft bodies.

mod actuator;
mod body;
mod defaults;
mod equality;
mod frames;
mod geom;
mod height_field;
mod include;
mod inertia;
mod law;
mod orientation;
mod record;
mod reflected;
mod state;
mod tendon;

use std::collections::{BTreeMap, BTreeSet};

use crate::findings::Findings;
use crate::robot::Robot;
use crate::source::Element;
use defaults::Defaults;
pub(crate) use include::load;
use orientation::Angles;
use reflected::Reflected;

/// Reason why an element or attribute is not read.
pub(crate) fn reason(path: &[&str]) -> Option<&'static str> {
    let soft = "contacts, limits and friction are rigid here: no solver parameters";
    match path {
        [
            ..,
            "@solref" | "@solimp" | "@solreflimit" | "@solimplimit" | "@solreffriction" | "@solimpfriction" | "@solmix",
        ] => Some(soft),
        [.., "@margin" | "@gap" | "@condim" | "@priority"] => Some(soft),
        [.., "texture" | "skin" | "light"] => Some("bodies have a colour each, the viewer has its own light"),
        _ if path.contains(&"material") => Some("bodies have a colour each"),
        [.., "visual" | "statistic" | "size" | "custom"] => Some("setting of MuJoCo's viewer or memory"),
        [.., "visual" | "statistic" | "size" | "custom", _] => Some("setting of MuJoCo's viewer or memory"),
        [.., "camera", "@ipd"] => Some("pictures are of one eye"),
        _ if path.contains(&"option") => Some("setting of MuJoCo's solver"),
        _ if path.contains(&"sensor") => Some("its quantity can be recorded, or measured by a [[sensor]]"),
        _ if path.contains(&"contact") => Some("pairs follow from the bodies"),
        [.., "@user"] | [.., "@group"] => Some("data of other programs"),
        [.., "site", "@rgba" | "@size" | "@type" | "@material"] => Some("a frame does not show"),
        [.., "compiler", _] => Some("setting of MuJoCo's compiler that changes nothing here"),
        _ if path.contains(&"tendon") => Some("it neither exerts a force nor changes a length"),
        _ => None,
    }
}

impl<'d> Reader<'d> {
    /// Reads the pairs of bodies that do not touch each other.
    fn exclusions(&self, contact: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for exclude in self.files.elements(contact).into_iter().filter(|e| e.name() == "exclude") {
            exclude.keep();
            exclude.attribute("name");
            let names = ["body1", "body2"].map(|key| exclude.attribute(key).unwrap_or_default());
            let found = names.map(|name| match name {
                "world" => robot.links.iter().position(|link| link.name == name),
                name => self.bodies.get(name).copied(),
            });
            match found {
                [Some(one), Some(two)] => robot.excluded.push([one, two]),
                // a world without geoms touches nothing
                _ => {
                    for name in names.iter().filter(|name| **name != "world" && !self.bodies.contains_key(**name)) {
                        findings.warn(exclude.error(format!("there is no body `{name}`: nothing is excluded")));
                    }
                }
            }
        }
    }
}

/// State of the reader.
struct Reader<'d> {
    files: include::Files<'d>,
    /// Folder of the model.
    folder: std::path::PathBuf,
    defaults: Defaults<'d>,
    angles: Angles,
    settings: Settings,
    /// Meshes of the assets by name.
    meshes: BTreeMap<String, geom::MeshAsset>,
    /// Height fields of the assets by name; the reason where one is not read.
    fields: BTreeMap<String, Result<crate::robot::Shape, String>>,
    /// Mass properties at density 1 of meshes that were read, by file and bits of the factors.
    mesh_masses: geom::MeshMasses,
    /// Colours of materials by name.
    materials: BTreeMap<String, [u8; 3]>,
    /// Links by the names of bodies.
    bodies: BTreeMap<String, usize>,
    /// Links and frames of sites by name: the body's link, the site's own.
    sites: BTreeMap<String, usize>,
    /// Joints by name.
    joints: BTreeMap<String, usize>,
    /// Positions of the bodies of links, as their elements give them: MuJoCo takes the same numbers for the centre of
    /// mass of a body without mass.
    positions: BTreeMap<usize, [f64; 3]>,
    /// Links of mocap bodies.
    mocap: BTreeSet<usize>,
    /// Tendons by name.
    tendons: BTreeMap<String, tendon::KnownTendon>,
    /// Names of tendons whose length an equality holds.
    held: BTreeSet<String>,
    /// Actuators in the order of the file.
    actuators: Vec<actuator::KnownActuator>,
    /// Reference coordinate of each joint of the robot.
    references: Vec<f64>,
    /// Coordinate of springs of each joint of the robot, zero at the reference.
    rests: Vec<f64>,
    /// Ranges of joints of the robot in the source's coordinates, whether they limit or not.
    ranges: BTreeMap<usize, [f64; 2]>,
    /// Joints of the robot whose springs follow from their inertia.
    tuned: Vec<(usize, body::Tuned<'d>)>,
    /// Joints of the tree in the order of the coordinates.
    order: Vec<usize>,
}

/// Settings of the compiler.
#[derive(Debug)]
struct Settings {
    autolimits: bool,
    /// Always (`true`), never (`false`), or where there is no `inertial`.
    inertia_from_geoms: Option<bool>,
    inertia_groups: [i64; 2],
    mesh_folder: String,
    bound_mass: f64,
    bound_inertia: f64,
    balances_inertia: bool,
    total_mass: f64,
    strip_path: bool,
}

/// Reads a model.
pub(crate) fn read<'d>(
    root: Element<'d>,
    roots: &[(std::path::PathBuf, Element<'d>)],
    findings: &mut Findings,
) -> Robot {
    let mut robot = Robot { name: root.attribute("model").unwrap_or("mujoco").to_owned(), ..Robot::default() };
    let files = include::Files::new(roots);
    let top = files.elements(root);
    let all = |name: &str| -> Vec<Element<'d>> { top.iter().filter(|e| e.name() == name).copied().collect() };
    let (settings, angles) = settings(&all("compiler"), findings);
    let mut reader = Reader {
        defaults: Defaults::new(&files, &all("default"), findings),
        files,
        folder: root.file().folder(),
        angles,
        settings,
        meshes: BTreeMap::new(),
        fields: BTreeMap::new(),
        mesh_masses: geom::MeshMasses::default(),
        materials: BTreeMap::new(),
        bodies: BTreeMap::new(),
        sites: BTreeMap::new(),
        joints: BTreeMap::new(),
        positions: BTreeMap::new(),
        mocap: BTreeSet::new(),
        tendons: BTreeMap::new(),
        held: BTreeSet::new(),
        actuators: Vec::new(),
        references: Vec::new(),
        rests: Vec::new(),
        ranges: BTreeMap::new(),
        tuned: Vec::new(),
        order: Vec::new(),
    };
    roots.iter().for_each(|(_, root)| reader.defaults.check_classes(*root, findings));
    for option in all("option") {
        options(option, &mut robot, findings);
    }
    for name in ["extension", "deformable"] {
        for element in all(name) {
            element.keep();
            if !reader.files.elements(element).is_empty() {
                findings.error(element.error(format!("`{name}`: plugins and soft bodies have no counterpart")));
            }
        }
    }
    for asset in all("asset") {
        asset.keep();
        reader.assets(asset, findings);
    }
    for world in all("worldbody") {
        world.keep();
        reader.world(world, &mut robot, findings);
    }
    if robot.links.is_empty() {
        findings.error(root.error("the model has no body"));
        return robot;
    }
    if reader.settings.total_mass > 0.0 {
        scale_mass(&mut robot, reader.settings.total_mass);
    }
    reader.held = all("equality").into_iter().flat_map(|equality| reader.held_names(equality)).collect();
    // springs that are tuned, stops and damping ratios follow from masses with the armatures of tendons and actuators
    let tendons: Vec<_> = all("tendon").into_iter().flat_map(|e| reader.files.elements(e)).collect();
    for tendon in all("tendon") {
        reader.joint_properties(tendon, &mut robot, findings);
    }
    for actuators in all("actuator") {
        reader.reflect(Reflected::Armature, actuators, &tendons, &mut robot, findings);
    }
    reader.tune(&mut robot);
    for actuators in all("actuator") {
        reader.reflect(Reflected::Damping, actuators, &tendons, &mut robot, findings);
    }
    for tendon in all("tendon") {
        tendon.keep();
        reader.tendons(tendon, &mut robot, findings);
    }
    let off = disabled(&all("option"));
    if !off.is_empty() {
        disable(&off, &mut robot);
    }
    for (name, flag) in [("equality", "equality"), ("actuator", "actuation")] {
        for section in all(name) {
            section.keep();
            if off.contains(&flag) {
                reader.files.elements(section).iter().for_each(|e| e.drop("disabled by a flag of the options"));
            } else if name == "equality" {
                reader.equalities(section, &mut robot, findings);
            } else {
                reader.actuators(section, &mut robot, findings);
            }
        }
    }
    for sensor in all("sensor") {
        sensor.keep();
        reader.sensors(sensor, &mut robot);
    }
    for keyframe in all("keyframe") {
        keyframe.keep();
        reader.keyframes(keyframe, &mut robot, findings);
    }
    reader.frames(&all("custom"), &mut robot, findings);
    for contact in all("contact") {
        reader.exclusions(contact, &mut robot, findings);
    }
    robot.has_own_motors = true;
    robot.may_overlap = robot.links.iter().any(|link| !link.collisions.is_empty());
    robot
}

fn settings(all: &[Element<'_>], findings: &mut Findings) -> (Settings, Angles) {
    let mut angles = Angles::default();
    let mut s = Settings {
        autolimits: true,
        inertia_from_geoms: None,
        inertia_groups: [0, 5],
        mesh_folder: String::new(),
        bound_mass: 0.0,
        bound_inertia: 0.0,
        balances_inertia: false,
        total_mass: -1.0,
        strip_path: false,
    };
    for element in all {
        element.keep();
        let flag = |name: &str, old: bool| element.attribute(name).map_or(old, |text| text == "true");
        if let Some(unit) = element.attribute("angle") {
            angles.in_degrees = unit == "degree";
        }
        if let Some(sequence) = element.attribute("eulerseq") {
            match orientation::sequence(sequence) {
                Some(sequence) => angles.sequence = sequence,
                None => findings.error(element.error(format!("`{sequence}` is no sequence of three axes"))),
            }
        }
        if element.attribute("coordinate") == Some("global") {
            findings.error(
                element
                    .error("global coordinates are of an old version")
                    .with_help("save the model again with a newer MuJoCo"),
            );
        }
        s.autolimits = flag("autolimits", s.autolimits);
        s.balances_inertia = flag("balanceinertia", s.balances_inertia);
        s.strip_path = flag("strippath", s.strip_path);
        match element.attribute("inertiafromgeom") {
            Some("true") => s.inertia_from_geoms = Some(true),
            Some("false") => s.inertia_from_geoms = Some(false),
            Some("auto") => s.inertia_from_geoms = None,
            _ => {}
        }
        if let Some(folder) = element.attribute("assetdir").or(element.attribute("meshdir")) {
            folder.clone_into(&mut s.mesh_folder);
        }
        if let Some(folder) = element.attribute("meshdir") {
            folder.clone_into(&mut s.mesh_folder);
        }
        for (name, place) in [
            ("boundmass", &mut s.bound_mass),
            ("boundinertia", &mut s.bound_inertia),
            ("settotalmass", &mut s.total_mass),
        ] {
            if let Some(Some(x)) = findings.take(element.number(name)) {
                *place = x;
            }
        }
        if let Some(Some(range)) = findings.take(element.numbers("inertiagrouprange"))
            && let [a, b] = range[..]
        {
            s.inertia_groups = [a as i64, b as i64];
        }
    }
    (s, angles)
}

fn options(element: Element<'_>, robot: &mut Robot, findings: &mut Findings) {
    element.keep();
    if let Some(gravity) = findings.take(element.vector("gravity")).flatten() {
        robot.gravity = Some(gravity);
    }
    for name in ["density", "viscosity"] {
        if findings.take(element.number(name)).flatten().is_some_and(|x| x > 0.0) {
            let message = format!("fluid forces (`{name}`) have no counterpart");
            findings.error(element.error(message).with_help("set it to zero to import the model without them"));
        }
    }
    if let Some(flag) = element.child("flag")
        && flag.attribute("gravity") == Some("disable")
    {
        robot.gravity = Some([0.0; 3]);
    }
}

/// Forces that flags of the options disable, the last flag of a name counting.
fn disabled(options: &[Element<'_>]) -> Vec<&'static str> {
    let is_off = |name: &str| {
        let given = options.iter().flat_map(|option| option.children("flag")).filter_map(|flag| flag.attribute(name));
        given.last() == Some("disable")
    };
    let [constraint, passive] = ["constraint", "passive"].map(is_off);
    let all = [
        ("contact", constraint),
        ("limit", constraint),
        ("frictionloss", constraint),
        ("equality", constraint),
        ("spring", passive),
        ("damper", passive),
        ("actuation", false),
    ];
    let off: Vec<&str> =
        all.into_iter().filter(|(name, of_all)| is_off(name) || *of_all).map(|(name, _)| name).collect();
    if let (Some(flag), false) = (options.iter().find_map(|option| option.child("flag")), off.is_empty()) {
        flag.change(&format!("disabled, and left out: {}", off.join(", ")));
    }
    off
}

/// Takes what is disabled out of links, joints and tendons that have neither actuators nor equalities yet.
fn disable(off: &[&str], robot: &mut Robot) {
    if off.contains(&"contact") {
        robot.links.iter_mut().for_each(|link| link.collisions.clear());
    }
    for joint in &mut robot.joints {
        if off.contains(&"limit") {
            joint.limits = None;
        }
        if off.contains(&"frictionloss") {
            joint.friction.fill(0.0);
        }
        if off.contains(&"spring") {
            joint.spring = None;
        }
        if off.contains(&"damper") {
            joint.damping.fill(0.0);
        }
    }
    for tendon in &mut robot.tendons {
        if off.contains(&"limit") {
            tendon.limits = None;
        }
        if off.contains(&"spring") {
            tendon.stiffness = 0.0;
        }
        if off.contains(&"damper") {
            tendon.damping = 0.0;
        }
    }
    robot.tendons.retain(|tendon| tendon.limits.is_some() || tendon.stiffness != 0.0 || tendon.damping != 0.0);
}

fn scale_mass(robot: &mut Robot, total: f64) {
    let mass: f64 = robot.links.iter().filter_map(|l| l.inertial).map(|i| i.mass).sum();
    if mass > 0.0 {
        for inertial in robot.links.iter_mut().filter_map(|l| l.inertial.as_mut()) {
            inertial.mass *= total / mass;
            inertial.inertia.iter_mut().for_each(|i| *i *= total / mass);
        }
    }
}
