//! `welt check`.

use super::args::Check;
use super::error::Failure;
use super::files;
use std::process::ExitCode;
use welt::io::inspect;

pub fn run(arguments: &Check) -> Result<ExitCode, Failure> {
    let source = files::read(&arguments.input, &arguments.import)?;
    let inspection = inspect(&source);
    if arguments.json {
        println!("{}", files::json(&inspection)?);
    } else {
        print!("{inspection}");
    }
    Ok(if inspection.defects.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
