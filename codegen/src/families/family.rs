//! What a family of kernels says of itself, in one record: its names, its sentence, its orders and forms, what its error is
//! measured by and proven from, what the planner may take it for, its rows of the catalogue. And the spec, which names
//! one kernel of a family. It knows no family.

pub use crate::families::group::Group;
pub use crate::families::parts::form::Form;
use crate::families::parts::small_angle::SmallAngle;
use crate::ir::code::{Branch, Code};
use crate::ir::kernel::Kernel;
use crate::ir::listing::Listing;
use crate::ir::program::LoopKernel;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::ops::RangeInclusive;

/// The smallest order of a kernel.
pub const MIN_ORDER: usize = 2;
/// The largest order of an unrolled kernel: beyond it, text grows past what shader compilers take.
pub const MAX_ORDER: usize = 16;
/// The largest order of a kernel in f16.
pub const MAX_HALF_ORDER: usize = 10;
/// The largest order of a kernel in loop form.
pub const MAX_LOOP_ORDER: usize = 64;

/// The largest angle in degrees that an approximate rotation is meant for: "up to 25 degrees" in Křivánek et al. 2005.
pub const SMALL_ANGLE_DEGREES: f64 = 25.0;

/// [`SMALL_ANGLE_DEGREES`] in radians.
pub fn small_angle() -> f64 {
    SMALL_ANGLE_DEGREES.to_radians()
}

/// What a rounding error is measured against.
#[derive(Clone, Copy, Debug)]
pub enum Measure {
    /// Each band's error against the band's norm in the signal.
    Bands,
    /// Each band's error where something is added to the signal, against the norm of that band and the size of what is
    /// added, both of which are one. What is added is linear in signals that are single numbers.
    Added,
    /// The value's error against the norm of all coefficients.
    Whole,
    /// The whole result's error against the norm of the signal: neither need be bands.
    Norm,
    /// The whole result's error against the product of the norms of its factors, of which there are two or one twice.
    Product,
    /// The error itself: there is no signal.
    Absolute,
    /// The error of each band of the signal that this kernel rotates by the result, for two results may mean the same: there
    /// is no signal.
    Through(fn(usize) -> Kernel),
}

/// What a kernel does to the bands of its signal, where its error is measured by bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// It turns or reflects the signal as its parameters say: no band mixes with another, and each keeps its norm but for the
    /// error of an approximate method.
    Turns,
    /// Something else, to each band by itself.
    Bands,
    /// A map that mixes bands; what proves its bound takes it to be constant.
    Mixes,
}

/// How a rounding bound is proven, where the measure, the bands and the parameters' domains do not say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// Values, sums, bands or all of them at once, as the measure and what is done to the bands say.
    Auto,
    /// Lobes that are turned to the directions that the kernel notes.
    Lobes,
    /// Not at all: the measured worst case times a margin is promised.
    Nothing,
}

/// What the planner is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Job {
    /// The shortest rotation from z to a normal.
    Tilt,
    /// A rotation about y.
    Y,
    /// A rotation about z, y and z: any one, its y angle bounded.
    Zyz,
    /// A rotation by a quaternion whose y angle is bounded.
    Quaternion,
}

/// A job that a family does, or is weighed for only to say why it does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Does {
    /// The job.
    pub job: Job,
    /// Whether it takes other parameters than the job has, such as a quaternion where there is a normal.
    pub otherwise: bool,
    /// What bars it.
    pub barred: Option<&'static str>,
}

impl Does {
    /// A job that is done with the job's own parameters.
    pub const fn job(job: Job) -> Self {
        Self { job, otherwise: false, barred: None }
    }

    /// A job that is done with other parameters.
    pub const fn otherwise(job: Job) -> Self {
        Self { job, otherwise: true, barred: None }
    }

    /// A job that is not done, and why.
    pub const fn barred(job: Job, why: &'static str) -> Self {
        Self { job, otherwise: true, barred: Some(why) }
    }
}

/// How a rotation's small angle reaches it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleAs {
    /// β itself.
    Angle,
    /// Its cosine and sine: β = sin β (1 + sin²β/6), to the fifth order.
    Phase,
    /// A normal, as the tilt has it: the same series, multiplied out in the shears.
    Normal,
}

/// Where a spec says the methods of the bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spelled {
    /// In the family's place if all bands have one, as in `lf3:5`; after the family's name else.
    AsFamily,
    /// In the method's place, as in `rotate:5:lf3`.
    AsMethod,
    /// After the order; left out where they are the family's usual ones, as in `tilt:5`.
    AsOption,
}

/// What a family whose bands are each rotated in a way of their own says of that.
#[derive(Clone, Copy, Debug)]
pub struct ByBand {
    /// Where a spec says the methods.
    pub spelled: Spelled,
    /// How the angle is given.
    pub given: AngleAs,
    /// The methods that a band may have.
    pub in_band: fn(usize) -> &'static [SmallAngle],
    /// What is wrong where a band has another one, and what to do.
    pub rule: [&'static str; 2],
    /// The y rotation, or the tilt towards x, alone.
    pub plane: fn(usize, &[SmallAngle]) -> Kernel,
}

impl ByBand {
    /// Whether a band may be rotated exactly.
    pub fn takes_exact(&self) -> bool {
        (self.in_band)(1).contains(&SmallAngle::Exact)
    }

    /// One method for all bands: from band 3 on where bands may be exact.
    pub fn alone(&self, method: SmallAngle, order: usize) -> Vec<SmallAngle> {
        match self.takes_exact() {
            true => method.from_band_3(order),
            false => vec![method; order - 1],
        }
    }
}

/// The loop form of a family.
#[derive(Clone, Copy, Debug)]
pub struct Looped {
    /// What has one, as a spec begins.
    pub name: &'static str,
    /// Whether a spec of the family has one.
    pub has: fn(&Spec) -> bool,
    /// It, at an order.
    pub kernel: fn(usize) -> LoopKernel,
}

/// A function of the angle from an axis, as a family says it that gives its zonal coefficients: by what a cosine is short of
/// one, so that it is exact near the axis too.
#[derive(Clone, Copy, Debug)]
pub struct ZonalFunction {
    /// How far it reaches: it is zero beyond this.
    pub reach: fn(parameters: &[Vec<f64>]) -> f64,
    /// Its value at one less the cosine.
    pub value: fn(parameters: &[Vec<f64>], short: f64) -> f64,
    /// By how much the coefficients err besides rounding, relative to the largest of them.
    pub error: f64,
}

/// A family of kernels.
pub struct Family {
    /// What a spec begins with: `rotate`.
    pub name: &'static str,
    /// The method that a spec names after the order, `zxzxz`; empty for a family without methods.
    pub method: &'static str,
    /// What its functions are called after `sh<order>_`: `rotate_zxzxz`. It neither ends in a digit nor holds `__`.
    pub stem: &'static str,
    /// Whether its name without a method means it, at an order and for one channel or three.
    pub usual: fn(usize, bool) -> bool,
    /// What it is listed under.
    pub group: Group,
    /// What a kernel does, in a sentence, and where it comes from.
    pub what: fn(&Spec) -> String,
    /// The orders of its unrolled kernels.
    pub orders: RangeInclusive<usize>,
    /// What is wrong with an order outside of them, and what to do.
    pub outside: fn(usize) -> [String; 2],
    /// Whether it works in f16: not where a quaternion's or a normal's angles are kept defined by a number that f16 does not
    /// hold, and where lobes are inverted.
    pub half: bool,
    /// Whether it takes some bands only.
    pub some_bands: bool,
    /// Whether its two factors may be of other orders than the result.
    pub factors: bool,
    /// The orders of what it converts, where that may be another one than the result's: a spec then names both, as in
    /// `sh_to_hsh:5+3`.
    pub converts: Option<RangeInclusive<usize>>,
    /// Whether its specs leave the order out and its functions are not called after it, since there is one alone.
    pub one_order: bool,
    /// What a spec may choose besides, after its method: of each list one at most.
    pub choices: &'static [&'static [&'static str]],
    /// What is wrong with a spec besides, and what to do.
    pub fault: fn(&Spec) -> Option<[String; 2]>,
    /// Its loop form.
    pub looped: Option<Looped>,
    /// What it says where each band has a method of its own.
    pub by_band: Option<ByBand>,
    /// An unrolled kernel; of a branch, the way that is taken where the condition does not hold.
    pub kernel: fn(&Spec) -> Kernel,
    /// The two ways of a kernel that has a branch, and what decides between them.
    pub branch: Option<fn(&Spec) -> Branch>,
    /// What its error is measured against.
    pub measure: Measure,
    /// What it does to the bands of its signal.
    pub acts: Acts,
    /// How its error is proven.
    pub proof: Proof,
    /// The choices of which nothing is proven.
    pub unproven: &'static [&'static str],
    /// The largest y angle in radians, if it does not take every angle.
    pub max_angle: fn(&Spec) -> Option<f64>,
    /// What the planner may take it for, at an order and for one channel or three.
    pub does: fn(usize, bool) -> Vec<Does>,
    /// Where among its results a direction begins that turns with the coefficients that it is found of; none where all that
    /// is found does.
    pub direction: Option<usize>,
    /// The function that its results are the zonal coefficients of, where they are those of one.
    pub zonal: Option<ZonalFunction>,
    /// The non-zero entries of its sparse matrix in the bands from 2 on, where that is what its papers count.
    pub nonzeros: Option<fn(usize) -> usize>,
    /// Its rows of the catalogue at an order.
    pub shown: fn(usize) -> Vec<Spec>,
}

impl Family {
    /// A family that says nothing: what most records leave as it is.
    pub const PLAIN: Self = Self {
        name: "",
        method: "",
        stem: "",
        usual: |_, _| true,
        group: Group::Piece,
        what: |_| String::new(),
        orders: MIN_ORDER..=MAX_ORDER,
        outside: |order| {
            let help = format!("unrolled kernels have orders {MIN_ORDER} to {MAX_ORDER}");
            [format!("order {order} is too long unrolled"), help]
        },
        half: true,
        some_bands: false,
        factors: false,
        converts: None,
        one_order: false,
        choices: &[],
        fault: |_| None,
        looped: None,
        by_band: None,
        kernel: |spec| unreachable!("`{}` has no kernel", spec.family.name),
        branch: None,
        measure: Measure::Bands,
        acts: Acts::Turns,
        proof: Proof::Auto,
        unproven: &[],
        max_angle: |spec| spec.is_approximate().then(small_angle),
        does: |_, _| vec![],
        direction: None,
        zonal: None,
        nonzeros: None,
        shown: |_| vec![],
    };

    /// Whether it has a signal, which may be RGB.
    pub fn has_signal(&self) -> bool {
        matches!(self.measure, Measure::Bands | Measure::Added | Measure::Whole | Measure::Norm | Measure::Product)
    }

    fn key(&self) -> (&str, &str) {
        (self.name, self.method)
    }
}

impl fmt::Debug for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.name, self.method)
    }
}

impl PartialEq for Family {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Family {}

impl Hash for Family {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl PartialOrd for Family {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Family {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

/// What to generate. A spec names exactly one function in each language.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Spec {
    /// The order n: bands 0 to n − 1, n² coefficients.
    pub order: usize,
    /// What it does.
    pub family: &'static Family,
    /// A method for each band from 1, where the family takes them.
    pub methods: Vec<SmallAngle>,
    /// The bands that exist; the others are zero and not stored. All of them where the family does not take some only.
    pub bands: Vec<usize>,
    /// Whether the signal has three channels that share the parameters.
    pub rgb: bool,
    /// Unrolled or a loop.
    pub form: Form,
    /// Whether it works in f16 instead of f32: WGSL only, with `enable f16`.
    pub half: bool,
    /// The orders of the two factors of a product, or of what is converted and of the result, where they are not all the
    /// result's.
    pub factors: Option<[usize; 2]>,
    /// What it chooses of the family's lists, in their order.
    pub chosen: Vec<&'static str>,
}

impl Spec {
    /// A spec of all bands, one channel, unrolled; `lf3` where bands have methods.
    pub fn new(family: &'static Family, order: usize) -> Self {
        let methods = family.by_band.map_or_else(Vec::new, |by_band| by_band.alone(SmallAngle::Lf3, order));
        let (bands, form) = ((0..order).collect(), Form::Unrolled);
        Self { order, family, methods, bands, rgb: false, form, half: false, factors: None, chosen: vec![] }
    }

    /// The spec of a family of one order, where that is this one.
    pub fn only(family: &'static Family, order: usize) -> Option<Self> {
        family.orders.contains(&order).then(|| Self::new(family, order))
    }

    /// The spec for three channels.
    #[must_use]
    pub fn rgb(mut self) -> Self {
        self.rgb = true;
        self
    }

    /// The spec with one method for all bands, from band 3 on where bands may be exact.
    ///
    /// # Panics
    ///
    /// If the family's bands have no methods.
    #[must_use]
    pub fn by(self, method: SmallAngle) -> Self {
        let by_band = self.family.by_band.expect("the family's bands have methods");
        Self { methods: by_band.alone(method, self.order), ..self }
    }

    /// The spec with a method for each band from 1.
    #[must_use]
    pub fn by_band(self, methods: Vec<SmallAngle>) -> Self {
        Self { methods, ..self }
    }

    /// The spec in loop form.
    #[must_use]
    pub fn looped(self) -> Self {
        Self { form: Form::Loop, ..self }
    }

    /// The spec with its RGB twin.
    pub fn both(self) -> Vec<Self> {
        vec![self.clone(), self.rgb()]
    }

    /// The spec with factors of these orders; of a conversion those of what is converted and of the result.
    #[must_use]
    pub fn of_factors(self, orders: [usize; 2]) -> Self {
        let factors = (orders != [self.order; 2]).then_some(orders);
        Self { factors, ..self }
    }

    /// Returns the orders of the two factors of a product, or of what is converted and of the result.
    pub fn factor_orders(&self) -> [usize; 2] {
        self.factors.unwrap_or([self.order; 2])
    }

    /// How many channels the signal has.
    pub fn channels(&self) -> usize {
        if self.rgb { 3 } else { 1 }
    }

    /// Whether a kernel in f16 exists.
    pub fn takes_half(&self) -> bool {
        let half = Self { half: true, ..self.clone() };
        self.family.half
            && self.form != Form::Loop
            && self.order <= MAX_HALF_ORDER
            && (self.family.fault)(&half).is_none()
    }

    /// Whether all bands exist.
    pub fn is_whole(&self) -> bool {
        self.bands.len() == self.order
    }

    /// Whether it is a rotation that errs by more than rounding.
    pub fn is_approximate(&self) -> bool {
        self.methods.iter().any(|method| *method != SmallAngle::Exact)
    }

    /// The largest y angle in radians that the kernel is meant for, if it does not take every angle.
    pub fn max_angle(&self) -> Option<f64> {
        (self.family.max_angle)(self)
    }

    /// [`Spec::max_angle`] in degrees, cut off after two decimals.
    pub fn max_degrees(&self) -> Option<f64> {
        self.max_angle().map(crate::ir::kernel::degrees)
    }

    /// Its operations, in the form that it names.
    pub fn code(&self) -> Code {
        match (self.form, self.family.looped, self.family.branch) {
            (Form::Loop, Some(looped), _) => Code::Loop((looped.kernel)(self.order)),
            (Form::Unrolled, _, Some(branch)) => Code::Branch(Box::new(branch(self))),
            _ => Code::Straight(Listing::new(&self.kernel())),
        }
    }

    /// Its unrolled kernel: the twin of a loop, the way of a branch that is taken where the condition does not hold, or the
    /// piece that it names.
    ///
    /// # Panics
    ///
    /// If it names a piece that there is not, which no spec does that was read.
    pub fn kernel(&self) -> Kernel {
        let piece = match self.form {
            Form::Unrolled | Form::Loop => return (self.family.kernel)(self),
            Form::SetUp => self.pieces().and_then(|pieces| pieces.set_up()),
            Form::Band(l) => self.pieces().map(|pieces| pieces.band(l)),
        };
        piece.unwrap_or_else(|| panic!("`{self}` is no piece"))
    }

    /// The spec of the kernel itself, without what only its text depends on: the number of channels.
    pub fn base(&self) -> Self {
        Self { rgb: false, ..self.clone() }
    }

    /// The bands, as a sentence names them.
    pub fn which_bands(&self) -> String {
        let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
        match self.is_whole() {
            true => format!("of order {}", self.order),
            false => format!("of the bands {}", bands.join(", ")),
        }
    }
}
