//! Ends of the slit that leave no thin face.
//!
//! A crossing is at least the snap r away from the ends of its edge, and so no face that the slit
//! crosses from edge to edge leaves a child with an altitude below r (1 − r) of its own. A tip
//! inside a face is as near to the outline as the rays say, and where it is near an edge that has a
//! crossing near its end, the two small numbers multiply. So each face with a tip is divided on
//! trial, and where a child would be too thin, the tip moves as little as keeps the bound: along the
//! slit (to one of [`STEPS`] places, or to the node where the slit enters or leaves the face), away
//! from the outline (by one of [`INSETS`], as a part of the face's height), or both. It moves by less
//! than the slit's way through one face. A slit is never made longer up to a boundary, which would
//! open that.

use super::planner::Planner;
use super::trace::{Piece, Place, Site, Trace, is_closed};
use crate::attribute::Blend;
use crate::edit::{ChildFace, Mix};
use crate::geometry::{Point, altitude, between, length};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// Into how many parts the way through a face is divided to look for a better tip.
const STEPS: u32 = 16;

/// How far from an edge the points of a piece are kept, to look for better ones.
const INSETS: [f64; 6] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25];

/// A tip that moves may change whether its neighbour opens; more rounds than these would be a
/// circle, and then pieces are given up.
const ROUNDS: u32 = 8;

/// Moves or gives up tips until every child keeps r (1 − r) of the altitude of its parent, where r
/// is the snap. Where that would leave nothing of a slit, returns nodes beyond its ends that it could
/// reach, had they been snapped.
pub(super) fn settle(
    trace: &mut Trace,
    snap: f64,
    mesh: &Mesh,
    positions: &Positions,
) -> Vec<Site> {
    let mut beyond = Vec::new();
    if snap == 0.0 {
        return beyond;
    }
    // Beyond ROUNDS each round takes pieces away.
    for round in 0.. {
        let trial = Trial::new(trace, snap, mesh, positions);
        let thin = trace.pieces.iter().filter(|piece| !trial.fits(piece));
        let thin: Vec<Piece> = thin.copied().collect();
        if thin.is_empty() {
            break;
        }
        let choose = |piece: &Piece| trial.best(piece).filter(|_| round < ROUNDS);
        let chosen: Vec<Option<Piece>> = thin.iter().map(choose).collect();
        let lost = thin.iter().zip(&chosen);
        let lost = lost.filter(|(piece, chosen)| chosen.is_none() && !trial.goes_on(piece));
        beyond.extend(lost.flat_map(|(piece, _)| trial.beyond(piece)));
        for (piece, better) in thin.iter().zip(chosen) {
            trace.replace(piece.place, better);
        }
        trace.finish(mesh);
    }
    beyond
}

/// Divides faces on trial.
struct Trial<'t> {
    trace: &'t Trace,
    /// The nodes at which pieces end, ascending, each as often as pieces end there.
    nodes: Vec<Site>,
    /// Those of pieces that have no tip, in the same way.
    through: Vec<Site>,
    snap: f64,
    mesh: &'t Mesh,
    positions: &'t Positions,
}

impl<'t> Trial<'t> {
    fn new(trace: &'t Trace, snap: f64, mesh: &'t Mesh, positions: &'t Positions) -> Trial<'t> {
        let pieces = trace.pieces.iter().filter(|piece| !piece.has_tip());
        let mut through: Vec<Site> = pieces.flat_map(Piece::end_nodes).flatten().collect();
        through.sort_unstable();
        Trial {
            trace,
            nodes: trace.nodes(),
            through,
            snap,
            mesh,
            positions,
        }
    }

    /// The piece with ends that keep the bound, moved as little as can be; `None` if there is none, or
    /// if giving it up moves them less and leaves a slit.
    fn best(&self, piece: &Piece) -> Option<Piece> {
        let [froms, tos] = [0, 1].map(|end| self.ends(piece, end));
        let mut choices: Vec<(f64, Piece)> = Vec::new();
        for &from in &froms {
            for &to in tos.iter().filter(|&to| to - from > self.trace.near) {
                for inset in INSETS {
                    let choice = Piece {
                        from,
                        to,
                        inset,
                        ..*piece
                    };
                    choices.push((self.moved(piece, &choice), choice));
                }
            }
        }
        if self.goes_on(piece) {
            let given_up = length(self.point(piece, piece.to) - self.point(piece, piece.from));
            choices.retain(|&(moved, _)| moved < given_up);
        }
        // The order of equals is that of the lists: fixed.
        choices.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut choices = choices.into_iter().map(|(_, choice)| Piece {
            middle: self.needs_middle(piece, &choice),
            ..choice
        });
        choices.find(|choice| self.fits(choice))
    }

    /// How far the ends of a piece are from where they were.
    fn moved(&self, piece: &Piece, choice: &Piece) -> f64 {
        let ends = [(piece.from, choice.from), (piece.to, choice.to)];
        let moved = ends.map(|(was, is)| length(self.point(choice, is) - self.point(piece, was)));
        moved[0] + moved[1]
    }

    /// A point of a piece, by its parameter. A node stays where it is, whatever the inset.
    fn point(&self, piece: &Piece, at: f64) -> Point {
        match piece.place {
            Place::Face(f) => {
                let inset = if at == 0.0 || at == 1.0 {
                    0.0
                } else {
                    piece.inset
                };
                let piece = Piece { inset, ..*piece };
                let weights = self.trace.weights(self.mesh, f, &piece, at);
                let sum = weights[0] + weights[1] + weights[2];
                let corners = self.corners(f);
                Point::weighted(corners.each_ref(), weights.map(|weight| weight / sum))
            }
            Place::Edge { h, forward } => {
                let ends = h.ends(forward);
                let [from, to] = ends.map(|h| self.positions.at(self.mesh.origin(h)));
                between(from, to, at)
            }
        }
    }

    /// Whether the slit goes on from where a piece came, and farther than to another tip.
    fn goes_on(&self, piece: &Piece) -> bool {
        let own = usize::from(!piece.has_tip());
        let mut nodes = piece.end_nodes().into_iter().flatten();
        nodes.any(|site| count_of(&self.through, site) > own)
    }

    /// The nodes beyond the tips of a piece that are near a vertex inside the mesh.
    fn beyond(&self, piece: &Piece) -> impl Iterator<Item = Site> {
        let tips = piece.nodes.into_iter().zip(piece.tips);
        let nodes = tips.filter_map(|(site, tip)| tip.map(|_| site));
        nodes.filter(|&site| {
            let Site::Edge(h) = site else { return false };
            let ends = [self.mesh.origin(h), self.mesh.target(h)];
            let inside = |&v: &VertexId| is_closed(self.mesh, Site::Vertex(v));
            !self.is_far(site) && ends.iter().all(inside)
        })
    }

    /// Where an end of a piece may be: where it is, and if it is a tip, at other places.
    fn ends(&self, piece: &Piece, end: usize) -> Vec<f64> {
        let at = [piece.from, piece.to][end];
        let mut ends = vec![at];
        if piece.tips[end].is_some() {
            ends.extend((1..STEPS).map(|step| f64::from(step) / f64::from(STEPS)));
            // What goes on to a boundary opens it.
            if is_closed(self.mesh, piece.nodes[end]) {
                ends.push([0.0, 1.0][end]);
            }
        }
        ends
    }

    /// Whether a piece leaves no face too thin.
    fn fits(&self, piece: &Piece) -> bool {
        let at_nodes = piece.end_nodes();
        let tips = at_nodes.into_iter().zip(piece.tips);
        let mut tips = tips.filter_map(|(site, tip)| site.filter(|_| tip.is_some()));
        tips.all(|site| self.is_far(site)) && (piece.is_crossing() || self.keeps(piece))
    }

    /// Whether a node is far enough from the ends of its edge. One that the slit does not meet, but
    /// goes on to, was not snapped.
    fn is_far(&self, site: Site) -> bool {
        let Site::Edge(h) = site else { return true };
        let crossing = self.trace.crossing(h);
        crossing.is_some_and(|one| one.t >= self.snap && 1.0 - one.t >= self.snap)
    }

    /// Whether a choice for a piece opens only with a vertex in its middle.
    fn needs_middle(&self, piece: &Piece, choice: &Piece) -> bool {
        let own = piece.end_nodes();
        let opens = |site: Site| {
            let others = count_of(&self.nodes, site) - usize::from(own.contains(&Some(site)));
            others > 0 || !is_closed(self.mesh, site)
        };
        !choice.end_nodes().into_iter().flatten().any(opens)
    }

    /// Whether all children of the faces that a piece divides keep enough of their altitude.
    fn keeps(&self, piece: &Piece) -> bool {
        let crossings = piece.nodes.into_iter().filter_map(|site| match site {
            Site::Edge(h) => self.trace.crossing(h).copied(),
            Site::Vertex(_) => None,
        });
        let mut crossings: Vec<_> = crossings.collect();
        crossings.sort_by_key(|crossing| crossing.half_edge);
        for crossing in &mut crossings {
            let site = Site::Edge(crossing.half_edge);
            let others = self.nodes.binary_search(&site).is_ok();
            crossing.used = others || piece.end_nodes().contains(&Some(site));
        }
        let alone = Trace {
            pieces: vec![*piece],
            crossings,
            lone_tips: Vec::new(),
            snapped: Vec::new(),
            near: self.trace.near,
        };
        let mut planner = Planner::new(&alone, self.mesh);
        planner.piece(piece);
        let Ok(insertion) = planner.plan.prepare(self.mesh) else {
            return false; // Crowded.
        };
        let divided = |child: &&ChildFace| match piece.place {
            Place::Face(f) => child.parent == f,
            Place::Edge { h, .. } => {
                let across = self.mesh.pair(h).map(HalfEdgeId::face);
                child.parent == h.face() || Some(child.parent) == across
            }
        };
        let least = self.snap * (1.0 - self.snap);
        let is_kept = |child: &ChildFace| {
            let corners = self.corners(child.parent);
            altitude(corners_of(child, corners)) >= least * altitude(corners)
        };
        insertion.children.iter().filter(divided).all(is_kept)
    }

    fn corners(&self, f: FaceId) -> [Point; 3] {
        self.mesh.face_vertices(f).map(|v| self.positions.at(v))
    }
}

/// The corners of a face that is to be cut from one with these corners.
pub(super) fn corners_of(child: &ChildFace, parent: [Point; 3]) -> [Point; 3] {
    let place = |source: Mix<HalfEdgeId>| source.map(|h| &parent[h.corner()]);
    child.sources.map(|source| Point::blend(place(source)))
}

/// How often a site is in a sorted list.
fn count_of(sites: &[Site], site: Site) -> usize {
    let first = sites.partition_point(|&other| other < site);
    let all = sites[first..].iter().take_while(|&&other| other == site);
    all.count()
}
