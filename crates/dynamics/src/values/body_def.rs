//! How a body starts.

use carom_math::{Vec2, vec2};

use super::error::{
    BodyError, check_finite, check_mass, check_not_negative, check_positive, check_vec2,
};
use crate::Filter;

/// What moves a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum BodyKind {
    /// Forces, fields and impacts.
    #[default]
    Dynamic,
    /// Nothing: infinite mass, never moves.
    Fixed,
    /// Its own velocity and spin: infinite mass, pushes others and is never pushed.
    Kinematic,
}

/// Definition of a body, to be inserted into a world with its shapes.
///
/// # Examples
/// ```
/// use carom_dynamics::{BodyDef, Material, Settings, World};
/// use carom_geometry::ConvexPolygon;
/// use carom_math::vec2;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = World::new(Settings::default())?;
/// let id = world.insert(
///     BodyDef::dynamic().at(vec2(0.0, 5.0)).moving(vec2(1.0, 0.0)).spinning(0.5),
///     ConvexPolygon::rectangle(2.0, 1.0)?,                     // m
///     Material { density: 3.0, ..Material::default() },        // kg/m²
/// )?;
/// let body = world.body(id).ok_or("just inserted")?;
/// assert!((body.mass() - 6.0).abs() < 1e-14);                  // kg
/// assert!((body.inertia() - 2.5).abs() < 1e-14);               // kg·m², m (w² + h²) / 12
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", default, deny_unknown_fields)
)]
pub struct BodyDef {
    /// What moves the body.
    pub kind: BodyKind,
    /// Where the shapes' own origin is placed, in m.
    pub position: Vec2,
    /// How the shapes are turned about their origin, in rad.
    pub angle: f64,
    /// Velocity of the centre of mass, in m/s.
    pub velocity: Vec2,
    /// Angular velocity, in rad/s, counter-clockwise.
    pub spin: f64,
    /// Mass in kg; `None` takes the shapes' densities.
    pub mass: Option<f64>,
    /// Moment of inertia about the centre of mass, in kg·m²; `None` takes the shapes' (scaled to a given mass).
    pub inertia: Option<f64>,
    /// Centre of mass in the shapes' own frame, in m; `None` takes the shapes' densities.
    pub centre: Option<Vec2>,
    /// Whether the body never turns.
    pub locked_rotation: bool,
    /// Factor on gravity and fields for this body.
    pub gravity_scale: f64,
    /// What the velocity loses by itself: `dv/dt = … − linear_damping · v`, in 1/s, ≥ 0.
    pub linear_damping: f64,
    /// What the spin loses by itself: `dω/dt = … − angular_damping · ω`, in 1/s, ≥ 0.
    pub angular_damping: f64,
    /// Whether the body starts asleep: it stays where it is until something touches it or the caller changes it.
    ///
    /// Without effect where [`Settings::sleep`](crate::Settings::sleep) is off, and on a body that moves, is not
    /// dynamic or [may not sleep](Self::sleep_allowed).
    pub asleep: bool,
    /// Whether the body may fall asleep. One that may not keeps all that it hangs together with awake, too: its island, through
    /// dynamic bodies in touch. Without effect while it is not dynamic.
    pub sleep_allowed: bool,
    /// Collision filter of its shapes.
    pub filter: Filter,
    /// Anything the caller wants to find again.
    pub tag: u64,
}

impl BodyDef {
    /// A body of the given kind at rest at the origin.
    #[must_use]
    pub const fn new(kind: BodyKind) -> Self {
        Self {
            kind,
            position: vec2(0.0, 0.0),
            angle: 0.0,
            velocity: vec2(0.0, 0.0),
            spin: 0.0,
            mass: None,
            inertia: None,
            centre: None,
            locked_rotation: false,
            gravity_scale: 1.0,
            linear_damping: 0.0,
            angular_damping: 0.0,
            asleep: false,
            sleep_allowed: true,
            filter: Filter {
                categories: 1,
                mask: u64::MAX,
                group: 0,
            },
            tag: 0,
        }
    }

    /// A body moved by forces, fields and impacts.
    #[must_use]
    pub const fn dynamic() -> Self {
        Self::new(BodyKind::Dynamic)
    }

    /// A body that never moves.
    #[must_use]
    pub const fn fixed() -> Self {
        Self::new(BodyKind::Fixed)
    }

    /// A body that moves at its own velocity and spin, whatever it meets.
    #[must_use]
    pub const fn kinematic() -> Self {
        Self::new(BodyKind::Kinematic)
    }

    /// Places the shapes' own origin at `position`, in m.
    #[must_use]
    pub const fn at(mut self, position: Vec2) -> Self {
        self.position = position;
        self
    }

    /// Turns the shapes by `angle`, in rad.
    #[must_use]
    pub const fn turned(mut self, angle: f64) -> Self {
        self.angle = angle;
        self
    }

    /// Velocity of the centre of mass, in m/s.
    #[must_use]
    pub const fn moving(mut self, velocity: Vec2) -> Self {
        self.velocity = velocity;
        self
    }

    /// Angular velocity, in rad/s.
    #[must_use]
    pub const fn spinning(mut self, spin: f64) -> Self {
        self.spin = spin;
        self
    }

    /// Gives the mass in kg instead of taking the shapes' densities.
    #[must_use]
    pub const fn with_mass(mut self, mass: f64) -> Self {
        self.mass = Some(mass);
        self
    }

    /// Gives the moment of inertia about the centre of mass, in kg·m².
    #[must_use]
    pub const fn with_inertia(mut self, inertia: f64) -> Self {
        self.inertia = Some(inertia);
        self
    }

    /// Gives the centre of mass in the shapes' own frame, in m, instead of taking the shapes' densities. A moment of
    /// inertia that follows from these is about it.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{BodyDef, Material, Settings, World};
    /// use carom_geometry::ConvexPolygon;
    /// use carom_math::vec2;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut world = World::new(Settings::default())?;
    /// let weighted = BodyDef::dynamic().at(vec2(0.0, 5.0)).with_centre(vec2(0.5, 0.0));
    /// let plank = ConvexPolygon::rectangle(2.0, 1.0)?;             // m
    /// let id = world.insert(weighted, plank, Material { density: 3.0, ..Material::default() })?;
    /// let body = world.body(id).ok_or("just inserted")?;
    /// assert_eq!(body.centre(), vec2(0.5, 5.0));
    /// assert_eq!(body.pose().position, vec2(0.0, 5.0));
    /// assert!((body.inertia() - 4.0).abs() < 1e-14);               // kg·m², m (w² + h²) / 12 + m 0.5²
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub const fn with_centre(mut self, centre: Vec2) -> Self {
        self.centre = Some(centre);
        self
    }

    /// The body never turns.
    #[must_use]
    pub const fn with_locked_rotation(mut self) -> Self {
        self.locked_rotation = true;
        self
    }

    /// Factor on gravity and fields.
    #[must_use]
    pub const fn with_gravity_scale(mut self, scale: f64) -> Self {
        self.gravity_scale = scale;
        self
    }

    /// What velocity and spin lose by themselves, in 1/s: see [`Self::linear_damping`].
    #[must_use]
    pub const fn damped(mut self, linear: f64, angular: f64) -> Self {
        self.linear_damping = linear;
        self.angular_damping = angular;
        self
    }

    /// The body starts asleep, with [what that asks for](Self::asleep).
    #[must_use]
    pub const fn asleep(mut self) -> Self {
        self.asleep = true;
        self
    }

    /// Whether the body may fall asleep, with [what that means for others](Self::sleep_allowed).
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{BodyDef, Material, Settings, World};
    /// use carom_geometry::{ConvexPolygon, HalfPlane};
    /// use carom_math::{Vec2, vec2};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut world = World::new(Settings::default())?;
    /// world.insert(BodyDef::fixed(), HalfPlane::new(Vec2::ZERO, Vec2::Y)?, Material::default())?;
    /// let crate_ = ConvexPolygon::rectangle(1.0, 1.0)?;            // m
    /// let watched = BodyDef::dynamic().at(vec2(0.0, 0.5)).with_sleep_allowed(false);
    /// let watched = world.insert(watched, crate_.clone(), Material::default())?;
    /// let other = world.insert(BodyDef::dynamic().at(vec2(5.0, 0.5)), crate_, Material::default())?;
    /// world.step(2.0);                                             // s
    /// assert!(!world.body(watched).ok_or("it is there")?.is_asleep());
    /// assert!(world.body(other).ok_or("it is there")?.is_asleep());
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub const fn with_sleep_allowed(mut self, allowed: bool) -> Self {
        self.sleep_allowed = allowed;
        self
    }

    /// Collision filter of its shapes.
    #[must_use]
    pub const fn filtered(mut self, filter: Filter) -> Self {
        self.filter = filter;
        self
    }

    /// Anything the caller wants to find again.
    #[must_use]
    pub const fn tagged(mut self, tag: u64) -> Self {
        self.tag = tag;
        self
    }

    pub(crate) fn check(&self) -> Result<(), BodyError> {
        check_vec2("position.x", "position.y", self.position)?;
        check_finite("angle", self.angle)?;
        check_vec2("velocity.x", "velocity.y", self.velocity)?;
        check_finite("spin", self.spin)?;
        check_finite("gravity_scale", self.gravity_scale)?;
        check_not_negative("linear_damping", self.linear_damping)?;
        check_not_negative("angular_damping", self.angular_damping)?;
        if let Some(centre) = self.centre {
            check_vec2("centre.x", "centre.y", centre)?;
        }
        for (field, given) in [("mass", self.mass), ("inertia", self.inertia)] {
            if let Some(value) = given {
                check_mass(field, value)?;
                check_positive(field, value)?;
            }
        }
        Ok(())
    }
}

impl Default for BodyDef {
    fn default() -> Self {
        Self::dynamic()
    }
}
