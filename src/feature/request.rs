//! What a caller asks for, and why it may be refused.

use super::settings::Setting;
use super::{Leftover, Length, Profile, ProfileError, SettingError, Unit, WidthError};
use crate::grammar::{self, RuleSet, Tracer};
use crate::job::Cancelled;
use crate::mark::{DEFAULT_KIND, parity};
use crate::memory::OutOfMemory;
use crate::mesh::MOST_COORDINATE;
use crate::optimise::Method;
use crate::surface::FreezeError;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A feature and what it is set to.
#[derive(Clone, Debug)]
pub struct Feature {
    /// The kind of the marks that ask for it.
    pub kind: String,
    /// The cross-section.
    pub profile: Profile,
    /// Parameters of the profile that differ from their defaults.
    pub lengths: BTreeMap<String, Length>,
}

impl Feature {
    /// The value of parameter number `index`, as set or by default.
    pub(super) fn length(&self, index: usize) -> Length {
        self.profile.parameters.get(index).map_or(Length::Units(0.0), |parameter| {
            self.lengths.get(&parameter.name).copied().unwrap_or(parameter.default)
        })
    }
}

impl Feature {
    /// All parameters in model units, on an edge of this length and with this extent across the feature.
    pub(super) fn values(&self, length: f64, breadth: f64) -> Vec<f64> {
        let width = self.profile.width();
        (0..self.profile.parameters.len())
            .map(|p| match self.profile.parameters[p].unit {
                Unit::Count => self.length(p).value(),
                Unit::Length if Some(p) == width => self.length(p).on_edge(breadth),
                Unit::Length => self.length(p).on_edge(length),
            })
            .collect()
    }
}

/// What to apply: rules, and the features whose marks they are to handle.
///
/// A mark asks for the feature whose kind it names; one that names no kind asks for the first. Without features the
/// rules run on the marks as they are, and nothing is displaced.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rules that rewrite the mesh.
    pub rules: RuleSet,
    /// The features.
    pub features: Vec<Feature>,
    /// Parameters of the rules that differ from their defaults.
    pub numbers: BTreeMap<String, f64>,
}

/// A request that makes no sense.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RequestError {
    /// A feature that cannot be had.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A setting that cannot be read, or names a parameter that there is not, or is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// Two features of one kind.
    #[error("the kind '{kind}' is given twice; name one of them otherwise, such as wide=groove")]
    KindTwice {
        /// The kind.
        kind: String,
    },
    /// The rules that ship cannot be read.
    #[error(transparent)]
    Rules(#[from] grammar::RulesError),
}

impl Request {
    /// Features by name, with the rules that ship.
    ///
    /// Each name is `FEATURE` or `KIND=FEATURE`; a feature is one of [`Profile::names`] or a profile file ending in
    /// `.toml`. Each setting is `NAME=VALUE`, for every feature that has the parameter and else for the rules, or
    /// `KIND.NAME=VALUE` for one feature.
    ///
    /// # Errors
    /// See [`RequestError`].
    pub fn features<S: AsRef<str>, T: AsRef<str>>(names: &[S], settings: &[T]) -> Result<Self, RequestError> {
        let mut request =
            Self { rules: super::linear_rules()?, features: Vec::new(), numbers: BTreeMap::new() };
        for name in names {
            let (kind, feature) = match name.as_ref().split_once('=') {
                Some((kind, feature)) => (Some(kind), feature),
                None => (None, name.as_ref()),
            };
            request.add(kind, feature)?;
        }
        for setting in settings {
            request.set(setting.as_ref())?;
        }
        Ok(request)
    }

    /// Rules of the caller, without features.
    ///
    /// # Errors
    /// A setting that is no number or names no parameter of the rules.
    pub fn rules<T: AsRef<str>>(rules: RuleSet, settings: &[T]) -> Result<Self, RequestError> {
        let mut request = Self { rules, features: Vec::new(), numbers: BTreeMap::new() };
        for setting in settings {
            request.set(setting.as_ref())?;
        }
        Ok(request)
    }

    fn add(&mut self, kind: Option<&str>, name: &str) -> Result<(), RequestError> {
        let profile = Profile::named(name)?;
        let kind = kind.map_or_else(|| profile.name.clone(), str::to_owned);
        if self.features.iter().any(|feature| feature.kind == kind) {
            return Err(RequestError::KindTwice { kind });
        }
        self.features.push(Feature { kind, profile, lengths: BTreeMap::new() });
        Ok(())
    }

    /// Takes over a setting.
    ///
    /// # Errors
    /// Text that is no setting, a parameter that there is not, a value out of its range.
    pub fn set(&mut self, text: &str) -> Result<(), SettingError> {
        let setting: Setting = text.parse()?;
        let error = |problem: String| SettingError { text: text.to_owned(), problem };
        let chosen: Vec<usize> = match &setting.kind {
            Some(kind) => {
                let index = feature_of(&mut self.features, kind).ok_or_else(|| {
                    error(format!(
                        "there is no feature of kind '{kind}'; there are {}",
                        self.kinds().join(", ")
                    ))
                })?;
                if self.features[index].profile.parameter(&setting.name).is_none() {
                    return Err(error(unknown(
                        &self.features[index].profile.name,
                        &setting.name,
                        self.known(Some(index)),
                    )));
                }
                vec![index]
            }
            None => (0..self.features.len())
                .filter(|&i| self.features[i].profile.parameter(&setting.name).is_some())
                .collect(),
        };
        for &i in &chosen {
            let feature = &mut self.features[i];
            let parameter = feature.profile.parameters.iter().find(|p| p.name == setting.name);
            if let Some(problem) = parameter.and_then(|parameter| parameter.problem(setting.value)) {
                return Err(error(problem));
            }
            feature.lengths.insert(setting.name.clone(), setting.value);
        }
        if chosen.is_empty() {
            let Some(parameter) = self.rules.parameters().iter().find(|p| p.name == setting.name) else {
                let name = self.features.first().map_or(self.rules.name(), |feature| &feature.profile.name);
                return Err(error(unknown(name, &setting.name, self.known(None))));
            };
            let Length::Units(x) = setting.value else {
                return Err(error("parameters of rules are plain numbers".into()));
            };
            if !(parameter.low..=parameter.high).contains(&x) {
                return Err(error(format!("it lies between {} and {}", parameter.low, parameter.high)));
            }
            self.numbers.insert(setting.name, x);
        }
        Ok(())
    }

    fn kinds(&self) -> Vec<String> {
        self.features.iter().map(|feature| feature.kind.clone()).collect()
    }

    /// Names of all parameters, or of those of one feature.
    fn known(&self, feature: Option<usize>) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let chosen = self.features.iter().enumerate().filter(|(i, _)| feature.is_none_or(|f| f == *i));
        for parameter in chosen.flat_map(|(_, feature)| &feature.profile.parameters) {
            if !names.contains(&parameter.name) {
                names.push(parameter.name.clone());
            }
        }
        if feature.is_none() {
            names.extend(self.rules.parameters().iter().map(|p| p.name.clone()));
        }
        names
    }

    /// What the request is called in reports: its features, or the rules.
    pub fn title(&self) -> String {
        if self.features.is_empty() { self.rules.name().to_owned() } else { self.kinds().join(" + ") }
    }
}

/// The index of the feature that marks of this kind ask for; features that ship need not be named before.
pub(super) fn feature_of(features: &mut Vec<Feature>, kind: &str) -> Option<usize> {
    if let Some(index) = features.iter().position(|feature| feature.kind == kind) {
        return Some(index);
    }
    if kind == DEFAULT_KIND {
        return (!features.is_empty()).then_some(0);
    }
    let profile = Profile::names().find(|name| *name == kind).and_then(|name| Profile::named(name).ok())?;
    features.push(Feature { kind: kind.to_owned(), profile, lengths: BTreeMap::new() });
    Some(features.len() - 1)
}

fn unknown(feature: &str, name: &str, known: Vec<String>) -> String {
    let known = if known.is_empty() { "no parameters".to_owned() } else { known.join(", ") };
    format!("{feature} has no parameter '{name}'; it has {known}")
}

/// How to apply it.
#[derive(Clone, Debug)]
pub struct Options {
    /// How to fit the changed mesh to the surface as it was.
    pub method: Method,
    /// What to do about faces that the marks leave with an odd number of sides.
    pub parity: parity::Mode,
    /// Marks that no rule handles are an error; otherwise they are kept, see [`Leftover`].
    pub strict: bool,
    /// Samples per side of a face for measuring deviations, 8 as a rule; 0 measures none. Measuring also looks for
    /// walls thinner than the feature is deep. It costs more than the feature itself.
    pub samples: usize,
    /// Threads for measuring deviations, 0 for all; the result does not depend on it.
    pub threads: usize,
    /// What each run of the rules may cost; there are several where widths and depths are corrected.
    pub limits: grammar::Limits,
    /// Records where rules are applied, or says where to apply them.
    pub tracer: Option<Arc<Tracer>>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::FitSlide,
            parity: parity::Mode::default(),
            strict: false,
            samples: 0,
            threads: 1,
            limits: grammar::Limits::default(),
            tracer: None,
        }
    }
}

/// Why a feature was not applied. The mesh is as it was.
#[derive(Clone, Debug, thiserror::Error)]
pub enum FeatureError {
    /// Nothing is marked.
    #[error("no edge is marked; name at least one edge the feature is to cross")]
    NoMarks,
    /// A mark of another mesh, or of this one before it was changed.
    #[error("mark {mark} is on an edge that the mesh does not have; select the edges anew on this mesh")]
    NoSuchEdge {
        /// The mark, counted from 0 in the order of the selection.
        mark: usize,
    },
    /// A mark whose kind is no feature.
    #[error("edge {},{} is marked #{kind}, and no feature has that name; there are {}", edge.0, edge.1, known.join(", "))]
    UnknownKind {
        /// The edge.
        edge: (u32, u32),
        /// The kind.
        kind: String,
        /// The kinds there are.
        known: Vec<String>,
    },
    /// Marks that do not enclose anything, for a feature that has an inside.
    #[error("{feature} needs a closed loop of marks; this one {}", open_loop(ends))]
    OpenLoop {
        /// The feature.
        feature: String,
        /// Marked edges at which it ends; empty where it does not separate the mesh.
        ends: Vec<(u32, u32)>,
    },
    /// A curve that no feature can follow.
    #[error("curve {curve}: {problem}")]
    Curve {
        /// The curve, counted from 0 in the order of the selection.
        curve: usize,
        /// What is wrong with it, and the remedy.
        problem: String,
    },
    /// An edge that a curve crosses where another curve or a mark does already.
    #[error(
        "curve {curve} crosses edge {0},{1}, which another curve or a mark crosses, too; an edge is crossed once: move one \
         of them, or refine the faces there first (--rules rules/patches.rules --mark edge:{0},{1})",
        edge.0, edge.1
    )]
    CrossedTwice {
        /// The edge.
        edge: (u32, u32),
        /// The curve, counted from 0 in the order of the selection.
        curve: usize,
    },
    /// A width that an edge cannot take.
    #[error(transparent)]
    Width(#[from] WidthError),
    /// Marks that no rule handles, in strict mode. Edges have the numbers of the mesh as it is; faces are those that
    /// the rules would have left.
    #[error("{}", unresolved(leftovers))]
    Unresolved {
        /// What would be left over.
        leftovers: Vec<Leftover>,
    },
    /// A result too large to be read again.
    #[error(
        "vertex {vertex} of the result would lie beyond {MOST_COORDINATE:e}; ask for less, or scale the model"
    )]
    Beyond {
        /// The vertex, by its number while the feature was applied.
        vertex: u32,
    },
    /// The rules failed.
    #[error(transparent)]
    Rules(#[from] grammar::RunError),
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is no memory for the surface round the marks.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
}

impl From<FreezeError> for FeatureError {
    fn from(error: FreezeError) -> Self {
        match error {
            FreezeError::Cancelled(cancelled) => cancelled.into(),
            FreezeError::Memory(error) => error.into(),
        }
    }
}

fn open_loop(ends: &[(u32, u32)]) -> String {
    if ends.is_empty() {
        return "does not separate an inside from an outside".into();
    }
    let list: Vec<String> = ends.iter().map(|(a, b)| format!("{a},{b}")).collect();
    format!("ends at the edges {}", list.join(" and "))
}

fn unresolved(leftovers: &[Leftover]) -> String {
    let mut edges: Vec<(u32, u32)> =
        leftovers.iter().flat_map(|leftover| &leftover.marks).map(|mark| mark.edge).collect();
    edges.sort_unstable();
    edges.dedup();
    let first: Vec<String> = edges.iter().take(4).map(|(a, b)| format!("{a},{b}")).collect();
    let more = if edges.len() > first.len() { ", ..." } else { "" };
    format!(
        "no rule handles {} faces at the marked edges {}{more}; change the marks there, or apply without strict to keep \
         the rest",
        leftovers.len(),
        first.join(" ")
    )
}
