//! PNG, as the crate `png` decodes it: 8 or 16 bits, grey, colour or a palette, in sRGB unless the file says that it is linear.
//! Alpha is left out. Without the feature `png` every such file is refused.

use super::decoded::Decoded;
use super::error::MapError;

/// The first bytes of a file.
pub(super) const MAGIC: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Refuses a size.
type Check<'a> = &'a dyn Fn(usize, usize) -> Result<(), MapError>;

#[cfg(not(feature = "png"))]
pub(super) fn read(name: &str, _: &[u8], _: Check<'_>) -> Result<Decoded, MapError> {
    Err(MapError::Unsupported { name: name.to_owned(), format: "PNG", feature: "png" })
}

#[cfg(feature = "png")]
pub(super) fn read(name: &str, bytes: &[u8], check: Check<'_>) -> Result<Decoded, MapError> {
    use png::{BitDepth, Decoder, DecodingError, Limits, Transformations};
    use std::io::{Cursor, ErrorKind};
    let undecodable = |error: DecodingError| match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            MapError::malformed(name, "it ends too early")
        }
        error => MapError::malformed(name, &error.to_string()),
    };
    // What is decoded is held to the size of a map; this is for what a file says of itself beside its texels.
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 1 << 28 });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(undecodable)?;
    let [width, height] = [header.width, header.height].map(|side| side as usize);
    check(width, height)?;
    let mut reader = decoder.read_info().map_err(undecodable)?;
    let info = reader.info();
    // ITU-T H.273, table 3: 16 is the perceptual quantiser, 18 hybrid log-gamma, 8 linear.
    let transfer = info.coding_independent_code_points.map(|points| points.transfer_function);
    if let Some(16 | 18) = transfer {
        let help = "save it as .hdr or .exr";
        return Err(MapError::refused(name, "is a PNG image in a transfer function of high dynamic range", help));
    }
    let is_one = |gamma: png::ScaledFloat| (gamma.into_value() - 1.0).abs() < 1e-3;
    let is_linear = transfer == Some(8) || (info.srgb.is_none() && info.gama_chunk.is_some_and(is_one));
    let bits = info.bit_depth as usize;
    let size = reader.output_buffer_size().ok_or_else(|| MapError::malformed(name, "it is too large"))?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(undecodable)?;
    let samples = frame.color_type.samples();
    let levels: Vec<f64> = match frame.bit_depth {
        BitDepth::Sixteen => (0..=65535).map(|value| linear(f64::from(value) / 65535.0, is_linear)).collect(),
        _ => (0..=255).map(|value| linear(f64::from(value) / 255.0, is_linear)).collect(),
    };
    let depth = if frame.bit_depth == BitDepth::Sixteen { 2 } else { 1 };
    let level = |bytes: &[u8]| match *bytes {
        [high, low] => levels[usize::from(high) << 8 | usize::from(low)],
        [value] => levels[usize::from(value)],
        _ => 0.0,
    };
    let texel = |texel: &[u8]| {
        let at = |channel: usize| level(&texel[channel * depth..(channel + 1) * depth]);
        match samples {
            1 | 2 => [at(0); 3],
            _ => [at(0), at(1), at(2)],
        }
    };
    let texels: Vec<[f64; 3]> = data[..frame.buffer_size()].chunks_exact(samples * depth).map(texel).collect();
    let how = if is_linear { "linear, as it says" } else { "decoded from sRGB" };
    Ok(Decoded { width, height, texels, encoding: format!("PNG of {bits} bits, {how}") })
}

/// What a value from 0 to 1 stands for (IEC 61966-2-1).
#[cfg(feature = "png")]
fn linear(value: f64, is_linear: bool) -> f64 {
    match value {
        value if is_linear => value,
        value if value <= 0.04045 => value / 12.92,
        value => ((value + 0.055) / 1.055).powf(2.4),
    }
}
