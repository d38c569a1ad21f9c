//! Two bodies at one point: the variables of an impact.

use carom_geometry::MassProperties;
use carom_math::{Sum, Vec2, cross, cross_scalar, perp, two_product};

/// A body in the instant of an impact.
///
/// The thesis's variables (section 3.3): `velocity` is v⃗ₐ₁, `spin` ωₐ₁, and r⃗ₐₚ follows from `centre`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactBody {
    /// 1/m in kg⁻¹; 0 for a body that cannot be moved.
    pub inverse_mass: f64,
    /// 1/I in kg⁻¹·m⁻²; 0 for a body that cannot be turned.
    pub inverse_inertia: f64,
    /// Centre of mass, in m.
    pub centre: Vec2,
    /// Velocity of the centre of mass, in m/s.
    pub velocity: Vec2,
    /// Angular velocity, in rad/s.
    pub spin: f64,
}

impl ImpactBody {
    /// A free body with the given mass and inertia, and its centre of mass at `centre`.
    #[must_use]
    pub fn free(mass: MassProperties, centre: Vec2, velocity: Vec2, spin: f64) -> Self {
        Self {
            inverse_mass: mass.mass.recip(),
            inverse_inertia: mass.inertia.recip(),
            centre,
            velocity,
            spin,
        }
    }

    /// A body of infinite mass that moves as it likes.
    #[must_use]
    pub const fn immovable(centre: Vec2, velocity: Vec2, spin: f64) -> Self {
        Self {
            inverse_mass: 0.0,
            inverse_inertia: 0.0,
            centre,
            velocity,
            spin,
        }
    }

    /// Velocity of the body's point at `point`, in m/s.
    #[must_use]
    pub fn velocity_of(&self, point: Vec2) -> Vec2 {
        self.velocity + cross_scalar(self.spin, point - self.centre)
    }

    /// The same body where it is, at another velocity, in m/s, and spin, in rad/s.
    #[must_use]
    pub const fn moving(&self, velocity: Vec2, spin: f64) -> Self {
        Self {
            velocity,
            spin,
            ..*self
        }
    }

    /// The same body where it is, without its motion.
    #[must_use]
    pub const fn at_rest(&self) -> Self {
        self.moving(Vec2::ZERO, 0.0)
    }

    /// Whether it is of infinite mass, and on the move.
    #[must_use]
    pub fn drives(&self) -> bool {
        self.inverse_mass == 0.0 && (self.velocity != Vec2::ZERO || self.spin != 0.0)
    }

    /// Most speed that an impulse of 1 N·s at `point` gives that point, in m/s.
    pub(super) fn yields_at(&self, point: Vec2) -> f64 {
        self.inverse_mass + (point - self.centre).length_squared() * self.inverse_inertia
    }

    /// ½ m v² + ½ I ω² in J; 0 for a body of infinite mass.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        let half = |inverse: f64| if inverse > 0.0 { 0.5 / inverse } else { 0.0 };
        half(self.inverse_mass) * self.velocity.length_squared()
            + half(self.inverse_inertia) * self.spin * self.spin
    }

    pub(crate) fn pushed(&self, impulse: Vec2, point: Vec2) -> Self {
        let turn = cross(point - self.centre, impulse);
        self.moving(
            self.velocity + impulse * self.inverse_mass,
            self.spin + turn * self.inverse_inertia,
        )
    }
}

/// Whether two of the bodies do not yield and move differently, as a paddle and a floor do: only these can squeeze others.
///
/// Impulses that leave all other bodies as they are, and push against what closes, push along with the difference of two
/// unyielding ones: at rest relative to each other there are none.
#[must_use]
pub fn is_driven<'a>(bodies: impl IntoIterator<Item = &'a ImpactBody>) -> bool {
    let mut unyielding = bodies
        .into_iter()
        .filter(|body| body.inverse_mass == 0.0 && body.inverse_inertia == 0.0)
        .map(|body| (body.velocity, body.spin));
    let first = unyielding.next();
    unyielding.any(|other| Some(other) != first)
}

/// Where and how two bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactContact {
    /// Point of contact, in m.
    pub point: Vec2,
    /// Unit normal from A to B.
    pub normal: Vec2,
    /// Coefficient of restitution of the pair, 0..1.
    pub restitution: f64,
    /// Coefficient of Coulomb friction of the pair, ≥ 0.
    pub friction: f64,
}

/// What an impact did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Impulse on B along the normal, in N·s; A gets the opposite. 0 if the bodies do not approach.
    pub normal_impulse: f64,
    /// Impulse on B along the normal turned by +90 degrees, in N·s.
    pub tangential_impulse: f64,
    /// A after the impact.
    pub a: ImpactBody,
    /// B after the impact.
    pub b: ImpactBody,
    /// Energy lost, in J: minus impulse times mean relative velocity.
    pub loss: f64,
}

impl Outcome {
    /// ±J applied once to both bodies; velocities are not corrected afterwards.
    pub(super) fn of(
        a: &ImpactBody,
        b: &ImpactBody,
        contact: &ImpactContact,
        (normal_impulse, tangential_impulse): (f64, f64),
    ) -> Self {
        let point = contact.point;
        let impulse = contact.normal * normal_impulse + perp(contact.normal) * tangential_impulse;
        let after = (a.pushed(-impulse, point), b.pushed(impulse, point));
        Self::between(a, b, contact, (normal_impulse, tangential_impulse), after)
    }

    /// Velocities before and after, and what that cost.
    fn between(
        a: &ImpactBody,
        b: &ImpactBody,
        contact: &ImpactContact,
        (normal_impulse, tangential_impulse): (f64, f64),
        (after_a, after_b): (ImpactBody, ImpactBody),
    ) -> Self {
        let point = contact.point;
        let impulse = contact.normal * normal_impulse + perp(contact.normal) * tangential_impulse;
        let before = b.velocity_of(point) - a.velocity_of(point);
        let after = after_b.velocity_of(point) - after_a.velocity_of(point);
        Self {
            normal_impulse,
            tangential_impulse,
            a: after_a,
            b: after_b,
            loss: -0.5 * impulse.dot(before + after),
        }
    }
}

impl Outcome {
    /// The impact where nothing rubs, by the one law there is: `u_n⁺ = −e u_n⁻`.
    ///
    /// A factor 1 + ε on the impulse of an elastic impact gives ε of the energy `2 u_n²/K` that goes to and fro.
    /// So what rounds the same way for a pair, an edge or all turned normals adds up over millions of
    /// impacts. Therefore K is summed with twice the digits, and with the true n², which is short of 1 by
    /// 3e-17 in the mean; and each body's share of the bounce is a quotient that is rounded once.
    ///
    /// ```text
    /// Δv_b = n w / (m_b K)        w = −(1 + e) u_n,  K = (1/m_a + 1/m_b) n² + (r_a×n)²/I_a + (r_b×n)²/I_b
    /// ```
    /// What strikes something immovable along its normal leaves with −e times its speed, to the last bit.
    pub(super) fn smooth(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Self {
        let (point, n) = (contact.point, contact.normal);
        let u = (b.velocity_of(point) - a.velocity_of(point)).dot(n);
        let mut over = Sum::ZERO; // n² − 1
        over.add(-1.0);
        over.add_product(n.x, n.x);
        over.add_product(n.y, n.y);
        let over = over.value();
        let mut k = Sum::ZERO;
        for body in [a, b] {
            let arm = cross(point - body.centre, n);
            k.add(body.inverse_mass);
            k.add(body.inverse_mass * over);
            k.add_product(arm * body.inverse_inertia, arm);
        }
        let high = k.value();
        if u >= 0.0 || high == 0.0 {
            return Self::of(a, b, contact, (0.0, 0.0));
        }
        k.add(-high);
        let low = k.value();
        let w = -(1.0 + contact.restitution) * u;
        // q K = w x but for a rest, which moves q to its neighbour where that is nearer.
        let share = |x: f64| {
            let (wanted, rest) = two_product(w, x);
            let q = wanted / high;
            let (product, error) = two_product(q, high);
            q + ((((wanted - product) - error) + rest) - q * low) / high
        };
        let impulse = share(1.0);
        let pushed = |body: &ImpactBody, sign: f64| {
            let turn = cross(point - body.centre, n * (sign * impulse));
            body.moving(
                body.velocity + n * (sign * share(body.inverse_mass)),
                body.spin + turn * body.inverse_inertia,
            )
        };
        Self::between(
            a,
            b,
            contact,
            (impulse, 0.0),
            (pushed(a, -1.0), pushed(b, 1.0)),
        )
    }
}

/// Relative velocity and its response to impulses, in the frame of the contact.
///
/// Δu = K j with u = (normal, tangential) velocity of B's point minus A's:
/// `K_nn = 1/m_a + 1/m_b + (r_a×n)²/I_a + (r_b×n)²/I_b`, the others alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Response {
    pub(crate) u_n: f64,
    pub(crate) u_t: f64,
    pub(crate) k_nn: f64,
    pub(crate) k_nt: f64,
    pub(crate) k_tt: f64,
}

impl Response {
    pub(crate) fn of(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Self {
        let (n, t) = (contact.normal, perp(contact.normal));
        let (r_a, r_b) = (contact.point - a.centre, contact.point - b.centre);
        let u = b.velocity_of(contact.point) - a.velocity_of(contact.point);
        let (an, at) = (cross(r_a, n), cross(r_a, t));
        let (bn, bt) = (cross(r_b, n), cross(r_b, t));
        let (m_a, m_b) = (a.inverse_mass, b.inverse_mass);
        let (i_a, i_b) = (a.inverse_inertia, b.inverse_inertia);
        // A's share and B's share: swapping the bodies swaps two terms, and no bit changes.
        Self {
            u_n: u.dot(n),
            u_t: u.dot(t),
            k_nn: (m_a + an * an * i_a) + (m_b + bn * bn * i_b),
            k_nt: an * at * i_a + bn * bt * i_b,
            k_tt: (m_a + at * at * i_a) + (m_b + bt * bt * i_b),
        }
    }
}
