//! Bounds of what is not cut into parts: values that are sums over bands, maps that mix bands, and bands that something is
//! added to.

use crate::ir::kernel::Shape;
use crate::ir::listing::Operand;
use crate::promise::bound::norm::{Matrix, SLACK};
use crate::promise::bound::prover::Prover;
use crate::promise::bound::region::Region;
use crate::promise::bound::roundoff::{Both, larger_of};
use crate::promise::bound::section::{Run, Section};
use crate::promise::bound::sweep::sweep;
use std::ops::Range;

impl Prover<'_> {
    /// Values, each linear in coefficients of which each band has norm one.
    pub(super) fn sum(&self, bands: &[usize]) -> Option<Both> {
        self.at_once(|section, run, mode, _| {
            let weights = section.weights(run, mode);
            let value = |mut rest: &[f64]| {
                let mut sum = 0.0;
                for l in bands {
                    let (band, others) = rest.split_at(2 * l + 1);
                    sum += band.iter().map(|w| w * w).sum::<f64>().sqrt();
                    rest = others;
                }
                sum * SLACK
            };
            weights.rows().map(value).fold(0.0, larger_of)
        })
    }

    /// The whole result as a vector, for a signal of norm one.
    pub(super) fn vector(&self) -> Option<Both> {
        self.at_once(|section, run, mode, enough| section.weights(run, mode).weight_norm(enough))
    }

    /// A measure of all results that are linear in the coefficients, at its largest within the domain.
    fn at_once(&self, measure: impl Fn(&Section, &Run, usize, f64) -> f64 + Sync) -> Option<Both> {
        let inputs = self.coefficients();
        let outputs: Vec<Operand> =
            self.listing.outputs.iter().copied().filter(|&output| self.is_signal(output)).collect();
        let (_, scalars) = self.cone(&inputs, &outputs)?;
        let (domain, _) = self.domain(scalars)?;
        let section = Section::new(self.listing, domain, &inputs, &outputs, |operand| self.start(operand))?;
        let measure = |run: &Run, mode: usize, enough: f64| measure(&section, run, mode, enough);
        Some(sweep(&section, domain, section.starts(), self.roundoff, 0.0, &measure))
    }

    /// The errors of bands to each of which something is added, for bands of norm one and for numbers of size one that
    /// what is added is linear in: the signals that are single numbers.
    pub(super) fn added(&self) -> Option<Vec<Both>> {
        let (sizes, all): (Vec<Operand>, Vec<Operand>) = self.coefficients().into_iter().partition(|operand| {
            matches!(operand, Operand::Input { param, .. } if self.listing.params[*param].shape == Shape::Scalar)
        });
        let band = |l: usize| {
            let places = l * l..(l + 1) * (l + 1);
            let inputs = [&sizes[..], &all[places.clone()]].concat();
            let outputs = &self.listing.outputs[places];
            let (_, scalars) = self.cone(&inputs, outputs)?;
            let (domain, _) = self.domain(scalars)?;
            let section = Section::new(self.listing, domain, &inputs, outputs, |operand| self.start(operand))?;
            let measure = |run: &Run, mode: usize, _: f64| {
                let weights = section.weights(run, mode);
                let norm = |columns: Range<usize>| {
                    let rows = (0..outputs.len()).flat_map(|row| weights.row(row)[columns.clone()].iter().copied());
                    Matrix { columns: columns.len(), entries: rows.collect() }.weight_norm(0.0)
                };
                let of_sizes: f64 = (0..sizes.len()).map(|column| norm(column..column + 1)).sum();
                (of_sizes + norm(sizes.len()..inputs.len())) * SLACK
            };
            Some(sweep(&section, domain, section.starts(), self.roundoff, 0.0, &measure))
        };
        (0..self.spec.order).map(band).collect()
    }

    /// The errors of a constant map that mixes bands, for bands of norm one.
    pub(super) fn mixed(&self) -> Option<Vec<Both>> {
        let (inputs, places) = (self.coefficients(), |l: usize| l * l..(l + 1) * (l + 1));
        let band = |l: usize| {
            let outputs = &self.listing.outputs[places(l)];
            let section = Section::new(self.listing, Region::Nothing, &inputs, outputs, |_| None)?;
            let measure = |run: &Run, mode: usize, _: f64| {
                let weights = section.weights(run, mode);
                let of = |from: usize| -> f64 {
                    let rows = (0..outputs.len()).flat_map(|row| weights.row(row)[places(from)].iter().copied());
                    Matrix { columns: 2 * from + 1, entries: rows.collect() }.weight_norm(0.0)
                };
                (0..self.spec.order).map(of).sum::<f64>() * SLACK
            };
            Some(sweep(&section, Region::Nothing, &[], self.roundoff, 0.0, &measure))
        };
        (0..self.spec.order).map(band).collect()
    }
}
