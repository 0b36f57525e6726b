//! Nanoseconds a vector of the compiled kernels. A time means little on another machine, so that each is also given as
//! a ratio to a copy of the same bytes, timed in turn with the kernel in the same run. Behind the feature `times`: its
//! kernels take minutes to compile, which no test waits for.

use crate::timing::{Single, Time, Times, Timing};
use crate::{Progress, significant};
use std::hint::black_box;
use std::time::Instant;
use zonal::real::{Lanes, Real, Signal};
use zonal_codegen::promise::samples::{Random, matrix_of};

/// How many rounds of copy and kernel a median is taken over.
const ROUNDS: usize = 15;
/// The bytes of each of the two buffers: more than the first cache holds, less than the second.
const BYTES: usize = 1 << 17;
/// A round passes over the buffers so often and takes the fastest pass, which nothing else on the machine broke into.
const PASSES: usize = 5;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    significant(values[values.len() / 2])
}

fn seconds(mut work: impl FnMut()) -> f64 {
    let pass = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..PASSES).map(pass).fold(f64::INFINITY, f64::min)
}

/// A kernel as a call that nothing is shared with, and that writes its result where it belongs: what it takes alone.
#[inline(never)]
fn call<P, A, R>(kernel: &impl Fn(&P, &A) -> R, p: &P, c: &A, out: &mut R) {
    *out = kernel(p, c);
}

/// Times a kernel against a copy, by single calls and inlined into a plain loop over slices; `lanes` vectors are worked on
/// at once.
fn time<T: Real, P: Clone, const N: usize>(
    lanes: usize,
    params: &[P],
    kernel: impl Fn(&P, &[T; N]) -> [T; N],
) -> [Time; 2] {
    let count = (BYTES / size_of::<[T; N]>()).max(params.len());
    let params: Vec<P> = params.iter().cycle().take(count).cloned().collect();
    let input: Vec<[T; N]> = (0..count).map(|i| std::array::from_fn(|j| T::lit(((i + j) % 7) as f64 - 3.0))).collect();
    let mut output = input.clone();
    let mut rounds: [Vec<[f64; 2]>; 2] = Default::default();
    for _ in 0..ROUNDS {
        let copy = seconds(|| black_box(&mut output).copy_from_slice(black_box(&input)));
        let single = seconds(|| {
            for ((out, c), p) in black_box(&mut output).iter_mut().zip(black_box(&input)).zip(black_box(&params)) {
                call(&kernel, p, c, out);
            }
        });
        let plain = seconds(|| {
            for ((out, c), p) in black_box(&mut output).iter_mut().zip(black_box(&input)).zip(black_box(&params)) {
                *out = kernel(p, c);
            }
        });
        for (rounds, run) in rounds.iter_mut().zip([single, plain]) {
            rounds.push([run * 1e9 / (count * lanes) as f64, run / copy]);
        }
    }
    rounds.map(|rounds| {
        let of = |place: usize| median(rounds.iter().map(|round| round[place]).collect());
        Time { nanoseconds: of(0), copies: of(1) }
    })
}

/// Parameters for a kernel: quaternions, some of them near to the identity, normals, phases, small angles.
struct Params<T> {
    quaternions: Vec<[T; 4]>,
    near: Vec<[T; 4]>,
    normals: Vec<[T; 3]>,
    phases: Vec<[T; 2]>,
    angles: Vec<T>,
}

impl<T: Real> Params<T> {
    fn new() -> Self {
        let mut random = Random::new(1);
        Self {
            quaternions: (0..64).map(|_| random.unit::<4>().map(T::lit)).collect(),
            near: (0..64).map(|_| near(random.unit::<4>()).map(T::lit)).collect(),
            normals: (0..64).map(|_| random.unit::<3>().map(f64::abs).map(T::lit)).collect(),
            phases: (0..64).map(|_| random.unit::<2>().map(T::lit)).collect(),
            angles: (0..64).map(|_| T::lit(0.2 * random.signed())).collect(),
        }
    }
}

/// A unit quaternion whose y angle is at most six degrees.
fn near([x, y, z, w]: [f64; 4]) -> [f64; 4] {
    let (small, large) = (x.hypot(y), z.hypot(w));
    let (sin, cos) = 0.05f64.sin_cos();
    [x / small * sin, y / small * sin, z / large * cos, w / large * cos]
}

/// The three layouts of one kernel, after a set-up that is not timed if there is one.
macro_rules! times {
    (@ $p:ident) => { *$p };
    (@ $p:ident $set_up:ident) => { $p };
    ($order:literal, $spec:literal, $field:ident $($set_up:ident)?, $module:ident :: $name:ident) => {{
        fn layout<T: Real + Signal<T>>(lanes: usize) -> [Time; 2] {
            let params = Params::<T>::new();
            let all = params.$field.into_iter()$(.map(zonal::$module::$set_up))?.collect::<Vec<_>>();
            time(lanes, &all, |p, c: &[T; $order * $order]| {
                zonal::$module::$name(times!(@ p $($set_up)?), c)
            })
        }
        let [f32, plain] = layout::<f32>(1);
        Times {
            spec: format!($spec, $order),
            order: $order,
            f32,
            plain,
            f64: layout::<f64>(1)[0],
            lanes: layout::<Lanes<f32, 16>>(16)[1],
        }
    }};
}

/// The kernels that are timed at one order.
macro_rules! order {
    ($kernels:ident, $order:literal, $module:ident, $zyz:literal $zyz_name:ident $(, $spec:literal $field:ident $name:ident)*) => {
        order!(@ $kernels, $order, $module,
            $zyz (quaternions) $zyz_name,
            "rotate:{}:zxzxz" (quaternions) rotate_zxzxz,
            "rotate:{}:angles" (quaternions angles) rotate_angles,
            "rotate:{}:lifted" (near lifted) rotate_lifted,
            "rotate_small:{}" (near) rotate_small,
            "rotate:{}:align" (normals) rotate_align,
            "tilt:{}" (normals) tilt,
            "rotate_y:{}" (phases) rotate_y,
            "taylor1:{}" (angles) taylor1_y,
            "taylor15:{}" (angles) taylor15_y,
            "taylor2:{}" (angles) taylor2_y,
            "lf3:{}" (angles) lf3_y,
            "lf5:{}" (angles) lf5_y
            $(, $spec ($field) $name)*
        );
    };
    (@ $kernels:ident, $order:literal, $module:ident, $($spec:literal ($field:ident $($set_up:ident)?) $name:ident),*) => { $(
        $kernels.push(|| times!($order, $spec, $field $($set_up)?, $module::$name));
    )* };
}

/// Ways to turn at one order, by the module's function: from a quaternion, from a matrix, from samples.
macro_rules! turns {
    ($turns:ident, $($order:literal $module:ident $rotate:ident $spec:literal),*) => { $(
        $turns.push(|turning| turning.time($order, $spec, &turning.quaternions, |q, c: &[f32; $order * $order]| {
            zonal::$module::$rotate(*q, c)
        }));
        $turns.push(|turning| turning.time($order, "rotate:{}:zxzxz", &turning.quaternions, |q, c| {
            let turned: [f32; $order * $order] = zonal::$module::rotate_zxzxz(*q, c);
            turned
        }));
        $turns.push(|turning| turning.time($order, "zhf:{}", &turning.matrices, |m, c: &[f32; $order * $order]| {
            zonal::$module::zhf(m, c)
        }));
        $turns.push(|turning| turning.time($order, "zhf_tailored:{}", &turning.angles, |_, f: &[f32; $order * $order]| {
            zonal::$module::zhf_tailored(f)
        }));
        $turns.push(|turning| turning.time($order, "rotate:{}:taylor15", &turning.angles, |(cs, beta), c| {
            let turned: [f32; $order * $order] = zonal::$module::taylor15_zyz(cs, *beta, c);
            turned
        }));
        $turns.push(|turning| turning.time($order, "rotate_small:{}", &turning.near, |q, c: &[f32; $order * $order]| {
            zonal::$module::rotate_small(*q, c)
        }));
    )* };
}

/// What ways to turn are given.
struct Turning {
    quaternions: Vec<[f32; 4]>,
    near: Vec<[f32; 4]>,
    matrices: Vec<[[f32; 3]; 3]>,
    /// Two phases and a small angle between them.
    angles: Vec<([[f32; 2]; 2], f32)>,
}

impl Turning {
    fn new() -> Self {
        let Params { quaternions, near, .. } = Params::<f32>::new();
        let matrix = |q: &[f32; 4]| {
            let m = matrix_of(q.map(f64::from)).map(|x| x as f32);
            [0, 3, 6].map(|i| [m[i], m[i + 1], m[i + 2]])
        };
        let mut random = Random::new(2);
        let mut phase = || random.unit::<2>().map(|x| x as f32);
        let angles = (0..64).map(|i| ([phase(), phase()], i as f32 / 640.0)).collect();
        Self { matrices: quaternions.iter().map(matrix).collect(), quaternions, near, angles }
    }

    fn time<P: Clone, const N: usize>(
        &self,
        order: usize,
        spec: &str,
        params: &[P],
        kernel: impl Fn(&P, &[f32; N]) -> [f32; N],
    ) -> Single {
        Single { spec: spec.replace("{}", &order.to_string()), order, time: time(1, params, kernel)[0] }
    }
}

/// Times the kernels of the orders 3, 5 and 8, and ways to turn at the orders 3 to 10, one after another.
pub fn measure(progress: &dyn Progress) -> Timing {
    let mut kernels: Vec<fn() -> Times> = Vec::new();
    order!(kernels, 3, sh3, "rotate:{}:zyz" rotate_zyz);
    order!(kernels, 5, sh5, "rotate:{}" rotate, "tilt_prescaled:{}" normals tilt_prescaled);
    order!(kernels, 8, sh8, "rotate:{}" rotate, "tilt_prescaled:{}" normals tilt_prescaled);
    let mut turns: Vec<fn(&Turning) -> Single> = Vec::new();
    turns!(
        turns, 3 sh3 rotate_zyz "rotate:{}:zyz", 4 sh4 rotate "rotate:{}", 5 sh5 rotate "rotate:{}",
        6 sh6 rotate "rotate:{}", 7 sh7 rotate "rotate:{}", 8 sh8 rotate "rotate:{}", 9 sh9 rotate "rotate:{}",
        10 sh10 rotate "rotate:{}"
    );
    progress.stage("times", kernels.len() + turns.len());
    let time = |kernel: fn() -> Times| {
        let times = kernel();
        progress.step();
        times
    };
    let turning = Turning::new();
    Timing {
        machine: format!("{}, {}", std::env::consts::ARCH, std::env::consts::OS),
        kernels: kernels.into_iter().map(time).collect(),
        turns: turns
            .into_iter()
            .map(|turn| {
                let time = turn(&turning);
                progress.step();
                time
            })
            .collect(),
    }
}
