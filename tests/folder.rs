//! The program, run in a folder of a test.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A sheet of 3 x 2 unit squares, vertices 0 to 11 row by row, whose last square is cut into two triangles.
pub const SHEET: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\nv 3 2 0\n\
f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12\nf 7 12 11\n";

/// A folder of one test, empty at first.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("program").join(test);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("sheet.obj"), SHEET).unwrap();
        Self(path)
    }

    pub fn welt(&self, arguments: &[&str]) -> Run {
        self.welt_fed(arguments, "")
    }

    /// Runs with an output that nobody reads.
    pub fn welt_unread(&self, arguments: &[&str]) -> Run {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(env!("CARGO_BIN_EXE_welt"))
            .args(arguments)
            .current_dir(&self.0)
            .stdin(Stdio::null())
            .stdout(writer)
            .output()
            .unwrap();
        Run::from(output)
    }

    /// Runs by a program that runs another one.
    pub fn welt_by(&self, runner: &[&str], arguments: &[&str]) -> Run {
        let output = Command::new(runner[0])
            .args(&runner[1..])
            .arg(env!("CARGO_BIN_EXE_welt"))
            .args(arguments)
            .current_dir(&self.0)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        Run::from(output)
    }

    pub fn welt_fed(&self, arguments: &[&str], input: &str) -> Run {
        let mut child = Command::new(env!("CARGO_BIN_EXE_welt"))
            .args(arguments)
            .current_dir(&self.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // A program that does not read its input closes it.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        Run::from(child.wait_with_output().unwrap())
    }

    /// A groove with more arguments; the result would be `out.obj`.
    pub fn groove(&self, more: &[&str]) -> Run {
        let mut arguments = vec!["apply", "sheet.obj", "-o", "out.obj", "--feature", "groove"];
        arguments.extend(more);
        self.welt(&arguments)
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    /// Names of all files.
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// The exit code of a program that the system ended.
pub const ENDED: i32 = 128;

pub struct Run {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self {
            code: output.status.code().unwrap_or(ENDED),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }
}

impl Run {
    /// Ends with `code` and says all of `words` on standard error.
    #[track_caller]
    pub fn fails(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, code, "{}{}", self.out, self.err);
        for word in words {
            assert!(self.err.contains(word), "no '{word}' in: {}", self.err);
        }
        assert!(!self.err.contains("panicked"), "{}", self.err);
    }

    #[track_caller]
    pub fn succeeds(self) -> Self {
        assert_eq!(self.code, 0, "{}{}", self.out, self.err);
        self
    }
}
