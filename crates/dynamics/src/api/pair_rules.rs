//! What a caller says of two bodies alone: the material between them, and whether they collide at all.

use crate::{BodyError, BodyId, BodyIx, PairMaterial, World};

impl World {
    /// Gives two bodies a friction and restitution of their own, instead of the mixed ones.
    ///
    /// # Errors
    /// If a body is not there, both are one, or a number is out of its range.
    pub fn set_pair_material(
        &mut self,
        a: BodyId,
        b: BodyId,
        material: PairMaterial,
    ) -> Result<(), BodyError> {
        material.check()?;
        let (ends, key) = self.two(a, b)?;
        self.broad.overrides.insert(key, material);
        self.mix_anew(ends, key);
        Ok(())
    }

    /// Takes back what [`Self::set_pair_material`] said of two bodies: their materials are mixed again.
    ///
    /// # Errors
    /// If a body is not there, or both are one.
    pub fn clear_pair_material(&mut self, a: BodyId, b: BodyId) -> Result<(), BodyError> {
        let (ends, key) = self.two(a, b)?;
        if self.broad.overrides.remove(&key).is_some() {
            self.mix_anew(ends, key);
        }
        Ok(())
    }

    /// Gives the pairs of two bodies the material that they have now.
    fn mix_anew(&mut self, ends: [BodyIx; 2], (a, b): (BodyId, BodyId)) {
        self.resurface(ends[0]);
        for place in self.bodies.get(ends[0]).pairs.clone() {
            let pair = self.pairs.get_mut(place);
            if pair.bodies == (a.index, b.index) {
                pair.material = self.broad.material(&self.bodies, pair.colliders);
            }
        }
        for index in ends {
            if self.bodies.get(index).is_dynamic() {
                self.disturb(index, |_| {});
            }
        }
    }

    /// Whether two bodies collide with each other, whatever their filters say: they do unless this said `false`.
    ///
    /// Two that overlap are pushed apart once they collide again.
    ///
    /// # Errors
    /// If a body is not there, or both are one.
    pub fn set_pair_collides(
        &mut self,
        a: BodyId,
        b: BodyId,
        collides: bool,
    ) -> Result<(), BodyError> {
        let (ends, key) = self.two(a, b)?;
        let changed = if collides {
            self.broad.excluded.remove(&key)
        } else {
            self.broad.excluded.insert(key)
        };
        if changed {
            for index in ends {
                self.remake(index, |_| {});
            }
        }
        Ok(())
    }

    /// Places of two bodies, and their ids in order.
    fn two(&self, a: BodyId, b: BodyId) -> Result<([BodyIx; 2], (BodyId, BodyId)), BodyError> {
        let ends = [self.bodies.find(a)?, self.bodies.find(b)?];
        if a == b {
            return Err(BodyError::SameBody(a));
        }
        Ok((ends, if a < b { (a, b) } else { (b, a) }))
    }
}
