//! The light of each band as a cubemap, from which a shader reads what a turned band is at a direction (Nowrouzezahrai et al.
//! 2012, equation 11): three halves a texel, filtered linearly. Made and read here for this page alone.

use half::f16;
use std::f64::consts::PI;
use zonal_codegen::environment::harmonics::basis;
use zonal_picture::vector::dot;

/// By how much a read may err, relative to the band's largest value: l² h²/4 of a step of h radians.
pub const ERROR: f64 = 0.01;

/// The axes to the right and downwards of a face, and its own: +x, −x, +y, −y, +z, −z as graphics interfaces have them.
const FACES: [[[f64; 3]; 3]; 6] = [
    [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
    [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
];

/// The cube of a band.
#[derive(Clone, Debug)]
pub struct Cube {
    /// The texels along a side.
    pub side: usize,
    /// Face by face, row by row from the top: R, G, B and nothing.
    pub texels: Vec<[f16; 4]>,
}

/// A band of a light in a direction.
pub fn band(e: &[[f64; 3]], l: usize, direction: [f64; 3]) -> [f64; 3] {
    let mut values = vec![0.0; (l + 1) * (l + 1)];
    basis(l + 1, direction, &mut values);
    let range = l * l..(l + 1) * (l + 1);
    let of = |k: usize| values[range.clone()].iter().zip(&e[range.clone()]).map(|(y, e)| y * e[k]).sum();
    [0, 1, 2].map(of)
}

/// The smallest side with which band l errs by no more than [`ERROR`].
pub fn side(l: usize) -> usize {
    let step = 2.0 * ERROR.sqrt() / l as f64;
    if l == 0 { 1 } else { (PI / 2.0 / step).ceil() as usize }
}

impl Cube {
    /// Returns the cube of a band of a light.
    pub fn new(e: &[[f64; 3]], l: usize) -> Self {
        let side = side(l);
        let texel = |i: usize| {
            let [right, down, out] = FACES[i / (side * side)];
            let place = |at: usize| (2 * at + 1) as f64 / side as f64 - 1.0;
            let (u, v) = (place(i % side), place(i / side % side));
            let direction: [f64; 3] = std::array::from_fn(|k| out[k] + u * right[k] + v * down[k]);
            let length = dot(direction, direction).sqrt();
            let [r, g, b] = band(e, l, direction.map(|x| x / length)).map(f16::from_f64);
            [r, g, b, f16::ZERO]
        };
        Self { side, texels: (0..6 * side * side).map(texel).collect() }
    }

    /// Returns the face that a direction of any length lies in, and where, right and down from −1 to 1.
    fn place(direction: [f64; 3]) -> (usize, [f64; 2]) {
        let depth = |face: usize| dot(FACES[face][2], direction);
        let face = (0..6).max_by(|&a, &b| depth(a).total_cmp(&depth(b))).unwrap_or(0);
        let [right, down, _] = FACES[face];
        (face, [right, down].map(|axis| dot(axis, direction) / depth(face)))
    }

    /// Returns a texel by its column and row; beyond a face's border that of the neighbour whose direction is nearest.
    fn texel(&self, face: usize, at: [isize; 2]) -> [f16; 4] {
        let side = self.side as isize;
        let inside = |v: isize| (0..side).contains(&v);
        let middle = |v: isize| (2 * v + 1) as f64 / side as f64 - 1.0;
        let (face, [x, y]) = match at {
            [x, y] if inside(x) && inside(y) => (face, [x, y]),
            [x, y] => {
                let ([right, down, out], u, v) = (FACES[face], middle(x), middle(y));
                let (face, place) = Self::place(std::array::from_fn(|k| out[k] + u * right[k] + v * down[k]));
                (face, place.map(|v| (((v + 1.0) * 0.5 * side as f64) as isize).clamp(0, side - 1)))
            }
        };
        self.texels[(face * self.side + y as usize) * self.side + x as usize]
    }

    /// Returns what a linear filter reads in a direction, over the cube's edges too.
    pub fn read(&self, direction: [f64; 3]) -> [f64; 3] {
        let (face, place) = Self::place(direction);
        let [(x, across), (y, along)] = place.map(|v| {
            let place = (v + 1.0) * 0.5 * self.side as f64 - 0.5;
            (place.floor() as isize, place - place.floor())
        });
        let mut sum = [0.0; 3];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = (if dx == 0 { 1.0 - across } else { across }) * (if dy == 0 { 1.0 - along } else { along });
            let texel = self.texel(face, [x + dx, y + dy]);
            (0..3).for_each(|k| sum[k] += weight * texel[k].to_f64());
        }
        sum
    }

    /// How many bytes it takes, three halves a texel.
    pub fn bytes(&self) -> usize {
        6 * self.texels.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::promise::samples::Random;

    #[test]
    fn a_read_errs_by_what_the_side_is_made_for() {
        let mut random = Random::new(6);
        for l in [0, 1, 3, 6] {
            let e: Vec<[f64; 3]> = (0..(l + 1) * (l + 1)).map(|_| [(); 3].map(|()| random.signed())).collect();
            let (cube, mut worst, mut most) = (Cube::new(&e, l), 0.0f64, 0.0f64);
            for _ in 0..2000 {
                let direction = random.unit::<3>();
                let (found, wanted) = (cube.read(direction), band(&e, l, direction));
                for k in 0..3 {
                    (worst, most) = (worst.max((found[k] - wanted[k]).abs()), most.max(wanted[k].abs()));
                }
            }
            // Over an edge the texels of both faces do not lie on one grid: some times what is inside.
            let allowed = if l == 0 { 1e-3 } else { 5.0 * ERROR };
            assert!(worst <= allowed * most, "band {l}: {worst} of {most}, side {}", cube.side);
        }
    }
}
