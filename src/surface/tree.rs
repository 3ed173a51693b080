//! A bounding volume tree over boxes: median split, flat array, no recursion.

use crate::memory::{self, OutOfMemory};
use glam::DVec3;

/// Most boxes in a leaf: the bounds of a node cost less than a look at a piece.
const LEAF: usize = 1;

/// An inner node's children are `index + 1` and `second`; a leaf (`count > 0`) holds `items[second..second + count]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    second: u32,
    count: u32,
}

/// See the [module](self).
#[derive(Clone, Default, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// What a node holds.
pub(super) enum Content<'a> {
    /// Indices of boxes.
    Leaf(&'a [u32]),
    /// Indices of two nodes.
    Children([u32; 2]),
}

impl Tree {
    /// The tree over `boxes`, each (low, high).
    pub(super) fn new(boxes: &[(DVec3, DVec3)]) -> Result<Self, OutOfMemory> {
        let mut items: Vec<u32> = memory::collected(boxes.len(), 0..boxes.len() as u32)?;
        let mut nodes: Vec<Node> = memory::room(2 * boxes.len())?;
        // Ranges still to do, each with the inner node whose second child it is.
        let mut open: Vec<(usize, usize, Option<usize>)> = Vec::new();
        if !items.is_empty() {
            open.push((0, items.len(), None));
        }
        while let Some((start, end, parent)) = open.pop() {
            let index = nodes.len();
            if let Some(parent) = parent {
                nodes[parent].second = index as u32;
            }
            let range = &mut items[start..end];
            let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let (mut around, mut middles) = (empty, empty);
            for &item in range.iter() {
                let (low, high) = boxes[item as usize];
                let middle = low + high;
                around = (around.0.min(low), around.1.max(high));
                middles = (middles.0.min(middle), middles.1.max(middle));
            }
            let (low, high) = around;
            if range.len() <= LEAF {
                nodes.push(Node { low, high, second: start as u32, count: range.len() as u32 });
                continue;
            }
            nodes.push(Node { low, high, second: 0, count: 0 });
            let extent = middles.1 - middles.0;
            let axis = if extent.x >= extent.y && extent.x >= extent.z {
                0
            } else if extent.y >= extent.z {
                1
            } else {
                2
            };
            let key = |item: u32| boxes[item as usize].0[axis] + boxes[item as usize].1[axis];
            let half = range.len() / 2;
            range.select_nth_unstable_by(half, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            open.push((start + half, end, Some(index)));
            open.push((start, start + half, None));
        }
        Ok(Self { nodes, items })
    }

    /// The box round everything; `None` for an empty tree.
    pub(super) fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.nodes.first().map(|node| (node.low, node.high))
    }

    pub(super) fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    pub(super) fn content(&self, index: u32) -> Content<'_> {
        let node = self.node(index);
        let second = node.second as usize;
        if node.count > 0 {
            Content::Leaf(&self.items[second..second + node.count as usize])
        } else {
            Content::Children([index + 1, node.second])
        }
    }

    /// Something for each node: that of its items (`leaf`) or of its children, joined.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    pub(super) fn gather<T: Copy>(&self, leaf: impl Fn(u32) -> T, join: impl Fn(T, T) -> T) -> Result<Vec<T>, OutOfMemory> {
        // From the last to the first, for children stand behind their parent.
        let mut reversed: Vec<T> = memory::room(self.nodes.len())?;
        let last = self.nodes.len().saturating_sub(1);
        for index in (0..self.nodes.len()).rev() {
            let joined = match self.content(index as u32) {
                Content::Leaf(items) => items.iter().map(|&item| leaf(item)).reduce(&join),
                Content::Children(children) => {
                    children.iter().map(|&child| reversed[last - child as usize]).reduce(&join)
                }
            };
            reversed.extend(joined);
        }
        reversed.reverse();
        Ok(reversed)
    }
}
