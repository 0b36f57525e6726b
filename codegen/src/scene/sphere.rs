//! The tables `[[light]]` of a scene: spheres that shine, beside its environment map. Who draws is another package.

use crate::math::convention::Axes;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::located::{Locator, Placed};
use serde::Deserialize;

/// The furthest that a light may be, in radii of the object.
const FURTHEST: f64 = 1e6;
/// The most radiance of a channel.
const BRIGHTEST: f64 = 1e9;

/// A sphere of one radiance, seen from the middle of the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight {
    /// Where its centre is, in radii of the object; z is up.
    pub position: [f64; 3],
    /// Its radius, less than its distance.
    pub radius: f64,
    /// Its radiance: R, G and B.
    pub radiance: [f64; 3],
}

impl SphereLight {
    /// The unit direction to its centre.
    pub fn direction(&self) -> [f64; 3] {
        let length = self.square().sqrt();
        self.position.map(|x| x / length)
    }

    /// The squared sine of half the angle that it fills: the square of its radius over that of its distance.
    pub fn squared_sine(&self) -> f64 {
        self.radius * self.radius / self.square()
    }

    /// Returns it in zonal's axes, its position in others; in zonal's own without any.
    #[must_use]
    pub fn in_axes(&self, axes: Option<Axes>) -> Self {
        Self { position: axes.map_or(self.position, |axes| axes.to_zonal(self.position)), ..*self }
    }

    fn square(&self) -> f64 {
        self.position.iter().map(|x| x * x).sum()
    }
}

/// A sphere that shines.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    /// Where its centre is, in radii of the object, in the axes of the environment.
    position: Placed<[f64; 3]>,
    /// Its radius, in radii of the object; less than its distance.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0.0, "maximum" = FURTHEST)))]
    radius: Placed<f64>,
    /// Its radiance: R, G and B, in the unit of the map.
    radiance: Placed<[f64; 3]>,
}

pub(super) fn light(locate: &Locator, table: LightTable) -> Result<SphereLight, Diagnostic> {
    let [position, radiance] = [table.position, table.radiance].map(|value| locate.at(value));
    if !position.value.iter().all(|x| x.abs() <= FURTHEST) {
        let message = "a light's position is out of range".to_owned();
        let help = format!("write three numbers of at most {FURTHEST}, in radii of the object");
        return Err(Diagnostic::at(&position.place, message, help));
    }
    if !radiance.value.iter().all(|x| (0.0..=BRIGHTEST).contains(x)) {
        let message = "a light's radiance is out of range".to_owned();
        return Err(Diagnostic::at(&radiance.place, message, format!("write R, G and B from 0 to {BRIGHTEST}")));
    }
    let radius = locate.number(table.radius, "a radius of", 0.0, FURTHEST)?;
    let light = SphereLight { position: position.value, radius: radius.value, radiance: radiance.value };
    if light.square() <= radius.value * radius.value {
        let message = "the middle of the object lies inside of this light".to_owned();
        return Err(Diagnostic::at(&radius.place, message, "write less than the distance of its `position`"));
    }
    Ok(light)
}

#[cfg(test)]
mod tests {
    use crate::scene::{Maps, Scene};

    fn scene(table: &str) -> Result<Scene, String> {
        let text = format!("name = \"lit\"\n[[light]]\n{table}\n");
        Scene::parse("lit.toml", &text, Maps::Embedded(&[])).map_err(|error| error.to_string())
    }

    #[test]
    fn a_light_is_read_and_seen_from_the_middle() {
        let scene = scene("position = [0, 3, -4]\nradius = 2.5\nradiance = [1, 0.5, 0]").unwrap();
        let [light] = scene.lights[..] else { panic!("one light") };
        assert_eq!((light.direction(), light.squared_sine()), ([0.0, 0.6, -0.8], 0.25));
    }

    #[test]
    fn what_is_no_light_says_why() {
        for (table, why) in [
            ("position = [0, 0, 0]\nradius = 1\nradiance = [1, 1, 1]", "lies inside of this light"),
            ("position = [1, 0, 0]\nradius = 1\nradiance = [1, 1, 1]", "lies inside of this light"),
            ("position = [1, nan, 0]\nradius = 0.1\nradiance = [1, 1, 1]", "position is out of range"),
            ("position = [1, 0, 1e7]\nradius = 0.1\nradiance = [1, 1, 1]", "position is out of range"),
            ("position = [1, 0, 0]\nradius = 0\nradiance = [1, 1, 1]", "a radius of 0 is out of range"),
            ("position = [1, 0, 0]\nradius = nan\nradiance = [1, 1, 1]", "is out of range"),
            ("position = [1, 0, 0]\nradius = 0.5\nradiance = [1, -1, 1]", "radiance is out of range"),
            ("position = [1, 0, 0]\nradius = 0.5\nradiance = [1, inf, 1]", "radiance is out of range"),
            ("position = [1, 0, 0]\nradius = 0.5", "radiance"),
            ("position = [1, 0]\nradius = 0.5\nradiance = [1, 1, 1]", "expected an array of length 3"),
            ("position = [1, 0, 0]\nradius = 0.5\nradiance = [1, 1, 1]\nsize = 1", "size"),
        ] {
            let error = scene(table).unwrap_err();
            assert!(error.contains(why), "{table}: {error}");
        }
    }
}
