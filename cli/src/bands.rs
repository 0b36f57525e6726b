//! The command that writes the bands of a map as cubemaps, with the text that reads them in shaders: images, an account of them
//! and text, all or none. What a band is the library knows.

use clap::Args;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text, WritableImage, f16,
};
use serde::Serialize;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use zonal_cli::projected::name_of;
use zonal_cli::terminal::{Failure, bar, out};
use zonal_codegen::emit::bands::Reads;
// Names a language: these have textures.
use zonal_codegen::emit::language::{GLSL, WGSL};
use zonal_codegen::emit::validate::validate;
use zonal_codegen::environment::bands::{ERRORS, MAX_BANDS, bound_side};
use zonal_codegen::environment::{BandTable, FACES, Loaded, Texel};
use zonal_codegen::fault::Fault;
use zonal_codegen::files::{self, MARK, Replace};
use zonal_codegen::plan::text::{percent, table};

/// Which map, how finely, and where to.
#[derive(Args)]
pub struct Arguments {
    /// The map, as `zonal project` takes it.
    map: PathBuf,
    /// How many bands; text for shaders is written to 16.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=MAX_BANDS as u64))]
    order: u64,
    /// Irradiance instead of radiance.
    #[arg(long)]
    irradiance: bool,
    /// By how much a bilinear read may err, as a share of the largest value of its band.
    #[arg(long, default_value_t = 0.01, value_parser = error)]
    error: f64,
    /// Writes 32-bit floats instead of 16-bit ones.
    #[arg(long)]
    float: bool,
    /// The folder to write to.
    #[arg(long, value_name = "DIR", default_value = "bands")]
    out: PathBuf,
    /// Replaces files that zonal did not write, too.
    #[arg(long)]
    force: bool,
}

fn error(text: &str) -> Result<f64, String> {
    let [least, most] = ERRORS;
    let number = text.parse::<f64>().map_err(|_| format!("`{text}` is no number; write it as 0.01"))?;
    // NaN is refused too.
    match (least..=most).contains(&number) {
        true => Ok(number),
        false => Err(format!("errors are {least} to {most}")),
    }
}

/// What the files hold.
#[derive(Serialize)]
struct About {
    map: String,
    of: &'static str,
    order: usize,
    error: f64,
    texel: &'static str,
    layout: String,
    rim: &'static str,
    axes: &'static str,
    band: Vec<AboutBand>,
}

/// What a file of a band holds.
#[derive(Serialize)]
struct AboutBand {
    file: String,
    side: usize,
    largest: f64,
    error: f64,
}

/// The bytes of a band as an OpenEXR image: the faces beside each other.
fn image(table: &BandTable) -> Result<Vec<u8>, Fault> {
    let strip = table.strip();
    let channel = |(k, name): (usize, &str)| {
        let values = strip.iter().map(move |texel| texel[k]);
        let samples = match table.texel {
            Texel::Half => FlatSamples::F16(values.map(f16::from_f64).collect()),
            Texel::Float => FlatSamples::F32(values.map(|value| value as f32).collect()),
        };
        AnyChannel::new(name, samples)
    };
    let channels: Vec<AnyChannel<FlatSamples>> = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    let comments = Some(Text::new_or_panic(format!("{MARK} bands")));
    let about = LayerAttributes { comments, ..LayerAttributes::default() };
    let size = (6 * table.side, table.side);
    let layer = Layer::new(size, about, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into()));
    let mut bytes = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.map_err(|error| Fault::new(format!("the image cannot be encoded: {error}"), ""))?;
    Ok(bytes.into_inner())
}

/// The texts that read the tables, with their file names; none beyond the order to which there are such.
fn texts(name: &str, order: usize, map: &Path) -> Result<Vec<(String, String)>, Failure> {
    let origin = format!("the map `{}`", map.display());
    let reads = Reads { order, name, group: 1, origin: &origin };
    let mut texts = Vec::new();
    for target in [&WGSL, &GLSL] {
        let Some(text) = reads.text(target) else { continue };
        let file = format!("{name}s.{}", target.extension);
        // Naga's GLSL has no samplers as other compilers have them.
        if target.name == WGSL.name {
            validate(target, &file, &text).map_err(|error| Fault::new(error.to_string(), ""))?;
        }
        texts.push((file, text));
    }
    Ok(texts)
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let replace = Replace::forced(arguments.force);
    let (order, texel) = (arguments.order as usize, if arguments.float { Texel::Float } else { Texel::Half });
    let name = name_of(&arguments.map, "_band");
    let about_file = format!("{name}s.toml");
    let head = format!("# {MARK} bands: what the images beside this file hold.\n");
    let loaded = Loaded::read(&arguments.map).map_err(Fault::from)?;
    // What may not be written is better known before the work than after it.
    files::check(&arguments.out, &[(&about_file, head.as_bytes())], replace)?;
    let bar = bar("projecting");
    bar.set_length(order as u64);
    let radiance = loaded.map.project(order);
    let light = if arguments.irradiance { radiance.irradiance() } else { radiance };
    let mut tables = Vec::new();
    for band in 0..order {
        bar.set_message(format!("band {band}"));
        tables.push(light.band_table(band, arguments.error, texel).map_err(|fault| {
            let help = fault.help.replace("floats instead of halves", "`--float`");
            Fault::new(fault.message, help.replace("a larger error", "a larger `--error`"))
        })?);
        bar.inc(1);
    }
    let file = |table: &BandTable| format!("{name}_{}.exr", table.band);
    let about = About {
        map: arguments.map.display().to_string(),
        of: if arguments.irradiance { "irradiance" } else { "radiance" },
        order,
        error: arguments.error,
        texel: if arguments.float { "32-bit float" } else { "16-bit float" },
        layout: format!(
            "six faces from left to right: {}; rows from the top, each face seen from inside",
            FACES.join(" ")
        ),
        rim: "the first and the last texel of a row or a column lie on the face's rim, and its neighbour has the same ones: the text of the shaders reads them so; import without levels and without compression",
        axes: "the cube's frame is left-handed and y up, as that of OpenGL and Direct3D: its x, z and y are the map's x, y and z",
        band: tables
            .iter()
            .map(|table| AboutBand { file: file(table), side: table.side, largest: table.largest, error: table.error })
            .collect(),
    };
    let account = toml::to_string(&about).map_err(|error| Fault::new(error.to_string(), ""))?;
    let texts = texts(&name, order, &arguments.map)?;
    let mut written = vec![(about_file, format!("{head}{account}").into_bytes())];
    written.extend(texts.iter().map(|(file, text)| (file.clone(), text.clone().into_bytes())));
    for table in &tables {
        written.push((file(table), image(table)?));
    }
    let list: Vec<(&str, &[u8])> = written.iter().map(|(path, bytes)| (path.as_str(), &bytes[..])).collect();
    files::write_below(&arguments.out, &list, replace)?;
    drop(bar);

    let head = ["band", "side", "by the bound", "error", "largest value", "bytes", "file"];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for table in &tables {
        lines.push(vec![
            table.band.to_string(),
            table.side.to_string(),
            bound_side(table.band, arguments.error).to_string(),
            percent(table.error),
            format!("{:.3e}", table.largest),
            table.bytes().to_string(),
            file(table),
        ]);
    }
    let bytes: usize = tables.iter().map(BandTable::bytes).sum();
    let mut text = table(&lines);
    text += &format!(
        "\n{} bands of {}, {bytes} bytes of texels, in {}. An error is that of a bilinear read, as a share of the band's largest \
         value.\n",
        order,
        arguments.map.display(),
        arguments.out.display()
    );
    for (file, _) in &texts {
        text += &format!("{file} reads them.\n");
    }
    out(&text)
}
