//! A spec's kernel: built, laid out, counted and measured, once for all languages.

use crate::families::spec::{Family, Form, Method, Spec};
use crate::families::{basis, lifted, loops, monomial, rotate, tilt, y_rotation, zhf};
use crate::ir::code::{Branch, Code};
use crate::ir::kernel::Kernel;
use crate::ir::listing::Listing;
use crate::promise::accuracy::{Accuracy, round_up};
use crate::promise::proofs;

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

/// The kernel of an unrolled spec, the unrolled twin of a loop, or the exact way of a branch.
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
        Family::Lifted => lifted::lifted(order),
        Family::EvalMonomial => monomial::eval(order),
        Family::ToMonomial => monomial::from_harmonics(order),
        Family::Tilt(methods) => tilt::tilt(order, methods, false),
        Family::TiltPrescaled(methods) => tilt::tilt(order, methods, true),
        Family::TiltScale => tilt::rescale(order, false),
        Family::TiltUnscale => tilt::rescale(order, true),
        Family::RotateSmall(methods) => y_rotation::small_rotate(order, methods),
        Family::RotateAdaptive(methods) => {
            let [_, _, exact] = y_rotation::adaptive(order, methods);
            exact
        }
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
            Method::Lifted => lifted::rotate(order),
            Method::Zxzxz => rotate::zxzxz(order),
            Method::Align => rotate::align(order),
            Method::Zonal => rotate::zonal(order),
            Method::Small(methods) => y_rotation::small_zyz(order, methods),
        },
    }
}

/// The operations of a spec in the form that it names.
pub fn code(spec: &Spec) -> Code {
    match (spec.form, &spec.family) {
        (Form::Loop, Family::Basis) => Code::Loop(loops::basis_loop(spec.order)),
        (Form::Loop, Family::SmallY(_)) => Code::Loop(loops::taylor15_loop(spec.order)),
        (Form::Loop, Family::Rotate(_)) => Code::Loop(loops::rotate_loop(spec.order)),
        (_, Family::RotateAdaptive(methods)) => {
            let [condition, below, above] =
                y_rotation::adaptive(spec.order, methods).map(|kernel| Listing::new(&kernel));
            Code::Branch(Box::new(Branch { condition, below, above }))
        }
        _ => Code::Straight(Listing::new(&kernel(spec))),
    }
}

impl Built {
    /// Builds, lays out and measures.
    pub fn new(spec: &Spec) -> Self {
        let code = code(spec);
        let accuracy = Accuracy::of(spec, &code);
        Self { spec: spec.clone(), code, accuracy }
    }

    /// What rounding may add up to an angle in radians; for a small rotation in f32 that is less than the head says, which
    /// is for the method's whole domain.
    pub fn rounding_within(&self, max_angle: f64) -> f64 {
        let whole = self.accuracy.rounding_f32;
        match self.spec.max_angle() {
            Some(limit) if !self.spec.half => {
                let within = proofs::bound_within(&self.spec, &self.code, Some(limit.min(max_angle)));
                within.map_or(whole, |bound| round_up(bound.value()))
            }
            _ => whole,
        }
    }

    /// The spec of the kernel itself, without what only its text depends on: the number of channels.
    pub fn base(spec: &Spec) -> Spec {
        Spec { rgb: false, ..spec.clone() }
    }
}
