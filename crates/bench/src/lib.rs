//! carom-bench.
