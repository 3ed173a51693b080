//! `welt_report`.

use super::arguments::{self, Output};
use super::boundary::boundary_value;
use super::failure::Failure;
use super::status::WELT_ERROR_INTERNAL;
use crate::fault;
use serde::Serialize;
use std::ffi::{CString, c_char};

/// What a call did, beyond its result. Never changes.
pub struct WeltReport {
    json: CString,
}

impl WeltReport {
    pub(super) fn new(content: &impl Serialize) -> Result<Self, Failure> {
        fault::point("report");
        let internal = |reason: String| Failure::new(WELT_ERROR_INTERNAL, reason);
        let text = serde_json::to_string(content).map_err(|error| internal(error.to_string()))?;
        // JSON writes control characters as escapes, so that there is no NUL in it.
        Ok(Self { json: CString::new(text).map_err(|error| internal(error.to_string()))? })
    }
}

/// Hands the report that was made, if any, to the caller who asked for it.
pub(super) fn hand_over(output: Option<Output<*mut WeltReport>>, report: Option<WeltReport>) {
    if let (Some(output), Some(report)) = (output, report) {
        output.handle(report);
    }
}

/// Frees a report. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_report_free(report: *mut WeltReport) {
    // SAFETY: the header asks for NULL or a report that was not freed.
    unsafe { arguments::free(report) };
}

/// The report as JSON, UTF-8, NUL-terminated, valid until the report is freed. Empty where report is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_report_json(report: *const WeltReport) -> *const c_char {
    boundary_value(c"".as_ptr(), || {
        // SAFETY: the header asks for NULL or a living report.
        let report = unsafe { arguments::optional(report, "report") };
        report.ok().flatten().map_or(c"".as_ptr(), |report| report.json.as_ptr())
    })
}
