//! The program writes the same bytes on 1 and 2 threads, run after run. The C ABI: `tests/cpp/same_bytes.cpp`, with a library that
//! the compiler optimised and one that it did not.

use crate::folder::Folder;
use std::fs;
use std::path::Path;

/// What a command writes: standard output and its files.
fn written(folder: &Folder, arguments: &[&str], files: &[&str]) -> Vec<Vec<u8>> {
    let run = folder.welt(arguments).succeeds();
    let mut all = vec![without_times(run.out)];
    for name in files {
        let content = fs::read(folder.0.join(name)).unwrap();
        fs::remove_file(folder.0.join(name)).unwrap();
        all.push(match String::from_utf8(content) {
            Ok(text) => without_times(text),
            Err(binary) => binary.into_bytes(),
        });
    }
    all
}

/// Reports say last how long each stage took.
fn without_times(mut text: String) -> Vec<u8> {
    for start in ["\"times\"", "time"] {
        if let Some(at) = text.find(start) {
            text.truncate(at);
        }
    }
    text.into_bytes()
}

#[test]
fn the_program_writes_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new("same_bytes");
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/models/leaf_chair.obj");
    let chair = model.to_str().unwrap();
    let apply = [
        "apply",
        chair,
        "--feature",
        "groove",
        "--mark",
        "ring:3,331",
        "--set",
        "width=1.6",
        "--set",
        "depth=0.6",
    ];
    let everything =
        ["-o", "out.obj", "--report", "out.json", "--figure", "out.png", "--trace", "out.trace", "--json"];
    let files = ["out.obj", "out.json", "out.png", "out.trace"];
    folder.welt(&[&apply[..], &["--no-deviation", "-o", "groove.ply"]].concat()).succeeds();
    let sheet = ["apply", "sheet.obj", "--feature", "ridge", "--set", "width=0.3"];
    let commands: [(Vec<&str>, &[&str]); 8] = [
        ([&apply[..], &everything[..]].concat(), &files),
        ([&sheet[..], &["--mark", "ring:1,2"], &everything[..]].concat(), &files),
        (
            [
                &sheet[..],
                &["--mark", "polyline:0.3,0.4,0;2.1,0.7,0;2.6,1.5,0", "--optimise", "fit+slide"],
                &everything[..],
            ]
            .concat(),
            &files,
        ),
        (vec!["deviation", chair, "groove.ply", "--samples", "2"], &[]),
        (
            vec!["limit", chair, "-o", "out.ply", "--level", "1", "--zebra", "out.png"],
            &["out.ply", "out.png"],
        ),
        (vec!["quality", chair, "--json"], &[]),
        (vec!["patches", "sheet.obj", "-o", "out.json"], &["out.json"]),
        (vec!["check", chair], &[]),
    ];
    for (arguments, files) in commands {
        let expected = written(&folder, &arguments, files);
        assert!(expected.iter().map(Vec::len).sum::<usize>() > 200, "{arguments:?}");
        let threaded = ["apply", "deviation"].contains(&arguments[0]);
        for more in if threaded { vec![vec!["--threads", "2"], vec!["--threads", "0"]] } else { vec![vec![]] }
        {
            let again = written(&folder, &[&arguments[..], &more].concat(), files);
            assert!(again == expected, "{arguments:?} {more:?}: other bytes");
        }
    }
}
