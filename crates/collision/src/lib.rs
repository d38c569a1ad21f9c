//! carom-collision.
