//! The oracle of insertions: what one must do, and what it must leave as it was.

use tearmesh::insert::{Chord, ChordEnd, InsertRefusal, Plan, Point};
use tearmesh::{ChildFace, Cursor, Edit, HalfEdgeId, Insert, InsertedPoint, Mesh, Mix};

use super::beside::weights_in_parent;
use super::mesh::euler;
use crate::oracle::{Child, End, Place, Soup, Spot, Unfit};

/// An insertion that was asked for, in the words of the oracle.
pub(super) struct Request {
    spots: Vec<Spot>,
    chord: Option<(usize, [End; 2])>,
}

fn place_of(h: HalfEdgeId) -> (usize, usize) {
    (h.face().index(), h.corner())
}

impl Request {
    pub(super) fn new(mesh: &Mesh, plan: &Plan) -> Request {
        let spot = |point: &Point| match *point {
            Point::Edge { h, t, forward } => {
                assert!(forward && h.index() < mesh.half_edge_count());
                let side = place_of(h);
                Spot::Side { side, t, forward }
            }
            Point::Face { f, weights } => Spot::Inside {
                face: f.index(),
                weights,
            },
        };
        let end = |end: ChordEnd| match end {
            ChordEnd::Corner(h) => {
                let (f, i) = place_of(h);
                End::Corner(f, i)
            }
            ChordEnd::Point(point) => End::Spot(point.index()),
        };
        let mut chords = plan.chords().iter();
        let chord = chords
            .next()
            .map(|&Chord { f, ends }| (f.index(), ends.map(end)));
        assert_eq!(chords.next(), None, "one chord at most");
        Request {
            spots: plan.points().iter().map(spot).collect(),
            chord,
        }
    }

    pub(super) fn is_refused_where_it_should(
        &self,
        soup: &Soup,
        outcome: Result<Cursor, InsertRefusal>,
    ) {
        let unfit = soup.unfit(&self.spots, self.chord);
        let refused = outcome.err().map(|refusal| match refusal {
            InsertRefusal::Parameter { .. } => Unfit::Parameter,
            InsertRefusal::Weights { .. } => Unfit::Weights,
            InsertRefusal::Repeated { .. } => Unfit::Repeated,
            InsertRefusal::Chord { .. } => Unfit::Chord,
            InsertRefusal::Crowded { .. } => Unfit::Crowded,
            other => panic!("no small mesh is {other}"),
        });
        match refused {
            None => assert_eq!(unfit, [], "it was not refused"),
            Some(reason) => assert!(unfit.contains(&reason), "{reason:?} is none of {unfit:?}"),
        }
    }

    /// The soup is divided as the record tells, and checks all of it.
    pub(super) fn is_carried_out(&self, soup: &mut Soup, edit: &Edit<'_>) {
        let Edit::Insert(insert) = edit else {
            panic!("not an insertion: {edit:?}");
        };
        let (told, children) = plain(insert);
        let places = soup.insert(&self.spots, self.chord, &children);
        assert_eq!(told, places, "the new vertices");
    }
}

/// A vertex and where it was put, in the words of the oracle.
type Told = (u32, Place);

/// The new vertices and the children of a record, in the words of the oracle.
pub(super) fn plain(insert: &Insert<'_>) -> (Vec<Told>, Vec<Child>) {
    let child = |child: &ChildFace| Child {
        parent: child.parent.index(),
        face: child.face.index(),
        vertices: child.vertices.map(u32::from),
        share: child.share,
        weights: child
            .sources
            .map(|source| weights_in_parent(child, &source)),
    };
    let told = |point: &InsertedPoint| {
        let place = match point.at {
            Mix::Copy(v) => panic!("{v} was inserted nowhere"),
            Mix::Between { ends, t } => Place::Edge {
                ends: ends.map(u32::from),
                t,
            },
            Mix::Weighted { of, weights } => Place::Face {
                vertices: of.map(u32::from),
                weights,
            },
            _ => unreachable!("there is no other mix"),
        };
        (point.vertex.into(), place)
    };
    let children = insert.children.iter().map(child).collect();
    (insert.points.iter().map(told).collect(), children)
}

/// I16, I17: old vertices and faces keep their ids; the Euler characteristic, the number
/// of pieces and the number of boundary loops stay.
pub(super) fn changes_nothing_else(before: &Mesh, after: &Mesh, insert: &Insert<'_>) {
    let (points, children) = (insert.points.len(), insert.children.len());
    let counts = |mesh: &Mesh| (mesh.vertex_count(), mesh.face_count());
    let (vertices, faces) = counts(before);
    let families = insert.families().count();
    let expected = (vertices + points, faces + children - families);
    assert_eq!(counts(after), expected, "vertices and faces");
    for family in insert.families() {
        assert_eq!(family[0].face, family[0].parent);
        assert!(family.len() > 1, "it is divided");
    }
    for f in before.faces() {
        let is_divided = insert.families().any(|family| family[0].parent == f);
        let is_same = after.face_vertices(f) == before.face_vertices(f);
        assert!(is_divided || is_same, "{f} was not divided");
    }
    assert_eq!(euler(after), euler(before), "the Euler characteristic");
    let counts = |mesh: &Mesh| (mesh.components().count(), mesh.boundary_loops().len());
    assert_eq!(counts(after), counts(before), "pieces and boundary loops");
}
