//! The smallest script that still fails.

use std::ops::RangeInclusive;

use super::grammar::{Choice, Parts};
use super::{Script, Shape};

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
    let faces = |script: &Script| script.shape.make().0.face_count();
    let most = faces(least);
    // A move that could not be made before may be possible once another one is gone.
    let mut fails_smaller = |script: &Script| faces(script) <= most && fails(script);
    if !matches!(least.shape, Shape::Grid { .. }) {
        // Numbers are taken modulo what there is, so what fails on a torus may fail on a grid.
        let grids = [1, 2, 3].map(|cells| Shape::Grid {
            columns: cells,
            rows: cells,
            rising: 0,
        });
        let operations = &least.operations;
        let mut grids = grids.map(|shape| Script {
            shape,
            operations: operations.clone(),
        });
        if let Some(grid) = grids.iter_mut().find(|grid| fails_smaller(grid)) {
            std::mem::swap(least, grid);
            any = true;
        }
    }
    any |= first_that_fails(least, &mut fails_smaller, |script, parts| {
        script.shape.parts(parts);
    });
    for i in 0..least.operations.len() {
        any |= first_that_fails(least, fails, |script, parts| {
            script.operations[i].parts(parts);
        });
    }
    any
}

/// Makes the first simplification with which the script still fails, again and again.
fn first_that_fails(
    least: &mut Script,
    fails: &mut impl FnMut(&Script) -> bool,
    visit: impl Fn(&mut Script, &mut Simplifier),
) -> bool {
    let mut any = false;
    let mut number = 0;
    loop {
        let mut simpler = least.clone();
        let mut parts = Simplifier { left: Some(number) };
        visit(&mut simpler, &mut parts);
        if parts.left.is_some() {
            return any;
        }
        number += 1;
        if fails(&simpler) {
            *least = simpler;
            (any, number) = (true, 0);
        }
    }
}

/// Makes one of the simplifications of the parts that it visits.
struct Simplifier {
    /// How many come before the one that it makes; none once that is made.
    left: Option<usize>,
}

impl Simplifier {
    /// Which of this many simplifications of a part is to be made, if any.
    fn takes(&mut self, count: usize) -> Option<usize> {
        let left = self.left?;
        self.left = left.checked_sub(count);
        self.left.is_none().then_some(left)
    }
}

impl Parts for Simplifier {
    /// From the least on: enough that one of them is, modulo what a small mesh has, the same. Weights and
    /// directions, which may be below zero, stay.
    fn number(&mut self, number: i128, limits: RangeInclusive<i128>, _: usize) -> i128 {
        let least = *limits.start();
        let below = if least < 0 {
            0
        } else {
            (number - least).clamp(0, 64)
        };
        let taken = self.takes(below as usize);
        taken.map_or(number, |taken| least + taken as i128)
    }

    /// With one bit less.
    fn bits(&mut self, bits: i128, _: usize) -> i128 {
        let mut set = (0..64).filter(|bit| bits >> bit & 1 == 1);
        let taken = self.takes(bits.count_ones() as usize);
        let bit = taken.and_then(|taken| set.nth(taken));
        bit.map_or(bits, |bit| bits & !(1 << bit))
    }

    fn choice(&mut self, chosen: &mut usize, choice: &Choice) {
        let may_go = *chosen > 0 && !choice.words.is_empty();
        if self.takes(usize::from(may_go)).is_some() {
            *chosen = 0;
        }
    }

    /// Without what comes more, and with one item less.
    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        _: usize,
        _: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    ) {
        if let Some((_, is_more)) = more
            && self.takes(usize::from(*is_more)).is_some()
        {
            *is_more = false;
        }
        if let Some(taken) = self.takes(list.len()) {
            list.remove(taken);
        }
        list.iter_mut().for_each(|it| item(self, it));
    }
}
