//! A product by its plan: the sums over pairs (docs/MATH.md#pairs), the rings, and the constant's own terms, which are
//! scaled so that its integrals with any other two are one.

use crate::families::product::plan::{CONSTANT, Item, Plan, Task, is_sum, triple};
use crate::families::product::rings;
use crate::families::product::wave::{self, Wave, Waves};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::gaunt::{Mode, gaunt};
use crate::math::tables::k;

/// The factors, the sums so far and what they are made of.
struct Cover<'a> {
    g: &'a mut Graph,
    plan: &'a Plan,
    zero: Id,
    /// The factors as what is multiplied with which; a square has one of each.
    views: Vec<[usize; 2]>,
    factors: [Waves; 2],
    /// The factors' constants, times y_0 and twice that in a square.
    constants: [Id; 2],
    out: Waves,
    /// What the constant's sum is over y_0, besides what it has already.
    constant: Id,
}

/// A multiplication of the sum of a pair's thirds with one of the pair: for thirds of the sum's order and the difference's.
#[derive(Clone, Copy)]
struct Sums {
    plus: Wave,
    minus: Wave,
}

/// Returns the kernel of a plan: of the factors `a`, a signal or grey, and `b`, or of `a` alone.
pub fn kernel(plan: &Plan, first: Domain) -> Kernel {
    let mut builder = Builder::new();
    let Task { orders, square } = plan.task;
    let a = factor(&mut builder, "a", orders[0], first);
    let b = if square { a.clone() } else { factor(&mut builder, "b", orders[1], Domain::Signal) };
    let out = product(&mut builder.graph, plan, &a, &b);
    finish(builder, orders[2], out)
}

/// Declares a factor.
pub fn factor(builder: &mut Builder, name: &'static str, order: usize, domain: Domain) -> Vec<Id> {
    let what = if domain == Domain::Signal { "" } else { ", grey: one number for all channels" };
    let doc = format!("the coefficients of a function of order {order}, index l(l+1)+m{what}");
    builder.param(name, Shape::Array(order * order), domain, doc)
}

/// Returns the kernel whose result are the coefficients of a product.
pub fn finish(builder: Builder, order: usize, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(order * order), "the coefficients of the product, index l(l+1)+m")
}

/// Returns the product of two functions, or the square of one, by a plan.
pub fn product(g: &mut Graph, plan: &Plan, a: &[Id], b: &[Id]) -> Vec<Id> {
    g.lay_out_as_made();
    let zero = g.constant(Exact::zero());
    let Task { orders, square } = plan.task;
    let factors = [a, b].map(|coefficients| Waves::of(coefficients, zero));
    let scale = if square { k(0, 0) * Exact::int(2) } else { k(0, 0) };
    let constants = [a, b].map(|coefficients| g.scale(&scale, coefficients[0]));
    let views = if square { vec![[0, 0]] } else { vec![[0, 1], [1, 0]] };
    let out = Waves::zeros(orders[2], zero);
    let mut cover = Cover { g, plan, zero, views, factors, constants, out, constant: zero };
    if plan.rings_of(0).is_none() {
        cover.constant = cover.g.mul(a[0], b[0]);
    }
    plan.items.iter().for_each(|item| cover.add(item));
    for ring in &plan.rings {
        rings::add(cover.g, plan.task, ring, [&cover.factors[0], &cover.factors[1]], &mut cover.out);
    }
    let [sum, none] = cover.out.at(CONSTANT);
    let sum = cover.g.scale_add(&k(0, 0), cover.constant, sum);
    cover.out.set(CONSTANT, [sum, none]);
    cover.out.coefficients(orders[2])
}

impl Cover<'_> {
    /// What a pair and a third are multiplied by, less what rings sum of it.
    fn factor(&self, pair: [Mode; 2], third: Mode) -> Exact {
        let [p, q, sum] = triple(pair, third);
        let whole = gaunt(p, q, sum);
        let rest = match self.plan.rings_of(sum.1) {
            Some(ring) => whole - rings::sum(ring, [p, q, sum]),
            None => whole,
        };
        // What is in a triple twice is met twice.
        if pair[0] != pair[1] && pair.contains(&third) { rest / Exact::int(2) } else { rest }
    }

    fn is_kept(&self, mode: Mode) -> bool {
        self.plan.task.has(mode)[2]
    }

    /// Adds a factor times the real part, or both parts, of a sum to a mode.
    fn give(&mut self, third: Mode, factor: &Exact, value: Wave) {
        if third == CONSTANT {
            self.constant = self.g.add(self.constant, value[0]);
            return;
        }
        let sum = self.out.at(third);
        let re = self.g.scale_add(factor, value[0], sum[0]);
        let im = if third.1 == 0 { self.zero } else { self.g.scale_add(factor, value[1], sum[1]) };
        self.out.set(third, [re, im]);
    }

    /// Σ factor · the third, of one of the factors.
    fn sum(&mut self, factor: usize, thirds: &[(Mode, Exact)]) -> Wave {
        let square = if self.plan.task.square { Exact::int(2) } else { Exact::one() };
        let constant = thirds.iter().any(|(third, _)| *third == CONSTANT);
        let start = if constant { self.constants[factor] } else { self.zero };
        thirds.iter().filter(|(third, _)| *third != CONSTANT).fold([start, self.zero], |sum, (third, value)| {
            let (scale, wave) = (value * &square, self.factors[factor].at(*third));
            [0, 1].map(|part| self.g.scale_add(&scale, wave[part], sum[part]))
        })
    }

    fn add(&mut self, item: &Item) {
        let [x, y] = item.pair;
        let is_own = |third: Mode| x == y && third == x;
        let with_factors = |cover: &Self, plus: bool| -> Vec<(Mode, Exact)> {
            let of_sign = item.thirds.iter().filter(|&&third| is_sum([x, y], third) == plus && !is_own(third));
            of_sign.map(|&third| (third, cover.factor([x, y], third))).collect()
        };
        let [plus, minus] = [true, false].map(|sign| with_factors(self, sign));
        self.give_thirds(item, &plus, &minus);
        if item.thirds.iter().any(|&third| is_own(third)) {
            let [a, b] = [0, 1].map(|factor| self.factors[factor].at(x));
            let value = self.g.mul(a[0], b[0]);
            let factor = self.factor([x, y], x);
            self.give(x, &factor, [value, self.zero]);
        }
        for [first, second] in self.views.clone() {
            let sums = Sums { plus: self.sum(first, &plus), minus: self.sum(first, &minus) };
            let [with_x, with_y] = [x, y].map(|mode| self.factors[second].at(mode));
            self.gather(x, &sums, with_y, false);
            if x != y {
                self.gather(y, &sums, with_x, true);
            }
        }
    }

    /// What the products of a pair give to the thirds.
    fn give_thirds(&mut self, item: &Item, plus: &[(Mode, Exact)], minus: &[(Mode, Exact)]) {
        let [x, y] = item.pair;
        let kept = |cover: &Self, thirds: &[(Mode, Exact)]| -> Vec<(Mode, Exact)> {
            thirds.iter().filter(|(third, _)| cover.is_kept(*third)).cloned().collect()
        };
        let [plus, minus] = [plus, minus].map(|thirds| kept(self, thirds));
        let twice = if self.plan.task.square && x != y { Exact::int(2) } else { Exact::one() };
        let views: Vec<[Wave; 2]> = self.views[..if x == y { 1 } else { self.views.len() }]
            .iter()
            .map(|&[u, v]| [self.factors[u].at(x), self.factors[v].at(y)])
            .collect();
        let (zero, is_real) = (self.zero, x.1 == y.1);
        if !plus.is_empty() && !minus.is_empty() {
            // Products of parts, shared by the sum's order and the difference's.
            let sum =
                |g: &mut Graph, i: usize, j: usize| views.iter().fold(zero, |sum, [u, v]| g.mul_add(u[i], v[j], sum));
            let g = &mut *self.g;
            let [rr, ii] = [sum(g, 0, 0), sum(g, 1, 1)];
            let re = g.sub(rr, ii);
            let both = match (x == y, is_real) {
                (true, _) => [[re, self.doubled(x)], [self.g.add(rr, ii), zero]],
                (_, true) => {
                    let first = views.iter().fold(zero, |sum, [u, v]| g.mul_add(u[0], v[1], sum));
                    let im = views.iter().fold(first, |sum, [u, v]| g.mul_add(u[1], v[0], sum));
                    [[re, im], [g.add(rr, ii), zero]]
                }
                _ => {
                    let [ri, ir] = [sum(g, 0, 1), sum(g, 1, 0)];
                    [[re, g.add(ri, ir)], [g.add(rr, ii), g.sub(ir, ri)]]
                }
            };
            for (thirds, value) in [(plus, both[0]), (minus, both[1])] {
                thirds.iter().for_each(|(third, factor)| self.give(*third, &(factor * &twice), value));
            }
            return;
        }
        let is_plus = !plus.is_empty();
        let thirds = [plus, minus].concat();
        if let [(CONSTANT, _)] = &thirds[..] {
            // The constant's sum takes the products themselves.
            let start = [self.constant, zero];
            let [re, _] = views.iter().fold(start, |sum, &[u, v]| wave::add_real(self.g, sum, u, v));
            self.constant = re;
            return;
        }
        if thirds.is_empty() {
            return;
        }
        let g = &mut *self.g;
        let value = match (is_plus, is_real) {
            (true, _) if x == y && x.1 > 0 => {
                let [u, v] = views[0];
                let rr = g.mul(u[0], v[0]);
                let ii = g.mul(u[1], v[1]);
                [g.sub(rr, ii), self.doubled(x)]
            }
            (true, _) => views.iter().fold([zero; 2], |sum, &[u, v]| wave::add(g, sum, u, v)),
            (false, true) => views.iter().fold([zero; 2], |sum, &[u, v]| wave::add_real(g, sum, u, v)),
            // ū v + u v̄ with the factors exchanged.
            (false, false) => views.iter().fold([zero; 2], |sum, &[u, v]| wave::add_turned(g, sum, u, v)),
        };
        thirds.iter().for_each(|(third, factor)| self.give(*third, &(factor * &twice), value));
    }

    /// The imaginary part of the product of both factors in one mode; in a square one product, twice.
    fn doubled(&mut self, x: Mode) -> Id {
        let [a, b] = [0, 1].map(|factor| self.factors[factor].at(x));
        let first = self.g.mul(a[0], b[1]);
        match self.plan.task.square {
            true => self.g.scale(&Exact::int(2), first),
            false => self.g.mul_add(a[1], b[0], first),
        }
    }

    /// Adds to a mode the sums of thirds times the other one of a pair; to the second one, whose order is the smaller, the
    /// difference's sum turned.
    fn gather(&mut self, mode: Mode, sums: &Sums, other: Wave, is_second: bool) {
        let Sums { plus: p, minus: m } = *sums;
        let g = &mut *self.g;
        let (re, im) = (g.add(p[0], m[0]), g.sub(m[0], p[0]));
        let (with, less) = (g.add(p[1], m[1]), g.sub(p[1], m[1]));
        let (first, second) = if is_second { (with, less) } else { (less, with) };
        let sum = self.out.at(mode);
        let real = g.mul_add(re, other[0], sum[0]);
        let real = g.mul_add(first, other[1], real);
        let imaginary = g.mul_add(second, other[0], sum[1]);
        let imaginary = g.mul_add(im, other[1], imaginary);
        let imaginary = if mode.1 == 0 { self.zero } else { imaginary };
        self.out.set(mode, [real, imaginary]);
    }
}
