//! Functions on the hemisphere: which basis holds them best, and what their rotation errs by. Measured in f64 by quadrature,
//! from the definitions of Habel and Wimmer 2010 and of Gautron et al. 2004, whose figures are made again.

pub mod bases;
pub mod captured;
pub mod claims;
pub mod cost;
pub mod grid;
pub mod irradiance;
pub mod light;
pub mod matrix;
pub mod pages;
pub mod rotation;
pub mod spheres;
pub mod teapot;
pub mod turn;

use crate::Progress;
use crate::raster::Raster;
use captured::Captured;
use irradiance::{MapError, Rank};
use light::Light;
use rotation::Rotation;
use serde::{Deserialize, Serialize};
use spheres::Sphere;
use teapot::{Pixel, Teapot};
use zonal_codegen::environment::map::Map;

/// All that is measured on the hemisphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hemisphere {
    /// Bases of irradiance.
    pub irradiance: Vec<Rank>,
    /// The irradiance of the maps at order 3.
    pub maps: Vec<MapError>,
    /// The energy that bases capture of lobes.
    pub captured: Vec<Captured>,
    /// Rotations.
    pub rotation: Rotation,
    /// The light of environment maps.
    pub light: Vec<Light>,
    /// One irradiance in each basis.
    pub spheres: Vec<Sphere>,
    /// Reflectances on a teapot.
    pub teapots: Vec<Teapot>,
    /// What a pixel costs under an environment map.
    pub pixels: Vec<Pixel>,
    /// The pictures, which no JSON holds.
    #[serde(skip)]
    pub pictures: Vec<Raster>,
}

/// The map whose sun stands at a grazing angle in Figure 4.
pub const SUN: &str = "sunrise";

/// The maps that the project carries, by name.
pub fn maps() -> Vec<(&'static str, Map)> {
    let read = |path| {
        let bytes = zonal_scenes::embedded(path).expect("it was listed");
        let map = Map::from_bytes(path, bytes).expect("a map of the project can be read");
        let name = path.rsplit('/').next().and_then(|file| file.split('_').next()).unwrap_or(path);
        (name, map)
    };
    zonal_scenes::below("maps").filter(|path| path.ends_with(".hdr")).map(read).collect()
}

impl Hemisphere {
    /// Measures everything.
    pub fn measure(progress: &dyn Progress) -> Self {
        let named = maps();
        let errors = irradiance::maps(&named);
        let (_, sunrise) = named.iter().find(|(name, _)| *name == SUN).expect("it is a map of the project");
        let (spheres, picture) = spheres::measure(sunrise);
        let (teapots, teapot) = teapot::measure(progress);
        let ranks = irradiance::measure(progress, &named);
        let maps: Vec<Map> = named.into_iter().map(|(_, map)| map).collect();
        let projections: Vec<_> = maps.iter().map(|map| map.project(turn::SPHERE)).collect();
        Self {
            irradiance: ranks,
            maps: errors,
            captured: captured::measure(progress),
            rotation: rotation::measure(progress, &projections),
            light: light::measure(progress, &maps),
            spheres,
            teapots,
            pixels: teapot::pixels(),
            pictures: vec![picture, teapot],
        }
    }
}
