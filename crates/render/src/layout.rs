//! Where the parts of a chart go, and their marks.

use carom_math::{Rot, Vec2, vec2};

use crate::axis::{Ruler, TickText};
use crate::clip::Window;
use crate::ends::{self, End};
use crate::{Axis, Chart, Frame, Ink, Label, Marker, Names, Op, Series, font};

/// Heights of capitals, in pixels.
const TITLE: f64 = 12.5;
const TEXT: f64 = 9.0;
const SMALL: f64 = 8.5;
const POWER: f64 = 6.0;

/// Room at the edges of the chart, in pixels.
const EDGE: f64 = 18.0;
/// Room between ticks and their labels, in pixels.
const TICK_GAP: f64 = 8.0;
/// Length of a legend's line and room after an entry, in pixels.
const SWATCH: f64 = 24.0;
const ENTRY_GAP: f64 = 22.0;
/// Height of the strips for nothing and infinity, in pixels.
const STRIP: f64 = 20.0;

/// Where everything goes: from the outside inwards.
pub(crate) struct Layout {
    /// The plot's corners, upper left and lower right.
    pub(crate) min: Vec2,
    max: Vec2,
    /// The same with the strips.
    top: f64,
    foot: f64,
    /// Upper left corner of all.
    origin: Vec2,
    x: Ruler,
    y: Ruler,
    /// Where each named series stands in the legend: index, left end, middle height.
    legend: Vec<(usize, Vec2)>,
}

impl Layout {
    pub(crate) fn new(chart: &Chart, origin: Vec2, size: Vec2) -> Self {
        let mut top = EDGE;
        for (text, height) in [(&chart.title, TITLE), (&chart.subtitle, SMALL)] {
            if !text.is_empty() {
                top += 1.9 * height;
            }
        }
        // The number of ticks follows from the whole picture; the plot is hardly smaller.
        let y_count = ((size.y - top - 60.0) / 46.0).clamp(2.0, 9.0);
        let y = Ruler::new(&chart.y, chart.numbers(|p| p.y), y_count, 0.06);
        let widest = y
            .ticks
            .iter()
            .map(|tick| tick_width(&tick.text))
            .chain([&chart.y.floor, &chart.y.ceiling].map(|name| font::width(name, SMALL)))
            .fold(0.0, f64::max);
        let label = |axis: &Axis| {
            if axis.label.is_empty() {
                0.0
            } else {
                2.2 * TEXT
            }
        };
        let left = EDGE + label(&chart.y) + widest + TICK_GAP;
        let at_ends = chart.names == Names::AtEnds;
        let beside = if at_ends {
            ends::room(chart.series.iter())
        } else {
            0.0
        };
        let right = size.x - EDGE - 6.0 - beside;
        let x_count = ((right - left) / 84.0).clamp(2.0, 10.0);
        // What stands in the strip of infinity has a place on the level axis too.
        let above = !chart.y.ceiling.is_empty();
        let points = chart.series.iter().flat_map(|series| &series.points);
        let seen = points.filter(|p| p.is_finite() || above && p.y == f64::INFINITY);
        let x = Ruler::new(&chart.x, seen.map(|p| p.x), x_count, 0.02);

        // The legend runs along the top of the plot and breaks like text.
        let named = chart
            .series
            .iter()
            .enumerate()
            .filter(|(_, s)| !s.name.is_empty() && !at_ends);
        let mut legend = Vec::new();
        let mut pen = vec2(left, top + TEXT);
        for (i, series) in named {
            let width = SWATCH + 7.0 + font::width(&series.name, SMALL);
            if pen.x > left && pen.x + width > right {
                pen = vec2(left, pen.y + 2.1 * SMALL);
            }
            legend.push((i, origin + pen));
            pen.x += width + ENTRY_GAP;
        }
        if !legend.is_empty() {
            top = pen.y + 1.1 * SMALL;
        }
        if y.exponent != 0 {
            top += 1.5 * TEXT;
        }
        let bottom = size.y - EDGE + 2.0 - label(&chart.x) - 1.2 * SMALL - TICK_GAP;
        let (top, foot) = (origin.y + top + 6.0, origin.y + bottom);
        let strip = |name: &str| if name.is_empty() { 0.0 } else { STRIP };
        Self {
            min: vec2(origin.x + left, top + strip(&chart.y.ceiling)),
            max: vec2(origin.x + right, foot - strip(&chart.y.floor)),
            top,
            foot,
            origin,
            x,
            y,
            legend,
        }
    }

    pub(crate) fn has_room(&self) -> bool {
        (self.max - self.min).min_element() >= 8.0
    }

    pub(crate) fn place(&self, point: Vec2) -> Option<Vec2> {
        let x = self.min.x + self.x.at(point.x)? * (self.max.x - self.min.x);
        let y = match self.strip(point.y) {
            Some(middle) => middle,
            None => self.max.y - self.y.at(point.y)? * (self.max.y - self.min.y),
        };
        Some(vec2(x, y)).filter(|place| place.is_finite())
    }

    /// The middle of the strip that a number belongs to; `None` if it belongs to the plot.
    fn strip(&self, y: f64) -> Option<f64> {
        if y == f64::INFINITY && self.top < self.min.y {
            Some(0.5 * (self.top + self.min.y))
        } else if y == 0.0 && self.max.y < self.foot {
            Some(0.5 * (self.max.y + self.foot))
        } else {
            None
        }
    }

    pub(crate) fn draw_headings(&self, chart: &Chart, frame: &mut Frame) {
        let left = if self.has_room() {
            self.min.x
        } else {
            self.origin.x + EDGE
        };
        let mut top = self.origin.y + EDGE;
        for (text, height, ink) in [
            (&chart.title, TITLE, Ink::Text),
            (&chart.subtitle, SMALL, Ink::Muted),
        ] {
            if text.is_empty() {
                continue;
            }
            frame.push(Label::new(vec2(left, top), text.clone(), height, ink).anchored(0.0, 1.0));
            top += 1.9 * height;
        }
        for &(i, at) in &self.legend {
            draw_entry(&chart.series[i], chart.ink(i), at, frame);
        }
    }

    pub(crate) fn draw_axes(&self, chart: &Chart, frame: &mut Frame) {
        let (min, max) = (self.min, self.max);
        let (top, foot) = (self.top, self.foot);
        let mut grid = |from: Vec2, to: Vec2, width: f64| {
            frame.push(Op::Line {
                points: vec![from, to],
                width,
                dash: None,
                ink: Ink::Grid,
            });
        };
        // Level and upright lines of one pixel lie on whole pixels.
        for tick in &self.x.ticks {
            let x = crisp(min.x + tick.at * (max.x - min.x));
            let width = if tick.text == TickText::None {
                0.5
            } else {
                1.0
            };
            grid(vec2(x, top), vec2(x, foot), width);
        }
        for tick in &self.y.ticks {
            let y = crisp(max.y - tick.at * (max.y - min.y));
            let width = if tick.text == TickText::None {
                0.5
            } else {
                1.0
            };
            grid(vec2(min.x, y), vec2(max.x, y), width);
        }
        for (name, y, from, to) in [
            (&chart.y.ceiling, crisp(min.y), top, min.y),
            (&chart.y.floor, crisp(max.y), max.y, foot),
        ] {
            if !name.is_empty() {
                frame.push(Op::Line {
                    points: vec![vec2(min.x, y), vec2(max.x, y)],
                    width: 1.0,
                    dash: Some(4.0),
                    ink: Ink::Muted,
                });
                let at = vec2(min.x - TICK_GAP, 0.5 * (from + to));
                let label = Label::new(at, name.clone(), SMALL, Ink::Muted);
                frame.push(label.anchored(1.0, 0.5));
            }
        }
        let (left, bottom) = (crisp(min.x), crisp(foot));
        frame.push(Op::Line {
            points: vec![vec2(left, top), vec2(left, bottom), vec2(max.x, bottom)],
            width: 1.0,
            dash: None,
            ink: Ink::Muted,
        });
        self.draw_marks(chart, frame);
        for tick in &self.x.ticks {
            let x = min.x + tick.at * (max.x - min.x);
            draw_tick(&tick.text, vec2(x, foot + TICK_GAP), vec2(0.5, 1.0), frame);
        }
        for tick in &self.y.ticks {
            let y = max.y - tick.at * (max.y - min.y);
            draw_tick(&tick.text, vec2(min.x - TICK_GAP, y), vec2(1.0, 0.5), frame);
        }
        let corner = vec2(max.x, foot + TICK_GAP + 1.2 * SMALL);
        for (ruler, at, anchor) in [
            (&self.x, corner + vec2(0.0, 1.4 * TEXT), vec2(1.0, 0.0)),
            (&self.y, vec2(min.x, top - 0.7 * TEXT), vec2(0.0, 0.0)),
        ] {
            if ruler.exponent != 0 {
                draw_power("×10", ruler.exponent, at, anchor, frame);
            }
        }
        let middle = 0.5 * (min + max);
        let bottom = vec2(middle.x, corner.y + 1.8 * TEXT);
        frame.push(Label::new(bottom, chart.x.label.clone(), TEXT, Ink::Text).anchored(0.5, 0.0));
        let side = vec2(self.origin.x + EDGE, middle.y);
        let label = Label::new(side, chart.y.label.clone(), TEXT, Ink::Text);
        frame.push(label.anchored(0.5, 1.0).upwards());
    }

    /// Lines across the plot at numbers that are spoken of, each with its name at an end.
    fn draw_marks(&self, chart: &Chart, frame: &mut Frame) {
        let (min, max) = (self.min, self.max);
        let within = |ruler: &Ruler, x: f64| ruler.at(x).filter(|at| (0.0..=1.0).contains(at));
        let mut mark = |from: Vec2, to: Vec2, name: &String, at: Vec2, anchor: Vec2| {
            frame.push(Op::Line {
                points: vec![from, to],
                width: 1.0,
                dash: Some(4.0),
                ink: Ink::Muted,
            });
            let label = Label::new(at, name.clone(), SMALL, Ink::Muted);
            frame.push(label.anchored(anchor.x, anchor.y).with_halo());
        };
        for (x, name) in &chart.x.marks {
            if let Some(at) = within(&self.x, *x) {
                let x = crisp(min.x + at * (max.x - min.x));
                let (top, foot) = (vec2(x, self.top), vec2(x, self.foot));
                mark(top, foot, name, top - vec2(0.0, 4.0), vec2(0.5, 0.0));
            }
        }
        for (y, name) in &chart.y.marks {
            if let Some(at) = within(&self.y, *y) {
                let y = crisp(max.y - at * (max.y - min.y));
                let (left, right) = (vec2(min.x, y), vec2(max.x, y));
                mark(left, right, name, left + vec2(4.0, -4.0), vec2(0.0, 0.0));
            }
        }
    }

    /// The names of the curves, beside their last points.
    pub(crate) fn draw_names(&self, chart: &Chart, frame: &mut Frame) {
        let seen = |place: &Vec2| (self.min.x..=self.max.x).contains(&place.x);
        let end = |(i, series): (usize, &'_ Series)| {
            let mut places = series.points.iter().filter_map(|&p| self.place(p));
            let at = places.rfind(seen)?;
            (!series.name.is_empty()).then_some((i, at))
        };
        let ends = chart.series.iter().enumerate().filter_map(end);
        let ends = ends.map(|(i, at)| End {
            name: &chart.series[i].name,
            ink: chart.ink(i),
            at: vec2(at.x, at.y.clamp(self.top, self.foot)),
        });
        ends::draw(ends.collect(), self.max.x, self.top, self.foot, frame);
    }

    pub(crate) fn draw_series(&self, series: &Series, ink: Ink, frame: &mut Frame) {
        // A line may leave the plot; its markers may not.
        let (min, max) = (vec2(self.min.x, self.top), vec2(self.max.x, self.foot));
        let window = Window::between(min - Vec2::splat(1.0), max + Vec2::splat(1.0));
        let mut spare = Vec::new();
        let runs = series.points.split(|&p| self.place(p).is_none());
        // Between the plot and a strip lie all numbers: no line goes there.
        let runs = runs.flat_map(|run| run.chunk_by(|a, b| self.strip(a.y) == self.strip(b.y)));
        for run in runs {
            let places: Vec<Vec2> = run.iter().filter_map(|&p| self.place(p)).collect();
            let thinned = thinned(&places);
            window.polyline(&thinned, &mut spare, |part| {
                frame.push(Op::Line {
                    points: part.to_vec(),
                    width: series.width,
                    dash: series.dash,
                    ink,
                });
            });
        }
        if let Some(marker) = series.marker {
            for &point in &series.points {
                let Some(place) = self.place(point).filter(|&p| window.contains(p)) else {
                    continue;
                };
                let failed = point.y == f64::INFINITY && marker != Marker::Ring;
                let marker = if failed { Marker::Cross } else { marker };
                draw_marker(marker, place, ink, frame);
            }
        }
    }
}

/// An entry of a legend: a piece of the line, and the name.
pub(crate) fn draw_entry(series: &Series, ink: Ink, at: Vec2, frame: &mut Frame) {
    let end = at + vec2(SWATCH, 0.0);
    frame.push(Op::Line {
        points: vec![at, end],
        width: series.width,
        dash: series.dash,
        ink,
    });
    if let Some(marker) = series.marker {
        draw_marker(marker, 0.5 * (at + end), ink, frame);
    }
    let text = Label::new(end + vec2(7.0, 0.0), series.name.clone(), SMALL, Ink::Text);
    frame.push(text.anchored(0.0, 0.5));
}

/// Width of an entry of a legend and the room after it, in pixels.
pub(crate) fn entry_width(series: &Series) -> f64 {
    SWATCH + 7.0 + font::width(&series.name, SMALL) + ENTRY_GAP
}

/// The middle of the pixel that a coordinate falls into.
fn crisp(x: f64) -> f64 {
    x.floor() + 0.5
}

/// A line with at most four points a pixel column: the first, lowest, highest and last of each run of points in
/// one, which is what can be seen of it.
fn thinned(points: &[Vec2]) -> Vec<Vec2> {
    let mut kept = Vec::new();
    let mut rest = points;
    while let Some(first) = rest.first() {
        let column = first.x.floor();
        let inside = |p: &&Vec2| p.x >= column && p.x < column + 1.0;
        // At least one: beyond 2^53 px a column is narrower than a rounding.
        let count = rest.iter().take_while(inside).count().max(1);
        let (run, after) = rest.split_at(count);
        rest = after;
        if count <= 4 {
            kept.extend_from_slice(run);
            continue;
        }
        let (mut low, mut high) = (0, 0);
        for (i, point) in run.iter().enumerate() {
            if point.y < run[low].y {
                low = i;
            }
            if point.y > run[high].y {
                high = i;
            }
        }
        let mut picks = [0, low, high, count - 1];
        picks.sort_unstable();
        kept.extend(picks.map(|i| run[i]));
    }
    kept
}

fn tick_width(text: &TickText) -> f64 {
    match text {
        TickText::None => 0.0,
        TickText::Plain(text) => font::width(text, SMALL),
        TickText::Power(power) => power_width("10", *power),
    }
}

fn draw_tick(text: &TickText, at: Vec2, anchor: Vec2, frame: &mut Frame) {
    match text {
        TickText::None => {}
        TickText::Plain(text) => {
            let label = Label::new(at, text.clone(), SMALL, Ink::Muted);
            frame.push(label.anchored(anchor.x, anchor.y));
        }
        TickText::Power(power) => draw_power("10", *power, at, anchor, frame),
    }
}

fn power_width(base: &str, power: i32) -> f64 {
    font::width(base, SMALL) + font::width(&power.to_string(), POWER)
}

/// `base` with a raised exponent.
fn draw_power(base: &str, power: i32, at: Vec2, anchor: Vec2, frame: &mut Frame) {
    let left = at.x - anchor.x * power_width(base, power);
    let line = at.y + anchor.y * SMALL;
    frame.push(Label::new(vec2(left, line), base, SMALL, Ink::Muted));
    let raised = vec2(left + font::width(base, SMALL), line - 0.62 * SMALL);
    frame.push(Label::new(raised, power.to_string(), POWER, Ink::Muted));
}

/// A marker with a seam of the ground around it, so that it stands out from lines.
fn draw_marker(marker: Marker, at: Vec2, ink: Ink, frame: &mut Frame) {
    if marker == Marker::Cross {
        for arm in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
            frame.push(Op::Line {
                points: vec![at - arm, at + arm],
                width: 2.2,
                dash: None,
                ink,
            });
        }
        return;
    }
    if marker == Marker::Ring {
        let corner = |i: i32| at + 6.6 * Rot::from_degrees(15.0 * f64::from(i)).x_axis();
        frame.push(Op::Line {
            points: (0..=24).map(corner).collect(),
            width: 1.2,
            dash: None,
            ink,
        });
        return;
    }
    for (radius, ink) in [(5.2, Ink::Background), (3.8, ink)] {
        if marker == Marker::Circle {
            frame.push(Op::Dot {
                centre: at,
                radius,
                ink,
            });
            continue;
        }
        // Corner count, first corner in degrees, and a circumradius that makes them look alike.
        let (corners, first, grown) = match marker {
            Marker::Square => (4, 45.0, 1.25),
            Marker::Triangle => (3, -90.0, 1.3),
            Marker::Diamond | Marker::Circle | Marker::Cross | Marker::Ring => (4, 0.0, 1.35),
        };
        let points = (0..corners)
            .map(|i| {
                let angle = first + 360.0 * f64::from(i) / f64::from(corners);
                at + grown * radius * Rot::from_degrees(angle).x_axis()
            })
            .collect();
        frame.push(Op::Area { points, ink });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_points_are_thinned_to_what_is_seen() {
        let points: Vec<Vec2> = (0..100_000_i32)
            .map(|i| vec2(f64::from(i) * 1e-3, f64::from((i * 37) % 101)))
            .collect();
        let thin = thinned(&points);
        assert!(thin.len() <= 404, "{}", thin.len());
        assert!(thin.iter().any(|p| p.y == 0.0) && thin.iter().any(|p| p.y == 100.0));
        assert_eq!((thin[0], thin[thin.len() - 1]), (points[0], points[99_999]));
    }
}
