//! What `generate` tells of a plan, to a person who has not seen it before: the order of the light, what it errs by and why,
//! and of each kernel what it does, takes and errs by. Each figure is said with its meaning.

use zonal_codegen::emit::docs;
use zonal_codegen::families::Spec;
use zonal_codegen::plan::environment::EnvironmentPlan;
use zonal_codegen::plan::text::{percent, short};
use zonal_codegen::plan::{Chosen, Plan};

/// Returns the light and the kernels of a plan, a paragraph each.
pub fn plan(plan: &Plan) -> String {
    let mut text = String::new();
    if let Some(light) = &plan.environment {
        let [width, height] = light.size;
        text += &format!("The light `{}`, of {} ({width} x {height}): {}.\n", light.name, light.map, light.verdict());
        for reason in light.reasons() {
            text += &format!("  {reason}.\n");
        }
    }
    for chosen in &plan.kernels {
        text += &kernel(chosen, plan.environment.as_ref());
    }
    text
}

fn kernel(chosen: &Chosen, light: Option<&EnvironmentPlan>) -> String {
    let row = &chosen.row;
    let mut text = format!("\nThe function `{}`, which is `{}`: {}.\n", row.name, row.spec, chosen.reason);
    let mut special = String::new();
    if let Ok(spec) = row.spec.parse::<Spec>() {
        text += &format!("  {}\n", (spec.family.what)(&spec));
        special = docs::special(&spec.code(), row.channels);
    }
    let channels = if row.channels == 3 { " for R, G and B together" } else { "" };
    text += &format!(
        "  It takes {} multiplications, additions or multiply-adds{channels}{special}. In f32 rounding is {} of {} at most, {}.\n",
        row.cost.total,
        short(row.accuracy.rounding_f32),
        row.accuracy.relative_to,
        if row.accuracy.proven { "which is proven" } else { "three times the worst that was measured" },
    );
    if let (Some(error), Some(angle)) = (chosen.method_error.filter(|error| *error > 1e-12), chosen.max_angle) {
        let of = chosen.norm.map_or("of the worst band's norm", |norm| norm.meaning());
        text += &format!("  It is an approximation: at {angle} degrees it errs by {} {of}", percent(error));
        text += &match (chosen.seen_error, light) {
            (Some(seen), Some(light)) => format!(
                "; of what one sees that is {}. With the {} that the order leaves out it is {}, since their squares add.\n",
                percent(seen),
                percent(light.error()),
                percent(seen.hypot(light.error()))
            ),
            _ => ".\n".to_owned(),
        };
    }
    text
}
