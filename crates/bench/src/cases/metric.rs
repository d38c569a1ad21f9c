//! What a case measures.

/// A number that a case gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Metric {
    /// As the tables write it.
    pub name: &'static str,
    /// SI, or `1` for ratios and counts.
    pub unit: &'static str,
    /// How to read it.
    pub kind: Kind,
    /// What a table says where a run that came to its end has no such number: `never`, `refused`.
    pub missing: &'static str,
}

/// How a number is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 0 is right: it goes into charts, and its order of convergence is looked at.
    Error,
    /// A measured value; the text says what is right.
    Value,
}

impl Metric {
    pub(super) const fn error(name: &'static str, unit: &'static str) -> Self {
        Self {
            name,
            unit,
            kind: Kind::Error,
            missing: "none",
        }
    }

    pub(super) const fn value(name: &'static str, unit: &'static str) -> Self {
        Self {
            kind: Kind::Value,
            ..Self::error(name, unit)
        }
    }

    pub(super) const fn or(self, missing: &'static str) -> Self {
        Self { missing, ..self }
    }
}
