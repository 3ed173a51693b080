//! Every statement of `docs/abi.md`, and every promise of `docs/trust.md`, names tests, and these exist.

use std::path::Path;

/// The (file, names) that a text refers to as "`file`: `name`, `name`".
fn references(text: &str) -> Vec<(&str, Vec<&str>)> {
    let parts: Vec<&str> = text.split('`').collect();
    let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
    // Odd parts stand between backquotes, each followed by what comes after it.
    for pair in parts.get(1..).unwrap_or_default().chunks_exact(2) {
        let (quoted, after) = (pair[0], pair[1]);
        let is_file = ["tests/", "src/", "bindings/"].iter().any(|start| quoted.starts_with(start))
            && after.starts_with(':');
        if is_file {
            found.push((quoted, Vec::new()));
        } else if let Some((_, names)) = found.last_mut() {
            names.push(quoted);
        }
    }
    found
}

/// Whether the source of a file has a test of this name that is run.
fn has_test(file: &str, source: &str, name: &str) -> bool {
    let squeezed = source.split_whitespace().collect::<Vec<_>>().join(" ");
    match file.rsplit('.').next() {
        Some("rs") => squeezed
            .split("#[test]")
            .skip(1)
            .any(|test| test.split('{').next().unwrap_or_default().contains(&format!("fn {name}("))),
        Some("txt") => {
            // Some names are made in a loop: foreach(name abi arguments) ... welt_c_test(${name}_valgrind.
            let direct = squeezed.contains(&format!("welt_c_test({name} "));
            let made = name.rsplit_once('_').is_some_and(|(stem, kind)| {
                squeezed.contains(&format!("welt_c_test(${{name}}_{kind} "))
                    && squeezed.split("foreach(name ").skip(1).any(|list| {
                        list.split(')').next().unwrap_or_default().split(' ').any(|entry| entry == stem)
                    })
            });
            direct || made
        }
        Some("py") => squeezed.contains(&format!("def {name}(")),
        _ => {
            let defined = squeezed.contains(&format!("void {name}("));
            defined && squeezed.matches(&format!("{name}(")).count() > 1
        }
    }
}

/// The statements of a page, up to `end`, after checking that the tests which they name exist.
fn statements(page: &str, end: Option<&str>) -> Vec<(String, bool)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join(page)).unwrap();
    let page = end.and_then(|end| Some(page.split_once(end)?.0)).unwrap_or(&page);
    let statements = page.split("\n- ").skip(1).map(|part| part.split("\n\n").next().unwrap_or_default());
    let mut checked = Vec::new();
    for statement in statements {
        let references = references(statement);
        checked.push((statement.to_owned(), references.iter().any(|(_, names)| !names.is_empty())));
        for (file, names) in references {
            let source = std::fs::read_to_string(root.join(file)).unwrap_or_else(|_| panic!("no {file}"));
            for name in names {
                assert!(has_test(file, &source, name), "{file} has no test {name}: {statement}");
            }
        }
    }
    checked
}

#[track_caller]
fn all_are_held(statements: Vec<(String, bool)>, at_least: usize) {
    assert!(statements.len() >= at_least, "the page is read: {} statements", statements.len());
    for (statement, held) in statements {
        assert!(held, "no test holds this: {statement}");
    }
}

#[test]
fn every_statement_names_tests_that_exist() {
    all_are_held(statements("docs/abi.md", None), 26);
}

/// What is not promised needs no test.
#[test]
fn every_promise_names_tests_that_exist() {
    all_are_held(statements("docs/trust.md", Some("\n## Not promised\n")), 20);
}
