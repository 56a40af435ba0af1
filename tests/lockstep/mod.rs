//! The properties, as named functions, and a model that runs beside the library in lock step.
//!
//! Proptest, the exhaustive small cases, the regressions and the fuzz targets all use these.
//! Numbers like I16 are those of `src/mesh/invariants.md`.

pub(crate) mod beside;
mod cut;
mod history;
mod insert;
mod merge;
mod mesh;
mod slide;
mod split;

use tearmesh::script::{Script, Step, World};
use tearmesh::{Cursor, Edit, Edits, FaceId, Mesh, Positions, VertexId};

use crate::oracle::{Soup, is_strict, lump};

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Done {
    pub(crate) splits: usize,
    pub(crate) insertions: usize,
    pub(crate) merges: usize,
    pub(crate) slides: usize,
    /// Cuts, by their method.
    pub(crate) cuts: [usize; 4],
    /// Refused, or nothing to do.
    pub(crate) refused: usize,
}

impl Done {
    pub(crate) fn add(&mut self, more: Done) {
        self.splits += more.splits;
        self.insertions += more.insertions;
        self.merges += more.merges;
        self.slides += more.slides;
        for (sum, more) in self.cuts.iter_mut().zip(more.cuts) {
            *sum += more;
        }
        self.refused += more.refused;
    }
}

/// Runs a script and checks every property after every step.
pub(crate) fn check(script: &Script) -> Done {
    let mut model: Option<Model> = None;
    let world = script.run(|world, step| match &mut model {
        None => model = Some(Model::new(world)),
        Some(model) => model.follow(world, step),
    });
    let model = model.expect("the mesh is built first");
    model.undoing_everything_gives_the_input_back();
    running_again_gives_the_same_bytes(script, &world);
    model.done
}

/// The soup beside a [`World`], and the world as it was before the last step.
#[derive(Clone)]
pub(crate) struct Model {
    soup: Soup,
    unit: f64,
    input: Mesh,
    before: World,
    /// The edits that were cleared.
    cleared: Vec<Edits>,
    pub(crate) done: Done,
}

impl Model {
    pub(crate) fn new(world: &World) -> Model {
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
            cleared: Vec::new(),
            done: Done::default(),
        };
        model.everything_agrees(world);
        model
    }

    /// The vertices and faces as the oracle has them.
    pub(crate) fn soup(&self) -> &Soup {
        &self.soup
    }

    /// Checks a step, and everything after it.
    pub(crate) fn follow(&mut self, world: &World, step: &Step<'_>) {
        let place = self.before.edits.cursor();
        match *step {
            Step::Split {
                vertex,
                faces,
                outcome,
            } => {
                let expected = self.soup.split(vertex.index(), &indices(faces));
                let told = outcome.map_err(split::plain).map(|_| ());
                assert_eq!(told, expected, "outcome of {step:?}");
                self.one_edit(world, outcome.ok());
            }
            Step::Plane {
                vertex,
                normal,
                outcome,
            } => {
                let behind = self.soup.behind(vertex.index(), normal);
                let expected = self.soup.split(vertex.index(), &behind);
                assert_eq!(outcome.is_some(), expected.is_ok(), "outcome of {step:?}");
                self.one_edit(world, outcome);
            }
            Step::Insert { plan, outcome } => {
                let asked = insert::Request::new(&self.before.mesh, plan);
                asked.is_refused_where_it_should(&self.soup, outcome);
                if outcome.is_ok() {
                    let edit = world.edits.iter().next_back();
                    asked.is_carried_out(&mut self.soup, &edit.expect("it is in the log"));
                }
                self.one_edit(world, outcome.ok());
            }
            Step::Merge {
                one,
                other,
                weights,
                outcome,
            } => {
                merge::is_refused_where_it_should(&self.soup, one, other, weights, outcome);
                if outcome.is_ok() {
                    let edit = world.edits.iter().next_back().expect("it is in the log");
                    merge::has_the_weights(&edit, one, weights);
                    merge::is_carried_out(&mut self.soup, &edit);
                }
                self.one_edit(world, outcome.ok());
            }
            Step::Slide {
                vertex,
                toward,
                t,
                outcome,
            } => {
                let expected = self.soup.slide(vertex.index(), toward.index(), t);
                let told = outcome.map_err(slide::plain).map(|_| ());
                assert_eq!(told, expected, "outcome of {step:?}");
                self.one_edit(world, outcome.ok());
            }
            Step::Sewn {
                first,
                stitches,
                merges,
            } => {
                assert_eq!(first, place, "the edits of this step");
                let mut mesh = self.before.mesh.clone();
                for edit in world.edits.since(first) {
                    merge::is_carried_out(&mut self.soup, &edit);
                    let after = merge::is_a_merge(&mesh, &edit);
                    merge::changes_nothing_else(&mesh, &after, &edit);
                    mesh = after;
                }
                assert_eq!(mesh, world.mesh, "sewing is nothing but merges");
                let done = world.edits.since(first).len();
                assert_eq!([done, stitches.len()], [merges; 2], "merges, stitches");
                merge::copies_are_sewn(&self.before.mesh, &world.mesh, stitches);
                self.done.merges += merges;
            }
            Step::Cut {
                first,
                scissor,
                settings,
                report,
            } => {
                assert_eq!(first, place, "the edits of this step");
                let made =
                    cut::is_carried_out(&mut self.soup, &self.before, world, first, settings);
                self.done.splits += made.splits;
                self.done.insertions += made.insertions;
                self.done.slides += made.slides;
                cut::is_reported(&self.soup, &self.before, world, first, report);
                let has_rays = scissor.sides().is_some();
                assert_eq!(world.polyline.is_some(), has_rays, "a polyline has rays");
                self.done.cuts[cut::number(settings.method)] += 1;
            }
            Step::Cleared => {
                assert!(world.edits.is_empty(), "the log was cleared");
                assert_eq!(world.edits.cursor(), self.before.edits.cursor());
                assert_eq!(world.mesh, self.before.mesh);
                self.cleared.push(self.before.edits.clone());
                self.before = world.clone();
            }
            Step::Nothing => self.one_edit(world, None),
            ref other => panic!("the mesh is built once, and this is {other:?}"),
        }
        if world.edits.cursor() != place {
            self.everything_agrees(world);
            self.before = world.clone();
        }
    }

    /// One edit was made, from this place on: the last one. Or none, and nothing has changed.
    fn one_edit(&mut self, world: &World, before: Option<Cursor>) {
        let Some(place) = before else {
            self.done.refused += 1;
            return nothing_changed(&self.before, world);
        };
        assert_eq!(place, self.before.edits.cursor(), "edits have no gap");
        let mut edits = world.edits.since(place);
        let edit = edits.next().expect("what was done is in the log");
        assert!(edits.next().is_none(), "one operation is one edit");
        assert_eq!((edit.before(), edit.after()), (place, world.edits.cursor()));
        assert_eq!(place.number() + 1, world.edits.cursor().number());
        let [before, after] = [&self.before, world];
        match edit {
            Edit::Split(split) => {
                split::changes_nothing_else(&before.mesh, &after.mesh, &split);
                // A face of a few units may have been divided into more corners than that.
                let has_units = |v: VertexId| self.soup.lumped_mass(v.index()) > 0;
                split::conserves_mass(&before.area, &after.area, &split, has_units);
                if let (Some(before), Some(after)) = (&before.half, &after.half) {
                    split::conserves_mass(before, after, &split, |_| true);
                }
                merge::undoes_the_last_split(&before.mesh, &after.mesh, &split);
                self.done.splits += 1;
            }
            Edit::Insert(insert) => {
                insert::changes_nothing_else(&before.mesh, &after.mesh, &insert);
                assert!(
                    after.half.is_none() && !insert.points.is_empty() || after.mesh == before.mesh
                );
                self.done.insertions += 1;
            }
            Edit::Merge(_) => {
                merge::changes_nothing_else(&before.mesh, &after.mesh, &edit);
                self.done.merges += 1;
            }
            Edit::Slide(slide) => {
                slide::changes_nothing_else(before, after, &slide);
                self.done.slides += 1;
            }
            _ => unreachable!("there is no other edit"),
        }
    }

    fn everything_agrees(&self, world: &World) {
        let soup = &self.soup;
        mesh::agrees(&world.mesh, soup);
        beside::every_vertex_is_where_the_soup_has_it(&world.positions, soup);
        beside::every_corner_is_where_its_vertex_is(&world.corners, soup);
        beside::every_vertex_weighs_what_its_faces_weigh(&world.area, soup, self.unit);
        if let Some(half) = &world.half {
            beside::halves_add_up(half, soup, self.unit);
        }
        let ends = world.polyline.iter().flatten();
        ends.for_each(|end| cut::an_end_has_vertices(end, &world.mesh));
    }

    /// I21: with all edits undone in reverse order, the triangles build the input again.
    pub(crate) fn undoing_everything_gives_the_input_back(&self) {
        let logs = self.cleared.iter().chain([&self.before.edits]).rev();
        let last_first = logs.flat_map(|log| log.iter().rev());
        let (vertices, triangles) = history::undone(last_first, &self.before.mesh);
        let rebuilt = Mesh::build(vertices, &triangles);
        assert_eq!(rebuilt.as_ref(), Ok(&self.input), "the input, bit for bit");
    }
}

/// The soup of a mesh that nothing was done to, and the unit of its masses.
pub(crate) fn soup_of(mesh: &Mesh, positions: &Positions) -> (Soup, f64) {
    let triangles = history::triangles(mesh);
    let points: Vec<[f64; 3]> = positions.as_slice().iter().map(|&p| p.into()).collect();
    let (unit, corner_mass) = lump(&points, triangles);
    (Soup::new(&points, triangles, &corner_mass), unit)
}

fn indices(faces: &[FaceId]) -> Vec<usize> {
    faces.iter().map(|f| f.index()).collect()
}

/// I22: a refused operation leaves everything as it was, bit for bit.
pub(crate) fn nothing_changed(before: &World, after: &World) {
    is_same(before, after);
    assert_eq!(after.corners, before.corners, "the followers");
}

fn is_same(one: &World, other: &World) {
    assert_eq!(one.mesh, other.mesh, "the mesh");
    assert_eq!(one.positions, other.positions, "the positions");
    let logs = [one, other].map(|world| &world.edits);
    assert_eq!(logs[0].cursor(), logs[1].cursor(), "the numbering");
    assert!(logs[0].iter().eq(logs[1].iter()), "the log");
}

/// Running a script twice gives the same bytes.
fn running_again_gives_the_same_bytes(script: &Script, world: &World) {
    is_same(&script.run(|_, _| {}), world);
}
