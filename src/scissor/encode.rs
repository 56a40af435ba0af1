//! A scissor as numbers, so that a cut can be logged and made again to the bit.

use super::{CutLayers, CutTips, Scissor};
use crate::geometry::{Plane, Point, Ray, Vector};

impl Scissor {
    /// Returns the scissor as 64-bit words, from which [`Scissor::from_words`] makes an equal one:
    /// its rays or its plane, its snap, and its other settings. Returns `None` for a scissor that
    /// continues another cut, since that holds vertices of a mesh.
    ///
    /// ```
    /// use tearmesh::{CutLayers, Point, Ray, Scissor, Vector};
    ///
    /// let down = |x| Ray::new(Point::new(x, 0.1, 5.0), Vector::new(0.3, 0.0, -1.0));
    /// let scissor = Scissor::new(down(0.1)?, down(0.7)?)?.with_snap(0.2).with_layers(CutLayers::First);
    /// let words = scissor.to_words().ok_or("it continues no cut")?;
    /// assert_eq!(Scissor::from_words(&words), Some(scissor));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_words(&self) -> Option<Vec<u64>> {
        if self.joints.iter().any(Option::is_some) {
            return None;
        }
        let plane = &self.strip.plane;
        let vectors = match &self.rays {
            Some(rays) => rays
                .iter()
                .flat_map(|ray| [ray.origin().coords, ray.direction()])
                .collect(),
            None => vec![plane.point().coords, plane.scaled_normal()],
        };
        let numbers = vectors.iter().flat_map(|v| [v.x, v.y, v.z]);
        let numbers = numbers.chain([self.snap]);
        let settings = [
            self.strip.through,
            self.snap_move,
            self.tips == CutTips::Midpoint,
            self.layers == CutLayers::First,
        ];
        let flags = settings
            .iter()
            .rev()
            .fold(0, |flags, &is_set| 2 * flags + u64::from(is_set));
        Some(numbers.map(f64::to_bits).chain([flags]).collect())
    }

    /// Makes a scissor of the words that [`Scissor::to_words`] returned; `None` if they are not such.
    #[must_use]
    pub fn from_words(words: &[u64]) -> Option<Scissor> {
        let (&flags, numbers) = words.split_last()?;
        let (&snap, numbers) = numbers.split_last()?;
        let vector = |words: &[u64]| {
            let [x, y, z] = [0, 1, 2].map(|i| f64::from_bits(words[i]));
            Vector::new(x, y, z)
        };
        let (vectors, rest) = numbers.as_chunks::<3>();
        let vectors: Vec<Vector> = vectors.iter().map(|words| vector(words)).collect();
        let ray = |from: Vector, along| Ray::new(Point::from(from), along).ok();
        let scissor = match vectors[..] {
            [point, normal] => Scissor::by_plane(Plane::new(point.into(), normal).ok()?),
            [a, along_a, b, along_b] => Scissor::new(ray(a, along_a)?, ray(b, along_b)?).ok()?,
            _ => return None,
        };
        let [through, snap_move, midpoint, first] = [1, 2, 4, 8].map(|flag| flags & flag != 0);
        let tips = [CutTips::Vertex, CutTips::Midpoint][usize::from(midpoint)];
        let layers = [CutLayers::All, CutLayers::First][usize::from(first)];
        let scissor = scissor.with_through(through).with_snap_move(snap_move);
        let is_ours = rest.is_empty() && flags < 16;
        is_ours.then(|| {
            scissor
                .with_snap(f64::from_bits(snap))
                .with_tips(tips)
                .with_layers(layers)
        })
    }
}
