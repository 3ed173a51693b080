//! `welt apply` for several models: each on its own, so that one that fails leaves the others alone.

use super::apply::{Files, Work};
use super::args::Apply;
use super::error::Failure;
use super::files;
use super::output::{print, tell};
use std::collections::BTreeSet;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use welt::feature::Report;

/// Whether a name is that of a folder: one that is there, or one that ends as folders do.
pub fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.to_string_lossy().ends_with(std::path::is_separator)
}

/// Does the work to every model; exit code 1 when one fails.
pub fn run(arguments: &Apply) -> Result<ExitCode, Failure> {
    let models = models(arguments)?;
    let work = Work::new(arguments)?;
    let folders = [Some(&arguments.output), arguments.report.as_ref(), arguments.figure.as_ref()];
    for folder in folders.into_iter().chain([arguments.trace.as_ref()]).flatten() {
        make_folder(folder)?;
    }
    let mut failed = Vec::new();
    for model in &models {
        // A defect of the library that one model meets is no reason to leave out the others.
        let result = catch_unwind(AssertUnwindSafe(|| work.on(model)))
            .unwrap_or_else(|_| Err(Failure::error("a defect of welt; please report it with the model")));
        if let Err(error) = &result {
            failed.push(model.input.display().to_string());
            let (input, message) = (model.input.display().to_string(), error.to_string());
            let place = if message.starts_with(&input) { String::new() } else { format!("{input}: ") };
            tell(format_args!("welt: {place}{message}"));
        }
        let line = if arguments.json { json(model, &result)? } else { text(model, &result) };
        print(|out| out.write_all(line.as_bytes()))?;
    }
    let (done, all) = (models.len() - failed.len(), models.len());
    if failed.is_empty() {
        tell(format_args!("welt: {all} of {all} models done"));
        return Ok(ExitCode::SUCCESS);
    }
    tell(format_args!("welt: {done} of {all} models done; these failed: {}", failed.join(", ")));
    Ok(ExitCode::FAILURE)
}

/// One line per model that was done.
fn text(model: &Files, result: &Result<Report, Failure>) -> String {
    let Ok(report) = result else { return String::new() };
    let mut line = format!(
        "{}: {}, {} marks, {} faces, {} now; {} warnings\n",
        model.output.display(),
        report.feature,
        report.marks,
        report.before.faces,
        report.after.faces,
        report.warnings.len()
    );
    for warning in &report.warnings {
        line += &format!("  {warning}\n");
    }
    line
}

/// One line of JSON per model.
fn json(model: &Files, result: &Result<Report, Failure>) -> Result<String, Failure> {
    let (input, output) = (model.input.to_string_lossy(), model.output.to_string_lossy());
    let value = match result {
        Ok(report) => serde_json::json!({ "input": input, "output": output, "report": report }),
        Err(error) => serde_json::json!({ "input": input, "error": error.to_string() }),
    };
    Ok(serde_json::to_string(&value)? + "\n")
}

/// The files of every model: named after the input, in the folders of the arguments.
fn models(arguments: &Apply) -> Result<Vec<Files>, Failure> {
    if arguments.replay.is_some() {
        return Err(Failure::usage("--replay repeats a run on one model; give one input and an output file"));
    }
    if files::is_standard(&arguments.output) || arguments.inputs.iter().any(|input| files::is_standard(input))
    {
        return Err(Failure::usage("several models are read from files and written into a folder, not -"));
    }
    // A file of a folder that is not there yet is none of the others, whatever their names.
    let place = |path: &PathBuf| files::place(path).unwrap_or_else(|| path.clone());
    let read: BTreeSet<PathBuf> = arguments.inputs.iter().map(place).collect();
    let mut written = BTreeSet::new();
    let mut models = Vec::new();
    for input in &arguments.inputs {
        let Some(name) = input.file_name() else {
            return Err(Failure::usage(format_args!("{}: this is no file", input.display())));
        };
        let beside = |folder: &Option<PathBuf>, extension| {
            folder.as_ref().map(|folder| folder.join(name).with_extension(extension))
        };
        let model = Files {
            input: input.clone(),
            output: arguments.output.join(name),
            report: beside(&arguments.report, "json"),
            figure: beside(&arguments.figure, "png"),
            trace: beside(&arguments.trace, "trace"),
        };
        let outputs = [Some(&model.output), model.report.as_ref(), model.figure.as_ref()];
        for path in outputs.into_iter().chain([model.trace.as_ref()]).flatten() {
            let place = place(path);
            let problem = if read.contains(&place) {
                "would take the place of an input; name another folder"
            } else if !written.insert(place) {
                "would be written for two models; give inputs names of their own"
            } else {
                continue;
            };
            return Err(Failure::usage(format_args!("{} {problem}", path.display())));
        }
        models.push(model);
    }
    Ok(models)
}

fn make_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Failure::error(format_args!(
            "{}: several models are written into a folder, and this cannot be made one: {error}; name another",
            folder.display()
        ))
    })
}
