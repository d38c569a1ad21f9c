//! Whatever numbers come in, an answer comes out: `resolve` and `several` panicked where one was NaN.

use carom_math::Vec2;

use carom_impact::{
    Friction, HeldFace, HeldPoint, ImpactBody, ImpactContact, ImpactLaw, Several, SharedContact,
    blend, generalised_reflections, held_faces, newton_lcp, resolve, several, swept_faces,
};

use super::Odd;

impl Odd {
    fn body(&mut self) -> ImpactBody {
        ImpactBody {
            inverse_mass: self.number(),
            inverse_inertia: self.number(),
            centre: self.vector(),
            velocity: self.vector(),
            spin: self.number(),
        }
    }

    fn contact(&mut self) -> ImpactContact {
        ImpactContact {
            point: self.vector(),
            normal: if self.below(2) == 0 {
                Vec2::Y
            } else {
                self.vector()
            },
            restitution: self.number(),
            friction: self.number(),
        }
    }

    fn face(&mut self, shared: &SharedContact) -> HeldFace {
        let friction = self.number();
        HeldFace {
            bodies: (shared.a, shared.b),
            normal: shared.contact.normal,
            friction: if self.below(2) == 0 {
                Friction::Coulomb(friction)
            } else {
                Friction::Given(friction)
            },
            slips: self.number(),
            points: (0..=self.below(2))
                .map(|_| HeldPoint {
                    on: (self.vector(), self.vector()),
                    opens: self.number(),
                })
                .collect(),
            before: [self.number(), self.number(), self.number()],
        }
    }
}

#[test]
fn no_number_makes_an_impact_panic() {
    for seed in 1..4000_u64 {
        let mut odd = Odd::new(seed, 6);
        let count = 2 + odd.below(3);
        let bodies: Vec<ImpactBody> = (0..count).map(|_| odd.body()).collect();
        let contacts: Vec<SharedContact> = (0..=odd.below(5))
            .map(|_| {
                let a = odd.below(count);
                let b = (a + 1 + odd.below(count - 1)) % count;
                SharedContact {
                    a,
                    b,
                    contact: odd.contact(),
                }
            })
            .collect();
        for law in [ImpactLaw::Stronge, ImpactLaw::Poisson, ImpactLaw::Newton] {
            let first = &contacts[0];
            let _ = resolve(law, &bodies[first.a], &bodies[first.b], &first.contact);
            for choice in [Several::Blend, Several::Reflections, Several::NewtonLcp] {
                let _ = several(law, choice, &bodies, &contacts);
            }
        }
        let _ = blend(&bodies, &contacts);
        let _ = generalised_reflections(&bodies, &contacts);
        let _ = newton_lcp(&bodies, &contacts);
        let faces: Vec<HeldFace> = contacts.iter().map(|shared| odd.face(shared)).collect();
        let _ = held_faces(&bodies, &faces);
        let _ = swept_faces(&bodies, &faces);
    }
}
