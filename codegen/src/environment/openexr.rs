//! OpenEXR, as the crate `exr` reads it: the first layer that has R, G and B. Without the feature `exr` every such file is
//! refused.

use super::error::MapError;

/// The numbers of columns and of rows, and the texels of all rows.
type Texels = (usize, usize, Vec<[f64; 3]>);

/// The first bytes of a file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

#[cfg(not(feature = "exr"))]
pub(super) fn read(name: &str, _: &[u8]) -> Result<Texels, MapError> {
    Err(MapError::Unsupported { name: name.to_owned() })
}

#[cfg(feature = "exr")]
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<Texels, MapError> {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    // The decoder is not proof against overflow in damaged files.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(name, bytes)));
    decoded.unwrap_or_else(|_| Err(MapError::malformed(name, "the decoder gave up")))
}

/// Texels outside of the display window are lost, those that the file leaves out are black.
#[cfg(feature = "exr")]
fn decode(name: &str, bytes: &[u8]) -> Result<Texels, MapError> {
    use super::error::check_size;
    use exr::error::Error;
    use exr::meta::header::Header;
    use exr::prelude::*;
    use std::io::{Cursor, ErrorKind};
    let undecodable = |error: Error| match error {
        Error::Io(error) if error.kind() == ErrorKind::UnexpectedEof => MapError::malformed(name, "it ends too early"),
        error => MapError::malformed(name, &error.to_string()),
    };
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(undecodable)?;
    let has = |header: &Header, channel: &str| header.channels.find_index_of_channel(&Text::from(channel)).is_some();
    let is_rgb = |header: &&Header| !header.deep && ["R", "G", "B"].iter().all(|channel| has(header, channel));
    let header = reader.headers().iter().find(is_rgb);
    let header = header.ok_or_else(|| MapError::malformed(name, "it has no layer of R, G and B that is not deep"))?;
    let window = header.shared_attributes.display_window;
    let (width, height) = (window.size.width(), window.size.height());
    check_size(name, width, height)?;
    let offset = header.own_attributes.layer_position - window.position;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            move |_, _| vec![[0.0; 3]; width * height],
            move |texels, place, (r, g, b): (f32, f32, f32)| {
                let place = place.to_i32() + offset;
                let inside = |x: i32, side: usize| usize::try_from(x).ok().filter(|&x| x < side);
                if let (Some(x), Some(y)) = (inside(place.x(), width), inside(place.y(), height)) {
                    texels[y * width + x] = [r, g, b].map(f64::from);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_chunks(reader)
        .map_err(undecodable)?;
    Ok((width, height, image.layer_data.channel_data.pixels))
}
