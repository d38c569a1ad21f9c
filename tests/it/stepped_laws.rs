//! Stepped mode on random piles: what must hold whatever falls on what.

use carom_dynamics::{BodyDef, BodyId, Material, Settings, World};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::{block, disc, put, stepped, surface};
use proptest::prelude::*;

/// A body of a pile: place in a grid of 6 × 6, offset, size, turn, velocity, disc or box.
#[derive(Clone, Copy, Debug)]
struct Piece {
    offset: Vec2,
    size: f64,
    angle: f64,
    velocity: Vec2,
    spin: f64,
    round: bool,
    friction: f64,
    restitution: f64,
}

fn piece() -> impl Strategy<Value = Piece> {
    (
        (-0.1..0.1_f64, -0.1..0.1_f64),
        0.3..0.9_f64,
        -1.6..1.6_f64,
        (-3.0..3.0_f64, -3.0..3.0_f64),
        -3.0..3.0_f64,
        any::<bool>(),
        prop_oneof![Just(0.0), 0.0..1.2_f64],
        prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64],
    )
        .prop_map(
            |((x, y), size, angle, (vx, vy), spin, round, friction, restitution)| Piece {
                offset: vec2(x, y),
                size,
                angle,
                velocity: vec2(vx, vy),
                spin,
                round,
                friction,
                restitution,
            },
        )
}

fn pile(pieces: &[Piece]) -> World {
    let mut world = stepped(Settings {
        sleep: None,
        ..Settings::default()
    });
    let wall = Material {
        friction: 0.4,
        ..Material::default()
    };
    for (at, w, h) in [
        (vec2(0.0, -0.5), 12.0, 1.0),
        (vec2(-5.5, 48.0), 1.0, 98.0),
        (vec2(5.5, 48.0), 1.0, 98.0),
    ] {
        put(&mut world, BodyDef::fixed().at(at), block(w, h), wall);
    }
    for (k, piece) in pieces.iter().enumerate() {
        add(&mut world, k, piece);
    }
    world
}

fn add(world: &mut World, k: usize, piece: &Piece) -> BodyId {
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let cell = vec2((k % 6) as f64, (k / 6) as f64);
    let def = BodyDef::dynamic()
        .at(vec2(-3.75, 0.9) + 1.5 * cell + piece.offset)
        .turned(piece.angle)
        .moving(piece.velocity)
        .spinning(piece.spin);
    let material = Material {
        friction: piece.friction,
        restitution: piece.restitution,
        ..Material::default()
    };
    if piece.round {
        put(world, def, disc(0.5 * piece.size), material)
    } else {
        put(world, def, block(piece.size, 0.7 * piece.size), material)
    }
}

/// A pile of 29 pieces in which a lively one, thrown up by the floor, strikes another that lies between it and two
/// that fall: pieces drawn by splitmix64.
fn struck_between() -> Vec<Piece> {
    let mut state = 150 * 7919 + 13_u64;
    let mut draw = |low: f64, high: f64| {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    };
    // How many pieces there are is drawn, too.
    draw(0.0, 1.0);
    let pieces = (0..29).map(|_| Piece {
        offset: vec2(draw(-0.1, 0.1), draw(-0.1, 0.1)),
        size: draw(0.3, 0.9),
        angle: draw(-1.6, 1.6),
        velocity: vec2(draw(-3.0, 3.0), draw(-3.0, 3.0)),
        spin: draw(-3.0, 3.0),
        round: draw(0.0, 1.0) < 0.5,
        friction: if draw(0.0, 1.0) < 0.5 {
            0.0
        } else {
            draw(0.0, 1.2)
        },
        restitution: match draw(0.0, 3.0) {
            x if x < 1.0 => 0.0,
            x if x < 2.0 => 1.0,
            _ => draw(0.0, 1.0),
        },
    });
    pieces.collect()
}

/// The blow was over-relaxed: it threw the piece in between into the upper one, faster than what struck it. Then the row
/// below let go, that above kept what it had pushed, and 18 J of 360 came from nowhere.
#[test]
fn a_blow_does_not_throw_what_lies_between_two_others() {
    let mut world = pile(&struck_between());
    let first = world.energy().mechanical();
    let mut before = first;
    run(&mut world, 2.0, |world| {
        let now = world.energy().mechanical();
        assert!(
            now - before < 1e-3 * first,
            "{before} J became {now} J after {} s",
            world.time().as_secs()
        );
        before = now;
    });
}

/// No contact pushes sideways by more than its friction allows, or pulls.
fn cone_is_kept(world: &World) -> Result<(), TestCaseError> {
    for contact in world.contacts() {
        let friction = |id| {
            let body = world.body(id).expect("it is there");
            body.shapes().next().expect("a shape").1.friction
        };
        let mu: f64 = (friction(contact.a) * friction(contact.b)).sqrt();
        let pushes = contact.points.iter().map(|p| p.normal_impulse);
        prop_assert!(pushes.clone().all(|j| j >= 0.0));
        let limit = mu * pushes.sum::<f64>();
        prop_assert!(
            contact.tangent_impulse.abs() <= limit * (1.0 + 1e-12),
            "{} over {limit}",
            contact.tangent_impulse
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn energy_goes_and_the_friction_cone_is_never_left(
        pieces in prop::collection::vec(piece(), 1..36),
    ) {
        let mut world = pile(&pieces);
        let mut energies = vec![world.energy().mechanical()];
        let mut verdict = Ok(());
        run(&mut world, 6.0, |world| {
            energies.push(world.energy().mechanical());
            if verdict.is_ok() {
                verdict = cone_is_kept(world);
            }
        });
        verdict?;
        let (first, last) = (energies[0], energies[energies.len() - 1]);
        let (lost, rounding) = (first - last, 1e-12 * first);
        prop_assert!(lost >= -rounding, "{last} J of {first} are left");
        // A light body that is struck between others sinks in, and is pushed out in the next step: it gives back up to 0.23 of what
        // the step before lost, and beyond that 6e-4 of all that is lost, in 4,000 piles.
        for some in energies.windows(3) {
            let (sunk, rise) = ((some[0] - some[1]).max(0.0), some[2] - some[1]);
            prop_assert!(
                rise <= 0.5 * sunk + 0.003 * lost + rounding,
                "energy rose by {rise:.1e} J after {sunk:.1e} J were lost in a step, of {lost} J"
            );
        }
    }

    #[test]
    fn changes_at_any_instant_leave_a_pile_that_rests(
        pieces in prop::collection::vec(piece(), 8..24),
        changes in prop::collection::vec((0..4_u8, any::<prop::sample::Index>(), 0.001..0.1_f64, piece()), 1..12),
    ) {
        let mut world = pile(&pieces);
        let mut ids: Vec<BodyId> = world.bodies().map(|body| body.id()).skip(3).collect();
        world.step(0.5);
        for (k, (what, which, dt, piece)) in changes.iter().enumerate() {
            let id = ids[which.index(ids.len())];
            match what {
                0 if ids.len() > 4 => {
                    world.remove(id).expect("it is there");
                    ids.retain(|other| *other != id);
                }
                1 => ids.push(add(&mut world, 42 + k % 6, piece)),
                2 => {
                    let pose = Pose::new(vec2(3.0 * piece.offset.x * 10.0, 12.0), Rot::from_angle(piece.angle));
                    world.teleport(id, pose).expect("valid");
                }
                _ => world.set_velocity(id, piece.velocity, piece.spin).expect("valid"),
            }
            world.step(*dt);
        }
        run(&mut world, 10.0, |_| {});
        for body in world.bodies() {
            let c = body.centre();
            prop_assert!(c.x.abs() < 6.5 && c.y > -1.5, "{} at {c}", body.id());
        }
        cone_is_kept(&world)?;
    }
}

/// A load of 3,200 times their mass: the over-relaxation of its many sweeps, cut off point by point, grew to 5e7 m/s.
#[test]
fn a_heavy_blow_throws_nothing_out_faster_than_it_came() {
    let mut world = stepped(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    });
    let stone = surface(0.0, 0.6);
    let striker = BodyDef::dynamic().at(vec2(-4.3, 0.0));
    let dense = Material {
        density: 8.0,
        ..stone
    };
    put(
        &mut world,
        striker.moving(vec2(40.0, 0.0)),
        block(8.0, 8.0),
        dense,
    );
    for (i, k) in (0..20).flat_map(|i| (0..30).map(move |k| (i, k))) {
        let at = vec2(0.4 * f64::from(i), 0.4 * f64::from(k) - 5.8);
        put(
            &mut world,
            BodyDef::dynamic().at(at),
            block(0.4, 0.4),
            stone,
        );
    }
    let before = world.energy().kinetic;
    for step in 0..20 {
        world.step(1.0 / 60.0);
        let fastest = world.bodies().map(|body| body.velocity().length());
        let fastest = fastest.fold(0.0, f64::max);
        let kinetic = world.energy().kinetic;
        assert!(
            fastest < 80.0 && kinetic < before,
            "step {step}: {fastest} m/s, {kinetic} of {before} J"
        );
    }
}
