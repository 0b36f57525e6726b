//! The plot of `zonal plan --plot`: for each rotation that the scene bounds, the error of every method over the angle by
//! its law, with what the scene allows.

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;
use zonal_cli::scene;
use zonal_cli::terminal::{Failure, progress};
use zonal_codegen::families::Spec;
use zonal_codegen::files::{self, MARK, Replace};
use zonal_codegen::plan::mixtures::Budget;
use zonal_codegen::plan::{Chosen, Plan};
use zonal_codegen::scene::diagnostic::Diagnostic;

const WIDTH: u32 = 900;
const HEIGHT: u32 = 460;
/// The angles, in degrees, and how many points lie between.
const DEGREES: [f64; 2] = [0.5, 45.0];
const POINTS: u32 = 90;
/// The errors that are shown.
const ERRORS: [f64; 2] = [1e-7, 10.0];
/// Colours that are told apart by most eyes (Okabe and Ito).
const COLOURS: [RGBColor; 10] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
    RGBColor(120, 70, 20),
    RGBColor(110, 60, 160),
    RGBColor(150, 150, 40),
];

/// Prints the plan of a scene after writing its plot.
pub fn plan(path: Option<&Path>, json: bool, plot: &Path, replace: Replace) -> Result<(), Failure> {
    if plot.extension().is_none_or(|extension| extension != "svg") {
        let message = format!("{}: a plot is an SVG file", plot.display());
        return Err(Diagnostic::nowhere(message, "give it a name that ends in `.svg`").into());
    }
    let bar = progress("planning");
    let plan = scene::plan(path)?;
    drop(bar);
    write(&plan, plot, replace)?;
    scene::print(&plan, json)
}

fn write(plan: &Plan, path: &Path, replace: Replace) -> Result<(), Failure> {
    let name = path.display();
    let drawn = svg(plan).map_err(|error| Diagnostic::nowhere(format!("{name}: cannot be drawn ({error})"), ""))?;
    let text = drawn.ok_or_else(|| {
        let help = "add a `[[rotation]]` with its `max_error`";
        Diagnostic::nowhere("there is nothing to plot: the scene bounds no rotation", help)
    })?;
    files::write_text(path, &format!("<!-- {MARK} from the scene `{}` -->\n{text}", plan.scene), replace)?;
    Ok(())
}

/// The rotations of a plan that were chosen within an error.
fn bounded(plan: &Plan) -> Vec<&Chosen> {
    plan.kernels.iter().filter(|chosen| chosen.max_error.is_some() && !chosen.rivals.is_empty()).collect()
}

/// The plot as SVG; none if the scene bounds no rotation.
///
/// # Errors
///
/// If it cannot be drawn.
fn svg(plan: &Plan) -> Result<Option<String>, Box<dyn Error>> {
    let rotations = bounded(plan);
    if rotations.is_empty() {
        return Ok(None);
    }
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, HEIGHT * rotations.len() as u32)).into_drawing_area();
        root.fill(&WHITE).map_err(|error| error.to_string())?;
        for (chosen, area) in rotations.iter().zip(root.split_evenly((rotations.len(), 1))) {
            rotation(plan, chosen, &area)?;
        }
        root.present().map_err(|error| error.to_string())?;
    }
    Ok(Some(text))
}

fn rotation(
    plan: &Plan,
    chosen: &Chosen,
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
) -> Result<(), Box<dyn Error>> {
    let (most, angle) = (chosen.max_error.unwrap_or(1.0), chosen.max_angle.unwrap_or(DEGREES[1]));
    let norm = chosen.norm.unwrap_or_default();
    let energy = plan.environment.as_ref().map_or(&[][..], |environment| &environment.energy);
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{}: error by the law, {}", chosen.row.name, norm.meaning()), ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d((DEGREES[0]..DEGREES[1]).log_scale(), (ERRORS[0]..ERRORS[1]).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("y angle or tilt, degrees")
        .y_desc("error")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .draw()?;
    let limit = |line: Vec<(f64, f64)>| LineSeries::new(line, BLACK.stroke_width(1));
    chart.draw_series(limit(vec![(DEGREES[0], most), (DEGREES[1], most)]))?;
    chart.draw_series(limit(vec![(angle, ERRORS[0]), (angle, ERRORS[1])]))?;
    for (drawn, rival) in chosen.rivals.iter().enumerate() {
        let spec: Spec = rival.spec.parse()?;
        let at = |step: u32| {
            let ratio: f64 = DEGREES[1] / DEGREES[0];
            let degrees = DEGREES[0] * ratio.powf(f64::from(step) / f64::from(POINTS));
            let budget = Budget { max_angle: degrees.to_radians(), error: most, norm, energy: energy.to_vec() };
            (degrees, (budget.predict(&spec) + rival.rounding_f32).clamp(ERRORS[0], ERRORS[1]))
        };
        let own = rival.spec == chosen.row.spec;
        let style = COLOURS[drawn % COLOURS.len()].stroke_width(if own { 4 } else { 2 });
        chart
            .draw_series(LineSeries::new((0..=POINTS).map(at), style))?
            .label(format!("{} ({} operations){}", rival.spec, rival.total, if own { ", chosen" } else { "" }))
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 12))
        .draw()?;
    Ok(())
}
