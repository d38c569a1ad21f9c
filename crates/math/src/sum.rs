//! Sums that keep what plain addition loses.

/// `a + b` as the rounded sum and its exact error (D. Knuth, TAOCP vol. 2, 4.2.2).
#[must_use]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// `a · b` as the rounded product and its exact error (T. J. Dekker, 1971).
///
/// Exact while neither factor exceeds 1e290 and the product does not underflow.
#[must_use]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

/// Halves of 26 bits each, so that products of halves are exact (G. W. Veltkamp, 1968).
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

/// A running sum with twice the digits: the lost parts are kept in a second number.
///
/// Error of the total: one rounding, plus n² 2⁻¹⁰⁶ of the sum of absolute values.
/// Source: T. Ogita, S. M. Rump, S. Oishi, *Accurate sum and dot product*, 2005.
///
/// # Examples
/// ```
/// use carom_math::Sum;
/// let mut sum = Sum::ZERO;
/// for term in [1e16, 1.0, -1e16] {
///     sum.add(term);
/// }
/// assert_eq!(sum.value(), 1.0);                               // plain addition gives 0
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    /// The empty sum.
    pub const ZERO: Self = Self {
        high: 0.0,
        low: 0.0,
    };

    /// Adds `term`.
    pub fn add(&mut self, term: f64) {
        let (high, error) = two_sum(self.high, term);
        self.high = high;
        self.low += error;
    }

    /// Adds the exact product `a · b`.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let (product, error) = two_product(a, b);
        self.add(product);
        self.low += error;
    }

    /// The sum, rounded once.
    #[must_use]
    pub fn value(self) -> f64 {
        self.high + self.low
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::ZERO;
        for term in terms {
            sum.add(term);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn exact_product_recovers_the_lost_bits() {
        let a = 1.0 + f64::EPSILON;
        let (product, error) = two_product(a, a);
        assert_eq!(product, 1.0 + 2.0 * f64::EPSILON);
        assert_eq!(error, f64::EPSILON * f64::EPSILON);
    }

    proptest! {
        #[test]
        fn a_shuffled_cancelling_sum_is_exact(terms in prop::collection::vec(-1e12..1e12_f64, 1..200)) {
            let forth: Sum = terms.iter().copied().chain([0.125]).collect();
            let mut both = forth;
            for term in terms.iter().rev() {
                both.add(-term);
            }
            prop_assert_eq!(both.value(), 0.125);
        }
    }
}
