//! Limits of scripts, and the messages when they are reached.

use sincro_sim::results::Status;

use super::world::{EXPERIMENT, PENDULUM, open, run, stop, with_script};

/// A script that never comes to an end, stopped by its limit.
fn endless(code: &str) {
    let loaded = with_script(code, "max_instructions = 200000").unwrap();
    match run(&loaded).status {
        Status::Stopped { reason, help, .. } => {
            assert!(reason.contains("one call took more than 200000 instructions"), "{code}: {reason}");
            assert!(help.contains("max_instructions"), "{help}");
        }
        other => panic!("{code}: {other:?}"),
    }
}

#[test]
fn no_loop_without_end_goes_on_however_it_catches_errors() {
    let loops = [
        "while true do end",
        "while true do pcall(function() while true do end end) end",
        "while true do pcall(pcall, function() while true do end end) end",
        "while true do xpcall(function() while true do end end, function(e) while true do end end) end",
        "while true do coroutine.resume(coroutine.create(function() while true do end end)) end",
        "local function deep(n) while true do pcall(coroutine.wrap(function()
             if n > 0 then deep(n - 1) else while true do end end end)) end end deep(5)",
        "local t = setmetatable({}, { __index = function(t, k) while true do end end })
             while true do pcall(function() return t.x end) end",
        "while true do pcall(table.sort, { 1, 2, 3 }, function(a, b) while true do end end) end",
        "while true do local x <close> = setmetatable({}, { __close = function() while true do end end }) end",
        "while true do load('while true do end')() end",
        "sim.testCB(1, function() while true do end end, 2)",
        "sim.testCB(1, math.abs, 2, 1 << 40)",
        "while true do pcall(string.find, ('a'):rep(10000), '.-.-.-.-b') end",
        "table.move({}, 1, 1e15, 2)",
        "while true do collectgarbage() end",
    ];
    for text in loops {
        endless(&format!("function sysCall_init() {text} end"));
        endless(&format!("function sysCall_thread() sim.setThreadAutomaticSwitch(false) {text} end"));
    }
}

#[test]
fn the_line_of_an_endless_loop_is_told() {
    let (reason, _) = stop("function sysCall_actuation()\n  while true do\n    x = 1\n  end\nend");
    assert!(reason.contains("a.lua:3, `x = 1`") || reason.contains("a.lua:2, `while true do`"), "{reason}");
}

#[test]
fn memory_has_an_end() {
    for text in [
        "local t = {} while true do t[#t + 1] = ('x'):rep(1000) .. #t end",
        "local s = 'x' while true do s = s .. s end",
    ] {
        let (reason, help) = stop(&format!("function sysCall_init() {text} end"));
        assert!(reason.contains("it took more than 64 MiB of memory"), "{reason}");
        assert!(help.contains("max_memory_mib"), "{help}");
    }
}

#[test]
fn no_script_has_a_finalizer() {
    let (reason, _) =
        stop("function sysCall_init()\n  setmetatable({}, { __gc = function() while true do end end })\nend");
    assert!(reason.contains("a.lua:2") && reason.contains("a metatable with `__gc` is not allowed"), "{reason}");
}

#[test]
fn a_value_that_is_in_a_table_many_times_has_an_end() {
    let code = "function sysCall_init()
        local t = { 1 }
        for k = 1, 40 do t = { t, t } end
        print(pcall(sim.setFloatSignal, 'x', t))
    end";
    let said = super::world::said(code);
    assert!(
        said[0].starts_with("false") && said[0].contains("values of more than 256 MiB cannot be passed on"),
        "{said:?}"
    );
}

#[test]
fn nothing_outside_can_be_reached() {
    let forbidden = [
        ("io.open('/etc/hostname')", "io.open is not allowed"),
        ("os.execute('true')", "os.execute is not allowed"),
        ("os.getenv('HOME')", "os.getenv is not allowed"),
        ("dofile('b.lua')", "dofile is not allowed"),
        ("loadfile('b.lua')", "loadfile is not allowed"),
        ("string.dump(function() end)", "string.dump is not allowed"),
        ("load('\\27Lua', 'x', 'b')", "bytecode is not allowed"),
        ("require 'simConvex'", "there is no module 'simConvex'"),
        ("require 'socket'", "there is no module 'socket'"),
        ("package.loadlib('x', 'y')", "package.loadlib is not allowed"),
        ("debug.getregistry()", "attempt to call a nil value (field 'getregistry')"),
    ];
    for (text, expected) in forbidden {
        let (reason, _) = stop(&format!("function sysCall_init()\n  {text}\nend"));
        assert!(reason.contains(expected) && reason.contains("a.lua:2"), "{text}: {reason}");
    }
}

#[test]
fn errors_say_script_line_text_and_cause() {
    let cases = [
        ("return a.b.c", "attempt to index a nil value (global 'a')"),
        ("sim.getJointPosition(77)", "there is no object with the handle 77 (in function 'sim.getJointPosition')"),
        ("sim.getObject('/hingo')", "Object does not exist: `/hingo`: did you mean `hinge`?"),
        ("sim.setJointTargetVelocity('x', 1)", "argument 1 is text, expected a handle"),
        ("sim.setFloatSignal('x', nil)", "argument 2 is nil (in function 'sim.setFloatSignal')"),
        ("sim.setFloatSignal('x', print)", "a function cannot be passed on (in function 'sim.setFloatSignal')"),
        ("sim.addForceAndTorque(sim.getObject('/hinge/arm'), {0/0, 0, 0}, {0, 0, 0})", "not finite"),
        ("sim.wait(1)", "only a thread can wait for the next step"),
        ("error({})", "an error that is a table, not a text"),
        ("simNothing()", "attempt to call a nil value (global 'simNothing')"),
        ("return {} ^ 3", "attempt to perform arithmetic on a table value"),
        ("for k in pairs({ [{}] = 1, [print] = 2 }) do end", "no order that is the same in every run"),
    ];
    for (text, expected) in cases {
        let (reason, _) = stop(&format!("function sysCall_actuation()\n  {text}\nend"));
        let place = "the script of `/hinge/arm` failed at ";
        let line = format!("a.lua:2, `{text}`: ");
        assert!(reason.starts_with(place) && reason.contains(&line) && reason.contains(expected), "{text}: {reason}");
    }
}

#[test]
fn what_was_recorded_before_a_fault_is_kept() {
    let code = "function sysCall_actuation() if sim.getSimulationTime() > 0.025 then error('enough') end end";
    let simulated = run(&with_script(code, "").unwrap());
    let Status::Stopped { tick, reason, .. } = &simulated.status else { panic!("{:?}", simulated.status) };
    assert_eq!((*tick, simulated.table.times().len()), (3, 4));
    assert!(reason.contains("a.lua:1") && reason.contains(": enough"), "{reason}");
    let sensing = code.replace("actuation", "sensing");
    let simulated = run(&with_script(&sensing, "").unwrap());
    // the world had made the step of that sensing
    assert_eq!(simulated.table.times().len(), 5);
}

#[test]
fn a_scene_with_bad_scripts_is_refused_as_a_whole() {
    let refused = |scripts: &str| {
        let scene = format!("{PENDULUM}\n{scripts}");
        let files = [
            ("scene.toml", scene.as_str()),
            ("experiment.toml", EXPERIMENT),
            ("a.lua", "x = = 3\n"),
            ("b.lua", "x = 3\n"),
        ];
        open(&files).unwrap_err().to_string()
    };
    let text = refused(
        "[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n[[script]]\nobject = \"/hing\"\nfile = \"b.lua\"\n\
         [[script]]\nobject = \"/hinge\"\nfile = \"c.lua\"\n",
    );
    assert!(text.contains("a.lua:1:1: error: script of `/hinge/arm`: unexpected symbol near '='"), "{text}");
    assert!(
        text.contains("there is no object `/hing` for the script") && text.contains("did you mean `/hinge`?"),
        "{text}"
    );
    assert!(text.contains("c.lua"), "{text}");
    let twice = "[[script]]\nobject = \"/hinge\"\nfile = \"b.lua\"\n".repeat(2);
    assert!(refused(&twice).contains("`/hinge` has two child scripts"));
    assert!(refused("[[script]]\nobject = \"/hinge\"\n").contains("file"));
    let inline = "[[script]]\nobject = \"/hinge\"\ncode = '''\nx = 1\nx = = 2\n'''\n";
    let scene = format!("{PENDULUM}\n{inline}");
    let line = 1 + scene.lines().position(|l| l == "x = = 2").unwrap();
    assert!(
        refused(inline).contains(&format!("scene.toml:{line}:1: error: script of `/hinge`")),
        "{}",
        refused(inline)
    );
}

#[test]
fn a_script_reads_the_files_that_its_scene_gives_it_and_no_other() {
    let code = "function sysCall_init()
        local file = assert(io.open('table.csv'))
        print(file:read(), file:read('n'), file:read(1), file:read('*n'), file:read('L') == '\\n', file:read('a') == '3,4\\nend', file:read('l'), file:read(0) == '')
        print(io.type(file), file:seek('set', 2), file:read(1), file:close(), io.type(file), pcall(file.read, file))
        local sum = 0
        for line in io.lines('table.csv') do for x in line:gmatch('%d+') do sum = sum + tonumber(x) end end
        print(sum)
        print(io.open('other.csv'))
        print(io.open('table.csv', 'w'))
        for _, f in ipairs { function() io.lines('/etc/hostname') end, function() io.popen('ls') end, function() file:read('x') end, function() io.write('x') end } do
            print((select(2, pcall(f))))
        end
    end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nfile = \"a.lua\"\nfiles = [\"table.csv\"]\n");
    let table = ("table.csv", "x,y\n1,2\n3,4\nend");
    let files = [("scene.toml", &scene[..]), ("experiment.toml", EXPERIMENT), ("a.lua", code), table];
    let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
    let said: Vec<String> = run.messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said[0], "x,y\t1\t,\t2\ttrue\ttrue\tnil\tfalse");
    assert!(said[1].starts_with("file\t2\ty\ttrue\tclosed file\tfalse\t"), "{said:?}");
    assert_eq!(said[2], "10");
    assert!(said[3].contains("not among the script's `files`") && said[4].contains("for reading only"), "{said:?}");
    for (text, reason) in said[5..].iter().zip([
        "not among the script's",
        "io.popen is not allowed",
        "the file is closed",
        "io.write is not allowed",
    ]) {
        assert!(text.contains(reason), "{text}");
    }
    let wrong = scene.replace("[\"table.csv\"]", "[\"tabel.csv\", \"/etc/hostname\"]");
    let files = [("scene.toml", &wrong[..]), ("experiment.toml", EXPERIMENT), ("a.lua", code), table];
    let problems = open(&files).unwrap_err().to_string();
    assert!(
        problems.contains("tabel.csv") && problems.contains("is absolute") && problems.contains("scene.toml:"),
        "{problems}"
    );
}

#[test]
fn what_a_script_writes_is_kept_with_the_run_and_nowhere_else() {
    let code = "function sysCall_init()
        file = io.open('C:/Users/somebody/Desktop/forces.csv', 'w')
        file:write('t', ',', 'force', '\\n')
        file:close()
    end
    function sysCall_sensing()
        local log = io.open('../out/forces.csv', 'a')
        assert(log:write(1.5, ',', 2, '\\n') == log and log:seek() > 8 and io.type(log) == 'file')
        log:close()
    end
    function sysCall_cleanup()
        local other = io.open('notes', 'w')
        print(io.open('forces.csv'):read('l'), pcall(other.write, other, {}))
        print(io.open('forces.csv', 'r+'))
        print(pcall(io.open, 'never.txt'))
        print(pcall(io.open, '.profile', 'w'))
        print(pcall(file.write, file, 'x'))
    end";
    let first = run(&with_script(code, "").unwrap());
    assert_eq!(first.status, Status::Completed, "{:?}", first.messages);
    let names: Vec<&str> = first.images.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["forces.csv", "notes.txt"]);
    let text = std::str::from_utf8(&first.images[0].bytes).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0] == "t,force" && lines.len() > 5 && lines[1..].iter().all(|line| *line == "1.5,2"), "{text}");
    let said: Vec<String> = first.messages.iter().map(|m| m.text.clone()).collect();
    for (text, reason) in said.iter().zip([
        "argument 1 is a table",
        "a file is opened to be read, written or written on",
        "io.open is not allowed",
        "no name of a file here",
        "the file is closed",
    ]) {
        assert!(text.contains(reason), "{reason}: {said:?}");
    }
    assert!(said[0].starts_with("t,force\tfalse"), "{said:?}");
    let again = run(&with_script(code, "").unwrap());
    assert_eq!(first.images, again.images);
}
