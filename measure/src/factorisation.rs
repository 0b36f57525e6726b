//! The sparse zonal factorisation of Nowrouzezahrai et al. 2012, its Tables I and II with ours beside: non-zeros of Â,
//! conditions of Y, operations (docs/MATH.md#zonal-factorisation).

use crate::papers::TABLE_2;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
// Names a family: its lobes are what is measured.
use zonal_codegen::families::zhf::lobes::{self, Lobe, LobeSet, Mode};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::tables::x90;

/// One band with lobes of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// The band.
    pub l: usize,
    /// The non-zeros of Â.
    pub nonzeros: usize,
    /// The condition number of Y.
    pub condition: f64,
    /// The non-zeros of each row of Â: the lobes of each function, m = −l to l.
    pub lobes: Vec<usize>,
    /// The seed of the search that found the set, and which of its tries.
    pub found: [usize; 2],
}

/// An order whose bands share 2n − 1 lobes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shared {
    /// The order.
    pub order: usize,
    /// Whether a band takes any 2l + 1 of the lobes, or the first.
    pub free: bool,
    /// The non-zeros of Â in each band.
    pub nonzeros: Vec<usize>,
    /// The condition number of each band's Y.
    pub conditions: Vec<f64>,
}

impl Shared {
    /// The non-zeros in the bands from 2 on.
    pub fn from_band_2(&self) -> usize {
        self.nonzeros.iter().skip(2).sum()
    }

    /// The percentage of zeros in all bands.
    pub fn sparsity(&self) -> f64 {
        let entries: usize = (0..self.order).map(|l| (2 * l + 1).pow(2)).sum();
        100.0 * (1.0 - self.nonzeros.iter().sum::<usize>() as f64 / entries as f64)
    }

    /// The largest condition number of any band.
    pub fn condition(&self) -> f64 {
        self.conditions.iter().copied().fold(0.0, f64::max)
    }
}

/// All lobe sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factorisation {
    /// Bands 2 to 10.
    pub bands: Vec<Band>,
    /// Orders 3 to 10, nested and free.
    pub shared: Vec<Shared>,
    /// For each order of Table II the non-zeros of a 90 degree rotation about x in the bands from 2 on.
    pub x_nonzeros: Vec<usize>,
}

/// The percentage of zeros in Â of a band.
pub fn sparsity(l: usize, nonzeros: usize) -> f64 {
    100.0 * (1.0 - nonzeros as f64 / (2 * l + 1).pow(2) as f64)
}

fn rows(a_hat: &[Vec<Exact>]) -> Vec<usize> {
    a_hat.iter().map(|row| row.iter().filter(|x| !x.is_zero()).count()).collect()
}

fn condition_of(l: usize, lobes: &[Lobe]) -> f64 {
    significant(lobes::band_condition(l, lobes))
}

fn band(l: &usize) -> Band {
    let lobes = lobes::single_band(*l).expect("bands 2 to 10 have lobes");
    let lobes_of = rows(&lobes::a_hat(*l, lobes).expect("the lobes are independent"));
    let record = lobes::chosen(Mode::Band, *l).expect("bands 2 to 10 have lobes");
    Band {
        l: *l,
        nonzeros: lobes_of.iter().sum(),
        condition: condition_of(*l, lobes),
        lobes: lobes_of,
        found: [record.seed as usize, record.attempt],
    }
}

fn shared(free: bool, set: &LobeSet) -> Shared {
    Shared {
        order: set.order,
        free,
        nonzeros: (0..set.order).map(|l| rows(set.a_hat(l)).iter().sum()).collect(),
        conditions: (0..set.order).map(|l| condition_of(l, &set.lobes(l))).collect(),
    }
}

fn x_nonzeros(order: usize) -> usize {
    let entries = |l: usize| {
        let orders = move || -(l as isize)..=l as isize;
        orders().flat_map(move |a| orders().map(move |b| x90(l, a, b, 1))).filter(|x| !x.is_zero()).count()
    };
    (2..order).map(entries).sum()
}

/// Every lobe set.
pub fn measure(progress: &dyn Progress) -> Factorisation {
    let bands: Vec<usize> = (2..=10).collect();
    let bands = each(progress, "lobes of single bands", &bands, band);
    let sets: Vec<(bool, &LobeSet)> = (3..=10)
        .flat_map(|order| [(false, lobes::shared(order)), (true, lobes::shared_free(order))])
        .filter_map(|(free, set)| set.map(|set| (free, set)))
        .collect();
    let shared = each(progress, "shared lobes", &sets, |(free, set)| shared(*free, set));
    Factorisation { bands, shared, x_nonzeros: TABLE_2.iter().map(|column| x_nonzeros(column.order)).collect() }
}
