//! Functions: objects, their names and their tree.

use sincro_dynamics::joint::JointKind;

use super::{Function, Outcome, done, handle, one, plain};
use crate::api::stored::{Form, Stored, check_tag};
use crate::api::{ApiError, Arguments, Entry, Handle, Kind, Search, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "getObject", tip: "int objectHandle=sim.getObject(string path,map options={})", run: get_object },
    Function {
        name: "getObjectHandle",
        tip: "int objectHandle=sim.getObjectHandle(string objectName)",
        run: get_object,
    },
    Function { name: "isHandle", tip: "bool result=sim.isHandle(int objectHandle)", run: is_handle },
    Function {
        name: "getObjectAlias",
        tip: "string objectAlias=sim.getObjectAlias(int objectHandle,int options=-1)",
        run: alias,
    },
    Function {
        name: "getObjectName",
        tip: "string objectName=sim.getObjectName(int objectHandle)",
        run: |d, a| one(named(d, a)?.name.clone()),
    },
    Function {
        name: "getObjectUid",
        tip: "int uid=sim.getObjectUid(int objectHandle)",
        run: |d, a| one(named(d, a)?.handle),
    },
    Function { name: "getObjectType", tip: "int objectType=sim.getObjectType(int objectHandle)", run: object_type },
    Function { name: "getJointType", tip: "int jointType=sim.getJointType(int objectHandle)", run: joint_type },
    Function {
        name: "getObjectParent",
        tip: "int parentObjectHandle=sim.getObjectParent(int objectHandle)",
        run: parent,
    },
    Function {
        name: "getObjectChild",
        tip: "int childObjectHandle=sim.getObjectChild(int objectHandle,int index)",
        run: child,
    },
    Function {
        name: "setObjectParent",
        tip: "sim.setObjectParent(int objectHandle,int parentObjectHandle,bool keepInPlace=true)",
        run: set_parent,
    },
    Function { name: "getObjects", tip: "int objectHandle=sim.getObjects(int index,int objectType)", run: nth },
    Function {
        name: "getObjectsInTree",
        tip: "int[] objects=sim.getObjectsInTree(int treeBaseHandle,int objectType=sim.handle_all,int options=0)",
        run: in_tree,
    },
    Function { name: "createDummy", tip: "int objectHandle=sim.createDummy(float size)", run: create_dummy },
    Function { name: "removeObject", tip: "int result=sim.removeObject(int objectHandle)", run: remove },
    Function { name: "removeModel", tip: "int objectCount=sim.removeModel(int objectHandle)", run: remove_model },
    Function {
        name: "copyPasteObjects",
        tip: "int[] copiedObjectHandles=sim.copyPasteObjects(int[] objectHandles,int options=0)",
        run: copy,
    },
    Function { name: "removeObjects", tip: "sim.removeObjects(int[] objectHandles)", run: remove_all },
    Function {
        name: "getObjectInt32Param",
        tip: "int parameter=sim.getObjectInt32Param(int objectHandle,int parameterID)",
        run: int,
    },
    Function {
        name: "setObjectInt32Param",
        tip: "sim.setObjectInt32Param(int objectHandle,int parameterID,int parameter)",
        run: set_int,
    },
    Function {
        name: "getObjectFloatParam",
        tip: "float parameter=sim.getObjectFloatParam(int objectHandle,int parameterID)",
        run: float,
    },
    Function {
        name: "setObjectFloatParam",
        tip: "sim.setObjectFloatParam(int objectHandle,int parameterID,float parameter)",
        run: set_float,
    },
    Function { name: "setObjectAlias", tip: "sim.setObjectAlias(int objectHandle,string objectAlias)", run: rename },
    Function {
        name: "setObjectName",
        tip: "int result=sim.setObjectName(int objectHandle,string objectName)",
        run: |d, a| rename(d, a).and_then(|_| one(1_i64)),
    },
    Function {
        name: "setObjectProperty",
        tip: "int result=sim.setObjectProperty(int objectHandle,int property)",
        run: set_property,
    },
    Function {
        name: "getObjectSpecialProperty",
        tip: "int property=sim.getObjectSpecialProperty(int objectHandle)",
        run: special_property,
    },
    Function {
        name: "getExtensionString",
        tip: "string theString=sim.getExtensionString(int objectHandle,int index,string key=nil)",
        run: |_, _| one(""),
    },
    Function { name: "getObjectProperty", tip: "int property=sim.getObjectProperty(int objectHandle)", run: property },
    Function {
        name: "setObjectSpecialProperty",
        tip: "int result=sim.setObjectSpecialProperty(int objectHandle,int property)",
        run: set_special_property,
    },
    Function {
        name: "getModelProperty",
        tip: "int property=sim.getModelProperty(int objectHandle)",
        run: model_property,
    },
    Function {
        name: "setModelProperty",
        tip: "int result=sim.setModelProperty(int objectHandle,int property)",
        run: set_model_property,
    },
    Function {
        name: "getLinkDummy",
        tip: "int linkedDummyHandle=sim.getLinkDummy(int dummyHandle)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            one(sim.linked_dummy(own).unwrap_or(Handle(-1)))
        },
    },
    Function {
        name: "setLinkDummy",
        tip: "int result=sim.setLinkDummy(int dummyHandle,int linkedDummyHandle)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            let other = super::scripts::object_of(sim, a)?;
            sim.link_dummies(own, other)?;
            one(1_i64)
        },
    },
    Function {
        name: "addObjectCustomData",
        tip: "int result=sim.addObjectCustomData(int objectHandle,int header,buffer data)",
        run: add_data,
    },
    Function {
        name: "getObjectCustomData",
        tip: "buffer data=sim.getObjectCustomData(int objectHandle,int header)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            let stored = sim.registry.data.get(&(own, header_tag(a)?));
            one(Value::Bytes(stored.map_or_else(Vec::new, |stored| stored.bytes.clone())))
        },
    },
    Function {
        name: "readCustomDataBlock",
        tip: "buffer data=sim.readCustomDataBlock(int objectHandle,string tagName)",
        run: read_data,
    },
    Function {
        name: "writeCustomDataBlock",
        tip: "sim.writeCustomDataBlock(int objectHandle,string tagName,buffer data)",
        run: write_data,
    },
    Function {
        name: "writeCustomBufferData",
        tip: "sim.writeCustomBufferData(int objectHandle,string tagName,buffer data)",
        run: write_data,
    },
    Function {
        name: "readCustomBufferData",
        tip: "buffer data=sim.readCustomBufferData(int objectHandle,string tagName)",
        run: read_data,
    },
    Function {
        name: "writeCustomStringData",
        tip: "sim.writeCustomStringData(int objectHandle,string tagName,string data)",
        run: write_text,
    },
    Function {
        name: "readCustomStringData",
        tip: "string data=sim.readCustomStringData(int objectHandle,string tagName)",
        run: read_text,
    },
    Function {
        name: "writeCustomTableData",
        tip: "sim.writeCustomTableData(int objectHandle,string tagName,map data)",
        run: write_table,
    },
    Function {
        name: "readCustomTableData",
        tip: "map data=sim.readCustomTableData(int objectHandle,string tagName)",
        run: read_table,
    },
    Function {
        name: "setUserParameter",
        tip: "sim.setUserParameter(int objectHandle,string parameterName,any parameterValue)",
        run: set_user_parameter,
    },
    Function {
        name: "getUserParameter",
        tip: "any parameterValue=sim.getUserParameter(int objectHandle,string parameterName)",
        run: user_parameter,
    },
    Function { name: "readCustomDataTags", tip: "string[] tags=sim.readCustomDataTags(int objectHandle)", run: tags },
    Function {
        name: "readCustomDataBlockTags",
        tip: "string[] tags=sim.readCustomDataBlockTags(int objectHandle)",
        run: tags,
    },
    Function {
        name: "getObjectSizeFactor",
        tip: "float sizeFactor=sim.getObjectSizeFactor(int objectHandle)",
        run: |d, a| handle(d, a, 0).and_then(|_| one(1.0)),
    },
    Function {
        name: "getScriptSimulationParameter",
        tip: "any parameterValue=sim.getScriptSimulationParameter(int scriptHandle,string parameterName,bool forceStringReturn=false)",
        run: parameter,
    },
    Function {
        name: "setScriptSimulationParameter",
        tip: "int result=sim.setScriptSimulationParameter(int scriptHandle,string parameterName,string parameterValue)",
        run: set_parameter,
    },
];

impl SimApi<'_> {
    /// Number of an object's type as V-REP has it: 0 shapes and bodies, 1 joints and rotors, 5 proximity sensors, 9
    /// vision sensors, 12 force sensors, 15 octrees, 16 point clouds, 4 (dummies) for everything else.
    #[must_use]
    pub fn type_of(&self, entry: &Entry) -> i64 {
        match entry.kind {
            Kind::Shape if self.registry.octrees.contains_key(&entry.handle) => 15,
            Kind::Shape if self.registry.clouds.contains_key(&entry.handle) => 16,
            Kind::Body(_) | Kind::Shape => 0,
            Kind::Proximity => 5,
            Kind::Joint(Some(_)) => 1,
            // a ball joint is V-REP's spherical one; what V-REP does not have is a point to it
            Kind::Joint(None) if is_ball(self, entry) => 1,
            // a rotor is the joint that would turn it
            Kind::Rotor(_) => 1,
            Kind::ForceSensor(_) => 12,
            Kind::Vision(_) => 9,
            _ => 4,
        }
    }

    /// Number of a joint's type as V-REP has it: 10 revolute (rotors too), 11 prismatic, 12 spherical.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, no joint, or a joint with several coordinates that is not spherical.
    pub fn joint_type(&self, handle: Handle) -> Result<i64, ApiError> {
        let entry = self.registry.entry(handle)?;
        if is_ball(self, entry) {
            return Ok(12);
        }
        if let Kind::Rotor(_) = entry.kind {
            return Ok(10);
        }
        Ok(if matches!(self.registry.joint(handle)?.kind, JointKind::Prismatic { .. }) { 11 } else { 10 })
    }

    /// Handles of the objects with a type number of [`SimApi::type_of`]; −2 and 109 stand for all types. Parents come
    /// before children, runtime objects last, free joints not at all; empty if there are none.
    #[must_use]
    pub fn objects_of_type(&self, wanted: i64) -> Vec<Handle> {
        let fits = |e: &&Entry| matches!(wanted, -2 | 109) || self.type_of(e) == wanted;
        let is_listed = |e: &&Entry| !self.registry.is_left_out(e.handle);
        self.registry.entries().filter(is_listed).filter(fits).map(|e| e.handle).collect()
    }
}

fn is_ball(sim: &SimApi<'_>, entry: &Entry) -> bool {
    sim.world.model().names().joint(&entry.path).is_some_and(|j| j.kind == JointKind::Ball)
}

fn named<'a>(sim: &'a SimApi<'_>, a: Arguments<'_>) -> Result<&'a Entry, ApiError> {
    sim.registry.entry(handle(sim, a, 0)?)
}

fn get_object(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let mut search = Search { from: sim.own, ..Search::default() };
    let mut no_error = false;
    if let Value::Map(options) = a.get(1) {
        for (key, value) in options {
            match key.as_str() {
                "index" => search.index = value.as_int().and_then(|k| usize::try_from(k).ok()),
                "proxy" => {
                    let proxy = value.as_int().and_then(|h| i32::try_from(h).ok()).filter(|h| *h >= 0);
                    search.from = proxy.map(|h| plain(sim, h)).transpose()?;
                    search.below = search.from;
                }
                "noError" => no_error = value.as_bool().unwrap_or(false),
                _ => return Err(ApiError(format!("there is no option `{key}`: index, proxy, noError"))),
            }
        }
    }
    match sim.registry.find(a.text(0)?, search) {
        Ok(handle) => one(handle),
        Err(_) if no_error => one(-1_i64),
        Err(error) => Err(error),
    }
}

fn is_handle(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    one(a.handle(0).is_ok_and(|h| plain(sim, h).is_ok()))
}

fn alias(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let entry = named(sim, a)?;
    one(match a.int_or(1, -1)? {
        1 | 2 => sim.registry.visible_path(entry.handle),
        4 => format!("{}__{}__", entry.name, entry.handle.0),
        5 | 6 => format!("/{}{{{}}}", entry.name, order(sim, entry)),
        0 => format!("{}[{}]", entry.name, order(sim, entry)),
        _ => entry.name.clone(),
    })
}

/// Number of objects of the same name before an object.
fn order(sim: &SimApi<'_>, entry: &Entry) -> usize {
    sim.registry.entries().filter(|e| e.name == entry.name && e.handle < entry.handle).count()
}

fn object_type(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let entry = named(sim, a)?;
    one(sim.type_of(entry))
}

fn joint_type(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.joint_type(own)?)
}

fn parent(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = named(sim, a)?.handle;
    one(sim.registry.visible_parent(own).unwrap_or(Handle(-1)))
}

fn child(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let entry = named(sim, a)?;
    let nth = usize::try_from(a.int(1)?).map_err(|_| ApiError::new("the index is negative"))?;
    one(sim.registry.visible_children(Some(entry.handle)).nth(nth).map_or(Handle(-1), |e| e.handle))
}

fn set_parent(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    // scripts are objects since CoppeliaSim 4.7
    if sim.is_added_script(a.int(0)?) {
        let object = super::scripts::object_of(sim, a)?;
        sim.associate_script(a.int(0)?, object)?;
        return done();
    }
    let own = handle(sim, a, 0)?;
    let parent = match a.handle(1)? {
        -1 => None,
        other => Some(plain(sim, other)?),
    };
    sim.set_parent(own, parent, a.bool_or(2, true)?)?;
    done()
}

fn nth(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let nth = usize::try_from(a.int(0)?).map_err(|_| ApiError::new("the index is negative"))?;
    one(sim.objects_of_type(a.int(1)?).get(nth).copied().unwrap_or(Handle(-1)))
}

fn in_tree(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (wanted, options) = (a.int_or(1, -2)?, a.int_or(2, 0)?);
    let all = sim.objects_of_type(wanted);
    let base = match a.handle(0)? {
        -12 => return Ok(vec![Value::handles(all)]),
        other => plain(sim, other)?,
    };
    let children: Vec<Handle> = sim.registry.visible_children(Some(base)).map(|e| e.handle).collect();
    let tree = if options & 2 != 0 { [vec![base], children].concat() } else { sim.registry.visible_tree(base) };
    let tree = tree.into_iter().filter(|h| all.contains(h) && (options & 1 == 0 || *h != base));
    Ok(vec![Value::handles(tree)])
}

fn create_dummy(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    a.real(0)?;
    one(sim.registry.create_dummy("Dummy")?)
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.remove_later(&[own], false)?;
    one(1_i64)
}

/// An object with all below it; returns their number.
fn remove_model(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let n = sim.registry.visible_tree(own).len();
    sim.remove_later(&[own], true)?;
    one(n as i64)
}

/// Bit 0 of the options: whole models.
fn copy(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (handles, options) = (handles(a, 0)?, a.int_or(1, 0)?);
    Ok(vec![Value::handles(sim.copy_objects(&handles, options & 1 != 0)?)])
}

/// A list of handles.
pub(super) fn handles(a: Arguments<'_>, k: usize) -> Result<Vec<Handle>, ApiError> {
    let wrong = || ApiError(format!("argument {} is no list of handles", k + 1));
    let Value::List(list) = a.get(k) else { return Err(wrong()) };
    let handles = list.iter().map(|v| v.as_int().and_then(|h| i32::try_from(h).ok()).map(Handle));
    handles.collect::<Option<Vec<_>>>().ok_or_else(wrong)
}

/// Handles that are none are left out as long as one is of an object, as in CoppeliaSim: programs remove what may have
/// gone already.
fn remove_all(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let given = handles(a, 0)?;
    let known: Vec<Handle> = given.iter().copied().filter(|own| sim.registry.entry(*own).is_ok()).collect();
    sim.remove_later(if known.is_empty() { &given } else { &known }, false)?;
    done()
}

fn int(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.object_int(own, a.int(1)?)?)
}

fn set_int(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_object_int(own, a.int(1)?, a.int(2)?)?;
    done()
}

fn float(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.object_float(own, a.int(1)?)?)
}

fn set_float(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_object_float(own, a.int(1)?, a.real(2)?)?;
    done()
}

fn special_property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.registry.special_property(own))
}

fn set_special_property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_special_property(own, a.int(1)?)?;
    one(1_i64)
}

fn model_property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.registry.model_property(own)?)
}

fn set_model_property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_model_property(own, a.int(1)?)?;
    one(1_i64)
}

fn property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.registry.common_property(own))
}

/// Properties say what a window shows and lets be selected: kept, and of no effect.
fn set_property(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.registry.set_common_property(own, a.int(1)?);
    one(1_i64)
}

fn rename(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.rename(own, a.text(1)?)?;
    done()
}

/// An object, the scene (−12) or the application (−13): what data are stored with.
pub(super) fn owner(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Handle, ApiError> {
    match a.handle(k)? {
        own @ (-12 | -13) => Ok(Handle(own)),
        _ => handle(sim, a, k),
    }
}

/// Stores data under a tag of an object, the scene or the application.
pub(super) fn store(sim: &mut SimApi<'_>, (own, tag): (Handle, &str), data: Stored) -> Outcome {
    check_tag(tag)?;
    let key = (own, tag.to_owned());
    if sim.registry.data.len() >= 10_000 && !sim.registry.data.contains_key(&key) {
        return Err(ApiError::new("there are 10000 blocks of data already"));
    }
    sim.registry.check_stored_size(tag.len() + data.bytes.len())?;
    sim.registry.data.insert(key, data);
    done()
}

/// The data under the tag that is argument 2.
fn stored<'s>(sim: &'s SimApi<'_>, a: Arguments<'_>) -> Result<Option<&'s Stored>, ApiError> {
    let own = owner(sim, a, 0)?;
    let tag = a.text(1)?;
    check_tag(tag)?;
    Ok(sim.registry.data.get(&(own, tag.to_owned())))
}

/// Stores data under the tag that is argument 2; no bytes remove what is there.
fn write(sim: &mut SimApi<'_>, a: Arguments<'_>, data: Stored) -> Outcome {
    let (own, tag) = (owner(sim, a, 0)?, a.text(1)?);
    if !data.bytes.is_empty() {
        return store(sim, (own, tag), data);
    }
    check_tag(tag)?;
    sim.registry.data.remove(&(own, tag.to_owned()));
    done()
}

/// Tag of data that V-REP 3 stores under a number.
fn header_tag(a: Arguments<'_>) -> Result<String, ApiError> {
    Ok(format!("header {}", a.int(1)?))
}

/// Data under a number; a number as data is its text.
fn add_data(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, tag) = (handle(sim, a, 0)?, header_tag(a)?);
    let bytes = match a.get(2) {
        Value::Int(n) => n.to_string().into_bytes(),
        Value::Real(x) => x.to_string().into_bytes(),
        _ => a.bytes(2)?.to_vec(),
    };
    if bytes.is_empty() {
        sim.registry.data.remove(&(own, tag));
    } else {
        store(sim, (own, &tag), Stored { form: Form::Bytes, bytes })?;
    }
    one(1_i64)
}

fn read_text(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    stored(sim, a)?.map_or(Ok(vec![Value::Nil]), |data| one(data.text()?))
}

/// Text, or what a script has as one and is none.
fn write_text(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    match a.get(2) {
        text @ Value::Text(_) => write(sim, a, Stored::from_value(text)),
        _ => write_data(sim, a),
    }
}

fn write_table(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let data = match a.get(2) {
        Value::Nil => Stored { form: Form::Packed, bytes: Vec::new() },
        table @ (Value::List(_) | Value::Map(_) | Value::Numbered(_)) => Stored::from_value(table),
        other => return Err(ApiError(format!("argument 3 is {}, expected a table", other.word()))),
    };
    write(sim, a, data)
}

/// Tag of the custom data under which a user parameter is stored.
fn user_tag(a: Arguments<'_>) -> Result<Value, ApiError> {
    Ok(Value::Text(format!("__userParameter__.{}", a.text(1)?)))
}

/// User parameters are custom data of the object.
fn set_user_parameter(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let given = [a.get(0).clone(), user_tag(a)?, Value::List(vec![a.get(2).clone()])];
    write_table(sim, Arguments(&given))
}

/// The value that was set, else that of the parameter of a script on the object; nil if there is none.
fn user_parameter(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let stored = read_table(sim, Arguments(&[a.get(0).clone(), user_tag(a)?]))?;
    if let Some(Value::List(list)) = stored.first()
        && let [value] = &list[..]
    {
        return one(value.clone());
    }
    if sim.registry.script_parameters.contains_key(&(own, a.text(1)?.to_owned())) {
        return parameter(sim, Arguments(&[own.into(), a.get(1).clone()]));
    }
    one(Value::Nil)
}

/// An empty table if there is none.
fn read_table(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    stored(sim, a)?.map_or_else(|| one(Value::Map(Vec::new())), |data| one(data.table()?))
}

fn tags(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = owner(sim, a, 0)?;
    let tags = sim.registry.data.keys().filter(|(h, _)| *h == own);
    Ok(vec![Value::List(tags.map(|(_, tag)| Value::from(tag.as_str())).collect())])
}

/// The bytes of data of any form.
fn read_data(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    Ok(vec![stored(sim, a)?.map_or(Value::Nil, |data| Value::Bytes(data.bytes.clone()))])
}

fn write_data(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let bytes = if a.has(2) { a.bytes(2)?.to_vec() } else { Vec::new() };
    write(sim, a, Stored { form: Form::Bytes, bytes })
}

/// Scripts have the handles of their objects here.
fn parameter(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let Some(text) = sim.registry.script_parameters.get(&(own, a.text(1)?.to_owned())) else {
        return Ok(vec![Value::Nil]);
    };
    if a.bool_or(2, false)? {
        return one(text.as_str());
    }
    one(match text.as_str() {
        "nil" => Value::Nil,
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        text => text.trim().parse().map_or_else(|_| Value::from(text), Value::Real),
    })
}

fn set_parameter(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let key = (handle(sim, a, 0)?, a.text(1)?.to_owned());
    let text = a.text(2)?.to_owned();
    match sim.registry.script_parameters.get_mut(&key) {
        Some(known) => *known = text,
        None => return one(-1_i64),
    }
    one(1_i64)
}
