//! From a frame's radiance to what a screen shows: the tone curve that all pictures have, exposed for the object.

use crate::frame::Frame;
pub use zonal_picture::tone::{KEY, WHITE, encoded, luminance, mapped};

/// The factor that a frame's radiance is exposed with, `stops` brighter than by itself.
pub fn exposure(frame: &Frame, stops: f64) -> f64 {
    zonal_picture::tone::exposure(frame.pixels.iter().flatten().copied()) * stops.exp2()
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
