//! Cores of shapes: what must not pass through anything. Whoever slides, rolls or grazes is outside of it.

use std::sync::Arc;

use carom_collision::hulls;
use carom_geometry::Shape;

use crate::state::inner_of;

/// The core of a convex part lies so deep inside, as a fraction of its least half width: 2.5 mm for a box
/// of 1 m, more than contacts of a pile sink in by.
const CORE: f64 = 0.005;

/// A core that is not used for so many ticks is dropped.
const KEPT: u32 = 16;

/// The cores of shapes that passed others by a hair lately, by collider.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cores {
    list: Vec<Option<Cored>>,
    /// Asked for since those that nobody asked for were dropped.
    asked: bool,
    /// Ticks since then.
    ticks: u32,
}

#[derive(Clone, Debug)]
struct Cored {
    of: Arc<Shape>,
    /// Of each convex part.
    parts: Arc<[Shape]>,
    asked: bool,
}

impl Cores {
    pub(super) fn of(&mut self, collider: u32, solid: &Arc<Shape>) -> Arc<[Shape]> {
        let at = collider as usize;
        if self.list.len() <= at {
            self.list.resize(at + 1, None);
        }
        self.asked = true;
        if let Some(cored) = &mut self.list[at]
            && Arc::ptr_eq(&cored.of, solid)
        {
            cored.asked = true;
            return Arc::clone(&cored.parts);
        }
        let parts = parts_of(solid);
        self.list[at] = Some(Cored {
            of: Arc::clone(solid),
            parts: Arc::clone(&parts),
            asked: true,
        });
        parts
    }

    /// A tick begins: drops cores that nobody asked for in the last ones.
    pub(super) fn age(&mut self) {
        self.ticks += 1;
        if self.ticks < KEPT {
            return;
        }
        self.ticks = 0;
        if !core::mem::take(&mut self.asked) {
            self.list = Vec::new();
            return;
        }
        for known in &mut self.list {
            let kept = known
                .as_mut()
                .map(|cored| core::mem::take(&mut cored.asked));
            if kept == Some(false) {
                *known = None;
            }
        }
    }
}

fn parts_of(solid: &Shape) -> Arc<[Shape]> {
    let single = hulls(solid).len() == 1;
    let parts = hulls(solid).map(|hull| {
        let inner = inner_of(&hull);
        // What cannot be shrunk, a segment, is all core.
        let whole = || if single { None } else { hull.inset(0.0) };
        let core = hull.inset(CORE * inner).or_else(whole);
        core.unwrap_or_else(|| solid.clone())
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_geometry::ConvexPolygon;

    #[test]
    fn cores_that_nobody_asks_for_are_dropped() {
        let solid = ConvexPolygon::rectangle(1.0, 1.0).expect("a square");
        let solid = Arc::new(Shape::from(solid));
        let mut cores = Cores::default();
        for tick in 0..10 * KEPT {
            let first = cores.of(3, &solid);
            assert!(Arc::ptr_eq(&first, &cores.of(3, &solid)), "tick {tick}");
            if tick == 0 {
                cores.of(5, &solid);
            }
            cores.age();
        }
        let kept = |cores: &Cores| cores.list.iter().flatten().count();
        assert_eq!(kept(&cores), 1);
        for _ in 0..2 * KEPT {
            cores.age();
        }
        assert_eq!(cores.list.capacity(), 0);
    }
}
