//! `welt demo`: features on real chairs.

use super::args::Demo;
use super::error::Failure;
use super::figure::{View, draw, limit_picture};
use super::files;
use super::output::print;
use super::rules;
use super::scenes::SCENES;
use glam::DVec3;
use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;
use welt::feature::{self, Options, Request};
use welt::grammar::RuleSet;
use welt::io::{self, Format, ImportOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::surface::SAMPLES;

pub fn run(arguments: &Demo) -> Result<ExitCode, Failure> {
    let folder = &arguments.folder;
    std::fs::create_dir_all(folder).map_err(|e| Failure::error(format_args!("{}: {e}", folder.display())))?;
    for scene in &SCENES {
        let start = Instant::now();
        let before =
            io::import_bytes(scene.name, Format::Obj, scene.model.as_bytes(), &ImportOptions::default())?
                .mesh;
        let selectors: Vec<Selector> =
            scene.marks.iter().map(|text| Selector::parse(text)).collect::<Result<_, _>>()?;
        let options = Options { samples: SAMPLES, method: scene.method, ..Options::default() };
        let request = match scene.rules {
            Some(text) => Request::rules(RuleSet::parse(scene.name, text, &|_| None)?, scene.set)?,
            None => Request::features(scene.features, scene.set)?,
        };
        let selection = Selection::resolve(&before, &selectors)?;
        let mut after = before.clone();
        let report = feature::apply(&mut after, &selection, &request, &options, &Job::new())?;

        let limit = limit_picture(&before, &after, &report)?;
        let view = View { viewer: scene.view.viewer(), up: DVec3::Y, zoom: scene.view.zoom() };
        let image = draw(scene.title, &after, &report, &limit, view);
        let path = |suffix: &str| folder.join(format!("{}{suffix}", scene.name));
        files::export(&path(".obj"), &after)?;
        let ply = io::ply::Options {
            normals: Some(&limit.normals),
            quality: Some(&limit.deviation),
            ..Default::default()
        };
        io::save(&path("_limit.ply"), |out| io::ply::write(&limit.polygons, &ply, out))?;
        files::save_json(&path(".json"), &report)?;
        io::save(&path(".png"), |out| image.write_png(out))?;
        let seconds = start.elapsed().as_secs_f64();
        print(|out| {
            writeln!(out, "{} ({seconds:.1} s): {}", path(".png").display(), scene.title)?;
            report.to_string().lines().try_for_each(|line| writeln!(out, "    {line}"))
        })?;
    }
    // Figures 4 and 9: the rules themselves.
    rules::draw(&feature::linear_rules()?, &folder.join("rules"), None)
}
