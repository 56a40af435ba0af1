//! Vertices that cuts slid onto their plane: on record with what they were before, and put back to the
//! bit when the cut is undone.

use tearmesh::{
    Edit, FaceId, HalfEdgeId, Method, Point, Ray, Scissor, Vector, VertexId, insert::Plan, slide,
    split,
};
use tearmesh_obj::Document;

use super::random::Random;
use super::torn_record::{Work, files};
use super::{read, rewritten, text};

fn below(random: &mut Random, bound: usize) -> usize {
    (random.next() * bound as f64) as usize
}

fn vertex(v: usize) -> VertexId {
    VertexId::new(v).expect("small")
}

impl Work<'_> {
    /// Cuts somewhere, and slides vertices that are near the plane onto it; which ones slid.
    pub(crate) fn cut_sliding(&mut self, random: &mut Random) -> Vec<usize> {
        let points = self.positions.as_slice();
        let near = |random: &mut Random| {
            let middle = points[below(random, points.len())];
            middle + Vector::new(random.next() - 0.5, random.next() - 0.5, 0.0) * 0.2
        };
        let [p, q]: [Point; 2] = [near(random), near(random)];
        let down = Vector::new(0.0, 0.0, -1.0);
        let rays = [p, q].map(|p| Ray::new(p - down * 50.0, down).expect("a ray"));
        let Ok(scissor) = Scissor::new(&rays[0], &rays[1]) else {
            return Vec::new();
        };
        let scissor = scissor.snap(0.2).snap_move(true);
        self.edit(|mesh, positions, edits| {
            let seen = edits.next_number();
            let done = scissor.cut(Method::Exact, mesh, positions, edits);
            done.expect("positions are in step");
            let slides = edits.since(seen).filter_map(|edit| match edit {
                Edit::Slide(slide) => Some(slide.vertex.index()),
                _ => None,
            });
            slides.collect()
        })
    }

    fn slide(&mut self, from: usize, toward: usize, t: f64) {
        self.edit(|mesh, _, edits| {
            slide::toward(mesh, vertex(from), vertex(toward), t, edits).expect("an edge");
        });
    }

    fn insert_on(&mut self, half_edge: usize) {
        self.edit(|mesh, _, edits| {
            let mut plan = Plan::new();
            plan.on_edge(HalfEdgeId::new(half_edge).expect("small"), 0.375);
            plan.apply(mesh, edits).expect("a point");
        });
    }

    fn split_off(&mut self, from: usize, face: usize) {
        self.edit(|mesh, _, edits| {
            let faces = [FaceId::new(face).expect("small")];
            split::vertex(mesh, vertex(from), &faces, edits).expect("a split");
        });
    }

    /// What is written once all is sewn and simplified, in this session.
    fn undone(mut self) -> String {
        self.sew_all();
        let simple = self.torn.simplified(&self.mesh, &self.positions);
        let simple = simple.expect("what we wrote can be read").document;
        let written = simple.map_or_else(|| self.written(), |simple| Work::on(&simple).written());
        text(&written)
    }
}

/// The same in another session.
fn undone_later(file: &[u8]) -> String {
    let document = read(file);
    Work::on(&document).undone()
}

/// Two objects, with all kinds of corners, and with colours, which slide along.
const FLAG: &str = "o flag\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0.3 0 0 1\nv 1 1 0 1 1 1\n\
    v 2 0.5 0.1 0 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 0.3 0.7\nvn 0 0 1\nvn 0 0.6 0.8\n\
    f 1/1/1 2/2/2 3/3/1\nf 3/3/1 2/2/2 4/4/1\nf 2/5/1 5/1/2 4/4/1\n\
    o tile\nv 9 9 9\nv 8 9 9\nv 9 8 9\nvt 0.1\nf 6/6 7/6 8/6\n";

#[test]
fn a_slide_is_undone_to_the_bit() {
    type Deed = fn(&mut Work<'_>);
    let deeds: [(&str, Deed); 9] = [
        ("once", |work| work.slide(1, 3, 0.3)),
        ("along the boundary", |work| work.slide(0, 1, 0.7)),
        ("twice in a cut", |work| {
            work.slide(1, 3, 0.3);
            work.slide(1, 2, 0.1);
        }),
        ("in two cuts", |work| {
            work.slide(1, 3, 0.3);
            work.torn.next_cut();
            work.slide(1, 3, 0.3);
        }),
        ("and then split", |work| {
            work.slide(1, 3, 0.3);
            work.split_off(1, 0);
        }),
        ("and then divided", |work| {
            work.slide(1, 3, 0.3);
            work.insert_on(1);
            work.insert_on(0);
        }),
        ("after it was divided", |work| {
            work.insert_on(1);
            work.torn.next_cut();
            work.slide(1, 3, 0.3);
        }),
        ("after it was divided by the same cut", |work| {
            work.insert_on(1);
            work.slide(1, 3, 0.3);
            work.split_off(1, 0);
        }),
        ("as it was inserted", |work| {
            work.insert_on(1);
            work.torn.next_cut();
            work.slide(8, 1, 0.3);
            work.torn.next_cut();
            work.slide(1, 8, 0.2);
        }),
    ];
    let document = read(FLAG.as_bytes());
    for (name, deed) in deeds {
        let mut work = Work::on(&document);
        deed(&mut work);
        let written = work.written();
        assert_ne!(text(&written), FLAG, "{name}");
        assert_eq!(text(&rewritten(&written)), text(&written), "{name}");
        assert_eq!(undone_later(&written), FLAG, "{name}:\n{}", text(&written));
        assert_eq!(work.undone(), FLAG, "{name}");
    }
}

/// Cuts that slide near vertices onto their plane, through files, all undone at last.
#[test]
fn cuts_that_slide_are_undone_to_the_byte() {
    let (mut slid_in, mut slid) = (0, 0);
    for (name, file) in files() {
        let uncut = text(&rewritten(&file));
        for seed in 0..40 {
            let mut random = Random(5000 + seed);
            let mut bytes = file.clone();
            let mut count = 0;
            for _ in 0..1 + seed % 3 {
                let document = read(&bytes);
                let mut work = Work::on(&document);
                for _ in 0..1 + seed % 2 {
                    count += work.cut_sliding(&mut random).len();
                    work.torn.next_cut();
                }
                bytes = work.written();
                assert_eq!(
                    text(&rewritten(&bytes)),
                    text(&bytes),
                    "{name}, seed {seed}"
                );
            }
            assert_eq!(undone_later(&bytes), uncut, "{name}, seed {seed}");
            slid_in += usize::from(count > 0);
            slid += count;
        }
    }
    println!("{slid} vertices slid in {slid_in} of 200 files, and are all back");
    assert!(slid_in > 80, "{slid_in}");
}
