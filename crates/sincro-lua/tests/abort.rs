//! A program that is being ended ends the scripts that are running. (A process of its own: nothing runs in it
//! afterwards.)

#[path = "lua/world.rs"]
#[allow(dead_code)]
mod world;

use sincro_sim::results::Status;
use world::{run, with_script};

#[test]
fn scripts_end_with_the_program() {
    let ending = std::thread::spawn(|| {
        // while the script is running, or before: both end it
        std::thread::sleep(std::time::Duration::from_millis(50));
        sincro_lua::abort_running_scripts();
    });
    let (reason, help) = stop_of("while true do pcall(function() while true do end end) end");
    ending.join().unwrap();
    assert!(reason.contains("the program is being ended"), "{reason}");
    assert_eq!(help, "");
    // what takes no thousand instructions, but does work that is charged for
    let (reason, _) = stop_of("while true do pcall(string.find, ('a'):rep(10000), '.-b') end");
    assert!(reason.contains("the program is being ended"), "{reason}");
    let (reason, _) = stop_of("collectgarbage()");
    assert!(reason.contains("the program is being ended"), "{reason}");
}

fn stop_of(text: &str) -> (String, String) {
    let keys = "max_instructions = 1000000000000";
    let loaded = with_script(&format!("function sysCall_init() {text} end"), keys)
        .unwrap_or_else(|problems| panic!("{problems}"));
    match run(&loaded).status {
        Status::Stopped { reason, help, .. } => (reason, help),
        other => panic!("{other:?}"),
    }
}
