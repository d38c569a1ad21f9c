//! Zeno series: impacts that come ever faster, and their accumulation point from the times of the last ones.

use carom_math::SimTime;

/// Limits that differ by less, in s, are one: ten times what small bounces lose.
const AGREES: f64 = 1e-9;

/// What is left of the longest interval of a series with each impact that nothing presses: where several bodies come to
/// rest against each other, short and long intervals take turns, and only whole rounds come ever faster.
const FADES: f32 = 0.9;

/// The last impacts of a body, while they come ever faster: a Zeno series.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ZenoSeries {
    last: SimTime,
    /// Seconds between the last five impacts, the latest first.
    gaps: [f64; 4],
    /// Speed of approach of the first, in m/s.
    top: f64,
    /// Seconds of the longest interval, less what has faded: rounded, since it is only compared.
    longest: f32,
    /// Impacts so far, if they are few.
    count: u8,
    /// Accumulation point as the first impact predicted it.
    predicted: SimTime,
    /// Its end has been reported.
    ended: bool,
}

impl Default for ZenoSeries {
    fn default() -> Self {
        Self {
            last: SimTime::ZERO,
            gaps: [f64::INFINITY; 4],
            top: 0.0,
            longest: 0.0,
            count: 0,
            predicted: SimTime::ZERO,
            ended: false,
        }
    }
}

impl ZenoSeries {
    /// Impacts of a series before it is taken for one: two pairs of intervals.
    const LEAST: u8 = 5;

    /// An impact at `time` with an approach of `speed` m/s, after which, were it all that ever acts,
    /// bounces would last for `left` seconds. A Zeno series ends where an impact is stronger than the
    /// first, or an interval twice as long as the last one; where nothing presses (`left` is 0), as the longest lately.
    pub(crate) fn hit(&mut self, time: SimTime, speed: f64, left: f64) {
        let gap = time - self.last;
        let late = self.count > 1 && gap > 2.0 * f64::from(self.longest);
        if self.count == 0 || late || speed > self.top {
            *self = Self {
                top: speed,
                predicted: time + left,
                ..Self::default()
            };
        }
        if self.count > 0 {
            self.gaps = [gap, self.gaps[0], self.gaps[1], self.gaps[2]];
            let lately = if left > 0.0 {
                0.0
            } else {
                FADES * self.longest
            };
            self.longest = rounded(gap).max(lately);
        }
        self.count = self.count.saturating_add(1);
        self.last = time;
    }

    /// Whether impacts have come ever faster for a while.
    pub(crate) const fn is_one(&self) -> bool {
        self.count >= Self::LEAST
    }

    /// Speed of approach of the first impact, in m/s; 0 if there is no Zeno series.
    pub(crate) const fn top(&self) -> f64 {
        if self.is_one() { self.top } else { 0.0 }
    }

    /// Reports the end of a Zeno series, once; whether there is one to report.
    pub(crate) const fn end(&mut self) -> bool {
        let first = self.is_one() && !self.ended;
        self.ended = true;
        first
    }

    /// Whether `speed` is below `part` of that of the first impact of a Zeno series.
    pub(crate) fn has_faded(&self, speed: f64, part: f64) -> bool {
        self.is_one() && speed < part * self.top
    }

    /// The limit of the series after the last impact, which predicts `left` more seconds.
    ///
    /// The prediction of an impact is right to (rounding of a gap) / (speed of the impact): best at the first.
    /// Where first and last agree it was one point that bounced, else the limit follows from the intervals. No series ends
    /// before its last impact.
    pub(crate) fn limit(&self, left: f64) -> SimTime {
        if (self.last + left - self.predicted).abs() <= AGREES {
            self.predicted.max(self.last)
        } else {
            self.last + self.rest()
        }
    }

    /// Seconds from the last impact to the limit of the series, were it geometric from here on.
    ///
    /// Intervals are taken in pairs: bounces of one point shrink by one ratio, those of a body that
    /// rocks between two by two in turn. With sums s₁ of the last two and s₂ of the two before,
    /// r = s₁/s₂ and the rest is `s₁ r/(1 − r)`.
    fn rest(&self) -> f64 {
        let (latest, before) = (self.gaps[0] + self.gaps[1], self.gaps[2] + self.gaps[3]);
        let ratio = latest / before;
        if ratio < 1.0 {
            latest * ratio / (1.0 - ratio)
        } else {
            0.0
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "it is only compared")]
const fn rounded(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_series_ends_before_its_last_impact() {
        let (start, e) = (SimTime::from_secs(3.0), 0.5);
        // The first impact predicts an end that lies 2 ps before that of the intervals.
        let (mut series, mut time, mut gap) = (ZenoSeries::default(), start, 1.0);
        let mut speed = 5.0;
        for _ in 0..50 {
            series.hit(time, speed, 2.0 - 2e-12);
            assert!(series.limit(gap / (1.0 - e)) >= time, "at {speed} m/s");
            (time, gap, speed) = (time + gap, e * gap, e * speed);
        }
        assert_eq!(series.limit(0.0), series.last);
    }

    #[test]
    fn a_geometric_series_ends_at_its_limit() {
        for e in [0.1, 0.5, 0.9] {
            let (mut series, mut time, mut gap) =
                (ZenoSeries::default(), SimTime::from_secs(3.0), 0.8);
            for _ in 0..8 {
                series.hit(time, gap, 0.0);
                time += gap;
                gap *= e;
            }
            let limit = 3.0 + 0.8 / (1.0 - e);
            assert!(
                (series.last + series.rest() - SimTime::from_secs(limit)).abs() < 1e-14,
                "e = {e}"
            );
            assert!(series.has_faded(0.8, 1.01) && !series.has_faded(0.8, 0.99));
        }
    }

    #[test]
    fn rounds_of_short_and_long_intervals_are_one_series() {
        // Of four discs at e = 0.15: every fourth interval is long, and each round a quarter of the one before.
        let (mut series, mut time, mut round) = (ZenoSeries::default(), SimTime::ZERO, 1.0);
        for _ in 0..8 {
            for part in [0.02, 0.015, 0.08, 0.4] {
                time += part * round;
                series.hit(time, round, 0.0);
            }
            round *= 0.25;
        }
        assert!(series.is_one() && series.has_faded(round, 1e-4));
    }

    #[test]
    fn steady_bounces_are_no_series_that_fades() {
        let mut series = ZenoSeries::default();
        for i in 0..20 {
            series.hit(SimTime::from_secs(f64::from(i)), 4.0, 0.0);
        }
        assert!(!series.has_faded(4.0, 1.0) && series.rest() == 0.0);
    }
}
