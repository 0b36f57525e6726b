//! The order that a budget asks for: the smallest whose error, of what is seen, keeps the budget. The light is projected
//! deeper until what lies beyond leaves no doubt which order that is.

use crate::environment::{MapError, Spectrum, Survey, Weights};
use crate::families::family::MIN_ORDER;
use crate::reflectance::brdf::Brdf;
use crate::reflectance::seen;
use crate::scene::budget::RelativeTo;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::{Environment, Light, Maps, Scene};

/// How far maps are projected, one after the other while it is in doubt which order keeps the budget, or by how much.
const DEPTHS: [usize; 3] = [32, 64, 128];

/// How much of an error may be doubt.
const DOUBT: f64 = 0.02;

/// The share of the energy that a band's rounding is of.
const NOTHING: f64 = 1e-26;

/// An error that is f64's rounding: what a map holds beyond an order is known to 1e-15 of its energy.
const ROUNDING: f64 = 1e-7;

/// What was found about a light and what is seen of it.
pub(super) struct Found {
    pub survey: Survey,
    /// How much of each band is seen.
    pub weights: Weights,
    /// The energy of each band as it is seen, exactly 0 for a band that holds nothing.
    pub seen: Spectrum,
    /// The order.
    pub order: usize,
    /// Whether it keeps the budget.
    pub kept: bool,
    /// The relative rms errors of the orders from 1 on, against all bands.
    pub errors: Vec<f64>,
    /// Those of the orders 1 to the most that the scene affords, against that one.
    pub costs: Vec<f64>,
}

/// The map of a scene, projected.
fn survey(scene: &Scene, name: &str, depth: usize) -> Result<Survey, MapError> {
    match &scene.maps {
        Maps::Folder(folder) => Survey::read(&folder.join(name), depth),
        Maps::Embedded(maps) => {
            let found = maps.iter().find(|(known, _)| *known == name);
            Survey::from_bytes(name, found.map_or(&[], |(_, bytes)| bytes), depth)
        }
    }
}

/// How much of each band is seen.
pub fn weights(light: Light, brdf: Option<&Brdf>, depth: usize) -> Weights {
    match (light, brdf) {
        (Light::Irradiance, _) => Weights::irradiance(depth),
        (Light::Radiance, Some(brdf)) => seen::weights(brdf, depth),
        (Light::Radiance, None) => Weights::mirror(depth),
    }
}

/// The first order whose error is within a budget, of the errors of the orders from 1 on.
pub fn smallest(errors: &[f64], budget: f64) -> Option<usize> {
    (MIN_ORDER..=errors.len()).find(|&order| errors[order - 1] <= budget.max(ROUNDING))
}

/// Reads the map of a scene and finds the order that it needs.
pub(super) fn find(scene: &Scene, wanted: &Environment) -> Result<Found, Diagnostic> {
    let mut depths = DEPTHS.into_iter();
    loop {
        let depth = depths.next().unwrap_or(DEPTHS[0]);
        let survey =
            survey(scene, &wanted.map.value, depth).map_err(|error| Diagnostic::of(&wanted.map.place, error))?;
        let weights = weights(wanted.signal, scene.brdf.as_ref(), depth);
        let mut seen = weights.seen(&survey.projection.spectrum(), &survey.parts);
        let all = seen.energy();
        seen.bands.iter_mut().filter(|band| **band <= NOTHING * all).for_each(|band| *band = 0.0);
        let most = wanted.max_order;
        let costs = seen.errors_against(most);
        let errors = seen.errors();
        let order = match wanted.relative_to {
            RelativeTo::MaxOrder => smallest(&costs, wanted.budget),
            RelativeTo::AllBands => smallest(&errors[..most], wanted.budget),
        };
        let least = seen.least_errors();
        let own = order.unwrap_or(most);
        let is_close = errors[own - 1] - least[own - 1] <= (DOUBT * errors[own - 1]).max(ROUNDING);
        let is_same = match wanted.relative_to {
            RelativeTo::MaxOrder => true,
            RelativeTo::AllBands => smallest(&least[..most], wanted.budget) == order,
        };
        let is_sure = is_close && is_same;
        if is_sure || depth == DEPTHS[DEPTHS.len() - 1] {
            let kept = order.is_some();
            return Ok(Found { survey, weights, seen, order: own, kept, errors, costs });
        }
    }
}
