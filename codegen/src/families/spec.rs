//! What to generate: a family, an order and a few options, written as `rotate:5:zxzxz:rgb`. A spec names exactly one
//! function in each language.

use crate::families::y_rotation::Small;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The smallest order of a kernel.
pub const MIN_ORDER: usize = 2;
/// The largest order of an unrolled kernel: beyond it, text grows past what shader compilers take.
pub const MAX_ORDER: usize = 16;
/// The largest order of a kernel in f16.
pub const MAX_HALF_ORDER: usize = 10;
/// The largest order of a kernel in loop form.
pub const MAX_LOOP_ORDER: usize = 64;

/// The largest angle in degrees that an approximate rotation is meant for: the "up to 25 degrees" of
/// Křivánek et al. 2005, section 3.2.
pub const SMALL_ANGLE_DEGREES: f64 = 25.0;

/// The largest (n − 1) β in degrees that a lifted rotation takes: there the tangents of its shears reach √3, and f32 errs
/// by some one and a half times what the rotation by planes does; beyond, the error grows with them, to infinity at 180
/// degrees.
pub const LIFTED_DEGREES: f64 = 120.0;

/// How a rotation is done.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Method {
    /// z, y, z from a unit quaternion, every angle.
    Zyz,
    /// Vector and tensor from a unit quaternion, orders 2 and 3.
    Tensor,
    /// Vector and tensor from a 3×3 matrix, orders 2 and 3.
    Matrix,
    /// z, y, z from three (cos, sin) pairs.
    Euler,
    /// z, y, z from all multiples of the three angles, as the family `angles` makes them.
    Angles,
    /// z, y, z with the y rotation by shears, as the family `lifted` makes them.
    Lifted,
    /// z, x, z, x, z with sparse x rotations: the papers' baseline.
    Zxzxz,
    /// The z axis to a normal, spin irrelevant.
    Align,
    /// A zonal signal's axis to a direction.
    Zonal,
    /// z, y, z with a small y angle, a method for each band from 1.
    Small(Vec<Small>),
}

/// What a kernel does.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// All values at a direction.
    Basis,
    /// Σ c_i y_i at a direction.
    Eval,
    /// The same from the coefficients of monomials.
    EvalMonomial,
    /// From coefficients of harmonics to coefficients of monomials.
    ToMonomial,
    /// About z by (cos, sin).
    RotateZ,
    /// About y by (cos, sin), exactly.
    RotateY,
    /// The exchange of y and z.
    SwapYz,
    /// About x by +90 degrees.
    RotateXPlus90,
    /// About x by −90 degrees.
    RotateXMinus90,
    /// A rotation.
    Rotate(Method),
    /// The multiples of the three angles of a quaternion.
    Angles,
    /// The multiples of the two z angles of a quaternion and the shears of its y rotation.
    Lifted,
    /// About y by a small angle, a method for each band from 1.
    SmallY(Vec<Small>),
    /// z to a normal, a method for each band from 1: bands 1 and 2 exactly, the others by shears.
    Tilt(Vec<Small>),
    /// The same on coefficients that `tilt_scale` has divided, one multiplication a coupling cheaper.
    TiltPrescaled(Vec<Small>),
    /// From coefficients to those that `tilt_prescaled` takes.
    TiltScale,
    /// Back again.
    TiltUnscale,
    /// From a unit quaternion whose y angle is small, a method for each band from 1.
    RotateSmall(Vec<Small>),
    /// The same below a limiting angle, exactly above it: one branch.
    RotateAdaptive(Vec<Small>),
    /// Rotation by a sparse zonal factorisation over 2n − 1 shared lobes.
    Zhf,
    /// The lobe weights Âᵀ c.
    ZhfWeights,
    /// Coefficients from samples at the rotated lobes: Â f.
    ZhfTailored,
}

/// Unrolled or a loop over tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Form {
    /// Straight lines, every index a constant.
    Unrolled,
    /// Tables and a loop.
    Loop,
}

/// What to generate.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Spec {
    /// The order n: bands 0 to n − 1, n² coefficients.
    pub order: usize,
    /// What it does.
    pub family: Family,
    /// The bands that exist; the others are zero and not stored. All of them for every family but `basis` and `eval`.
    pub bands: Vec<usize>,
    /// Whether the signal has three channels that share the parameters.
    pub rgb: bool,
    /// Unrolled or a loop.
    pub form: Form,
    /// Whether it works in f16 instead of f32: WGSL only, with `enable f16`.
    pub half: bool,
}

/// Why a text is no spec.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}; {help}")]
pub struct SpecError {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Which bytes of the spec are meant.
    pub at: Range<usize>,
}

/// The families that take no method, with their names.
const PLAIN: [(Family, &str); 17] = [
    (Family::Basis, "basis"),
    (Family::Eval, "eval"),
    (Family::EvalMonomial, "eval_monomial"),
    (Family::ToMonomial, "to_monomial"),
    (Family::RotateZ, "rotate_z"),
    (Family::RotateY, "rotate_y"),
    (Family::SwapYz, "swap_yz"),
    (Family::RotateXPlus90, "rotate_x_plus_90"),
    (Family::RotateXMinus90, "rotate_x_minus_90"),
    (Family::Angles, "angles"),
    (Family::Lifted, "lifted"),
    (Family::TiltScale, "tilt_scale"),
    (Family::TiltUnscale, "tilt_unscale"),
    (Family::Zhf, "zhf"),
    (Family::ZhfWeights, "zhf_weights"),
    (Family::ZhfTailored, "zhf_tailored"),
    // `rotate` alone: the method is the cheapest exact one.
    (Family::Rotate(Method::Zyz), "rotate"),
];

/// Makes a family of a list of methods.
type Listed = fn(Vec<Small>) -> Family;

/// The families that take a method for each band, exact bands among them, with their names; `lf3` from band 3 on if
/// none is named.
const LISTED: [(Listed, &str); 4] = [
    (Family::Tilt, "tilt"),
    (Family::TiltPrescaled, "tilt_prescaled"),
    (Family::RotateSmall, "rotate_small"),
    (Family::RotateAdaptive, "rotate_adaptive"),
];

/// The methods of `rotate` but for the small-angle ones, with their names.
const METHODS: [(Method, &str); 9] = [
    (Method::Zyz, "zyz"),
    (Method::Tensor, "tensor"),
    (Method::Matrix, "matrix"),
    (Method::Euler, "euler"),
    (Method::Angles, "angles"),
    (Method::Lifted, "lifted"),
    (Method::Zxzxz, "zxzxz"),
    (Method::Align, "align"),
    (Method::Zonal, "zonal"),
];

/// Every family name that a spec may start with.
pub fn family_names() -> Vec<&'static str> {
    let mut names: Vec<&str> = PLAIN.iter().map(|(_, name)| *name).collect();
    names.extend(LISTED.iter().map(|(_, name)| *name));
    names.extend(Small::ALL.iter().map(|(_, name)| *name));
    names.push("mix");
    names
}

/// Every method name that `rotate` takes.
pub fn method_names() -> Vec<&'static str> {
    let mut names: Vec<&str> = METHODS.iter().map(|(_, name)| *name).collect();
    names.extend(Small::ALL.iter().map(|(_, name)| *name));
    names
}

fn small(name: &str) -> Option<Small> {
    Small::ALL.iter().find(|(_, known)| *known == name).map(|(small, _)| *small)
}

/// The same method for all bands once, or one a band joined by `+`.
fn small_list(methods: &[Small]) -> String {
    match methods.iter().all(|method| *method == methods[0]) {
        true => methods[0].name().to_owned(),
        false => methods.iter().map(|method| method.name()).collect::<Vec<_>>().join("+"),
    }
}

/// A list of [`LISTED`]: nothing if it is what the family takes by itself, one name if it stands from band 3 on.
fn listed(methods: &[Small]) -> Option<String> {
    let order = methods.len() + 1;
    let usual = methods.last().filter(|last| *methods == last.from_band_3(order));
    match usual {
        Some(Small::Lf3) => None,
        Some(Small::Exact) if order <= 3 => None,
        Some(last) => Some(last.name().to_owned()),
        None => Some(methods.iter().map(|method| method.name()).collect::<Vec<_>>().join("+")),
    }
}

fn suggest<'a>(got: &str, known: &[&'a str]) -> Option<&'a str> {
    let distance = |a: &str, b: &str| -> usize {
        let b: Vec<char> = b.chars().collect();
        let mut row: Vec<usize> = (0..=b.len()).collect();
        for (i, x) in a.chars().enumerate() {
            let mut before = row[0];
            row[0] = i + 1;
            for (j, y) in b.iter().enumerate() {
                let change = before + usize::from(x != *y);
                before = row[j + 1];
                row[j + 1] = change.min(row[j] + 1).min(before + 1);
            }
        }
        row[b.len()]
    };
    let best = known.iter().min_by_key(|name| distance(got, name))?;
    let longer = known.iter().find(|name| got.len() >= 3 && name.contains(got));
    match distance(got, best) {
        0 | 1 => Some(*best),
        2 | 3 => Some(*longer.unwrap_or(best)),
        _ => longer.copied(),
    }
}

/// "did you mean …", or the list of what is known.
pub(crate) fn hint(got: &str, known: &[&str]) -> String {
    match suggest(got, known) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("known are {}", known.join(", ")),
    }
}

impl Family {
    /// A method for each band from 1, where exact bands may be among them; none for the other families.
    pub fn methods(&self) -> Option<&[Small]> {
        match self {
            Self::Tilt(methods)
            | Self::TiltPrescaled(methods)
            | Self::RotateSmall(methods)
            | Self::RotateAdaptive(methods) => Some(methods),
            _ => None,
        }
    }
}

impl Spec {
    /// A spec of all bands, one channel, unrolled.
    pub fn new(family: Family, order: usize) -> Self {
        Self { order, family, bands: (0..order).collect(), rgb: false, form: Form::Unrolled, half: false }
    }

    /// The same for three channels.
    #[must_use]
    pub fn rgb(mut self) -> Self {
        self.rgb = true;
        self
    }

    /// The method that `rotate` means at this order: the cheapest exact one from a quaternion.
    pub fn default_method(order: usize, rgb: bool) -> Method {
        match (order, rgb) {
            (2, _) | (3, false) => Method::Tensor,
            _ => Method::Zyz,
        }
    }

    /// How many channels the signal has.
    pub fn channels(&self) -> usize {
        if self.rgb { 3 } else { 1 }
    }

    /// Whether the kernel works in f16: not where a quaternion's or a normal's angles are kept defined by a number that f16
    /// does not hold, where lobes are inverted, and in loops.
    pub fn takes_half(&self) -> bool {
        let family = match &self.family {
            Family::Rotate(method) => !matches!(method, Method::Zyz | Method::Zxzxz | Method::Align),
            Family::Angles | Family::Lifted | Family::RotateSmall(_) | Family::RotateAdaptive(_) => false,
            Family::Zhf | Family::ZhfWeights | Family::ZhfTailored => false,
            _ => true,
        };
        family && self.form == Form::Unrolled && self.order <= MAX_HALF_ORDER
    }

    /// Whether all bands exist.
    pub fn is_whole(&self) -> bool {
        self.bands.len() == self.order
    }

    /// Whether it is a rotation that errs by more than rounding.
    pub fn is_approximate(&self) -> bool {
        match &self.family {
            Family::SmallY(_) | Family::Rotate(Method::Small(_)) => true,
            family => family.methods().is_some_and(|methods| methods.iter().any(|method| *method != Small::Exact)),
        }
    }

    /// The largest y angle in radians that the method is meant for, if it does not take every angle.
    pub fn max_angle(&self) -> Option<f64> {
        match self.family {
            Family::Lifted | Family::Rotate(Method::Lifted) => {
                Some((LIFTED_DEGREES / (self.order - 1) as f64).to_radians())
            }
            _ => self.is_approximate().then(|| SMALL_ANGLE_DEGREES.to_radians()),
        }
    }

    /// The same in degrees, cut off after two decimals.
    pub fn max_degrees(&self) -> Option<f64> {
        self.max_angle().map(|most| (most.to_degrees() * 100.0 + 1e-6).floor() / 100.0)
    }

    /// What the function is called after its prefix `sh<order>_`; unique among specs of one order. It never ends in a
    /// digit and never holds `__`, since naga renames such names.
    pub fn stem(&self) -> String {
        let mut name = String::new();
        if !self.is_whole() {
            let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
            name += &format!("bands_{}_", bands.join("_"));
        }
        name += &match &self.family {
            Family::Rotate(method) if *method == Self::default_method(self.order, self.rgb) => "rotate".to_owned(),
            Family::Rotate(Method::Small(methods)) => format!("{}_zyz", small_list(methods).replace('+', "_")),
            Family::Rotate(method) => format!("rotate_{}", name_of(&METHODS, method)),
            Family::SmallY(methods) => format!("{}_y", small_list(methods).replace('+', "_")),
            Family::RotateXPlus90 => "rotate_x_plus_90deg".to_owned(),
            Family::RotateXMinus90 => "rotate_x_minus_90deg".to_owned(),
            family => match family.methods() {
                Some(methods) => {
                    let list = listed(methods).map(|list| list.replace('+', "_") + "_").unwrap_or_default();
                    list + listed_name(family, methods)
                }
                None => name_of(&PLAIN, family).to_owned(),
            },
        };
        if self.rgb {
            name += "_rgb";
        }
        if self.form == Form::Loop {
            name += "_loop";
        }
        if self.half {
            name += "_half";
        }
        name
    }

    /// The function's name in shaders.
    pub fn name(&self) -> String {
        format!("sh{}_{}", self.order, self.stem())
    }
}

/// The name of a family of [`LISTED`] with these methods.
fn listed_name(family: &Family, methods: &[Small]) -> &'static str {
    LISTED.iter().find(|(make, _)| make(methods.to_vec()) == *family).map_or("", |(_, name)| name)
}

fn name_of<T: PartialEq>(table: &[(T, &'static str)], wanted: &T) -> &'static str {
    table.iter().find(|(item, _)| item == wanted).map_or("", |(_, name)| name)
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = self.order;
        match &self.family {
            Family::Rotate(method) if *method == Self::default_method(order, self.rgb) => write!(f, "rotate:{order}")?,
            Family::Rotate(Method::Small(methods)) => write!(f, "rotate:{order}:{}", small_list(methods))?,
            Family::Rotate(method) => write!(f, "rotate:{order}:{}", name_of(&METHODS, method))?,
            Family::SmallY(methods) => {
                let list = small_list(methods);
                match list.contains('+') {
                    true => write!(f, "mix:{order}:{list}")?,
                    false => write!(f, "{list}:{order}")?,
                }
            }
            family => match family.methods() {
                Some(methods) => {
                    write!(f, "{}:{order}", listed_name(family, methods))?;
                    if let Some(list) = listed(methods) {
                        write!(f, ":{list}")?;
                    }
                }
                None => write!(f, "{}:{order}", name_of(&PLAIN, family))?,
            },
        }
        if !self.is_whole() {
            let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
            write!(f, ":bands={}", bands.join("+"))?;
        }
        if self.rgb {
            write!(f, ":rgb")?;
        }
        if self.form == Form::Loop {
            write!(f, ":loop")?;
        }
        if self.half {
            write!(f, ":f16")?;
        }
        Ok(())
    }
}

/// A piece of a spec's text and where it stands.
struct Piece<'a> {
    text: &'a str,
    at: Range<usize>,
}

impl Piece<'_> {
    fn error(&self, message: String, help: impl Into<String>) -> SpecError {
        SpecError { message, help: help.into(), at: self.at.clone() }
    }
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut start = 0;
    text.split(':')
        .map(|piece| {
            let at = start..start + piece.len();
            start = at.end + 1;
            Piece { text: piece, at }
        })
        .collect()
}

/// A method for each band; one alone is every band's, or `alone` makes a list of it. `exact` says whether it is known.
fn parse_small(
    piece: &Piece<'_>,
    order: usize,
    exact: bool,
    alone: impl Fn(Small) -> Vec<Small>,
) -> Result<Vec<Small>, SpecError> {
    let names: Vec<&str> = piece.text.split('+').collect();
    let mut known: Vec<&str> = Small::ALL.iter().map(|(_, name)| *name).collect();
    if exact {
        known.push(Small::Exact.name());
    }
    let mut methods = Vec::new();
    for name in &names {
        let method = small(name).or((exact && *name == Small::Exact.name()).then_some(Small::Exact));
        let method = method
            .ok_or_else(|| piece.error(format!("`{name}` is no method for a small angle here"), hint(name, &known)))?;
        methods.push(method);
    }
    if methods.len() == 1 {
        methods = alone(methods[0]);
    }
    if methods.len() != order - 1 {
        let message = format!("{} methods for the bands 1 to {}", methods.len(), order - 1);
        return Err(piece.error(message, format!("name one for all bands or {} joined by `+`", order - 1)));
    }
    Ok(methods)
}

fn parse_bands(piece: &Piece<'_>, list: &str, order: usize) -> Result<Vec<usize>, SpecError> {
    let mut bands = Vec::new();
    for text in list.split('+') {
        let band: usize = text
            .parse()
            .map_err(|_| piece.error(format!("`{text}` is no band"), "write bands as in `bands=0+1+2+4`"))?;
        if band >= order {
            let message = format!("band {band} is not below the order {order}");
            return Err(piece.error(message, format!("an order n has the bands 0 to n − 1: raise it to {}", band + 1)));
        }
        bands.push(band);
    }
    bands.sort_unstable();
    bands.dedup();
    Ok(bands)
}

fn parse_order(piece: &Piece<'_>) -> Result<usize, SpecError> {
    let range = format!("orders are {MIN_ORDER} to {MAX_ORDER}, in loop form to {MAX_LOOP_ORDER}");
    let order: usize =
        piece.text.parse().map_err(|_| piece.error(format!("`{}` is no order", piece.text), range.clone()))?;
    if !(MIN_ORDER..=MAX_LOOP_ORDER).contains(&order) {
        return Err(piece.error(format!("order {order} is out of range"), range));
    }
    Ok(order)
}

impl FromStr for Spec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        let all = pieces(text);
        let [head, rest @ ..] = &all[..] else {
            unreachable!("splitting always gives one piece");
        };
        let names = family_names();
        if !names.contains(&head.text) {
            return Err(head.error(format!("`{}` is no family of kernels", head.text), hint(head.text, &names)));
        }
        let Some((order_piece, mut options)) = rest.split_first() else {
            let help = format!("write it as in `{}:5`", head.text);
            return Err(head.error(format!("`{text}` names no order"), help));
        };
        let order = parse_order(order_piece)?;
        let mut spec = Self::new(Family::Basis, order);
        let mut method = None;
        spec.family = match (head.text, small(head.text)) {
            (_, Some(small)) => Family::SmallY(vec![small; order - 1]),
            ("mix", _) => {
                let Some((list, others)) = options.split_first() else {
                    return Err(order_piece.error(
                        "`mix` names no methods".to_owned(),
                        "write one a band, as in `mix:5:taylor15+taylor15+taylor15+taylor1`",
                    ));
                };
                options = others;
                Family::SmallY(parse_small(list, order, false, |method| vec![method; order - 1])?)
            }
            (name, None) => match LISTED.iter().find(|(_, known)| *known == name) {
                Some((make, _)) => {
                    let is_list = |piece: &&Piece<'_>| {
                        let first = piece.text.split('+').next().unwrap_or(piece.text);
                        small(first).is_some() || first == Small::Exact.name()
                    };
                    match options.first().filter(is_list) {
                        Some(list) => {
                            options = &options[1..];
                            make(parse_small(list, order, true, |method| method.from_band_3(order))?)
                        }
                        None => make(Small::Lf3.from_band_3(order)),
                    }
                }
                None => {
                    PLAIN.iter().find(|(_, known)| *known == name).map(|(family, _)| family.clone()).expect("is known")
                }
            },
        };
        let is_rotate = head.text == "rotate";
        for option in options {
            match option.text {
                "rgb" if spec.rgb => return Err(option.error("`rgb` stands twice".to_owned(), "leave one out")),
                "rgb" => spec.rgb = true,
                "loop" => spec.form = Form::Loop,
                "f16" => spec.half = true,
                _ if option.text.starts_with("bands=") => {
                    spec.bands = parse_bands(option, &option.text["bands=".len()..], order)?;
                }
                name if is_rotate && method.is_none() => {
                    let known = method_names();
                    let first = name.split('+').next().unwrap_or(name);
                    if !known.contains(&first) {
                        let all = [known, vec!["rgb", "loop", "f16"]].concat();
                        return Err(option.error(format!("`{name}` is no method of `rotate`"), hint(name, &all)));
                    }
                    method = Some(match METHODS.iter().find(|(_, known)| *known == name) {
                        Some((method, _)) => method.clone(),
                        None => Method::Small(parse_small(option, order, false, |method| vec![method; order - 1])?),
                    });
                }
                name => {
                    let known = ["rgb", "loop", "f16", "bands=0+1+2"];
                    return Err(option.error(format!("`{name}` is no option of `{}`", head.text), hint(name, &known)));
                }
            }
        }
        if is_rotate {
            spec.family = Family::Rotate(method.unwrap_or_else(|| match spec.form {
                Form::Loop => Method::Zyz,
                Form::Unrolled => Self::default_method(order, spec.rgb),
            }));
        }
        let whole = Piece { text, at: 0..text.len() };
        spec.check(&whole)?;
        Ok(spec)
    }
}

impl Spec {
    /// Refuses combinations that no kernel exists for.
    fn check(&self, whole: &Piece<'_>) -> Result<(), SpecError> {
        let order = self.order;
        let has_signal = !matches!(self.family, Family::Basis | Family::Angles | Family::Lifted);
        if self.rgb && !has_signal {
            let message = format!("`{}` has no signal that could be RGB", whole.text);
            return Err(whole.error(message, "leave `rgb` out: its result serves every channel"));
        }
        if !self.is_whole() && !matches!(self.family, Family::Basis | Family::Eval) {
            return Err(whole.error(
                "only `basis` and `eval` take `bands=`".to_owned(),
                "leave it out: a rotation leaves bands apart, so call it at the order that you store",
            ));
        }
        if self.bands.is_empty() {
            return Err(whole.error("no band is left".to_owned(), "name one at least, as in `bands=0+1+2`"));
        }
        if matches!(&self.family, Family::Rotate(Method::Tensor | Method::Matrix)) && order > 3 {
            return Err(whole.error(
                format!("this method has orders 2 and 3 only, not {order}"),
                "from order 4 on `zyz` is the cheapest exact rotation: leave the method out",
            ));
        }
        if matches!(&self.family, Family::Lifted | Family::Rotate(Method::Lifted)) && order < 3 {
            return Err(whole.error(
                format!("a lifted rotation has orders from 3 on, not {order}"),
                "at order 2 the matrix of a rotation costs least: take `rotate:2:matrix`",
            ));
        }
        if let Family::Tilt(methods) | Family::TiltPrescaled(methods) = &self.family
            && !methods.iter().enumerate().all(|(i, method)| match i {
                0 | 1 => *method == Small::Exact,
                _ => matches!(method, Small::Lf3 | Small::Lf5),
            })
        {
            return Err(whole.error(
                "a tilt is exact in bands 1 and 2 and takes `lf3` or `lf5` in the others".to_owned(),
                "write it as in `tilt:5:lf5` or `tilt:5:exact+exact+lf3+lf5`",
            ));
        }
        let zhf = matches!(self.family, Family::Zhf | Family::ZhfWeights | Family::ZhfTailored);
        if zhf && order > 10 {
            return Err(whole.error(
                format!("no lobe directions are known for order {order}"),
                "the zonal factorisation has orders 2 to 10",
            ));
        }
        let loops = match &self.family {
            Family::Basis => self.is_whole(),
            Family::Rotate(Method::Zyz) => true,
            Family::SmallY(methods) => methods.iter().all(|method| *method == Small::Taylor15),
            _ => false,
        };
        if self.form == Form::Loop && !loops {
            return Err(whole.error(
                format!("`{}` has no loop form", whole.text),
                "`basis`, `rotate` and `taylor15` have one: leave `loop` out",
            ));
        }
        if self.half && !self.takes_half() {
            return Err(whole.error(
                format!("`{}` does not work in f16", whole.text),
                format!(
                    "a quaternion's angles, a zonal factorisation and loops need f32, and orders end at {MAX_HALF_ORDER}; \
                     `rotate:{}:angles:f16` takes angles that were made in f32",
                    order.min(MAX_HALF_ORDER)
                ),
            ));
        }
        if self.form == Form::Unrolled && order > MAX_ORDER {
            let help = match loops {
                true => format!("write `{}:loop`", whole.text),
                false => format!("unrolled kernels have orders {MIN_ORDER} to {MAX_ORDER}"),
            };
            return Err(whole.error(format!("order {order} is too long unrolled"), help));
        }
        Ok(())
    }
}
