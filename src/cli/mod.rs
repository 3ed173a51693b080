//! The program: arguments in, one library call, result out. Exit code 0 on success, 1 on an error or a defect, 2 on
//! bad usage.

mod apply;
mod args;
mod batch;
mod check;
mod demo;
mod deviation;
mod error;
mod figure;
mod files;
mod limit;
mod limits;
mod output;
mod patches;
mod progress;
mod quality;
mod rules;
mod scenes;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

/// Parses the arguments and runs the command.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::Check(check) => check::run(check),
        Command::Apply(apply) => apply::run(apply),
        Command::Limit(limit) => limit::run(limit),
        Command::Deviation(deviation) => deviation::run(deviation),
        Command::Patches(patches) => patches::run(patches),
        Command::Quality(quality) => quality::run(quality),
        Command::Rules(rules) => rules::run(rules),
        Command::Demo(demo) => demo::run(demo),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            output::tell(format_args!("welt: {error}"));
            ExitCode::from(error.code)
        }
    }
}
