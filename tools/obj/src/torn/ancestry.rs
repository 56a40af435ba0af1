//! Which vertices were one, and since which cut they are not.
//!
//! Vertices of one root form a tree: each split joins the new vertex to the old one by
//! a link that bears the number of the cut. Two vertices are apart since the oldest cut on
//! the way between them, so undoing every cut after number k joins exactly those
//! with younger links between them. A merge contracts the tree: of the two ways round, the
//! oldest link is dropped. The tree is no history, then, but all that is needed to undo cuts.
//!
//! Ids of vertices change where vertices are merged; nodes of the tree never do. They are numbered
//! as the `v` of the document, and behind these as vertices were added. Nodes whose vertices were
//! merged are a set, and the leader of the set, the lowest, is the node of the vertex.

use tearmesh::DisjointSets;

use crate::record::SplitOff;

/// Not younger than any cut: vertices that are one are apart since then.
pub(super) const NEVER: u32 = u32::MAX;

/// The trees of all roots.
#[derive(Clone, Debug)]
pub(super) struct Ancestry {
    /// The node of each vertex. Empty, as the tree is, until something is split, inserted or
    /// merged: up to then each vertex is a tree.
    nodes: Vec<u32>,
    tree: Vec<Node>,
    /// Sets of nodes that are one vertex.
    merged: DisjointSets,
    classes: u32,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// A node that is now of the vertex above; at the top of a tree, one of the same vertex.
    from: u32,
    /// The cut between. Of nodes of one vertex, only the leader's `from` and `cut` count.
    cut: u32,
    /// The vertices of one root have one class, which never changes.
    class: u32,
}

impl Ancestry {
    /// `count` vertices, each its own root but for those that were split off, which are in
    /// ascending order, each from a lower one. The class of a vertex is then its root.
    pub(super) fn new(count: usize, splits: &[SplitOff]) -> Ancestry {
        let mut ancestry = Ancestry {
            nodes: Vec::new(),
            tree: Vec::new(),
            merged: DisjointSets::default(),
            classes: count as u32,
        };
        if splits.is_empty() {
            return ancestry;
        }
        ancestry.plant();
        let tree = &mut ancestry.tree;
        for split in splits {
            tree[split.vertex as usize] = Node {
                from: split.from,
                cut: split.cut,
                class: tree[split.from as usize].class,
            };
        }
        ancestry
    }

    /// Makes a tree of each vertex, if there are none yet.
    fn plant(&mut self) {
        if self.is_whole() {
            let alone = |v| Node {
                from: v,
                cut: NEVER,
                class: v,
            };
            self.nodes = (0..self.classes).collect();
            self.tree = (0..self.classes).map(alone).collect();
            self.merged.reset(self.classes);
        }
    }

    /// The number of vertices.
    pub(super) fn len(&self) -> usize {
        if self.is_whole() {
            self.class_count()
        } else {
            self.nodes.len()
        }
    }

    /// Whether nothing was split, inserted or merged yet.
    pub(super) fn is_whole(&self) -> bool {
        self.tree.is_empty()
    }

    /// The class of a vertex.
    pub(super) fn class(&self, v: usize) -> u32 {
        if self.is_whole() {
            return v as u32;
        }
        self.tree[self.nodes[v] as usize].class
    }

    /// The node of a vertex. It is the `v` of the document that the vertex is; behind these, new
    /// vertices come in the order in which they were made. Of vertices that became one, the first stands
    /// for all.
    pub(super) fn node(&self, v: usize) -> u32 {
        self.nodes.get(v).copied().unwrap_or(v as u32)
    }

    /// For each node the vertex that it is, or was merged into.
    pub(super) fn vertices_of_nodes(&mut self) -> Vec<u32> {
        self.plant();
        let mut vertices = vec![u32::MAX; self.tree.len()];
        for (&node, v) in self.nodes.iter().zip(0..) {
            vertices[node as usize] = v;
        }
        for node in 0..self.tree.len() as u32 {
            vertices[node as usize] = vertices[self.merged.leader(node) as usize];
        }
        vertices
    }

    /// Above every class.
    pub(super) fn class_count(&self) -> usize {
        self.classes as usize
    }

    fn push(&mut self, from: Option<(u32, u32)>) {
        let node = self.tree.len() as u32;
        let (from, cut) = from.unwrap_or((node, NEVER));
        let class = if from == node {
            self.classes += 1;
            self.classes - 1
        } else {
            self.tree[from as usize].class
        };
        self.tree.push(Node { from, cut, class });
        self.merged.push();
        self.nodes.push(node);
    }

    /// Adds a vertex of a class of its own.
    pub(super) fn insert(&mut self) {
        self.plant();
        self.push(None);
    }

    /// Adds a vertex that is apart from another since a cut.
    pub(super) fn split(&mut self, old: usize, cut: u32) {
        self.plant();
        self.push(Some((self.nodes[old], cut)));
    }

    /// The node above, with the cut between; `None` at the top.
    fn above(&mut self, node: u32) -> Option<(u32, u32)> {
        let Node { from, cut, .. } = self.tree[node as usize];
        let above = self.merged.leader(from);
        (above != node).then_some((above, cut))
    }

    /// The oldest link between two nodes of one tree: the node below it, whether that is on the
    /// side of the first, and the cut. `None` for one and the same.
    fn oldest_between(&mut self, one: u32, other: u32) -> Option<(u32, bool, u32)> {
        let mut ups = [Vec::new(), Vec::new()];
        for (mut node, up) in [one, other].into_iter().zip(&mut ups) {
            while let Some((above, cut)) = self.above(node) {
                up.push((node, cut));
                node = above;
            }
        }
        let [mut first, mut second] = ups;
        while let (Some(a), Some(b)) = (first.last(), second.last())
            && a.0 == b.0
        {
            first.pop();
            second.pop();
        }
        let sides = [(first, true), (second, false)];
        let links = sides
            .into_iter()
            .flat_map(|(up, side)| up.into_iter().map(move |(node, cut)| (node, side, cut)));
        links.min_by_key(|&(.., cut)| cut)
    }

    /// The cut since which two vertices of one class are apart; [`NEVER`] for one vertex.
    pub(super) fn apart_since(&mut self, one: usize, other: usize) -> u32 {
        self.plant();
        let [one, other] = [one, other].map(|v| self.nodes[v]);
        self.oldest_between(one, other)
            .map_or(NEVER, |(.., cut)| cut)
    }

    /// `gone` becomes `kept`, and the last vertex gets its id.
    ///
    /// # Panics
    ///
    /// If they are not of one class, or `gone` is not the higher one.
    pub(super) fn merge(&mut self, kept: usize, gone: usize) {
        assert_eq!(self.class(kept), self.class(gone), "both have one root");
        assert!(kept < gone, "the lower id is kept");
        self.plant();
        let vertex = kept;
        let (kept, gone) = (self.nodes[kept], self.nodes.swap_remove(gone));
        if let Some((below, on_side_of_kept, _)) = self.oldest_between(kept, gone) {
            let (stays, goes) = if on_side_of_kept {
                (gone, kept)
            } else {
                (kept, gone)
            };
            self.turn(goes, below);
            let Node { from, cut, .. } = self.tree[stays as usize];
            self.merged.join(stays, goes);
            let leader = self.merged.leader(stays);
            let node = &mut self.tree[leader as usize];
            (node.from, node.cut) = (from, cut);
            self.nodes[vertex] = leader;
        }
    }

    /// Cuts a tree above the node `top`, and makes `node` the top of what hangs there.
    fn turn(&mut self, node: u32, top: u32) {
        let mut below: Option<(u32, u32)> = None;
        let mut at = node;
        loop {
            let above = if at == top { None } else { self.above(at) };
            let (from, cut) = below.unwrap_or((at, NEVER));
            let cut_above = above.map_or(NEVER, |(_, cut)| cut);
            self.tree[at as usize].from = from;
            self.tree[at as usize].cut = cut;
            let Some((next, _)) = above else { return };
            below = Some((at, cut_above));
            at = next;
        }
    }

    /// The vertices by these numbers that are not the lowest of their class, ascending, each with
    /// the lowest of those that it is apart from most recently. What is apart since when says all.
    /// Classes whose vertices have no number, [`u32::MAX`], are left out.
    pub(super) fn split_off(&mut self, number: impl Fn(u32) -> u32) -> Vec<SplitOff> {
        let mut number_of = vec![u32::MAX; self.tree.len()];
        for (&node, v) in self.nodes.iter().zip(0..) {
            number_of[node as usize] = number(v);
        }
        // The links between vertices, the youngest first: those of one cut join what is younger
        // all at once, so that no order among them shows.
        let mut links = Vec::new();
        for v in 0..self.nodes.len() {
            let node = self.nodes[v];
            if let Some((above, cut)) = self.above(node)
                && number_of[node as usize] != u32::MAX
            {
                links.push((cut, number_of[node as usize], number_of[above as usize]));
            }
        }
        links.sort_unstable_by(|a, b| b.cmp(a));
        let ends = links.iter().flat_map(|&(_, one, other)| [one, other]);
        let above_all = ends.max().map_or(0, |highest| highest + 1);
        let mut joined = DisjointSets::new(above_all);
        let mut split_off = Vec::with_capacity(links.len());
        for of_cut in links.chunk_by(|a, b| a.0 == b.0) {
            let cut = of_cut[0].0;
            let first = split_off.len();
            for &(_, one, other) in of_cut {
                let vertex = joined.leader(one).max(joined.leader(other));
                joined.join(one, other);
                let from = vertex; // Known once all links of the cut are joined.
                split_off.push(SplitOff { vertex, from, cut });
            }
            for split in &mut split_off[first..] {
                split.from = joined.leader(split.vertex);
            }
        }
        split_off.sort_unstable_by_key(|split| split.vertex);
        split_off
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(ancestry: &mut Ancestry) -> Vec<[u32; 3]> {
        let all = ancestry.split_off(|v| v).into_iter();
        all.map(|s| [s.vertex, s.from, s.cut]).collect()
    }

    #[test]
    fn a_split_of_a_copy_is_told_from_one_of_the_first() {
        let mut ancestry = Ancestry::new(1, &[]);
        ancestry.split(0, 1); // 1
        ancestry.split(1, 2); // 2, from 1
        ancestry.split(0, 2); // 3, from 0
        assert_eq!(described(&mut ancestry), [[1, 0, 1], [2, 1, 2], [3, 0, 2]]);
        assert_eq!(ancestry.apart_since(2, 3), 1);
        assert_eq!(ancestry.apart_since(2, 1), 2);
    }

    #[test]
    fn a_merge_drops_the_oldest_link_of_two_ways() {
        let mut ancestry = Ancestry::new(1, &[]);
        ancestry.split(0, 1);
        ancestry.split(1, 2);
        ancestry.merge(0, 2); // 1 is apart from both: since 1 and since 2.
        assert_eq!(described(&mut ancestry), [[1, 0, 2]]);
        ancestry.merge(0, 1);
        assert_eq!(described(&mut ancestry), [[0; 3]; 0]);
    }

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
                let mut again = Ancestry::new(table.len(), &split_off);
                for (one, row) in table.iter().enumerate() {
                    for (other, &since) in row.iter().enumerate() {
                        assert_eq!(ancestry.apart_since(one, other), since);
                        assert_eq!(again.apart_since(one, other), since);
                    }
                }
                assert_eq!(again.split_off(|v| v), split_off, "it has one form");
                assert!(split_off.iter().all(|split| split.from < split.vertex));
            }
        }
    }
}
