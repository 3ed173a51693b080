//! Features on sheets of quads whose ideal shape is known, and how far their limit surfaces are from it.
//!
//! Written from the definitions, apart from the pipeline of the library: marks are placed, heights solved and errors
//! taken here; only the rules, the fit and the evaluation are the library's.

#![allow(dead_code, reason = "not every program that shares this module uses all of it")]

use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use welt::grammar::{self, RuleSet, RunOptions};
use welt::job::Job;
use welt::mesh::{Domain, FaceId, HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};
use welt::optimise::{self, Method, Target};
use welt::subdivision::{limit_mask, limit_normal};
use welt::surface::LimitSurface;

/// The cross-section of a band: places in half widths, heights over the base in units of its depth.
#[derive(Clone, Debug)]
pub struct Band {
    /// Half width of the control band, in edges.
    pub half: f64,
    pub depth: f64,
    pub lines: Vec<(f64, Option<f64>)>,
    pub kind: &'static str,
}

impl Band {
    pub fn groove(half: f64, depth: f64) -> Self {
        Self { half, depth, lines: vec![(-1.0, None), (0.0, Some(-1.0)), (1.0, None)], kind: "groove" }
    }

    /// Two rims and a flat bottom: control heights 48/46 of the depth, limits at the lines 5/6 of that.
    pub fn channel(half: f64, depth: f64) -> Self {
        const AT_LINES: f64 = -5.0 / 6.0 * 48.0 / 46.0;
        let lines = vec![(-1.0, None), (-0.4, Some(AT_LINES)), (0.4, Some(AT_LINES)), (1.0, None)];
        Self { half, depth, lines, kind: "channel" }
    }

    pub fn piping(half: f64, depth: f64) -> Self {
        let lines = [(-1.0, 0.0), (-0.55, -1.0), (0.0, 1.0), (0.55, -1.0), (1.0, 0.0)];
        Self { half, depth, lines: lines.map(|(x, h)| (x, Some(h))).to_vec(), kind: "piping" }
    }

    pub fn parity() -> Self {
        Self { half: 0.0, depth: 0.0, lines: vec![(0.0, None)], kind: "parity" }
    }

    /// Control heights of the lines of a straight band: its limit at the lines has their heights.
    fn control(&self) -> Vec<f64> {
        let free: Vec<usize> = (0..self.lines.len()).filter(|&i| self.lines[i].1.is_some()).collect();
        let weight = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 4.0 / 6.0,
            1 => 1.0 / 6.0,
            _ => 0.0,
        };
        let rows = free.iter().map(|&i| free.iter().map(|&j| weight(i, j)).collect()).collect();
        let right = free.iter().filter_map(|&i| Some(self.lines[i].1? * self.depth)).collect();
        let mut control = vec![0.0; self.lines.len()];
        free.iter().zip(solve(rows, right)).for_each(|(&i, height)| control[i] = height);
        control
    }

    /// Height of the straight band's limit surface at some places across it, in edges, ascending from 0: a uniform
    /// cubic B-spline whose control points are the lines and the rows of vertices beside them. Distance, height, and
    /// mean curvature of the cylinder.
    fn section(&self) -> Vec<[f64; 3]> {
        let across: Vec<f64> = (-3..0)
            .map(|i| f64::from(i) + 0.5)
            .chain(self.lines.iter().map(|line| line.0 * self.half))
            .chain((0..3).map(|i| f64::from(i) + 0.5))
            .collect();
        let control: Vec<f64> = [0.0; 3].into_iter().chain(self.control()).chain([0.0; 3]).collect();
        let mut table = Vec::new();
        for i in 1..control.len() - 2 {
            for s in 0..200 {
                let t = f64::from(s) / 200.0;
                let b = [
                    (1.0 - t).powi(3) / 6.0,
                    (3.0 * t.powi(3) - 6.0 * t * t + 4.0) / 6.0,
                    (-3.0 * t.powi(3) + 3.0 * t * t + 3.0 * t + 1.0) / 6.0,
                    t.powi(3) / 6.0,
                ];
                let first = [
                    -(1.0 - t).powi(2) / 2.0,
                    (3.0 * t * t - 4.0 * t) / 2.0,
                    (-3.0 * t * t + 2.0 * t + 1.0) / 2.0,
                    t * t / 2.0,
                ];
                let second = [1.0 - t, 3.0 * t - 2.0, 1.0 - 3.0 * t, t];
                let sum = |b: &[f64], values: &[f64]| (0..4).map(|k| b[k] * values[i - 1 + k]).sum::<f64>();
                let [x, dx, ddx] = [b, first, second].map(|b| sum(&b, &across));
                let [z, dz, ddz] = [b, first, second].map(|b| sum(&b, &control));
                if x >= -1e-12 {
                    table.push([x, z, (dx * ddz - dz * ddx) / (dx * dx + dz * dz).powf(1.5) / 2.0]);
                }
            }
        }
        table
    }
}

/// Gaussian elimination with pivots.
pub fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs())).expect("a row");
        rows.swap(i, pivot);
        right.swap(i, pivot);
        let (upper, lower) = rows.split_at_mut(i + 1);
        for (k, row) in lower.iter_mut().enumerate() {
            let factor = row[i] / upper[i][i];
            if factor != 0.0 {
                row.iter_mut().zip(&upper[i]).skip(i).for_each(|(a, b)| *a -= factor * b);
                right[i + 1 + k] -= factor * right[i];
            }
        }
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|j| rows[i][j] * right[j]).sum();
        right[i] = (right[i] - sum) / rows[i][i];
    }
    right
}

/// A mark: the edge between two vertices, and which band crosses it.
pub type Marked = (VertexId, VertexId, usize);

/// Cells along each side of a sheet.
pub const SIDE: u32 = 7;

/// Vertex of grid point (i, j).
pub fn at(i: u32, j: u32) -> VertexId {
    VertexId(j * (SIDE + 1) + i)
}

/// A sheet whose grid point (i, j) stands at `shape(i, j)`.
pub fn sheet(shape: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let mut polygons = Polygons::default();
    for (j, i) in (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| (j, i))) {
        polygons.positions.push(shape(i.into(), j.into()));
        if i < SIDE && j < SIDE {
            polygons.face_sizes.push(4);
            polygons
                .face_vertices
                .extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(|v| v.0));
        }
    }
    Mesh::from_polygons(&polygons).expect("a sheet")
}

/// Marks of a band that runs upwards between grid columns i and i + 1, over rows of grid points.
pub fn upwards(i: u32, rows: std::ops::RangeInclusive<u32>, band: usize) -> Vec<Marked> {
    rows.map(|j| (at(i, j), at(i + 1, j), band)).collect()
}

/// Marks of a band that runs sideways between grid rows j and j + 1.
pub fn sideways(j: u32, columns: std::ops::RangeInclusive<u32>, band: usize) -> Vec<Marked> {
    columns.map(|i| (at(i, j + 1), at(i, j), band)).collect()
}

/// A sheet with features.
pub struct Applied {
    /// After the fit, before heights.
    pub base: Mesh,
    pub mesh: Mesh,
    pub greens: Vec<VertexId>,
    /// Rules that were applied other than `Split` and `Straight`.
    pub fired: Vec<String>,
}

impl Applied {
    pub fn non_quads(&self) -> Vec<usize> {
        self.mesh.faces().map(|f| self.mesh.arity(f)).filter(|&n| n != 4).collect()
    }
}

/// Runs the rules on the marks, fits, and solves the heights: limit points of vertices on lines have the asked heights
/// along the normals; `hold` fixes a control height as a part of the straight band's.
pub fn apply(
    rules: &RuleSet,
    mut mesh: Mesh,
    bands: &[Band],
    marks: &[Marked],
    method: Method,
    set: &[(&str, f64)],
) -> Applied {
    let faces: Vec<FaceId> = mesh.faces().collect();
    let target =
        (method != Method::None).then(|| Target::freeze(&mesh, &faces, &Job::new()).expect("not cancelled"));
    let names = ["cuts", "lines", "mark", "color", "t"].map(|name| mesh.intern(name));
    for (number, &(from, to, band)) in marks.iter().enumerate() {
        let h = mesh.find_half_edge(from, to).expect("an edge");
        let band = &bands[band];
        let forward: Vec<f64> = band.lines.iter().map(|line| 0.5 + line.0 * band.half).collect();
        let lines: Vec<f64> = (1..=forward.len()).map(|line| line as f64).collect();
        let reversed = |values: &[f64]| values.iter().rev().copied().collect::<Vec<f64>>();
        let backward: Vec<f64> = forward.iter().rev().map(|t| 1.0 - t).collect();
        for (h, cuts, lines) in
            [(h, forward, lines.clone()), (HalfEdgeId(h.0 ^ 1), backward, reversed(&lines))]
        {
            let values = [
                Value::Numbers(cuts.into()),
                Value::Numbers(lines.into()),
                Value::Number(number as f64),
                Value::text(band.kind),
                Value::Number(0.5),
            ];
            for (name, value) in names.into_iter().zip(values) {
                mesh.set_attribute(Node::HalfEdge(h), name, Some(value));
            }
        }
    }
    let parameters: BTreeMap<String, f64> = set.iter().map(|&(name, x)| (name.to_owned(), x)).collect();
    let options = RunOptions { parameters, ..RunOptions::default() };
    let outcome = grammar::run(rules, &mut mesh, &options).unwrap_or_else(|error| panic!("{error}"));
    mesh.validate_control_mesh().expect("valid");
    if let Some(target) = &target {
        let active = optimise::active_set(&mesh, &outcome.touched, method);
        optimise::fit(&mut mesh, &active, target, method, &Job::new()).expect("a fit");
    }
    let base = mesh.clone();
    let greens = raise(&mut mesh, bands);
    let fired = outcome
        .applications
        .into_iter()
        .filter(|(name, count)| *count > 0 && !["Split", "Straight"].contains(&name.as_str()))
        .map(|(name, _)| name)
        .collect();
    Applied { base, mesh, greens, fired }
}

fn raise(mesh: &mut Mesh, bands: &[Band]) -> Vec<VertexId> {
    let text = |mesh: &Mesh, v: VertexId, name: &str| {
        mesh.attribute_named(Node::Vertex(v), name).and_then(|value| Some(value.as_text()?.to_owned()))
    };
    let number = |mesh: &Mesh, v: VertexId, name: &str| {
        mesh.attribute_named(Node::Vertex(v), name).and_then(Value::as_number)
    };
    let line = mesh.intern("line");
    let mut greens = Vec::new();
    for v in mesh.nodes_with_attribute(Domain::Vertex, line).into_iter().map(VertexId) {
        let height = |line: &str, kind: &str| {
            let kind = text(mesh, v, kind)?;
            let band = bands.iter().find(|band| band.kind == kind)?;
            Some(band.lines[number(mesh, v, line)? as usize - 1].1? * band.depth)
        };
        let height = [height("line", "kind"), height("cross", "crosskind")]
            .into_iter()
            .flatten()
            .max_by(|a, b| a.abs().total_cmp(&b.abs()));
        if let Some(height) = height {
            greens.push((v, height, number(mesh, v, "hold"), limit_normal(mesh, v).expect("a normal")));
        }
    }
    let straight = |v: VertexId| {
        let kind = text(mesh, v, "kind")?;
        let band = bands.iter().find(|band| band.kind == kind)?;
        band.control().get(number(mesh, v, "line")? as usize - 1).copied()
    };
    let held: Vec<Option<f64>> = greens.iter().map(|g| Some(g.2? * straight(g.0)?)).collect();
    let free: Vec<usize> = (0..greens.len()).filter(|&i| held[i].is_none()).collect();
    let mut rows = vec![vec![0.0; free.len()]; free.len()];
    let mut right: Vec<f64> = free.iter().map(|&i| greens[i].1).collect();
    for (row, &i) in free.iter().enumerate() {
        for (v, weight) in limit_mask(mesh, greens[i].0) {
            let Ok(j) = greens.binary_search_by_key(&v, |g| g.0) else { continue };
            let part = weight * greens[i].3.dot(greens[j].3);
            match held[j] {
                Some(height) => right[row] -= part * height,
                None => rows[row][free.binary_search(&j).expect("free")] += part,
            }
        }
    }
    let heights = solve(rows, right);
    let shifts = free.iter().zip(heights).map(|(&i, h)| (i, h));
    let shifts: Vec<(usize, f64)> =
        shifts.chain(held.iter().enumerate().filter_map(|(i, h)| Some((i, (*h)?)))).collect();
    for (i, height) in shifts {
        mesh.set_position(greens[i].0, mesh.position(greens[i].0) + greens[i].3 * height);
    }
    greens.into_iter().map(|green| green.0).collect()
}

/// A straight part of a centre line, in grid coordinates, and its band.
pub type Line = (DVec2, DVec2, usize);

pub fn line(a: [f64; 2], b: [f64; 2], band: usize) -> Line {
    (DVec2::from(a), DVec2::from(b), band)
}

/// The ideal: the height of the band that is farthest from the base at a point, each by its distance. With equal
/// sections this is the sharp union.
pub struct Ideal {
    sections: Vec<Vec<[f64; 3]>>,
    lines: Vec<Line>,
    /// The sides of a cell of the grid.
    cell: [DVec2; 2],
}

impl Ideal {
    pub fn new(bands: &[Band], lines: Vec<Line>) -> Self {
        Self { sections: bands.iter().map(Band::section).collect(), lines, cell: [DVec2::X, DVec2::Y] }
    }

    /// On a sheet whose cells have the sides (1, 0) and `v`, also of length 1.
    pub fn sheared(self, v: DVec2) -> Self {
        Self { cell: [DVec2::X, v], ..self }
    }

    /// Distance from a line, in edges that stand at a right angle to it.
    fn distance(&self, p: DVec2, (a, b, _): &Line) -> f64 {
        let [p, a, b] = [p, *a, *b].map(|p| self.cell[0] * p.x + self.cell[1] * p.y);
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (p - a.lerp(b, t)).length() / self.cell[0].perp_dot(self.cell[1])
    }

    /// Height and mean curvature.
    pub fn at(&self, p: DVec2) -> [f64; 2] {
        let found = self.lines.iter().map(|line| {
            let (table, x) = (&self.sections[line.2], self.distance(p, line));
            let i = table.partition_point(|entry| entry[0] <= x);
            if i == table.len() {
                return [0.0; 2];
            }
            let (a, b) = (table[i.max(1) - 1], table[i.max(1)]);
            let t = (x - a[0]) / (b[0] - a[0]).max(1e-300);
            [1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
        });
        found.max_by(|a, b| a[0].abs().total_cmp(&b[0].abs())).unwrap_or_default()
    }
}

/// A sample of a displaced limit surface.
pub struct Sample {
    /// Place on the sheet in grid coordinates.
    pub at: DVec2,
    /// Height over the base along its normal.
    pub height: f64,
    /// Mean curvature.
    pub curvature: f64,
    /// Area of the sheet it stands for.
    pub area: f64,
}

/// Samples of the faces whose middles lie within `reach` of `centre` in each direction. `flat` is the same sheet made
/// flat: it says where on the grid a point belongs.
pub fn samples(applied: &Applied, flat: &Mesh, centre: DVec2, reach: f64, per_side: usize) -> Vec<Sample> {
    let mut samples = Vec::new();
    let surfaces = [flat, &applied.base, &applied.mesh].map(LimitSurface::new);
    for f in flat.faces() {
        let count = flat.arity(f);
        let middle = flat.face_vertices(f).map(|v| flat.position(v)).sum::<DVec3>() / count as f64;
        if (middle.truncate() - centre).abs().max_element() > reach {
            continue;
        }
        let (quadrants, n) = if count == 4 { (1, per_side) } else { (count, per_side.div_ceil(2)) };
        for (corner, a, b) in
            (0..quadrants).flat_map(|c| (0..n).flat_map(move |a| (0..n).map(move |b| (c, a, b))))
        {
            let [u, v] = [a, b].map(|k| (k as f64 + 0.5) / n as f64);
            let [grid, base, point] =
                surfaces.each_ref().map(|surface| surface.evaluate(f, corner, u, v).expect("a point"));
            let curvature = point.second.map_or(0.0, |d| {
                let (e, g, m) = (point.du.dot(point.du), point.dv.dot(point.dv), point.du.dot(point.dv));
                let [l, mm, nn] = [d.uu, d.uv, d.vv].map(|x| x.dot(point.normal));
                (e * nn - 2.0 * m * mm + g * l) / (2.0 * (e * g - m * m))
            });
            samples.push(Sample {
                at: grid.position.truncate(),
                height: (point.position - base.position).dot(base.normal),
                curvature,
                area: grid.du.cross(grid.dv).length() / (n * n) as f64,
            });
        }
    }
    samples
}

/// Root of the mean square, weighted by area, and greatest size.
pub fn size(values: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let (mut square, mut area, mut max) = (0.0, 0.0, 0.0_f64);
    for (value, weight) in values {
        square += value * value * weight;
        area += weight;
        max = max.max(value.abs());
    }
    [(square / f64::max(area, 1e-300)).sqrt(), max]
}

/// Error of the height in the face around `centre`, as a part of `depth`: rms and greatest.
pub fn error(samples: &[Sample], ideal: &Ideal, centre: DVec2, depth: f64) -> [f64; 2] {
    let inside = samples.iter().filter(|s| (s.at - centre).abs().max_element() < 0.5);
    size(inside.map(|s| ((s.height - ideal.at(s.at)[0]) / depth, s.area)))
}

/// Error over all samples against a band whose end is moved to where the error is least, and that end.
pub fn fitted_end(samples: &[Sample], bands: &[Band], line: Line, depth: f64) -> ([f64; 2], DVec2) {
    let direction = (line.1 - line.0).normalize();
    (0..160)
        .map(|k| {
            let end = line.1 + direction * (f64::from(k) / 200.0 - 0.4);
            let ideal = Ideal::new(bands, vec![(line.0, end, line.2)]);
            (size(samples.iter().map(|s| ((s.height - ideal.at(s.at)[0]) / depth, s.area))), end)
        })
        .min_by(|a, b| a.0[0].total_cmp(&b.0[0]))
        .expect("candidates")
}

/// Error of the mean curvature on a flat sheet, at more than `clear` from all centre lines; rms and greatest.
pub fn curvature_error(samples: &[Sample], ideal: &Ideal, clear: f64) -> [f64; 2] {
    let outside =
        samples.iter().filter(|s| ideal.lines.iter().all(|line| ideal.distance(s.at, line) > clear));
    size(outside.map(|s| (s.curvature - ideal.at(s.at)[1], s.area)))
}

/// Least and greatest of the deepest points along a line, in slices: what one sees along a valley. Positive downwards,
/// as a part of `depth`.
pub fn valley(samples: &[Sample], from: DVec2, to: DVec2, beside: f64, depth: f64) -> [f64; 2] {
    const SLICES: usize = 16;
    let along = (to - from).normalize();
    let length = (to - from).length();
    let mut deepest = [0.0_f64; SLICES];
    for s in samples {
        let x = (s.at - from).dot(along);
        if (0.0..length).contains(&x) && (s.at - from).perp_dot(along).abs() < beside {
            let slice = &mut deepest[((x / length * SLICES as f64) as usize).min(SLICES - 1)];
            *slice = slice.max(-s.height / depth);
        }
    }
    [deepest.iter().copied().fold(f64::INFINITY, f64::min), deepest.iter().copied().fold(0.0, f64::max)]
}
