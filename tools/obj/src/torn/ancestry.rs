//! Which vertices were one, and since which cut they are not.
//!
//! Each split links the new vertex with the old one, and the link bears the number of the cut; a merge
//! makes two vertices one again. Two vertices are apart since the oldest cut on the way between them, or
//! on the one of several ways whose oldest cut is the youngest. So undoing every cut after number k joins
//! exactly those with younger links between them.
//!
//! Ids of vertices change where vertices are merged; nodes never do. They are numbered
//! as the `v` of the document, and behind these as vertices were added. Nodes whose vertices were
//! merged are a set, and the representative of the set, the lowest, is the node of the vertex.

use tearmesh::DisjointSets;

use crate::record::SplitOff;

/// Not younger than any cut: vertices that are one are apart since then.
const NEVER: u32 = u32::MAX;

/// What was split, inserted and merged.
#[derive(Clone, Debug)]
pub(super) struct Ancestry {
    /// The node of each vertex.
    nodes: Vec<u32>,
    /// The class of each node: the vertices of one root have one, which never changes.
    classes: Vec<u32>,
    /// For each split, the cut and the two nodes.
    links: Vec<(u32, [u32; 2])>,
    /// For each merge, the nodes of the two vertices.
    merged: Vec<[u32; 2]>,
    class_count: u32,
}

impl Ancestry {
    /// `count` vertices, each its own root but for those that were split off, which are in
    /// ascending order, each from a lower one. The class of a vertex is then its root.
    pub(super) fn new(count: usize, splits: &[SplitOff]) -> Ancestry {
        let count = count as u32;
        let mut classes: Vec<u32> = (0..count).collect();
        for split in splits {
            classes[split.vertex as usize] = classes[split.from as usize];
        }
        let links = splits
            .iter()
            .map(|split| (split.cut, [split.from, split.vertex]));
        Ancestry {
            nodes: (0..count).collect(),
            classes,
            links: links.collect(),
            merged: Vec::new(),
            class_count: count,
        }
    }

    /// The number of vertices.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The class of a vertex.
    pub(super) fn class(&self, v: usize) -> u32 {
        self.classes[self.nodes[v] as usize]
    }

    /// The node of a vertex. It is the `v` of the document that the vertex is; behind these, new
    /// vertices come in the order in which they were made. Of vertices that became one, the first stands
    /// for all.
    pub(super) fn node(&self, v: usize) -> u32 {
        self.nodes[v]
    }

    /// For each node the vertex that it is, or was merged into.
    pub(super) fn vertices_of_nodes(&self) -> Vec<u32> {
        let mut vertices = vec![u32::MAX; self.classes.len()];
        for (&node, v) in self.nodes.iter().zip(0..) {
            vertices[node as usize] = v;
        }
        let representatives = self.representatives().into_iter();
        representatives
            .map(|representative| vertices[representative as usize])
            .collect()
    }

    /// For each node the one that stands for all of its vertex.
    fn representatives(&self) -> Vec<u32> {
        let mut sets = DisjointSets::new(self.classes.len() as u32);
        for &[kept, gone] in &self.merged {
            sets.join(kept, gone);
        }
        sets.representatives().to_vec()
    }

    /// Above every class.
    pub(super) fn class_count(&self) -> usize {
        self.class_count as usize
    }

    /// Adds a vertex of a class of its own.
    pub(super) fn insert(&mut self) {
        self.push(self.class_count);
        self.class_count += 1;
    }

    /// Adds a vertex that is apart from another since a cut.
    pub(super) fn split(&mut self, old: usize, cut: u32) {
        let old = self.nodes[old];
        let new = self.push(self.classes[old as usize]);
        self.links.push((cut, [old, new]));
    }

    fn push(&mut self, class: u32) -> u32 {
        let node = self.classes.len() as u32;
        self.classes.push(class);
        self.nodes.push(node);
        node
    }

    /// `gone` becomes `kept`, and the last vertex gets its id.
    ///
    /// # Panics
    ///
    /// If they are not of one class, or `gone` is not the higher one.
    pub(super) fn merge(&mut self, kept: usize, gone: usize) {
        assert_eq!(self.class(kept), self.class(gone), "both have one root");
        assert!(kept < gone, "the lower id is kept");
        let gone = self.nodes.swap_remove(gone);
        self.merged.push([self.nodes[kept], gone]);
        self.nodes[kept] = self.nodes[kept].min(gone);
    }

    /// The links between vertices, the youngest first, with a number of each node's vertex.
    fn youngest_links(&self, number: impl Fn(u32) -> u32) -> Vec<(u32, [u32; 2])> {
        let representatives = self.representatives();
        let number = |node: u32| number(representatives[node as usize]);
        let links = self.links.iter();
        let mut links: Vec<_> = links
            .map(|&(cut, nodes)| (cut, nodes.map(number)))
            .collect();
        links.sort_unstable_by(|a, b| b.cmp(a));
        links
    }

    /// Since which cuts vertices are apart now.
    pub(super) fn distances(&self) -> Distances {
        let mut above: Vec<(u32, u32)> = (0..self.classes.len() as u32)
            .map(|node| (0, node))
            .collect();
        let mut sizes = vec![1_u32; above.len()];
        for (cut, nodes) in self.youngest_links(|node| node) {
            let tops = nodes.map(|mut node| {
                while above[node as usize].0 > 0 {
                    node = above[node as usize].1;
                }
                node
            });
            let [mut low, mut high] = tops;
            if low != high {
                if sizes[low as usize] > sizes[high as usize] {
                    (low, high) = (high, low);
                }
                above[low as usize] = (cut, high);
                sizes[high as usize] += sizes[low as usize];
            }
        }
        Distances(above)
    }

    /// The vertices by these numbers that are not the lowest of their class, ascending, each with
    /// the lowest of those that it is apart from most recently. What is apart since when says all.
    pub(super) fn split_off(&self, number: impl Fn(u32) -> u32) -> Vec<SplitOff> {
        let mut numbers = vec![u32::MAX; self.classes.len()];
        for (&node, v) in self.nodes.iter().zip(0..) {
            numbers[node as usize] = number(v);
        }
        // The links of one cut join what is younger all at once, so that no order among them shows.
        let links = self.youngest_links(|node| numbers[node as usize]);
        let ends = links.iter().flat_map(|&(_, ends)| ends);
        let mut joined = DisjointSets::new(ends.max().map_or(0, |highest| highest + 1));
        let mut split_off = Vec::with_capacity(links.len());
        for of_cut in links.chunk_by(|a, b| a.0 == b.0) {
            let first = split_off.len();
            for &(cut, ends) in of_cut {
                let [one, other] = ends.map(|end| joined.representative(end));
                if one != other {
                    joined.join(one, other);
                    let vertex = one.max(other);
                    let from = vertex; // Known once all links of the cut are joined.
                    split_off.push(SplitOff { vertex, from, cut });
                }
            }
            for split in &mut split_off[first..] {
                split.from = joined.representative(split.vertex);
            }
        }
        split_off.sort_unstable_by_key(|split| split.vertex);
        split_off
    }
}

/// Since which cuts nodes are apart: trees in which each node has another one above it, since a cut that is
/// no younger than those below. At the top, the cut is 0.
pub(crate) struct Distances(Vec<(u32, u32)>);

impl Distances {
    /// Those of `count` vertices, of which some were split off.
    pub(crate) fn of(count: usize, splits: &[SplitOff]) -> Distances {
        Ancestry::new(count, splits).distances()
    }

    /// The cut since which two vertices of one class are apart; [`NEVER`] for one vertex.
    pub(crate) fn apart_since(&self, mut one: u32, mut other: u32) -> u32 {
        let mut since = NEVER;
        while one != other {
            if self.0[one as usize].0 < self.0[other as usize].0 {
                std::mem::swap(&mut one, &mut other);
            }
            (since, one) = self.0[one as usize];
        }
        since
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random trees: what is apart since when, against a table of all pairs.
    #[test]
    fn the_tree_is_the_table_of_all_pairs() {
        let mut state = 1_u64;
        let mut below = |bound: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % bound
        };
        for _ in 0..300 {
            let mut ancestry = Ancestry::new(1, &[]);
            let mut table = vec![vec![NEVER]];
            let (mut homes, mut born) = (vec![0], 1);
            for step in 0..24 {
                let count = table.len();
                if count > 1 && below(3) == 0 {
                    let kept = below(count - 1);
                    let gone = kept + 1 + below(count - kept - 1);
                    ancestry.merge(kept, gone);
                    let old = table.clone();
                    for (x, row) in table.iter_mut().enumerate() {
                        for (y, entry) in row.iter_mut().enumerate() {
                            let through = old[x][kept].min(old[gone][y]);
                            let back = old[x][gone].min(old[kept][y]);
                            *entry = (*entry).max(through).max(back);
                        }
                    }
                    table.swap_remove(gone);
                    for row in &mut table {
                        row.swap_remove(gone);
                    }
                    homes[kept] = homes[kept].min(homes[gone]);
                    homes.swap_remove(gone);
                } else {
                    let old = below(count);
                    ancestry.split(old, 1 + step / 5);
                    let mut row = table[old].clone();
                    row[old] = 1 + step / 5;
                    for (v, entry) in row.iter().enumerate() {
                        table[v].push(*entry);
                    }
                    row.push(NEVER);
                    table.push(row);
                    homes.push(born);
                    born += 1;
                }
                for (v, home) in homes.iter().enumerate() {
                    assert_eq!(ancestry.node(v), *home);
                }
                let split_off = ancestry.split_off(|v| v);
                let again = Ancestry::new(table.len(), &split_off);
                let [distances, distances_again] = [&ancestry, &again].map(Ancestry::distances);
                for (one, row) in table.iter().enumerate() {
                    for (other, &since) in row.iter().enumerate() {
                        let nodes = [one, other].map(|v| ancestry.node(v));
                        assert_eq!(distances.apart_since(nodes[0], nodes[1]), since);
                        let [one, other] = [one as u32, other as u32];
                        assert_eq!(distances_again.apart_since(one, other), since);
                    }
                }
                assert_eq!(again.split_off(|v| v), split_off, "it has one form");
                assert!(split_off.iter().all(|split| split.from < split.vertex));
            }
        }
    }
}
