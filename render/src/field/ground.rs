//! A height field over a square, of hills and hollows where a seed puts them: its heights, its normals, and how high the sky
//! begins in a direction. It knows nothing of light.

use zonal_codegen::promise::samples::Random;

/// How many hills and hollows there are.
const HILLS: usize = 90;
/// How much further each step of a march to the horizon goes.
const GROWTH: f64 = 1.09;

/// Heights at the middles of the cells of a square from −1 to 1.
pub struct Ground {
    /// The cells along a side.
    pub side: usize,
    heights: Vec<f64>,
    slopes: Vec<[f64; 2]>,
}

impl Ground {
    /// Returns the field of a seed with so many cells along a side.
    pub fn new(seed: u64, side: usize) -> Self {
        let mut random = Random::new(seed);
        // The smaller the more of them, and the lower.
        let hills: Vec<([f64; 2], f64, f64)> = (0..HILLS)
            .map(|i| {
                let width = 0.45 / (1.0 + 0.1 * i as f64);
                ([random.signed(), random.signed()], width, 0.38 * width * random.signed())
            })
            .collect();
        let (mut heights, mut slopes) = (vec![], vec![]);
        for i in 0..side * side {
            let [x, y] = place(side, i);
            let (mut height, mut slope) = (0.0, [0.0; 2]);
            for &([at, to], width, high) in &hills {
                let [dx, dy] = [(x - at) / width, (y - to) / width];
                let bump = high * (-dx * dx - dy * dy).exp();
                height += bump;
                slope[0] -= 2.0 * dx / width * bump;
                slope[1] -= 2.0 * dy / width * bump;
            }
            heights.push(height);
            slopes.push(slope);
        }
        Self { side, heights, slopes }
    }

    /// Returns the unit normal of a point.
    pub fn normal(&self, point: usize) -> [f64; 3] {
        let [x, y] = self.slopes[point];
        let length = (1.0 + x * x + y * y).sqrt();
        [-x / length, -y / length, 1.0 / length]
    }

    /// Returns the field with all heights and slopes zero.
    #[must_use]
    pub fn levelled(&self) -> Self {
        Self { side: self.side, heights: vec![0.0; self.heights.len()], slopes: vec![[0.0; 2]; self.slopes.len()] }
    }

    /// Between the middles of cells linear, beyond the border as at it.
    fn height(&self, at: [f64; 2]) -> f64 {
        let last = self.side - 1;
        let [(x, right), (y, down)] = at.map(|v| {
            let place = ((v + 1.0) * 0.5 * self.side as f64 - 0.5).clamp(0.0, last as f64);
            let low = (place as usize).min(last.saturating_sub(1));
            (low, place - low as f64)
        });
        let (next, below) = ((x + 1).min(last), (y + 1).min(last));
        let row = |y: usize| {
            let [a, b] = [x, next].map(|x| self.heights[y * self.side + x]);
            a + right * (b - a)
        };
        row(y) + down * (row(below) - row(y))
    }

    /// Returns the sine of the elevation at which the sky begins over a point in the direction of an azimuth in radians: that of
    /// the surface itself, or of what is higher.
    pub fn horizon(&self, point: usize, azimuth: f64) -> f64 {
        let (sin, cos) = azimuth.sin_cos();
        let ([x, y], own, slope) = (place(self.side, point), self.heights[point], self.slopes[point]);
        let mut most = slope[0] * cos + slope[1] * sin;
        let mut away = 2.0 / self.side as f64;
        while away < 2.0 {
            let at = [x + away * cos, y + away * sin];
            if at.iter().any(|v| v.abs() > 1.0) {
                break;
            }
            most = most.max((self.height(at) - own) / away);
            away *= GROWTH;
        }
        most / (1.0 + most * most).sqrt()
    }
}

/// Where a cell's middle lies, x to the right and y upwards in a picture, whose first row is the upper.
pub fn place(side: usize, point: usize) -> [f64; 2] {
    let middle = |i: usize| (2 * i + 1) as f64 / side as f64 - 1.0;
    [middle(point % side), middle(point / side)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_heights_and_the_sky_begins_above_the_surface() {
        let ground = Ground::new(3, 128);
        let step = 2.0 / 128.0;
        for point in [40 * 128 + 31, 77 * 128 + 90, 12 * 128 + 100] {
            let difference = (ground.heights[point + 1] - ground.heights[point - 1]) / (2.0 * step);
            // Second order in a step of a sixty-fourth of the side, for hills that are a twentieth wide.
            assert!((difference - ground.slopes[point][0]).abs() < 0.1, "{difference} {:?}", ground.slopes[point]);
            for k in 0..8 {
                let azimuth = 0.8 * f64::from(k);
                let slope = ground.slopes[point][0] * azimuth.cos() + ground.slopes[point][1] * azimuth.sin();
                let sine = ground.horizon(point, azimuth);
                assert!(sine >= slope / (1.0 + slope * slope).sqrt() - 1e-12 && sine < 1.0);
            }
        }
        // Somewhere another hill is in the way.
        let hidden = |point: usize| {
            let [x, _] = ground.slopes[point];
            ground.horizon(point, 0.0) > x / (1.0 + x * x).sqrt() + 0.1
        };
        assert!((0..128 * 128).filter(|&point| hidden(point)).count() > 500);
    }
}
