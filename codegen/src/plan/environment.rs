//! The environment of a scene: the smallest order whose missing bands cost less than the budget, which bands are stored,
//! and what that saves.

use super::text::{percent, row, table};
use crate::emit::Constants;
use crate::environment::{MapError, Projection};
// Names a family: evaluation is what an environment's coefficients are for.
use crate::families::basis;
use crate::families::family::{MIN_ORDER, Spec};
use crate::generate;
use crate::math::convention::{Convention, Places, ZONAL};
use crate::reflectance::requirement::Requirement;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::{Light, Maps, Scene};
use serde::Serialize;
use std::fmt;

/// What was found about an environment.
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
    /// The budget.
    pub budget: f64,
    /// The most bands that the scene can afford.
    pub max_order: usize,
    /// The order that was chosen.
    pub order: usize,
    /// The bands whose coefficients are stored.
    pub bands: Vec<usize>,
    /// The share of each band below `max_order` in the energy that they hold together.
    pub energy: Vec<f64>,
    /// The share of those bands in the energy of the whole map.
    pub held: f64,
    /// The relative rms error of each order from 1 to `max_order`, against the whole map.
    pub errors: Vec<f64>,
    /// The bands below `max_order` that hold nothing.
    pub vanishing: Vec<usize>,
    /// The relative rms error of each order from 1 to `max_order`, against `max_order`.
    pub costs: Vec<f64>,
    /// How many RGB coefficients are stored, and how many `max_order` has.
    pub coefficients: [usize; 2],
    /// The operations of evaluating the stored bands in RGB, and of evaluating all of `max_order`.
    pub operations: [usize; 2],
    /// The RGB coefficients of the stored bands.
    pub values: Vec<[f64; 3]>,
    /// How the values are held.
    pub convention: Convention,
    /// What the scene's reflectance requires of the light; then `energy` is that of what is reflected.
    pub requirement: Option<Requirement>,
}

/// Maps are projected at least this far, so that the energy beyond is known well.
const DEPTH: usize = 32;

/// The projection of a scene's map, and its size.
fn projected(scene: &Scene, name: &str, order: usize) -> Result<(Projection, [usize; 2]), MapError> {
    match &scene.maps {
        Maps::Folder(folder) => Projection::read(&folder.join(name), order),
        Maps::Embedded(maps) => {
            let found = maps.iter().find(|(known, _)| *known == name);
            Projection::from_bytes(name, found.map_or(&[], |(_, bytes)| bytes), order)
        }
    }
}

/// Reads the map of a scene and chooses the order that it needs.
pub(super) fn plan(scene: &Scene) -> Result<Option<EnvironmentPlan>, Diagnostic> {
    let Some(wanted) = &scene.environment else {
        return Ok(None);
    };
    let (radiance, size) = projected(scene, &wanted.map.value, DEPTH.max(wanted.max_order))
        .map_err(|error| Diagnostic::of(&wanted.map.place, error))?;
    let signal = match wanted.signal {
        Light::Radiance => radiance,
        Light::Irradiance => radiance.irradiance(),
    };
    let max_order = wanted.max_order;
    let mut vanishing: Vec<usize> = (0..max_order).filter(|&l| signal.vanishes(l)).collect();
    let mut energy = signal.band_energy();
    energy.truncate(max_order);
    let held = energy.iter().sum::<f64>() / signal.energy();
    let requirement = scene.brdf.filter(|_| wanted.signal == Light::Radiance).map(|brdf| {
        let half = scene.targets.iter().all(|target| target.half.is_some());
        Requirement::new(&signal, &brdf, wanted.budget, max_order, half)
    });
    if let Some(requirement) = &requirement {
        // What is reflected decides, not the light itself.
        energy.clone_from(&requirement.energy);
        vanishing = (0..max_order).filter(|&l| !requirement.holds(l)).collect();
    }
    vanishing.iter().for_each(|&l| energy[l] = 0.0);
    // No map is black, so that this is above zero.
    let all: f64 = energy.iter().sum();
    energy.iter_mut().for_each(|band| *band /= all);
    let costs: Vec<f64> = (1..=max_order).map(|order| energy[order..].iter().sum::<f64>().sqrt()).collect();
    // The last entry is zero, so that one is found.
    let order = (MIN_ORDER..max_order).find(|&order| costs[order - 1] <= wanted.budget).unwrap_or(max_order);
    Ok(Some(EnvironmentPlan {
        name: wanted.name.value.clone(),
        map: wanted.map.value.clone(),
        size,
        signal: wanted.signal,
        budget: wanted.budget,
        max_order,
        order,
        bands: (0..order).collect(),
        energy,
        held,
        errors: signal.errors()[..max_order].to_vec(),
        vanishing,
        costs,
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
        let functions = generate::build(&[eval(self.order, &self.bands), eval(self.max_order, &all)]);
        self.operations = [0, 1].map(|i| functions[i].built.code.cost(3).total);
        self.coefficients = [self.values.len(), self.max_order * self.max_order];
    }

    pub(super) fn constants(&self) -> Constants {
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
        let error = match self.order == self.max_order {
            true => String::new(),
            false => format!(" They err by {} against order {}.", percent(self.costs[self.order - 1]), self.max_order),
        };
        Constants {
            name: self.name.clone(),
            doc: format!("The {what} of `{}`: RGB coefficients of {which}.{error} {}", self.map, self.axes()),
            values: self.values.clone(),
        }
    }

    /// The axes and the convention of the values, in a sentence.
    fn axes(&self) -> String {
        let others = match self.convention == ZONAL {
            true => "; for normals of three.js: `axes = \"three_js\"`, for its shader: `convention = \"three_js\"`",
            false => "",
        };
        format!("Axes: {}{others}.", self.convention.sentence())
    }

    /// What was decided, in a few sentences.
    pub fn summary(&self) -> String {
        let cost = |order: usize| percent(self.costs[order - 1]);
        let (order, budget) = (self.order, percent(self.budget));
        let mut text = match order == self.max_order {
            true => format!(
                "order {order}, all that the scene affords: one order less would err by {} against it, and the budget is \
                 {budget}.",
                cost(order - 1)
            ),
            false => format!(
                "order {order}: it errs by {} against order {}, within the budget of {budget}; one order less would err \
                 by {}.",
                cost(order),
                self.max_order,
                cost(order - 1)
            ),
        };
        let missing: Vec<String> =
            self.vanishing.iter().filter(|l| !self.bands.contains(l)).map(usize::to_string).collect();
        if !missing.is_empty() {
            let (bands, hold) = if missing.len() == 1 { ("Band", "holds") } else { ("Bands", "hold") };
            text += &format!(" {bands} {} {hold} nothing.", missing.join(", "));
        }
        let ([coefficients, all], [operations, whole]) = (self.coefficients, self.operations);
        if coefficients < all {
            text += &format!(
                " That saves {} of {all} coefficients and {} of {whole} operations of an RGB evaluation.",
                all - coefficients,
                whole.saturating_sub(operations)
            );
        }
        text += &format!(" Order {} holds {} of the energy of the whole map", self.max_order, percent(self.held));
        text += match self.held < 0.5 {
            true => "; the rest is light too small for it.",
            false => ".",
        };
        text
    }
}

impl fmt::Display for EnvironmentPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "## Environment `{}`\n", self.name)?;
        let signal = match self.signal {
            Light::Radiance => "radiance",
            Light::Irradiance => "irradiance",
        };
        writeln!(f, "`{}`, {width} x {height}, {signal}. Chosen: {} {}\n", self.map, self.summary(), self.axes())?;
        let mut rows = vec![row(["band", "energy", "error if it is the last", "error against the whole map", ""])];
        for l in 0..self.max_order {
            rows.push(vec![
                l.to_string(),
                percent(self.energy[l]),
                percent(self.costs[l]),
                percent(self.errors[l]),
                match (l < self.order, self.bands.contains(&l)) {
                    _ if self.vanishing.contains(&l) => "holds nothing",
                    (true, true) if l + 1 == self.order => "the last that is kept",
                    (true, _) => "kept",
                    (false, _) => "left out",
                }
                .to_owned(),
            ]);
        }
        f.write_str(&table(&rows))?;
        if let Some(requirement) = &self.requirement {
            write!(f, "\n{requirement}")?;
        }
        Ok(())
    }
}
