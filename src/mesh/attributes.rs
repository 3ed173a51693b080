//! Attributes and labelled links: name -> value on nodes, label -> node between nodes (paper, Definition 1).
//!
//! Columns are sparse: a mark on a mesh of a million faces costs what it costs on a thousand.
//! Each column keeps an index from value to ids, on which the rule matcher anchors.

use super::ids::{Domain, Node};
use super::value::{Key, Value};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::collections::BTreeSet;

/// An interned name of an attribute or a link label; valid for the mesh that gave it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Symbol(pub(crate) u32);

/// Values of up to 64 neighbouring ids: neighbours in the mesh tend to have near ids, so that a search round a face
/// looks at one place in memory, and learns without a look at the values that an element has none.
#[derive(Clone, Default, Debug)]
struct Block {
    /// Bit `i`: the id with remainder `i` has a value.
    present: u64,
    /// The values, by ascending id.
    values: SmallVec<[Value; 1]>,
}

impl Block {
    /// Place of `id` among the values, and whether it has one.
    fn place(&self, id: u32) -> (usize, bool) {
        let below = self.present & ((1 << (id % 64)) - 1);
        (below.count_ones() as usize, self.present >> (id % 64) & 1 == 1)
    }

    fn ids(&self, number: u32) -> impl Iterator<Item = u32> + use<> {
        let present = self.present;
        (0..64).filter(move |i| present >> i & 1 == 1).map(move |i| 64 * number + i)
    }
}

#[derive(Clone, Default, Debug)]
pub(crate) struct Column {
    blocks: FxHashMap<u32, Block>,
    index: FxHashMap<Key, BTreeSet<u32>>,
}

impl Column {
    fn get(&self, id: u32) -> Option<&Value> {
        let block = self.blocks.get(&(id / 64))?;
        let (place, present) = block.place(id);
        if present { block.values.get(place) } else { None }
    }

    fn set(&mut self, id: u32, value: Option<Value>) -> Option<Value> {
        let key = value.as_ref().map(Key::from);
        let old = match value {
            Some(value) => {
                let block = self.blocks.entry(id / 64).or_default();
                let (place, present) = block.place(id);
                if present {
                    Some(std::mem::replace(&mut block.values[place], value))
                } else {
                    block.present |= 1 << (id % 64);
                    block.values.insert(place, value);
                    None
                }
            }
            None => self.remove(id),
        };
        if let Some(old) = &old
            && let Some(ids) = self.index.get_mut(&Key::from(old))
        {
            ids.remove(&id);
        }
        if let Some(key) = key {
            self.index.entry(key).or_default().insert(id);
        }
        old
    }

    fn remove(&mut self, id: u32) -> Option<Value> {
        let block = self.blocks.get_mut(&(id / 64))?;
        let (place, present) = block.place(id);
        if !present {
            return None;
        }
        block.present &= !(1 << (id % 64));
        let old = block.values.remove(place);
        if block.values.is_empty() {
            self.blocks.remove(&(id / 64));
        }
        Some(old)
    }

    /// Ids that have a value, in no order.
    fn ids(&self) -> impl Iterator<Item = u32> {
        self.blocks.iter().flat_map(|(number, block)| block.ids(*number))
    }
}

#[derive(Clone, Default, Debug)]
pub(crate) struct Attributes {
    names: Vec<Box<str>>,
    by_name: FxHashMap<Box<str>, Symbol>,
    columns: FxHashMap<(Domain, Symbol), Column>,
    links: FxHashMap<(Symbol, Node), SmallVec<[Node; 1]>>,
    back_links: FxHashMap<(Symbol, Node), SmallVec<[Node; 1]>>,
    /// Nodes from which at least one link starts, per label.
    linked: FxHashMap<Symbol, BTreeSet<Node>>,
    /// Labels that carry at least one link ever, so that removing an element looks at these only.
    labels: Vec<Symbol>,
}

impl Attributes {
    pub(crate) fn intern(&mut self, name: &str) -> Symbol {
        if let Some(&symbol) = self.by_name.get(name) {
            return symbol;
        }
        let symbol = Symbol(self.names.len() as u32);
        self.names.push(name.into());
        self.by_name.insert(name.into(), symbol);
        symbol
    }

    pub(crate) fn symbol(&self, name: &str) -> Option<Symbol> {
        self.by_name.get(name).copied()
    }

    pub(crate) fn name(&self, symbol: Symbol) -> &str {
        &self.names[symbol.0 as usize]
    }

    pub(crate) fn get(&self, node: Node, name: Symbol) -> Option<&Value> {
        self.columns.get(&(node.domain(), name))?.get(node.id())
    }

    pub(crate) fn set(&mut self, node: Node, name: Symbol, value: Option<Value>) -> Option<Value> {
        self.columns.entry((node.domain(), name)).or_default().set(node.id(), value)
    }

    /// Ids that carry exactly `value`, ascending.
    pub(crate) fn with_value(
        &self,
        domain: Domain,
        name: Symbol,
        value: &Value,
    ) -> impl Iterator<Item = u32> {
        self.columns
            .get(&(domain, name))
            .and_then(|column| column.index.get(&Key::from(value)))
            .into_iter()
            .flatten()
            .copied()
    }

    /// Ids that carry the attribute with any value, ascending.
    pub(crate) fn with_name(&self, domain: Domain, name: Symbol) -> Vec<u32> {
        let mut ids: Vec<u32> = self.columns.get(&(domain, name)).into_iter().flat_map(Column::ids).collect();
        ids.sort_unstable();
        ids
    }

    /// Attribute names that `node` carries, in the order in which the names were first used.
    pub(crate) fn names_of(&self, node: Node) -> Vec<Symbol> {
        let mut names: Vec<Symbol> = self
            .columns
            .iter()
            .filter(|((domain, _), column)| *domain == node.domain() && column.get(node.id()).is_some())
            .map(|((_, name), _)| *name)
            .collect();
        names.sort_unstable();
        names
    }

    pub(crate) fn links(&self, from: Node, label: Symbol) -> &[Node] {
        self.links.get(&(label, from)).map_or(&[], |nodes| nodes.as_slice())
    }

    /// Ids of the nodes from which a link starts, ascending.
    pub(crate) fn with_link(&self, domain: Domain, label: Symbol) -> impl Iterator<Item = u32> {
        let ends = Node::new(domain, 0)..=Node::new(domain, u32::MAX);
        self.linked
            .get(&label)
            .into_iter()
            .flat_map(move |nodes| nodes.range(ends.clone()))
            .map(|node| node.id())
    }

    pub(crate) fn back_links(&self, to: Node, label: Symbol) -> &[Node] {
        self.back_links.get(&(label, to)).map_or(&[], |nodes| nodes.as_slice())
    }

    /// Adds (`true`) or removes the link; returns false when nothing changed.
    pub(crate) fn set_link(&mut self, from: Node, label: Symbol, to: Node, present: bool) -> bool {
        let nodes = self.links.entry((label, from)).or_default();
        let at = nodes.iter().position(|&node| node == to);
        if at.is_some() == present {
            return false;
        }
        let back = self.back_links.entry((label, to)).or_default();
        if present {
            nodes.push(to);
            self.linked.entry(label).or_default().insert(from);
            back.push(from);
            if !self.labels.contains(&label) {
                self.labels.push(label);
            }
        } else {
            nodes.retain(|node| *node != to);
            if nodes.is_empty()
                && let Some(linked) = self.linked.get_mut(&label)
            {
                linked.remove(&from);
            }
            back.retain(|node| *node != from);
        }
        true
    }

    /// Every link that starts or ends at `node`, as (from, label, to).
    pub(crate) fn links_of(&self, node: Node) -> Vec<(Node, Symbol, Node)> {
        let mut found = Vec::new();
        for &label in &self.labels {
            found.extend(self.links(node, label).iter().map(|&to| (node, label, to)));
            found.extend(
                self.back_links(node, label)
                    .iter()
                    .filter(|&&from| from != node)
                    .map(|&from| (from, label, node)),
            );
        }
        found
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.columns.is_empty() && self.labels.is_empty()
    }

    /// Renumbers every node; nodes mapped to `None` lose what they carried.
    pub(crate) fn remap(&mut self, map: impl Fn(Node) -> Option<Node>) {
        for ((domain, _), column) in &mut self.columns {
            let old = std::mem::take(column);
            for (number, block) in old.blocks {
                for (id, value) in block.ids(number).zip(block.values) {
                    if let Some(node) = map(Node::new(*domain, id)) {
                        column.set(node.id(), Some(value));
                    }
                }
            }
        }
        let old = std::mem::take(&mut self.links);
        self.back_links.clear();
        self.linked.clear();
        // Sorted so that the order of several links from one node does not depend on hashing.
        let mut links: Vec<_> = old.into_iter().collect();
        links.sort_unstable_by_key(|(key, _)| *key);
        for ((label, from), nodes) in links {
            for to in nodes {
                if let (Some(from), Some(to)) = (map(from), map(to)) {
                    self.set_link(from, label, to, true);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{HalfEdgeId, VertexId};
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

        /// A column is a map from ids to values.
        #[test]
        fn columns_are_maps(changes in prop::collection::vec((0..200u32, prop::option::of(0..3i32)), 0..300)) {
            let mut attributes = Attributes::default();
            let name = attributes.intern("n");
            let mut map = BTreeMap::new();
            for (id, number) in changes {
                let value = number.map(|x| Value::Number(f64::from(x)));
                let old = attributes.set(Node::Vertex(VertexId(id)), name, value.clone());
                let expected = match value {
                    Some(value) => map.insert(id, value),
                    None => map.remove(&id),
                };
                prop_assert_eq!(old, expected);
            }
            for id in 0..200 {
                prop_assert_eq!(attributes.get(Node::Vertex(VertexId(id)), name), map.get(&id));
            }
            prop_assert_eq!(attributes.with_name(Domain::Vertex, name), map.keys().copied().collect::<Vec<_>>());
            for number in 0..3 {
                let value = Value::Number(f64::from(number));
                let ids: Vec<u32> = attributes.with_value(Domain::Vertex, name, &value).collect();
                let expected: Vec<u32> = map.iter().filter(|(_, v)| **v == value).map(|(id, _)| *id).collect();
                prop_assert_eq!(ids, expected);
            }
        }
    }

    #[test]
    fn link_sources_are_listed_as_long_as_a_link_starts_there() {
        let mut attributes = Attributes::default();
        let label = attributes.intern("span");
        let [a, b] = [3, 1].map(|id| Node::HalfEdge(HalfEdgeId(id)));
        let v = Node::Vertex(VertexId(7));
        for (from, to) in [(a, b), (a, v), (b, a), (v, a)] {
            attributes.set_link(from, label, to, true);
        }
        let sources =
            |attributes: &Attributes, domain| attributes.with_link(domain, label).collect::<Vec<_>>();
        assert_eq!(sources(&attributes, Domain::HalfEdge), [1, 3]);
        assert_eq!(sources(&attributes, Domain::Vertex), [7]);
        attributes.set_link(a, label, b, false);
        assert_eq!(sources(&attributes, Domain::HalfEdge), [1, 3]);
        attributes.set_link(a, label, v, false);
        assert_eq!(sources(&attributes, Domain::HalfEdge), [1]);
        attributes.remap(|node| Some(Node::new(node.domain(), node.id() + 10)));
        assert_eq!(sources(&attributes, Domain::HalfEdge), [11]);
    }
}
