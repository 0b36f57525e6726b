//! The directions that a search may take: at the roots of Legendre functions and at fractions of a turn, with what the basis
//! is made of there.

use super::task::Task;
use crate::families::zhf::lobes::{Lobe, lobe_values};
use crate::math::exact::Exact;
use crate::threads;

/// A direction of the grid: the index of its height, and its azimuth as a fraction of π.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Direction {
    pub height: usize,
    pub numerator: usize,
    pub denominator: usize,
}

pub const POLE: usize = 0;
pub const EQUATOR: usize = 1;

/// Every direction that a search may take, with what the basis is made of there.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The bands that the search is of.
    pub bands: std::ops::Range<usize>,
    /// The heights as [`Lobe`] writes them; the pole, the equator, then the roots.
    pub heights: Vec<String>,
    /// For each height and band the part of y_l^m that does not depend on the azimuth, m from 0.
    polar: Vec<Vec<Vec<f64>>>,
    /// For each denominator the (cosine, sine) of each multiple of π through it, up to 2π.
    pub turns: Vec<Vec<[f64; 2]>>,
}

impl Grid {
    pub fn new(task: &Task) -> Self {
        let bands = task.mode.bands(task.size);
        let top = bands.end - 1;
        let mut known: Vec<Exact> = Vec::new();
        let mut heights = vec!["pole".to_owned(), "equator".to_owned()];
        for l in 2..=top {
            for (m, rank) in (0..l).flat_map(|m| (1..=(l - m) / 2).map(move |rank| (m, rank))) {
                let name = format!("P{l},{m}#{rank}");
                let [_, _, z] = lobe(&format!("{name} 0")).xyz();
                if !known.contains(&z) {
                    known.push(z);
                    heights.push(name);
                }
            }
        }
        let polar = threads::map(&heights, |name| {
            let text = if name == "pole" { name.clone() } else { format!("{name} 0") };
            let lobes = [lobe(&text)];
            // At azimuth 0 the cosines are one and the sines zero.
            let of = |l: usize| lobe_values(l, &lobes)[0][l..].iter().map(Exact::to_f64).collect();
            (0..=top).map(of).collect()
        });
        let turn = |d: usize| -> Vec<[f64; 2]> {
            let at =
                |k: usize| [Exact::cos_pi(k as i64, d as i64), Exact::sin_pi(k as i64, d as i64)].map(|x| x.to_f64());
            (0..2 * d).map(at).collect()
        };
        let turns = threads::map(1..=2 * top.max(2), turn);
        Self { bands, heights, polar, turns }
    }

    pub fn name(&self, direction: &Direction) -> String {
        let Direction { height, numerator, denominator } = *direction;
        let name = &self.heights[height];
        match (height, denominator) {
            (POLE, _) => name.clone(),
            (_, 1) => format!("{name} {numerator}"),
            _ => format!("{name} {numerator}/{denominator}"),
        }
    }

    /// The direction in lowest terms; the equator's are those of half a turn, since opposite directions are one.
    pub fn direction(&self, height: usize, numerator: usize, denominator: usize) -> Direction {
        if height == POLE {
            return Direction { height, numerator: 0, denominator: 1 };
        }
        let whole = if height == EQUATOR { denominator } else { 2 * denominator };
        let numerator = numerator % whole;
        let common = num_integer::gcd(numerator, denominator);
        Direction { height, numerator: numerator / common, denominator: denominator / common }
    }

    /// y_l^m at a direction, m from −l to l.
    pub fn row(&self, l: usize, direction: &Direction) -> Vec<f64> {
        let polar = &self.polar[direction.height][l];
        let turns = &self.turns[direction.denominator - 1];
        let mut row = vec![0.0; 2 * l + 1];
        for m in 0..=l {
            let [cos, sin] = turns[m * direction.numerator % turns.len()];
            row[l - m] = polar[m] * sin;
            row[l + m] = polar[m] * cos;
        }
        row
    }
}

fn lobe(text: &str) -> Lobe {
    text.parse().expect("the grid names directions")
}
