//! Threads that a step may use: with the cargo feature `parallel`, a pool of the world's own.

use crate::values::error::SettingsError;

/// A pool, if there is more than one thread to use. Copies of a world share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Threads {
    #[cfg(feature = "parallel")]
    pool: Option<std::sync::Arc<rayon::ThreadPool>>,
}

#[cfg(feature = "parallel")]
impl Threads {
    pub(crate) fn new(count: usize) -> Result<Self, SettingsError> {
        if count == 1 {
            return Ok(Self::default());
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|error| SettingsError::Threads {
            threads: count,
            reason: error.to_string(),
        })?;
        Ok(Self {
            pool: Some(std::sync::Arc::new(pool)),
        })
    }

    /// Runs `f` where it may use them.
    pub(crate) fn run<R: Send>(&self, f: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(f),
            None => f(),
        }
    }
}

#[cfg(not(feature = "parallel"))]
impl Threads {
    #[expect(clippy::unnecessary_wraps, reason = "with threads this may fail")]
    pub(crate) const fn new(_: usize) -> Result<Self, SettingsError> {
        Ok(Self {})
    }

    #[expect(clippy::unused_self, reason = "with threads there is a pool")]
    pub(crate) fn run<R>(&self, f: impl FnOnce() -> R) -> R {
        f()
    }
}
