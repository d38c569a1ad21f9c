//! Lists of bodies, pairs and rows that grow with a world: by a quarter, since half of a list that doubles may lie empty
//! for ever.

/// Appends to a list.
pub(crate) fn push<T>(list: &mut Vec<T>, item: T) {
    if list.len() == list.capacity() {
        list.reserve_exact(list.len() / 4 + 8);
    }
    list.push(item);
}
