//! Steps scenes of boxes and prints time and error: ms a tick (thread CPU time), overlap, hum.
//!
//! `cargo run --release -p carom-stepped --example pyramid -- [all|a|e|b|c|d|g|plain|pile|thousand|heaps] [fast|default|accurate|world] [four]`

use carom_geometry::{ConvexPolygon, Polygon, Segment};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_stepped::{BodyId, BodyInput, Engine, Material, PieceInput, Settings, Softness};
use rustix::time::{ClockId, clock_gettime};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "all".into());
    let preset = arguments.next().unwrap_or_else(|| "default".into());
    let four = arguments.next().is_some();
    let settings = match preset.as_str() {
        "fast" => Settings::fast(),
        "accurate" => Settings::accurate(),
        "world" => as_the_world(),
        _ => Settings::default(),
    };
    let settings = Settings {
        sleep: None,
        ..settings
    };
    if scene == "heaps" {
        return heaps(settings);
    }
    println!(
        "{:<9} {:>6} {:>8} {:>9} {:>8} {:>8} {:>9} {:>9} {:>9} {:>8}",
        "scene",
        "bodies",
        "contacts",
        "first ms",
        "ms/tick",
        "worst",
        "max mm",
        "mean mm",
        "hum m/s²",
        "v m/s"
    );
    let scenes: [(&str, Build, u32, u32); 10] = [
        ("a", large_pyramid, 50, 300),
        ("e", bouncing_pyramid, 50, 300),
        ("b", many_pyramids, 30, 120),
        ("c", smash, 75, 225),
        ("d", tumbler, 200, 300),
        ("g", concave_pile, 300, 200),
        ("g2", concave_pile, 1000, 500),
        ("plain", plain_pile, 300, 200),
        ("pile", falling_pile, 0, 240),
        ("thousand", thousand_boxes, 0, 240),
    ];
    for (name, build, skipped, ticks) in scenes {
        if scene == "all" || scene == name {
            let mut engine = build(settings)?;
            if four {
                engine.hold_to_four_lanes();
            }
            measure(name, engine, skipped, ticks)?;
        }
    }
    Ok(())
}

/// What `carom-dynamics` asks for.
fn as_the_world() -> Settings {
    let accurate = Settings::accurate();
    let softness = Softness {
        frequency: 45.0,
        ..accurate.softness
    };
    Settings {
        softness,
        ..accurate
    }
}

type Build = fn(Settings) -> Outcome<Engine>;

/// 5,050 boxes of 1 m in a hundred rows, all touching.
fn large_pyramid(settings: Settings) -> Outcome<Engine> {
    let mut engine = Engine::new(settings)?;
    let ground = PieceInput::new(ConvexPolygon::rectangle(200.0, 2.0)?);
    engine.insert(BodyInput::fixed().at(vec2(0.0, -1.0)), &[ground])?;
    pyramid(&mut engine, 100, vec2(-49.5, 0.0), 0.0)?;
    Ok(engine)
}

/// The same with a restitution of 0.3.
fn bouncing_pyramid(settings: Settings) -> Outcome<Engine> {
    let mut engine = Engine::new(settings)?;
    let ground = PieceInput::new(ConvexPolygon::rectangle(200.0, 2.0)?);
    engine.insert(BodyInput::fixed().at(vec2(0.0, -1.0)), &[ground])?;
    pyramid(&mut engine, 100, vec2(-49.5, 0.0), 0.3)?;
    Ok(engine)
}

/// 400 pyramids of ten rows on twenty floors without thickness.
fn many_pyramids(settings: Settings) -> Outcome<Engine> {
    let mut engine = Engine::new(settings)?;
    for floor in 0..20 {
        let y = 11.0 * f64::from(floor);
        let ground = Segment::new(vec2(-110.0, y), vec2(110.0, y))?;
        engine.insert(BodyInput::fixed(), &[PieceInput::new(ground)])?;
        for i in 0..20 {
            pyramid(&mut engine, 10, vec2(-109.0 + 11.0 * f64::from(i), y), 0.0)?;
        }
    }
    Ok(engine)
}

fn pyramid(engine: &mut Engine, rows: u32, corner: Vec2, restitution: f64) -> Outcome<()> {
    let surface = Material {
        restitution,
        ..Material::default()
    };
    let square = [PieceInput::new(ConvexPolygon::square(1.0)?).with_material(surface)];
    for row in 0..rows {
        for k in 0..rows - row {
            let x = corner.x + f64::from(k) + 0.5 * f64::from(row);
            let at = vec2(x, corner.y + 0.5 + f64::from(row));
            engine.insert(BodyInput::dynamic(1.0, 1.0 / 6.0).at(at), &square)?;
        }
    }
    Ok(())
}

/// A heavy box of 8 m is shot into 9,600 boxes of 0.4 m, without gravity.
fn smash(settings: Settings) -> Outcome<Engine> {
    let mut engine = Engine::new(Settings {
        gravity: Vec2::ZERO,
        ..settings
    })?;
    let heavy = ConvexPolygon::square(8.0)?;
    let mass = 8.0 * 64.0;
    let bullet = BodyInput::dynamic(mass, mass * 64.0 / 6.0).at(vec2(-20.0, 0.0));
    engine.insert(
        bullet.moving(vec2(40.0, 0.0), 0.0),
        &[PieceInput::new(heavy)],
    )?;
    let square = ConvexPolygon::square(0.4)?;
    for column in 0..120 {
        for row in 0..80 {
            let at = vec2(30.0 + 0.4 * f64::from(column), 0.4 * f64::from(row - 40));
            drop(&mut engine, &square, at)?;
        }
    }
    Ok(engine)
}

/// 2,025 boxes of 0.25 m in a drum of 20 m that turns by 25° a second.
fn tumbler(settings: Settings) -> Outcome<Engine> {
    let mut engine = Engine::new(settings)?;
    let spin = 25.0 * core::f64::consts::PI / 180.0;
    let drum = BodyInput::kinematic()
        .at(vec2(0.0, 10.0))
        .moving(Vec2::ZERO, spin);
    let mut walls = Vec::new();
    for (x, y, w, h) in [
        (10.0, 0.0, 1.0, 20.0),
        (-10.0, 0.0, 1.0, 20.0),
        (0.0, 10.0, 20.0, 1.0),
        (0.0, -10.0, 20.0, 1.0),
    ] {
        walls.push(PieceInput::new(
            ConvexPolygon::rectangle(w, h)?.translated(vec2(x, y)),
        ));
    }
    engine.insert(drum, &walls)?;
    let square = ConvexPolygon::square(0.25)?;
    for row in 0..45 {
        for column in 0..45 {
            let at = vec2(-9.0 + 0.4 * f64::from(column), 1.0 + 0.4 * f64::from(row));
            drop(&mut engine, &square, at)?;
        }
    }
    Ok(engine)
}

/// 800 concave L, U and stars that fall into a bin.
fn concave_pile(settings: Settings) -> Outcome<Engine> {
    letters(settings, |ring, _| {
        Ok(vec![PieceInput::new(Polygon::new(ring.to_vec())?)])
    })
}

/// The same of convex pieces that know nothing of each other.
fn plain_pile(settings: Settings) -> Outcome<Engine> {
    letters(settings, |_, pieces| {
        let piece = |piece: &Vec<Vec2>| Ok(PieceInput::new(ConvexPolygon::new(piece.clone())?));
        pieces.iter().map(piece).collect()
    })
}

fn letters(
    settings: Settings,
    make: impl Fn(&[Vec2], &[Vec<Vec2>]) -> Outcome<Vec<PieceInput>>,
) -> Outcome<Engine> {
    let mut engine = bin(settings, 40.0)?;
    for i in 0..800u32 {
        let at = vec2(
            f64::from(i % 22) * 1.75 - 18.375,
            1.5 + 1.75 * f64::from(i / 22),
        );
        let angle = 2.399_963 * f64::from(i);
        let size = 0.9 + 0.4 * (0.618_034 * f64::from(i)).fract();
        let (h, t) = (size / 2.0, size / 6.0);
        let rectangle =
            |x0, y0, x1, y1| vec![vec2(x0, y0), vec2(x1, y0), vec2(x1, y1), vec2(x0, y1)];
        let corners = |ring: &[(f64, f64)]| ring.iter().map(|(x, y)| vec2(*x, *y)).collect();
        let (ring, pieces): (Vec<Vec2>, Vec<Vec<Vec2>>) = match i % 3 {
            0 => (
                corners(&[(-h, -h), (h, -h), (h, -t), (-t, -t), (-t, h), (-h, h)]),
                vec![rectangle(-h, -h, h, -t), rectangle(-h, -t, -t, h)],
            ),
            1 => {
                let t = 0.2 * size;
                (
                    corners(&u_shape(size)),
                    vec![
                        rectangle(-h, -h, h, -t),
                        rectangle(-h, -t, -t, h),
                        rectangle(t, -t, h, h),
                    ],
                )
            }
            _ => {
                let ring: Vec<Vec2> = (0..10u32)
                    .map(|k| {
                        let radius = [h, 0.45 * h][k as usize % 2];
                        let angle = core::f64::consts::PI * f64::from(k) / 5.0;
                        Rot::from_angle(angle) * vec2(radius, 0.0)
                    })
                    .collect();
                let inner = ring.iter().skip(1).step_by(2).copied().collect();
                let mut pieces = vec![inner];
                pieces.extend(
                    (0..10)
                        .step_by(2)
                        .map(|k| vec![ring[k], ring[k + 1], ring[(k + 9) % 10]]),
                );
                (ring, pieces)
            }
        };
        let area = Polygon::new(ring.clone())?
            .area_properties()
            .with_density(1.0);
        let about = |points: &[Vec2]| {
            points
                .iter()
                .map(|p| *p - area.centroid)
                .collect::<Vec<_>>()
        };
        let pieces: Vec<Vec<Vec2>> = pieces.iter().map(|piece| about(piece)).collect();
        let mut body = BodyInput::dynamic(area.mass, area.inertia);
        body.pose = Pose::new(at, Rot::from_angle(angle));
        engine.insert(body, &make(&about(&ring), &pieces)?)?;
    }
    Ok(engine)
}

/// 2,000 boxes, triangles and hexagons that fall into a bin.
fn falling_pile(settings: Settings) -> Outcome<Engine> {
    let mut engine = bin(settings, 20.0)?;
    let shapes = [
        ConvexPolygon::square(0.8)?,
        ConvexPolygon::regular(3, 0.5)?,
        ConvexPolygon::regular(6, 0.45)?,
    ];
    for k in 0..2000u32 {
        let (column, row) = (f64::from(k % 16), f64::from(k / 16));
        let at = vec2(-9.0 + 1.2 * column + 0.1 * (row % 3.0), 1.0 + 1.2 * row);
        drop(&mut engine, &shapes[k as usize % 3], at)?;
    }
    Ok(engine)
}

/// 1,000 boxes that fall into a bin.
fn thousand_boxes(settings: Settings) -> Outcome<Engine> {
    let mut engine = bin(settings, 12.0)?;
    let square = ConvexPolygon::square(0.5)?;
    for k in 0..1000u32 {
        let (column, row) = (f64::from(k % 20), f64::from(k / 20));
        drop(
            &mut engine,
            &square,
            vec2(-5.4 + 0.55 * column + 0.02 * (row % 5.0), 0.5 + 0.6 * row),
        )?;
    }
    Ok(engine)
}

fn bin(settings: Settings, width: f64) -> Outcome<Engine> {
    let mut engine = Engine::new(settings)?;
    let walls = [
        (0.0, -0.5, width + 2.0, 1.0),
        (-0.5 * width - 0.5, 100.0, 1.0, 201.0),
        (0.5 * width + 0.5, 100.0, 1.0, 201.0),
    ];
    for (x, y, w, h) in walls {
        let wall = PieceInput::new(ConvexPolygon::rectangle(w, h)?);
        engine.insert(BodyInput::fixed().at(vec2(x, y)), &[wall])?;
    }
    Ok(engine)
}

fn drop(engine: &mut Engine, shape: &ConvexPolygon, at: Vec2) -> Outcome<BodyId> {
    let area = shape.area_properties().with_density(1.0);
    let body = BodyInput::dynamic(area.mass, area.inertia).at(at);
    Ok(engine.insert(body, &[PieceInput::new(shape.clone())])?)
}

/// Steps a scene; skipped ticks are the first ones, which are not measured.
fn measure(name: &str, mut engine: Engine, skipped: u32, ticks: u32) -> Outcome<()> {
    let ids: Vec<BodyId> = engine.bodies().collect();
    let first = timed(|| engine.tick());
    for _ in 1..skipped {
        engine.tick();
    }
    let (mut sum, mut worst, mut times) = (0.0, 0.0f64, Vec::new());
    let (mut deepest, mut depth, mut count) = (0.0f64, 0.0, 0.0);
    let mut hum = 0.0;
    for k in 0..ticks {
        let last = k + 1 == ticks;
        let before = if last {
            velocities(&engine, &ids)?
        } else {
            Vec::new()
        };
        let time = timed(|| engine.tick());
        (sum, worst) = (sum + time, worst.max(time));
        times.push(time);
        if k % 25 == 24 {
            for contact in engine.contacts() {
                let gap = contact.gaps[..contact.points]
                    .iter()
                    .fold(f64::INFINITY, |a, b| a.min(*b));
                deepest = deepest.max(-gap);
                (depth, count) = if gap < 0.0 {
                    (depth - gap, count + 1.0)
                } else {
                    (depth, count)
                };
            }
        }
        if last {
            let after = velocities(&engine, &ids)?;
            hum = hum_of(&before, &after, engine.settings().tick);
        }
    }
    let speed = velocities(&engine, &ids)?
        .iter()
        .map(|v| v.length_squared())
        .sum::<f64>();
    let speed = (speed / ids.len() as f64).sqrt();
    println!(
        "{name:<9} {:>6} {:>8} {:>9.2} {:>8.3} {:>8.2} {:>9.2} {:>9.3} {hum:>9.2e} {speed:>8.1e}",
        ids.len(),
        engine.contact_count(),
        1e3 * first,
        1e3 * sum / f64::from(ticks),
        1e3 * worst,
        1e3 * deepest,
        1e3 * depth / count,
    );
    Ok(())
}

fn velocities(engine: &Engine, ids: &[BodyId]) -> Outcome<Vec<Vec2>> {
    let mut list = Vec::new();
    for id in ids {
        list.push(engine.velocity(*id)?.0);
    }
    Ok(list)
}

/// Thread CPU time of a call, in s.
fn timed(call: impl FnOnce()) -> f64 {
    let now = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    };
    let start = now();
    call();
    now() - start
}

/// Corners of a U as wide as it is high.
fn u_shape(size: f64) -> [(f64, f64); 8] {
    let (h, t) = (size / 2.0, 0.2 * size);
    [
        (-h, -h),
        (h, -h),
        (h, h),
        (t, h),
        (t, -t),
        (-t, -t),
        (-t, h),
        (-h, h),
    ]
}

/// Root mean square of accelerations between two ticks, in m/s².
fn hum_of(before: &[Vec2], after: &[Vec2], tick: f64) -> f64 {
    let squares = before
        .iter()
        .zip(after)
        .map(|(b, a)| (*a - *b).length_squared());
    (squares.sum::<f64>() / before.len() as f64).sqrt() / tick
}

/// How many of 160 heaps of bodies like a U still move.
fn heaps(settings: Settings) -> Outcome<()> {
    let mut lively = [0; 3];
    for k in 0..160 {
        let mut engine = heap(settings, k)?;
        let ids: Vec<BodyId> = engine.bodies().skip(3).collect();
        for (lively, ticks) in lively.iter_mut().zip([600, 300, 900]) {
            for _ in 0..ticks {
                engine.tick();
            }
            let before = velocities(&engine, &ids)?;
            engine.tick();
            let hum = hum_of(&before, &velocities(&engine, &ids)?, engine.settings().tick);
            *lively += i32::from(hum > 5e-3 * 9.81);
        }
    }
    println!("of 160 heaps hum by more than 5e-3 g after 10, 15, 30 s: {lively:?}");
    Ok(())
}

/// 120 bodies like a U that fall into a bin.
fn heap(settings: Settings, k: u32) -> Outcome<Engine> {
    let mut engine = bin(settings, 12.0)?;
    for i in 0..120 {
        let size = 0.9 + 0.4 * (0.618_034 * f64::from(i + 100 * k)).fract();
        let ring = Polygon::new(u_shape(size).map(|(x, y)| vec2(x, y)))?;
        let mass = ring.area_properties().with_density(1.0);
        let mut body = BodyInput::dynamic(mass.mass, mass.inertia);
        let at = vec2(f64::from(i % 6) * 1.9 - 4.75, 1.5 + 1.9 * f64::from(i / 6));
        body.pose = Pose::new(at, Rot::from_angle(2.399_963 * f64::from(i + 7 * k)));
        engine.insert(body, &[PieceInput::new(ring)])?;
    }
    Ok(engine)
}
