//! Takes the figures of an [`Inspection`] from polygons.

use super::{Boundary, Component, Inspection};
use crate::io::error::LocatedDefect;
use crate::io::repair::{coincident, remove_degenerate_faces};
use crate::io::source::Source;
use crate::io::topology::{NONE, Partition, Topology};
use crate::mesh::{Defect, Mesh, Polygons};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Vertices closer than this part of the mesh's size coincide.
const COINCIDENT: f64 = 1e-9;
/// A face whose area is below this part of its longest side squared has none.
const NO_AREA: f64 = 1e-12;

/// Inspects what was read from a file, whether or not it can become a mesh.
///
/// [`Mesh::to_polygons`] and [`Source::from`] lead here from a mesh.
pub fn inspect(source: &Source) -> Inspection {
    let polygons = &source.polygons;
    let topology = Topology::new(polygons);
    let mut inspection = Inspection {
        vertices: polygons.positions.len(),
        edges: topology.edges().count(),
        faces: polygons.face_sizes.len(),
        creases: polygons.creases.len(),
        corners: polygons.corners.len(),
        defects: defects(source),
        ..Inspection::default()
    };
    for &size in &polygons.face_sizes {
        *inspection.arities.entry(size as usize).or_default() += 1;
    }
    count_sets(polygons, &mut inspection);
    measure_vertices(source, &topology, &mut inspection);
    measure_faces(source, &topology, &mut inspection);
    measure_components(source, &topology, &mut inspection);
    inspection
}

/// Defects of all faces; where some are degenerate, those of the others too.
fn defects(source: &Source) -> Vec<LocatedDefect> {
    let Err(found) = Mesh::from_polygons(&source.polygons) else { return Vec::new() };
    let degenerate =
        |defect: &Defect| matches!(defect, Defect::TooFewVertices { .. } | Defect::RepeatedVertex { .. });
    let look_on = found.0.iter().all(degenerate);
    let mut defects = source.locate(found);
    if look_on {
        let mut rest = source.clone();
        remove_degenerate_faces(&mut rest);
        if let Err(others) = Mesh::from_polygons(&rest.polygons) {
            defects.extend(rest.locate(others));
        }
    }
    defects
}

/// Faces per group and per material.
fn count_sets(polygons: &Polygons, inspection: &mut Inspection) {
    let mut faces_per_set = vec![0; polygons.sets.len()];
    for &set in &polygons.face_sets {
        if let Some(count) = faces_per_set.get_mut(set as usize) {
            *count += 1;
        }
    }
    let mut places = [FxHashMap::default(), FxHashMap::default()];
    for (set, &count) in polygons.sets.iter().zip(&faces_per_set) {
        let mut add = |which: usize, list: &mut Vec<(String, usize)>, name: &String| {
            let place = *places[which].entry(name.clone()).or_insert(list.len());
            if place == list.len() {
                list.push((name.clone(), 0));
            }
            list[place].1 += count;
        };
        set.groups.iter().for_each(|name| add(0, &mut inspection.groups, name));
        set.material.iter().for_each(|name| add(1, &mut inspection.materials, name));
    }
}

/// Valences, isolated and coincident vertices, seams, bounding box.
fn measure_vertices(source: &Source, topology: &Topology, inspection: &mut Inspection) {
    let positions = &source.polygons.positions;
    let mut valence = vec![0usize; positions.len()];
    let mut on_boundary = vec![false; positions.len()];
    for edge in topology.edges() {
        for vertex in [edge[0].low, edge[0].high] {
            valence[vertex as usize] += 1;
            on_boundary[vertex as usize] |= edge.len() == 1;
        }
    }
    for (vertex, &valence) in valence.iter().enumerate() {
        let histogram = match (valence, on_boundary[vertex]) {
            (0, _) => {
                inspection.isolated_vertices.push(source.file_vertex(vertex as u32));
                continue;
            }
            (_, true) => &mut inspection.boundary_valences,
            (_, false) => &mut inspection.interior_valences,
        };
        *histogram.entry(valence).or_default() += 1;
    }
    let Some(&first) = positions.first() else { return };
    let low = positions.iter().fold(first, |low, &p| low.min(p));
    let high = positions.iter().fold(first, |high, &p| high.max(p));
    inspection.bounding_box = Some([low.to_array(), high.to_array()]);
    // Vertices of one boundary seam must be compared among themselves: the lowest of a place may lie inside.
    let distance = COINCIDENT * low.distance(high);
    let distance = if distance.is_finite() { distance } else { 0.0 };
    inspection.coincident_vertices = pairs(source, positions, distance, |_| true);
    inspection.seams = pairs(source, positions, distance, |vertex| on_boundary[vertex as usize]);
}

/// Vertices of `which` that coincide with a lower one of `which`, and that one.
fn pairs(
    source: &Source,
    positions: &[DVec3],
    distance: f64,
    which: impl Fn(u32) -> bool,
) -> Vec<(u32, u32)> {
    let vertices: Vec<u32> = (0..positions.len() as u32).filter(|&vertex| which(vertex)).collect();
    let places: Vec<DVec3> = vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
    let lowest = coincident(&places, distance);
    (0..)
        .zip(lowest)
        .filter(|&(i, lowest)| i != lowest)
        .map(|pair| <[u32; 2]>::from(pair).map(|i| source.file_vertex(vertices[i as usize])).into())
        .collect()
}

fn measure_faces(source: &Source, topology: &Topology, inspection: &mut Inspection) {
    let polygons = &source.polygons;
    for (face, vertices) in polygons.faces().enumerate() {
        if !topology.sound[face] {
            continue;
        }
        let origin = polygons.positions[vertices[0] as usize];
        let (mut area, mut longest) = (DVec3::ZERO, 0.0f64);
        for (i, &a) in vertices.iter().enumerate() {
            let b = vertices[if i + 1 == vertices.len() { 0 } else { i + 1 }];
            let [a, b] = [a, b].map(|vertex| polygons.positions[vertex as usize] - origin);
            area += a.cross(b) / 2.0;
            longest = longest.max(a.distance(b));
        }
        if area.length() <= NO_AREA * longest * longest {
            inspection.zero_area_faces.push(source.file_face(face as u32));
        }
    }
}

/// What is gathered about a component before its genus is known.
struct Part {
    component: Component,
    manifold: bool,
    /// Orientable, and oriented as it is.
    orientable: bool,
    oriented: bool,
    /// Six times the volume.
    volume: f64,
    origin: DVec3,
    /// Largest size of a coordinate difference, to tell a volume from rounding.
    extent: f64,
}

fn measure_components(source: &Source, topology: &Topology, inspection: &mut Inspection) {
    let polygons = &source.polygons;
    let mut partition = Partition::new(polygons.positions.len());
    let mut boundary = Partition::new(polygons.positions.len());
    for edge in topology.edges() {
        partition.unite(edge[0].low, edge[0].high);
        if edge.len() == 1 {
            boundary.unite(edge[0].low, edge[0].high);
        }
    }
    let mut parts: BTreeMap<u32, Part> = BTreeMap::new();
    let mut boundaries: BTreeMap<u32, Boundary> = BTreeMap::new();
    let part_of: Vec<u32> = (0..polygons.positions.len() as u32).map(|v| partition.find(v)).collect();
    let mut used = vec![false; polygons.positions.len()];
    for edge in topology.edges() {
        let (a, b) = (edge[0].low, edge[0].high);
        let [from, to] = [a, b].map(|vertex| polygons.positions[vertex as usize]);
        let name = part_of[a as usize];
        let part = parts.entry(name).or_insert_with(|| Part {
            component: Component {
                vertex: source.file_vertex(name),
                vertices: 0,
                edges: 0,
                faces: 0,
                boundaries: 0,
                genus: None,
                volume: None,
            },
            manifold: true,
            orientable: true,
            oriented: true,
            volume: 0.0,
            origin: polygons.positions[name as usize],
            extent: 0.0,
        });
        part.component.edges += 1;
        for vertex in [a, b] {
            part.component.vertices += usize::from(!std::mem::replace(&mut used[vertex as usize], true));
        }
        part.manifold &= edge.len() <= 2;
        part.oriented &=
            edge.len() != 2 || topology.vertex(edge[0].corner) != topology.vertex(edge[1].corner);
        if edge.len() == 1 {
            let name = boundary.find(a);
            let vertex = source.file_vertex(name);
            let entry = boundaries.entry(name).or_insert(Boundary { vertex, edges: 0, length: 0.0 });
            entry.edges += 1;
            entry.length += from.distance(to);
        }
    }
    for &lowest in boundaries.keys() {
        if let Some(part) = parts.get_mut(&part_of[lowest as usize]) {
            part.component.boundaries += 1;
        }
    }
    for &(corner, _) in &topology.orientation().conflicts {
        if let Some(part) = parts.get_mut(&part_of[topology.vertex(corner) as usize]) {
            part.orientable = false;
        }
    }
    note_fans(topology, &part_of, &mut parts);
    add_faces(polygons, topology, &part_of, &mut parts);
    inspection.boundaries = boundaries.into_values().collect();
    inspection.components = parts.into_values().map(Part::finish).collect();
    inspection.genus = inspection.components.iter().map(|component| component.genus).sum();
    inspection.inside_out = (0..inspection.components.len())
        .filter(|&i| inspection.components[i].volume.is_some_and(|volume| volume < 0.0))
        .collect();
}

/// Parts with a vertex at which several fans meet are no manifolds.
fn note_fans(topology: &Topology, part_of: &[u32], parts: &mut BTreeMap<u32, Part>) {
    let mut fan_of = vec![NONE; part_of.len()];
    for (corner, fan) in topology.fans(&[]).into_iter().enumerate() {
        let corner = corner as u32;
        if !topology.sound[topology.face(corner) as usize] {
            continue;
        }
        let vertex = topology.vertex(corner) as usize;
        if fan_of[vertex] == NONE {
            fan_of[vertex] = fan;
        } else if fan_of[vertex] != fan
            && let Some(part) = parts.get_mut(&part_of[vertex])
        {
            part.manifold = false;
        }
    }
}

/// Face counts, and volumes as sums over tetrahedra from a point of the part.
fn add_faces(polygons: &Polygons, topology: &Topology, part_of: &[u32], parts: &mut BTreeMap<u32, Part>) {
    for (face, vertices) in polygons.faces().enumerate() {
        if !topology.sound[face] {
            continue;
        }
        let Some(part) = parts.get_mut(&part_of[vertices[0] as usize]) else { continue };
        part.component.faces += 1;
        let place = |vertex: u32| polygons.positions[vertex as usize] - part.origin;
        let first = place(vertices[0]);
        for pair in vertices[1..].windows(2) {
            part.volume += first.dot(place(pair[0]).cross(place(pair[1])));
        }
        for &vertex in vertices {
            part.extent = part.extent.max(place(vertex).abs().max_element());
        }
    }
}

impl Part {
    /// A volume below this part of the extent cubed is rounding.
    const NO_VOLUME: f64 = 1e-12;

    fn finish(self) -> Component {
        let mut component = self.component;
        if self.manifold && self.orientable {
            let euler = component.vertices as i64 - component.edges as i64 + component.faces as i64;
            let twice = 2 - component.boundaries as i64 - euler;
            component.genus = usize::try_from(twice / 2).ok();
            if self.oriented && component.boundaries == 0 {
                let rounding = self.volume.abs() <= Self::NO_VOLUME * self.extent.powi(3);
                component.volume = Some(if rounding { 0.0 } else { self.volume / 6.0 });
            }
        }
        component
    }
}
