//! Analytic islands that slide, roll or tip move by events until their next mode change.
//!
//! A member of an island that slides or rolls has one parabola until its mode changes, just as a free body has one until
//! its next impact. So it is treated as a free body is: swept boxes, impacts in the calendar queue, and a search that ends
//! with its mode. Only the parts that its mode holds in contact are not searched for. A body that meets it, or a call that
//! changes it, gives the whole island back: it gets its method anew before time goes on.

use carom_geometry::Aabb;
use carom_math::SimTime;

use crate::events::free::Cause;
use crate::model::narrow::look;
use crate::{BodyIx, IslandIx, PairIx, World};

impl World {
    /// Islands that came to move since the last time begin their motion; what goes otherwise than they say joins the engine. Whether
    /// there were some.
    pub(crate) fn begin_analytic_motion(&mut self, time: SimTime) -> bool {
        let moving = self.closed.take_begun(false);
        let some = !moving.is_empty();
        for place in moving {
            let Some(group) = self.closed.get(place) else {
                continue;
            };
            if group.may_move(&self.bodies, &self.pairs) {
                self.move_analytically(place, time);
            } else {
                for index in group.indices() {
                    self.join(index, time);
                }
            }
        }
        some
    }

    /// An island moves by events until its next mode change.
    fn move_analytically(&mut self, place: IslandIx, time: SimTime) {
        let Some(group) = self.closed.get(place) else {
            return;
        };
        let until = group.until.unwrap_or(SimTime::NEVER);
        let members = group.indices();
        let touches: Vec<PairIx> = group.touches.iter().map(|touch| touch.pair).collect();
        for &index in &members {
            self.end_unsettled(index);
            for pair in self.bodies.get(index).pairs.clone() {
                let other = self.pairs.get(pair).other(index);
                // What waits for its method, too, is about to look at its pairs.
                if !touches.contains(&pair) && !self.bodies.get(other).is_held() {
                    self.part(pair, time);
                }
            }
            let state = self.bodies.get_mut(index);
            state.begin_analytic_motion();
            state.set_piece(until);
            self.joins.note_flight(&self.bodies, index);
        }
        self.begin_next_pieces(place, time);
    }

    /// The next pieces of the members of an island in analytic motion, and their impacts.
    pub(crate) fn begin_next_pieces(&mut self, place: IslandIx, time: SimTime) {
        let Some(group) = self.closed.get(place) else {
            return;
        };
        let members = group.indices();
        for &index in &members {
            self.closed.begin_next_piece(&mut self.bodies, index, time);
        }
        self.closed.renew_members(&mut self.bodies, place);
        for index in members {
            self.foresee(index, time, Cause::Deflected, None);
        }
    }

    /// Ends the analytic motion of an island; its members, if it was in motion.
    pub(crate) fn land_group(&mut self, place: IslandIx, time: SimTime) -> Vec<BodyIx> {
        let Some(group) = self
            .closed
            .get(place)
            .filter(|group| group.moves_analytically(&self.bodies))
        else {
            return Vec::new();
        };
        let members = group.indices();
        // They leave their path first: where they are is asked many times at this instant.
        for &index in &members {
            if self.bodies.get(index).flight.is_some() {
                self.bodies.change(index, time, |_| {});
            }
        }
        // Which sides its contacts hide is asked of where they are now.
        for touch in &group.touches {
            let pair = self.pairs.get_mut(touch.pair);
            look(&self.bodies, pair, time);
        }
        for &index in &members {
            self.bodies.get_mut(index).land();
            self.free.vanish(&mut self.bodies, index);
        }
        self.closed.renew_members(&mut self.bodies, place);
        for &index in &members {
            self.unsettle(index, time);
            // Its boxes are as long as its way was: narrow ones meet what is here.
            self.bodies.set_boxes(index, Aabb::EMPTY);
        }
        self.closed.begins(place, false);
        members
    }

    /// Gives the island of a body back, if it is in analytic motion: its motions stand, and its mode; whether it was.
    pub(crate) fn hand_back_of(&mut self, index: BodyIx, time: SimTime) -> bool {
        let moves_analytically = self.bodies.get(index).moves_analytically();
        if moves_analytically {
            for index in self.land_group(self.bodies.get(index).membership.group, time) {
                self.redirect(index, time);
            }
        }
        moves_analytically
    }

    /// Gives an island in analytic motion that a pair holds together back, before the pair goes: all that
    /// it touches is looked at then.
    pub(crate) fn hand_back_by(&mut self, pair: PairIx, time: SimTime) {
        let Some(ends) = self.pairs.find(pair).map(|pair| pair.bodies) else {
            return;
        };
        for index in [ends.0, ends.1] {
            let group = self.closed.group_of(&self.bodies, index);
            if group.is_some_and(|group| group.touches_by(pair)) {
                self.hand_back_of(index, time);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
    use carom_math::{Vec2, vec2};

    use crate::{BodyDef, BodyId, BodyKind, Impulse, Material, Settings, World};

    /// Numbers from 0 to 1 by chance.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
            let part = (state >> 11) as f64;
            part / (1_u64 << 53) as f64
        }
    }

    fn material(restitution: f64, friction: f64) -> Material {
        Material {
            restitution,
            friction,
            ..Material::default()
        }
    }

    /// A floor that ends, a wall, a belt, and blocks and discs that slide, roll and drop.
    fn scene(seed: u64) -> (World, Vec<BodyId>) {
        let mut next = numbers(seed);
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            sleep: None,
            ..Settings::default()
        })
        .expect("settings");
        let floor = ConvexPolygon::rectangle(60.0, 1.0).expect("a floor");
        let friction = 0.1 + 0.3 * next();
        let surface = material(0.0, friction);
        let put = world.insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, surface);
        put.expect("valid");
        let wall = HalfPlane::new(vec2(29.0, 0.0), -Vec2::X).expect("a wall");
        world
            .insert(BodyDef::fixed(), wall, material(0.5, 0.0))
            .expect("valid");
        let belt = ConvexPolygon::rectangle(8.0, 0.5).expect("a belt");
        let def = BodyDef::kinematic()
            .at(vec2(-45.0, 0.0))
            .moving(vec2(0.5, 0.0));
        world.insert(def, belt, surface).expect("valid");
        let mut ids = Vec::new();
        for k in 0..10 {
            let drops = next() < 0.2;
            let x = -27.0 + 5.0 * f64::from(k) + next();
            let y = if drops { 2.0 + next() } else { 0.5 };
            let speed = 8.0 * next() - 4.0;
            let def = BodyDef::dynamic().at(vec2(x, y)).moving(vec2(speed, 0.0));
            let (def, shape): (_, Shape) = if next() < 0.5 {
                let spin = if next() < 0.5 {
                    -speed / 0.5
                } else {
                    4.0 * next()
                };
                (def.spinning(spin), Circle::new(0.5).expect("a disc").into())
            } else {
                let width = 1.0 + next();
                let block = ConvexPolygon::rectangle(width, 1.0).expect("a block");
                (def, block.into())
            };
            let id = world.insert(def, shape, material(0.5 * next(), friction));
            ids.push(id.expect("valid"));
        }
        let rider = ConvexPolygon::square(1.0).expect("a block");
        let def = BodyDef::dynamic().at(vec2(-46.0, 0.75));
        ids.push(world.insert(def, rider, surface).expect("valid"));
        (world, ids)
    }

    #[test]
    fn cutting_steps_changes_no_bit_of_an_analytic_island() {
        for seed in 1..10 {
            let (mut whole, _) = scene(seed);
            let (mut cut, _) = scene(seed);
            let mut next = numbers(seed + 100);
            whole.step(2.0);
            while cut.time() < whole.time() {
                // Sums of such parts of a second are exact.
                let dt = (1024.0 * next()).floor() / 8192.0;
                cut.step(dt.min(whole.time() - cut.time()));
            }
            assert_eq!(cut.state_hash(), whole.state_hash(), "seed {seed}");
        }
    }

    #[test]
    fn a_caller_may_change_anything_about_an_analytic_body() {
        for seed in 1..60 {
            let (mut world, ids) = scene(seed);
            let mut next = numbers(seed + 200);
            for _ in 0..30 {
                world.step(0.05 * next());
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a place in a short list"
                )]
                let id = ids[(next() * 11.0) as usize % 11];
                if world.body(id).is_none() {
                    continue;
                }
                let done = match (next() * 6.0).floor() {
                    0.0 => world.apply(id, Impulse::central(vec2(2.0 * next() - 1.0, next()))),
                    1.0 => world.set_velocity(id, vec2(next(), 0.0), 0.0),
                    2.0 => world.remove(id),
                    3.0 => world.set_kind(id, BodyKind::Kinematic),
                    4.0 => world.set_kind(id, BodyKind::Dynamic),
                    _ => world.set_damping(id, next(), next()),
                };
                done.expect("a change that is allowed");
            }
            world.step(2.0);
            for body in world.bodies() {
                let y = body.centre().y;
                let over = body.centre().x.abs() < 28.0 && body.kind() == BodyKind::Dynamic;
                assert!(body.velocity().is_finite());
                assert!(!over || y > 0.4, "seed {seed}: through the floor, at {y} m");
            }
            let left = world.energy().residual();
            assert!(left.abs() < 1e-6, "seed {seed}: {left:e} J unaccounted for");
        }
    }
}
