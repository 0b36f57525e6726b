//! The prover: what of a listing is a phase, what else its parts start from, and how a band falls into parts that are
//! bounded one by one.

use crate::families::family::Spec;
use crate::ir::graph::Kind;
use crate::ir::kernel::Shape;
use crate::ir::kernel::{Domain, Held, Made, OfAngle, POLAR};
use crate::ir::listing::{Listing, Op, Operand, Step};
use crate::math::exact::Exact;
use crate::promise::bound::norm::SLACK;
use crate::promise::bound::phases::{self, Phase, Phases};
use crate::promise::bound::region::{Region, Root};
use crate::promise::bound::roundoff::{Both, INPUT, U, larger, larger_of};
use crate::promise::bound::section::{Run, Section, Start};
use crate::promise::bound::sweep::{exact_norm, phase_error, sweep};
use std::collections::{HashMap, HashSet};
use std::sync::{LazyLock, Mutex, PoisonError};

/// What errors of some 1e-5 may change of errors that are found for exact values.
const ROOM: f64 = 1.01;

/// What adding the tiny number to a quaternion's w and y changes in band l, divided by l: the quaternion turns by 3e-15.
const NUDGE: f64 = 1e-13;

/// What a part of a band does: the bound of its fresh error for an input of norm one, and of its exact norm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) error: Both,
    pub(super) norm: f64,
}

impl Part {
    const IDENTITY: Self = Self { error: [0.0; 2], norm: 1.0 };

    pub(super) fn then(self, next: Self) -> Self {
        let error = |i: usize| {
            let carried = if self.error[i] == 0.0 { 0.0 } else { next.norm * self.error[i] };
            let fresh = if next.error[i] == 0.0 { 0.0 } else { next.error[i] * (self.norm + self.error[i]) };
            carried + fresh
        };
        Self { error: [error(0), error(1)], norm: self.norm * next.norm }
    }

    fn beside(self, other: Self) -> Self {
        Self { error: larger(self.error, other.error), norm: self.norm.max(other.norm) }
    }
}

pub(super) struct Prover<'a> {
    pub(super) spec: &'a Spec,
    pub(super) listing: &'a Listing,
    /// The angle that parameters are within, where they are bounded by one.
    within: f64,
    /// Whether a tiny number is added to a quaternion.
    nudge: bool,
    phases: Phases,
    /// Inputs that are functions of a circle's angle but no phases.
    others: HashMap<Operand, (Start, usize)>,
    /// [`U`], or 0 where only what the inputs come with counts.
    pub(super) roundoff: f64,
    /// How far the plane of each frequency from 1 is off that lifted couplings turn, besides their own errors.
    planes: Vec<Both>,
}

/// The bounds of parts that were met before: kernels share most of theirs.
static KNOWN: LazyLock<Mutex<HashMap<String, Part>>> = LazyLock::new(Mutex::default);

impl<'a> Prover<'a> {
    pub(super) fn new(spec: &'a Spec, listing: &'a Listing, max_angle: Option<f64>) -> Option<Self> {
        let mut others = HashMap::new();
        let first =
            listing.params.first().map(|param| max_angle.map_or(param.domain, |most| param.domain.within(most)));
        let roots = match first {
            // What does not make phases of a quaternion or of a normal is bounded over all of them.
            Some(Domain::Quaternion | Domain::SmallTurn(_) | Domain::BoundedTurn(_)) => {
                phases::of_quaternion(listing).unwrap_or_default()
            }
            Some(Domain::Normal) => phases::of_normal(listing).unwrap_or_default(),
            Some(Domain::Made(made)) => {
                let given = Given::new(made);
                for (operand, root, circle) in given.others {
                    others.insert(operand, (Start { root, spread: INPUT, error: [0.0; 2] }, circle));
                }
                given.pairs
            }
            Some(Domain::Phases) => match listing.params[0].shape {
                Shape::Pairs(n) => (0..n).map(|pair| phases::given(0, pair, pair, 1)).collect(),
                _ => vec![phases::given(0, 0, 0, 1)],
            },
            _ => vec![],
        };
        if let (Some(Domain::BoundedTurn(most)), Some(polar)) = (first, roots.get(POLAR)) {
            // Constant factors take in the two of sin β = 2 √(AB).
            let half =
                Start { root: Root::HalfSine, spread: polar.defect, error: polar.error.map(|error| error / 2.0) };
            others.extend(phases::doubled(listing, polar.sin).map(|root| (root, (half, POLAR))));
            let (operand, error) = phases::half_tangent(listing)?;
            let error = error.map(|error| error * (most / 2.0).tan() * SLACK);
            let start = Start { root: Root::HalfTangent(1), spread: polar.defect, error };
            others.insert(operand, (start, POLAR));
        }
        Some(Self {
            spec,
            listing,
            within: max_angle.unwrap_or(f64::INFINITY),
            nudge: matches!(first, Some(Domain::Quaternion | Domain::SmallTurn(_) | Domain::BoundedTurn(_)))
                && listing.steps.iter().any(|step| step.op.operands().any(|operand| operand == Operand::Tiny)),
            phases: Phases::new(listing, roots),
            others,
            roundoff: U,
            planes: vec![],
        })
    }

    /// What the errors of this listing's results, the kernel `angles` or `lifted`, do to a rotation by them.
    pub(super) fn rotating<'b>(&self, rotation: &'b Listing) -> Option<Prover<'b>>
    where
        'a: 'b,
    {
        let Some(Domain::Made(made)) = rotation.params.first().map(|param| param.domain) else { return None };
        let Given { mut pairs, others: rest } = Given::new(made);
        for (pair, outputs) in pairs.iter_mut().zip(self.listing.outputs.chunks_exact(2)) {
            let (made, is_sine) = self.phases.of(self.unsigned(outputs[0]))?;
            if is_sine || made.sin != self.unsigned(outputs[1]) || made.multiple != pair.multiple {
                return None;
            }
            *pair = Phase { defect: made.defect, error: made.error, ..*pair };
        }
        let (sums, planes) = match self.listing.params.first().map(|param| param.domain) {
            Some(Domain::BoundedTurn(_)) => self.sums().map(|(sums, planes)| (Some(sums), planes))?,
            _ => (None, vec![]),
        };
        let (sums, room) = sums.as_ref().map_or((self, 1.0), |sums| (sums, ROOM));
        let mut others = HashMap::new();
        for ((operand, root, circle), &output) in rest.into_iter().zip(&self.listing.outputs[2 * pairs.len()..]) {
            let error = sums.scalars(&[self.unsigned(output)])?.map(|error| error * room);
            others.insert(operand, (Start { root, spread: 5.0 * INPUT, error }, circle));
        }
        let phases = Phases::new(rotation, pairs);
        Some(Prover { listing: rotation, phases, others, roundoff: 0.0, planes, ..*self })
    }

    /// For `lifted`, whose couplings are sums over frequencies: what makes the sums of exact tangents and sines, and how
    /// far the plane of each frequency is off by theirs. Tangents and sines that are off leave the planes apart, so that
    /// these errors do not add; and as both come of one phase, most of what they are off by turns their plane.
    fn sums(&self) -> Option<(Prover<'a>, Vec<Both>)> {
        let count = self.spec.order - 1;
        let (half, _) = phases::half_tangent(self.listing)?;
        let tangents = phases::tangents(self.listing, &self.phases, half, count)?;
        let polar = self.phases.all().iter().filter(|phase| phase.circle == POLAR);
        let mut listing = self.listing.clone();
        listing.constants.extend([Exact::one(), Exact::int(2)]);
        let [one, two] = [2, 1].map(|back| Operand::Const(listing.constants.len() - back));
        let mut planes = Vec::new();
        for (k, &tangent) in (1..).zip(&tangents) {
            // The plane's matrix has 1 − ts twice, t (2 − ts) and −s.
            let sine = phases::sine(self.listing, &self.phases, k)?;
            let mut push = |op| {
                listing.steps.push(Step { op, kind: Kind::Scalar, uses: 1 });
                Operand::Step(listing.steps.len() - 1)
            };
            let product = push(Op::Mul(tangent, sine));
            let (same, rest) = (push(Op::Sub(one, product)), push(Op::Sub(two, product)));
            planes.push([same, push(Op::Mul(tangent, rest)), sine]);
        }
        let whole = Prover {
            listing: &listing,
            phases: Phases::only(polar.clone().filter(|phase| phase.multiple == 1).copied().collect()),
            others: self.others.clone(),
            planes: vec![],
            ..*self
        };
        let error = |plane: [Operand; 3]| -> Option<Both> {
            let [same, above, below] = plane.map(|entry| whole.scalars(&[entry]));
            let (same, above, below) = (same?, above?, below?);
            let norm = |i: usize| (2.0 * same[i] * same[i] + above[i] * above[i] + below[i] * below[i]).sqrt();
            Some([0, 1].map(|i| norm(i) * ROOM))
        };
        let planes = planes.into_iter().map(error).collect::<Option<Vec<Both>>>()?;
        let exact = polar.clone().map(|phase| Phase { error: [0.0; 2], ..*phase }).collect();
        let mut others = self.others.clone();
        others.values_mut().for_each(|(start, _)| start.error = [0.0; 2]);
        for (k, &tangent) in (1..).zip(&tangents) {
            // The last frequency has no cosine, and so no phase.
            let sine = phases::sine(self.listing, &self.phases, k)?;
            for (operand, root) in [(tangent, Root::HalfTangent(k)), (sine, Root::Sin(k))] {
                let start = Start { root, spread: 4.0 * k as f64 * INPUT, error: [0.0; 2] };
                others.insert(operand, (start, POLAR));
            }
        }
        let sums = Prover { phases: Phases::only(exact), others, planes: vec![], ..*self };
        Some((sums, planes))
    }

    /// Without a negation, which changes no norm.
    fn unsigned(&self, mut operand: Operand) -> Operand {
        while let Operand::Step(step) = operand {
            match self.listing.steps[step].op {
                Op::Neg(inner) => operand = inner,
                _ => break,
            }
        }
        operand
    }

    pub(super) fn is_signal(&self, operand: Operand) -> bool {
        match operand {
            Operand::Step(step) => self.listing.steps[step].kind == Kind::Signal,
            Operand::Input { param, .. } => self.listing.params[param].kind == Kind::Signal,
            _ => false,
        }
    }

    /// The signal values between `inputs` and `outputs`, both among them, and the scalars that they use. None if other
    /// values of the signal are needed.
    pub(super) fn cone(&self, inputs: &[Operand], outputs: &[Operand]) -> Option<(HashSet<Operand>, HashSet<Operand>)> {
        let (mut signals, mut scalars) = (HashSet::new(), HashSet::new());
        let mut stack = outputs.to_vec();
        while let Some(operand) = stack.pop() {
            if !self.is_signal(operand) {
                scalars.insert(operand);
            } else if signals.insert(operand) && !inputs.contains(&operand) {
                match operand {
                    Operand::Step(step) => stack.extend(self.listing.steps[step].op.operands()),
                    _ => return None,
                }
            }
        }
        Some((signals, scalars))
    }

    /// The region of what these scalars depend on, and the circle if they are functions of one angle of a phase.
    pub(super) fn domain(&self, scalars: impl IntoIterator<Item = Operand>) -> Option<(Region, usize)> {
        let mut found: Option<(Region, usize)> = None;
        let mut zonal: Option<Operand> = None;
        let mut seen = HashSet::new();
        let mut stack: Vec<Operand> = scalars.into_iter().collect();
        while let Some(operand) = stack.pop() {
            if !seen.insert(operand) {
                continue;
            }
            let circle = self.phases.of(operand).map(|(phase, _)| phase.circle);
            let circle = circle.or_else(|| self.others.get(&operand).map(|(_, circle)| *circle));
            let next = match (circle, operand) {
                (Some(circle), _) => (self.circle(circle), circle),
                (None, Operand::Input { param, .. }) => {
                    // The region is that of one number.
                    if self.listing.params[param].domain == Domain::Zonal && zonal.replace(operand).is_some() {
                        return None;
                    }
                    (self.parameter(param)?, 0)
                }
                (None, Operand::Step(step)) => {
                    stack.extend(self.listing.steps[step].op.operands());
                    continue;
                }
                _ => continue,
            };
            match found {
                Some(found) if found != next => return None,
                _ => found = Some(next),
            }
        }
        Some(found.unwrap_or((Region::Nothing, 0)))
    }

    /// What an angle may be: β, the last of a quaternion's, is bounded where its parameter is.
    fn circle(&self, circle: usize) -> Region {
        let first = self.listing.params.first().map(|param| param.domain.within(self.within));
        let most = match first {
            Some(Domain::SmallTurn(most) | Domain::BoundedTurn(most)) => Some(most),
            Some(Domain::Made(made)) => made.max_angle,
            _ => None,
        };
        most.filter(|_| circle == POLAR).map_or(Region::Circle, |most| Region::Arc(most * (1.0 + 4.0 * INPUT)))
    }

    fn parameter(&self, param: usize) -> Option<Region> {
        let region = match self.listing.params[param].domain.within(self.within) {
            Domain::Direction | Domain::Normal => Region::Sphere,
            Domain::MeanNormal(0.0) => Region::Ball,
            Domain::Hemisphere => Region::Cap(std::f64::consts::FRAC_PI_2),
            Domain::Tilt(most) => Region::Cap(most * (1.0 + INPUT)),
            Domain::Quaternion => Region::Quaternion,
            Domain::Rotation => Region::Rotation,
            Domain::Angle(most) => Region::Small(most),
            Domain::Zonal => Region::Small(1.0),
            _ => return None,
        };
        region.is_valid().then_some(region)
    }

    pub(super) fn start(&self, operand: Operand) -> Option<Start> {
        if let Some((phase, is_sine)) = self.phases.of(operand) {
            let k = phase.multiple;
            let root = if is_sine { Root::Sin(k) } else { Root::Cos(k) };
            return Some(Start { root, spread: phase.defect, error: phase.error });
        }
        if let Some(&(start, _)) = self.others.get(&operand) {
            return Some(start);
        }
        match operand {
            Operand::Input { index, .. } if !self.is_signal(operand) => {
                Some(Start { root: Root::Component(index), spread: INPUT, error: [0.0; 2] })
            }
            _ => None,
        }
    }

    /// Outputs that are scalars: the largest error.
    pub(super) fn scalars(&self, outputs: &[Operand]) -> Option<Both> {
        let (domain, _) = self.domain(outputs.iter().copied())?;
        let section = Section::new(self.listing, domain, &[], outputs, |operand| self.start(operand))?;
        let measure =
            |run: &Run, mode: usize, _: f64| section.errors(run).iter().map(|both| both[mode]).fold(0.0, larger_of);
        Some(sweep(&section, domain, section.starts(), self.roundoff, 0.0, &measure))
    }

    pub(super) fn coefficients(&self) -> Vec<Operand> {
        let params = self.listing.params.iter().enumerate().filter(|(_, param)| param.kind == Kind::Signal);
        params.flat_map(|(param, of)| (0..of.shape.len()).map(move |index| Operand::Input { param, index })).collect()
    }

    pub(super) fn bands(&self) -> Option<Vec<Both>> {
        (0..self.spec.order).map(|l| self.band(l)).collect()
    }

    /// The error of a band relative to its norm.
    pub(super) fn band(&self, l: usize) -> Option<Both> {
        let (all, places) = (self.coefficients(), l * l..(l + 1) * (l + 1));
        let inputs = if all.len() == self.spec.order { vec![all[l]] } else { all[places.clone()].to_vec() };
        let outputs: Vec<Operand> = self.listing.outputs[places].iter().map(|&output| self.unsigned(output)).collect();
        let stages: Vec<&[Operand]> = self.listing.stages.iter().map(Vec::as_slice).collect();
        let part = self.part(&inputs, &outputs, &stages)?;
        Some(part.error.map(|error| error * SLACK + if self.nudge { l as f64 * NUDGE } else { 0.0 }))
    }

    /// From values to values, cut at the stages that lie between.
    pub(super) fn part(&self, inputs: &[Operand], outputs: &[Operand], stages: &[&[Operand]]) -> Option<Part> {
        let (signals, scalars) = self.cone(inputs, outputs)?;
        let same = |a: &[Operand], b: &[Operand]| a.iter().all(|x| b.contains(x));
        for (at, &stage) in stages.iter().enumerate() {
            let fits = stage.len() == inputs.len() && stage.iter().all(|value| signals.contains(value));
            if fits && !same(stage, inputs) && !same(stage, outputs) && self.cone(stage, outputs).is_some() {
                let (before, after) = (&stages[..at], &stages[at + 1..]);
                return Some(self.part(inputs, stage, before)?.then(self.part(stage, outputs, after)?));
            }
        }
        let groups = self.groups(inputs, outputs)?;
        if let [_] = groups[..] {
            return self.whole(inputs, outputs, scalars);
        }
        let parts = groups.into_iter().map(|(inputs, outputs)| self.part(&inputs, &outputs, stages));
        parts.into_iter().try_fold(Part { norm: 0.0, ..Part::IDENTITY }, |all, part| Some(all.beside(part?)))
    }

    /// The parts that do not mix: outputs that share an input are in one.
    fn groups(&self, inputs: &[Operand], outputs: &[Operand]) -> Option<Vec<(Vec<Operand>, Vec<Operand>)>> {
        let mut groups: Vec<(Vec<Operand>, Vec<Operand>)> = Vec::new();
        for &output in outputs {
            let (signals, _) = self.cone(inputs, &[output])?;
            let used: Vec<Operand> = inputs.iter().copied().filter(|input| signals.contains(input)).collect();
            let mut joined = (used, vec![output]);
            let (touching, apart): (Vec<_>, Vec<_>) =
                groups.into_iter().partition(|(others, _)| others.iter().any(|input| signals.contains(input)));
            for (inputs, outputs) in touching {
                joined.0.extend(inputs.into_iter().filter(|input| !signals.contains(input)));
                joined.1.extend(outputs);
            }
            groups = apart;
            groups.push(joined);
        }
        Some(groups)
    }

    /// A part that falls no further apart.
    fn whole(&self, inputs: &[Operand], outputs: &[Operand], scalars: HashSet<Operand>) -> Option<Part> {
        // What depends on no signal is zero.
        if inputs.is_empty() {
            return Some(Part { norm: 0.0, ..Part::IDENTITY });
        }
        if inputs.len() == outputs.len() && outputs.iter().all(|output| inputs.contains(&self.unsigned(*output))) {
            return Some(Part::IDENTITY);
        }
        if let (&[x, y], &[real, imaginary]) = (inputs, outputs)
            && let Some(part) = self.turn([x, y], [real, imaginary], &scalars)
        {
            return Some(part);
        }
        let (domain, _) = self.domain(scalars)?;
        let section = Section::new(self.listing, domain, inputs, outputs, |operand| self.start(operand))?;
        let band = section.starts().iter().find_map(|start| match start.root {
            Root::Shear { l, .. } => Some(l),
            _ => None,
        });
        let planes = self.planes.iter().take(band.unwrap_or(0)).copied().fold([0.0; 2], larger);
        let key = format!("{domain:?} {} {planes:?} {}", self.roundoff, section.key());
        let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&part) = known().get(&key) {
            return Some(part);
        }
        let norm = exact_norm(&section, domain);
        let roundoff = self.roundoff;
        let weight = |run: &Run, mode: usize, enough: f64| {
            let weight = section.weights(run, mode).weight_norm(enough);
            // The second bound is too slow for a grid of several angles.
            match domain {
                Region::Nothing | Region::Circle | Region::Arc(_) | Region::Small(_) if weight > enough => {
                    weight.min(section.error_by_depth(run, roundoff)[mode])
                }
                _ => weight,
            }
        };
        let error = match (domain, section.is_affine()) {
            (Region::Circle, true) => {
                let given = phase_error(&section, domain, |start| start.error);
                let starts: Vec<Start> =
                    section.starts().iter().map(|start| Start { error: [0.0; 2], ..*start }).collect();
                let reach = section.starts().iter().map(|start| start.error[0].max(start.error[1])).fold(0.0, f64::max);
                let rounded = sweep(&section, domain, &starts, self.roundoff, reach, &weight);
                [rounded[0] + given[0], rounded[1] + given[1]]
            }
            _ => sweep(&section, domain, section.starts(), self.roundoff, 0.0, &weight),
        };
        let part = Part { error: [error[0] + planes[0], error[1] + planes[1]], norm };
        known().insert(key, part);
        Some(part)
    }

    /// A plane that a phase turns.
    fn turn(&self, plane: [Operand; 2], [real, imaginary]: [Operand; 2], scalars: &HashSet<Operand>) -> Option<Part> {
        let phase = scalars.iter().find_map(|&operand| self.phases.of(operand))?.0;
        let factor = [phase.cos, phase.sin];
        let turn = |a, b| phases::turn(self.listing, a, b, plane, factor);
        let own = turn(real, imaginary).or_else(|| turn(imaginary, real))?;
        let own = if self.roundoff == 0.0 { [0.0; 2] } else { own };
        let error = |i: usize| (phase.size() + phase.error[i]) * (1.0 + own[i]) - phase.size();
        Some(Part { error: [error(0), error(1)], norm: phase.size() })
    }
}

/// What a rotation by a set-up's results is given.
struct Given {
    /// First phases.
    pairs: Vec<Phase>,
    /// Then other functions of an angle, and which angle that is.
    others: Vec<(Operand, Root, usize)>,
}

impl Given {
    fn new(made: Made) -> Self {
        let mut given = Self { pairs: vec![], others: vec![] };
        for (index, Held { circle, of }) in (made.holds)(made.order).into_iter().enumerate() {
            let mut other = |root| given.others.push((Operand::Input { param: 0, index }, root, circle));
            match of {
                OfAngle::Cos(k) => given.pairs.push(phases::given(0, index / 2, circle, k)),
                OfAngle::Sin(_) => {}
                OfAngle::HalfSquare => other(Root::HalfSquare),
                OfAngle::Product => other(Root::Product),
                OfAngle::Shear { l, at, inner } => other(Root::Shear { l, at, inner }),
            }
        }
        given
    }
}
