//! The plots of a report.

use crate::errors::{LOBE, MAX, MEAN};
use crate::factorisation::sparsity;
use crate::methods::named;
use crate::svg::{Axis, Key, Panel, Picture, Series, Stroke, file, key};
use crate::{File, Report};
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::families::family::SMALL_ANGLE_DEGREES;
use zonal_codegen::promise::accuracy::method_error;

/// The colour of each method that is about y, of what is exact, and of laws.
const PLOTTED: [(&str, usize); 4] = [("taylor1", 4), ("taylor15", 1), ("taylor2", 3), ("lf3", 0)];
const EXACT: usize = 6;
const LAW: usize = 7;
const ANGLES: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0];

fn method_keys() -> Vec<Key> {
    let label = |name| named(name).map_or("", |method| method.label);
    PLOTTED.iter().map(|(name, colour)| key(label(name), *colour, Stroke::Solid)).collect()
}

fn over_angles(report: &Report, values: &[f64]) -> Vec<(f64, f64)> {
    report.angles.iter().copied().zip(values.iter().copied()).collect()
}

/// The largest error over the angle, the laws as dashes, the rounding of the exact rotation below.
fn error_over_angle(report: &Report, order: usize) -> File {
    let mut series = Vec::new();
    for (name, colour) in PLOTTED {
        let (Some(curve), Some(method)) = (report.curve(name, order), named(name)) else { continue };
        let spec = method.spec(order);
        let law: Vec<f64> = report.angles.iter().map(|degrees| method_error(&spec, degrees.to_radians())).collect();
        series.push(Series { colour, stroke: Stroke::Solid, points: over_angles(report, &curve.errors[MAX]) });
        series.push(Series { colour: LAW, stroke: Stroke::Dashed, points: over_angles(report, &law) });
    }
    let floor = report.rounding_of("rotate:n:zyz", order).and_then(|rounding| rounding.f32);
    if let Some(floor) = floor {
        let ends = [report.angles[0], report.angles[report.angles.len() - 1]];
        series.push(Series { colour: EXACT, stroke: Stroke::Solid, points: ends.map(|x| (x, floor)).to_vec() });
    }
    let mut keys = method_keys();
    keys.push(key("exact zyz, f32", EXACT, Stroke::Solid));
    keys.push(key("law, closed form", LAW, Stroke::Dashed));
    let picture = Picture {
        title: format!("Error of small rotations at order {order}"),
        subtitle: format!("The largest error of any signal of norm one, {} coefficients", order * order),
        size: [715.0, 520.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::logarithmic("angle about y in degrees", 0.1, 45.0, &ANGLES),
            y: Axis::decades("relative error", 1e-7, 10.0),
            series,
        }],
        keys,
    };
    file(&format!("error_order{order}"), &picture)
}

/// Figure 3 of Křivánek et al. 2005 with LF3 beside.
fn figure_3(report: &Report) -> File {
    let panels = [(MAX, "largest"), (MEAN, "mean singular value"), (LOBE, "Phong lobe cos⁵, relative")]
        .into_iter()
        .flat_map(|(norm, title)| [5, 8].map(|order| (norm, title, order)))
        .map(|(norm, title, order)| {
            let curve = |(name, colour): (&str, usize)| {
                let curve = report.curve(name, order)?;
                Some(Series { colour, stroke: Stroke::Solid, points: over_angles(report, &curve.errors[norm]) })
            };
            Panel {
                title: format!("order {order}: {title}"),
                x: Axis::linear("angle about y in degrees", 0.0, 45.0, &[0.0, 10.0, 20.0, 30.0, 40.0]),
                y: Axis::linear("error", 0.0, 1.0, &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
                series: PLOTTED.into_iter().filter_map(curve).collect(),
            }
        })
        .collect();
    let picture = Picture {
        title: "Errors of Taylor expansions and of LF3 over the angle".to_owned(),
        subtitle: "Křivánek et al. 2005, Figure 3, reproduced; LF3 is ours".to_owned(),
        size: [810.0, 1020.0],
        columns: 2,
        panels,
        keys: method_keys(),
    };
    file("figure3", &picture)
}

/// The fronts of cost against error, from a quaternion.
fn fronts(report: &Report) -> File {
    let colours = [(5.0, 4), (10.0, 5), (15.0, 2), (25.0, 1)];
    let orders = [3, 4, 5, 6, 8, 10];
    let panels = orders
        .into_iter()
        .map(|order| {
            let exact = report.cost("rotate:n", order).map_or(1, |costs| costs.operations) as f64;
            // An exact rotation has no error of its own; its step begins at the lower edge.
            let curves = colours.iter().flat_map(|(degrees, colour)| {
                let front = report.fronts.iter().find(|front| front.order == order && front.degrees == *degrees);
                let points: Vec<(f64, f64)> = front.map_or_else(Vec::new, |front| {
                    front.points.iter().map(|point| (point.operations as f64, point.law.max(1e-6))).collect()
                });
                [Series { colour: *colour, stroke: Stroke::Steps, points }]
            });
            let high = exact * 1.08;
            let step = [5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0].into_iter().find(|step| high / step <= 5.0);
            let step = step.unwrap_or(500.0);
            let ticks: Vec<f64> = (0..).map(|i| step * f64::from(i)).take_while(|tick| *tick <= high).collect();
            Panel {
                title: format!("order {order}"),
                x: Axis::linear("operations a vector", 0.0, high, &ticks),
                y: Axis::decades("largest error", 1e-5, 10.0),
                series: curves.collect(),
            }
        })
        .collect();
    let mut keys: Vec<Key> =
        colours.iter().map(|(degrees, colour)| key(&format!("up to {degrees}°"), *colour, Stroke::Solid)).collect();
    keys.reverse();
    let picture = Picture {
        title: "What an error costs: rotations from a quaternion whose y angle is bounded".to_owned(),
        subtitle: format!(
            "The cheapest choice of a method for each band; the last drop is the exact rotation, all that there is above {SMALL_ANGLE_DEGREES}°"
        ),
        size: [970.0, 720.0],
        columns: 3,
        panels,
        keys,
    };
    file("fronts", &picture)
}

/// The operations of full rotations over the order.
fn operations(report: &Report) -> File {
    let over = |name: &str| -> Vec<(f64, f64)> {
        ORDERS.filter_map(|order| Some((order as f64, report.cost(name, order)?.operations as f64))).collect()
    };
    let dense = ORDERS.map(|n| (n as f64, dense_operations(n) as f64)).collect();
    let rows = [
        ("zonal factorisation", 3, over("zhf:n")),
        ("dense matrix, given", 7, dense),
        ("zxzxz", 1, over("rotate:n:zxzxz")),
        ("zyz, exact", EXACT, over("rotate:n:zyz")),
        ("tilt", 2, over("tilt:n")),
        ("zyz, LF3", 0, over("rotate:n:lf3")),
        ("zyz, Taylor 1.5", 4, over("rotate:n:taylor15")),
    ];
    let keys = rows.iter().map(|(label, colour, _)| key(label, *colour, Stroke::Dotted)).collect();
    let series =
        rows.into_iter().map(|(_, colour, points)| Series { colour, stroke: Stroke::Dotted, points }).collect();
    let orders: Vec<f64> = ORDERS.map(|order| order as f64).collect();
    let picture = Picture {
        title: "Operations of a full rotation".to_owned(),
        subtitle: "One channel; a multiplication, an addition or a multiply-add each".to_owned(),
        size: [695.0, 520.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::linear("order", 1.8, 10.2, &orders),
            y: Axis::logarithmic(
                "operations a vector",
                5.0,
                10000.0,
                &[5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0],
            ),
            series,
        }],
        keys,
    };
    file("operations", &picture)
}

/// The operations of a product with the blocks of a given matrix.
pub fn dense_operations(order: usize) -> usize {
    (1..order).map(|l| (2 * l + 1).pow(2)).sum()
}

/// The rounding error over the order, a panel for each precision.
fn rounding(report: &Report) -> File {
    let rows = [
        ("zonal factorisation", 3, "zhf:n"),
        ("zxzxz", 1, "rotate:n:zxzxz"),
        ("zyz from quaternion", EXACT, "rotate:n:zyz"),
        ("zyz, angles given", 7, "rotate:n:angles"),
        ("align", 5, "rotate:n:align"),
        ("basis", 4, "basis:n"),
        ("tilt", 2, "tilt:n"),
        ("LF3 about y", 0, "lf3:n"),
    ];
    let precisions = [("f16", 1e-4, 1.0), ("f32", 1e-8, 1e-4), ("f64", 1e-17, 1e-13)];
    let orders: Vec<f64> = ORDERS.map(|order| order as f64).collect();
    let panels = precisions
        .into_iter()
        .map(|(precision, low, high)| {
            let series = rows.iter().map(|(_, colour, spec)| {
                let at = |order: usize| {
                    let found = report.rounding_of(spec, order)?;
                    let value = match precision {
                        "f16" => found.f16,
                        "f32" => found.f32,
                        _ => found.f64,
                    };
                    Some((order as f64, value?))
                };
                Series { colour: *colour, stroke: Stroke::Dotted, points: ORDERS.filter_map(at).collect() }
            });
            Panel {
                title: precision.to_owned(),
                x: Axis::linear("order", 1.8, 10.2, &orders),
                y: Axis::decades("rounding error", low, high),
                series: series.collect(),
            }
        })
        .collect();
    let picture = Picture {
        title: "Rounding over the order".to_owned(),
        subtitle: "The largest error of a band, relative to its norm; what is missing gives no number".to_owned(),
        size: [995.0, 500.0],
        columns: 3,
        panels,
        keys: rows.iter().map(|(label, colour, _)| key(label, *colour, Stroke::Dotted)).collect(),
    };
    file("rounding", &picture)
}

/// The sparsity of Â against the condition of Y.
fn factorisation(report: &Report) -> File {
    let sets = &report.factorisation;
    let bands = sets.bands.iter().map(|band| (band.condition, sparsity(band.l, band.nonzeros))).collect();
    let shared = |free: bool| {
        let chosen = sets.shared.iter().filter(move |set| set.free == free);
        let bands = |set: &crate::factorisation::Shared| -> Vec<(f64, f64)> {
            (2..set.order).map(|l| (set.conditions[l], sparsity(l, set.nonzeros[l]))).collect()
        };
        chosen.flat_map(bands).collect()
    };
    let rows = [
        ("nested, 2n − 1 lobes", 4, shared(false)),
        ("any of 2n − 1 lobes", 5, shared(true)),
        ("a band's own lobes", 0, bands),
    ];
    let keys = rows.iter().rev().map(|(label, colour, _)| key(label, *colour, Stroke::Dots)).collect();
    let series = rows.into_iter().map(|(_, colour, points)| Series { colour, stroke: Stroke::Dots, points }).collect();
    let picture = Picture {
        title: "Zonal factorisation: sparsity against condition".to_owned(),
        subtitle: "A dot is a band of a lobe set, bands 2 to 10".to_owned(),
        size: [695.0, 520.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::logarithmic("condition number of Y", 1.0, 250.0, &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0]),
            y: Axis::linear("zeros in Â, percent", 30.0, 80.0, &[30.0, 40.0, 50.0, 60.0, 70.0, 80.0]),
            series,
        }],
        keys,
    };
    file("factorisation", &picture)
}

/// Every plot.
pub fn files(report: &Report) -> Vec<File> {
    let mut files = vec![
        error_over_angle(report, 5),
        error_over_angle(report, 8),
        figure_3(report),
        fronts(report),
        operations(report),
        rounding(report),
        factorisation(report),
        crate::shading::plot(&report.shading),
        crate::filtering::plot(&report.filtering),
        crate::glossy::plot(&report.glossy),
    ];
    files.extend(crate::stability::report::plots(&report.stability));
    files
}
