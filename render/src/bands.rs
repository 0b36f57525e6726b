//! A light's bands as a shader reads them from cubemaps, and a reflectance's table for a shader that does. It knows nothing of
//! adapters.

use half::f16;
use zonal_codegen::environment::{BandTable, Projection, Texel};
// Names a family: what is looked up for a view are its weights.
use zonal_codegen::families::isd::directions::shared;
use zonal_codegen::reflectance::brdf::Table;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::Method;

/// By how much a read errs at most in pictures, relative to the largest value of its band.
pub const ERROR: f64 = 0.01;
/// The largest number of a texel: far from the end of half precision, and so are the small ones from its other end.
const LARGEST: f64 = 1024.0;

/// The bands of a light in half precision.
#[derive(Clone, Debug)]
pub struct Tables {
    /// A table a band, its texels divided by `scale`.
    pub bands: Vec<BandTable>,
    /// What they are to be multiplied by.
    pub scale: f64,
}

impl Tables {
    /// The tables of all bands of a light, each of the smallest faces that keep an error, relative to its band's largest value.
    ///
    /// # Errors
    ///
    /// If half precision or the largest faces do not keep it.
    pub fn new(light: &Projection, error: f64) -> Result<Self, Diagnostic> {
        Self::of(light, |light, band| {
            light
                .band_table(band, error, Texel::Half)
                .map_err(|fault| Diagnostic::nowhere(fault.message, "take another method, or a larger error"))
        })
    }

    /// The tables of all bands of a light with faces of one side.
    ///
    /// # Errors
    ///
    /// Never.
    pub fn of_side(light: &Projection, side: usize) -> Result<Self, Diagnostic> {
        Self::of(light, |light, band| Ok(light.band_table_of(band, side, Texel::Half)))
    }

    fn of(
        light: &Projection,
        table: impl Fn(&Projection, usize) -> Result<BandTable, Diagnostic>,
    ) -> Result<Self, Diagnostic> {
        // No band is larger than its coefficients' norm times that of the harmonics.
        let norm = light.coefficients.iter().flatten().map(|c| c * c).sum::<f64>().sqrt() * light.order as f64;
        let scale = if norm > LARGEST { norm / LARGEST } else { 1.0 };
        let mut scaled = light.clone();
        scaled.coefficients.iter_mut().flatten().for_each(|c| *c /= scale);
        let bands = (0..light.order).map(|band| table(&scaled, band)).collect::<Result<_, _>>()?;
        Ok(Self { bands, scale })
    }

    /// Returns the bytes of all texels, three channels each.
    pub fn bytes(&self) -> usize {
        self.bands.iter().map(BandTable::bytes).sum()
    }

    /// Returns the texels of a band: R, G, B and nothing, as the bits of half precision.
    pub fn texels(&self, band: usize) -> Vec<[u16; 4]> {
        let bits = |value: f64| f16::from_f64(value).to_bits();
        self.bands[band].texels.iter().map(|&[r, g, b]| [bits(r), bits(g), bits(b), 0]).collect()
    }

    /// Returns what a shader looks up by the view: coefficients, or for a shader by isotropic decomposition weights.
    pub fn reflectance(&self, table: &Table, method: Method) -> Table {
        let mut made = table.clone();
        let Some(set) = (method == Method::IsdTables).then(|| shared(table.order)).flatten() else { return made };
        for band in 0..table.order {
            let inverse: Vec<Vec<f64>> =
                set.inverse(band).iter().map(|row| row.iter().map(|x| x.to_f64()).collect()).collect();
            for entry in made.values.chunks_exact_mut(table.stride()) {
                let of_band = &mut entry[band * band..(band + 1) * (band + 1)];
                let c: Vec<f64> = of_band.iter().map(|&c| f64::from(c)).collect();
                for (weight, row) in of_band.iter_mut().zip(&inverse) {
                    *weight = row.iter().zip(&c).map(|(a, b)| a * b).sum::<f64>() as f32;
                }
            }
        }
        made
    }
}
