//! The README's figures come from the kernels and its quoted output from the command: this test compares them, and
//! writes them with `UPDATE=1 cargo test -p zonal-tests readme`.

use serde_json::Value;
use zonal_codegen::families::Spec;
use zonal_codegen::generate::build;
use zonal_tests::command::command;
use zonal_tests::{repository, spec};

/// The README's table of costs.
fn costs() -> String {
    let orders = 3..=10;
    type Text = fn(usize) -> String;
    let rows: [(&str, Text); 9] = [
        ("`rotate:n` from a quaternion", |n| format!("rotate:{n}")),
        ("`rotate:n:angles`, multiples given", |n| format!("rotate:{n}:angles")),
        ("`rotate:n:lifted`, shears given", |n| format!("rotate:{n}:lifted")),
        ("`rotate:n:zxzxz`, the papers' way", |n| format!("rotate:{n}:zxzxz")),
        ("`tilt:n`", |n| format!("tilt:{n}")),
        ("`lf3:n`", |n| format!("lf3:{n}")),
        ("`taylor15:n`", |n| format!("taylor15:{n}")),
        ("`basis:n`", |n| format!("basis:{n}")),
        ("`eval:n:rgb`", |n| format!("eval:{n}:rgb")),
    ];
    let heads: Vec<String> = orders.clone().map(|order| order.to_string()).collect();
    let mut table = format!("| order | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    for (name, text) in rows {
        let specs: Vec<Spec> = orders.clone().map(|order| spec(&text(order))).collect();
        let totals: Vec<String> =
            build(&specs).iter().map(|f| f.built.code.cost(f.spec.channels()).total.to_string()).collect();
        table += &format!("| {name} | {} |\n", totals.join(" | "));
    }
    table
}

/// What an approximation saves, in words, from the plans that `cargo measure` made.
fn answer() -> String {
    let path = repository("docs/measure/measure.json");
    let text = std::fs::read_to_string(&path).expect("there are measurements");
    let measured: Value = serde_json::from_str(&text).expect("they are JSON");
    let operations = |turn: &str, order: usize, degrees: f64, budget: f64| {
        let plans = measured["plans"].as_array().expect("plans").iter();
        let mut found = plans.filter(|plan| {
            plan["turn"] == turn && plan["order"] == order && plan["degrees"] == degrees && plan["budget"] == budget
        });
        let plan = found.next().unwrap_or_else(|| panic!("no plan of {turn} {order} {degrees} {budget}"));
        plan["choice"]["operations"].as_u64().expect("a count")
    };
    // The plan of the smallest budget at the largest angle is exact, from a quaternion.
    let exact = |order: usize| operations("quaternion", order, 45.0, 1e-4);
    let saved = |turn: &str, order: usize, degrees: f64, budget: f64| {
        100 - (100 * operations(turn, order, degrees, budget) + exact(order) / 2) / exact(order)
    };
    let none = |turn: &str, degrees: f64, budget: f64| {
        (3..=10).rev().take_while(|&order| saved(turn, order, degrees, budget) == 0).last()
    };
    let exactly = match none("quaternion", 15.0, 0.01) {
        Some(3) => "at no order from 3 to 10 is anything cheaper that keeps 1 % at 15 degrees".to_owned(),
        Some(order) => format!("from order {order} on nothing is cheaper that keeps 1 % at 15 degrees"),
        None => format!("what keeps 1 % at 15 degrees saves {} % at order 10", saved("quaternion", 10, 15.0, 0.01)),
    };
    let beyond = match none("tilt", 15.0, 0.01) {
        Some(order) => format!("; from order {order} on nothing keeps that and is cheaper"),
        None => String::new(),
    };
    let text = format!(
        "Rotate exactly: {exactly}, and within 5 degrees the cheapest saves {} % of the operations at order 5, {} % at order \
         10. Where z goes to a normal, `tilt` pays, since it needs nothing but the normal: for 1 % within 5 degrees it saves \
         {} % at order 5 and {} % at order 10, within 15 degrees {} % at order 5{beyond}. Say the angle and the error, in a \
         scene's `[[rotation]]`, and zonal takes the cheapest kernel that keeps it, a method for each band; \
         [docs/measure/fronts.md](docs/measure/fronts.md) has all of them.\n",
        saved("quaternion", 5, 5.0, 0.01),
        saved("quaternion", 10, 5.0, 0.01),
        saved("tilt", 5, 5.0, 0.01),
        saved("tilt", 10, 5.0, 0.01),
        saved("tilt", 5, 15.0, 0.01),
    );
    let lines = textwrap(&text).into_iter().map(|line| line.trim_start().to_owned() + "\n");
    lines.collect()
}

/// What the first command prints, but for the time it took and what was there before.
fn generated() -> String {
    let folder = std::env::temp_dir().join(format!("zonal-readme-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let output = command().arg("generate").current_dir(&folder).output().expect("the command starts");
    std::fs::remove_dir_all(&folder).expect("removable");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    // How many seconds it took is left out, and nothing else.
    let timeless = |line: &str| {
        let (before, after) = line.split_once(", in ")?;
        let (seconds, rest) = after.split_once(" s.")?;
        seconds.parse::<f64>().ok().map(|_| format!("{before}.{rest}"))
    };
    let lines = text.trim_end().lines().map(|line| timeless(line).unwrap_or_else(|| line.to_owned()));
    let wrapped: Vec<String> = lines.flat_map(|line| textwrap(&line)).collect();
    format!("```text\n{}\n```\n", wrapped.join("\n"))
}

/// Lines of at most 110 columns, those after the first indented as the first.
fn textwrap(line: &str) -> Vec<String> {
    let indent = line.len() - line.trim_start().len();
    let mut lines = vec![" ".repeat(indent)];
    for word in line.split_whitespace() {
        let last = lines.last_mut().expect("starts with one");
        if last.trim().is_empty() {
            last.push_str(word);
        } else if last.chars().count() + 1 + word.chars().count() > 110 {
            lines.push(format!("{}{word}", " ".repeat(indent + 2)));
        } else {
            last.push(' ');
            last.push_str(word);
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// Returns a text with another content of the block between `<!-- name -->` and `<!-- /name -->`.
fn with_block(text: &str, name: &str, block: &str) -> String {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let start = text.find(&open).expect("the block is opened") + open.len();
    let end = text.find(&close).expect("the block is closed");
    format!("{}{block}{}", &text[..start], &text[end..])
}

/// Holds the blocks of a page to what they should be; `UPDATE=1 cargo test -p zonal-tests FILTER` writes them.
pub fn hold(page: &str, filter: &str, blocks: &[(&str, String)]) {
    let path = repository(page);
    let read = || std::fs::read_to_string(&path).expect("there is a page");
    let want = blocks.iter().fold(read(), |text, (name, block)| with_block(&text, name, block));
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &want).expect("writable");
    }
    assert!(read() == want, "{page} is stale; run `UPDATE=1 cargo test -p zonal-tests {filter}`");
}

#[test]
fn the_readme_is_what_the_kernels_and_the_command_say() {
    hold("README.md", "readme", &[("generate", generated()), ("answer", answer()), ("costs", costs())]);
}
