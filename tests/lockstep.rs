//! The properties, as named functions, and a model that runs beside the library in lock step.
//!
//! Proptest, the exhaustive small cases, the regressions and the fuzz targets all use these.
//! Numbers like I16 are those of `src/mesh/invariants.md`.

use tearmesh::script::{Script, Step, World};
use tearmesh::split::{self, Refusal};
use tearmesh::{Edit, Edits, FaceId, HalfEdgeId, Masses, Mesh, Positions, Split, VertexId};

use crate::oracle::{Refused, Soup, is_strict, lump};

/// Runs a script and checks every property after every step. Returns the number of splits.
pub(crate) fn check(script: &Script) -> usize {
    let mut model: Option<Model> = None;
    let world = script.run(|world, step| match &mut model {
        None => model = Some(Model::new(world)),
        Some(model) => model.follow(world, step),
    });
    let model = model.expect("the mesh is built first");
    undoing_every_split_gives_the_input_back(&world.mesh, &model.history, &model.input);
    running_again_gives_the_same_bytes(script, &world);
    model.history.len()
}

/// A split, as the log told it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Told {
    pub(crate) old: VertexId,
    pub(crate) new: VertexId,
    pub(crate) corners: Vec<HalfEdgeId>,
    torn: Vec<(HalfEdgeId, HalfEdgeId)>,
}

impl Told {
    pub(crate) fn by(split: &Split<'_>) -> Told {
        Told {
            old: split.old,
            new: split.new,
            corners: split.corners.to_vec(),
            torn: split
                .torn
                .iter()
                .map(|link| (link.stayed, link.moved))
                .collect(),
        }
    }
}

pub(crate) fn told(edits: &Edits) -> Vec<Told> {
    edits.iter().map(|edit| Told::by(&split_of(edit))).collect()
}

pub(crate) fn split_of(edit: Edit<'_>) -> Split<'_> {
    match edit {
        Edit::Split(split) => split,
        other => panic!("a script only splits, and this is {other:?}"),
    }
}

/// The soup beside a [`World`], and the world as it was before the last step.
struct Model {
    soup: Soup,
    unit: f64,
    input: Mesh,
    before: World,
    /// Every split so far, those that were cleared included.
    history: Vec<Told>,
}

impl Model {
    fn new(world: &World) -> Model {
        let (soup, unit) = soup_of(&world.mesh, &world.positions);
        assert!(
            is_strict(world.mesh.vertex_count(), &soup.faces),
            "a shape is a manifold"
        );
        let model = Model {
            soup,
            unit,
            input: world.mesh.clone(),
            before: world.clone(),
            history: Vec::new(),
        };
        model.everything_agrees(world);
        model
    }

    fn follow(&mut self, world: &World, step: &Step<'_>) {
        match *step {
            Step::Split {
                vertex,
                faces,
                outcome,
            } => {
                let expected = self.soup.split(vertex.index(), &indices(faces));
                assert_eq!(
                    outcome.map_err(plain).map(|_| ()),
                    expected,
                    "outcome of {step:?}"
                );
                match outcome {
                    Ok(number) => self.splits(world, number),
                    Err(_) => nothing_changed(&self.before, world),
                }
            }
            Step::Plane {
                vertex,
                normal,
                outcome,
            } => {
                let behind = self.soup.behind(vertex.index(), normal);
                let expected = self.soup.split(vertex.index(), &behind);
                assert_eq!(outcome.is_some(), expected.is_ok(), "outcome of {step:?}");
                match outcome {
                    Some(number) => self.splits(world, number),
                    None => nothing_changed(&self.before, world),
                }
            }
            Step::Cut { first, report } => {
                assert_eq!(report.pieces_before, self.soup.piece_count());
                let splits = self.history.len();
                self.a_cut_is_made_of_splits(world, first);
                assert_eq!(
                    report.splits,
                    self.history.len() - splits,
                    "splits of the cut"
                );
                assert_eq!(
                    report.pieces,
                    self.soup.piece_count(),
                    "pieces after the cut"
                );
            }
            Step::Cleared => {
                assert!(world.edits.is_empty(), "the log was cleared");
                assert_eq!(world.edits.next_number(), self.before.edits.next_number());
                assert_eq!(
                    world.late_roots, world.roots,
                    "a late follower sees all edits at once"
                );
                assert_eq!(world.mesh, self.before.mesh);
                self.before.edits = world.edits.clone();
            }
            Step::Nothing => nothing_changed(&self.before, world),
            ref other => panic!("the mesh is built once, and this is {other:?}"),
        }
        assert_eq!(
            world.edits.next_number(),
            self.history.len() as u64,
            "edits are numbered from 0"
        );
        if world.mesh != self.before.mesh {
            self.everything_agrees(world);
            self.before = world.clone();
        }
    }

    /// One split was made, with this number: the last one.
    fn splits(&mut self, world: &World, number: u64) {
        assert_eq!(
            number,
            self.history.len() as u64,
            "edits are numbered from 0"
        );
        let mut edits = world.edits.since(number);
        let split = split_of(edits.next().expect("a split is in the log"));
        assert!(edits.next().is_none(), "one split is one edit");
        assert_eq!(split.number, number);
        a_split_changes_nothing_else(&self.before.mesh, &world.mesh, &split);
        for masses in [
            (&self.before.area, &world.area),
            (&self.before.half, &world.half),
        ] {
            a_split_conserves_mass(masses.0, masses.1, &split);
        }
        self.history.push(Told::by(&split));
    }

    /// The same splits, one by one, make the same mesh.
    fn a_cut_is_made_of_splits(&mut self, world: &World, first: u64) {
        assert_eq!(
            first,
            self.history.len() as u64,
            "edits are numbered from 0"
        );
        let mut mesh = self.before.mesh.clone();
        for edit in world.edits.since(first) {
            let split = split_of(edit);
            let faces: Vec<FaceId> = split.corners.iter().map(|h| h.face()).collect();
            let expected = self.soup.split(split.old.index(), &indices(&faces));
            assert_eq!(expected, Ok(()), "a cut makes no split that is refused");
            let before = mesh.clone();
            let mut edits = Edits::new();
            let again =
                split::faces(&mut mesh, split.old, &faces, &mut edits).map(|s| Told::by(&s));
            assert_eq!(again, Ok(Told::by(&split)), "a split of a cut is a split");
            a_split_changes_nothing_else(&before, &mesh, &split);
            self.history.push(Told::by(&split));
        }
        assert_eq!(mesh, world.mesh, "a cut is nothing but splits");
    }

    fn everything_agrees(&self, world: &World) {
        let soup = &self.soup;
        the_mesh_agrees(&world.mesh, soup);
        every_vertex_is_where_its_root_was(&world.positions, soup);
        every_vertex_weighs_what_its_faces_weigh(&world.area, soup, self.unit);
        halves_add_up(&world.half, soup, self.unit);
        assert_eq!(
            world.roots.as_slice(),
            soup.root
                .iter()
                .map(|&root| f64::from(root))
                .collect::<Vec<_>>(),
            "data of a vertex is copied"
        );
        let corners = world.corners.as_slice();
        assert!(
            corners
                .iter()
                .copied()
                .eq((0..corners.len() as u32).map(f64::from)),
            "data of a corner stays"
        );
    }
}

/// The soup of a mesh that nothing was done to, and the unit of its masses.
pub(crate) fn soup_of(mesh: &Mesh, positions: &Positions) -> (Soup, f64) {
    let triangles: Vec<[u32; 3]> = mesh
        .faces()
        .map(|f| mesh.corners(f).map(u32::from))
        .collect();
    let points: Vec<[f64; 3]> = positions
        .as_slice()
        .iter()
        .map(|p| [p.x, p.y, p.z])
        .collect();
    let (unit, corner_mass) = lump(&points, &triangles);
    (Soup::new(&points, &triangles, &corner_mass), unit)
}

fn indices(faces: &[FaceId]) -> Vec<usize> {
    faces.iter().map(|f| f.index()).collect()
}

/// A refusal, in the words of the oracle.
pub(crate) fn plain(refusal: Refusal) -> Refused {
    match refusal {
        Refusal::Empty { .. } => Refused::Empty,
        Refusal::Everything { .. } => Refused::Everything,
        Refusal::Foreign { face, .. } => Refused::Foreign(face.index()),
        Refusal::Repeated { face, .. } => Refused::Repeated(face.index()),
    }
}

/// All properties of a mesh on its own.
pub(crate) fn the_mesh_agrees(mesh: &Mesh, soup: &Soup) {
    assert_eq!(mesh.check(), [], "no invariant is broken");
    let triangles = soup.faces.as_flattened();
    assert_eq!(
        mesh.indices(),
        triangles,
        "the index buffer is the list of triangles"
    );
    let corners = soup.corners_by_vertex();
    the_walk_lists_exactly_the_corners(mesh, &corners);
    the_fans_are_those_joined_by_edges(mesh, soup);
    the_torn_links_are_those_whose_ends_differ(mesh, soup);
    the_roots_give_the_input_back(mesh, soup);
    assert_eq!(mesh.edges().count(), soup.edge_count(), "edges");
    assert_eq!(mesh.components().count(), soup.piece_count(), "components");
}

/// I10, I9: the walk round a vertex lists the corners that a scan of all faces finds, each once.
pub(crate) fn the_walk_lists_exactly_the_corners(mesh: &Mesh, corners: &[Vec<usize>]) {
    assert_eq!(mesh.vertex_count(), corners.len());
    let mut walked = Vec::new();
    for (v, truth) in mesh.vertices().zip(corners) {
        walked.clear();
        walked.extend(mesh.corners_of(v).map(HalfEdgeId::index));
        walked.sort_unstable();
        assert_eq!(walked, *truth, "the corners of {v}");
        let smallest = mesh.half_edge_of(v).map(HalfEdgeId::index);
        assert_eq!(smallest, truth.first().copied(), "the half-edge of {v}");
    }
}

/// I19: the fans of a vertex are its corners, joined by edges that are not torn.
pub(crate) fn the_fans_are_those_joined_by_edges(mesh: &Mesh, soup: &Soup) {
    for (v, truth) in mesh.vertices().zip(soup.fans_by_vertex()) {
        let mut fans: Vec<Vec<usize>> = mesh
            .fans(v)
            .map(|first| {
                let mut fan: Vec<usize> = mesh.fan(first).map(HalfEdgeId::index).collect();
                fan.sort_unstable();
                fan
            })
            .collect();
        fans.sort_unstable();
        assert_eq!(fans, truth, "the fans of {v}");
    }
}

/// I4 to I7, I15: what was joined at first is a pair where the ends agree, and else a
/// ghost pair; everything else is boundary.
pub(crate) fn the_torn_links_are_those_whose_ends_differ(mesh: &Mesh, soup: &Soup) {
    for &link in &soup.links {
        let [h, g] = link.map(|(f, i)| mesh.faces().nth(f).expect("a face").half_edges()[i]);
        let expected = if soup.is_torn(link) {
            (None, Some(g))
        } else {
            (Some(g), None)
        };
        assert_eq!(
            (mesh.pair(h), mesh.ghost_pair(h)),
            expected,
            "pair and ghost pair of {h}"
        );
        let back = expected.0.and(Some(h));
        assert_eq!(mesh.pair(g), back, "pair of {g}");
        assert_eq!(mesh.pair_or_ghost(g), Some(h), "pair or ghost pair of {g}");
    }
    let linked = mesh
        .half_edges()
        .filter(|&h| mesh.pair_or_ghost(h).is_some());
    assert_eq!(linked.count(), 2 * soup.links.len(), "links");
}

/// I8, I21: with each vertex replaced by its root, the triangles are those of the input.
pub(crate) fn the_roots_give_the_input_back(mesh: &Mesh, soup: &Soup) {
    let roots: Vec<u32> = mesh.vertices().map(|v| mesh.root(v).into()).collect();
    assert_eq!(roots, soup.root, "roots");
    let input = soup.input.as_flattened();
    assert!(
        mesh.indices()
            .iter()
            .zip(input)
            .all(|(&v, &root)| roots[v as usize] == root)
    );
}

/// I15 to I17: the frame of a split.
pub(crate) fn a_split_changes_nothing_else(before: &Mesh, after: &Mesh, split: &Split<'_>) {
    let Split {
        old,
        new,
        corners,
        torn,
        ..
    } = *split;
    assert_eq!(
        before.vertex_count(),
        new.index(),
        "the new vertex is the last one"
    );
    assert_eq!(after.vertex_count(), new.index() + 1, "one vertex more");
    assert_eq!(after.face_count(), before.face_count(), "no face more");
    assert!(!corners.is_empty(), "a face moves");
    assert!(after.indices().contains(&old.into()), "a face stays");
    let mut moved = vec![false; before.half_edge_count()];
    for &h in corners {
        assert_eq!(before.origin(h), old, "{h} was a corner of {old}");
        assert!(!moved[h.index()], "{h} moves once");
        moved[h.index()] = true;
    }
    let walk = before.corners_of(old).filter(|h| moved[h.index()]);
    assert!(
        walk.eq(corners.iter().copied()),
        "corners in the order of a walk"
    );

    let ends = |h: HalfEdgeId| (after.origin(h), after.target(h));
    let mut tears = 0;
    for h in before.half_edges() {
        let origin = if moved[h.index()] {
            new
        } else {
            before.origin(h)
        };
        assert_eq!(after.origin(h), origin, "origin of {h}");
        assert_eq!(
            after.pair_or_ghost(h),
            before.pair_or_ghost(h),
            "links never change"
        );
        let tears_now = before
            .pair(h)
            .is_some_and(|g| ends(g) != (ends(h).1, ends(h).0));
        let is_torn = before.ghost_pair(h).is_some() || tears_now;
        assert_eq!(
            after.ghost_pair(h).is_some(),
            is_torn,
            "whether {h} is torn"
        );
        tears += usize::from(tears_now);
        let listed = torn
            .iter()
            .filter(|link| link.stayed == h || link.moved == h);
        assert_eq!(
            listed.count(),
            usize::from(tears_now),
            "{h} among the torn links {torn:?}"
        );
    }
    assert_eq!(tears, 2 * torn.len(), "two half-edges for each torn link");
    let moves = |h: HalfEdgeId| h.face().half_edges().iter().any(|h| moved[h.index()]);
    for link in torn {
        assert_eq!(
            after.ghost_pair(link.stayed),
            Some(link.moved),
            "ghost pair"
        );
        assert!(moves(link.moved), "{} is of a face that moved", link.moved);
        assert!(
            !moves(link.stayed),
            "{} is of a face that stayed",
            link.stayed
        );
    }
    let euler = |mesh: &Mesh| {
        (mesh.vertex_count() + mesh.face_count()) as isize - mesh.edges().count() as isize
    };
    let change = euler(after) - euler(before);
    assert_eq!(change, 1 - torn.len() as isize, "the Euler characteristic");
}

/// I20: the two halves weigh what the vertex weighed, bit for bit, and nothing else changed.
pub(crate) fn a_split_conserves_mass(before: &Masses, after: &Masses, split: &Split<'_>) {
    let (old, new) = (split.old, split.new);
    assert_eq!(
        after.at(old) + after.at(new),
        before.at(old),
        "m_old + m_new"
    );
    assert!(
        after.at(old) > 0.0 && after.at(new) > 0.0,
        "no half without mass"
    );
    for v in (0..before.len())
        .filter_map(VertexId::new)
        .filter(|&v| v != old)
    {
        assert_eq!(
            after.at(v).to_bits(),
            before.at(v).to_bits(),
            "the mass of {v}"
        );
    }
}

/// I20: positions are copied bit for bit.
pub(crate) fn every_vertex_is_where_its_root_was(positions: &Positions, soup: &Soup) {
    let bits = |x: [f64; 3]| x.map(f64::to_bits);
    let points = positions.as_slice().iter().map(|p| bits([p.x, p.y, p.z]));
    assert!(points.eq(soup.points.iter().map(|&p| bits(p))), "positions");
}

/// I20 for masses by area.
pub(crate) fn every_vertex_weighs_what_its_faces_weigh(masses: &Masses, soup: &Soup, unit: f64) {
    let mut units = vec![0; soup.root.len()];
    for (&v, &mass) in soup
        .faces
        .as_flattened()
        .iter()
        .zip(soup.corner_mass.as_flattened())
    {
        units[v as usize] += mass;
    }
    assert_eq!(masses.len(), units.len());
    for (v, units) in (0..).map_while(VertexId::new).zip(units) {
        assert_eq!(masses.at(v), units as f64 * unit, "the mass of {v}");
    }
    assert!(masses.ledger().is_balanced(), "the total mass");
}

/// I20 for masses by halves.
pub(crate) fn halves_add_up(masses: &Masses, soup: &Soup, unit: f64) {
    assert_eq!(masses.len(), soup.halved.len());
    for (v, &(root, halvings)) in (0..).map_while(VertexId::new).zip(&soup.halved) {
        let half = (0..halvings).fold(root as f64 * unit, |mass, _| mass / 2.0);
        assert_eq!(masses.at(v), half, "the mass of {v}");
    }
    let first: u64 = soup.corner_mass.as_flattened().iter().sum();
    assert_eq!(
        soup.halved_total(64),
        u128::from(first) << 64,
        "the oracle loses no mass"
    );
    assert!(masses.ledger().is_balanced(), "the total mass");
}

/// I22: a refused operation leaves everything as it was, bit for bit.
pub(crate) fn nothing_changed(before: &World, after: &World) {
    assert_eq!(after.mesh, before.mesh, "the mesh");
    assert_eq!(after.positions, before.positions, "the positions");
    assert_eq!(after.roots, before.roots, "the followers");
    assert_eq!(
        after.edits.next_number(),
        before.edits.next_number(),
        "the numbering of edits"
    );
    assert_eq!(told(&after.edits), told(&before.edits), "the log");
}

/// I21: with all splits undone in reverse order, the triangles build the input again.
pub(crate) fn undoing_every_split_gives_the_input_back(
    mesh: &Mesh,
    history: &[Told],
    input: &Mesh,
) {
    let mut origins = mesh.indices().to_vec();
    let mut vertices = mesh.vertex_count();
    for split in history.iter().rev() {
        vertices -= 1;
        assert_eq!(
            split.new.index(),
            vertices,
            "the last split made the last vertex"
        );
        for h in &split.corners {
            assert_eq!(origins[h.index()], u32::from(split.new), "{h} was moved");
            origins[h.index()] = split.old.into();
        }
        assert!(
            !origins.contains(&split.new.into()),
            "all corners of {} are told",
            split.new
        );
    }
    let (triangles, rest) = origins.as_chunks();
    assert!(rest.is_empty());
    let rebuilt = Mesh::build(vertices, triangles);
    assert_eq!(rebuilt.as_ref(), Ok(input), "the input, bit for bit");
}

/// The same script gives the same bytes.
pub(crate) fn running_again_gives_the_same_bytes(script: &Script, world: &World) {
    let again = script.run(|_, _| {});
    assert_eq!(again.mesh, world.mesh, "the mesh");
    assert_eq!(again.positions, world.positions, "the positions");
    assert_eq!(told(&again.edits), told(&world.edits), "the log");
}
