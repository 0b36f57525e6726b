//! The orders of a product's two factors, or of what is converted and of the result, where they are not all the result's:
//! read from a spec, `2+3`, and what is wrong with them.

use crate::families::family::{MAX_LOOP_ORDER, Spec};

/// Returns both orders, or what is wrong with the text and what to do, with an example.
pub fn read(text: &str, example: &str) -> Result<[usize; 2], [String; 2]> {
    let orders: Option<Vec<usize>> = text.split('+').map(|text| text.parse().ok()).collect();
    match orders.as_deref() {
        // What is beyond any order is no order.
        Some(&[a, b]) if a.max(b) <= MAX_LOOP_ORDER => Ok([a, b]),
        _ => Err([format!("`{text}` is no pair of orders"), format!("write both, as in `{example}`")]),
    }
}

/// Returns what is wrong with a spec's factors and what to do, if anything.
pub fn fault(spec: &Spec) -> Option<[String; 2]> {
    if let Some(orders) = &spec.family.converts {
        let [from, _] = spec.factor_orders();
        return (!orders.contains(&from)).then(|| {
            let help = format!("it converts orders {} to {}", orders.start(), orders.end());
            [format!("`{}` of order {from}", spec.family.name), help]
        });
    }
    let ([a, b], order, name) = (spec.factors?, spec.order, spec.family.name);
    let orders = &spec.family.orders;
    let (few, many, last) = (a.min(b), a.max(b), (a + b).saturating_sub(1));
    // How many bands the other one may have is said below: what the result depends on.
    if !orders.contains(&few) {
        let help =
            format!("one of them has an order of {} to {}, the other no lower one", orders.start(), orders.end());
        return Some([format!("factors of the orders {a} and {b}"), help]);
    }
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
