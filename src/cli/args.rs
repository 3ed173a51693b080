//! The arguments of every command.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use welt::io::{ImportOptions, Limits};
use welt::mesh::BoundaryRule;

#[derive(Parser)]
#[command(name = "welt", version, about = "Features on Catmull-Clark control meshes", max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Tell what a mesh file holds and what is wrong with it (exit code 1 when something is)
    Check(Check),
    /// Apply a feature to marked edges
    Apply(Apply),
    /// Write the limit surface as a mesh: refine N times and move every vertex to its limit
    Limit(Limit),
    /// Measure how far the limit surfaces of two control meshes are apart
    Deviation(Deviation),
    /// Turn the limit surface into bicubic B-spline patches for CAD
    Patches(Patches),
    /// Tell where extraordinary vertices sit, how much curvature varies round them, and which faces are worst
    Quality(Quality),
    /// Check, test or list rule files
    Rules(Rules),
    /// Make example features on chairs: control meshes, limit surfaces, reports, figures
    Demo(Demo),
}

/// How files are taken over.
#[derive(Args, Clone)]
pub struct Import {
    /// Split apart, turn round or remove what cannot be held instead of refusing the file
    #[arg(long)]
    pub repair: bool,
    /// Merge vertices that are no further apart than EPS (model units)
    #[arg(long, value_name = "EPS", allow_negative_numbers = true)]
    pub weld: Option<f64>,
    /// What becomes of the boundary; what the file says, or edge, without it
    #[arg(long, value_enum, value_name = "RULE")]
    pub boundary: Option<Boundary>,
    /// Sizes beyond which a file is refused: vertices, faces (of the file; 268435456 each), face-vertices (of one face; 1024), vertex-faces (at one vertex; 1024)
    #[arg(long = "limit", value_name = "NAME=COUNT", value_parser = super::limits::import)]
    pub limits: Vec<super::limits::Import>,
}

/// The names of boundary rules.
#[derive(Clone, Copy, ValueEnum)]
pub enum Boundary {
    /// Faces at the boundary are no part of the surface
    None,
    /// The boundary is a smooth curve
    Edge,
    /// As edge, but vertices of a single face stay where they are
    Corner,
}

impl From<Boundary> for BoundaryRule {
    fn from(boundary: Boundary) -> Self {
        match boundary {
            Boundary::None => Self::None,
            Boundary::Edge => Self::EdgeOnly,
            Boundary::Corner => Self::EdgeAndCorner,
        }
    }
}

impl Import {
    pub fn options(&self) -> ImportOptions {
        let mut limits = Limits::default();
        self.limits.iter().for_each(|limit| limit.set(&mut limits));
        ImportOptions { repair: self.repair, weld: self.weld, limits }
    }
}

#[derive(Args)]
pub struct Check {
    /// OBJ or PLY file, or - for OBJ on standard input
    pub input: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum CurvatureKind {
    /// The greater principal curvature
    Greatest,
    /// The smaller principal curvature
    Least,
    /// The mean of both
    Mean,
    /// Their product
    Gaussian,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum FitMethod {
    /// Leave vertices where the rules put them
    None,
    /// The paper's iteration
    Loop,
    /// The sparse system that iteration converges to
    Solve,
    /// Least squares of distance and slope over the surface
    Fit,
    /// The same; vertices that were there before may slide along the surface
    #[value(name = "fit+slide")]
    FitSlide,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Parity {
    /// A line of vertices to the border or between two of them where the way is short
    Auto,
    /// Lines wherever there is a way, also to triangles and pentagons of the mesh
    AllQuad,
    /// One irregular face each
    Local,
}

#[derive(Args)]
pub struct Apply {
    /// OBJ or PLY files, or - for OBJ on standard input. Of several, those that fail are told, and the others are done
    #[arg(value_name = "INPUT", required = true)]
    pub inputs: Vec<PathBuf>,
    /// Where the new control mesh goes (.obj or .ply), or - for OBJ on standard output; for several, a folder, which is made if missing, and so are those of reports, figures and traces
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Feature for marks that name no kind, or KIND=FEATURE: groove, ridge, piping, step, bead, dent, loop, or a profile file ending in .toml
    #[arg(long = "feature", value_name = "[KIND=]FEATURE", required_unless_present = "rules")]
    pub features: Vec<String>,
    /// Rule file to run on the marks instead of a feature
    #[arg(long, value_name = "FILE", conflicts_with = "features")]
    pub rules: Option<PathBuf>,
    /// Edges to mark: edge:A,B[@t], ring:A,B, path:A,B:C,D, cut:V,V,..., polyline:X,Y,Z;..., spline:X,Y,Z;..., select:FILE (0-based vertices); #KIND at the end asks for the feature of that kind
    #[arg(long = "mark", value_name = "SELECTOR", required = true)]
    pub marks: Vec<String>,
    /// Parameters: width=0.3 (model units) or width=30% (of the local edge); KIND.width=30% for one feature of several
    #[arg(long = "set", value_name = "[KIND.]NAME=VALUE")]
    pub set: Vec<String>,
    /// How to fit the changed mesh to the surface as it was
    #[arg(long, visible_alias = "method", value_enum, default_value = "fit+slide")]
    pub optimise: FitMethod,
    /// What to do about faces that the marks leave with an odd number of sides
    #[arg(long, value_enum, default_value = "auto")]
    pub parity: Parity,
    /// Fail where no rule handles a mark, instead of keeping the mark and applying the rest
    #[arg(long)]
    pub strict: bool,
    /// What a run of the rules may cost: applications, steps, changes, depth (of scripts), growth (factor of the elements of the mesh), extra (elements beyond that), seconds
    #[arg(long = "rule-limit", value_name = "NAME=COUNT", value_parser = super::limits::rules)]
    pub rule_limits: Vec<super::limits::Rules>,
    /// Write a report as JSON
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Write a figure: control mesh, limit surface, deviation map
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
    /// Do not measure deviations, which costs more than the feature itself
    #[arg(long)]
    pub no_deviation: bool,
    /// Threads for measuring deviations; 0 for as many as the machine has
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub threads: usize,
    /// Write which rule was applied where, in order, as JSON lines
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    pub trace: Option<PathBuf>,
    /// Apply the rules as a trace says instead of looking for matches; stop where that does not give the same mesh
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
    /// Print the report as JSON instead of text; of several models a line each
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Args)]
pub struct Limit {
    /// OBJ or PLY file, or - for OBJ on standard input
    pub input: PathBuf,
    /// Where the mesh goes: .obj, or .ply with normals; - for OBJ on standard output
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// How often to refine; 0 moves the control vertices themselves, in their order
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(0..=10))]
    pub level: u8,
    /// Draw the surface with reflection lines, which show unevenness that shading hides
    #[arg(long, value_name = "FILE.png")]
    pub zebra: Option<PathBuf>,
    /// Write this curvature of the surface as the value "quality" of each vertex of a .ply file, per model unit
    #[arg(long, value_name = "KIND")]
    pub curvature: Option<CurvatureKind>,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Args)]
pub struct Patches {
    /// OBJ or PLY file, or - for OBJ on standard input
    pub input: PathBuf,
    /// JSON file with knots, poles and neighbours of the patches, or - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Faces along a side of a patch at most
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    pub most_faces: u32,
    /// Aim for the deviation beside extraordinary vertices, in parts of the mean edge of the control face there
    #[arg(long, value_name = "PART", default_value_t = 1e-4)]
    pub tolerance: f64,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Args)]
pub struct Quality {
    /// OBJ or PLY file, or - for OBJ on standard input
    pub input: PathBuf,
    /// How many of the worst are listed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub worst: usize,
    /// Print JSON, with all extraordinary vertices
    #[arg(long)]
    pub json: bool,
    /// Draw the control mesh with its extraordinary vertices, mean curvature, and reflection lines
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Args)]
pub struct Deviation {
    /// First control mesh
    pub first: PathBuf,
    /// Second control mesh
    pub second: PathBuf,
    /// Samples per side of each face
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=64))]
    pub samples: u16,
    /// Threads; 0 for as many as the machine has
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub threads: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub import: Import,
}

#[derive(Args)]
pub struct Rules {
    #[command(subcommand)]
    pub action: RulesAction,
}

#[derive(Subcommand)]
pub enum RulesAction {
    /// Check rule files; exit code 1 when one has an error, 3 when there are warnings only
    Check {
        /// Rule files
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Print errors and warnings as JSON
        #[arg(long)]
        json: bool,
    },
    /// Draw every rule: left what its pattern matches, right what its action makes of it
    Draw {
        /// A rule file
        file: PathBuf,
        /// Folder for the drawings, one SVG per rule; it is made if missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// Folder of before/after cases: a rule that cannot be drawn from its pattern alone is drawn by RULE.case
        #[arg(long, value_name = "DIR")]
        cases: Option<PathBuf>,
    },
    /// Run before/after cases of rules; exit code 1 when one does not pass
    Test {
        /// Case files
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// List features, or the rules and parameters of a file
    List {
        /// A rule file; the built-in features without one
        file: Option<PathBuf>,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
}

#[derive(Args)]
pub struct Demo {
    /// Folder for the results; it is made if missing
    #[arg(default_value = "demo")]
    pub folder: PathBuf,
}
