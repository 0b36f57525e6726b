//! Proofs that are kept on disk: the same as made ones to the last bit, of exactly the operations that were asked for,
//! and never from a file that is not whole.

use std::cell::Cell;
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::listing::{Op, Sign};
use zonal_codegen::promise::bound;
use zonal_codegen::promise::proofs::{self, Proofs};
use zonal_tests::command::Folder;
use zonal_tests::spec;

/// What is asked, and how often it was answered anew.
struct Asked<'a> {
    proofs: &'a Proofs,
    made: Cell<usize>,
}

impl Asked<'_> {
    /// The bound of a kernel.
    fn bound(&self, text: &str, code: &Code) -> Vec<f64> {
        self.proofs.kept(&spec(text), code, "bound", || {
            self.made.set(self.made.get() + 1);
            let bound = bound::of(&spec(text), code).expect("it has a bound");
            [vec![bound.separate, bound.fused], bound.bands].concat()
        })
    }
}

#[test]
fn a_kept_bound_is_the_proven_one() {
    let folder = Folder::new();
    let proofs = Proofs::at(folder.path("proofs"));
    let asked = Asked { proofs: &proofs, made: Cell::new(0) };
    let texts = ["rotate:5", "basis:4", "angles:3", "lifted:4", "tilt:4", "rotate_adaptive:4:lf3", "rotate:3:loop"];
    for (i, text) in texts.into_iter().enumerate() {
        let code = spec(text).code();
        let first = asked.bound(text, &code);
        assert_eq!(asked.made.get(), i + 1, "{text} is proven");
        let again = asked.bound(text, &code);
        assert_eq!(asked.made.get(), i + 1, "{text} is kept");
        assert_eq!(first, again, "{text}");
        // Whether or not the environment names a folder.
        let bound = proofs::bound(&spec(text), &code).expect("it has a bound");
        assert_eq!(Some(&bound), bound::of(&spec(text), &code).as_ref(), "{text}");
        assert_eq!(first, [vec![bound.separate, bound.fused], bound.bands].concat(), "{text}");
    }
}

#[test]
fn what_has_no_answer_is_kept_too() {
    let folder = Folder::new();
    let proofs = Proofs::at(folder.path(""));
    let code = spec("eval:3").code();
    assert_eq!(proofs.kept(&spec("eval:3"), &code, "nothing", Vec::new), Vec::<f64>::new());
    assert_eq!(proofs.kept(&spec("eval:3"), &code, "nothing", || vec![1.0]), Vec::<f64>::new());
}

#[test]
fn another_operation_question_or_kernel_is_proven_anew() {
    let folder = Folder::new();
    let proofs = Proofs::at(folder.path(""));
    let made = Cell::new(0);
    let ask = |text: &str, code: &Code, question: &str| {
        let before = made.get();
        proofs.kept(&spec(text), code, question, || {
            made.set(made.get() + 1);
            vec![made.get() as f64]
        });
        made.get() > before
    };
    let Code::Straight(listing) = spec("rotate:4").code() else { panic!("a rotation is straight") };
    assert!(ask("rotate:4", &Code::Straight(listing.clone()), "bound"));
    assert!(!ask("rotate:4", &Code::Straight(listing.clone()), "bound"));
    // Every single operation, constant, output and cut counts.
    for place in 0..listing.steps.len() {
        let mut changed = listing.clone();
        changed.steps[place].op = match changed.steps[place].op {
            Op::Add(a, b) => Op::Sub(a, b),
            Op::Sub(a, b) | Op::Mul(a, b) => Op::Add(a, b),
            Op::Fma(a, b, c, Sign::Plus) => Op::Fma(a, b, c, Sign::MinusAddend),
            Op::Fma(a, b, c, _) => Op::Fma(a, b, c, Sign::Plus),
            Op::Neg(a) | Op::Rsqrt(a) => Op::Recip(a),
            Op::Recip(a) => Op::Rsqrt(a),
            op => panic!("a rotation has no {}", op.name()),
        };
        assert!(ask("rotate:4", &Code::Straight(changed), "bound"), "operation {place}");
    }
    let mut changed = listing.clone();
    changed.constants.swap(0, 1);
    assert!(ask("rotate:4", &Code::Straight(changed), "bound"), "constants");
    let mut changed = listing.clone();
    changed.outputs.swap(4, 5);
    assert!(ask("rotate:4", &Code::Straight(changed), "bound"), "outputs");
    let mut changed = listing.clone();
    changed.stages.pop().expect("a rotation has stages");
    assert!(ask("rotate:4", &Code::Straight(changed), "bound"), "stages");
    let mut changed = listing.clone();
    changed.directions.push([listing.outputs[1], listing.outputs[2], listing.outputs[3]]);
    assert!(ask("rotate:4", &Code::Straight(changed), "bound"), "directions");
    assert!(ask("rotate:4", &Code::Straight(listing.clone()), "bound within 0.1"), "the question");
    assert!(ask("tilt:4", &Code::Straight(listing.clone()), "bound"), "the spec");
    assert!(!ask("rotate:4", &Code::Straight(listing), "bound"));
}

#[test]
fn an_entry_that_is_not_whole_is_as_good_as_none() {
    let folder = Folder::new();
    let proofs = Proofs::at(folder.path(""));
    let (spec, code) = (spec("eval:3"), spec("eval:3").code());
    let want = vec![1.5, -0.0, f64::INFINITY];
    proofs.kept(&spec, &code, "numbers", || want.clone());
    let [name] = &folder.names()[..] else { panic!("one entry: {:?}", folder.names()) };
    let whole = std::fs::read(folder.path(name)).expect("readable");
    let mut bad: Vec<Vec<u8>> = (0..whole.len()).map(|length| whole[..length].to_vec()).collect();
    bad.extend((0..whole.len()).map(|place| {
        let mut bytes = whole.clone();
        bytes[place] ^= 1;
        bytes
    }));
    bad.push(vec![0xff; 40]);
    for bytes in bad {
        folder.put(name, &bytes);
        let got = proofs.kept(&spec, &code, "numbers", || vec![7.0]);
        assert_eq!(got, [7.0], "{}", String::from_utf8_lossy(&bytes));
        // It was made anew, and is whole again.
        assert_eq!(proofs.kept(&spec, &code, "numbers", || panic!("it is kept")), [7.0]);
    }
    folder.put(name, &whole);
    let bits = |numbers: Vec<f64>| numbers.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(proofs.kept(&spec, &code, "numbers", || panic!("it is kept"))), bits(want));
    assert_eq!(folder.names().len(), 1, "nothing is left beside it: {:?}", folder.names());
}

/// A folder that cannot be written is no reason to fail.
#[test]
fn without_a_place_everything_is_proven() {
    let folder = Folder::new();
    let proofs = Proofs::at(folder.put("file", "not a folder"));
    let (spec, code) = (spec("eval:3"), spec("eval:3").code());
    for value in [1.0, 2.0] {
        assert_eq!(proofs.kept(&spec, &code, "numbers", || vec![value]), [value]);
    }
}
