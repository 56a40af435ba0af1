//! Which triangles are an oriented 2-manifold, and what is wrong with others: the
//! definitions, written down as loops.

/// What is wrong with triangles: its name, its vertices (of a face that has one which does not exist, the corner
/// instead), and its faces, of a bow-tie those of each fan. Lists of faces ascend.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Fault(
    pub(crate) &'static str,
    pub(crate) Vec<u32>,
    pub(crate) Vec<Vec<usize>>,
);

/// Whether triangles are an oriented 2-manifold, with or without boundary.
pub(crate) fn is_strict(vertices: usize, faces: &[[u32; 3]]) -> bool {
    let mut sides = Vec::new();
    let mut sets = Vec::new();
    for &[a, b, c] in faces {
        if a == b || b == c || c == a || [a, b, c].iter().any(|&v| v as usize >= vertices) {
            return false;
        }
        sides.extend([(a, b), (b, c), (c, a)]);
        let mut set = [a, b, c];
        set.sort();
        sets.push(set);
    }
    has_no_twins(&mut sides)
        && has_no_twins(&mut sets)
        && (0..vertices as u32)
            .all(|v| fans(v, faces, &(0..faces.len()).collect::<Vec<_>>()).len() < 2)
}

fn has_no_twins<T: Ord>(list: &mut [T]) -> bool {
    list.sort();
    list.windows(2).all(|two| two[0] != two[1])
}

/// Everything that is wrong with triangles, sorted. A face with a vertex that does not exist,
/// or with the same vertex twice, is left out of what follows.
pub(crate) fn faults(vertices: usize, faces: &[[u32; 3]]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut sound = Vec::new();
    for (f, &[a, b, c]) in faces.iter().enumerate() {
        let beyond: Vec<u32> = (0..3)
            .filter(|&i| [a, b, c][i as usize] as usize >= vertices)
            .collect();
        for &corner in &beyond {
            faults.push(Fault("out of range", vec![corner], vec![vec![f]]));
        }
        if !beyond.is_empty() {
        } else if a == b || a == c {
            faults.push(Fault("repeated", vec![a], vec![vec![f]]));
        } else if b == c {
            faults.push(Fault("repeated", vec![b], vec![vec![f]]));
        } else {
            sound.push(f);
        }
    }
    let same_set = |f: usize, g: usize| faces[f].iter().all(|v| faces[g].contains(v));
    let has_side = |f: usize, from: u32, to: u32| {
        (0..3).any(|i| faces[f][i] == from && faces[f][(i + 1) % 3] == to)
    };
    for &f in &sound {
        let group: Vec<usize> = sound.iter().copied().filter(|&g| same_set(f, g)).collect();
        if group.len() > 1 && group[0] == f {
            let [a, b, _] = faces[f];
            let is_pillow = group.len() == 2 && !has_side(group[1], a, b);
            let what = if is_pillow { "pillow" } else { "duplicate" };
            faults.push(Fault(what, vec![], vec![group]));
        }
    }
    for a in 0..vertices as u32 {
        for b in a + 1..vertices as u32 {
            let up: Vec<usize> = sound
                .iter()
                .copied()
                .filter(|&f| has_side(f, a, b))
                .collect();
            let down: Vec<usize> = sound
                .iter()
                .copied()
                .filter(|&f| has_side(f, b, a))
                .collect();
            let mut on = [&up[..], &down[..]].concat();
            on.sort();
            if on.iter().all(|&f| same_set(f, on[0])) {
                continue; // At most one face, or faces that were named above.
            }
            match (up.len(), down.len()) {
                (1, 1) => {}
                (2, 0) => faults.push(Fault("flipped", vec![a, b], vec![on])),
                (0, 2) => faults.push(Fault("flipped", vec![b, a], vec![on])),
                _ => faults.push(Fault("crowded", vec![a, b], vec![on])),
            }
        }
    }
    for vertex in 0..vertices as u32 {
        let fans = fans(vertex, faces, &sound);
        if fans.len() > 1 {
            faults.push(Fault("bow-tie", vec![vertex], fans));
        }
    }
    faults.sort();
    faults
}

/// The faces of a vertex, in sets that are joined by further vertices in common.
fn fans(vertex: u32, faces: &[[u32; 3]], sound: &[usize]) -> Vec<Vec<usize>> {
    let mut fans: Vec<Vec<usize>> = Vec::new();
    for &f in sound.iter().filter(|&&f| faces[f].contains(&vertex)) {
        let meets = |g: &usize| {
            let common = faces[f].iter().filter(|v| faces[*g].contains(v));
            common.count() > 1
        };
        let (joined, mut apart): (Vec<_>, Vec<_>) =
            fans.into_iter().partition(|fan| fan.iter().any(meets));
        let mut fan = joined.concat();
        fan.push(f);
        fan.sort();
        apart.push(fan);
        fans = apart;
    }
    fans.sort();
    fans
}
