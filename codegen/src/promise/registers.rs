//! How many vector registers a kernel takes on RDNA 2, and how many it lacks there: measured by `cargo measure-gpu` for
//! what the catalogue holds, else counted. A table of the repository's tells what was measured, by spec, so that nobody
//! needs a driver to plan by it.

use crate::families::family::{Form, Spec};
use crate::families::pieces::PIECES;
use crate::ir::code::Code;
use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

/// The table, a line a kernel: how it is called, registers, spilled registers.
const MEASURED: &str = include_str!("../../data/registers.tsv");

/// The vector registers that a thread may have on RDNA 2.
pub const MOST: usize = 256;

/// Registers of a unit of RDNA 2, for each of the 64 threads of a wave.
pub const ROOM: usize = 512;
/// The waves of 64 threads that a unit of RDNA 2 holds at the most.
pub const MOST_WAVES: usize = 16;

/// Returns how many waves a unit of RDNA 2 holds of a kernel that takes so many registers: while one waits, others run.
pub fn waves(registers: usize) -> usize {
    (ROOM / registers.max(1)).clamp(ROOM / MOST, MOST_WAVES)
}

/// How a kernel is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Called {
    /// By one function.
    Whole,
    /// Set-up and bands after each other, by the functions of [`Spec::in_pieces`].
    Pieces,
    /// As pieces, a channel after the other in each band, by the functions of one channel.
    Channels,
    /// As pieces of one channel that read and write a memory: a pass for the set-up and one for each band, a thread a channel.
    Memory,
}

impl Called {
    /// Returns how many registers a number is held for that a kernel holds by its listing, where nothing was measured: what
    /// AMD's compiler takes, spilled ones among them, is no more for nine of ten kernels of the catalogue (docs/GPU.md).
    /// Of pieces it takes more than of a whole, since it reads ahead.
    pub fn for_a_number(self) -> f64 {
        match self {
            Self::Whole => 1.5,
            Self::Pieces | Self::Channels | Self::Memory => 2.0,
        }
    }
}

/// The registers of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Registers {
    /// Registers that it takes, at most [`MOST`].
    pub registers: usize,
    /// Registers that memory has to stand in for.
    pub spilled: usize,
    /// Whether they were measured, and not counted.
    pub measured: bool,
}

impl Registers {
    /// How many it needs so that memory stands in for none.
    pub fn needed(self) -> usize {
        self.registers + self.spilled
    }

    /// Returns the registers of a kernel that is called by one function, measured or else counted.
    pub fn of(spec: &Spec, code: &Code) -> Self {
        measured(spec, Called::Whole).unwrap_or_else(|| Self::counted(code.held(spec.channels()), Called::Whole))
    }

    fn counted(held: usize, called: Called) -> Self {
        let needed = (held as f64 * called.for_a_number()).ceil() as usize;
        let registers = needed.min(MOST);
        Self { registers, spilled: needed - registers, measured: false }
    }
}

impl fmt::Display for Registers {
    /// As tables have it: `184`, `256 + 26` with what memory stands in for, `about 96` where it was counted.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let about = if self.measured { "" } else { "about " };
        match self.spilled {
            0 => write!(f, "{about}{}", self.registers),
            spilled => write!(f, "{about}{} + {spilled}", self.registers),
        }
    }
}

/// Returns what stands for a kernel that is called in some way in the table.
pub fn key(spec: &str, called: Called) -> String {
    match called {
        Called::Whole => spec.to_owned(),
        Called::Pieces => format!("{spec}:{PIECES}"),
        Called::Channels => format!("{spec}:{PIECES}:channels"),
        Called::Memory => format!("{spec}:{PIECES}:memory"),
    }
}

/// Returns what was measured of a kernel, if it was.
pub fn measured(spec: &Spec, called: Called) -> Option<Registers> {
    static TABLE: OnceLock<HashMap<&str, [usize; 2]>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let row = |line: &'static str| {
            let mut cells = line.split('\t');
            let (key, registers, spilled) = (cells.next()?, cells.next()?, cells.next()?);
            Some((key, [registers.parse().ok()?, spilled.parse().ok()?]))
        };
        MEASURED.lines().filter_map(row).collect()
    });
    let &[registers, spilled] = table.get(&*key(&spec.to_string(), called))?;
    Some(Registers { registers, spilled, measured: true })
}

/// Returns the numbers that a kernel holds at once, by its listing; none where it cannot be called so.
pub fn held(spec: &Spec, called: Called) -> Option<usize> {
    let of = |spec: &Spec| spec.code().held(spec.channels());
    let pieces = match called {
        Called::Whole => return Some(of(spec)),
        _ if spec.form.is_piece() => return None,
        Called::Pieces => spec.in_pieces(),
        Called::Channels if spec.rgb => spec.base().in_pieces(),
        // Arrays that lie in memory take no registers, so that what is held is not what takes them.
        Called::Channels | Called::Memory => return None,
    };
    // What the set-up made is among what a band is given.
    let bands = pieces.iter().filter(|piece| piece.form != Form::SetUp);
    bands.map(of).max()
}

/// Returns the registers of a kernel, measured or else counted; none where it cannot be called so.
pub fn registers(spec: &Spec, called: Called) -> Option<Registers> {
    measured(spec, called).or_else(|| held(spec, called).map(|held| Registers::counted(held, called)))
}
