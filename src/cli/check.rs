//! `welt check`.

use super::args::Check;
use super::error::Failure;
use super::files;
use super::output::print;
use std::io::Write;
use std::process::ExitCode;
use welt::io::inspect;

pub fn run(arguments: &Check) -> Result<ExitCode, Failure> {
    let source = files::read(&arguments.input, &arguments.import)?;
    let inspection = inspect(&source);
    let text = if arguments.json { files::json(&inspection)? + "\n" } else { inspection.to_string() };
    print(|out| out.write_all(text.as_bytes()))?;
    Ok(if inspection.defects.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
