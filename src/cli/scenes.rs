//! The examples of `welt demo`: counterparts of the figures of Thaller, Augsdoerfer and Fellner 2016 on real chairs.
//! `docs/figures.md` puts their figures beside the paper's.

use glam::DVec3;
use welt::optimise::Method;

/// One example.
pub struct Scene {
    /// Name of its files.
    pub name: &'static str,
    pub title: &'static str,
    /// The chair, as OBJ.
    pub model: &'static str,
    /// Rules to run on the marks instead of features.
    pub rules: Option<&'static str>,
    pub features: &'static [&'static str],
    pub marks: &'static [&'static str],
    pub set: &'static [&'static str],
    pub method: Method,
    pub view: Side,
}

/// Where the viewer stands.
#[derive(Clone, Copy)]
pub enum Side {
    /// The whole chair from the left.
    Left,
    /// The whole chair from the right.
    Right,
    /// The back rest, close.
    Near,
}

impl Side {
    pub fn viewer(self) -> DVec3 {
        match self {
            Self::Left => DVec3::new(-0.9, 0.6, 1.5),
            Self::Right => DVec3::new(0.9, 0.6, 1.5),
            Self::Near => DVec3::new(-0.3, 0.4, 1.5),
        }
    }

    pub fn zoom(self) -> Option<f64> {
        match self {
            Self::Left | Self::Right => None,
            Self::Near => Some(2.0),
        }
    }
}

const LEAF: &str = include_str!("../../tests/data/models/leaf_chair.obj");
const ARMCHAIR: &str = include_str!("../../tests/data/models/chair.obj");
const PATCHES: &str = include_str!("../../rules/patches.rules");

/// The seam down the middle of the chair.
const MIDDLE: &str = "ring:3,331";
const MIDDLE_PIPED: &str = "ring:3,331#piping";
/// The seam across it.
const ACROSS: &str = "ring:16,333";
/// From the seam in the middle of the front round the right side to that of the back.
const HALF_ACROSS: [&str; 2] = ["path:814,970:91,547", "path:91,547:441,1071"];
/// A patch of the back rest.
const PATCH: &str = "cut:442,1071,443,422,444,57";
/// A wave over the back rest that follows no edges.
const WAVE: &str = "spline:-13,68,-37;-8,71.6,-38.7;-2.2,72.2,-39;4,70,-38;9,69.6,-37.8;13,72,-38.9";
/// A round outline there.
const ROUND: &str = "spline:8.2,71.1,-38.5;6.7,74.4,-40;2.7,76.4,-41;-2.1,76.4,-41;-6.1,74.4,-40;-7.6,71.1,-38.5;\
                     -6.1,67.8,-36.9;-2.1,65.8,-36;2.7,65.8,-36;6.7,67.8,-36.9;closed";

const SEAM: &[&str] = &["width=1.2", "depth=0.4"];
const SEAMS: &[&str] =
    &["width=1.2", "depth=0.3", "piping.width=2", "piping.height=0.45", "piping.depth=0.25"];

const GROOVE: &[&str] = &["groove"];

pub const SCENES: [Scene; 18] = [
    Scene {
        name: "ring",
        title: "A groove round a shell chair (ring:3,331; figures 5, 6b)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE],
        set: &["width=1.6", "depth=0.6"],
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "ridge",
        title: "The same as a ridge (figure 6c)",
        model: LEAF,
        rules: None,
        features: &["ridge"],
        marks: &[MIDDLE],
        set: &["width=1.6", "height=0.5"],
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "dent",
        title: "A dent in the back rest (figure 6d)",
        model: LEAF,
        rules: None,
        features: &["dent"],
        marks: &[PATCH],
        set: &["width=0.9", "depth=0.5"],
        method: Method::Solve,
        view: Side::Near,
    },
    Scene {
        name: "interplay",
        title: "Features together: a seam that ends in another, and a dent (figure 6e)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE, HALF_ACROSS[0], HALF_ACROSS[1], "cut:1049,453,454,1084#dent"],
        set: &["width=1.2", "depth=0.4", "dent.width=0.5"],
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "unfitted",
        title: "Three loops of depth 0 without a fit (figure 7a)",
        model: LEAF,
        rules: None,
        features: &["loop"],
        marks: &[MIDDLE],
        set: &["count=3"],
        method: Method::None,
        view: Side::Left,
    },
    Scene {
        name: "fitted",
        title: "Three loops of depth 0, fitted (figure 7b)",
        model: LEAF,
        rules: None,
        features: &["loop"],
        marks: &[MIDDLE],
        set: &["count=3"],
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "fitted_sliding",
        title: "Three loops of depth 0, fitted with sliding vertices",
        model: LEAF,
        rules: None,
        features: &["loop"],
        marks: &[MIDDLE],
        set: &["count=3"],
        method: Method::FitSlide,
        view: Side::Left,
    },
    Scene {
        name: "free_crossing",
        title: "A wave off the edges crosses a seam along them (figure 8a)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[WAVE, MIDDLE],
        set: SEAM,
        method: Method::Solve,
        view: Side::Near,
    },
    Scene {
        name: "free_dent",
        title: "A dent with an outline off the edges (figure 8b)",
        model: LEAF,
        rules: None,
        features: &["dent"],
        marks: &[ROUND],
        set: &["width=0.6", "depth=0.5"],
        method: Method::Solve,
        view: Side::Near,
    },
    Scene {
        name: "crossing",
        title: "Two seams that cross (figure 13a)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE, ACROSS],
        set: SEAM,
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "corner",
        title: "A seam with four corners (figure 13b)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[PATCH],
        set: &["width=1.2", "depth=0.5"],
        method: Method::Solve,
        view: Side::Near,
    },
    Scene {
        name: "tee",
        title: "A seam that ends in another one (figure 13c)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE, HALF_ACROSS[0], HALF_ACROSS[1]],
        set: SEAM,
        method: Method::Solve,
        view: Side::Right,
    },
    Scene {
        name: "tee_as_printed",
        title: "The same by the paper's Rule 6: the seam ends at a dam",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE, HALF_ACROSS[0], HALF_ACROSS[1]],
        set: &["width=1.2", "depth=0.4", "paper_tees=1"],
        method: Method::Solve,
        view: Side::Right,
    },
    Scene {
        name: "piped_tee",
        title: "A seam that ends in a piped one (figures 11, 13d)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE_PIPED, HALF_ACROSS[0], HALF_ACROSS[1]],
        set: SEAMS,
        method: Method::Solve,
        view: Side::Right,
    },
    Scene {
        name: "piped_crossing",
        title: "A seam ends at a piped one and resumes behind it (figures 12, 13e)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[MIDDLE_PIPED, ACROSS],
        set: SEAMS,
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "free",
        title: "A seam off the edges (figure 13f)",
        model: LEAF,
        rules: None,
        features: GROOVE,
        marks: &[WAVE],
        set: SEAM,
        method: Method::Solve,
        view: Side::Near,
    },
    Scene {
        name: "refined",
        title: "The faces of the groove by general refinement, to compare (figure 10)",
        model: LEAF,
        rules: Some(PATCHES),
        features: &[],
        marks: &[MIDDLE],
        set: &["depth=2"],
        method: Method::Solve,
        view: Side::Left,
    },
    Scene {
        name: "armchair",
        title: "Pipings round the seat and the back of another chair",
        model: ARMCHAIR,
        rules: None,
        features: &["piping"],
        marks: &["ring:132,224", "ring:262,265"],
        set: &["width=1.6", "height=0.6", "depth=0.2"],
        method: Method::Solve,
        view: Side::Left,
    },
];
