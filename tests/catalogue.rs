//! The figures of `inspect` against those that the catalogue of test meshes gives (made with other software).

use crate::common;

use std::collections::BTreeMap;
use std::path::Path;
use welt::io::{self, Format, ImportError, ImportOptions, Inspection};
use welt::mesh::Defect;

/// Files that the reader refuses, since a statement of theirs cannot be understood; `tests/stress.rs` has the messages.
const REFUSED: [&str; 7] = [
    "gen_bad_index_1e19.obj",
    "gen_bad_index_big.obj",
    "gen_bad_index_zero.obj",
    "gen_nan_inf.obj",
    "gen_not_a_number.obj",
    "as_number_formats.obj",
    "tol_issue-140-zero-face-idx.obj",
];

/// One row of the catalogue.
struct Row<'a> {
    folder: &'a str,
    columns: Vec<&'a str>,
}

impl<'a> Row<'a> {
    fn column(&self, name: &str) -> &'a str {
        let names = [
            "file", "key", "source", "V", "F", "arity", "val", "bnd", "comp", "genus", "nm", "creases",
            "notes",
        ];
        let place = names.iter().position(|&n| n == name).expect("a column of the catalogue");
        self.columns[place]
    }

    /// The number in front of `what` in the notes, 0 when it is not mentioned.
    fn noted(&self, what: &str) -> usize {
        let note = self.column("notes").split(';').map(str::trim).find_map(|note| {
            let (number, rest) = note.split_once(' ')?;
            rest.starts_with(what).then(|| number.parse().ok())?
        });
        note.unwrap_or(0)
    }
}

fn rows(catalogue: &str) -> Vec<Row<'_>> {
    let mut folder = "";
    let mut rows = Vec::new();
    for line in catalogue.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            folder = title.split(' ').next().unwrap_or_default();
        }
        let columns: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if columns.len() == 13 && columns[0].contains(".obj") {
            rows.push(Row { folder, columns });
        }
    }
    rows
}

/// Compares a histogram with text such as `4:364 3:76 ..`; where the text is cut off, only what it lists.
fn check_histogram(text: &str, counts: &BTreeMap<usize, usize>) -> Result<(), String> {
    let mut listed = 0;
    for entry in text.split_whitespace().filter(|&entry| entry != "..") {
        let (value, count) = entry.split_once(':').ok_or("an entry without a colon")?;
        let value: usize = value.parse().map_err(|_| "a value that is no number")?;
        if counts.get(&value).map(usize::to_string).as_deref() != Some(count) {
            return Err(format!("{entry} against {:?}", counts.get(&value)));
        }
        listed += 1;
    }
    if !text.ends_with("..") && listed != counts.len() {
        return Err(format!("'{text}' against {counts:?}"));
    }
    Ok(())
}

fn check(row: &Row, inspection: &Inspection) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut same = |what: &str, expected: String, found: String| {
        if expected != found {
            wrong.push(format!("{}: {what}: catalogue {expected}, found {found}", row.column("file")));
        }
    };
    same("V", row.column("V").into(), inspection.vertices.to_string());
    same("F", row.column("F").into(), inspection.faces.to_string());
    let edges: usize = inspection.boundaries.iter().map(|boundary| boundary.edges).sum();
    same("bnd", row.column("bnd").into(), format!("{edges}/{}", inspection.boundaries.len()));
    same("comp", row.column("comp").into(), inspection.components.len().to_string());
    let genus = inspection.genus.map_or("-".into(), |genus| genus.to_string());
    same("genus", row.column("genus").into(), genus);
    same("isolated", row.noted("isolated v").to_string(), inspection.isolated_vertices.len().to_string());
    same("zero-area", row.noted("zero-area f").to_string(), inspection.zero_area_faces.len().to_string());
    same(
        "coincident",
        row.noted("coincident v").to_string(),
        inspection.coincident_vertices.len().to_string(),
    );
    let count = |which: fn(&Defect) -> bool| inspection.defects.iter().filter(|d| which(&d.defect)).count();
    let (many_edges, fans) = row.column("nm").split_once('/').unwrap_or_default();
    same("nm edges", many_edges.into(), count(|d| matches!(d, Defect::EdgeWithManyFaces { .. })).to_string());
    let inconsistent = count(|d| matches!(d, Defect::InconsistentOrientation { .. }));
    same("inconsistent", row.noted("inconsistent edges").to_string(), inconsistent.to_string());
    if many_edges == "0" && inconsistent == 0 {
        same("nm vertices", fans.into(), count(|d| matches!(d, Defect::SeparateFans { .. })).to_string());
    }
    let corners = if inspection.corners > 0 { format!("+{}c", inspection.corners) } else { String::new() };
    let creases = if inspection.creases > 0 { inspection.creases.to_string() } else { String::new() };
    same("creases", row.column("creases").into(), creases + &corners);
    for (column, histogram) in [("arity", &inspection.arities), ("val", &inspection.interior_valences)] {
        if let Err(difference) = check_histogram(row.column(column), histogram) {
            wrong.push(format!("{}: {column}: {difference}", row.column("file")));
        }
    }
    wrong
}

#[test]
fn every_file_has_the_figures_of_the_catalogue() {
    let Some(data) = common::shared_data() else { return };
    let catalogue = std::fs::read_to_string(data.join("CATALOGUE.md")).expect("the catalogue");
    let rows = rows(&catalogue);
    assert_eq!(rows.len(), 198, "the catalogue lists 198 meshes");
    let mut wrong = Vec::new();
    for row in &rows {
        let file = row.column("file");
        let bytes = common::content(&data.join(row.folder).join(Path::new(file)));
        // One file is a single face of 50,000 vertices.
        let limits = io::Limits { max_arity: 1 << 20, ..io::Limits::default() };
        match io::read_bytes(file, Format::Obj, &bytes, &ImportOptions { limits, ..ImportOptions::default() })
        {
            Ok(source) => wrong.extend(check(row, &io::inspect(&source))),
            Err(ImportError::Text { .. }) if REFUSED.contains(&file) => {}
            Err(error) => wrong.push(error.to_string()),
        }
    }
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
}
