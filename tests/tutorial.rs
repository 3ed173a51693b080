//! Everything in docs/rules-tutorial.md is executed: files are written, cases pass, commands print what the page says.

use std::path::{Path, PathBuf};
use std::process::Command;
use welt::grammar::Case;

/// A fenced block: what stands behind the fence, and its lines.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(info), None) => open = Some((info.to_owned(), String::new())),
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, Some((_, body))) => {
                body.push_str(line);
                body.push('\n');
            }
            (None, None) => {}
        }
    }
    found
}

/// Runs the commands of a block in `folder` and compares what they print, `...` standing for anything.
fn console(folder: &Path, body: &str) {
    for part in body.split("$ welt ").skip(1) {
        let (command, expected) = part.split_once('\n').expect("a command is a line");
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let output = Command::new(env!("CARGO_BIN_EXE_welt"))
            .args(&arguments)
            .current_dir(folder)
            .output()
            .expect("the program starts");
        let found =
            [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text")).concat();
        if expected == "...\n" {
            assert!(output.status.success(), "{command}\n{found}");
        } else {
            assert_eq!(found, expected, "{command}");
        }
    }
}

#[test]
fn the_tutorial_does_what_it_says() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("docs/rules-tutorial.md")).expect("the tutorial is there");
    let folder = std::env::temp_dir().join(format!("welt-tutorial-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut cases = 0;
    for (info, body) in blocks(&text) {
        match info.split_once(' ') {
            Some((kind, name)) => {
                let path = folder.join(name);
                std::fs::write(&path, &body).expect("a file");
                if kind == "case" {
                    Case::load(&path)
                        .and_then(|case| case.check())
                        .unwrap_or_else(|error| panic!("{name}: {error}"));
                    cases += 1;
                }
            }
            None if info == "console" => console(&folder, &body),
            None => panic!("a block says what it is: {info}"),
        }
    }
    assert!(cases >= 4, "{cases} cases");
    // A trace played again gives the same file; a trace that does not fit stops, and nothing is written.
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a file");
    assert_eq!(read("out.obj"), read("again.obj"));
    let trace = read("out.trace");
    assert!(trace.lines().count() >= 5, "{trace}");
    assert!(trace.contains(r#""rule":"Panel","at":{"e":"edge 0 -> 1","f":"face 0"}"#), "{trace}");
    for (from, to, problem) in [
        (
            r#""rule":"Panel""#,
            r#""rule":"Rim""#,
            "the rule does not match there at step 1, rule Rim at e = edge 0 -> 1, f = face 0",
        ),
        (r#""rule":"Panel""#, r#""rule":"Frame""#, "there is no such rule at step 1"),
        (r#""after":""#, r#""after":"0"#, "the mesh after the last step is another one"),
        (r#""before":""#, r#""before":"0"#, "the mesh is not the one the trace was made on"),
        (r#"{"pass":1,"step":1"#, r#"{"step":1"#, "this is no line of a trace"),
    ] {
        std::fs::write(folder.join("bad.trace"), trace.replacen(from, to, 1)).expect("a file");
        let output = Command::new(env!("CARGO_BIN_EXE_welt"))
            .args("apply square.obj -o bad.obj --rules frame.rules --mark edge:0,1#panel --optimise none --replay bad.trace".split(' '))
            .current_dir(&folder)
            .output()
            .expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(problem), "{problem}\n{message}");
        assert!(!folder.join("bad.obj").exists());
    }
    std::fs::remove_dir_all(&folder).expect("the folder was made above");
}
