//! `welt rules`.

use super::args::{Rules, RulesAction};
use super::error::Failure;
use super::files;
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;
use welt::feature::PROFILES;
use welt::grammar::{Parameter, RuleSet};

pub fn run(arguments: &Rules) -> Result<ExitCode, Failure> {
    match &arguments.action {
        RulesAction::Check { files } => Ok(check(files)),
        RulesAction::List { file, json } => list(file.as_deref(), *json),
    }
}

fn check(files: &[std::path::PathBuf]) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for path in files {
        match RuleSet::load(path) {
            Ok(rules) => println!("{}: {} rules, no errors", path.display(), rules.rules().len()),
            Err(error) => {
                eprintln!("{error}");
                code = ExitCode::FAILURE;
            }
        }
    }
    code
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
            if json { println!("{}", files::json(&listing)?) } else { print_rules(&listing) }
        }
        None if json => println!("{}", files::json(&PROFILES)?),
        None => print_features(),
    }
    Ok(ExitCode::SUCCESS)
}

fn print_rules(listing: &Listing) {
    println!("{}", listing.name);
    for p in listing.parameters {
        println!("    {} = {} {}, {} to {}: {}", p.name, p.default, p.unit, p.low, p.high, p.help);
    }
    for rule in &listing.rules {
        println!("    rule {rule}");
    }
}

fn print_features() {
    for profile in PROFILES {
        println!("{}: {}", profile.name, profile.help);
        for p in profile.parameters {
            println!("    {} = {}: {}", p.name, p.default, p.help);
        }
    }
}
