//! A random feature on random marks of a random model.

use super::random::Random;
use std::collections::BTreeMap;
use std::fmt;
use welt::feature::{self, FeatureError, Options, Profile, Report, Request};
use welt::job::Job;
use welt::mark::parity::Mode;
use welt::mark::{Course, Curve, Mark, Selection, Selector, Shape};
use welt::mesh::{FaceId, Mesh};
use welt::optimise::Method;
use welt::subdivision::evaluate;

/// More marks take more time and find no more.
const MOST_MARKS: usize = 20;

pub struct Model {
    pub name: String,
    pub mesh: Mesh,
}

pub struct Case<'m> {
    pub model: &'m Model,
    pub marks: Vec<Mark>,
    /// Curves near the surface.
    pub curves: Vec<Curve>,
    /// The features, as in `--feature`, and their parameters, as in `--set`.
    pub features: Vec<String>,
    pub settings: Vec<String>,
    pub request: Request,
    pub options: Options,
    /// Nothing is moved off the surface.
    pub is_flat: bool,
    /// For whatever else a property leaves to chance.
    pub seed: u64,
}

impl<'m> Case<'m> {
    /// `None` where the marks that were tried do not exist.
    pub fn random(models: &'m [Model], random: &mut Random) -> Option<Self> {
        let model = &models[random.below(models.len())];
        let mut marks: BTreeMap<u32, Mark> = BTreeMap::new();
        for _ in 0..1 + random.below(3) {
            for mark in some_marks(&model.mesh, random) {
                marks.entry(mark.half_edge.edge()).or_insert(mark);
            }
        }
        let mut curves = Vec::new();
        if random.once_in(5) {
            curves.extend(some_curve(&model.mesh, random));
            // With marks beside it now and then: mostly they share edges, which is refused.
            if !random.once_in(4) {
                marks.clear();
            }
        }
        if marks.is_empty() && curves.is_empty() {
            return None;
        }
        let percent = |x: f64| format!("{}%", (1000.0 * x).round() / 10.0);
        let first = random.pick(&["groove", "groove", "groove", "ridge", "piping", "step", "bead", "loop"]);
        let features = vec![first.to_owned()];
        let mut settings = Vec::new();
        let is_flat = random.once_in(3);
        for name in Profile::named(first).ok()?.parameters.iter().map(|p| p.name.as_str()) {
            match name {
                "width" => settings.push(format!("width={}", percent(random.between(0.1, 0.4)))),
                "depth" | "height" if is_flat => settings.push(format!("{name}=0")),
                "depth" | "height" => settings.push(format!("{name}={}", percent(random.between(0.02, 0.2)))),
                _ => {}
            }
        }
        if random.once_in(4) {
            settings.push(format!("taper={}", random.pick(&[0.25, 0.5, 1.0])));
        }
        if random.once_in(8) {
            settings.push("paper_tees=1".into());
        }
        let request = Request::features(&features, &settings).ok()?;
        let mut options = Options {
            method: random.pick(&[Method::None, Method::None, Method::Solve]),
            parity: random.pick(&[Mode::Auto, Mode::AllQuad, Mode::Local]),
            strict: random.once_in(10),
            ..Options::default()
        };
        let mut marks: Vec<Mark> = marks.into_values().collect();
        let count = marks.len();
        marks.rotate_left(random.below(count.max(1)).min(count));
        marks.truncate(MOST_MARKS);
        let seed = random.bits();
        // The default takes long.
        if seed.is_multiple_of(40) {
            options.method = Method::FitSlide;
        }
        Some(Self { model, marks, curves, features, settings, request, options, is_flat, seed })
    }

    pub fn apply(&self, mesh: &mut Mesh) -> Result<Report, FeatureError> {
        self.apply_to(mesh, &self.marks)
    }

    /// The same feature on marks of another mesh.
    pub fn apply_to(&self, mesh: &mut Mesh, marks: &[Mark]) -> Result<Report, FeatureError> {
        let selection =
            Selection { marks: marks.to_vec(), curves: self.curves.clone(), ..Selection::default() };
        feature::apply(mesh, &selection, &self.request, &self.options, &Job::new())
    }

    /// Leaves out marks as long as the case `fails`.
    pub fn reduce(&mut self, fails: impl Fn(&Self) -> bool) {
        let mut size = self.marks.len().div_ceil(2);
        while size > 0 {
            let mut start = 0;
            while start < self.marks.len() {
                let end = (start + size).min(self.marks.len());
                let removed: Vec<Mark> = self.marks.drain(start..end).collect();
                if self.marks.is_empty() && self.curves.is_empty() || !fails(self) {
                    self.marks.splice(start..start, removed);
                    start = end;
                }
            }
            size = if size == 1 { 0 } else { size.div_ceil(2) };
        }
    }
}

impl fmt::Display for Case<'_> {
    /// As a call of the program.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Options { method, parity, strict, .. } = &self.options;
        write!(f, "welt apply {} -o out.obj", self.model.name)?;
        self.features.iter().try_for_each(|feature| write!(f, " --feature {feature}"))?;
        self.settings.iter().try_for_each(|setting| write!(f, " --set {setting}"))?;
        write!(
            f,
            " --optimise {} --parity {}",
            method.name(),
            match parity {
                Mode::Auto => "auto",
                Mode::AllQuad => "all-quad",
                Mode::Local => "local",
            }
        )?;
        if *strict {
            write!(f, " --strict")?;
        }
        for mark in &self.marks {
            let (a, b) = (self.model.mesh.source(mark.half_edge).0, self.model.mesh.target(mark.half_edge).0);
            write!(f, " --mark edge:{a},{b}@{}#{}", mark.t, mark.kind)?;
        }
        for Curve { points, course, closed, kind } in &self.curves {
            let points: Vec<String> = points.iter().map(|p| format!("{},{},{}", p.x, p.y, p.z)).collect();
            let course = if *course == Course::Spline { "spline" } else { "polyline" };
            let closed = if *closed { ";closed" } else { "" };
            write!(f, " --mark '{course}:{}{closed}#{kind}'", points.join(";"))?;
        }
        Ok(())
    }
}

/// A curve from face to face.
fn some_curve(mesh: &Mesh, random: &mut Random) -> Option<Curve> {
    let mut face = random.pick(&mesh.faces().collect::<Vec<_>>());
    let mut points = Vec::new();
    // Where a curve touches itself it is not clear which stretch is the nearest.
    let mut seen = vec![face];
    for _ in 0..2 + random.below(5) {
        let [u, v] = [0.1, 0.1].map(|low| random.between(low, 0.9));
        points.push(evaluate(mesh, face, 0, u, v)?.position);
        let sides: Vec<_> = mesh.face_half_edges(face).map(|h| mesh.face(h.mate())).collect();
        let next = random.pick(&sides);
        if next.is_boundary() || seen.contains(&next) {
            break;
        }
        face = next;
        seen.push(face);
    }
    (points.len() > 1).then_some(())?;
    Some(Curve {
        closed: points.len() > 3 && random.once_in(4),
        points,
        course: random.pick(&[Course::Polyline, Course::Spline]),
        kind: random.pick(&["red", "red", "ridge", "dent"]).to_owned(),
    })
}

/// Marks of one random selector.
fn some_marks(mesh: &Mesh, random: &mut Random) -> Vec<Mark> {
    let edges: Vec<_> = mesh.edges().collect();
    let start = random.pick(&edges);
    let edge = (mesh.source(start).0, mesh.target(start).0);
    let kind = random.pick(&["red", "red", "red", "ridge", "piping"]).to_owned();
    let resolve_as = |shape, kind: &str| {
        let selector = Selector { shape, kind: kind.to_owned() };
        Selection::resolve(mesh, &[selector]).map(|selection| selection.marks).unwrap_or_default()
    };
    let resolve = |shape| resolve_as(shape, &kind);
    let near = |rings: usize| {
        let mut faces: Vec<FaceId> = mesh.outgoing(mesh.source(start)).map(|h| mesh.face(h)).collect();
        faces.retain(|f| !f.is_boundary());
        for _ in 0..rings {
            faces = mesh.grow_faces(&faces);
        }
        faces
    };
    let mut marks = match random.below(6) {
        0 => resolve(Shape::Ring { edge }),
        1 => {
            let faces = near(3);
            let goal = mesh.face_half_edges(random.pick(&faces)).nth(random.below(3)).unwrap_or(start);
            resolve(Shape::Path { from: edge, to: (mesh.source(goal).0, mesh.target(goal).0) })
        }
        2 => {
            let faces = near(random.below(3));
            let vertices = faces.iter().flat_map(|&f| mesh.face_vertices(f)).map(|v| v.0).collect();
            resolve_as(Shape::Cut { vertices }, if random.once_in(3) { "dent" } else { &kind })
        }
        3 => vec![Mark { half_edge: start, t: 0.5, kind: kind.clone(), breadth: None }],
        which => {
            // A random subset of a neighbourhood, or of the whole mesh.
            let faces = if which == 4 { near(1 + random.below(3)) } else { mesh.faces().collect() };
            let share = if which == 4 { 2 + random.below(6) } else { faces.len() / 4 + 1 };
            let all = faces.iter().flat_map(|&f| mesh.face_half_edges(f));
            all.filter(|_| random.once_in(share))
                .map(|half_edge| Mark { half_edge, t: 0.5, kind: kind.clone(), breadth: None })
                .collect()
        }
    };
    // Places: in the middle, all in one place, or each in its own; now and then too near to an end.
    match random.below(4) {
        0 | 1 => {}
        2 => {
            let t = random.between(0.3, 0.7);
            marks.iter_mut().for_each(|mark| mark.t = t);
        }
        _ => {
            let far = if random.once_in(4) { 0.49 } else { 0.2 };
            marks.iter_mut().for_each(|mark| mark.t = random.between(0.5 - far, 0.5 + far));
        }
    }
    marks
}
