//! A kernel that leaves bands apart, in pieces: `rotate:8:setup` and `rotate:8:band=3`, each a spec as any other.

use crate::families::family::{Acts, Form, Spec};
use crate::ir::pieces::Pieces;

/// The option that names the set-up.
pub const SET_UP: &str = "setup";
/// What the option that names a band begins with.
pub const BAND: &str = "band=";
/// What stands for all pieces.
pub const PIECES: &str = "pieces";
/// What a kernel that has pieces takes.
pub const OPTIONS: [&str; 3] = [SET_UP, "band=1", PIECES];

/// What to do about a kernel that has no pieces.
pub const NO_PIECES: &str =
    "leave it out: only kernels from coefficients to coefficients that leave bands apart have a piece a band";

impl Spec {
    /// Its pieces; none where it does not leave bands apart.
    pub fn pieces(&self) -> Option<Pieces> {
        let is_plain =
            self.form != Form::Loop && self.family.branch.is_none() && self.is_whole() && self.factors.is_none();
        let kernel = || (self.family.kernel)(&self.whole());
        (is_plain && self.family.acts == Acts::Turns && self.family.has_signal())
            .then(kernel)
            .and_then(|kernel| Pieces::new(kernel, self.order))
    }

    /// The specs of its pieces, the set-up first, which serves every channel; nothing where it does not leave bands apart.
    pub fn in_pieces(&self) -> Vec<Self> {
        let Some(pieces) = self.pieces() else { return vec![] };
        let set_up = pieces.set_up().map(|_| Self { form: Form::SetUp, rgb: false, ..self.clone() });
        let bands = pieces.changed().into_iter().map(|l| Self { form: Form::Band(l), ..self.clone() });
        set_up.into_iter().chain(bands).collect()
    }

    /// What it is called where the kernel that it is a piece of is called `name`.
    pub fn named(&self, name: &str) -> String {
        match self.form {
            Form::SetUp => format!("{name}_setup"),
            Form::Band(l) => format!("band_{l}_{name}"),
            Form::Unrolled | Form::Loop => name.to_owned(),
        }
    }

    /// The spec of the kernel that it is a piece of; of what is none, itself.
    #[must_use]
    pub fn whole(&self) -> Self {
        match self.form.is_piece() {
            true => Self { form: Form::Unrolled, ..self.clone() },
            false => self.clone(),
        }
    }
}

/// The form that an option names, if it names a piece.
pub fn form(option: &str) -> Option<Form> {
    let band = || option.strip_prefix(BAND)?.parse().ok().map(Form::Band);
    if option == SET_UP { Some(Form::SetUp) } else { band() }
}

/// What is wrong with a piece that there is not, and what to do.
pub fn fault(spec: &Spec) -> Option<[String; 2]> {
    if !spec.form.is_piece() {
        return None;
    }
    let whole = spec.whole();
    let Some(pieces) = spec.pieces() else { return Some([format!("`{whole}` has no pieces"), NO_PIECES.to_owned()]) };
    let [message, help] = match spec.form {
        Form::SetUp if spec.rgb => {
            ["the set-up has no signal that could be RGB", "leave `rgb` out: it serves every channel"]
        }
        Form::SetUp if pieces.set_up().is_none() => {
            ["it needs no set-up", "leave it out: its bands take coefficients alone"]
        }
        Form::Band(l) if !pieces.changed().contains(&l) => {
            let all: Vec<String> = pieces.changed().iter().map(usize::to_string).collect();
            let help = format!("name one of {}: other bands are copied or do not exist", all.join(", "));
            return Some([format!("band {l} is no piece of `{whole}`"), help]);
        }
        _ => return None,
    };
    Some([message, help].map(str::to_owned))
}
