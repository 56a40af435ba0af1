//! The exact cut in lock step with an oracle in fractions: cuts one after another across small flat sheets
//! whose corners and lines are whole numbers.

use std::collections::BTreeMap;

use tearmesh::{CutMethod, Edits, Mesh, Plane, Point, Positions, Scissor, Vector, VertexId};

use crate::cases::cases;
use crate::oracle::rational::{Fraction, Line, Sheet};
use crate::random::Random;

/// Far below what any two points of such a sheet are apart, and far above what rounding does to them.
const NEAR: f64 = 1e-9;

fn whole(random: &mut Random, least: i128, most: i128) -> i128 {
    least + ((most - least + 1) as f64 * random.next()) as i128
}

/// A grid with a distance of 4 between its points, and diagonals that run either way.
fn grid(random: &mut Random) -> (Sheet, [i128; 2]) {
    let size = [(); 2].map(|()| whole(random, 1, 4));
    let [columns, rows] = size;
    let at = |x: i128, y: i128| (y * (columns + 1) + x) as usize;
    let fraction = |number| Fraction::new(number, 1);
    let mut sheet = Sheet {
        points: Vec::new(),
        faces: Vec::new(),
    };
    for y in 0..=rows {
        for x in 0..=columns {
            sheet.points.push([fraction(4 * x), fraction(4 * y)]);
        }
    }
    for y in 0..rows {
        for x in 0..columns {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            sheet.faces.extend(match random.next() < 0.5 {
                true => [[a, b, c], [a, c, d]],
                false => [[a, b, d], [b, c, d]],
            });
        }
    }
    (sheet, size)
}

fn is_near(p: Point, q: [Fraction; 2]) -> bool {
    (p.x - q[0].to_f64()).abs() < NEAR && (p.y - q[1].to_f64()).abs() < NEAR && p.z == 0.0
}

/// Every face of the mesh is one of the sheet, and corners of faces are one in the mesh where they are one
/// in the sheet.
fn is_the_sheet(mesh: &Mesh, positions: &Positions, sheet: &Sheet) -> Result<(), String> {
    if mesh.face_count() != sheet.faces.len() || mesh.vertex_count() != sheet.points.len() {
        let [faces, points] = [sheet.faces.len(), sheet.points.len()];
        return Err(format!("{faces} faces of {points} corners, not {mesh:?}"));
    }
    let mut corner_of: BTreeMap<VertexId, usize> = BTreeMap::new();
    let mut vertex_of: BTreeMap<usize, VertexId> = BTreeMap::new();
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f);
        let found = sheet.faces.iter().find_map(|&[x, y, z]| {
            let turned = [[x, y, z], [y, z, x], [z, x, y]];
            turned.into_iter().find(|turned| {
                let mut pairs = [a, b, c].into_iter().zip(turned);
                pairs.all(|(v, &corner)| is_near(positions.at(v), sheet.points[corner]))
            })
        });
        let found = found.ok_or_else(|| format!("{f} is no face of the sheet"))?;
        for (v, corner) in [a, b, c].into_iter().zip(found) {
            let corner_before = *corner_of.entry(v).or_insert(corner);
            let vertex_before = *vertex_of.entry(corner).or_insert(v);
            if (corner_before, vertex_before) != (corner, v) {
                return Err(format!(
                    "{v} of {f} is one with other corners than in the sheet"
                ));
            }
        }
    }
    Ok(())
}

#[test]
fn exact_cuts_in_lock_step_with_fractions() {
    let (mut cuts, mut divided, mut torn_before) = (0, 0, 0);
    for seed in 0..cases() {
        let mut random = Random(seed);
        let (mut sheet, size) = grid(&mut random);
        let points = sheet
            .points
            .iter()
            .map(|p| [p[0].to_f64(), p[1].to_f64(), 0.0]);
        let mut positions = Positions::new(points).expect("whole numbers");
        let triangles: Vec<[u32; 3]> = sheet
            .faces
            .iter()
            .map(|face| face.map(|v| v as u32))
            .collect();
        let mut mesh = Mesh::build(positions.len(), &triangles).expect("a grid");
        let mut edits = Edits::new();
        for _ in 0..whole(&mut random, 1, 3) {
            let normal = [(); 2].map(|()| whole(&mut random, -3, 3));
            let through = size.map(|cells| whole(&mut random, 0, 4 * cells));
            if normal == [0, 0] {
                continue;
            }
            let line: Line = [
                normal[0],
                normal[1],
                normal[0] * through[0] + normal[1] * through[1],
            ];
            let [x, y] = through.map(|x| x as f64);
            let [a, b] = normal.map(|x| x as f64);
            let plane =
                Plane::new(Point::new(x, y, 0.0), Vector::new(a, b, 0.0)).expect("a normal");
            let faces = mesh.face_count();
            torn_before += usize::from(mesh.half_edges().any(|h| mesh.ghost_pair(h).is_some()));
            Scissor::by_plane(plane)
                .with_snap(0.0)
                .cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
                .expect("positions are in step");
            let has_edge = |ends: [[Fraction; 2]; 2]| {
                mesh.edges().any(|h| {
                    let at = [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
                    let is = |p, q| is_near(at[0], p) && is_near(at[1], q);
                    is(ends[0], ends[1]) || is(ends[1], ends[0])
                })
            };
            sheet.cut(line, has_edge);
            let agreed = is_the_sheet(&mesh, &positions, &sheet);
            assert_eq!(agreed, Ok(()), "seed {seed}, cut along {line:?}");
            assert_eq!(mesh.check(), []);
            cuts += 1;
            divided += usize::from(mesh.face_count() > faces);
        }
    }
    assert!(divided > cuts / 2 && torn_before > cuts / 3);
}
