//! A spec's kernel: built, laid out, counted and measured, once for all languages.

use crate::accuracy::{self, Accuracy};
use crate::eval::{Contraction, Number, Program};
use crate::graph::Kind;
use crate::kernel::{Kernel, Param, Shape};
use crate::kernels::{basis, rotate, tilt, y_rotation, zhf};
use crate::listing::{Cost, Footprint, Listing};
use crate::spec::{Family, Method, Spec};

/// A kernel that is ready to print.
#[derive(Clone, Debug)]
pub struct Built {
    /// What was asked for.
    pub spec: Spec,
    /// Its operations.
    pub code: Code,
    /// How exact it is.
    pub accuracy: Accuracy,
}

/// The operations of a kernel.
#[derive(Clone, Debug)]
pub enum Code {
    /// Straight lines.
    Straight(Listing),
}

/// The kernel of an unrolled spec, or the unrolled twin of a loop.
pub fn kernel(spec: &Spec) -> Kernel {
    let order = spec.order;
    match &spec.family {
        Family::Basis => basis::basis(order, &spec.bands),
        Family::Eval => basis::eval(order, &spec.bands),
        Family::RotateZ => rotate::rotate_z(order),
        Family::RotateY => rotate::rotate_y(order),
        Family::SwapYz => rotate::swap_yz(order),
        Family::RotateXPlus90 => rotate::rotate_x_90(order, 1),
        Family::RotateXMinus90 => rotate::rotate_x_90(order, -1),
        Family::Angles => rotate::angles(order),
        Family::Tilt => tilt::tilt(order),
        Family::SmallY(methods) => y_rotation::about_y(order, methods),
        Family::Zhf => zhf::rotate(order),
        Family::ZhfWeights => zhf::weights_of(order),
        Family::ZhfTailored => zhf::tailored(order),
        Family::Rotate(method) => match method {
            Method::Zyz => rotate::zyz(order),
            Method::Tensor => rotate::tensor(order),
            Method::Matrix => rotate::from_matrix(order),
            Method::Euler => rotate::euler_angles(order),
            Method::Angles => rotate::zyz_from_angles(order),
            Method::Zxzxz => rotate::zxzxz(order),
            Method::Align => rotate::align(order),
            Method::Zonal => rotate::zonal(order),
            Method::Small(methods) => y_rotation::small_zyz(order, methods),
        },
    }
}

impl Built {
    /// Builds, lays out and measures.
    pub fn new(spec: &Spec) -> Self {
        let listing = Listing::new(&kernel(spec));
        let accuracy = Accuracy::of(spec, &listing);
        Self {
            spec: spec.clone(),
            code: Code::Straight(listing),
            accuracy,
        }
    }

    /// What it costs for so many channels.
    pub fn cost_of(&self, channels: usize) -> Cost {
        match &self.code {
            Code::Straight(listing) => listing.cost(channels),
        }
    }

    /// What it needs besides operations.
    pub fn footprint(&self) -> Footprint {
        match &self.code {
            Code::Straight(listing) => listing.footprint(),
        }
    }

    /// Its parameters, in order.
    pub fn params(&self) -> &[Param] {
        match &self.code {
            Code::Straight(listing) => &listing.params,
        }
    }

    /// The shape and the kind of its result.
    pub fn result(&self) -> (Shape, Kind) {
        match &self.code {
            Code::Straight(listing) => (listing.result, listing.result_kind),
        }
    }

    /// What its result holds.
    pub fn result_doc(&self) -> &str {
        match &self.code {
            Code::Straight(listing) => &listing.result_doc,
        }
    }

    /// Runs it for one channel; see [`Program::run`].
    ///
    /// # Panics
    ///
    /// If an input is shorter than its parameter's shape.
    pub fn run<T: Number>(&self, inputs: &[&[T]], contraction: Contraction) -> Vec<T> {
        match &self.code {
            Code::Straight(listing) => Program::new(listing).run(inputs, contraction),
        }
    }

    /// Its largest rounding error in `T` over seeded inputs; see [`accuracy::rounding`].
    pub fn rounding<T: Number>(&self, seed: u64, count: usize, contraction: Contraction) -> f64 {
        match &self.code {
            Code::Straight(listing) => accuracy::rounding::<T>(&self.spec, listing, seed, count, contraction),
        }
    }

    /// The spec of the kernel itself, without what only its text depends on: the number of channels.
    pub fn base(spec: &Spec) -> Spec {
        Spec {
            rgb: false,
            ..spec.clone()
        }
    }
}
