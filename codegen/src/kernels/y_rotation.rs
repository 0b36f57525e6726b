//! Approximate rotations about y by a small angle: Taylor expansions (paper 000) and three parity shears (LF3), which
//! are cheaper and closer. A kernel names a method for every band.

use crate::graph::{Graph, Id, Kind};
use crate::kernel::{Builder, Kernel, Shape};
use crate::kernels::rotate::{each_band, signal, z_band};
use crate::kernels::{multiples, phases};
use crate::sh::exact::Exact;
use crate::sh::tables;

/// How a band is rotated about y by a small angle β.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Small {
    /// 1 + β A: error (lβ)²/2.
    Taylor1,
    /// 1 + β A + β²/2 diag(A²): paper 000's `shRotYdiff15`, error about (lβ)²/4.
    Taylor15,
    /// 1 + β A + β²/2 A²: error (lβ)³/6.
    Taylor2,
    /// Shears of the even orders, the odd, the even: error (lβ)³/24, determinant one.
    Lf3,
}

impl Small {
    /// All of them, with the names that specs use.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Taylor1, "taylor1"), (Self::Taylor15, "taylor15"), (Self::Taylor2, "taylor2"), (Self::Lf3, "lf3")];

    /// Its name in a spec.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(small, _)| *small == self).map_or("", |(_, name)| name)
    }
}

/// The correction p of the shears' polynomials: the discrete minimax over the band's frequencies (MATH section 9.1).
pub fn lf3_correction(l: usize) -> Exact {
    let l = l as i64;
    match l % 2 {
        0 => Exact::ratio(l * l, 8),
        _ => Exact::ratio(3 * l * l + 1, 24),
    }
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
        Small::Lf3 => {
            let p = lf3_correction(l);
            let half = Exact::ratio(1, 2);
            let s = g.affine(&-&p, powers.square, &Exact::one());
            let s = g.mul(powers.beta, s);
            let t = g.affine(&(&p / &Exact::int(4)), powers.square, &half);
            let t = g.mul(powers.beta, t);
            let mut x = values.to_vec();
            let (even, odd) = (Band::new(g, values, t, |_| true), Band::new(g, values, s, |_| true));
            for (band, parity) in [(&even, 0), (&odd, 1), (&even, 0)] {
                x = band.map(|m| {
                    let value = x[(l as isize + m) as usize];
                    match m.rem_euclid(2) == parity {
                        true => band.add_generator(g, m, &x, value),
                        false => value,
                    }
                });
            }
            x
        }
    }
}

fn small_rotation(g: &mut Graph, c: &[Id], order: usize, beta: Id, methods: &[Small]) -> Vec<Id> {
    let square = g.mul(beta, beta);
    let powers = Powers { beta, square };
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        _ => {
            let out = small_band(g, band, &powers, methods[l - 1]);
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
    let out = small_rotation(&mut builder.graph, &c, order, beta, methods);
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
    let alpha = multiples(g, both[0], order - 1);
    let gamma = multiples(g, both[1], order - 1);
    let turned = each_band(g, &c, order, |g, _, band| z_band(g, band, &gamma));
    let tilted = small_rotation(g, &turned, order, beta, methods);
    let out = each_band(g, &tilted, order, |g, _, band| z_band(g, band, &alpha));
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}
