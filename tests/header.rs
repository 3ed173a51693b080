//! `include/welt.h`: up to date, C89 and C++, and exactly the functions that the shared library exports.
//!
//! `WELT_UPDATE_HEADER=1 cargo test --test header` writes the header anew.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header_path() -> PathBuf {
    root().join("include/welt.h")
}

/// Collects what cbindgen warns of.
struct Warnings(Mutex<Vec<String>>);

static WARNINGS: Warnings = Warnings(Mutex::new(Vec::new()));

impl log::Log for Warnings {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            self.0.lock().unwrap().push(record.args().to_string());
        }
    }

    fn flush(&self) {}
}

#[test]
fn header_is_up_to_date() {
    log::set_logger(&WARNINGS).unwrap();
    log::set_max_level(log::LevelFilter::Warn);
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    // The sections of the header, in the order in which a reader needs them.
    for section in [
        "version",
        "status",
        "error",
        "job",
        "report",
        "mesh",
        "scheme",
        "file",
        "limit",
        "refinement",
        "loop_surface",
        "selection",
        "rules",
        "feature",
        "surface",
        "evaluate",
        "query",
    ] {
        builder = builder.with_src(root().join("src/ffi").join(section).with_extension("rs"));
    }
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    let generated = String::from_utf8(text).unwrap();
    let warnings = WARNINGS.0.lock().unwrap();
    assert!(warnings.is_empty(), "cbindgen warns: {warnings:#?}");
    if std::env::var_os("WELT_UPDATE_HEADER").is_some() {
        std::fs::write(header_path(), &generated).unwrap();
    }
    let committed = std::fs::read_to_string(header_path()).unwrap();
    assert!(
        committed == generated,
        "include/welt.h is out of date: run WELT_UPDATE_HEADER=1 cargo test --test header"
    );
}

#[test]
fn every_section_of_the_abi_is_in_the_header() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    let declared = functions_of(&header);
    for entry in std::fs::read_dir(root().join("src/ffi")).unwrap() {
        let source = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        for line in
            source.lines().filter(|line| line.starts_with("pub ") && line.contains("extern \"C\" fn "))
        {
            let name = line.split("fn ").nth(1).unwrap().split('(').next().unwrap();
            assert!(declared.contains(name), "{name} is not declared in include/welt.h");
        }
    }
}

#[test]
fn every_function_says_since_when_it_exists() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    for part in header.split("/*") {
        let (comment, code) = part.split_once("*/").unwrap_or_default();
        let function = code.lines().any(|line| line.starts_with("WELT_API"));
        assert!(!function || comment.contains("Since: "), "no Since in the comment of {code}");
    }
}

#[test]
fn header_is_c89_and_cpp() {
    let twice = "#include <welt.h>\n#include <welt.h>\nint main(void) { return (int)(welt_version() - WELT_VERSION); }\n";
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let compile = |compiler: &str, arguments: &[&str], file: &str| {
        let source = folder.join(file);
        std::fs::write(&source, twice).unwrap();
        let output = Command::new(compiler)
            .args(arguments)
            .args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"])
            .arg(root().join("include"))
            .arg(&source)
            .output();
        check(compiler, output);
    };
    compile("gcc", &["-std=c89"], "header.c");
    compile("g++", &["-std=c++98"], "header.cpp");
}

#[test]
#[cfg(target_os = "linux")]
fn exported_symbols_are_those_of_the_header() {
    let library = shared_library();
    let symbols = check("nm", Command::new("nm").args(["-D", "--defined-only"]).arg(&library).output());
    let exported: BTreeSet<&str> =
        symbols.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    let header = std::fs::read_to_string(header_path()).unwrap();
    assert_eq!(exported, functions_of(&header));
}

#[test]
#[cfg(target_os = "linux")]
fn soname_carries_the_abi_version() {
    let text = check("readelf", Command::new("readelf").arg("-d").arg(shared_library()).output());
    let soname = format!("[libwelt.so.{}]", welt::ffi::WELT_ABI_VERSION);
    assert!(text.lines().any(|line| line.contains("SONAME") && line.contains(&soname)), "{text}");
}

/// Names of the functions a header declares.
fn functions_of(header: &str) -> BTreeSet<&str> {
    let code = header.split("*/").filter_map(|part| part.split("/*").next());
    code.flat_map(|code| code.match_indices('(').map(move |(open, _)| &code[..open]))
        .filter_map(|before| before.rsplit([' ', '*', '\n']).next())
        .filter(|name| name.starts_with("welt_"))
        .collect()
}

/// The shared library that Cargo built beside this test.
#[cfg(target_os = "linux")]
fn shared_library() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let library = test.parent().unwrap().join("libwelt.so");
    assert!(library.exists(), "{} is absent: cargo build", library.display());
    library
}

/// The standard output of a tool that must succeed.
fn check(tool: &str, output: std::io::Result<Output>) -> String {
    let output = output.unwrap_or_else(|error| panic!("{tool} cannot be run ({error}); install it"));
    assert!(output.status.success(), "{tool}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
