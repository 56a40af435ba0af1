//! Items in groups of equal keys, without comparing any two of different groups.

/// Calls a function with each group of items that have the same key, in ascending order of the keys, which
/// are less than `keys`. Within a group, items keep their order. Linear in the items and keys.
pub(super) fn for_each_group<T: Copy>(
    items: &[T],
    keys: usize,
    key: impl Fn(T) -> usize,
    mut act: impl FnMut(&mut [T]),
) {
    // At first where each group starts, and in the end where it ends.
    let mut bounds = vec![0u32; keys + 1];
    for &item in items {
        bounds[key(item) + 1] += 1;
    }
    let mut sum = 0;
    for bound in &mut bounds {
        sum += *bound;
        *bound = sum;
    }
    let mut grouped = items.to_vec();
    for &item in items {
        let next = &mut bounds[key(item)];
        grouped[*next as usize] = item;
        *next += 1;
    }
    let mut start = 0;
    for &end in &bounds[..keys] {
        if end > start {
            act(&mut grouped[start as usize..end as usize]);
        }
        start = end;
    }
}
