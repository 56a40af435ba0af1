//! Equal inputs give equal bytes, on every machine and after every change of the code that promises
//! to change none: one number stands for all that twenty thousand scripts leave.

use tearmesh::script::World;
use tearmesh::{Edit, HalfEdgeId, VertexId};

use crate::digest;
use crate::scripts::script;

/// Of the scripts below. A commit that changes it says which bits moved, and why.
const DIGEST: u64 = 0x4055_cbcf_c0f6_b2c3;

const SCRIPTS: u64 = 20_000;

#[test]
fn scripts_leave_the_same_bytes_as_ever() {
    let mut digest = Digest::new();
    for seed in 0..SCRIPTS {
        let world = script(seed).run(|world, _| {
            digest.number(world.mesh.vertex_count() as u64);
        });
        digest.world(&world);
    }
    assert_eq!(digest.0, DIGEST, "{:#018x}", digest.0);
}

/// The digest of worlds.
struct Digest(u64);

impl Digest {
    fn new() -> Digest {
        Digest(digest::EMPTY)
    }

    fn number(&mut self, number: u64) {
        self.0 = digest::after(self.0, number.to_le_bytes());
    }

    fn float(&mut self, number: f64) {
        self.number(number.to_bits());
    }

    fn floats<const N: usize>(&mut self, numbers: [f64; N]) {
        for number in numbers {
            self.float(number);
        }
    }

    fn half_edge(&mut self, h: Option<HalfEdgeId>) {
        self.number(h.map_or(u64::MAX, |h| h.index() as u64));
    }

    fn vertices<const N: usize>(&mut self, vertices: [VertexId; N]) {
        for v in vertices {
            self.number(v.index() as u64);
        }
    }

    /// Everything in a world that can be asked for: links, marks, the log, places, masses, values.
    fn world(&mut self, world: &World) {
        let mesh = &world.mesh;
        for h in mesh.half_edges() {
            self.vertices([mesh.origin(h)]);
            self.half_edge(mesh.pair(h));
            self.half_edge(mesh.ghost_pair(h));
        }
        for v in mesh.vertices() {
            self.half_edge(mesh.half_edge_of(v));
            let place = world.positions.at(v);
            self.floats([place.x, place.y, place.z]);
            self.float(world.area.at(v));
            self.float(world.half.as_ref().map_or(-1.0, |half| half.at(v)));
        }
        for &value in world.corners.as_slice() {
            self.floats(value);
        }
        for edit in &world.edits {
            self.edit(&edit);
        }
    }

    fn edit(&mut self, edit: &Edit<'_>) {
        self.number(edit.number());
        match edit {
            Edit::Split(split) => self.vertices([split.old, split.new]),
            Edit::Merge(merge) => self.vertices([merge.kept, merge.gone]),
            Edit::Insert(insert) => {
                for child in insert.children {
                    self.vertices(child.vertices);
                    self.float(child.share);
                }
            }
            Edit::Slide(slide) => {
                self.vertices([slide.vertex, slide.toward]);
                self.float(slide.t);
            }
            _ => unreachable!("there is no other edit"),
        }
    }
}
