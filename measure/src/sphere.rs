//! A sphere as pictures of reflectances show it, seen from the front without perspective, the world's z up.

use zonal_picture::vector::{cross, dot, unit};

/// Three axes, z the normal.
pub type Axes = [[f64; 3]; 3];

/// A square picture of a sphere.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    /// Pixels along a side.
    pub side: usize,
}

impl Tile {
    /// Returns the axes of the surface that a pixel shows, x along the parallels, and the direction to the eye in them; none
    /// beside the sphere.
    pub fn surface(self, x: usize, y: usize) -> Option<(Axes, [f64; 3])> {
        let place = |i: usize| (2 * i + 1) as f64 / self.side as f64 - 1.0;
        let [across, up] = [1.04 * place(x), -1.04 * place(y)];
        let depth = 1.0 - across * across - up * up;
        let z = [across, -depth.max(0.0).sqrt(), up];
        let x = unit(cross([0.0, 0.0, 1.0], z)).unwrap_or([1.0, 0.0, 0.0]);
        let axes = [x, cross(z, x), z];
        (depth > 0.0).then(|| (axes, axes.map(|axis| dot(axis, [0.0, -1.0, 0.0]))))
    }
}

/// A difference as a colour, linear, from black at 0 to white at 1.
pub fn heat(share: f64) -> [f64; 3] {
    let share = share.clamp(0.0, 1.0);
    [share.sqrt(), share, share * share * share]
}
