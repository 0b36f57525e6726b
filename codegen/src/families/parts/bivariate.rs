//! Sums of monomials in which one coordinate, the linear one, occurs to the first power at most: A(x, y) + z B(x, y), by
//! Horner's rule in x with coefficients that are polynomials in y (docs/MATH.md#evaluation-at-the-floor). Where all
//! monomials of a degree are there, n² coefficients take n² − 1 multiply-adds a channel and share nothing.

use crate::families::parts::polynomial::{Polynomial, Powers};
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// The monomials of order n, those of degree d from d² on: first without the linear coordinate, which is the last, then
/// with it.
pub fn monomials(order: usize) -> Vec<Powers> {
    let of_degree = |d: usize| {
        let without = (0..=d).map(move |i| [i, d - i, 0]);
        without.chain((0..d).map(move |i| [i, d - 1 - i, 1]))
    };
    (0..order).flat_map(of_degree).collect()
}

/// Returns a polynomial in which every square of the last coordinate is replaced by `square`, which is linear in it.
pub fn reduced(polynomial: &Polynomial, square: &Polynomial) -> Polynomial {
    let (mut reduced, mut rest) = (Polynomial::default(), polynomial.clone());
    while rest != Polynomial::default() {
        let mut next = Polynomial::default();
        for ([i, j, k], factor) in rest.terms() {
            match k {
                0 | 1 => reduced.add([i, j, k], factor.clone()),
                _ => next = next.plus(factor, &square.times(&Polynomial::new([([i, j, k - 2], Exact::one())]))),
            }
        }
        rest = next;
    }
    reduced
}

/// The square of the last coordinate of a unit vector: 1 − x² − y².
pub fn on_the_sphere() -> Polynomial {
    let minus = -Exact::one();
    Polynomial::new([([0; 3], Exact::one()), ([2, 0, 0], minus.clone()), ([0, 2, 0], minus)])
}

/// Returns for each monomial Σ factor · c over the functions that `c` are the coefficients of.
pub fn converted(g: &mut Graph, functions: &[(Id, Polynomial)], monomials: &[Powers]) -> Vec<Id> {
    let zero = g.constant(Exact::zero());
    let sum = |g: &mut Graph, powers: Powers| {
        functions.iter().fold(zero, |sum, (c, function)| g.scale_add(&function.factor(powers), *c, sum))
    };
    monomials.iter().map(|&powers| sum(g, powers)).collect()
}

/// Returns a^k, each power made of the one below.
fn power(g: &mut Graph, a: Id, k: usize) -> Id {
    (1..k).fold(a, |power, _| g.mul(power, a))
}

/// Returns Σ of each term times a power of `a`, terms ascending by exponents; powers that are left out cost a product.
fn horner(g: &mut Graph, a: Id, terms: &[(usize, Id)]) -> Option<Id> {
    let (&(mut above, mut nested), rest) = terms.split_last()?;
    for &(exponent, term) in rest.iter().rev() {
        let factor = power(g, a, above - exponent);
        nested = g.mul_add(nested, factor, term);
        above = exponent;
    }
    Some(if above == 0 {
        nested
    } else {
        let factor = power(g, a, above);
        g.mul(nested, factor)
    })
}

/// Returns Σ c · monomial, the linear coordinate last.
///
/// # Panics
///
/// If there is no monomial, or one that is not linear in the last coordinate.
pub fn sum(g: &mut Graph, [x, y, z]: [Id; 3], monomials: &[Powers], c: &[Id]) -> Id {
    assert!(monomials.iter().all(|powers| powers[2] <= 1), "the last coordinate is the linear one");
    let largest = monomials.iter().map(|powers| powers[0].max(powers[1])).max().unwrap_or(0);
    let part = |g: &mut Graph, k: usize| {
        let of = |i: usize, j: usize| {
            monomials.iter().zip(c).find(|(powers, _)| **powers == [i, j, k]).map(|(_, &c)| (j, c))
        };
        let rows: Vec<(usize, Id)> = (0..=largest)
            .filter_map(|i| {
                let row: Vec<(usize, Id)> = (0..=largest).filter_map(|j| of(i, j)).collect();
                horner(g, y, &row).map(|row| (i, row))
            })
            .collect();
        horner(g, x, &rows)
    };
    match (part(g, 0), part(g, 1)) {
        (Some(a), Some(b)) => g.mul_add(b, z, a),
        (Some(a), None) => a,
        (None, Some(b)) => g.mul(b, z),
        (None, None) => panic!("there is a monomial"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::Spec;
    use crate::ir::eval::{Contraction, Program};
    use crate::ir::listing::Listing;
    use crate::promise::samples::Random;

    #[test]
    fn every_square_of_the_linear_coordinate_is_replaced() {
        let (x, y, z) = (0.48f64, -0.6f64, 0.64f64);
        let value = |polynomial: &Polynomial| -> f64 {
            let of = |(powers, factor): (Powers, &Exact)| {
                let [i, j, k] = powers.map(|power| power as i32);
                factor.to_f64() * x.powi(i) * y.powi(j) * z.powi(k)
            };
            polynomial.terms().map(of).sum()
        };
        for k in 0..7 {
            let monomial = Polynomial::new([([1, 2, k], Exact::sqrt_ratio(3, 7))]);
            let reduced = reduced(&monomial, &on_the_sphere());
            assert!(reduced.terms().all(|([_, _, k], _)| k <= 1), "{reduced:?}");
            assert!((value(&reduced) - value(&monomial)).abs() < 1e-15, "z^{k}");
        }
    }

    #[test]
    fn monomials_take_an_operation_a_coefficient_and_are_what_harmonics_are() {
        let mut random = Random::new(3);
        for order in 2..=8 {
            let [eval, turn, plain] = ["eval_monomial", "to_monomial", "eval"].map(|name| format!("{name}:{order}"));
            for axis in ["", ":x", ":y"] {
                let [eval, turn] =
                    [&eval, &turn].map(|text| Listing::new(&format!("{text}{axis}").parse::<Spec>().unwrap().kernel()));
                let plain = Listing::new(&plain.parse::<Spec>().unwrap().kernel());
                assert_eq!([1, 3].map(|channels| eval.cost(channels).total), [1, 3].map(|k| k * (order * order - 1)));
                println!("order {order}{axis}: to_monomial {}", turn.cost(1).total);
                let run = |listing: &Listing, inputs: &[&[f64]]| {
                    Program::<f64>::new(listing).run(inputs, Contraction::Separate)
                };
                for _ in 0..20 {
                    let dir: [f64; 3] = random.unit();
                    let c: Vec<f64> = (0..order * order).map(|_| random.signed()).collect();
                    let (got, want) = (run(&eval, &[&dir, &run(&turn, &[&c])])[0], run(&plain, &[&dir, &c])[0]);
                    // The coefficients grow by half a digit an order (docs/MATH.md#evaluation-at-the-floor).
                    assert!(
                        (got - want).abs() < 1e-14 * f64::powi(2.0, order as i32),
                        "order {order}{axis}: {got}, {want}"
                    );
                }
            }
        }
        let error = "eval_monomial:9:x".parse::<Spec>().unwrap_err();
        assert!(error.help.contains("leave `x` out"), "{error}");
        assert!("eval_monomial:3:x:y".parse::<Spec>().unwrap_err().message.contains("exclude"));
    }
}
