//! The plot of a light: the error over the order and the energy by band of what is seen of it, the map beside the series of
//! the order, and the spheres that both light.

use super::pixels;
use super::sheet::{Area, COLOURS, Sheet, WIDTH, drawn};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use zonal_cli::projected::Projected;
use zonal_codegen::plan::text::percent;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::Light;

const HALF: u32 = WIDTH / 2;
const HEIGHT: u32 = 360;
/// The largest order that is shown, if the plot is not of a larger one.
const ORDERS: usize = 16;
/// The least error and the least share that are shown.
const LEAST: [f64; 2] = [1e-3, 1e-6];

/// A light and what is asked of it.
pub struct Lit<'a> {
    /// What it is called.
    pub name: String,
    /// What was found about it.
    pub projected: &'a Projected,
    /// What the sphere reflects.
    pub brdf: Brdf,
    /// The error that is allowed.
    pub budget: Option<f64>,
}

impl Lit<'_> {
    fn orders(&self) -> usize {
        ORDERS.max(self.projected.order + 2).min(self.projected.survey.projection.order)
    }

    /// Draws the light.
    ///
    /// # Errors
    ///
    /// If it cannot be drawn.
    pub fn draw(&self, sheet: &mut Sheet) -> Result<(), Box<dyn Error>> {
        let Projected { order, loaded, survey, curves, .. } = self.projected;
        sheet.text(16, 26, &format!("{}: order {order}", self.name), 18);
        sheet.down(36);
        sheet.put(0, &drawn([HALF, HEIGHT], |area| self.errors(area))?);
        sheet.put(HALF, &drawn([HALF, HEIGHT], |area| self.energies(area))?);
        sheet.down(HEIGHT);
        let [whole, series] = pixels::maps(&loaded.map, &survey.projection, *order);
        let size = [HALF - 32, (HALF - 32) / 2];
        sheet.picture(16, size, &whole, "the map");
        let negative = survey.projection.negative(*order);
        let title = format!("its order {order}; negative, in magenta: {} of all directions", percent(negative.share));
        sheet.picture(HALF + 16, size, &series, &title);
        sheet.down(size[1] + 40);
        let [whole, series] = pixels::spheres(&loaded.map, &survey.projection, *order, &self.brdf);
        sheet.picture(HALF / 2 - 110, [220; 2], &whole, &format!("a sphere of `{}` under the map", self.brdf));
        let seen = match (&self.brdf, self.projected.signal) {
            (Brdf::Lambert, _) | (_, Light::Irradiance) => curves.get(1),
            _ => curves.last(),
        };
        let error = seen.map_or_else(String::new, |curve| format!(": errs by {}", percent(curve.errors[order - 1])));
        sheet.picture(HALF + HALF / 2 - 110, [220; 2], &series, &format!("under its order {order}{error}"));
        sheet.down(258);
        Ok(())
    }

    fn errors(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let last = self.orders();
        let mut chart = ChartBuilder::on(area)
            .caption("error over the order", ("sans-serif", 15))
            .margin(12)
            .x_label_area_size(36)
            .y_label_area_size(56)
            .build_cartesian_2d(0.5..last as f64 + 0.5, (LEAST[0]..1.0).log_scale())?;
        mesh(&mut chart, last, "order", "root mean square, of what is seen")?;
        if let Some(budget) = self.budget.filter(|budget| *budget >= LEAST[0]) {
            let line = LineSeries::new(vec![(0.5, budget), (last as f64 + 0.5, budget)], BLACK.stroke_width(1));
            chart
                .draw_series(line)?
                .label(format!("budget, {}", percent(budget)))
                .legend(|(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], BLACK.stroke_width(1)));
        }
        let order = self.projected.order as f64;
        let at = RGBColor(120, 120, 120).stroke_width(1);
        chart.draw_series(LineSeries::new(vec![(order, LEAST[0]), (order, 1.0)], at))?;
        for (curve, colour) in self.projected.curves.iter().zip(COLOURS) {
            let points: Vec<(f64, f64)> =
                (1..=last).map(|order| (order as f64, curve.errors[order - 1].clamp(LEAST[0], 1.0))).collect();
            let style = colour.stroke_width(2);
            chart.draw_series(points.iter().map(|point| Circle::new(*point, 3, colour.filled())))?;
            chart
                .draw_series(LineSeries::new(points, style))?
                .label(curve.what.clone())
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 12))
            .draw()?;
        Ok(())
    }

    fn energies(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let last = self.orders();
        let mut chart = ChartBuilder::on(area)
            .caption(format!("energy by band; pale: left out by order {}", self.projected.order), ("sans-serif", 15))
            .margin(12)
            .x_label_area_size(36)
            .y_label_area_size(64)
            .build_cartesian_2d(-0.5..last as f64 - 0.5, (LEAST[1]..1.0).log_scale())?;
        mesh(&mut chart, last, "band", "share of the energy of what is seen")?;
        let count = self.projected.curves.len() as f64;
        for (i, (curve, colour)) in self.projected.curves.iter().zip(COLOURS).enumerate() {
            let bar = |l: usize| {
                let from = l as f64 - 0.4 + 0.8 * i as f64 / count;
                let share = curve.shares[l].clamp(LEAST[1], 1.0);
                // A band that is left out is paler.
                let style = if l < self.projected.order { colour.mix(1.0) } else { colour.mix(0.35) };
                Rectangle::new([(from, LEAST[1]), (from + 0.8 / count, share)], style.filled())
            };
            chart.draw_series((0..last).filter(|&l| curve.shares[l] > LEAST[1]).map(bar))?;
        }
        Ok(())
    }
}

/// The chart of what is seen over orders or bands, in per cent.
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, LogCoord<f64>>>;

fn mesh(chart: &mut Chart<'_, '_>, count: usize, x: &str, y: &str) -> Result<(), Box<dyn Error>> {
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .disable_x_mesh()
        .x_labels(count)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{} %", 100.0 * y))
        .x_desc(x)
        .y_desc(y)
        .draw()?;
    Ok(())
}
