//! An inspection as text for people.

use super::Inspection;
use std::collections::BTreeMap;
use std::fmt::{self, Display};

/// Lists are cut off after this many entries; the whole is in the data.
const SHOWN: usize = 12;

impl Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "vertices     {}", self.vertices)?;
        writeln!(f, "edges        {}", self.edges)?;
        writeln!(f, "faces        {}", self.faces)?;
        if let Some([low, high]) = self.bounding_box {
            writeln!(f, "box          {low:?} to {high:?}")?;
        }
        histogram(f, "arity", &self.arities)?;
        histogram(f, "valence", &self.interior_valences)?;
        histogram(f, "on boundary", &self.boundary_valences)?;
        let genus = self.genus.map_or("none (no orientable manifold)".to_string(), |genus| genus.to_string());
        writeln!(f, "components   {}, genus {genus}", self.components.len())?;
        if self.components.len() > 1 {
            let line = |f: &mut fmt::Formatter, i: usize| {
                let c = &self.components[i];
                let genus = c.genus.map_or("-".to_string(), |genus| genus.to_string());
                write!(
                    f,
                    "{i}: from vertex {}, V {} E {} F {}, boundaries {}, genus {genus}",
                    c.vertex, c.vertices, c.edges, c.faces, c.boundaries
                )
            };
            lines(f, self.components.len(), line)?;
        }
        writeln!(f, "boundaries   {}", self.boundaries.len())?;
        lines(f, self.boundaries.len(), |f, i| {
            let b = &self.boundaries[i];
            write!(f, "from vertex {}, {} edges, length {:.6}", b.vertex, b.edges, b.length)
        })?;
        if self.creases + self.corners > 0 {
            writeln!(f, "sharp        {} creases, {} corners", self.creases, self.corners)?;
        }
        named(f, "groups", &self.groups)?;
        named(f, "materials", &self.materials)?;
        ids(f, "isolated vertices", &self.isolated_vertices)?;
        let pair = |pairs: &[(u32, u32)]| pairs.iter().map(|(a, b)| format!("{a}={b}")).collect::<Vec<_>>();
        ids(f, "coincident vertices", &pair(&self.coincident_vertices))?;
        ids(f, "unwelded seam vertices", &pair(&self.seams))?;
        ids(f, "inside-out components", &self.inside_out)?;
        ids(f, "faces without area", &self.zero_area_faces)?;
        if self.is_clean() {
            return writeln!(f, "no defects");
        }
        writeln!(f, "defects      {}", self.defects.len())?;
        lines(f, self.defects.len(), |f, i| self.defects[i].fmt(f))
    }
}

fn histogram(f: &mut fmt::Formatter, name: &str, counts: &BTreeMap<usize, usize>) -> fmt::Result {
    if counts.is_empty() {
        return Ok(());
    }
    let entries: Vec<String> = counts.iter().map(|(value, count)| format!("{value}:{count}")).collect();
    let more = if entries.len() > SHOWN { " ..." } else { "" };
    writeln!(f, "{name:<12} {}{more}", entries[..entries.len().min(SHOWN)].join(" "))
}

fn named(f: &mut fmt::Formatter, title: &str, names: &[(String, usize)]) -> fmt::Result {
    if names.is_empty() {
        return Ok(());
    }
    writeln!(f, "{title:<12} {}", names.len())?;
    lines(f, names.len(), |f, i| write!(f, "{} ({} faces)", names[i].0, names[i].1))
}

fn ids<T: Display>(f: &mut fmt::Formatter, title: &str, ids: &[T]) -> fmt::Result {
    if ids.is_empty() {
        return Ok(());
    }
    let shown: Vec<String> = ids.iter().take(SHOWN).map(T::to_string).collect();
    let more = if ids.len() > SHOWN { ", ..." } else { "" };
    writeln!(f, "{title}: {} ({}{more})", ids.len(), shown.join(", "))
}

/// Indented lines, one per entry.
fn lines(
    f: &mut fmt::Formatter,
    count: usize,
    write_entry: impl Fn(&mut fmt::Formatter, usize) -> fmt::Result,
) -> fmt::Result {
    for i in 0..count.min(SHOWN) {
        write!(f, "  ")?;
        write_entry(f, i)?;
        writeln!(f)?;
    }
    if count > SHOWN {
        writeln!(f, "  and {} more", count - SHOWN)?;
    }
    Ok(())
}
