//! The approximate rotations that are compared.

// Names a family: these are the methods that the reports compare.
use zonal_codegen::families::about_y::ABOUT_Y;
use zonal_codegen::families::small_turn::ROTATE_SMALL;
use zonal_codegen::families::tilt::TILT;
use zonal_codegen::families::{SmallAngle, Spec};

/// An approximate rotation of all bands.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Its name in reports.
    pub name: &'static str,
    /// Its name in tables and plots.
    pub label: &'static str,
    /// What the error of band l begins with, L = lβ.
    pub formula: &'static str,
    /// The smallest order whose rotation is not exact.
    pub first_order: usize,
    kernel: fn(usize) -> Spec,
}

impl Method {
    /// Its kernel at an order.
    pub fn spec(&self, order: usize) -> Spec {
        (self.kernel)(order)
    }
}

fn about_y(method: SmallAngle, order: usize) -> Spec {
    Spec::new(&ABOUT_Y, order).by(method)
}

/// All of them: about y by one method, then those that are exact in bands 1 and 2.
pub const METHODS: [Method; 7] = [
    Method {
        name: "taylor1",
        label: "Taylor 1",
        formula: "L²/2",
        first_order: 2,
        kernel: |order| about_y(SmallAngle::Taylor1, order),
    },
    Method {
        name: "taylor15",
        label: "Taylor 1.5",
        formula: "≈ L²/4 (l = 1: L³/6)",
        first_order: 2,
        kernel: |order| about_y(SmallAngle::Taylor15, order),
    },
    Method {
        name: "taylor2",
        label: "Taylor 2",
        formula: "L³/6",
        first_order: 2,
        kernel: |order| about_y(SmallAngle::Taylor2, order),
    },
    Method {
        name: "lf3",
        label: "LF3",
        formula: "L³/24, l odd: (l³ − l) β³/24",
        first_order: 2,
        kernel: |order| about_y(SmallAngle::Lf3, order),
    },
    Method {
        name: "lf5",
        label: "LF5",
        formula: "(7 − 3√5) L³/96, l odd: (7 − 3√5) (l³ − l) β³/96",
        first_order: 2,
        kernel: |order| about_y(SmallAngle::Lf5, order),
    },
    Method {
        name: "exact2+lf3",
        label: "LF3, l ≤ 2 exact",
        formula: "as LF3, 0 for l ≤ 2",
        first_order: 4,
        kernel: |order| Spec::new(&ROTATE_SMALL, order),
    },
    Method {
        name: "tilt",
        label: "tilt",
        formula: "as LF3, 0 for l ≤ 2",
        first_order: 4,
        kernel: |order| Spec::new(&TILT, order),
    },
];

/// The method of a name.
pub fn named(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}
