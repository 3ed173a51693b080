//! `welt_job`.

use super::arguments::{self, Output};
use super::boundary::{boundary, boundary_value};
use super::error::WeltError;
use super::failure::Failure;
use crate::job::Job;
use std::ffi::{c_char, c_void};

/// Watches and cancels a long call. All functions of a job may be called from any thread at any time, also while a call
/// works with it. Cancelling is for good: use a new job for the next call.
pub struct WeltJob {
    pub(super) job: Job,
}

/// Makes a job. job: receives the handle; free it with welt_job_free after every call that uses it has returned.
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_create(job: *mut *mut WeltJob, error: *mut *mut WeltError) -> i32 {
    let body = || {
        // SAFETY: the header asks for NULL or a place for the handle.
        let output = unsafe { Output::new(job, "job") }?;
        output.handle(WeltJob { job: Job::new() });
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// What C is called back with: a function and its context.
struct Callback {
    function: unsafe extern "C" fn(context: *mut c_void, progress: f64),
    context: *mut c_void,
}

// SAFETY: the header says on which thread the function is called; the caller answers for what it does there.
unsafe impl Send for Callback {}
// SAFETY: as above.
unsafe impl Sync for Callback {}

impl Callback {
    fn call(&self, progress: f64) {
        // SAFETY: the header asks for a function that may be called with this context until the job is freed.
        unsafe { (self.function)(self.context, progress) };
    }
}

/// Has a function called with the progress at every step of a call that works with the job.
///
/// job: must not be NULL; no call may work with it meanwhile.
/// observer: is called by the thread that made the call, with the progress in [0, 1]. It may use the functions of this job,
/// welt_job_cancel above all, and handles that the call does not change. It must come back: no exception, no longjmp.
/// context: is passed to the function as it is; may be NULL.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_observe(
    job: *mut WeltJob,
    observer: Option<unsafe extern "C" fn(context: *mut c_void, progress: f64)>,
    context: *mut c_void,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living job that nobody else uses.
        let job = unsafe { arguments::handle_mut(job, "job") }?;
        let function = observer.ok_or_else(|| Failure::argument("observer is NULL"))?;
        let callback = Callback { function, context };
        job.job.observe(move |progress| callback.call(progress));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees a job. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_free(job: *mut WeltJob) {
    // SAFETY: the header asks for NULL or a job that was not freed.
    unsafe { arguments::free(job) };
}

/// Asks the call that works with the job to stop. It returns WELT_ERROR_CANCELLED soon after, and what it was changing is
/// as it was before. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_cancel(job: *const WeltJob) {
    boundary_value((), || {
        // SAFETY: the header asks for NULL or a living job; it is shared, and `Job` changes through atomics.
        if let Ok(Some(job)) = unsafe { arguments::optional(job, "job") } {
            job.job.cancel();
        }
    });
}

/// How much of the present call is done, in [0, 1]; 0 where job is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_progress(job: *const WeltJob) -> f64 {
    boundary_value(0.0, || {
        // SAFETY: the header asks for NULL or a living job.
        let job = unsafe { arguments::optional(job, "job") };
        job.ok().flatten().map_or(0.0, |job| job.job.progress())
    })
}

/// Writes the name of the present stage of the work, UTF-8 and NUL-terminated, cut where the buffer ends. Gives the length
/// of the whole name without its NUL; 0 where job is NULL. buffer: may be NULL when capacity is 0. capacity: room in
/// bytes. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_job_stage(job: *const WeltJob, buffer: *mut c_char, capacity: usize) -> usize {
    boundary_value(0, || {
        // SAFETY: the header asks for NULL or a living job.
        let job = unsafe { arguments::optional(job, "job") };
        let stage = job.ok().flatten().map_or("", |job| job.job.stage());
        if let Some(room) = capacity.checked_sub(1) {
            let end = (0..=room.min(stage.len())).rev().find(|&end| stage.is_char_boundary(end)).unwrap_or(0);
            let bytes = stage.as_bytes()[..end].iter().chain(&[0]).map(|&byte| byte as c_char);
            // SAFETY: the header asks for NULL or a buffer of this capacity, of which `end + 1` is a part.
            if let Ok(buffer) = unsafe { arguments::Buffer::new(buffer, capacity, end + 1, "buffer") } {
                buffer.fill(bytes);
            }
        }
        stage.len()
    })
}
