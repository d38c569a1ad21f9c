//! Line charts, drawn by the same painter as everything else.

use carom_math::Vec2;

use crate::layout::Layout;
use crate::{Axis, Frame, Ink, Picture, Scale, Size, Style};

/// What stands at the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A dot.
    Circle,
    /// A square.
    Square,
    /// A triangle, tip up.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// Two crossed strokes: what failed.
    Cross,
    /// A ring around what is drawn beneath it: a point that is spoken of.
    Ring,
}

/// Where the names of a chart's series stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Names {
    /// In a legend above the plot.
    #[default]
    Legend,
    /// Beside the plot, at the height of each curve's last point, in its colour.
    AtEnds,
}

impl Marker {
    /// The markers in turn, so that series differ by more than their colour.
    const ALL: [Self; 4] = [Self::Circle, Self::Square, Self::Triangle, Self::Diamond];
}

/// Points with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty for none.
    pub name: String,
    /// Its points (x, y), in order; a point that is not finite breaks the line.
    pub points: Vec<Vec2>,
    /// Width of the line, in pixels; 0 for none.
    pub width: f64,
    /// Length of a dash, in pixels; `None` draws through.
    pub dash: Option<f64>,
    /// What stands at the points.
    pub marker: Option<Marker>,
    /// Its colour; `None` takes its turn among [`Style::series`].
    pub ink: Option<Ink>,
}

impl Series {
    /// A line without markers.
    #[must_use]
    pub fn line(name: impl Into<String>, points: Vec<Vec2>) -> Self {
        Self {
            name: name.into(),
            points,
            width: 2.0,
            dash: None,
            marker: None,
            ink: None,
        }
    }

    /// The same in a colour of its own.
    #[must_use]
    pub fn inked(self, ink: impl Into<Ink>) -> Self {
        Self {
            ink: Some(ink.into()),
            ..self
        }
    }

    /// The same with a marker at every point.
    #[must_use]
    pub fn marked(self, marker: Marker) -> Self {
        Self {
            marker: Some(marker),
            ..self
        }
    }

    /// The same with dashes of `length` pixels.
    #[must_use]
    pub fn dashed(self, length: f64) -> Self {
        Self {
            dash: Some(length),
            ..self
        }
    }

    /// The same with markers only.
    #[must_use]
    pub fn scattered(self, marker: Marker) -> Self {
        Self {
            width: 0.0,
            ..self.marked(marker)
        }
    }
}

/// A chart of one or several series over common axes.
///
/// # Examples
/// ```
/// use carom_render::{Chart, Marker, Series, Size, Style};
/// use carom_math::vec2;
///
/// let error = [0.1, 0.01, 0.001].map(|dt| vec2(dt, 0.5 * dt * dt));
/// let chart = Chart::new("Error of a projectile")
///     .x("dt (s)")
///     .y("error (m)")
///     .log_x()
///     .log_y()
///     .with(Series::line("second order", error.to_vec()).marked(Marker::Circle));
/// let svg = chart.frame(Size::new(640, 400)?).to_svg(&Style::light());
/// assert!(svg.contains("second order"));
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Line above the chart.
    pub title: String,
    /// Smaller line below the title; empty for none.
    pub subtitle: String,
    /// The level axis.
    pub x: Axis,
    /// The upright axis.
    pub y: Axis,
    /// Where the names of the series stand.
    pub names: Names,
    /// The series, lowest first.
    pub series: Vec<Series>,
}

impl Chart {
    /// An empty chart with a title.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
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

    /// The same with a label on the level axis.
    #[must_use]
    pub fn x(mut self, label: impl Into<String>) -> Self {
        self.x.label = label.into();
        self
    }

    /// The same with a label on the upright axis.
    #[must_use]
    pub fn y(mut self, label: impl Into<String>) -> Self {
        self.y.label = label.into();
        self
    }

    /// The same with a logarithmic level axis.
    #[must_use]
    pub const fn log_x(mut self) -> Self {
        self.x.scale = Scale::Log;
        self
    }

    /// The same with a logarithmic upright axis.
    #[must_use]
    pub const fn log_y(mut self) -> Self {
        self.y.scale = Scale::Log;
        self
    }

    /// The same with names at the ends of curves in place of a legend.
    #[must_use]
    pub const fn named_at_ends(mut self) -> Self {
        self.names = Names::AtEnds;
        self
    }

    /// The same with one more series, above the others.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The chart in pixels.
    #[must_use]
    pub fn paint(&self, size: Size, style: &Style) -> Picture {
        self.frame(size).paint(style)
    }

    /// The chart as marks, for pixels or for SVG.
    #[must_use]
    pub fn frame(&self, size: Size) -> Frame {
        let mut frame = Frame::new(size);
        self.draw(Vec2::ZERO, size.corner(), &mut frame);
        frame
    }

    /// Draws the chart into a part of a frame, `size` wide and high.
    pub(crate) fn draw(&self, origin: Vec2, size: Vec2, frame: &mut Frame) {
        let layout = Layout::new(self, origin, size);
        layout.draw_headings(self, frame);
        if layout.has_room() {
            layout.draw_axes(self, frame);
            for (i, series) in self.series.iter().enumerate() {
                layout.draw_series(series, self.ink(i), frame);
            }
            if self.names == Names::AtEnds {
                layout.draw_names(self, frame);
            }
        }
    }

    /// The colour of a series.
    pub(crate) fn ink(&self, index: usize) -> Ink {
        self.series[index].ink.unwrap_or(Ink::Series(index))
    }

    /// A marker that differs from those of the neighbouring series.
    #[must_use]
    pub const fn marker(index: usize) -> Marker {
        Marker::ALL[index % Marker::ALL.len()]
    }

    pub(crate) fn numbers(&self, pick: fn(&Vec2) -> f64) -> impl Iterator<Item = f64> {
        let points = self.series.iter().flat_map(|series| &series.points);
        points.filter(|p| p.is_finite()).map(pick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colour, Op};
    use carom_math::vec2;
    use proptest::prelude::*;

    fn size() -> Size {
        Size::new(400, 300).unwrap()
    }

    fn chart(points: Vec<Vec2>) -> Chart {
        Chart::new("Title")
            .x("x")
            .y("y")
            .with(Series::line("one", points).marked(Marker::Square))
    }

    #[test]
    fn a_line_goes_through_its_points() {
        let style = Style::light();
        let points = vec![vec2(0.0, 0.0), vec2(10.0, 5.0)];
        let mut chart = Chart::new("").with(Series::line("", points));
        chart.x.range = Some((0.0, 10.0));
        chart.y.range = Some((0.0, 5.0));
        let layout = Layout::new(&chart, Vec2::ZERO, size().corner());
        let middle = layout.place(vec2(5.0, 2.5)).unwrap();
        let picture = chart.paint(size(), &style);
        #[expect(clippy::cast_sign_loss, reason = "inside the picture")]
        let (x, y) = (middle.x as u32, middle.y as u32);
        assert_eq!(picture.pixel(x, y), Some(style.series[0]));
        assert_eq!(layout.place(vec2(0.0, 0.0)).unwrap().x, layout.min.x);
    }

    #[test]
    fn a_chart_without_room_or_data_is_still_a_picture() {
        for (width, height) in [(1, 1), (40, 30), (400, 40), (60, 400)] {
            let size = Size::new(width, height).unwrap();
            let _seen = chart(vec![]).paint(size, &Style::dark());
            let _seen = chart(vec![vec2(1.0, 1.0)]).paint(size, &Style::dark());
        }
        let empty = Chart::default().paint(size(), &Style::light());
        assert_eq!(empty.pixel(399, 0), Some(Colour::WHITE));
    }

    #[test]
    fn nothing_and_infinity_have_their_strips() {
        let points = vec![vec2(1.0, 0.0), vec2(2.0, 1e-3), vec2(3.0, f64::INFINITY)];
        let plain = chart(points.clone()).log_y();
        let mut stripped = plain.clone();
        (stripped.y.floor, stripped.y.ceiling) = ("exact".to_owned(), "failed".to_owned());
        let place = |chart: &Chart, point: Vec2| {
            Layout::new(chart, Vec2::ZERO, size().corner()).place(point)
        };
        assert_eq!(place(&plain, points[0]), None);
        assert_eq!(place(&plain, points[2]), None);
        let [floor, middle, ceiling] = [0, 1, 2].map(|i| place(&stripped, points[i]).unwrap());
        assert!(
            ceiling.y < middle.y && middle.y < floor.y,
            "{ceiling} {middle} {floor}"
        );
        let svg = stripped.frame(size()).to_svg(&Style::light());
        assert!(svg.contains("exact") && svg.contains("failed"));
    }

    #[test]
    fn a_name_stands_beside_the_end_of_its_curve() {
        let up = Series::line("up", vec![vec2(0.0, 0.0), vec2(1.0, 1.0)]);
        let down = Series::line("down", vec![vec2(0.0, 1.0), vec2(1.0, 0.0)]);
        let chart = Chart::new("").with(up).with(down).named_at_ends();
        let layout = Layout::new(&chart, Vec2::ZERO, size().corner());
        let frame = chart.frame(size());
        for (name, end) in [("up", vec2(1.0, 1.0)), ("down", vec2(1.0, 0.0))] {
            let at = frame.ops().iter().find_map(|op| match op {
                Op::Label(label) if label.text == name => Some(label.at),
                _ => None,
            });
            let (at, end) = (at.unwrap(), layout.place(end).unwrap());
            assert!(
                (at.y - end.y).abs() < 1e-9 && at.x > end.x,
                "{name}: {at} {end}"
            );
        }
    }

    #[test]
    fn a_mark_is_drawn_where_its_axis_has_room_for_it() {
        let mut chart = chart(vec![vec2(1.0, 1.0), vec2(100.0, 100.0)])
            .log_x()
            .log_y();
        chart.y.marks = vec![(10.0, "ten".to_owned()), (1e9, "beyond".to_owned())];
        chart.x.marks = vec![(10.0, "across".to_owned()), (-1.0, "nowhere".to_owned())];
        let svg = chart.frame(size()).to_svg(&Style::light());
        assert!(svg.contains("ten") && svg.contains("across"));
        assert!(!svg.contains("beyond") && !svg.contains("nowhere"));
    }

    #[test]
    fn names_stand_at_whole_numbers() {
        let mut chart = chart(vec![vec2(1.0, 0.0), vec2(2.0, 1.0)]);
        chart.y.names = vec!["first".to_owned(), "second".to_owned()];
        let svg = chart.frame(size()).to_svg(&Style::light());
        assert!(svg.contains("first") && svg.contains("second"));
        let layout = Layout::new(&chart, Vec2::ZERO, size().corner());
        let [a, b] = [0.0, 1.0].map(|y| layout.place(vec2(1.0, y)).unwrap().y);
        assert!(b < a, "upwards");
    }

    proptest! {
        #[test]
        fn strange_numbers_make_no_strange_marks(
            points in prop::collection::vec(
                (prop::num::f64::ANY, prop::num::f64::ANY).prop_map(|(x, y)| vec2(x, y)), 0..12),
            log_x: bool,
            log_y: bool,
            strips: bool,
        ) {
            let mut chart = chart(points);
            chart.x.scale = if log_x { Scale::Log } else { Scale::Linear };
            chart.y.scale = if log_y { Scale::Log } else { Scale::Linear };
            if strips {
                (chart.y.floor, chart.y.ceiling) = ("0".to_owned(), "inf".to_owned());
            }
            let frame = chart.frame(size());
            for op in frame.ops() {
                if let Op::Line { points, .. } | Op::Area { points, .. } = op {
                    prop_assert!(points.iter().all(|p| p.is_finite()), "{points:?}");
                }
            }
            prop_assert_eq!(frame.to_svg(&Style::light()), chart.frame(size()).to_svg(&Style::light()));
        }
    }
}
