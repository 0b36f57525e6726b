//! A section over its whole domain: the largest of a measure on the grid that proves it, the exact norm, and what errors of
//! phases do.

use crate::promise::bound::norm::Matrix;
use crate::promise::bound::region::{Degree, Region, Root};
use crate::promise::bound::roundoff::{Both, larger, larger_of};
use crate::promise::bound::section::{Run, Section, Start};

/// Points a degree on the grid, by the number of angles.
pub(super) fn density(degree: Degree) -> usize {
    match degree.iter().filter(|&&d| d > 0).count() {
        0 | 1 => 16,
        2 => 12,
        _ => 10,
    }
}

/// The largest measure over the domain; `reach` widens what the roots may be.
pub(super) fn sweep(
    section: &Section,
    domain: Region,
    starts: &[Start],
    roundoff: f64,
    reach: f64,
    measure: &dyn Fn(&Run, usize, f64) -> f64,
) -> Both {
    let roots: Vec<Root> = starts.iter().map(|start| start.root).collect();
    let degree = section.degree();
    let mut run = Run::default();
    let mut over = |slab: (f64, f64)| {
        let (grid, factor) = domain.grid(&roots, degree, density(degree), slab);
        let mut worst = [0.0; 2];
        for mut values in grid {
            values.iter_mut().for_each(|value| value.1 += reach);
            section.run(&values, starts, roundoff, &mut run);
            for mode in 0..2 {
                worst[mode] = larger_of(measure(&run, mode, worst[mode]), worst[mode]);
            }
        }
        worst.map(|bound| bound * factor)
    };
    let Some((from, to)) = domain.slabs() else {
        return over((0.0, 0.0));
    };
    // Halve the slab with the largest bound until it is hardly above what is found at single angles.
    let largest = |both: Both| both[0].max(both[1]);
    let mut slabs = vec![((from, to), over((from, to)))];
    let mut found = largest(over((to, to)));
    for _ in 0..40 {
        let (at, &((a, b), bound)) =
            slabs.iter().enumerate().max_by(|x, y| largest(x.1.1).total_cmp(&largest(y.1.1))).expect("there is a slab");
        if largest(bound) <= 1.05 * found {
            break;
        }
        let middle = (a + b) / 2.0;
        found = found.max(largest(over((middle, middle))));
        slabs[at] = ((a, middle), over((a, middle)));
        slabs.push(((middle, b), over((middle, b))));
    }
    slabs.into_iter().map(|(_, bound)| bound).fold([0.0; 2], larger)
}

/// How far a map that is affine in phases is off by errors of the phases, as a norm: Σ dcₖ Aₖ + dsₖ Bₖ, where the planes
/// of different phases are orthogonal if the map is; else the norms add.
pub(super) fn phase_error(section: &Section, domain: Region, error: impl Fn(&Start) -> Both) -> Both {
    let starts = section.starts();
    let mut run = Run::default();
    let mut map = |values: &[f64]| -> Matrix {
        let values: Vec<_> = values.iter().map(|&value| (value, 0.0)).collect();
        section.run(&values, starts, 0.0, &mut run);
        let [mid, _] = section.map(&run);
        mid
    };
    debug_assert_eq!(domain, Region::Circle);
    let zero = map(&vec![0.0; starts.len()]);
    // The derivative by a phase's part, wherever it stands.
    let mut derivative = |root: Root| -> Matrix {
        let values: Vec<f64> = starts.iter().map(|start| f64::from(u8::from(start.root == root))).collect();
        let mut matrix = map(&values);
        matrix.entries.iter_mut().zip(&zero.entries).for_each(|(x, y)| *x -= y);
        matrix
    };
    let mut multiples: Vec<(usize, Both)> = Vec::new();
    for start in starts {
        if let Root::Cos(k) | Root::Sin(k) = start.root
            && !multiples.iter().any(|(known, _)| *known == k)
        {
            multiples.push((k, error(start)));
        }
    }
    let pairs: Vec<[Matrix; 2]> =
        multiples.iter().map(|&(k, _)| [derivative(Root::Cos(k)), derivative(Root::Sin(k))]).collect();
    let norms: Vec<f64> = pairs
        .iter()
        .map(|[cos, sin]| {
            // The norm of cos ψ A + sin ψ B is a supremum of polynomials of degree one in ψ.
            let points = 64;
            let at = |i: usize| {
                let psi = std::f64::consts::TAU * i as f64 / points as f64;
                let entries = cos.entries.iter().zip(&sin.entries).map(|(a, b)| psi.cos() * a + psi.sin() * b);
                Matrix { columns: cos.columns, entries: entries.collect() }.norm()
            };
            (0..points).map(at).fold(0.0, f64::max) / (std::f64::consts::PI / points as f64).cos()
        })
        .collect();
    let apart = pairs
        .iter()
        .enumerate()
        .all(|(i, p)| pairs[..i].iter().all(|q| p.iter().all(|a| q.iter().all(|b| are_orthogonal(a, b)))));
    // Orthogonal to 1e-12 only: what they mix is added.
    let mixed = 1e-10 * multiples.iter().map(|(_, error)| error[0].max(error[1])).sum::<f64>();
    let each = multiples.iter().zip(&norms).map(|((_, error), norm)| error.map(|error| error * norm));
    match apart {
        true => each.fold([0.0; 2], larger).map(|error| error + mixed),
        false => each.fold([0.0; 2], |sum, error| [sum[0] + error[0], sum[1] + error[1]]),
    }
}

/// Whether AᵀB and ABᵀ vanish.
fn are_orthogonal(a: &Matrix, b: &Matrix) -> bool {
    let rows = a.entries.len() / a.columns;
    let columns = a.columns;
    let at = |m: &Matrix, i: usize, j: usize| m.entries[i * columns + j];
    let inner = (0..columns)
        .all(|i| (0..columns).all(|j| (0..rows).map(|k| at(a, k, i) * at(b, k, j)).sum::<f64>().abs() < 1e-12));
    let outer = (0..rows)
        .all(|i| (0..rows).all(|j| (0..columns).map(|k| at(a, i, k) * at(b, j, k)).sum::<f64>().abs() < 1e-12));
    inner && outer
}

/// At least the 2-norm of a section's exact map; infinite where it is not needed, for domains of several angles.
pub(super) fn exact_norm(section: &Section, domain: Region) -> f64 {
    if !matches!(domain, Region::Nothing | Region::Circle | Region::Arc(_) | Region::Small(_)) {
        return f64::INFINITY;
    }
    let exact: Vec<Start> =
        section.starts().iter().map(|start| Start { spread: 0.0, error: [0.0; 2], ..*start }).collect();
    let whole = |run: &Run| {
        let [mid, radius] = section.map(run);
        (mid, radius.frobenius())
    };
    // MᵀM − 1 is a polynomial of twice the degree: on a grid of eight points a degree of it, its bound is 1.09 times its
    // largest value there; the grid has sixteen for a degree of M.
    let defect = |run: &Run, _: usize, _: f64| {
        let (mid, radius) = whole(run);
        let mut gram = mid.gram();
        let columns = gram.columns;
        gram.entries.iter_mut().step_by(columns + 1).for_each(|x| *x -= 1.0);
        gram.frobenius() + 3.0 * radius * (1.0 + mid.frobenius())
    };
    let defect = 1.1 * sweep(section, domain, &exact, 0.0, 0.0, &defect)[0];
    let ideal = if defect < 1e-6 {
        (1.0 + defect).sqrt()
    } else {
        let norm = |run: &Run, _: usize, _: f64| {
            let (mid, radius) = whole(run);
            mid.norm() + radius
        };
        sweep(section, domain, &exact, 0.0, 0.0, &norm)[0]
    };
    // The phases are not quite of unit size: an error of each root by as much.
    let spread: Vec<Start> =
        exact.iter().zip(section.starts()).map(|(exact, start)| Start { error: [start.spread; 2], ..*exact }).collect();
    let weight = |run: &Run, mode: usize, enough: f64| section.weights(run, mode).weight_norm(enough);
    ideal + sweep(section, domain, &spread, 0.0, 0.0, &weight)[0]
}
