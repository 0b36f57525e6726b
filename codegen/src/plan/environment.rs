//! The environment of a scene: its order, which bands are stored, what that saves, and the constants that are printed.
//! What is said of it in words is in [`light`](super::light).

use super::order::{self, Found};
use super::text::{capital, percent};
use crate::emit::Constants;
use crate::environment::{Lamps, Negative};
// Names a family: evaluation is what an environment's coefficients are for.
use crate::families::family::Spec;
use crate::families::{basis, monomial};
use crate::math::convention::{Convention, Places, ZONAL};
use crate::promise::law;
use crate::reflectance::brdf::Brdf;
use crate::reflectance::measured::Measured;
use crate::reflectance::requirement::{Requirement, Room};
use crate::scene::budget::RelativeTo;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::{Light, Scene};
use serde::Serialize;

/// What was found about an environment. *What is seen* of it is the light that the scene's reflectance sends back, in the
/// root mean square over all normals and views; or its irradiance, over all normals; or, for radiance without a reflectance,
/// the light itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnvironmentPlan {
    /// What the constants are called.
    pub name: String,
    /// The map, as the scene writes it.
    pub map: String,
    /// The columns and the rows of the map.
    pub size: [usize; 2],
    /// What is wanted of it.
    pub signal: Light,
    /// What reflects it.
    pub brdf: Option<String>,
    /// What is told of the file of a tabulated reflectance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub told: Option<String>,
    /// The budget: the relative rms error of what is seen that leaving bands out may cost.
    pub budget: f64,
    /// What that error is relative to.
    pub relative_to: RelativeTo,
    /// The most bands that the scene can afford.
    pub max_order: usize,
    /// The order that was chosen.
    pub order: usize,
    /// Whether it keeps the budget.
    pub kept: bool,
    /// The smallest order that keeps the budget, though the scene cannot afford it; none if none up to 32 does.
    pub would_keep: Option<usize>,
    /// The bands whose coefficients are stored.
    pub bands: Vec<usize>,
    /// The share of each band below `max_order` in the energy of what is seen that they hold together.
    pub energy: Vec<f64>,
    /// The share of those bands in the energy of what is seen of all bands.
    pub held: f64,
    /// The relative rms error of what is seen by each order from 1 to `max_order`, against all bands; at most.
    pub errors: Vec<f64>,
    /// That error against `max_order`.
    pub costs: Vec<f64>,
    /// The relative rms error of the light itself by each order from 1 to `max_order`, against the whole map.
    pub light_errors: Vec<f64>,
    /// The relative rms error of diffuse light by each order from 1 to `max_order`, against all bands; at most.
    pub diffuse_errors: Vec<f64>,
    /// The brightest texels of the map.
    pub lamps: Lamps,
    /// Where the chosen order is negative.
    pub negative: Negative,
    /// The bands below `max_order` that hold nothing.
    pub vanishing: Vec<usize>,
    /// How many RGB coefficients are stored, and how many `max_order` has.
    pub coefficients: [usize; 2],
    /// The operations of evaluating the stored bands in RGB, and of evaluating all of `max_order`.
    pub operations: [usize; 2],
    /// The RGB coefficients of the stored bands.
    pub values: Vec<[f64; 3]>,
    /// How the values are held.
    pub convention: Convention,
    /// What else the scene's reflectance would let go.
    pub requirement: Option<Requirement>,
}

/// Reads the map of a scene and chooses the order that it needs.
pub(super) fn plan(scene: &Scene) -> Result<Option<EnvironmentPlan>, Diagnostic> {
    let Some(wanted) = &scene.environment else {
        return Ok(None);
    };
    let Found { survey, weights, seen, order, kept, errors, costs } = order::find(scene, wanted)?;
    let max_order = wanted.max_order;
    let light = &survey.projection;
    let vanishing: Vec<usize> = (0..max_order).filter(|&l| seen.bands[l] == 0.0).collect();
    // No map is black, so that this is above zero.
    let below: f64 = seen.bands[..max_order].iter().sum();
    let energy: Vec<f64> = seen.bands[..max_order].iter().map(|band| band / below).collect();
    let brdf = scene.brdf.as_ref().filter(|_| wanted.signal == Light::Radiance);
    let (error, total) = match wanted.relative_to {
        RelativeTo::AllBands => (errors[order - 1], seen.energy()),
        RelativeTo::MaxOrder => (costs[order - 1], below),
    };
    let room = Room { order, max_order, budget: wanted.budget, error, weights: &weights.of_band, energy: total };
    let half = scene.targets.iter().all(|target| target.half.is_some());
    let requirement = brdf.map(|brdf| Requirement::new(light, brdf, &room, &vanishing, half));
    let irradiance = light.irradiance();
    let signal = match wanted.signal {
        Light::Radiance => light,
        Light::Irradiance => &irradiance,
    };
    Ok(Some(EnvironmentPlan {
        name: wanted.name.value.clone(),
        map: wanted.map.value.clone(),
        size: survey.size,
        signal: wanted.signal,
        brdf: brdf.map(ToString::to_string),
        told: brdf.and_then(Brdf::table).map(Measured::told),
        budget: wanted.budget,
        relative_to: wanted.relative_to,
        max_order,
        order,
        kept,
        would_keep: if kept { None } else { order::smallest(&errors, wanted.budget) },
        bands: (0..order).collect(),
        energy,
        held: below / seen.energy(),
        errors: errors[..max_order].to_vec(),
        vanishing,
        costs,
        light_errors: light.errors()[..max_order].to_vec(),
        diffuse_errors: order::weights(Light::Irradiance, None, light.order)
            .seen(&light.spectrum(), &survey.parts)
            .errors()[..max_order]
            .to_vec(),
        lamps: survey.lamps,
        negative: signal.negative(order),
        coefficients: [0, 0],
        operations: [0, 0],
        values: wanted.convention.value.convert_to(&signal.coefficients[..order * order]),
        convention: wanted.convention.value,
        requirement,
    }))
}

impl EnvironmentPlan {
    /// Bands that hold nothing are neither stored nor evaluated, unless a kernel of the environment's order needs all
    /// of them: only `basis` and `eval` can do without.
    pub(super) fn leave_out_vanishing_bands(&mut self, specs: &mut [(Spec, bool)], whole: bool) {
        let serves = |spec: &Spec| spec.family.some_bands && spec.is_whole();
        let takes_order = || specs.iter().filter(|(_, takes_order)| *takes_order);
        if whole || takes_order().next().is_none() || !takes_order().all(|(spec, _)| serves(spec)) {
            return;
        }
        self.bands.retain(|band| !self.vanishing.contains(band));
        self.values = self.bands.iter().flat_map(|&l| self.values[l * l..(l + 1) * (l + 1)].to_vec()).collect();
        for (spec, _) in specs.iter_mut().filter(|(_, takes_order)| *takes_order) {
            spec.bands.clone_from(&self.bands);
        }
    }

    pub(super) fn count_operations(&mut self) {
        // Names a family: evaluation is what the coefficients are for.
        let eval =
            |order: usize, bands: &[usize]| Spec { bands: bands.to_vec(), ..Spec::new(&basis::EVAL, order).rgb() };
        let all: Vec<usize> = (0..self.max_order).collect();
        let specs = [eval(self.order, &self.bands), eval(self.max_order, &all)];
        self.operations = specs.map(|spec| spec.code().cost(3).total);
        self.coefficients = [self.values.len(), self.max_order * self.max_order];
    }

    /// What an evaluation takes of coefficients that are turned into monomials first, in a sentence, or why they are not to be.
    pub(super) fn in_monomials(&self) -> Option<String> {
        let order = self.order;
        // Names a family: monomials are the other way to evaluate.
        let family = &monomial::EVAL_MONOMIAL;
        if self.bands.len() != order || !(*family.orders.start()..=monomial::MAX_FLOOR_ORDER).contains(&order) {
            return None;
        }
        let operations = Spec::new(family, order).rgb().code().cost(3).total;
        Some(match order <= monomial::MAX_EXACT_ORDER {
            true => {
                format!("Turned once by `to_monomial:{order}`, they are evaluated in RGB by {operations} operations")
            }
            false => format!(
                "Monomials would take {operations} operations in RGB, and err by more in f32: from order {} on harmonics are to be \
                 evaluated as they are",
                monomial::MAX_EXACT_ORDER + 1
            ),
        })
    }

    /// What a method that turns this light or its reflectance adds to the error of what is seen, by its law, where it errs
    /// most: relative to what is seen of all bands, in the root mean square. The reflectance is taken for a random one of its
    /// energies.
    pub(super) fn added_by(&self, spec: &Spec, angle: f64) -> f64 {
        let errors = law::errors(spec, angle);
        let squares = errors.iter().zip(&self.energy).map(|(error, share)| share * error.mean * error.mean);
        (self.held * squares.sum::<f64>()).sqrt()
    }

    /// The error of the chosen order against all bands.
    pub fn error(&self) -> f64 {
        self.errors[self.order - 1]
    }

    /// What stands above the constants.
    pub fn constants_doc(&self) -> String {
        let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
        let what = match self.signal {
            Light::Radiance => "radiance",
            Light::Irradiance => {
                "irradiance by the surface's normal (times albedo / π it is what a diffuse surface sends out)"
            }
        };
        let index = match self.convention.places {
            Places::Acn => ", index l(l+1)+m",
            Places::ByPolynomial => "",
        };
        let which = match self.bands.len() == self.order {
            true => format!("order {}{index}", self.order),
            false => format!("the bands {}, one after the other; the bands between hold nothing", bands.join(", ")),
        };
        let budget = match self.kept {
            true => String::new(),
            false => format!(", which does not keep the budget of {}", percent(self.budget)),
        };
        let error = format!("{} errs by {} against all bands{budget}.", capital(&self.seen()), percent(self.error()));
        format!("The {what} of `{}`: RGB coefficients of {which}. {error} {}", self.map, self.axes())
    }

    pub(super) fn constants(&self) -> Constants {
        Constants { name: self.name.clone(), doc: self.constants_doc(), values: self.values.clone() }
    }

    /// The axes and the convention of the values, in a sentence.
    pub(super) fn axes(&self) -> String {
        let others = match self.convention == ZONAL {
            true => "; for normals of three.js: `axes = \"three_js\"`, for its shader: `convention = \"three_js\"`",
            false => "",
        };
        format!("Axes: {}{others}.", self.convention.sentence())
    }

    /// What is seen, in a few words.
    pub fn seen(&self) -> String {
        match (self.signal, &self.brdf) {
            (Light::Irradiance, _) => "diffuse light".to_owned(),
            (Light::Radiance, Some(brdf)) => format!("what `{brdf}` reflects"),
            (Light::Radiance, None) => "the light itself, as a mirror shows it,".to_owned(),
        }
    }
}
