//! `welt rules`.

use super::args::{Rules, RulesAction};
use super::error::Failure;
use super::files;
use super::output::{print, tell};
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use welt::feature::PROFILES;
use welt::grammar::{Case, Parameter, RuleSet};

pub fn run(arguments: &Rules) -> Result<ExitCode, Failure> {
    match &arguments.action {
        RulesAction::Check { files } => check(files),
        RulesAction::Test { files } => test(files),
        RulesAction::List { file, json } => list(file.as_deref(), *json),
    }
}

fn check(files: &[PathBuf]) -> Result<ExitCode, Failure> {
    let mut code = ExitCode::SUCCESS;
    for path in files {
        match RuleSet::load(path) {
            Ok(rules) => {
                print(|out| writeln!(out, "{}: {} rules, no errors", path.display(), rules.rules().len()))?
            }
            Err(error) => {
                tell(error);
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

fn test(files: &[PathBuf]) -> Result<ExitCode, Failure> {
    let mut code = ExitCode::SUCCESS;
    for path in files {
        match Case::load(path).and_then(|case| case.check()) {
            Ok(()) => print(|out| writeln!(out, "{}: passed", path.display()))?,
            Err(error) => {
                tell(format_args!("{}: {error}", path.display()));
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// What a rule file declares.
#[derive(Serialize)]
struct Listing<'a> {
    name: &'a str,
    parameters: &'a [Parameter],
    rules: Vec<&'a str>,
}

fn list(file: Option<&Path>, json: bool) -> Result<ExitCode, Failure> {
    match file {
        Some(path) => {
            let rules = RuleSet::load(path)?;
            let listing = Listing {
                name: rules.name(),
                parameters: rules.parameters(),
                rules: rules.rules().iter().map(|rule| rule.name.as_str()).collect(),
            };
            if json { print_json(&listing)? } else { print(|out| write_rules(out, &listing))? }
        }
        None if json => print_json(&PROFILES)?,
        None => print(write_features)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = files::json(value)?;
    print(|out| writeln!(out, "{text}"))
}

fn write_rules(out: &mut impl Write, listing: &Listing) -> io::Result<()> {
    writeln!(out, "{}", listing.name)?;
    for p in listing.parameters {
        writeln!(out, "    {} = {} {}, {} to {}: {}", p.name, p.default, p.unit, p.low, p.high, p.help)?;
    }
    for rule in &listing.rules {
        writeln!(out, "    rule {rule}")?;
    }
    Ok(())
}

fn write_features(out: &mut impl Write) -> io::Result<()> {
    for profile in PROFILES {
        writeln!(out, "{}: {}", profile.name, profile.help)?;
        for p in profile.parameters {
            writeln!(out, "    {} = {}: {}", p.name, p.default, p.help)?;
        }
    }
    Ok(())
}
