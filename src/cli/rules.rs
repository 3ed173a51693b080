//! `welt rules`.

use super::args::{Rules, RulesAction};
use super::error::Failure;
use super::files;
use super::output::{print, tell};
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use welt::feature::Profile;
use welt::gml::{Diagnostic, Severity};
use welt::grammar::{Case, Input, Parameter, RuleSet};
use welt::picture::rule_svg;

pub fn run(arguments: &Rules) -> Result<ExitCode, Failure> {
    match &arguments.action {
        RulesAction::Check { files, json } => check(files, *json),
        RulesAction::Draw { file, output, cases } => draw(&RuleSet::load(file)?, output, cases.as_deref()),
        RulesAction::Test { files } => test(files),
        RulesAction::List { file, json } => list(file.as_deref(), *json),
    }
}

/// What `check` tells about a place in a rule file.
#[derive(Serialize)]
struct Finding<'a> {
    severity: &'static str,
    file: &'a str,
    line: usize,
    column: usize,
    word: &'a str,
    message: &'a str,
}

impl<'a> From<&'a Diagnostic> for Finding<'a> {
    fn from(diagnostic: &'a Diagnostic) -> Self {
        let severity = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let Diagnostic { file, line, column, word, message, .. } = diagnostic;
        Self { severity, file, line: *line, column: *column, word, message }
    }
}

fn check(files: &[PathBuf], json: bool) -> Result<ExitCode, Failure> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for path in files {
        match RuleSet::load(path) {
            Ok(rules) => {
                let warnings = rules.warnings();
                if !json {
                    let count = match warnings.len() {
                        0 => "no errors, no warnings".to_owned(),
                        1 => "1 warning".to_owned(),
                        count => format!("{count} warnings"),
                    };
                    print(|out| writeln!(out, "{}: {} rules, {count}", path.display(), rules.rules().len()))?;
                    warnings.iter().for_each(tell);
                }
                found.extend(warnings);
            }
            Err(error) => {
                if !json {
                    tell(&error);
                }
                found.extend(error.diagnostics);
            }
        }
    }
    if json {
        print_json(&found.iter().map(Finding::from).collect::<Vec<_>>())?;
    }
    let code = if found.iter().any(|found| found.severity == Severity::Error) {
        1
    } else if found.is_empty() {
        0
    } else {
        3
    };
    Ok(ExitCode::from(code))
}

/// One SVG per rule.
/// Draws each rule into a file of `folder`; `cases` has the meshes of rules that cannot be drawn by themselves.
pub fn draw(rules: &RuleSet, folder: &Path, cases: Option<&Path>) -> Result<ExitCode, Failure> {
    std::fs::create_dir_all(folder).map_err(|e| Failure::error(format_args!("{}: {e}", folder.display())))?;
    for rule in rules.rules() {
        let path = folder.join(format!("{}.svg", rule.name));
        let case = cases.map(|cases| cases.join(format!("{}.case", rule.name))).filter(|case| case.is_file());
        let case = case.map(|case| Case::load(&case)).transpose()?;
        let svg = rule_svg(rules, rule, case.as_ref());
        welt::io::save(&path, |out| out.write_all(svg.as_bytes()))?;
        print(|out| writeln!(out, "{}", path.display()))?;
    }
    Ok(ExitCode::SUCCESS)
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
    inputs: &'a [Input],
    rules: Vec<&'a str>,
}

fn list(file: Option<&Path>, json: bool) -> Result<ExitCode, Failure> {
    match file {
        Some(path) => {
            let rules = RuleSet::load(path)?;
            let listing = Listing {
                name: rules.name(),
                parameters: rules.parameters(),
                inputs: rules.inputs(),
                rules: rules.rules().iter().map(|rule| rule.name.as_str()).collect(),
            };
            if json { print_json(&listing)? } else { print(|out| write_rules(out, &listing))? }
        }
        None => {
            let shipped = Profile::shipped()?;
            if json { print_json(&shipped)? } else { print(|out| write_features(out, &shipped))? }
        }
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
    for input in listing.inputs {
        writeln!(out, "    input {}: {}", input.name, input.help)?;
    }
    for rule in &listing.rules {
        writeln!(out, "    rule {rule}")?;
    }
    Ok(())
}

fn write_features(out: &mut impl Write, shipped: &[Profile]) -> io::Result<()> {
    for profile in shipped {
        writeln!(out, "{}: {}", profile.name, profile.help)?;
        for p in &profile.parameters {
            writeln!(out, "    {} = {}: {}", p.name, p.default, p.help)?;
        }
    }
    Ok(())
}
