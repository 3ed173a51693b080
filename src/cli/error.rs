//! Everything that ends a command, in words.

use std::fmt;

/// What ends a command.
#[derive(Debug)]
pub struct Failure {
    /// Exit code of the program: 1 on an error, 2 on bad usage.
    pub code: u8,
    /// For the user. The library's errors already name the place and the remedy.
    message: String,
}

impl Failure {
    /// Something about the mesh, a file or the system.
    pub fn error(message: impl fmt::Display) -> Self {
        Self { code: 1, message: message.to_string() }
    }

    /// Arguments that would be wrong on any mesh.
    pub fn usage(message: impl fmt::Display) -> Self {
        Self { code: 2, message: message.to_string() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::error(error)
    }
}
