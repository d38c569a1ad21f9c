//! Values in numbered places, which are used again.

/// Values by place; the place that was left last is taken first.
#[derive(Clone, Debug)]
pub(crate) struct Slots<T> {
    list: Vec<Option<T>>,
    free: Vec<u32>,
}

impl<T> Default for Slots<T> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            free: Vec::new(),
        }
    }
}

/// The value at a place of a list, which grows as far as that.
pub(crate) fn grown<T: Clone>(list: &mut Vec<T>, place: u32, fill: T) -> &mut T {
    let at = place as usize;
    if list.len() <= at {
        list.resize(at + 1, fill);
    }
    &mut list[at]
}

/// The number of a place in a list.
#[expect(
    clippy::cast_possible_truncation,
    reason = "fewer than 2^32 fit in memory"
)]
pub(crate) const fn number(at: usize) -> u32 {
    at as u32
}

impl<T> Slots<T> {
    pub(crate) fn insert(&mut self, value: T) -> u32 {
        let place = self.free.pop().unwrap_or_else(|| {
            self.list.push(None);
            number(self.list.len() - 1)
        });
        self.list[place as usize] = Some(value);
        place
    }

    pub(crate) fn remove(&mut self, place: u32) -> Option<T> {
        let value = self.list.get_mut(place as usize)?.take();
        if value.is_some() {
            self.free.push(place);
        }
        value
    }

    pub(crate) fn get(&self, place: u32) -> Option<&T> {
        self.list.get(place as usize)?.as_ref()
    }

    pub(crate) fn get_mut(&mut self, place: u32) -> Option<&mut T> {
        self.list.get_mut(place as usize)?.as_mut()
    }

    /// All values with their places, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, &T)> {
        let all = (0_u32..).zip(&self.list);
        all.filter_map(|(place, value)| Some((place, value.as_ref()?)))
    }
}
