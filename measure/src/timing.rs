//! The times of kernels, as a report holds them; `clock` takes them.

use serde::{Deserialize, Serialize};

/// A kernel's time in one layout.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Nanoseconds a vector, the median.
    pub nanoseconds: f64,
    /// The median of the ratios to a copy.
    pub copies: f64,
}

/// The times of a kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// The spec.
    pub spec: String,
    /// The order.
    pub order: usize,
    /// By single calls in f32: a function that is compiled by itself, so that nothing is shared between vectors.
    pub f32: Time,
    /// Inlined into a plain loop over slices in f32, which the compiler may turn into one over several vectors.
    pub plain: Time,
    /// By single calls in f64.
    pub f64: Time,
    /// Sixteen vectors at once, interleaved, in f32.
    pub lanes: Time,
}

/// The time of a kernel by single calls in f32.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Single {
    /// The spec.
    pub spec: String,
    /// The order.
    pub order: usize,
    /// The time.
    pub time: Time,
}

/// Where and how kernels were timed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// The processor's architecture and operating system.
    pub machine: String,
    /// The times.
    pub kernels: Vec<Times>,
    /// Ways to turn at the orders 3 to 10.
    #[serde(default)]
    pub turns: Vec<Single>,
}
