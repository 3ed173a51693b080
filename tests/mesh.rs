//! The half-edge kernel: building, Euler operators, undo, compaction.

use glam::DVec3;
use proptest::prelude::*;
use welt::mesh::{Defect, EulerError, HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};

/// A grid of `n` x `m` unit quads.
fn grid(n: u32, m: u32) -> Polygons {
    let positions = (0..=m).flat_map(|y| (0..=n).map(move |x| DVec3::new(x.into(), y.into(), 0.0))).collect();
    let at = |x: u32, y: u32| y * (n + 1) + x;
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for (x, y) in (0..m).flat_map(|y| (0..n).map(move |x| (x, y))) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
    }
    polygons
}

fn cube() -> Polygons {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into())).collect();
    Polygons::new(
        positions,
        &[&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]],
    )
}

fn build(polygons: &Polygons) -> Mesh {
    let mesh = Mesh::from_polygons(polygons).expect("a good mesh");
    mesh.validate_control_mesh().expect("valid");
    mesh
}

/// V - E + F, boundary loops counted as faces.
fn euler_characteristic(mesh: &Mesh) -> i64 {
    let [v, e, f] = mesh.counts();
    v as i64 - e as i64 + f as i64 + mesh.boundary_loops().count() as i64
}

#[test]
fn a_cube_has_its_euler_characteristic_and_neighbours() {
    let mesh = build(&cube());
    assert_eq!(mesh.counts(), [8, 12, 6]);
    assert_eq!(euler_characteristic(&mesh), 2);
    assert!(mesh.vertices().all(|v| mesh.valence(v) == 3 && !mesh.is_boundary_vertex(v)));
    let h = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("an edge");
    assert_eq!((mesh.source(h), mesh.target(h)), (VertexId(0), VertexId(1)));
    assert!(mesh.find_half_edge(VertexId(0), VertexId(7)).is_none());
}

#[test]
fn a_grid_has_one_boundary_loop() {
    let mesh = build(&grid(5, 3));
    assert_eq!(mesh.counts(), [24, 38, 15]);
    let loops: Vec<_> = mesh.boundary_loops().collect();
    assert_eq!(loops.len(), 1);
    assert_eq!(mesh.arity(loops[0]), 16);
    assert_eq!(mesh.to_polygons(), grid(5, 3));
}

#[test]
fn what_the_kernel_cannot_hold_is_listed() {
    let square = || (0..6).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect::<Vec<_>>();
    let defects = |faces: &[&[u32]]| {
        Mesh::from_polygons(&Polygons::new(square(), faces)).map_err(|e| e.0).expect_err("defects")
    };
    assert_eq!(defects(&[&[0, 1]]), [Defect::TooFewVertices { face: 0, size: 2 }]);
    assert_eq!(defects(&[&[0, 1, 1]]), [Defect::RepeatedVertex { face: 0, vertex: 1 }]);
    assert_eq!(defects(&[&[0, 1, 9]]), [Defect::VertexOutOfRange { face: 0, vertex: 9 }]);
    assert_eq!(
        defects(&[&[0, 1, 2], &[0, 1, 3]]),
        [Defect::InconsistentOrientation { edge: (0, 1), faces: vec![0, 1] }]
    );
    assert_eq!(
        defects(&[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]),
        [Defect::EdgeWithManyFaces { edge: (0, 1), faces: vec![0, 1, 2] }]
    );
    assert_eq!(defects(&[&[0, 1, 2], &[0, 3, 4]]), [Defect::SeparateFans { vertex: 0, fans: 2 }]);
    let mut polygons = Polygons::new(square(), &[&[0, 1, 2]]);
    polygons.positions[5].y = f64::NAN;
    let found = Mesh::from_polygons(&polygons).map_err(|e| e.0).expect_err("a defect");
    assert_eq!(found, [Defect::NotFinite { vertex: 5 }]);
}

#[test]
fn splitting_an_edge_and_a_face() {
    let mut mesh = build(&grid(1, 1));
    let e = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("an edge");
    mesh.set_edge_sharpness(e, 3.0);
    let first = mesh.split_edge(e, DVec3::new(0.5, 0.0, 0.0)).expect("split");
    mesh.validate_control_mesh().expect("valid");
    assert_eq!((mesh.source(first), mesh.target(first)), (VertexId(0), VertexId(4)));
    assert_eq!((mesh.source(e), mesh.next(first)), (VertexId(4), e));
    assert_eq!((mesh.edge_sharpness(first), mesh.edge_sharpness(e)), (3.0, 3.0));
    // New face: P -> B -> C, closed by C -> P.
    let across = mesh.next(mesh.next(e));
    let n = mesh.make_ef(e, across).expect("a new edge");
    assert_eq!((mesh.source(n), mesh.target(n)), (mesh.source(across), VertexId(4)));
    assert_eq!(mesh.arity(mesh.face(n)), 3);
    assert_eq!(mesh.arity(mesh.face(n.mate())), 4);
    mesh.validate_control_mesh().expect("valid");
    mesh.kill_ef(n).expect("gone");
    mesh.kill_ev(first.mate()).expect("gone");
    mesh.validate_control_mesh().expect("valid");
    mesh.compact();
    assert_eq!(mesh.counts(), [4, 4, 1]);
}

#[test]
fn preconditions_are_errors() {
    let mut mesh = build(&grid(2, 1));
    let before = mesh.to_polygons();
    let h = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("an edge");
    let other = mesh.find_half_edge(VertexId(1), VertexId(2)).expect("an edge");
    let p = DVec3::ZERO;
    assert_eq!(mesh.make_ef(h, other), Err(EulerError::DifferentFaces(h, other)));
    assert_eq!(mesh.make_ef(h, h), Err(EulerError::LoopEdge(h, h, VertexId(0))));
    assert!(matches!(mesh.make_ev(h, other, p), Err(EulerError::DifferentVertices(..))));
    assert_eq!(mesh.make_ev(h, h, DVec3::NAN), Err(EulerError::NotFinite));
    assert_eq!(mesh.make_ev_one(h.mate(), p), Err(EulerError::Outside(h.mate())));
    assert_eq!(mesh.kill_ef(h), Err(EulerError::BoundaryFace(h)));
    assert_eq!(mesh.kill_vefs(h), Err(EulerError::NotSingleEdge(h)));
    let gone = HalfEdgeId(9999);
    assert_eq!(mesh.kill_ev(gone), Err(EulerError::NoSuchHalfEdge(gone)));
    assert_eq!(mesh.to_polygons(), before);
}

#[test]
fn a_shell_grows_from_one_edge() {
    let mut mesh = Mesh::default();
    let corner = |i: u32| DVec3::new((i & 1).into(), (i >> 1).into(), 0.0);
    let e = mesh.make_vefs(corner(0), corner(1)).expect("a shell");
    mesh.validate().expect("valid");
    assert_eq!(euler_characteristic(&mesh), 2);
    assert_eq!(mesh.position(mesh.source(e)), corner(1));
    // e runs p1 -> p0; an antenna at p1, closed to p0: two triangles back to back.
    let n = mesh.make_ev_one(e, corner(3)).expect("antenna");
    assert_eq!((mesh.position(mesh.source(n)), mesh.target(n)), (corner(3), mesh.source(e)));
    let closing = mesh.make_ef(mesh.next(e), n).expect("closed");
    mesh.validate_control_mesh().expect("valid");
    assert_eq!(mesh.counts(), [3, 3, 2]);
    mesh.kill_ef(closing).expect("open");
    mesh.kill_ev(n).expect("short");
    mesh.kill_vefs(e).expect("empty");
    mesh.compact();
    assert_eq!(mesh.counts(), [0, 0, 0]);
}

/// Everything a mesh holds, as comparable text.
fn snapshot(mesh: &Mesh) -> String {
    let mut lines = vec![format!("{:?}", mesh.to_polygons())];
    for h in mesh.half_edges() {
        lines.push(format!(
            "{h:?} {:?} {:?} {:?} {:?}",
            mesh.next(h),
            mesh.source(h),
            mesh.face(h),
            mesh.edge_sharpness(h)
        ));
        for name in mesh.attribute_names(Node::HalfEdge(h)) {
            lines.push(format!("{name:?} {:?}", mesh.attribute(Node::HalfEdge(h), name)));
        }
    }
    lines.push(format!("{:?}", mesh.counts()));
    lines.join("\n")
}

#[derive(Clone, Debug)]
enum Step {
    Split(u32),
    Antenna(u32),
    JoinFace(u32, u32),
    KillEdge(u32),
    KillVertex(u32),
    Move(u32),
    Mark(u32),
    Crease(u32),
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        any::<u32>().prop_map(Step::Split),
        any::<u32>().prop_map(Step::Antenna),
        (any::<u32>(), 1u32..6).prop_map(|(a, b)| Step::JoinFace(a, b)),
        any::<u32>().prop_map(Step::KillEdge),
        any::<u32>().prop_map(Step::KillVertex),
        any::<u32>().prop_map(Step::Move),
        any::<u32>().prop_map(Step::Mark),
        any::<u32>().prop_map(Step::Crease),
    ];
    proptest::collection::vec(step, 1..60)
}

fn take(mesh: &mut Mesh, step: &Step) {
    let half_edges: Vec<HalfEdgeId> = mesh.half_edges().collect();
    if half_edges.is_empty() {
        return;
    }
    let pick = |i: u32| half_edges[i as usize % half_edges.len()];
    // Refusals are part of the test: a refused step must leave the mesh valid too.
    let _ = match *step {
        Step::Split(i) => mesh.split_edge(pick(i), mesh.point_along(pick(i), 0.5)).map(drop),
        Step::Antenna(i) => mesh.make_ev_one(pick(i), DVec3::splat(i.into())).map(drop),
        Step::JoinFace(i, k) => {
            let e1 = (0..k).fold(pick(i), |h, _| mesh.next(h));
            mesh.make_ef(pick(i), e1).map(drop)
        }
        Step::KillEdge(i) => mesh.kill_ef(pick(i)),
        Step::KillVertex(i) => mesh.kill_ev(pick(i)),
        Step::Move(i) => {
            mesh.set_position(mesh.source(pick(i)), DVec3::new(i.into(), 1.0, 2.0));
            Ok(())
        }
        Step::Mark(i) => {
            let name = mesh.intern("color");
            let (from, to) = (Node::HalfEdge(pick(i)), Node::Face(mesh.face(pick(i))));
            mesh.set_attribute(from, name, Some(Value::Number(f64::from(i % 7))));
            mesh.set_link(from, name, to, i % 2 == 0);
            Ok(())
        }
        Step::Crease(i) => {
            mesh.set_edge_sharpness(pick(i), (i % 3) as f32);
            Ok(())
        }
    };
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_sequence_validates_and_rolls_back(first in steps(), second in steps(), open in any::<bool>()) {
        let mut mesh = build(&if open { grid(3, 2) } else { cube() });
        let characteristic = euler_characteristic(&mesh);
        for step in &first {
            take(&mut mesh, step);
            mesh.validate().map_err(|e| TestCaseError::fail(format!("after {step:?}: {e}")))?;
        }
        prop_assert_eq!(euler_characteristic(&mesh), characteristic);
        let before = snapshot(&mesh);
        let outer = mesh.begin();
        let half = second.len() / 2;
        for step in &second[..half] {
            take(&mut mesh, step);
        }
        let middle = snapshot(&mesh);
        let inner = mesh.begin();
        for step in &second[half..] {
            take(&mut mesh, step);
        }
        mesh.rollback(inner);
        prop_assert_eq!(snapshot(&mesh), middle);
        mesh.rollback(outer);
        prop_assert_eq!(snapshot(&mesh), before);
    }

    #[test]
    fn compaction_keeps_order_and_connectivity(first in steps()) {
        let mut mesh = build(&cube());
        for step in &first {
            take(&mut mesh, step);
        }
        let (polygons, counts) = (mesh.to_polygons(), mesh.counts());
        mesh.compact();
        mesh.validate().map_err(|e| TestCaseError::fail(e.to_string()))?;
        prop_assert!(mesh.is_compact());
        prop_assert_eq!(mesh.counts(), counts);
        prop_assert_eq!(mesh.to_polygons(), polygons);
    }
}
