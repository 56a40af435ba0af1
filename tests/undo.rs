//! Taking out what was inserted: the input comes back once everything is sewn, and before that
//! everything goes that a plain search finds.
//!
//! The search knows the records and the roots. It begins with all divided faces, and strikes out those
//! that cannot be restored until nothing changes.

use std::collections::BTreeSet;

use tearmesh::mend;
use tearmesh::script::World;
use tearmesh::{Edit, FaceId, FacePart, HalfEdgeId, Insertions, Mesh, Mix, RemovalPlan, VertexId};

use crate::lockstep::beside::weights_in_parent;
use crate::random::Random;
use crate::scripts::scripts;

/// A place in a face, by the weights of its corners.
type Place = [f64; 3];

const CORNERS: [Place; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A divided face: each child by its face, and the places of its corners in the parent; and the
/// points inside.
struct Division {
    parent: usize,
    children: Vec<(usize, [Place; 3])>,
    /// By child.
    points_at: Vec<[Option<usize>; 3]>,
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
                for family in insert.families() {
                    let mut division = Division {
                        parent: family[0].parent.index(),
                        children: Vec::new(),
                        points_at: Vec::new(),
                        points: BTreeSet::new(),
                    };
                    for child in family {
                        let sources = child.sources.each_ref();
                        let places = sources.map(|source| weights_in_parent(child, source));
                        let mut points_at = [None; 3];
                        for (i, source) in sources.into_iter().enumerate() {
                            if !matches!(source, Mix::Copy(_)) {
                                let points = &self.points[child.vertices[i].index()];
                                division.points.extend(points);
                                points_at[i] = points.first().copied();
                            }
                        }
                        division.points_at.push(points_at);
                        division.children.push((child.face.index(), places));
                    }
                    self.divisions.push(division);
                }
            }
            _ => unreachable!("there is no other edit"),
        }
    }

    /// The division of the child of one.
    fn later(&self, division: usize, child: usize) -> Option<usize> {
        let mut later = division + 1..self.divisions.len();
        later.find(|&later| self.divisions[later].parent == child)
    }

    /// The half-edges of the mesh within what was divided, each with the places of its ends there.
    fn half_edges(&self, division: usize) -> Vec<(usize, [Place; 2])> {
        let mut found = Vec::new();
        for &(face, corners) in &self.divisions[division].children {
            let own = |i: usize| (3 * face + i, [CORNERS[i], CORNERS[(i + 1) % 3]]);
            let inner = match self.later(division, face) {
                Some(later) => self.half_edges(later),
                None => (0..3).map(own).collect(),
            };
            let here = |place: Place| {
                [0, 1, 2].map(|axis| (0..3).map(|i| place[i] * corners[i][axis]).sum::<f64>())
            };
            found.extend(inner.into_iter().map(|(h, ends)| (h, ends.map(here))));
        }
        found
    }

    /// Whether no tear begins, ends or is wholly within what was divided: of each side all parts are
    /// torn or none is, and if they are, so is the side between the vertices at its ends.
    fn is_even(&self, mesh: &Mesh, division: usize) -> bool {
        let mut sides = [const { Vec::new() }; 3];
        for (h, ends) in self.half_edges(division) {
            let h = HalfEdgeId::new(h).expect("small");
            let ghost = mesh.ghost_pair(h);
            match (0..3).find(|&corner| ends.iter().all(|end| end[corner] == 0.0)) {
                None if ghost.is_some() => return false,
                None => {}
                Some(side) => {
                    let parts = ghost.map(|ghost| {
                        let from = mesh.origin(h) != mesh.target(ghost);
                        let to = mesh.target(h) != mesh.origin(ghost);
                        let is_corner = ends.map(|end| CORNERS.contains(&end));
                        is_corner[0] && from || is_corner[1] && to
                    });
                    sides[side].push(parts);
                }
            }
        }
        sides.iter().all(|parts: &Vec<Option<bool>>| {
            parts.iter().all(Option::is_none)
                || parts.iter().all(Option::is_some) && parts.contains(&Some(true))
        })
    }

    /// The vertices that go, and how many faces there are then.
    fn undone(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(usize) -> bool,
        value: impl Fn(usize) -> bool,
    ) -> (BTreeSet<usize>, usize) {
        let roots = mesh.roots();
        let mut goes: BTreeSet<usize> = (0..self.points.len())
            .filter(|&v| !self.points[v].is_empty() && may_go(v))
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
                let half_edges = self.half_edges(division);
                let agree = CORNERS.iter().all(|corner| {
                    let at = half_edges.iter().filter(|(_, ends)| ends[0] == *corner);
                    let at: Vec<usize> = at.map(|&(h, _)| h).collect();
                    at.iter().all(|&h| {
                        mesh.indices()[h] == mesh.indices()[at[0]] && value(h) == value(at[0])
                    })
                });
                all_go
                    && agree
                    && self.is_even(mesh, division)
                    && inner.into_iter().all(|inner| whole.contains(&inner))
            };
            whole = whole.iter().copied().filter(is_whole).collect();
            goes.retain(|&v| {
                let mut of_point = (0..self.divisions.len()).filter(|&division| {
                    !self.divisions[division].points.is_disjoint(&self.points[v])
                });
                of_point.all(|division| whole.contains(&division))
            });
            let all = goes.clone();
            let roots = &roots;
            let copies = |v: usize| (0..roots.len()).filter(move |&u| roots[u] == roots[v]);
            goes.retain(|&v| copies(v).all(|u| all.contains(&u)));
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

/// A division as the kernel is told of it.
impl Division {
    fn parts(&self, roots: &[u32]) -> Vec<FacePart> {
        let children = self.children.iter().zip(&self.points_at);
        let part =
            |(&(face, places), points): (&(usize, [Place; 3]), &[Option<usize>; 3])| FacePart {
                face: FaceId::new(face).expect("small"),
                roots: points.map(|point| point.map_or(u32::MAX, |point| roots[point])),
                corners: places.map(|place| CORNERS.iter().position(|corner| *corner == place)),
                on_sides: places.map(|place| [2, 0, 1].map(|opposite| place[opposite] == 0.0)),
            };
        children.map(part).collect()
    }
}

impl Plain {
    /// What the kernel plans: the last division is given first.
    fn plan(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> RemovalPlan {
        let mut roots = vec![0; self.count];
        for (points, root) in self.points.iter().zip(mesh.roots()) {
            points.iter().for_each(|&point| roots[point] = root);
        }
        let divisions = self.divisions.iter().rev();
        let insertions = Insertions::new(mesh, divisions.map(|division| division.parts(&roots)));
        let may_go = |v: VertexId| !self.points[v.index()].is_empty() && may_go(v);
        insertions.plan(mesh, may_go, agree)
    }

    /// Carries a plan out: the mesh, and its vertices as they were numbered.
    fn restored(&self, mesh: &Mesh, plan: &RemovalPlan) -> (Mesh, Vec<VertexId>) {
        let mut within: Vec<Vec<usize>> = vec![Vec::new(); mesh.face_count()];
        for (number, division) in self.divisions.iter().enumerate() {
            let around = within[division.parent].clone();
            for &(face, _) in &division.children {
                within[face] = [&around[..], &[number]].concat();
            }
        }
        let corners_of = |division: usize| plan.restored(self.divisions.len() - 1 - division);
        let mut corners = Vec::new();
        for f in mesh.faces() {
            let divisions = within[f.index()].iter().copied();
            let whole = divisions
                .clone()
                .find_map(|one| Some((one, corners_of(one)?)));
            match whole {
                None => corners.extend(f.half_edges()),
                Some((one, own)) if self.divisions[one].parent == f.index() => corners.extend(own),
                Some(_) => {}
            }
        }
        let vertices: Vec<VertexId> = mesh.vertices().filter(|&v| !plan.goes(v)).collect();
        let number = |v: u32| {
            let place = vertices.binary_search_by_key(&v, |&v| u32::from(v));
            place.expect("what stays has vertices that stay") as u32
        };
        let origins = corners.iter().map(|&h| number(mesh.origin(h).into()));
        let triangles: Vec<u32> = origins.collect();
        let roots = mesh.roots();
        let roots = vertices.iter().map(|v| number(roots[v.index()]));
        let roots: Vec<u32> = roots.collect();
        let made = Mesh::build_torn(triangles.as_chunks().0, &roots).expect("a torn mesh");
        assert_eq!(made.check(), []);
        (made, vertices)
    }
}

#[test]
fn insertions_that_keep_nothing_apart_are_undone() {
    let (mut count, mut sewn, mut partly) = (0, 0, 0);
    let (mut removed, mut left, mut kept_by_value) = (0, 0, 0);
    for (seed, script) in scripts().enumerate() {
        count += 1;
        let mut random = Random(seed as u64);
        let mut beside: Option<(Mesh, Plain)> = None;
        let look = |world: &World, plain: &Plain, random: &mut Random| {
            let mesh = &world.mesh;
            let any = random.next();
            let stays: Vec<bool> = mesh.vertices().map(|_| random.next() < any * any).collect();
            let values: Vec<bool> = mesh
                .half_edges()
                .map(|_| random.next() < 0.05 * any)
                .collect();
            let (goes, faces) = plain.undone(mesh, |v| !stays[v], |h| values[h]);
            let agree = |a: HalfEdgeId, b: HalfEdgeId| values[a.index()] == values[b.index()];
            let plan = plain.plan(mesh, |v| !stays[v.index()], agree);
            let planned = mesh.vertices().filter(|&v| plan.goes(v));
            let planned: BTreeSet<usize> = planned.map(VertexId::index).collect();
            assert_eq!(planned, goes, "after\n{script}");
            let (made, _) = plain.restored(mesh, &plan);
            assert_eq!(made.face_count(), faces, "after\n{script}");
            let (freely, _) = plain.undone(mesh, |v| !stays[v], |_| true);
            let inserted = plain
                .points
                .iter()
                .filter(|points| !points.is_empty())
                .count();
            (goes.len(), inserted - goes.len(), freely.len() - goes.len())
        };
        let mut world = script.run(|world, _| {
            let (_, plain) =
                beside.get_or_insert_with(|| (world.mesh.clone(), Plain::new(&world.mesh)));
            world.edits.iter().for_each(|edit| plain.follow(&edit));
            if random.next() < 0.2 {
                let (goes, stays, by_value) = look(world, plain, &mut random);
                partly += usize::from(goes > 0 && stays > 0);
                (removed, left) = (removed + goes, left + stays);
                kept_by_value += by_value;
            }
        });
        let (input, mut plain) = beside.expect("the mesh is built first");
        let stitches = mend::stitches(&world.mesh, |_| true);
        let World {
            mesh,
            positions,
            edits,
            ..
        } = &mut world;
        mend::sew(mesh, &*positions, &stitches, |_| 1.0, f64::INFINITY, edits).expect("copies");
        edits.iter().for_each(|edit| plain.follow(&edit));
        let plan = plain.plan(mesh, |_| true, |_, _| true);
        sewn += usize::from(mesh.vertices().any(|v| plan.goes(v)));
        let (whole, _) = plain.restored(mesh, &plan);
        assert_eq!(whole, input, "after sewing\n{script}");
    }
    assert!(2 * sewn > count && partly > count && removed > count && left > count);
    assert!(10 * kept_by_value > count);
}
