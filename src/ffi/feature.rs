//! Features: the whole job in one call, and its stages one by one.

use super::arguments::{self, Output};
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::{Failure, Place};
use super::job::WeltJob;
use super::mesh::WeltMesh;
use super::options::{self, Options};
use super::report::{WeltReport, hand_over};
use super::rules::WeltRules;
use super::selection::WeltSelection;
use crate::feature::{self, Profile, Request};
use crate::grammar::Limits;
use crate::job::Job;
use crate::mark::parity;
use crate::mesh::{MOST_COORDINATE, VertexId};
use crate::optimise::Method;
use crate::surface::SAMPLES;
use std::collections::BTreeSet;
use std::ffi::c_char;
use std::time::Duration;

/// Leave vertices where the rules put them.
pub const WELT_FIT_NONE: u32 = 0;
/// The iteration of Thaller, Augsdoerfer and Fellner 2016, section 5.3.
pub const WELT_FIT_LOOP: u32 = 1;
/// The sparse system which that iteration converges to.
pub const WELT_FIT_SOLVE: u32 = 2;
/// Least squares of distance and slope over samples of the surface; vertices move along the normal.
pub const WELT_FIT_SURFACE: u32 = 3;
/// The same; vertices that were there before may also slide along the surface, which brings the new surface closest.
pub const WELT_FIT_SURFACE_SLIDE: u32 = 4;

pub(super) fn method(number: u32) -> Result<Method, Failure> {
    match number {
        WELT_FIT_NONE => Ok(Method::None),
        WELT_FIT_LOOP => Ok(Method::Loop),
        WELT_FIT_SOLVE => Ok(Method::Solve),
        WELT_FIT_SURFACE => Ok(Method::Fit),
        WELT_FIT_SURFACE_SLIDE => Ok(Method::FitSlide),
        _ => Err(Failure::argument(format!("the fit is {number}, which is no WELT_FIT_*"))),
    }
}

/// A line of vertices between faces that the marks leave with an odd number of sides, where the way is short; one irregular
/// face each elsewhere.
pub const WELT_PARITY_AUTO: u32 = 0;
/// Lines wherever there is a way, also to triangles and pentagons, so that no new face is other than a quad.
pub const WELT_PARITY_ALL_QUAD: u32 = 1;
/// No lines: one irregular face each.
pub const WELT_PARITY_LOCAL: u32 = 2;

fn parity_mode(number: u32) -> Result<parity::Mode, Failure> {
    match number {
        WELT_PARITY_AUTO => Ok(parity::Mode::Auto),
        WELT_PARITY_ALL_QUAD => Ok(parity::Mode::AllQuad),
        WELT_PARITY_LOCAL => Ok(parity::Mode::Local),
        _ => Err(Failure::argument(format!("the parity is {number}, which is no WELT_PARITY_*"))),
    }
}

/// How a feature is applied. Set it by welt_feature_options_init, then change what differs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltFeatureOptions {
    /// Set by welt_feature_options_init; leave it.
    pub struct_size: u32,
    /// How the changed mesh is fitted to the surface as it was: one of WELT_FIT_*. Default WELT_FIT_SURFACE_SLIDE.
    pub fit: u32,
    /// Not 0: measure deviations and look for thin walls; costs more than the feature. Default 0.
    pub deviation: u32,
    /// What is done about faces that the marks leave with an odd number of sides: one of WELT_PARITY_*. Default
    /// WELT_PARITY_AUTO.
    pub parity: u32,
    /// Not 0: marks that no rule handles are an error, WELT_ERROR_RULE, whose places are the marked edges; else they
    /// are kept and the report lists them. Default 0.
    pub strict: u32,
    /// Most procedures and loops of a script of the rules inside one another. Default 1000.
    pub max_script_depth: u32,
    /// Most applications of rules. This and what follows is for each run of the rules; correcting widths and depths takes
    /// several. Default 10 million.
    pub max_applications: u64,
    /// Most steps of scripts and of the search for matches. Default 10^9.
    pub max_steps: u64,
    /// Most changes of the mesh; bounds the memory, about 150 bytes each. Default 20 million.
    pub max_changes: u64,
    /// The mesh may come to have at most this many times the vertices, edges and faces that it has, together, default 16,
    pub max_growth: u64,
    /// and this many more. Default 1 million.
    pub max_extra_elements: u64,
    /// Most seconds, at least 0, infinite for no bound. Default 60.
    pub max_seconds: f64,
}

// SAFETY: `repr(C)`, 6 * 4 + 5 * 8 + 8 bytes without padding, of integers and a double.
unsafe impl Options for WeltFeatureOptions {
    fn first_size() -> usize {
        20
    }

    fn defaults(struct_size: u32) -> Self {
        let Limits { applications, steps, edits, depth, growth, extra, time } = Limits::default();
        Self {
            struct_size,
            fit: WELT_FIT_SURFACE_SLIDE,
            deviation: 0,
            parity: WELT_PARITY_AUTO,
            strict: 0,
            max_script_depth: u32::try_from(depth).unwrap_or(u32::MAX),
            max_applications: applications,
            max_steps: steps,
            max_changes: edits,
            max_growth: growth,
            max_extra_elements: extra,
            max_seconds: time.map_or(f64::INFINITY, |time| time.as_secs_f64()),
        }
    }
}

impl WeltFeatureOptions {
    fn limits(&self) -> Result<Limits, Failure> {
        let seconds = self.max_seconds;
        if seconds.is_nan() || seconds < 0.0 {
            return Err(Failure::argument(format!("max_seconds is {seconds}; it is 0 or more")));
        }
        Ok(Limits {
            applications: self.max_applications,
            steps: self.max_steps,
            edits: self.max_changes,
            depth: self.max_script_depth as usize,
            growth: self.max_growth,
            extra: self.max_extra_elements,
            // More than a duration can hold is no bound.
            time: Duration::try_from_secs_f64(seconds).ok(),
        })
    }
}

/// Sets options to their defaults. options: must not be NULL. size: sizeof *options. Fails with WELT_ERROR_ARGUMENT where the
/// size is none that the library knows. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_feature_options_init(options: *mut WeltFeatureOptions, size: usize) -> i32 {
    // SAFETY: the header asks for NULL or a struct of this size; no error is wanted.
    unsafe { boundary(std::ptr::null_mut(), || options::initialise(options, size)) }
}

/// Lists the features that come with the library.
///
/// list: receives a report whose JSON is an array of features, each with name, help and parameters: name, unit (length or
/// count), default (a number in model units, or a text such as "30%"), low, high (null where only the mesh sets a bound), help;
/// free it with welt_report_free.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_feature_list(list: *mut *mut WeltReport, error: *mut *mut WeltError) -> i32 {
    let body = || {
        // SAFETY: the header asks for a place for the handle.
        let output = unsafe { Output::new(list, "list") }?;
        output.handle(WeltReport::new(&Profile::shipped()?)?);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// What both ways of applying share.
///
/// # Safety
/// The pointers are as the header asks.
#[allow(clippy::too_many_arguments)]
unsafe fn apply(
    mesh: *mut WeltMesh,
    selection: *const WeltSelection,
    request: impl FnOnce(&[&str]) -> Result<Request, Failure>,
    settings: *const c_char,
    settings_length: usize,
    options: *const WeltFeatureOptions,
    job: *const WeltJob,
    report: *mut *mut WeltReport,
) -> Result<(), Failure> {
    // SAFETY: as for this function.
    let (mesh, selection, text, options, job, report) = unsafe {
        (
            arguments::handle_mut(mesh, "mesh")?,
            arguments::handle(selection, "selection")?,
            if settings.is_null() { "" } else { arguments::text(settings, settings_length, "settings")? },
            options::complete(options)?,
            arguments::optional(job, "job")?,
            Output::optional(report, "report")?,
        )
    };
    let options = feature::Options {
        method: method(options.fit)?,
        parity: parity_mode(options.parity)?,
        strict: options.strict != 0,
        limits: options.limits()?,
        samples: if options.deviation != 0 { SAMPLES } else { 0 },
        ..feature::Options::default()
    };
    let settings: Vec<&str> = text.split_whitespace().collect();
    let request = request(&settings)?;
    let idle = Job::new();
    let job = job.map_or(&idle, |job| &job.job);
    let done = mesh.change(|mesh| {
        let selection = selection.on(mesh)?;
        let done = feature::apply(mesh, selection, &request, &options, job)?;
        report.is_some().then(|| WeltReport::new(&done)).transpose()
    })?;
    hand_over(report, done);
    Ok(())
}

/// Applies features: rewrites the mesh along the marked edges, fits it to the surface as it was, displaces it to the asked
/// widths, depths and heights.
///
/// mesh: is changed; vertices keep their numbers, new ones follow.
/// selection: the marked edges, made on this mesh, whose edges are unchanged since. A mark asks for the feature that its kind
/// (#kind) names; one without a kind asks for the first feature.
/// features: one or more, one per line: FEATURE or KIND=FEATURE, where FEATURE is one that welt_feature_list lists, such as
/// groove, or a profile file ending in .toml. Features of the list that marks name need not be given here.
/// features_length: in bytes, SIZE_MAX for a NUL-terminated text.
/// settings: may be NULL; NAME=VALUE, or KIND.NAME=VALUE for one feature of several, separated by blanks, such as
/// "width=0.2 depth=30%": model units, or a percentage of the length of the marked edge.
/// settings_length: in bytes, SIZE_MAX for a NUL-terminated text.
/// options: may be NULL for defaults.
/// job: may be NULL.
/// report: may be NULL; else receives what was done: counts, rules, leftovers, dimensions asked and reached, deviations,
/// warnings. Free it with welt_report_free.
///
/// Fails with WELT_ERROR_ARGUMENT (an unknown feature or setting, a selection of another mesh, a width that an edge cannot
/// take: the place is the edge), WELT_ERROR_FILE, WELT_ERROR_RULE (also for rules that go beyond a limit of the options and, when
/// strict, for marks that no rule handles),
/// WELT_ERROR_CANCELLED; the mesh is as it was before then. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_feature_apply(
    mesh: *mut WeltMesh,
    selection: *const WeltSelection,
    features: *const c_char,
    features_length: usize,
    settings: *const c_char,
    settings_length: usize,
    options: *const WeltFeatureOptions,
    job: *const WeltJob,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a string of this length.
        let features = unsafe { arguments::text(features, features_length, "features") }?;
        let names: Vec<&str> = features.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let request = |settings: &[&str]| Ok(Request::features(&names, settings)?);
        // SAFETY: the header asks for what `apply` asks for.
        unsafe { apply(mesh, selection, request, settings, settings_length, options, job, report) }
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Runs a rule set on the marked edges and fits the changed mesh to the surface as it was; nothing is displaced.
///
/// mesh, selection, options, job, report: as for welt_feature_apply.
/// rules: must not be NULL.
/// settings: may be NULL; NAME=VALUE with numbers, separated by blanks, for parameters of the rules.
/// settings_length: in bytes, SIZE_MAX for a NUL-terminated text.
///
/// Fails as welt_feature_apply does. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_rules_apply(
    mesh: *mut WeltMesh,
    selection: *const WeltSelection,
    rules: *const WeltRules,
    settings: *const c_char,
    settings_length: usize,
    options: *const WeltFeatureOptions,
    job: *const WeltJob,
    report: *mut *mut WeltReport,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living rules.
        let rules = unsafe { arguments::handle(rules, "rules") }?;
        let request = |settings: &[&str]| Ok(Request::rules(rules.rules.clone(), settings)?);
        // SAFETY: the header asks for what `apply` asks for.
        unsafe { apply(mesh, selection, request, settings, settings_length, options, job, report) }
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Displaces vertices along the normals of the limit surface, so that their limit points rise by the given heights, all
/// together.
///
/// mesh: must not be NULL; is changed.
/// vertices: the vertices, 0-based, each once; may be NULL when count is 0.
/// heights: how far the limit point of each rises, in model units; negative is inwards; may be
/// NULL when count is 0.
/// count: number of vertices and of heights.
///
/// Fails with WELT_ERROR_ARGUMENT where a vertex does not exist, or has no normal (the places list them), or a height is not
/// finite; the mesh is as it was before then. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_displace(
    mesh: *mut WeltMesh,
    vertices: *const u32,
    heights: *const f64,
    count: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for arrays of this count.
        let (vertices, heights) = unsafe {
            (arguments::array(vertices, count, "vertices")?, arguments::array(heights, count, "heights")?)
        };
        // SAFETY: the header asks for a living mesh that nobody else uses.
        let mesh = unsafe { arguments::handle_mut(mesh, "mesh") }?;
        let checked = mesh.read()?;
        let mut seen = BTreeSet::new();
        for (&v, height) in vertices.iter().zip(heights) {
            if !checked.has_vertex(VertexId(v)) {
                return Err(Failure::argument(format!("vertex {v} does not exist")));
            }
            if !seen.insert(v) {
                return Err(Failure::argument(format!("vertex {v} is named twice")));
            }
            if !height.is_finite() {
                return Err(Failure::argument(format!("the height of vertex {v} is not a finite number")));
            }
            if height.abs() > MOST_COORDINATE {
                return Err(Failure::argument(format!("the height of vertex {v} is beyond 1e50")));
            }
        }
        let heights: Vec<(VertexId, f64)> =
            vertices.iter().map(|&v| VertexId(v)).zip(heights.iter().copied()).collect();
        mesh.transact(|mesh| {
            let left_out = feature::raise(mesh, &heights);
            if left_out.is_empty() {
                return Ok(());
            }
            let place = |v: &VertexId| Place::vertex(v.0, "the surface has no normal here");
            Err(Failure {
                places: left_out.iter().map(place).collect(),
                ..Failure::argument(format!("{} vertices have no normal to rise along", left_out.len()))
            })
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}
