//! Whatever numbers come in, an answer comes out: `resolve` and `several` panicked where one was NaN.

use carom_math::{Vec2, vec2};

use crate::{
    Friction, HeldFace, HeldPoint, ImpactBody, ImpactContact, ImpactLaw, Several, SharedContact,
    blend, generalised_reflections, held_faces, newton_lcp, resolve, several, swept_faces,
};

/// Numbers by chance, some of them none.
struct Odd(u64);

impl Odd {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).expect("31 bits") % n
    }

    fn number(&mut self) -> f64 {
        const ODD: [f64; 20] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            1e308,
            -1e308,
            5e-324,
            1e-300,
            1e12,
            0.1,
            1e-30,
            1e154,
            2.0,
            -3.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            0.5,
        ];
        const PLAIN: [f64; 8] = [0.0, 1.0, -1.0, 0.5, 2.0, -0.3, 0.1, 3.0];
        if self.below(6) == 0 {
            ODD[self.below(ODD.len())]
        } else {
            PLAIN[self.below(PLAIN.len())]
        }
    }

    fn vector(&mut self) -> Vec2 {
        vec2(self.number(), self.number())
    }

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
        let mut odd = Odd(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
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
