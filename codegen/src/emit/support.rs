//! The traits and small types that generated Rust stands on. Only rustc reads them closely, so they are quoted; the
//! kernels, which people read, are templates.

use proc_macro2::TokenStream;
use quote::quote;

/// Where generated Rust runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Std {
    /// In a crate that has `std`.
    Always,
    /// In a crate whose feature `std` says so, and which else has `libm`.
    ByFeature,
}

fn roots(std: Std) -> [TokenStream; 2] {
    let root = |name: TokenStream| match std {
        Std::Always => quote! { self.sqrt() },
        Std::ByFeature => quote! {
            #[cfg(feature = "std")]
            let root = self.sqrt();
            #[cfg(not(feature = "std"))]
            let root = libm::#name(self);
            root
        },
    };
    [root(quote! { sqrtf }), root(quote! { sqrt })]
}

/// The text of the module `real`.
pub fn real(std: Std) -> String {
    let [root32, root64] = roots(std);
    let float = |float: TokenStream, tiny: TokenStream, root: TokenStream, lit: TokenStream, both: TokenStream| {
        quote! {
            impl Signal<#float> for #float {
                #[inline(always)]
                fn zero() -> Self { 0.0 }
                #[inline(always)]
                fn fma(self, t: #float, c: Self) -> Self { self * t + c }
                #[inline(always)]
                fn fms(self, t: #float, c: Self) -> Self { self * t - c }
                #[inline(always)]
                fn fnma(self, t: #float, c: Self) -> Self { c - self * t }
            }
            impl Real for #float {
                const TINY: Self = #tiny;
                #[inline(always)]
                fn lit(value: f64) -> Self { #lit }
                #[inline(always)]
                fn lit2(#both) -> Self { value }
                #[inline(always)]
                fn root(self) -> Self { #root }
                #[inline(always)]
                fn recip(self) -> Self { 1.0 / self }
                #[inline(always)]
                fn at_most(self, limit: Self) -> bool { self <= limit }
            }
        }
    };
    let narrow =
        float(quote! { f32 }, quote! { 1e-15 }, root32, quote! { value as f32 }, quote! { value: f32, _: f64 });
    let wide = float(quote! { f64 }, quote! { 1e-30 }, root64, quote! { value }, quote! { _: f32, value: f64 });
    // A tuple of numbers that is worked on number by number; a factor is one number or one for each.
    let tuple = |name: TokenStream, factor: TokenStream, of_factor: TokenStream| {
        let each = |item: TokenStream| quote! { Self(core::array::from_fn(#[inline(always)] |i| #item)) };
        let add = each(quote! { self.0[i] + other.0[i] });
        let sub = each(quote! { self.0[i] - other.0[i] });
        let neg = each(quote! { -self.0[i] });
        let mul = each(quote! { self.0[i] * #of_factor });
        let fma = each(quote! { self.0[i].fma(#of_factor, c.0[i]) });
        let fms = each(quote! { self.0[i].fms(#of_factor, c.0[i]) });
        let fnma = each(quote! { self.0[i].fnma(#of_factor, c.0[i]) });
        quote! {
            impl<T: Real, const N: usize> Add for #name<T, N> {
                type Output = Self;
                #[inline(always)]
                fn add(self, other: Self) -> Self { #add }
            }
            impl<T: Real, const N: usize> Sub for #name<T, N> {
                type Output = Self;
                #[inline(always)]
                fn sub(self, other: Self) -> Self { #sub }
            }
            impl<T: Real, const N: usize> Neg for #name<T, N> {
                type Output = Self;
                #[inline(always)]
                fn neg(self) -> Self { #neg }
            }
            impl<T: Real, const N: usize> Mul<#factor> for #name<T, N> {
                type Output = Self;
                #[inline(always)]
                fn mul(self, t: #factor) -> Self { #mul }
            }
            impl<T: Real, const N: usize> Signal<#factor> for #name<T, N> {
                #[inline(always)]
                fn zero() -> Self { Self([T::zero(); N]) }
                #[inline(always)]
                fn fma(self, t: #factor, c: Self) -> Self { #fma }
                #[inline(always)]
                fn fms(self, t: #factor, c: Self) -> Self { #fms }
                #[inline(always)]
                fn fnma(self, t: #factor, c: Self) -> Self { #fnma }
            }
        }
    };
    let channels = tuple(quote! { Channels }, quote! { T }, quote! { t });
    let lanes = tuple(quote! { Lanes }, quote! { Lanes<T, N> }, quote! { t.0[i] });
    let tokens = quote! {
        use core::ops::{Add, Mul, Neg, Sub};

        /// What a kernel's signal is made of: a number, or one number a channel. Linear over `T`.
        pub trait Signal<T>:
            Copy + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> + Mul<T, Output = Self>
        {
            /// Nothing.
            fn zero() -> Self;
            /// `self · t + c`; one rounding or two.
            fn fma(self, t: T, c: Self) -> Self;
            /// `self · t − c`; one rounding or two.
            fn fms(self, t: T, c: Self) -> Self;
            /// `c − self · t`; one rounding or two.
            fn fnma(self, t: T, c: Self) -> Self;
        }

        /// What a kernel's parameters are made of: `f32`, `f64` or [`Lanes`].
        pub trait Real: Signal<Self> {
            /// A number that changes nothing but a zero.
            const TINY: Self;
            /// The nearest number to a constant.
            fn lit(value: f64) -> Self;
            /// The constant whose nearest `f32` and nearest `f64` are given.
            fn lit2(narrow: f32, wide: f64) -> Self;
            /// √self.
            fn root(self) -> Self;
            /// 1 / self.
            fn recip(self) -> Self;
            /// Whether it is at most `limit`, of many numbers all of them: then an approximation may serve.
            fn at_most(self, limit: Self) -> bool;
            /// 1 / √self, rounded twice.
            #[inline(always)]
            fn rsqrt(self) -> Self { self.root().recip() }
        }

        #narrow
        #wide

        /// A signal of `N` channels that share the parameters: `Channels<f32, 3>` is RGB. `Channels<f32, N>` may have
        /// parameters of `f64`, so that a rotation's set-up is done in f64 and only its bands in f32: from a quaternion
        /// that is normalised in f64 its error is then the same at every order.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(transparent)]
        pub struct Channels<T, const N: usize>(pub [T; N]);
        #channels
        // A signal of f32 whose parameters are f64: angles and their multiples are then as good as exact, at any order,
        // and each is rounded once where it meets the signal.
        impl<const N: usize> Mul<f64> for Channels<f32, N> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, t: f64) -> Self { self * t as f32 }
        }
        impl<const N: usize> Signal<f64> for Channels<f32, N> {
            #[inline(always)]
            fn zero() -> Self { Self([0.0; N]) }
            #[inline(always)]
            fn fma(self, t: f64, c: Self) -> Self { Signal::<f32>::fma(self, t as f32, c) }
            #[inline(always)]
            fn fms(self, t: f64, c: Self) -> Self { Signal::<f32>::fms(self, t as f32, c) }
            #[inline(always)]
            fn fnma(self, t: f64, c: Self) -> Self { Signal::<f32>::fnma(self, t as f32, c) }
        }

        /// `N` numbers that are worked on at once, one a problem: the layout that vector units like. A kernel on `Lanes`
        /// does what it does on each number, but that one with a branch takes the same way for all.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C, align(64))]
        pub struct Lanes<T, const N: usize>(pub [T; N]);
        #lanes
        impl<T: Real, const N: usize> Real for Lanes<T, N> {
            const TINY: Self = Self([T::TINY; N]);
            #[inline(always)]
            fn lit(value: f64) -> Self { Self([T::lit(value); N]) }
            #[inline(always)]
            fn lit2(narrow: f32, wide: f64) -> Self { Self([T::lit2(narrow, wide); N]) }
            #[inline(always)]
            fn root(self) -> Self { Self(self.0.map(#[inline(always)] |x| x.root())) }
            #[inline(always)]
            fn recip(self) -> Self { Self(self.0.map(#[inline(always)] |x| x.recip())) }
            #[inline(always)]
            fn at_most(self, limit: Self) -> bool {
                (0..N).all(#[inline(always)] |i| self.0[i].at_most(limit.0[i]))
            }
        }
    };
    let file = syn::parse2(tokens).expect("the quoted module is Rust");
    prettyplease::unparse(&file)
}
