//! Cuts of scripts: nothing but splits, insertions and slides, which leave no gap and lose no face.

use tearmesh::script::{CutSettings, World};
use tearmesh::split as split_op;
use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{
    Cursor, CutEnd, CutMethod, CutReport, Edit, Edits, FaceId, HalfEdgeId, Mesh, Split,
};

use super::{insert, slide, split};
use crate::oracle::Soup;

/// How many edits of each kind a cut is made of.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Made {
    pub(super) splits: usize,
    pub(super) insertions: usize,
    pub(super) slides: usize,
}

/// The edits of a cut are carried out on the soup one by one, each as what it says it is.
pub(super) fn is_carried_out(
    soup: &mut Soup,
    before: &World,
    after: &World,
    first: Cursor,
    settings: CutSettings,
) -> Made {
    let seams = UnsewnSeams::find(&before.mesh, &before.positions);
    // Where sides that coincide are apart, each is cut by itself.
    let is_one = (settings.seams || seams.is_empty()) && seams.left_apart().count() == 0;
    let whole = (soup.gaps(), soup.area());
    let mut mesh = before.mesh.clone();
    if settings.seams {
        _ = seams.close(&mut mesh);
        let side = |h: HalfEdgeId| (h.face().index(), h.corner());
        let sides = seams.edges().iter().map(|edge| edge.map(side));
        soup.close(&sides.collect::<Vec<_>>());
    }
    let mut made = Made::default();
    for edit in after.edits.since(first) {
        match edit {
            Edit::Split(record) => {
                mesh = is_a_split(soup, &mesh, edit, &record);
                made.splits += 1;
            }
            Edit::Insert(record) => {
                assert_eq!(settings.method, CutMethod::Exact, "a method that inserts");
                let (told, children) = insert::plain(&record);
                soup.insert_of_cut(&told, &children);
                let again = Mesh::build_torn(&soup.faces, &soup.roots());
                let again = again.expect("the soup is a manifold");
                insert::changes_nothing_else(&mesh, &again, &record);
                mesh = again;
                made.insertions += 1;
            }
            Edit::Slide(record) => {
                assert!(settings.snap_move, "a cut moves nothing unless it may");
                let [v, toward] = [record.vertex, record.toward].map(|v| v.index());
                assert_eq!(soup.slide(v, toward, record.t), Ok(()), "a slide of a cut");
                slide::names_all_corners(&mesh, &record);
                made.slides += 1;
            }
            other => panic!("no cut makes {other:?}"),
        }
    }
    if settings.seams {
        soup.open();
    } else {
        assert_eq!(mesh, after.mesh, "a cut is nothing but its edits");
    }
    stays_closed(soup, whole, is_one, made.slides > 0);
    made
}

/// Makes the split of a record again; it must come out the same.
fn is_a_split(soup: &mut Soup, before: &Mesh, edit: Edit<'_>, record: &Split<'_>) -> Mesh {
    let faces: Vec<FaceId> = record.corners.iter().map(|h| h.face()).collect();
    let indices: Vec<usize> = faces.iter().map(|f| f.index()).collect();
    let expected = soup.split(record.old.index(), &indices);
    assert_eq!(expected, Ok(()), "a cut makes no split that is refused");
    let mut mesh = before.clone();
    let mut edits = Edits::starting_at(edit.before());
    let again = split_op::vertex(&mut mesh, record.old, &faces, &mut edits);
    assert_eq!(again, Ok(*record), "a split of a cut is a split");
    split::changes_nothing_else(before, &mesh, record);
    mesh
}

/// What is closed by place stays closed by place, and where nothing slid, faces cover what they covered.
fn stays_closed(soup: &Soup, (gaps, area): (Vec<f64>, f64), is_one: bool, slid: bool) {
    let sum = |numbers: &[f64]| numbers.iter().sum::<f64>();
    let left = soup.gaps();
    if is_one && gaps.is_empty() {
        assert_eq!(left, [0.0; 0], "a cut leaves no crack");
    }
    if !slid {
        let off = (soup.area() - area).abs();
        assert!(off <= 1e-9 * area, "the area changes by {off} of {area}");
        // Parts of sides that lie on one line may become partners, so that gaps may become shorter.
        let more = sum(&left) - sum(&gaps);
        let most = 1e-9 * (1.0 + sum(&gaps));
        assert!(!is_one || more <= most, "cracks of a length of {more}");
    }
}

/// An end of a polyline follows all edits: it has vertices of the mesh, each once.
pub(super) fn an_end_has_vertices(end: &CutEnd, mesh: &Mesh) {
    let vertices = end.vertices();
    for (i, v) in vertices.iter().enumerate() {
        assert!(v.index() < mesh.vertex_count(), "{v} is of the mesh");
        assert!(!vertices[..i].contains(v), "{v} is an end once");
    }
}

/// The counts of a report are those of the soup.
pub(super) fn is_reported(
    soup: &Soup,
    before: &World,
    after: &World,
    first: Cursor,
    report: &CutReport,
) {
    assert_eq!(report.pieces_before, before.mesh.components().count());
    let is_split = |edit: &Edit<'_>| matches!(edit, Edit::Split(_));
    let splits = after.edits.since(first).filter(is_split).count();
    assert_eq!(report.splits, splits, "splits of the cut");
    assert_eq!(report.pieces, soup.piece_count(), "pieces after the cut");
}

/// The number of a method, for counts.
pub(super) fn number(method: CutMethod) -> usize {
    match method {
        CutMethod::Partition => 0,
        CutMethod::Exact => 1,
        CutMethod::Uniform => 2,
        CutMethod::Alternating => 3,
        _ => unreachable!("there is no other method"),
    }
}
