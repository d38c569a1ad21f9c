//! What a sweep varies: `KEY=from:to:count`, or `KEY=` and a list of values with commas.

use std::collections::BTreeSet;
use std::ops::Range;
use std::str::FromStr;

use crate::number::number;
use crate::values::KeyValue;

/// Most runs of a sweep: a row each makes some hundred gigabytes of this.
const MOST: u64 = 1_000_000_000;

/// Most values of a range: they are held as they are written.
const LONGEST: u32 = 1_000_000;

/// One key of a scene and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// A key as `--set` knows it.
    pub key: String,
    /// Its values, as `--set` takes them.
    pub values: Vec<String>,
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let KeyValue { key, value } = text.parse()?;
        let values = match range(&value)? {
            Some(values) => values,
            None => list(&value),
        };
        Ok(Self { key, values })
    }
}

/// `from:to:count`: so many numbers at equal distances, both ends included.
fn range(text: &str) -> Result<Option<Vec<String>>, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, count] = parts[..] else {
        return Ok(None);
    };
    let (Ok(from), Ok(to)) = (from.trim().parse::<f64>(), to.trim().parse::<f64>()) else {
        return Ok(None);
    };
    let count: u32 = match count.trim().parse() {
        Ok(count) if (1..=LONGEST).contains(&count) => count,
        _ => return Err(format!("{count:?} is no number of values, 1 to {LONGEST}")),
    };
    if !from.is_finite() || !to.is_finite() {
        return Err("a range from or to what is not finite".to_owned());
    }
    if !(to - from).is_finite() {
        return Err("a range wider than any finite number".to_owned());
    }
    let last = count.max(2) - 1;
    // The last one is as it was written; the others are rounded twice.
    let value = |k: u32| {
        number(if k == last {
            to
        } else {
            from + (to - from) * f64::from(k) / f64::from(last)
        })
    };
    Ok(Some((0..count).map(value).collect()))
}

/// Values between the commas that are in no brackets and no quotes.
fn list(text: &str) -> Vec<String> {
    let (mut depth, mut quote, mut values) = (0_i32, None, vec![String::new()]);
    for letter in text.chars() {
        match (letter, quote) {
            ('"' | '\'', None) => quote = Some(letter),
            (_, Some(open)) if letter == open => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth == 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(letter);
        }
    }
    values.iter().map(|value| value.trim().to_owned()).collect()
}

/// How many runs all combinations are, each with so many seeds.
pub(super) fn runs(axes: &[Axis], seeds: u64) -> Result<u64, String> {
    let counts = axes.iter().map(|axis| axis.values.len() as u64);
    let all = counts.chain([seeds]).try_fold(1_u64, u64::checked_mul);
    all.filter(|all| *all <= MOST)
        .ok_or_else(|| format!("more than {MOST} runs"))
}

/// The values of run `k`, one of each axis, and its seed: the last axis changes faster than the first, and seeds fastest.
pub(super) fn values(axes: &[Axis], seeds: u64, k: u64) -> (Vec<&str>, u64) {
    let (mut rest, seed) = (k / seeds, k % seeds);
    let mut chosen = Vec::with_capacity(axes.len());
    for axis in axes.iter().rev() {
        let count = axis.values.len() as u64;
        let place = usize::try_from(rest % count).unwrap_or(0);
        chosen.push(axis.values[place].as_str());
        rest /= count;
    }
    chosen.reverse();
    (chosen, seed)
}

/// Runs of these that have each value of each axis that occurs in them, in order: the first one, and those where a value changes.
pub(super) fn samples(axes: &[Axis], seeds: u64, runs: &Range<u64>) -> BTreeSet<u64> {
    let mut samples = BTreeSet::from([runs.start]);
    // So many runs in a row have one value.
    let mut stride = seeds;
    for axis in axes.iter().rev() {
        let count = axis.values.len() as u64;
        let first = runs.start.next_multiple_of(stride);
        let changes = (0..count).map(|k| first + k * stride);
        samples.extend(changes.take_while(|run| *run < runs.end));
        stride *= count;
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> Axis {
        text.parse().unwrap()
    }

    #[test]
    fn ranges_and_lists_are_read() {
        assert_eq!(axis("body.ball.mass=1:10:4").values, ["1", "4", "7", "10"]);
        assert_eq!(axis("n=3:9:1").values, ["3"]);
        let gravity = axis("gravity=[0,-9.81],[0,-1.62]");
        assert_eq!(gravity.values, ["[0,-9.81]", "[0,-1.62]"]);
        assert_eq!(axis("name='a,b',c").values, ["'a,b'", "c"]);
        assert!("n=1:2:0".parse::<Axis>().is_err());
        assert!("n".parse::<Axis>().is_err());
        assert!("n=-1e308:1e308:3".parse::<Axis>().is_err());
    }

    #[test]
    fn runs_are_all_combinations_in_order() {
        let axes = [axis("a=1,2"), axis("b=x,y,z")];
        assert_eq!(runs(&axes, 2), Ok(12));
        let all: Vec<_> = (0..12).map(|k| values(&axes, 2, k)).collect();
        assert_eq!(all[0], (vec!["1", "x"], 0));
        assert_eq!(all[1], (vec!["1", "x"], 1));
        assert_eq!(all[11], (vec!["2", "z"], 1));
        assert!("a=1:2:4000000000".parse::<Axis>().is_err());
        assert!(runs(&[axis("a=1:2:1000000")], 10_000).is_err());
    }

    #[test]
    fn samples_have_every_value_that_the_runs_have() {
        let axes = [axis("a=1,2,3"), axis("b=x,y"), axis("c=1,2,3,4")];
        let all = 5 * runs(&axes, 1).unwrap();
        for (start, end) in [(0, all), (0, 1), (7, 8), (3, 50), (59, all), (38, 44)] {
            let of = |runs: &mut dyn Iterator<Item = u64>| {
                let chosen = runs.flat_map(|k| values(&axes, 5, k).0.into_iter().enumerate());
                chosen.collect::<BTreeSet<_>>()
            };
            let samples = samples(&axes, 5, &(start..end));
            assert!(samples.len() <= 1 + 3 + 2 + 4);
            assert_eq!(
                of(&mut samples.into_iter()),
                of(&mut (start..end)),
                "{start}..{end}"
            );
        }
    }
}
