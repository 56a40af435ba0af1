//! Numbers as people type them.

use tearmesh::Point;

/// Reads a point.
pub(super) fn point(text: &str) -> Result<Point, String> {
    match numbers(text, ',')[..] {
        [x, y, z] => Ok(Point::new(x, y, z)),
        _ => Err("expected three numbers with commas between them, as in 0,1.5,0".to_owned()),
    }
}

/// Reads an eye and the point that it looks at.
pub(super) fn look(text: &str) -> Result<[Point; 2], String> {
    let (eye, at) = text
        .split_once('@')
        .ok_or("expected `@` between the eye and what it looks at, as in 0,0,5@0,0,0")?;
    Ok([point(eye)?, point(at)?])
}

/// Reads the size of a picture.
pub(super) fn size(text: &str) -> Result<[f64; 2], String> {
    match numbers(text, 'x')[..] {
        [width, height] if width > 0.0 && height > 0.0 => Ok([width, height]),
        _ => Err("expected width and height with an x between them, as in 1920x1080".to_owned()),
    }
}

/// Finite numbers, `separator` between them; none if one cannot be read.
pub(crate) fn numbers(text: &str, separator: char) -> Vec<f64> {
    let numbers = text.split(separator);
    let read = numbers.map(|number| number.trim().parse().ok().filter(|x: &f64| x.is_finite()));
    read.collect::<Option<_>>().unwrap_or_default()
}
