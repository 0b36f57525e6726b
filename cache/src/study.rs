//! What is measured: each way to turn records, the limits of the adaptive rotation, and one cache for three cameras.

use crate::basis::Basis;
use crate::cache::{Cache, Count};
use crate::gloss::{Gloss, Slices};
use crate::methods::{Limit, Method};
use crate::picture::{self, Square};
use crate::record::Sampling;
use crate::scene::Scene;
use crate::view::{Shown, View, rms};
use cpu_time::ProcessTime;
use zonal_picture::camera::Camera;
use zonal_picture::tone;

/// How often a frame is made; the shortest time counts.
const TIMES: usize = 5;
/// The errors a that are compared.
pub const ERRORS: [f64; 6] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5];
/// The limits that are compared; the last is held where the first is at a = 0.1.
pub const LIMITS: [(&str, Limit); 3] =
    [("1.25 a", Limit::Rounded), ("closed form", Limit::Closed), ("held at 7.2 degrees", Limit::Held(0.125))];
/// How the rooms are looked at from the front.
pub const CAMERA: Camera = Camera { azimuth: -90.0, elevation: 0.0, distance: 3.6, field: 42.0 };

/// A scene as a camera sees it, with its picture by brute force.
pub struct Setup<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What is glossy in it.
    pub gloss: Gloss,
    /// What the camera sees.
    pub view: &'a View,
    /// The glossy pixels by brute force.
    pub truth: &'a [[f64; 3]],
    /// How records are sampled.
    pub sampling: Sampling,
}

/// One way to turn records.
#[derive(Clone, Debug)]
pub struct Row {
    /// The method's name.
    pub name: &'static str,
    /// Its kernels.
    pub kernels: &'static str,
    /// The frame, in seconds.
    pub seconds: f64,
    /// What a rotation takes beyond leaving it out, in seconds.
    pub rotation: f64,
    /// The rotations of a frame.
    pub count: Count,
    /// Whether it has a method of its own below the limit.
    pub is_adaptive: bool,
    /// The error against the exact method.
    pub exact: f64,
    /// The error against brute force.
    pub truth: f64,
}

/// All ways for one cache.
#[derive(Clone, Debug)]
pub struct Table {
    /// The basis and its order.
    pub basis: (&'static str, usize),
    /// The error a.
    pub error: f64,
    /// How many records there are.
    pub records: usize,
    /// How long they took, in seconds.
    pub filling: f64,
    /// The ways, the first none, the last exact.
    pub rows: Vec<Row>,
}

/// The limits for one error.
#[derive(Clone, Debug)]
pub struct Step {
    /// The error a.
    pub error: f64,
    /// How many records there are.
    pub records: usize,
    /// For each of [`LIMITS`] its angle in degrees, the share of exact rotations, the frame's seconds, the error against the
    /// exact method.
    pub limits: Vec<[f64; 4]>,
    /// The exact method's seconds.
    pub seconds: f64,
    /// The exact method's error against brute force.
    pub truth: f64,
}

/// What brute force takes to err as much as a cache.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equal {
    /// How many rays a pixel.
    pub rays: f64,
    /// For how many seconds.
    pub seconds: f64,
    /// Whether it came so far; else this is the most that was tried.
    pub is_reached: bool,
}

/// A camera that reuses a cache.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Where it stands, in degrees.
    pub azimuth: f64,
    /// How many records it added.
    pub added: usize,
    /// How long they took, in seconds.
    pub filling: f64,
    /// The frame from the cache on one thread, in seconds.
    pub seconds: f64,
    /// Its error against brute force.
    pub truth: f64,
    /// How brute force comes to err as much.
    pub equal: Equal,
    /// How many times as long that is, and how many times it is at a picture of 850 by 850 pixels.
    pub times: [f64; 2],
}

/// The shortest of some times.
fn timed<const C: usize>(
    setup: &Setup,
    cache: &Cache<C>,
    slices: &Slices<C>,
    method: &Method<C>,
    limit: Limit,
) -> Shown {
    let frame = || setup.view.cached(cache, slices, method, cache.limit(limit));
    (1..TIMES).map(|_| frame()).fold(frame(), |best, next| if next.seconds < best.seconds { next } else { best })
}

/// Returns a cache that serves all glossy pixels, and the seconds of the processor that it took.
pub fn filled<const C: usize>(setup: &Setup, basis: Basis<C>, error: f64, tick: &dyn Fn()) -> (Cache<C>, f64) {
    let start = ProcessTime::now();
    let mut cache = Cache::new(basis, error);
    cache.fill(setup.scene, setup.view.places(), setup.sampling, tick);
    (cache, start.elapsed().as_secs_f64())
}

/// The last method of a basis, which is exact.
fn exact_of<const C: usize>(basis: &Basis<C>) -> &'static Method<C> {
    &basis.methods[basis.methods.len() - 1]
}

/// Returns what each way takes and errs by.
pub fn table<const C: usize>(setup: &Setup, cache: &Cache<C>, filling: f64) -> Table {
    let basis = &cache.basis;
    let slices = Slices::new(*basis, &setup.gloss);
    let shown: Vec<Shown> =
        basis.methods.iter().map(|method| timed(setup, cache, &slices, method, Limit::Rounded)).collect();
    let (ignored, exact) = (&shown[0], &shown[shown.len() - 1]);
    let row = |(method, shown): (&Method<C>, &Shown)| Row {
        name: method.name,
        kernels: method.kernels,
        seconds: shown.seconds,
        rotation: (shown.seconds - ignored.seconds) / shown.count.all.max(1) as f64,
        count: shown.count,
        is_adaptive: method.small.is_some(),
        exact: rms(&shown.radiance, &exact.radiance),
        truth: rms(&shown.radiance, setup.truth),
    };
    Table {
        basis: (basis.name, basis.order),
        error: cache.error,
        records: cache.records.len(),
        filling,
        rows: basis.methods.iter().zip(&shown).map(row).collect(),
    }
}

/// Returns what the limits do for each of [`ERRORS`], with the method of that name.
pub fn steps<const C: usize>(setup: &Setup, basis: Basis<C>, name: &str, tick: &dyn Fn()) -> Vec<Step> {
    let slices = Slices::new(basis, &setup.gloss);
    let exact = exact_of(&basis);
    let method = basis.methods.iter().find(|method| method.name == name).unwrap_or(exact);
    let step = |error: f64| {
        let (cache, _) = filled(setup, basis, error, tick);
        let best = timed(setup, &cache, &slices, exact, Limit::Closed);
        let limited = |(_, limit): &(&str, Limit)| {
            let shown = timed(setup, &cache, &slices, method, *limit);
            let share = shown.count.any as f64 / shown.count.all.max(1) as f64;
            let angle = limit.angle(error).to_degrees();
            [angle, share, shown.seconds, rms(&shown.radiance, &best.radiance)]
        };
        Step {
            error,
            records: cache.records.len(),
            limits: LIMITS.iter().map(limited).collect(),
            seconds: best.seconds,
            truth: rms(&best.radiance, setup.truth),
        }
    };
    ERRORS.into_iter().map(step).collect()
}

/// Returns four squares: where the records are, the picture from the cache by the exact method, the difference of a method
/// from that (yellow at `bright` of the mean), brute force.
pub fn squares<const C: usize>(setup: &Setup, cache: &Cache<C>, name: &str, bright: f64) -> Vec<Square> {
    let slices = Slices::new(cache.basis, &setup.gloss);
    let exact = exact_of(&cache.basis);
    let method = cache.basis.methods.iter().find(|method| method.name == name).unwrap_or(exact);
    let limit = cache.limit(Limit::Rounded);
    let [best, near] = [exact, method].map(|method| setup.view.cached(cache, &slices, method, limit).radiance);
    let (picture, truth) = (setup.view.with(&best), setup.view.with(setup.truth));
    let exposure = exposure(&truth);
    vec![
        picture::records(setup.view, cache, &picture, exposure),
        picture::shown(&picture, exposure),
        picture::difference(setup.view, &near, &best, bright),
        picture::shown(&truth, exposure),
    ]
}

/// Returns the factor with which a picture is shown.
pub fn exposure(picture: &[[f64; 3]]) -> f64 {
    // The lamp is white whatever the exposure: it is left out.
    tone::exposure(picture.iter().copied().filter(|v| v[0] < 10.0))
}

/// What three cameras do with one cache, and the squares of what they see.
pub struct Tour {
    /// The cameras.
    pub stops: Vec<Stop>,
    /// How many records the first would add in a picture of twice as many pixels a side.
    pub doubled: usize,
    /// From the cache, one a camera, then brute force of the first.
    pub squares: Vec<Square>,
}

/// How a tour is taken.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Where the cameras stand, in degrees.
    pub azimuths: &'a [f64],
    /// The pixels along a side.
    pub side: usize,
    /// The error a.
    pub error: f64,
    /// How records are sampled.
    pub sampling: Sampling,
    /// How many rays a pixel the pictures by brute force take.
    pub rays: usize,
}

/// Returns what brute force takes to err as little as `error` against the truth: its rays are doubled until it does, and the
/// last two are interpolated.
fn equal(view: &View, scene: &Scene, truth: &[[f64; 3]], error: f64, plan: &Plan) -> Equal {
    let mut before: Option<(f64, f64, f64)> = None;
    let mut rays = 4;
    loop {
        let shown = view.brute_force(scene, rays, plan.sampling.seed.wrapping_add(1), || ());
        let now = (rays as f64, shown.seconds, rms(&shown.radiance, truth));
        let is_reached = now.2 <= error;
        if is_reached || 4 * rays > plan.rays {
            let share = match before {
                Some((_, _, last)) if is_reached => (last / error).ln() / (last / now.2).ln(),
                _ => 1.0,
            };
            let (few, seconds, _) = before.unwrap_or(now);
            let mixed = |a: f64, b: f64| (a.ln() + share * (b / a).ln()).exp();
            return Equal { rays: mixed(few, now.0), seconds: mixed(seconds.max(1e-9), now.1.max(1e-9)), is_reached };
        }
        before = Some(now);
        rays *= 2;
    }
}

/// Returns what cameras, one after the other, do with one cache of a scene whose glossy surface is flat.
pub fn tour<const C: usize>(
    scene: &Scene,
    gloss: Gloss,
    basis: Basis<C>,
    plan: &Plan,
    tick: &(dyn Fn() + Sync),
) -> Tour {
    let slices = Slices::new(basis, &gloss);
    // The wall is flat: the frames of all its points are one, and no record is turned.
    let method = &basis.methods[0];
    let larger = (850.0 / plan.side as f64).powi(2);
    let mut cache = Cache::new(basis, plan.error);
    let (mut stops, mut squares, mut last) = (Vec::new(), Vec::new(), None);
    for &azimuth in plan.azimuths {
        let view = View::new(scene, &Camera { azimuth, ..CAMERA }, plan.side);
        let (before, start) = (cache.records.len(), ProcessTime::now());
        cache.fill(scene, view.places(), plan.sampling, tick);
        let filling = start.elapsed().as_secs_f64();
        let shown = view.cached(&cache, &slices, method, cache.limit(Limit::Closed));
        let truth = view.brute_force(scene, plan.rays, plan.sampling.seed, tick).radiance;
        let error = rms(&shown.radiance, &truth);
        let equal = equal(&view, scene, &truth, error, plan);
        let picture = view.with(&shown.radiance);
        let truth = view.with(&truth);
        let exposure = exposure(&truth);
        squares.push(picture::shown(&picture, exposure));
        last.get_or_insert(picture::shown(&truth, exposure));
        stops.push(Stop {
            azimuth,
            added: cache.records.len() - before,
            filling,
            seconds: shown.seconds,
            truth: error,
            equal,
            times: [1.0, larger].map(|pixels| pixels * equal.seconds / (filling + pixels * shown.seconds)),
        });
    }
    squares.extend(last);
    let mut cache = Cache::new(basis, plan.error);
    if let Some(&azimuth) = plan.azimuths.first() {
        let view = View::new(scene, &Camera { azimuth, ..CAMERA }, 2 * plan.side);
        cache.fill(scene, view.places(), plan.sampling, tick);
    }
    Tour { stops, doubled: cache.records.len(), squares }
}
