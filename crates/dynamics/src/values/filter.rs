//! Collision filters.

/// Which shapes a shape may touch, by categories, a mask and a group.
///
/// Two shapes of one group that is not 0 touch if it is above 0, and pass through each other if it is
/// below. Any others touch if each is of a category that the other's mask has.
///
/// # Examples
/// ```
/// use carom_dynamics::Filter;
/// const WALLS: u64 = 1 << 0;
/// const COINS: u64 = 1 << 1;
/// let wall = Filter { categories: WALLS, ..Filter::default() };
/// let coin = Filter { categories: COINS, mask: WALLS, ..Filter::default() };   // coins meet walls alone
/// assert!(coin.touches(wall) && wall.touches(coin));
/// assert!(!coin.touches(coin));
/// let wheel = Filter { group: -1, ..Filter::default() };                       // parts of one car
/// assert!(!wheel.touches(wheel) && wheel.touches(wall));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Filter {
    /// What the shape is: a bit for each category, usually one.
    pub categories: u64,
    /// The categories that it touches.
    pub mask: u64,
    /// 0: no group.
    pub group: i32,
}

impl Default for Filter {
    /// The first category, which touches everything; no group.
    fn default() -> Self {
        Self {
            categories: 1,
            mask: u64::MAX,
            group: 0,
        }
    }
}

impl Filter {
    /// Whether shapes of these filters touch; the order does not matter.
    #[must_use]
    pub const fn touches(self, other: Self) -> bool {
        if self.group == other.group && self.group != 0 {
            return self.group > 0;
        }
        self.mask & other.categories != 0 && other.mask & self.categories != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn filter() -> impl Strategy<Value = Filter> {
        (0..8_u64, 0..8_u64, -2..3_i32).prop_map(|(categories, mask, group)| Filter {
            categories,
            mask,
            group,
        })
    }

    proptest! {
        #[test]
        fn the_order_does_not_matter(a in filter(), b in filter()) {
            prop_assert_eq!(a.touches(b), b.touches(a));
        }

        #[test]
        fn a_group_outweighs_masks(a in filter(), b in filter()) {
            let same = Filter { group: a.group, ..b };
            if a.group != 0 {
                prop_assert_eq!(a.touches(same), a.group > 0);
            }
        }
    }
}
