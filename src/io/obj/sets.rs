//! Which groups, object, material and smoothing group the next face belongs to.

use crate::mesh::{FaceSet, Polygons};
use rustc_hash::FxHashMap;

/// Most bytes that the names of all sets may take together.
const MOST_NAME_BYTES: usize = 1 << 28;

/// What a name takes besides its text.
const BYTES_PER_NAME: usize = 64;

/// The statements that change what the next face belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum SetStatement {
    Group,
    Object,
    Material,
    Smoothing,
}

impl SetStatement {
    const ALL: [Self; 4] = [Self::Group, Self::Object, Self::Material, Self::Smoothing];

    /// The keyword in a file.
    pub(super) fn keyword(self) -> &'static str {
        match self {
            Self::Group => "g",
            Self::Object => "o",
            Self::Material => "usemtl",
            Self::Smoothing => "s",
        }
    }
}

/// Follows the statements and hands out the index of the present set to each face.
#[derive(Default)]
pub(super) struct Sets {
    present: FaceSet,
    /// Index of `present`, once a face asked for it.
    index: Option<u32>,
    known: FxHashMap<FaceSet, u32>,
    /// What all names in all sets take, in bytes.
    name_bytes: usize,
    /// Lines of the statements that no face followed yet.
    waiting: [Option<u32>; 4],
}

impl Sets {
    /// Takes a statement. Gives the line of the statement it replaces when no face ever used that one.
    pub(super) fn set(&mut self, statement: SetStatement, name: String, line: u32) -> Option<u32> {
        let named = (!name.is_empty()).then_some(name);
        match statement {
            SetStatement::Group => {
                self.present.groups = named.iter().flat_map(|n| n.split(' ')).map(str::to_string).collect();
            }
            SetStatement::Object => self.present.object = named,
            SetStatement::Material => self.present.material = named,
            SetStatement::Smoothing => self.present.smoothing = named,
        }
        self.index = None;
        self.waiting[statement as usize].replace(line)
    }

    /// The set of the next face, as an index into `polygons.sets`.
    pub(super) fn index(&mut self, polygons: &mut Polygons) -> u32 {
        if let Some(index) = self.index {
            return index;
        }
        self.waiting = [None; 4];
        let index = *self.known.entry(self.present.clone()).or_insert_with_key(|set| {
            let FaceSet { groups, object, material, smoothing } = set;
            let names = groups.iter().chain(object).chain(material).chain(smoothing);
            self.name_bytes += names.map(|name| name.len() + BYTES_PER_NAME).sum::<usize>();
            polygons.sets.push(set.clone());
            (polygons.sets.len() - 1) as u32
        });
        self.index = Some(index);
        index
    }

    /// True when the sets hold more text than a file of sense: a long name that many sets repeat would take far more
    /// memory than the file.
    pub(super) fn are_too_large(&self) -> bool {
        self.name_bytes > MOST_NAME_BYTES
    }

    /// The statements that no face followed, and their lines.
    pub(super) fn unused(&self) -> impl Iterator<Item = (SetStatement, u32)> {
        SetStatement::ALL
            .into_iter()
            .zip(self.waiting)
            .filter_map(|(statement, line)| Some((statement, line?)))
    }
}
