//! The kernels in pieces, of which each number is handed over as soon as it is known: the table of them, which batches read
//! too, and what runs them on the numbers of one signal.
//!
//! Between two numbers that are written stands a fence for the compiler, which is no instruction. LLVM would else gather the
//! sums of neighbours into vectors (its SLP pass), which without multiply-add instructions takes more moves than it saves;
//! and it would put all writing off to the end, where all results have to be kept until then. What a fence also keeps from
//! happening is that a loop over many signals is made one of vectors, so that functions by value have none.

use core::sync::atomic::{Ordering, compiler_fence};

use zonal_kernels::real::Real;

use crate::scalar::Element;

/// A function of an index, always inlined: only so is it compiled for the unit of the function around it.
#[inline(always)]
pub fn source<V, F: Fn(usize) -> V>(of: F) -> F {
    of
}

/// A function that takes an index and a number, always inlined as [`source`] is.
#[inline(always)]
pub fn sink<V, F: FnMut(usize, V)>(of: F) -> F {
    of
}

/// Writes a number before any that comes after it.
#[inline(always)]
fn write<E>(to: &mut E, number: E) {
    *to = number;
    compiler_fence(Ordering::SeqCst);
}

/// A kernel that turns a signal, set-up first, then band after band. Band 0 stays as it is.
macro_rules! turn {
    ($name:ident: $about:literal, $module:ident, $count:literal, $params:literal, $set_up:ident [$($l:literal $band:ident)*]) => {
        #[doc = $about]
        #[inline]
        pub fn $name<E: Element>(params: [E::Scalar; $params], c: &[E; $count], to: &mut [E; $count]) {
            let mut numbers = [E::Scalar::lit(0.0); _];
            zonal_kernels::batch::$module::$set_up(params, &mut sink(#[inline(always)] |i, x| numbers[i] = x));
            write(&mut to[0], c[0]);
            $(
                zonal_kernels::batch::$module::$band(
                    &numbers,
                    &source(#[inline(always)] |i| c[$l * $l + i].signal()),
                    &mut sink(#[inline(always)] |i, x| write(&mut to[$l * $l + i], E::element(x))),
                );
            )*
        }
    };
}

/// The kernels of an order for one signal.
macro_rules! orders {
    ($(
        $feature:literal $module:ident, $count:literal:
        each $each_set_up:ident $each_bands:tt,
        all $all_set_up:ident $all_bands:tt,
        tilt $tilt_bands:tt
        $(, product $product:ident)?;
    )*) => { $(
        /// The kernels of an order for one signal. Most take the same rotation whatever the channels.
        #[cfg(feature = $feature)]
        #[allow(dead_code)]
        pub mod $module {
            use super::*;

            turn!(rotate: "By a quaternion.", $module, $count, 4, $each_set_up $each_bands);
            turn!(rotate_zyz: "By a quaternion, of whose set-up channels have more.", $module, $count, 4, $all_set_up $all_bands);
            turn!(tilt: "To a normal.", $module, $count, 3, tilt_setup $tilt_bands);

            /// The basis in a direction.
            #[inline]
            pub fn basis<T: Real>(dir: [T; 3], to: &mut [T; $count]) {
                zonal_kernels::batch::$module::basis(dir, &mut sink(#[inline(always)] |i, x| write(&mut to[i], x)));
            }
        }
    )* };
}

/// Hands the pieces of all orders to a macro: an order's feature and module, how many coefficients it has, the set-up and
/// the bands of a rotation of each signal, of one of all signals or channels, and of a tilt, and whether there is a product.
macro_rules! table {
    ($then:ident) => { $then! {
        "order2" sh2, 4:
            each rotate_setup [1 band_1_rotate],
            all rotate_zyz_setup [1 band_1_rotate_zyz],
            tilt [1 band_1_tilt], product Product;
        "order3" sh3, 9:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate],
            all rotate_zyz_setup [1 band_1_rotate_zyz 2 band_2_rotate_zyz],
            tilt [1 band_1_tilt 2 band_2_tilt], product Product;
        "order4" sh4, 16:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt], product Product;
        "order5" sh5, 25:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt], product Product;
        "order6" sh6, 36:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt 5 band_5_tilt], product Product;
        "order7" sh7, 49:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt 5 band_5_tilt 6 band_6_tilt];
        "order8" sh8, 64:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt 5 band_5_tilt 6 band_6_tilt 7 band_7_tilt];
        "order9" sh9, 81:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate 8 band_8_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate 8 band_8_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt 5 band_5_tilt 6 band_6_tilt 7 band_7_tilt 8 band_8_tilt];
        "order10" sh10, 100:
            each rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate 8 band_8_rotate 9 band_9_rotate],
            all rotate_setup [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate 5 band_5_rotate 6 band_6_rotate 7 band_7_rotate 8 band_8_rotate 9 band_9_rotate],
            tilt [1 band_1_tilt 2 band_2_tilt 3 band_3_tilt 4 band_4_tilt 5 band_5_tilt 6 band_6_tilt 7 band_7_tilt 8 band_8_tilt 9 band_9_tilt];
    } };
}
#[cfg(feature = "batch")]
pub(crate) use table;

table!(orders);
