//! The slow twin: every combination of modes of a few touches, tried one by one.

use super::{ImpactBody, Touch};
use carom_math::{Vec2, cross, perp};

/// Accelerations `(x, y, angle)` of every body, for every combination of modes that meets all conditions.
///
/// `slides`: sign of the slip of each touch, 0 where there is none yet.
pub(super) fn all_balances(
    (bodies, pulls): (&[ImpactBody], &[(Vec2, f64)]),
    touches: &[Touch],
    slides: &[f64],
) -> Vec<Vec<f64>> {
    let points: Vec<(usize, usize)> = touches
        .iter()
        .enumerate()
        .flat_map(|(i, touch)| (0..touch.points.len()).map(move |k| (i, k)))
        .collect();
    let mut found = Vec::new();
    for closed in 0..1_u32 << points.len() {
        for mut code in 0..3_u32.pow(u32::try_from(touches.len()).expect("few")) {
            let modes: Vec<u32> = touches
                .iter()
                .map(|_| {
                    let mode = code % 3;
                    code /= 3;
                    mode
                })
                .collect();
            let fits = |(mode, (touch, slide)): (&u32, (&Touch, &f64))| {
                (touch.friction > 0.0 && *slide == 0.0) || *mode == 0
            };
            if modes.iter().zip(touches.iter().zip(slides)).all(fits) {
                found.extend(one(
                    (bodies, pulls),
                    touches,
                    slides,
                    &points,
                    closed,
                    &modes,
                ));
            }
        }
    }
    found
}

/// One combination. Modes: 0 as the slip says (or holds), 1 and 2 begins to slip up or down.
fn one(
    (bodies, pulls): (&[ImpactBody], &[(Vec2, f64)]),
    touches: &[Touch],
    slides: &[f64],
    points: &[(usize, usize)],
    closed: u32,
    modes: &[u32],
) -> Option<Vec<f64>> {
    let holds = |i: usize| touches[i].friction > 0.0 && slides[i] == 0.0 && modes[i] == 0;
    let sign = |i: usize| match modes[i] {
        1 => 1.0,
        2 => -1.0,
        _ => slides[i],
    };
    // Unknowns: 3 accelerations a body, a force a point, a friction a touch that holds.
    let size = 3 * bodies.len();
    let held: Vec<usize> = (0..touches.len()).filter(|&i| holds(i)).collect();
    let n = size + points.len() + held.len();
    let mut a = vec![vec![0.0; n]; n];
    let mut x = vec![0.0; n];
    for (k, body) in bodies.iter().enumerate() {
        for c in 0..3 {
            a[3 * k + c][3 * k + c] = 1.0;
            x[3 * k + c] = if body.inverse_mass == 0.0 {
                0.0
            } else {
                [pulls[k].0.x, pulls[k].0.y, pulls[k].1][c]
            };
        }
    }
    let push =
        |a: &mut Vec<Vec<f64>>, touch: &Touch, point: Vec2, along: Vec2, column: usize, by: f64| {
            for (place, side) in [(touch.bodies.0, -by), (touch.bodies.1, by)] {
                let body = &bodies[place];
                a[3 * place][column] -= side * along.x * body.inverse_mass;
                a[3 * place + 1][column] -= side * along.y * body.inverse_mass;
                a[3 * place + 2][column] -=
                    side * cross(point - body.centre, along) * body.inverse_inertia;
            }
        };
    for (j, &(i, k)) in points.iter().enumerate() {
        let (touch, column) = (&touches[i], size + j);
        if closed >> j & 1 == 0 {
            a[column][column] = 1.0;
            continue;
        }
        push(&mut a, touch, touch.points[k], touch.normal, column, 1.0);
        if !holds(i) {
            push(
                &mut a,
                touch,
                touch.points[k],
                perp(touch.normal),
                column,
                -sign(i) * touch.friction,
            );
        }
        rate_row(bodies, &mut a[column], touch, touch.points[k], touch.normal);
    }
    for (j, &i) in held.iter().enumerate() {
        let (touch, column) = (&touches[i], size + points.len() + j);
        let mut own = points.iter().enumerate().filter(|(_, point)| point.0 == i);
        if !own.any(|(p, _)| closed >> p & 1 == 1) {
            a[column][column] = 1.0;
            continue;
        }
        push(
            &mut a,
            touch,
            touch.points[0],
            perp(touch.normal),
            column,
            1.0,
        );
        rate_row(
            bodies,
            &mut a[column],
            touch,
            touch.points[0],
            perp(touch.normal),
        );
    }
    let x = eliminate(a, x)?;
    let rate = |i: usize, k: usize, along: Vec2| {
        let mut row = vec![0.0; n];
        rate_row(bodies, &mut row, &touches[i], touches[i].points[k], along);
        row.iter().zip(&x).map(|(r, x)| r * x).sum::<f64>()
    };
    let tolerance = 1e-8;
    let mut loads = vec![0.0; touches.len()];
    for (j, &(i, k)) in points.iter().enumerate() {
        loads[i] += x[size + j];
        if x[size + j] < -tolerance || rate(i, k, touches[i].normal) < -tolerance {
            return None;
        }
    }
    for (j, &i) in held.iter().enumerate() {
        if x[size + points.len() + j].abs() > touches[i].friction * loads[i] + tolerance {
            return None;
        }
    }
    for (i, touch) in touches.iter().enumerate() {
        let begins = modes[i] != 0;
        if begins && sign(i) * rate(i, 0, perp(touch.normal)) < -tolerance {
            return None;
        }
    }
    Some(x[..size].to_vec())
}

fn rate_row(bodies: &[ImpactBody], row: &mut [f64], touch: &Touch, point: Vec2, along: Vec2) {
    for (place, side) in [(touch.bodies.0, -1.0), (touch.bodies.1, 1.0)] {
        row[3 * place] = side * along.x;
        row[3 * place + 1] = side * along.y;
        row[3 * place + 2] = side * cross(point - bodies[place].centre, along);
    }
}

fn eliminate(mut a: Vec<Vec<f64>>, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let n = x.len();
    for k in 0..n {
        let best = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        if a[best][k].abs() < 1e-9 {
            return None;
        }
        a.swap(k, best);
        x.swap(k, best);
        let pivot = a[k].clone();
        for i in 0..n {
            if i != k && a[i][k] != 0.0 {
                let factor = a[i][k] / pivot[k];
                for (to, from) in a[i].iter_mut().zip(&pivot) {
                    *to -= factor * from;
                }
                x[i] -= factor * x[k];
            }
        }
    }
    Some((0..n).map(|k| x[k] / a[k][k]).collect())
}
