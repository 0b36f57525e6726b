//! Conventions and axes as people write them, in a scene or on the command line.

use crate::fault::{Fault, hint};
use crate::math::convention::{self, Axes, Convention, Holds};
use crate::scene::wanted::Light;

/// Returns the convention of a name.
///
/// # Errors
///
/// If there is none of that name.
pub fn convention(name: &str) -> Result<Convention, Fault> {
    let known = convention::names();
    convention::named(name).copied().ok_or_else(|| {
        let (near, list) = (hint(name, &known), format!("known are {}", known.join(", ")));
        let help = if near == list { list } else { format!("{near} {list}") };
        Fault::new(format!("`{name}` is no convention"), help)
    })
}

/// Returns the axes that a text says: those of a convention by its name, or three signed axes, as in `x,-z,y`.
///
/// # Errors
///
/// If it is neither.
pub fn axes(text: &str) -> Result<Axes, Fault> {
    match text.contains(',') {
        false => convention(text).map(|convention| convention.axes).map_err(|fault| {
            let help = format!("{}; or write the axes to the map's centre, to the left of it and up, as in `x,-z,y`", fault.help);
            Fault::new(format!("`{text}` names no axes"), help)
        }),
        true => text.parse().map_err(|message: String| {
            let help = "write three different ones, each x, y or z, with - where it is the opposite: to the map's centre, to \
                        the left of it, and up, as in `x,-z,y`";
            Fault::new(message, help)
        }),
    }
}

/// Returns the convention in which coefficients are wanted: the named one or zonal's, with other axes if they are said.
///
/// # Errors
///
/// As [`convention()`] and [`axes()`].
pub fn wanted(name: Option<&str>, text: Option<&str>) -> Result<Convention, Fault> {
    let mut wanted = name.map_or(Ok(convention::ZONAL), convention)?;
    if let Some(text) = text {
        wanted.axes = axes(text)?;
    }
    Ok(wanted)
}

/// Refuses radiance where a convention holds irradiance alone, and more bands than it has.
///
/// # Errors
///
/// If it does not take them.
pub fn check(convention: &Convention, light: Light, order: usize) -> Result<(), Fault> {
    let name = convention.name;
    if convention.holds == Holds::Irradiance && light != Light::Irradiance {
        let help = "ask for irradiance: `signal = \"irradiance\"` in a scene, `--irradiance` on the command line";
        return Err(Fault::new(format!("`{name}` holds irradiance, not radiance"), help));
    }
    let most = convention.max_order;
    match order > most {
        true => {
            Err(Fault::new(format!("`{name}` has at most {most} bands, not {order}"), format!("take order {most}")))
        }
        false => Ok(()),
    }
}
