//! A kernel: named parameters, a graph, and the outputs that it computes. Families in `kernels/` build it through
//! [`Builder`]; the interpreter and the printers read it.
//! What a parameter may be is its *domain*: the one word from which the sentence in a function's head, the samples, the
//! proof's regions, the inputs of tests and the JSON of test vectors are made.

use crate::ir::graph::{Graph, Id, Kind};
use std::fmt;

/// The shape of a parameter or a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One number.
    Scalar,
    /// Three numbers: x, y, z.
    Vec3,
    /// Four numbers: x, y, z, w.
    Vec4,
    /// Three columns of three numbers.
    Mat3,
    /// One (cosine, sine) pair.
    Pair,
    /// So many (cosine, sine) pairs.
    Pairs(usize),
    /// So many numbers.
    Array(usize),
    /// So many vectors of three numbers.
    Vectors(usize),
}

impl Shape {
    /// Returns whether a value is an array, which not every language can return.
    pub fn is_array(self) -> bool {
        matches!(self, Self::Pairs(_) | Self::Array(_) | Self::Vectors(_))
    }

    /// How many numbers it holds.
    pub fn len(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Pair => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            Self::Mat3 => 9,
            Self::Pairs(n) => 2 * n,
            Self::Array(n) => n,
            Self::Vectors(n) => 3 * n,
        }
    }

    /// Whether it holds no number.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// One parameter of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its name, the same in every language.
    pub name: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Whether it is a signal, which has one number a channel, or a number that all channels share.
    pub kind: Kind,
    /// What it may be.
    pub domain: Domain,
    /// What it holds, with its unit and range.
    pub doc: String,
    /// What each of its numbers is where a list of inputs leaves it out, if it may.
    pub usual: Option<f64>,
}

impl Param {
    /// A parameter; it is a signal where its domain says so.
    pub fn new(name: &'static str, shape: Shape, domain: Domain, doc: impl Into<String>) -> Self {
        let kind = if domain.is_signal() { Kind::Signal } else { Kind::Scalar };
        Self { name, shape, kind, domain, doc: doc.into(), usual: None }
    }
}

/// A straight-line kernel.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The parameters, in order.
    pub params: Vec<Param>,
    /// The graph that the outputs live in.
    pub graph: Graph,
    /// One node a number of the result.
    pub outputs: Vec<Id>,
    /// The shape of the result.
    pub result: Shape,
    /// Whether the result is linear in the signal, or in each of two.
    pub result_kind: Kind,
    /// What the result holds.
    pub result_doc: String,
}

/// Makes a [`Kernel`]: declare the parameters, compute on the graph, finish with the outputs.
#[derive(Debug, Default)]
pub struct Builder {
    /// The graph to compute on.
    pub graph: Graph,
    params: Vec<Param>,
}

impl Builder {
    /// A builder with no parameter.
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares a parameter and returns its components in flat order.
    pub fn param(&mut self, name: &'static str, shape: Shape, domain: Domain, doc: impl Into<String>) -> Vec<Id> {
        let (param, of) = (self.params.len() as u32, Param::new(name, shape, domain, doc));
        let kind = of.kind;
        self.params.push(of);
        (0..shape.len() as u32).map(|index| self.graph.input(param, index, kind)).collect()
    }

    /// Says what the parameter that was declared last is where a list of inputs leaves it out.
    ///
    /// # Panics
    ///
    /// If there is no parameter.
    pub fn usually(&mut self, number: f64) {
        self.params.last_mut().expect("a parameter is declared").usual = Some(number);
    }

    /// The kernel with these outputs.
    ///
    /// # Panics
    ///
    /// If there are more or fewer than the result has numbers, or a signal is among products of signals.
    pub fn finish(self, outputs: Vec<Id>, result: Shape, doc: impl Into<String>) -> Kernel {
        assert_eq!(outputs.len(), result.len(), "one output for each number of the result");
        let kinds = || outputs.iter().map(|&id| self.graph.kind(id));
        let result_kind = kinds().max().unwrap_or(Kind::Scalar);
        let is_mixed = result_kind == Kind::Product && kinds().any(|kind| kind == Kind::Signal);
        assert!(!is_mixed, "a result is linear in a signal, or in each of two");
        Kernel { params: self.params, graph: self.graph, outputs, result, result_kind, result_doc: doc.into() }
    }
}

/// What a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// Coefficients, or what else the result is linear in: any numbers, one a channel.
    Signal,
    /// Coefficients as of a signal, one number each that all channels share.
    Grey,
    /// A direction, of unit length.
    Direction,
    /// A normal, of unit length, on either side of the horizon.
    Normal,
    /// A mean of normals of unit length, as mip maps have: its length is from this to one.
    MeanNormal(f64),
    /// A normal of unit length whose z is not negative.
    Hemisphere,
    /// A normal of unit length at most this angle in radians from z.
    Tilt(f64),
    /// A unit quaternion.
    Quaternion,
    /// A unit quaternion whose y angle, in Rz(α) Ry(β) Rz(γ), is at most this in radians, and which is turned
    /// approximately.
    SmallTurn(f64),
    /// A unit quaternion whose y angle is at most this in radians, and which is turned exactly: tangents of half its
    /// multiples are taken.
    BoundedTurn(f64),
    /// A rotation matrix, by columns.
    Rotation,
    /// The cosine and the sine of any angle, or several such pairs.
    Phases,
    /// An angle of at most this size in radians.
    Angle(f64),
    /// The sine of half an angle from 0 to this in radians.
    HalfSine(f64),
    /// A number between two.
    Between(f64, f64),
    /// A number between the first and the last, at the second of which another way is taken.
    Bent(f64, f64, f64),
    /// The coefficients of a function of the angle from an axis, one a band, none larger than one.
    Zonal,
    /// Coefficients of one channel, each band of norm one, of which something is found that is not linear in them.
    Coefficients,
    /// What another kernel returns.
    Made(Made),
    /// What the set-up returns of a kernel that is in pieces.
    SetUp,
}

/// A kernel that makes another one's parameter.
#[derive(Clone, Copy)]
pub struct Made {
    /// Its family's name.
    pub by: &'static str,
    /// Its order.
    pub order: usize,
    /// It.
    pub kernel: fn(usize) -> Kernel,
    /// The largest y angle in radians that it takes, if it does not take every rotation.
    pub max_angle: Option<f64>,
    /// What each number that it returns is a function of.
    pub holds: fn(usize) -> Vec<Held>,
}

impl fmt::Debug for Made {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{} within {:?}", self.by, self.order, self.max_angle)
    }
}

impl PartialEq for Made {
    fn eq(&self, other: &Self) -> bool {
        (self.by, self.order) == (other.by, other.order)
    }
}

/// A number that a set-up hands on: a function of one of a rotation's angles, as a proof has to know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// Which angle: 0 and up, in the order of the results; [`POLAR`] is the y angle of a quaternion.
    pub circle: usize,
    /// Which function of it.
    pub of: OfAngle,
}

/// The circle of a quaternion's y angle.
pub const POLAR: usize = 2;

/// A function of an angle θ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfAngle {
    /// cos kθ; what follows it is sin kθ.
    Cos(usize),
    /// sin kθ.
    Sin(usize),
    /// sin²θ / 2.
    HalfSquare,
    /// sin θ cos θ.
    Product,
    /// A coupling of a lifted band: Σ factor · tan(kθ/2) in the outer shear, Σ factor · sin kθ in the inner one.
    Shear {
        /// The band.
        l: usize,
        /// Which of its couplings.
        at: usize,
        /// In which shear.
        inner: bool,
    },
}

impl Domain {
    /// The largest angle in radians, if it is bounded.
    pub fn max_angle(self) -> Option<f64> {
        match self {
            Self::Tilt(most)
            | Self::SmallTurn(most)
            | Self::BoundedTurn(most)
            | Self::Angle(most)
            | Self::HalfSine(most) => Some(most),
            Self::Made(made) => made.max_angle,
            _ => None,
        }
    }

    /// The part of it within an angle in radians, where it is bounded by one.
    #[must_use]
    pub fn within(self, angle: f64) -> Self {
        match self {
            Self::Tilt(most) => Self::Tilt(most.min(angle)),
            Self::SmallTurn(most) => Self::SmallTurn(most.min(angle)),
            Self::BoundedTurn(most) => Self::BoundedTurn(most.min(angle)),
            Self::Angle(most) => Self::Angle(most.min(angle)),
            Self::HalfSine(most) => Self::HalfSine(most.min(angle)),
            Self::Made(made) => Self::Made(Made { max_angle: made.max_angle.map(|most| most.min(angle)), ..made }),
            _ => self,
        }
    }

    /// Returns whether it is coefficients, of which any numbers may be: a signal, or one that is grey.
    pub fn is_coefficients(self) -> bool {
        matches!(self, Self::Signal | Self::Grey)
    }

    /// Whether it is the signal.
    pub fn is_signal(self) -> bool {
        self == Self::Signal
    }

    /// For which values of a parameter of this name a kernel's promises hold, in words; none for coefficients.
    pub fn in_words(self, name: &str) -> Option<String> {
        let most = self.max_angle().map(degrees).unwrap_or_default();
        let words = match self {
            Self::Signal | Self::Grey => return None,
            Self::Direction => format!("for {name} of unit length"),
            Self::Normal => format!("for every {name} of unit length"),
            Self::MeanNormal(0.0) => format!("for every {name} of at most unit length"),
            Self::MeanNormal(least) => format!("for every {name} of a length from {least} to 1"),
            Self::Hemisphere => format!("for every {name} of unit length with {name}.z >= 0"),
            Self::Quaternion => format!("for every unit {name}"),
            Self::Rotation => "for every rotation matrix".to_owned(),
            Self::Phases => "for every angle".to_owned(),
            Self::Tilt(_) | Self::SmallTurn(_) | Self::Angle(_) => format!("for an angle up to {most} degrees"),
            Self::BoundedTurn(_) => format!("for an angle up to {most} degrees about y"),
            Self::HalfSine(_) => format!("with a {name} up to {most} degrees"),
            Self::Made(Made { max_angle: Some(_), .. }) => format!("for an angle up to {most} degrees about y"),
            Self::Between(least, most) | Self::Bent(least, _, most) => format!("for {name} from {least} to {most}"),
            Self::Zonal => format!("for {name} of at most one each"),
            Self::Coefficients => format!("for {name} with each band of norm one"),
            Self::Made(_) => "for every angle".to_owned(),
            Self::SetUp => format!("for {name} as the set-up makes it"),
        };
        Some(words)
    }
}

/// An angle in degrees, cut off after two decimals.
pub fn degrees(radians: f64) -> f64 {
    (radians.to_degrees() * 100.0 + 1e-6).floor() / 100.0
}
