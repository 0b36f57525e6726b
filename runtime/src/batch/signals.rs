//! Many signals in memory, in whichever layout: what batches take and where they write.

use core::fmt;
use core::marker::PhantomData;

use super::numbers::Storage;
use super::pass::MOST_CHANNELS;
use super::registers::BLOCK;
use super::rows::{MOST_COUNT, Row};
use crate::error::Error;

/// Sixteen signals of `N` numbers each, the layout that is fastest: `self.0[i][k]` is number i of signal k. An array of blocks
/// holds any number of signals, sixteen a block; what the last block has too much is computed and is of no meaning.
///
/// It begins at a multiple of 64 bytes and has no padding, so that `&[Block<f32, 25>]` may be sent as bytes.
#[derive(Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Block<T, const N: usize>(pub [[T; BLOCK]; N]);

impl<T: Storage, const N: usize> Block<T, N> {
    /// Returns a block of zeros.
    #[must_use]
    pub fn zero() -> Self {
        Self([[T::default(); BLOCK]; N])
    }

    /// Returns how many blocks hold so many signals.
    #[must_use]
    pub const fn count(signals: usize) -> usize {
        signals.div_ceil(BLOCK)
    }
}

impl<T: Storage, const N: usize> Default for Block<T, N> {
    fn default() -> Self {
        Self::zero()
    }
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Block<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Block").field(&self.0).finish()
    }
}

/// How numbers lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Places {
    /// In blocks, those of the channels of sixteen signals one after the other.
    Blocks,
    /// In rows, a signal each.
    Rows { stride: usize, row: Row },
}

/// Where many signals lie. It borrows nothing: [`Signals`] and [`SignalsMut`] do.
#[derive(Debug)]
pub(super) struct View<T> {
    /// The memory: one for all channels, or one a channel.
    pub planes: [*mut T; MOST_CHANNELS],
    /// How many numbers each has.
    pub lengths: [usize; MOST_CHANNELS],
    /// How many there are.
    pub plane_count: usize,
    pub places: Places,
    /// The numbers of a signal and channel.
    pub count: usize,
    /// The channels, in all planes.
    pub channels: usize,
    /// The signals; those of blocks are a multiple of sixteen.
    pub signals: usize,
}

impl<T> Clone for View<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for View<T> {}

// SAFETY: it is a place and no access; what reads or writes there has borrowed it, and says what each thread touches.
unsafe impl<T: Send> Send for View<T> {}
unsafe impl<T: Sync> Sync for View<T> {}

impl<T> View<T> {
    // Views are made where they stay: moving one costs more than all that a call does with it.
    #[inline(always)]
    fn blocks(planes: [(*mut T, usize); MOST_CHANNELS], plane_count: usize, count: usize, channels: usize) -> Self {
        let of_a_block = BLOCK * count * channels / plane_count.max(1);
        let blocks = planes[..plane_count].iter().map(|plane| plane.1 / of_a_block.max(1)).min().unwrap_or(0);
        Self::new(planes, plane_count, Places::Blocks, [count, channels], blocks * BLOCK)
    }

    #[inline(always)]
    fn rows(planes: [(*mut T, usize); MOST_CHANNELS], plane_count: usize, stride: usize, row: Row) -> Self {
        let signals = planes[..plane_count].iter().map(|plane| plane.1 / stride.max(1)).min().unwrap_or(0);
        let channels = row.channels * plane_count;
        Self::new(planes, plane_count, Places::Rows { stride, row }, [row.count, channels], signals)
    }

    #[inline(always)]
    fn new(
        planes: [(*mut T, usize); MOST_CHANNELS],
        plane_count: usize,
        places: Places,
        [count, channels]: [usize; 2],
        signals: usize,
    ) -> Self {
        let (planes, lengths) = (planes.map(|plane| plane.0), planes.map(|plane| plane.1));
        Self { planes, lengths, plane_count, places, count, channels, signals }
    }

    /// Returns it as a view of f32, if that is what it is.
    #[cfg(all(target_arch = "x86_64", feature = "order4"))]
    pub fn singles(&self) -> Option<View<f32>>
    where
        T: 'static,
    {
        let is_single = core::any::TypeId::of::<T>() == core::any::TypeId::of::<f32>();
        is_single.then(|| View {
            planes: self.planes.map(<*mut T>::cast),
            lengths: self.lengths,
            plane_count: self.plane_count,
            places: self.places,
            count: self.count,
            channels: self.channels,
            signals: self.signals,
        })
    }

    /// How many blocks hold the signals.
    pub fn block_count(&self) -> usize {
        self.signals.div_ceil(BLOCK)
    }

    /// Whether all channels lie in one plane; else each has one.
    fn is_one_plane(&self) -> bool {
        self.plane_count == 1
    }

    /// The channels of a plane.
    pub fn channels_of_plane(&self) -> usize {
        if self.is_one_plane() { self.channels } else { 1 }
    }

    /// How many numbers of a plane a block has, if it lies in blocks.
    pub fn step(&self) -> usize {
        BLOCK * self.count * self.channels_of_plane()
    }

    /// How many bytes all signals take, which is no more than memory has.
    pub fn bytes(&self) -> usize {
        self.signals * self.count * self.channels * size_of::<T>()
    }

    /// Whether all planes have as many numbers.
    pub fn is_even(&self) -> bool {
        self.is_one_plane() || self.lengths[..self.plane_count].windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Returns whether sixteen signals are lines as they lie, from a block on that is whole.
    pub fn is_lines(&self) -> bool {
        match self.places {
            Places::Blocks => true,
            Places::Rows { stride, row } => stride == 1 && row == Row::interleaved(1, 1),
        }
    }

    /// The first line of a channel of a block.
    pub fn line(&self, channel: usize, block: usize) -> *mut T {
        let (plane, within) = if self.is_one_plane() { (0, channel) } else { (channel, 0) };
        self.planes[plane].wrapping_add(block * self.step() + within * self.count * BLOCK)
    }
}

/// Many signals to read, or as many quaternions, directions or normals: numbers of a type, so many for each.
///
/// | made from | holds |
/// |---|---|
/// | `&[Block<T, N>]` | blocks of sixteen, the fastest |
/// | `&[[Block<T, N>; C]]` | blocks of C channels, one after the other |
/// | `[&[Block<T, N>]; C]` | blocks of C channels, each its own slice |
/// | `&[[T; N]]` | an array a signal; `&[[f32; 4]]` are quaternions too, and `&[[f32; 3]]` directions |
/// | `&[[[T; C]; N]]` | an array of C channels a coefficient: interleaved RGB |
/// | `[&[[T; N]]; C]` | an array a signal, a slice a channel: planar RGB |
/// | `&[T]` | one number a signal, as values have |
/// | [`Signals::rows`] | rows of any stride, each as a [`Row`] says: splats |
#[derive(Clone, Copy, Debug)]
pub struct Signals<'a, T> {
    pub(super) view: View<T>,
    borrowed: PhantomData<&'a [T]>,
}

/// Many signals to write, or to change in place: made as [`Signals`] are, of `&mut`.
#[derive(Debug)]
pub struct SignalsMut<'a, T> {
    pub(super) view: View<T>,
    borrowed: PhantomData<&'a mut [T]>,
}

/// Checks what a user says of rows.
fn checked(numbers: usize, stride: usize, row: &Row) -> Result<(), Error> {
    let width = row.width();
    if row.channels == 0 || row.channels > MOST_CHANNELS || row.count == 0 || row.count > MOST_COUNT {
        return Err(Error::Row { count: row.count, channels: row.channels });
    }
    if stride < width {
        return Err(Error::Stride { stride, width });
    }
    match numbers % stride {
        0 => Ok(()),
        over => Err(Error::Rows { numbers, stride, over }),
    }
}

const EMPTY: usize = 0;

/// One plane for all channels.
#[inline(always)]
fn one<T>(at: *mut T, length: usize) -> [(*mut T, usize); MOST_CHANNELS] {
    let mut planes = [(core::ptr::null_mut(), EMPTY); MOST_CHANNELS];
    planes[0] = (at, length);
    planes
}

/// A plane a channel.
#[inline(always)]
fn each<T>(of: impl IntoIterator<Item = (*mut T, usize)>) -> [(*mut T, usize); MOST_CHANNELS] {
    let mut planes = [(core::ptr::null_mut(), EMPTY); MOST_CHANNELS];
    for (plane, known) in planes.iter_mut().zip(of) {
        *plane = known;
    }
    planes
}

/// What a type of the signals is checked for when it is compiled.
struct Sizes<const N: usize, const C: usize>;

impl<const N: usize, const C: usize> Sizes<N, C> {
    const CHECKED: () = assert!(
        N >= 1 && N <= MOST_COUNT && C >= 1 && C <= MOST_CHANNELS,
        "a signal of a batch has 1 to 100 numbers in 1 to 4 channels"
    );
}

macro_rules! signals {
    ($signals:ident, [$($reference:tt)+], $as_ptr:ident, $($cast:ident)?) => {
        impl<'a, T: Storage> $signals<'a, T> {
            fn of(view: View<T>) -> Self {
                Self { view, borrowed: PhantomData }
            }

            /// Returns rows of `stride` numbers each, in which signals lie as a [`Row`] says.
            ///
            /// # Errors
            ///
            /// If a row is shorter than its signal, if the numbers are no whole rows, or if a signal has no numbers, more than
            /// 100 a channel or more than 4 channels.
            ///
            /// ```
            /// use zonal::batch::{Row, Signals};
            ///
            /// // Two splats of order 4, of 59 numbers each, whose harmonics begin at the sixth.
            /// let splats = vec![0.0_f32; 2 * 59];
            /// let harmonics = Signals::rows(&splats, 59, Row::splat(16).at(6)).expect("48 of 59 numbers from the sixth on");
            /// assert_eq!(harmonics.len(), 2);
            /// assert!(Signals::rows(&splats, 50, Row::splat(16).at(6)).is_err());
            /// ```
            pub fn rows(numbers: $($reference)+ [T], stride: usize, row: Row) -> Result<Self, Error> {
                checked(numbers.len(), stride, &row)?;
                Ok(Self::of(View::rows(one(numbers.$as_ptr()$(.$cast())?, numbers.len()), 1, stride, row)))
            }

            /// Returns how many signals there are; those of blocks are a multiple of sixteen.
            #[must_use]
            pub fn len(&self) -> usize {
                self.view.signals
            }

            /// Returns whether there are none.
            #[must_use]
            pub fn is_empty(&self) -> bool {
                self.view.signals == 0
            }
        }

        impl<'a, T: Storage, const N: usize> From<$($reference)+ [Block<T, N>]> for $signals<'a, T> {
            fn from(blocks: $($reference)+ [Block<T, N>]) -> Self {
                let () = Sizes::<N, 1>::CHECKED;
                let length = blocks.len() * N * BLOCK;
                Self::of(View::blocks(one(blocks.$as_ptr()$(.$cast())?.cast(), length), 1, N, 1))
            }
        }
        impl<'a, T: Storage, const N: usize, const C: usize> From<$($reference)+ [[Block<T, N>; C]]> for $signals<'a, T> {
            fn from(blocks: $($reference)+ [[Block<T, N>; C]]) -> Self {
                let () = Sizes::<N, C>::CHECKED;
                let length = blocks.len() * N * C * BLOCK;
                Self::of(View::blocks(one(blocks.$as_ptr()$(.$cast())?.cast(), length), 1, N, C))
            }
        }
        impl<'a, T: Storage, const N: usize, const C: usize> From<[$($reference)+ [Block<T, N>]; C]> for $signals<'a, T> {
            fn from(planes: [$($reference)+ [Block<T, N>]; C]) -> Self {
                let () = Sizes::<N, C>::CHECKED;
                let plane = |plane: $($reference)+ [Block<T, N>]| (plane.$as_ptr()$(.$cast())?.cast(), plane.len() * N * BLOCK);
                Self::of(View::blocks(each(planes.map(plane)), C, N, C))
            }
        }
        impl<'a, T: Storage, const N: usize> From<$($reference)+ [[T; N]]> for $signals<'a, T> {
            fn from(rows: $($reference)+ [[T; N]]) -> Self {
                let () = Sizes::<N, 1>::CHECKED;
                let length = rows.len() * N;
                Self::of(View::rows(one(rows.$as_ptr()$(.$cast())?.cast(), length), 1, N, Row::interleaved(N, 1)))
            }
        }
        impl<'a, T: Storage, const N: usize, const C: usize> From<$($reference)+ [[[T; C]; N]]> for $signals<'a, T> {
            fn from(rows: $($reference)+ [[[T; C]; N]]) -> Self {
                let () = Sizes::<N, C>::CHECKED;
                let length = rows.len() * N * C;
                Self::of(View::rows(one(rows.$as_ptr()$(.$cast())?.cast(), length), 1, N * C, Row::interleaved(N, C)))
            }
        }
        impl<'a, T: Storage, const N: usize, const C: usize> From<[$($reference)+ [[T; N]]; C]> for $signals<'a, T> {
            fn from(planes: [$($reference)+ [[T; N]]; C]) -> Self {
                let () = Sizes::<N, C>::CHECKED;
                let plane = |plane: $($reference)+ [[T; N]]| (plane.$as_ptr()$(.$cast())?.cast(), plane.len() * N);
                Self::of(View::rows(each(planes.map(plane)), C, N, Row::interleaved(N, 1)))
            }
        }
        impl<'a, T: Storage> From<$($reference)+ [T]> for $signals<'a, T> {
            fn from(numbers: $($reference)+ [T]) -> Self {
                let length = numbers.len();
                Self::of(View::rows(one(numbers.$as_ptr()$(.$cast())?, length), 1, 1, Row::interleaved(1, 1)))
            }
        }
    };
}

signals!(Signals, [&'a], as_ptr, cast_mut);
signals!(SignalsMut, [&'a mut], as_mut_ptr,);

/// A vector is taken as the slice of its items is.
impl<'a, T: Storage, I> From<&'a Vec<I>> for Signals<'a, T>
where
    Self: From<&'a [I]>,
{
    fn from(items: &'a Vec<I>) -> Self {
        Self::from(items.as_slice())
    }
}

impl<'a, T: Storage, I> From<&'a mut Vec<I>> for SignalsMut<'a, T>
where
    Self: From<&'a mut [I]>,
{
    fn from(items: &'a mut Vec<I>) -> Self {
        Self::from(items.as_mut_slice())
    }
}
