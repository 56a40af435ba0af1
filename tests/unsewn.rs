//! Seams that coincide and are not sewn: found by place, closed while a cut is made, and reopened.
//!
//! The oracle compares all pairs of boundary edges of plain triangles, and judges what is closed by
//! building the mesh anew from triangles and roots.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{
    CutError, CutLayers, CutMethod, Edits, Follower as _, Mesh, Plane, Positions, Scissor, Vector,
    shapes,
};

use crate::cases::cases;
use crate::oracle::by_place::{by_place, has_layers, lies_on, open_edges, place};
use crate::oracle::joined_sets;
use crate::oracle::straight::{Surface, length, minus};
use crate::random::Random;
use crate::surfaces::{built, delaunay, doubled, jittered, sphere, surface, unsewn};
use crate::work::ray;

type Point = [f64; 3];

/// The boundary edges of a surface that are each other's only partner, by all pairs of edges.
fn partners(surface: &Surface) -> BTreeSet<[[u32; 2]; 2]> {
    let directed = surface.directed_edges();
    let mut boundary: Vec<([u32; 2], u32)> = Vec::new();
    for &[a, b, c] in &surface.faces {
        for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
            if !directed.contains_key(&(b, a)) {
                boundary.push(([a, b], c));
            }
        }
    }
    let at = |v: u32| place(surface.points[v as usize]);
    let is_thin =
        |&([a, b], c): &([u32; 2], u32)| at(a) == at(b) || [at(a), at(b)].contains(&at(c));
    let are_partners = |one: &([u32; 2], u32), other: &([u32; 2], u32)| {
        let ([a, b], [c, d]) = (one.0, other.0);
        at(a) == at(d)
            && at(b) == at(c)
            && at(one.1) != at(other.1)
            && !is_thin(one)
            && !is_thin(other)
    };
    let all = |one: &([u32; 2], u32)| {
        let partners = boundary.iter().filter(|other| are_partners(one, other));
        partners.map(|other| other.0).collect::<Vec<_>>()
    };
    let mut found = BTreeSet::new();
    for one in &boundary {
        if let [other] = all(one)[..] {
            let back = boundary
                .iter()
                .find(|back| back.0 == other)
                .expect("it is there");
            if all(back) == [one.0] {
                found.insert([one.0.min(other), one.0.max(other)]);
            }
        }
    }
    found
}

fn wholes(random: &mut Random) -> Vec<Surface> {
    let half = 1 + random.below(2) as u32;
    vec![
        folded(half, random),
        surface(&shapes::grid(5, 4)),
        jittered(6, random),
        delaunay(50, 6, random),
        sphere(1),
        surface(&shapes::tube(7, 3)),
        surface(&shapes::torus(7, 5)),
        doubled(&surface(&shapes::grid(3, 3))),
        pillow(random),
        slit(random),
        with_copies(&sphere(1), random),
        surface(&shapes::fan(9, true)),
    ]
}

/// Triangles on a few places, with vertices of their own but for some edges: whatever sides can meet in.
fn triangles(random: &mut Random) -> Surface {
    let places = 4 + random.below(3);
    let part = 0.1 + 0.5 * random.next();
    let mut loose = Surface::default();
    let mut add = |corners: [usize; 3]| {
        let first = loose.points.len() as u32;
        let point = |i: usize| [(i * i) as f64, i as f64, (i % 3) as f64];
        loose.points.extend(corners.map(point));
        loose.faces.push([first, first + 1, first + 2]);
    };
    for a in 0..places {
        for b in a..places {
            for c in b + 1..places {
                for corners in [[a, b, c], [b, a, c]] {
                    let part = if a == b { 0.1 * part } else { part };
                    if random.next() < part {
                        add(corners);
                    }
                }
            }
        }
    }
    if loose.faces.is_empty() {
        loose.points.extend([[0.0; 3], [1.0; 3], [2.0, 1.0, 0.0]]);
        loose.faces.push([0, 1, 2]);
    }
    loose
}

/// A sheet that is folded in the middle, so that two sides of it coincide. Sewn, it is a flat tube, with
/// twice the same edges round it if it is a cell wide.
fn folded(half: u32, random: &mut Random) -> Surface {
    let turns: Vec<bool> = (0..64).map(|_| random.next() < 0.5).collect();
    let diagonal = |x: u32, y: u32| turns[(8 * y + x) as usize % 64];
    let mut sheet = surface(&shapes::grid_with_diagonals(2 * half, 3, diagonal));
    for [x, ..] in &mut sheet.points {
        *x = 0.5 - (*x - 0.5).abs();
    }
    sheet
}

/// A narrow strip and its back, whose diagonals need not be the same. Sewn, some faces would lie back to
/// back with the same vertices.
fn pillow(random: &mut Random) -> Surface {
    let turns: Vec<bool> = (0..16).map(|_| random.next() < 0.5).collect();
    let strip = |from: usize| {
        let diagonal = |x: u32, _| turns[from + x as usize];
        surface(&shapes::grid_with_diagonals(5, 1, diagonal))
    };
    let [front, back] = [0, 8].map(strip);
    let mut both = doubled(&front);
    let first = front.points.len() as u32;
    let backward = back
        .faces
        .iter()
        .map(|&[a, b, c]| [c, b, a].map(|v| v + first));
    both.faces.truncate(front.faces.len());
    both.faces.extend(backward);
    both
}

/// A round sheet with a slit from its rim. It ends at a face with two corners at one place, or at one that
/// lies on another; sewn, the edge between the two would have a third face.
fn slit(random: &mut Random) -> Surface {
    let sides = 4 + random.below(4) as u32;
    let mut sheet = Surface::default();
    sheet.points.push([0.0; 3]);
    for ring in [1, 2] {
        for i in 0..=sides {
            let angle = TAU * f64::from(i % sides) / f64::from(sides);
            sheet
                .points
                .push([angle.cos(), angle.sin(), 0.2].map(|x| x * f64::from(ring)));
        }
    }
    let [inner, outer] = [1, 2 + sides];
    for i in 0..sides {
        let [a, b, c, d] = [inner + i, inner + i + 1, outer + i, outer + i + 1];
        sheet.faces.extend([[0, a, b], [a, c, b], [c, d, b]]);
    }
    let over = sheet.points[inner as usize + 1];
    sheet.points.push(over);
    let over = [inner, outer + sides + 1][random.below(2)];
    sheet.faces.push([0, inner + sides, over]);
    sheet
}

/// A surface, and loose copies of a few of its faces, so that three sides meet at their edges.
fn with_copies(whole: &Surface, random: &mut Random) -> Surface {
    let mut more = whole.clone();
    for _ in 0..1 + random.below(2) {
        let first = more.points.len() as u32;
        let corners = whole.faces[random.below(whole.faces.len())];
        let corners = corners.map(|v| whole.points[v as usize]);
        more.points.extend(corners);
        more.faces.push([first, first + 1, first + 2]);
    }
    more
}

fn edges(mesh: &Mesh, seams: &UnsewnSeams) -> BTreeSet<[[u32; 2]; 2]> {
    let ends = |h| [mesh.origin(h), mesh.target(h)].map(u32::from);
    let pairs = seams.edges().iter();
    let pairs = pairs.map(|pair| pair.map(ends));
    pairs
        .map(|[one, other]| [one.min(other), one.max(other)])
        .collect()
}

#[test]
fn seams_are_those_of_all_pairs_of_edges() {
    let mut random = Random(5);
    let (mut found, mut left, mut enclosed) = (0, 0, 0);
    for i in 0..cases() {
        let wholes = wholes(&mut random);
        let parts = match i % 2 {
            0 if random.next() < 0.2 => wholes[i as usize / 2 % wholes.len()].clone(),
            0 => unsewn(&wholes[i as usize / 2 % wholes.len()], 0.3, &mut random),
            _ => triangles(&mut random),
        };
        let (mut mesh, positions) = built(&parts);
        let seams = UnsewnSeams::find(&mesh, &positions);
        let [oracle, ours] = [partners(&parts), edges(&mesh, &seams)];
        // More than two sides may meet at an edge both ends of which seams join.
        let extra = ours.difference(&oracle).count();
        enclosed += extra;
        let apart = seams.left_apart().not_manifold;
        assert_eq!(2 * (oracle.len() + extra - ours.len()), apart, "{parts:?}");
        found += ours.len();
        left += apart;

        // What is closed is what triangles and roots say.
        let closed = seams.close(&mut mesh);
        assert_eq!(mesh.check(), []);
        let triangles = mesh.indices().as_chunks().0;
        assert_eq!(
            Mesh::build_torn(triangles, &mesh.roots()).as_ref(),
            Ok(&mesh)
        );
        // And what was left apart would not be a manifold.
        if apart > 0 {
            let joined = oracle.iter().flat_map(|&[[a, b], [c, d]]| [[a, d], [b, c]]);
            let joined: Vec<_> = joined.map(|pair| pair.map(|v| v as usize)).collect();
            let roots = joined_sets(parts.points.len(), &joined);
            let roots: Vec<u32> = roots.into_iter().map(|root| root as u32).collect();
            assert!(Mesh::build_torn(triangles, &roots).is_err());
        }
        closed.reopen(&mut mesh);
        assert_eq!(mesh, built(&parts).0);

        let welded = seams.welded(&mesh, &positions);
        assert_eq!(welded.mesh.check(), []);
        assert_eq!(welded.mesh.face_count(), mesh.face_count());
        let at = |v: tearmesh::VertexId| welded.positions.at(welded.vertices[v.index()]);
        assert!(mesh.vertices().all(|v| at(v) == positions.at(v)));
        // Of more than two sides, two may be left that belong together.
        let again = UnsewnSeams::find(&welded.mesh, &welded.positions);
        assert!(again.is_empty() || seams.left_apart().crowded > 0);
    }
    println!("{found} seam edges, {enclosed} enclosed, {left} left apart");
    assert!(found > 1000 && enclosed > 0 && left > 0);
}

/// A scissor that meets a surface: a plane, which may hold vertices, or rays from one eye or parallel.
fn scissor(of: &Surface, random: &mut Random) -> Scissor {
    let pick = |random: &mut Random| of.points[random.below(of.points.len())];
    let edge = of.mean_edge();
    let near = |random: &mut Random| {
        let by = edge * [0.0, 0.01, 0.3, 1.0][random.below(4)];
        pick(random).map(|x| x + by * (random.next() - 0.5))
    };
    let (p, q) = (near(random), near(random));
    let view = [random.next() - 0.5, random.next() - 0.5, -1.0];
    let eye = [0, 1, 2].map(|i| p[i] - 3.0 * view[i]);
    let kind = random.below(3);
    if kind < 2 && length(minus(p, q)) > 1e-9 {
        let far = |p: Point| [0, 1, 2].map(|i| p[i] - 3.0 * view[i]);
        let rays = match kind {
            0 => [p, q].map(|p| ray((eye, minus(p, eye)))),
            _ => [p, q].map(|p| ray((far(p), view))),
        };
        if let Ok(scissor) = Scissor::new(rays[0], rays[1]) {
            return scissor;
        }
    }
    let normal = match random.below(4) {
        axis if axis < 3 => [0, 1, 2].map(|i| f64::from(u8::from(i == axis))),
        _ => [
            random.next() - 0.5,
            random.next() - 0.5,
            random.next() - 0.5,
        ],
    };
    Scissor::by_plane(Plane::new(p.into(), Vector::from(normal)).expect("a normal"))
}

/// Cuts a mesh whose seams are closed meanwhile. What is torn then is what the cut tore and what was
/// torn before: sewn up, the mesh has the border that it had.
fn cut_closed(
    (mesh, positions): &mut (Mesh, Positions),
    scissor: &Scissor,
    method: CutMethod,
) -> Result<(), CutError> {
    let before = border_of_sewn(mesh, positions);
    let mut edits = Edits::new();
    let mut at = positions.clone().starting_at(edits.cursor());
    let mut closed = UnsewnSeams::find(mesh, &at).close(mesh);
    scissor.cut(method, mesh, &mut at, &mut edits)?;
    edits.replay(&mut closed);
    closed.reopen(mesh);
    *positions = at;
    assert_eq!(mesh.check(), []);
    let triangles = mesh.indices().as_chunks().0;
    assert_eq!(
        Mesh::build_torn(triangles, &mesh.roots()).as_ref(),
        Ok(&*mesh)
    );
    let after = border_of_sewn(mesh, positions);
    let off = (after - before).abs();
    assert!(
        off <= 1e-9 * before.max(1.0),
        "{before} of border is {after}"
    );
    Ok(())
}

/// The length of the edges with one face, where all vertices with one root are one.
fn border_of_sewn(mesh: &Mesh, positions: &Positions) -> f64 {
    let roots = mesh.roots();
    let mut sewn = surface(&(mesh.clone(), positions.clone()));
    for v in sewn.faces.as_flattened_mut() {
        *v = roots[*v as usize];
    }
    let directed = sewn.directed_edges();
    let border = directed
        .keys()
        .filter(|(a, b)| !directed.contains_key(&(*b, *a)));
    let long = |&(a, b): &(u32, u32)| {
        let [from, to] = [a, b].map(|v| sewn.points[v as usize]);
        length(minus(to, from))
    };
    border.map(long).sum()
}

/// A cut of parts is that of the whole, face by face; and where vertices slide on one of them alone, it
/// opens no edge.
#[test]
fn cuts_across_unsewn_seams_are_those_of_the_whole() {
    let mut random = Random(17);
    let (mut cuts, mut seams, mut slid, mut twice) = (0, 0, 0, 0);
    for i in 0..cases() {
        let wholes = wholes(&mut random);
        let whole = &wholes[i as usize % wholes.len()];
        let parts = unsewn(whole, 0.3, &mut random);
        let snap = [0.0, 0.01, Scissor::SNAP, 0.2, 0.49][random.below(5)];
        let moves = random.next() < 0.3;
        let layers = [CutLayers::All, CutLayers::First][random.below(2)];
        let method = [CutMethod::Exact, CutMethod::Exact, CutMethod::Partition][random.below(3)];
        let [scissor, second] = [0, 1].map(|_| {
            let scissor = scissor(whole, &mut random);
            scissor
                .with_snap(snap)
                .with_snap_move(moves)
                .with_layers(layers)
        });
        let mut parts = built(&parts);
        let found = UnsewnSeams::find(&parts.0, &parts.1);
        let welded = found.welded(&parts.0, &parts.1);
        let mut welded = (welded.mesh, welded.positions);
        let before = surface(&welded);
        if cut_closed(&mut parts, &scissor, method).is_err() {
            continue;
        }
        let of_whole = cut_closed(&mut welded, &scissor, method);
        of_whole.expect("parts were cut");
        let [of_parts, of_whole] = [&parts, &welded].map(surface);
        seams += found.edges().len();
        cuts += usize::from(of_parts.faces.len() > before.faces.len());
        slid += usize::from(moves);
        // A tip is never moved onto a boundary, and to a tip, a seam is one.
        if !moves && scissor.sides().is_none() {
            let is_same = by_place(&of_parts) == by_place(&of_whole);
            assert!(is_same, "case {i}, snap {snap}");
        }
        // Layers at one place hide each other's edges, until one of them is cut alone.
        let open = open_edges(&before);
        for edge in open_edges(&of_parts) {
            // A vertex that slides along the boundary lengthens an edge of it.
            let is_old = |p: Point| open.iter().any(|&old| lies_on([p, p], old));
            let middle = [0, 1, 2].map(|i| (edge[0][i] + edge[1][i]) / 2.0);
            let is_old = [edge[0], middle, edge[1]].into_iter().all(is_old);
            assert!(is_old || has_layers(&before), "case {i}: {edge:?} opened");
        }
        twice += usize::from(cut_closed(&mut parts, &second, method).is_ok());
    }
    println!(
        "{cuts} cuts that inserted, {twice} second ones, {slid} with slides, across {seams} seam edges"
    );
}

/// A sheet in parts is one layer: also where a snapped seam ends beyond the rays, across a seam that is closed
/// meanwhile. (Found by combinations of `--layers first`, `--snap` and seams.)
#[test]
fn regression_the_first_layer_of_a_sheet_in_parts_is_all_of_it() {
    let mut random = Random(43);
    let mut torn = 0;
    for case in 0..cases() {
        let sheet = unsewn(&delaunay(30, 4, &mut random), 1.0, &mut random);
        let mut at = || ([random.next(), random.next(), 1.0], [0.0, 0.0, -1.0]);
        let rays = [at(), at()].map(ray);
        let snap = [0.0, 0.05, 0.2, 0.49][case as usize % 4];
        let both = [CutLayers::All, CutLayers::First].map(|layers| {
            let scissor = Scissor::new(rays[0], rays[1]).expect("a plane");
            let mut mesh = built(&sheet);
            let scissor = scissor.with_snap(snap).with_layers(layers);
            cut_closed(&mut mesh, &scissor, CutMethod::Exact).expect("parallel rays");
            [mesh.0.vertex_count(), mesh.0.face_count()]
        });
        assert_eq!(both[0], both[1], "case {case}, snap {snap}");
        torn += usize::from(both[0][0] > sheet.points.len());
    }
    assert!(2 * torn as u64 > cases());
}

/// Nothing sews the front of double-sided cloth to its back, so each side decides by itself. It decides alike
/// on the outline that both share, in ties too, whatever corner its faces begin with.
#[test]
fn double_sided_cloth_stays_closed_round_its_outline() {
    let mut random = Random(31);
    let mut cuts = 0;
    for case in 0..4 * cases() {
        let turns: Vec<bool> = (0..64).map(|_| random.next() < 0.5).collect();
        let diagonal = |x: u32, y: u32| turns[(8 * y + x) as usize % 64];
        let [x, y] = [0; 2].map(|_| 1 + random.below(5) as u32);
        let mut cloth = doubled(&surface(&shapes::grid_with_diagonals(x, y, diagonal)));
        for face in &mut cloth.faces {
            face.rotate_left(random.below(3));
        }
        // On a lattice, where ties are frequent.
        let mut at = || [0; 2].map(|_| 0.05 * (random.below(23) as f64 - 1.0));
        let ends = [at(), at()];
        let snap = [Scissor::SNAP, 0.0, 0.1, 0.2, 0.25, 0.4][random.below(6)];
        if let Some(open) = opened(&cloth, ends, snap, random.next() < 0.3) {
            cuts += 1;
            assert!(
                open.is_empty(),
                "case {case}: {ends:?}, snap {snap}: {open:?}"
            );
        }
    }
    assert!(cuts > 100);
}

/// The edges that a slit from one point to another, seen from above, leaves without an opposite.
fn opened(cloth: &Surface, ends: [[f64; 2]; 2], snap: f64, moves: bool) -> Option<Vec<[Point; 2]>> {
    let [a, b] = ends.map(|[x, y]| ray(([x, y, 1.0], [0.0, 0.0, -1.0])));
    let scissor = Scissor::new(a, b)
        .ok()?
        .with_snap(snap)
        .with_snap_move(moves);
    let mut mesh = built(cloth);
    cut_closed(&mut mesh, &scissor, CutMethod::Exact).ok()?;
    Some(open_edges(&surface(&mesh)))
}

#[test]
fn regression_both_sides_take_a_tip_for_the_same_node() {
    let cloth = doubled(&surface(&shapes::grid_with_diagonals(1, 2, |_, _| false)));
    let open = opened(&cloth, [[0.1, 0.6], [0.5, 0.1]], 0.2, false);
    assert_eq!(open, Some(Vec::new()));
}
