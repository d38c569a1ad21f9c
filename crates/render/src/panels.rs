//! Small multiples: charts side by side under one title and one legend.

use carom_math::{Vec2, vec2};

use crate::layout::{draw_entry, entry_width};
use crate::{Chart, Frame, Ink, Label, Names, Series, Size};

/// Heights of capitals, in pixels.
const TITLE: f64 = 14.0;
const SMALL: f64 = 8.5;
/// Room at the edges, and height of a line of the legend, in pixels.
const EDGE: f64 = 20.0;
const LINE: f64 = 20.0;

/// Charts in a grid with a common legend: series of one name and colour are one entry. Charts with names at ends have none in it.
///
/// # Examples
/// ```
/// use carom_render::{Chart, Panels, Series, Size, Style};
/// use carom_math::vec2;
///
/// let one = |title| Chart::new(title).with(Series::line("shared", vec![vec2(0.0, 1.0), vec2(1.0, 2.0)]));
/// let panels = Panels::new("Two charts", 2).with(one("left")).with(one("right"));
/// let svg = panels.frame(Size::new(800, 400)?).to_svg(&Style::light());
/// assert_eq!(svg.matches("shared").count(), 1);
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panels {
    /// Line above all.
    pub title: String,
    /// Smaller lines below the title; empty for none.
    pub subtitle: String,
    /// Charts in a row; 0 counts as 1.
    pub columns: usize,
    /// The charts, row by row.
    pub charts: Vec<Chart>,
}

impl Panels {
    /// An empty grid of so many columns.
    #[must_use]
    pub fn new(title: impl Into<String>, columns: usize) -> Self {
        Self {
            title: title.into(),
            columns,
            ..Self::default()
        }
    }

    /// The same with a smaller line below the title.
    #[must_use]
    pub fn subtitled(self, subtitle: impl Into<String>) -> Self {
        Self {
            subtitle: subtitle.into(),
            ..self
        }
    }

    /// The same with one more chart.
    #[must_use]
    pub fn with(mut self, chart: Chart) -> Self {
        self.charts.push(chart);
        self
    }

    /// The charts as marks, for pixels or for SVG.
    #[must_use]
    pub fn frame(&self, size: Size) -> Frame {
        let mut frame = Frame::new(size);
        let corner = size.corner();
        let mut top = EDGE;
        for (text, height, ink) in [
            (&self.title, TITLE, Ink::Text),
            (&self.subtitle, SMALL, Ink::Muted),
        ] {
            for line in text.lines() {
                let label = Label::new(vec2(EDGE, top), line, height, ink);
                frame.push(label.anchored(0.0, 1.0));
                top += 1.9 * height;
            }
        }
        top = self.draw_legend(top, corner.x, &mut frame);
        self.draw_charts(top, corner, &mut frame);
        frame
    }

    /// Entries from left to right, broken like text; gives where they end.
    fn draw_legend(&self, top: f64, width: f64, frame: &mut Frame) -> f64 {
        let entries = self.entries();
        let mut pen = vec2(EDGE, top + 0.5 * LINE);
        for (series, ink) in &entries {
            let step = entry_width(series);
            if pen.x > EDGE && pen.x + step > width {
                pen = vec2(EDGE, pen.y + LINE);
            }
            draw_entry(series, *ink, pen, frame);
            pen.x += step;
        }
        if entries.is_empty() {
            top
        } else {
            pen.y + 0.5 * LINE
        }
    }

    /// Every named series once.
    fn entries(&self) -> Vec<(&Series, Ink)> {
        let mut entries: Vec<(&Series, Ink)> = Vec::new();
        for chart in self
            .charts
            .iter()
            .filter(|chart| chart.names == Names::Legend)
        {
            for (index, series) in chart.series.iter().enumerate() {
                let ink = chart.ink(index);
                let known = |(found, of): &(&Series, Ink)| found.name == series.name && *of == ink;
                if !series.name.is_empty() && !entries.iter().any(known) {
                    entries.push((series, ink));
                }
            }
        }
        entries
    }

    #[expect(clippy::cast_precision_loss, reason = "a count of charts")]
    fn draw_charts(&self, top: f64, corner: Vec2, frame: &mut Frame) {
        let columns = self.columns.clamp(1, self.charts.len().max(1));
        let rows = self.charts.len().div_ceil(columns);
        let cell = vec2(
            corner.x / columns as f64,
            (corner.y - top) / rows.max(1) as f64,
        );
        for (index, chart) in self.charts.iter().enumerate() {
            let place = vec2((index % columns) as f64, (index / columns) as f64);
            let mut chart = chart.clone();
            if chart.names == Names::Legend {
                for series in &mut chart.series {
                    series.name.clear();
                }
            }
            chart.draw(vec2(0.0, top) + place * cell, cell, frame);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Op, Style};

    #[test]
    fn charts_stay_in_their_cells() {
        let points = vec![vec2(0.0, 1.0), vec2(1.0, 2.0)];
        let chart = || {
            Chart::new("t")
                .x("x")
                .y("y")
                .with(Series::line("a", points.clone()))
        };
        let mut panels = Panels::new("all", 2);
        for _ in 0..3 {
            panels = panels.with(chart());
        }
        let size = Size::new(600, 500).unwrap();
        let frame = panels.frame(size);
        for op in frame.ops() {
            if let Op::Line { points, .. } = op {
                assert!(
                    points
                        .iter()
                        .all(|p| (0.0..=600.0).contains(&p.x) && (0.0..=500.0).contains(&p.y))
                );
                let left = points.iter().all(|p| p.x <= 300.0);
                let right = points.iter().all(|p| p.x >= 300.0);
                assert!(left || right, "{points:?}");
            }
        }
    }

    #[test]
    fn no_chart_and_no_room_are_still_pictures() {
        for (width, height) in [(1, 1), (30, 20), (600, 30)] {
            let size = Size::new(width, height).unwrap();
            let _seen = Panels::new("x", 0).frame(size).paint(&Style::dark());
            let _seen = Panels::new("x", 0)
                .with(Chart::new("y"))
                .frame(size)
                .paint(&Style::dark());
        }
    }
}
