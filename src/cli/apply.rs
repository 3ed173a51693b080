//! `welt apply`, for one model.

use super::args::{Apply, FitMethod, Parity};
use super::batch;
use super::error::Failure;
use super::figure::{View, draw, limit_picture};
use super::files;
use super::output::{print, tell};
use super::progress::watch;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use welt::feature::{Options, ProfileError, Report, Request, RequestError};
use welt::grammar::{Limits, RuleSet, Trace, Tracer};
use welt::io;
use welt::mark::{Selection, Selector, Shape, parity};
use welt::optimise::Method;
use welt::surface::SAMPLES;

pub fn run(arguments: &Apply) -> Result<ExitCode, Failure> {
    let [input] = &arguments.inputs[..] else { return batch::run(arguments) };
    if batch::is_folder(&arguments.output) {
        return batch::run(arguments);
    }
    let work = Work::new(arguments)?;
    let files = Files {
        input: input.clone(),
        output: arguments.output.clone(),
        report: arguments.report.clone(),
        figure: arguments.figure.clone(),
        trace: arguments.trace.clone(),
    };
    let report = work.on(&files)?;
    let text = if arguments.json { files::json(&report)? + "\n" } else { report.to_string() };
    // Standard output may carry the mesh.
    if files::is_standard(&arguments.output) {
        tell(text.trim_end());
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The files of one model.
pub struct Files {
    pub input: PathBuf,
    pub output: PathBuf,
    pub report: Option<PathBuf>,
    pub figure: Option<PathBuf>,
    pub trace: Option<PathBuf>,
}

/// What is done to models, as the arguments say.
pub struct Work<'a> {
    arguments: &'a Apply,
    request: Request,
    replay: Option<Trace>,
    selectors: Vec<Selector>,
}

impl<'a> Work<'a> {
    pub fn new(arguments: &'a Apply) -> Result<Self, Failure> {
        Ok(Self {
            arguments,
            request: request(arguments)?,
            replay: replay(arguments)?,
            selectors: arguments
                .marks
                .iter()
                .map(|text| Selector::parse(text))
                .collect::<Result<_, _>>()
                .map_err(Failure::usage)?,
        })
    }

    /// Does it to one model.
    pub fn on(&self, files: &Files) -> Result<Report, Failure> {
        let arguments = self.arguments;
        check_outputs(files, arguments, &self.selectors)?;
        let options = options(arguments, self.tracer());
        let mut mesh = files::import(&files.input, &arguments.import)?;
        let before = files.figure.as_ref().map(|_| mesh.clone());
        let selection = Selection::resolve(&mesh, &self.selectors)?;
        let result = watch(|job| welt::feature::apply(&mut mesh, &selection, &self.request, &options, job));
        // Of an attempt that failed, the trace shows how it came to that.
        if let (Some(path), Some(tracer)) = (&files.trace, &options.tracer) {
            let lines = tracer.trace().to_lines()?;
            io::save(path, |out| out.write_all(lines.as_bytes()))?;
        }
        let report = result?;

        files::export(&files.output, &mesh)?;
        if let Some(path) = &files.report {
            files::save_json(path, &report)?;
        }
        if let (Some(path), Some(before)) = (&files.figure, &before) {
            let limit = limit_picture(before, &mesh, &report)?;
            let view = View::of_feature(&mesh, &report, &limit);
            let title = format!("{}: {} marked edges", report.feature, report.marks);
            let image = draw(&title, &mesh, &report, &limit, view);
            io::save(path, |out| image.write_png(out))?;
        }
        Ok(report)
    }

    fn tracer(&self) -> Option<Arc<Tracer>> {
        match &self.replay {
            Some(trace) => Some(Arc::new(Tracer::replay(trace.clone()))),
            None => self.arguments.trace.as_ref().map(|_| Arc::new(Tracer::record())),
        }
    }
}

/// Refuses outputs that cannot be written, before any work is done.
fn check_outputs(files: &Files, arguments: &Apply, selectors: &[Selector]) -> Result<(), Failure> {
    let (report, figure) = (files.report.as_deref(), files.figure.as_deref());
    if report.is_some_and(files::is_standard) {
        return Err(Failure::usage("--report writes a file; --json prints the report as JSON"));
    }
    let trace = files.trace.as_deref();
    figure.map_or(Ok(()), files::check_picture)?;
    files::check_mesh_output(&files.output)?;
    [report, trace].into_iter().flatten().try_for_each(files::check_output)?;
    let beside: Vec<&Path> = [report, figure, trace].into_iter().flatten().collect();
    // The mesh may take the place of the mesh that is read.
    let read = selectors.iter().filter_map(|selector| match &selector.shape {
        Shape::File(path) => Some(path.as_path()),
        _ => None,
    });
    let profiles =
        arguments.features.iter().map(|feature| Path::new(feature.rsplit('=').next().unwrap_or(feature)));
    let others = [files.output.as_path(), &files.input];
    let others = others.into_iter().chain(arguments.replay.as_deref()).chain(arguments.rules.as_deref());
    let others: Vec<&Path> = others.chain(read).chain(profiles).collect();
    files::check_apart(&beside, &others)?;
    files::check_apart(&[&files.output], &others[2..])
}

fn replay(arguments: &Apply) -> Result<Option<Trace>, Failure> {
    let Some(path) = &arguments.replay else { return Ok(None) };
    let text =
        std::fs::read_to_string(path).map_err(|e| Failure::error(format_args!("{}: {e}", path.display())))?;
    let trace = Trace::from_lines(&text)
        .map_err(|(line, problem)| Failure::error(format_args!("{}:{line}: {problem}", path.display())))?;
    Ok(Some(trace))
}

fn request(arguments: &Apply) -> Result<Request, Failure> {
    let request = match &arguments.rules {
        Some(path) => Request::rules(RuleSet::load(path)?, &arguments.set),
        None => Request::features(&arguments.features, &arguments.set),
    };
    request.map_err(|error| match error {
        RequestError::Profile(ProfileError::File { .. }) | RequestError::Rules(_) => Failure::error(error),
        error => Failure::usage(error),
    })
}

fn options(arguments: &Apply, tracer: Option<Arc<Tracer>>) -> Options {
    let mut limits = Limits::default();
    arguments.rule_limits.iter().for_each(|limit| limit.set(&mut limits));
    Options {
        method: match arguments.optimise {
            FitMethod::None => Method::None,
            FitMethod::Loop => Method::Loop,
            FitMethod::Solve => Method::Solve,
            FitMethod::Fit => Method::Fit,
            FitMethod::FitSlide => Method::FitSlide,
        },
        parity: match arguments.parity {
            Parity::Auto => parity::Mode::Auto,
            Parity::AllQuad => parity::Mode::AllQuad,
            Parity::Local => parity::Mode::Local,
        },
        strict: arguments.strict,
        limits,
        samples: if arguments.no_deviation { 0 } else { SAMPLES },
        threads: arguments.threads,
        tracer,
    }
}
