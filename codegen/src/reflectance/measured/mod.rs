//! Tabulated reflectances: files that hold what a material was measured to reflect, or what a program sampled. It knows which
//! layouts there are and what is missing in a file; what an entry means is in the file of its layout.
//!
//! | layout | known by | what it holds |
//! |---|---|---|
//! | [`merl`] | three int32, 90, 90, 180 | half and difference angles, RGB, isotropic |
//! | [`pairs`] as OpenEXR | the format's first bytes | a row a view, a column a light, on grids of one step |
//! | [`pairs`] as an array of NumPy | the format's first bytes | view elevation × azimuth × light elevation × azimuth (× 3) |
//!
//! An entry is the reflectance per steradian without the cosine. One below zero is missing: it takes the value of the nearest
//! that is there on its line, and is told. The tables are linear between their entries.

pub mod entries;
pub mod merl;
pub mod npy;
pub mod pairs;

pub use entries::{MAX_VALUE, Missing};

use crate::environment::MapError;
use crate::environment::openexr;
use crate::fault::Fault;
use crate::input;
use entries::refused;
use merl::Merl;
use pairs::Pairs;
use std::path::Path;
use std::sync::Arc;

/// The largest file that is read, in bytes.
pub const MAX_BYTES: usize = 1 << 28;

/// A tabulated reflectance: its entries, and what is told of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// What it is called: its file, as it was named.
    pub name: String,
    /// What was missing.
    pub missing: Missing,
    /// Whether its channels differ.
    pub coloured: bool,
    layout: Layout,
}

#[derive(Clone, Debug, PartialEq)]
enum Layout {
    Merl(Merl),
    Pairs(Pairs),
}

/// A channel of a tabulated reflectance, or the mean of all three.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    /// The table.
    pub table: Arc<Measured>,
    /// Which channel, 0 to 2; the mean if it is none.
    pub channel: Option<usize>,
}

impl Measured {
    /// Reads a file, whose layout its first bytes tell.
    ///
    /// # Errors
    ///
    /// If it cannot be read, is no regular file or larger than [`MAX_BYTES`], or as [`Measured::from_bytes`].
    pub fn read(path: &Path) -> Result<Self, Fault> {
        let name = path.display().to_string();
        let bytes = input::read(path, MAX_BYTES).map_err(|error| {
            refused(&name, format!("cannot be read ({error})"), "check the path of the tabulated reflectance")
        })?;
        Self::from_bytes(&name, &bytes)
    }

    /// Reads the bytes of a file. `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// If they are in none of the layouts, too few or too many, or an entry is not finite or above [`MAX_VALUE`], or none is
    /// above zero. No bytes make it panic.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Fault> {
        let (layout, missing) = match bytes {
            [] => {
                return Err(refused(
                    name,
                    "it is empty",
                    "name a file of MERL's, an OpenEXR image or an array of NumPy",
                ));
            }
            _ if bytes.starts_with(&openexr::MAGIC) => {
                let image = openexr::read(name, bytes, &|width, height| pairs::check_image(name, width, height));
                let image = image.map_err(|error: MapError| Fault::from(&error))?;
                let (pairs, missing) = Pairs::of_image(name, image.width, &image.texels)?;
                (Layout::Pairs(pairs), missing)
            }
            _ if bytes.starts_with(npy::MAGIC) => {
                let (shape, values) = npy::read(bytes).map_err(|error| refused(name, error.message, &error.help))?;
                let (pairs, missing) = Pairs::of_array(name, &shape, &values)?;
                (Layout::Pairs(pairs), missing)
            }
            _ => {
                let (merl, missing) = Merl::read(name, bytes)?;
                (Layout::Merl(merl), missing)
            }
        };
        let entries = match &layout {
            Layout::Merl(merl) => merl.entries(),
            Layout::Pairs(pairs) => pairs.entries(),
        };
        let coloured = entries.iter().any(|[r, g, b]| r != g || g != b);
        Ok(Self { name: name.to_owned(), missing, coloured, layout })
    }

    /// Whether turning view and light about the normal together changes nothing. It is then its own mirror image too: the
    /// mean of both is taken.
    pub fn is_isotropic(&self) -> bool {
        match &self.layout {
            Layout::Merl(_) => true,
            Layout::Pairs(pairs) => pairs.is_isotropic(),
        }
    }

    /// Returns the elevations and azimuths of the views that a table of an order needs.
    pub fn shape(&self, order: usize) -> [usize; 2] {
        match &self.layout {
            Layout::Merl(_) => [merl::STEPS.max(7 * order) + 1, 1],
            Layout::Pairs(pairs) => pairs.views(),
        }
    }

    /// Returns what is to be told of the file, in a sentence without its stop: its layout and what is missing.
    pub fn told(&self) -> String {
        let Self { name, missing, layout, .. } = self;
        let what = match layout {
            Layout::Merl(_) => "half and difference angles in MERL's layout, isotropic".to_owned(),
            Layout::Pairs(pairs) => pairs.told(),
        };
        let channels = if self.coloured { "R, G and B" } else { "grey" };
        let lack = match (missing.filled, missing.black) {
            (0, _) => "none is missing".to_owned(),
            (filled, 0) => format!("{filled} are missing and take the value of the nearest on their line"),
            (filled, black) => format!(
                "{filled} are missing and take the value of the nearest on their line, but for {black} whose line has none, \
                 which are black"
            ),
        };
        format!("`{name}` is a table of {what}, {channels}; of its {} entries above the horizon {lack}", missing.of)
    }

    /// Returns the reflectance per steradian, without the cosine, in R, G and B, for unit vectors with z ≥ 0.
    pub fn reflectance(&self, view: [f64; 3], light: [f64; 3]) -> [f64; 3] {
        match &self.layout {
            Layout::Merl(merl) => merl.at(view, light),
            Layout::Pairs(pairs) => pairs.at(view, light),
        }
    }
}

impl Tabulated {
    /// What is shown of three channels.
    pub fn shown(&self, channels: [f64; 3]) -> f64 {
        match self.channel {
            Some(channel) => channels[channel.min(2)],
            None => channels.iter().sum::<f64>() / 3.0,
        }
    }

    /// Returns the `order`² coefficients of the reflectance times the cosine as a function of the light, for a unit view
    /// with z ≥ 0.
    pub fn coefficients(&self, view: [f64; 3], order: usize) -> Vec<f64> {
        match &self.table.layout {
            Layout::Merl(merl) => merl.coefficients(view, order, |channels| self.shown(channels)),
            Layout::Pairs(pairs) => pairs.coefficients(view, order, |channels| self.shown(channels)),
        }
    }
}
