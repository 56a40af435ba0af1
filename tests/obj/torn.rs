//! Writing a mesh after splits.

use proptest::prelude::*;
use tearmesh::{FaceId, Point, VertexId, split};
use tearmesh_obj::{Document, WriteSummary};

use super::torn_record::{Work, assert_is_read_again};
use super::{read, rewritten, text, write_as};

/// A cut: the vertex (from 0), and the faces that move to the new one.
type Cut<'c> = (usize, &'c [usize]);

fn cut<'d>(document: &'d Document, cuts: &[Cut<'_>]) -> Work<'d> {
    let mut work = Work::on(document);
    for &(vertex, faces) in cuts {
        let vertex = VertexId::new(vertex).expect("small");
        let faces = faces.iter().map(|&f| FaceId::new(f).expect("small"));
        let faces: Vec<FaceId> = faces.collect();
        work.edit(|mesh, _, edits| {
            split::vertex(mesh, vertex, &faces, edits).expect("a split that is possible");
        });
    }
    work
}

fn check(file: &str, cuts: &[Cut<'_>], expected: &str) -> WriteSummary {
    let document = read(file.as_bytes());
    let Work {
        mesh, positions, ..
    } = &cut(&document, cuts);
    let written = write_as(&document, mesh, positions);
    let all = text(&written);
    let record = all.find("#tearmesh record ").expect("it is torn");
    assert_eq!(&all[..record], expected);
    assert_eq!(text(&rewritten(&written)), all, "written again");
    assert_is_read_again(&cut(&document, cuts), &read(&written), file);
    document
        .write(mesh, positions, &mut std::io::sink())
        .expect("a sink takes all")
}

// Where a vertex at the end of a torn edge lies on the boundary, the two faces no longer share
// an edge there: it gets a second `v`, too.

#[test]
fn new_vertices_follow_the_last_one_and_copy_its_numbers() {
    check(
        "o flag\nv 0 0 0\nv 1 0 0 0.5 0.25 -0\nv 0 1 0\nv 1 1 0\nvt 0 0\n# faces\n\
         f 1/1 2/1 3/1\nf 3/1 2/1 4/1\n",
        &[(1, &[1])],
        "o flag\nv 0 0 0\nv 1 0 0 0.5 0.25 -0\nv 0 1 0\nv 1 1 0\nv 1 0 0 0.5 0.25 -0\nv 0 1 0\n\
         vt 0 0\n# faces\nf 1/1 2/1 3/1\nf 6/1 5/1 4/1\n",
    );
}

#[test]
fn a_later_object_keeps_its_vertices_and_counts_on_from_the_new_ones() {
    check(
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng one\nf 1 2 3\nf 3 2 4\n\
         o b\nv 5 0 0\nnv 1 2 3\n# kept\nv 6 0 0\nv 5 1 0\nny 0 0 0\nnv 7 8 \\\n9\nusemtl b\nf 5 6 7\n",
        &[(1, &[1])],
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\ng one\nf 1 2 3\nf 6 5 4\n\
         o b\nv 5 0 0\nnv 1 2 3\n# kept\nv 6 0 0\nv 5 1 0\nny 0 0 0\nnv 7 8 \\\n9\nusemtl b\nf 7 8 9\n",
    );
}

#[test]
fn new_vertices_of_a_later_object_leave_the_earlier_one_in_place() {
    check(
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\nnl 4\n\
         # end of b\nf 4 5 6\nf 6 5 7\n",
        &[(4, &[2])],
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\nnl 4\n\
         v 6 0 0\nv 5 1 0\n# end of b\nf 4 5 6\nf 9 8 7\n",
    );
}

/// `ARCSim` reads these into the last `v` before them. They stay where they are, and of those about a
/// vertex that has copies now, or of a `v` that is another's now, the number is told.
#[test]
fn what_arcsim_says_of_a_vertex_stays_and_is_not_said_of_its_copies() {
    let start = "v 0 0 0\nv 1 0 0\nnl 2 # pinned\nvt 0\nnv 1 \\\n2 3\ne 1 2\nv 0 1 0\nv 1 1 0\nnl 4\nea 5\n";
    let summary = check(
        &format!("{start}f 1 2 3\nf 3 2 4\n"),
        &[(1, &[1])],
        &format!("{start}v 1 0 0\nv 0 1 0\nf 1 2 3\nf 6 5 4\n"),
    );
    assert_eq!(summary.unspoken, 2);
    let summary = check(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0\nvv 1 2 3\n# end\nf 1 2 3\nf 3 2 4\n",
        &[(1, &[1])],
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nvt 0\nvv 1 2 3\n# end\nf 1 2 3\nf 6 5 4\n",
    );
    assert_eq!(summary.unspoken, 1);
}

#[test]
fn a_vertex_with_several_fans_is_written_as_several() {
    // Six faces round vertex 7. Two opposite ones move to vertex 8: each is a fan there, and
    // 7 keeps two fans of two. Each torn spoke parts two faces that shared a vertex of the rim.
    let file = "v 1 0 0\nv 0.5 1 0\nv -0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0.5 -1 0\nv 0 0 0 0.125\n\
                f 7 1 2\nf 7 2 3\nf 7 3 4\nf 7 4 5\nf 7 5 6\nf 7 6 1\n";
    let summary = check(
        file,
        &[(6, &[0, 3])],
        "v 1 0 0\nv 0.5 1 0\nv -0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0.5 -1 0\nv 0 0 0 0.125\n\
         v 0 0 0 0.125\n\
         v 1 0 0\nv 0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0 0 0 0.125\nv 0 0 0 0.125\n\
         f 8 1 2\nf 7 10 3\nf 7 3 4\nf 14 11 5\nf 13 12 6\nf 13 6 9\n",
    );
    assert_eq!(
        summary,
        WriteSummary {
            vertices: 14,
            faces: 6,
            separated: 6,
            unspoken: 0,
        }
    );
}

#[test]
fn objects_groups_materials_and_corner_data_survive_a_cut() {
    // Only numbers change, and new `v` appear behind those of their object.
    let head = "mtllib a.mtl b.mtl\no shirt\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0.25\nvn 0 0 1\n";
    let torn_head = head.replace("v 1 1 0\n", "v 1 1 0\nv 1 0 0\nv 0 1 0\n");
    check(
        &format!(
            "{head}g left seam\nusemtl red silk\ns 1\nf 1/1/1 2/2/1 3/1/1\n# the seam\ng\nusemtl blue\ns off\n\
             f 3/1/1 2/2/1 4//1\no body\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\ns 2\nf 5/1 6/2 7/1\n"
        ),
        &[(1, &[1]), (2, &[1])],
        &format!(
            "{torn_head}g left seam\nusemtl red silk\ns 1\nf 1/1/1 2/2/1 3/1/1\n# the seam\ng\nusemtl blue\ns off\n\
             f 6/1/1 5/2/1 4//1\no body\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\ns 2\nf 7/1 8/2 9/1\n"
        ),
    );
}

#[test]
fn the_triangles_of_a_quad_can_be_torn_apart() {
    check(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0\nvt 1\nvn 0 0 1\nf 1/1/1 2/2/1 3//1 4\n",
        &[(0, &[1])],
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 1 1 0\nvt 0\nvt 1\nvn 0 0 1\n\
         f 1/1/1 2/2/1 3//1\nf 5/1/1 6//1 4\n",
    );
}

/// A grid of quads and triangles in two objects, the faces of the second before its vertices.
fn two_sheets(side: usize) -> String {
    let mut file = String::new();
    for object in 0..2 {
        file += &format!("o sheet{object}\n");
        let vertices: String = (0..(side + 1) * (side + 1))
            .map(|i| {
                format!(
                    "v {} {} {object} 0.{i}\nnl {i}\n",
                    i % (side + 1),
                    i / (side + 1)
                )
            })
            .collect();
        let first = object * (side + 1) * (side + 1) + 1;
        let faces: String = (0..side * side)
            .map(|i| {
                let a = first + i % side + i / side * (side + 1);
                let (b, c, d) = (a + 1, a + side + 2, a + side + 1);
                if i % 3 == 0 {
                    format!("f {a} {b} {c} {d}\n")
                } else {
                    format!("f {a} {b} {c}\nf {a} {c} {d}\n")
                }
            })
            .collect();
        file += &if object == 0 {
            vertices + &faces
        } else {
            faces + &vertices
        };
    }
    file
}

proptest! {
    #![proptest_config(super::properties(1))]

    /// Any splits: what is written is a mesh without bow-ties that has the same corners, and
    /// is written again byte for byte. With bow-ties it is the same mesh, too.
    #[test]
    fn a_torn_mesh_is_written_whole(
        choices in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..60),
    ) {
        let document = read(two_sheets(3).as_bytes());
        let mut work = Work::on(&document);
        for (vertex, mask) in choices {
            let vertex = VertexId::new(vertex.index(work.mesh.vertex_count())).expect("small");
            let moving: Vec<FaceId> = work
                .mesh
                .faces_of(vertex)
                .enumerate()
                .filter(|(i, _)| mask >> i & 1 == 1)
                .map(|(_, face)| face)
                .collect();
            work.edit(|mesh, _, edits| {
                let _refused = split::vertex(mesh, vertex, &moving, edits);
            });
        }
        let (mesh, positions) = (&work.mesh, &work.positions);
        let mut together = Vec::new();
        let summary = work.torn.write_unseparated(mesh, positions, &mut together);
        prop_assert_eq!(summary.expect("memory takes everything").vertices, mesh.vertex_count());
        let written = text(&together);
        let raw = written.lines().filter_map(|line| line.strip_prefix("f "));
        let raw = raw.flat_map(|line| line.split(' ').map(|corner| corner.parse::<u32>()));
        let raw: Vec<u32> = raw.map(|index| index.expect("a plain index") - 1).collect();
        prop_assert_eq!(&raw[..], mesh.indices(), "vertices have the numbers of the mesh");
        let again = read(&together).mesh();
        prop_assert_eq!(again.as_ref(), Ok(mesh));

        let written = write_as(&document, mesh, positions);
        prop_assert_eq!(text(&work.written()), text(&written));
        let again = read(&written);
        prop_assert_eq!(text(&rewritten(&written)), text(&written));

        let fans: usize = mesh.vertices().map(|v| mesh.fans(v).count().max(1)).sum();
        let statements = text(&written).lines().filter(|line| line.starts_with("v ")).count();
        prop_assert_eq!(statements, fans);
        assert_is_read_again(&work, &again, "two sheets");
        for (torn, original) in again.triangles().iter().zip(document.triangles()) {
            for (&vertex, &root) in torn.iter().zip(original) {
                let (vertex, root) = (vertex as usize, root as usize);
                prop_assert_eq!(again.positions()[vertex], document.positions()[root]);
                prop_assert_eq!(again.extra_numbers(vertex), document.extra_numbers(root));
            }
        }
        let in_order = work.torn.vertices_in_order().into_iter();
        let places: Vec<Point> = in_order.map(|v| positions.at(v)).collect();
        prop_assert_eq!(again.positions(), places);
    }
}
