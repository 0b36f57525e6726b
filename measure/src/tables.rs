//! The tables of a report, as Markdown. No figure is typed here: what the papers print comes from [`crate::papers`].
//! One file: a page of docs/measure a function.

use crate::bounds::{Bounds, Pair};
use crate::errors::{LEVELS, LOBE, MAX, MEAN, NORMS, RMS, SHOWN};
use crate::factorisation::{Shared, sparsity};
use crate::fronts::{Plan, TURNS};
use crate::markdown::{file, perhaps, short, table};
use crate::methods::{METHODS, named};
use crate::papers::{Column, ERRATA, LOBES, SPARSITY, TABLE_2, recomputed};
use crate::plots::dense_operations;
use crate::turns;
use crate::{File, Report};
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::families::Spec;
use zonal_codegen::promise::law;
use zonal_codegen::scene::Job;

fn degrees(value: f64) -> String {
    format!("{value}°")
}

fn errors(report: &Report) -> File {
    let levels: Vec<String> = LEVELS.iter().map(|level| format!("{level:e}")).collect();
    let laws = METHODS.map(|method| vec![method.label.to_owned(), method.formula.to_owned()]);
    let mut parts = vec![
        "D(β) is the difference of the approximate and the exact rotation about y (for the tilt: of z towards x) by β. \
         *Max* is its largest singular value, the largest error of any signal of norm one; *mean singular value* the \
         mean of all n² of them, which Křivánek et al. 2005 call the average error; *rms* their root mean square, which \
         is the error of a random signal; the lobes are max(0, cos θ)⁵ and ²⁰ about z, their error relative to their norm."
            .to_owned(),
        "![Error over the angle, order 5](error_order5.svg)".to_owned(),
        "![Error over the angle, order 8](error_order8.svg)".to_owned(),
        "## Laws\n\nThe largest error of band l begins with this term in L = lβ. The whole law is the closed form that the \
         planner takes (`codegen/src/promise/law.rs`), dashed in the plots."
            .to_owned(),
        table(&["method", "error"], laws),
        "## Figure 3 of Křivánek et al. 2005\n\nThe paper plots the largest error, the average error and that of a Phong \
         lobe at the orders 5 and 8. The angle in degrees at which each error is reached, LF3 beside:\n\n\
         ![Figure 3](figure3.svg)"
            .to_owned(),
    ];
    let row = |name: &str, label: &str, order: usize, norm: usize| -> Option<Vec<String>> {
        let curve = report.curve(name, order)?;
        let mut row = vec![order.to_string(), NORMS[norm].to_owned(), label.to_owned()];
        row.extend(curve.reaches[norm].iter().map(|angle| perhaps(*angle)));
        Some(row)
    };
    let columns: Vec<&str> =
        ["order", "error", "method"].into_iter().chain(levels.iter().map(String::as_str)).collect();
    let all = |orders: &[usize], norms: &[usize]| -> String {
        let rows = orders.iter().flat_map(|order| norms.iter().map(move |norm| (*order, *norm)));
        let rows = rows.flat_map(|(order, norm)| METHODS.iter().map(move |method| (order, norm, method)));
        table(&columns, rows.filter_map(|(order, norm, method)| row(method.name, method.label, order, norm)))
    };
    parts.push(all(&[5, 8], &[MAX, MEAN, RMS, LOBE]));
    parts.push("## Every order\n\nThe angle in degrees at which the largest error is reached:".to_owned());
    parts.push(all(&ORDERS.collect::<Vec<_>>(), &[MAX]));
    parts.push("The errors at some angles, largest and rms:".to_owned());
    let shown: Vec<String> = SHOWN.iter().map(|angle| degrees(*angle)).collect();
    let columns: Vec<&str> = ["order", "method"].into_iter().chain(shown.iter().map(String::as_str)).collect();
    let rows = report.errors.iter().map(|curve| {
        let label = named(&curve.method).map_or("", |method| method.label);
        let pair = |place: usize| format!("{} / {}", short(curve.shown[MAX][place]), short(curve.shown[RMS][place]));
        [curve.order.to_string(), label.to_owned()].into_iter().chain((0..SHOWN.len()).map(pair)).collect()
    });
    parts.push(table(&columns, rows));
    file("errors", "Error over the angle", &parts)
}

fn costs(report: &Report) -> File {
    let rows = report.costs.iter().map(|costs| {
        let mut row = vec![format!("`{}`", costs.spec)];
        row.extend(
            [
                costs.operations,
                costs.operations_rgb,
                costs.special,
                costs.constants,
                costs.live,
                costs.wgsl,
                costs.glsl,
            ]
            .map(|count| count.to_string()),
        );
        row
    });
    let methods =
        ["rotate:n:zyz", "rotate:n:zxzxz", "zhf:n", "tilt:n", "rotate:n:align", "rotate:n:lf3", "rotate:n:taylor15"];
    let by_order = ORDERS.map(|order| {
        let operations = methods
            .map(|spec| report.cost(spec, order).map_or_else(|| "–".to_owned(), |costs| costs.operations.to_string()));
        let mut row = vec![order.to_string()];
        row.extend(operations);
        row.push(dense_operations(order).to_string());
        row
    });
    let columns = [
        "order",
        "zyz",
        "zxzxz",
        "zonal factorisation",
        "tilt",
        "align",
        "zyz, LF3",
        "zyz, Taylor 1.5",
        "dense matrix, given",
    ];
    let parts = [
        "A multiplication, an addition or a multiply-add is one operation; an inverse square root or a reciprocal \
         (special) is counted apart. zyz, zxzxz and align take a quaternion or a normal and do their set-up; the small \
         rotations take the cosines and sines of the two z angles; the dense matrix is given, its making not counted."
            .to_owned(),
        "![Operations over the order](operations.svg)".to_owned(),
        table(&columns, by_order),
        "## Every kernel\n\nOperations for one channel and for three, inverse square roots and reciprocals, distinct \
         constants, the most values alive at once, the bytes of the shader's file with its comments."
            .to_owned(),
        table(&["spec", "one channel", "RGB", "special", "constants", "live", "WGSL", "GLSL"], rows),
    ];
    file("costs", "Operations and memory", &parts)
}

fn rounding(report: &Report) -> File {
    let rows = report.rounding.iter().map(|rounding| {
        let mut row = vec![format!("`{}`", rounding.spec)];
        row.extend([rounding.f16, rounding.f32, rounding.f64].map(perhaps));
        row
    });
    let parts = [
        format!(
            "The largest error of any band, relative to the band's norm, over {} seeded inputs, poles and tiny angles \
             among them, with multiply-adds rounded once and twice. Inputs are taken as exact; approximate methods turn \
             by up to 25 degrees, and their method's error is not in these figures. f16 rounds every operation to \
             binary16; a dash means that some input gives no number: the set-up from a quaternion squares numbers that \
             f16 does not hold, so that f16 wants its angles made in f32.",
            crate::rounding::SAMPLES
        ),
        "![Rounding over the order](rounding.svg)".to_owned(),
        table(&["spec", "f16", "f32", "f64"], rows),
    ];
    file("rounding", "Rounding", &parts)
}

/// The methods of a spec's bands from 1, neighbours of one method together.
fn bands(spec: &str) -> String {
    let spec: Spec = spec.parse().expect("a report holds specs");
    let Some((methods, _)) = law::methods(&spec) else { return "exact".to_owned() };
    let mut first = 1;
    let runs = methods.chunk_by(|a, b| a == b).map(|run| {
        let (start, end) = (first, first + run.len() - 1);
        first = end + 1;
        match (run.len() == methods.len(), start == end) {
            (true, _) => run[0].name().to_owned(),
            (_, true) => format!("{start} {}", run[0].name()),
            _ => format!("{start}–{end} {}", run[0].name()),
        }
    });
    runs.collect::<Vec<_>>().join(", ")
}

fn fronts(report: &Report) -> File {
    let mut parts = vec![
        "What the planner chooses (`codegen/src/plan/mixtures.rs`): the cheapest kernel whose predicted error keeps the budget, a \
         method for each band. Errors are of a band, over its norm, at any angle up to the largest. *Law* is the method's \
         own, in closed form, *rounding* what f32 may add, proven; *predicted* is their sum, as a scene's plan has it. \
         *Measured* is the largest error of the kernel in f32 against the exact rotation, over angles up to the largest \
         and turns about z, on the signals that the kernel's own matrix errs most on, and others. A test holds it below \
         what is predicted, and that below the budget; where the law is 0, rounding alone decides."
            .to_owned(),
        "![What an error costs](fronts.svg)".to_owned(),
    ];
    let columns =
        ["order", "up to", "budget", "operations", "methods by band", "law", "rounding", "predicted", "measured"];
    for turn in TURNS {
        let title = match turn {
            Job::Tilt => "From a normal: the tilt of z to it; the exact rotation takes the tilt's quaternion",
            Job::Y => "About y, given the angle, or its cosine and sine for the exact rotation",
            Job::Zyz => "About z, y and z",
            Job::Quaternion => "From a quaternion whose y angle is bounded, set-up counted",
        };
        // The budgets that the same kernel keeps stand together, the largest first.
        let row = |same: &[Plan]| {
            let (first, last) = (&same[0], &same[same.len() - 1]);
            let budget = match same.len() {
                1 => format!("{:e}", first.budget),
                _ => format!("{:e} to {:e}", first.budget, last.budget),
            };
            let errors = [first.choice.law, first.rounding, first.predicted(), first.measured].map(short);
            let choice = [budget, first.choice.operations.to_string(), bands(&first.choice.spec)];
            [first.order.to_string(), degrees(first.degrees)].into_iter().chain(choice).chain(errors).collect()
        };
        let same = |a: &Plan, b: &Plan| (a.order, a.degrees, &a.choice.spec) == (b.order, b.degrees, &b.choice.spec);
        let plans: Vec<Plan> = report.plans.iter().filter(|plan| plan.turn == turn).cloned().collect();
        parts.push(format!("## {title}"));
        parts.push(table(&columns, plans.chunk_by(same).map(row)));
    }
    let points = report.fronts.iter().flat_map(|front| {
        front.points.iter().map(|point| {
            let place = [front.order.to_string(), degrees(front.degrees), point.operations.to_string()];
            place.into_iter().chain([short(point.law), bands(&point.spec)]).collect()
        })
    });
    parts
        .push("## The fronts\n\nFrom a quaternion: every choice that no other beats in operations and law.".to_owned());
    parts.push(table(&["order", "up to", "operations", "law", "methods by band"], points));
    file("fronts", "What an error costs", &parts)
}

fn differing(printed: usize, right: usize) -> String {
    match printed == right {
        true => printed.to_string(),
        false => format!("{printed} → **{right}**"),
    }
}

fn table_1(report: &Report) -> Vec<String> {
    let sets = &report.factorisation;
    let rows = sets.bands.iter().map(|band| {
        let entries = (2 * band.l + 1).pow(2);
        let printed = SPARSITY[band.l - 2];
        let exact = LOBES.get(band.l - 2).map(|lobes| lobes.iter().sum::<usize>());
        let count = exact.map_or_else(
            || format!("≈ {:.0}", entries as f64 * (1.0 - printed as f64 / 100.0)),
            |count| count.to_string(),
        );
        vec![
            band.l.to_string(),
            count,
            format!("{printed} %"),
            band.nonzeros.to_string(),
            format!("{:.1} %", sparsity(band.l, band.nonzeros)),
            short(band.condition),
            band.found[1].to_string(),
        ]
    });
    let tries = sets.bands.iter().map(|band| band.found[1] + 1).max().unwrap_or(0);
    let seed = sets.bands.first().map_or(0, |band| band.found[0]);
    let list = |lobes: &[usize]| lobes.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    let lobes = sets.bands.iter().map(|band| {
        let printed = LOBES.get(band.l - 2).map_or_else(|| "–".to_owned(), |lobes| list(lobes));
        vec![band.l.to_string(), printed, list(&band.lobes)]
    });
    vec![
        format!(
            "## Table I: sparsity of a band's own lobes\n\nNon-zeros of Â and the share of zeros, as printed and ours; the \
             condition number is that of our Y. Where the paper prints no counts, they are those that its percentage \
             allows. Ours are what `zonal search-lobes --mode band --size 2-10 --seed {seed} --tries {tries}` finds, in \
             the try that is named."
        ),
        table(&["l", "printed non-zeros", "printed zeros", "our non-zeros", "our zeros", "condition", "try"], rows),
        "The lobes of each function, m = −l to l:".to_owned(),
        table(&["l", "printed", "ours"], lobes),
    ]
}

fn shared_lobes(report: &Report) -> Vec<String> {
    let sets = &report.factorisation;
    let find = |order: usize, free: bool| sets.shared.iter().find(|set| set.order == order && set.free == free);
    let cells = |set: Option<&Shared>| -> Vec<String> {
        set.map_or_else(
            || vec!["–".to_owned(); 3],
            |set| vec![set.from_band_2().to_string(), format!("{:.1} %", set.sparsity()), short(set.condition())],
        )
    };
    let rows = (3..=10).map(|order| {
        let mut row = vec![order.to_string(), TABLE_2[order - 3].sparse.to_string()];
        row.extend(cells(find(order, false)));
        row.extend(cells(find(order, true)));
        row
    });
    let columns = ["N", "printed", "nested", "zeros", "condition", "free", "zeros", "condition"];
    vec![
        "## Lobes shared by the bands of an order\n\nNon-zeros of Â in the bands from 2 on (Table II's row \"sparse \
         multiplication\"), with 2N − 1 lobes of which band l takes the first 2l + 1 (nested, as in the paper) or any \
         2l + 1 (free: no further evaluation of the basis). Zeros are of all bands, the condition is the largest of any."
            .to_owned(),
        table(&columns, rows),
        "![Sparsity against condition](factorisation.svg)".to_owned(),
    ]
}

fn table_2(report: &Report) -> Vec<String> {
    let right: Vec<Column> = TABLE_2
        .iter()
        .zip(&report.factorisation.x_nonzeros)
        .map(|(printed, count)| recomputed(printed, *count))
        .collect();
    let printed = TABLE_2.iter().zip(&right).map(|(printed, right)| {
        vec![
            printed.order.to_string(),
            differing(printed.z, right.z),
            differing(printed.z_optimised, right.z_optimised),
            differing(printed.x, right.x),
            differing(printed.zxzxz, right.zxzxz),
            differing(printed.basis, right.basis),
            differing(printed.values, right.values),
            printed.sparse.to_string(),
            differing(printed.standard, right.standard),
            differing(printed.tabulated, right.tabulated),
        ]
    });
    let columns = ["N", "z", "z (opt.)", "x", "zxzxz", "basis", "[Y^R]ᵀ", "Â", "standard (CPU)", "standard (GPU)"];

    let ours = right.iter().take_while(|column| column.order <= 10).map(|column| {
        let n = column.order;
        let products =
            |spec: &str| report.cost(spec, n).map_or_else(|| "–".to_owned(), |costs| costs.products.to_string());
        let pairs = [
            (column.z, "rotate_z:n"),
            (column.x, "rotate_x_plus_90:n"),
            (column.zxzxz, "rotate:n:zxzxz"),
            (column.basis, "basis:n"),
            (column.sparse, "zhf_weights:n"),
            (column.standard, "zhf:n"),
        ];
        let pairs = pairs.map(|(paper, spec)| format!("{paper} / {}", products(spec)));
        [n.to_string()].into_iter().chain(pairs).chain([products("rotate:n:zyz")]).collect()
    });
    let errata: Vec<String> = ERRATA.iter().map(|erratum| format!("* {erratum}")).collect();
    vec![
        "## Table II: multiplications\n\nAs printed; where a recomputation differs, it follows the arrow. Recomputed: \
         z = 2N² + 4N + 4, z (opt.) = 2N(N − 1) + 4(N − 2), x the non-zeros of the matrix in the bands from 2 on, \
         zxzxz = 3z + 2x, basis = (5N² − 7N + 4)/2, [Y^R]ᵀ = N(4N² − 1)/3 − 10, \
         standard = (2N − 1) basis + [Y^R]ᵀ + Â."
            .to_owned(),
        table(&columns, printed),
        "Ours beside: multiplications and multiply-adds of the generated kernels, after the paper's recomputed count. Âᵀ \
         counts bands 0 and 1 too, which are scaled. The last column is the exact z, y, z rotation from a quaternion: fewer \
         than zxzxz and than the standard rotation at every order; only the signal-tailored rotation, Â alone, takes \
         fewer, and it wants the samples made."
            .to_owned(),
        table(&["N", "z", "x", "zxzxz", "basis", "Âᵀ (free lobes)", "standard", "our zyz"], ours),
        format!("What is wrong in print:\n\n{}", errata.join("\n")),
    ]
}

fn factorisation(report: &Report) -> File {
    let mut parts = vec![
        "Nowrouzezahrai, Simari and Fiume, \"Sparse Zonal Harmonic Factorization for Efficient SH Rotation\" (2012), \
         Tables I and II, with the lobe sets and the kernels of this project beside."
            .to_owned(),
    ];
    parts.extend(table_1(report));
    parts.extend(shared_lobes(report));
    parts.extend(table_2(report));
    file("factorisation", "Sparse zonal factorisation", &parts)
}

fn timing(report: &Report) -> File {
    let Some(timing) = &report.timing else {
        return file("timing", "Time", &["Not measured yet: run `cargo measure-times`.".to_owned()]);
    };
    let rows = timing.kernels.iter().map(|times| {
        let operations = report
            .costs
            .iter()
            .find(|costs| costs.spec == times.spec)
            .map_or_else(|| "–".to_owned(), |costs| costs.operations.to_string());
        let mut row = vec![format!("`{}`", times.spec), operations];
        row.extend(
            [times.f32, times.plain, times.f64, times.lanes]
                .iter()
                .flat_map(|time| [short(time.nanoseconds), short(time.copies)]),
        );
        row
    });
    let slower = timing.kernels.iter().filter(|times| times.lanes.nanoseconds > times.f32.nanoseconds);
    let slower: Vec<String> = slower.map(|times| format!("`{}`", times.spec)).collect();
    let remark = match slower.is_empty() {
        true => String::new(),
        false => format!("Slower in lanes than one at a time, as compiled here: {}.", slower.join(", ")),
    };
    let parts = [
        format!(
            "Nanoseconds a vector of the compiled kernels on one core ({}), and the ratio to a copy of the same bytes, \
             timed in turn in the same run: medians. *Call*: by single calls, each of a function that is compiled by \
             itself and writes its result in place. *Loop*: the same kernel inlined into a plain loop over slices, of which the compiler may work on \
             several vectors at once: another thing, and neither is wrong. *Lanes*: a loop over blocks of sixteen \
             vectors, interleaved, in f32. `rotate:n:angles` and `rotate:n:lifted` are timed without their set-up, \
             which serves many vectors. Compiled for the architecture's baseline, so without multiply-add instructions \
             on x86-64; [peers](peers.md) has single calls and loops by what they are compiled for. No test reads these \
             figures.",
            timing.machine
        ),
        table(
            &[
                "spec",
                "operations",
                "call f32, ns",
                "copies",
                "loop f32, ns",
                "copies",
                "call f64, ns",
                "copies",
                "lanes, ns",
                "copies",
            ],
            rows,
        ),
        remark,
        turns::part(&timing.turns),
        turns::shading(report),
    ];
    file("timing", "Time", &parts)
}

fn proven(report: &Report) -> File {
    let title = "Proven rounding bounds";
    let Some(bounds) = &report.bounds else {
        return file("bounds", title, &["Not measured yet: run `cargo measure --bounds`.".to_owned()]);
    };
    let rows = bounds.iter().map(|row| {
        let pair = |pair: Pair| [short(pair.proven), short(pair.measured), short(pair.ratio())];
        let [a, b] = [pair(row.separate), pair(row.fused)];
        [vec![format!("`{}`", row.spec)], a.to_vec(), b.to_vec()].concat()
    });
    let ratios = |of: fn(&Bounds) -> Pair| {
        let mut ratios: Vec<f64> = bounds.iter().map(|row| of(row).ratio()).collect();
        ratios.sort_by(f64::total_cmp);
        (ratios[ratios.len() / 2], ratios[ratios.len() - 1], ratios.iter().filter(|ratio| **ratio > 10.0).count())
    };
    let (median, most, loose) = ratios(|row| row.fused);
    let inputs = bounds.iter().map(|row| row.inputs).min().unwrap_or(0);
    let parts = [
        format!(
            "The f32 rounding error of each kernel: what `codegen/src/promise/bound` proves for every input of its domain, the \
             largest that {inputs} seeded inputs reach, and how many times the one is the other; on the left where a \
             multiply-add is rounded twice, on the right where it is rounded once. The measure is that of the file's \
             head: relative to the norm of a band (for the basis: to one; for sums: to coefficients of which each band has \
             norm one). `cargo measure --bounds` measures them again; nothing else does."
        ),
        format!(
            "Of {} kernels none exceeds its bound. Rounded once, the median ratio is {}, the largest {}; {loose} are above \
             10. Random inputs are not the worst ones: a part of each ratio is what a search would still find.",
            bounds.len(),
            short(median),
            short(most)
        ),
        table(&["spec", "proven", "measured", "ratio", "proven, fused", "measured", "ratio"], rows),
    ];
    file("bounds", title, &parts)
}

fn index(report: &Report) -> File {
    let rows = [
        ("[errors](errors.md)", "how far each approximation errs at which angle; Figure 3 of Křivánek et al. 2005"),
        ("[costs](costs.md)", "operations, constants, live values and bytes of every rotation"),
        ("[fronts](fronts.md)", "the cheapest rotation for an error, by order and angle, predicted and measured"),
        ("[rounding](rounding.md)", "what f16, f32 and f64 add"),
        ("[bounds](bounds.md)", "the proven rounding bounds of all kernels, and what a million inputs reach"),
        ("[stability](stability.md)", "the extremes: order 64, poles, tiny angles, rotations in a row, infinities"),
        ("[factorisation](factorisation.md)", "Tables I and II of Nowrouzezahrai et al. 2012, ours beside"),
        ("[ringing](ringing.md)", "what is done against ringing, and how far it errs on eight maps"),
        ("[irradiance_bases](irradiance_bases.md)", "bases of irradiance ranked; Figure 3 of Habel and Wimmer 2010"),
        (
            "[hemisphere_bases](hemisphere_bases.md)",
            "what bases capture of lobes: Figures 4 and 5 of Gautron et al. 2004",
        ),
        ("[hemisphere_rotation](hemisphere_rotation.md)", "what rotations of hemispherical harmonics err by"),
        ("[hemisphere_light](hemisphere_light.md)", "environment light in hemispherical harmonics"),
        (
            "[hemisphere_reflectance](hemisphere_reflectance.md)",
            "reflectances in hemispherical harmonics: Figure 6 and Table 1 of Gautron et al. 2004",
        ),
        ("[shading](shading.md)", "isotropic decomposition: Figure 13 of Soler et al. 2015, costs, convergence"),
        ("[filtering](filtering.md)", "sparse and noisy reflectances, filtered: Figure 11 of Soler et al. 2015"),
        ("[glossy](glossy.md)", "glossy surfaces: Figures 4 and 12 and Table I of Soler et al. 2015"),
        ("[timing](timing.md)", "nanoseconds a vector"),
        ("[instructions](instructions.md)", "instructions of single calls, counted"),
        (
            "[peers](peers.md)",
            "zonal beside sphericart, ducc0, pyshtools, sphrs and splat-transform; written by measure/peers",
        ),
        ("[measure.json](measure.json)", "all of it as data"),
    ];
    let exact = report.cost("rotate:n", 5).map_or(0, |costs| costs.operations);
    let bound = report.rounding_of("rotate:n", 5).and_then(|rounding| rounding.f32);
    let parts = [
        "Speed against accuracy, measured. `cargo measure` writes this folder; `cargo measure --check` \
         says whether it is stale, and a test does too (times apart); `cargo measure-times` takes the times, `cargo measure \
         --bounds` the bounds, `cargo measure --instructions` counts instructions."
            .to_owned(),
        format!(
            "![Error over the angle, order 5](error_order5.svg)\n\nThe exact rotation of order 5 takes {exact} operations \
             and errs by {} in f32; an approximation is worth its error while it is cheaper by enough.",
            perhaps(bound)
        ),
        table(&["file", "what it holds"], rows.map(|(name, what)| vec![name.to_owned(), what.to_owned()])),
    ];
    file("README", "What was measured", &parts)
}

/// Every table.
pub fn files(report: &Report) -> Vec<File> {
    vec![
        index(report),
        errors(report),
        costs(report),
        fronts(report),
        rounding(report),
        proven(report),
        crate::stability::report::tables(&report.stability),
        factorisation(report),
        crate::ringing::table(&report.ringing),
        crate::shading::table(&report.shading),
        crate::filtering::table(&report.filtering),
        crate::glossy::table(&report.glossy),
        timing(report),
        crate::instructions::page(report.instructions.as_deref()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.28e-5, "1.3e-5"),
            (2.0e-5, "2e-5"),
            (0.010_04, "0.01"),
            (3.004, "3"),
            (12.345, "12.3"),
            (100.0, "100"),
            (1234.6, "1235"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn neighbours_of_one_method_stand_together() {
        assert_eq!(bands("rotate:5"), "exact");
        assert_eq!(bands("lf3:5"), "lf3");
        let mixed = "rotate_small:6:exact+exact+lf3+taylor2+taylor2";
        assert_eq!(bands(mixed), "1–2 exact, 3 lf3, 4–5 taylor2");
    }
}
