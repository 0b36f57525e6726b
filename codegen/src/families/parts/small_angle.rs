//! Rotations of one band about y by a small angle: Taylor expansions (docs/MATH.md#taylor-expansions) and three or
//! five parity shears (LF3, LF5), which are cheaper and closer (docs/MATH.md#parity-shears).

use crate::families::parts::bands::{each_band, y_band, z_band};
use crate::families::parts::phases::{Phase, YPhases, multiples, y_phases};
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::tables;

/// How a band is rotated about y by a small angle β.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SmallAngle {
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

impl SmallAngle {
    /// The exact rotation, then the approximations, cheapest first.
    pub const ALL: [Self; 6] = [Self::Exact, Self::Taylor1, Self::Taylor15, Self::Taylor2, Self::Lf3, Self::Lf5];
    /// The approximations.
    pub const APPROXIMATE: [Self; 5] = [Self::Taylor1, Self::Taylor15, Self::Taylor2, Self::Lf3, Self::Lf5];

    /// Its name in a spec.
    pub fn name(self) -> &'static str {
        match self {
            Self::Taylor1 => "taylor1",
            Self::Taylor15 => "taylor15",
            Self::Taylor2 => "taylor2",
            Self::Lf3 => "lf3",
            Self::Lf5 => "lf5",
            Self::Exact => "exact",
        }
    }

    /// The method of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
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
pub fn parity_shears(l: usize, method: SmallAngle) -> Vec<ParityShear> {
    let p = shear_correction(l);
    let series: Vec<[Exact; 2]> = match method {
        SmallAngle::Lf3 => {
            let outer = [Exact::ratio(1, 2), &p / &Exact::int(4)];
            vec![outer.clone(), [Exact::one(), -&p], outer]
        }
        SmallAngle::Lf5 => {
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
/// The powers of β.
pub struct Powers {
    beta: Id,
    /// β².
    square: Id,
    /// What exact bands take, where the cosine and the sine are known.
    exact: Option<YPhases>,
}

fn small_band(g: &mut Graph, values: &[Id], powers: &Powers, method: SmallAngle) -> Vec<Id> {
    let l = values.len() / 2;
    if l == 0 {
        return values.to_vec();
    }
    match method {
        SmallAngle::Taylor1 => {
            let band = Band::new(g, values, powers.beta, |_| true);
            band.map(|m| band.add_generator(g, m, values, band.at(m)))
        }
        SmallAngle::Taylor15 => {
            let band = Band::new(g, values, powers.beta, |_| true);
            band.map(|m| {
                let half = &tables::ddy_diag(l, m) / &Exact::int(2);
                let factor = g.affine(&half, powers.square, &Exact::one());
                let start = g.mul(band.at(m), factor);
                band.add_generator(g, m, values, start)
            })
        }
        SmallAngle::Taylor2 => {
            let half = g.scale(&Exact::ratio(1, 2), powers.beta);
            let first = Band::new(g, values, half, |_| true);
            let inner = first.map(|m| first.add_generator(g, m, values, first.at(m)));
            let second = Band::new(g, values, powers.beta, |_| true);
            second.map(|m| second.add_generator(g, m, &inner, second.at(m)))
        }
        SmallAngle::Lf3 | SmallAngle::Lf5 => {
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
        SmallAngle::Exact => {
            let phases = powers.exact.as_ref().expect("a spec with exact bands takes the cosine and the sine");
            y_band(g, values, phases)
        }
    }
}

/// β = sin β (1 + sin²β / 6) and its square, to the fifth order.
pub fn of_sine(g: &mut Graph, sin: Id) -> [Id; 2] {
    let square = g.mul(sin, sin);
    let factor = g.affine(&Exact::ratio(1, 6), square, &Exact::one());
    let beta = g.mul(sin, factor);
    let factor = g.affine(&Exact::ratio(1, 3), square, &Exact::one());
    [beta, g.mul(square, factor)]
}

impl Powers {
    /// β and its square, from β.
    pub fn of_angle(g: &mut Graph, beta: Id) -> Self {
        Self { beta, square: g.mul(beta, beta), exact: None }
    }

    /// β = sin β (1 + sin²β / 6) and its square, to the fifth order; what the exact bands need up to the last of them.
    pub fn of_phase(g: &mut Graph, phase: Phase, methods: &[SmallAngle]) -> Self {
        let [beta, square] = of_sine(g, phase.sin);
        let exact = methods.iter().rposition(|method| *method == SmallAngle::Exact);
        Self { beta, square, exact: exact.map(|last| y_phases(g, phase, last + 1)) }
    }
}

/// Rotates every band about y, `methods[l − 1]` for band l.
pub fn small_rotation(g: &mut Graph, c: &[Id], order: usize, powers: &Powers, methods: &[SmallAngle]) -> Vec<Id> {
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        _ => {
            let out = small_band(g, band, powers, methods[l - 1]);
            g.stage(&out);
            out
        }
    })
}

/// Rz(α), the rotation about y by a small angle, Rz(γ).
pub fn between_z(
    g: &mut Graph,
    c: &[Id],
    order: usize,
    [alpha, gamma]: [Phase; 2],
    powers: &Powers,
    methods: &[SmallAngle],
) -> Vec<Id> {
    let alpha = multiples(g, alpha, order - 1);
    let gamma = multiples(g, gamma, order - 1);
    let turned = each_band(g, c, order, |g, _, band| z_band(g, band, &gamma));
    let tilted = small_rotation(g, &turned, order, powers, methods);
    each_band(g, &tilted, order, |g, _, band| z_band(g, band, &alpha))
}

/// The methods of the bands, repetitions left out.
pub fn names(methods: &[SmallAngle]) -> String {
    let mut names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
    names.dedup();
    names.join(", ")
}

/// The methods of the bands, and where they come from.
pub fn sources(methods: &[SmallAngle]) -> String {
    let names = names(methods);
    format!(
        "bands from 1: {names}; Taylor forms after Krivanek et al. 2005, lf3 and lf5 by three and five parity shears"
    )
}
