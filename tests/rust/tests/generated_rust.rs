//! The emitted Rust is the interpreter, to the last bit: every function of `generated/rust` runs on seeded inputs,
//! extremes first, in f32 and f64, one channel and three, and its results are compared with `to_bits`. The table of
//! functions is checked against the standard catalogue, so that none can be forgotten.

use std::collections::BTreeMap;
use std::fmt::Debug;

use zonal::real::{Channels, Lanes};
use zonal_codegen::catalog;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::code::Runner;
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::kernel::Param;
use zonal_codegen::promise::samples::{self, Random};

const SEED: u64 = 0x9e_11;
const SAMPLES: usize = 24;

/// A value that is read from a row of numbers and written to one.
trait Flat<T>: Sized {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Self;
    fn write(&self, numbers: &mut Vec<T>);
}

macro_rules! flat_number {
    ($($number:ident)*) => { $(
        impl Flat<$number> for $number {
            fn read(numbers: &mut impl Iterator<Item = $number>) -> Self {
                numbers.next().expect("a number for each place")
            }
            fn write(&self, numbers: &mut Vec<$number>) {
                numbers.push(*self);
            }
        }
    )* };
}
flat_number!(f32 f64);

impl<T, V: Flat<T>, const N: usize> Flat<T> for [V; N] {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Self {
        std::array::from_fn(|_| V::read(numbers))
    }
    fn write(&self, numbers: &mut Vec<T>) {
        self.iter().for_each(|value| value.write(numbers));
    }
}

fn read<T: Copy, V: Flat<T>>(numbers: &[T]) -> V {
    let mut numbers = numbers.iter().copied();
    let value = V::read(&mut numbers);
    assert_eq!(numbers.count(), 0, "no number is left over");
    value
}

fn written<T, V: Flat<T>>(value: V) -> Vec<T> {
    let mut numbers = Vec::new();
    value.write(&mut numbers);
    numbers
}

/// A kernel on rows of numbers, one a parameter.
type Flattened<T> = Box<dyn Fn(&[Vec<T>]) -> Vec<T>>;

macro_rules! adapters {
    ($($name:ident($($kind:ident: [$($by:tt)?]),*);)*) => { $(
        #[allow(non_snake_case)]
        fn $name<T: Copy, $($kind: Flat<T>,)* R: Flat<T>>(f: impl Fn($($($by)? $kind),*) -> R + 'static) -> Flattened<T> {
            Box::new(move |rows| {
                let mut rows = rows.iter();
                $(let $kind: $kind = read(rows.next().expect("a row for each parameter"));)*
                written(f($($($by)? $kind),*))
            })
        }
    )* };
}
adapters! {
    value(A: []);
    signal(C: [&]);
    value_signal(A: [], C: [&]);
    list_signal(A: [&], C: [&]);
    value_value_signal(A: [], B: [], C: [&]);
    value_value_value_signal(A: [], B: [], C: [], D: [&]);
    list(C: [&]);
    list_value_signal(A: [&], B: [], C: [&]);
    value_list_signal(A: [], B: [&], C: [&]);
    list_list_signal(A: [&], B: [&], C: [&]);
    value_list(A: [], C: [&]);
}

/// Every function of one order under its name in shaders; after `alone` that has no order.
macro_rules! functions {
    ($scalar:ident, $table:ident, alone $module:ident, $($adapter:ident: $($one:ident $(/ $rgb:ident)?),*;)*) => {
        $($(
            $table.insert(stringify!($one), functions!(@ $scalar, $module, $adapter, $one));
            $($table.insert(stringify!($rgb), $adapter(zonal::$module::$rgb::<$scalar>));)?
        )*)*
    };
    ($scalar:ident, $table:ident, $module:ident, $($adapter:ident: $($one:ident $(/ $rgb:ident)?),*;)*) => {
        $($(
            $table.insert(
                concat!(stringify!($module), "_", stringify!($one)),
                functions!(@ $scalar, $module, $adapter, $one),
            );
            $($table.insert(
                concat!(stringify!($module), "_", stringify!($rgb)),
                $adapter(zonal::$module::$rgb::<$scalar>),
            );)?
        )*)*
    };
    (@ $scalar:ident, $module:ident, value, $one:ident) => { value(zonal::$module::$one::<$scalar>) };
    (@ $scalar:ident, $module:ident, list, $one:ident) => { list(zonal::$module::$one::<$scalar>) };
    (@ $scalar:ident, $module:ident, value_list, $one:ident) => { value_list(zonal::$module::$one::<$scalar>) };
    (@ $scalar:ident, $module:ident, $adapter:ident, $one:ident) => {
        $adapter(zonal::$module::$one::<$scalar, $scalar>)
    };
}

macro_rules! order {
    ($scalar:ident, $table:ident, $module:ident, $($more:tt)*) => {
        functions! {
            $scalar, $table, $module,
            value: basis, angles, basis_loop;
            signal: swap_yz / swap_yz_rgb, rotate_x_plus_90deg / rotate_x_plus_90deg_rgb,
                rotate_x_minus_90deg / rotate_x_minus_90deg_rgb, zhf_weights / zhf_weights_rgb,
                zhf_tailored / zhf_tailored_rgb, to_monomial / to_monomial_rgb;
            value_signal: eval / eval_rgb, rotate_z / rotate_z_rgb, rotate_y / rotate_y_rgb, rotate / rotate_rgb,
                rotate_zxzxz / rotate_zxzxz_rgb, rotate_align / rotate_align_rgb, rotate_zonal / rotate_zonal_rgb,
                tilt / tilt_rgb, taylor1_y / taylor1_y_rgb, taylor15_y / taylor15_y_rgb, taylor2_y / taylor2_y_rgb,
                lf3_y / lf3_y_rgb, lf5_y / lf5_y_rgb, taylor15_y_loop / taylor15_y_rgb_loop,
                eval_monomial / eval_monomial_rgb, rotate_small / rotate_small_rgb;
            list_signal: rotate_euler / rotate_euler_rgb, rotate_angles / rotate_angles_rgb, zhf / zhf_rgb, dot / dot_rgb;
            list_value_signal: taylor1_zyz / taylor1_zyz_rgb, taylor15_zyz / taylor15_zyz_rgb,
                taylor2_zyz / taylor2_zyz_rgb, lf3_zyz / lf3_zyz_rgb, lf5_zyz / lf5_zyz_rgb;
            $($more)*
        }
    };
}

/// The same with what there is from order 4 on.
macro_rules! order_from_4 {
    ($scalar:ident, $table:ident, $module:ident, $($more:tt)*) => {
        order! {
            $scalar, $table, $module,
            value: lifted;
            list_signal: rotate_lifted / rotate_lifted_rgb;
            value_signal: lf5_tilt / lf5_tilt_rgb, lf5_rotate_small / lf5_rotate_small_rgb,
                tilt_prescaled / tilt_prescaled_rgb, lf5_tilt_prescaled / lf5_tilt_prescaled_rgb;
            signal: tilt_scale / tilt_scale_rgb, tilt_unscale / tilt_unscale_rgb;
            value_value_signal: rotate_adaptive / rotate_adaptive_rgb;
            $($more)*
        }
    };
}

/// Lights and zonal functions, which the catalogue has to order 6.
macro_rules! lights {
    ($scalar:ident, $table:ident, $($module:ident)*) => { $(
        functions! {
            $scalar, $table, $module,
            value: cap, gaussian, gaussian_narrow, phong, henyey_greenstein;
            list: dominant, light_fit;
            signal: convolve_cosine / convolve_cosine_rgb, to_irradiance / to_irradiance_rgb;
            list_signal: convolve / convolve_rgb;
            value_signal: irradiance / irradiance_rgb, light_fit_along / light_fit_along_rgb, window / window_rgb,
                irradiance_prepared / irradiance_prepared_rgb;
            value_value_signal: light_directional / light_directional_rgb;
            value_value_value_signal: light_sphere / light_sphere_rgb, light_cone / light_cone_rgb,
                light_hemisphere / light_hemisphere_rgb, light_gaussian / light_gaussian_rgb;
        }
    )* };
}

/// The products of an order.
macro_rules! products {
    ($scalar:ident, $table:ident, $module:ident, $($more:tt)*) => {
        functions! {
            $scalar, $table, $module,
            value: axis_angles;
            signal: square / square_rgb, product_cosine / product_cosine_rgb, product_hemisphere / product_hemisphere_rgb;
            list_signal: product / product_rgb, product_zonal / product_zonal_rgb;
            value_list_signal: product_zonal_about / product_zonal_about_rgb;
            list_list_signal: product_zonal_about_angles / product_zonal_about_angles_rgb;
            $($more)*
        }
    };
}

/// The same with what there is to order 4.
macro_rules! products_to_4 {
    ($scalar:ident, $table:ident, $module:ident, $($more:tt)*) => {
        products! {
            $scalar, $table, $module,
            signal: product_matrix / product_matrix_rgb;
            value_signal: product_cosine_about / product_cosine_about_rgb,
                product_hemisphere_about / product_hemisphere_about_rgb;
            list_signal: product_by_matrix / product_by_matrix_rgb, product_grey / product_grey_rgb,
                product_cosine_about_angles / product_cosine_about_angles_rgb,
                product_hemisphere_about_angles / product_hemisphere_about_angles_rgb;
            $($more)*
        }
    };
}

/// The bases of irradiance over the hemisphere, which have no order, and what is there at order 3 alone.
macro_rules! irradiances {
    ($scalar:ident, $table:ident) => {
        functions! {
            $scalar, $table, alone sh2,
            value: h4_basis, h4_basis_normalised, hl2_basis, hl2_basis_normalised;
            value_signal: h4_eval / h4_eval_rgb,
                h4_eval_normalised / h4_eval_normalised_rgb,
                h4_eval_monomial / h4_eval_monomial_rgb,
                h4_eval_monomial_normalised / h4_eval_monomial_normalised_rgb,
                hl2_eval / hl2_eval_rgb,
                hl2_eval_normalised / hl2_eval_normalised_rgb,
                hl2_eval_vector / hl2_eval_vector_rgb,
                hl2_eval_vector_normalised / hl2_eval_vector_normalised_rgb;
            signal: h4_to_monomial / h4_to_monomial_rgb,
                hl2_to_h4_coefficients / hl2_to_h4_coefficients_rgb,
                hl2_to_vector / hl2_to_vector_rgb;
            value_list: eval_geomerics, eval_zh3_hallucinated;
        }
        functions! {
            $scalar, $table, alone sh3,
            value: h6_basis, h6_basis_normalised;
            value_signal: h6_eval / h6_eval_rgb,
                h6_eval_normalised / h6_eval_normalised_rgb,
                h6_eval_monomial / h6_eval_monomial_rgb,
                h6_eval_monomial_normalised / h6_eval_monomial_normalised_rgb;
            signal: h6_to_monomial / h6_to_monomial_rgb,
                sh3_to_h4_coefficients / sh3_to_h4_coefficients_rgb,
                sh3_to_h4_coefficients_irradiance / sh3_to_h4_coefficients_irradiance_rgb,
                sh3_to_h4_coefficients_monomial / sh3_to_h4_coefficients_monomial_rgb,
                sh3_to_h4_coefficients_irradiance_monomial / sh3_to_h4_coefficients_irradiance_monomial_rgb,
                sh3_to_h6_coefficients / sh3_to_h6_coefficients_rgb,
                sh3_to_h6_coefficients_irradiance / sh3_to_h6_coefficients_irradiance_rgb,
                sh3_to_h6_coefficients_monomial / sh3_to_h6_coefficients_monomial_rgb,
                sh3_to_h6_coefficients_irradiance_monomial / sh3_to_h6_coefficients_irradiance_monomial_rgb,
                sh3_to_hl2_coefficients / sh3_to_hl2_coefficients_rgb,
                sh3_to_hl2_coefficients_irradiance / sh3_to_hl2_coefficients_irradiance_rgb;
        }
        functions! {
            $scalar, $table, alone sh5,
            signal: sh5_to_h4_coefficients / sh5_to_h4_coefficients_rgb,
                sh5_to_h4_coefficients_irradiance / sh5_to_h4_coefficients_irradiance_rgb,
                sh5_to_h4_coefficients_monomial / sh5_to_h4_coefficients_monomial_rgb,
                sh5_to_h4_coefficients_irradiance_monomial / sh5_to_h4_coefficients_irradiance_monomial_rgb,
                sh5_to_h6_coefficients / sh5_to_h6_coefficients_rgb,
                sh5_to_h6_coefficients_irradiance / sh5_to_h6_coefficients_irradiance_rgb,
                sh5_to_h6_coefficients_monomial / sh5_to_h6_coefficients_monomial_rgb,
                sh5_to_h6_coefficients_irradiance_monomial / sh5_to_h6_coefficients_irradiance_monomial_rgb;
        }
        functions! { $scalar, $table, sh2, value_signal: eval_once; }
        functions! { $scalar, $table, sh3, value_signal: eval_once; list: minimum, lerp_to_dc; }
    };
}

macro_rules! every_order {
    ($scalar:ident) => {{
        let mut table: BTreeMap<&'static str, Flattened<$scalar>> = BTreeMap::new();
        order!($scalar, table, sh2,
            value_signal: rotate_zyz / rotate_zyz_rgb, rotate_zyz_loop / rotate_zyz_rgb_loop;
            list_signal: rotate_matrix / rotate_matrix_rgb;);
        order!($scalar, table, sh3,
            value: lifted;
            value_signal: rotate_zyz / rotate_tensor_rgb, rotate_zyz_loop / rotate_rgb_loop;
            list_signal: rotate_matrix / rotate_matrix_rgb, rotate_lifted / rotate_lifted_rgb;);
        order_from_4!($scalar, table, sh4, value_signal: rotate_loop / rotate_rgb_loop;);
        order_from_4!($scalar, table, sh5,
            value_signal: rotate_loop / rotate_rgb_loop, bands_0_1_2_4_eval / bands_0_1_2_4_eval_rgb,
                taylor15_taylor15_taylor15_taylor1_y;);
        order_from_4!($scalar, table, sh6, value_signal: rotate_loop / rotate_rgb_loop;);
        order_from_4!($scalar, table, sh7, value_signal: rotate_loop / rotate_rgb_loop;);
        order_from_4!($scalar, table, sh8, value_signal: rotate_loop / rotate_rgb_loop;);
        order_from_4!($scalar, table, sh9, value_signal: rotate_loop / rotate_rgb_loop;);
        order_from_4!($scalar, table, sh10, value_signal: rotate_loop / rotate_rgb_loop;);
        lights!($scalar, table, sh2 sh3 sh4 sh5 sh6);
        products_to_4!($scalar, table, sh2,);
        products_to_4!($scalar, table, sh3, list_signal: of_sh2_and_sh3_product / of_sh2_and_sh3_product_rgb;);
        products_to_4!($scalar, table, sh4, list_signal: of_sh2_and_sh4_product / of_sh2_and_sh4_product_rgb;);
        products!($scalar, table, sh5,
            list_signal: of_sh2_and_sh5_product / of_sh2_and_sh5_product_rgb, product_grey / product_grey_rgb;);
        products!($scalar, table, sh6,);
        irradiances!($scalar, table);
        table
    }};
}

/// Equality to the last bit, but for NaN, which has many.
trait Same: Number {
    fn same(self, other: Self) -> bool;
}

macro_rules! same {
    ($($number:ident)*) => { $(
        impl Same for $number {
            fn same(self, other: Self) -> bool {
                self.to_bits() == other.to_bits() || (self.is_nan() && other.is_nan())
            }
        }
    )* };
}
same!(f32 f64);

fn assert_same<T: Same + Debug>(got: &[T], want: &[T], what: impl Fn() -> String) {
    let same = got.len() == want.len() && got.iter().zip(want).all(|(a, b)| a.same(*b));
    assert!(same, "{}: {got:?} is not {want:?}", what());
}

/// Runs every spec of the catalogue in one precision, in the interpreter and from the table.
fn compare<T: Same>(table: &BTreeMap<&'static str, Flattened<T>>) {
    let specs = catalog::standard();
    let names: Vec<String> = specs.iter().map(Spec::name).collect();
    for name in table.keys() {
        assert!(names.iter().any(|known| known == name), "`{name}` is in the table, but not in the catalogue");
    }
    let mut kernels: BTreeMap<Spec, (Vec<Param>, Runner<T>)> = BTreeMap::new();
    for spec in &specs {
        let name = spec.name();
        let function = table.get(&name[..]).unwrap_or_else(|| panic!("`{name}` is missing in the table of this test"));
        let (params, runner) = kernels.entry(spec.base()).or_insert_with(|| {
            let code = spec.code();
            (code.params().to_vec(), code.runner())
        });
        compare_one(spec, params, runner, function);
    }
}

fn compare_one<T: Same>(spec: &Spec, params: &[Param], runner: &Runner<T>, function: &Flattened<T>) {
    let inputs: Vec<Vec<Vec<T>>> = samples::inputs(params, SEED, SAMPLES, None)
        .iter()
        .map(|input| input.iter().map(|row| row.iter().map(|&x| T::from_f64(x)).collect()).collect())
        .collect();
    let channels = spec.channels();
    for i in 0..SAMPLES {
        // The parameters of one input, the signals of as many inputs as there are channels.
        let one = |channel: usize| -> Vec<&[T]> {
            let of = |param: &Param| if param.kind.is_scalar() { i } else { (i + channel) % SAMPLES };
            params.iter().enumerate().map(|(place, param)| &inputs[of(param)][place][..]).collect()
        };
        let each: Vec<Vec<T>> = (0..channels).map(|channel| runner.run(&one(channel), Contraction::Separate)).collect();
        let rows: Vec<Vec<T>> = (0..params.len())
            .map(|place| {
                let channels = params[place].kind.numbers(channels);
                interleaved(&(0..channels).map(|channel| one(channel)[place]).collect::<Vec<_>>())
            })
            .collect();
        let want = interleaved(&each.iter().map(Vec::as_slice).collect::<Vec<_>>());
        assert_same(&function(&rows), &want, || format!("{spec} at input {i}"));
    }
}

fn interleaved<T: Copy>(rows: &[&[T]]) -> Vec<T> {
    (0..rows[0].len()).flat_map(|i| rows.iter().map(move |row| row[i])).collect()
}

#[test]
fn every_function_equals_the_interpreter_bit_for_bit_in_f32() {
    compare::<f32>(&every_order!(f32));
}

#[test]
fn every_function_equals_the_interpreter_bit_for_bit_in_f64() {
    compare::<f64>(&every_order!(f64));
}

const LANES: usize = 16;

/// Sixteen problems at once and one by one.
fn lanes<const P: usize, const N: usize, const R: usize>(
    seed: u64,
    at_once: impl Fn([Lanes<f32, LANES>; P], &[Lanes<f32, LANES>; N]) -> [Lanes<f32, LANES>; R],
    one: impl Fn([f32; P], &[f32; N]) -> [f32; R],
) {
    let mut random = Random::new(seed);
    let params: [[f32; P]; LANES] = std::array::from_fn(|_| random.unit().map(|x| x as f32));
    let signals: [[f32; N]; LANES] = std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32));
    let got = at_once(across(&params), &across(&signals));
    for lane in 0..LANES {
        let want = one(params[lane], &signals[lane]);
        assert_same(&got.map(|value| value.0[lane]), &want, || format!("lane {lane}"));
    }
}

fn across<const N: usize>(rows: &[[f32; N]; LANES]) -> [Lanes<f32, LANES>; N] {
    std::array::from_fn(|i| Lanes(rows.map(|row| row[i])))
}

#[test]
fn lanes_equal_single_runs_bit_for_bit() {
    lanes(1, |dir, _: &[_; 0]| zonal::sh5::basis(dir), |dir, _| zonal::sh5::basis(dir));
    lanes(2, |dir, c| [zonal::sh8::eval(dir, c)], |dir, c| [zonal::sh8::eval(dir, c)]);
    lanes(3, zonal::sh3::rotate, zonal::sh3::rotate);
    lanes(4, zonal::sh5::rotate, zonal::sh5::rotate);
    lanes(5, zonal::sh4::rotate_align, zonal::sh4::rotate_align);
    lanes(6, zonal::sh5::tilt, zonal::sh5::tilt);
    lanes(7, |[beta], c| zonal::sh5::lf3_y(beta, c), |[beta], c| zonal::sh5::lf3_y(beta, c));
}

#[test]
fn channels_of_lanes_equal_single_runs_bit_for_bit() {
    type Wide = Lanes<f32, LANES>;
    let mut random = Random::new(8);
    let q: [[f32; 4]; LANES] = std::array::from_fn(|_| random.unit().map(|x| x as f32));
    let signals: [[[f32; 25]; LANES]; 3] =
        std::array::from_fn(|_| std::array::from_fn(|_| std::array::from_fn(|_| random.signed() as f32)));
    let wide = signals.map(|channel| across(&channel));
    let c: [Channels<Wide, 3>; 25] = std::array::from_fn(|i| Channels([wide[0][i], wide[1][i], wide[2][i]]));
    let got = zonal::sh5::rotate(across(&q), &c);
    for (channel, signal) in signals.iter().enumerate() {
        for lane in 0..LANES {
            let want = zonal::sh5::rotate(q[lane], &signal[lane]);
            assert_same(&got.map(|value| value.0[channel].0[lane]), &want, || {
                format!("channel {channel}, lane {lane}")
            });
        }
    }
}
