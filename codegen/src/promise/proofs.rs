//! What was proven and measured of a listing, kept on disk, so that the many processes of a test run do it once. An entry is
//! found by a hash of the question, of the listing and of the sources that answer it. Nothing is read or written unless
//! the environment names a folder ([`FOLDER`]); a file that is not whole is as good as none.

use crate::families::family::Spec;
use crate::ir::code::Code;
use crate::ir::kernel::Param;
use crate::ir::listing::Listing;
use crate::promise::bound::{self, Bound};
use std::fmt::{self, Debug, Write};
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The environment variable that names the folder of proofs.
pub const FOLDER: &str = "ZONAL_PROOFS";

/// A hash of the sources that a proof rests on: `build.rs` makes it.
const PROVER: &str = env!("ZONAL_PROVER");

/// A folder of answers.
#[derive(Clone, Debug)]
pub struct Proofs(PathBuf);

impl Proofs {
    /// Those in a folder, which need not exist.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self(folder.into())
    }

    /// The numbers that answer a question on a kernel's operations: from the folder, or made and put there. That they
    /// cannot be put there is no error.
    pub fn kept(&self, spec: &Spec, code: &Code, question: &str, make: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        let head = format!("{PROVER} {} {spec} {question}\n", std::env::consts::ARCH);
        let path = self.0.join(format!("{:016x}", hash(|text| write!(text, "{head}").and_then(|()| lay(text, code)))));
        let read = std::fs::read_to_string(&path).ok().and_then(|text| numbers(text.strip_prefix(&head)?));
        read.unwrap_or_else(|| {
            let made = make();
            let body = made.iter().map(|x| format!("{:016x}", x.to_bits())).collect::<Vec<_>>().join(" ");
            _ = self.put(&path, &format!("{head}{body}\n{}\n", checked(&body)));
            made
        })
    }

    /// Writes a file beside its place first, so that nobody reads a half of it.
    fn put(&self, path: &Path, text: &str) -> std::io::Result<()> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        std::fs::create_dir_all(&self.0)?;
        let name = format!(".{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let beside = self.0.join(name);
        std::fs::write(&beside, text)?;
        std::fs::rename(&beside, path)
    }
}

/// The numbers of an entry, if its second line is the hash of the first.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let (body, check) = text.strip_suffix('\n')?.split_once('\n')?;
    let number = |word: &str| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
    (check == checked(body)).then(|| body.split_whitespace().map(number).collect()).flatten()
}

fn checked(body: &str) -> String {
    format!("{:016x}", hash(|text| text.write_str(body)))
}

/// A hash as text is written.
struct Hashed(DefaultHasher);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

fn hash(write: impl FnOnce(&mut Hashed) -> fmt::Result) -> u64 {
    let mut text = Hashed(DefaultHasher::new());
    write(&mut text).expect("hashing does not fail");
    text.0.finish()
}

/// All that a proof sees of a kernel's operations, as text.
fn lay(text: &mut Hashed, code: &Code) -> fmt::Result {
    let mut all = |params: &[Param], parts: &[&dyn Debug]| {
        params.iter().try_for_each(|param| write!(text, "{} {:?} {:?};", param.name, param.shape, param.domain))?;
        parts.iter().try_for_each(|part| write!(text, "{part:?};"))
    };
    let mut listing = |l: &Listing| {
        let notes = (&l.stages, &l.directions);
        all(&l.params, &[&l.constants, &l.steps, &l.outputs, &notes, &l.result, &l.result_kind])
    };
    match code {
        Code::Straight(straight) => listing(straight),
        Code::Branch(branch) => [&branch.condition, &branch.below, &branch.above].into_iter().try_for_each(listing),
        Code::Loop(kernel) => {
            let k = kernel;
            all(&k.params, &[&k.tables, &k.body, &k.output, &k.result, &k.result_kind])
        }
    }
}

/// Those that the environment names.
static NAMED: LazyLock<Option<Proofs>> = LazyLock::new(|| std::env::var_os(FOLDER).map(Proofs::at));

/// The numbers that answer a question: kept where the environment names a folder, else made.
pub(super) fn kept(spec: &Spec, code: &Code, question: &str, make: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
    match &*NAMED {
        Some(proofs) => proofs.kept(spec, code, question, make),
        None => make(),
    }
}

/// [`bound::of`], kept.
pub fn bound(spec: &Spec, code: &Code) -> Option<Bound> {
    bound_within(spec, code, None)
}

/// [`bound::within`], kept.
pub fn bound_within(spec: &Spec, code: &Code, max_angle: Option<f64>) -> Option<Bound> {
    let make = || match bound::within(spec, code, max_angle) {
        Some(Bound { separate, fused, bands }) => [vec![separate, fused], bands].concat(),
        None => vec![],
    };
    match &kept(spec, code, &format!("bound within {max_angle:?}"), make)[..] {
        [separate, fused, bands @ ..] => Some(Bound { separate: *separate, fused: *fused, bands: bands.to_vec() }),
        _ => None,
    }
}
