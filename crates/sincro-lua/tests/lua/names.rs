//! Every function of V-REP's script API that scripts use is there, or says why it is not.

use super::world::{EXPERIMENT, PENDULUM, open, run, said};

/// Names, without lines of comment.
fn names() -> Vec<String> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/third-party/data/v-rep-functions.txt");
    let text = std::fs::read_to_string(file).unwrap();
    text.lines().filter(|line| !line.starts_with('#')).flat_map(str::split_whitespace).map(str::to_owned).collect()
}

#[test]
fn every_function_of_the_api_is_offered_or_refused_with_a_reason() {
    let names = names();
    assert!(names.len() > 250, "{}", names.len());
    let list = names.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
    let code = format!(
        "function sysCall_init()
            for _, name in ipairs({{ {list} }}) do
                local old = 'sim' .. name:sub(1, 1):upper() .. name:sub(2)
                if type(sim[name]) ~= 'function' then print('missing ' .. name)
                elseif type(_G[old]) ~= 'function' then print('missing ' .. old) end
            end
        end"
    );
    assert_eq!(said(&code), Vec::<String>::new());
}

#[test]
fn names_of_copies_of_v_rep_3_are_found_as_there() {
    let scene = |object: &str, code: &str| {
        let frames = ["robot", "robot#0", "motor", "motor#0", "only#0"];
        let frames: String = frames.iter().map(|name| format!("[[frame]]\nname = \"{name}\"\n\n")).collect();
        let script = format!("[[script]]\nobject = \"/{object}\"\ncode = \"\"\"\n{code}\n\"\"\"\n");
        let files = format!("{frames}{PENDULUM}\n{script}");
        let loaded = open(&[("scene.toml", &files), ("experiment.toml", EXPERIMENT)]).unwrap();
        run(&loaded).messages.into_iter().map(|message| message.text).collect::<Vec<_>>()
    };
    let code = "function sysCall_init()
        for _, name in ipairs({ 'motor', 'motor#', 'motor#0', 'only', 'only#0' }) do
            local ok, own = pcall(sim.getObjectHandle, name)
            print(name, ok and sim.getObjectName(own))
        end
        print(sim.getNameSuffix(nil), sim.getObjectName(sim.getObject('/motor[1]')))
    end";
    // a name without `#` is the one with the suffix of the script's object
    let of_copy = ["motor\tmotor#0", "motor#\tmotor", "motor#0\tmotor#0", "only\tonly#0", "only#0\tonly#0"];
    assert_eq!(scene("robot#0", code)[..5], of_copy);
    let of_first = ["motor\tmotor", "motor#\tmotor", "motor#0\tmotor#0", "only\tfalse", "only#0\tonly#0"];
    assert_eq!(scene("robot", code)[..5], of_first);
    assert_eq!(scene("robot#0", code)[5], "0\tmotor#0");
    assert_eq!(scene("robot", code)[5], "-1\tmotor#0");
}

#[test]
fn what_is_refused_has_a_reason_of_its_own() {
    let refused = sincro_coppelia::api::functions::absent().collect::<Vec<_>>();
    for name in &refused {
        let why = sincro_coppelia::api::functions::why_absent(name).unwrap();
        assert!(why.len() > 25 && !why.ends_with('.'), "{name}: {why}");
        assert!(sincro_coppelia::api::functions::function(name).is_none(), "{name} is there and absent");
    }
    let named = names();
    let told: Vec<_> = named.iter().filter(|name| refused.contains(&name.as_str())).collect();
    // a ceiling: what is built is taken away from the list
    assert!(told.len() <= 66, "{told:?}");
}
