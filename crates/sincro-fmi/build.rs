//! Link arguments: the library goes into every FMU, without the symbols that debuggers need.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let unix_with_gnu_linker = std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux");
    if unix_with_gnu_linker {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--strip-all");
    }
}
