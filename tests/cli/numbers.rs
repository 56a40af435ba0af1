//! Vertices are named by their numbers in the file, between which copies for fans may stand.

use crate::harness::Folder;
use crate::plain::Plain;

/// A wheel torn at its hub, with a copy of each vertex that has several fans, and behind it a tile that
/// is torn in two: vertex 19 was split from 16, and 20 from 17.
const TORN: &str = "o wheel\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nv -1 -1 0\nv 0 -1 0\nv 0 0 0\nv 0 0 0\n\
    v 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nv 0 0 0\nv 0 0 0\nf 8 1 2\nf 7 10 3\nf 7 3 4\n\
    f 14 11 5\nf 13 12 6\nf 13 6 9\no tile\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\nv 6 0 0\n\
    v 5 1 0\nf 15 16 17\nf 20 19 18\n\
    #tearmesh record 2 v 20 f 8 vt 0 0 vn 0 0 faces b93094631f04dfcc\n#~ split 8 7 1\n\
    #~ split 19 16 1\n#~ split 20 17 1\n#~ fan 9 1\n#~ fan 10 2\n#~ fan 11 4\n#~ fan 12 5\n\
    #~ fan 13 7\n#~ fan 14 8\n#tearmesh end 9 acb9d961f321039a\n";

#[test]
fn vertices_too_far_apart_are_named_as_in_the_file() {
    let folder = Folder::new();
    let tile = TORN.find("o tile").expect("the second object");
    let (wheel, rest) = TORN.split_at(tile);
    let (own, copies) = rest.split_at(rest.find("v 6 1 0").expect("the fourth corner"));
    let moved = copies.replace("v 6 0 0", "v 7 0 0");
    folder.write("torn.obj", format!("{wheel}{own}{moved}"));
    let answer = folder.ends("mend torn.obj --max-distance 0.5 -o whole.obj", 1);
    assert!(
        answer.contains("the vertices 16 and 19 are 1 apart"),
        "{answer}"
    );
}

#[test]
fn strengths_and_holds_name_vertices_as_in_the_file() {
    let folder = Folder::new();
    folder.write("torn.obj", TORN);
    let tear = |scene: &str, exit: i32| {
        folder.write("s.toml", scene);
        folder.ends("tear torn.obj --seconds 0.01 -o o.obj --scene s.toml", exit)
    };
    // The last vertex, and a copy, which is the vertex that it is of.
    let strong = "base = \"hang\"\n[tear]\n[[strength]]\nfactor = 2\nvertices =";
    tear(&format!("{strong} [20, 9]\n"), 0);
    let answer = tear(&format!("{strong} [21]\n"), 2);
    assert!(
        answer.contains("the mesh has the vertices 1 to 20"),
        "{answer}"
    );
    // Vertex 18 hangs by its hand; what is not held falls.
    tear("[[hold]]\nvertices = [18]\n", 0);
    let [before, after] = [TORN, &folder.read("o.obj")].map(Plain::read);
    let rests = |&v: &usize| before.at(v) == after.at(v);
    let resting: Vec<usize> = (0..after.vertices.len()).filter(rests).collect();
    assert_eq!(resting, [17]);
    let answer = tear("[[hold]]\nvertices = [21]\n", 2);
    let refused = "hold 1 names the vertex 21, and the mesh has the vertices 1 to 20";
    assert!(answer.contains(refused), "{answer}");
}
