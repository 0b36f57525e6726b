//! What stands above a function: what it computes, over which inputs, at what cost and within which error, in plain
//! ASCII so that every compiler reads it.

use crate::families::spec::{Family, Method, Spec};
use crate::families::y_rotation::Small;
use crate::ir::code::Code;
use crate::ir::kernel::Param;
use crate::promise::accuracy::{Accuracy, MARGIN};
use crate::promise::built::Built;

const WIDTH: usize = 100;

/// The convention that every kernel keeps, one sentence a line.
pub const CONVENTION: [&str; 2] = [
    "Convention: real orthonormal harmonics with the Condon-Shortley phase (band 1 is -y, z, -x), index l(l+1)+m,",
    "order n = bands 0 to n-1 = n^2 coefficients; a rotation R takes c to D(R) c, with y(R w) = D(R) y(w).",
];

/// Replaces what is not ASCII.
pub fn ascii(text: &str) -> String {
    const NAMES: [(char, &str); 24] = [
        ('α', "alpha"),
        ('β', "beta"),
        ('γ', "gamma"),
        ('φ', "phi"),
        ('ω', "w"),
        ('π', "pi"),
        ('ν', "nu"),
        ('Â', "A^"),
        ('ᵀ', "^T"),
        ('Σ', "sum"),
        ('√', "sqrt"),
        ('²', "^2"),
        ('³', "^3"),
        ('⁻', "^-"),
        ('¹', "1"),
        ('−', "-"),
        ('·', "*"),
        ('×', "x"),
        ('≤', "<="),
        ('≥', ">="),
        ('…', "..."),
        ('°', " deg"),
        ('ř', "r"),
        ('á', "a"),
    ];
    text.chars()
        .map(|c| match NAMES.iter().find(|(from, _)| *from == c) {
            Some((_, to)) => (*to).to_owned(),
            None if c.is_ascii() => c.to_string(),
            None => "?".to_owned(),
        })
        .collect()
}

/// Breaks a sentence into lines; those after the first are indented by `indent`.
pub fn wrap(text: &str, indent: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("starts with one");
        if !line.is_empty() && line.len() + 1 + word.len() > WIDTH {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

/// What a kernel does, in a sentence, and where it comes from.
pub fn summary(spec: &Spec) -> String {
    let bands: Vec<String> = spec.bands.iter().map(usize::to_string).collect();
    let which = match spec.is_whole() {
        true => format!("of order {}", spec.order),
        false => format!("of the bands {}", bands.join(", ")),
    };
    let order = spec.order;
    match &spec.family {
        Family::Basis => format!(
            "The spherical harmonics {which} at a direction, accurate also near the poles (Sloan 2013's recurrence, rearranged)."
        ),
        Family::Eval => format!("The sum of c_i y_i(dir) over the harmonics {which}, without storing the basis."),
        Family::RotateZ => format!("Rotates order {order} about z by the angle of (cos, sin)."),
        Family::RotateY => {
            format!("Rotates order {order} about y by the angle of (cos, sin), exactly and at every angle.")
        }
        Family::SwapYz => format!("Exchanges y and z of order {order}: the sparse symmetric matrix J, a reflection."),
        Family::RotateXPlus90 => format!("Rotates order {order} about x by +90 degrees, a sparse matrix."),
        Family::RotateXMinus90 => format!("Rotates order {order} about x by -90 degrees, a sparse matrix."),
        Family::Angles => format!(
            "The multiples of the three angles of a rotation that `rotate:{order}:angles` takes; done once for many signals."
        ),
        Family::Lifted => format!(
            "The multiples of the two z angles of a rotation and the shears of its y rotation that `rotate:{order}:lifted` takes; done once for many signals."
        ),
        Family::Tilt(methods) => match order {
            2 | 3 => {
                format!("Tilts order {order}: the shortest rotation from z to a normal, exactly, with no trigonometry.")
            }
            _ => format!(
                "Tilts order {order}: the shortest rotation from z to a normal, with no trigonometry; bands 1 and 2 exactly, the others by shears that are regular at n = z ({}). The inverse is the same with (-n.x, -n.y, n.z).",
                small_list(&methods[2..])
            ),
        },
        Family::TiltPrescaled(methods) => format!(
            "Tilts order {order} as `tilt` does ({}), on coefficients that `tilt_scale:{order}` has divided: the couplings of neighbours are in the stored data. What it is multiplied with, such as a light, is scaled the other way, by `tilt_unscale:{order}`.",
            small_list(methods.get(2..).unwrap_or_default())
        ),
        Family::TiltScale => {
            format!(
                "Divides the coefficients of order {order} as `tilt_prescaled:{order}` takes them; done once, when they are stored."
            )
        }
        Family::TiltUnscale => format!(
            "The inverse of `tilt_scale:{order}`: for tilted coefficients, or for a light that they are multiplied with."
        ),
        Family::RotateSmall(methods) => format!(
            "Rotates order {order} by z, y, z from a quaternion whose y angle is small, approximately ({}).",
            small_source(methods)
        ),
        Family::RotateAdaptive(methods) => format!(
            "Rotates order {order} from a quaternion: approximately where the y angle is below a limit ({}), exactly above it.",
            small_source(methods)
        ),
        Family::EvalMonomial => format!(
            "The sum of c_i y_i(dir) over the harmonics {which}, from the coefficients that `to_monomial:{order}` makes."
        ),
        Family::ToMonomial => format!(
            "From the coefficients of the harmonics {which} to those of the monomials that `eval_monomial:{order}` takes; done once, when they are stored."
        ),
        Family::SmallY(methods) => {
            format!("Rotates order {order} about y by a small angle, approximately ({}).", small_source(methods))
        }
        Family::Zhf => format!(
            "Rotates order {order} by sparse zonal factorisation over {} shared lobes (Nowrouzezahrai et al. 2012, the standard rotation).",
            2 * order - 1
        ),
        Family::ZhfWeights => format!(
            "The weights of the zonal lobes of order {order}, the sparse product A^^T c (Nowrouzezahrai et al. 2012)."
        ),
        Family::ZhfTailored => format!(
            "Rotates order {order} from samples at the lobes, the sparse product A^ f (Nowrouzezahrai et al. 2012, the signal-tailored rotation)."
        ),
        Family::Rotate(method) => match method {
            Method::Zyz => format!(
                "Rotates order {order} exactly, by z, y, z from a quaternion: no trigonometry, no branch, every angle."
            ),
            Method::Tensor => format!(
                "Rotates order {order} exactly, as vector and tensor from a quaternion: products and sums only."
            ),
            Method::Matrix => format!(
                "Rotates order {order} exactly, as vector and tensor from a 3x3 matrix: products and sums only."
            ),
            Method::Euler => format!("Rotates order {order} exactly, by z, y, z from three (cos, sin) pairs."),
            Method::Angles => {
                format!("Rotates order {order} exactly, by z, y, z from the multiples that `angles:{order}` makes.")
            }
            Method::Lifted => format!(
                "Rotates order {order} exactly, by z, y, z with the y rotation as shears, from what `lifted:{order}` makes; the y angle is bounded."
            ),
            Method::Zxzxz => format!(
                "Rotates order {order} exactly, by z, x, z, x, z with sparse x rotations (Krivanek et al. 2005): the baseline."
            ),
            Method::Align => {
                format!("Rotates order {order} exactly so that z goes to a normal, the spin about it left open.")
            }
            Method::Zonal => {
                format!("Rotates a zonal signal of order {order} exactly so that its axis goes from z to a direction.")
            }
            Method::Small(methods) => format!(
                "Rotates order {order} by z, y, z with a small y angle, approximately ({}).",
                small_source(methods)
            ),
        },
    }
}

/// The methods of the bands, repetitions left out.
fn small_list(methods: &[Small]) -> String {
    let mut names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
    names.dedup();
    names.join(", ")
}

fn small_source(methods: &[Small]) -> String {
    let names = small_list(methods);
    format!(
        "bands from 1: {names}; Taylor forms after Krivanek et al. 2005, lf3 and lf5 by three and five parity shears"
    )
}

fn parameter(param: &Param) -> String {
    format!("{}: {}.", param.name, param.doc)
}

/// What a kernel costs, in a sentence.
pub fn cost(built: &Built, channels: usize) -> String {
    let cost = built.code.cost(channels);
    let special = match cost.special {
        0 => String::new(),
        1 => " and 1 inverse square root or reciprocal".to_owned(),
        n => format!(" and {n} inverse square roots or reciprocals"),
    };
    let footprint = built.code.footprint();
    let below = match &built.code {
        Code::Branch(branch) => format!(" above the limit, {} below it", branch.costs(channels)[0].total),
        _ => String::new(),
    };
    format!(
        "Operations: {} ({} mul, {} add, {} fma){special}{below}; {} constants, {} live values.",
        cost.total, cost.mul, cost.add, cost.fma, footprint.constants, footprint.live
    )
}

/// How exact a kernel is and where, in sentences.
pub fn error(spec: &Spec, accuracy: &Accuracy) -> String {
    let small = spec.max_degrees().map(|most| format!("for an angle up to {most} degrees")).unwrap_or_default();
    let domain = match &spec.family {
        Family::RotateAdaptive(_) => "for every unit q, with a limit up to 25 degrees",
        Family::Lifted | Family::Rotate(Method::Lifted) => &format!("{small} about y"),
        _ if spec.max_angle().is_some() => &small,
        Family::Basis | Family::Eval | Family::EvalMonomial => "for dir of unit length",
        Family::Tilt(_) | Family::TiltPrescaled(_) => "for every n of unit length with n.z >= 0",
        Family::Rotate(Method::Zyz | Method::Zxzxz | Method::Tensor) | Family::Angles => "for every unit q",
        Family::Rotate(Method::Align) => "for every n of unit length",
        Family::Rotate(Method::Zonal) => "for dir of unit length",
        Family::Rotate(Method::Matrix) | Family::Zhf => "for every rotation matrix",
        Family::RotateZ | Family::RotateY | Family::Rotate(Method::Euler | Method::Angles) => "for every angle",
        _ => "for every input",
    };
    let (measured, samples) = (accuracy.measured_f32, accuracy.samples);
    let why = match accuracy.proven {
        true => {
            format!("proven for IEEE arithmetic, contracted or not; the worst of {samples} measured is {measured:e}")
        }
        false => format!("{MARGIN} times the worst of {samples} measured, {measured:e}; not proven"),
    };
    let mut text = format!(
        "Error: {} rounding at most {:e} of {}, {domain} ({why}).",
        if spec.half { "f16" } else { "f32" },
        accuracy.rounding_f32,
        accuracy.relative_to
    );
    if !accuracy.method.is_empty() {
        let at: Vec<String> =
            accuracy.method.iter().map(|(degrees, error)| format!("{error:e} at {degrees}")).collect();
        text += &format!(
            " Method error, the worst band's in spectral norm: {} degrees; it grows without bound beyond.",
            at.join(", ")
        );
    }
    if spec.half {
        text += " Numbers beyond 65504 are infinite in f16, and those below 6e-5 lose digits.";
    }
    if spec.is_approximate() && accuracy.method.is_empty() {
        text += " Method error: about (l beta)^2 / 4 in band l while l beta is below 1.";
    }
    text
}

/// All that stands above a function.
pub fn function(built: &Built, spec: &Spec) -> Vec<String> {
    let mut lines = wrap(&format!("`{spec}`: {}", summary(spec)), 0);
    for param in built.code.params() {
        lines.extend(wrap(&parameter(param), 4));
    }
    lines.extend(wrap(&format!("Returns {}.", built.code.result_doc()), 4));
    lines.extend(wrap(&cost(built, spec.channels()), 4));
    lines.extend(wrap(&error(spec, &built.accuracy), 4));
    lines.into_iter().map(|line| ascii(&line)).collect()
}
