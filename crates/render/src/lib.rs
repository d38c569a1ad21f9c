//! carom-render.
