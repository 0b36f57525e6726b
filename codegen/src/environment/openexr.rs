//! OpenEXR, as the crate `exr` reads it: the first part that has R, G and B; else the layer that has them, if one can be told;
//! else luminance alone. Without the feature `exr` every such file is refused.

use super::decoded::Decoded;
#[cfg(feature = "exr")]
use super::error::MAX_WIDTH;
use super::error::MapError;

/// The first bytes of a file.
pub(crate) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Refuses a size.
pub(crate) type Check<'a> = &'a dyn Fn(usize, usize) -> Result<(), MapError>;

#[cfg(not(feature = "exr"))]
pub(crate) fn read(name: &str, _: &[u8], _: Check<'_>) -> Result<Decoded, MapError> {
    Err(MapError::Unsupported { name: name.to_owned(), format: "OpenEXR", feature: "exr" })
}

#[cfg(feature = "exr")]
pub(crate) fn read(name: &str, bytes: &[u8], check: Check<'_>) -> Result<Decoded, MapError> {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    // The decoder is not proof against overflow in damaged files.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(name, bytes, check)));
    decoded.unwrap_or_else(|_| Err(MapError::malformed(name, "the decoder gave up")))
}

/// Which channels hold the radiance.
#[cfg(feature = "exr")]
struct Channels {
    /// The part of the file.
    part: usize,
    /// R, G and B, or luminance alone.
    names: Vec<String>,
    /// What a person is told.
    encoding: String,
}

/// The names of layers that hold the whole picture, the best first, as Blender, Arnold and others write them.
#[cfg(feature = "exr")]
const WHOLE: [&str; 5] = ["combined", "beauty", "rgba", "rgb", "default"];

/// Which channels hold the radiance, or what is wrong and what to do.
#[cfg(feature = "exr")]
fn channels(name: &str, headers: &[exr::meta::header::Header]) -> Result<Channels, MapError> {
    let refused = |message: String, help: &str| Err(MapError::refused(name, message, help));
    let flat: Vec<(usize, Vec<String>)> = headers
        .iter()
        .enumerate()
        .filter(|(_, header)| !header.deep)
        .map(|(part, header)| (part, header.channels.list.iter().map(|channel| channel.name.to_string()).collect()))
        .collect();
    if flat.is_empty() {
        return refused("holds deep data alone".to_owned(), "flatten the image and save it again");
    }
    let has = |names: &[String], wanted: &str| names.iter().any(|name| name == wanted);
    let rgb = ["R", "G", "B"];
    if let Some((part, _)) = flat.iter().find(|(_, names)| rgb.iter().all(|channel| has(names, channel))) {
        let names = rgb.map(str::to_owned).to_vec();
        return Ok(Channels { part: *part, names, encoding: "OpenEXR".to_owned() });
    }
    // Layers within a part: `diffuse.R` and so on.
    let mut layers: Vec<(usize, String)> = Vec::new();
    for (part, names) in &flat {
        let prefixes = names.iter().filter_map(|channel| channel.strip_suffix(".R"));
        let whole = prefixes.filter(|layer| ["G", "B"].iter().all(|channel| has(names, &format!("{layer}.{channel}"))));
        layers.extend(whole.map(|layer| (*part, layer.to_owned())));
    }
    let last = |layer: &str| layer.rsplit('.').next().unwrap_or(layer).to_lowercase();
    let best = WHOLE.iter().find_map(|known| layers.iter().find(|(_, layer)| last(layer) == *known));
    match (best, &layers[..]) {
        (Some((part, layer)), _) | (None, [(part, layer)]) => {
            let names = rgb.map(|channel| format!("{layer}.{channel}")).to_vec();
            return Ok(Channels { part: *part, names, encoding: format!("OpenEXR, layer `{layer}`") });
        }
        (None, []) => {}
        (None, several) => {
            let list: Vec<String> = several.iter().take(8).map(|(_, layer)| format!("`{layer}`")).collect();
            let message = format!("has the layers {}, and none says that it is the whole picture", list.join(", "));
            return refused(message, "save the one that you want as channels R, G and B");
        }
    }
    let luminance = |names: &[String]| has(names, "Y");
    if let Some((part, names)) = flat.iter().find(|(_, names)| luminance(names)) {
        if has(names, "RY") || has(names, "BY") {
            let message = "holds luminance and chroma (Y, RY, BY)".to_owned();
            return refused(message, "save it as channels R, G and B");
        }
        let encoding = "OpenEXR, luminance alone: grey".to_owned();
        return Ok(Channels { part: *part, names: vec!["Y".to_owned()], encoding });
    }
    let list: Vec<&String> = flat.iter().flat_map(|(_, names)| names).take(8).collect();
    let list: Vec<String> = list.iter().map(|name| format!("`{name}`")).collect();
    refused(
        format!("has the channels {}, but neither R, G and B nor a luminance Y", list.join(", ")),
        "save the map as channels R, G and B",
    )
}

/// What a part of a block in DWA compression may say that it holds beyond twice the bytes of the block, which no part of one
/// has.
#[cfg(feature = "exr")]
const SECTION_SLACK: u64 = 1 << 16;

/// Whether every block in DWA compression says that its parts are of sizes that there can be. A block begins with eleven
/// counters of eight bytes, and the decoder asks for as much memory as they say.
#[cfg(feature = "exr")]
fn has_sane_sections(bytes: &[u8]) -> exr::error::Result<bool> {
    use exr::block::chunk::CompressedBlock;
    use exr::compression::Compression;
    const COUNTERS: usize = 11;
    let reader = exr::block::read(std::io::Cursor::new(bytes), false)?;
    let is_dwa = |compression| matches!(compression, Compression::DWAA(_) | Compression::DWAB(_));
    let limit = |header: &exr::meta::header::Header| {
        is_dwa(header.compression).then(|| 2 * header.max_block_byte_size() as u64 + SECTION_SLACK)
    };
    let limits: Vec<Option<u64>> = reader.headers().iter().map(limit).collect();
    if limits.iter().all(Option::is_none) {
        return Ok(true);
    }
    for chunk in reader.all_chunks(false)? {
        let chunk = chunk?;
        let pixels = match &chunk.compressed_block {
            CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
            CompressedBlock::Tile(block) => &block.compressed_pixels_le,
            _ => continue,
        };
        let mut counters = pixels.as_chunks::<8>().0.iter().take(COUNTERS).map(|bytes| u64::from_le_bytes(*bytes));
        let limit = limits.get(chunk.layer_index).copied().flatten();
        if limit.is_some_and(|limit| counters.any(|counter| counter > limit)) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// How many texels a part's data window may have: twice those of the largest map, for what lies beyond a picture's edges.
#[cfg(feature = "exr")]
const MAX_TEXELS: usize = MAX_WIDTH * MAX_WIDTH;

/// Whether every part is of a size that there can be: a damaged data window makes the decoder ask for all memory. Each block
/// has an entry of eight bytes in a table of the file.
#[cfg(feature = "exr")]
fn has_sane_windows(headers: &[exr::meta::header::Header], bytes: usize) -> bool {
    headers.iter().all(|header| {
        let texels = header.layer_size.width().checked_mul(header.layer_size.height());
        let is_listed = header.chunk_count.checked_mul(8).is_some_and(|listed| listed <= bytes);
        is_listed && texels.is_some_and(|texels| texels <= MAX_TEXELS)
    })
}

/// Texels outside of the display window are lost, those that the file leaves out are black.
#[cfg(feature = "exr")]
fn decode(name: &str, bytes: &[u8], check: Check<'_>) -> Result<Decoded, MapError> {
    use exr::error::Error;
    use exr::prelude::*;
    use std::io::{Cursor, ErrorKind};
    let undecodable = |error: Error| match error {
        Error::Io(error) if error.kind() == ErrorKind::UnexpectedEof => MapError::malformed(name, "it ends too early"),
        error => MapError::malformed(name, &error.to_string()),
    };
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(undecodable)?;
    if !has_sane_windows(reader.headers(), bytes.len()) {
        return Err(MapError::malformed(name, "its data window is larger than the file can hold"));
    }
    if !has_sane_sections(bytes).map_err(undecodable)? {
        return Err(MapError::malformed(name, "a block in DWA compression names a size that none has"));
    }
    let Channels { part, names, encoding } = channels(name, reader.headers())?;
    let header = &reader.headers()[part];
    let window = header.shared_attributes.display_window;
    let (width, height) = (window.size.width(), window.size.height());
    check(width, height)?;
    let offset = header.own_attributes.layer_position - window.position;
    let put = move |texels: &mut Vec<[f64; 3]>, place: Vec2<usize>, texel: [f32; 3]| {
        let place = place.to_i32() + offset;
        let inside = |x: i32, side: usize| usize::try_from(x).ok().filter(|&x| x < side);
        if let (Some(x), Some(y)) = (inside(place.x(), width), inside(place.y(), height)) {
            texels[y * width + x] = texel.map(f64::from);
        }
    };
    let wanted = exr::prelude::read().no_deep_data().largest_resolution_level();
    let texels = match &names[..] {
        [r, g, b] => {
            let channels = wanted.specific_channels().required(r.as_str()).required(g.as_str()).required(b.as_str());
            let image = channels
                .collect_pixels(
                    move |_, _| vec![[0.0; 3]; width * height],
                    move |texels, place, (r, g, b): (f32, f32, f32)| put(texels, place, [r, g, b]),
                )
                .first_valid_layer()
                .all_attributes()
                .from_chunks(reader)
                .map_err(undecodable)?;
            image.layer_data.channel_data.pixels
        }
        _ => {
            let channels = wanted.specific_channels().required(names[0].as_str());
            let image = channels
                .collect_pixels(
                    move |_, _| vec![[0.0; 3]; width * height],
                    move |texels, place, (grey,): (f32,)| put(texels, place, [grey; 3]),
                )
                .first_valid_layer()
                .all_attributes()
                .from_chunks(reader)
                .map_err(undecodable)?;
            image.layer_data.channel_data.pixels
        }
    };
    Ok(Decoded { width, height, texels, encoding })
}
