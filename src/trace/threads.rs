//! The threads that share the tiles.

/// A pool of tracing threads.
#[derive(Debug)]
pub struct Threads(rayon::ThreadPool);

/// The operating system did not start the threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {count} tracing threads: {source}")]
pub struct PoolError {
    count: usize,
    source: rayon::ThreadPoolBuildError,
}

impl Threads {
    /// Starts `count` threads, or one per core.
    ///
    /// # Errors
    /// [`PoolError`] when the system refuses so many.
    pub fn new(count: Option<usize>) -> Result<Self, PoolError> {
        let count = count.unwrap_or(0);
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .thread_name(|index| format!("glint-trace-{index}"))
            .build()
            .map(Self)
            .map_err(|source| PoolError { count, source })
    }

    /// The number of threads if none is asked for.
    pub fn available() -> usize {
        std::thread::available_parallelism().map_or(1, usize::from)
    }

    /// The number of threads of the current pool: the global one outside of [`Self::run`].
    pub fn current() -> usize {
        rayon::current_num_threads()
    }

    /// The number of threads.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }

    /// Runs `work` with these threads as the current pool.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.0.install(work)
    }
}
