//! One sheet on four meshes: what of an answer is the mesh's, by springs and by triangles.

use tearmesh::insert::Plan;
use tearmesh::{Edits, HalfEdgeId, Mesh, Point, Positions, Vector, VertexId};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
use tearmesh_cloth::{Fabric, Implicit, force};

use crate::parts::cloths::cloth;
use crate::parts::scenes::{square, torn_first};
use crate::parts::woven::of_moduli;
use crate::parts::{near, pulled, run};
use crate::random::Random;

const MODULUS_N_PER_M: f64 = 1000.0;

fn is_inner(p: Point) -> bool {
    [p.x, p.y].iter().all(|x| (0.01..0.99).contains(x))
}

/// A square metre with its upper edge along y = 1.
fn meshes() -> [(&'static str, Mesh, Positions); 4] {
    let (mesh, even) = square(12);
    let moved = |by: &mut dyn FnMut(usize) -> [f64; 2]| {
        let points = even.as_slice().iter().enumerate().map(|(v, p)| {
            let [x, y] = if is_inner(*p) { by(v) } else { [0.0; 2] };
            [p.x + x / 12.0, p.y + y / 12.0, 0.0]
        });
        Positions::new(points).expect("finite")
    };
    let mut random = Random(7);
    let uneven = moved(&mut |_| [0, 1].map(|_| 0.3 * (2.0 * random.next() - 1.0)));
    // Every fifth vertex is all but at its neighbour.
    let slivers = moved(&mut |v| [if v % 5 == 0 { 0.95 } else { 0.0 }, 0.0]);
    let (mut finer, mut refined, mut edits) = (mesh.clone(), even.clone(), Edits::new());
    for _ in 0..2 {
        let mut plan = Plan::new();
        for h in finer.edges() {
            let [a, b] = [finer.origin(h), finer.target(h)].map(|v| refined.at(v));
            if a.x.max(b.x) < 0.5 && a.y.min(b.y) > 0.4 {
                plan.on_edge(h, 0.5);
            }
        }
        plan.apply(&mut finer, &mut edits).expect("a plan");
        edits.replay(&mut refined);
    }
    [
        ("even", mesh.clone(), even.clone()),
        ("uneven", mesh.clone(), uneven),
        ("slivers", mesh, slivers),
        ("refined", finer, refined),
    ]
}

fn springs() -> Fabric {
    Fabric::new(MODULUS_N_PER_M)
}

fn triangles() -> Fabric {
    let moduli = [1.0, 1.0, 0.5].map(|part| part * MODULUS_N_PER_M);
    Fabric::orthotropic(of_moduli(moduli, Vector::y()))
}

/// The droop of the lower edge's middle, and the 99th percentile of the strains of edges that lie further
/// than .15 m from where the sheet is held, at rest.
fn hung(mesh: &Mesh, positions: &Positions, fabric: Fabric) -> [f64; 2] {
    let mut cloth = cloth(mesh, positions, fabric);
    let rest = positions.as_slice();
    let system = cloth.system_mut();
    for v in (0..rest.len()).filter(|&v| rest[v].y > 0.99) {
        system.hold(v);
    }
    let loads = pulled(Vector::y() * -100.0, 2.0);
    system.set_loads(loads).expect("loads");
    run(system, Implicit::default(), 0.1, 150);
    let away = |v: &usize| (rest[*v] - Point::new(0.5, 0.0, 0.0)).norm();
    let middle = (0..rest.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
    let middle = middle.expect("a vertex");
    let droop_m = rest[middle].y - system.positions()[middle].y;
    let low = |v: VertexId| positions.at(v).y < 0.85;
    let is_low = |&h: &HalfEdgeId| low(mesh.origin(h)) && low(mesh.target(h));
    let strain = |h| cloth.system().stretch_ratio(cloth.stretch(h)) - 1.0;
    let mut strains: Vec<f64> = mesh.edges().filter(is_low).map(strain).collect();
    strains.sort_unstable_by(f64::total_cmp);
    [droop_m, strains[strains.len() * 99 / 100]]
}

/// A stretch of a tenth, everywhere the same, is at equilibrium in a membrane. The largest force on a vertex
/// inside, over E times the mean length of its edges.
fn patch(mesh: &Mesh, positions: &Positions, fabric: Fabric) -> f64 {
    let mut cloth = cloth(mesh, positions, fabric);
    for p in cloth.system_mut().state_mut().0 {
        p.y *= 1.1;
    }
    let inner = mesh.vertices().filter(|&v| is_inner(positions.at(v)));
    let missed = inner.map(|v| {
        let lengths = mesh.faces_of(v).map(|f| {
            let [a, b, _] = mesh.face_vertices(f).map(|v| positions.at(v));
            (b - a).norm()
        });
        let mean = lengths.sum::<f64>() / mesh.faces_of(v).count() as f64;
        force::reaction_n(cloth.system(), v.index()).norm() / (MODULUS_N_PER_M * mean)
    });
    missed.fold(0.0, f64::max)
}

#[test]
fn triangles_hang_alike_on_all_meshes_springs_nearly() {
    let (mesh, positions) = square(48);
    let [droop, strain] = hung(&mesh, &positions, triangles());
    // ρ g L²/(2 E) of a strip.
    near(droop / (0.2 * 100.0 / (2.0 * MODULUS_N_PER_M)), 1.0, 0.05);
    for (name, mesh, positions) in meshes() {
        let woven = hung(&mesh, &positions, triangles());
        let net = hung(&mesh, &positions, springs());
        near(woven[0] / droop, 1.0, 0.05);
        near(woven[1] / strain, 1.0, 0.05);
        assert!((0.75..1.4).contains(&(net[0] / droop)), "{name}");
        assert!(net[1] < 3.0 * strain, "{name}");
        assert!(patch(&mesh, &positions, triangles()) < 1e-12, "{name}");
    }
}

#[test]
fn a_rip_begins_where_the_hand_pulls_on_all_meshes() {
    for (name, mesh, positions) in meshes() {
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let scene = Scene::rip(&frame);
        let rip = Run::new(mesh, &positions, scene, &frame).expect("a scene");
        let (rip, edge) = torn_first(rip);
        let rest = rip.cloth().rest_positions();
        let ends = [rip.mesh().origin(edge), rip.mesh().target(edge)];
        let away = ends.map(|v| (rest[v.index()] - Point::new(0.5, 0.5, 0.0)).norm());
        assert!(away[0].min(away[1]) < 0.15, "{name}: {away:?}");
    }
}
