//! The explorer in a real browser: `tests/browser/explorer.mjs` works it as a person would, in WebGL2 and WebGPU; here
//! stands what must be true of what it saw. `UPDATE=1` renews the picture in the documentation.

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Command;
use zonal_codegen::catalog::ORDERS;
use zonal_codegen::emit::language::WGSL;
use zonal_codegen::families::Spec;
use zonal_codegen::generate::build;
use zonal_gpu_tests::cases::{Cases, tolerance};
use zonal_gpu_tests::system::{compile, missing};
use zonal_picture::method::{Judged, Method};
use zonal_picture::shade::Shading;
use zonal_tests::command::{Folder, command};
use zonal_tests::repository;

/// The first inputs hold the extremes, and after eight blocks of 64 every kind of signal was there.
const ROWS: usize = 512;
const APIS: [&str; 2] = ["webgl2", "webgpu"];

/// The kernels that the page's shaders call.
fn specs() -> Vec<Spec> {
    let of = |order: usize| Method::ALL.map(|method| Shading { order, method, isotropic: true });
    let specs: BTreeSet<Spec> = ORDERS.flat_map(of).flat_map(|shading| shading.specs()).collect();
    specs.into_iter().collect()
}

/// Looks a number up that must be there.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("{value} is no list"))
}

#[test]
fn the_explorer_shows_what_the_kernels_do() {
    let _turn = crate::turn();
    let (page, work) = (Folder::new(), Folder::new());
    let written = command().args(["explore", "--no-serve", "--out"]).arg(page.path("")).output();
    let written = written.expect("the command starts");
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));

    // WGSL passed naga when it was written; GLSL has no other judge than this and the browser.
    let files =
        std::fs::read_dir(page.path("shaders")).expect("the page has shaders").flatten().map(|entry| entry.path());
    let is_glsl = |path: &PathBuf| path.extension().is_some_and(|kind| kind == "frag" || kind == "vert");
    let glsl: Vec<PathBuf> = files.filter(is_glsl).collect();
    assert!(glsl.len() > 2 * Method::ALL.len() * ORDERS.count(), "only {} shaders", glsl.len());
    compile("glslangValidator", "glslang-tools", &[], &glsl).unwrap_or_else(|error| panic!("{error}"));

    let functions = build(&specs());
    let cases: Vec<(&_, Cases)> = functions.iter().map(|function| (function, Cases::new(function))).collect();
    let mut checks = Vec::new();
    for (function, cases) in &cases {
        let job = cases.job(function, &WGSL, "");
        let (rows, name) = (job.count.min(ROWS), function.shader_name());
        let inputs = &job.inputs[..rows * (job.inputs.len() / job.count)];
        std::fs::write(work.path(&format!("{name}.in")), bytemuck::cast_slice(inputs)).expect("written");
        checks.push(json!({"name": name, "count": rows}));
    }
    work.put("checks.json", Value::from(checks).to_string());
    let index: Value =
        serde_json::from_slice(&std::fs::read(page.path("data/index.json")).expect("the page has an index"))
            .expect("the index is JSON");
    let known: BTreeSet<&str> = list(&index["checks"]).iter().filter_map(|check| check["spec"].as_str()).collect();
    let wanted: Vec<String> = functions.iter().map(|function| function.spec.to_string()).collect();
    assert_eq!(
        known,
        wanted.iter().map(String::as_str).collect(),
        "the page knows other kernels than its shaders call"
    );

    let update = std::env::var_os("UPDATE").is_some();
    let mut node = Command::new("node");
    node.arg(repository("tests/browser/explorer.mjs")).arg(page.path("")).arg(work.path(""));
    if update {
        node.env("SCREENSHOT", "1");
    }
    let output = node.output().unwrap_or_else(|_| panic!("{}", missing("Node", "nodejs npm")));
    assert!(output.status.success(), "the browser's script fails:\n{}", String::from_utf8_lossy(&output.stderr));
    let facts: Value = serde_json::from_slice(&output.stdout).expect("the script prints JSON");

    for (function, cases) in &cases {
        for api in APIS {
            let name = function.shader_name();
            let bytes = std::fs::read(work.path(&format!("{name}.{api}"))).expect("the page gave results");
            let got: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
            // Rows come without what fills the last vector up; the cases expect it.
            let len = function.built.code.result().0.len();
            let rows: Vec<f32> = got
                .chunks(len)
                .flat_map(|row| row.iter().copied().chain(std::iter::repeat(0.0)).take(len.next_multiple_of(4)))
                .collect();
            assert_eq!(got.len() / len, ROWS, "{name}: {api} gave {} numbers", got.len());
            let (error, tolerance) = (cases.error(&rows), tolerance(function));
            assert!(error <= tolerance, "{name}: {api} is off by {error:e}, more than {tolerance:e}");
        }
    }
    println!("{} kernels agree on {ROWS} inputs in WebGL2 and WebGPU", cases.len());

    quiet(&facts);
    pictures(&facts);
    methods(&facts["controls"]);
    controls(&facts["controls"]);
    accessible(&facts);
    fallbacks(&facts);
    if update {
        std::fs::copy(work.path("explorer.png"), repository("docs/explorer.png")).expect("copied");
    }
}

/// No console errors on any page but where nothing can draw, and nothing from elsewhere.
fn quiet(facts: &Value) {
    for errors in list(&facts["errors"]) {
        assert_eq!(list(errors).len(), 0, "the console says {errors}");
    }
    assert_eq!(list(&facts["foreign"]).len(), 0, "{}", facts["foreign"]);
}

/// Both interfaces draw, they draw the same, and it is something.
fn pictures(facts: &Value) {
    for api in APIS {
        let (first, message) = (&facts["apis"][api]["first"], &facts["apis"][api]["message"]);
        assert_eq!(first["api"], api, "{message}");
        assert_eq!(message, "", "{api}");
        assert!(number(&first["pixels"]) > 2000.0, "{api} shows the object on {} pixels", first["pixels"]);
        for figure in ["chosen", "exact"] {
            assert!(number(&first["milliseconds"][figure]) > 0.0, "{api}: {}", first["milliseconds"]);
        }
    }
    // The compilers of the two round differently, and at an edge of the object a sample falls to either side: less than
    // one of 256 steps on the mean, and more than eight on less than one pixel of a hundred.
    for (panel, apart) in ["chosen", "exact", "difference"].iter().zip(list(&facts["agree"])) {
        assert!(number(&apart["mean"]) < 1.0 && number(&apart["share"]) < 0.01, "{panel}: {apart}");
    }
    let [gl, gpu] = APIS.map(|api| number(&facts["apis"][api]["first"]["mean"]));
    assert!((gl / gpu - 1.0).abs() < 0.05, "WebGL2 measures a mean error of {gl}, WebGPU of {gpu}");
    for panel in ["chosen", "exact"] {
        let spread = &facts["controls"]["blank"][panel];
        let (mean, deviation) = (number(&spread["mean"]), number(&spread["deviation"]));
        assert!((20.0..235.0).contains(&mean) && deviation > 20.0, "the {panel} picture is blank: {spread}");
    }
    for switched in list(&facts["switched"]) {
        assert!(number(&switched["moved"]) < 1.0, "the other interface draws another picture: {switched}");
    }
    let apis: Vec<&str> = list(&facts["switched"]).iter().filter_map(|switched| switched["api"].as_str()).collect();
    assert_eq!(apis, APIS);
}

/// What each method's picture and figures must show.
fn methods(seen: &Value) {
    let order = number(&seen["first"]["order"]) as usize;
    for method in Method::ALL {
        let figures = &seen["methods"][method.name()];
        assert_eq!(figures["method"], method.name());
        assert_eq!(number(&figures["operations"]) as usize, method.cost(order).total, "{method}");
        let (mean, worst) = (number(&figures["mean"]), number(&figures["worst"]));
        let (estimate, bound) = (number(&figures["predicted"]["mean"]), number(&figures["predicted"]["worst"]));
        assert!(worst >= mean && worst <= bound, "{method}: a worst error of {worst} over the bound {bound}");
        // The estimate takes errors and light for independent, and one level of the normal map for what is seen: on
        // several scenes it was 2 to 6 times too high, more on a picture as small as this.
        let ratio = mean / estimate;
        assert!(method == Method::Exact || (0.05..1.5).contains(&ratio), "{method}: {mean} against {estimate}");
    }
    let mean = |method: Method| number(&seen["methods"][method.name()]["mean"]);
    assert_eq!(number(&seen["methods"]["exact"]["worst"]), 0.0, "exact minus exact is not zero");
    // The first false colour is #000004.
    assert!(number(&seen["black"]) <= 4.0, "exact minus exact is not black but {}", seen["black"]);
    assert!(number(&seen["colourful"]["deviation"]) > 20.0, "the false colours are blank: {}", seen["colourful"]);
    // The claim of Křivánek et al. 2005, on this picture: turning approximately beats not turning, the more the better
    // the method.
    assert!(mean(Method::None) > 4.0 * mean(Method::Taylor15), "{} {}", mean(Method::None), mean(Method::Taylor15));
    assert!(mean(Method::Taylor15) > 2.0 * mean(Method::Tilt), "{} {}", mean(Method::Taylor15), mean(Method::Tilt));
    assert!(mean(Method::Taylor15) > 2.0 * mean(Method::Lf3));
    assert!(mean(Method::None) > 20.0 * mean(Method::Tilt));
    let table = list(&seen["table"]);
    assert_eq!(table.len(), Method::ALL.len());
    for row in table {
        assert!(list(row).iter().all(|cell| cell != "–" && cell != ""), "the table has a gap: {row}");
    }
}

/// Every control does what it says.
fn controls(seen: &Value) {
    for (id, values) in seen["selects"].as_object().expect("the selects") {
        assert!(!list(values).is_empty(), "{id} has one choice only");
        for value in list(values) {
            // Dents are shallow; everything else changes more.
            assert!(number(&value["moved"]) > 0.2, "{id}: {value} changes nothing");
            assert!(number(&value["worst"]) <= number(&value["bound"]) + 1e-5, "{id}: {value} breaks the bound");
        }
    }
    let figures = |name: &str, which: &str| &seen[name][which]["figures"];
    // Without relief a tilt turns by nothing; what is left is rounding.
    assert_eq!(number(&figures("strength", "least")["strength"]), 0.0);
    assert!(number(&figures("strength", "least")["worst"]) < 1e-5, "{}", figures("strength", "least"));
    assert!(number(&figures("strength", "most")["mean"]) > 5.0 * number(&seen["first"]["mean"]));
    assert!(number(&seen["exposure"]["End"]) > number(&seen["exposure"]["Home"]) + 50.0, "{}", seen["exposure"]);
    assert!(number(&seen["back"]["mean"]) < 0.01, "the first choices do not bring the first picture back");
    for (key, order) in [("least", *ORDERS.start()), ("most", *ORDERS.end()), ("step", *ORDERS.end() - 1)] {
        let figures = figures("orders", key);
        assert_eq!(number(&figures["order"]) as usize, order);
        assert_eq!(number(&figures["operations"]) as usize, Method::Tilt.cost(order).total);
    }

    let (first, stage) = (&seen["first"], &seen["stage"]);
    let change = |key: &str, before: &Value, what: &str| number(&stage[key][what]) - number(&before[what]);
    assert_eq!(change("ArrowLeft", first, "azimuth"), 5.0);
    assert_eq!(change("ArrowRight", &stage["ArrowLeft"], "azimuth"), -5.0);
    assert_eq!(change("ArrowUp", &stage["ArrowRight"], "elevation"), 5.0);
    assert_eq!(change("ArrowDown", &stage["ArrowUp"], "elevation"), -5.0);
    assert!(change("+", &stage["ArrowDown"], "pixels") > 0.0 && change("-", &stage["+"], "pixels") < 0.0, "{stage}");
    for (key, seen) in stage.as_object().expect("the keys") {
        assert!(number(&seen["moved"]) > 0.5, "{key} moves nothing");
    }
    let dragged = &seen["drag"]["figures"];
    assert!(number(&dragged["azimuth"]) < number(&first["azimuth"]) - 10.0, "a drag does not turn: {dragged}");
    assert!(number(&dragged["elevation"]) > number(&first["elevation"]) + 5.0, "a drag does not tilt: {dragged}");
    assert!(number(&seen["wheel"]["figures"]["distance"]) > number(&dragged["distance"]), "the wheel does not zoom");
    assert!(number(&seen["home"]["mean"]) < 0.01, "the first view does not come back: {}", seen["home"]);
    assert!(
        number(&seen["rotated"]) > number(&first["azimuth"]) + 1.0,
        "it does not turn by itself: {}",
        seen["rotated"]
    );
    assert_eq!(seen["row"], "none", "a row of the table does not choose its method");
    assert_eq!(seen["typed"], "3", "an order in the address is not taken");
    assert_eq!(seen["recalled"], "none", "the address {} is not recalled", seen["address"]);
    let source = seen["source"].as_str().unwrap_or_default();
    assert!(source.contains("@generated by zonal") && source.contains("method none"), "{source}");
}

/// Names, focus rings, the keyboard, the live region, a narrow screen and a finger.
fn accessible(facts: &Value) {
    let seen = &facts["controls"];
    for fault in ["unlabelled", "ringless", "unreached"] {
        assert_eq!(list(&seen[fault]).len(), 0, "{fault}: {}", seen[fault]);
    }
    let status = seen["status"].as_str().unwrap_or_default();
    assert!(status.contains("None") && status.contains("mean error") && status.contains('%'), "{status}");
    let phone = &facts["phone"];
    assert_eq!(number(&phone["overflow"]), 0.0, "a narrow screen scrolls sideways");
    assert_eq!(list(&phone["small"]).len(), 0, "too small for a finger: {}", phone["small"]);
    assert!(number(&phone["turned"]) < -5.0, "a finger does not turn it: {}", phone["turned"]);
}

/// Without WebGPU, or without either, the page says so.
fn fallbacks(facts: &Value) {
    let fallback = &facts["fallback"];
    assert_eq!((&fallback["api"], &fallback["select"]), (&json!("webgl2"), &json!("webgl2")));
    let message = fallback["message"].as_str().unwrap_or_default();
    assert!(message.contains("no WebGPU") && message.contains("WebGL2 instead"), "{message}");
    assert_eq!(facts["nothing"]["state"], "failed");
    let message = facts["nothing"]["message"].as_str().unwrap_or_default();
    assert!(message.contains("WebGL2 is not to be had") && message.contains("Nothing can be drawn"), "{message}");
}
