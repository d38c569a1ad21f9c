//! Compares the plain scenes with published data, bit for bit: `cargo run -p carom-scenes --example check_scenes -- DIR`.
//!
//! A file a scene, `NAME.json`: an object with `gravity`, `materials`, `shapes`, `bodies`, and what [`PlainScene`] has
//! besides. Each line names a scene, the digest of the file's data and what differs first.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainMaterial, PlainScene, PlainShape, plain_scenes};
use serde_json::Value;

type Read<T> = Result<T, Box<dyn Error>>;

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1) else {
        eprintln!("usage: check_scenes DIR");
        return ExitCode::from(2);
    };
    let mut equal = true;
    for info in plain_scenes() {
        let path = Path::new(&folder).join(format!("{}.json", info.name));
        match read(&path) {
            Ok(published) => {
                let verdict = difference(&published, &info.scene());
                equal &= verdict.is_none();
                let verdict = verdict.unwrap_or_else(|| "equal".to_owned());
                println!("{:<20} {:#018x} {verdict}", info.name, published.digest());
            }
            Err(error) => {
                equal = false;
                println!("{:<20} {}: {error}", info.name, path.display());
            }
        }
    }
    ExitCode::from(u8::from(!equal))
}

/// What differs first, by value; the digest decides about signs of zero.
fn difference(published: &PlainScene, ours: &PlainScene) -> Option<String> {
    let about = |scene: &PlainScene| PlainScene {
        materials: Vec::new(),
        shapes: Vec::new(),
        outlines: Vec::new(),
        bodies: Vec::new(),
        ..scene.clone()
    };
    if about(published) != about(ours) {
        return Some(format!("{:?} is {:?}", about(published), about(ours)));
    }
    first("material", &published.materials, &ours.materials)
        .or_else(|| first("shape", &published.shapes, &ours.shapes))
        .or_else(|| first("outline", &published.outlines, &ours.outlines))
        .or_else(|| first("body", &published.bodies, &ours.bodies))
        .or_else(|| (published.digest() != ours.digest()).then(|| "the sign of a zero".to_owned()))
}

fn first<T: PartialEq + std::fmt::Debug>(
    what: &str,
    published: &[T],
    ours: &[T],
) -> Option<String> {
    if published.len() != ours.len() {
        return Some(format!("{} of {what} are {}", published.len(), ours.len()));
    }
    let mut pairs = published.iter().zip(ours).enumerate();
    let (index, (a, b)) = pairs.find(|(_, (a, b))| a != b)?;
    let differing = published.iter().zip(ours).filter(|(a, b)| a != b).count();
    Some(format!(
        "{differing} of {what} differ, first {index}: {a:?} is {b:?}"
    ))
}

fn read(path: &Path) -> Read<PlainScene> {
    let data: Value = serde_json::from_str(&fs::read_to_string(path)?)?;
    let name = data["scene"].as_str().ok_or("no name")?;
    let mut scene = PlainScene::empty(name, point(&data["gravity"])?);
    if !data["dt"].is_null() {
        scene.dt = number(&data["dt"])?;
        scene.warm_up_steps = u32::try_from(whole(&data["warm_up_steps"])?)?;
        scene.measured_steps = u32::try_from(whole(&data["measured_steps"])?)?;
    }
    scene.sleeping = data["sleeping"].as_bool().ok_or("sleeping is no boolean")?;
    if let [x0, y0, x1, y1] = &data["region"].as_array().map_or(&[][..], Vec::as_slice) {
        let low = vec2(number(x0)?, number(y0)?);
        scene.region = Some([low, vec2(number(x1)?, number(y1)?)]);
    }
    scene.materials = all(&data["materials"], |material| {
        Ok(PlainMaterial {
            density: number(&material["density"])?,
            friction: number(&material["friction"])?,
            restitution: number(&material["restitution"])?,
        })
    })?;
    scene.shapes = all(&data["shapes"], shape)?;
    if !data["outlines"].is_null() {
        scene.outlines = all(&data["outlines"], |ring| all(ring, point))?;
    }
    scene.bodies = all(&data["bodies"], body)?;
    Ok(scene)
}

fn body(data: &Value) -> Read<PlainBody> {
    let kind = match data["kind"].as_str() {
        Some("fixed") => PlainKind::Fixed,
        Some("dynamic") => PlainKind::Dynamic,
        Some("kinematic") => PlainKind::Kinematic,
        other => return Err(format!("unknown kind {other:?}").into()),
    };
    let material = whole(&data["material"])?;
    let mut body = PlainBody::new(kind, point(&data["position"])?, material)
        .turned(number(&data["angle"])?)
        .moving(point(&data["velocity"])?)
        .spinning(number(&data["angular"])?);
    body.shapes = all(&data["shapes"], whole)?;
    body.asleep = data["asleep"].as_bool().unwrap_or(false);
    if !data["outline"].is_null() {
        body.outline = Some(whole(&data["outline"])?);
    }
    Ok(body)
}

fn shape(data: &Value) -> Read<PlainShape> {
    let (kind, value) = data
        .as_object()
        .and_then(|object| object.iter().find(|(key, _)| *key != "offset"))
        .ok_or("an empty shape")?;
    Ok(match kind.as_str() {
        "circle" => PlainShape::Circle {
            radius: number(value)?,
        },
        "box" => PlainShape::Box {
            half: point(value)?,
            offset: match &data["offset"] {
                Value::Null => Vec2::ZERO,
                offset => point(offset)?,
            },
        },
        "polygon" => PlainShape::Polygon(all(value, point)?),
        "segment" => PlainShape::Segment([point(&value[0])?, point(&value[1])?]),
        other => return Err(format!("unknown shape {other}").into()),
    })
}

fn all<T>(data: &Value, read: impl Fn(&Value) -> Read<T>) -> Read<Vec<T>> {
    data.as_array().ok_or("no list")?.iter().map(read).collect()
}

fn point(data: &Value) -> Read<Vec2> {
    Ok(vec2(number(&data[0])?, number(&data[1])?))
}

fn number(data: &Value) -> Read<f64> {
    data.as_f64()
        .ok_or_else(|| format!("{data} is no number").into())
}

fn whole(data: &Value) -> Read<usize> {
    let value = data
        .as_u64()
        .ok_or_else(|| format!("{data} is no whole number"))?;
    Ok(usize::try_from(value)?)
}
