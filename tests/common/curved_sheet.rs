//! Curved sheets with a band of depth 0 inserted by hand: the meshes of the optimisation study (docs/optimisation.md).

use glam::DVec3;
use std::collections::HashMap;
use std::time::Instant;
use welt::job::Job;
use welt::mesh::{FaceId, Mesh, Polygons, VertexId};
use welt::optimise::{Method, Target, active_set, fit};
use welt::surface::{Deviation, LimitSurface, Sampling, deviation_samples};

/// Cells along each side; the junction is in the middle one.
pub const SIDE: usize = 13;
const MIDDLE: usize = SIDE / 2;

/// The control points of a sheet with unit edges.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Base {
    Cylinder,
    Sphere,
    Saddle,
}

impl Base {
    /// Control point (i, j), the middle of the sheet at the origin of the parameters.
    fn point(self, radius: f64, i: usize, j: usize) -> DVec3 {
        let [x, y] = [i, j].map(|k| k as f64 - 0.5 * SIDE as f64);
        let (a, b) = (x / radius, y / radius);
        match self {
            Self::Cylinder => DVec3::new(radius * a.sin(), y, radius * a.cos()),
            // The exponential map: circles through the middle keep their lengths.
            Self::Sphere => {
                let r = a.hypot(b);
                let s = if r > 0.0 { r.sin() / r } else { 1.0 };
                DVec3::new(radius * s * a, radius * s * b, radius * r.cos())
            }
            Self::Saddle => DVec3::new(x, y, (x * x - y * y) / (2.0 * radius)),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Pattern {
    Straight,
    Corner,
    Crossing,
    Tee,
}

impl Pattern {
    pub const ALL: [Self; 4] = [Self::Straight, Self::Corner, Self::Crossing, Self::Tee];
}

/// The sheet as it was, with the band, and the cell of each of the latter's faces.
pub struct Case {
    pub before: Mesh,
    pub after: Mesh,
    /// Distance in cells from the middle cell, of each face of `after`.
    pub away: Vec<usize>,
}

struct Builder {
    points: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    away: Vec<usize>,
    /// Inserted points by edge (lower number first) and place in millionths.
    cuts: HashMap<(u32, u32, u32), u32>,
    width: f64,
}

impl Builder {
    fn cut(&mut self, a: u32, b: u32, t: f64) -> u32 {
        let (low, high, t) = if a < b { (a, b, t) } else { (b, a, 1.0 - t) };
        let key = (low, high, (t * 1e6).round() as u32);
        if let Some(&known) = self.cuts.get(&key) {
            return known;
        }
        let p = self.points[low as usize].lerp(self.points[high as usize], t);
        self.cuts.insert(key, self.points.len() as u32);
        self.points.push(p);
        self.points.len() as u32 - 1
    }

    /// The three lines' vertices on the edge from `a` to `b`.
    fn three(&mut self, a: u32, b: u32) -> [u32; 3] {
        [0.5 - self.width, 0.5, 0.5 + self.width].map(|t| self.cut(a, b, t))
    }

    /// A point at (x, y) of the bilinear cell BL BR TR TL.
    fn inner(&mut self, cell: [u32; 4], x: f64, y: f64) -> u32 {
        let [bl, br, tr, tl] = cell.map(|v| self.points[v as usize]);
        self.points.push(bl.lerp(br, x).lerp(tl.lerp(tr, x), y));
        self.points.len() as u32 - 1
    }

    fn face(&mut self, away: usize, vertices: &[u32]) {
        self.faces.push(vertices.to_vec());
        self.away.push(away);
    }

    /// Lines from the bottom edge to the top edge of the quad BL BR TR TL.
    fn straight(&mut self, away: usize, [bl, br, tr, tl]: [u32; 4]) {
        let (b, t) = (self.three(bl, br), self.three(tl, tr));
        let (low, high) = ([bl, b[0], b[1], b[2], br], [tl, t[0], t[1], t[2], tr]);
        (0..4).for_each(|i| self.face(away, &[low[i], low[i + 1], high[i + 1], high[i]]));
    }

    /// Lines from the bottom edge to the left edge.
    fn corner(&mut self, cell @ [bl, br, tr, tl]: [u32; 4]) {
        let (b, l) = (self.three(bl, br), self.three(bl, tl));
        let q = [0.5 - self.width, 0.5, 0.5 + self.width].map(|t| self.inner(cell, t, t));
        self.face(0, &[bl, b[0], q[0], l[0]]);
        for i in 0..2 {
            self.face(0, &[b[i], b[i + 1], q[i + 1], q[i]]);
            self.face(0, &[l[i], q[i], q[i + 1], l[i + 1]]);
        }
        self.face(0, &[b[2], br, tr, q[2]]);
        self.face(0, &[q[2], tr, tl, l[2]]);
    }

    fn crossing(&mut self, cell @ [bl, br, tr, tl]: [u32; 4]) {
        let t = [0.5 - self.width, 0.5, 0.5 + self.width];
        let (b, u) = (self.three(bl, br), self.three(tl, tr));
        let (l, r) = (self.three(bl, tl), self.three(br, tr));
        let mut rows = vec![[bl, b[0], b[1], b[2], br]];
        for j in 0..3 {
            let c = t.map(|x| self.inner(cell, x, t[j]));
            rows.push([l[j], c[0], c[1], c[2], r[j]]);
        }
        rows.push([tl, u[0], u[1], u[2], tr]);
        for pair in rows.windows(2) {
            (0..4).for_each(|i| self.face(0, &[pair[0][i], pair[0][i + 1], pair[1][i + 1], pair[1][i]]));
        }
    }

    /// Pattern T-DE: the stem comes from the bottom, the bar runs from left to right; one pentagon above.
    fn tee(&mut self, cell @ [bl, br, tr, tl]: [u32; 4]) {
        let w = self.width;
        let (t1, t3) = (0.5 - w, 0.5 + w);
        let (p, m) = ((0.5 * w).min(0.04), (0.2 * w).min(0.03));
        let (b, l, r) = (self.three(bl, br), self.three(bl, tl), self.three(br, tr));
        let ia = self.inner(cell, t1 + p, t1 + p);
        let ib = self.inner(cell, t3 - p, t1 + p);
        let im = self.inner(cell, 0.5, 0.5 + m);
        let iu = self.inner(cell, 0.5, t3);
        let faces: [&[u32]; 9] = [
            &[bl, b[0], ia, l[0]],
            &[b[0], b[1], im, ia],
            &[b[1], b[2], ib, im],
            &[b[2], br, r[0], ib],
            &[l[0], ia, im, l[1]],
            &[ib, r[0], r[1], im],
            &[l[1], im, iu, l[2]],
            &[im, r[1], r[2], iu],
            &[l[2], iu, r[2], tr, tl],
        ];
        faces.into_iter().for_each(|face| self.face(0, face));
    }
}

impl Case {
    pub fn new(base: Base, radius: f64, pattern: Pattern, width: f64) -> Self {
        let at = |i: usize, j: usize| (j * (SIDE + 1) + i) as u32;
        let points: Vec<DVec3> =
            (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| base.point(radius, i, j))).collect();
        let mut builder = Builder {
            points: points.clone(),
            faces: Vec::new(),
            away: Vec::new(),
            cuts: HashMap::new(),
            width,
        };
        let mut plain = Polygons { positions: points, ..Polygons::default() };
        for (i, j) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j))) {
            let cell @ [bl, br, tr, tl] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            plain.face_sizes.push(4);
            plain.face_vertices.extend(cell);
            let away = i.abs_diff(MIDDLE).max(j.abs_diff(MIDDLE));
            let (in_column, in_row) = (i == MIDDLE, j == MIDDLE);
            let upright =
                in_column && (j < MIDDLE || matches!(pattern, Pattern::Straight | Pattern::Crossing));
            let across = in_row && (i < MIDDLE || matches!(pattern, Pattern::Crossing | Pattern::Tee));
            match (upright, in_column && in_row, across && pattern != Pattern::Straight) {
                (_, true, _) if pattern == Pattern::Corner => builder.corner(cell),
                (_, true, _) if pattern == Pattern::Crossing => builder.crossing(cell),
                (_, true, _) if pattern == Pattern::Tee => builder.tee(cell),
                (true, ..) => builder.straight(away, cell),
                (_, _, true) => builder.straight(away, [tl, bl, br, tr]),
                _ => builder.face(away, &cell),
            }
        }
        let faces: Vec<&[u32]> = builder.faces.iter().map(Vec::as_slice).collect();
        Self {
            before: Mesh::from_polygons(&plain).expect("a sheet"),
            after: Mesh::from_polygons(&Polygons::new(builder.points, &faces)).expect("a sheet with a band"),
            away: builder.away,
        }
    }

    /// The faces that the band changed.
    pub fn changed(&self) -> Vec<welt::mesh::FaceId> {
        let bound = self.before.vertex_bound() as u32;
        self.after.faces().filter(|&f| self.after.face_vertices(f).any(|v| v.0 >= bound)).collect()
    }
}

/// Cells away from the junction that are looked at.
const WITHIN: usize = 4;
/// Half width of the control band.
pub const WIDTH: f64 = 0.15;

/// Deviation near the junction, and the time of the fit in milliseconds.
pub fn measure(case: &Case, method: Method) -> (Deviation, f64) {
    let faces: Vec<FaceId> = case.before.faces().collect();
    let target = Target::freeze(&case.before, &faces, &Job::new()).expect("not cancelled");
    let mut after = case.after.clone();
    let active = active_set(&after, &case.changed(), method);
    let start = Instant::now();
    fit(&mut after, &active, &target, method, &Job::new()).expect("not cancelled");
    let time = start.elapsed().as_secs_f64() * 1e3;
    // Vertices that were inserted on edges keep their places along them: the width of a band depends on it.
    if method == Method::FitSlide {
        let bound = case.before.vertex_bound();
        let moved = |v: &VertexId| after.position(*v) != case.after.position(*v);
        assert!(after.vertices().filter(|v| v.index() < bound).any(|v| moved(&v)));
    }
    let now = LimitSurface::new(&after);
    let near = |f: FaceId| case.away[f.index()] <= WITHIN;
    let samples = deviation_samples(&now, near, &target.surface, Sampling::default(), &Job::new());
    (Deviation::of(&samples.expect("not cancelled")).expect("memory"), time)
}
