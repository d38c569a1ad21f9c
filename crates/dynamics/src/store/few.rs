//! A list that is mostly of one.

use core::ops::Deref;

/// Values in order: one is kept in place, and more on the heap. 16 bytes.
#[derive(Clone, Debug)]
pub(crate) enum Few<T> {
    One(T),
    Many(Box<[T]>),
}

impl<T> Default for Few<T> {
    fn default() -> Self {
        Self::Many(Box::default())
    }
}

impl<T> FromIterator<T> for Few<T> {
    fn from_iter<I: IntoIterator<Item = T>>(numbers: I) -> Self {
        let mut numbers = numbers.into_iter().fuse();
        match (numbers.next(), numbers.next()) {
            (Some(number), None) => Self::One(number),
            (first, second) => Self::Many(first.into_iter().chain(second).chain(numbers).collect()),
        }
    }
}

impl<T> Deref for Few<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::One(number) => core::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}

impl<'a, T> IntoIterator for &'a Few<T> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_collected_is_there_in_order() {
        assert_eq!(size_of::<Few<u32>>(), 16);
        for count in 0..5 {
            let few: Few<u32> = (0..count).collect();
            assert!(few.iter().copied().eq(0..count));
        }
    }
}
