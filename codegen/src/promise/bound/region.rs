//! The parameters' domains as trigonometric grids. Everything that a section computes, its error included, is a
//! trigonometric polynomial in the angles of its domain, for fixed relative roundings; such a polynomial of degree d stays
//! below its largest value at N equidistant points divided by cos(πd/N) (M. Riesz 1914). So a grid proves a bound for all
//! angles (docs/MATH.md#grids-that-prove).

// Names a family: a lifted rotation's couplings are sums over frequencies whose factors it alone has.
use crate::families::lifted;
use crate::math::exact::Exact;
use crate::promise::bound::roundoff::INPUT;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// What a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// There is no parameter.
    Nothing,
    /// One unit phase.
    Circle,
    /// One unit phase of an angle from 0 to this, over boxes.
    Arc(f64),
    /// A number of at most this size.
    Small(f64),
    /// Unit vectors (x, y, z).
    Sphere,
    /// Vectors (x, y, z) of at most unit length.
    Ball,
    /// Unit vectors at most this angle from z.
    Cap(f64),
    /// Unit quaternions (x, y, z, w).
    Quaternion,
    /// Rotation matrices by columns.
    Rotation,
    /// One or two pairs (cos, sin), over boxes instead of a grid; see [`crate::promise::bound::boxes`].
    Pairs,
}

/// A number that a section starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Root {
    /// A component of the parameter.
    Component(usize),
    /// cos kθ.
    Cos(usize),
    /// sin kθ.
    Sin(usize),
    /// sin θ / 2.
    HalfSine,
    /// tan(kθ / 2).
    HalfTangent(usize),
    /// sin²θ / 2.
    HalfSquare,
    /// sin θ cos θ.
    Product,
    /// A coupling in the outer or in the inner shear of a lifted band.
    Shear {
        /// The band.
        l: usize,
        /// Which of its couplings.
        at: usize,
        /// In which shear.
        inner: bool,
    },
}

/// The factors of a coupling, computed once.
fn factors(l: usize, at: usize) -> Arc<[f64]> {
    type Known = HashMap<(usize, usize), Arc<[f64]>>;
    static KNOWN: LazyLock<Mutex<Known>> = LazyLock::new(Mutex::default);
    let known = &mut KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let compute = || lifted::factors(l, lifted::couplings(l)[at]).iter().map(Exact::to_f64).collect();
    Arc::clone(known.entry((l, at)).or_insert_with(compute))
}

/// A coupling over angles from `middle` − `half` to `middle` + `half`, below the tangents' poles. A quaternion whose
/// components were rounded to f32 is longer or shorter than one by 1.001 u, which changes a sine of kβ by k times two of
/// that and a tangent of its half by less than twice as much; so does rounding a coupling itself by less.
fn coupling(l: usize, at: usize, inner: bool, middle: f64, half: f64) -> Enclosure {
    let (mut value, mut slope, mut bend, mut loose) = (0.0, 0.0, 0.0, 0.0);
    for (i, factor) in factors(l, at).iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
        let k = (i + 1) as f64;
        // The function, its slope, and the most that its size and its second derivative are.
        let (of, by, size, most) = match inner {
            true => ((k * middle).sin(), k * (k * middle).cos(), k * (middle + half), k * k),
            false => {
                let [tan, end] = [middle, middle + half].map(|x| (k * x / 2.0).tan());
                (tan, k / 2.0 * (1.0 + tan * tan), end, k * k / 2.0 * end * (1.0 + end * end))
            }
        };
        value += factor * of;
        slope += factor * by;
        bend += factor.abs() * most;
        loose += 8.0 * k * INPUT * factor.abs() * size;
    }
    (value, slope.abs() * half + bend * half * half / 2.0 + loose + THIN)
}

/// Degrees in up to three angles.
pub type Degree = [usize; 3];

/// An enclosure: a midpoint and a radius.
pub type Enclosure = (f64, f64);

/// What f64 makes of a cosine of a multiple of π.
const THIN: f64 = 1e-14;

fn thin(value: f64) -> Enclosure {
    (value, THIN)
}

fn enclose(a: f64, b: f64) -> Enclosure {
    ((a + b) / 2.0, (a - b).abs() / 2.0 + THIN)
}

fn times(a: Enclosure, b: Enclosure) -> Enclosure {
    let mid = a.0 * b.0;
    (mid, a.0.abs() * b.1 + a.1 * (b.0.abs() + b.1) + THIN * mid.abs())
}

fn minus(a: Enclosure, b: Enclosure) -> Enclosure {
    (a.0 - b.0, a.1 + b.1 + THIN)
}

fn plus(a: Enclosure, b: Enclosure) -> Enclosure {
    (a.0 + b.0, a.1 + b.1 + THIN)
}

impl Region {
    /// The degrees of a root in the domain's angles.
    pub fn degree(self, root: Root) -> Degree {
        match (self, root) {
            (Self::Arc(_), _) => [0, 0, 0],
            (_, Root::Cos(k) | Root::Sin(k)) => [k, 0, 0],
            (_, Root::HalfSine) => [1, 0, 0],
            (_, Root::HalfSquare | Root::Product) => [2, 0, 0],
            (_, Root::HalfTangent(_) | Root::Shear { .. }) => [0, 0, 0],
            (Self::Small(_), _) => [1, 0, 0],
            (Self::Sphere, Root::Component(2)) => [0, 1, 0],
            (Self::Sphere, _) => [1, 1, 0],
            (Self::Ball, Root::Component(2)) => [0, 1, 1],
            (Self::Ball, _) => [1, 1, 1],
            (Self::Cap(_), Root::Component(2)) => [0, 0, 0],
            (Self::Cap(_), _) => [1, 0, 0],
            (Self::Quaternion, Root::Component(i)) => [usize::from(i < 2), 1, usize::from(i >= 2)],
            (Self::Rotation, Root::Component(i)) => [usize::from(i % 3 < 2), 1, usize::from(i < 6)],
            _ => [0, 0, 0],
        }
    }

    /// The sections of the domain that no grid covers: parts of the angle from z.
    pub fn slabs(self) -> Option<(f64, f64)> {
        match self {
            Self::Cap(most) | Self::Arc(most) => Some((0.0, most)),
            _ => None,
        }
    }

    /// The grid for polynomials of this degree, on it the value of each root (its f32 rounding left out), and the factor
    /// by which the largest value on the grid is multiplied. `density` points are taken for each degree.
    pub fn grid(self, roots: &[Root], degree: Degree, density: usize, slab: (f64, f64)) -> (Vec<Vec<Enclosure>>, f64) {
        let sizes = degree.map(|d| (density * d).max(4).next_multiple_of(4));
        let factor: f64 = degree.iter().zip(sizes).map(|(&d, n)| 1.0 / (PI * d as f64 / n as f64).cos()).product();
        let angle = |i: usize, n: usize| TAU * i as f64 / n as f64;
        let turn = |i: usize, n: usize| [thin(angle(i, n).cos()), thin(angle(i, n).sin())];
        let [n0, n1, n2] = sizes;
        let mut grid: Vec<Vec<Enclosure>> = Vec::new();
        let mut push = |at: &dyn Fn(Root) -> Enclosure| grid.push(roots.iter().map(|&root| at(root)).collect());
        let component = |values: Vec<Enclosure>| {
            move |root: Root| match root {
                Root::Component(i) => values[i],
                _ => unreachable!("only a circle has phases"),
            }
        };
        match self {
            Self::Nothing | Self::Pairs => push(&component(vec![])),
            Self::Circle => {
                for i in 0..n0 {
                    let theta = angle(i, n0);
                    push(&|root| {
                        thin(match root {
                            Root::Cos(k) => (k as f64 * theta).cos(),
                            Root::Sin(k) => (k as f64 * theta).sin(),
                            Root::HalfSine => theta.sin() / 2.0,
                            Root::HalfSquare => theta.sin() * theta.sin() / 2.0,
                            Root::Product => theta.sin() * theta.cos(),
                            Root::Component(i) => [theta.cos(), theta.sin()][i],
                            Root::HalfTangent(_) | Root::Shear { .. } => unreachable!("an arc has tangents"),
                        })
                    });
                }
            }
            Self::Arc(_) => {
                let (middle, half) = ((slab.0 + slab.1) / 2.0, (slab.1 - slab.0).abs() / 2.0);
                // A function and its slope in the middle, with a second derivative of at most k².
                let around =
                    |value: f64, slope: f64, k: f64| (value, slope.abs() * half + k * k * half * half / 2.0 + THIN);
                push(&|root| match root {
                    Root::Cos(k) | Root::Sin(k) => {
                        let k = k as f64;
                        let (sin, cos) = (k * middle).sin_cos();
                        let [value, slope] = if matches!(root, Root::Cos(_)) { [cos, sin] } else { [sin, cos] };
                        around(value, k * slope, k)
                    }
                    Root::HalfSine => around(middle.sin() / 2.0, middle.cos() / 2.0, 1.0),
                    Root::HalfTangent(k) => {
                        let k = k as f64;
                        let [tan, end] = [middle, middle + half].map(|x| (k * x / 2.0).tan());
                        let bend = k * k / 2.0 * end * (1.0 + end * end);
                        (tan, k / 2.0 * (1.0 + tan * tan) * half + bend * half * half / 2.0 + THIN)
                    }
                    Root::HalfSquare => around(middle.sin().powi(2) / 2.0, (2.0 * middle).sin() / 2.0, 1.0),
                    Root::Product => around((2.0 * middle).sin() / 2.0, (2.0 * middle).cos(), 2.0),
                    Root::Shear { l, at, inner } => coupling(l, at, inner, middle, half),
                    Root::Component(_) => unreachable!("an arc has phases"),
                });
            }
            // most · cos t covers both signs already for t up to π.
            Self::Small(most) => (0..=n0 / 2).for_each(|i| push(&|_| thin(most * angle(i, n0).cos()))),
            Self::Sphere => {
                for i in 0..=n1 / 2 {
                    let [z, sin] = turn(i, n1);
                    for j in 0..n0 {
                        let [x, y] = turn(j, n0);
                        push(&component(vec![times(sin, x), times(sin, y), z]));
                    }
                }
            }
            // The length is the cosine of a third angle, of which every sign is met.
            Self::Ball => {
                for i in 0..=n1 / 2 {
                    let [z, sin] = turn(i, n1);
                    for j in 0..n0 {
                        let [x, y] = turn(j, n0);
                        for k in 0..=n2 / 2 {
                            let [length, _] = turn(k, n2);
                            let [x, y] = [x, y].map(|x| times(times(sin, x), length));
                            push(&component(vec![x, y, times(z, length)]));
                        }
                    }
                }
            }
            Self::Cap(_) => {
                let sin = enclose(slab.0.sin(), slab.1.sin());
                let z = enclose(slab.0.cos(), slab.1.cos());
                for j in 0..n0 {
                    let [x, y] = turn(j, n0);
                    push(&component(vec![times(sin, x), times(sin, y), z]));
                }
            }
            Self::Quaternion => {
                for i in 0..=n1 / 4 {
                    let [cos, sin] = turn(i, n1);
                    for j in 0..n0 {
                        let [x, y] = turn(j, n0);
                        for k in 0..n2 {
                            let [w, z] = turn(k, n2);
                            let all = vec![times(sin, x), times(sin, y), times(cos, z), times(cos, w)];
                            push(&component(all));
                        }
                    }
                }
            }
            Self::Rotation => {
                for i in 0..=n1 / 2 {
                    let [cb, sb] = turn(i, n1);
                    for j in 0..n0 {
                        let [ca, sa] = turn(j, n0);
                        for k in 0..n2 {
                            let [cg, sg] = turn(k, n2);
                            let (cc, sc) = (times(ca, cb), times(sa, cb));
                            push(&component(vec![
                                minus(times(cc, cg), times(sa, sg)),
                                plus(times(sc, cg), times(ca, sg)),
                                times((-sb.0, sb.1), cg),
                                minus(times((-cc.0, cc.1), sg), times(sa, cg)),
                                minus(times(ca, cg), times(sc, sg)),
                                times(sb, sg),
                                times(ca, sb),
                                times(sa, sb),
                                cb,
                            ]));
                        }
                    }
                }
            }
        }
        (grid, factor)
    }

    /// Whether the angle from z stays where sine and cosine are monotone, which [`Region::Cap`] needs.
    pub fn is_valid(self) -> bool {
        !matches!(self, Self::Cap(most) if most > FRAC_PI_2)
    }
}
