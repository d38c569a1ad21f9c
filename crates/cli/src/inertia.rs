//! `inertia`: area, centroid, moments, principal axes, mass and inertia of a polygon.

use carom_geometry::{AreaProperties, MassProperties, Polygon};
use carom_math::{Vec2, vec2};
use carom_render::read_file;

use crate::exit::{End, Failure, Outcome, fail};
use crate::flags::InertiaArgs;
use crate::number::number;
use crate::out::say;

/// Largest list of vertices that is read, in bytes: as many as a polygon may have, in 16 bytes each; with full digits a
/// third of that. Less would refuse what a polygon takes, more is memory for a wrong file.
const MAX_BYTES: u64 = 1 << 28;

pub(crate) fn run(args: &InertiaArgs) -> Outcome {
    let points = match (&args.vertices, &args.file) {
        (Some(text), _) => parse(text)?,
        (None, Some(path)) => {
            let named = |error: &dyn std::fmt::Display| {
                Failure::new(format!("{}: {error}", path.display()))
            };
            let bytes = read_file(path, MAX_BYTES).map_err(|error| named(&error))?;
            let text = String::from_utf8(bytes).map_err(|error| named(&error))?;
            parse_lines(&text).map_err(|failure| named(&failure.line()))?
        }
        (None, None) => fail!("neither vertices nor --file"),
    };
    for (name, value) in [("density", args.density), ("mass", args.mass)] {
        if let Some(value) = value
            && !(value > 0.0 && value.is_finite())
        {
            fail!("{name} is {}, not a finite number above 0", number(value));
        }
    }
    let area = Polygon::new(points)?.area_properties();
    let mass = match args.mass {
        Some(mass) => area.with_mass(mass),
        None => area.with_density(args.density.unwrap_or(1.0)),
    };
    print(&area, &mass);
    Ok(End::Done)
}

fn print(area: &AreaProperties, mass: &MassProperties) {
    let (largest, smallest, axis) = area.principal_axes();
    let turn = axis.angle().to_degrees();
    say!("area        {} m²", number(area.area));
    let (x, y) = (number(area.centroid.x), number(area.centroid.y));
    say!("centroid    ({x}, {y}) m");
    let [xx, yy, xy] = [area.ixx, area.iyy, area.ixy].map(number);
    say!("moments     ixx {xx}, iyy {yy}, ixy {xy} m⁴ about the centroid");
    say!("polar       {} m⁴ about the centroid", number(area.polar));
    let (largest, smallest) = (number(largest), number(smallest));
    say!("principal   {largest} m⁴ about the axis at {turn}°, {smallest} m⁴ across it");
    say!("mass        {} kg", number(mass.mass));
    say!(
        "inertia     {} kg m² about the centroid",
        number(mass.inertia)
    );
}

/// "x,y x,y x,y".
fn parse(text: &str) -> Result<Vec<Vec2>, Failure> {
    let vertices = text
        .split([' ', '\t', '\n', '\r', ';'])
        .filter(|part| !part.is_empty());
    vertices
        .enumerate()
        .map(|(index, part)| vertex(index, part, ","))
        .collect()
}

/// A vertex a line, comma or space between the numbers, `#` begins a comment.
fn parse_lines(text: &str) -> Result<Vec<Vec2>, Failure> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or("").trim());
    let mut points = Vec::new();
    for line in lines.filter(|line| !line.is_empty()) {
        let between = if line.contains(',') { "," } else { " " };
        points.push(vertex(points.len(), line, between)?);
    }
    Ok(points)
}

fn vertex(index: usize, text: &str, between: &str) -> Result<Vec2, Failure> {
    let Some((x, y)) = text.split_once(between) else {
        fail!("vertex {index}: '{text}' is not of the form x,y");
    };
    let number = |name: &str, text: &str| {
        text.trim().parse::<f64>().map_err(|_| {
            Failure::new(format!(
                "vertex {index}: {name} is '{}', not a number",
                text.trim()
            ))
        })
    };
    Ok(vec2(number("x", x)?, number("y", y)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_come_in_several_dresses() {
        let square = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0)];
        assert_eq!(parse("0,0 1,0 1,1").unwrap(), square);
        assert_eq!(parse(" 0,0;1,0 ;\n1,1\r\n").unwrap(), square);
        assert_eq!(
            parse_lines("\u{feff}# a corner\r\n0, 0\r\n\r\n1 0 # next\n1,1").unwrap(),
            square
        );
    }

    #[test]
    fn a_wrong_vertex_is_named() {
        let line = |text: &str| parse(text).unwrap_err().line();
        assert_eq!(line("0,0 1,0 a,1"), "vertex 2: x is 'a', not a number");
        assert_eq!(line("0,0 10"), "vertex 1: '10' is not of the form x,y");
    }
}
