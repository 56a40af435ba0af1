//! A mesh kernel that somebody has written, with a bug.

/// Triangles, of which some can get a vertex of their own.
pub struct Kernel {
    vertices: usize,
    triangles: Vec<[u32; 3]>,
}

/// The bug: a vertex can have more triangles.
const TRIANGLES_OF_A_VERTEX_MAX: usize = 8;

impl Kernel {
    pub fn new(vertices: usize, triangles: &[[u32; 3]]) -> Kernel {
        Kernel {
            vertices,
            triangles: triangles.to_vec(),
        }
    }

    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Gives some triangles of a vertex a new one. Returns `false` if one of the two would have none.
    pub fn split(&mut self, vertex: usize, moving: &[usize]) -> bool {
        let [old, new] = [vertex, self.vertices].map(|v| v as u32);
        let around = (0..self.triangles.len()).filter(|&f| self.triangles[f].contains(&old));
        let around = around.take(TRIANGLES_OF_A_VERTEX_MAX);
        let (moves, stays): (Vec<_>, Vec<_>) = around.partition(|f| moving.contains(f));
        if moves.is_empty() || stays.is_empty() {
            return false;
        }
        for f in moves {
            self.triangles[f] = self.triangles[f].map(|v| if v == old { new } else { v });
        }
        self.vertices += 1;
        true
    }
}
