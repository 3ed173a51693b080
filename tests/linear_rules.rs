//! The rules of linear features with other numbers of lines than three: topology by counting.

use glam::DVec3;
use welt::feature;
use welt::grammar::{self, RunOptions};
use welt::mesh::{HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};

const SIDE: u32 = 5;

fn sheet() -> Mesh {
    let mut polygons = Polygons::default();
    for (i, j) in (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| (i, j))) {
        polygons.positions.push(DVec3::new(i.into(), j.into(), 0.0));
        if i < SIDE && j < SIDE {
            let a = j * (SIDE + 1) + i;
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend([a, a + 1, a + SIDE + 2, a + SIDE + 1]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a sheet")
}

/// Prepares an edge as the feature stage does, with `lines` lines spread over it.
fn mark(mesh: &mut Mesh, index: usize, from: (u32, u32), to: (u32, u32), lines: usize) {
    let at = |(i, j): (u32, u32)| VertexId(j * (SIDE + 1) + i);
    let h = mesh.find_half_edge(at(from), at(to)).expect("an edge");
    let places: Vec<f64> = (1..=lines).map(|k| k as f64 / (lines + 1) as f64).collect();
    let names = ["cuts", "lines", "mark", "color", "t"].map(|name| mesh.intern(name));
    let forward: Vec<f64> = (1..=lines).map(|line| line as f64).collect();
    let backward: Vec<f64> = forward.iter().rev().copied().collect();
    for (h, numbers) in [(h, forward), (HalfEdgeId(h.0 ^ 1), backward)] {
        let values = [
            Value::Numbers(places.clone().into()),
            Value::Numbers(numbers.into()),
            Value::Number(index as f64),
            Value::text("red"),
            Value::Number(0.5),
        ];
        for (name, value) in names.into_iter().zip(values) {
            mesh.set_attribute(Node::HalfEdge(h), name, Some(value));
        }
    }
}

/// Runs the rules; returns the new vertices and the faces that are no quads.
fn run(mesh: &mut Mesh) -> (usize, Vec<usize>) {
    let before = mesh.vertex_bound();
    let rules = feature::linear_rules().expect("rules");
    grammar::run(&rules, mesh, &RunOptions::default()).expect("the rules run");
    mesh.validate_control_mesh().expect("valid");
    let others = mesh.faces().map(|f| mesh.arity(f)).filter(|&arity| arity != 4).collect();
    (mesh.vertex_bound() - before, others)
}

#[test]
fn straight_bands_of_any_number_of_lines() {
    for lines in [1, 2, 3, 4, 5, 8] {
        let mut mesh = sheet();
        for j in 0..=SIDE {
            mark(&mut mesh, j as usize, (2, j), (3, j), lines);
        }
        let expected = (SIDE as usize + 1) * lines;
        assert_eq!(run(&mut mesh), (expected, vec![]), "{lines} lines");
        // Every row has as many quads more as there are lines.
        assert_eq!(mesh.face_bound(), (SIDE * SIDE) as usize + SIDE as usize * lines);
    }
}

#[test]
fn corners_of_any_number_of_lines() {
    for lines in [1, 2, 3, 5] {
        let mut mesh = sheet();
        for j in 0..=2 {
            mark(&mut mesh, j as usize, (2, j), (3, j), lines);
        }
        for i in 3..=SIDE {
            mark(&mut mesh, i as usize, (i, 2), (i, 3), lines);
        }
        // Six marks and the diagonal.
        assert_eq!(run(&mut mesh), (7 * lines, vec![]), "{lines} lines");
    }
}

#[test]
fn crossings_of_different_numbers_of_lines() {
    for (columns, rows) in [(1, 1), (3, 3), (2, 3), (2, 4), (1, 5)] {
        let mut mesh = sheet();
        for k in 0..=SIDE {
            mark(&mut mesh, k as usize, (2, k), (3, k), columns);
            mark(&mut mesh, k as usize, (k, 2), (k, 3), rows);
        }
        let expected = (SIDE as usize + 1) * (columns + rows) + columns * rows;
        assert_eq!(run(&mut mesh), (expected, vec![]), "{columns} x {rows}");
        // The inner vertices lie on a grid.
        let inside = |x: f64| x > 2.0 && x < 3.0;
        let mut found: Vec<(i64, i64)> = mesh
            .positions()
            .iter()
            .filter(|p| inside(p.x) && inside(p.y))
            .map(|p| ((p.x * 1e9).round() as i64, (p.y * 1e9).round() as i64))
            .collect();
        found.sort_unstable();
        let place = |k: usize, count: usize| ((2.0 + k as f64 / (count + 1) as f64) * 1e9).round() as i64;
        let mut grid: Vec<(i64, i64)> = (1..=columns)
            .flat_map(|a| (1..=rows).map(move |b| (a, b)))
            .map(|(a, b)| (place(a, columns), place(b, rows)))
            .collect();
        grid.sort_unstable();
        assert_eq!(found, grid, "{columns} x {rows}");
    }
}
