//! `welt_rules`.

use super::arguments::{self, Output};
use super::boundary::{boundary, boundary_value};
use super::error::WeltError;
use super::failure::Failure;
use crate::feature;
use crate::grammar::RuleSet;
use std::ffi::{CString, c_char};
use std::path::Path;

/// A rule set. Never changes.
pub struct WeltRules {
    pub(super) rules: RuleSet,
    parameters: Vec<Parameter>,
}

struct Parameter {
    name: CString,
    unit: CString,
    help: CString,
    default: f64,
    low: f64,
    high: f64,
}

impl WeltRules {
    fn new(rules: RuleSet) -> Self {
        let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let parameters = rules
            .parameters()
            .iter()
            .map(|p| Parameter {
                name: text(&p.name),
                unit: text(&p.unit),
                help: text(&p.help),
                default: p.default,
                low: p.low,
                high: p.high,
            })
            .collect();
        Self { rules, parameters }
    }
}

/// Makes a handle of rules.
///
/// # Safety
/// `rules` is NULL or can be written to.
unsafe fn hand_over(
    rules: *mut *mut WeltRules,
    load: impl FnOnce() -> Result<RuleSet, Failure>,
) -> Result<(), Failure> {
    // SAFETY: as for this function.
    let output = unsafe { Output::new(rules, "rules") }?;
    output.handle(WeltRules::new(load()?));
    Ok(())
}

/// Loads a rule file and checks it.
///
/// path: UTF-8.
/// path_length: in bytes, SIZE_MAX for a NUL-terminated path.
/// rules: receives the handle; free it with welt_rules_free.
///
/// Fails with WELT_ERROR_FILE, or with WELT_ERROR_SYNTAX: each place of the error has file, line and column. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_load(
    path: *const c_char,
    path_length: usize,
    rules: *mut *mut WeltRules,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a string of this length and a place for the handle.
        unsafe {
            let path = arguments::text(path, path_length, "path")?;
            hand_over(rules, || Ok(RuleSet::load(Path::new(path))?))
        }
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Gives the rules of linear features that come with the library.
///
/// rules: receives the handle; free it with welt_rules_free.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_linear(rules: *mut *mut WeltRules, error: *mut *mut WeltError) -> i32 {
    // SAFETY: the header asks for a place for the handle.
    let body = || unsafe { hand_over(rules, || Ok(feature::linear_rules()?)) };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees rules. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_free(rules: *mut WeltRules) {
    // SAFETY: the header asks for NULL or rules that were not freed.
    unsafe { arguments::free(rules) };
}

/// Number of parameters that the rules declare; 0 where rules is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_count(rules: *const WeltRules) -> usize {
    // SAFETY: the header asks for NULL or living rules.
    unsafe { look(rules, 0, |rules| Some(rules.parameters.len())) }
}

/// Name of parameter number index, valid until the rules are freed; empty where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_name(rules: *const WeltRules, index: usize) -> *const c_char {
    // SAFETY: the header asks for NULL or living rules.
    unsafe { look(rules, c"".as_ptr(), |rules| Some(rules.parameters.get(index)?.name.as_ptr())) }
}

/// Unit of parameter number index, such as length, angle or count, valid until the rules are freed; empty where there is
/// none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_unit(rules: *const WeltRules, index: usize) -> *const c_char {
    // SAFETY: the header asks for NULL or living rules.
    unsafe { look(rules, c"".as_ptr(), |rules| Some(rules.parameters.get(index)?.unit.as_ptr())) }
}

/// One line of help for parameter number index, valid until the rules are freed; empty where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_help(rules: *const WeltRules, index: usize) -> *const c_char {
    // SAFETY: the header asks for NULL or living rules.
    unsafe { look(rules, c"".as_ptr(), |rules| Some(rules.parameters.get(index)?.help.as_ptr())) }
}

/// Default of parameter number index; 0 where there is none. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_default(rules: *const WeltRules, index: usize) -> f64 {
    // SAFETY: the header asks for NULL or living rules.
    unsafe { look(rules, 0.0, |rules| Some(rules.parameters.get(index)?.default)) }
}

/// Writes the least and the greatest value of parameter number index; they may be infinite.
///
/// rules: must not be NULL.
/// index: below welt_rules_parameter_count(rules), 0-based.
/// low, high: receive one number each.
///
/// Fails with WELT_ERROR_ARGUMENT where there is no such parameter. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_rules_parameter_range(
    rules: *const WeltRules,
    index: usize,
    low: *mut f64,
    high: *mut f64,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for living rules and places for two numbers.
        let (rules, low, high) = unsafe {
            (arguments::handle(rules, "rules")?, Output::new(low, "low")?, Output::new(high, "high")?)
        };
        let parameter = rules.parameters.get(index).ok_or_else(|| {
            Failure::argument(format!("there is no parameter {index}; there are {}", rules.parameters.len()))
        })?;
        low.set(parameter.low);
        high.set(parameter.high);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Looks at rules from C.
///
/// # Safety
/// `rules` is NULL or living rules.
unsafe fn look<T: Copy>(rules: *const WeltRules, none: T, value: impl FnOnce(&WeltRules) -> Option<T>) -> T {
    boundary_value(none, || {
        // SAFETY: as for this function.
        let rules = unsafe { arguments::optional(rules, "rules") };
        rules.ok().flatten().and_then(value).unwrap_or(none)
    })
}
