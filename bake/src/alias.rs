//! An alias table: which of many things a number picks, each as often as it weighs, at one look-up. It knows nothing of what
//! is picked.

/// A table of as many columns as there are things, all equally wide, each split between at most two of them (Walker 1974,
/// made by Vose's method of 1991).
#[derive(Clone, Debug, PartialEq)]
pub struct Alias {
    /// How much of a column is its own, from 0 to 1, and whose the rest is.
    columns: Vec<(f64, u32)>,
    /// What each weighs of all.
    shares: Vec<f64>,
}

impl Alias {
    /// Returns the table of weights; none if one is negative or not finite, all are zero, or there are 2³² or more.
    pub fn new(weights: &[f64]) -> Option<Self> {
        let total: f64 = weights.iter().sum();
        let is_sound = weights.iter().all(|&weight| weight >= 0.0) && total > 0.0 && total.is_finite();
        if !is_sound || u32::try_from(weights.len()).is_err() {
            return None;
        }
        let shares: Vec<f64> = weights.iter().map(|weight| weight / total).collect();
        let mut left: Vec<f64> = shares.iter().map(|share| share * weights.len() as f64).collect();
        let mut columns: Vec<(f64, u32)> = (0..weights.len()).map(|i| (1.0, i as u32)).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..left.len()).partition(|&i| left[i] < 1.0);
        while let (Some(&above), Some(below)) = (large.last(), small.pop()) {
            columns[below] = (left[below], above as u32);
            left[above] -= 1.0 - left[below];
            if left[above] < 1.0 {
                large.pop();
                small.push(above);
            }
        }
        // Of what rounding has left over a column is its own, unless it weighs nothing.
        for i in small.into_iter().filter(|&i| shares[i] == 0.0) {
            let heaviest = (0..shares.len()).max_by(|&a, &b| shares[a].total_cmp(&shares[b])).unwrap_or(i);
            columns[i] = (0.0, heaviest as u32);
        }
        Some(Self { columns, shares })
    }

    /// Returns what a number from 0 to 1 picks. Numbers that are spread evenly pick evenly.
    pub fn pick(&self, at: f64) -> usize {
        let place = at.clamp(0.0, 1.0) * self.columns.len() as f64;
        let column = (place as usize).min(self.columns.len() - 1);
        let (own, other) = self.columns[column];
        if place - (column as f64) < own { column } else { other as usize }
    }

    /// Returns how likely one is picked: its share of all weights.
    pub fn share(&self, i: usize) -> f64 {
        self.shares[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;

    #[test]
    fn what_the_columns_hold_is_what_was_weighed() {
        let mut random = Random::new(8);
        let heavy: Vec<f64> = (0..1000).map(|i| if i % 97 == 3 { 1e6 } else { random.signed().max(0.0) }).collect();
        for weights in [vec![3.0], vec![1.0; 7], vec![0.0, 5.0, 0.0, 1e-9], heavy] {
            let table = Alias::new(&weights).expect("sound");
            let mut held = vec![0.0; weights.len()];
            for (i, &(own, other)) in table.columns.iter().enumerate() {
                assert!((0.0..=1.0).contains(&own));
                held[i] += own;
                held[other as usize] += 1.0 - own;
            }
            let total: f64 = weights.iter().sum();
            for (i, (held, weight)) in held.iter().zip(&weights).enumerate() {
                let (held, wanted) = (held / weights.len() as f64, weight / total);
                // A column is rounded once for every thing that it was filled up from: a thousand times 1e-16 of a column.
                assert!((held - wanted).abs() < 1e-13, "{held} {wanted}");
                assert!(*weight > 0.0 || held == 0.0, "{i} weighs nothing and is picked");
                assert_eq!(table.share(i), wanted);
            }
        }
    }

    #[test]
    fn even_numbers_pick_as_often_as_things_weigh() {
        let weights: Vec<f64> = (0..40).map(|i| f64::from(i * i)).collect();
        let (table, count) = (Alias::new(&weights).expect("sound"), 400_000);
        let mut found = vec![0.0; weights.len()];
        (0..count).for_each(|i| found[table.pick((f64::from(i) + 0.5) / f64::from(count))] += 1.0 / f64::from(count));
        let total: f64 = weights.iter().sum();
        for (found, weight) in found.iter().zip(&weights) {
            // Each column's split falls between two numbers: 40 columns err by half a step each at most.
            assert!((found - weight / total).abs() <= 20.5 / f64::from(count), "{found} {}", weight / total);
        }
        // What is no such number picks what the ends pick.
        assert_eq!((table.pick(-1.0), table.pick(2.0)), (table.pick(0.0), table.pick(1.0)));
    }

    #[test]
    fn weights_that_make_no_sense_are_refused() {
        for weights in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[f64::NAN, 1.0], &[f64::INFINITY]] {
            assert_eq!(Alias::new(weights), None, "{weights:?}");
        }
    }
}
