//! Gravity and fields.

use std::sync::Arc;

use carom_math::Vec2;

use crate::Field;

/// What pulls on every body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pull {
    pub(crate) gravity: Vec2,
    pub(crate) fields: Vec<Arc<dyn Field>>,
    /// What a flight in a field may leave out, in m/s.
    pub(crate) error: f64,
}

impl Pull {
    /// Acceleration by gravity and fields at `position`, before the body's own scale.
    pub(crate) fn at(&self, position: Vec2) -> Vec2 {
        let fields = self.fields.iter();
        fields.fold(self.gravity, |sum, field| {
            sum + field.acceleration(position)
        })
    }

    /// Potential of gravity and fields, in J/kg.
    pub(crate) fn potential(&self, position: Vec2) -> f64 {
        let fields = self.fields.iter();
        fields.fold(-self.gravity.dot(position), |sum, field| {
            sum + field.potential(position)
        })
    }

    /// Bound on the gradient of all fields, in 1/s².
    pub(crate) fn gradient_bound(&self, position: Vec2, radius: f64) -> f64 {
        let fields = self.fields.iter();
        fields
            .map(|field| field.gradient_bound(position, radius))
            .sum()
    }
}
