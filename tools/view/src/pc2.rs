//! Point caches: where all vertices of one mesh are, sample by sample.
//!
//! The format PC2, which Blender's modifier Mesh Cache plays, and 3ds Max and Houdini read: a header of 32
//! bytes, `POINTCACHE2` and a zero, then the version (1) and the number of points as 32-bit integers, the
//! frame of the first sample and the frames from one to the next as 32-bit floats, and the number of samples;
//! behind it three 32-bit floats for each point of each sample. All of it is little-endian.

use std::io::{self, Write};

use tearmesh::Point;

/// Writes a point cache in the format PC2, with one sample per frame from frame 1. Each sample has `points`
/// points, one for each vertex, in the vertex order of the mesh that the cache animates.
///
/// Coordinates are rounded to `f32`.
///
/// ```
/// use tearmesh::Point;
///
/// let still = [Point::new(0.0, 0.5, -1.0), Point::new(2.0, 0.0, 0.0)];
/// let mut file = Vec::new();
/// tearmesh_view::write_pc2(&mut file, 2, [still, still])?;
/// assert_eq!((&file[..12], file.len()), (&b"POINTCACHE2\0"[..], 32 + 2 * 2 * 3 * 4));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
///
/// Any I/O error of `out`. An error of the kind `InvalidInput` if a sample does not have `points` points, or
/// if the number of samples or points exceeds [`i32::MAX`].
pub fn write_pc2<S>(
    mut out: impl Write,
    points: usize,
    samples: impl IntoIterator<Item = S, IntoIter: ExactSizeIterator>,
) -> io::Result<()>
where
    S: IntoIterator<Item = Point>,
{
    let samples = samples.into_iter();
    out.write_all(b"POINTCACHE2\0")?;
    out.write_all(&1i32.to_le_bytes())?;
    out.write_all(&counted(points)?.to_le_bytes())?;
    // The first frame, and the frames of a sample.
    out.write_all(&[1.0f32, 1.0].map(f32::to_le_bytes).concat())?;
    out.write_all(&counted(samples.len())?.to_le_bytes())?;
    for sample in samples {
        let mut written = 0;
        for point in sample {
            for x in [point.x, point.y, point.z] {
                out.write_all(&(x as f32).to_le_bytes())?;
            }
            written += 1;
        }
        if written != points {
            return Err(invalid(format!("{written} points in a sample of {points}")));
        }
    }
    Ok(())
}

fn counted(count: usize) -> io::Result<i32> {
    i32::try_from(count).map_err(|_| invalid(format!("{count} are too many for a point cache")))
}

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}
