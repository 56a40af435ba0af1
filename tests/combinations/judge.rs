//! The oracles of a cut of any levels. No oracle shares code with what it judges: each sees points and
//! triangles, rays, and the text of files.

use std::collections::BTreeMap;

use tearmesh::{CutLayers, CutMethod};

use crate::counts::Counts;
use crate::library::{Made, State, Step};
use crate::meshes::{NORMALS, Start, has_seam, uv};
use crate::oracle::aim::{Line, aimed, beyond, distance};
use crate::oracle::by_place::{has_layers, lies_on, open_edges};
use crate::oracle::straight::{
    self, Cut, Surface, cross, dot, is_generic, length, minus, on_the_way,
};
use crate::plain::Plain;
use crate::table::Levels;
use crate::verb::{Along, CutVerb};

type Point = [f64; 3];

/// A cut verb, what it made of the mesh, and what is known of that.
pub(crate) struct Case<'c> {
    pub(crate) start: &'c Start,
    pub(crate) levels: &'c Levels,
    pub(crate) verb: &'c CutVerb,
    pub(crate) made: &'c Made,
    pub(crate) counts: &'c mut Counts,
    /// What rounding may do to a length.
    pub(crate) rounding: f64,
}

impl Case<'_> {
    pub(crate) fn judge(&mut self) {
        self.rounding = self.rounding_of_lengths();
        let (made, verb) = (self.made, self.verb);
        self.invariants();
        self.mass();
        if !made.has_slid() || self.start.is_flat {
            self.area();
            self.border();
        }
        if !has_layers(&made.first().surface) {
            self.stays_closed();
        }
        // A slide carries the values of one side of their seam along.
        let is_carried = !has_seam(self.levels) || !self.is("snap-move", "yes");
        if self.is("gap", "none") && is_carried {
            self.values();
        }
        if verb.method == CutMethod::Exact {
            for (i, step) in made.steps.iter().enumerate() {
                self.near(i, step);
                self.slides(step);
            }
        }
        self.parts();
    }

    fn is(&self, levels: &str, words: &str) -> bool {
        self.levels.is(levels, words)
    }

    fn rounding_of_lengths(&self) -> f64 {
        let points = self.made.first().surface.points.as_flattened();
        let reach = points.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let of_rays = match &self.verb.along {
            Along::Rays(lines) => lines
                .iter()
                .flat_map(|line| line.0)
                .fold(0.0, |most: f64, x| most.max(x.abs())),
            Along::Plane(..) => 0.0,
        };
        1e-9 * self.start.size + 1e-12 * reach.max(of_rays)
    }

    /// Each directed edge is there once, faces have three vertices, and in the file those of a vertex form a fan.
    fn invariants(&mut self) {
        let written = Plain::read(&self.made.file);
        let written = Surface {
            points: (0..written.vertices.len()).map(|v| written.at(v)).collect(),
            faces: written.triangles(),
        };
        for surface in [&self.made.last().surface, &written] {
            for &[a, b, c] in &surface.faces {
                assert!(a != b && b != c && c != a, "a face has a vertex twice");
            }
            let mut counts = surface.directed_edges().into_values();
            assert!(counts.all(|count| count == 1), "an edge is there twice");
        }
        assert_eq!(
            written.fans().into_iter().max(),
            Some(1),
            "fans of a vertex"
        );
        self.counts.add("invariants");
    }

    fn mass(&mut self) {
        assert!(self.made.is_balanced, "the ledger is not balanced");
        let area = self.made.first().surface.area();
        let off = (self.made.mass - area).abs();
        assert!(
            off <= 1e-9 * area,
            "the mass of {area} is {}",
            self.made.mass
        );
        self.counts.add("mass");
    }

    fn area(&mut self) {
        let [before, after] =
            [self.made.first(), self.made.last()].map(|state| state.surface.area());
        let edge = self.made.first().surface.mean_edge();
        let most = 1e-9 * before
            + self.rounding * 1e-3 * edge * self.made.last().surface.faces.len() as f64;
        assert!(
            (after - before).abs() <= most,
            "an area of {before} is {after}"
        );
        self.counts.add("area");
    }

    fn border(&mut self) {
        let [before, after] = [self.made.first(), self.made.last()].map(sewn_border);
        let most = 1e-9 * before + 1e3 * self.rounding;
        assert!(
            (after - before).abs() <= most,
            "{before} of border is {after}"
        );
        self.counts.add("border");
    }

    /// No edge is open by place that was not. A vertex that slides along the border lengthens an edge of it.
    fn stays_closed(&mut self) {
        let before = open_edges(&self.made.first().surface);
        for edge in open_edges(&self.made.last().surface) {
            let is_old = |p: Point| before.iter().any(|&old| is_on(p, old, self.rounding));
            let middle = on_the_way(edge[0], edge[1], 0.5);
            let is_closed = [edge[0], middle, edge[1]].into_iter().all(is_old);
            assert!(is_closed, "{edge:?} is open by place");
        }
        self.counts.add("closed");
    }

    /// The texture coordinates of a corner are those of the place of its vertex, on one side of the seam or on the
    /// other; its normal is that of the side.
    fn values(&mut self) {
        let (has_uv, has_normals) = (
            self.is("attributes", "uv both"),
            self.is("attributes", "normals both"),
        );
        if !has_uv && !has_normals {
            return;
        }
        let most = 1e-9 * self.start.size + self.rounding;
        for face in corners(&self.made.file) {
            for is_beyond in [false, true] {
                let uv_fits = |&(p, of_corner, _): &Corner| {
                    let expected = uv(p, is_beyond);
                    let fits =
                        |at: [f64; 2]| (0..2).all(|i| (at[i] - expected[i]).abs() <= most + 1e-14);
                    of_corner.is_some_and(fits)
                };
                let normal_fits = |&(_, _, of_corner): &Corner| {
                    let expected = NORMALS[usize::from(is_beyond)];
                    of_corner.is_some_and(|normal| length(minus(normal, expected)) < 1e-9)
                };
                let fits = |corner: &Corner| {
                    (!has_uv || uv_fits(corner)) && (!has_normals || normal_fits(corner))
                };
                if face.iter().all(fits) {
                    break;
                }
                assert!(
                    !is_beyond,
                    "values of {face:?} are not those of their places"
                );
            }
        }
        if has_uv {
            self.counts.add("values");
        }
        if has_normals {
            self.counts.add("normals");
        }
    }

    /// What an exact cut tore is near its plane, not beyond its rays, and comes near its aims.
    fn near(&mut self, i: usize, step: &Step) {
        let before = &step.before.surface;
        let longest = before.longest_edge();
        let r = self.verb.snap;
        let torn: Vec<Point> = step.torn.as_flattened().to_vec();
        let is_skew = self.is("rays", "skew nearly-one-eye");
        if !is_skew && !step.continues {
            let cut = ideal(self.verb, i);
            let far = torn
                .iter()
                .map(|&p| cut.plane.distance(p).abs())
                .fold(0.0, f64::max);
            // An end may move within its face, so that no face gets thin.
            let ends = if self.verb.through || cut.sides.is_empty() {
                0.0
            } else {
                1.0
            };
            let most = (r + if r > 0.0 { ends } else { 0.0 }) * longest + self.rounding;
            assert!(far <= most, "a seam {far} off its plane, of {most}");
            self.counts.add("plane");
        }
        let pairs = self.verb.pairs();
        let Some(&pair) = pairs.get(i).filter(|_| !self.verb.through) else {
            return;
        };
        let far = torn.iter().map(|&p| beyond(pair, p)).fold(0.0, f64::max);
        assert!(
            far < 2.0 * longest,
            "a seam {far} beyond its ray, of edges of {longest}"
        );
        self.counts.add("strip");
        if step.report.splits > 0 {
            self.aims(pair, step, longest);
        }
    }

    /// Where a ray meets the mesh first, there is a seam, unless the report says how far aside it is.
    fn aims(&mut self, pair: [Line; 2], step: &Step, longest: f64) {
        let after = &step.after.surface;
        let sewn = sewn(&step.after);
        let open = open_by_number(after, &sewn);
        let aims = step.report.aims.expect("a cut between rays");
        for (line, aim) in pair.into_iter().zip(aims) {
            // A ray that passes so near an edge may have met another face.
            let [within, nearly] =
                [1e-6, -1e-6].map(|least| aimed(line, &step.before.surface, least));
            let Some(at) = within.filter(|_| within == nearly) else {
                continue;
            };
            let far = open
                .iter()
                .chain(&step.torn)
                .map(|&edge| distance(edge, at));
            let far = far.fold(f64::INFINITY, f64::min);
            let near = 2.0 * self.verb.snap * longest + self.rounding;
            let is_said =
                aim.is_some_and(|aim| aim.is_missed() && (far >= near || aim.aside > near));
            assert!(
                far <= near || is_said,
                "a seam {far} from its aim {at:?}: {aim:?}"
            );
            self.counts.add("aims");
            self.counts.aim(far > near);
        }
    }

    /// What slid is an end of an edge that was torn.
    fn slides(&mut self, step: &Step) {
        if !step.has_slid {
            return;
        }
        let [before, after] = [&step.before, &step.after].map(|state| &state.surface.points);
        for (v, (from, to)) in before.iter().zip(after).enumerate() {
            let is_end = step.torn.as_flattened().contains(to);
            assert!(from == to || is_end, "vertex {v} slid, and is on no seam");
        }
        self.counts.add("slides");
    }

    /// What a plane parts is not in one piece: faces farther before it and behind it than a seam may be.
    fn parts(&mut self) {
        let is_whole = matches!(self.verb.along, Along::Plane(..)) || self.verb.through;
        let is_sure = [CutMethod::Exact, CutMethod::Partition].contains(&self.verb.method);
        let step = &self.made.steps[0];
        if !is_whole
            || !is_sure
            || self.verb.layers == CutLayers::First
            || self.is("rays", "skew nearly-one-eye")
        {
            return;
        }
        let cut = ideal(self.verb, 0);
        let far = match self.verb.method {
            CutMethod::Exact => self.verb.snap + 1e-6,
            _ => 2.0,
        };
        let far = far * step.before.surface.longest_edge() + self.rounding;
        let after = &step.after.surface;
        let (pieces, _) = after.pieces();
        let mut sides: BTreeMap<usize, [bool; 2]> = BTreeMap::new();
        for (face, piece) in after.faces.iter().zip(pieces) {
            let depths = face.map(|v| cut.plane.distance(after.points[v as usize]));
            let of_piece = sides.entry(piece).or_default();
            of_piece[0] |= depths.iter().any(|&depth| depth > far);
            of_piece[1] |= depths.iter().any(|&depth| depth < -far);
        }
        let is_apart = sides.values().all(|sides| !(sides[0] && sides[1]));
        assert!(is_apart, "a piece is on both sides of the plane");
        self.counts.add("parts");
    }
}

/// The ideal cut of a step, by its rays or its plane.
fn ideal(verb: &CutVerb, i: usize) -> Cut {
    let cut = match &verb.along {
        Along::Plane(point, normal) => whole(*point, *normal),
        Along::Rays(lines) => Cut::between([lines[i], lines[i + 1]]),
    };
    if verb.through { cut.through() } else { cut }
}

/// The oracle of straight cuts: of a generic cut, and of two on a sheet of which one continues the other. Whether it
/// was applied.
pub(crate) fn straight(before: &Surface, verb: &CutVerb, steps: &[Step], is_flat: bool) -> bool {
    let cuts: Vec<Cut> = (0..steps.len()).map(|i| ideal(verb, i)).collect();
    if !cuts.iter().all(|cut| is_generic(before, cut)) {
        return false;
    }
    let after = &steps[steps.len() - 1].after.surface;
    let verdict = match &cuts[..] {
        [cut] => straight::judge(before, cut, after),
        [_, _] if is_flat => straight::judge_polyline(before, &cuts, after),
        _ => return false,
    };
    if let Err(faults) = verdict {
        let faults = faults.iter().map(ToString::to_string);
        panic!(
            "a straight cut is not: {}",
            faults.collect::<Vec<_>>().join("; ")
        );
    }
    true
}

/// The cut along a plane: that through two parallel rays in it.
fn whole(point: Point, normal: Point) -> Cut {
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()));
    let axis = [0, 1, 2].map(|i| f64::from(u8::from(Some(i) == least)));
    let along = cross(normal, axis);
    let aside = cross(normal, along);
    let beside = [0, 1, 2].map(|i| point[i] + aside[i]);
    Cut::between([(point, along), (beside, along)]).through()
}

/// Whether a point is on a segment, but for so much.
fn is_on(p: Point, edge: [Point; 2], most: f64) -> bool {
    lies_on([p, p], edge) || distance(edge, p) <= most
}

/// The triangles with all vertices of one root as one.
fn sewn(state: &State) -> Vec<[u32; 3]> {
    let faces = state.surface.faces.iter();
    faces
        .map(|face| face.map(|v| state.roots[v as usize]))
        .collect()
}

/// The edges that are open, and not where all is sewn.
fn open_by_number(surface: &Surface, sewn: &[[u32; 3]]) -> Vec<[Point; 2]> {
    let whole = Surface {
        points: surface.points.clone(),
        faces: sewn.to_vec(),
    };
    let [open, whole] = [surface, &whole].map(Surface::directed_edges);
    let mut torn = Vec::new();
    for (face, of_whole) in surface.faces.iter().zip(sewn) {
        for i in 0..3 {
            let [a, b] = [face[i], face[(i + 1) % 3]];
            let [c, d] = [of_whole[i], of_whole[(i + 1) % 3]];
            if !open.contains_key(&(b, a)) && whole.contains_key(&(d, c)) {
                torn.push([a, b].map(|v| surface.points[v as usize]));
            }
        }
    }
    torn
}

/// The length of the border where all that was one vertex is one.
pub(crate) fn sewn_border(state: &State) -> f64 {
    let whole = Surface {
        points: state.surface.points.clone(),
        faces: sewn(state),
    };
    let long = |(a, b): (u32, u32)| {
        let [from, to] = [a, b].map(|v| whole.points[v as usize]);
        length(minus(to, from))
    };
    whole.boundary().into_iter().map(long).sum()
}

/// The place of a corner, its texture coordinates and its normal.
type Corner = (Point, Option<[f64; 2]>, Option<Point>);

/// The corners of all faces of a file.
fn corners(file: &str) -> Vec<Vec<Corner>> {
    let (mut places, mut textures, mut normals, mut faces) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for line in file.lines() {
        let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
        let numbers = || {
            rest.split(' ')
                .map(|word| word.parse().expect("a number"))
                .collect::<Vec<f64>>()
        };
        match keyword {
            "v" => places.push(numbers()),
            "vt" => textures.push(numbers()),
            "vn" => normals.push(numbers()),
            "f" => faces.push(rest.split(' ').collect::<Vec<_>>()),
            _ => {}
        }
    }
    let corner = |word: &&str| {
        let index = |i: usize| word.split('/').nth(i)?.parse::<usize>().ok();
        let place = &places[index(0).expect("a vertex") - 1];
        let texture = index(1).map(|i| [textures[i - 1][0], textures[i - 1][1]]);
        let normal = index(2).map(|i| [normals[i - 1][0], normals[i - 1][1], normals[i - 1][2]]);
        ([place[0], place[1], place[2]], texture, normal)
    };
    faces
        .iter()
        .map(|face| face.iter().map(corner).collect())
        .collect()
}

/// What does not change where a mesh is turned, mirrored or renumbered: counts, and sums.
pub(crate) fn sums(steps: &[Step]) -> (Vec<usize>, Vec<f64>) {
    let last = &steps[steps.len() - 1].after.surface;
    let mut counts = vec![last.points.len(), last.faces.len(), last.pieces().1];
    counts.extend(steps.iter().map(|step| step.torn.len()));
    let long = |edge: &[Point; 2]| length(minus(edge[1], edge[0]));
    let torn = steps.iter().map(|step| step.torn.iter().map(long).sum());
    // The second moments of vertices do not change where a mesh is turned about the origin.
    let moment = last.points.iter().map(|&p| dot(p, p)).sum();
    (counts, torn.chain([last.area(), moment]).collect())
}
