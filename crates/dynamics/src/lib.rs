//! carom-dynamics.
