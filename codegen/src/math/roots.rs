//! The roots of Legendre functions, to 512 bits where they are not rational: lobe directions and the nodes of quadratures
//! stand at them.

use crate::math::exact::{Exact, Real};
use crate::math::tables::legendre_polynomial;

/// Returns the square of the `rank`-th largest root of P_l^m, 1 ≤ rank ≤ (l-m)/2: rational if it is the only one, otherwise by
/// Newton's iteration from 1, where the larger roots are divided out (Maehly), so that it falls to the largest one left.
pub fn squared_root(l: usize, m: usize, rank: usize) -> Exact {
    let exact: Vec<Exact> = legendre_polynomial(l, m).into_iter().skip((l - m) % 2).step_by(2).collect();
    if let [constant, slope] = &exact[..] {
        return -(constant / slope);
    }
    let polynomial: Vec<Real> = exact.iter().map(Exact::to_real).collect();
    let mut roots: Vec<Real> = Vec::new();
    for _ in 0..rank {
        let mut root = Real::from_ratio(1, 1);
        loop {
            let (mut value, mut slope) = (Real::zero(), Real::zero());
            for c in polynomial.iter().rev() {
                slope = slope * &root + &value;
                value = value * &root + c;
            }
            for larger in &roots {
                slope = slope - &value / (&root - larger);
            }
            let step = value / slope;
            root = root - &step;
            if step.is_negligible() {
                break;
            }
        }
        roots.push(root);
    }
    Exact::real(roots.pop().unwrap_or_else(Real::zero))
}
