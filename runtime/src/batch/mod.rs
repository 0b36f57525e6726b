//! Many signals at once, at the speed of memory: each function is compiled for the vector units of a processor and takes the
//! widest that it finds. With the feature `batch`.
//!
//! ```
//! use zonal::batch::{self, Block};
//!
//! // A thousand signals of order 5, sixteen a block, and a quaternion for each.
//! let mut signals = vec![Block::<f32, 25>::zero(); Block::<f32, 25>::count(1000)];
//! signals[0].0[2][5] = 1.0;
//! let half_turns = vec![[1.0_f32, 0.0, 0.0, 0.0]; 1000];
//! batch::rotate_each_in_place(&half_turns, &mut signals)?;
//! assert!((signals[0].0[2][5] + 1.0).abs() < 1e-6);
//! # Ok::<(), zonal::Error>(())
//! ```
//!
//! # Layouts
//!
//! What a function takes is made from many types of slices: see [`Signals`]. [`Block`]s are the fastest, since sixteen numbers
//! of as many signals lie side by side; arrays and rows are read and written through blocks on the stack, which costs about as
//! much again. Parameters, such as quaternions, are taken in the same layouts, four numbers each. Any length will do: where
//! signals lie in blocks and parameters do not, there are as many parameters as fill the blocks, or up to fifteen fewer.
//!
//! # What it costs, and how exact it is
//!
//! A batch does the operations of the kernel that the function of the crate's root names, in `f32` or `f64`, and errs by no more
//! than that kernel's proven bound, which holds whether a product and a sum are rounded together or not; `f16` is rounded once
//! more when it is written. Every layout gives the same bits, but for [`rotate_all`] of rows of order 4 with AVX2 and
//! AVX-512, which multiplies by the rotation's matrix. Nothing is allocated; rows go by way of the stack, some 45 KiB of it in
//! f32, or 90 where the channels have more than 170 coefficients together, and twice as much in f64. `docs/BATCHES.md` has what each
//! function takes beside a copy of the same bytes.
//!
//! # Errors
//!
//! Every function checks all sizes before it touches anything.

mod arrays;
#[cfg(all(target_arch = "x86_64", feature = "order4"))]
mod diagonals;
mod kernels;
mod moving;
mod numbers;
mod pass;
mod registers;
mod room;
mod rows;
mod signals;
mod squares;
mod task;
mod units;

pub use numbers::{Number, Storage};
pub use rows::Row;
pub use signals::{Block, Signals, SignalsMut};
pub use task::stream_from;
pub use units::Unit;

use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::scalar::Element;
use pass::MOST_CHANNELS;
use registers::BLOCK;
use signals::View;
use task::{Input, Params, Task};
use units::Kernels;

/// The kernels of signals of so many coefficients.
fn kernels<T: Number>(unit: Unit, count: usize) -> Result<Kernels<T>, Error> {
    let order = count.isqrt();
    let kernels = if order * order == count { T::kernels(unit, order) } else { None };
    kernels.ok_or(Error::Order { count })
}

/// Parameters of so many numbers each.
fn params<T: Number>(view: View<T>, wanted: usize) -> Result<Params<'static, T>, Error> {
    match view.count * view.channels == wanted {
        true => Ok(Params::Each(view)),
        false => Err(Error::Parameters { found: view.count * view.channels, wanted }),
    }
}

/// Checks that results have as many coefficients and channels as signals.
fn same<S, D>(from: &View<S>, to: &View<D>) -> Result<(), Error> {
    match (from.count, from.channels) == (to.count, to.channels) {
        true => Ok(()),
        false => Err(Error::Results { found: [to.count, to.channels], wanted: [from.count, from.channels] }),
    }
}

/// Results of one number a signal and channel, however they are called.
fn values<D: Storage>(mut to: View<D>, channels: usize) -> Result<View<D>, Error> {
    if to.count * to.channels != channels {
        return Err(Error::Results { found: [to.count, to.channels], wanted: [1, channels] });
    }
    if to.channels != channels {
        // An array of three numbers is RGB here.
        if let signals::Places::Rows { row, .. } = &mut to.places {
            if *row != Row::interleaved(channels, 1) {
                return Err(Error::Results { found: [to.count, to.channels], wanted: [1, channels] });
            }
            *row = Row::interleaved(1, channels);
        }
        (to.count, to.channels) = (1, channels);
    }
    Ok(to)
}

/// The functions, with what runs a task over its blocks.
macro_rules! functions {
    ($over:path) => {
        /// Rotates each signal by a unit quaternion of its own, (x, y, z, w), exactly, as [`rotate`](crate::rotate) does one:
        /// `from` to `to`, which need not be of one layout, nor of one storage.
        ///
        /// # Errors
        ///
        /// If there are not as many quaternions, signals and results, if a quaternion has not four numbers, if signals and
        /// results differ in their coefficients or channels, or if the order's feature is off.
        ///
        /// ```
        /// use zonal::batch;
        ///
        /// let quaternions = [[0.0_f32, 0.0, 0.6, 0.8]; 3];
        /// let signals = [[[0.5_f32, 1.0, 2.0]; 9]; 3];
        /// let mut turned = [[[0.0; 3]; 9]; 3];
        /// batch::rotate_each(&quaternions[..], &signals[..], &mut turned[..])?;
        /// assert!((turned[2][7][1] - zonal::rotate(quaternions[2], &signals[2])[7][1]).abs() < 1e-6);
        /// assert!(batch::rotate_each(&quaternions[..2], &signals[..], &mut turned[..]).is_err());
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn rotate_each<'a, S: Storage, D: Storage<Number = S::Number>>(
            quaternions: impl Into<Signals<'a, S::Number>>,
            from: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (quaternions, from, to) = (quaternions.into(), from.into(), to.into());
            turn(quaternions.view, 4, |kernels| kernels.rotate, from.view, to.view, $over)
        }

        /// Rotates each signal by a unit quaternion of its own, where it lies; see [`rotate_each`].
        ///
        /// # Errors
        ///
        /// As [`rotate_each`].
        pub fn rotate_each_in_place<'a, S: Storage>(
            quaternions: impl Into<Signals<'a, S::Number>>,
            signals: impl Into<SignalsMut<'a, S>>,
        ) -> Result<(), Error> {
            let (quaternions, signals) = (quaternions.into(), signals.into());
            turn(quaternions.view, 4, |kernels| kernels.rotate, signals.view, signals.view, $over)
        }

        /// Rotates all signals by one unit quaternion, (x, y, z, w), exactly, as [`Rotation`](crate::Rotation) does: the set-up is
        /// done once.
        ///
        /// # Errors
        ///
        /// If there are not as many signals and results, if they differ in their coefficients or channels, or if the order's
        /// feature is off.
        ///
        /// ```
        /// use zonal::batch::{self, Row, Signals, SignalsMut};
        ///
        /// // The harmonics of splats of order 4 are turned with the scene: three constants, then 15 numbers a channel.
        /// let splats = vec![1.0_f32; 48 * 100];
        /// let mut turned = vec![0.0; 48 * 100];
        /// let row = Row::splat(16);
        /// let q = [0.0, 0.0, 0.6, 0.8];
        /// batch::rotate_all(q, Signals::rows(&splats, 48, row)?, SignalsMut::rows(&mut turned, 48, row)?)?;
        /// let red = zonal::rotate(q, &[1.0_f32; 16]);
        /// assert!((turned[3] - red[1]).abs() < 1e-6);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn rotate_all<'a, S: Storage, D: Storage<Number = S::Number>>(
            quaternion: impl Into<[S::Number; 4]>,
            from: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (quaternion, from, to) = (quaternion.into(), from.into(), to.into());
            turn_all(&quaternion, from.view, to.view, $over)
        }

        /// Rotates all signals by one unit quaternion, where they lie; see [`rotate_all`].
        ///
        /// # Errors
        ///
        /// If the order's feature is off.
        pub fn rotate_all_in_place<'a, S: Storage>(
            quaternion: impl Into<[S::Number; 4]>,
            signals: impl Into<SignalsMut<'a, S>>,
        ) -> Result<(), Error> {
            let (quaternion, signals) = (quaternion.into(), signals.into());
            turn_all(&quaternion, signals.view, signals.view, $over)
        }

        /// Tilts each signal by the shortest rotation from z to a unit normal of its own, as [`tilt`](crate::tilt) does one, with
        /// its domain and its error.
        ///
        /// # Errors
        ///
        /// As [`rotate_each`], of normals of three numbers.
        pub fn tilt_each<'a, S: Storage, D: Storage<Number = S::Number>>(
            normals: impl Into<Signals<'a, S::Number>>,
            from: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (normals, from, to) = (normals.into(), from.into(), to.into());
            turn(normals.view, 3, |kernels| kernels.tilt, from.view, to.view, $over)
        }

        /// Tilts each signal to a unit normal of its own, where it lies; see [`tilt_each`].
        ///
        /// # Errors
        ///
        /// As [`tilt_each`].
        pub fn tilt_each_in_place<'a, S: Storage>(
            normals: impl Into<Signals<'a, S::Number>>,
            signals: impl Into<SignalsMut<'a, S>>,
        ) -> Result<(), Error> {
            let (normals, signals) = (normals.into(), signals.into());
            turn(normals.view, 3, |kernels| kernels.tilt, signals.view, signals.view, $over)
        }

        /// Writes the basis at each direction of unit length, as [`evaluate_basis`](crate::evaluate_basis) does one.
        ///
        /// # Errors
        ///
        /// If there are not as many directions and results, if a direction has not three numbers, if results have more channels
        /// than one, or if the order's feature is off.
        ///
        /// ```
        /// use zonal::batch;
        ///
        /// let mut basis = [[0.0_f32; 16]; 2];
        /// batch::basis_each(&[[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]][..], &mut basis[..])?;
        /// assert!((basis[1][2] - 0.488_602_5 * 0.8).abs() < 1e-6);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn basis_each<'a, D: Storage>(
            directions: impl Into<Signals<'a, D::Number>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (directions, to) = (directions.into().view, to.into().view);
            let unit = Unit::used();
            if to.channels != 1 {
                return Err(Error::Results { found: [to.count, to.channels], wanted: [to.count, 1] });
            }
            let run = kernels(unit, to.count)?.basis;
            let params = params(directions, 3)?;
            $over(&Task::<D, D> { run: Some(run), unit, params, from: Input::None, other: None, to })
        }

        /// Writes the value of each signal in a direction of unit length of its own, as [`evaluate`](crate::evaluate) does one: a
        /// number a channel.
        ///
        /// # Errors
        ///
        /// If there are not as many directions, signals and results, if a direction has not three numbers, if results have not one
        /// number a channel, or if the order's feature is off.
        ///
        /// ```
        /// use zonal::batch;
        ///
        /// let mut values = [0.0_f32; 2];
        /// batch::eval_each(&[[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]][..], &[[1.0_f32; 9]; 2][..], &mut values[..])?;
        /// assert!((values[1] - zonal::evaluate([0.6, 0.0, 0.8], &[1.0; 9])).abs() < 1e-6);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn eval_each<'a, S: Storage, D: Storage<Number = S::Number>>(
            directions: impl Into<Signals<'a, S::Number>>,
            from: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (directions, from, to) = (directions.into().view, from.into().view, to.into().view);
            let unit = Unit::used();
            let run = kernels(unit, from.count)?.eval;
            let (params, to) = (params(directions, 3)?, values(to, from.channels)?);
            $over(&Task { run: Some(run), unit, params, from: Input::Each(from), other: None, to })
        }

        /// Writes the value of one signal in each direction of unit length: a number a channel.
        ///
        /// # Errors
        ///
        /// If there are not as many directions and results, if a direction has not three numbers, if results have not one number a
        /// channel, or if the signal has more than four.
        ///
        /// ```
        /// use zonal::batch;
        ///
        /// let light = [[1.0_f32, 0.5, 0.25]; 9];
        /// let mut seen = [[0.0; 3]; 2];
        /// batch::eval_all(&[[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]][..], &light, &mut seen[..])?;
        /// assert!((seen[1][2] - zonal::evaluate([0.6, 0.0, 0.8], &light)[2]).abs() < 1e-6);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn eval_all<'a, C, D>(
            directions: impl Into<Signals<'a, D::Number>>,
            signal: &C,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error>
        where
            C: Coefficients<Scalar = D::Number>,
            D: Storage,
        {
            let (directions, to) = (directions.into().view, to.into().view);
            let channels = C::Element::CHANNELS;
            if channels > MOST_CHANNELS {
                return Err(Error::Row { count: C::COUNT, channels });
            }
            let mut planes = [[<D::Number as Default>::default(); rows::MOST_COUNT]; MOST_CHANNELS];
            for (i, coefficient) in signal.as_ref().iter().enumerate() {
                for (plane, number) in planes.iter_mut().zip(coefficient.channels()) {
                    plane[i] = *number;
                }
            }
            let unit = Unit::used();
            let run = kernels(unit, C::COUNT)?.eval_all;
            let (params, to) = (params(directions, 3)?, values(to, channels)?);
            let from = Input::Shared(planes.each_ref().map(|plane| plane.as_ptr()));
            $over(&Task::<D, D> { run: Some(run), unit, params, from, other: None, to })
        }

        /// Multiplies each two signals, as the kernel `product:n` does: what the product has beyond the order is cut off. The orders
        /// 2 to 6.
        ///
        /// # Errors
        ///
        /// If there are not as many of both and results, if they differ in their coefficients or channels, or if there is no
        /// product of the order.
        ///
        /// ```
        /// use zonal::batch;
        ///
        /// let constant = [[2.0 * 3.544_907_7_f32, 0.0, 0.0, 0.0]];
        /// let mut product = [[0.0_f32; 4]];
        /// batch::product_each(&constant[..], &[[1.0_f32, 2.0, 3.0, 4.0]][..], &mut product[..])?;
        /// assert!((product[0][3] - 8.0).abs() < 1e-5);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn product_each<'a, S: Storage, D: Storage<Number = S::Number>>(
            a: impl Into<Signals<'a, S>>,
            b: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (a, b, to) = (a.into().view, b.into().view, to.into().view);
            let unit = Unit::used();
            let run = kernels(unit, a.count)?.product.ok_or(Error::Order { count: a.count })?;
            same(&a, &b)?;
            same(&a, &to)?;
            $over(&Task { run: Some(run), unit, params: Params::None, from: Input::Each(a), other: Some(b), to })
        }

        /// Copies signals to another layout or storage: arrays to blocks, `f32` to `f16`.
        ///
        /// # Errors
        ///
        /// If there are not as many signals and results, or if they differ in their coefficients or channels.
        ///
        /// ```
        /// use zonal::batch::{self, Block};
        ///
        /// let signals = [[1.0_f32, 2.0, 3.0, 4.0]; 20];
        /// let mut blocks = [Block::<f32, 4>::zero(); 2];
        /// batch::copy_each(&signals[..], &mut blocks[..])?;
        /// assert_eq!(blocks[1].0[2][3], 3.0);
        /// # Ok::<(), zonal::Error>(())
        /// ```
        pub fn copy_each<'a, S: Storage, D: Storage<Number = S::Number>>(
            from: impl Into<Signals<'a, S>>,
            to: impl Into<SignalsMut<'a, D>>,
        ) -> Result<(), Error> {
            let (from, to) = (from.into().view, to.into().view);
            same(&from, &to)?;
            let from = Input::Each(from);
            $over(&Task { run: None, unit: Unit::used(), params: Params::None, from, other: None, to })
        }
    };
}

/// Runs a task over all its blocks.
fn here<S: Storage, D: Storage<Number = S::Number>>(task: &Task<'_, S, D>) -> Result<(), Error> {
    task.check()?;
    // SAFETY: it is checked, and what made the views is borrowed by the function that calls.
    unsafe { task.all() };
    Ok(())
}

/// Each by parameters of its own, signals to as many results.
fn turn<S: Storage, D: Storage<Number = S::Number>>(
    parameters: View<S::Number>,
    wanted: usize,
    run: impl Fn(&Kernels<S::Number>) -> units::Run<S::Number>,
    from: View<S>,
    to: View<D>,
    over: impl Fn(&Task<'_, S, D>) -> Result<(), Error>,
) -> Result<(), Error> {
    let unit = Unit::used();
    same(&from, &to)?;
    let run = run(&kernels(unit, from.count)?);
    let params = params(parameters, wanted)?;
    over(&Task { run: Some(run), unit, params, from: Input::Each(from), other: None, to })
}

/// All by one quaternion.
fn turn_all<S: Storage, D: Storage<Number = S::Number>>(
    quaternion: &[S::Number; 4],
    from: View<S>,
    to: View<D>,
    over: impl Fn(&Task<'_, S, D>) -> Result<(), Error>,
) -> Result<(), Error> {
    let unit = Unit::used();
    same(&from, &to)?;
    let run = kernels(unit, from.count)?.rotate_all;
    over(&Task { run: Some(run), unit, params: Params::Shared(quaternion), from: Input::Each(from), other: None, to })
}

functions!(here);

#[cfg(feature = "rayon")]
pub mod parallel;

/// Changes each sixteen signals by a function of this crate: as coefficients of sixteen channels, which is what a block is. So
/// anything that is done to one signal is done to many, such as [`to_convention`](crate::to_convention) or
/// [`irradiance`](crate::irradiance), in any layout.
///
/// # Errors
///
/// If there are not as many signals and results, or if they are not of the coefficients that the function takes and gives.
///
/// ```
/// use zonal::batch;
///
/// let radiance = [[1.0_f32; 9]; 3];
/// let mut irradiance = [[0.0; 9]; 3];
/// batch::map_each(&radiance[..], &mut irradiance[..], |c: &[[f32; 16]; 9]| zonal::irradiance(c))?;
/// assert_eq!(irradiance[1], zonal::irradiance(&radiance[1]));
/// # Ok::<(), zonal::Error>(())
/// ```
pub fn map_each<'a, const N: usize, const M: usize, S, D>(
    from: impl Into<Signals<'a, S>>,
    to: impl Into<SignalsMut<'a, D>>,
    of: impl Fn(&[[S::Number; BLOCK]; N]) -> [[S::Number; BLOCK]; M],
) -> Result<(), Error>
where
    S: Storage,
    D: Storage<Number = S::Number>,
{
    let (from, to) = (from.into().view, to.into().view);
    if from.count != N || to.count != M || from.channels != to.channels {
        return Err(Error::Results { found: [to.count, to.channels], wanted: [M, from.channels] });
    }
    task::map(&from, &to, |given, made| {
        // SAFETY: both are lines of the stack, of as many coefficients, which no array of numbers aligns otherwise.
        unsafe { *made.cast::<[[S::Number; BLOCK]; M]>() = of(&*given.cast()) }
    })
}
