//! The integration tests, one module per file, in one program: it is built once and its tests share both cores.
//! `cargo test --test all features::` runs those of `tests/features.rs`. What counts or refuses allocations
//! stands apart (`tests/bad_inputs.rs`, `tests/memory.rs`).

mod abi_page;
mod abi_snapshot;
mod batch;
mod cad_patches;
mod catalogue;
mod common;
mod creases;
mod curvature;
mod curves;
mod degenerate_queries;
mod extremes;
mod faults;
mod features;
mod fit_study;
mod flat_sheets;
mod folder;
mod gml;
mod header;
mod hostile;
mod junction_cages;
mod junction_quality;
mod junction_rules;
mod limits;
mod linear_rules;
mod loop_surface;
mod mesh;
mod optimise;
mod parity;
mod patches;
mod picture;
mod poles;
mod program;
mod properties;
mod real_cages;
mod repair;
mod round_trip;
mod rule_cases;
mod rule_check;
mod rules;
mod same_bytes;
mod stress;
mod supply_chain;
mod surface_evaluate;
mod surface_queries;
mod tutorial;
mod warnings;

/// A file that is not named here would not be compiled.
#[test]
fn every_file_is_a_module() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let Some(module) = name.strip_suffix(".rs") else { continue };
        let named = include_str!("all.rs").contains(&format!("\nmod {module};\n"));
        assert!(
            named || ["all", "bad_inputs", "memory"].contains(&module),
            "tests/{name} is not named in tests/all.rs"
        );
    }
}
