//! Frames of a simulation: numbered OBJ files, with their own faces or those of the last frame, and a
//! point cache, with those of the last frame.
//!
//! A split adds no face, so the faces of the last frame fit all frames. A vertex that does not exist
//! yet is at the position of its source. A vertex that a cut will insert is on its edge or in its face,
//! at the same fraction: the surface is the same although faces are divided.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use tearmesh::{Blend, Edit, Edits, Mesh, Mix, Point, Positions, VertexId, VertexOp};
use tearmesh_cloth::scene::Run;
use tearmesh_obj::TornDocument;
use tearmesh_view::{MOMENTS_PER_S, write_pc2};

use super::check;
use super::precision::Precision;
use crate::args::{TearArgs, Topology};
use crate::exit::{Exit, Stop};
use crate::say::Fault;
use crate::session::Session;
use crate::{output, report};

/// How many frames a second.
pub(super) const RATE_PER_S: f64 = MOMENTS_PER_S;

/// Where the vertices of a run are; refused if one of them is nowhere.
pub(super) fn places(run: &Run) -> Result<Positions, Fault> {
    finite(run.cloth().positions().to_vec())
}

fn finite(points: Vec<Point>) -> Result<Positions, Fault> {
    Positions::new(points).map_err(|error| Fault::error("E-SIM-BLOWUP", error.to_string()))
}

/// The frames of a run, if any are wanted.
pub(super) struct Frames {
    folder: Option<PathBuf>,
    cache: Option<PathBuf>,
    topology: Topology,
    /// The number of frames so far.
    count: usize,
    /// Frames that wait for the last one's faces.
    waiting: Vec<Frame>,
    /// For each vertex that was added, what it was made from, where it is in earlier frames.
    sources: Vec<Mix<VertexId>>,
    /// Faces that were divided, by their index.
    divided: Vec<bool>,
}

/// A recorded frame.
struct Frame {
    points: Vec<Point>,
    /// Shared by frames between which nothing tore.
    indices: Rc<Vec<u32>>,
    /// How many vertices had been added.
    sources: usize,
}

impl Frames {
    /// Makes the folder where there is none.
    pub(super) fn open(args: &TearArgs, run: &Run) -> Result<Frames, Stop> {
        let frames = Frames {
            folder: args.files.wanted(&args.frames).cloned(),
            cache: args.files.wanted(&args.cache).cloned(),
            topology: args.frames_topology,
            count: 0,
            waiting: Vec::new(),
            sources: Vec::new(),
            divided: vec![false; run.mesh().face_count()],
        };
        if let Some(folder) = &frames.folder {
            let is_frame = |name: &str| name.starts_with("frame_") && name.ends_with(".obj");
            let names = check::names(args);
            names.keep_from(folder, ("a frame", "frames"), is_frame)?;
            output::make_folder(folder)?;
        }
        Ok(frames)
    }

    /// Notes where vertices are added.
    pub(super) fn follow(&mut self, edits: &Edits) {
        for edit in edits {
            for op in edit.vertex_ops() {
                // A slide adds no vertex, and where seams are sewn no frame waits for the last.
                if let VertexOp::Push { from, .. } = op {
                    self.sources.push(from);
                }
            }
            if let Edit::Insert(insert) = edit {
                for child in insert.children {
                    self.divided[child.parent.index()] = true;
                    let count = self.divided.len().max(child.face.index() + 1);
                    self.divided.resize(count, true);
                }
            }
        }
    }

    /// Records a frame if it is time for one.
    pub(super) fn record(&mut self, run: &Run, torn: &TornDocument<'_>) -> Result<(), Stop> {
        let step = (self.count as f64 / RATE_PER_S / run.step_s()).round();
        let has_cache = self.cache.is_some();
        let folder = self.folder.as_ref();
        if !(folder.is_some() || has_cache) || (run.tally().steps as f64) < step {
            return Ok(());
        }
        if let Some(folder) = folder.filter(|_| self.topology == Topology::Own) {
            let positions = places(run)?;
            // Fans stay together: the number of a copy is that of the vertex that is added next.
            output::write(&folder.join(name(self.count)), |mut out| {
                torn.write_unseparated(run.mesh(), &positions, &mut out)
            })?;
        }
        if has_cache || self.topology == Topology::Final {
            let now = run.mesh().indices();
            let last = self.waiting.last().filter(|frame| *frame.indices == now);
            let indices = match last {
                Some(last) => Rc::clone(&last.indices),
                None => Rc::new(now.to_vec()),
            };
            self.waiting.push(Frame {
                points: run.cloth().positions().to_vec(),
                indices,
                sources: self.sources.len(),
            });
        }
        self.count += 1;
        Ok(())
    }

    /// Writes the point cache, unless it would be too coarse, and then the frames that waited until it is enough;
    /// each sample and frame is checked against its own mesh. Notes both in the report.
    pub(super) fn finish(
        mut self,
        run: &Run,
        torn: &TornDocument<'_>,
        (precision, is_enough): (&Precision, impl Fn() -> bool),
        session: &mut Session<'_, '_>,
    ) -> Result<(), Stop> {
        let (mut cache, mut refused) = (None, None);
        if let Some(path) = &self.cache {
            let statements = torn.statements_in_order(run.mesh());
            match self.check_cache(&statements, precision) {
                Ok(()) => cache = Some(self.write_cache(path, run, &statements, precision)?),
                Err(fault) => refused = Some(fault),
            }
        }
        let mut report = None;
        if let Some(folder) = self.folder.clone() {
            let is_final = self.topology == Topology::Final;
            let waiting = if is_final { &self.waiting[..] } else { &[] };
            let mut checked = 0;
            for (number, frame) in waiting.iter().enumerate() {
                if is_enough() {
                    let (folder, all) = (folder.display(), self.count);
                    let message = format!("interrupted: `{folder}` has {number} of {all} frames");
                    let fault = Fault::warning("W-FRAMES-INTERRUPTED", message);
                    session.faults.push(fault);
                    self.count = number;
                    break;
                }
                let (points, corners) = self.checked(number, frame, run.mesh())?;
                checked += corners;
                let positions = finite(points)?;
                output::write(&folder.join(name(number)), |mut out| {
                    torn.write(run.mesh(), &positions, &mut out)
                })?;
            }
            let next = name(self.count);
            if folder.join(&next).exists() {
                let folder = folder.display();
                let message = format!("`{folder}` has frames of an earlier run, from {next} on");
                let fault = Fault::warning("W-FRAMES-OLD", message);
                let help = "write frames into a folder of their own";
                session.faults.push(fault.help(help));
            }
            report = Some(report::Frames {
                folder: folder.display().to_string(),
                count: self.count,
                topology: if is_final { "final" } else { "own" },
                corners_checked: is_final.then_some(checked),
            });
        }
        if let Some(tear) = &mut session.report.tear {
            (tear.frames, tear.cache) = (report, cache);
        }
        refused.map_or(Ok(()), |fault| Err(Stop::new(Exit::Output, fault)))
    }

    /// Refuses a cache whose numbers would be too coarse for some frame.
    fn check_cache(&self, statements: &[VertexId], precision: &Precision) -> Result<(), Fault> {
        let points = || {
            self.waiting.iter().flat_map(|frame| {
                let points = self.grown(frame);
                statements.iter().map(move |v| points[v.index()])
            })
        };
        let name = |i: usize| {
            let (frame, vertex) = (i / statements.len(), i % statements.len() + 1);
            format!("vertex {vertex} of frame {frame}")
        };
        precision.check(points, name)
    }

    /// Writes where every `v` of the last mesh's file is in every frame.
    fn write_cache(
        &self,
        path: &Path,
        run: &Run,
        statements: &[VertexId],
        precision: &Precision,
    ) -> Result<report::Cache, Fault> {
        for (number, frame) in self.waiting.iter().enumerate() {
            self.checked(number, frame, run.mesh())?;
        }
        let samples = self.waiting.iter().map(|frame| {
            let points = self.grown(frame);
            let at = move |v: &VertexId| points[v.index()] - precision.origin;
            statements.iter().map(at)
        });
        output::write(path, |out| write_pc2(out, statements.len(), samples))?;
        Ok(report::Cache {
            path: path.display().to_string(),
            samples: self.waiting.len(),
            points: statements.len(),
            origin: precision.origin.into(),
        })
    }

    /// The points of a frame that has the faces of the last one, compared with its own mesh to the last
    /// bit: each corner of each face that was never divided. Gives how many there were.
    fn checked(
        &self,
        number: usize,
        frame: &Frame,
        mesh: &Mesh,
    ) -> Result<(Vec<Point>, u64), Fault> {
        let points = self.grown(frame);
        let own = frame.indices.as_chunks::<3>().0.iter();
        let last = mesh.indices().as_chunks::<3>().0.iter();
        let faces = own.zip(last).zip(&self.divided).zip(1..);
        let mut checked = 0;
        for (((own, last), _), face) in faces.filter(|((_, divided), _)| !**divided) {
            for (&was, &is) in own.iter().zip(last) {
                let [was, is] = [frame.points[was as usize], points[is as usize]];
                let bits = |p: Point| [p.x, p.y, p.z].map(f64::to_bits);
                if bits(is) != bits(was) {
                    let broken = format!("a corner of face {face} is at {is}, not {was}");
                    let message = format!("frame {number} is not its own mesh: {broken}");
                    return Err(Fault::error("E-BUG-INVARIANT", message));
                }
                checked += 1;
            }
        }
        Ok((points, checked))
    }

    /// The points of a frame, and of all vertices that were added later.
    fn grown(&self, frame: &Frame) -> Vec<Point> {
        let mut points = frame.points.clone();
        for source in &self.sources[frame.sources..] {
            points.push(Point::blend(source.map(|v| &points[v.index()])));
        }
        points
    }
}

fn name(number: usize) -> String {
    format!("frame_{number:05}.obj")
}
