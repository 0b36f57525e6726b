//! Multiply-adds of plain numbers: compiled for a processor that has the instruction they are rounded once, as the
//! interpreter has it, and for the architecture's baseline as that has it.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use zonal_codegen::builder::Builder;
use zonal_codegen::emit::language::RUST;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::samples::Random;
use zonal_tests::{repository, spec};

const SPECS: [&str; 2] = ["rotate:5", "product:3"];

/// What the interpreter gives, as bits: a rotation of a signal, and the product of its first numbers and of those behind them.
fn interpreted<T: Number>(q: &[f64], c: &[f64], contraction: Contraction, bits: impl Fn(T) -> u64) -> Vec<u64> {
    let [q, c] = [q, c].map(|row| row.iter().map(|&x| T::from_f64(x)).collect::<Vec<T>>());
    let run = |place: usize, params: &[&[T]]| {
        Program::<T>::new(&Listing::new(&spec(SPECS[place]).kernel())).run(params, contraction)
    };
    [run(0, &[&q, &c]), run(1, &[&c[..9], &c[9..18]])].concat().into_iter().map(bits).collect()
}

/// Whether this processor has the instruction.
fn has_fma() -> bool {
    #[cfg(target_arch = "x86_64")]
    let has = std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    let has = cfg!(target_arch = "aarch64");
    has
}

#[test]
fn numbers_are_fused_where_the_target_is_and_only_there() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fused");
    SPECS.into_iter().fold(Builder::new("fused"), Builder::spec).target(&RUST).write(&folder).expect("is written");
    let mut random = Random::new(14);
    let (q, c): ([f64; 4], Vec<f64>) = (random.unit(), (0..25).map(|_| random.signed()).collect());
    let input: String = q.iter().chain(&c).map(|x| format!("{x}\n")).collect();

    let flags: &[&str] = if cfg!(target_arch = "x86_64") { &["-fma", "+fma"] } else { &["+neon"] };
    let mut results = Vec::new();
    for flag in flags {
        let fused = !flag.starts_with('-');
        let program = folder.join(format!("program{flag}"));
        let rustc = Command::new("rustc")
            .args(["--edition=2024", "-Copt-level=1", &format!("-Ctarget-feature={flag}"), "-o"])
            .args([&program, &repository("tests/fixture/fused.rs")])
            .env("FUSED", folder.join("fused.rs"))
            .output()
            .expect("rustc runs");
        assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
        if fused && !has_fma() {
            eprintln!("compiled, not run: this processor has no multiply-add");
            continue;
        }
        let mut child =
            Command::new(&program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the program runs");
        child.stdin.take().expect("is piped").write_all(input.as_bytes()).expect("the program reads");
        let output = child.wait_with_output().expect("the program ends");
        let text = String::from_utf8(output.stdout).expect("is text");
        let (said, bits) = text.split_once('\n').expect("says whether it is fused");
        assert_eq!(said, fused.to_string(), "{flag}");
        let contraction = if fused { Contraction::Fused } else { Contraction::Separate };
        let mut want = interpreted::<f32>(&q, &c, contraction, |x| x.to_bits().into());
        want.extend(interpreted::<f64>(&q, &c, contraction, f64::to_bits));
        let got: Vec<u64> = bits.lines().map(|line| line.parse().expect("bits")).collect();
        assert_eq!(got, want, "{flag}");
        results.push(got);
    }
    // Else the test could not tell them apart.
    assert!(results.windows(2).all(|pair| pair[0] != pair[1]));
}
