//! Results are meshes, the same in every run; what no rule handled is kept and said; failures change nothing.

use super::case::Case;
use std::collections::BTreeMap;
use welt::feature::{FeatureError, Report};
use welt::mark::parity::Mode;
use welt::mesh::{Domain, FaceId, HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};
use welt::optimise::Method;

/// A report without the times.
fn comparable(report: &Report) -> Result<serde_json::Value, String> {
    let mut json = serde_json::to_value(report).map_err(|e| e.to_string())?;
    json.as_object_mut().map(|object| object.remove("times"));
    Ok(json)
}

/// Everything about a mesh that a caller can see.
fn whole(mesh: &Mesh) -> (Polygons, BTreeMap<Node, Vec<(String, Value)>>) {
    let nodes = mesh.vertices().map(Node::Vertex).chain(mesh.half_edges().map(Node::HalfEdge));
    let attributes = nodes.chain(mesh.faces().map(Node::Face)).filter_map(|node| {
        let values = mesh.attribute_names(node).into_iter().map(|name| {
            let value = mesh.attribute(node, name).cloned().unwrap_or(Value::Number(f64::NAN));
            (mesh.symbol_name(name).to_owned(), value)
        });
        let values: Vec<_> = values.collect();
        (!values.is_empty()).then_some((node, values))
    });
    (mesh.to_polygons(), attributes.collect())
}

macro_rules! ensure {
    ($condition:expr, $($message:tt)*) => {
        if !$condition {
            return Err(format!($($message)*));
        }
    };
}
pub(crate) use ensure;

/// Only these may refuse a feature; anything else is a rule that failed.
pub fn is_refusal(error: &FeatureError) -> bool {
    use FeatureError::{CrossedTwice, Curve, OpenLoop, Unresolved, Width};
    matches!(error, Width(_) | Unresolved { .. } | OpenLoop { .. } | Curve { .. } | CrossedTwice { .. })
}

pub fn result_is_sound(case: &Case) -> Result<(), String> {
    let before = &case.model.mesh;
    let mut mesh = before.clone();
    let mut again = before.clone();
    match (case.apply(&mut mesh), case.apply(&mut again)) {
        (Err(first), Err(second)) => {
            ensure!(is_refusal(&first), "{first}");
            ensure!(first.to_string() == second.to_string(), "two runs fail differently: {first}, {second}");
            ensure!(whole(&mesh) == whole(before), "it failed ({first}) and changed the mesh");
            mesh.validate().map_err(|violation| format!("after a failure: {violation}"))
        }
        (Ok(report), Ok(second)) => {
            mesh.validate_control_mesh().map_err(|violation| violation.to_string())?;
            ensure!(whole(&mesh) == whole(&again), "two runs differ");
            ensure!(comparable(&report)? == comparable(&second)?, "the reports of two runs differ");
            ensure!(!case.options.strict || report.leftovers.is_empty(), "strict, but marks are left over");
            only_leftovers_have_attributes(&mesh, &report)?;
            if matches!(case.options.method, Method::None) && case.is_flat && case.curves.is_empty() {
                leftovers_are_where_lines_end(case, &mesh, &report)?;
            }
            all_quads(case, &mesh, &report)
        }
        (first, second) => Err(format!("one run fails: {:?} {:?}", first.err(), second.err())),
    }
}

/// The attributes `unresolved` are the marks that the report lists, and no other attribute is left behind.
fn only_leftovers_have_attributes(mesh: &Mesh, report: &Report) -> Result<(), String> {
    let mut kept: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    for (node, values) in whole(mesh).1 {
        let [(name, value)] = values.as_slice() else { return Err(format!("{node:?} keeps {values:?}")) };
        let (Node::HalfEdge(h), "unresolved") = (node, name.as_str()) else {
            return Err(format!("{node:?} keeps '{name}'"));
        };
        kept.entry(mesh.face(h).0).or_default().push(value.as_text().unwrap_or_default().to_owned());
    }
    let mut said: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    for leftover in &report.leftovers {
        said.insert(leftover.face, leftover.marks.iter().map(|mark| mark.kind.clone()).collect());
        let vertices: Vec<u32> = mesh.face_vertices(FaceId(leftover.face)).map(|v| v.0).collect();
        ensure!(vertices == leftover.vertices, "face {} has other vertices", leftover.face);
    }
    kept.values_mut().chain(said.values_mut()).for_each(|kinds| kinds.sort());
    ensure!(kept == said, "kept as attributes: {kept:?}; in the report: {said:?}");
    let links = mesh.symbol("span").map_or(0, |span| mesh.nodes_with_link(Domain::HalfEdge, span).count());
    ensure!(links == 0, "{links} spans are left");
    Ok(())
}

/// Where vertices stay on the marked edges, a side of an edge on which no line goes on is one that the report lists,
/// and the other way round but for what the last resort joined.
fn leftovers_are_where_lines_end(case: &Case, mesh: &Mesh, report: &Report) -> Result<(), String> {
    let before = &case.model.mesh;
    let lines = report.parity.iter().flat_map(|parity| &parity.lines).flat_map(|line| &line.edges);
    let edge = |h: HalfEdgeId| (before.source(h).0, before.target(h).0);
    let mut found: Vec<(u32, (u32, u32))> = Vec::new();
    for (a, b) in case.marks.iter().map(|mark| edge(mark.half_edge)).chain(lines.copied()) {
        for (from, to) in [(a, b), (b, a)] {
            let (start, end) = (mesh.position(VertexId(from)), mesh.position(VertexId(to)));
            let is_on = |v: VertexId| {
                let p = mesh.position(v);
                let t = (p - start).dot(end - start) / (end - start).length_squared();
                v.index() >= before.vertex_bound()
                    && t > 0.0
                    && t < 1.0
                    && p.distance(start.lerp(end, t)) < 1e-9 * end.distance(start)
            };
            // Along the pieces of the edge, as long as the face on the left has no edge between them.
            let first =
                mesh.outgoing(VertexId(from)).find(|&h| is_on(mesh.target(h)) && !mesh.face(h).is_boundary());
            let mut h = first;
            while let Some(piece) = h.filter(|&piece| is_on(mesh.target(piece))) {
                h = Some(mesh.next(piece));
            }
            // A single line may end in a face by making it even: its vertex is a corner of a quad then.
            let is_corner = |first: HalfEdgeId| {
                mesh.target(mesh.next(first)) == VertexId(to) && mesh.arity(mesh.face(first)) == 4
            };
            if let (Some(first), Some(last)) = (first, h)
                && mesh.target(last) == VertexId(to)
                && !is_corner(first)
            {
                found.push((mesh.face(first).0, (a.min(b), a.max(b))));
            }
        }
    }
    let mut said: Vec<(u32, (u32, u32))> = report
        .leftovers
        .iter()
        .flat_map(|leftover| leftover.marks.iter().map(|mark| (leftover.face, mark.edge)))
        .map(|(face, (a, b))| (face, (a.min(b), a.max(b))))
        .collect();
    found.sort_unstable();
    said.sort_unstable();
    // Features that do not fit together are joined all the same, by the last resort of the rules, and are listed.
    let is_joined = report.rules.iter().any(|(rule, count)| rule == "Unlike" && *count > 0);
    if is_joined {
        said.retain(|entry| found.binary_search(entry).is_ok());
    }
    ensure!(found == said, "lines end at {found:?}, the report says {said:?}");
    Ok(())
}

/// In all-quad mode, where every mark is on quads and every odd face found a partner, there are no more faces with
/// three or five and more sides than before.
fn all_quads(case: &Case, mesh: &Mesh, report: &Report) -> Result<(), String> {
    let before = &case.model.mesh;
    let on_quads = case.marks.iter().flat_map(|mark| [mark.half_edge, mark.half_edge.mate()]);
    let on_quads = on_quads.map(|h| before.face(h)).all(|f| f.is_boundary() || before.arity(f) == 4);
    // Which edges a curve crosses is not known here: any.
    let on_quads = on_quads && (case.curves.is_empty() || before.faces().all(|f| before.arity(f) == 4));
    let is_paired = report.parity.as_ref().is_some_and(|parity| parity.left.is_empty());
    if case.options.parity != Mode::AllQuad || !on_quads || !is_paired || !report.leftovers.is_empty() {
        return Ok(());
    }
    let irregular = |mesh: &Mesh| mesh.faces().filter(|&f| mesh.arity(f) != 4).count();
    let (now, then) = (irregular(mesh), irregular(before));
    ensure!(now <= then, "{now} faces are no quads, {then} were none before");
    Ok(())
}
