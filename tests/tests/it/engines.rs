//! `docs/ENGINES.md` is what the table of conventions says: this test compares them, and writes the page with
//! `UPDATE=1 cargo test -p zonal-tests engines`.

use crate::readme::hold;
use zonal_codegen::math::convention::{ALL, Convention, Holds};
use zonal_codegen::plan::text::table;

fn rows<const N: usize>(head: [&str; N], row: impl Fn(&Convention) -> [String; N]) -> String {
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(ALL.iter().map(|convention| row(convention).to_vec()));
    table(&rows)
}

fn conventions() -> String {
    let head = ["`convention`, `axes`", "coefficients", "for a kernel of zonal", "back", "frame"];
    rows(head, |convention| {
        let [there, back] = convention.axes.swizzles("n").map(|text| format!("`{text}`"));
        let own = if convention.has_own_basis() { "zonal's own".to_owned() } else { convention.differences() };
        let hand = if convention.axes.is_left_handed() { "left-handed" } else { "right-handed" };
        let frame = format!("{hand}, {}", convention.frame());
        [format!("`{}`", convention.name), own, there, back, frame]
    })
}

fn engines() -> String {
    rows(["`convention`", "of", "holds", "bands", "there", "source"], |convention| {
        let holds = match convention.holds {
            Holds::Any => "any signal",
            Holds::Irradiance => "irradiance",
        };
        [
            format!("`{}`", convention.name),
            convention.title.to_owned(),
            holds.to_owned(),
            format!("up to {}", convention.max_order),
            convention.there.to_owned(),
            convention.source.to_owned(),
        ]
    })
}

#[test]
fn the_page_for_engines_is_what_the_table_of_conventions_says() {
    hold("docs/ENGINES.md", "engines", &[("conventions", conventions()), ("engines", engines())]);
}
