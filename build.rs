//! Gives the shared library its SONAME.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let system = std::env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    if matches!(system.as_str(), "linux" | "freebsd" | "netbsd" | "openbsd" | "android") {
        // The number is WELT_ABI_VERSION of src/ffi/version.rs; tests/header.rs compares them.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libwelt.so.0");
    }
}
