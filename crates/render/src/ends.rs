//! Names beside the ends of curves, apart from each other.

use carom_math::{Vec2, vec2};

use crate::{Frame, Ink, Label, Op, Series, font};

/// Height of capitals, and of a line with its room, in pixels.
const SMALL: f64 = 8.5;
const LINE: f64 = 15.0;
/// Room between the plot and the names, which the leaders cross, in pixels.
const LEADER: f64 = 16.0;

/// Room that names take beside the plot, in pixels.
pub(crate) fn room<'a>(series: impl Iterator<Item = &'a Series>) -> f64 {
    let widths = series
        .filter(|series| !series.name.is_empty())
        .map(|series| font::width(&series.name, SMALL));
    widths.fold(0.0, |widest: f64, width| widest.max(LEADER + width))
}

/// A name, and where its curve ends.
pub(crate) struct End<'a> {
    pub(crate) name: &'a str,
    pub(crate) ink: Ink,
    pub(crate) at: Vec2,
}

/// Draws names right of `edge`, between `top` and `foot`, each as near to the height of its curve's end as the others let it.
pub(crate) fn draw(mut ends: Vec<End<'_>>, edge: f64, top: f64, foot: f64, frame: &mut Frame) {
    ends.sort_by(|a, b| a.at.y.total_cmp(&b.at.y));
    let wanted: Vec<f64> = ends.iter().map(|end| end.at.y).collect();
    for (end, y) in ends.iter().zip(apart(&wanted, top, foot)) {
        let start = vec2(edge + LEADER, y);
        frame.push(Op::Line {
            points: vec![end.at, vec2(edge, y), start - vec2(4.0, 0.0)],
            width: 0.75,
            dash: Some(2.0),
            ink: end.ink,
        });
        let label = Label::new(start, end.name, SMALL, end.ink).anchored(0.0, 0.5);
        frame.push(label);
    }
}

/// Heights at least a line apart and in the order of those wanted (which are sorted), nearest to them in least squares.
fn apart(wanted: &[f64], top: f64, foot: f64) -> Vec<f64> {
    // With y_i = z_i + i LINE the z need only not decrease: isotonic regression, by pooling neighbours that do.
    let mut pools: Vec<(f64, u32)> = Vec::new();
    let mut shift = 0.0;
    for y in wanted {
        let mut pool = (y - shift, 1);
        while let Some(&(sum, count)) = pools.last()
            && sum / f64::from(count) > pool.0 / f64::from(pool.1)
        {
            pools.pop();
            pool = (pool.0 + sum, pool.1 + count);
        }
        pools.push(pool);
        shift += LINE;
    }
    let mut places = Vec::with_capacity(wanted.len());
    let highest = (foot - shift + LINE).max(top);
    shift = 0.0;
    for (sum, count) in pools {
        for _ in 0..count {
            places.push((sum / f64::from(count)).clamp(top, highest) + shift);
            shift += LINE;
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn names_keep_their_height_unless_they_would_overlap() {
        assert_eq!(apart(&[10.0, 60.0], 0.0, 100.0), [10.0, 60.0]);
        assert_eq!(apart(&[50.0, 50.0], 0.0, 100.0), [42.5, 57.5]);
        assert_eq!(apart(&[98.0, 99.0], 0.0, 100.0), [85.0, 100.0]);
        assert_eq!(apart(&[], 0.0, 100.0), []);
    }

    proptest! {
        #[test]
        fn names_lie_a_line_apart_in_their_order(mut wanted in prop::collection::vec(0.0..200.0_f64, 0..9)) {
            wanted.sort_by(f64::total_cmp);
            let places = apart(&wanted, 0.0, 200.0);
            prop_assert_eq!(places.len(), wanted.len());
            for pair in places.windows(2) {
                prop_assert!(pair[1] - pair[0] >= LINE - 1e-9, "{places:?}");
            }
            for y in places {
                prop_assert!((-1e-9..=200.0 + 1e-9).contains(&y), "{y}");
            }
        }
    }
}
