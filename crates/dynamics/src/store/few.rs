//! A list that is mostly of one.

use core::ops::Deref;

/// Numbers in order: one is kept in place, and more on the heap. 16 bytes.
#[derive(Clone, Debug)]
pub(crate) enum Few {
    One(u32),
    Many(Box<[u32]>),
}

impl Default for Few {
    fn default() -> Self {
        Self::Many(Box::default())
    }
}

impl FromIterator<u32> for Few {
    fn from_iter<I: IntoIterator<Item = u32>>(numbers: I) -> Self {
        let mut numbers = numbers.into_iter().fuse();
        match (numbers.next(), numbers.next()) {
            (Some(number), None) => Self::One(number),
            (first, second) => Self::Many(first.into_iter().chain(second).chain(numbers).collect()),
        }
    }
}

impl Deref for Few {
    type Target = [u32];

    fn deref(&self) -> &[u32] {
        match self {
            Self::One(number) => core::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}

impl<'a> IntoIterator for &'a Few {
    type Item = &'a u32;
    type IntoIter = core::slice::Iter<'a, u32>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_collected_is_there_in_order() {
        assert_eq!(size_of::<Few>(), 16);
        for count in 0..5 {
            let few: Few = (0..count).collect();
            assert!(few.iter().copied().eq(0..count));
        }
    }
}
