//! `include/welt.h`: up to date, C89 and C++, and exactly the functions that the shared library exports.
//!
//! `WELT_UPDATE_HEADER=1 cargo test --test all header` writes the header anew.

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
        "deviation",
        "surface",
        "evaluate",
        "query",
        "patches",
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
        "include/welt.h is out of date: run WELT_UPDATE_HEADER=1 cargo test --test all header"
    );
}

#[test]
fn every_section_of_the_abi_is_in_the_header() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    let declared = functions_of(&header);
    for entry in std::fs::read_dir(root().join("src/ffi")).unwrap() {
        let path = entry.unwrap().path();
        if path.ends_with("fault.rs") {
            // Only in builds for tests.
            continue;
        }
        let source = std::fs::read_to_string(path).unwrap();
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

#[test]
fn every_function_is_reached_from_cpp() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    let bindings = std::fs::read_to_string(root().join("bindings/cpp/welt.hpp")).unwrap();
    let words: BTreeSet<&str> = bindings.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    for name in functions_of(&header) {
        assert!(words.contains(name), "{name} is not reached from bindings/cpp/welt.hpp");
    }
}

/// What was released once stays; what is new is added here.
#[test]
fn constants_keep_their_numbers() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    let is_version = |name: &str| name.contains("VERSION");
    let defined: BTreeSet<(&str, &str)> = header
        .lines()
        .filter_map(|line| line.strip_prefix("#define ")?.split_once(' '))
        .filter(|(name, _)| !is_version(name))
        .collect();
    let known = BTreeSet::from([
        ("WELT_OK", "0"),
        ("WELT_ERROR_ARGUMENT", "-1"),
        ("WELT_ERROR_MESH", "-2"),
        ("WELT_ERROR_CANCELLED", "-3"),
        ("WELT_ERROR_TOO_LARGE", "-4"),
        ("WELT_ERROR_BUFFER", "-5"),
        ("WELT_ERROR_POISONED", "-6"),
        ("WELT_ERROR_INTERNAL", "-7"),
        ("WELT_ERROR_FILE", "-8"),
        ("WELT_ERROR_SYNTAX", "-9"),
        ("WELT_ERROR_RULE", "-10"),
        ("WELT_ERROR_MEMORY", "-11"),
        ("WELT_PLACE_WHOLE", "0"),
        ("WELT_PLACE_VERTEX", "1"),
        ("WELT_PLACE_EDGE", "2"),
        ("WELT_PLACE_FACE", "3"),
        ("WELT_NONE", "4294967295"),
        ("WELT_BOUNDARY_NONE", "0"),
        ("WELT_BOUNDARY_EDGE_ONLY", "1"),
        ("WELT_BOUNDARY_EDGE_AND_CORNER", "2"),
        ("WELT_CREASING_UNIFORM", "0"),
        ("WELT_CREASING_CHAIKIN", "1"),
        ("WELT_FORMAT_OBJ", "0"),
        ("WELT_FORMAT_PLY", "1"),
        ("WELT_PARENT_VERTEX", "0"),
        ("WELT_PARENT_EDGE", "1"),
        ("WELT_PARENT_FACE", "2"),
        ("WELT_FIT_NONE", "0"),
        ("WELT_FIT_LOOP", "1"),
        ("WELT_FIT_SOLVE", "2"),
        ("WELT_FIT_SURFACE", "3"),
        ("WELT_FIT_SURFACE_SLIDE", "4"),
        ("WELT_PARITY_AUTO", "0"),
        ("WELT_PARITY_ALL_QUAD", "1"),
        ("WELT_PARITY_LOCAL", "2"),
    ]);
    assert_eq!(defined, known);
}

/// The lines of structs of options that a header defines each have a function that sets them, which is tried.
#[test]
fn every_struct_of_options_is_set_and_tried() {
    let header = std::fs::read_to_string(header_path()).unwrap();
    let tried = std::fs::read_to_string(root().join("tests/cpp/arguments.c")).unwrap();
    let structs: Vec<&str> =
        header.lines().filter_map(|line| line.strip_prefix("} ")?.strip_suffix("_options;")).collect();
    assert!(structs.len() >= 2);
    for name in structs {
        let init = format!("{name}_options_init");
        assert!(functions_of(&header).contains(init.as_str()), "{init} is absent");
        assert!(tried.contains(&format!("sizes(\"{init}\"")), "tests/cpp/arguments.c does not try {init}");
    }
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
