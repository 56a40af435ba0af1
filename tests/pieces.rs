//! Pieces, counted the plain way.

use tearmesh::Mesh;

/// The numbers of the pieces that faces belong to, joined by shared vertices.
pub(crate) fn pieces_by_vertices(mesh: &Mesh) -> Vec<usize> {
    let faces: Vec<&[u32]> = mesh.indices().chunks(3).collect();
    let mut piece: Vec<usize> = (0..faces.len()).collect();
    let mut changed = true;
    while changed {
        changed = false;
        let mut least = vec![usize::MAX; mesh.vertex_count()];
        for (f, face) in faces.iter().enumerate() {
            for &v in *face {
                least[v as usize] = least[v as usize].min(piece[f]);
            }
        }
        for (f, face) in faces.iter().enumerate() {
            let smallest = face
                .iter()
                .map(|&v| least[v as usize])
                .min()
                .expect("three vertices");
            changed |= smallest != piece[f];
            piece[f] = smallest;
        }
    }
    piece
}
