//! Signals from what they are of: samples, a function of directions, an image by latitude and longitude, a cubemap.
//!
//! Coefficients are c_{l,m} = ∫ f y_l^m over the sphere, in the frame of the directions, or for [`in_frame`] and what is named
//! after it in that of a surface. Sums are of f in the precision of
//! the coefficients, by runs and with what each addition loses, so that a million texels round as few do. The
//! module `parallel`, with the feature `rayon`, has all but single sums of samples over threads, with the same results to the
//! last bit.

use zonal_kernels::real::{Real, Signal};

use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::grid;
use crate::scalar::Element;
use crate::surface::Frame;

/// How many terms are summed before they are added to the others.
const RUN: usize = 64;

/// A sum of samples: of a run of them as it is, of runs with what additions lose (Kahan 1965).
#[derive(Clone, Copy)]
struct Sum<C> {
    run: C,
    length: usize,
    whole: C,
    lost: C,
}

impl<C: Coefficients> Sum<C> {
    fn new() -> Self {
        Self { run: C::zero(), length: 0, whole: C::zero(), lost: C::zero() }
    }

    /// Adds a value in a direction, times a weight.
    #[inline]
    fn sample(&mut self, dir: [C::Scalar; 3], value: C::Element, weight: C::Scalar) {
        self.sample_of(&C::basis(dir), value, weight);
    }

    /// Adds a value where functions have these values, times a weight.
    #[inline]
    fn sample_of(&mut self, basis: &C::Basis, value: C::Element, weight: C::Scalar) {
        let value = value.signal() * weight;
        for (sum, y) in self.run.as_mut().iter_mut().zip(basis.as_ref()) {
            *sum = C::Element::element(value.fma(*y, sum.signal()));
        }
        self.length += 1;
        if self.length == RUN {
            self.end_run();
        }
    }

    fn end_run(&mut self) {
        let run = core::mem::replace(&mut self.run, C::zero());
        self.length = 0;
        self.add(&run);
    }

    /// Adds a sum.
    fn add(&mut self, part: &C) {
        let terms = part.as_ref().iter().zip(self.whole.as_mut()).zip(self.lost.as_mut());
        for ((part, whole), lost) in terms {
            let (before, term) = (whole.signal(), part.signal() - lost.signal());
            let after = before + term;
            *lost = C::Element::element((after - before) - term);
            *whole = C::Element::element(after);
        }
    }

    fn end(mut self) -> C {
        self.end_run();
        self.whole
    }
}

/// Returns the sum of parts.
fn total<C: Coefficients>(parts: impl Iterator<Item = C>) -> C {
    let mut sum = Sum::new();
    parts.for_each(|part| sum.add(&part));
    sum.end()
}

/// Returns the sum over some directions, which all have one weight.
fn row<C: Coefficients>(texels: impl Iterator<Item = ([f64; 3], C::Element)>, weight: f64) -> C {
    let (mut sum, weight) = (Sum::new(), C::Scalar::lit(weight));
    texels.for_each(|(dir, value)| sum.sample(dir.map(C::Scalar::lit), value, weight));
    sum.end()
}

/// Projects samples: directions of unit length, the values there, and the solid angle in steradians that each stands for.
///
/// The solid angles of samples that are spread over the sphere are 4π together: of N evenly spread or uniformly random
/// ones 4π/N each, and of random ones by a density p per steradian 1/(N p).
///
/// ```
/// use core::f32::consts::PI;
///
/// // Six directions along the axes integrate what has up to three bands together exactly.
/// let axes = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
/// let seen = axes.map(|dir: [f32; 3]| (dir, 1.0 + dir[2], 4.0 * PI / 6.0));
/// let c: [f32; 4] = zonal::project::samples(seen);
/// assert!((zonal::evaluate([0.0, 0.6, 0.8], &c) - 1.8).abs() < 1e-6);
/// ```
pub fn samples<C, D>(samples: impl IntoIterator<Item = (D, C::Element, C::Scalar)>) -> C
where
    C: Coefficients,
    D: Into<[C::Scalar; 3]>,
{
    let mut sum = Sum::new();
    samples.into_iter().for_each(|(dir, value, weight)| sum.sample(dir.into(), value, weight));
    sum.end()
}

/// Projects samples as [`samples`] does, in the frame of a surface: directions are those of the world, coefficients those of
/// the frame, which [`h4`](crate::h4), [`h6`](crate::h6) and [`irradiance`](crate::irradiance) take for its normal map.
///
/// What lies below the horizon of the surface is hidden by it: whoever bakes leaves it out.
///
/// ```
/// use core::f32::consts::PI;
///
/// // A wall that looks along x and is lit from there: a light in its frame's z.
/// let frame = zonal::Frame::<f32>::new([1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 1.0]);
/// let c: [f32; 9] = zonal::project::in_frame(&frame, [([1.0, 0.0, 0.0], 2.0, 0.5)]);
/// let up: [f32; 9] = zonal::evaluate_basis([0.0, 0.0, 1.0]);
/// assert_eq!(c, up);
/// // Its irradiance is the radiance times the solid angle, but for the bands that order 3 lacks.
/// assert!((zonal::irradiance_at([0.0, 0.0, 1.0], &c) - 1.0).abs() < 0.07);
/// ```
pub fn in_frame<C, D>(frame: &Frame<C::Scalar>, samples: impl IntoIterator<Item = (D, C::Element, C::Scalar)>) -> C
where
    C: Coefficients,
    D: Into<[C::Scalar; 3]>,
{
    let mut sum = Sum::new();
    samples.into_iter().for_each(|(dir, value, weight)| sum.sample(frame.to_local(dir), value, weight));
    sum.end()
}

/// Projects samples on the hemispherical harmonics of a surface's frame (Gautron et al. 2004): index l(l+1)+m,
/// orthonormal over the directions above its horizon (docs/MATH.md#hemispherical-harmonics). Samples below it count as none.
///
/// ```
/// // Radiance 1 above the horizon is the constant alone.
/// let frame = zonal::Frame::<f64>::new([0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]);
/// let weight = core::f64::consts::PI / 4.0;
/// let four = [[0.6, 0.0, 0.8], [-0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, -0.6, 0.8]].map(|dir| (dir, 1.0, weight));
/// let below = [([0.0, 0.0, -1.0], 9.0, 1.0)];
/// let c: [f64; 4] = zonal::project::on_hemisphere(&frame, four.into_iter().chain(below));
/// assert!((c[0] - (0.5 * core::f64::consts::PI).sqrt()).abs() < 1e-12 && c[1].abs() < 1e-12);
/// ```
pub fn on_hemisphere<C, D>(frame: &Frame<C::Scalar>, samples: impl IntoIterator<Item = (D, C::Element, C::Scalar)>) -> C
where
    C: Coefficients,
    D: Into<[C::Scalar; 3]>,
{
    let mut sum = Sum::new();
    for (dir, value, weight) in samples {
        let dir = frame.to_local(dir);
        if dir[2] > C::Scalar::zero() {
            sum.sample_of(&C::hemisphere_basis(dir), value, weight);
        }
    }
    sum.end()
}

/// Refuses slices of different lengths.
fn check_frames(frames: usize, results: usize) -> Result<(), Error> {
    if frames == results { Ok(()) } else { Err(Error::Frames { frames, results }) }
}

/// Projects the samples of many points of surfaces into `results`, each in its frame: `samples(i)` are those of frame i, and
/// `one` is [`in_frame`] or [`on_hemisphere`], or one of them with what makes its results out of coefficients.
///
/// # Errors
///
/// If there are not as many results as frames.
///
/// ```
/// use zonal::{Frame, project};
///
/// let frames = [Frame::<f32>::new([0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]); 2];
/// let light = |i: usize| [([0.0_f32, 0.0, 1.0], 1.0 + i as f32, 0.1)];
/// // Six coefficients a texel of a lightmap.
/// let texel = |frame: &Frame<f32>, light| {
///     let radiance: [f32; 25] = project::in_frame(frame, light);
///     zonal::h6(&radiance)
/// };
/// let mut texels = [[0.0; 6]; 2];
/// project::in_frames(&frames, light, texel, &mut texels)?;
/// assert_eq!(texels[1], texels[0].map(|c| 2.0 * c));
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn in_frames<T, S, R>(
    frames: &[Frame<T>],
    mut samples: impl FnMut(usize) -> S,
    mut one: impl FnMut(&Frame<T>, S) -> R,
    results: &mut [R],
) -> Result<(), Error> {
    check_frames(frames.len(), results.len())?;
    for (i, (frame, result)) in frames.iter().zip(results).enumerate() {
        *result = one(frame, samples(i));
    }
    Ok(())
}

fn function_row<C: Coefficients>(rows: usize, at: usize, f: &mut impl FnMut([C::Scalar; 3]) -> C::Element) -> C {
    let (directions, weight) = grid::exact(rows, at);
    row(directions.map(|dir| (dir, f(dir.map(C::Scalar::lit)))), weight)
}

/// Projects a function of unit directions, which is called 2 rows² times.
///
/// Its directions are rows at the zeros of a Legendre polynomial, each with twice as many columns; there are at least as
/// many rows as the order n, also where fewer are asked for. A function that has the bands 0 to 2 rows − n alone is
/// projected exactly, hence a signal of the order with `rows` = n. What has no end of bands, as the sky with a sun, needs
/// rows for its smallest feature: some 180 for one of a degree.
///
/// ```
/// // The upper half of the sphere is 1, the lower one 0.
/// let c: [f32; 4] = zonal::project::function(64, |dir: [f32; 3]| if dir[2] > 0.0 { 1.0 } else { 0.0 });
/// let pi = core::f32::consts::PI;
/// assert!((c[0] - pi.sqrt()).abs() < 1e-5 && (c[2] - (0.75 * pi).sqrt()).abs() < 1e-3);
/// ```
pub fn function<C: Coefficients>(rows: usize, mut f: impl FnMut([C::Scalar; 3]) -> C::Element) -> C {
    let rows = rows.max(C::ORDER);
    total((0..rows).map(|at| function_row(rows, at, &mut f)))
}

/// Refuses an image that has not as many texels as its sizes say.
fn check_image(found: usize, width: usize, height: usize) -> Result<(), Error> {
    match found > 0 && width.checked_mul(height) == Some(found) {
        true => Ok(()),
        false => Err(Error::Image { found, width, height }),
    }
}

fn lat_long_row<C: Coefficients>(texels: &[C::Element], width: usize, height: usize, at: usize) -> C {
    let texels = texels[at * width..][..width].iter().copied().enumerate();
    let directions = texels.map(|(column, value)| (grid::direction(height, width, at, column), value));
    row(directions, grid::solid_angle(height, width, at))
}

/// Projects an image by latitude and longitude: `width` × `height` texels, row by row from the top, each row from the left.
///
/// The top row is around +z, the centre of the image lies along +x, and what is right of it, seen from inside, towards −y:
/// zonal's own frame. [`to_axes`](crate::to_axes) takes the coefficients to another. A texel is its value at its centre
/// times its exact solid angle.
///
/// # Errors
///
/// If there are not `width` × `height` texels, or none.
///
/// ```
/// // Four texels a row: light from the upper half.
/// let image = [[1.0_f32; 4], [0.0; 4]].concat();
/// let c: [f32; 9] = zonal::project::lat_long(&image, 4, 2)?;
/// assert!((c[0] - core::f32::consts::PI.sqrt()).abs() < 1e-6);
/// assert!(zonal::project::lat_long::<[f32; 9]>(&image, 4, 3).is_err());
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn lat_long<C: Coefficients>(texels: &[C::Element], width: usize, height: usize) -> Result<C, Error> {
    check_image(texels.len(), width, height)?;
    Ok(total((0..height).map(|at| lat_long_row(texels, width, height, at))))
}

/// Refuses a cubemap whose faces have not as many texels as its size says.
fn check_cubemap<E>(faces: &[&[E]; 6], size: usize) -> Result<(), Error> {
    let is_whole = |texels: &[E]| size > 0 && size.checked_mul(size) == Some(texels.len());
    match faces.iter().position(|texels| !is_whole(texels)) {
        Some(face) => Err(Error::Face { face, found: faces[face].len(), size }),
        None => Ok(()),
    }
}

/// Row `at` of all the rows of the six faces.
fn cubemap_row<C: Coefficients>(faces: &[&[C::Element]; 6], size: usize, at: usize) -> C {
    let (face, row) = (at / size, at % size);
    let mut sum = Sum::new();
    for (column, value) in faces[face][row * size..][..size].iter().enumerate() {
        let (dir, weight) = grid::of_cube(face, size, row, column);
        sum.sample(dir.map(C::Scalar::lit), *value, C::Scalar::lit(weight));
    }
    sum.end()
}

/// Projects a cubemap: six faces of `size` × `size` texels in the order +x, −x, +y, −y, +z, −z, each row by row as it lies
/// in memory.
///
/// A texel's direction is that by which a shader samples it, in all of OpenGL, Vulkan, Direct3D, Metal and WebGPU, so that
/// [`evaluate`](crate::evaluate) takes the directions with which the cubemap is sampled. A texel is its value at its centre
/// times its exact solid angle.
///
/// # Errors
///
/// If a face has not `size` × `size` texels, or `size` is 0.
///
/// ```
/// // One texel a face, light from +y alone.
/// let faces = [[0.0_f32], [0.0], [3.0], [0.0], [0.0], [0.0]];
/// let c: [f32; 4] = zonal::project::cubemap(faces.each_ref().map(|face| &face[..]), 1)?;
/// assert!(zonal::evaluate([0.0, 1.0, 0.0], &c) > 1.9 && zonal::evaluate([0.0, -1.0, 0.0], &c) < 0.0);
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn cubemap<C: Coefficients>(faces: [&[C::Element]; 6], size: usize) -> Result<C, Error> {
    check_cubemap(&faces, size)?;
    Ok(total((0..6 * size).map(|at| cubemap_row(&faces, size, at))))
}

/// The same over the threads of rayon, with the same results to the last bit.
#[cfg(feature = "rayon")]
pub mod parallel {
    use rayon::iter::{
        IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, IntoParallelRefMutIterator,
        ParallelIterator,
    };

    use super::{check_cubemap, check_frames, check_image, cubemap_row, function_row, lat_long_row};
    use crate::coefficients::Coefficients;
    use crate::error::Error;
    use crate::surface::Frame;

    /// Rows are summed in their order, whichever thread was first.
    fn total<C: Coefficients>(rows: usize, row: impl Fn(usize) -> C + Sync) -> C {
        let parts: Vec<C> = (0..rows).into_par_iter().map(&row).collect();
        super::total(parts.into_iter())
    }

    /// Projects the samples of many points of surfaces, as [`project::in_frames`](super::in_frames) does.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn in_frames<T: Sync, S, R: Send>(
        frames: &[Frame<T>],
        samples: impl Fn(usize) -> S + Sync,
        one: impl Fn(&Frame<T>, S) -> R + Sync,
        results: &mut [R],
    ) -> Result<(), Error> {
        check_frames(frames.len(), results.len())?;
        let all = frames.par_iter().zip(results.par_iter_mut()).enumerate();
        all.for_each(|(i, (frame, result))| *result = one(frame, samples(i)));
        Ok(())
    }

    /// Projects a function of unit directions, as [`project::function`](super::function) does.
    pub fn function<C: Coefficients>(rows: usize, f: impl Fn([C::Scalar; 3]) -> C::Element + Sync) -> C {
        let rows = rows.max(C::ORDER);
        total(rows, |at| function_row(rows, at, &mut |dir| f(dir)))
    }

    /// Projects an image by latitude and longitude, as [`project::lat_long`](super::lat_long) does.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn lat_long<C: Coefficients>(texels: &[C::Element], width: usize, height: usize) -> Result<C, Error> {
        check_image(texels.len(), width, height)?;
        Ok(total(height, |at| lat_long_row(texels, width, height, at)))
    }

    /// Projects a cubemap, as [`project::cubemap`](super::cubemap) does.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn cubemap<C: Coefficients>(faces: [&[C::Element]; 6], size: usize) -> Result<C, Error> {
        check_cubemap(&faces, size)?;
        Ok(total(6 * size, |at| cubemap_row(&faces, size, at)))
    }
}
