//! Where control passes between C and Rust.

use super::error::WeltError;
use super::failure::Failure;
use super::status::{WELT_ERROR_INTERNAL, WELT_ERROR_POISONED, WELT_OK};
use crate::fault;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs the body of an exported function. `error` may be NULL; else it becomes the reason of a failure, or NULL.
///
/// Handles are unwind safe because whatever changes one does it through [`Guarded::change`].
///
/// # Safety
/// `error` is NULL or can be written to.
pub(super) unsafe fn boundary(error: *mut *mut WeltError, body: impl FnOnce() -> Result<(), Failure>) -> i32 {
    let body = || {
        fault::point("entry");
        body()
    };
    let outcome = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(internal(panic)));
    let (status, handle) = match outcome {
        Ok(()) => (WELT_OK, std::ptr::null_mut()),
        Err(failure) if error.is_null() => (failure.code, std::ptr::null_mut()),
        Err(failure) => (failure.code, Box::into_raw(Box::new(WeltError::new(failure)))),
    };
    if !error.is_null() {
        // SAFETY: the caller of this function answers for a pointer that is not NULL. `write` because what is there
        // may be uninitialised.
        unsafe { error.write(handle) };
    }
    status
}

/// Runs the body of an exported function that cannot fail but for a defect of its own; then gives `fallback`.
pub(super) fn boundary_value<T>(fallback: T, body: impl FnOnce() -> T) -> T {
    let body = || {
        let value = body();
        // After the work, so that a handle that is freed is free.
        fault::point("exit");
        value
    };
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        drop(internal(panic));
        fallback
    })
}

fn internal(panic: Box<dyn Any + Send>) -> Failure {
    let text = match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(text), _) => (*text).to_owned(),
        (_, Some(text)) => text.clone(),
        _ => {
            // A payload of an unknown type may panic again when it is dropped.
            std::mem::forget(panic);
            "no further information".to_owned()
        }
    };
    Failure::new(WELT_ERROR_INTERNAL, format!("internal error: {text}; please report it"))
}

/// The content of a handle that can be changed. A change that panics or finds a defect of the library leaves it poisoned.
pub(super) struct Guarded<T> {
    content: T,
    poisoned: bool,
}

impl<T> Guarded<T> {
    pub(super) fn new(content: T) -> Self {
        Self { content, poisoned: false }
    }

    pub(super) fn read(&self) -> Result<&T, Failure> {
        if self.poisoned {
            return Err(Failure::new(
                WELT_ERROR_POISONED,
                "an internal error interrupted an earlier change of this handle; it can only be freed",
            ));
        }
        Ok(&self.content)
    }

    pub(super) fn change<R>(
        &mut self,
        work: impl FnOnce(&mut T) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        self.read()?;
        self.poisoned = true;
        fault::point("change begun");
        let result = work(&mut self.content);
        fault::point("change done");
        self.poisoned = matches!(&result, Err(failure) if failure.code == WELT_ERROR_INTERNAL);
        result
    }
}
