//! Writing that fails: a full disk, a folder that takes no files, a program that is killed. The file that was there stays whole.

use crate::folder::{ENDED, Folder, Run};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const GROOVE: [&str; 6] = ["apply", "sheet.obj", "--feature", "groove", "--mark", "ring:1,2"];
const SIZES: [&str; 4] = ["--set", "width=0.2", "--set", "depth=0.05"];

/// Everything that the program writes: what it is, the arguments, the file. Meshes of level 5 are larger than a buffer.
fn outputs() -> Vec<(&'static str, Vec<&'static str>, &'static str)> {
    let groove = |more: &[&'static str]| [&GROOVE, &SIZES[..], &["--no-deviation"], more].concat();
    vec![
        ("a mesh, OBJ", vec!["limit", "sheet.obj", "--level", "5", "-o", "out.obj"], "out.obj"),
        ("a mesh with normals, PLY", vec!["limit", "sheet.obj", "--level", "5", "-o", "out.ply"], "out.ply"),
        ("a control mesh, OBJ", groove(&["-o", "out.obj"]), "out.obj"),
        ("a control mesh, PLY", groove(&["-o", "out.ply"]), "out.ply"),
        ("a report", groove(&["-o", "-", "--report", "out.json"]), "out.json"),
        ("a trace", groove(&["-o", "-", "--trace", "out.trace"]), "out.trace"),
        ("a figure", groove(&["-o", "-", "--figure", "out.png"]), "out.png"),
        ("reflection lines", vec!["limit", "sheet.obj", "-o", "-", "--zebra", "out.png"], "out.png"),
        ("patches", vec!["patches", "sheet.obj", "-o", "out.json"], "out.json"),
        ("drawings of rules", vec!["rules", "draw", "drawn.rules", "-o", "."], "Split.svg"),
    ]
}

/// A folder with what the arguments name.
fn folder(test: &str) -> Folder {
    let folder = Folder::new(test);
    let rule = "rule Split { e(color) }\naction { usereg e dup vertexCW e vertexpos makeEV !h e \"color\" attrdel }\n";
    fs::write(folder.0.join("drawn.rules"), rule).unwrap();
    folder
}

/// Runs with no more than so many bytes for a file, as on a disk that is full then: the system says that the file is too large
/// where it would say that no space is left.
fn with_space(folder: &Folder, bytes: usize, arguments: &[&str]) -> Run {
    let limit = format!("--fsize={bytes}:{bytes}");
    // Else the system would end the program.
    let ignoring = ["sh", "-c", "trap '' XFSZ; exec \"$@\"", "sh"];
    folder.welt_by(&[&["prlimit", &limit], &ignoring[..]].concat(), arguments)
}

const REMEDY: &str = "check the permissions and the space on the disk";

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_leaves_the_file_that_was_there() {
    let folder = folder("full");
    for (what, arguments, name) in outputs() {
        let path = folder.0.join(name);
        folder.welt(&arguments).succeeds();
        let whole = fs::read(&path).unwrap();
        let files = folder.files();
        // The times in a report may come out shorter.
        let almost = whole.len() - if what == "a report" { 100 } else { 1 };
        for bytes in [0, 1, whole.len() / 2, almost] {
            for before in [Some("precious"), None] {
                match before {
                    Some(text) => fs::write(&path, text).unwrap(),
                    None => fs::remove_file(&path).unwrap(),
                }
                let run = with_space(&folder, bytes, &arguments);
                run.fails(1, &[name, "cannot be written", REMEDY]);
                let after = fs::read(&path).ok();
                assert_eq!(after.as_deref(), before.map(str::as_bytes), "{what}, {bytes} bytes");
                let expected: Vec<_> =
                    files.iter().filter(|file| *file != name || before.is_some()).cloned().collect();
                assert_eq!(folder.files(), expected, "{what}, {bytes} bytes: nothing lies beside it");
            }
        }
        with_space(&folder, whole.len() + 100, &arguments).succeeds();
        assert!(fs::read(&path).unwrap().len().abs_diff(whole.len()) < 100, "{what}: written where it fits");
        fs::remove_file(&path).unwrap();
    }
}

/// `/dev/full` takes nothing: as a file that a link leads to, and as standard output.
#[test]
#[cfg(target_os = "linux")]
fn a_full_device_is_told() {
    let folder = folder("device");
    for (what, arguments, name) in outputs() {
        std::os::unix::fs::symlink("/dev/full", folder.0.join(name)).unwrap();
        let run = folder.welt(&arguments);
        run.fails(1, &[name, "No space left on device", REMEDY]);
        let link = fs::symlink_metadata(folder.0.join(name)).unwrap();
        assert!(link.is_symlink(), "{what}: the link stays");
        fs::remove_file(folder.0.join(name)).unwrap();
    }
    let told = [
        vec!["check", "sheet.obj"],
        vec!["check", "sheet.obj", "--json"],
        [&GROOVE, &SIZES[..], &["-o", "-"]].concat(),
        [&GROOVE, &SIZES[..], &["-o", "out.obj", "--json"]].concat(),
        vec!["limit", "sheet.obj", "-o", "-"],
        vec!["patches", "sheet.obj", "-o", "-"],
        vec!["deviation", "sheet.obj", "sheet.obj"],
        vec!["quality", "sheet.obj"],
        vec!["rules", "list"],
    ];
    for arguments in told {
        let run = folder.welt_by(&["sh", "-c", "exec \"$@\" >/dev/full", "sh"], &arguments);
        run.fails(1, &["standard output", "No space left on device"]);
    }
}

/// For root no folder is read-only: there the program runs as nobody.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_takes_no_files_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder("readonly");
    // Works for everybody: a file where a folder should be, a folder that the system keeps.
    let limit = |output| folder.welt(&["limit", "sheet.obj", "-o", output]);
    limit("sheet.obj/out.obj").fails(1, &["sheet.obj/out.obj", "create it first"]);
    limit("/proc/out.obj").fails(1, &["/proc/out.obj", "cannot be written", REMEDY]);

    let is_root = Command::new("id").arg("-u").output().is_ok_and(|run| run.stdout == b"0\n");
    let nobody: &[&str] =
        if is_root { &["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] } else { &[] };
    if is_root && folder.welt_by(nobody, &["check", "sheet.obj"]).code != 0 {
        println!("skipped: read-only folders; nobody may not run the program here");
        return;
    }
    let permit = |mode| fs::set_permissions(&folder.0, fs::Permissions::from_mode(mode)).unwrap();
    for (what, arguments, name) in outputs() {
        let path = folder.0.join(name);
        for before in [Some("precious"), None] {
            before.iter().for_each(|text| fs::write(&path, text).unwrap());
            permit(0o555);
            let run = folder.welt_by(nobody, &arguments);
            permit(0o755);
            run.fails(1, &[name, "Permission denied", REMEDY]);
            assert_eq!(fs::read(&path).ok().as_deref(), before.map(str::as_bytes), "{what}");
            let _ = fs::remove_file(&path);
            assert_eq!(folder.files(), ["drawn.rules", "sheet.obj"], "{what}");
        }
    }
}

/// What a killed program may leave beside the file: `out.obj.PID-NUMBER.tmp`.
fn is_leftover(name: &str) -> bool {
    let middle = name.strip_prefix("out.obj.").and_then(|rest| rest.strip_suffix(".tmp"));
    let parts = middle.and_then(|middle| middle.split_once('-'));
    parts.is_some_and(|(pid, attempt)| pid.parse::<u32>().is_ok() && attempt.parse::<u32>().is_ok())
}

/// The content of the file, after a look at what else lies there; leftovers are counted and removed.
fn look(folder: &Folder, leftovers: &mut usize) -> Vec<u8> {
    for name in folder.files() {
        if is_leftover(&name) {
            *leftovers += 1;
            fs::remove_file(folder.0.join(name)).unwrap();
        } else {
            assert!(["sheet.obj", "out.obj"].contains(&&name[..]), "{name}");
        }
    }
    fs::read(folder.0.join("out.obj")).unwrap()
}

/// Killed at a moment after its start, and as soon as it has begun to write and a moment later; by Ctrl-C, too.
#[test]
#[cfg(unix)]
fn a_killed_program_leaves_the_old_file_or_the_new_one() {
    let folder = Folder::new("killed");
    let arguments = ["limit", "sheet.obj", "--level", "6", "-o", "out.obj"];
    let start = std::time::Instant::now();
    folder.welt(&arguments).succeeds();
    let whole = start.elapsed();
    let path = folder.0.join("out.obj");
    let (old, new) = (b"precious".to_vec(), fs::read(&path).unwrap());
    let (mut leftovers, mut kept, mut written) = (0, 0, 0);
    for moment in 0..60u32 {
        fs::write(&path, &old).unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_welt"))
            .args(arguments)
            .current_dir(&folder.0)
            .stdin(Stdio::null())
            .spawn()
            .unwrap();
        if moment < 20 {
            std::thread::sleep(whole * moment / 18);
        } else {
            while folder.files().len() < 3 && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_micros(200));
            }
            std::thread::sleep(Duration::from_micros(u64::from(moment % 20) * 500));
        }
        if moment < 50 {
            child.kill().unwrap();
        } else {
            let _ = Command::new("sh").arg("-c").arg(format!("kill -INT {} 2>&1", child.id())).output();
        }
        child.wait().unwrap();
        let content = look(&folder, &mut leftovers);
        assert!(content == old || content == new, "moment {moment}: a part of a file");
        if content == old { kept += 1 } else { written += 1 }
    }
    println!(
        "killed 60 times: {kept} times the old file, {written} times the new one, {leftovers} leftovers"
    );
    assert!(kept > 0 && leftovers > 0, "it was killed while it wrote");
    // Leftovers are in nobody's way.
    fs::write(folder.0.join("out.obj.1-0.tmp"), "part").unwrap();
    folder.welt(&arguments).succeeds();
    assert_eq!(look(&folder, &mut leftovers), new);
}

/// One limit of the system for all of a program's memory; small lists still end it (docs/trust.md). A file that is there at the
/// end is whole.
#[test]
#[cfg(target_os = "linux")]
fn no_memory_leaves_the_file_that_was_there() {
    let folder = Folder::new("memory");
    let arguments = ["limit", "sheet.obj", "--level", "6", "-o", "out.obj"];
    folder.welt(&arguments).succeeds();
    let path: &Path = &folder.0.join("out.obj");
    let new = fs::read(path).unwrap();
    let (mut told, mut ended, mut done) = (0, 0, 0);
    for megabytes in (4..64).step_by(3).chain([80, 400]) {
        fs::write(path, "precious").unwrap();
        let limit = format!("--as={}", megabytes << 20);
        let run = folder.welt_by(&["prlimit", &limit], &arguments);
        let content = fs::read(path).unwrap();
        match run.code {
            0 => {
                done += 1;
                assert!(content == new, "{megabytes} MiB: a whole file");
            }
            1 => {
                told += 1;
                run.fails(1, &["no memory for a list of ", "ask for less, or free memory"]);
                assert_eq!(content, b"precious");
            }
            // The runtime of the program, or before its first line the system.
            code => {
                ended += 1;
                assert!(code == ENDED || run.err.contains("loading shared libraries"), "{code}: {}", run.err);
                assert_eq!(content, b"precious", "{megabytes} MiB: {}", run.err);
            }
        }
        assert!(folder.files().iter().all(|name| !name.ends_with(".tmp") || run.code > 1));
    }
    println!(
        "{done} runs done, {told} told that there is no memory, {ended} ended by the system or the runtime"
    );
    assert!(done > 0 && told > 0);
}
