//! All that was measured, as JSON, and how two reports differ.

use crate::bounds::Bounds;
use crate::costs::Costs;
use crate::errors::Curve;
use crate::factorisation::Factorisation;
use crate::filtering::Filtering;
use crate::fronts::{Front, Plan};
use crate::glossy::Glossy;
use crate::hemisphere::Hemisphere;
use crate::instructions::Instructions;
use crate::raster::Raster;
use crate::ringing::Ringing;
use crate::rounding::Rounding;
use crate::shading::Shading;
use crate::stability::Stability;
use crate::timing::Timing;
use crate::{Progress, costs, errors, factorisation, filtering, fronts, glossy, ringing, rounding, shading};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use zonal_codegen::families::Spec;

/// How far two floating-point figures may lie apart, relatively: another machine's sine may differ in its last bit.
const TOLERANCE: f64 = 0.01;

/// All that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The angles in degrees of every curve.
    pub angles: Vec<f64>,
    /// The error over the angle, by order and method.
    pub errors: Vec<Curve>,
    /// What each kernel costs.
    pub costs: Vec<Costs>,
    /// How each kernel rounds.
    pub rounding: Vec<Rounding>,
    /// What a budget buys.
    pub fronts: Vec<Front>,
    /// The cheapest rotation within each budget, predicted and measured.
    pub plans: Vec<Plan>,
    /// The lobe sets of the zonal factorisation.
    pub factorisation: Factorisation,
    /// What is done against ringing, and how far it errs.
    #[serde(default)]
    pub ringing: Vec<Ringing>,
    /// Shading by isotropic decomposition.
    #[serde(default)]
    pub shading: Shading,
    /// Tabulated reflectances, filtered.
    #[serde(default)]
    pub filtering: Filtering,
    /// Glossy surfaces: their bands, ringing, tables.
    #[serde(default)]
    pub glossy: Glossy,
    /// The proven rounding bounds beside what was measured last.
    #[serde(default)]
    pub bounds: Option<Vec<Bounds>>,
    /// The extremes.
    pub stability: Stability,
    /// Bases of the hemisphere and rotations on it.
    pub hemisphere: Hemisphere,
    /// How long kernels took where they were last timed.
    pub timing: Option<Timing>,
    /// The instructions of single calls where they were last counted.
    #[serde(default)]
    pub instructions: Option<Vec<Instructions>>,
    /// Pictures, which no JSON holds, besides those of the hemisphere.
    #[serde(skip)]
    pub drawn: Vec<Raster>,
}

impl Report {
    /// Measures everything but times, instructions and the bounds' million inputs.
    pub fn measure(progress: &dyn Progress) -> Self {
        let (fronts, plans) = fronts::measure(progress);
        let (filtering, filtered) = filtering::measure(progress);
        let (glossy, strips) = glossy::measure(progress);
        Self {
            angles: errors::grid(),
            errors: errors::measure(progress),
            costs: costs::measure(progress),
            rounding: rounding::measure(progress),
            fronts,
            plans,
            factorisation: factorisation::measure(progress),
            ringing: ringing::measure(progress),
            shading: shading::measure(progress),
            filtering,
            glossy,
            bounds: None,
            stability: Stability::measure(progress),
            hemisphere: Hemisphere::measure(progress),
            timing: None,
            instructions: None,
            drawn: vec![filtered, strips],
        }
    }

    /// Returns the pictures, which no JSON holds.
    pub fn pictures(&self) -> impl Iterator<Item = &Raster> {
        self.hemisphere.pictures.iter().chain(&self.drawn)
    }

    /// JSON with one line an item of each list.
    pub fn to_json(&self) -> String {
        fn lines(value: &Value, depth: usize) -> String {
            let indent = "  ".repeat(depth + 1);
            let (open, items, close): (_, Vec<String>, _) = match value {
                Value::Object(fields) if depth < 2 => {
                    let field = |(name, value)| format!("{indent}\"{name}\": {}", lines(value, depth + 1));
                    ('{', fields.iter().map(field).collect(), '}')
                }
                Value::Array(items) if items.iter().any(Value::is_object) && depth < 3 => {
                    ('[', items.iter().map(|item| format!("{indent}{item}")).collect(), ']')
                }
                other => return other.to_string(),
            };
            format!("{open}\n{}\n{}{close}", items.join(",\n"), "  ".repeat(depth))
        }
        let value = serde_json::to_value(self).expect("a report has names for its fields");
        lines(&value, 0) + "\n"
    }

    /// Where a fresh report differs from this one, times, instructions and bounds left out: counts must agree, errors to one percent.
    pub fn differences(&self, fresh: &Self) -> Vec<String> {
        let value = |report: &Self| {
            let report = Self { bounds: None, timing: None, instructions: None, ..report.clone() };
            serde_json::to_value(report).expect("a report has names for its fields")
        };
        let mut found = Vec::new();
        compare("", &value(self), &value(fresh), &mut found);
        found
    }

    /// The costs of a spec, its order written as `n`: `rotate:n:zyz`.
    pub fn cost(&self, spec: &str, order: usize) -> Option<&Costs> {
        let spec = at_order(spec, order)?;
        self.costs.iter().find(|costs| costs.spec == spec)
    }

    /// The curve of a method at an order.
    pub fn curve(&self, method: &str, order: usize) -> Option<&Curve> {
        self.errors.iter().find(|curve| curve.method == method && curve.order == order)
    }

    /// The rounding of a spec, its order written as `n`.
    pub fn rounding_of(&self, spec: &str, order: usize) -> Option<&Rounding> {
        let spec = at_order(spec, order)?;
        self.rounding.iter().find(|rounding| rounding.spec == spec)
    }
}

/// A spec with its order put in, as reports write it: `rotate:n:zyz` is `rotate:5` at order 5, where z, y, z is the default.
fn at_order(spec: &str, order: usize) -> Option<String> {
    let spec: Spec = spec.replacen(":n", &format!(":{order}"), 1).parse().ok()?;
    Some(spec.to_string())
}

fn close(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) if x.is_f64() && y.is_f64() => {
            let (x, y) = (x.as_f64().unwrap_or(f64::NAN), y.as_f64().unwrap_or(f64::NAN));
            (x - y).abs() <= TOLERANCE * x.abs().max(y.abs())
        }
        _ => a == b,
    }
}

fn compare(path: &str, old: &Value, new: &Value, found: &mut Vec<String>) {
    match (old, new) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            for (name, value) in a {
                compare(&format!("{path}/{name}"), value, &b[name], found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (place, (x, y)) in a.iter().zip(b).enumerate() {
                let name = x.get("spec").and_then(Value::as_str).map_or_else(|| place.to_string(), str::to_owned);
                compare(&format!("{path}/{name}"), x, y, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => found.push(format!("{path}: {} items, now {}", a.len(), b.len())),
        _ if close(old, new) => {}
        _ => found.push(format!("{path}: {old}, now {new}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn counts_must_agree_and_errors_nearly() {
        let old = json!({"costs": [{"spec": "a", "operations": 5, "error": 1.0e-3}], "none": null});
        for (new, count) in [
            (old.clone(), 0),
            (json!({"costs": [{"spec": "a", "operations": 5, "error": 1.005e-3}], "none": null}), 0),
            (json!({"costs": [{"spec": "a", "operations": 6, "error": 1.1e-3}], "none": null}), 2),
            (json!({"costs": [], "none": null}), 1),
            (json!({"costs": [{"spec": "a", "operations": 5, "error": null}], "none": 1.0}), 2),
        ] {
            let mut found = Vec::new();
            compare("", &old, &new, &mut found);
            assert_eq!(found.len(), count, "{found:?}");
        }
    }
}
