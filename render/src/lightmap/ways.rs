//! The ways to store irradiance for normals that a normal map leans, each by its kernels.

use zonal_bake::basis::Basis;
use zonal_codegen::environment::cosine_lobe;
use zonal_codegen::families::Spec;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::index::index;
use zonal_picture::vector::unit;

/// A way.
pub struct Way {
    /// What it is called.
    pub name: &'static str,
    /// How many coefficients a point has, each in R, G and B.
    pub coefficients: usize,
    /// The kernel that is run for a pixel.
    pub spec: &'static str,
    /// How many operations it takes in R, G and B, with what follows it.
    pub operations: usize,
    /// The kernel that takes coefficients that were made ready for it, with its operations, if there is one.
    pub prepared: Option<(&'static str, usize)>,
    /// How many roots and reciprocals.
    pub special: usize,
    /// Whether a normal may be a mean that is shorter than one.
    pub takes_means: bool,
    kernel: Program<f64>,
    made: Made,
}

/// How a way gets from radiance to a value.
enum Made {
    /// By coefficients of a basis; the normal map may be left out.
    Basis { basis: Box<Basis>, is_flat: bool },
    /// By the cosine's lobe, which is turned to the normal.
    Lobe(Vec<f64>),
}

/// What a table calls the ways, with the basis that they store, the kernel that they run and the one for coefficients that were
/// made ready: without the normal map, and in three bases over the hemisphere.
const WAYS: [(&str, &str, &str, &str); 4] = [
    ("flat", "h4", "h4_eval", ""),
    ("hl2", "hl2", "hl2_eval", "hl2_eval_vector"),
    ("h4", "h4", "h4_eval:shared", "h4_eval_monomial"),
    ("h6", "h6", "h6_eval:shared", "h6_eval_monomial:shared"),
];

/// The order of the transferred radiance.
const ORDER: usize = 3;

impl Way {
    /// All ways, from the coarsest to the finest.
    ///
    /// # Errors
    ///
    /// If a kernel is not known.
    pub fn all() -> Result<Vec<Self>, Fault> {
        let program = |spec: &'static str| -> Result<(Program<f64>, Spec), Fault> {
            let spec: Spec = spec.parse().map_err(|error| Fault::new(format!("{error}"), ""))?;
            Ok((Program::new(&Listing::new(&spec.kernel())), spec))
        };
        let mut ways = Vec::new();
        for (name, basis, spec, ready) in WAYS {
            let prepared = if ready.is_empty() { None } else { Some((ready, program(ready)?.1.code().cost(3).total)) };
            let (kernel, known) = program(spec)?;
            let basis: Basis = basis.parse()?;
            let (cost, is_flat) = (known.code().cost(3), name == "flat");
            // Without the normal map one colour is stored.
            let (coefficients, operations) = if is_flat { (1, 0) } else { (basis.coefficients, cost.total) };
            let (special, takes_means) = (cost.special, !is_flat);
            let made = Made::Basis { basis: Box::new(basis), is_flat };
            ways.push(Self { name, coefficients, spec, operations, prepared, special, takes_means, kernel, made });
        }
        let (kernel, known) = program("tilt:3")?;
        let cost = known.code().cost(1);
        let mut lobe = vec![0.0; ORDER * ORDER];
        (0..ORDER).for_each(|l| {
            lobe[index(l, 0)] = cosine_lobe(l) * ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
        });
        ways.push(Self {
            name: "sh3",
            coefficients: ORDER * ORDER,
            spec: "tilt:3",
            // The lobe is turned once for all channels, and multiplied with each.
            operations: cost.total + 3 * ORDER * ORDER,
            prepared: None,
            special: cost.special,
            takes_means: false,
            kernel,
            made: Made::Lobe(lobe),
        });
        Ok(ways)
    }

    /// Returns the irradiance at a normal of the frame, which may be shorter than one, of radiance in five bands. `is_unit`
    /// brings the normal to length one where the way would take it as it is.
    pub fn irradiance(&self, radiance: &[[f64; 3]], normal: [f64; 3], is_unit: bool) -> [f64; 3] {
        let up = [0.0, 0.0, 1.0];
        let long = unit(normal).unwrap_or(up);
        match &self.made {
            Made::Basis { basis, is_flat } => {
                let at = match (is_flat, is_unit) {
                    (true, _) => up,
                    (false, true) => long,
                    (false, false) => normal,
                };
                let c = basis.coefficients(&radiance[..basis.order * basis.order]);
                let channel = |k: usize| {
                    let one: Vec<f64> = c.iter().map(|c| c[k]).collect();
                    self.kernel.run(&[&at, &one], Contraction::Separate)[0].max(0.0)
                };
                [0, 1, 2].map(channel)
            }
            Made::Lobe(lobe) => {
                let turned = self.kernel.run(&[&long, lobe], Contraction::Separate);
                [0, 1, 2].map(|k| turned.iter().zip(radiance).map(|(y, c)| y * c[k]).sum::<f64>().max(0.0))
            }
        }
    }
}
