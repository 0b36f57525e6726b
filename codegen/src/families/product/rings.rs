//! Sums on rings: both factors as functions of the longitude at the nodes of a Gauss rule, given by their complex amplitudes,
//! multiplied there, and projected back (docs/MATH.md#rings). The nodes come in pairs ±z, and columns of modes of one
//! order by the parity of their bands.

use crate::families::product::plan::{Rings, Task, Triple};
use crate::families::product::wave::{self, Wave, Waves};
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::gaunt::Mode;
use crate::math::roots::squared_root;
use crate::math::tables::{k, legendre_polynomial};

/// A node of the rule, with what is multiplied at it.
struct Node {
    /// √(1 − z²) and z, which is not negative.
    sine: Exact,
    z: Exact,
    /// The weight, that of one of the two nodes where z is not zero.
    weight: Exact,
}

impl Node {
    fn new(rings: &Rings, z: Exact) -> Self {
        let sine = (Exact::one() - &z * &z).sqrt();
        let mut node = Self { sine, z, weight: Exact::one() };
        // Orthonormal polynomials of the rule's weight are those of the order of its exponent (Christoffel, Darboux).
        let exponent = rings.exponent;
        let sum: Exact = (exponent..exponent + rings.nodes).map(|l| node.value((l, exponent))).map(|p| &p * &p).sum();
        node.weight = Exact::one() / sum;
        node
    }

    /// K_l^m P_l^(m)(z) (1 − z²)^(m/2); the signs of three cancel.
    fn value(&self, (l, m): Mode) -> Exact {
        let polynomial = legendre_polynomial(l, m);
        let sum = polynomial.iter().rev().fold(Exact::zero(), |sum, c| &(&sum * &self.z) + c);
        let power = (0..m).fold(Exact::one(), |power, _| &power * &self.sine);
        k(l, m) * sum * power
    }

    fn is_equator(&self) -> bool {
        self.z.is_zero()
    }
}

fn nodes(rings: &Rings) -> Vec<Node> {
    let (l, m) = (rings.nodes + rings.exponent, rings.exponent);
    let above = (1..=rings.nodes / 2).map(|rank| squared_root(l, m, rank).sqrt());
    let equator = (rings.nodes % 2 == 1).then(Exact::zero);
    above.chain(equator).map(|z| Node::new(rings, z)).collect()
}

/// √2, which an order that is zero has in every column, and which the whole has not.
fn root_two() -> Exact {
    Exact::sqrt_ratio(2, 1)
}

/// Returns what rings sum for a triple instead of its integral.
pub fn sum(rings: &Rings, triple: Triple) -> Exact {
    let of = |node: &Node| {
        let product = triple.iter().map(|&mode| node.value(mode)).fold(node.weight.clone(), |product, p| product * p);
        if node.is_equator() { product } else { product * Exact::int(2) }
    };
    let sum: Exact = nodes(rings).iter().map(of).sum();
    if triple.iter().all(|(_, m)| *m > 0) { sum / root_two() } else { sum }
}

/// Both factors at a node, by order; the second is the first where there is one.
type Factors = [Vec<Wave>; 2];

/// Adds to `out` what the rings' classes make of both factors at one ring.
fn multiply(g: &mut Graph, task: Task, rings: &Rings, [a, b]: &Factors, out: &mut [Wave]) {
    let [from, to] = rings.classes;
    let half = Exact::ratio(1, 2);
    let halved = |g: &mut Graph, u: Wave| u.map(|part| g.scale(&half, part));
    for class in from..=to {
        for low in 0..=class / 2 {
            let high = class - low;
            // Terms that a square has twice are left single: what they are added to is doubled when it is projected.
            match (low, high) {
                (0, 0) => {
                    let u = halved(g, a[0]);
                    out[0] = wave::add_real(g, out[0], u, b[0]);
                }
                (0, _) => {
                    out[0] = wave::add_real(g, out[0], a[high], b[high]);
                    out[high] = wave::add(g, out[high], a[high], b[0]);
                    if !task.square {
                        out[high] = wave::add(g, out[high], b[high], a[0]);
                    }
                }
                _ if low == high => {
                    if task.square {
                        let u = halved(g, a[low]);
                        let [re, im] = out[class];
                        let re = g.mul_add(u[0], a[low][0], re);
                        let minus = g.mul(u[1], a[low][1]);
                        out[class] = [g.sub(re, minus), g.mul_add(a[low][0], a[low][1], im)];
                    } else {
                        out[class] = wave::add(g, out[class], a[low], b[low]);
                        out[low] = wave::add_turned(g, out[low], b[class], a[low]);
                    }
                    out[low] = wave::add_turned(g, out[low], a[class], b[low]);
                }
                _ => {
                    let views: &[[&Vec<Wave>; 2]] = if task.square { &[[a, a]] } else { &[[a, b], [b, a]] };
                    for [u, v] in views {
                        out[class] = wave::add(g, out[class], u[low], v[high]);
                        out[high] = wave::add_turned(g, out[high], u[class], v[low]);
                        out[low] = wave::add_turned(g, out[low], u[class], v[high]);
                    }
                }
            }
        }
    }
}

/// Adds to `out` what the rings sum.
pub fn add(g: &mut Graph, task: Task, rings: &Rings, factors: [&Waves; 2], out: &mut Waves) {
    let zero = g.constant(Exact::zero());
    let orders = rings.classes[1] + 1;
    let bands = |m: usize, order: usize, odd: usize| (m + odd..order).step_by(2);
    for node in nodes(rings) {
        // One entry of each factor's columns is made one.
        let unit = node.value((1, 1));
        let column = |m: usize| if m == 0 { root_two() } else { Exact::one() };
        let entry = |(l, m): Mode| node.value((l, m)) * column(m);
        let project = |(l, m): Mode| {
            let twice = if task.square && m > 0 { Exact::int(2) } else { Exact::one() };
            entry((l, m)) * &node.weight * &unit * &unit * twice / root_two()
        };
        // The factors above and below the equator.
        let mut sides: [Factors; 2] = Default::default();
        for (place, factor) in factors.into_iter().enumerate() {
            for m in 0..orders {
                let sum = |g: &mut Graph, odd: usize, start: Wave| {
                    bands(m, task.orders[place], odd).fold(start, |sum, l| {
                        let scale = entry((l, m)) / &unit;
                        let value = factor.at((l, m));
                        [0, 1].map(|part| g.scale_add(&scale, value[part], sum[part]))
                    })
                };
                let even = sum(g, 0, [zero; 2]);
                if node.is_equator() {
                    sides[0][place].push(even);
                    continue;
                }
                let above = sum(g, 1, even);
                sides[0][place].push(above);
                sides[1][place].push(mirrored(g, even, above));
            }
        }
        let mut made = vec![[zero; 2]; orders];
        multiply(g, task, rings, &sides[0], &mut made);
        let above = made.clone();
        if !node.is_equator() {
            multiply(g, task, rings, &sides[1], &mut made);
        }
        for m in 0..orders {
            let mut spread = |g: &mut Graph, odd: usize, value: Wave| {
                for l in bands(m, task.orders[2], odd) {
                    let scale = project((l, m));
                    let sum = out.at((l, m));
                    out.set((l, m), [0, 1].map(|part| g.scale_add(&scale, value[part], sum[part])));
                }
            };
            spread(g, 0, made[m]);
            if !node.is_equator() {
                let difference = mirrored(g, above[m], made[m]);
                spread(g, 1, difference);
            }
        }
    }
}

/// 2 u − v: e − o of e and e + o, and u − w of u and u + w.
fn mirrored(g: &mut Graph, u: Wave, v: Wave) -> Wave {
    [0, 1].map(|part| {
        if u[part] == v[part] {
            return u[part];
        }
        let twice: Id = g.scale(&Exact::int(2), u[part]);
        g.sub(twice, v[part])
    })
}
