//! From the tables of a file to a world and its look.

mod boxes;
mod look;
mod material;
mod plain;
mod plan;
mod populate;
mod settings;
mod shape;

use std::collections::BTreeMap;
use std::sync::Arc;

use carom_dynamics::{
    BodyDef, BodyError, BodyId, BodyKind, Filter, Impulse, PairMaterial, RadialField,
    SettingsError, World,
};
use carom_geometry::{Circle, Shape};
use carom_math::Vec2;

use crate::document::Document;
use crate::error::{Problem, SceneError, nearest};
use crate::model::{BodyTable, FieldTable, Kind, SceneFile};
use crate::path::FieldPath;
use crate::{Built, PlainScene, Scene};
use material::Resolved;
use plan::{Planned, Planner};

impl From<Kind> for BodyKind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Dynamic => Self::Dynamic,
            Kind::Fixed => Self::Fixed,
            Kind::Kinematic => Self::Kinematic,
        }
    }
}

/// Builds the world and how it looks.
pub(crate) fn build(scene: &Scene) -> Result<Built, SceneError> {
    let document = &scene.document;
    let mut file = with_parameters(document, &scene.file)?;
    check_times(document, &file)?;
    material::check_all(document, &file)?;
    let plain = plain::lay_under(document, &mut file)?;
    let planned = plan(document, &file, plain.as_ref())?;
    let mut world = new_world(document, &file)?;
    let mut names = Vec::with_capacity(planned.len());
    for body in &planned {
        names.push((body.name.clone(), insert(document, &mut world, body)?));
    }
    pairs(document, &file, &mut world, &names)?;
    look::dress(scene, &file, world, &planned, names)
}

/// The file with the original program's parameters in the places that they name.
fn with_parameters(document: &Document, file: &SceneFile) -> Result<SceneFile, SceneError> {
    let mut file = file.clone();
    let parameters = file.parameters.clone();
    let refuse = |key: &str, reason: &str| {
        let field = FieldPath::root("parameters").key(key);
        Err(document.error(&field, Problem::Refused(reason.to_owned())))
    };
    if let Some(population) = file.population.first_mut() {
        population.count = parameters.n.unwrap_or(population.count);
        population.radius = parameters.radius.unwrap_or(population.radius);
        population.speed = parameters.v.or(population.speed);
    } else if let Some((key, _)) = [
        ("n", parameters.n.is_some()),
        ("radius", parameters.radius.is_some()),
        ("v", parameters.v.is_some()),
    ]
    .iter()
    .find(|(_, given)| *given)
    {
        return refuse(
            key,
            "the scene has no [[population]] that it could be about",
        );
    }
    match (parameters.fnewt, file.field.first_mut()) {
        (Some(strength), Some(field)) => field.strength = strength,
        (Some(_), None) => {
            return refuse("fnewt", "the scene has no [[field]] that it could be about");
        }
        (None, _) => {}
    }
    file.look.stats = parameters.stats.unwrap_or(file.look.stats);
    file.look.face = parameters.face.or(file.look.face);
    Ok(file)
}

fn check_times(document: &Document, file: &SceneFile) -> Result<(), SceneError> {
    /// Ten million seconds: above it frames are counted in billions.
    const LONGEST: f64 = 1e7;
    if file.duration > 0.0 && file.duration <= LONGEST {
        return Ok(());
    }
    let reason = format!(
        "{} s is not above 0 and at most {LONGEST:e} s",
        file.duration
    );
    Err(document.error(&FieldPath::root("duration"), Problem::Refused(reason)))
}

/// All bodies, in the order in which the world gets them.
fn plan(
    document: &Document,
    file: &SceneFile,
    plain: Option<&PlainScene>,
) -> Result<Vec<Planned>, SceneError> {
    let mut planner = Planner {
        document,
        file,
        bodies: Vec::new(),
        vertices: 0,
    };
    if let Some(plain) = plain {
        plain::bodies(&mut planner, plain)?;
    }
    if let Some(table) = &file.walls {
        boxes::walls(&mut planner, table)?;
    }
    for (index, table) in file.field.iter().enumerate() {
        core_of_field(&mut planner, index, table)?;
    }
    for (index, table) in file.body.iter().enumerate() {
        written_body(&mut planner, index, table)?;
    }
    for (index, table) in file.stack.iter().enumerate() {
        boxes::stack(&mut planner, index, table)?;
    }
    for (index, table) in file.pyramid.iter().enumerate() {
        boxes::pyramid(&mut planner, index, table)?;
    }
    for (index, table) in file.grid.iter().enumerate() {
        boxes::grid(&mut planner, index, table)?;
    }
    for (index, table) in file.population.iter().enumerate() {
        populate::populate(&mut planner, index, table)?;
    }
    Ok(planner.bodies)
}

/// The solid core of a field: a fixed disc.
fn core_of_field(
    planner: &mut Planner<'_>,
    index: usize,
    table: &FieldTable,
) -> Result<(), SceneError> {
    if !table.solid || table.strength == 0.0 {
        return Ok(());
    }
    let field = FieldPath::root("field").index(index);
    let disc = Circle::new(table.core)
        .map_err(|error| planner.refuse(&field.key("core"), error.to_string()))?;
    let material = planner.material(&table.material, field.key("material"))?;
    let mut body = Planned::new(format!("core/{index}"), field);
    body.kind = BodyKind::Fixed;
    body.position = table.centre.0;
    body.shapes = vec![(Arc::new(disc.into()), material)];
    body.colour.clone_from(&table.colour);
    planner.add(body)
}

/// A `[[body]]`.
fn written_body(
    planner: &mut Planner<'_>,
    index: usize,
    table: &BodyTable,
) -> Result<(), SceneError> {
    let field = FieldPath::root("body").index(index);
    let document = planner.document;
    let mut material = planner.material(&table.material, field.key("material"))?;
    material.filter = material::filter(document, &table.filter, &field.key("filter"))?;
    let mut body = Planned::new(
        table
            .name
            .clone()
            .unwrap_or_else(|| format!("body/{index}")),
        field.clone(),
    );
    if table.shape.is_some() && !table.shapes.is_empty() {
        let reason = "both shape and shapes are given: put all shapes into the list".to_owned();
        return Err(planner.refuse(&field.key("shapes"), reason));
    }
    let single = table.shape.iter().map(|shape| (shape, field.key("shape")));
    let several = table.shapes.iter().enumerate();
    let several = several.map(|(k, shape)| (shape, field.key("shapes").index(k)));
    for (shape_table, place) in single.chain(several) {
        let mut surface = match &shape_table.material {
            Some(own) => planner.material(own, place.key("material"))?,
            None => material.clone(),
        };
        surface.filter = match &shape_table.filter {
            Some(own) => material::filter(document, own, &place.key("filter"))?,
            None => material.filter,
        };
        body.shapes.push((
            Arc::new(shape::shape(document, shape_table, &place)?),
            surface,
        ));
    }
    if body.shapes.is_empty() {
        let problem = Problem::MissingField("a body needs a shape".to_owned());
        return Err(document.error(&field.key("shape"), problem));
    }
    body.kind = table.kind.into();
    body.position = table.position.map_or(body.position, |position| position.0);
    body.angle = shape::angle(document, &field, "angle", table.angle, table.angle_deg)?;
    body.velocity = table.velocity.map_or(body.velocity, |velocity| velocity.0);
    body.spin = table.spin;
    if body.kind == BodyKind::Fixed {
        still(planner, &body)?;
    }
    body.mass = table.mass;
    body.inertia = table.inertia;
    body.locked_rotation = table.locked_rotation;
    body.gravity_scale = table.gravity_scale;
    body.damping = (table.linear_damping, table.angular_damping);
    body.asleep = table.asleep;
    body.sleep_allowed = table.sleep_allowed;
    body.impulse = table.impulse.map(|impulse| (impulse.at.0, impulse.value.0));
    body.colour.clone_from(&table.colour);
    body.face.clone_from(&table.face);
    planner.add(body)
}

/// Refuses what a fixed body would leave out without a word.
fn still(planner: &Planner<'_>, body: &Planned) -> Result<(), SceneError> {
    let Vec2 { x, y } = body.velocity;
    for (key, value, moves) in [
        (
            "velocity",
            format!("[{x}, {y}]"),
            body.velocity != Vec2::ZERO,
        ),
        ("spin", body.spin.to_string(), body.spin != 0.0),
    ] {
        if moves {
            let reason =
                format!("{value} on a fixed body, which does not move: kind = \"kinematic\" does");
            return Err(planner.refuse(&body.field.key(key), reason));
        }
    }
    Ok(())
}

/// What `[[pair]]` says of two bodies by name.
fn pairs(
    document: &Document,
    file: &SceneFile,
    world: &mut World,
    names: &[(String, BodyId)],
) -> Result<(), SceneError> {
    let mut ids = BTreeMap::new();
    if !file.pair.is_empty() {
        for (name, id) in names {
            ids.entry(name.as_str()).or_insert(*id);
        }
    }
    let mut known_pairs: BTreeMap<(BodyId, BodyId), FieldPath> = BTreeMap::new();
    for (index, table) in file.pair.iter().enumerate() {
        let field = FieldPath::root("pair").index(index);
        let id = |k: usize| {
            let name = &table.bodies[k];
            ids.get(name.as_str()).copied().ok_or_else(|| {
                let known = names.iter().map(|(known, _)| known.as_str());
                let problem = Problem::Unknown {
                    what: "body",
                    nearest: nearest(name, known).map(str::to_owned),
                    expected: Vec::new(),
                };
                document.error(&field.key("bodies").index(k), problem)
            })
        };
        let (a, b) = (id(0)?, id(1)?);
        if let Some(first) = known_pairs.get(&(a.min(b), a.max(b))) {
            let [one, other] = &table.bodies;
            let reason = format!(
                "\"{one}\" and \"{other}\" are already a pair: {}",
                document.words_for(first)
            );
            return Err(document.error(&field.key("bodies"), Problem::Refused(reason)));
        }
        known_pairs.insert((a.min(b), a.max(b)), field.key("bodies"));
        let material = PairMaterial {
            friction: table.friction,
            restitution: table.restitution,
            tangent_speed: table.tangent_speed,
        };
        world.set_pair_material(a, b, material).map_err(|error| {
            let key = match &error {
                BodyError::Restitution { .. } => "restitution",
                BodyError::SameBody(_) => "bodies",
                other => field_of(other).unwrap_or("friction"),
            };
            document.error(&field.key(key), Problem::Refused(error.to_string()))
        })?;
    }
    Ok(())
}

/// Where the file has its gravity.
fn gravity_field(file: &SceneFile) -> FieldPath {
    if file.parameters.fconst.is_some() {
        FieldPath::root("parameters").key("fconst")
    } else {
        FieldPath::root("gravity")
    }
}

fn new_world(document: &Document, file: &SceneFile) -> Result<World, SceneError> {
    let mut world = World::new(settings::settings(file)).map_err(|error| {
        let (SettingsError::NotFinite { field, .. }
        | SettingsError::NotPositive { field, .. }
        | SettingsError::OutOfRange { field, .. }) = &error
        else {
            return document.error(
                &FieldPath::root("settings"),
                Problem::Refused(error.to_string()),
            );
        };
        let path = match *field {
            "tick" if file.parameters.delta.is_some() => FieldPath::root("parameters").key("delta"),
            "gravity.x" => gravity_field(file).index(0),
            "gravity.y" => gravity_field(file).index(1),
            "tick / substep" => FieldPath::root("settings").key("substep"),
            field => field
                .split('.')
                .fold(FieldPath::root("settings"), |path, key| path.key(key)),
        };
        document.error(&path, Problem::Refused(error.to_string()))
    })?;
    for (index, table) in file.field.iter().enumerate() {
        if table.strength == 0.0 {
            continue;
        }
        let path = FieldPath::root("field").index(index);
        let field =
            RadialField::new(table.centre.0, table.strength, table.core).map_err(|error| {
                let key = field_of(&error)
                    .and_then(|name| name.split('.').nth(1))
                    .unwrap_or("strength");
                document.error(&path.key(key), Problem::Refused(error.to_string()))
            })?;
        world.add_field(field);
    }
    Ok(world)
}

fn insert(document: &Document, world: &mut World, body: &Planned) -> Result<BodyId, SceneError> {
    let filter = body.shapes.first();
    let filter = filter.map_or_else(Filter::default, |(_, surface)| surface.filter);
    let def = BodyDef {
        filter,
        position: body.position,
        angle: body.angle,
        velocity: body.velocity,
        spin: body.spin,
        mass: body.mass,
        inertia: body.inertia,
        locked_rotation: body.locked_rotation,
        gravity_scale: body.gravity_scale,
        linear_damping: body.damping.0,
        angular_damping: body.damping.1,
        asleep: body.asleep,
        sleep_allowed: body.sleep_allowed,
        ..BodyDef::new(body.kind)
    };
    let shapes = body.shapes.iter();
    let shapes = shapes
        .map(|(shape, surface)| (Shape::clone(shape), surface.material))
        .collect();
    let refused = |error: BodyError| {
        let (place, reason) = match (&error, body.mass, body.inertia) {
            // What is not in the file follows from the mass, and is 0 where that has no digits left.
            (
                BodyError::NotPositive {
                    field: "inertia", ..
                },
                Some(mass),
                None,
            ) => (
                body.field.key("mass"),
                format!("mass is {mass:?}, too small for the shape: the moment of inertia is 0"),
            ),
            _ => (origin_of(&error, body), error.to_string()),
        };
        let problem = Problem::Refused(format!("{reason} (body \"{}\")", body.name));
        document.error(&place, problem)
    };
    let id = world.insert_compound(def, shapes).map_err(refused)?;
    for (k, (_, surface)) in body.shapes.iter().enumerate() {
        if surface.filter != filter {
            let set = world.set_shape_filter(id, k, surface.filter);
            set.map_err(refused)?;
        }
    }
    if let Some((point, impulse)) = body.impulse {
        world
            .apply(id, Impulse::at(point, impulse))
            .map_err(|error| {
                let problem = Problem::Refused(format!("{error} (body \"{}\")", body.name));
                document.error(&body.field.key("impulse"), problem)
            })?;
    }
    Ok(id)
}

/// Where the file has the value that a body was refused for.
fn origin_of(error: &BodyError, body: &Planned) -> FieldPath {
    let surface = |wrong: &dyn Fn(&Resolved) -> bool| {
        let surfaces = body.shapes.iter().map(|(_, surface)| surface);
        surfaces
            .clone()
            .find(|surface| wrong(surface))
            .or_else(|| surfaces.clone().next())
    };
    let of_material = |key: &str, value: f64| {
        let found = surface(&|surface| {
            let material = &surface.material;
            let held = match key {
                "density" => material.density,
                "friction" => material.friction,
                "tangent_speed" => material.tangent_speed,
                _ => material.restitution,
            };
            held.to_bits() == value.to_bits()
        });
        found.map_or_else(|| body.field.clone(), |surface| surface.field_of(key))
    };
    match *error {
        BodyError::Restitution { value } => of_material("restitution", value),
        BodyError::NoMass { density } => of_material("density", density),
        BodyError::NotFinite { field, value }
        | BodyError::TooLarge { field, value, .. }
        | BodyError::Negative { field, value }
        | BodyError::NotPositive { field, value } => match field {
            "density" | "friction" | "restitution" | "tangent_speed" => of_material(field, value),
            _ => body.field.key(field.split('.').next().unwrap_or(field)),
        },
        _ => body.field.clone(),
    }
}

fn field_of(error: &BodyError) -> Option<&'static str> {
    match error {
        BodyError::NotFinite { field, .. }
        | BodyError::TooLarge { field, .. }
        | BodyError::Negative { field, .. }
        | BodyError::NotPositive { field, .. } => Some(field),
        _ => None,
    }
}
