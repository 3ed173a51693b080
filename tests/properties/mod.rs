//! Random marks on real cages: whatever is marked, the result is a valid mesh, the same in every run and under any
//! numbering, all quads where that is asked for and possible, and what no rule could handle is said. A feature that
//! fails leaves the mesh as it was.
//!
//! Cases come from fixed seeds; a failing one is printed with the least marks that still fail. `WELT_CASES=N` runs N
//! cases per property, `WELT_SEED=N` begins with seed N.

mod case;
mod checks;
mod random;
mod renumber;
mod routes;

use crate::common;
use case::{Case, Model};
use random::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Larger models would take too much of the time.
const MOST_FACES: usize = 2200;

/// Real control cages, or the few that the project holds where the collection is absent.
fn models() -> Vec<Model> {
    let models: Vec<Model> = match common::shared_data() {
        Some(data) => ["upholstery", "product", "organic", "classic"]
            .into_iter()
            .flat_map(|folder| common::clean_cages(&data, folder))
            .map(|(name, mesh)| Model { name, mesh })
            .filter(|model| model.mesh.face_bound() <= MOST_FACES)
            .collect(),
        None => {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/models");
            ["chair.obj", "leaf_chair.obj", "mid_century_chair.obj"]
                .map(|name| Model { name: name.into(), mesh: common::load(&folder.join(name)) })
                .into()
        }
    };
    assert!(models.len() >= 30 || common::shared_data().is_none(), "only {} models", models.len());
    models
}

fn from_environment(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// Runs `property` on `cases` random cases; stops at the first that fails, with the least marks that still do.
fn hold(cases: u64, property: impl Fn(&Case) -> Result<(), String>) {
    let models = models();
    let first = from_environment("WELT_SEED", 0);
    for seed in first..first + from_environment("WELT_CASES", cases) {
        let mut random = Random::new(seed);
        let Some(mut case) = Case::random(&models, &mut random) else { continue };
        // A panic is a failure like any other, so that its marks can be reduced.
        let outcome = |case: &Case| {
            catch_unwind(AssertUnwindSafe(|| property(case))).unwrap_or_else(|_| Err("it panics".into()))
        };
        if outcome(&case).is_ok() {
            continue;
        }
        case.reduce(|case| outcome(case).is_err());
        let problem = outcome(&case).expect_err("reduced to what fails");
        panic!("seed {seed}: {problem}\n{case}");
    }
}

#[test]
fn results_are_valid_and_repeatable_and_leftovers_are_said() {
    hold(800, checks::result_is_sound);
}

#[test]
fn odd_faces_become_even_wherever_there_is_a_way() {
    hold(5000, routes::lines_are_right);
}

#[test]
fn numbering_does_not_matter() {
    hold(450, renumber::result_is_the_same);
}
