//! The binary interface as it was recorded in `tests/data/abi.txt`: functions, layouts of structs, constants. What is
//! there may not change or go while `WELT_ABI_VERSION` stays; what is new must be recorded, with
//! `WELT_RECORD_ABI=1 cargo test --test all abi_snapshot`, and told in CHANGELOG.md.

use std::path::{Path, PathBuf};
use welt::ffi;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(path: &str) -> String {
    let path: &Path = &root().join(path);
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The header without comments, each run of blanks as one.
fn declarations(header: &str) -> Vec<String> {
    let mut code = String::new();
    let mut rest = header;
    while let Some((before, comment)) = rest.split_once("/*") {
        code += before;
        rest = comment.split_once("*/").expect("a comment ends").1;
    }
    code += rest;
    let mut found = Vec::new();
    let mut statement = String::new();
    let mut depth = 0;
    // The braces of extern "C" are about C++ only.
    for line in code.lines().map(str::trim).filter(|line| !["", "extern \"C\" {", "}"].contains(line)) {
        if line.starts_with('#') {
            if let Some(constant) = line.strip_prefix("#define WELT_") {
                found.push(format!("constant WELT_{constant}"));
            }
            continue;
        }
        depth += line.matches('{').count();
        depth -= line.matches('}').count().min(depth);
        statement = format!("{statement} {line}");
        if depth == 0 && line.ends_with(';') {
            found.push(std::mem::take(&mut statement));
        }
    }
    found
}

/// Size and alignment on the machines with 64 bits that the library is made for.
fn size_of_type(name: &str) -> usize {
    match name {
        "uint8_t" => 1,
        "uint32_t" | "int32_t" | "float" => 4,
        "uint64_t" | "size_t" | "double" => 8,
        pointer if pointer.ends_with('*') => 8,
        other => panic!("a member of the type {other}: teach this test its size"),
    }
}

/// A line per member with its offset, and one for the size.
fn layout(statement: &str) -> Vec<String> {
    let (head, body) = statement.split_once('{').expect("a struct");
    assert!(head.contains("struct"), "{head}");
    let (body, name) = body.rsplit_once('}').expect("a struct ends");
    let name = name.trim().trim_end_matches(';');
    let (mut offset, mut widest) = (0usize, 1);
    let mut lines = Vec::new();
    for member in body.split(';').map(str::trim).filter(|member| !member.is_empty()) {
        let (kind, member) = member.rsplit_once(' ').expect("type and name");
        let (kind, member) = match member.strip_prefix('*') {
            Some(member) => (format!("{kind}*"), member),
            None => (kind.to_owned(), member),
        };
        let (member, count) = match member.split_once('[') {
            Some((member, count)) => (member, count.trim_end_matches(']').parse().expect("a number")),
            None => (member, 1),
        };
        let size = size_of_type(&kind);
        offset = offset.next_multiple_of(size);
        lines.push(format!("member {name}.{member}: {kind} x {count} at {offset}"));
        offset += size * count;
        widest = widest.max(size);
    }
    lines.push(format!("size {name}: {}", offset.next_multiple_of(widest)));
    lines
}

/// The interface, one line per thing that a compiled program relies on.
fn interface() -> Vec<String> {
    let mut lines = Vec::new();
    for statement in declarations(&text("include/welt.h")) {
        let statement: String = statement.split_whitespace().collect::<Vec<_>>().join(" ");
        if statement.starts_with("constant") {
            // The version of the package changes with every release.
            if !statement.contains("WELT_VERSION")
                && !statement.contains("WELT_API")
                && !statement.ends_with("_H")
            {
                lines.push(statement);
            }
        } else if statement.contains('{') {
            if statement.contains("struct") {
                lines.extend(layout(&statement));
            }
        } else if let Some(function) = statement.strip_prefix("WELT_API ") {
            lines.push(format!("function {}", function.trim_end_matches(';')));
        } else if statement.contains("typedef") {
            lines.push(format!("handle {}", statement.trim_end_matches(';')));
        }
    }
    lines
}

/// The size of a struct that says its size first, so that it may grow: `size NAME: BYTES`.
fn growing<'a>(line: &'a str, lines: &[String]) -> Option<(&'a str, usize)> {
    let (name, size) = line.strip_prefix("size ")?.split_once(": ")?;
    let first = format!("member {name}.struct_size: uint32_t x 1 at 0");
    lines.contains(&first).then(|| (name, size.parse().expect("a size")))
}

/// True where a line says no more than that such a struct has grown at its end; its members stand in lines of their own.
fn has_grown(line: &str, now: &[String]) -> bool {
    growing(line, now).is_some_and(|(name, before)| {
        now.iter().filter_map(|line| growing(line, now)).any(|(other, size)| other == name && size > before)
    })
}

fn version(lines: &[String]) -> Option<&String> {
    lines.iter().find(|line| line.starts_with("constant WELT_ABI_VERSION"))
}

#[test]
fn nothing_changed_unannounced() {
    let now = interface();
    assert!(
        now.iter().filter(|line| line.starts_with("function")).count() > 60,
        "the header was not understood"
    );
    let path = root().join("tests/data/abi.txt");
    let recorded: Vec<String> =
        std::fs::read_to_string(&path).unwrap_or_default().lines().map(str::to_owned).collect();
    let gone: Vec<&String> =
        recorded.iter().filter(|line| !now.contains(line) && !has_grown(line, &now)).collect();
    assert!(
        gone.is_empty() || version(&recorded) != version(&now),
        "programs that were compiled before would break: {gone:#?}\nleave it as it was, or raise WELT_ABI_VERSION"
    );
    if std::env::var_os("WELT_RECORD_ABI").is_some() {
        std::fs::write(&path, now.join("\n") + "\n").expect("the record is written");
        return;
    }
    let new: Vec<&String> = now.iter().filter(|line| !recorded.contains(line)).collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "not recorded: {new:#?}\ntell it in CHANGELOG.md and record it: WELT_RECORD_ABI=1 cargo test --test all abi_snapshot"
    );
}

/// The layouts that the record states are those of the compiled library.
#[test]
fn structs_have_the_recorded_size() {
    let lines = interface();
    for (name, size) in [
        ("welt_import_options", size_of::<ffi::WeltImportOptions>()),
        ("welt_batch_options", size_of::<ffi::WeltBatchOptions>()),
        ("welt_feature_options", size_of::<ffi::WeltFeatureOptions>()),
        ("welt_surface_point", size_of::<ffi::WeltSurfacePoint>()),
        ("welt_patch_options", size_of::<ffi::WeltPatchOptions>()),
        ("welt_patch", size_of::<ffi::WeltPatch>()),
    ] {
        assert!(lines.contains(&format!("size {name}: {size}")), "{name} has {size} bytes");
    }
    let at = [
        ("welt_import_options.weld: double x 1", std::mem::offset_of!(ffi::WeltImportOptions, weld)),
        ("welt_surface_point.normal: double x 3", std::mem::offset_of!(ffi::WeltSurfacePoint, normal)),
        (
            "welt_batch_options.output_stride: size_t x 1",
            std::mem::offset_of!(ffi::WeltBatchOptions, output_stride),
        ),
    ];
    for (member, offset) in at {
        assert!(lines.contains(&format!("member {member} at {offset}")), "{member}");
    }
}
