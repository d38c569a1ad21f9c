//! Fields: the circle around a core, and lines along what pulls.

use carom_dynamics::{Field as _, RadialField};
use carom_math::{Vec2, vec2};

use super::{FieldMark, Overlaid, TEXT};
use crate::{Ink, Label, Op};

/// Room between the starts of two lines, and length of a chord of a line, in pixels of the overlay.
const ROOM: f64 = 44.0;
const CHORD: f64 = 6.0;
/// Most chords of a line.
const CHORDS: u32 = 4000;
/// How much paler than its ink a line is.
const PALE: f64 = 0.55;

impl Overlaid<'_> {
    /// Lines that start at the border of the picture, an arrow in the middle of each.
    pub(super) fn field_lines(&mut self) {
        let Some(fields) = &self.look.overlay.field_lines else {
            return;
        };
        let style = &self.look.style;
        let ink = Ink::Of(style.field.mixed(style.background, PALE));
        let corner = self.camera.size().corner();
        let pull = |pixel: Vec2| self.pull(fields, pixel);
        let starts = border(corner, ROOM * self.unit);
        let inwards = |&(start, inside): &(Vec2, Vec2)| pull(start).dot(inside) > 0.0;
        // Lines that come in; where the field only leaves the picture, those that go out, backwards.
        let ahead = starts.iter().any(inwards);
        let sign = if ahead { 1.0 } else { -1.0 };
        let mut marks = Vec::new();
        for (start, _) in starts.iter().filter(|start| inwards(start) == ahead) {
            let points = line(*start, corner, CHORD * self.unit, |p| pull(p) * sign);
            if points.len() < 3 {
                continue;
            }
            let middle = points.len() / 2;
            let (a, b) = (points[middle - 1], points[middle]);
            let half = (b - a).normalize_or_zero() * (5.0 * self.unit * sign);
            marks.push(Op::Line {
                points,
                width: self.unit,
                dash: None,
                ink,
            });
            marks.push(Op::Arrow {
                from: b - half,
                to: b + half,
                width: 1.6 * self.unit,
                ink,
            });
        }
        for mark in marks {
            self.frame.push(mark);
        }
    }

    /// Direction of what pulls at a point of the picture, y down; zero where nothing does.
    fn pull(&self, fields: &[RadialField], pixel: Vec2) -> Vec2 {
        let place = self.camera.world(pixel);
        let mut all = self.world.settings().gravity;
        for field in fields {
            if (field.centre() - place).length() <= field.core() {
                return Vec2::ZERO;
            }
            all += field.acceleration(place);
        }
        self.camera.vector(all).normalize_or_zero()
    }

    pub(super) fn field(&mut self) {
        if let Some(mark) = &self.look.overlay.field {
            self.frame.push(Op::Ring {
                centre: self.camera.point(mark.centre),
                radius: self.camera.length(mark.radius),
                width: 3.0 * self.unit,
                ink: Ink::Field,
            });
        }
    }

    pub(super) fn field_label(&mut self) {
        let Some(FieldMark {
            centre,
            radius,
            label,
        }) = &self.look.overlay.field
        else {
            return;
        };
        if !label.is_empty() {
            let above = vec2(0.0, self.camera.length(*radius) + 8.0 * self.unit);
            let at = self.camera.point(*centre) - above;
            let text = Label::new(at, label.clone(), TEXT * self.unit, Ink::Field);
            self.frame.push(text.anchored(0.5, 0.0).with_halo());
        }
    }
}

/// Points along the border of the picture, evenly spaced, each with the direction into it.
fn border(corner: Vec2, room: f64) -> Vec<(Vec2, Vec2)> {
    let mut starts = Vec::new();
    let sides = [
        (Vec2::ZERO, Vec2::X, corner.x, Vec2::Y),
        (vec2(0.0, corner.y), Vec2::X, corner.x, Vec2::NEG_Y),
        (Vec2::ZERO, Vec2::Y, corner.y, Vec2::X),
        (vec2(corner.x, 0.0), Vec2::Y, corner.y, Vec2::NEG_X),
    ];
    for (from, along, length, inside) in sides {
        let count = (length / room).round().max(1.0);
        let mut k = 0.5;
        while k < count {
            starts.push((from + along * (length * k / count), inside));
            k += 1.0;
        }
    }
    starts
}

/// A line along a direction, by the midpoint rule, until it leaves the picture or the direction ends or turns back.
fn line(start: Vec2, corner: Vec2, chord: f64, direction: impl Fn(Vec2) -> Vec2) -> Vec<Vec2> {
    let mut points = vec![start];
    let (mut at, mut before) = (start, direction(start));
    for _ in 0..CHORDS {
        let middle = at + direction(at) * (0.5 * chord);
        let along = direction(middle);
        if along == Vec2::ZERO || along.dot(before) < 0.0 {
            break;
        }
        at += along * chord;
        before = along;
        points.push(at);
        let inside = at.cmpge(Vec2::ZERO).all() && at.cmple(corner).all();
        if !inside {
            break;
        }
    }
    points
}
