//! The tables of a scene that a picture of it is made from: its reflectance, its object and its camera. Who draws is
//! another package; here is what may be asked of it.

// Names a family: these are the ways that a picture compares.
use crate::families::about_y::SMALL_ZYZ;
use crate::families::family::{MAX_ORDER, MIN_ORDER};
use crate::families::text::usual;
use crate::families::tilt::TILT;
use crate::families::zhf::ZHF_TAILORED;
use crate::families::{SmallAngle, Spec};
use crate::fault::hint;
use crate::reflectance::brdf::Brdf;
#[cfg(feature = "schema")]
use crate::reflectance::brdf::{EXPONENTS, ROUGHNESSES};
use crate::reflectance::measured::{self, Measured};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::located::{Located, Locator, Order, Placed};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// The most pixels of a picture along a side.
pub const MAX_SIZE: usize = 4096;

/// What a picture shows, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// `sphere`, `plane` or the file of a mesh, as the scene writes it.
    pub mesh: Located<String>,
    /// The file of a normal map; a smooth surface without one.
    pub normals: Option<Located<String>>,
    /// What the slopes of the normal map are multiplied with.
    pub strength: f64,
    /// The width and the height in pixels.
    pub size: [usize; 2],
    /// How coefficients get from a normal's frame to the surface's; without it, as the scene's first rotation of the
    /// kind `tilt` was planned, exactly if there is none.
    pub method: Option<Method>,
    /// The number of bands; the environment's without it.
    pub order: Option<Located<Order>>,
    /// Where it is taken from.
    pub camera: Camera,
    /// How many stops it is brighter than it would be by itself.
    pub exposure: f64,
}

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Degrees from +x towards +y.
    pub azimuth: f64,
    /// Degrees above the horizon, less than 90 away from it.
    pub elevation: f64,
    /// From the origin, above 1: meshes lie in the unit sphere.
    pub distance: f64,
    /// The vertical field of view in degrees, below 180.
    pub field: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { azimuth: 0.0, elevation: 15.0, distance: 4.0, field: 30.0 }
    }
}

/// How the coefficients of the reflectance are turned from the frame of the normal map's normal into that of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// `rotate`, by the quaternion of the shortest rotation.
    Exact,
    /// `tilt`, from the normal alone.
    Tilt,
    /// `tilt:n:lf5`, likewise, by five shears.
    Tilt5,
    /// `rotate:n:lf3`, from the phases of the shortest rotation and its angle.
    Lf3,
    /// `rotate:n:taylor15`, likewise.
    Taylor15,
    /// Not at all: the normal map only changes which reflectance is looked up ("simplified normal mapping").
    None,
    /// The light instead, exactly: read from cubemaps of its bands, then `zhf_tailored` (Nowrouzezahrai et al. 2012, equation
    /// 11). Orders 2 to 10.
    #[serde(rename = "zhf_tailored")]
    ZhfTailored,
    /// Likewise, by the weights of isotropic decomposition (Soler et al. 2015, equation 22, the middle line). Orders 3 to 12.
    #[serde(rename = "isd_tables")]
    IsdTables,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 8] = [
        Self::Exact,
        Self::Tilt,
        Self::Tilt5,
        Self::Lf3,
        Self::Taylor15,
        Self::None,
        Self::ZhfTailored,
        Self::IsdTables,
    ];
    /// Those that turn the reflectance from the frame of the normal map's normal to that of the surface.
    pub const TURNS: [Self; 6] = [Self::Exact, Self::Tilt, Self::Tilt5, Self::Lf3, Self::Taylor15, Self::None];

    /// Returns whether it reads the light's bands from tables.
    pub fn reads_tables(self) -> bool {
        matches!(self, Self::ZhfTailored | Self::IsdTables)
    }

    /// Returns the orders that it has.
    pub fn orders(self) -> RangeInclusive<usize> {
        match self {
            // Names a family: this one has lobes to some order.
            Self::ZhfTailored => ZHF_TAILORED.orders.clone(),
            // A texture a band, beside two others, of the sixteen that there are everywhere.
            Self::IsdTables => 3..=12,
            _ => MIN_ORDER..=MAX_ORDER,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Tilt => "tilt",
            Self::Tilt5 => "tilt5",
            Self::Lf3 => "lf3",
            Self::Taylor15 => "taylor15",
            Self::None => "none",
            Self::ZhfTailored => "zhf_tailored",
            Self::IsdTables => "isd_tables",
        }
    }

    /// The kernel of an order, if it is one.
    pub fn spec(self, order: usize) -> Option<Spec> {
        // Names a family: these are the ways that a picture compares.
        match self {
            Self::Exact => Some(usual("rotate", order, false)),
            Self::Tilt => Some(Spec::new(&TILT, order)),
            Self::Tilt5 => Some(Spec::new(&TILT, order).by(SmallAngle::Lf5)),
            Self::Lf3 => Some(Spec::new(&SMALL_ZYZ, order)),
            Self::Taylor15 => Some(Spec::new(&SMALL_ZYZ, order).by(SmallAngle::Taylor15)),
            Self::ZhfTailored => Some(Spec { rgb: true, ..Spec::new(&ZHF_TAILORED, order) }),
            Self::None | Self::IsdTables => None,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name);
        let found = Self::ALL.into_iter().find(|method| method.name() == text);
        found.ok_or_else(|| format!("`{text}` is no way to turn coefficients; {}", hint(text, &names)))
    }
}

#[derive(Clone, Copy, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// Equal in all directions.
    Lambert,
    /// A cosine lobe around the mirrored view.
    Phong,
    /// A Gaussian lobe of the slopes of the half vector.
    Ward,
    /// As a file has it.
    Measured,
}

/// What a surface reflects.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct BrdfTable {
    /// Which model.
    kind: Placed<Kind>,
    /// The exponent of the cosine, which `phong` needs.
    #[cfg_attr(feature = "schema", schemars(range(min = EXPONENTS[0], max = EXPONENTS[1])))]
    exponent: Option<Placed<f64>>,
    /// The roughness, which `ward` needs: one number, or one along the tangent and one across it.
    alpha: Option<Placed<Roughness>>,
    /// The file of a tabulated reflectance, relative to the scene, which `measured` needs: one of MERL's (.binary), or pairs of
    /// views and lights as OpenEXR (.exr) or as an array of NumPy (.npy).
    file: Option<Placed<String>>,
}

/// One number, or one along x and one along y.
#[derive(Clone, Copy, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged, expecting = "invalid type: expected a number or two, as in 0.2 or [0.2, 0.6]")]
enum Roughness {
    Same(#[cfg_attr(feature = "schema", schemars(range(min = ROUGHNESSES[0], max = ROUGHNESSES[1])))] f64),
    Both(#[cfg_attr(feature = "schema", schemars(inner(range(min = ROUGHNESSES[0], max = ROUGHNESSES[1]))))] [f64; 2]),
}

/// The least and the most azimuth in degrees.
const AZIMUTHS: [f64; 2] = [-360.0, 360.0];
/// The least and the most elevation in degrees.
const ELEVATIONS: [f64; 2] = [-89.0, 89.0];
/// The least and the most distance in radii of the object.
const DISTANCES: [f64; 2] = [1.2, 100.0];
/// The least and the most field of view in degrees.
const FIELDS: [f64; 2] = [1.0, 120.0];
/// What the slopes of a normal map may be multiplied with.
const STRENGTHS: [f64; 2] = [0.0, 10.0];
/// The least and the most exposure in stops.
const EXPOSURES: [f64; 2] = [-20.0, 20.0];

/// What a picture shows.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PictureTable {
    /// `sphere`, `plane` or the file of a mesh, .obj, relative to the scene.
    mesh: Placed<String>,
    /// The file of a normal map, relative to the scene; a smooth surface if it is left out.
    normals: Option<Placed<String>>,
    /// What the slopes of the normal map are multiplied with; 1 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = STRENGTHS[0], max = STRENGTHS[1])))]
    strength: Option<Placed<f64>>,
    /// The width and the height in pixels, up to 4096 each; 960 and 540 if it is left out.
    size: Option<Placed<[u64; 2]>>,
    /// How coefficients get from a normal's frame to the surface's; if it is left out, as the scene's first rotation of the
    /// kind `tilt` was planned, exactly if there is none.
    method: Option<Method>,
    /// The bands; as many as the environment's if it is left out.
    order: Option<Placed<Order>>,
    /// Where the camera stands, in degrees from +x towards +y; 0 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = AZIMUTHS[0], max = AZIMUTHS[1])))]
    azimuth: Option<Placed<f64>>,
    /// Where it stands, in degrees above the horizon; 15 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = ELEVATIONS[0], max = ELEVATIONS[1])))]
    elevation: Option<Placed<f64>>,
    /// How far it stands from the origin, in radii of the object; 4 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = DISTANCES[0], max = DISTANCES[1])))]
    distance: Option<Placed<f64>>,
    /// Its vertical field of view in degrees; 30 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = FIELDS[0], max = FIELDS[1])))]
    field: Option<Placed<f64>>,
    /// How many stops brighter the picture is than by itself; 0 if it is left out.
    #[cfg_attr(feature = "schema", schemars(range(min = EXPOSURES[0], max = EXPOSURES[1])))]
    exposure: Option<Placed<f64>>,
}

/// Reads a file that a scene names, of so many bytes at most.
type Reader<'a> = &'a dyn Fn(&Located<String>, usize) -> Result<Cow<'static, [u8]>, Diagnostic>;

pub(super) fn brdf(bytes: Reader<'_>, locate: &Locator, table: BrdfTable) -> Result<Brdf, Diagnostic> {
    let kind = locate.at(table.kind);
    let (exponent, alpha) = (table.exponent.map(|e| locate.at(e)), table.alpha.map(|a| locate.at(a)));
    let file = table.file.map(|file| locate.at(file));
    let missing = |key: &str, example: &str| {
        Diagnostic::at(&kind.place, format!("this kind needs its `{key}`"), format!("add `{key} = {example}`"))
    };
    let misplaced = |place, key: &str| Err(Diagnostic::at(place, format!("this kind has no `{key}`"), "leave it out"));
    let (brdf, place) = match (kind.value, exponent, alpha, file) {
        (Kind::Lambert | Kind::Ward | Kind::Measured, Some(exponent), ..) => {
            return misplaced(&exponent.place, "exponent");
        }
        (Kind::Lambert | Kind::Phong | Kind::Measured, _, Some(alpha), _) => return misplaced(&alpha.place, "alpha"),
        (Kind::Lambert | Kind::Phong | Kind::Ward, .., Some(file)) => return misplaced(&file.place, "file"),
        (Kind::Lambert, ..) => (Brdf::Lambert, kind.place),
        (Kind::Phong, None, ..) => return Err(missing("exponent", "20")),
        (Kind::Phong, Some(exponent), ..) => (Brdf::Phong { exponent: exponent.value }, exponent.place),
        (Kind::Ward, _, None, _) => return Err(missing("alpha", "[0.2, 0.6]")),
        (Kind::Ward, _, Some(alpha), _) => {
            let both = match alpha.value {
                Roughness::Same(alpha) => [alpha; 2],
                Roughness::Both(both) => both,
            };
            (Brdf::Ward { alpha: both }, alpha.place)
        }
        (Kind::Measured, .., None) => return Err(missing("file", "\"gold.binary\"")),
        (Kind::Measured, .., Some(file)) => {
            let bytes = bytes(&file, measured::MAX_BYTES)?;
            let read = Measured::from_bytes(&file.value, &bytes).map_err(|error| Diagnostic::of(&file.place, error))?;
            (read.into(), file.place)
        }
    };
    brdf.checked().map_err(|error| Diagnostic::of(&place, error))
}

pub(super) fn picture(locate: &Locator, table: PictureTable) -> Result<Picture, Diagnostic> {
    let number = |value: Option<Placed<f64>>, what: &str, [least, most]: [f64; 2], default: f64| {
        let Some(value) = value else { return Ok(default) };
        let value = locate.at(value);
        match (least..=most).contains(&value.value) {
            true => Ok(value.value),
            false => Err(Diagnostic::at(
                &value.place,
                format!("{what} of {} is out of range", value.value),
                format!("write a number from {least} to {most}"),
            )),
        }
    };
    let default = Camera::default();
    let camera = Camera {
        azimuth: number(table.azimuth, "an azimuth in degrees", AZIMUTHS, default.azimuth)?,
        elevation: number(table.elevation, "an elevation in degrees", ELEVATIONS, default.elevation)?,
        distance: number(table.distance, "a distance in radii of the object", DISTANCES, default.distance)?,
        field: number(table.field, "a field of view in degrees", FIELDS, default.field)?,
    };
    let size = match table.size.map(|size| locate.at(size)) {
        None => [960, 540],
        Some(Located { value, place }) => {
            let sides = value.map(|side| usize::try_from(side).unwrap_or(usize::MAX));
            if sides.iter().any(|side| !(1..=MAX_SIZE).contains(side)) {
                let message = format!("a picture of {} by {} pixels is out of range", value[0], value[1]);
                return Err(Diagnostic::at(&place, message, format!("write sides from 1 to {MAX_SIZE} pixels")));
            }
            sides
        }
    };
    Ok(Picture {
        mesh: locate.at(table.mesh),
        normals: table.normals.map(|normals| locate.at(normals)),
        strength: number(table.strength, "a strength", STRENGTHS, 1.0)?,
        size,
        method: table.method,
        order: table.order.map(|order| locate.at(order)),
        camera,
        exposure: number(table.exposure, "an exposure in stops", EXPOSURES, 0.0)?,
    })
}
