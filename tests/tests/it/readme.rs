//! The README's figures come from the kernels and its quoted output from the command: this test compares them, and
//! writes them with `UPDATE=1 cargo test -p zonal-tests readme`.

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

/// What the first command prints, but for the time it took and what was there before.
fn generated() -> String {
    let folder = std::env::temp_dir().join(format!("zonal-readme-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let output = command().arg("generate").current_dir(&folder).output().expect("the command starts");
    std::fs::remove_dir_all(&folder).expect("removable");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.trim_end().lines().map(|line| match line.split_once(", in ") {
        Some((before, after)) => {
            let rest = after.split_once(" s.").map_or("", |(_, rest)| rest);
            format!("{before}.{rest}")
        }
        None => line.to_owned(),
    });
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
    hold("README.md", "readme", &[("generate", generated()), ("costs", costs())]);
}
