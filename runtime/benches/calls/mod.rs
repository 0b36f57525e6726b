//! The five calls that everybody makes, at the orders 2 to 10 in f32, in each form that a program has them: `call`,
//! zonal's function compiled by itself, which returns its result; `into`, its result written in place, by the function that does
//! so where there is one, else by the kernel; `loop`, the kernel inlined into a plain loop over slices. Beside them what memory alone takes. Nothing here knows a clock: the
//! bench `single` times the rows, `instructions` does each once, and `measure/peers` times them beside others.

/// What a call is given.
pub struct Inputs {
    /// Unit quaternions (x, y, z, w), one a signal.
    pub quaternions: Vec<[f32; 4]>,
    /// Unit directions, one a signal.
    pub directions: Vec<[f32; 3]>,
    /// Normals that lean by 17 degrees at most, one a signal.
    pub normals: Vec<[f32; 3]>,
    /// Signals of 100 numbers, of which an order takes the first n².
    pub signals: Vec<[f32; 100]>,
}

impl Inputs {
    /// Returns so many inputs, the same ones on every run: numbers from −1 to 1, directions uniform on the sphere.
    pub fn new(count: usize) -> Self {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut signed = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let quaternions: Vec<[f32; 4]> = (0..count).map(|_| unit(&mut signed)).collect();
        let directions: Vec<[f32; 3]> = (0..count).map(|_| unit(&mut signed)).collect();
        let normal = |dir: &[f32; 3]| {
            let (x, y) = (0.3 * f64::from(dir[0]), 0.3 * f64::from(dir[1]));
            let length = (x * x + y * y + 1.0).sqrt();
            [x / length, y / length, 1.0 / length].map(|x| x as f32)
        };
        let normals = directions.iter().map(normal).collect();
        let signals = (0..count).map(|_| std::array::from_fn(|_| signed() as f32)).collect();
        Self { quaternions, directions, normals, signals }
    }
}

/// A vector of length one, normalised in f64.
fn unit<const N: usize>(signed: &mut impl FnMut() -> f64) -> [f32; N] {
    loop {
        let x: [f64; N] = std::array::from_fn(|_| signed());
        let square: f64 = x.iter().map(|x| x * x).sum();
        if (0.01..=1.0).contains(&square) {
            return x.map(|x| (x / square.sqrt()) as f32);
        }
    }
}

/// What a row does to all signals.
pub trait Work {
    /// Does it once.
    fn run(&mut self);
    /// Returns what was written last, signal after signal.
    fn written(&self) -> &[f32];
}

/// What turns parameters and signals into results.
type Body<P, const N: usize, const M: usize> = fn(&[P], &[[f32; N]], &mut [[f32; M]]);

struct Batch<P, const N: usize, const M: usize> {
    params: Vec<P>,
    signals: Vec<[f32; N]>,
    results: Vec<[f32; M]>,
    body: Body<P, N, M>,
}

impl<P, const N: usize, const M: usize> Batch<P, N, M> {
    /// Results begin half a page from where signals do: at one place of a page, as large allocations are, a load waits for a
    /// store that it has nothing to do with, and what is timed is that.
    const SKIP: usize = 2048 / size_of::<[f32; M]>();

    fn new(params: Vec<P>, signals: Vec<[f32; N]>, body: Body<P, N, M>) -> Self {
        let results = vec![[0.0; M]; signals.len() + Self::SKIP];
        Self { params, signals, results, body }
    }
}

impl<P, const N: usize, const M: usize> Work for Batch<P, N, M> {
    fn run(&mut self) {
        (self.body)(&self.params, &self.signals, &mut self.results[Self::SKIP..]);
    }

    fn written(&self) -> &[f32] {
        self.results[Self::SKIP..].as_flattened()
    }
}

/// Makes a row's work ready for inputs: reads and writes nothing that another row does.
pub type Make = Box<dyn Fn(&Inputs) -> Box<dyn Work>>;

/// A function in one form, at one order.
pub struct Row {
    /// The function's name in zonal; `copy` copies the signals, `fill` writes as many numbers.
    pub function: &'static str,
    /// `call`, `into` or `loop`; nothing of a copy and a fill.
    pub form: &'static str,
    /// The order.
    pub order: usize,
    /// What it does.
    pub make: Make,
}

/// One function of an order, as the crate has it and as the kernel that it calls, and its rows.
macro_rules! function {
    (
        $name:ident, $order:literal, $each:ident, $results:expr,
        crate |$p:ident: $param:ty, $c:ident| $called:expr, $params:expr;
        kernel |$q:ident: $own:ty| $kernel:expr, $owns:expr;
        into |$place:ident| $into:expr
    ) => {
        pub mod $name {
            use super::super::{Batch, Body, Inputs, Make, Row};

            const N: usize = $order * $order;
            type Signal = [f32; N];
            type Written = [f32; $results];

            #[inline(never)]
            pub fn call($p: &$param, $c: &Signal) -> Written {
                $called
            }

            #[inline(never)]
            pub fn into($q: &$own, $c: &Signal, $place: &mut Written) {
                $into;
            }

            fn row<P: 'static>(form: &'static str, params: fn(&Inputs) -> Vec<P>, body: Body<P, N, $results>) -> Row {
                let make: Make =
                    Box::new(move |inputs| Box::new(Batch::new(params(inputs), super::signals(inputs), body)));
                Row { function: stringify!($name), form, order: $order, make }
            }

            pub fn rows() -> [Row; 3] {
                let params: fn(&Inputs) -> Vec<$param> = $params;
                let owns: fn(&Inputs) -> Vec<$own> = $owns;
                [
                    row("call", params, |params, c, out| {
                        $each!(params).zip(c).zip(out).for_each(|((p, c), out)| *out = call(p, c));
                    }),
                    row("into", owns, |params, c, out| {
                        $each!(params).zip(c).zip(out).for_each(|((p, c), out)| into(p, c, out));
                    }),
                    row("loop", owns, |params, c, out| {
                        for (($q, $c), out) in $each!(params).zip(c).zip(out) {
                            *out = $kernel;
                        }
                    }),
                ]
            }
        }
    };
}

/// A parameter a signal.
macro_rules! many {
    ($params:ident) => {
        $params.iter()
    };
}

/// One parameter for all signals.
macro_rules! one {
    ($params:ident) => {
        std::iter::repeat(&$params[0])
    };
}

macro_rules! orders {
    ($($module:ident $kernels:ident $order:literal),*) => {
        $(pub mod $module {
            use super::{Batch, Body, Inputs, Make, Row};

            fn signals<const N: usize>(inputs: &Inputs) -> Vec<[f32; N]> {
                inputs.signals.iter().map(|c| std::array::from_fn(|i| c[i])).collect()
            }

            function!(
                rotate, $order, many, N,
                crate |q: [f32; 4], c| zonal::rotate(*q, c), |inputs| inputs.quaternions.clone();
                kernel |q: [f32; 4]| zonal::$kernels::rotate(*q, c), |inputs| inputs.quaternions.clone();
                into |to| zonal::rotate_into(*q, c, to)
            );
            function!(
                apply, $order, one, N,
                crate |turn: zonal::Rotation<Signal>, c| turn.apply(c),
                |inputs| vec![zonal::Rotation::new(inputs.quaternions[0])];
                kernel |angles: [[f32; 2]; 3 * $order - 2]| zonal::$kernels::rotate_angles(angles, c),
                |inputs| vec![zonal::$kernels::angles(inputs.quaternions[0])];
                into |to| *to = zonal::$kernels::rotate_angles(angles, c)
            );
            function!(
                evaluate_basis, $order, many, N,
                crate |dir: [f32; 3], _c| zonal::evaluate_basis(*dir), |inputs| inputs.directions.clone();
                kernel |dir: [f32; 3]| zonal::$kernels::basis(*dir), |inputs| inputs.directions.clone();
                into |to| zonal::evaluate_basis_into(*dir, to)
            );
            function!(
                evaluate, $order, many, 1,
                crate |dir: [f32; 3], c| [zonal::evaluate(*dir, c)], |inputs| inputs.directions.clone();
                kernel |dir: [f32; 3]| [zonal::$kernels::eval(*dir, c)], |inputs| inputs.directions.clone();
                into |to| *to = [zonal::$kernels::eval(*dir, c)]
            );
            function!(
                tilt, $order, many, N,
                crate |n: [f32; 3], c| zonal::tilt(*n, c), |inputs| inputs.normals.clone();
                kernel |n: [f32; 3]| zonal::$kernels::tilt(*n, c), |inputs| inputs.normals.clone();
                into |to| zonal::tilt_into(*n, c, to)
            );

            pub fn rows() -> Vec<Row> {
                const N: usize = $order * $order;
                let memory = |function, body: Body<(), N, N>| {
                    let make: Make = Box::new(move |inputs| Box::new(Batch::new(Vec::new(), signals(inputs), body)));
                    Row { function, form: "", order: $order, make }
                };
                let mut rows = vec![
                    memory("copy", |_, c, out| out.copy_from_slice(c)),
                    memory("fill", |_, _, out| out.fill([0.0; N])),
                ];
                rows.extend(rotate::rows());
                rows.extend(apply::rows());
                rows.extend(evaluate_basis::rows());
                rows.extend(evaluate::rows());
                rows.extend(tilt::rows());
                rows
            }
        })*

        /// Returns every row of the orders, ascending.
        pub fn rows() -> Vec<Row> {
            [$($module::rows()),*].into_iter().flatten().collect()
        }
    };
}

orders!(
    order2 sh2 2, order3 sh3 3, order4 sh4 4, order5 sh5 5, order6 sh6 6, order7 sh7 7, order8 sh8 8, order9 sh9 9,
    order10 sh10 10
);
