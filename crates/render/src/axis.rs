//! Where the ticks of a chart go and what they say.

use carom_math::trig;

/// How an axis maps numbers to places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios; numbers that are not positive are left out.
    Log,
}

/// One axis of a chart: its label, its scale, its ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// How numbers are mapped.
    pub scale: Scale,
    /// First and last number; `None` takes those of the data and a little room.
    pub range: Option<(f64, f64)>,
    /// Names at 0, 1, 2, … in place of numbers; empty for numbers.
    pub names: Vec<String>,
    /// Name of a strip below an upright logarithmic axis in which 0 has its place; empty for none.
    pub floor: String,
    /// Name of a strip above an upright axis in which infinity has its place, marked by a cross; empty for none.
    pub ceiling: String,
    /// Numbers with a line across the plot and a name; those beyond the ends of the axis are left out.
    pub marks: Vec<(f64, String)>,
}

/// An axis with its ends fixed: numbers to fractions of its length, and its ticks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ruler {
    scale: Scale,
    /// Ends: the numbers themselves, or their decimal logarithms.
    low: f64,
    high: f64,
    pub(crate) ticks: Vec<Tick>,
    /// Power of ten that the labels leave out, 0 for none.
    pub(crate) exponent: i32,
}

/// A place on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    /// Fraction of the axis.
    pub(crate) at: f64,
    pub(crate) text: TickText,
}

/// What stands at a tick.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TickText {
    /// Nothing: a fine line.
    None,
    /// A number.
    Plain(String),
    /// A power of ten.
    Power(i32),
}

/// Powers of ten that a number of an axis is kept within.
const DECADES: f64 = 280.0;

impl Ruler {
    /// The axis for `numbers`, with about `count` labelled ticks and `room` (a fraction) beyond the outermost numbers.
    pub(crate) fn new(
        axis: &Axis,
        numbers: impl Iterator<Item = f64>,
        count: f64,
        room: f64,
    ) -> Self {
        if !axis.names.is_empty() {
            return Self::named(&axis.names);
        }
        let mapped = |x: f64| match axis.scale {
            Scale::Linear => (x.abs() < 1e280).then_some(x),
            Scale::Log => {
                (x > 0.0 && x.is_finite()).then(|| trig::log10(x).clamp(-DECADES, DECADES))
            }
        };
        let given = axis
            .range
            .and_then(|(low, high)| Some((mapped(low)?, mapped(high)?)))
            .filter(|(low, high)| low < high);
        let (low, high) = given.unwrap_or_else(|| {
            let ends = numbers
                .filter_map(mapped)
                .fold(None, |ends: Option<(f64, f64)>, x| match ends {
                    Some((low, high)) => Some((low.min(x), high.max(x))),
                    None => Some((x, x)),
                });
            widened(ends, axis.scale, room)
        });
        let mut ruler = Self {
            scale: axis.scale,
            low,
            high,
            ticks: Vec::new(),
            exponent: 0,
        };
        match axis.scale {
            // Less than one and a half decades: the numbers themselves say more than their powers.
            Scale::Log if high - low > 1.5 => ruler.powers(count),
            Scale::Log => ruler.ones_and_twos(),
            Scale::Linear => ruler.steps(count),
        }
        ruler
    }

    /// Names at whole numbers from 0.
    #[expect(clippy::cast_precision_loss, reason = "a count of names for the eye")]
    fn named(names: &[String]) -> Self {
        let count = names.len() as f64;
        let tick = |(index, name): (usize, &String)| Tick {
            at: (index as f64 + 0.5) / count,
            text: TickText::Plain(name.clone()),
        };
        Self {
            scale: Scale::Linear,
            low: -0.5,
            high: count - 0.5,
            ticks: names.iter().enumerate().map(tick).collect(),
            exponent: 0,
        }
    }

    /// Where a number is, as a fraction of the axis; `None` if it has no place.
    pub(crate) fn at(&self, x: f64) -> Option<f64> {
        let x = match self.scale {
            Scale::Linear => x,
            Scale::Log if x > 0.0 => trig::log10(x),
            Scale::Log => return None,
        };
        let at = (x - self.low) / (self.high - self.low);
        at.is_finite().then_some(at)
    }

    /// Ticks at multiples of 1, 2 or 5 times a power of ten.
    fn steps(&mut self, count: f64) {
        let (step, digits) = nice_step((self.high - self.low) / count);
        let largest = self.low.abs().max(self.high.abs());
        // Five digits before the point, or three zeros after it: a common power of ten is easier to read.
        let magnitude = floor_log10(largest);
        self.exponent = if (-3..=4).contains(&magnitude) {
            0
        } else {
            magnitude
        };
        let unit = power_of_ten(self.exponent);
        let decimals = usize::try_from(self.exponent - digits).unwrap_or(0).min(15);
        let first = (self.low / step - 1e-9).ceil();
        for i in 0..200_i32 {
            let x = (first + f64::from(i)) * step;
            if x > self.high + 1e-9 * step {
                break;
            }
            let text = format!("{:.decimals$}", x / unit);
            // A zero that was rounded from below has no sign.
            let zero = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
            let text = if zero { text.replace('-', "") } else { text };
            self.ticks.push(Tick {
                at: (x - self.low) / (self.high - self.low),
                text: TickText::Plain(text),
            });
        }
    }

    /// Ticks at powers of ten, every first, second, third, … one labelled; fine lines at 2 to 9 if there is room.
    fn powers(&mut self, count: f64) {
        let decades = self.high - self.low;
        let every = [1, 2, 3, 5, 10, 20, 50, 100]
            .into_iter()
            .find(|&n| decades / f64::from(n) <= count)
            .unwrap_or(100);
        let fine = every == 1 && decades <= 0.8 * count.max(4.0);
        for power in floor(self.low)..=floor(self.high + 1e-9) {
            let at = |x: f64| (x - self.low) / decades;
            let exact = at(f64::from(power));
            if exact >= -1e-9 && power.rem_euclid(every) == 0 {
                self.ticks.push(Tick {
                    at: exact,
                    text: TickText::Power(power),
                });
            }
            if !fine {
                continue;
            }
            for digit in 2..10_i32 {
                let at = at(f64::from(power) + trig::log10(f64::from(digit)));
                if (0.0..=1.0).contains(&at) {
                    self.ticks.push(Tick {
                        at,
                        text: TickText::None,
                    });
                }
            }
        }
    }

    /// Ticks at 1, 2, 3 and 5 times powers of ten, for a short logarithmic axis.
    fn ones_and_twos(&mut self) {
        for power in floor(self.low)..=floor(self.high + 1e-9) {
            for digit in 1..10_i32 {
                let x = f64::from(power) + trig::log10(f64::from(digit));
                let at = (x - self.low) / (self.high - self.low);
                if !(-1e-9..=1.0 + 1e-9).contains(&at) {
                    continue;
                }
                let text = match digit {
                    1 if power.abs() > 3 => TickText::Power(power),
                    1 | 2 | 3 | 5 if power.abs() <= 3 => TickText::Plain(digit_text(digit, power)),
                    2 | 3 | 5 => TickText::Plain(format!("{digit}e{power}")),
                    _ => TickText::None,
                };
                self.ticks.push(Tick { at, text });
            }
        }
    }
}

/// `digit` · 10^`power` without an exponent.
fn digit_text(digit: i32, power: i32) -> String {
    let decimals = usize::try_from(-power).unwrap_or(0);
    format!("{:.decimals$}", f64::from(digit) * power_of_ten(power))
}

/// Ends with room around them; something sensible if there is no number, or only one.
fn widened(ends: Option<(f64, f64)>, scale: Scale, room: f64) -> (f64, f64) {
    let Some((low, high)) = ends else {
        return (0.0, 1.0);
    };
    let span = high - low;
    // Numbers that differ by rounding only are one number.
    if span <= 1e-13 * low.abs().max(high.abs()) {
        let half = match scale {
            Scale::Log => 0.5,
            Scale::Linear if low == 0.0 => 1.0,
            Scale::Linear => 0.1 * low.abs().max(high.abs()),
        };
        return (low - half, high + half);
    }
    (low - room * span, high + room * span)
}

/// The next larger 1, 2 or 5 times a power of ten, and that power.
fn nice_step(least: f64) -> (f64, i32) {
    let power = floor_log10(least);
    let unit = power_of_ten(power);
    for factor in [1.0, 2.0, 5.0] {
        if factor * unit >= least {
            return (factor * unit, power);
        }
    }
    (10.0 * unit, power + 1)
}

fn floor_log10(x: f64) -> i32 {
    if x > 0.0 { floor(trig::log10(x)) } else { 0 }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "decimal exponents of doubles stay within ±324"
)]
fn floor(x: f64) -> i32 {
    x.floor() as i32
}

/// 10^`power`, correctly rounded: the parser's job.
fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(ruler: &Ruler) -> Vec<String> {
        ruler
            .ticks
            .iter()
            .filter_map(|tick| match &tick.text {
                TickText::None => None,
                TickText::Plain(text) => Some(text.clone()),
                TickText::Power(power) => Some(format!("^{power}")),
            })
            .collect()
    }

    fn linear(low: f64, high: f64) -> Ruler {
        Ruler::new(&Axis::default(), [low, high].into_iter(), 6.0, 0.0)
    }

    fn log(low: f64, high: f64) -> Ruler {
        let axis = Axis {
            scale: Scale::Log,
            ..Axis::default()
        };
        Ruler::new(&axis, [low, high].into_iter(), 6.0, 0.0)
    }

    #[test]
    fn labels_as_a_person_would_write_them() {
        assert_eq!(texts(&linear(0.0, 10.0)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(
            texts(&linear(-0.3, 0.3)),
            ["-0.3", "-0.2", "-0.1", "0.0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(
            texts(&linear(0.0, 60.0)),
            ["0", "10", "20", "30", "40", "50", "60"]
        );
        let tiny = linear(0.0, 4e-14);
        assert_eq!(
            (texts(&tiny), tiny.exponent),
            (["0", "1", "2", "3", "4"].map(String::from).to_vec(), -14)
        );
        let large = linear(0.0, 250_000.0);
        assert_eq!(large.exponent, 5);
        assert_eq!(texts(&large), ["0.0", "0.5", "1.0", "1.5", "2.0", "2.5"]);
        assert_eq!(
            texts(&log(1e-3, 1e2)),
            ["^-3", "^-2", "^-1", "^0", "^1", "^2"]
        );
        assert_eq!(texts(&log(1e-14, 1e2)), ["^-12", "^-9", "^-6", "^-3", "^0"]);
        assert_eq!(texts(&log(0.05, 0.5)), ["0.05", "0.1", "0.2", "0.3", "0.5"]);
    }

    #[test]
    fn no_data_and_strange_data_have_an_axis() {
        for ruler in [
            Ruler::new(&Axis::default(), core::iter::empty(), 6.0, 0.05),
            linear(f64::NAN, f64::INFINITY),
            linear(3.0, 3.0),
            linear(0.0, 0.0),
            linear(-1e300, 1e300),
            linear(1e16, 1e16 + 2.0),
            log(-1.0, 0.0),
            log(1e-320, 1e308),
            log(5.0, 5.0),
        ] {
            assert!(
                ruler.low < ruler.high && ruler.ticks.len() < 200,
                "{ruler:?}"
            );
        }
        let upside_down = Axis {
            range: Some((2.0, 1.0)),
            ..Axis::default()
        };
        assert!(Ruler::new(&upside_down, [5.0, 6.0].into_iter(), 6.0, 0.0).low >= 5.0);
    }

    proptest! {
        #[test]
        fn ticks_lie_on_the_axis_and_are_few(low in -1e6..1e6_f64, span in 1e-6..1e6_f64) {
            let ruler = linear(low, low + span);
            let count = ruler.ticks.len();
            prop_assert!((2..=8).contains(&count), "{count} ticks");
            for tick in &ruler.ticks {
                prop_assert!((-1e-6..=1.0 + 1e-6).contains(&tick.at), "{}", tick.at);
            }
            let mut texts = texts(&ruler);
            texts.dedup();
            prop_assert!(span < 1e-9 * low.abs() || texts.len() == count, "{texts:?}");
        }

        #[test]
        fn numbers_lie_where_their_ticks_are(low in 1e-9..1.0_f64, ratio in 100.0..1e9_f64) {
            let ruler = log(low, low * ratio);
            prop_assert!(ruler.at(low).unwrap().abs() < 1e-12);
            prop_assert!((ruler.at(low * ratio).unwrap() - 1.0).abs() < 1e-12);
            prop_assert!((ruler.at(low * ratio.sqrt()).unwrap() - 0.5).abs() < 1e-12);
            prop_assert_eq!(ruler.at(0.0), None);
        }
    }
}
