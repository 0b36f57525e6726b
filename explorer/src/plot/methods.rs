//! The plot of a rotation that a scene bounds: the error of every method over the angle by its law, with what the scene
//! allows.

use super::sheet::{Area, COLOURS, WIDTH, drawn};
use plotters::prelude::*;
use std::error::Error;
use zonal_codegen::families::Spec;
use zonal_codegen::plan::mixtures::Budget;
use zonal_codegen::plan::{Chosen, Plan};

/// The height of a panel.
pub const HEIGHT: u32 = 460;
/// The angles, in degrees, and how many points lie between.
const DEGREES: [f64; 2] = [0.5, 45.0];
const POINTS: u32 = 90;
/// The errors that are shown.
const ERRORS: [f64; 2] = [1e-7, 10.0];
/// The rotations of a plan that were chosen within an error.
pub fn bounded(plan: &Plan) -> Vec<&Chosen> {
    plan.kernels.iter().filter(|chosen| chosen.max_error.is_some() && !chosen.rivals.is_empty()).collect()
}

/// The panel of a rotation.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn panel(plan: &Plan, chosen: &Chosen) -> Result<String, Box<dyn Error>> {
    drawn([WIDTH, HEIGHT], |area| rotation(plan, chosen, area))
}

fn rotation(plan: &Plan, chosen: &Chosen, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
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
