//! Disjoint sets of numbers.

/// A union–find forest over the numbers 0, 1, 2, …, which represents disjoint sets that can be joined.
///
/// The representative of a set is its smallest number, so results do not depend on the order of joins. A
/// look-up halves the path that it walks; n operations take O(n log n).
///
/// ```
/// use tearmesh::DisjointSets;
///
/// let mut sets = DisjointSets::new(4);
/// sets.join(3, 1);
/// assert_eq!((sets.representative(3), sets.representative(2)), (1, 2));
/// assert_eq!(sets.count(), 3);
/// ```
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    /// A smaller number of the same set, or for a representative itself.
    above: Vec<u32>,
}

impl DisjointSets {
    /// Creates a forest in which each number below `count` is in a set of its own.
    #[must_use]
    pub fn new(count: u32) -> DisjointSets {
        DisjointSets {
            above: (0..count).collect(),
        }
    }

    /// Resets the forest so that each number below `count` is in a set of its own. Keeps the
    /// allocated memory.
    pub fn reset(&mut self, count: u32) {
        self.above.clear();
        self.above.extend(0..count);
    }

    /// Adds the next number in a set of its own, and returns the number.
    pub fn push(&mut self) -> u32 {
        let next = self.above.len() as u32;
        self.above.push(next);
        next
    }

    /// Returns the representative of a number: the smallest number in its set.
    ///
    /// # Panics
    ///
    /// If `number` is not in the forest.
    pub fn representative(&mut self, mut number: u32) -> u32 {
        while self.above[number as usize] != number {
            let above = self.above[self.above[number as usize] as usize];
            self.above[number as usize] = above;
            number = above;
        }
        number
    }

    /// Joins the sets that two numbers belong to.
    ///
    /// # Panics
    ///
    /// If `a` or `b` is not in the forest.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.representative(a), self.representative(b));
        self.above[a.max(b) as usize] = a.min(b);
    }

    /// Returns the number of disjoint sets. Linear.
    #[must_use]
    pub fn count(&self) -> usize {
        let numbers = self.above.iter().zip(0..);
        numbers.filter(|&(&above, number)| above == number).count()
    }

    /// Returns the representative of each number, indexed by number. Linear: a representative is smaller than the
    /// other numbers of its set, so one pass shortens every path to one step.
    pub fn representatives(&mut self) -> &[u32] {
        for number in 0..self.above.len() {
            self.above[number] = self.above[self.above[number] as usize];
        }
        &self.above
    }
}
