//! From radiance to what a screen shows: exposure, Reinhard's curve and the transfer function of sRGB.
//!
//! Each channel c of the exposed radiance becomes c (1 + c/w²) / (1 + c) (Reinhard et al. 2002, equation 4), which leaves
//! the dark alone, bends the bright and reaches white at w = 4. By itself the exposure takes the object's log-average
//! luminance to 0.3. Negative radiance, which truncated lobes ring to, shows as black; nothing else clamps it.

use crate::frame::Frame;

/// The exposed radiance that becomes white.
const WHITE: f64 = 4.0;
/// What the log-average of the object's luminance is exposed to.
const KEY: f64 = 0.3;

/// The luminance of linear sRGB.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The factor that a frame's radiance is exposed with, `stops` brighter than by itself.
pub fn exposure(frame: &Frame, stops: f64) -> f64 {
    let values: Vec<f64> = frame.pixels.iter().flatten().map(|p| luminance(*p)).filter(|l| *l > 0.0).collect();
    let logs = values.iter().map(|l| l.ln()).sum::<f64>();
    let average = if values.is_empty() { KEY } else { (logs / values.len() as f64).exp() };
    KEY / average * stops.exp2()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_from_black_to_white() {
        let at = |c: f64| mapped([c, 0.0, 0.0])[0];
        assert_eq!((at(-1.0), at(0.0), at(WHITE), at(100.0)), (0.0, 0.0, 1.0, 1.0));
        assert!((0..400).all(|i| at(f64::from(i) / 100.0) < at(f64::from(i + 1) / 100.0)));
        // The dark is left alone.
        assert!((at(1e-4) / 1e-4 - 1.0).abs() < 1e-3);
        assert_eq!([0.0, 1.0, 2.0].map(encoded), [0, 255, 255]);
        // The standard's own example: a linear fifth is 124.
        assert_eq!(encoded(0.2), 124);
    }

    #[test]
    fn the_exposure_makes_frames_of_any_brightness_alike() {
        let frame = |scale: f64| Frame {
            size: [2, 1],
            pixels: vec![Some([scale; 3]), Some([4.0 * scale; 3]), None],
            milliseconds: 0.0,
        };
        assert!((exposure(&frame(7.0), 0.0) * 7.0 * 2.0 - KEY).abs() < 1e-12);
        assert!((exposure(&frame(1.0), 1.0) / exposure(&frame(1.0), 0.0) - 2.0).abs() < 1e-12);
        let empty = Frame { size: [1, 1], pixels: vec![None], milliseconds: 0.0 };
        assert!(exposure(&empty, 0.0).is_finite());
    }
}
