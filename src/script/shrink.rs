//! The smallest script that still fails.

use super::{Fault, Operation, Script, Shape, Spot};

impl Script {
    /// Reduces a failing script to a small script that still fails. Operations are removed, first many at
    /// once, and then the remaining ones and the mesh are simplified while the result still fails. Every part
    /// that remains is needed: without any one operation, spot or row of the mesh, the script would not fail.
    ///
    /// `fails` returns whether a script fails, by any criterion. It may catch panics, as in this
    /// example. A script that does not fail is returned unchanged.
    ///
    /// Calls `fails` some thousand times: about n log n times for n operations, and up to 64 times
    /// for each number that remains.
    ///
    /// ```
    /// use std::panic::{AssertUnwindSafe, catch_unwind};
    /// use tearmesh::script::{Script, Step};
    ///
    /// // A program that believes that a split never leaves a vertex with a single face.
    /// let property = |script: &Script| {
    ///     script.run(|world, step| {
    ///         if let Step::Split { vertex, outcome: Ok(_), .. } = step {
    ///             assert!(world.mesh.faces_of(*vertex).count() > 1, "at {vertex}");
    ///         }
    ///     });
    /// };
    /// let script: Script = "
    ///     grid 3 2 0b010110
    ///     split 5 0b101
    ///     slide 3 1 16
    ///     insert 5 edge 0 32
    ///     split 6 0b11111
    ///     clear
    ///     split 4 0b11
    /// ".parse()?;
    /// let fails = |script: &Script| catch_unwind(AssertUnwindSafe(|| property(script))).is_err();
    /// # let quiet = std::panic::take_hook();
    /// # std::panic::set_hook(Box::new(|_| {}));
    /// assert_eq!(script.shrink(fails).to_string(), "grid 2 1 0b0\nsplit 1 0b11\n");
    /// # std::panic::set_hook(quiet);
    /// # Ok::<(), tearmesh::script::ScriptError>(())
    /// ```
    #[must_use]
    pub fn shrink(&self, mut fails: impl FnMut(&Script) -> bool) -> Script {
        let mut least = self.clone();
        if !fails(&least) {
            return least;
        }
        // Each round that goes on has made the script smaller.
        while drop_operations(&mut least, &mut fails) | simplify(&mut least, &mut fails) {}
        least
    }
}

/// Leaves out runs of operations, each half as long as the last. Says whether any was left out.
fn drop_operations(least: &mut Script, fails: &mut impl FnMut(&Script) -> bool) -> bool {
    let before = least.operations.len();
    let mut run = before;
    while run > 0 {
        let mut start = 0;
        while start < least.operations.len() {
            let end = (start + run).min(least.operations.len());
            let mut shorter = least.clone();
            shorter.operations.drain(start..end);
            if fails(&shorter) {
                *least = shorter;
            } else {
                start = end;
            }
        }
        run /= 2;
    }
    least.operations.len() < before
}

/// Makes the mesh and each operation simpler. Says whether any became so.
fn simplify(least: &mut Script, fails: &mut impl FnMut(&Script) -> bool) -> bool {
    let mut any = false;
    let shape = |script: &Script| simpler_shapes(&script.shape);
    any |= first_that_fails(least, fails, shape, |script, shape| script.shape = shape);
    for i in 0..least.operations.len() {
        let operation = |script: &Script| simpler_operations(&script.operations[i]);
        any |= first_that_fails(least, fails, operation, |script, operation| {
            script.operations[i] = operation;
        });
    }
    any
}

/// Puts the first of some parts in its place with which the script still fails, again and again.
fn first_that_fails<P>(
    least: &mut Script,
    fails: &mut impl FnMut(&Script) -> bool,
    parts: impl Fn(&Script) -> Vec<P>,
    put: impl Fn(&mut Script, P),
) -> bool {
    let mut any = false;
    loop {
        let simpler = parts(least).into_iter().find_map(|part| {
            let mut simpler = least.clone();
            put(&mut simpler, part);
            fails(&simpler).then_some(simpler)
        });
        match simpler {
            Some(simpler) => *least = simpler,
            None => return any,
        }
        any = true;
    }
}

/// Simpler variants of a shape, the simplest first.
fn simpler_shapes(shape: &Shape) -> Vec<Shape> {
    let mut simpler = Vec::new();
    if !matches!(shape, Shape::Grid { .. }) {
        // Numbers are taken modulo what there is, so what fails on a torus may fail on a grid.
        let grids = [1, 2, 3].map(|cells| Shape::Grid {
            columns: cells,
            rows: cells,
            rising: 0,
        });
        let faces = |shape: &Shape| shape.make().0.face_count();
        simpler.extend(grids.into_iter().filter(|grid| faces(grid) <= faces(shape)));
    }
    match *shape {
        Shape::Grid {
            columns,
            rows,
            rising,
        } => {
            let grid = |columns, rows, rising| Shape::Grid {
                columns,
                rows,
                rising,
            };
            simpler.extend(below(columns, 1).map(|columns| grid(columns, rows, rising)));
            simpler.extend(below(rows, 1).map(|rows| grid(columns, rows, rising)));
            simpler.extend(fewer_bits(rising).map(|rising| grid(columns, rows, rising)));
        }
        Shape::Fan { faces, closed } => {
            simpler.extend(below(faces, 3).map(|faces| Shape::Fan { faces, closed }));
        }
        Shape::Tube { around, along } => {
            simpler.extend(below(around, 3).map(|around| Shape::Tube { around, along }));
            simpler.extend(below(along, 1).map(|along| Shape::Tube { around, along }));
        }
        Shape::Torus { around, across } => {
            simpler.extend(below(around, 3).map(|around| Shape::Torus { around, across }));
            simpler.extend(below(across, 3).map(|across| Shape::Torus { around, across }));
        }
        Shape::Tetrahedron { subdivisions } => {
            let fewer = below(subdivisions, 0);
            simpler.extend(fewer.map(|subdivisions| Shape::Tetrahedron { subdivisions }));
        }
        Shape::Octahedron { subdivisions } => {
            let fewer = below(subdivisions, 0);
            simpler.extend(fewer.map(|subdivisions| Shape::Octahedron { subdivisions }));
        }
        Shape::Saddle => {}
        Shape::Grown(ref moves) => simpler.extend(without_one(moves).map(Shape::Grown)),
        Shape::Glued { faces, ref sides } => {
            let fewer = without_one(sides).map(|sides| Shape::Glued { faces, sides });
            simpler.extend(fewer);
            simpler.extend(below(faces, 1).map(|faces| Shape::Glued {
                faces,
                sides: sides.clone(),
            }));
        }
    }
    simpler
}

/// Simpler variants of an operation, the simplest first.
fn simpler_operations(operation: &Operation) -> Vec<Operation> {
    let mut simpler = Vec::new();
    match *operation {
        Operation::Split {
            vertex,
            mask,
            fault,
        } => {
            let split = |vertex, mask, fault| Operation::Split {
                vertex,
                mask,
                fault,
            };
            if fault != Fault::None {
                simpler.push(split(vertex, mask, Fault::None));
            }
            simpler.extend(below(vertex, 0).map(|vertex| split(vertex, mask, fault)));
            simpler.extend(fewer_bits(mask).map(|mask| split(vertex, mask, fault)));
        }
        Operation::Plane { vertex, normal } => {
            let plane = |vertex| Operation::Plane { vertex, normal };
            simpler.extend(below(vertex, 0).map(plane));
        }
        Operation::Insert {
            half_edge,
            ref spots,
            chord,
        } => {
            let insert = |half_edge, spots: &[Spot], chord| Operation::Insert {
                half_edge,
                spots: spots.to_vec(),
                chord,
            };
            if chord.is_some() {
                simpler.push(insert(half_edge, spots, None));
            }
            simpler.extend(without_one(spots).map(|spots| insert(half_edge, &spots, chord)));
            simpler.extend(below(half_edge, 0).map(|h| insert(h, spots, chord)));
        }
        Operation::Merge {
            vertex,
            other,
            any,
            weights,
        } => {
            let merge = |vertex, other, any| Operation::Merge {
                vertex,
                other,
                any,
                weights,
            };
            if any {
                simpler.push(merge(vertex, other, false));
            }
            simpler.extend(below(vertex, 0).map(|vertex| merge(vertex, other, any)));
            simpler.extend(below(other, 0).map(|other| merge(vertex, other, any)));
        }
        Operation::Slide {
            vertex,
            toward,
            any,
            part,
        } => {
            let slide = |vertex, toward, any| Operation::Slide {
                vertex,
                toward,
                any,
                part,
            };
            if any {
                simpler.push(slide(vertex, toward, false));
            }
            simpler.extend(below(vertex, 0).map(|vertex| slide(vertex, toward, any)));
            simpler.extend(below(toward, 0).map(|toward| slide(vertex, toward, any)));
        }
        Operation::Sew { mask } => {
            simpler.extend(fewer_bits(mask).map(|mask| Operation::Sew { mask }));
        }
        Operation::Cut { .. } | Operation::Tear | Operation::Clear => {}
    }
    simpler
}

/// Smaller numbers, from the least on: enough of them that one is, modulo what a small mesh has, the
/// same.
fn below<N>(number: N, least: N) -> impl Iterator<Item = N>
where
    N: Copy + Into<u64> + TryFrom<u64>,
{
    let (number, least) = (number.into(), least.into());
    let smaller = (least..number).take(64);
    smaller.filter_map(|n| N::try_from(n).ok())
}

/// The mask with one bit less, for each that it has.
fn fewer_bits<N>(mask: N) -> impl Iterator<Item = N>
where
    N: Copy + Into<u64> + TryFrom<u64>,
{
    let mask = mask.into();
    let set = (0..64).filter(move |bit| mask >> bit & 1 == 1);
    set.filter_map(move |bit| N::try_from(mask & !(1 << bit)).ok())
}

/// The list with one item less, for each that it has.
fn without_one<T: Clone>(list: &[T]) -> impl Iterator<Item = Vec<T>> {
    (0..list.len()).map(|i| [&list[..i], &list[i + 1..]].concat())
}
