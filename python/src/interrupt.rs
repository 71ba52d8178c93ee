//! Work without Python's lock that Ctrl-C still ends within a fraction of a second.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use pyo3::prelude::*;

/// Between two looks for a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// What a piece of work asks from time to time.
#[derive(Debug)]
pub(crate) struct Stop(AtomicBool);

impl Stop {
    /// Whether the result is not wanted any more.
    pub(crate) fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Runs `work` on a thread of its own, without Python's lock, and hands its result back; if Python's user
/// interrupts, tells `work` to stop, waits for it, and raises `KeyboardInterrupt`.
///
/// # Errors
/// The exception that a signal handler raised.
pub(crate) fn run<T: Send>(py: Python<'_>, work: impl FnOnce(&Stop) -> T + Send) -> PyResult<T> {
    let stop = Stop(AtomicBool::new(false));
    let mut signal = Ok(());
    let result = py.detach(|| {
        std::thread::scope(|scope| {
            let (done, is_done) = std::sync::mpsc::channel::<()>();
            let stop = &stop;
            let worker = scope.spawn(move || {
                let result = work(stop);
                // The one who waits may have stopped waiting.
                let _ = done.send(());
                result
            });
            while let Err(std::sync::mpsc::RecvTimeoutError::Timeout) =
                is_done.recv_timeout(PATIENCE)
            {
                if signal.is_ok() {
                    signal = Python::attach(|py| py.check_signals());
                    if signal.is_err() {
                        stop.0.store(true, Ordering::Relaxed);
                    }
                }
            }
            worker.join()
        })
    });
    signal?;
    result.map_err(|_| pyo3::exceptions::PyRuntimeError::new_err("the work ended without a result"))
}
