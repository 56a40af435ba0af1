//! The source of each vertex, corner and face of a mesh, to carry over weights, bones, colours and
//! materials.

use std::io::{self, Write};

use tearmesh::{Cursor, Edit, Follower, Mesh, Mix};
use tearmesh_obj::{Document, TornDocument};

/// Elements of the input that an element is made of, ascending, each with its weight; the weights are of
/// sum one up to rounding.
type Sources = Vec<(u32, f64)>;

fn one(source: u32) -> Sources {
    vec![(source, 1.0)]
}

fn mixed(mix: Mix<&Sources>) -> Sources {
    match mix {
        Mix::Copy(one) => one.clone(),
        Mix::Between { ends: [a, b], t } => sum(&[(a, 1.0 - t), (b, t)]),
        Mix::Weighted { of, weights } => {
            let [a, b, c] = weights;
            sum(&[(of[0], a), (of[1], b), (of[2], c)])
        }
        _ => unreachable!("there is no other mix"),
    }
}

fn sum(parts: &[(&Sources, f64)]) -> Sources {
    let scaled = parts.iter().flat_map(|(sources, part)| {
        let sources = sources.iter();
        sources.map(move |(source, weight)| (*source, weight * part))
    });
    let mut list: Sources = scaled.collect();
    list.sort_by_key(|&(source, _)| source);
    list.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        kept.1 += if is_same { next.1 } else { 0.0 };
        is_same
    });
    match list[..] {
        [(source, _)] => one(source),
        _ => list,
    }
}

/// A corner of a face.
#[derive(Clone, Debug)]
struct Corner {
    of: Sources,
    /// Its texture coordinate, as a mix of those of the file. Where a vertex slides, corners that have
    /// the same one go together.
    texture: Sources,
}

impl PartialEq for Corner {
    fn eq(&self, other: &Corner) -> bool {
        self.texture == other.texture
    }
}

impl Corner {
    fn mixed(mix: Mix<&Corner>) -> Corner {
        Corner {
            of: mixed(mix.map(|corner| &corner.of)),
            texture: mixed(mix.map(|corner| &corner.texture)),
        }
    }
}

/// Where the vertices, corners and faces of a mesh come from, as its file counts them, from 0. Corners
/// are counted through all faces of the file, which may have more than three.
pub(super) struct Map {
    seen: Cursor,
    vertices: Vec<Sources>,
    corners: Vec<Corner>,
    faces: Vec<u32>,
}

impl Map {
    /// The mesh of the document, which has seen no edit yet.
    pub(super) fn new(document: &Document) -> Map {
        let number = |v: usize| document.number_of_vertex(v) as u32 - 1;
        let vertices = 0..document.positions().len();
        let triangles = 0..document.triangles().len();
        let corners = triangles.clone().flat_map(|t| [0, 1, 2].map(|c| (t, c)));
        let corners = corners.map(|(triangle, corner)| {
            let texture = document.corner(triangle, corner).texture;
            Corner {
                of: one(document.number_of_corner(triangle, corner) as u32),
                texture: one(texture.unwrap_or(u32::MAX)),
            }
        });
        Map {
            seen: Cursor::START,
            vertices: vertices.map(|v| one(number(v))).collect(),
            corners: corners.collect(),
            faces: triangles.map(|t| document.polygon_of(t) as u32).collect(),
        }
    }

    /// Writes the map as JSON, an element a line, in the order of the file that the document is written
    /// to. `names` are those of the input and of the output.
    pub(super) fn write(
        &self,
        torn: &TornDocument<'_>,
        mesh: &Mesh,
        names: [Option<&str>; 2],
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let vertices = torn.statements_in_order(mesh);
        let faces = torn.faces_in_order();
        let document = torn.document();
        let polygons = document.polygon_count();
        let corners = (0..polygons).map(|polygon| document.polygon(polygon).len());
        let [input, output] = names.map(|name| serde_json::json!(name));
        let sizes = |vertices: usize, corners: usize, faces: usize| {
            format!("\"vertices\":{vertices},\"corners\":{corners},\"faces\":{faces}")
        };
        let before = sizes(document.vertex_statement_count(), corners.sum(), polygons);
        let after = sizes(vertices.len(), 3 * faces.len(), faces.len());
        writeln!(out, "{{\"schema\":\"tearmesh.map/1\",\"counts_from\":0,")?;
        writeln!(out, "\"input\":{{\"path\":{input},{before}}},")?;
        writeln!(out, "\"output\":{{\"path\":{output},{after}}},")?;
        let of_vertices = vertices.iter().map(|v| &self.vertices[v.index()]);
        write_all("vertices", of_vertices, out)?;
        let half_edges = faces.iter().flat_map(|f| f.half_edges());
        let of_corners = half_edges.map(|h| &self.corners[h.index()].of);
        write_all("corners", of_corners, out)?;
        let of_faces = faces.iter().map(|f| self.faces[f.index()]);
        let of_faces: Vec<String> = of_faces.map(|face| face.to_string()).collect();
        writeln!(out, "\"faces\":[\n{}\n]}}", of_faces.join(",\n"))
    }
}

fn write_all<'s>(
    name: &str,
    all: impl Iterator<Item = &'s Sources>,
    out: &mut dyn Write,
) -> io::Result<()> {
    write!(out, "\"{name}\":[")?;
    for (i, sources) in all.enumerate() {
        write!(out, "{}", if i == 0 { "\n" } else { ",\n" })?;
        let pair = |(of, weight): &(u32, f64)| format!("[{of},{weight}]");
        let pairs = sources.iter().map(pair);
        write!(out, "[{}]", pairs.collect::<Vec<_>>().join(","))?;
    }
    writeln!(out, "\n],")
}

impl Follower for Map {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for op in edit.vertex_ops() {
            op.apply(&mut self.vertices, mixed);
        }
        edit.apply_to_corners(&mut self.corners, Corner::mixed);
        edit.apply_to_faces(&mut self.faces);
    }
}
