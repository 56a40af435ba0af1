//! Taking out what was inserted: the input comes back once everything is sewn, and before that
//! everything goes that a plain search finds.
//!
//! The search knows the records and the roots. It begins with all divided faces, and strikes out those
//! that cannot be restored until nothing changes.

use std::collections::BTreeSet;

use tearmesh::script::World;
use tearmesh::{CornerSource, DerivedMesh, Edit, HalfEdgeId, Insertions, Mesh, VertexId, mend};

use crate::cases::scripts;
use crate::random::Random;

/// A divided face: each child by its face, and which corners of the parent it has; and the points
/// inside.
struct Division {
    parent: usize,
    children: Vec<(usize, [Option<usize>; 3])>,
    points: BTreeSet<usize>,
}

/// What a plain reading of the records says.
struct Plain {
    /// The points that each vertex was, of which several may have become one.
    points: Vec<BTreeSet<usize>>,
    divisions: Vec<Division>,
    count: usize,
    seen: u64,
}

impl Plain {
    fn new(mesh: &Mesh) -> Plain {
        Plain {
            points: vec![BTreeSet::new(); mesh.vertex_count()],
            divisions: Vec::new(),
            count: 0,
            seen: 0,
        }
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        if edit.number() < self.seen {
            return;
        }
        self.seen += 1;
        match edit {
            Edit::Split(split) => self.points.push(self.points[split.old.index()].clone()),
            Edit::Merge(merge) => {
                let gone = self.points.swap_remove(merge.gone.index());
                self.points[merge.kept.index()].extend(gone);
            }
            Edit::Slide(_) => {}
            Edit::Insert(insert) => {
                for _ in insert.points {
                    self.points.push(BTreeSet::from([self.count]));
                    self.count += 1;
                }
                let mut parents: Vec<usize> = insert
                    .children
                    .iter()
                    .map(|child| child.parent.index())
                    .collect();
                parents.dedup();
                for parent in parents {
                    let own = insert
                        .children
                        .iter()
                        .filter(|child| child.parent.index() == parent);
                    let mut division = Division {
                        parent,
                        children: Vec::new(),
                        points: BTreeSet::new(),
                    };
                    for child in own {
                        let mut corners = [None; 3];
                        for (i, source) in child.sources.iter().enumerate() {
                            match source {
                                CornerSource::Corner(h) => corners[i] = Some(h.index() % 3),
                                _ => division
                                    .points
                                    .extend(&self.points[child.vertices[i].index()]),
                            }
                        }
                        division.children.push((child.face.index(), corners));
                    }
                    self.divisions.push(division);
                }
            }
        }
    }

    /// The division of the child of one.
    fn later(&self, division: usize, child: usize) -> Option<usize> {
        let mut later = division + 1..self.divisions.len();
        later.find(|&later| self.divisions[later].parent == child)
    }

    /// The corners of the mesh that stand at a corner of what was divided.
    fn corners_at(&self, division: usize, corner: usize) -> Vec<usize> {
        let mut found = Vec::new();
        for &(face, corners) in &self.divisions[division].children {
            for own in (0..3).filter(|&own| corners[own] == Some(corner)) {
                match self.later(division, face) {
                    Some(later) => found.extend(self.corners_at(later, own)),
                    None => found.push(3 * face + own),
                }
            }
        }
        found
    }

    /// The vertices that go, and how many faces there are then.
    fn undone(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(usize) -> bool,
        value: impl Fn(usize) -> bool,
    ) -> (BTreeSet<usize>, usize) {
        let roots = mesh.roots();
        let copies = |v: usize| roots.iter().filter(|&&root| root == roots[v]).count();
        let mut goes: BTreeSet<usize> = (0..self.points.len())
            .filter(|&v| !self.points[v].is_empty() && copies(v) == 1 && may_go(v))
            .collect();
        let mut whole: BTreeSet<usize> = (0..self.divisions.len()).collect();
        loop {
            let before = (goes.len(), whole.len());
            let is_whole = |&division: &usize| {
                let Division {
                    children, points, ..
                } = &self.divisions[division];
                let inner = children
                    .iter()
                    .filter_map(|&(face, _)| self.later(division, face));
                let all_go = points
                    .iter()
                    .all(|point| goes.iter().any(|&v| self.points[v].contains(point)));
                let agree = (0..3).all(|corner| {
                    let at = self.corners_at(division, corner);
                    at.iter().all(|&h| {
                        mesh.indices()[h] == mesh.indices()[at[0]] && value(h) == value(at[0])
                    })
                });
                all_go && agree && inner.into_iter().all(|inner| whole.contains(&inner))
            };
            whole = whole.iter().copied().filter(is_whole).collect();
            goes.retain(|&v| {
                let mut of_point = (0..self.divisions.len()).filter(|&division| {
                    !self.divisions[division].points.is_disjoint(&self.points[v])
                });
                of_point.all(|division| whole.contains(&division))
            });
            if before == (goes.len(), whole.len()) {
                break;
            }
        }
        let fewer = whole
            .iter()
            .map(|&division| self.divisions[division].children.len() - 1);
        (goes, mesh.face_count() - fewer.sum::<usize>())
    }
}

/// What is made of a mesh is one, and its maps are true.
fn check_maps(mesh: &Mesh, made: &DerivedMesh) {
    let own = made.mesh();
    assert_eq!(own.check(), []);
    assert!(made.vertices().is_sorted_by(|a, b| a < b) && made.faces().is_sorted_by(|a, b| a < b));
    assert_eq!(
        [own.vertex_count(), own.face_count()],
        [made.vertices().len(), made.faces().len()]
    );
    for h in own.half_edges() {
        let source = made.corners()[h.index()];
        assert_eq!(made.corner_of(source), Some(h));
        assert_eq!(
            made.vertices()[own.origin(h).index()],
            mesh.origin(source),
            "{h}"
        );
    }
    let here = mesh.half_edges().filter(|&h| made.corner_of(h).is_some());
    assert_eq!(here.count(), own.half_edge_count(), "corners that are gone");
    for v in own.vertices() {
        let [source, root] = [v, own.root(v)].map(|v| made.vertices()[v.index()]);
        assert_eq!(root, mesh.root(source), "the root of {v}");
    }
}

#[test]
fn the_input_comes_back_once_everything_is_sewn_and_before_that_what_keeps_nothing_apart_goes() {
    let (mut count, mut sewn, mut partly) = (0, 0, 0);
    let (mut removed, mut left, mut kept_by_value) = (0, 0, 0);
    for (seed, script) in scripts(3_000).enumerate() {
        count += 1;
        let mut random = Random(seed as u64);
        let mut beside: Option<(Mesh, Insertions, Plain)> = None;
        let look = |world: &World, plain: &Plain, insertions: &Insertions, random: &mut Random| {
            let mesh = &world.mesh;
            let any = random.next();
            let stays: Vec<bool> = mesh.vertices().map(|_| random.next() < any * any).collect();
            let values: Vec<bool> = mesh
                .half_edges()
                .map(|_| random.next() < 0.05 * any)
                .collect();
            let (goes, faces) = plain.undone(mesh, |v| !stays[v], |h| values[h]);
            let agree = |a: HalfEdgeId, b: HalfEdgeId| values[a.index()] == values[b.index()];
            let made = insertions.undone(mesh, |v: VertexId| !stays[v.index()], agree);
            let all: BTreeSet<usize> = (0..mesh.vertex_count()).collect();
            let Some(made) = made else {
                assert!(goes.is_empty(), "{goes:?} may go, after\n{script}");
                return (0, 0, 0);
            };
            check_maps(mesh, &made);
            let kept: BTreeSet<usize> = made.vertices().iter().map(|v| v.index()).collect();
            assert_eq!(
                all.difference(&kept).copied().collect::<BTreeSet<_>>(),
                goes,
                "after\n{script}"
            );
            assert_eq!(made.faces().len(), faces, "after\n{script}");
            let (freely, _) = plain.undone(mesh, |v| !stays[v], |_| true);
            let inserted = plain
                .points
                .iter()
                .filter(|points| !points.is_empty())
                .count();
            (goes.len(), inserted - goes.len(), freely.len() - goes.len())
        };
        let mut world = script.run(|world, _| {
            let (_, insertions, plain) = beside.get_or_insert_with(|| {
                (
                    world.mesh.clone(),
                    Insertions::new(&world.mesh),
                    Plain::new(&world.mesh),
                )
            });
            world.edits.replay(&mut *insertions);
            world.edits.iter().for_each(|edit| plain.follow(&edit));
            if random.next() < 0.2 {
                let (goes, stays, by_value) = look(world, plain, insertions, &mut random);
                partly += usize::from(goes > 0 && stays > 0);
                (removed, left) = (removed + goes, left + stays);
                kept_by_value += by_value;
            }
        });
        let (input, mut insertions, _) = beside.expect("the mesh is built first");
        let stitches = mend::stitches(&world.mesh, |_| true);
        let World {
            mesh,
            positions,
            edits,
            ..
        } = &mut world;
        mend::sew(mesh, &*positions, &stitches, |_| 1.0, f64::INFINITY, edits).expect("copies");
        edits.replay(&mut insertions);
        let whole = insertions.undone(mesh, |_| true, |_, _| true);
        sewn += usize::from(whole.is_some());
        let whole = whole.map_or_else(|| mesh.clone(), DerivedMesh::into_mesh);
        assert_eq!(whole, input, "after sewing\n{script}");
    }
    println!(
        "{sewn} sewn; {removed} vertices taken out before that, {left} left, {kept_by_value} of them by the \
         values at corners; {partly} times some of both"
    );
    assert!(2 * sewn > count && partly > count && removed > count && left > count);
    assert!(10 * kept_by_value > count);
}
