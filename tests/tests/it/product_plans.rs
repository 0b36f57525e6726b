//! What products cost, the plans that are kept, the search that finds them, and how products of unequal orders are named.

use std::collections::BTreeMap;
use zonal_codegen::families::Spec;
use zonal_codegen::families::product::plan::{HIGHEST_ORDER, Task, kept};
use zonal_codegen::families::product::{chosen, search};
use zonal_tests::command::{Folder, Run};
use zonal_tests::{golden, spec};

fn total(text: &str) -> usize {
    let spec = spec(text);
    spec.code().cost(spec.channels()).total
}

/// What the plans that are kept cost, as the most that a product may; docs/MATH.md#the-search-for-plans has the least counts
/// that were known before.
#[test]
fn no_product_costs_more_than_the_best_known() {
    let ledger: [(&str, usize, &[usize]); 4] = [
        ("product", 2, &[13, 90, 307, 751, 1370, 2414, 3670]),
        ("square", 2, &[9, 58, 183, 467, 854, 1476, 2259]),
        ("product_zonal", 3, &[29, 67, 143, 256]),
        ("product_zonal_about", 3, &[96, 223, 429, 722]),
    ];
    for (name, first, most) in ledger {
        let got: Vec<usize> = (first..first + most.len()).map(|order| total(&format!("{name}:{order}"))).collect();
        println!("{name} from order {first}: {got:?}, at most {most:?}");
        assert!(got.iter().zip(most).all(|(got, most)| got <= most), "{name}: {got:?} above {most:?}");
    }
    let single = [
        ("product_zonal:8", 669),
        ("product_zonal_about:8", 1665),
        ("product_zonal_about:3:angles", 83),
        ("product_zonal_about:4:angles", 201),
        ("product_zonal_about:5:angles", 401),
        ("product_zonal_about:6:angles", 686),
        ("product_zonal_about:8:angles", 1615),
        ("product:2+3:3", 44),
        ("product:2+4:4", 102),
        ("product:2+5:5", 174),
        ("product:2+6:6", 276),
        ("product:3+4:4", 224),
        ("product:3+5:5", 419),
        ("product_cosine:3", 19),
        ("product_cosine:4", 42),
        ("product_cosine:5", 77),
        ("product_cosine:6", 126),
        ("product_cosine:8", 274),
        ("product_hemisphere:3", 17),
        ("product_hemisphere:4", 36),
        ("product_hemisphere:5", 65),
        ("product_hemisphere:6", 106),
        ("product_hemisphere:8", 232),
        ("product_cosine_about:3:angles", 73),
        ("product_cosine_about:6:angles", 556),
        ("product_hemisphere_about:3:angles", 71),
        ("product_hemisphere_about:6:angles", 536),
        ("dot:5", 25),
    ];
    for (text, most) in single {
        let got = total(text);
        println!("{text}: {got}, at most {most}");
        assert!(got <= most, "{text}: {got} above {most}");
    }
    for about in ["product_zonal_about:5", "product_cosine_about:5", "product_hemisphere_about:5"] {
        assert_eq!(spec(about).code().cost(1).special, 1, "{about}");
    }
    // Two coloured factors are three products; a grey one is cheaper.
    for order in 2..=6 {
        let [both, one] = ["product", "product_grey"].map(|name| total(&format!("{name}:{order}:rgb")));
        println!("order {order}, three channels: {both} of two coloured factors, {one} of a grey one");
        assert!(both == 3 * total(&format!("product:{order}")) && one < both);
    }
}

#[test]
fn every_kept_plan_costs_what_it_says_and_none_is_kept_twice() {
    let mut tasks: BTreeMap<Task, usize> = BTreeMap::new();
    for record in kept() {
        let plan = record.plan().unwrap_or_else(|error| panic!("{:?}: {error}", record.orders));
        assert_eq!(search::operations(&plan), record.operations, "{:?}", record.orders);
        assert_eq!(tasks.insert(record.task(), record.operations), None, "{:?}", record.orders);
    }
    for order in 2..=HIGHEST_ORDER {
        assert!([Task::product(order), Task::square(order)].iter().all(|task| tasks.contains_key(task)));
    }
    // What is not kept is searched for briefly, and is found again.
    let task = Task { orders: [3, 4, 3], square: false };
    assert_eq!(*chosen::plan(task), search::brief(task));
}

/// The plans that golden/product_plans.json tells of have these counts; a search of some seconds finds as good ones.
#[test]
fn a_search_finds_the_known_counts() {
    let file = golden("product_plans");
    for (order, tries) in [(3, 2), (4, 4)] {
        let known = file["plans"][order.to_string()]["ops"].as_u64().expect("a count") as usize;
        for seed in [1, 2] {
            let record = search::search(Task::product(order), seed, tries, || ());
            println!("order {order}, seed {seed}: {}, {known} in the golden plan", record.operations);
            assert!(record.operations <= known, "order {order}");
            assert_eq!(record, search::search(Task::product(order), seed, tries, || ()), "one seed, one plan");
        }
    }
}

/// The table of docs/MATH.md#counts-of-products.
fn table() -> String {
    let orders = 2..=HIGHEST_ORDER;
    type Text = fn(usize) -> String;
    let rows: [(&str, Text); 10] = [
        ("`product:n`", |n| format!("product:{n}")),
        ("`product:2+n:n`", |n| format!("product:{}{n}", if n == 2 { String::new() } else { format!("2+{n}:") })),
        ("`square:n`", |n| format!("square:{n}")),
        ("`product_grey:n:rgb`, three channels", |n| format!("product_grey:{n}:rgb")),
        ("`product:n:rgb`, three channels", |n| format!("product:{n}:rgb")),
        ("`product_matrix:n`", |n| format!("product_matrix:{n}")),
        ("`product_by_matrix:n`", |n| format!("product_by_matrix:{n}")),
        ("`product_zonal:n`", |n| format!("product_zonal:{n}")),
        ("`product_zonal_about:n`, and one special", |n| format!("product_zonal_about:{n}")),
        ("`product_zonal_about:n:angles`", |n| format!("product_zonal_about:{n}:angles")),
    ];
    let heads: Vec<String> = orders.clone().map(|order| order.to_string()).collect();
    let mut table = format!("| order | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    let cell = |text: String, of: &dyn Fn(Spec) -> usize| {
        text.parse().map_or_else(|_| "-".to_owned(), |spec: Spec| of(spec).to_string())
    };
    let cost = |spec: Spec| spec.code().cost(spec.channels()).total;
    let live = |spec: Spec| spec.code().footprint().live;
    for (name, text) in rows {
        let cells: Vec<String> = orders.clone().map(|order| cell(text(order), &cost)).collect();
        table += &format!("| {name} | {} |\n", cells.join(" | "));
    }
    for name in ["product", "square"] {
        let cells: Vec<String> = orders.clone().map(|order| cell(format!("{name}:{order}"), &live)).collect();
        table += &format!("| live values of `{name}:n` | {} |\n", cells.join(" | "));
    }
    table
}

/// `UPDATE=1 cargo test -p zonal-tests product_plans` writes the table.
#[test]
fn the_table_of_counts_is_what_the_kernels_cost() {
    crate::readme::hold("docs/MATH.md", "product_plans", &[("products", table())]);
}

#[test]
fn the_command_searches_and_keeps_the_cheapest() {
    let folder = Folder::new();
    let arguments =
        ["search-products", "product:2", "square:3", "product:3+2:3", "--tries", "1", "--out", "plans.toml"];
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(0), "{out}{err}");
    assert!(out.contains("| product:2 ") && out.contains("| square:3 ") && out.contains("| product:2+3:3 "), "{out}");
    let text = std::fs::read_to_string(folder.path("plans.toml")).expect("written");
    assert!(
        text.starts_with("# @generated by zonal search-products") && text.matches("[[plan]]").count() == 3,
        "{text}"
    );
    // The same again changes nothing.
    assert_eq!(folder.run(arguments).code, Some(0));
    assert_eq!(text, std::fs::read_to_string(folder.path("plans.toml")).expect("still there"));
    folder.put("other.toml", "name = \"a scene\"\n");
    let twice = "# @generated by zonal\n[[plan]]\norders = [2, 2, 2]\noperations = 13\nseed = 1\ntries = 1\npairs = [\"10 10: 00\"]\n";
    folder.put("twice.toml", twice);
    for (arguments, part) in [
        (["search-products", "dot:3", "--tries", "1"], "is made by no plan"),
        (["search-products", "product:2", "--out", "other.toml"], "holds no plans"),
        (["search-products", "product:2", "--out", "twice.toml"], "is summed 0 times"),
    ] {
        let Run { code, err, .. } = folder.run(arguments);
        assert!(code == Some(1) && err.contains(part), "{arguments:?}: {err}");
    }
}

#[test]
fn specs_of_unequal_orders_are_read_written_and_refused() {
    for (text, name) in [
        ("product:2+3:4", "sh4_of_sh2_and_sh3_product"),
        ("product:3+2:4:rgb", "sh4_of_sh3_and_sh2_product_rgb"),
        ("product:3", "sh3_product"),
        ("square:5:rgb", "sh5_square_rgb"),
        ("product_zonal_about:4:angles", "sh4_product_zonal_about_angles"),
    ] {
        let spec = spec(text);
        assert_eq!((spec.to_string().as_str(), spec.name().as_str()), (text, name));
    }
    for (text, message, help) in [
        ("product:3+3:3", "both factors have the result's order 3", "write `product:3`"),
        ("product:2+2:4", "the product of the orders 2 and 2 ends at order 3", "write `product:2+2:3`"),
        (
            "product:1+3:3",
            "factors of the orders 1 and 3",
            "one of them has an order of 2 to 8, the other no lower one",
        ),
        (
            "product:9+9:3",
            "factors of the orders 9 and 9",
            "one of them has an order of 2 to 8, the other no lower one",
        ),
        (
            "product:2+8:3",
            "bands of the factor of order 8 meet nothing",
            "order 4 of it is all that the result depends on",
        ),
        ("product:2+x:3", "`2+x` is no pair of orders", "write both, as in `product:2+3:4`"),
        ("product:2+3+4:3", "`2+3+4` is no pair of orders", "write both, as in `product:2+3:4`"),
        (
            "product:9",
            "a product of order 9 is too long",
            "products have orders 2 to 8: beyond, multiply on a grid of directions",
        ),
        ("square:2+3:3", "`2+3` is no order", "orders are 2 to 16, in loop form to 64"),
        ("product_matrix:7", "the matrix of order 7 is too long", "matrices of products have orders 2 to 6"),
    ] {
        let error = text.parse::<Spec>().expect_err(text);
        assert_eq!((error.message.as_str(), error.help.as_str()), (message, help));
    }
}
