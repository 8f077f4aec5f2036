//! Long work on a thread of its own, while Python hears of its progress and of Ctrl-C.

use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use dem_io::Result;
use dem_io::diagnostic::Kind;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::python_error;

/// Time between two looks at signals and progress.
const LOOK: Duration = Duration::from_millis(50);

/// How far the work has come: the fraction done and a text. None: nothing new.
#[derive(Default)]
pub(crate) struct Told(Mutex<Option<(f64, String)>>);

impl Told {
    pub(crate) fn say(&self, fraction: f64, text: String) {
        if let Ok(mut latest) = self.0.lock() {
            *latest = Some((fraction, text));
        }
    }

    fn take(&self) -> Option<(f64, String)> {
        self.0.lock().ok().and_then(|mut latest| latest.take())
    }
}

/// Does the work without the lock of the interpreter. At Ctrl-C, or if `tell` raises, `stop` is
/// called once, the end of the work is waited for, and that exception is raised.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    told: &Told,
    stop: &dyn Fn(),
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    thread::scope(|scope| {
        let (done, waiting) = channel::<()>();
        let worker = scope.spawn(move || {
            // Dropped at the end of the work, whatever its end.
            let _done = done;
            work()
        });
        let mut waiting = waiting;
        let mut stopped: Option<PyErr> = None;
        loop {
            let (received, receiver) = py.detach(move || (waiting.recv_timeout(LOOK), waiting));
            waiting = receiver;
            if received != Err(RecvTimeoutError::Timeout) {
                break;
            }
            if stopped.is_none()
                && let Err(exception) = look(py, tell, told)
            {
                stop();
                stopped = Some(exception);
            }
        }
        let ended = worker
            .join()
            .map_err(|_| PyRuntimeError::new_err("a fault of the program: see standard error"))?;
        if stopped.is_none() {
            stopped = look(py, tell, told).err();
        }
        match (ended, stopped) {
            (Ok(_), Some(exception)) => Err(exception),
            (Err(problem), Some(exception)) if problem.kind == Kind::Interrupted => Err(exception),
            (Err(problem), _) => Err(python_error(py, &problem)),
            (Ok(value), None) => Ok(value),
        }
    })
}

/// Handles signals, and tells the progress.
fn look(py: Python<'_>, tell: Option<&Bound<'_, PyAny>>, told: &Told) -> PyResult<()> {
    py.check_signals()?;
    if let (Some(tell), Some(so_far)) = (tell, told.take()) {
        tell.call1(so_far)?;
    }
    Ok(())
}
