//! The smallest script that still fails.

use super::Script;

impl Script {
    /// Reduces a failing script to a small script that still fails. Operations are removed, first many at
    /// once, and then the remaining ones and the mesh are simplified while the result still fails. Every part
    /// that remains is needed: without any one operation, spot or row of the mesh, the script would not fail.
    ///
    /// `fails` returns whether a script fails, by any criterion. It may catch panics, as in this
    /// example. A script that does not fail is returned unchanged.
    ///
    /// Calls `fails` some thousand times: about n log n times for n operations, and up to 64 times
    /// for each number that remains, or 256 times for a coordinate.
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
    let faces = |script: &Script| script.shape.make().0.face_count();
    let most = faces(least);
    // A shorter line may be that of a larger mesh: a move that could not be made before is possible once
    // another one is gone.
    let mut fails_smaller = |script: &Script| faces(script) <= most && fails(script);
    let mut any = simplify_line(least, 0, &mut fails_smaller);
    for line in 1..=least.operations.len() {
        any |= simplify_line(least, line, fails);
    }
    any
}

/// Makes the first simplification of a line with which the script still fails, again and again.
fn simplify_line(least: &mut Script, line: usize, fails: &mut impl FnMut(&Script) -> bool) -> bool {
    let mut any = false;
    loop {
        let text = least.to_string();
        let lines: Vec<&str> = text.lines().collect();
        let with = |simpler: String| {
            let script = [&lines[..line], &[&simpler], &lines[line + 1..]].concat();
            script.join("\n").parse::<Script>().ok()
        };
        let mut simpler = simpler(lines[line]).into_iter().filter_map(with);
        let Some(script) = simpler.find(|script| fails(script)) else {
            return any;
        };
        (*least, any) = (script, true);
    }
}

/// What may be a simpler line: without a few words, with a number nearer to zero, or with one bit less.
/// Numbers beyond 128 are taken modulo what there is, and beyond 64 a small mesh has nothing else.
fn simpler(line: &str) -> Vec<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut simpler = Vec::new();
    for at in 0..words.len() {
        let mut with = |word: &str, end: usize| {
            let line = [&words[..at], &[word], &words[end..]].concat();
            simpler.push(line.join(" "));
        };
        (at + 1..=words.len().min(at + LONGEST)).for_each(|end| with("", end));
        if let Some(bits) = words[at].strip_prefix("0b") {
            for (bit, _) in bits.match_indices('1') {
                with(&format!("0b{}0{}", &bits[..bit], &bits[bit + 1..]), at + 1);
            }
        } else if let Ok(number) = words[at].parse::<i64>() {
            let numbers = nearer_to_zero(number);
            numbers.for_each(|less| with(&less.to_string(), at + 1));
        }
    }
    simpler
}

/// The numbers that are simpler than a number, from zero on. Of two that are as far from zero, that below
/// zero is less simple.
fn nearer_to_zero(number: i64) -> impl Iterator<Item = i64> {
    let far = number.unsigned_abs() as i64;
    let most = if far <= 128 { far } else { 64 };
    let both = (0..most).flat_map(move |less| [Some(less), (number < 0).then_some(-less)]);
    both.flatten().chain((number < 0).then_some(far))
}

/// The most words of a part that may be missing: those of a spot in a face.
const LONGEST: usize = 5;
