//! Pictures of pixels: PNG files of `docs/measure`, and whether one that lies there is still what is computed.

use image::{ImageFormat, RgbImage};
use std::io::Cursor;
use std::path::Path;
use zonal_picture::tone::encoded;

/// How far a byte may be off: another machine's sine may differ in its last bit.
const TOLERANCE: u8 = 2;
/// The colour of what is no picture.
pub const GROUND: [u8; 3] = [250, 250, 250];

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// The name of its file.
    pub name: String,
    /// Its width and height.
    pub size: [usize; 2],
    /// Its pixels, by rows from the top: red, green, blue in sRGB.
    pub pixels: Vec<[u8; 3]>,
}

impl Raster {
    /// An empty picture.
    pub fn new(name: &str, size: [usize; 2]) -> Self {
        Self { name: name.to_owned(), size, pixels: vec![GROUND; size[0] * size[1]] }
    }

    /// Sets a pixel to what sRGB stores for linear shares of white; what is negative shows as blue, three times its size.
    pub fn set(&mut self, [x, y]: [usize; 2], shares: [f64; 3]) {
        let least = shares.into_iter().fold(0.0, f64::min);
        let shown = if least < 0.0 { [0.0, 0.0, -3.0 * least] } else { shares };
        self.pixels[y * self.size[0] + x] = shown.map(encoded);
    }

    /// The bytes of its file.
    pub fn png(&self) -> Vec<u8> {
        let [width, height] = self.size.map(|side| side as u32);
        let image = RgbImage::from_raw(width, height, self.pixels.concat()).expect("there are as many pixels");
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).expect("memory takes a picture");
        bytes.into_inner()
    }

    /// What is wrong with the file of it in a folder, if anything is: other pixels, but for a step of a byte or two.
    pub fn stale(&self, folder: &Path) -> Option<String> {
        let name = &self.name;
        let image = match image::open(folder.join(name)) {
            Ok(image) => image.into_rgb8(),
            Err(error) => return Some(format!("{name}: {error}")),
        };
        if [image.width() as usize, image.height() as usize] != self.size {
            return Some(format!("{name} has another size"));
        }
        let far = |(a, b): (&image::Rgb<u8>, &[u8; 3])| a.0.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > TOLERANCE);
        let off = image.pixels().zip(&self.pixels).filter(|(a, b)| far((a, b))).count();
        // A surface's edge may take another pixel.
        (1000 * off > self.pixels.len()).then(|| format!("{name}: {off} pixels are not what is computed"))
    }
}
