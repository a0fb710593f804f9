//! `docs/compatibility.md`: every function name of the APIs, as the program's own tables have it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

use sincro_coppelia::api::functions;
use sincro_sim::load;
use sincro_testing::{SceneFolder, run, scenes, with_scripts};

const HEAD: &str = "# Compatibility\n
Generated from the program by `cargo xtask bless`: every function name of V-REP's and CoppeliaSim's APIs that is known here. What the functions do is in
[remote.md](remote.md) and [lua.md](lua.md).

| mark | meaning |
|---|---|
| yes | works as in V-REP or CoppeliaSim |
| part | works, but for what the last column says |
| – | this API does not have it, there or here |

";

/// Functions of scripts as they find them: present names, and those with a global as V-REP had it.
fn of_scripts() -> (BTreeSet<String>, BTreeSet<String>) {
    let code = "
        function sysCall_init()
            for name, value in pairs(sim) do
                if type(value) == 'function' then
                    local old = 'sim' .. name:sub(1, 1):upper() .. name:sub(2)
                    print((type(_G[old]) == 'function' and 'both ' or 'new ') .. name)
                end
            end
            for _, module in ipairs { 'simIK', 'simOMPL', 'simUI', 'simVision', 'simRemoteApi', 'messagePack' } do
                for name, value in pairs(require(module)) do
                    if type(value) == 'function' then print('new ' .. module .. '.' .. name) end
                end
            end
        end";
    let scene = format!("{}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n", scenes::MOTOR_PENDULUM);
    let folder = SceneFolder::new().with("scene.toml", &scene).with("a.lua", code);
    let folder = folder.with("experiment.toml", scenes::MOTOR_PENDULUM_EXPERIMENT);
    let run = run(&load(&folder, &[], with_scripts()).unwrap_or_else(|problems| panic!("{problems}")));
    let (mut new, mut old) = (BTreeSet::new(), BTreeSet::new());
    for message in &run.messages {
        let (kind, name) = message.text.split_once(' ').unwrap();
        new.insert(name.to_owned());
        if kind == "both" {
            old.insert(name.to_owned());
        }
    }
    (new, old)
}

/// Functions that are refused, each with the reason.
fn refused() -> Vec<(String, &'static str)> {
    let of_vision = functions::absent_vision_functions().map(|(name, why)| (format!("simVision.{name}"), why));
    let of_sim = functions::absent().map(|name| (name.to_owned(), functions::why_absent(name).unwrap()));
    // scripts have the first of these
    let of_planning = functions::absent_planning_functions().skip(1);
    let of_planning = of_planning.map(|(name, why)| (format!("simOMPL.{name}"), why));
    of_sim.chain(of_vision).chain(of_planning).collect()
}

/// A row of the table: legacy, ZeroMQ, old and new Lua.
#[derive(Default)]
struct Row {
    offered: [bool; 4],
}

/// All rows by name; older names that mean a present function are left out.
fn rows() -> BTreeMap<String, Row> {
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    let mut mark = |name: String, column: usize| rows.entry(name).or_default().offered[column] = true;
    for (name, why) in sincro_remote::legacy::functions() {
        if why.is_none() {
            let of_script = format!("sim{}", &name[4..]);
            let present = functions::present_name(&of_script);
            let is_shared = functions::function(&present).is_some() || present == "callScriptFunction";
            mark(if is_shared { present.into_owned() } else { name.to_owned() }, 0);
        }
    }
    sincro_remote::zmq::present_names().into_iter().for_each(|name| mark(name.to_owned(), 1));
    functions::ik_functions().for_each(|f| mark(format!("simIK.{}", f.name), 1));
    functions::planning_functions().for_each(|f| mark(format!("simOMPL.{}", f.name), 1));
    functions::ui_functions().for_each(|f| mark(format!("simUI.{}", f.name), 1));
    functions::vision_functions().for_each(|f| mark(format!("simVision.{}", f.name), 1));
    let absent: BTreeSet<String> = refused().into_iter().map(|(name, _)| name).collect();
    let older: BTreeSet<String> = functions::old_names()
        .map(|(old, _)| old.to_owned())
        .chain(functions::old_ik_names().map(|(old, _)| format!("simIK.{old}")))
        .collect();
    let (new, old) = of_scripts();
    for (names, column) in [(old, 2), (new, 3)] {
        for name in names.into_iter().filter(|name| !absent.contains(name) && !older.contains(name)) {
            mark(name, column);
        }
    }
    rows
}

/// Files of a kind in a folder of the acceptance programs.
fn count(folder: &str, ending: &str) -> usize {
    let path = root().join("examples/clients/programs").join(folder);
    let files = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|found| found == ending)).count()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn page() -> String {
    let rows = rows();
    let mut out = String::from(HEAD);
    let programs = [
        ("legacy", "py", "legacy remote API"),
        ("zmq", "py", "ZeroMQ, version 2"),
        ("zmq1", "py", "ZeroMQ, version 1"),
        ("scripts", "lua", "Lua, old and new style"),
    ];
    out += "Acceptance programs (`examples/clients/programs`), run by `.ci/run`, which fails if one of them does not pass (programs of ZeroMQ are left out where pip cannot install their client):\n\n| programs | API |\n|---|---|\n";
    for (folder, ending, api) in programs {
        writeln!(out, "| {} | {api} |", count(folder, ending)).unwrap();
    }
    let all = |column: usize| rows.values().filter(|row| row.offered[column]).count();
    let refused = refused();
    let n_older = functions::old_names().count() + functions::old_ik_names().count();
    write!(
        out,
        "\n| | legacy | ZeroMQ, WebSocket | Lua `simX` | Lua `sim.x` |\n|---|---|---|---|---|\n| offered | {} | {} | {} | {} |\n\nNot counted: {n_older} older names of the same functions. {} functions are refused, with their reasons (below).\n\n## Offered\n\n| function | legacy | ZeroMQ | `simX` | `sim.x` | what is missing |\n|---|---|---|---|---|---|\n",
        all(0), all(1), all(2), all(3), refused.len()
    )
    .unwrap();
    for (name, row) in &rows {
        let (missing, in_scripts) = (functions::missing_part(name), functions::missing_in_scripts(name));
        let word = |column: usize| match (row.offered[column], missing.or(in_scripts.filter(|_| column >= 2))) {
            (false, _) => "–",
            (true, None) => "yes",
            (true, Some(_)) => "part",
        };
        writeln!(
            out,
            "| {name} | {} | {} | {} | {} | {} |",
            word(0),
            word(1),
            word(2),
            word(3),
            missing.or(in_scripts).unwrap_or_default()
        )
        .unwrap();
    }
    out += "\n## Refused\n\nBy every API that has them, with the reason in the error (legacy: return code 8 and `simxGetLastErrors`).\n\n| reason | functions |\n|---|---|\n";
    let mut reasons: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, why) in &refused {
        reasons.entry(why).or_default().insert(name);
    }
    for (name, why) in sincro_remote::legacy::functions() {
        if let Some(why) = why {
            reasons.entry(why).or_default().insert(name);
        }
    }
    for (why, names) in reasons {
        writeln!(out, "| {why} | {} |", names.into_iter().collect::<Vec<_>>().join(", ")).unwrap();
    }
    out
}

/// The committed page must be the one that the tables give; `SINCRO_BLESS=1` rewrites it.
#[test]
fn committed_page_is_that_of_the_tables() {
    let (path, page) = (root().join("docs/compatibility.md"), page());
    if std::env::var_os("SINCRO_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == page, "{} is out of date: run the tests with SINCRO_BLESS=1", path.display());
}

#[test]
fn what_an_api_has_another_has_unless_it_belongs_to_that_one() {
    let rows = rows();
    let unknown: Vec<&str> =
        functions::partly_in_scripts().filter(|name| !rows.get(*name).is_some_and(|row| row.offered[3])).collect();
    assert_eq!(unknown, Vec::<&str>::new(), "told of in the table, but no script has them");
    assert!(rows.len() > 400, "{}", rows.len());
    // every function of the session is there for clients and scripts
    let differ: Vec<&String> = rows
        .iter()
        .filter(|(name, row)| functions::function(name).is_some() && row.offered[1] != row.offered[3])
        .map(|(name, _)| name)
        .collect();
    assert_eq!(differ, Vec::<&String>::new());
    for name in ["getObjectPosition", "setJointTargetVelocity", "getFloatSignal", "readProximitySensor"] {
        assert_eq!(rows[name].offered, [true; 4], "{name}");
    }
}
