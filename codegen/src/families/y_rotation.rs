//! Approximate rotations about y by a small angle: Taylor expansions (docs/MATH.md#taylor-expansions) and three or five
//! parity shears (LF3, LF5), which are cheaper and closer (docs/MATH.md#parity-shears). A kernel names a method for each
//! band.

use crate::families::rotate::{
    YPhases, each_band, from_quaternion, phases_of_quaternion, quaternion, signal, y_band, y_phases, z_band,
};
use crate::families::{Phase, inner, multiples, phases};
use crate::ir::graph::{Graph, Id, Kind};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::tables;

/// How a band is rotated about y by a small angle β.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Small {
    /// 1 + β A: error (lβ)²/2.
    Taylor1,
    /// 1 + β A + β²/2 diag(A²): `shRotYdiff15` of Křivánek et al. 2005, error about (lβ)²/4.
    Taylor15,
    /// 1 + β A + β²/2 A²: error (lβ)³/6.
    Taylor2,
    /// Shears of the even orders, the odd, the even: error (lβ)³/24, determinant one.
    Lf3,
    /// Two shears more: error (7 − 3√5) (lβ)³/96, about (lβ)³/329, determinant one.
    Lf5,
    /// The exact rotation. It takes the cosine and the sine of β, so that kernels which take β alone cannot have it.
    Exact,
}

impl Small {
    /// The approximations, with the names that specs use.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Taylor1, "taylor1"),
        (Self::Taylor15, "taylor15"),
        (Self::Taylor2, "taylor2"),
        (Self::Lf3, "lf3"),
        (Self::Lf5, "lf5"),
    ];

    /// Its name in a spec.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(small, _)| *small == self).map_or("exact", |(_, name)| name)
    }

    /// `self` from band 3 on; bands 1 and 2 are exact, which costs less there than any shears.
    pub fn from_band_3(self, order: usize) -> Vec<Self> {
        (1..order).map(|l| if l < 3 { Self::Exact } else { self }).collect()
    }
}

/// The correction p of the shears' polynomials: the discrete minimax over the band's frequencies
/// (docs/MATH.md#three-shears).
pub fn shear_correction(l: usize) -> Exact {
    let l = l as i64;
    match l % 2 {
        0 => Exact::ratio(l * l, 8),
        _ => Exact::ratio(3 * l * l + 1, 24),
    }
}

/// A shear of the rows of one parity: its parity, and its coefficient as c₀ β + c₂ β³.
pub struct ParityShear {
    /// Whether the even or the odd orders change.
    pub parity: usize,
    /// c₀ and c₂.
    pub series: [Exact; 2],
}

/// The shears of LF3 and LF5, none for other methods. On the plane of a frequency k they multiply to 1 − e k³β³ off the
/// diagonal, once first order is right; the term in β³ takes off the part of e k³ that is linear in k. For five shears
/// β is split by the golden ratio, where both triangles have the same e = (7 − 3√5)/24; what is left to choose shifts
/// β³ between the outer and the inner even shears, so that the two triangles err alike in (lβ)⁵ too
/// (docs/MATH.md#five-shears).
pub fn parity_shears(l: usize, method: Small) -> Vec<ParityShear> {
    let p = shear_correction(l);
    let series: Vec<[Exact; 2]> = match method {
        Small::Lf3 => {
            let outer = [Exact::ratio(1, 2), &p / &Exact::int(4)];
            vec![outer.clone(), [Exact::one(), -&p], outer]
        }
        Small::Lf5 => {
            let root5 = Exact::sqrt_ratio(5, 1);
            let golden = &(&root5 - &Exact::one()) / &Exact::int(2);
            let outer = &(&Exact::one() - &golden) / &Exact::int(2);
            let linear = &(&(&root5 * &Exact::int(3)) - &Exact::int(7)) / &Exact::int(4);
            let linear = &linear * &p;
            // l² stands as 8 p, which is what it is on the frequencies of an odd band.
            let shift = &(&(&(&outer * &outer) * &golden) / &(&root5 * &Exact::int(2))) * &(&p * &Exact::int(8));
            let scaled = |factor: &Exact, shift: Exact| [factor.clone(), &(factor * &linear) + &shift];
            let even = scaled(&outer, shift.clone());
            let odd = scaled(&Exact::ratio(1, 2), Exact::zero());
            let inner = scaled(&golden, &shift * &Exact::int(-2));
            vec![even.clone(), odd.clone(), inner, odd, even]
        }
        _ => vec![],
    };
    series.into_iter().enumerate().map(|(i, series)| ParityShear { parity: i % 2, series }).collect()
}

/// A band while it is rotated about y: the chain of cosines and the chain of sines, and the couplings of neighbours.
struct Band<'a> {
    values: &'a [Id],
    l: usize,
    /// `edge[m]` couples m − 1 and m.
    edge: Vec<Option<Id>>,
}

impl<'a> Band<'a> {
    /// Couplings `factor` · a_m for every m that `wanted` names.
    fn new(g: &mut Graph, values: &'a [Id], factor: Id, wanted: impl Fn(usize) -> bool) -> Self {
        let l = values.len() / 2;
        let edge = (0..=l).map(|m| (m > 0 && wanted(m)).then(|| g.scale(&tables::ladder(l, m), factor))).collect();
        Self { values, l, edge }
    }

    /// `start` + f A x for the order `signed`: −a_m x_{m−1} + a_{m+1} x_{m+1} along the order's chain.
    fn add_generator(&self, g: &mut Graph, signed: isize, x: &[Id], start: Id) -> Id {
        let m = signed.unsigned_abs();
        let at = |m: usize| if signed < 0 { x[self.l - m] } else { x[self.l + m] };
        let lowest = usize::from(signed < 0);
        let mut sum = start;
        if m > lowest {
            let term = g.mul(at(m - 1), self.edge[m].expect("coupling was asked for"));
            sum = g.sub(sum, term);
        }
        if m < self.l {
            let term = g.mul(at(m + 1), self.edge[m + 1].expect("coupling was asked for"));
            sum = g.add(sum, term);
        }
        sum
    }

    fn map(&self, f: impl FnMut(isize) -> Id) -> Vec<Id> {
        let l = self.l as isize;
        (-l..=l).map(f).collect()
    }

    fn at(&self, m: isize) -> Id {
        self.values[(self.l as isize + m) as usize]
    }
}

/// What the small rotations of all bands share.
struct Powers {
    beta: Id,
    /// β².
    square: Id,
    /// What exact bands take, where the cosine and the sine are known.
    exact: Option<YPhases>,
}

fn small_band(g: &mut Graph, values: &[Id], powers: &Powers, method: Small) -> Vec<Id> {
    let l = values.len() / 2;
    if l == 0 {
        return values.to_vec();
    }
    match method {
        Small::Taylor1 => {
            let band = Band::new(g, values, powers.beta, |_| true);
            band.map(|m| band.add_generator(g, m, values, band.at(m)))
        }
        Small::Taylor15 => {
            let band = Band::new(g, values, powers.beta, |_| true);
            band.map(|m| {
                let half = &tables::ddy_diag(l, m) / &Exact::int(2);
                let factor = g.affine(&half, powers.square, &Exact::one());
                let start = g.mul(band.at(m), factor);
                band.add_generator(g, m, values, start)
            })
        }
        Small::Taylor2 => {
            let half = g.scale(&Exact::ratio(1, 2), powers.beta);
            let first = Band::new(g, values, half, |_| true);
            let inner = first.map(|m| first.add_generator(g, m, values, first.at(m)));
            let second = Band::new(g, values, powers.beta, |_| true);
            second.map(|m| second.add_generator(g, m, &inner, second.at(m)))
        }
        Small::Lf3 | Small::Lf5 => {
            let mut x = values.to_vec();
            for shear in parity_shears(l, method) {
                let [first, third] = &shear.series;
                let factor = g.affine(third, powers.square, first);
                let factor = g.mul(powers.beta, factor);
                let band = Band::new(g, values, factor, |_| true);
                x = band.map(|m| {
                    let value = x[(l as isize + m) as usize];
                    match m.rem_euclid(2) as usize == shear.parity {
                        true => band.add_generator(g, m, &x, value),
                        false => value,
                    }
                });
            }
            x
        }
        Small::Exact => {
            let phases = powers.exact.as_ref().expect("a spec with exact bands takes the cosine and the sine");
            y_band(g, values, phases)
        }
    }
}

impl Powers {
    fn of_angle(g: &mut Graph, beta: Id) -> Self {
        Self { beta, square: g.mul(beta, beta), exact: None }
    }

    /// β = sin β (1 + sin²β / 6) and its square, to the fifth order; what the exact bands need up to the last of them.
    fn of_phase(g: &mut Graph, phase: Phase, methods: &[Small]) -> Self {
        let square = g.mul(phase.sin, phase.sin);
        let factor = g.affine(&Exact::ratio(1, 6), square, &Exact::one());
        let beta = g.mul(phase.sin, factor);
        let factor = g.affine(&Exact::ratio(1, 3), square, &Exact::one());
        let exact = methods.iter().rposition(|method| *method == Small::Exact);
        Self { beta, square: g.mul(square, factor), exact: exact.map(|last| y_phases(g, phase, last + 1)) }
    }
}

fn small_rotation(g: &mut Graph, c: &[Id], order: usize, powers: &Powers, methods: &[Small]) -> Vec<Id> {
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        _ => {
            let out = small_band(g, band, powers, methods[l - 1]);
            g.stage(&out);
            out
        }
    })
}

fn angle(builder: &mut Builder) -> Id {
    builder.param("beta", Shape::Scalar, Kind::Scalar, "the angle about y in radians, small")[0]
}

/// About y by β, `methods[l − 1]` for band l: the kernels `taylor1`, `taylor15`, `taylor2`, `lf3` and their mixtures.
pub fn about_y(order: usize, methods: &[Small]) -> Kernel {
    let mut builder = Builder::new();
    let beta = angle(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let powers = Powers::of_angle(g, beta);
    let out = small_rotation(g, &c, order, &powers, methods);
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

/// The y rotation of `rotate_small` alone, from (cos β, sin β).
pub fn small_y(order: usize, methods: &[Small]) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Kind::Scalar, "(cos β, sin β)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let powers = Powers::of_phase(g, phases(&cs)[0], methods);
    let out = small_rotation(g, &c, order, &powers, methods);
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

/// Rz(α) Ry(β) Rz(γ) with a small β, `methods[l − 1]` for band l.
pub fn small_zyz(order: usize, methods: &[Small]) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(2), Kind::Scalar, "(cos, sin) of α and γ in Rz(α) Ry(β) Rz(γ)");
    let beta = angle(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let both = phases(&cs);
    let powers = Powers::of_angle(g, beta);
    let out = between_z(g, &c, order, [both[0], both[1]], &powers, methods);
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

/// Rz(α), the small rotation, Rz(γ).
fn between_z(
    g: &mut Graph,
    c: &[Id],
    order: usize,
    [alpha, gamma]: [Phase; 2],
    powers: &Powers,
    methods: &[Small],
) -> Vec<Id> {
    let alpha = multiples(g, alpha, order - 1);
    let gamma = multiples(g, gamma, order - 1);
    let turned = each_band(g, c, order, |g, _, band| z_band(g, band, &gamma));
    let tilted = small_rotation(g, &turned, order, powers, methods);
    each_band(g, &tilted, order, |g, _, band| z_band(g, band, &alpha))
}

/// The kernel `rotate_small`: from a unit quaternion whose y angle is small, `methods[l − 1]` for band l.
pub fn small_rotate(order: usize, methods: &[Small]) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder);
    let c = signal(&mut builder, order);
    let out = small_from_quaternion(&mut builder.graph, &q, &c, order, methods);
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

fn small_from_quaternion(g: &mut Graph, q: &[Id], c: &[Id], order: usize, methods: &[Small]) -> Vec<Id> {
    let [alpha, beta, gamma] = phases_of_quaternion(g, q);
    let powers = Powers::of_phase(g, beta, methods);
    between_z(g, c, order, [alpha, gamma], &powers, methods)
}

/// The kernel `rotate_adaptive` as three of the same parameters: the two numbers of which the first must not be above the
/// second for the small rotation, sin²(β/2) and its limit; the small rotation; the exact one.
pub fn adaptive(order: usize, methods: &[Small]) -> [Kernel; 3] {
    type Part<'a> = &'a dyn Fn(&mut Graph, [&[Id]; 3]) -> Vec<Id>;
    let make = |f: Part<'_>, shape: Shape| {
        let mut builder = Builder::new();
        let q = quaternion(&mut builder);
        let doc = "sin(b/2) of the largest y angle b that may be rotated approximately, not negative; a / (√2 + 2 r/R) \
                   for a radiance cache of error a whose record has the radius R and is used at the distance r";
        let limit = builder.param("limit", Shape::Scalar, Kind::Scalar, doc);
        let c = signal(&mut builder, order);
        let out = f(&mut builder.graph, [&q, &limit, &c]);
        builder.finish(out, shape, "the rotated coefficients")
    };
    let condition = |g: &mut Graph, [q, limit, _]: [&[Id]; 3]| {
        vec![inner(g, &[q[0], q[1]], &[q[0], q[1]]), g.mul(limit[0], limit[0])]
    };
    let small = |g: &mut Graph, [q, _, c]: [&[Id]; 3]| small_from_quaternion(g, q, c, order, methods);
    let exact = |g: &mut Graph, [q, _, c]: [&[Id]; 3]| from_quaternion(g, q, c, order);
    let all = Shape::Array(order * order);
    [make(&condition, Shape::Pair), make(&small, all), make(&exact, all)]
}
