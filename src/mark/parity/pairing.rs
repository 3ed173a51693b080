//! Pairs of greatest total gain: a maximum-weight matching of a general graph (Edmonds 1965).
//!
//! Groups of up to [`EXACT`] nodes are solved exactly, by the blossom algorithm. In larger ones pairs are first taken
//! greedily, then every neighbourhood of up to [`EXACT`] nodes is solved exactly in turn.

use super::cost::Cost;
use integer_blossom::max_weight_matching;
use std::cmp::Reverse;
use std::collections::VecDeque;

/// Nodes that are solved exactly together; the time grows with the cube of this.
const EXACT: usize = 200;

/// A matching.
pub(super) struct Pairing {
    /// The partner of each node.
    pub(super) mates: Vec<Option<usize>>,
    /// Its gain is the greatest there is.
    pub(super) is_exact: bool,
}

/// Pairs `nodes` nodes. `gains` lists what pairs would gain, each pair once, all greater than 0.
pub(super) fn pair(nodes: usize, gains: &[(usize, usize, Cost)]) -> Pairing {
    let mut graph = Graph { neighbours: vec![Vec::new(); nodes], mates: vec![None; nodes] };
    for &(a, b, gain) in gains {
        graph.neighbours[a].push((b, gain));
        graph.neighbours[b].push((a, gain));
    }
    let mut seen = vec![false; nodes];
    let mut is_exact = true;
    for start in 0..nodes {
        if seen[start] {
            continue;
        }
        let group = graph.around(start, usize::MAX);
        group.iter().for_each(|&node| seen[node] = true);
        if group.len() <= EXACT {
            graph.solve(&group);
        } else {
            is_exact = false;
            graph.take_greedily(&group);
            for &node in &group {
                let near = graph.around(node, EXACT);
                graph.solve(&near);
            }
        }
    }
    Pairing { mates: graph.mates, is_exact }
}

struct Graph {
    neighbours: Vec<Vec<(usize, Cost)>>,
    mates: Vec<Option<usize>>,
}

impl Graph {
    /// Up to `most` nodes around `start`, each with its mate; nearest first.
    fn around(&self, start: usize, most: usize) -> Vec<usize> {
        let mut found = Vec::new();
        let mut seen = rustc_hash::FxHashSet::default();
        let mut queue = VecDeque::from([start]);
        while let Some(node) = queue.pop_front() {
            let both = [Some(node), self.mates[node]];
            let new: Vec<usize> = both.into_iter().flatten().filter(|node| !seen.contains(node)).collect();
            if found.len() + new.len() > most {
                break;
            }
            seen.extend(new.iter().copied());
            for &node in &new {
                queue.extend(self.neighbours[node].iter().map(|entry| entry.0).filter(|n| !seen.contains(n)));
            }
            found.extend(new);
        }
        found
    }

    /// Pairs the nodes of `group`, which are free or paired among themselves, anew.
    fn solve(&mut self, group: &[usize]) {
        let mut order = group.to_vec();
        order.sort_unstable();
        let n = order.len();
        let mut weights = vec![0; n * n];
        for (i, &node) in order.iter().enumerate() {
            for &(other, gain) in &self.neighbours[node] {
                if let Ok(j) = order.binary_search(&other) {
                    weights[i * n + j] = gain;
                }
            }
        }
        for (&node, mate) in order.iter().zip(max_weight_matching(&weights, n)) {
            self.mates[node] = mate.and_then(|j| order.get(j).copied());
        }
    }

    /// Pairs the nodes of `group`, the greatest gain first.
    fn take_greedily(&mut self, group: &[usize]) {
        let mut gains: Vec<(Reverse<Cost>, usize, usize)> = group
            .iter()
            .flat_map(|&a| self.neighbours[a].iter().map(move |&(b, gain)| (Reverse(gain), a, b)))
            .filter(|&(_, a, b)| a < b)
            .collect();
        gains.sort_unstable();
        for (_, a, b) in gains {
            if self.mates[a].is_none() && self.mates[b].is_none() {
                self.mates[a] = Some(b);
                self.mates[b] = Some(a);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest gain by trying all matchings of up to 16 nodes: dynamic programming over sets.
    fn brute_force(nodes: usize, gains: &[(usize, usize, Cost)]) -> Cost {
        let mut best = vec![0; 1 << nodes];
        for set in 1_usize..1 << nodes {
            let low = set.trailing_zeros() as usize;
            let rest = set & !(1 << low);
            best[set] = best[rest];
            for &(a, b, gain) in gains {
                let other = if a == low { b } else { a };
                if (a == low || b == low) && rest & (1 << other) != 0 {
                    best[set] = best[set].max(gain + best[rest & !(1 << other)]);
                }
            }
        }
        best[(1 << nodes) - 1]
    }

    fn total(gains: &[(usize, usize, Cost)], pairing: &Pairing) -> Cost {
        for (a, mate) in pairing.mates.iter().enumerate() {
            assert!(mate.is_none_or(|b| pairing.mates[b] == Some(a)), "{a} is the mate of its mate");
        }
        gains.iter().filter(|&&(a, b, _)| pairing.mates[a] == Some(b)).map(|gain| gain.2).sum()
    }

    /// A random graph by a linear congruential generator (Knuth's MMIX).
    fn random(nodes: usize, edges: usize, mut state: u64) -> Vec<(usize, usize, Cost)> {
        let mut next = |bound: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % bound
        };
        let mut gains = std::collections::BTreeMap::new();
        for _ in 0..edges {
            let (a, b) = (next(nodes), next(nodes));
            if a != b {
                gains.insert((a.min(b), a.max(b)), 1 + next(1000) as Cost);
            }
        }
        gains.into_iter().map(|((a, b), gain)| (a, b, gain)).collect()
    }

    #[test]
    fn small_groups_are_paired_best() {
        for seed in 0..300 {
            let nodes = 3 + seed % 10;
            let gains = random(nodes, 1 + seed % 40, seed as u64);
            let pairing = pair(nodes, &gains);
            assert!(pairing.is_exact);
            assert_eq!(total(&gains, &pairing), brute_force(nodes, &gains), "seed {seed}: {gains:?}");
        }
    }

    #[test]
    fn large_groups_are_paired_well() {
        // The exact optimum of the whole graph comes from the crate at once.
        let (nodes, mut worst) = (300, 1.0_f64);
        for seed in 0..2 {
            let gains = random(nodes, 3 * nodes, seed);
            let pairing = pair(nodes, &gains);
            assert!(!pairing.is_exact);
            let mut weights = vec![0; nodes * nodes];
            gains.iter().for_each(|&(a, b, gain)| weights[a * nodes + b] = gain);
            let mates = max_weight_matching(&weights, nodes);
            let best = total(&gains, &Pairing { mates, is_exact: true });
            worst = worst.min(total(&gains, &pairing) as f64 / best as f64);
        }
        assert!(worst > 0.99, "{worst} of the greatest gain");
    }
}
