//! carom-geometry.
