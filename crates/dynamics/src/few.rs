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

impl Few {
    pub(crate) fn push(&mut self, number: u32) {
        *self = if self.is_empty() {
            Self::One(number)
        } else {
            Self::Many([&**self, &[number]].concat().into())
        };
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
    fn what_is_pushed_is_there_in_order() {
        assert_eq!(size_of::<Few>(), 16);
        let mut few = Few::default();
        for count in 0..5 {
            assert!(few.iter().copied().eq(0..count));
            few.push(count);
        }
    }
}
