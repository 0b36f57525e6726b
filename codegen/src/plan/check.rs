//! What a plan refuses: names that a language or another function has taken, angles beyond a method's domain, f16 where
//! there is none.

// Names a family: it says which orders the hemisphere has.
use crate::emit::Module;
use crate::emit::language::{self, Target};
use crate::emit::names::{self, Use};
use crate::families::family::{Does, Spec};
use crate::families::hemisphere::table::ROTATE_TABLE;
use crate::plan::mixtures;
use crate::scene::diagnostic::{Diagnostic, Place};
use crate::scene::{Job, Located, Order, Rotation, Scene, Wanted};
use std::collections::BTreeMap;

/// Refuses a named method that cannot take the scene's angle.
pub(super) fn check_angle(wanted: &Wanted, spec: &Spec) -> Result<(), Diagnostic> {
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
pub(super) fn check_half(scene: &Scene, place: &Place) -> Result<(), Diagnostic> {
    if scene.targets.iter().all(|target| target.half.is_some()) {
        return Ok(());
    }
    let names: Vec<String> =
        language::ALL.iter().filter(|target| target.half.is_some()).map(|target| format!("\"{target}\"")).collect();
    let message = format!("{} f16", language::only(|target| target.half.is_some()));
    Err(Diagnostic::at(place, message, format!("write `targets = [{}]`, or leave f16 out", names.join(", "))))
}

/// Refuses an order that hemispherical coefficients do not have, and a norm beside their own.
pub(super) fn check_hemisphere(rotation: &Rotation, order: usize) -> Result<(), Diagnostic> {
    let place = &rotation.order.place;
    match (&rotation.hemisphere, rotation.order.value) {
        (None, _) => Ok(()),
        // A norm that is left out stands where the error does.
        (Some(_), _) if rotation.norm.place != rotation.max_error.place => {
            let help = "leave `norm` out: the error is the mean over such functions";
            Err(Diagnostic::at(&rotation.norm.place, "a rotation on the hemisphere has a norm of its own", help))
        }
        (Some(_), Order::Environment) => {
            let message = "the order of the environment is that of spherical coefficients";
            Err(Diagnostic::at(place, message, "write the order of the hemispherical ones as a number"))
        }
        (Some(_), Order::Number(_)) if !ROTATE_TABLE.orders.contains(&order) => {
            let [message, help] = (ROTATE_TABLE.outside)(order);
            Err(Diagnostic::at(place, message, help))
        }
        (Some(_), Order::Number(_)) => Ok(()),
    }
}

/// Refuses kernels of zonal for coefficients that are not held as zonal holds them.
pub(super) fn check_convention(scene: &Scene, specs: &[(Spec, bool)]) -> Result<(), Diagnostic> {
    let Some(convention) = scene.environment.as_ref().map(|environment| environment.convention.value) else {
        return Ok(());
    };
    let named = scene.kernels.iter().zip(specs).filter(|(_, (_, takes_order))| *takes_order);
    let named = named.map(|(wanted, _)| &wanted.spec.place);
    let bounded = scene.rotations.iter().filter(|rotation| rotation.order.value == Order::Environment);
    match named.chain(bounded.map(|rotation| &rotation.order.place)).next() {
        Some(place) if !convention.has_own_basis() => {
            let name = convention.name;
            let message = format!("no kernel of zonal takes coefficients as `{name}` holds them");
            let help = format!("write `axes = \"{name}\"` instead of the convention, for its axes alone");
            Err(Diagnostic::at(place, message, help))
        }
        _ => Ok(()),
    }
}

pub(super) fn check_name(name: &Located<String>, purpose: Use, targets: &[Target]) -> Result<(), Diagnostic> {
    match names::fault(&name.value, purpose, targets) {
        Some((message, help)) => Err(Diagnostic::at(&name.place, message, help)),
        None => Ok(()),
    }
}

/// Refuses two functions, or a function and a constant, of one name in any language.
pub(super) fn check_collisions(module: &Module, places: &[Place]) -> Result<(), Diagnostic> {
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
