//! The pages of `docs/` that the renderer measures and writes on demand: which there are, what each is made from, and its files.

use crate::bands_page;
use crate::gpu::Gpu;
use crate::mirror::ball::Ball;
use crate::mirror::page::{self as mirror, MAPS, NORMALS};
use crate::subject::{Instead, Subject};
use clap::ValueEnum;
use indicatif::ProgressBar;
use std::path::Path;
use zonal_codegen::environment::Map;
use zonal_codegen::fault::Fault;
use zonal_codegen::input;
use zonal_codegen::scene::Scene;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::normal_map::{self, NormalMap};

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Page {
    /// BANDS.md: shading from tables of a light's bands.
    Bands,
    /// REFLECTIONS.md: a mirror's pixels by Gaussians.
    Reflections,
}

/// Returns the scene of the page about bands, from the folder of scenes.
///
/// # Errors
///
/// If it is not there or at fault.
pub fn subject(scenes: &Path) -> Result<Subject, Diagnostic> {
    Subject::new(&Scene::read(&scenes.join("teapot.toml"))?, Instead::default())
}

/// A map with its name.
pub type Named = (&'static str, Map);

/// Returns the mirror and the maps of the page about reflections, from the folder of scenes.
///
/// # Errors
///
/// If a file is not there or at fault.
pub fn mirror(scenes: &Path) -> Result<(Ball, Vec<Named>), Fault> {
    let path = scenes.join(format!("normals/{NORMALS}.webp"));
    let bytes = input::read(&path, normal_map::MAX_BYTES).map_err(|error| {
        Fault::new(format!("{}: cannot be read ({error})", path.display()), "name the folder of scenes")
    })?;
    let normals = NormalMap::from_bytes(&path.display().to_string(), &bytes)?;
    let camera = Camera { azimuth: 30.0, elevation: 12.0, distance: 5.0, field: 25.0 };
    let map = |name: &'static str| {
        let map = Map::read(&scenes.join(format!("maps/{name}_256x128.hdr"))).map_err(Fault::from)?;
        Ok((name, mirror::cut(map)))
    };
    let maps = MAPS.into_iter().map(map).collect::<Result<_, Fault>>()?;
    Ok((Ball { normals, strength: 0.5, camera }, maps))
}

impl Page {
    /// Measures what the page says and returns its files: names and bytes.
    ///
    /// # Errors
    ///
    /// If a scene is at fault or the device fails.
    pub fn files(self, scenes: &Path, bar: &ProgressBar) -> Result<Vec<(&'static str, Vec<u8>)>, Diagnostic> {
        match self {
            Self::Bands => {
                let report = bands_page::Report::measure(&Gpu::open()?, &subject(scenes)?, bar)?;
                Ok(vec![("BANDS.md", report.markdown().into_bytes()), ("bands.png", report.canvas().png())])
            }
            Self::Reflections => {
                let (ball, maps) = mirror(scenes)?;
                let report = mirror::Report::measure(&ball, &maps, mirror::SIDE, &mirror::ORDERS, bar);
                Ok(vec![("REFLECTIONS.md", report.markdown().into_bytes()), ("reflections.png", report.canvas().png())])
            }
        }
    }
}
