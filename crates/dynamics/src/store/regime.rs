//! Which method moves a body now, and how one method gives it to another.
//!
//! All transitions are made by [`Regime::pass_to`], through the verbs of a body here. These are there:
//!
//! ```text
//! from                                to                                  by
//! Fixed, Kinematic, Free, Held        Fixed, Kinematic, Free              arrive, vanish
//! Fixed, Kinematic, Stepped(All)      Fixed, Kinematic, Stepped(All)      arrive, vanish
//! Analytic(Pending)                Free                                arrive
//! Held                                Free                                take_off
//! Free                                Held, Analytic(Pending)          land
//! Held                                Analytic(Pending)                enter_island
//! Analytic(Pending)                Held                                leave_island
//! Analytic(Pending)                Analytic(Moves)                     begin_analytic_motion
//! Analytic(Moves)                     Analytic(Pending)                land
//! Analytic(Pending)                Analytic(Rests)                     begin_analytic_rest
//! Held                                Stepped(Members)                    join
//! Stepped(Members)                    Held                                leave
//! Held, Analytic(Rests)               Asleep(None)                        fall_asleep
//! Stepped(scope)                      Asleep(Some(scope))                 fall_asleep
//! Asleep(None), Analytic(Rests)       Held                                wake
//! Analytic(Rests)                     Analytic(Pending)                wake
//! Asleep(Some(scope))                 Stepped(scope)                      wake
//! Asleep(Some(Members))               Asleep(None)                        leave
//! ```
//! - A body of another kind keeps its regime until it arrives as what it is then (`World::remake`): a kinematic one may land
//!   before, and a fixed one take off.
//! - Under another gravity bodies arrive one after the other. One that is in an island with earlier ones has left it when its
//!   arrival is over.

use carom_math::SimTime;

use super::bodies::Bodies;
use super::course::Course;
use super::membership::Membership;
use super::state::BodyState;
use crate::{BodyIx, BodyKind, Mode};

/// What moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Regime {
    /// Nothing, ever.
    Fixed,
    /// The velocity that the caller gave it.
    Kinematic,
    /// Its law of flight, until its next event.
    Free,
    /// The closed form of its contact island, until its contact mode changes.
    Analytic(Form),
    /// Nothing yet: it touches something, and gets its method before time goes on.
    Held,
    /// Sub-steps of the engine.
    Stepped(Scope),
    /// Nothing, until it is touched: in the engine, or outside.
    Asleep(Option<Scope>),
}

/// How an analytic island is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// Not yet: it moves or rests before time goes on.
    Pending,
    /// From event to event.
    Moves,
    /// Not at all: it is treated as asleep, but reported awake to the caller until its time.
    Rests,
}

/// Which bodies an engine moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    /// All of a world, in [`Mode::Stepped`].
    All,
    /// Those that joined it, in [`Mode::Hybrid`] and [`Mode::Exact`].
    Members,
}

impl Regime {
    /// Of a body that comes into a world, until it arrives there or falls asleep.
    pub(crate) const fn at_birth(kind: BodyKind, mode: Mode) -> Self {
        match (kind, mode) {
            (BodyKind::Fixed, _) => Self::Fixed,
            (BodyKind::Kinematic, _) => Self::Kinematic,
            (BodyKind::Dynamic, Mode::Stepped) => Self::Stepped(Scope::All),
            (BodyKind::Dynamic, _) => Self::Held,
        }
    }

    /// Another method moves the body from now on: no other function makes a transition.
    pub(crate) fn pass_to(&mut self, next: Self) {
        debug_assert!(
            *self == next || self.may_pass_to(next),
            "no transition leads from {self:?} to {next:?}"
        );
        *self = next;
    }

    /// The table of transitions.
    const fn may_pass_to(self, next: Self) -> bool {
        use Form::{Moves, Pending, Rests};
        use Regime::{Analytic, Asleep, Fixed, Free, Held, Kinematic, Stepped};
        use Scope::{All, Members};
        match self {
            Fixed => matches!(next, Kinematic | Free | Stepped(All)),
            Kinematic => matches!(next, Fixed | Free | Held | Analytic(Pending) | Stepped(All)),
            Free => matches!(next, Fixed | Kinematic | Held | Analytic(Pending)),
            Held => matches!(
                next,
                Fixed | Kinematic | Free | Analytic(Pending) | Stepped(Members) | Asleep(None)
            ),
            Analytic(Pending) => {
                matches!(next, Free | Held | Analytic(Moves | Rests))
            }
            Analytic(Moves) => matches!(next, Analytic(Pending)),
            Analytic(Rests) => matches!(next, Held | Analytic(Pending) | Asleep(None)),
            Stepped(Members) => matches!(next, Held | Asleep(Some(Members))),
            Stepped(All) => matches!(next, Fixed | Kinematic | Asleep(Some(All))),
            Asleep(None) => matches!(next, Held),
            Asleep(Some(Members)) => matches!(next, Stepped(Members) | Asleep(None)),
            Asleep(Some(All)) => matches!(next, Stepped(All)),
        }
    }

    /// What contradicts the other things that a body has, when no call is under way.
    fn check(state: &BodyState, mode: Mode) -> Result<(), &'static str> {
        let regime = state.regime();
        let kind = match regime {
            Self::Fixed => BodyKind::Fixed,
            Self::Kinematic => BodyKind::Kinematic,
            _ => BodyKind::Dynamic,
        };
        if kind != state.kind {
            return Err("what is dynamic is moved by other methods than what is not");
        }
        if matches!(regime, Self::Analytic(_)) != state.membership.is_closed() {
            return Err("analytic bodies have an island, and no others");
        }
        let is_all = match regime {
            Self::Fixed | Self::Kinematic => return Ok(()),
            Self::Stepped(scope) | Self::Asleep(Some(scope)) => scope == Scope::All,
            _ => false,
        };
        if is_all != (mode == Mode::Stepped) {
            return Err("the engine moves all bodies of a stepped world, and only there");
        }
        Ok(())
    }
}

/// What moves it. While a body is remade its kind is newer than its regime: what depends on both asks for both.
impl BodyState {
    /// Nothing moves it until it is touched: asleep, or in an analytic island at rest.
    pub(crate) const fn is_asleep(&self) -> bool {
        matches!(
            self.regime(),
            Regime::Asleep(_) | Regime::Analytic(Form::Rests)
        )
    }

    /// Its analytic island rests: treated as asleep, but reported awake to the caller until its time.
    pub(crate) const fn rests_analytically(&self) -> bool {
        matches!(self.regime(), Regime::Analytic(Form::Rests))
    }

    /// Moves with its analytic island until the island's mode changes.
    pub(crate) const fn moves_analytically(&self) -> bool {
        matches!(self.regime(), Regime::Analytic(Form::Moves))
    }

    /// Moves in closed form from event to event: free, kinematic, or in analytic motion.
    pub(crate) const fn goes_by_events(&self) -> bool {
        matches!(
            self.regime(),
            Regime::Free | Regime::Kinematic | Regime::Analytic(Form::Moves)
        )
    }

    /// Moved by the engine in hybrid mode.
    const fn is_member(&self) -> bool {
        matches!(self.regime(), Regime::Stepped(Scope::Members))
    }

    /// Moved by the engine in hybrid mode, or asleep in it.
    pub(crate) const fn in_engine(&self) -> bool {
        matches!(
            self.regime(),
            Regime::Stepped(Scope::Members) | Regime::Asleep(Some(Scope::Members))
        )
    }

    /// Moves by itself now: neither fixed nor asleep.
    pub(crate) fn is_active(&self) -> bool {
        self.kind != BodyKind::Fixed && !self.is_asleep()
    }

    /// Dynamic, and nothing holds it.
    pub(crate) fn is_free(&self) -> bool {
        self.is_dynamic() && self.goes_by_events()
    }

    /// Dynamic and awake, and not the engine's.
    pub(crate) fn is_outside(&self) -> bool {
        self.is_dynamic() && !self.is_asleep() && !self.in_engine()
    }

    /// Moved by the engine, or without a method until time goes on.
    pub(crate) fn is_stepped(&self) -> bool {
        self.is_active() && !self.goes_by_events()
    }

    /// Dynamic, and gets its method before time goes on.
    pub(crate) fn is_held(&self) -> bool {
        self.is_dynamic() && self.is_stepped() && !self.in_engine()
    }

    /// Held, and in no closed form: no method moves it yet.
    pub(crate) fn is_unsolved(&self) -> bool {
        self.is_held() && !self.membership.is_closed()
    }
}

/// What begins to move it.
impl BodyState {
    /// What is new where it is flies if it moves; in [`Mode::Stepped`] the engine has it, asleep or awake.
    pub(crate) fn arrive(&mut self, mode: Mode) {
        let next = match (self.kind, mode) {
            (BodyKind::Dynamic, Mode::Stepped) if self.is_asleep() => return,
            (BodyKind::Dynamic, Mode::Hybrid | Mode::Exact) => Regime::Free,
            (kind, mode) => Regime::at_birth(kind, mode),
        };
        self.pass_to(next);
    }

    /// What was taken out of the world moves no more.
    pub(crate) fn vanish(&mut self) {
        self.kind = BodyKind::Fixed;
        self.pass_to(Regime::Fixed);
        self.course = Course::default();
    }

    /// Nothing holds it any more.
    pub(crate) fn take_off(&mut self) {
        self.pass_to(Regime::Free);
    }

    /// Something holds it from now on, or its analytic island is given back.
    pub(crate) fn land(&mut self) {
        match self.regime() {
            Regime::Free | Regime::Kinematic => self.pass_to(self.held()),
            Regime::Analytic(Form::Moves) => self.pass_to(Regime::Analytic(Form::Pending)),
            _ => {}
        }
        // Ends of its searches that are entered are stale: a pile that landed leaves nothing in the calendar.
        self.course.entered = (SimTime::NEVER, SimTime::NEVER);
    }

    /// It belongs to an analytic island.
    pub(crate) fn enter_island(&mut self, membership: Membership) {
        self.membership = membership;
        self.pass_to(Regime::Analytic(Form::Pending));
    }

    /// Its analytic island is no more. One at rest is treated as asleep until it wakes.
    pub(crate) fn leave_island(&mut self) {
        self.membership = Membership::default();
        if self.regime() == Regime::Analytic(Form::Pending) {
            self.pass_to(Regime::Held);
        }
    }

    /// Its analytic island moves from now on.
    pub(crate) fn begin_analytic_motion(&mut self) {
        self.pass_to(Regime::Analytic(Form::Moves));
    }

    /// Its analytic island rests from now on.
    pub(crate) fn begin_analytic_rest(&mut self) {
        self.pass_to(Regime::Analytic(Form::Rests));
    }

    /// The engine moves it from now on.
    fn join(&mut self) {
        self.pass_to(Regime::Stepped(Scope::Members));
    }

    /// The engine has it no more.
    fn leave(&mut self) {
        self.pass_to(if self.is_asleep() {
            Regime::Asleep(None)
        } else {
            Regime::Held
        });
    }

    /// It sleeps from now on, where it is; whether something moved it before.
    fn fall_asleep(&mut self) -> bool {
        let rested = self.rests_analytically();
        self.pass_to(match self.regime() {
            Regime::Stepped(scope) => Regime::Asleep(Some(scope)),
            _ => Regime::Asleep(None),
        });
        !rested
    }

    /// What moved a sleeper before moves it again; whether the caller took it for asleep.
    fn wake(&mut self) -> bool {
        let rested = self.rests_analytically();
        self.pass_to(match self.regime() {
            Regime::Asleep(Some(scope)) => Regime::Stepped(scope),
            _ => self.held(),
        });
        !rested
    }

    /// Of a body that gets its method before time goes on: in an island, or outside.
    fn held(&self) -> Regime {
        if self.membership.is_closed() {
            Regime::Analytic(Form::Pending)
        } else {
            Regime::Held
        }
    }
}

/// How many bodies the engine moves in hybrid mode.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Members(usize);

/// The transitions by which bodies become members of the engine, and cease to be: these are counted.
impl Bodies {
    /// How many bodies the engine moves in hybrid mode.
    pub(crate) const fn member_count(&self) -> usize {
        self.members.0
    }

    /// The engine moves a body from now on.
    pub(crate) fn join(&mut self, index: BodyIx) {
        self.count(index, BodyState::join);
    }

    /// The engine has a body no more.
    pub(crate) fn leave(&mut self, index: BodyIx) {
        self.count(index, BodyState::leave);
    }

    /// A body sleeps from now on, where it is; whether something moved it before.
    pub(crate) fn fall_asleep(&mut self, index: BodyIx) -> bool {
        self.count(index, BodyState::fall_asleep)
    }

    /// What moved a sleeper before moves it again; whether the caller took it for asleep.
    pub(crate) fn wake(&mut self, index: BodyIx) -> bool {
        self.count(index, BodyState::wake)
    }

    fn count<T>(&mut self, index: BodyIx, passes: impl FnOnce(&mut BodyState) -> T) -> T {
        let state = self.get_mut(index);
        let before = usize::from(state.is_member());
        let said = passes(state);
        let after = usize::from(state.is_member());
        self.members.0 = self.members.0 + after - before;
        said
    }
}

/// What goes together, in builds that check so.
impl Bodies {
    /// Whether what every body has goes together.
    pub(crate) fn check_regimes(&self, mode: Mode) {
        if cfg!(debug_assertions) {
            let mut members = 0;
            for state in self.iter() {
                self.check_regime(state.id.index, mode);
                members += usize::from(state.is_member());
            }
            assert_eq!(members, self.member_count(), "members are counted");
        }
    }

    /// Whether what a body has goes together.
    pub(crate) fn check_regime(&self, index: BodyIx, mode: Mode) {
        if cfg!(debug_assertions) {
            let state = self.get(index);
            if let Err(why) = Regime::check(state, mode) {
                panic!("{}: {why}", state.id);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Regime; 12] = [
        Regime::Fixed,
        Regime::Kinematic,
        Regime::Free,
        Regime::Analytic(Form::Pending),
        Regime::Analytic(Form::Moves),
        Regime::Analytic(Form::Rests),
        Regime::Held,
        Regime::Stepped(Scope::All),
        Regime::Stepped(Scope::Members),
        Regime::Asleep(None),
        Regime::Asleep(Some(Scope::All)),
        Regime::Asleep(Some(Scope::Members)),
    ];

    /// Where a body of the regime `first` may come to, after any number of transitions.
    fn reached(first: Regime) -> Vec<Regime> {
        let mut found = vec![first];
        let mut next = 0;
        while let Some(&from) = found.get(next) {
            next += 1;
            let more = ALL.into_iter().filter(|to| from.may_pass_to(*to));
            let more: Vec<_> = more.filter(|to| !found.contains(to)).collect();
            found.extend(more);
        }
        found
    }

    #[test]
    fn every_regime_is_reached_and_left() {
        for from in ALL {
            assert_eq!(reached(from).len(), ALL.len(), "from {from:?}");
        }
    }

    #[test]
    fn the_engine_gives_no_member_to_a_closed_form_at_once() {
        for from in [Regime::Stepped(Scope::Members), Regime::Stepped(Scope::All)] {
            for form in [Form::Pending, Form::Moves, Form::Rests] {
                assert!(!from.may_pass_to(Regime::Analytic(form)));
            }
        }
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "no transition leads from Free to Asleep(None)")]
    fn the_top_of_a_throw_is_no_rest() {
        let mut regime = Regime::Free;
        regime.pass_to(Regime::Asleep(None));
    }

    #[test]
    fn a_regime_fills_two_bytes_at_most() {
        assert!(size_of::<Regime>() <= 2, "{}", size_of::<Regime>());
    }
}
