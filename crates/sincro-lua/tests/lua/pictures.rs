//! Pictures that scripts save.

use sincro_sim::results::Status;

use super::world::{run, stop, with_script};

/// A call that saves four pixels under a name.
fn save(name: &str) -> String {
    format!("sim.saveImage(('abc'):rep(4), {{ 2, 2 }}, 0, '{name}', -1)")
}

#[test]
fn pictures_of_a_run_are_kept_with_it_under_plain_names() {
    let code = format!(
        "function sysCall_sensing()
            last = {} {} {}
            print(last)
        end",
        save("C:/Users/somebody/what I see.png"),
        save("folder/what I see.png"),
        save("photo.jpg") + " " + &save("small.BMP")
    );
    let simulated = run(&with_script(&code, "").unwrap());
    assert_eq!(simulated.status, Status::Completed, "{:?}", simulated.messages);
    let names: Vec<&str> = simulated.images.iter().map(|image| image.name.as_str()).collect();
    assert_eq!(names, ["photo.jpg.png", "small.bmp", "what I see.png"], "the last one of a name counts");
    assert!(simulated.images[0].bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
    let bitmap = &simulated.images[1].bytes;
    // two lines of two pixels, blue first, each line filled up to eight bytes
    assert_eq!((&bitmap[..2], bitmap.len()), (&b"BM"[..], 54 + 2 * 8));
    assert_eq!(&bitmap[54..62], b"cbacba\0\0");
    assert_eq!(u32::from_le_bytes(bitmap[2..6].try_into().unwrap()), 70);
    let said: Vec<&str> = simulated.messages.iter().map(|m| m.text.as_str()).collect();
    assert!(said[1].contains("`photo.jpg` is saved as `photo.jpg.png`"), "{said:?}");
}

#[test]
fn what_is_no_name_of_a_picture_is_refused() {
    for (name, why) in [
        ("picture", "has no extension"),
        ("picture.exe", "not written as `.exe`"),
        (".jpg", "not written as `.jpg`"),
        ("..png", "no name of a file here"),
        ("a$b.png", "no name of a file here"),
    ] {
        let (reason, _) = stop(&format!("function sysCall_sensing()\n  {}\nend", save(name)));
        assert!(reason.contains(why) && reason.contains("sim.saveImage"), "{name}: {reason}");
    }
}

#[test]
fn pictures_of_a_run_have_limits() {
    let code = "function sysCall_actuation()
            for k = 1, 1001 do sim.saveImage('abc', { 1, 1 }, 0, k .. '.png', -1) end
        end";
    assert!(stop(code).0.contains("1000 pictures and files of 64 MiB together"));
}
