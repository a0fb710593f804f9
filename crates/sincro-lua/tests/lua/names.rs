//! Every function of V-REP's script API that scripts use is there, or says why it is not.

use super::world::said;

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
