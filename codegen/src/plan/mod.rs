//! From a scene to specs, and why. Kernels that the scene names are taken as they are; for a rotation that it bounds, a
//! [contest] chooses among the methods; for an environment, the smallest [order] by which what is seen of it keeps the
//! budget. All figures are the kernels' own.

mod check;
pub mod contest;
mod direct;
pub mod environment;
mod fit;
pub mod light;
pub mod mixtures;
pub mod order;
mod report;
pub mod text;

pub use crate::plan::contest::{
    Chosen, HALF_SHARE, ISSUE_CYCLES, MEMORY_CYCLES, READ_WEIGHT, RESULT_CYCLES, Rival, SPECIAL_WEIGHT, SPILL_WEIGHT,
    price,
};

use crate::emit::language::Target;
use crate::emit::names::Use;
use crate::emit::{Function, Module};
use crate::families::family::Spec;
use crate::families::several::several;
use crate::generate::{self, Row};
use crate::plan::check::{check_angle, check_collisions, check_convention, check_half, check_hemisphere, check_name};
use crate::plan::contest::Contest;
use crate::plan::environment::EnvironmentPlan;
use crate::promise::accuracy;
use crate::scene::diagnostic::{Diagnostic, Place};
use crate::scene::{Located, Norm, Order, Precision, Scene, Wanted};
use serde::Serialize;

/// What a scene comes to.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// The scene's name.
    pub scene: String,
    /// The languages.
    #[serde(serialize_with = "names_of")]
    pub targets: Vec<Target>,
    /// The output folder, relative.
    pub output: String,
    /// The environment.
    pub environment: Option<EnvironmentPlan>,
    /// The kernels, in the scene's order.
    pub kernels: Vec<Chosen>,
    /// What to print.
    #[serde(skip)]
    pub module: Module,
    /// Where each function of the module was asked for.
    #[serde(skip)]
    pub(crate) places: Vec<Place>,
}

fn names_of<S: serde::Serializer>(targets: &[Target], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(targets.iter().map(|target| target.name))
}

/// An order that a scene writes, as a number.
fn number_of(order: &Located<Order>, environment: Option<&EnvironmentPlan>) -> Result<usize, Diagnostic> {
    match (order.value, environment) {
        (Order::Number(number), _) => Ok(number),
        (Order::Environment, Some(plan)) => Ok(plan.order),
        (Order::Environment, None) => Err(no_environment(&order.place)),
    }
}

fn no_environment(place: &Place) -> Diagnostic {
    let help = "write a number, or add an `[environment]` with its map";
    Diagnostic::at(place, "the scene has no environment whose order could be taken", help)
}

/// The specs that a scene names, and whether they take the order of the environment.
fn parse(wanted: &Wanted, environment: Option<&EnvironmentPlan>) -> Result<(Vec<Spec>, bool), Diagnostic> {
    let Located { value, place } = &wanted.spec;
    let pieces: Vec<&str> = value.split(':').collect();
    if pieces.get(1) != Some(&"environment") {
        return several(value)
            .map(|specs| (specs, false))
            .map_err(|error| Diagnostic::at(&place.within(value, error.at), error.message, error.help));
    }
    let start = pieces[0].len() + 1;
    let plan = environment.ok_or_else(|| no_environment(&place.within(value, start..start + "environment".len())))?;
    let order = plan.order.to_string();
    let text = [&[pieces[0], &order], &pieces[2..]].concat().join(":");
    let specs = several(&text).map_err(|error| Diagnostic::at(place, error.message, error.help))?;
    Ok((specs, true))
}

impl Plan {
    /// Plans a scene: reads its map, builds its kernels and every method that competes for its rotations.
    ///
    /// # Errors
    ///
    /// If a spec, a name or a map is at fault, a method cannot take its angle, or no method keeps an error.
    pub fn new(scene: &Scene) -> Result<Self, Diagnostic> {
        check_name(&scene.name, Use::Stem, &scene.targets)?;
        if scene.kernels.is_empty() && scene.rotations.is_empty() && scene.environment.is_none() {
            let help = "add a `[[kernel]]` with its `spec`, a `[[rotation]]` or an `[environment]`";
            return Err(Diagnostic::at(&scene.name.place, "the scene asks for nothing", help));
        }
        let own_names = scene.kernels.iter().filter_map(|wanted| wanted.name.as_ref());
        for name in own_names.chain(scene.rotations.iter().filter_map(|rotation| rotation.name.as_ref())) {
            check_name(name, Use::Item, &scene.targets)?;
        }
        if let Some(environment) = &scene.environment {
            check_name(&environment.name, Use::Item, &scene.targets)?;
        }
        let mut environment = environment::plan(scene)?;
        // What a scene asks for, a row a function.
        let (mut kernels, mut specs) = (vec![], vec![]);
        for wanted in &scene.kernels {
            let (all, takes_order) = parse(wanted, environment.as_ref())?;
            if let (Some(name), 2..) = (&wanted.name, all.len()) {
                let message =
                    format!("`{}` is {} functions, which cannot all be `{}`", wanted.spec.value, all.len(), name.value);
                return Err(Diagnostic::at(
                    &name.place,
                    message,
                    "leave the name out, or ask for each piece by its own spec",
                ));
            }
            for spec in all {
                kernels.push(wanted.clone());
                specs.push((spec, takes_order));
            }
        }
        check_convention(scene, &specs)?;
        if let Some(plan) = &mut environment {
            let whole = scene.rotations.iter().any(|rotation| rotation.order.value == Order::Environment);
            plan.leave_out_vanishing_bands(&mut specs, whole);
            plan.count_operations();
        }
        let specs: Vec<Spec> = specs.into_iter().map(|(spec, _)| spec).collect();
        let mut plan = Self {
            scene: scene.name.value.clone(),
            targets: scene.targets.clone(),
            output: scene.output.clone(),
            module: Module {
                name: scene.name.value.clone(),
                origin: format!("the scene `{}`", scene.name.value),
                functions: vec![],
                constants: environment.iter().map(EnvironmentPlan::constants).collect(),
                arrays: scene.arrays,
                form: scene.form,
            },
            environment,
            kernels: vec![],
            places: vec![],
        };
        plan.take_named(scene, &kernels, &specs)?;
        plan.take_rotations(scene)?;
        check_collisions(&plan.module, &plan.places)?;
        Ok(plan)
    }

    fn take_named(&mut self, scene: &Scene, kernels: &[Wanted], specs: &[Spec]) -> Result<(), Diagnostic> {
        for (place, (wanted, spec)) in kernels.iter().zip(specs).enumerate() {
            if specs[..place].contains(spec) {
                return Err(Diagnostic::at(&wanted.spec.place, format!("`{spec}` stands twice"), "leave one out"));
            }
            check_angle(wanted, spec)?;
            if spec.half {
                check_half(scene, &wanted.spec.place)?;
            }
        }
        for (wanted, mut function) in kernels.iter().zip(generate::build(specs)) {
            function.name = wanted.name.as_ref().map(|name| name.value.clone());
            let max_angle = wanted.max_angle.as_ref().map(|angle| angle.value);
            let error = |degrees: f64| accuracy::method_error(&function.spec, degrees.to_radians());
            let asked = match wanted.spec.value.split(':').nth(1) {
                Some("environment") => "asked for by the scene, at the order of its light",
                _ => "asked for by the scene",
            };
            let chosen = Chosen {
                row: Row::of(&function),
                max_angle,
                method_error: max_angle.map(error),
                max_error: None,
                norm: None,
                hemisphere: None,
                seen_error: None,
                reason: match direct::cheaper(&function.spec) {
                    Some(cheaper) => format!("{asked}; {cheaper}"),
                    None => asked.to_owned(),
                },
                rivals: vec![],
            };
            let place = wanted.name.as_ref().map_or(&wanted.spec.place, |name| &name.place);
            self.push_within(function, chosen, place, scene)?;
        }
        Ok(())
    }

    fn take_rotations(&mut self, scene: &Scene) -> Result<(), Diagnostic> {
        let mut set_ups: Vec<(Function, Chosen, &Place)> = vec![];
        for rotation in &scene.rotations {
            let order = number_of(&rotation.order, self.environment.as_ref())?;
            check_hemisphere(rotation, order)?;
            if rotation.precision.value != Precision::F32 {
                check_half(scene, &rotation.precision.place)?;
            }
            let energy = match (rotation.norm.value, self.environment.as_ref()) {
                (Norm::Signal, None) => {
                    let help = "add an `[environment]` with its map, or take `max` or `mean`";
                    let message = "the scene has no environment whose energy could weigh the bands";
                    return Err(Diagnostic::at(&rotation.norm.place, message, help));
                }
                (_, environment) => environment.map_or(&[][..], |environment| &environment.energy),
            };
            let (function, set_up, mut chosen) =
                Contest::new(rotation, order, energy, scene.registers.as_ref()).decide()?;
            if let (Order::Environment, Some(environment)) = (rotation.order.value, &self.environment) {
                chosen.seen_error = Some(environment.added_by(&function.spec, rotation.max_angle.value.to_radians()));
            }
            let place = rotation.name.as_ref().map_or(&rotation.order.place, |name| &name.place);
            if let Some(set_up) = set_up {
                let chosen = Chosen {
                    row: Row::of(&set_up),
                    reason: format!("what `{}` takes, once for all that turns alike", function.spec),
                    rivals: vec![],
                    ..chosen.clone()
                };
                set_ups.push((set_up, chosen, place));
            }
            if self.has(&function) {
                chosen.reason += ", and there already";
                self.kernels.push(chosen);
                continue;
            }
            self.push_within(function, chosen, place, scene)?;
        }
        for (function, chosen, place) in set_ups {
            if !self.has(&function) {
                self.push_within(function, chosen, place, scene)?;
            }
        }
        Ok(())
    }

    fn has(&self, function: &Function) -> bool {
        self.module.functions.iter().any(|known| (&known.spec, &known.name) == (&function.spec, &function.name))
    }

    /// Takes a kernel, in pieces if the scene allows too few registers for the whole.
    fn push_within(
        &mut self,
        function: Function,
        mut chosen: Chosen,
        place: &Place,
        scene: &Scene,
    ) -> Result<(), Diagnostic> {
        let Some(most) = &scene.registers else {
            chosen.reason.extend(fit::spilled(&function.spec).map(|text| format!("; {text}")));
            self.push(function, chosen, place);
            return Ok(());
        };
        let (specs, why) = fit::fitted(&function.spec, most)?;
        let Some(why) = why else {
            self.push(function, chosen, place);
            return Ok(());
        };
        chosen.reason = format!("{why}; it is {}", chosen.reason);
        for mut piece in generate::build(&specs) {
            piece.name = function.name.as_ref().map(|name| piece.spec.named(name));
            if !self.has(&piece) {
                let rivals = std::mem::take(&mut chosen.rivals);
                self.push(piece.clone(), Chosen { row: Row::of(&piece), rivals, ..chosen.clone() }, place);
            }
        }
        Ok(())
    }

    fn push(&mut self, function: Function, chosen: Chosen, place: &Place) {
        self.module.functions.push(function);
        self.places.push(place.clone());
        self.kernels.push(chosen);
    }
}
