//! What is kept of a body beside its line.

use carom_math::{Pose, trig};

use crate::input::BodyKind;
use crate::rows::{Line, Quad};
use crate::{BodyIx, Entry, IslandIx, LineIx, PieceIx};

/// What is kept of a body, awake or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) generation: u32,
    pub(crate) kind: BodyKind,
    pub(crate) live: bool,
    /// Its island may fall asleep.
    pub(crate) sleep_allowed: bool,
    /// Its line: [`LineIx::GROUND`] if fixed.
    pub(crate) line: LineIx,
    /// Number of its first piece, and how many it has.
    pub(crate) first_piece: PieceIx,
    pub(crate) count: u32,
    /// Counts insertions: the order of bodies that recycled slots cannot change.
    pub(crate) birth: u64,
    /// Which update of contacts was the next when it was put where it is or was: see [`Bodies::updates`](crate::bodies::Bodies::updates).
    pub(crate) placed: u64,
    /// Head of the list of its contacts.
    pub(crate) contacts: Entry,
    /// A bit for each colour that has a contact of it.
    pub(crate) colours: u64,
    /// Where a fixed body is; others have theirs by line.
    pub(crate) pose: Pose,
    /// Angle by which it has turned, in rad, whole turns included: of what has no line of its own.
    pub(crate) turned: f64,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    pub(crate) gravity_scale: f64,
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// The island that it sleeps in, or [`IslandIx::NONE`].
    pub(crate) island: IslandIx,
    /// What velocity and spin lose by themselves, in 1/s.
    pub(crate) damping: [f64; 2],
    pub(crate) tag: u64,
}

/// A body without its line: what waking puts back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sleeper {
    pub(crate) slot: BodyIx,
    pub(crate) line: Line,
    pub(crate) start: Quad,
    pub(crate) pull: Quad,
    pub(crate) base: Pose,
    pub(crate) turned: f64,
    pub(crate) limit: Limit,
    /// Its contacts are not those of where it lies.
    pub(crate) moved: bool,
}

impl Sleeper {
    /// Whether it was put to sleep before its contacts were found.
    pub(crate) const fn is_unmet(&self) -> bool {
        self.moved
    }
}

/// How far a body may go from its base pose before its contacts are computed anew.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// In m.
    pub(crate) tolerance: f64,
    /// Of its smallest piece, in m.
    pub(crate) extent: f64,
}

/// A body that moves by less than this part of its least half width is not fast: rows hold it. 0.1: a drum takes twice the time;
/// 0.5: no difference in time, but a body may move by half of itself unsearched.
pub(crate) const FAST: f64 = 0.25;

/// Contacts of a body are computed anew within a tick once its turn bends the path of a point by this part of a margin. A box of
/// 1 m by 0.5 m that lands on its edge at 20 m/s sinks in by 0.30 mm; 1: by 0.43; 0.06: by 0.25. Times do not differ.
pub(crate) const BEND: f64 = 0.25;

impl Limit {
    /// Whether a displacement, squared, or a turn is so large that the body may pass through another one.
    #[inline]
    pub(crate) fn is_far(&self, square: f64, turn: f64) -> bool {
        let least = self.near();
        square > least * least || turn.abs() * self.reach > least
    }

    /// How far a body that is not fast goes within a sub-step, in m.
    #[inline]
    pub(crate) fn near(&self) -> f64 {
        FAST * 0.5 * self.extent
    }

    /// Whether a body deviates from its rows by a part of a margin that counts: it will be `off` metres from its predicted
    /// motion, or has turned so far since its base pose.
    #[inline]
    pub(crate) fn deviates(&self, margin: f64, off: f64, turn: f64) -> bool {
        let most = margin * self.extent;
        // Rows are straight: what turned by θ is off them by r θ²/2.
        off > most || 0.5 * turn * turn * self.reach > BEND * most
    }
}

/// What a sub-step of `h` seconds leaves of velocity and spin that lose `rates` of themselves in a second, and what part of
/// their accelerations it adds: `v' = a − c v` gives `v(h) = e^(−ch) v + h a (1 − e^(−ch))/(ch)`.
pub(crate) fn drag(rates: [f64; 2], h: f64) -> [Quad; 2] {
    let [linear, angular] = rates.map(|rate| {
        let loss = rate * h;
        if loss > 0.0 {
            (trig::exp(-loss), -trig::exp_m1(-loss) / loss)
        } else {
            (1.0, 1.0)
        }
    });
    [
        Quad([linear.0, linear.0, angular.0, 1.0]),
        Quad([linear.1, linear.1, angular.1, 1.0]),
    ]
}

/// [`drag`] of what is not damped.
pub(crate) const UNDAMPED: [Quad; 2] = [Quad([1.0; 4]); 2];

impl Record {
    /// Numbers of its pieces.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = PieceIx> + Clone + use<> {
        self.first_piece.run(self.count)
    }

    pub(crate) const NONE: Self = Self {
        generation: 0,
        kind: BodyKind::Fixed,
        live: false,
        sleep_allowed: true,
        line: LineIx::NONE,
        first_piece: PieceIx(0),
        count: 0,
        birth: 0,
        placed: 0,
        contacts: Entry::NONE,
        colours: 0,
        pose: Pose::IDENTITY,
        turned: 0.0,
        mass: f64::INFINITY,
        inertia: f64::INFINITY,
        gravity_scale: 0.0,
        reach: 0.0,
        island: IslandIx::NONE,
        damping: [0.0; 2],
        tag: 0,
    };
}
