//! Modules beside `sim`: user interfaces without windows, MessagePack, the remote API; threads in tracebacks; the calls
//! of the stock quadricopters.

use sincro_sim::results::Status;

use super::world::{EXPERIMENT, PENDULUM, open, run, said};

#[test]
fn message_pack_gives_back_what_was_packed_in_the_published_format() {
    let code = r#"
        function sysCall_init()
            local mp = require 'messagePack'
            local function hex(s) return (s:gsub('.', function(c) return ('%02x'):format(c:byte()) end)) end
            -- examples of the format's specification
            print(hex(mp.pack({ compact = true, schema = 0 })))
            print(hex(mp.pack(-1)), hex(mp.pack(128)), hex(mp.pack(-32768)), hex(mp.pack(1.5)), hex(mp.pack('abc')), hex(mp.pack({ 1, 2 })))
            -- tables with holes or other keys are maps: nothing of them is lost
            for _, t in ipairs { { 1, 2, nil, 4, x = 5 }, { 1, nil, 3 }, { [1.5] = 2, [1] = 3 }, { [0] = 1, 2 }, { x = 1, y = 2, 3, 4 }, {}, { 1, 2, 3 } } do
                local back, n, m = mp.unpack(mp.pack(t)), 0, 0
                for k, v in pairs(t) do n = n + (back[k] == v and 1 or 1000) end
                for _ in pairs(back) do m = m + 1 end
                if n ~= m then print('lost', n, m) end
            end
            local mixed = mp.unpack(mp.pack { 1, 2, nil, 4, x = 5 })
            print(mixed[1], mixed[2], mixed[3], mixed[4], mixed.x)
            local long = string.rep('x', 70000)
            local t = mp.unpack(mp.pack { a = { 1, -2, 3.25, 'text', false }, b = long, n = 1 << 40, [7] = true })
            print(t.a[1], t.a[2], t.a[3], t.a[4], t.a[5], t.b == long, t.n, t[7])
            for _, n in ipairs { 0, 127, 128, 255, 256, 65535, 65536, 4294967296, -32, -33, -129, -40000, -3000000000, math.mininteger } do
                if mp.unpack(mp.pack(n)) ~= n then print('wrong', n) end
            end
            for _, bad in ipairs { '', '\xc1', '\x92\x01', '\xda\xff\xffx', string.rep('\x91', 1000) } do
                if pcall(mp.unpack, bad) then print('taken', #bad) end
            end
        end"#;
    assert_eq!(
        said(code),
        [
            "82a7636f6d70616374c3a6736368656d6100",
            "ff\tcc80\td18000\tcb3ff8000000000000\ta3616263\t920102",
            "1\t2\tnil\t4\t5",
            "1\t-2\t3.25\ttext\tfalse\ttrue\t1099511627776\ttrue",
        ]
    );
}

#[test]
fn interfaces_have_no_windows_and_keep_what_they_are_told() {
    let code = r#"
        function sysCall_init()
            simUI = require 'simUI'
            local ui = simUI.create('<ui title="T"><slider id="1" on-change="moved"/></ui>')
            simUI.setSliderValue(ui, 1, 40)
            simUI.setLabelText(ui, 2, 'far')
            simUI.addCurve(ui, 3, 0, 'curve', { 1, 2, 3 }, 0, {})
            print(simUI.getSliderValue(ui, 1), simUI.getLabelText(ui, 2), simUI.getEditValue(ui, 9) == '', simUI.isVisible(ui))
            simUI.destroy(ui)
            print(simUI.getSliderValue(ui, 1))
        end"#;
    assert_eq!(said(code), ["40\tfar\ttrue\tfalse", "0"]);
}

#[test]
fn a_run_without_a_server_says_that_no_port_is_opened() {
    let code = "
        function sysCall_init()
            print(simRemoteApi.start(19999, 1300, false, true), simExtRemoteApiStart(20000))
            print(simRemoteApi.stop(19999), simRemoteApi.reset(19999), (simRemoteApi.status(19999)))
            print(pcall(simRemoteApi.start, -1))
        end";
    let said = said(code);
    assert!(said.contains(&"-1\t-1".to_owned()) && said.contains(&"-1\t-1\t-1".to_owned()), "{said:?}");
    for name in ["stop", "reset"] {
        let line = format!("simRemoteApi.{name} does nothing to port 19999");
        assert!(said.iter().any(|said| said.contains(&line)), "{said:?}");
    }
    assert_eq!(said.iter().filter(|line| line.contains("is not opened: nothing is served")).count(), 2);
    assert!(said.last().unwrap().starts_with("false\t") && said.last().unwrap().contains("expected 1 to 65535"));
}

#[test]
fn a_traceback_takes_a_thread_before_its_message() {
    let code = "
        function sysCall_init()
            local co = coroutine.create(function() error('inside') end)
            local _, message = coroutine.resume(co)
            local text = debug.traceback(co, message)
            print(text:match('inside') and text:match('stack traceback:'))
            print(debug.traceback(co):match('^stack traceback:'), debug.traceback('here', 1):match('^here'))
        end";
    assert_eq!(said(code), ["stack traceback:", "stack traceback:\there"]);
}

#[test]
fn the_calls_of_the_stock_quadricopters_are_taken() {
    let code = "
        function sysCall_init()
            sim.setScriptSimulationParameter(sim.handle_self, 'fakeShadow', 'true')
            print(sim.setScriptSimulationParameter(sim.handle_tree, 'fakeShadow', 'false'), sim.setScriptSimulationParameter(sim.handle_tree, 'none', '1'))
            print(simGetScriptSimulationParameter(sim_handle_self, 'fakeShadow'), simGetObjectSizeFactor(sim.getObject('.')))
            shadow = simAddDrawingObject(sim_drawing_discpoints + sim_drawing_cyclic + sim_drawing_25percenttransparency
                + sim_drawing_50percenttransparency + sim_drawing_itemsizes, 0.2, 0, -1, 1)
            simAddDrawingObjectItem(shadow, { 0, 0, 0.002, 0, 0, 1, 0.2 })
            local kind = sim.particle_roughspheres + sim.particle_cyclic + sim.particle_respondable1to4 + sim.particle_respondable5to8 + sim.particle_ignoresgravity
            local jet = sim.addParticleObject(kind, 0.005, 8500, { 2, 1, 0.2, 3, 0.4 }, 0.5, 50, { 0.3, 0.7, 1 })
            sim.addParticleObjectItem(jet, { 0, 0, 0, 0, 0, -1 })
            sim.removeParticleObject(jet)
            local view = simFloatingViewAdd(0.9, 0.9, 0.2, 0.2, 0)
            simAdjustView(view, sim.getObject('.'), 64)
            simFloatingViewRemove(view)
            simRemoveDrawingObject(shadow)
            -- a script is an object of its own since 4.7: two points are what it is on
            print(sim.getObject('../arm') == sim.getObject('/hinge/arm'), sim.boolOr32(4, 3))
        end";
    assert_eq!(said(code), ["1\t0", "false\t1.0", "true\t7"]);
}

#[test]
fn packets_of_tubes_go_from_end_to_end() {
    let code = "
        function sysCall_init()
            local a, b = sim.tubeOpen(0, 'link', 10), simTubeOpen(0, 'link', 10)
            print(sim.tubeStatus(a))
            print(sim.tubeWrite(a, 'one'), sim.tubeWrite(a, 'two'), sim.tubeRead(b), sim.tubeRead(b), sim.tubeRead(b))
            sim.tubeClose(a)
            print(sim.tubeWrite(b, 'three'), pcall(sim.tubeRead, a))
        end";
    let said = said(code);
    assert_eq!(said[..2], ["1\t0\t0", "1\t1\tone\ttwo\tnil"]);
    assert!(said[2].starts_with("0\tfalse\t"), "{said:?}");
}

#[test]
fn json_is_written_and_read_as_by_dkjson() {
    let code = r#"
        function sysCall_init()
            local json = require 'dkjson'
            print(json.encode({ 1, 2, { x = 'a"\n', y = { true, false } }, 1.5 }))
            print(json.encode({}), json.encode(setmetatable({}, { __jsontype = 'object' })), json.encode({ 1, nil, 3 }))
            print(json.encode({ b = 1, a = 2, c = 3 }, { keyorder = { 'c', 'a' } }))
            print(json.encode({ a = { 1 }, b = json.null, c = 0 / 0 }, { indent = true }))
            local value, after, why = json.decode([=[ { "a": [1, -2.5e3, "\u00e4\ud83d\ude00\n"], /* c */ "b": {}, "n": null } rest]=])
            print(value.a[1], value.a[2], value.a[3] == 'ä😀\n', value.n, json.encode(value), after, why)
            print(json.decode('[null, 1]', 1, json.null)[1] == json.null)
            for _, text in ipairs { '', '[1, 2', '{"a" 1}', '{"a": nope}', '[1 2]', '"abc' } do
                print(select(2, json.decode(text)), select(3, json.decode(text)))
            end
            print(pcall(json.encode, { f = print }))
            local t = {} t.t = t
            print(pcall(json.encode, t))
            print(require 'json' == json)
        end"#;
    assert_eq!(
        said(code),
        [
            r#"[1,2,{"x":"a\"\n","y":[true,false]},1.5]"#,
            "[]\t{}\t[1,null,3]",
            r#"{"c":3,"a":2,"b":1}"#,
            "{\n  \"a\": [\n    1\n  ],\n  \"b\": null,\n  \"c\": null\n}",
            "1\t-2500.0\ttrue\tnil\t{\"a\":[1,-2500.0,\"ä😀\\n\"],\"b\":{}}\t74\tnil",
            "true",
            "1\tno valid JSON value (reached the end)",
            "1\tunterminated array at line 1, column 1",
            "5\t':' expected at line 1, column 5",
            "7\tno valid JSON value at line 1, column 7",
            "4\t',' or ']' expected at line 1, column 4",
            "1\tunterminated string at line 1, column 1",
            "false\ttype 'function' is not supported by JSON.",
            "false\treference cycle",
            "true",
        ]
    );
}

#[test]
fn matrices_and_vectors_are_there_without_require() {
    let code = r#"
        function sysCall_init()
            local m = Matrix(2, 2, { 1, 2, 3, 4 })
            print(m * m, m:t(), m[2][1], m:get(1, 2), m:det(), (m * m:inv() - Matrix:eye(2)):abs():max() < 1e-12)
            print(m + m, 2 * m - m / 2, -m, Matrix { { 1, 2 }, { 3, 4 } } == m, m:data())
            local a, b = Vector3 { 1, 2, 3 }, Vector3 { 4, 5, 6 }
            print(a + b, a:dot(b), a:cross(b), Vector3({ 3, 4, 0 }):norm(), a[2], #a, a:t() * b)
            a[1] = 7
            m[1][2] = 9
            print(a, m, Vector(2, 5), Vector { 1, 2 }:data(), m:row(2), m:col(1))
            local x = Matrix4x4:fromposition({ 1, 2, 3 }) * Matrix4x4:rotz(math.pi / 2)
            local p = x * Vector4 { 1, 0, 0, 1 }
            print(math.abs(p[1] - 1) < 1e-12, math.abs(p[2] - 3) < 1e-12, p[3])
            local pose = x:topose()
            print(#pose, (Matrix4x4:frompose(pose) - x):abs():max() < 1e-12, (Matrix3x3:fromeuler(x:toeuler()) - x:torotation()):abs():max() < 1e-12)
            print(pcall(function() return m * a end))
            print(require('matrix').Matrix == Matrix)
        end"#;
    assert_eq!(
        said(code),
        [
            "Matrix{{7, 10}, {15, 22}}\tMatrix{{1, 3}, {2, 4}}\t3\t2\t-2.0\ttrue",
            "Matrix{{2, 4}, {6, 8}}\tMatrix{{1.5, 3.0}, {4.5, 6.0}}\tMatrix{{-1, -2}, {-3, -4}}\ttrue\t{1, 2, 3, 4}",
            "Vector{5, 7, 9}\t32\tVector{-3, 6, -3}\t5.0\t2\t3\tVector{32}",
            "Vector{7, 2, 3}\tMatrix{{1, 9}, {3, 4}}\tVector{5, 5}\t{1, 2}\tMatrix{{3, 4}}\tVector{1, 3}",
            "true\ttrue\t3.0",
            "7\ttrue\ttrue",
            "false\tscript:16: the product of 2×2 and 3×1: expected as many rows as columns",
            "true",
        ]
    );
}

#[test]
fn tables_are_printed_with_their_values() {
    let code = r#"
        function sysCall_init()
            print({ 1, 2, 3 }, { a = 1 }, 'text', { b = 'x', a = { true, 1.5 }, [10] = 2, 7 })
            local t = { 1 }
            t.me = t
            print(t, {}, { [print] = 1 }, setmetatable({}, { __tostring = function() return 'own' end }))
            print(getAsString({ 1, 2 }, 'x', 3), getAsString('plain'))
            local long = {}
            for k = 1, 100000 do long[k] = k end
            print(long)
        end"#;
    let said = said(code);
    assert_eq!(said[0], "{1, 2, 3}\t{a=1}\ttext\t{7, [10]=2, a={true, 1.5}, b=\"x\"}");
    assert_eq!(said[1], "{1, me={...}}\t{}\t{...}\town");
    assert_eq!(said[2], "{1, 2}, x, 3\tplain");
    assert!(said[3].starts_with("{1, 2, 3, ") && said[3].len() <= 10_000, "{}", said[3].len());
}

/// The pendulum with a script that has these files.
fn with_files(code: &str, files: &[(&str, &str)]) -> Result<Vec<String>, String> {
    let names: Vec<String> = files.iter().map(|(name, _)| format!("{name:?}")).collect();
    let scene =
        format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\nfiles = [{}]\n", names.join(", "));
    let own = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)];
    let run = run(&open(&[&own[..], files].concat()).map_err(|problems| problems.to_string())?);
    match run.status {
        Status::Completed => Ok(run.messages.into_iter().map(|m| m.text).collect()),
        other => Err(format!("{other:?}")),
    }
}

#[test]
fn files_of_the_scene_are_modules() {
    let helper =
        "loads = (loads or 0) + 1\nlocal M = { name = ... }\nfunction M.twice(x) return 2 * x ^ 1 end\nreturn M";
    let plain = "function of_plain() return 7 end";
    let old = "module(..., package.seeall)\ncount = 3\nfunction more() count = count + 1 return tostring(count) end";
    let said = with_files(
        "function sysCall_init()
            package.path = package.path .. ';./lib/?.lua'
            local a, b = require('helper'), require 'helper'
            print(a == b, loads, a.name, a.twice(4))
            print(require 'lib.plain', of_plain(), require('lib/plain'))
            package.loaded.helper = nil
            print(require('helper') == a, loads)
            local old = require 'old'
            print(old.count, old.more(), old.count, _G.count, _G.old == old)
        end",
        &[("helper.lua", helper), ("lib/plain.lua", plain), ("old.lua", old)],
    )
    .unwrap();
    assert_eq!(said, ["true\t1\thelper\t8.0", "true\t7\ttrue", "false\t2", "3\t4\t4\tnil\ttrue"]);
}

#[test]
fn a_file_of_the_scene_goes_before_a_module_of_its_name() {
    let said = with_files(
        "function sysCall_init()
            package.preload.given = function(name) return { name = name } end
            print(require('json').of_scene, require('given').name, require('dkjson').of_scene)
            print(require('dkjson').decode('\"\\\\u-001\"'))
        end",
        &[("json.lua", "return { of_scene = true }")],
    )
    .unwrap();
    assert_eq!(said[0], "true\tgiven\tnil");
    assert!(!said[1].contains("value out of range"), "{said:?}");
}

#[test]
fn libraries_of_lua_are_modules() {
    let said = with_files(
        "local math, text = require('math'), require 'string'
        function sysCall_init()
            print(math.floor(2.5), text.upper('a'), require('table') == table, require('_G') == _G, require('math').of_scene)
        end",
        &[("table.lua", "return 'of the scene'")],
    )
    .unwrap();
    assert_eq!(said, ["2\tA\tfalse\ttrue\tnil"]);
}

#[test]
fn a_module_that_is_no_file_of_the_script_says_where_it_would_stand() {
    let code = "function sysCall_init() require 'missing' end";
    let why = with_files(code, &[("helper.lua", "return 1")]).unwrap_err();
    assert!(why.contains("there is no module 'missing'") && why.contains("files = [\\\"missing.lua\\\"]"), "{why}");
    let broken = with_files("function sysCall_init() require 'helper' end", &[("helper.lua", "\nlocal = 1")]);
    assert!(broken.unwrap_err().contains("helper.lua:2:"), "the place in the file");
    let endless = with_files("function sysCall_init() require 'helper' end", &[("helper.lua", "while true do end")]);
    assert!(endless.unwrap_err().contains("instructions"), "it counts as the script that loads it");
}

#[test]
fn modules_that_ask_for_each_other_are_a_loop() {
    let scene =
        format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nfile = \"s.lua\"\nfiles = [\"a.lua\", \"b.lua\"]\n");
    let a = "local b = require 'b' return { name = 'a' }";
    let b = "local a = require 'a' return { name = 'b' }";
    let code = "function sysCall_init()
            local ok, why = pcall(require, 'a')
            print(ok, why:match('loop of modules: `[ab].lua`'))
            -- and again: what failed is no module
            print((pcall(require, 'a')))
        end";
    let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("s.lua", code), ("a.lua", a), ("b.lua", b)];
    let run = run(&open(&files).unwrap_or_else(|p| panic!("{p}")));
    let said: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(said, ["false\tloop of modules: `a.lua`", "false"]);
}
