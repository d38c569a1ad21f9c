//! Lists that are read by numbers of one kind alone, and values in numbered places, which are used again.

use core::marker::PhantomData;
use core::ops::{Deref, DerefMut, Index, IndexMut};

use crate::Ix;

/// A list that is read by numbers of one kind alone.
#[derive(Clone, Debug)]
pub(crate) struct List<I, T>(Vec<T>, PhantomData<I>);

impl<I, T> Default for List<I, T> {
    fn default() -> Self {
        Self(Vec::new(), PhantomData)
    }
}

impl<I, T> Deref for List<I, T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<I, T> DerefMut for List<I, T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<I: Ix, T> Index<I> for List<I, T> {
    type Output = T;

    fn index(&self, place: I) -> &T {
        &self.0[place.at()]
    }
}

impl<I: Ix, T> IndexMut<I> for List<I, T> {
    fn index_mut(&mut self, place: I) -> &mut T {
        &mut self.0[place.at()]
    }
}

impl<I: Ix, T> List<I, T> {
    /// Adds a value at the end; its place.
    pub(crate) fn push(&mut self, value: T) -> I {
        self.0.push(value);
        I::new(u32::try_from(self.0.len() - 1).expect("fewer than 2^32 fit in memory"))
    }

    pub(crate) fn get(&self, place: I) -> Option<&T> {
        self.0.get(place.at())
    }

    pub(crate) fn get_mut(&mut self, place: I) -> Option<&mut T> {
        self.0.get_mut(place.at())
    }

    /// The value at a place; the list grows as far as that.
    pub(crate) fn grown(&mut self, place: I, fill: T) -> &mut T
    where
        T: Clone,
    {
        let at = place.at();
        if self.0.len() <= at {
            self.0.resize(at + 1, fill);
        }
        &mut self.0[at]
    }

    /// All values with their places, in order.
    pub(crate) fn each(&self) -> impl Iterator<Item = (I, &T)> {
        (0..).map(I::new).zip(&self.0)
    }
}

/// Values by place; the place that was left last is taken first.
#[derive(Clone, Debug)]
pub(crate) struct Slots<I, T> {
    list: List<I, Option<T>>,
    free: Vec<I>,
}

impl<I, T> Default for Slots<I, T> {
    fn default() -> Self {
        Self {
            list: List::default(),
            free: Vec::new(),
        }
    }
}

impl<I: Ix, T> Slots<I, T> {
    pub(crate) fn insert(&mut self, value: T) -> I {
        let place = self.free.pop().unwrap_or_else(|| self.list.push(None));
        self.list[place] = Some(value);
        place
    }

    pub(crate) fn remove(&mut self, place: I) -> Option<T> {
        let value = self.list.get_mut(place)?.take();
        if value.is_some() {
            self.free.push(place);
        }
        value
    }

    pub(crate) fn get(&self, place: I) -> Option<&T> {
        self.list.get(place)?.as_ref()
    }

    pub(crate) fn get_mut(&mut self, place: I) -> Option<&mut T> {
        self.list.get_mut(place)?.as_mut()
    }

    /// All values with their places, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (I, &T)> {
        let all = self.list.each();
        all.filter_map(|(place, value)| Some((place, value.as_ref()?)))
    }
}
