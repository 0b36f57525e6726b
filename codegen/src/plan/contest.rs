//! A contest of methods: for a rotation that a scene bounds, every method that does the job is built, counted and
//! measured, and the cheapest that keeps the error is chosen. All figures are the kernels' own.

// Names a family: those of the hemisphere do the jobs of others for other coefficients.
use crate::emit::Function;
use crate::families::family::Spec;
use crate::families::hemisphere::rotate;
use crate::generate::{self, Row};
use crate::ir::code::Code;
use crate::ir::graph::Kind;
use crate::ir::listing::Cost;
use crate::math::hemisphere::Below;
use crate::plan::fit;
use crate::plan::mixtures::{self, Budget, candidates, set_up};
use crate::plan::text::short;
use crate::promise::built::Built;
use crate::promise::hemisphere::Trials;
use crate::promise::registers::{MOST, Registers, waves};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::{Hemisphere, Job, Located, Norm, Precision, Rotation};
use serde::Serialize;

/// What an inverse square root or a reciprocal weighs against a multiply-add when methods are compared. GPUs have a
/// quarter as many units for them (AMD's RDNA; NVIDIA's compute capability 7 and 8.0: 16 against 64 a cycle), some an
/// eighth.
pub const SPECIAL_WEIGHT: usize = 4;

/// How many f16 operations a GPU does while it does one in f32, where it packs two (AMD's RDNA, Apple's, Arm's Mali).
pub const HALF_SHARE: usize = 2;

/// What a number weighs that a kernel is given besides its signal. It takes a read and a register; with this weight the
/// order of methods agrees best with the cycles that AMD's compiler counts (docs/GPU.md), and without it the lifted
/// rotation, which is given twice as many numbers as it turns, comes before others that take fewer cycles.
pub const READ_WEIGHT: usize = 1;

/// What a number weighs that a kernel holds beyond the registers that a thread has, [`MOST`]: it is written to memory and
/// read again, of which each takes the time of two operations.
pub const SPILL_WEIGHT: usize = 4;

/// The cycles that a wave of RDNA keeps its unit busy for with an operation: 64 threads on 32 lanes.
pub const ISSUE_CYCLES: usize = 2;

/// The cycles after which a wave of RDNA has the result of an operation: an operation that needs it waits so long.
pub const RESULT_CYCLES: usize = 5;

/// The cycles until memory answers, as AMD's compiler takes them.
pub const MEMORY_CYCLES: usize = 320;

/// What a kernel weighs when methods are compared, for so many channels and in so many registers on RDNA 2.
pub fn price(code: &Code, channels: usize, registers: usize) -> usize {
    busy(weight(code, channels), channels, registers) + spill(code.held(channels))
}

/// What the operations of a kernel and the numbers that it reads besides the signal weigh together. Of a branch both sides
/// count: the threads of a wave go both ways unless all of them go one.
pub fn weight(code: &Code, channels: usize) -> usize {
    let cost = match code {
        Code::Branch(branch) => branch.both(channels),
        _ => code.cost(channels),
    };
    weigh(cost.total, cost.special, code.reads())
}

/// What operations, special ones and numbers that are read besides the signal weigh together.
pub fn weigh(total: usize, special: usize, reads: usize) -> usize {
    total + SPECIAL_WEIGHT * special + READ_WEIGHT * reads
}

/// What a kernel that weighs so much keeps a unit of the GPU for, in operations: its weight or, if that is more, what a wave
/// waits, for memory and for each result before the next operation, shared between the waves that its registers leave room
/// for. Channels do not wait for each other.
pub fn busy(weight: usize, channels: usize, registers: usize) -> usize {
    let waiting = RESULT_CYCLES * weight / channels + MEMORY_CYCLES;
    weight.max(waiting / (ISSUE_CYCLES * waves(registers)))
}

/// What the numbers weigh that a kernel holds at once, and that registers do not.
pub fn spill(held: usize) -> usize {
    SPILL_WEIGHT * held.saturating_sub(MOST)
}

/// A method that was weighed for a rotation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rival {
    /// The spec.
    pub spec: String,
    /// The spec of what makes its parameters, done once for all signals of a rotation, if it is not done by itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_up: Option<String>,
    /// The parameters but for the signal, of the set-up if there is one.
    pub takes: Vec<&'static str>,
    /// Multiplications, additions and multiply-adds, for all signals of a rotation.
    pub total: usize,
    /// Inverse square roots and reciprocals.
    pub special: usize,
    /// Numbers that are read besides the signals.
    pub reads: usize,
    /// The numbers that it holds at once.
    pub held: usize,
    /// How many waves its registers leave room for on RDNA 2, in the form in which the scene gets it.
    pub waves: usize,
    /// total + [`SPECIAL_WEIGHT`] · special + [`READ_WEIGHT`] · reads or, if that is more, what its waves wait for
    /// ([`busy`]); and for each signal [`SPILL_WEIGHT`] for each number that is held beyond the registers, unless the scene
    /// says how many may be taken: then it is printed in pieces.
    pub price: usize,
    /// The method's error at the largest angle, by its law, in the norm that the scene asks for.
    pub method_error: f64,
    /// The error of f32 rounding.
    pub rounding_f32: f64,
    /// How many registers it takes at least, if that is more than the scene allows.
    #[serde(skip)]
    pub least_registers: Option<usize>,
    /// Why it does not do what is asked, if so.
    #[serde(skip)]
    pub barred: Option<&'static str>,
    /// Whether it may be chosen.
    pub admissible: bool,
    /// Why it was chosen or not.
    pub verdict: String,
}

/// A kernel that the scene gets.
#[derive(Clone, Debug, Serialize)]
pub struct Chosen {
    /// Its costs and errors.
    #[serde(flatten)]
    pub row: Row,
    /// The largest angle in degrees that the scene asks for.
    pub max_angle: Option<f64>,
    /// The method's error at that angle.
    pub method_error: Option<f64>,
    /// The error that the scene allows.
    pub max_error: Option<f64>,
    /// What the error is the error of.
    pub norm: Option<Norm>,
    /// What it is the error of on the hemisphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hemisphere: Option<Hemisphere>,
    /// What the method adds at that angle to the error of what is seen of the environment, relative to all of its bands, in
    /// the root mean square.
    pub seen_error: Option<f64>,
    /// Why this one.
    pub reason: String,
    /// All methods that were weighed, cheapest first; none for a kernel that the scene names.
    pub rivals: Vec<Rival>,
}

/// A method in a contest.
#[derive(Clone)]
struct Entry {
    function: Function,
    /// What makes its parameters, if it does not do so itself.
    set_up: Option<Function>,
    rival: Rival,
}

/// A rotation's methods, weighed.
pub(super) struct Contest<'a> {
    rotation: &'a Rotation,
    order: usize,
    budget: Budget,
    /// The most registers that a kernel may take.
    registers: Option<&'a Located<usize>>,
    /// What methods on the hemisphere are tried on.
    trials: Option<Trials>,
    entries: Vec<Entry>,
}

impl<'a> Contest<'a> {
    pub fn new(rotation: &'a Rotation, order: usize, energy: &[f64], registers: Option<&'a Located<usize>>) -> Self {
        let budget = Budget {
            max_angle: rotation.max_angle.value.to_radians(),
            error: rotation.max_error.value,
            norm: rotation.norm.value,
            energy: energy.to_vec(),
        };
        let below = rotation.hemisphere.as_ref().map(|hemisphere| hemisphere.value.below());
        let trials = below.map(|below| Trials::new(order, below, budget.max_angle));
        let mut contest = Self { rotation, order, budget, registers, trials, entries: vec![] };
        match below {
            Some(below) => contest.enter_hemispherical(below),
            None => contest.enter_spherical(),
        }
        contest.narrow();
        contest.entries.sort_by(|Entry { rival: a, .. }, Entry { rival: b, .. }| {
            a.price.cmp(&b.price).then(a.method_error.total_cmp(&b.method_error))
        });
        contest
    }

    fn enter_hemispherical(&mut self, below: Below) {
        let specs = rotate::candidates(self.rotation.kind, self.order, below).into_iter();
        let specs: Vec<Spec> = specs.map(|spec| Spec { rgb: self.rotation.rgb, ..spec }).collect();
        for function in generate::build(&specs) {
            self.enter(function, None, None);
        }
    }

    fn enter_spherical(&mut self) {
        let (rotation, order) = (self.rotation, self.order);
        let all = candidates(rotation.kind, order, rotation.rgb).into_iter();
        let (alone, shared): (Vec<_>, Vec<_>) =
            all.map(|(spec, does)| (set_up(&spec), spec, does.barred)).partition(|(set_up, ..)| set_up.is_none());
        let specs: Vec<Spec> = alone.iter().map(|(_, spec, _)| spec.clone()).collect();
        for (function, (.., why)) in generate::build(&specs).into_iter().zip(alone) {
            self.enter(function, None, why);
        }
        // A set-up that is done once pays for several signals, or channels, that turn alike.
        for (set_up, spec, why) in shared.into_iter().filter(|_| rotation.rgb || rotation.signals > 1) {
            let specs: Vec<Spec> = set_up.into_iter().chain([spec]).collect();
            if let [set_up, function] = &generate::build(&specs)[..] {
                self.enter(function.clone(), Some(set_up.clone()), why);
            }
        }
        let known = |contest: &Self, spec: &Spec| contest.entries.iter().any(|entry| entry.function.spec == *spec);
        let mixtures: Vec<Spec> = self.mixtures().into_iter().filter(|spec| !known(self, spec)).collect();
        for function in generate::build(&mixtures) {
            self.enter(function, None, None);
        }
    }

    /// What the method of a spec errs by at the largest angle.
    fn method_error(&self, spec: &Spec) -> f64 {
        match (&self.trials, &self.rotation.hemisphere) {
            (Some(trials), Some(hemisphere)) => {
                trials.error(&rotate::matrix(spec, hemisphere.value.below(), self.budget.max_angle))
            }
            _ => self.budget.predict(spec),
        }
    }

    fn enter(&mut self, function: Function, set_up: Option<Function>, why: Option<&'static str>) {
        let (spec, built) = (&function.spec, &function.built);
        let (degrees, max_error) = (self.rotation.max_angle.value, self.rotation.max_error.value);
        let own = built.code.cost(spec.channels());
        let once = set_up.as_ref().map_or_else(Cost::default, |set_up| set_up.built.code.cost(1));
        let all = |of: fn(Cost) -> usize| self.rotation.signals * of(own) + of(once);
        let read_once = set_up.as_ref().map_or(0, |set_up| set_up.built.code.reads());
        let reads = self.rotation.signals * built.code.reads() + read_once;
        let held = built.code.held(spec.channels());
        // What a scene's registers do not suffice for is in pieces, which hold less.
        let within = |most: &Located<usize>| fit::within(spec, most.value).ok().map(|(_, found)| found);
        let registers = self.registers.and_then(within).unwrap_or_else(|| Registers::of(spec, &built.code)).registers;
        let spilled = if self.registers.is_some() { 0 } else { spill(held) };
        let each = busy(weight(&built.code, spec.channels()), spec.channels(), registers) + spilled;
        let made = set_up.as_ref().map_or(0, |set_up| {
            let code = &set_up.built.code;
            busy(weight(code, 1), 1, Registers::of(&set_up.spec, code).registers)
        });
        let price = self.rotation.signals * each + made;
        let method_error = self.method_error(spec);
        let rounding = |built: &Built| built.rounding_within(self.budget.max_angle);
        let rounding_f32 = rounding(built) + set_up.as_ref().map_or(0.0, |set_up| rounding(&set_up.built));
        let beyond = spec.max_angle().is_some_and(|limit| degrees.to_radians() > limit);
        let keeps = why.is_none() && !beyond && method_error + rounding_f32 <= max_error;
        let beyond_registers = |most: &Located<usize>| {
            let specs = [Some(spec), set_up.as_ref().map(|set_up| &set_up.spec)];
            specs.into_iter().flatten().filter_map(|spec| fit::least_beyond(spec, most.value)).max()
        };
        let least_registers = self.registers.filter(|_| keeps).and_then(beyond_registers);
        let refused = match (why, beyond) {
            (Some(why), _) => Some(why.to_owned()),
            (None, true) => Some(format!("takes up to {} degrees only", spec.max_degrees().unwrap_or_default())),
            (None, false) if keeps => least_registers.map(|least| format!("takes {least} registers at least")),
            (None, false) => Some(format!("errs by more than {max_error}")),
        };
        let given = set_up.as_ref().unwrap_or(&function).built.code.params();
        let rival = Rival {
            spec: spec.to_string(),
            set_up: set_up.as_ref().map(|set_up| set_up.spec.to_string()),
            takes: given.iter().filter(|param| param.kind == Kind::Scalar).map(|param| param.name).collect(),
            total: all(|cost| cost.total),
            special: all(|cost| cost.special),
            reads,
            held,
            waves: waves(registers),
            price: if spec.half { price.div_ceil(HALF_SHARE) } else { price },
            method_error,
            rounding_f32,
            least_registers,
            barred: why,
            admissible: refused.is_none(),
            verdict: refused.unwrap_or_else(|| "keeps the error".to_owned()),
        };
        self.entries.push(Entry { function, set_up, rival });
    }

    /// Every kernel again in f16, or there alone, if the scene says so.
    fn narrow(&mut self) {
        let precision = self.rotation.precision.value;
        if precision == Precision::F32 {
            return;
        }
        let halves = self.entries.iter().filter(|entry| entry.set_up.is_none() && entry.function.spec.takes_half());
        let (specs, why): (Vec<Spec>, Vec<_>) =
            halves.map(|entry| (Spec { half: true, ..entry.function.spec.clone() }, entry.rival.barred)).unzip();
        if precision == Precision::F16 {
            self.entries.clear();
        }
        for (function, why) in generate::build(&specs).into_iter().zip(why) {
            self.enter(function, None, why);
        }
    }

    /// Mixtures of methods by band that leave room for the rounding of those that were entered.
    fn mixtures(&self) -> Vec<Spec> {
        let approximate = self.entries.iter().filter(|entry| entry.function.spec.is_approximate());
        let rounding = approximate.map(|entry| entry.rival.rounding_f32).fold(0.0, f64::max);
        let budget = Budget { error: self.budget.error - rounding, ..self.budget.clone() };
        let mut specs = mixtures::mixtures(self.rotation.kind, self.order, &budget);
        specs.iter_mut().for_each(|spec| spec.rgb = self.rotation.rgb);
        specs
    }

    /// The cheapest method that keeps the error, and all of them with the reasons.
    pub fn decide(mut self) -> Result<(Function, Option<Function>, Chosen), Diagnostic> {
        let max_error = &self.rotation.max_error;
        let rivals = || self.entries.iter().map(|entry| &entry.rival);
        let Some(best) = rivals().position(|rival| rival.admissible) else {
            let error = |rival: &Rival| rival.method_error + rival.rounding_f32;
            let exact = rivals().min_by(|a, b| error(a).total_cmp(&error(b)));
            if self.entries.is_empty() {
                let help = "take `auto` or `f32`, or the kind `tilt`, `y` or `zyz`";
                let place = &self.rotation.precision.place;
                return Err(Diagnostic::at(place, "no kernel of this kind works in f16", help));
            }
            let least =
                rivals().filter_map(|rival| Some((rival.least_registers?, rival))).min_by_key(|(least, _)| *least);
            if let (Some((least, rival)), Some(most)) = (least, self.registers) {
                let message =
                    format!("no method that keeps an error of {} takes {} registers", max_error.value, most.value);
                let help = format!("allow {least} at least: so many takes `{}`, in its best form", rival.spec);
                return Err(Diagnostic::at(&most.place, message, help));
            }
            let message = format!("no method keeps an error of {}", max_error.value);
            let help = exact.map_or_else(String::new, |rival| {
                format!("allow {} at least: that is how far `{}` errs in f32", short(error(rival)), rival.spec)
            });
            return Err(Diagnostic::at(&max_error.place, message, help));
        };
        let which = match rivals().filter(|rival| rival.admissible).count() {
            1 => "the only one that keeps".to_owned(),
            kept => format!("the cheapest of {kept} that keep"),
        };
        let reason = format!(
            "{which} the scene's `max_error` of {}, of {} ways to {} by up to {} degrees{}",
            max_error.value,
            self.entries.len(),
            match self.rotation.kind {
                Job::Tilt => "tilt z to a normal",
                Job::Y => "turn about y",
                Job::Zyz => "turn about z, y and z",
                Job::Quaternion => "turn by a quaternion whose y angle is bounded",
            },
            self.rotation.max_angle.value,
            match self.rotation.signals {
                1 => String::new(),
                signals => format!(", for {signals} signals that turn alike"),
            },
        );
        for (place, Entry { rival, .. }) in self.entries.iter_mut().enumerate() {
            if place == best {
                rival.verdict = "chosen".to_owned();
            } else if rival.admissible {
                rival.verdict = "keeps the error too, but costs more".to_owned();
            }
        }
        let Entry { mut function, set_up, .. } = self.entries[best].clone();
        function.name = self.rotation.name.as_ref().map(|name| name.value.clone());
        let chosen = Chosen {
            row: Row::of(&function),
            max_angle: Some(self.rotation.max_angle.value),
            method_error: Some(self.entries[best].rival.method_error),
            max_error: Some(max_error.value),
            norm: self.trials.is_none().then_some(self.budget.norm),
            hemisphere: self.rotation.hemisphere.as_ref().map(|hemisphere| hemisphere.value),
            seen_error: None,
            reason,
            rivals: self.entries.into_iter().map(|entry| entry.rival).collect(),
        };
        Ok((function, set_up, chosen))
    }
}
