//! A plot that is put together: panels one below the other, each an SVG of its own, and pictures as PNG in them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;

/// The width of a plot.
pub const WIDTH: u32 = 900;

/// Colours that are told apart by most eyes (Okabe and Ito).
pub const COLOURS: [RGBColor; 10] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
    RGBColor(120, 70, 20),
    RGBColor(110, 60, 160),
    RGBColor(150, 150, 40),
];

/// What a chart draws on.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A chart as an SVG of a size.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn drawn(
    [width, height]: [u32; 2],
    draw: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>,
) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        root.fill(&WHITE).map_err(|error| error.to_string())?;
        draw(&root)?;
        root.present().map_err(|error| error.to_string())?;
    }
    Ok(text)
}

/// Parts of a plot at places of it.
#[derive(Default)]
pub struct Sheet {
    parts: String,
    height: u32,
}

impl Sheet {
    /// Puts an SVG at a place, from the left of the plot and from where it ended.
    pub fn put(&mut self, x: u32, svg: &str) {
        self.parts += &svg.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{}\" ", self.height), 1);
        self.parts += "\n";
    }

    /// Puts a picture there, so large, with its title below.
    pub fn picture(&mut self, x: u32, [width, height]: [u32; 2], picture: &Picture, title: &str) {
        self.parts += &format!(
            "<image x=\"{x}\" y=\"{}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{}\"/>\n",
            self.height + 6,
            STANDARD.encode(picture.png())
        );
        self.text(x, height + 24, title, 13);
    }

    /// Writes a line there, so far down.
    pub fn text(&mut self, x: u32, down: u32, text: &str, size: u32) {
        let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        self.parts += &format!(
            "<text x=\"{x}\" y=\"{}\" font-family=\"sans-serif\" font-size=\"{size}\">{text}</text>\n",
            self.height + down
        );
    }

    /// Goes on so far below.
    pub fn down(&mut self, height: u32) {
        self.height += height;
    }

    /// The whole.
    pub fn svg(&self) -> String {
        let height = self.height;
        format!(
            "<svg width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n{}</svg>\n",
            self.parts
        )
    }
}

/// A picture in sRGB with a mask, row by row from the top.
pub struct Picture {
    /// The columns and the rows.
    pub size: [usize; 2],
    /// R, G, B and what is opaque.
    pub pixels: Vec<[u8; 4]>,
}

impl Picture {
    /// Its bytes as PNG.
    fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0] as u32, self.size[1] as u32);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        // A vector takes all that is written.
        let mut writer = encoder.write_header().expect("is no stream");
        writer.write_image_data(self.pixels.as_flattened()).expect("has as many pixels as it says");
        drop(writer);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_stands_in_the_plot_as_its_bytes() {
        let picture = Picture { size: [2, 1], pixels: vec![[1, 2, 3, 255], [4, 5, 6, 0]] };
        let mut sheet = Sheet::default();
        sheet.picture(0, [20, 10], &picture, "two texels");
        let svg = sheet.svg();
        let (_, after) = svg.split_once("href=\"data:image/png;base64,").expect("it is embedded");
        let (text, _) = after.split_once('"').expect("it ends");
        assert_eq!(STANDARD.decode(text).expect("base64"), picture.png());
    }
}
