//! Kernels that a scene names and that others make superfluous: what a plan tells of them, with the figures of both.

use crate::emit::bands;
// Names a family: these have a direct form that gives the same.
use crate::families::isd::direct::{SHADE, SHADE_ZONAL};
use crate::families::isd::paper::{ISD_SHADE, ISD_SHADE_ZONAL};
use crate::families::text::usual;
use crate::families::{Family, Spec};

/// A family by the papers, the direct form of what it gives, and whether tables may serve instead.
const DIRECT: [(&Family, &Family, bool); 2] = [(&ISD_SHADE, &SHADE, true), (&ISD_SHADE_ZONAL, &SHADE_ZONAL, false)];

/// Returns what gives the same as a kernel for fewer operations, if anything does, as the rest of a sentence.
pub fn cheaper(spec: &Spec) -> Option<String> {
    let (_, direct, has_tables) = DIRECT.iter().find(|(family, ..)| *spec.family == **family)?;
    let (order, channels) = (spec.order, spec.channels());
    let other = usual(direct.name, order, spec.rgb);
    let [own, less] = [spec, &other].map(|spec| spec.code().cost(channels).total);
    let mut text = format!("`{other}` gives the same for {less} operations instead of {own}");
    let (read, reads) = (bands::shaded(order, channels), order * order);
    if *has_tables && read < less {
        let price = (less - read) as f64 / reads as f64;
        text += &format!(
            ", and {reads} reads of tables that `zonal bands` writes do with {read}, which is less where a read costs below {price:.1}"
        );
    }
    (less < own).then_some(text)
}
