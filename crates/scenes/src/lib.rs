//! carom-scenes.
