//! The orders of a product's two factors, where they are not the result's: read from a spec, `2+3`, and what is wrong with
//! them.

use crate::families::family::Spec;

/// Returns the orders of both factors, or what is wrong with the text and what to do.
pub fn read(text: &str) -> Result<[usize; 2], [String; 2]> {
    let orders: Option<Vec<usize>> = text.split('+').map(|text| text.parse().ok()).collect();
    match orders.as_deref() {
        Some(&[a, b]) => Ok([a, b]),
        _ => Err([format!("`{text}` is no pair of orders"), "write both, as in `product:2+3:4`".to_owned()]),
    }
}

/// Returns what is wrong with a spec's factors and what to do, if anything.
pub fn fault(spec: &Spec) -> Option<[String; 2]> {
    let ([a, b], order, name) = (spec.factors?, spec.order, spec.family.name);
    let orders = &spec.family.orders;
    if ![a, b].iter().all(|order| orders.contains(order)) {
        let help = format!("each has an order of {} to {}", orders.start(), orders.end());
        return Some([format!("factors of the orders {a} and {b}"), help]);
    }
    let (few, many, last) = (a.min(b), a.max(b), a + b - 1);
    if few == order && many == order {
        return Some([format!("both factors have the result's order {order}"), format!("write `{name}:{order}`")]);
    }
    if order > last {
        let message = format!("the product of the orders {a} and {b} ends at order {last}");
        return Some([message, format!("write `{name}:{a}+{b}:{last}`")]);
    }
    let most = few + order - 1;
    let help = format!("order {most} of it is all that the result depends on");
    (many > most).then(|| [format!("bands of the factor of order {many} meet nothing"), help])
}
