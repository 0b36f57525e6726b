//! The command `zonal-bake`, to which `zonal bake` hands over: reads a mesh and a map, bakes, writes. It decides nothing
//! about light.

use clap::Parser;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use zonal_bake::basis::Basis;
use zonal_bake::chart::{Chart, LARGEST};
use zonal_bake::gather::Baker;
use zonal_bake::model;
use zonal_bake::occluders::Occluders;
use zonal_bake::output::{self, About, layers};
use zonal_bake::point::Point;
use zonal_bake::sky::Sky;
use zonal_cli::terminal::{Failure, bar, ended, out};
use zonal_codegen::environment::{Map, MapError};
use zonal_codegen::fault::Fault;
use zonal_codegen::files::{self, Replace};
use zonal_picture::mesh::Model;

/// What the help ends with.
const NOTES: &str = "Bases: sh2 to sh10, radiance in spherical harmonics; irradiance2 to irradiance10, irradiance by the \
                     normal; hsh2 to hsh10, radiance in hemispherical harmonics; h4, h6 and hl2, irradiance over the \
                     hemisphere in the H-basis and the Half-Life 2 basis; visibility2 to visibility20, 1 where the sky is \
                     seen and 0 elsewhere, in spherical harmonics.\n\n\
                     Visibility takes no map, has one number a coefficient, and is in the axes of the object, which all \
                     points share: those of the mesh's file turned so that z is up (x, -z, y), as the coefficients of a map \
                     are. All else is in the frame of the surface: x along the tangent of the first set of texture \
                     coordinates, y along the bitangent with its handedness, z along the normal, as interpolated. The map is \
                     around the mesh with its upper edge above: the mesh's y axis points there. Light from below the \
                     horizon of a point counts as none.\n\n\
                     Beside the file lies one of the same name in .toml that says what the numbers are.";

/// The most numbers of a lightmap, of which each takes some sixteen bytes while it is made.
const MOST: usize = 1 << 29;

/// Bakes the light of a map, or what is seen of the sky, into the vertices of a mesh, or into a lightmap.
#[derive(Parser)]
#[command(name = "zonal bake", bin_name = "zonal bake", version, after_help = NOTES)]
struct Arguments {
    /// The mesh: Wavefront OBJ, or glTF 2.0 as .gltf or .glb; y up. It stands in its own light.
    mesh: PathBuf,
    /// The map, .hdr, .exr or .png: latitude and longitude, or a cubemap. Of visibility there is none.
    #[arg(long)]
    map: Option<PathBuf>,
    /// What is stored, and in what.
    #[arg(long, value_name = "NAME", default_value = "h6")]
    basis: String,
    /// The file to write: .ply for vertices, .exr for a lightmap; the mesh's name without it.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Bakes a lightmap of so many texels along a side, by the second set of texture coordinates, instead of vertices.
    #[arg(long, value_name = "SIZE", value_parser = clap::value_parser!(u64).range(1..=LARGEST as u64))]
    lightmap: Option<u64>,
    /// An OBJ file of the same faces whose texture coordinates are the second set; glTF has its own, TEXCOORD_1.
    #[arg(long, value_name = "FILE.obj", requires = "lightmap")]
    lightmap_uv: Option<PathBuf>,
    /// How many rays a point casts.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u64).range(1..=1 << 20))]
    rays: u64,
    /// Which rays.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Divides irradiance by pi: what a white surface sends out.
    #[arg(long)]
    over_pi: bool,
    /// Replaces files that zonal did not write, too.
    #[arg(long)]
    force: bool,
}

impl Arguments {
    /// The file to write, and the one beside it.
    fn output(&self) -> Result<[PathBuf; 2], Fault> {
        let extension = if self.lightmap.is_some() { "exr" } else { "ply" };
        let output = match &self.output {
            Some(output) => output.clone(),
            None => PathBuf::from(self.mesh.file_name().unwrap_or_default()).with_extension(extension),
        };
        if output.extension().is_none_or(|found| !found.eq_ignore_ascii_case(extension)) {
            let what = if self.lightmap.is_some() { "a lightmap" } else { "vertices" };
            let message = format!("`{}` is no name of a file for {what}", output.display());
            return Err(Fault::new(message, format!("end it in `.{extension}`")));
        }
        let beside = output.with_extension("toml");
        Ok([output, beside])
    }
}

/// What is odd about a mesh and accepted.
fn notes(arguments: &Arguments, basis: &Basis, model: &Model) -> String {
    let mut text = String::new();
    let crowded = model::crowded_edges(model);
    if crowded > 0 {
        let _ = writeln!(text, "note: {crowded} edges belong to three triangles or more; rays stop at all of them");
    }
    if !model.has_frames && !basis.is_of_object() {
        let name = arguments.mesh.display();
        let _ = writeln!(
            text,
            "note: {name} has no texture coordinates, so that the tangents are zonal's own: they are in the file"
        );
    }
    text
}

fn check(arguments: &Arguments, basis: &Basis, model: &Model) -> Result<(), Fault> {
    if arguments.over_pi && !basis.is_irradiance() {
        let message = format!("`{}` stores {}, of which nothing is divided by pi", basis.name, basis.of());
        return Err(Fault::new(message, "leave out `--over-pi`"));
    }
    let size = arguments.lightmap.unwrap_or(0) as usize;
    if basis.channels() * size * size * basis.coefficients > MOST {
        let (name, count) = (&basis.name, basis.coefficients);
        let message =
            format!("a lightmap of {size} by {size} texels in `{name}`, of {count} coefficients, is too large");
        return Err(Fault::new(message, "name a smaller size, or a basis of fewer coefficients"));
    }
    if arguments.lightmap.is_some() && !model.has_frames && !basis.is_of_object() {
        let message = format!("{}: has no texture coordinates of a normal map, nor tangents", arguments.mesh.display());
        let help = "a lightmap is in the frame that they make: export the mesh with them, `vt` or TEXCOORD_0";
        return Err(Fault::new(message, help));
    }
    Ok(())
}

/// Where light comes from: a map, or of visibility everywhere.
fn sky(arguments: &Arguments, basis: &Basis) -> Result<Sky, Fault> {
    let name = &basis.name;
    match (&arguments.map, basis.is_of_object()) {
        (None, true) => Ok(Sky::even()),
        (Some(_), true) => Err(Fault::new(format!("`{name}` is of the mesh alone"), "leave out `--map`")),
        (None, false) => {
            Err(Fault::new(format!("`{name}` stores light, and no map of it is named"), "name one: `--map sky.hdr`"))
        }
        (Some(path), false) => {
            let black = || MapError::Black { name: path.display().to_string() };
            Ok(Sky::new(Map::read(path)?).ok_or_else(black)?)
        }
    }
}

fn run(arguments: &Arguments) -> Result<String, Failure> {
    let start = Instant::now();
    let [output, beside] = arguments.output()?;
    let basis: Basis = arguments.basis.parse()?;
    let progress = bar("reading");
    let model = model::read(&arguments.mesh, arguments.lightmap_uv.as_deref())?;
    check(arguments, &basis, &model)?;
    let sky = sky(arguments, &basis)?;
    let name = arguments.mesh.display().to_string();
    let chart = arguments.lightmap.map(|size| Chart::new(&name, &model, size as usize)).transpose()?;
    let points = match &chart {
        Some(chart) => chart.points.iter().flatten().copied().collect(),
        None => Point::vertices(&model.mesh),
    };
    let mut text = notes(arguments, &basis, &model);
    if let Some(chart) = chart.as_ref().filter(|chart| chart.overlaps > 0) {
        let count = chart.overlaps;
        let _ = writeln!(text, "note: {count} texels lie on two triangles, of which the first counts: islands overlap");
    }
    let occluders = Occluders::new(&model.mesh);
    let (rays, seed) = (arguments.rays as usize, arguments.seed);
    let over_pi = arguments.over_pi;
    let baker = Baker { sky: &sky, occluders: &occluders, basis: &basis, rays, seed, over_pi };
    progress.set_message("baking");
    progress.set_length(points.len() as u64);
    let found = baker.all(&points, || progress.inc(1));
    progress.set_message("writing");
    let bytes = match &chart {
        Some(chart) => {
            let covered: Vec<bool> = chart.points.iter().map(Option::is_some).collect();
            output::exr(chart.size, &chart.filled(&found), basis.channels(), &covered)?
        }
        None => output::ply(&model, &found, basis.channels()),
    };
    let about = About {
        basis: basis.name.clone(),
        order: basis.order,
        coefficients: basis.coefficients,
        channels: basis.channels(),
        of: basis.of(),
        over_pi,
        convention: "zonal",
        space: if basis.is_of_object() { "object" } else { "tangent" },
        axes: basis.is_of_object().then_some(output::AXES),
        scale: 1.0,
        layers: layers(basis.coefficients),
        mesh: name,
        map: arguments.map.as_ref().map(|path| path.display().to_string()),
        rays,
        seed,
    };
    let described = about.toml()?;
    let ((folder, image), (_, toml)) = (files::split(&output), files::split(&beside));
    let written = [(image.as_str(), &bytes[..]), (toml.as_str(), described.as_bytes())];
    files::write_below(folder, &written, Replace::forced(arguments.force))?;
    progress.finish_and_clear();
    let what = if chart.is_some() { "texels" } else { "vertices" };
    let seconds = start.elapsed().as_secs_f64();
    let kind = about.of;
    let _ = writeln!(
        text,
        "{} {what}, each {} coefficients of {kind} by {rays} rays, in {seconds:.1} s: {} and {}.",
        points.len(),
        basis.coefficients,
        output.display(),
        beside.display()
    );
    Ok(text)
}

fn main() -> ExitCode {
    ended(run(&Arguments::parse()).and_then(|text| out(&text)))
}
