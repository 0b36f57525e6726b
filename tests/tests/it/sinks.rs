//! Rust kernels into a sink: every number is handed over once, with the bits of the kernel by value, also where it goes to the place
//! from which another was read.

use zonal::Coefficients;
use zonal_codegen::promise::samples::Random;

/// What a function hands over, number by number; each must come once.
fn gathered<T: Copy + std::fmt::Debug, const N: usize>(work: impl FnOnce(&mut dyn FnMut(usize, T))) -> [T; N] {
    let mut found = [None; N];
    work(&mut |i, x| assert!(found[i].replace(x).is_none(), "number {i} comes twice"));
    found.map(|x| x.expect("every number comes"))
}

#[test]
fn kernels_into_a_sink_have_the_bits_of_those_by_value() {
    macro_rules! sinks {
        ($($module:ident $count:literal [$($l:literal $band:ident)*]),*) => { $({
            let mut random = Random::new(12);
            for _ in 0..20 {
                let q = random.unit::<4>().map(|x| x as f32);
                let direction = random.unit::<3>().map(|x| x as f32);
                let c = <[f32; $count]>::from_fn(|_| random.signed() as f32);
                let basis: [f32; $count] =
                    gathered(|sink| zonal_kernels::batch::$module::basis(direction, &mut |i, x| sink(i, x)));
                assert_eq!(basis, zonal::$module::basis(direction));
                let value: f32 = zonal_kernels::batch::$module::eval(direction, &|i| c[i]);
                assert_eq!(value, zonal::$module::eval(direction, &c));
                let mut set_up = std::array::from_fn(|_| f32::NAN);
                zonal_kernels::batch::$module::rotate_setup(q, &mut |i, x| set_up[i] = x);
                let wanted = zonal::$module::rotate(q, &c);
                $(
                    let first = $l * $l;
                    // In one place: what is read is not read again once it is written.
                    let place = std::cell::RefCell::new(c);
                    zonal_kernels::batch::$module::$band(
                        &set_up,
                        &|i| place.borrow()[first + i],
                        &mut |i, x: f32| place.borrow_mut()[first + i] = x,
                    );
                    let band = first..first + 2 * $l + 1;
                    assert_eq!(place.borrow()[band.clone()], wanted[band], "band {} of {}", $l, stringify!($module));
                )*
            }
        })* };
    }
    sinks!(
        sh2 4 [1 band_1_rotate],
        sh3 9 [1 band_1_rotate 2 band_2_rotate],
        sh5 25 [1 band_1_rotate 2 band_2_rotate 3 band_3_rotate 4 band_4_rotate],
        sh10 100 [1 band_1_rotate 5 band_5_rotate 9 band_9_rotate]
    );
}

#[test]
fn a_loop_is_refused_into_a_sink_and_says_what_to_do() {
    use zonal_codegen::builder::Builder;
    use zonal_codegen::emit::language::{Arrays, RUST};
    let module = |spec: &str| Builder::new("kernels").target(&RUST).arrays(Arrays::Sink).spec(spec).generate();
    let text = &module("rotate:4").expect("straight lines are printed")[0].text;
    assert!(text.contains("c: &impl Fn(usize) -> V, result: &mut impl FnMut(usize, V)"), "{text}");
    let error = module("rotate:4:loop").expect_err("a loop is no sequence").to_string();
    assert!(error.contains("leave `loop` out"), "{error}");
}
