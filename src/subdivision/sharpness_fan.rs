//! What sharpness means for the faces round one vertex when they are refined by themselves.

use super::sharpness::{Around, Values, is_semi_sharp};
use crate::mesh::Creasing;
use smallvec::{SmallVec, smallvec};

impl Around {
    /// Sharpness of the half at this vertex of spoke `j`, and of the semi-sharp halves of the others.
    pub(super) fn half_and_others(&self, creasing: Creasing, j: usize) -> (f32, Values) {
        let halves = self.halves(creasing);
        let others = halves.iter().enumerate().filter(|&(i, &s)| i != j && is_semi_sharp(s)).map(|(_, &s)| s);
        (halves[j], others.collect())
    }

    /// What is sharp round the point of an edge inside the surface, whose halves are spokes `places` of `count`: the
    /// sharpness of each half, and of the semi-sharp edges at its far end. `None` where nothing is.
    pub(super) fn of_edge(
        creasing: Creasing,
        count: usize,
        places: [usize; 2],
        halves: [(f32, Values); 2],
    ) -> Option<Self> {
        if halves.iter().all(|half| half.0 <= 0.0) {
            return None;
        }
        let mut spokes: Values = smallvec![0.0; count];
        let mut far: SmallVec<[Values; 2]> = SmallVec::new();
        if creasing == Creasing::Chaikin && halves.iter().any(|half| is_semi_sharp(half.0)) {
            far.resize(count, Values::new());
        }
        for (place, (sharpness, others)) in places.into_iter().zip(halves) {
            spokes[place] = sharpness;
            if let Some(far) = far.get_mut(place) {
                *far = others;
            }
        }
        Some(Self { vertex: 0.0, spokes, far })
    }

    /// Where nothing is semi-sharp: the first spoke and the number of faces between the infinitely sharp spokes on both sides of
    /// face `home`. `None` where these are fewer than two and do not bound a sector by themselves.
    pub(super) fn sector(&self, home: usize) -> Option<(usize, usize)> {
        let sharp = self.infinite_spokes();
        if sharp.is_empty() || sharp.len() == 1 && !self.is_fixed() {
            return None;
        }
        let count = self.spokes.len();
        let first = *sharp.iter().rev().find(|&&j| j <= home).or(sharp.last())?;
        let last = *sharp.iter().find(|&&j| j > home).or(sharp.first())?;
        let between = (last + count - first) % count;
        Some((first, if between == 0 { count } else { between }))
    }
}
