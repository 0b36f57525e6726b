//! From radiance to what a screen shows: Reinhard's curve and the transfer function of sRGB.
//!
//! Each channel c of the exposed radiance becomes c (1 + c/w²) / (1 + c) (Reinhard et al. 2002, equation 4), which leaves
//! the dark alone, bends the bright and reaches white at w = 4. By itself the exposure takes the log-average luminance of
//! what is seen to 0.3. Negative radiance, which truncated lobes ring to, shows as black; nothing else clamps it.

/// The exposed radiance that becomes white.
pub const WHITE: f64 = 4.0;
/// What the log-average of the luminance is exposed to.
pub const KEY: f64 = 0.3;

/// The luminance of linear sRGB.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The factor that radiance is exposed with, so that the log-average of what is above black becomes [`KEY`]; 1 if nothing
/// is.
pub fn exposure(radiance: impl IntoIterator<Item = [f64; 3]>) -> f64 {
    let values: Vec<f64> = radiance.into_iter().map(luminance).filter(|luminance| *luminance > 0.0).collect();
    let logs = values.iter().map(|luminance| luminance.ln()).sum::<f64>();
    let average = if values.is_empty() { KEY } else { (logs / values.len() as f64).exp() };
    KEY / average
}

/// The share of white, from 0 to 1 and linear, that exposed radiance shows as.
pub fn mapped(radiance: [f64; 3]) -> [f64; 3] {
    radiance.map(|c| {
        let c = c.max(0.0);
        (c * (1.0 + c / (WHITE * WHITE)) / (1.0 + c)).min(1.0)
    })
}

/// The byte that sRGB stores for a linear share of white.
pub fn encoded(share: f64) -> u8 {
    let share = share.clamp(0.0, 1.0);
    let value = if share <= 0.003_130_8 { 12.92 * share } else { 1.055 * share.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}
