//! The threads that tiles are shared between.

/// A pool of tracing threads.
#[derive(Debug)]
pub struct Threads(rayon::ThreadPool);

/// The system would not start the threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {count} tracing threads: {source}")]
pub struct PoolError {
    count: usize,
    source: rayon::ThreadPoolBuildError,
}

impl Threads {
    /// `count` threads, or one per core.
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

    /// How many there are where nobody asks for a number.
    pub fn available() -> usize {
        std::thread::available_parallelism().map_or(1, usize::from)
    }

    /// How many threads work that is not said to run elsewhere has.
    pub fn current() -> usize {
        rayon::current_num_threads()
    }

    /// How many threads there are.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }

    /// Runs `work` with these threads as the current pool.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.0.install(work)
    }
}
