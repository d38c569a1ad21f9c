//! The Routh path: an impact followed through its few straight pieces.
//!
//! While the normal impulse p grows, velocities change linearly as long as the contact slips one
//! way or sticks. In the plane there are at most three such pieces, and one more border where
//! compression ends, so the impact has a closed form that exists, is unique and never gains
//! energy. Source: E. J. Routh, *Dynamics of a System of Rigid Bodies*, 1905; W. J. Stronge 1990.

use super::body::{ImpactContact, Response};

/// When restitution is over.
#[derive(Clone, Copy, Debug)]
pub(super) enum EndRule {
    /// Poisson: impulse of restitution = e × impulse of compression.
    Impulse,
    /// Stronge: work of restitution = e² × work of compression.
    Work,
}

/// Pieces of compression, and of restitution, before the path is given up. There are two of each at most, and no end where numbers
/// are none: then the impulse up to here is the answer.
const PIECES: usize = 8;

/// One straight piece: rates per unit of normal impulse, and how long it lasts.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// `dj_t/dp`.
    friction: f64,
    /// `du_n/dp`.
    normal: f64,
    /// `du_t/dp`.
    tangential: f64,
    /// Normal impulse until the slip ends; infinite if it does not.
    length: f64,
}

/// Whether friction presses a contact that slips together faster than its normal force pushes it apart:
/// no force holds it (Painlevé 1895), only an impulse that ends the slip.
fn jams(k: &Response, contact: &ImpactContact) -> bool {
    k.u_n <= 0.0 && k.u_t != 0.0 && k.k_nn < contact.friction * k.k_nt * k.u_t.signum()
}

/// Normal and tangential impulse on B, in N·s.
///
/// A contact that does not approach gets none, unless it jams.
pub(super) fn follow(k: &Response, contact: &ImpactContact, rule: EndRule) -> (f64, f64) {
    if k.u_n >= 0.0 && !jams(k, contact) || k.k_nn == 0.0 {
        return (0.0, 0.0);
    }
    let mut path = Path {
        k: *k,
        mu: contact.friction,
        p: 0.0,
        j_t: 0.0,
    };
    // Compression: until the normal velocity is zero. A slip can first make it worse (jam).
    let mut work = 0.0;
    for _ in 0..PIECES {
        let piece = path.piece();
        let to_zero = if piece.normal > 0.0 {
            -path.k.u_n / piece.normal
        } else {
            f64::INFINITY
        };
        let step = to_zero.min(piece.length);
        work -= step * (path.k.u_n + 0.5 * piece.normal * step);
        path.advance(&piece, step);
        if to_zero <= piece.length {
            path.k.u_n = 0.0;
            break;
        }
    }
    let e = contact.restitution;
    let mut left = match rule {
        EndRule::Impulse => e * path.p,
        EndRule::Work => e * e * work,
    };
    // Restitution: the rest of the impulse, or of the work, piece by piece.
    let mut pieces = 0;
    while left > 0.0 && pieces < PIECES {
        pieces += 1;
        let piece = path.piece();
        let u = path.k.u_n;
        let whole = match rule {
            EndRule::Impulse => left,
            // ∫ u dp = u δ + u' δ²/2 = left, in the form that does not cancel.
            EndRule::Work => 2.0 * left / (u + (u * u + 2.0 * piece.normal * left).max(0.0).sqrt()),
        };
        let step = whole.min(piece.length);
        path.advance(&piece, step);
        if whole <= piece.length {
            break;
        }
        left -= match rule {
            EndRule::Impulse => step,
            EndRule::Work => step * (u + 0.5 * piece.normal * step),
        };
    }
    (path.p, path.j_t)
}

struct Path {
    k: Response,
    mu: f64,
    p: f64,
    j_t: f64,
}

impl Path {
    /// Slip against friction, stick inside the cone, or the slip that friction cannot hold.
    fn piece(&self) -> Piece {
        let k = &self.k;
        if k.u_t != 0.0 {
            let s = k.u_t.signum();
            let rate = k.k_nt - s * self.mu * k.k_tt;
            let length = if rate * s < 0.0 {
                -k.u_t / rate
            } else {
                f64::INFINITY
            };
            return self.slip(s, length);
        }
        if k.k_nt.abs() <= self.mu * k.k_tt {
            let hold = -k.k_nt / k.k_tt;
            return Piece {
                friction: hold,
                normal: k.k_nn + hold * k.k_nt,
                tangential: 0.0,
                length: f64::INFINITY,
            };
        }
        self.slip(k.k_nt.signum(), f64::INFINITY)
    }

    fn slip(&self, s: f64, length: f64) -> Piece {
        let friction = -s * self.mu;
        Piece {
            friction,
            normal: self.k.k_nn + friction * self.k.k_nt,
            tangential: self.k.k_nt + friction * self.k.k_tt,
            length,
        }
    }

    fn advance(&mut self, piece: &Piece, step: f64) {
        self.p += step;
        self.j_t += piece.friction * step;
        self.k.u_n += piece.normal * step;
        // The end of a slip is a slip of exactly zero.
        self.k.u_t = if step >= piece.length {
            0.0
        } else {
            self.k.u_t + piece.tangential * step
        };
    }
}
