//! Stepped mode: a fast body is stopped at its time of impact.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::Polygon;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, stepped};
use carom_tests::{overlaps, run};

fn weightless(restitution: f64) -> (World, Material) {
    let world = stepped(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    });
    let material = Material {
        friction: 0.0,
        restitution,
        ..Material::default()
    };
    (world, material)
}

/// Sixteen bullets of 2 cm at a wall of 1 cm; their final velocities, and that of the wall.
fn bullets(speed: f64, restitution: f64, free: bool, each: impl Fn(f64, f64)) {
    for k in 0..16 {
        let k = f64::from(k);
        let (mut world, material) = weightless(restitution);
        let def = if free {
            BodyDef::dynamic()
        } else {
            BodyDef::fixed()
        };
        let heavy = Material {
            density: 1e5,
            ..material
        };
        let wall = put(&mut world, def, block(0.01, 4.0), heavy);
        let start = vec2(-5.0 - 0.0713 * k, 0.01 * k);
        let def = BodyDef::dynamic().at(start).moving(vec2(speed, 0.0));
        let bullet = put(&mut world, def, disc(0.02), material);
        run(&mut world, f64::max(20.0 / speed, 4.0 / 60.0), |_| {});
        let [bullet, wall] = [bullet, wall].map(|id| world.body(id).expect("it stays"));
        let ahead = wall.centre().x - bullet.centre().x;
        assert!(
            ahead > 0.0,
            "{speed} m/s: {ahead} m ahead of the wall, free {free}"
        );
        each(bullet.velocity().x, wall.velocity().x);
    }
}

#[test]
fn bullets_do_not_tunnel_and_keep_their_speed() {
    for speed in [1e2, 1e3, 1e4, 1e5] {
        bullets(speed, 0.0, false, |v, _| {
            assert!(v.abs() < 1e-8 * speed, "{speed} m/s: leaves at {v}");
        });
        bullets(speed, 1.0, false, |v, _| {
            let error = (v + speed).abs() / speed;
            assert!(error < 1e-9, "{speed} m/s: rebound is off by {error:.1e}");
        });
        // What both have together after e = 0.
        let (m, wall) = (core::f64::consts::PI * 4e-4, 4000.0);
        bullets(speed, 0.0, true, |v, w| {
            let together = m * speed / (m + wall);
            assert!((v - together).abs() < 1e-8 * speed && (w - together).abs() < 1e-8 * speed);
        });
    }
}

#[test]
fn a_swift_body_passes_where_there_is_room() {
    // Two walls with a slit between them, and a body that fits through by 2 cm on each side.
    for speed in [1e2, 1e3, 1e4] {
        let (mut world, material) = weightless(0.0);
        for y in [-1.07, 1.07] {
            put(
                &mut world,
                BodyDef::fixed().at(vec2(0.0, y)),
                block(1.0, 2.0),
                material,
            );
        }
        let def = BodyDef::dynamic()
            .at(vec2(-7.3, 0.0))
            .moving(vec2(speed, 0.0));
        let id = put(&mut world, def, disc(0.05), material);
        world.step(15.0 / speed);
        let body = world.body(id).expect("it stays");
        assert!(
            (body.centre() - vec2(7.7, 0.0)).length() < 1e-9,
            "{speed} m/s: at {}",
            body.centre()
        );
        assert_eq!(body.velocity(), vec2(speed, 0.0));
    }
}

#[test]
fn a_swift_box_slides_over_tiles_without_a_stop() {
    let mut world = stepped(Settings::default());
    let ice = Material {
        friction: 0.0,
        ..Material::default()
    };
    for i in 0..200 {
        let at = vec2(f64::from(i), -0.5);
        put(&mut world, BodyDef::fixed().at(at), block(1.0, 1.0), ice);
    }
    let def = BodyDef::dynamic()
        .at(vec2(1.0, 0.5))
        .moving(vec2(150.0, 0.0));
    let id = put(&mut world, def, block(1.0, 1.0), ice);
    run(&mut world, 1.2, |_| {});
    let body = world.body(id).expect("it stays");
    assert!(
        (body.velocity().x - 150.0).abs() < 1e-3,
        "{}",
        body.velocity()
    );
    assert!((body.centre().x - 181.0).abs() < 1e-3, "{}", body.centre());
}

#[test]
fn swift_bodies_meet_each_other() {
    for speed in [1e2, 1e4] {
        let (mut world, material) = weightless(1.0);
        let mut ids = Vec::new();
        for k in 0..10 {
            // Head on, at other places along the sub-step.
            let (y, off) = (f64::from(k), 0.37 * f64::from(k));
            for side in [-1.0, 1.0] {
                let def = BodyDef::dynamic()
                    .at(vec2(side * (10.0 + off), y))
                    .moving(vec2(-side * speed, 0.0));
                ids.push(put(&mut world, def, disc(0.05), material));
            }
        }
        run(&mut world, f64::max(40.0 / speed, 0.1), |_| {});
        for pair in ids.chunks(2) {
            let v = [pair[0], pair[1]].map(|id| world.body(id).expect("it stays").velocity());
            assert!(
                (v[0] - vec2(-speed, 0.0)).length() < 1e-9 * speed,
                "{}",
                v[0]
            );
            assert!(
                (v[1] - vec2(speed, 0.0)).length() < 1e-9 * speed,
                "{}",
                v[1]
            );
        }
    }
}

#[test]
fn a_swift_needle_and_a_plank_that_whirls_stop_at_a_wall() {
    let (mut world, material) = weightless(0.5);
    put(&mut world, BodyDef::fixed(), block(0.01, 20.0), material);
    let def = BodyDef::dynamic()
        .at(vec2(-4.0, 3.0))
        .moving(vec2(500.0, 0.0))
        .spinning(300.0);
    let needle = put(&mut world, def, block(1.0, 0.001), material);
    let def = BodyDef::dynamic()
        .at(vec2(-3.0, -3.0))
        .moving(vec2(90.0, 20.0))
        .spinning(-150.0);
    let plank = put(&mut world, def, block(2.0, 0.1), material);
    // An L: concave, of two pieces.
    let corner = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 0.2),
        (0.2, 0.2),
        (0.2, 1.0),
        (0.0, 1.0),
    ];
    let corner: Vec<Vec2> = corner.map(|(x, y)| vec2(x, y)).to_vec();
    let corner = Polygon::new(corner).expect("an L");
    let def = BodyDef::dynamic()
        .at(vec2(-8.0, 0.0))
        .moving(vec2(1000.0, 0.0))
        .spinning(40.0);
    let ell = put(&mut world, def, corner, material);
    run(&mut world, 0.5, |world| {
        for id in [needle, plank, ell] {
            let x = world.body(id).expect("it stays").centre().x;
            assert!(x < 0.0, "{id} is at {x} after {}", world.time().as_secs());
        }
    });
}

#[test]
fn shots_into_a_pile_leave_everything_inside() {
    let mut world = stepped(Settings::default());
    let material = Material {
        restitution: 0.3,
        ..Material::default()
    };
    for (at, w, h) in [
        (vec2(0.0, -0.05), 10.2, 0.1),
        (vec2(0.0, 10.05), 10.2, 0.1),
        (vec2(-5.05, 5.0), 0.1, 10.2),
        (vec2(5.05, 5.0), 0.1, 10.2),
    ] {
        put(&mut world, BodyDef::fixed().at(at), block(w, h), material);
    }
    for i in 0..40 {
        let at = vec2(f64::from(i % 8) - 3.5, 0.4 + 0.8 * f64::from(i / 8));
        put(
            &mut world,
            BodyDef::dynamic().at(at),
            block(0.7, 0.7),
            material,
        );
    }
    run(&mut world, 0.5, |_| {});
    for k in 0..10 {
        let angle = 0.6 * f64::from(k);
        let way = carom_math::Rot::from_angle(angle).x_axis();
        let def = BodyDef::dynamic()
            .at(vec2(0.0, 7.0) + 0.5 * way)
            .moving(400.0 * way);
        put(&mut world, def, disc(0.1), material);
    }
    run(&mut world, 3.0, |world| {
        for body in world.bodies() {
            let c = body.centre();
            assert!(
                c.x.abs() < 5.2 && (-0.2..10.2).contains(&c.y),
                "{} at {c} after {} s",
                body.id(),
                world.time().as_secs()
            );
        }
    });
    let (deepest, _) = overlaps(&world);
    assert!(deepest < 5e-3, "deepest overlap {deepest:.1e} m");
}
