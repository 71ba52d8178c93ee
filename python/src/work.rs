//! Work without Python's lock, on threads of our own, that Ctrl-C ends within a second.
//!
//! The caller's thread waits and looks for signals; a pool does the work. Work that owns all it needs can be
//! left behind when it does not end in time: its result is then dropped when it comes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error;

/// Between two looks for a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// How long interrupted work has to end before it is left behind.
const GRACE: Duration = Duration::from_millis(300);

/// What a piece of work asks from time to time.
#[derive(Debug, Default)]
pub(crate) struct Stop(AtomicBool);

impl Stop {
    /// Whether the result is not wanted any more.
    pub(crate) fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Runs `work` on the pool, without Python's lock, and hands its result back. If a signal's handler raises,
/// tells `work` to stop and raises the same.
///
/// # Errors
/// The exception of a signal's handler, `KeyboardInterrupt` as a rule; what `work` fails with.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Stop) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let pool = of_this_process()?;
    let stop = Arc::new(Stop::default());
    let (send, receive) = sync_channel(1);
    let asked = Arc::clone(&stop);
    pool.spawn(move || {
        // A panic would end the process.
        let result = catch_unwind(AssertUnwindSafe(|| work(&asked)));
        // Nobody may be waiting any more.
        let _ = send.send(result);
    });
    drop(pool);
    py.detach(move || {
        loop {
            match receive.recv_timeout(PATIENCE) {
                Ok(result) => {
                    return result.unwrap_or_else(|_| Err(error::internal("the work panicked")));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(error::internal("the work ended without a result"));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Err(raised) = Python::attach(|py| py.check_signals()) {
                stop.0.store(true, Ordering::Relaxed);
                if receive.recv_timeout(GRACE).is_err() {
                    // What comes next should not wait for what nobody wants.
                    *POOL.lock().unwrap_or_else(PoisonError::into_inner) = None;
                }
                return Err(raised);
            }
        }
    })
}

/// The pool, and the process in which it has threads.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// The pool of this process: after a fork, as by Python's `multiprocessing`, a new one, since the child has
/// none of its parent's threads.
fn of_this_process() -> PyResult<Arc<ThreadPool>> {
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*pool {
        Some((of, threads)) if *of == process => return Ok(Arc::clone(threads)),
        _ => {}
    }
    let threads = ThreadPoolBuilder::new()
        .thread_name(|i| format!("twelvefold {i}"))
        .build()
        .map_err(|_| error::internal("no threads can be started"))?;
    let threads = Arc::new(threads);
    if let Some(of_parent) = pool.replace((process, Arc::clone(&threads))) {
        // Its locks may be held for ever by threads that are not here.
        std::mem::forget(of_parent);
    }
    Ok(threads)
}
