//! Sheets to hang and to crush: even, jittered, uneven, and with a sliver.

use tearmesh::{Masses, Mesh, Point, Positions, shapes};
use tearmesh_cloth::System;

use crate::parts::Order;
use crate::random::Random;

/// The stiffness of every edge, in N/m, and the mass of a square metre, in kg.
pub(super) const STIFFNESS: f64 = 1000.0;
pub(super) const DENSITY: f64 = 0.15;

/// A net of springs between the points of a mesh, hung by its top.
pub(super) struct Sheet {
    pub(super) name: &'static str,
    points: Vec<Point>,
    masses: Vec<f64>,
    /// Ends, in the order of the mesh.
    edges: Vec<[usize; 2]>,
}

/// A square of one metre with diagonals at random, and inner points moved by so much of a cell.
pub(super) fn grid(cells: u32, jitter: f64) -> (Mesh, Positions) {
    let mut random = Random(1);
    let (mesh, positions) = shapes::grid_with_diagonals(cells, cells, |_, _| random.next() < 0.5);
    let part = jitter / f64::from(cells);
    let moved = positions.as_slice().iter().map(|p| {
        let inner = |x: f64| x > 0.0 && x < 1.0;
        let mut off = || part * (random.next() - 0.5);
        let off = [off(), off()];
        let within = inner(p.x) && inner(p.y);
        let off = if within { off } else { [0.0; 2] };
        [p.x + off[0], p.y + off[1], 0.0]
    });
    let positions = Positions::new(moved).expect("points");
    (mesh, positions)
}

impl Sheet {
    fn new(name: &'static str, cells: u32, jitter: f64) -> Sheet {
        let (mesh, positions) = grid(cells, jitter);
        let masses = Masses::area(&mesh, &positions, DENSITY).expect("masses");
        let ends = |h| [mesh.origin(h), mesh.target(h)].map(|v| v.index());
        Sheet {
            name,
            points: positions.as_slice().to_vec(),
            masses: mesh.vertices().map(|v| masses.at(v)).collect(),
            edges: mesh.edges().map(ends).collect(),
        }
    }

    /// Even, jittered by a third of a cell, uneven by nine tenths, and even with a vertex of a
    /// hundredth of its mass.
    pub(super) fn all() -> [Sheet; 4] {
        let mut sliver = Sheet::new("sliver", 10, 0.0);
        sliver.masses[60] /= 100.0;
        [
            Sheet::new("even", 10, 0.0),
            Sheet::new("jittered", 10, 0.35),
            Sheet::new("uneven", 10, 0.9),
            sliver,
        ]
    }

    /// The sheet with its constraints in this order, held by its top.
    pub(super) fn system(&self, order: Order) -> System {
        let mut system = self.free(order);
        let top = (0..self.points.len()).filter(|&i| self.points[i].y == 1.0);
        top.for_each(|i| system.hold(i));
        system
    }

    /// The sheet, held by nobody.
    pub(super) fn free(&self, order: Order) -> System {
        let mut system =
            System::new(self.points.iter().copied(), self.masses.clone()).expect("particles");
        let mut edges = self.edges.clone();
        order.apply(&mut edges);
        for [a, b] in edges {
            let rest = (self.points[b] - self.points[a]).norm();
            system.stretch([a, b], rest, STIFFNESS).expect("an edge");
        }
        system
    }

    /// The mean length of edges by the speed of waves: h/c, in seconds.
    pub(super) fn edge_s(&self) -> f64 {
        let lengths = self.edges.iter();
        let lengths = lengths.map(|&[a, b]| (self.points[b] - self.points[a]).norm());
        lengths.sum::<f64>() / self.edges.len() as f64 / (STIFFNESS / DENSITY).sqrt()
    }

    /// The strains in the order of the mesh.
    pub(super) fn strains(&self, system: &System) -> Vec<f64> {
        let x = system.positions();
        let strain = |&[a, b]: &[usize; 2]| {
            (x[b] - x[a]).norm() / (self.points[b] - self.points[a]).norm() - 1.0
        };
        self.edges.iter().map(strain).collect()
    }
}
