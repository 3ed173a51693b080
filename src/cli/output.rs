//! Standard output and standard error. A reader that closes its end early is no error.

use super::error::Failure;
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, StdoutLock, Write};

/// Writes to standard output. What a closed pipe no longer takes is dropped, and the command goes on.
pub fn print(
    write: impl FnOnce(&mut BufWriter<StdoutLock<'static>>) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::error(format_args!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a message and a line end to standard error, if that can be written to: there is no other place for it.
pub fn tell(message: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}
