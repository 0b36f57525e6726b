//! The tables and the plots of the extremes.

use super::Stability;
use super::basis::{NUMBERS, ORDERS, PLACES};
use super::chain::{Drift, STEPS, TURN};
use super::euler::{ANGLES, MULTIPLES, NOISE, RECURRENCES, WAYS};
use super::recursion;
use super::rotation::Way;
use super::special::{BAND, QUATERNIONS, SPECS, VALUES};
use crate::File;
use crate::markdown::{file, perhaps, short, table};
use crate::svg::{Axis, Key, Panel, Picture, Series, Stroke, file as picture, key};
// Names a family: the bound of its conditions is said.
use zonal_codegen::families::zhf::lobes::LARGEST_CONDITION;

/// What the issue of the basis in f32 asks for.
pub const BASIS_TARGET: f64 = 1e-5;
/// What the issue of the exact rotation in f32 asks for.
pub const ROTATION_TARGET: f64 = 5e-7;

fn basis(stability: &Stability) -> Vec<String> {
    let at = |number: &str, place: &str, order: usize| -> Option<f64> {
        stability.basis.iter().find(|curve| curve.number == number && curve.place == place)?.at_order(order)
    };
    let rows = NUMBERS.iter().flat_map(|(number, _)| {
        PLACES.iter().map(move |place| {
            let mut row = vec![(*number).to_owned(), (*place).to_owned()];
            row.extend(ORDERS.map(|order| perhaps(at(number, place, order))));
            row
        })
    });
    let not_finite: usize = stability.basis.iter().map(|curve| curve.not_finite).sum();
    let orders = ORDERS.map(|order| order.to_string());
    let columns: Vec<&str> = ["", "direction"].into_iter().chain(orders.iter().map(String::as_str)).collect();
    let worst = PLACES.iter().filter_map(|place| at("f32", place, 64)).fold(0.0, f64::max);
    vec![
        format!(
            "## The basis\n\nThe loop form, its tables rounded once, against each band's polynomials in whole numbers of \
             any length. The largest error of a band, relative to the norm of its 2l + 1 values; a direction is taken as \
             the number type holds it. Of all values {not_finite} are no finite number. To order 64 in f32 the error is \
             {} at most (asked for: {}). It is largest at the poles, where a band is its middle value alone and the \
             rounding of the recurrence's coefficients adds up.",
            short(worst),
            short(BASIS_TARGET)
        ),
        table(&columns, rows),
        "![Error of the basis over the band](stability_basis.svg)".to_owned(),
    ]
}

fn rotation(stability: &Stability) -> Vec<String> {
    let at = |way: Way, number: &str, order: usize| -> Option<f64> {
        stability.rotation.iter().find(|curve| curve.number == number && curve.way == way.name())?.at_order(order)
    };
    let orders = [2, 4, 8, 16, 32, 48, 64];
    let rows = ["f32", "f64"].iter().flat_map(|number| Way::ALL.iter().map(move |(way, name)| (*number, *way, *name)));
    let rows = rows.filter(|(number, way, _)| at(*way, number, 2).is_some()).map(|(number, way, name)| {
        let mut row = vec![number.to_owned(), name.to_owned()];
        row.extend(orders.map(|order| perhaps(at(way, number, order))));
        row
    });
    let names = orders.map(|order| order.to_string());
    let columns: Vec<&str> = ["", "way"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let in_f32 = |way: Way| at(way, "f32", 64).unwrap_or(f64::NAN);
    let (bands, pairs) = (in_f32(Way::Multiples), in_f32(Way::Pairs));
    let (wide, whole) = (in_f32(Way::WideSetup), in_f32(Way::Quaternion));
    // How many bands cost the recursion a digit.
    let lost = |number: &str| {
        let error = |order: usize| at(Way::Recursion, number, order).unwrap_or(f64::NAN);
        16.0 / (error(64) / error(48)).log10()
    };
    let shown = [2, 4, 8, 16, 32, 48, 63];
    let derivatives = stability.derivatives.iter().flat_map(|found| {
        ["value", "first", "second"].iter().enumerate().map(move |(k, name)| {
            let [cos, _] = recursion::ANGLES[found.angle];
            let mut row = vec![found.number.clone(), format!("cos β = {cos}"), (*name).to_owned()];
            let of = |l: &usize| found.bands.iter().position(|band| band == l).map(|place| found.errors[place][k]);
            row.extend(shown.iter().map(|l| perhaps(of(l).map(|error| if error < 1e-30 { 0.0 } else { error }))));
            row
        })
    });
    let names = shown.map(|l| l.to_string());
    let of_bands: Vec<&str> = ["", "angle", "derivative"].into_iter().chain(names.iter().map(String::as_str)).collect();
    vec![
        "## Exact rotations to order 64\n\nThe largest error of any band of norm one over rotations by nothing, by 90 \
             and 180 degrees, by tiny β and π − β, and random ones, against products with the exact J in pairs of \
             doubles. Inputs are taken as the number type holds them, quaternions as the rotation that they are when \
             normalised."
            .to_owned(),
        table(&columns, rows),
        "![Error of rotations over the band](stability_rotation.svg)".to_owned(),
        format!(
            "What costs accuracy in f32 at order 64: the bands themselves keep {} (asked for: {}, and flat), since J and \
             the plane rotations are orthogonal. Multiples of the angles by products of rounded cosines and sines bring \
             {}: what an angle is off by, its multiples are off by as many times. From a quaternion it is {}. With its \
             set-up and the multiples done in f64, from the same f32 quaternion, it is {}: an f32 quaternion is of unit \
             length only to a rounding, which moves β. Normalised in f64 besides, {}. So who wants order 64 flat in f32 \
             normalises, sets up and multiplies in f64, and rotates in f32: in Rust a quaternion of f64 and a signal \
             of `Channels<f32, N>`, to order 10 also `angles:n` in f64, `rotate:n:angles` in f32.",
            short(bands),
            short(ROTATION_TARGET),
            short(pairs),
            short(whole),
            short(wide),
            short(in_f32(Way::Normalised)),
        ),
        format!(
            "The recursion of Ivanic and Ruedenberg makes each band's matrix from the one below. From order 48 to 64 it \
             loses a digit every {} bands in f32 and every {} in f64. Its derivative form (Křivánek et al. 2005, appendix A) \
             loses as much, but not at β = 0, where the paper uses it. The entries' errors, root mean square over the \
             entries' own, by band:",
            short(lost("f32")),
            short(lost("f64"))
        ),
        table(&of_bands, derivatives),
    ]
}

fn angles(stability: &Stability) -> Vec<String> {
    let columns: Vec<&str> = ["β"].into_iter().chain(WAYS).collect();
    let rows = stability.euler.iter().map(|found| {
        let angle = if found.angle == 0.0 { "0".to_owned() } else { format!("{:e}", found.angle) };
        let mut row = vec![if found.from_pi { format!("π − {angle}") } else { angle }];
        row.extend(found.errors.map(short));
        row
    });
    let names = MULTIPLES.map(|m| format!("m ≤ {m}"));
    let of_multiples: Vec<&str> = ["", "way", "angles"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let multiples = ["f32", "f64"].into_iter().flat_map(|number| {
        RECURRENCES.into_iter().flat_map(move |way| ANGLES.map(move |kind| (number, way, kind))).filter_map(
            |(number, way, kind)| {
                let found = stability.multiples.iter().find(|found| {
                    (found.number.as_str(), found.way.as_str(), found.angles.as_str()) == (number, way, kind)
                })?;
                let mut row = vec![number.to_owned(), way.to_owned(), kind.to_owned()];
                row.extend(found.errors.map(short));
                Some(row)
            },
        )
    });
    vec![
        format!(
            "## The angles of a rotation\n\nf32, at β near 0 and near π, where α and γ have no meaning apart. From a \
             quaternion rounded to f32, and from a matrix whose entries are off by up to {} besides. The largest error of an \
             entry of the 3×3 matrix that the angles make.",
            short(NOISE)
        ),
        table(&columns, rows),
        "Three arc tangents, each from entries of its own, leave α and γ to the noise, apart from each other, and so does \
         an arc cosine. One after another, each from what the last has left, is as good as by a quaternion, and takes \
         trigonometry."
            .to_owned(),
        "## Multiples of an angle\n\nThe largest error of (cos mα, sin mα) against those of the angle that the rounded \
         (cos α, sin α) has; near means by 1e-4 to 1e-1."
            .to_owned(),
        table(&of_multiples, multiples),
    ]
}

fn turn_degrees() -> f64 {
    let [cos, sin] = TURN;
    sin.atan2(cos).to_degrees()
}

fn chain(stability: &Stability) -> Vec<String> {
    let names = STEPS.map(|steps| steps.to_string());
    let columns: Vec<&str> = ["spec", ""].into_iter().chain(names.iter().map(String::as_str)).collect();
    let rows = |random: bool| {
        let of = stability.chain.iter().filter(move |found| found.is_random() == random);
        of.map(|found| {
            let mut row = vec![format!("`{}`", found.spec), found.number.clone()];
            row.extend(found.norms.map(|norm| norm.map_or_else(|| "overflow".to_owned(), short)));
            row
        })
    };
    vec![
        "## Rotations in a row\n\nHow far the norm of a band, which no rotation changes, lies from what it was; the largest \
         of four bands (of three at order 3). By another random rotation each time:"
            .to_owned(),
        table(&columns, rows(true)),
        format!(
            "About y by the same {} degrees each time. LF3 is not orthogonal, but its shears cannot grow: the norm swings \
             about what it was, for ever. The Taylor expansions grow until they overflow:",
            short(turn_degrees())
        ),
        table(&columns, rows(false)),
        "![Drift of the norm](stability_chain.svg)".to_owned(),
    ]
}

fn special(stability: &Stability) -> Vec<String> {
    let find =
        |spec: &str, value: &str| stability.special.iter().find(|found| found.spec == spec && found.value == value);
    let rows = SPECS.iter().map(|spec| {
        let mut row = vec![format!("`{spec}`")];
        row.extend(VALUES.map(|(value, _)| match find(spec, value) {
            None => "–".to_owned(),
            Some(found) => match (found.finite, found.units, found.error) {
                (false, ..) => "in its band".to_owned(),
                (_, Some(units), _) if units < 100.0 => format!("{} units", short(units)),
                (_, _, error) => perhaps(error),
            },
        }));
        row
    });
    let columns: Vec<&str> = ["spec"].into_iter().chain(VALUES.map(|(name, _)| name)).collect();
    let spread = stability.special.iter().filter(|found| !found.others_unchanged).count();
    let bent = SPECS.iter().filter_map(|spec| {
        let of = |input: &str| stability.bent.iter().find(|found| found.spec == *spec && found.input == input);
        of(QUATERNIONS[0])?;
        let mut row = vec![format!("`{spec}`")];
        row.extend(QUATERNIONS.map(|input| match of(input) {
            None => "–".to_owned(),
            Some(found) if found.all_nan => "NaN, but band 0".to_owned(),
            Some(found) => found.change.map_or_else(|| "not finite".to_owned(), short),
        }));
        Some(row)
    });
    let of_quaternions: Vec<&str> = ["spec"].into_iter().chain(QUATERNIONS).collect();
    vec![
        format!(
            "## Coefficients at the ends of f32\n\nThe coefficients of band {BAND} are scaled to a norm, or all made \
             infinite or NaN; the others stay. Bands do not mix: in {spread} of {} trials another band changed in any \
             bit. In the band itself: the largest error over its norm, below the normal numbers in units of the smallest \
             f32, which is {}; an infinity or a NaN makes the numbers of its own band infinite or NaN.",
            stability.special.len(),
            short(f64::from(f32::from_bits(1)))
        ),
        table(&columns, rows),
        "## Quaternions that are none\n\nThe largest change of band l, over l times its norm, against the rotation by the \
         quaternion as it was, at and near the extremes among them. Band 0 passes through whatever comes. A rotation from \
         zero has no meaning; the kernels that need its phases give NaN, the tensor takes it for no rotation."
            .to_owned(),
        table(&of_quaternions, bent),
    ]
}

fn lobes(stability: &Stability) -> Vec<String> {
    let rows = stability.lobes.iter().filter(|set| set.chosen).map(|set| {
        vec![
            set.mode.clone(),
            set.size.to_string(),
            set.nonzeros.to_string(),
            short(set.condition),
            short(set.error),
            short(set.error / set.condition),
        ]
    });
    let most = stability.lobes.iter().map(|set| set.error / set.condition).fold(0.0, f64::max);
    vec![
        format!(
            "## Conditions of lobe sets\n\nA band is taken apart into lobes by Â and put together from their turned copies, \
             in f32, Â and the lobes' values rounded once. The sets that kernels use, of condition {LARGEST_CONDITION} at \
             most; the plot has all {} sets that are kept, of which none errs by more than {} times its condition.",
            stability.lobes.len(),
            short(most)
        ),
        table(&["bands share", "size", "non-zeros", "condition", "f32 error", "error / condition"], rows),
        "![Error against condition](stability_lobes.svg)".to_owned(),
    ]
}

/// The page.
pub fn tables(stability: &Stability) -> File {
    let mut parts = vec![
        "What the kernels do where numbers get hard. A test (`measure/tests/stability`) asserts what is promised here; \
         every figure is measured by `cargo measure`."
            .to_owned(),
    ];
    parts.extend(basis(stability));
    parts.extend(rotation(stability));
    parts.extend(angles(stability));
    parts.extend(chain(stability));
    parts.extend(special(stability));
    parts.extend(lobes(stability));
    file("stability", "The extremes", &parts)
}

/// What every chart over the band has in common.
fn over_bands(name: &str, title: &str, subtitle: &str, panels: Vec<Panel>, keys: Vec<Key>) -> File {
    let picture_of = Picture {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        size: [900.0, 520.0],
        columns: 2,
        panels,
        keys,
    };
    picture(name, &picture_of)
}

fn points(bands: &[usize], errors: &[f64]) -> Vec<(f64, f64)> {
    bands.iter().map(|l| *l as f64).zip(errors.iter().copied()).collect()
}

fn basis_plot(stability: &Stability) -> File {
    let colours = [4, 1, 3, 2, 0];
    let panel = |number: &str, high: f64, (low, most): (f64, f64)| {
        let curves = stability.basis.iter().filter(|curve| curve.number == number);
        let series = curves.map(|curve| Series {
            colour: PLACES.iter().position(|place| *place == curve.place).map_or(7, |place| colours[place]),
            stroke: Stroke::Solid,
            points: points(&curve.bands, &curve.errors),
        });
        let ticks: Vec<f64> =
            [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0].into_iter().filter(|x| *x <= high).collect();
        Panel {
            title: number.to_owned(),
            x: Axis::logarithmic("band", 1.0, high, &ticks),
            y: Axis::decades("error over the band's norm", low, most),
            series: series.collect(),
        }
    };
    let panels = vec![panel("f32", 64.0, (1e-8, 1e-4)), panel("f64", 128.0, (1e-17, 1e-13))];
    let keys = PLACES.iter().zip(colours).map(|(place, colour)| key(place, colour, Stroke::Solid)).collect();
    let subtitle = "The loop form, against polynomials in whole numbers";
    over_bands("stability_basis", "Error of the basis over the band", subtitle, panels, keys)
}

fn rotation_plot(stability: &Stability) -> File {
    let colours = [6, 5, 3, 4, 0, 2, 1];
    let panel = |number: &str, (low, most): (f64, f64)| {
        let curves = stability.rotation.iter().filter(|curve| curve.number == number);
        let series = curves.map(|curve| Series {
            colour: Way::ALL.iter().position(|(_, name)| *name == curve.way).map_or(7, |place| colours[place]),
            stroke: Stroke::Solid,
            points: points(&curve.bands, &curve.errors),
        });
        Panel {
            title: number.to_owned(),
            x: Axis::logarithmic("band", 1.0, 64.0, &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0]),
            y: Axis::decades("error of a band of norm one", low, most),
            series: series.collect(),
        }
    };
    let panels = vec![panel("f32", (1e-8, 1e-1)), panel("f64", (1e-17, 1e-10))];
    let keys = Way::ALL.iter().zip(colours).map(|((_, name), colour)| key(name, colour, Stroke::Solid)).collect();
    let subtitle = "The largest of all rotations tried, against products with the exact J";
    over_bands("stability_rotation", "Error of exact rotations over the band", subtitle, panels, keys)
}

fn chain_plot(stability: &Stability) -> File {
    let steps = STEPS.map(|steps| steps as f64);
    let colour = |found: &Drift, among: &[&str]| among.iter().position(|spec| *spec == found.spec).unwrap_or(7);
    let panel = |random: bool, title: &str, (low, most): (f64, f64)| {
        let own: Vec<&str> = stability
            .chain
            .iter()
            .filter(|found| found.is_random() == random && found.number == "f32")
            .map(|found| found.spec.as_str())
            .collect();
        let curves = stability.chain.iter().filter(|found| found.is_random() == random && found.number == "f32");
        let series: Vec<Series> = curves
            .map(|found| Series {
                colour: colour(found, &own),
                stroke: Stroke::Dotted,
                points: steps.into_iter().zip(found.norms).filter_map(|(step, norm)| Some((step, norm?))).collect(),
            })
            .collect();
        let panel = Panel {
            title: title.to_owned(),
            x: Axis::decades("rotations", 10.0, 1e5),
            y: Axis::decades("drift of a band's norm", low, most),
            series,
        };
        let keys: Vec<Key> = own.iter().enumerate().map(|(colour, spec)| key(spec, colour, Stroke::Dotted)).collect();
        (panel, keys)
    };
    let (random, mut keys) = panel(true, "random rotations, f32", (1e-8, 1.0));
    let (same, others) = panel(false, &format!("about y by {} degrees each, f32", short(turn_degrees())), (1e-8, 1e4));
    keys.extend(others);
    let subtitle = "How far a norm lies from what it was; what overflows ends";
    over_bands("stability_chain", "A hundred thousand rotations in a row", subtitle, vec![random, same], keys)
}

fn lobes_plot(stability: &Stability) -> File {
    let modes =
        [("nested", "nested, 2n − 1 lobes", 4), ("free", "any of 2n − 1 lobes", 5), ("band", "a band's own", 0)];
    let series = modes.iter().map(|(mode, _, colour)| Series {
        colour: *colour,
        stroke: Stroke::Dots,
        points: stability.lobes.iter().filter(|set| set.mode == *mode).map(|set| (set.condition, set.error)).collect(),
    });
    let panel = Panel {
        title: String::new(),
        x: Axis::logarithmic("largest condition number", 1.0, 110.0, &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]),
        y: Axis::decades("f32 error of a band of norm one", 1e-8, 1e-4),
        series: series.collect(),
    };
    let chart = Picture {
        title: "Lobe sets: f32 error against condition".to_owned(),
        subtitle: "A dot is a set that is kept".to_owned(),
        size: [695.0, 520.0],
        columns: 1,
        panels: vec![panel],
        keys: modes.iter().map(|(_, label, colour)| key(label, *colour, Stroke::Dots)).collect(),
    };
    picture("stability_lobes", &chart)
}

/// The plots.
pub fn plots(stability: &Stability) -> Vec<File> {
    vec![basis_plot(stability), rotation_plot(stability), chain_plot(stability), lobes_plot(stability)]
}
