//! The plots of `zonal plan --plot` and `zonal project --plot`: of a light what its orders err by and how it looks, of each
//! rotation what its methods err by.

mod light;
mod methods;
mod pixels;
mod sheet;

use light::Lit;
use sheet::Sheet;
use std::error::Error;
use std::path::Path;
use zonal_cli::projected::{Asked, Projected, Question};
use zonal_cli::scene;
use zonal_cli::terminal::{Failure, progress};
use zonal_codegen::environment::Loaded;
use zonal_codegen::files::{self, MARK, Replace};
use zonal_codegen::plan::Plan;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Light, Maps, Scene};

/// Prints the plan of a scene after writing its plot.
pub fn plan(path: Option<&Path>, json: bool, plot: &Path, replace: Replace) -> Result<(), Failure> {
    check(plot)?;
    let bar = progress("planning and drawing");
    let scene = scene::read(path)?;
    let plan = Plan::new(&scene)?;
    let mut sheet = Sheet::default();
    let mut is_empty = true;
    if let Some(projected) = lit(&scene, &plan)? {
        let brdf = scene.brdf.clone().filter(|_| projected.signal == Light::Radiance).unwrap_or(Brdf::Lambert);
        let budget = scene.environment.as_ref().map(|environment| environment.budget);
        let name =
            plan.environment.as_ref().map_or_else(String::new, |light| format!("{} of {}", light.name, light.map));
        Lit { name, projected: &projected, brdf, budget }.draw(&mut sheet).map_err(|error| undrawn(plot, error))?;
        is_empty = false;
    }
    for chosen in methods::bounded(&plan) {
        sheet.put(0, &methods::panel(&plan, chosen).map_err(|error| undrawn(plot, error))?);
        sheet.down(methods::HEIGHT);
        is_empty = false;
    }
    if is_empty {
        let help = "add an `[environment]` with its `map`, or a `[[rotation]]` with its `max_error`";
        let message = "there is nothing to plot: the scene has no light and bounds no rotation";
        return Err(Diagnostic::nowhere(message, help).into());
    }
    write(&sheet, plot, &format!("the scene `{}`", plan.scene), replace)?;
    drop(bar);
    scene::print(&plan, json)
}

/// Prints what was found about a map after writing its plot.
pub fn project(asked: &Asked, plot: &Path, replace: Replace) -> Result<(), Failure> {
    check(plot)?;
    let bar = progress("projecting and drawing");
    let projected = Projected::new(asked)?;
    let mut sheet = Sheet::default();
    let brdf = asked.brdf.clone().filter(|_| !asked.irradiance).unwrap_or(Brdf::Lambert);
    let name = asked.map.display().to_string();
    Lit { name: name.clone(), projected: &projected, brdf, budget: None }
        .draw(&mut sheet)
        .map_err(|error| undrawn(plot, error))?;
    write(&sheet, plot, &format!("the map `{name}`"), replace)?;
    drop(bar);
    projected.print(asked)
}

/// The light of a scene, as `zonal project` finds it.
fn lit(scene: &Scene, plan: &Plan) -> Result<Option<Projected>, Failure> {
    let (Some(wanted), Some(found)) = (&scene.environment, &plan.environment) else { return Ok(None) };
    let name = &wanted.map.value;
    let loaded = match &scene.maps {
        Maps::Folder(folder) => Loaded::read(&folder.join(name)),
        Maps::Embedded(files) => {
            let file = files.iter().find(|(known, _)| known == name);
            Loaded::from_bytes(name, file.map_or(&[], |(_, bytes)| bytes))
        }
    };
    let loaded = loaded.map_err(|error| Diagnostic::of(&wanted.map.place, error))?;
    let brdf = scene.brdf.clone().filter(|_| wanted.signal == Light::Radiance);
    let question = Question { signal: wanted.signal, order: found.order, convention: wanted.convention.value, brdf };
    Ok(Some(Projected::of(loaded, &question)))
}

fn check(plot: &Path) -> Result<(), Failure> {
    if plot.extension().is_none_or(|extension| extension != "svg") {
        let message = format!("{}: a plot is an SVG file", plot.display());
        return Err(Diagnostic::nowhere(message, "give it a name that ends in `.svg`").into());
    }
    Ok(())
}

fn undrawn(plot: &Path, error: Box<dyn Error>) -> Failure {
    Diagnostic::nowhere(format!("{}: cannot be drawn ({error})", plot.display()), "").into()
}

fn write(sheet: &Sheet, path: &Path, origin: &str, replace: Replace) -> Result<(), Failure> {
    // Two hyphens end a comment of XML, or may not stand in it.
    let origin = origin.replace("--", "- -");
    files::write_text(path, &format!("<!-- {MARK} from {origin} -->\n{}", sheet.svg()), replace)?;
    Ok(())
}
