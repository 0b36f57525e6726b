//! The scene that a command was given, or the one that zonal carries with it, and how its plan is printed.

use crate::terminal::{Failure, out, out_json};
use std::path::Path;
use zonal_codegen::plan::Plan;
use zonal_codegen::scene::{Maps, Scene};

/// Reads a scene; without a path, the one that zonal carries with it.
///
/// # Errors
///
/// If the scene is at fault.
pub fn read(path: Option<&Path>) -> Result<Scene, Failure> {
    Ok(match path {
        Some(path) => Scene::read(path)?,
        None => Scene::parse("glossy.toml", zonal_scenes::GLOSSY, Maps::Embedded(zonal_scenes::FILES))?,
    })
}

/// Reads a scene and plans it; without a path, the one that zonal carries with it.
///
/// # Errors
///
/// If the scene or its map is at fault.
pub fn plan(path: Option<&Path>) -> Result<Plan, Failure> {
    Ok(Plan::new(&read(path)?)?)
}

/// Prints a plan as Markdown or as JSON.
///
/// # Errors
///
/// If it cannot be printed.
pub fn print(plan: &Plan, json: bool) -> Result<(), Failure> {
    match json {
        true => out_json(plan),
        false => out(&plan.to_string()),
    }
}
