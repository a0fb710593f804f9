//! Functions: the simulation itself, its parameters, messages.

use super::{Function, Outcome, done, one};
use crate::api::stored::check_name;
use crate::api::{ApiError, Arguments, Phase, Request, SimApi, Value};

/// Plug-ins of V-REP and CoppeliaSim whose functions are built in, by their names there.
const MODULES: [&str; 3] = ["RemoteApi", "IK", "UI"];

/// A function on mills: there are none, so that all of them are none.
const fn milling(name: &'static str, tip: &'static str) -> Function {
    Function {
        name,
        tip,
        run: |_, a| match a.int(0)? {
            -2 | -3 => one(0_i64),
            own => Err(ApiError(format!("{own} is no mill: nothing is milled here, shapes keep their form"))),
        },
    }
}

/// The text of the scene as runs begin with it: a file kept with the run of a script, or of a client one in the folder
/// for files of clients.
fn save(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let name = a.text(0)?.to_owned();
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = [".ttt", ".simscene.xml", ".toml"].iter().find_map(|end| last.strip_suffix(end)).unwrap_or(last);
    let file = format!("{stem}.toml");
    super::check_file_name(&file)?;
    let (text, n_left_out) = sim.scene_text()?;
    sim.keep_file(file.clone(), text.into_bytes())?;
    let left_out = match n_left_out {
        0 => String::new(),
        n => format!("; {n} objects that were made at run time and are no part of the model are left out"),
    };
    sim.log(300, &format!("the scene is saved as `{file}`, a scene file of this program{left_out}"));
    one(1_i64)
}

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "msgBox",
        tip: "int result=sim.msgBox(int dlgType,int buttons,string title,string message)",
        run: message_box,
    },
    Function {
        name: "launchExecutable",
        tip: "int result=sim.launchExecutable(string filename,string parameters='',int showStatus=1)",
        run: launch,
    },
    Function { name: "startSimulation", tip: "int result=sim.startSimulation()", run: |d, _| ask(d, Request::Start) },
    Function { name: "pauseSimulation", tip: "int result=sim.pauseSimulation()", run: |d, _| ask(d, Request::Pause) },
    Function {
        name: "stopSimulation",
        tip: "int result=sim.stopSimulation(bool wait=false)",
        run: |d, _| ask(d, Request::Stop),
    },
    Function { name: "loadScene", tip: "sim.loadScene(string filename)", run: load },
    Function { name: "saveScene", tip: "int result=sim.saveScene(string filename)", run: save },
    milling("handleMill", "int removedItems=sim.handleMill(int millHandle)"),
    milling("resetMill", "int result=sim.resetMill(int millHandle)"),
    milling("resetMilling", "int result=sim.resetMilling(int objectHandle)"),
    Function { name: "closeScene", tip: "int result=sim.closeScene()", run: |d, _| ask(d, Request::Close) },
    Function {
        name: "getSimulationState",
        tip: "int simulationState=sim.getSimulationState()",
        run: |d, _| one(d.simulation_state()),
    },
    Function { name: "getSimulationTime", tip: "float simulationTime=sim.getSimulationTime()", run: |d, _| one(d.t) },
    Function {
        name: "getSimulationTimeStep",
        tip: "float timeStep=sim.getSimulationTimeStep()",
        run: |d, _| one(d.registry.sample_time()),
    },
    Function {
        name: "getIsRealTimeSimulation",
        tip: "int result=sim.getIsRealTimeSimulation()",
        run: |_, _| one(0_i64),
    },
    Function {
        name: "getSimulationStopping",
        tip: "bool stopping=sim.getSimulationStopping()",
        run: |_, _| one(false),
    },
    Function {
        name: "getSimulatorMessage",
        tip: "int message,int[4] auxiliaryData,int[] auxiliaryData2=sim.getSimulatorMessage()",
        run: |_, _| Ok(vec![Value::Int(-1), Value::List(vec![Value::Int(0); 4]), Value::List(Vec::new())]),
    },
    Function {
        name: "getModuleName",
        tip: "string moduleName,int moduleVersion=sim.getModuleName(int index)",
        run: module,
    },
    Function {
        name: "getPluginName",
        tip: "string pluginName,int pluginVersion=sim.getPluginName(int index)",
        run: module,
    },
    Function { name: "addLog", tip: "sim.addLog(int verbosityLevel,string logMessage)", run: log },
    Function { name: "addStatusbarMessage", tip: "int result=sim.addStatusbarMessage(string message)", run: message },
    Function {
        name: "getInt32Param",
        tip: "int intState=sim.getInt32Param(int parameter)",
        run: |d, a| one(d.int_parameter(a.int(0)?)?),
    },
    Function { name: "setInt32Param", tip: "sim.setInt32Param(int parameter,int intState)", run: set_int },
    Function {
        name: "getFloatParam",
        tip: "float floatState=sim.getFloatParam(int parameter)",
        run: |d, a| one(d.float_parameter(a.int(0)?)?),
    },
    Function { name: "setFloatParam", tip: "sim.setFloatParam(int parameter,float floatState)", run: set_float },
    Function {
        name: "getBoolParam",
        tip: "bool boolState=sim.getBoolParam(int parameter)",
        run: |d, a| one(d.bool_parameter(a.int(0)?)?),
    },
    Function { name: "setBoolParam", tip: "sim.setBoolParam(int parameter,bool boolState)", run: set_bool },
    Function { name: "getArrayParam", tip: "float[3] arrayOfValues=sim.getArrayParam(int parameter)", run: array },
    Function { name: "setArrayParam", tip: "sim.setArrayParam(int parameter,float[3] arrayOfValues)", run: set_array },
    Function {
        name: "setNamedInt32Param",
        tip: "sim.setNamedInt32Param(string paramName,int intParam)",
        run: |d, a| keep_named(d, a, a.int(1)?.to_string()),
    },
    Function {
        name: "getNamedInt32Param",
        tip: "int intParam=sim.getNamedInt32Param(string paramName)",
        run: |d, a| Ok(vec![number(d, a)?.map_or(Value::Nil, |x: i64| Value::Int(x))]),
    },
    Function {
        name: "setNamedFloatParam",
        tip: "sim.setNamedFloatParam(string paramName,float floatParam)",
        run: |d, a| keep_named(d, a, format!("{:?}", a.real(1)?)),
    },
    Function {
        name: "getNamedFloatParam",
        tip: "float floatParam=sim.getNamedFloatParam(string paramName)",
        run: |d, a| Ok(vec![number(d, a)?.map_or(Value::Nil, |x: f64| Value::Real(x))]),
    },
    Function {
        name: "persistentDataWrite",
        tip: "sim.persistentDataWrite(string dataTag,buffer dataValue,int options=0)",
        run: set_named,
    },
    Function { name: "persistentDataRead", tip: "buffer dataValue=sim.persistentDataRead(string dataTag)", run: named },
    Function {
        name: "getStringParam",
        tip: "string stringState=sim.getStringParam(int parameter)",
        run: |d, a| one(d.string_parameter(a.int(0)?)?),
    },
    Function {
        name: "setNamedStringParam",
        tip: "sim.setNamedStringParam(string paramName,buffer stringParam)",
        run: set_named,
    },
    Function {
        name: "getNamedStringParam",
        tip: "buffer stringParam=sim.getNamedStringParam(string paramName)",
        run: named,
    },
];

/// No program is started. A script goes on, as where V-REP has not found the program, which is then started by hand.
fn launch(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if sim.own.is_none() {
        return Err(ApiError::new("programs and plug-ins are not started by clients"));
    }
    let parameters = if a.has(1) { a.text(1)? } else { "" };
    let program = format!("{} {parameters}", a.text(0)?);
    sim.log(300, &format!("programs are not started by scripts: start this one by hand: {}", program.trim()));
    one(-1_i64)
}

fn ask(sim: &mut SimApi<'_>, request: Request) -> Outcome {
    sim.registry.ask(request);
    one(1_i64)
}

fn load(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.ask(Request::Load(a.text(0)?.to_owned()));
    done()
}

fn log(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.log(a.int(0)? & 0xfff, a.text(1)?);
    done()
}

fn message(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.log(450, if a.has(0) { a.text(0)? } else { "" });
    one(1_i64)
}

fn set_int(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    a.int(1)?;
    sim.set_int_parameter(a.int(0)?)?;
    done()
}

fn set_float(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.set_float_parameter(a.int(0)?, a.real(1)?)?;
    done()
}

/// Switches of the display and of real time are taken and do nothing here: the first has no meaning without a window,
/// the second is the server's. Parts of the step cannot be switched off.
fn set_bool(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.set_bool_parameter(a.int(0)?, a.bool_or(1, false)?)?;
    done()
}

fn array(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    super::list(sim.array_parameter(a.int(0)?)?)
}

fn set_array(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.set_array_parameter(a.int(0)?, a.reals(1)?)?;
    done()
}

/// Named numbers are kept as text: all kinds share their names.
fn number<T: std::str::FromStr>(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Option<T>, crate::api::ApiError> {
    let name = a.text(0)?;
    let Some(bytes) = sim.registry.named.get(name) else { return Ok(None) };
    let text = std::str::from_utf8(bytes).ok().and_then(|text| text.trim().parse().ok());
    text.map(Some).ok_or_else(|| crate::api::ApiError(format!("the parameter `{name}` is no such number")))
}

fn set_named(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    keep_named(sim, a, a.bytes(1)?)
}

fn keep_named(sim: &mut SimApi<'_>, a: Arguments<'_>, bytes: impl AsRef<[u8]>) -> Outcome {
    let (name, bytes) = (a.text(0)?, bytes.as_ref());
    check_name("parameter", name)?;
    if sim.registry.named.len() >= 1_000 && !sim.registry.named.contains_key(name) {
        return Err(crate::api::ApiError::new("there are 1000 named parameters already"));
    }
    sim.registry.check_stored_size(name.len() + bytes.len())?;
    sim.registry.named.insert(name.to_owned(), bytes.to_vec());
    done()
}

fn named(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    Ok(vec![sim.registry.named.get(a.text(0)?).map_or(Value::Nil, |bytes| Value::Bytes(bytes.clone()))])
}

impl Phase {
    /// Returns true for [`Phase::Running`] and [`Phase::Paused`]: a run has been started and not stopped.
    #[must_use]
    pub fn is_on(self) -> bool {
        self != Self::Stopped
    }
}

/// Name and version of a plug-in; nothing after the last one, so that loops over all of them end.
fn module(_: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let index = usize::try_from(a.int(0)?).ok();
    let name = index.and_then(|index| MODULES.get(index));
    Ok(name.map_or_else(|| vec![Value::Nil, Value::Nil], |name| vec![(*name).into(), Value::Int(0)]))
}

/// Text for the operator, and the answer that lets a script go on: ok, or yes if that is asked for.
fn message_box(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    const ASKS: [i64; 2] = [1, 2];
    let (buttons, title, text) = (a.int_or(1, 0)?, a.text(2)?, a.text(3)?);
    sim.log(450, &format!("{title}: {text}"));
    one(if ASKS.contains(&buttons) { 2_i64 } else { 3_i64 })
}
