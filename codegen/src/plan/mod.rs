//! From a scene to specs, and why. Kernels that the scene names are taken as they are; for a rotation that it bounds,
//! every method that does the job is built, counted and measured, and the cheapest that keeps the error is chosen; for
//! an environment, the smallest order whose missing bands cost less than the budget. All figures are the kernels' own.
//! One file: a contest of methods, its verdicts and the plan that they come to.

pub mod environment;
pub mod mixtures;
pub mod text;

use crate::emit::language::{self, Target};
use crate::emit::names::{self, Use};
use crate::emit::{Function, Module};
use crate::families::family::{Does, Spec};
use crate::generate::{self, Row};
use crate::ir::graph::Kind;
use crate::ir::listing::Cost;
use crate::plan::environment::EnvironmentPlan;
use crate::plan::mixtures::{Budget, candidates, set_up};
use crate::plan::text::{row, short, table};
use crate::promise::accuracy;
use crate::promise::built::Built;
use crate::scene::diagnostic::{Diagnostic, Place};
use crate::scene::{Job, Located, Norm, Order, Precision, Rotation, Scene, Wanted};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// What an inverse square root or a reciprocal weighs against a multiply-add when methods are compared. GPUs have a
/// quarter as many units for them (AMD's RDNA; NVIDIA's compute capability 7 and 8.0: 16 against 64 a cycle), some an
/// eighth.
pub const SPECIAL_WEIGHT: usize = 4;

/// How many f16 operations a GPU does while it does one in f32, where it packs two (AMD's RDNA, Apple's, Arm's Mali).
pub const HALF_SHARE: usize = 2;

/// What a kernel weighs when methods are compared.
pub fn price(cost: Cost) -> usize {
    cost.total + SPECIAL_WEIGHT * cost.special
}

/// A method that was weighed for a rotation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rival {
    /// The spec.
    pub spec: String,
    /// The spec of what makes its parameters, done once for all signals of a rotation, if it is not done by itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_up: Option<String>,
    /// The parameters but for the signal, of the set-up if there is one.
    pub takes: Vec<&'static str>,
    /// Multiplications, additions and multiply-adds, for all signals of a rotation.
    pub total: usize,
    /// Inverse square roots and reciprocals.
    pub special: usize,
    /// total + [`SPECIAL_WEIGHT`] · special.
    pub price: usize,
    /// The method's error at the largest angle, by its law, in the norm that the scene asks for.
    pub method_error: f64,
    /// The error of f32 rounding.
    pub rounding_f32: f64,
    /// Why it does not do what is asked, if so.
    #[serde(skip)]
    pub barred: Option<&'static str>,
    /// Whether it may be chosen.
    pub admissible: bool,
    /// Why it was chosen or not.
    pub verdict: String,
}

/// A kernel that the scene gets.
#[derive(Clone, Debug, Serialize)]
pub struct Chosen {
    /// Its costs and errors.
    #[serde(flatten)]
    pub row: Row,
    /// The largest angle in degrees that the scene asks for.
    pub max_angle: Option<f64>,
    /// The method's error at that angle.
    pub method_error: Option<f64>,
    /// The error that the scene allows.
    pub max_error: Option<f64>,
    /// What the error is the error of.
    pub norm: Option<Norm>,
    /// Why this one.
    pub reason: String,
    /// All methods that were weighed, cheapest first; none for a kernel that the scene names.
    pub rivals: Vec<Rival>,
}

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

/// The spec that a scene names, and whether it takes the order of the environment.
fn parse(wanted: &Wanted, environment: Option<&EnvironmentPlan>) -> Result<(Spec, bool), Diagnostic> {
    let Located { value, place } = &wanted.spec;
    let pieces: Vec<&str> = value.split(':').collect();
    if pieces.get(1) != Some(&"environment") {
        let spec = value.parse::<Spec>();
        return spec
            .map(|spec| (spec, false))
            .map_err(|error| Diagnostic::at(&place.within(value, error.at), error.message, error.help));
    }
    let start = pieces[0].len() + 1;
    let plan = environment.ok_or_else(|| no_environment(&place.within(value, start..start + "environment".len())))?;
    let order = plan.order.to_string();
    let text = [&[pieces[0], &order], &pieces[2..]].concat().join(":");
    let spec = text.parse::<Spec>().map_err(|error| Diagnostic::at(place, error.message, error.help))?;
    Ok((spec, true))
}

/// A method in a contest.
#[derive(Clone)]
struct Entry {
    function: Function,
    /// What makes its parameters, if it does not do so itself.
    set_up: Option<Function>,
    rival: Rival,
}

/// A rotation's methods, weighed.
struct Contest<'a> {
    rotation: &'a Rotation,
    order: usize,
    budget: Budget,
    entries: Vec<Entry>,
}

impl<'a> Contest<'a> {
    fn new(rotation: &'a Rotation, order: usize, energy: &[f64]) -> Self {
        let budget = Budget {
            max_angle: rotation.max_angle.value.to_radians(),
            error: rotation.max_error.value,
            norm: rotation.norm.value,
            energy: energy.to_vec(),
        };
        let mut contest = Self { rotation, order, budget, entries: vec![] };
        let all = candidates(rotation.kind, order, rotation.rgb).into_iter();
        let (alone, shared): (Vec<_>, Vec<_>) =
            all.map(|(spec, does)| (set_up(&spec), spec, does.barred)).partition(|(set_up, ..)| set_up.is_none());
        let specs: Vec<Spec> = alone.iter().map(|(_, spec, _)| spec.clone()).collect();
        for (function, (.., why)) in generate::build(&specs).into_iter().zip(alone) {
            contest.enter(function, None, why);
        }
        // A set-up that is done once pays for several signals, or channels, that turn alike.
        for (set_up, spec, why) in shared.into_iter().filter(|_| rotation.rgb || rotation.signals > 1) {
            let specs: Vec<Spec> = set_up.into_iter().chain([spec]).collect();
            if let [set_up, function] = &generate::build(&specs)[..] {
                contest.enter(function.clone(), Some(set_up.clone()), why);
            }
        }
        let known = |contest: &Self, spec: &Spec| contest.entries.iter().any(|entry| entry.function.spec == *spec);
        let mixtures: Vec<Spec> = contest.mixtures().into_iter().filter(|spec| !known(&contest, spec)).collect();
        for function in generate::build(&mixtures) {
            contest.enter(function, None, None);
        }
        contest.narrow();
        contest.entries.sort_by(|Entry { rival: a, .. }, Entry { rival: b, .. }| {
            a.price.cmp(&b.price).then(a.method_error.total_cmp(&b.method_error))
        });
        contest
    }

    fn enter(&mut self, function: Function, set_up: Option<Function>, why: Option<&'static str>) {
        let (spec, built) = (&function.spec, &function.built);
        let (degrees, max_error) = (self.rotation.max_angle.value, self.rotation.max_error.value);
        let own = built.code.cost(spec.channels());
        let once = set_up.as_ref().map_or_else(Cost::default, |set_up| set_up.built.code.cost(1));
        let all = |of: fn(Cost) -> usize| self.rotation.signals * of(own) + of(once);
        let method_error = self.budget.predict(spec);
        let rounding = |built: &Built| built.rounding_within(self.budget.max_angle);
        let rounding_f32 = rounding(built) + set_up.as_ref().map_or(0.0, |set_up| rounding(&set_up.built));
        let beyond = spec.max_angle().is_some_and(|limit| degrees.to_radians() > limit);
        let refused = match (why, beyond) {
            (Some(why), _) => Some(why.to_owned()),
            (None, true) => Some(format!("takes up to {} degrees only", spec.max_degrees().unwrap_or_default())),
            (None, false) if method_error + rounding_f32 <= max_error => None,
            (None, false) => Some(format!("errs by more than {max_error}")),
        };
        let given = set_up.as_ref().unwrap_or(&function).built.code.params();
        let rival = Rival {
            spec: spec.to_string(),
            set_up: set_up.as_ref().map(|set_up| set_up.spec.to_string()),
            takes: given.iter().filter(|param| param.kind == Kind::Scalar).map(|param| param.name).collect(),
            total: all(|cost| cost.total),
            special: all(|cost| cost.special),
            price: if spec.half { all(price).div_ceil(HALF_SHARE) } else { all(price) },
            method_error,
            rounding_f32,
            barred: why,
            admissible: refused.is_none(),
            verdict: refused.unwrap_or_else(|| "keeps the error".to_owned()),
        };
        self.entries.push(Entry { function, set_up, rival });
    }

    /// Every kernel again in f16, or there alone, if the scene says so.
    fn narrow(&mut self) {
        let precision = self.rotation.precision.value;
        if precision == Precision::F32 {
            return;
        }
        let halves = self.entries.iter().filter(|entry| entry.set_up.is_none() && entry.function.spec.takes_half());
        let (specs, why): (Vec<Spec>, Vec<_>) =
            halves.map(|entry| (Spec { half: true, ..entry.function.spec.clone() }, entry.rival.barred)).unzip();
        if precision == Precision::F16 {
            self.entries.clear();
        }
        for (function, why) in generate::build(&specs).into_iter().zip(why) {
            self.enter(function, None, why);
        }
    }

    /// Mixtures of methods by band that leave room for the rounding of those that were entered.
    fn mixtures(&self) -> Vec<Spec> {
        let approximate = self.entries.iter().filter(|entry| entry.function.spec.is_approximate());
        let rounding = approximate.map(|entry| entry.rival.rounding_f32).fold(0.0, f64::max);
        let budget = Budget { error: self.budget.error - rounding, ..self.budget.clone() };
        let mut specs = mixtures::mixtures(self.rotation.kind, self.order, &budget);
        specs.iter_mut().for_each(|spec| spec.rgb = self.rotation.rgb);
        specs
    }

    /// The cheapest method that keeps the error, and all of them with the reasons.
    fn decide(mut self) -> Result<(Function, Option<Function>, Chosen), Diagnostic> {
        let max_error = &self.rotation.max_error;
        let rivals = || self.entries.iter().map(|entry| &entry.rival);
        let Some(best) = rivals().position(|rival| rival.admissible) else {
            let error = |rival: &Rival| rival.method_error + rival.rounding_f32;
            let exact = rivals().min_by(|a, b| error(a).total_cmp(&error(b)));
            if self.entries.is_empty() {
                let help = "take `auto` or `f32`, or the kind `tilt`, `y` or `zyz`";
                let place = &self.rotation.precision.place;
                return Err(Diagnostic::at(place, "no kernel of this kind works in f16", help));
            }
            let message = format!("no method keeps an error of {}", max_error.value);
            let help = exact.map_or_else(String::new, |rival| {
                format!("allow {} at least: that is how far `{}` errs in f32", short(error(rival)), rival.spec)
            });
            return Err(Diagnostic::at(&max_error.place, message, help));
        };
        let which = match rivals().filter(|rival| rival.admissible).count() {
            1 => "the only one that keeps".to_owned(),
            kept => format!("the cheapest of {kept} that keep"),
        };
        let reason = format!(
            "{which} an error of {}, of {} ways to {} by up to {} degrees{}",
            max_error.value,
            self.entries.len(),
            match self.rotation.kind {
                Job::Tilt => "tilt z to a normal",
                Job::Y => "turn about y",
                Job::Zyz => "turn about z, y and z",
                Job::Quaternion => "turn by a quaternion whose y angle is bounded",
            },
            self.rotation.max_angle.value,
            match self.rotation.signals {
                1 => String::new(),
                signals => format!(", for {signals} signals that turn alike"),
            },
        );
        for (place, Entry { rival, .. }) in self.entries.iter_mut().enumerate() {
            if place == best {
                rival.verdict = "chosen".to_owned();
            } else if rival.admissible {
                rival.verdict = "keeps the error too, but costs more".to_owned();
            }
        }
        let Entry { mut function, set_up, .. } = self.entries[best].clone();
        function.name = self.rotation.name.as_ref().map(|name| name.value.clone());
        let chosen = Chosen {
            row: Row::of(&function),
            max_angle: Some(self.rotation.max_angle.value),
            method_error: Some(self.entries[best].rival.method_error),
            max_error: Some(max_error.value),
            norm: Some(self.budget.norm),
            reason,
            rivals: self.entries.into_iter().map(|entry| entry.rival).collect(),
        };
        Ok((function, set_up, chosen))
    }
}

/// Refuses a named method that cannot take the scene's angle.
fn check_angle(wanted: &Wanted, spec: &Spec) -> Result<(), Diagnostic> {
    let (Some(angle), Some(limit), Some(degrees)) = (&wanted.max_angle, spec.max_angle(), spec.max_degrees()) else {
        return Ok(());
    };
    if angle.value.to_radians() <= limit {
        return Ok(());
    }
    let message = format!("`{spec}` takes angles up to {degrees} degrees, not {}", angle.value);
    let own = |job: &Job| (spec.family.does)(spec.order, spec.rgb).contains(&Does::job(*job));
    let job = [Job::Y, Job::Quaternion].into_iter().find(own).unwrap_or(Job::Quaternion);
    let exact = mixtures::exact(job, spec.order, spec.rgb).base();
    let help = format!("`{exact}` takes every angle, or let a `[[rotation]]` with a `max_error` choose");
    Err(Diagnostic::at(&angle.place, message, help))
}

/// Refuses f16 where a language is wanted that has none.
fn check_half(scene: &Scene, place: &Place) -> Result<(), Diagnostic> {
    if scene.targets.iter().all(|target| target.half.is_some()) {
        return Ok(());
    }
    let names: Vec<String> =
        language::ALL.iter().filter(|target| target.half.is_some()).map(|target| format!("\"{target}\"")).collect();
    let message = format!("{} f16", language::only(|target| target.half.is_some()));
    Err(Diagnostic::at(place, message, format!("write `targets = [{}]`, or leave f16 out", names.join(", "))))
}

fn check_name(name: &Located<String>, purpose: Use, targets: &[Target]) -> Result<(), Diagnostic> {
    match names::fault(&name.value, purpose, targets) {
        Some((message, help)) => Err(Diagnostic::at(&name.place, message, help)),
        None => Ok(()),
    }
}

/// Refuses two functions, or a function and a constant, of one name in any language.
fn check_collisions(module: &Module, places: &[Place]) -> Result<(), Diagnostic> {
    let taken = |name: &str, place: &Place| {
        let help = "give one of them another `name`";
        Err(Diagnostic::at(place, format!("the name `{name}` is taken already"), help))
    };
    let mut shader: Vec<String> = module.constants.iter().map(|constants| constants.name.to_uppercase()).collect();
    // In Rust a module holds the functions of one order; a spec and its RGB variant share one generic function.
    let mut rust: BTreeMap<(usize, String), Option<Spec>> = BTreeMap::new();
    for (function, place) in module.functions.iter().zip(places) {
        let name = function.shader_name();
        if shader.contains(&name) {
            return taken(&name, place);
        }
        shader.push(name);
        let order = function.spec.order;
        let (generic, rgb) = function.generic_names();
        let shared = function.name.is_none().then(|| function.spec.base());
        for (name, owner) in std::iter::once((generic, shared)).chain(rgb.map(|rgb| (rgb, None))) {
            match rust.insert((order, name.clone()), owner.clone()) {
                Some(earlier) if earlier.is_none() || earlier != owner => return taken(&name, place),
                _ => {}
            }
        }
    }
    Ok(())
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
        let parsed: Result<Vec<(Spec, bool)>, _> =
            scene.kernels.iter().map(|wanted| parse(wanted, environment.as_ref())).collect();
        let mut specs = parsed?;
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
            },
            environment,
            kernels: vec![],
            places: vec![],
        };
        plan.take_named(scene, &specs)?;
        plan.take_rotations(scene)?;
        check_collisions(&plan.module, &plan.places)?;
        Ok(plan)
    }

    fn take_named(&mut self, scene: &Scene, specs: &[Spec]) -> Result<(), Diagnostic> {
        for (place, (wanted, spec)) in scene.kernels.iter().zip(specs).enumerate() {
            if specs[..place].contains(spec) {
                return Err(Diagnostic::at(&wanted.spec.place, format!("`{spec}` stands twice"), "leave one out"));
            }
            check_angle(wanted, spec)?;
            if spec.half {
                check_half(scene, &wanted.spec.place)?;
            }
        }
        for (wanted, mut function) in scene.kernels.iter().zip(generate::build(specs)) {
            function.name = wanted.name.as_ref().map(|name| name.value.clone());
            let max_angle = wanted.max_angle.as_ref().map(|angle| angle.value);
            let error = |degrees: f64| accuracy::method_error(&function.spec, degrees.to_radians());
            let chosen = Chosen {
                row: Row::of(&function),
                max_angle,
                method_error: max_angle.map(error),
                max_error: None,
                norm: None,
                reason: match wanted.spec.value.split(':').nth(1) {
                    Some("environment") => "named by the scene, at the order of its environment".to_owned(),
                    _ => "named by the scene".to_owned(),
                },
                rivals: vec![],
            };
            self.push(function, chosen, wanted.name.as_ref().map_or(&wanted.spec.place, |name| &name.place));
        }
        Ok(())
    }

    fn take_rotations(&mut self, scene: &Scene) -> Result<(), Diagnostic> {
        let mut set_ups: Vec<(Function, Chosen, &Place)> = vec![];
        for rotation in &scene.rotations {
            let order = number_of(&rotation.order, self.environment.as_ref())?;
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
            let (function, set_up, mut chosen) = Contest::new(rotation, order, energy).decide()?;
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
            self.push(function, chosen, place);
        }
        for (function, chosen, place) in set_ups {
            if !self.has(&function) {
                self.push(function, chosen, place);
            }
        }
        Ok(())
    }

    fn has(&self, function: &Function) -> bool {
        self.module.functions.iter().any(|known| (&known.spec, &known.name) == (&function.spec, &function.name))
    }

    fn push(&mut self, function: Function, chosen: Chosen, place: &Place) {
        self.module.functions.push(function);
        self.places.push(place.clone());
        self.kernels.push(chosen);
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let targets: Vec<&str> = self.targets.iter().map(|target| target.name).collect();
        writeln!(f, "# {}\n\nTargets: {}.\n", self.scene, targets.join(", "))?;
        if let Some(environment) = &self.environment {
            writeln!(f, "{environment}")?;
        }
        if self.kernels.is_empty() {
            return Ok(());
        }
        let mut rows = vec![row([
            "kernel",
            "function",
            "total",
            "special",
            "constants",
            "live",
            "f32 rounding",
            "method error",
            "why",
        ])];
        for chosen in &self.kernels {
            rows.push(vec![
                format!("`{}`", chosen.row.spec),
                format!("`{}`", chosen.row.name),
                chosen.row.cost.total.to_string(),
                chosen.row.cost.special.to_string(),
                chosen.row.footprint.constants.to_string(),
                chosen.row.footprint.live.to_string(),
                short(chosen.row.accuracy.rounding_f32),
                match (chosen.method_error, chosen.max_angle) {
                    (Some(error), Some(angle)) if error > 1e-12 => format!("{} at {angle} degrees", short(error)),
                    (None, _) if !chosen.row.accuracy.method.is_empty() => "grows with the angle".to_owned(),
                    _ => "none".to_owned(),
                },
                chosen.reason.clone(),
            ]);
        }
        writeln!(f, "## Kernels\n")?;
        f.write_str(&table(&rows))?;
        writeln!(
            f,
            "\nTotal: multiplications, additions and multiply-adds, one each. Special: inverse square roots and reciprocals."
        )?;
        for chosen in self.kernels.iter().filter(|chosen| !chosen.rivals.is_empty()) {
            writeln!(f, "\n## Why `{}`\n\nIt is {}.\n", chosen.row.spec, chosen.reason)?;
            let mut rows =
                vec![row(["method", "takes", "total", "special", "price", "method error", "f32 rounding", "verdict"])];
            for rival in &chosen.rivals {
                rows.push(vec![
                    match &rival.set_up {
                        Some(set_up) => format!("`{}` after `{set_up}`", rival.spec),
                        None => format!("`{}`", rival.spec),
                    },
                    rival.takes.join(", "),
                    rival.total.to_string(),
                    rival.special.to_string(),
                    rival.price.to_string(),
                    short(rival.method_error),
                    short(rival.rounding_f32),
                    rival.verdict.clone(),
                ]);
            }
            f.write_str(&table(&rows))?;
            writeln!(
                f,
                "\nThe price is the total plus {SPECIAL_WEIGHT} for each special, in f16 by {HALF_SHARE}; errors are {}, at the largest angle.",
                chosen.norm.unwrap_or_default().meaning()
            )?;
        }
        Ok(())
    }
}
