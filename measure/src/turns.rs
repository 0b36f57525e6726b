//! Ways to turn at the orders 3 to 10, timed, beside what the papers say of theirs: zonal factorisation against z-x-z-x-z
//! (Nowrouzezahrai et al. 2012, figure 5), the expansion for small angles against it (Křivánek et al. 2005, table 1); and what
//! shading by isotropic decomposition spares of it (Soler et al. 2015, figure 3).

use crate::markdown::{short, table};
use crate::report::Report;
use crate::timing::Single;

/// The ways, their orders left out: the columns.
const WAYS: [&str; 6] = ["rotate", "rotate:zxzxz", "zhf", "zhf_tailored", "rotate:taylor15", "rotate_small"];

/// What Křivánek et al. have of the expansion for small angles against z-x-z-x-z, by the order.
const FASTER: [(usize, f64); 2] = [(6, 4.0), (10, 6.0)];

/// The nanoseconds of a way at an order.
fn nanoseconds(turns: &[Single], way: &str, order: usize) -> Option<f64> {
    let (family, method) = way.split_once(':').unwrap_or((way, ""));
    // `rotate` is the exact one of the order, whichever way that goes.
    let is_way = |spec: &str| {
        let mut parts = spec.split(':').filter(|part| part.parse::<usize>().is_err());
        let found = [parts.next().unwrap_or_default(), parts.next().unwrap_or_default()];
        found == [family, method] || (way == "rotate" && found == ["rotate", "zyz"])
    };
    turns.iter().find(|turn| turn.order == order && is_way(&turn.spec)).map(|turn| turn.time.nanoseconds)
}

/// The part of the page on time; empty if nothing was timed.
pub fn part(turns: &[Single]) -> String {
    let orders: Vec<usize> =
        (3..=10).filter(|&order| WAYS.iter().all(|way| nanoseconds(turns, way, order).is_some())).collect();
    if orders.is_empty() {
        return String::new();
    }
    let time = |way: &str, order: usize| nanoseconds(turns, way, order).unwrap_or(f64::NAN);
    let ratio = |a: &str, b: &str, order: usize| time(a, order) / time(b, order);
    let rows = orders.iter().map(|&order| {
        let mut row = vec![order.to_string()];
        row.extend(WAYS.iter().map(|way| short(time(way, order))));
        row.extend([
            short(ratio("zhf", "rotate:zxzxz", order)),
            short(ratio("zhf_tailored", "rotate:zxzxz", order)),
            short(ratio("rotate:zxzxz", "rotate:taylor15", order)),
            short(ratio("rotate:zxzxz", "rotate_small", order)),
        ]);
        row
    });
    let faster: Vec<usize> =
        orders.iter().copied().filter(|&order| ratio("zhf", "rotate:zxzxz", order) < 1.0).collect();
    let even = match faster[..] {
        [] => "Here `zhf` takes longer than z-x-z-x-z at every order: there is no such point, since z-x-z-x-z without loops, without \
               trigonometry and with constant matrices takes a few operations a coefficient."
            .to_owned(),
        [.., last] => format!("Here `zhf` is the faster up to order {last}."),
    };
    let claims: Vec<String> = FASTER
        .iter()
        .filter(|(order, _)| orders.contains(order))
        .map(|&(order, claim)| {
            format!(
                "{} times at order {order} (theirs {})",
                short(ratio("rotate:zxzxz", "rotate:taylor15", order)),
                short(claim)
            )
        })
        .collect();
    format!(
        "## Ways to turn\n\nNanoseconds a vector in f32, one at a time, from a quaternion, for `zhf` from a matrix, for \
         `zhf_tailored` from samples, whose reads are not in it, for `rotate:n:taylor15` from two phases and an angle. The last \
         columns say how many times as long.\n\n{}\nNowrouzezahrai et al. (2012, section 7.1) find their standard rotation faster \
         than z-x-z-x-z on a CPU up to order 7, and slower from 8 on. {even}\n\nKřivánek et al. (2005, section 4.2) find their \
         expansion for small angles faster than z-x-z-x-z, the interpolation of a cache around it left out: {}. Both are here \
         straight lines, where theirs are loops; `rotate_small` errs by less.",
        table(
            &[
                "order",
                "`rotate`",
                "zxzxz",
                "`zhf`",
                "`zhf_tailored`",
                "taylor15",
                "`rotate_small`",
                "`zhf` / zxzxz",
                "tailored / zxzxz",
                "zxzxz / taylor15",
                "zxzxz / `rotate_small`",
            ],
            rows,
        ),
        claims.join(", "),
    )
}

/// The part on shading without a rotation, told in operations.
pub fn shading(report: &Report) -> String {
    let rows: Vec<Vec<String>> = report
        .shading
        .forms
        .iter()
        .filter_map(|form| {
            let order = form.order;
            let [_, equation_22] = form.operations.first().copied()?;
            let [_, direct] = form.operations.get(1).copied()?;
            let turned = report.cost("rotate:n:zxzxz", order)?.operations_rgb + 3 * order * order;
            let ratio = |cost: usize| short(turned as f64 / cost as f64);
            Some(vec![
                order.to_string(),
                turned.to_string(),
                equation_22.to_string(),
                ratio(equation_22),
                format!("{} and {} reads", form.tabulated[1], form.reads),
                ratio(form.tabulated[1]),
                direct.to_string(),
                ratio(direct),
            ])
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    format!(
        "## Shading without a rotation\n\nSoler et al. (2015, figure 3) find their shading 30 times faster than the rotation of \
         harmonics by z-x-z-x-z on a GPU, followed by an inner product. Operations of three channels, and how many times fewer \
         than by z-x-z-x-z:\n\n{}\nOf 30 nothing is left by equation 22 as it stands; where the light's bands are read from tables \
         some is, if reads are free; the rotation itself is cheap today, and `shade` does with less of it.",
        table(&["order", "zxzxz, inner product", "equation 22", "times", "tables", "times", "`shade`", "times"], rows,)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timing::Time;

    #[test]
    fn the_claims_are_told_from_the_times() {
        let single = |spec: &str, order: usize, nanoseconds: f64| Single {
            spec: spec.to_owned(),
            order,
            time: Time { nanoseconds, copies: 1.0 },
        };
        let of_order = |order: usize, zhf: f64| {
            let first = if order == 3 { "rotate:3:zyz".to_owned() } else { format!("rotate:{order}") };
            vec![
                single(&first, order, 10.0),
                single(&format!("rotate:{order}:zxzxz"), order, 20.0),
                single(&format!("zhf:{order}"), order, zhf),
                single(&format!("zhf_tailored:{order}"), order, 5.0),
                single(&format!("rotate:{order}:taylor15"), order, 8.0),
                single(&format!("rotate_small:{order}"), order, 4.0),
            ]
        };
        assert_eq!(part(&[]), "");
        let slow = part(&[of_order(3, 30.0), of_order(6, 90.0)].concat());
        assert!(slow.contains("there is no such point") && slow.contains("2.5 times at order 6 (theirs 4)"), "{slow}");
        assert!(slow.contains("| 3 | 10 | 20 | 30 | 5 | 8 | 4 | 1.5 | 0.25 | 2.5 | 5 |"), "{slow}");
        let fast = part(&[of_order(3, 10.0), of_order(6, 90.0)].concat());
        assert!(fast.contains("`zhf` is the faster up to order 3"), "{fast}");
        // What lacks a time is left out.
        assert_eq!(part(&of_order(4, 1.0)[1..]), "");
    }
}
