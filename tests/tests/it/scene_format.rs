//! The format of scenes: its schema is that of the types that read scenes, the page that documents it is printed from the
//! schema, every scene of this repository keeps it by a validator that knows nothing of zonal, and so does what
//! `zonal init` writes.

use crate::readme::hold;
use boon::{Compiler, Schemas};
use serde_json::{Map, Value};
use std::path::PathBuf;
use zonal_codegen::scene::schema;
use zonal_codegen::scene::{Maps, Scene};
use zonal_tests::command::{command, printed};
use zonal_tests::repository;

/// What a keyword of the schema says of a value, in words.
fn range(of: &Map<String, Value>) -> String {
    let said =
        [("exclusiveMinimum", "above"), ("minimum", "from"), ("exclusiveMaximum", "below"), ("maximum", "up to")];
    let words = said.iter().filter_map(|(key, word)| of.get(*key).map(|limit| format!("{word} {limit}")));
    words.map(|words| format!(" {words}")).collect()
}

/// The schema that a reference leads to, or the schema itself.
fn followed<'a>(root: &'a Value, of: &'a Value) -> &'a Value {
    match of["$ref"].as_str() {
        Some(path) => root.pointer(path.trim_start_matches('#')).expect("a reference leads to a definition"),
        None => of,
    }
}

/// What a value may be, in words; the words that an enumeration knows are told with what they mean.
fn values(root: &Value, of: &Value) -> String {
    let of = followed(root, of);
    let words = |list: &Value| -> Vec<String> {
        list.as_array().expect("a list").iter().map(|word| format!("`{word}`")).collect()
    };
    if let Some(of) = of.get("anyOf").or(of.get("oneOf")) {
        let all = of.as_array().expect("a list").iter();
        let said: Vec<String> = all
            .filter(|one| one["type"] != "null")
            .map(|one| match one["description"].as_str() {
                Some(meaning) if one.get("const").is_some() => format!("`{}`: {meaning}", one["const"]),
                _ => values(root, one),
            })
            .collect();
        return said.join(if said.iter().any(|one| one.starts_with('`') && one.contains("`: ")) {
            "<br>"
        } else {
            ", or "
        });
    }
    if let Some(list) = of.get("enum") {
        let words = words(list).into_iter().filter(|word| word != "`null`").collect::<Vec<_>>();
        return words.join(", ");
    }
    if let Some(constant) = of.get("const") {
        return format!("`{constant}`");
    }
    let name = match &of["type"] {
        Value::Array(types) => types[0].as_str().expect("a type"),
        other => other.as_str().unwrap_or_else(|| panic!("a type: {of}")),
    };
    let object = of.as_object().expect("a schema");
    match name {
        "string" => "text".to_owned(),
        "boolean" => "`true` or `false`".to_owned(),
        "number" => format!("a number{}", range(object)),
        "integer" => format!("a whole number{}", range(object)),
        "array" => match of["minItems"].as_u64() {
            Some(count) => format!("{count} of these: {}", values(root, &of["items"])),
            None => format!("a list of these: {}", values(root, &of["items"])),
        },
        other => panic!("the page knows no {other}"),
    }
}

/// One table of the format: its keys, whether they must be there, what they may be and what they mean.
fn keys(root: &Value, of: &Value, tables: &[&str]) -> String {
    let must: Vec<&str> = of["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let mut text = "| key | must | value | meaning |\n|---|---|---|---|\n".to_owned();
    for (key, of) in of["properties"].as_object().expect("keys") {
        if tables.contains(&key.as_str()) {
            continue;
        }
        let must = if must.contains(&key.as_str()) { "yes" } else { "" };
        let meaning = of["description"].as_str().unwrap_or_else(|| panic!("`{key}` says nothing")).replace('\n', " ");
        text += &format!("| `{key}` | {must} | {} | {meaning} |\n", values(root, of));
    }
    text
}

/// The reference as Markdown: the keys at the top, then a heading a table.
fn reference(root: &Value) -> String {
    const TABLES: [&str; 6] = ["environment", "kernel", "rotation", "brdf", "light", "picture"];
    let mut text = format!("## At the top\n\n{}", keys(root, root, &TABLES));
    for table in TABLES {
        let of = &root["properties"][table];
        let (heading, body) = match of["items"].is_object() {
            true => (format!("`[[{table}]]`, as often as wanted"), followed(root, &of["items"])),
            false => {
                let one = of["anyOf"].as_array().and_then(|any| any.first()).unwrap_or(of);
                (format!("`[{table}]`"), followed(root, one))
            }
        };
        let meaning = of["description"].as_str().expect("a table says what it is").replace('\n', " ");
        text += &format!("\n## {heading}\n\n{meaning}\n\n{}", keys(root, body, &[]));
    }
    text
}

fn written() -> Value {
    serde_json::from_str(zonal_templates::SCENE_SCHEMA).expect("the schema is JSON")
}

#[test]
fn the_schema_is_that_of_the_types() {
    let path = repository("templates/scene.schema.json");
    let want = serde_json::to_string_pretty(&schema()).expect("a schema is JSON") + "\n";
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &want).expect("writable");
    }
    let is = std::fs::read_to_string(&path).expect("there is a schema");
    assert!(is == want, "templates/scene.schema.json is stale; run `UPDATE=1 cargo test -p zonal-tests scene_format`");
    assert_eq!(printed(command().arg("schema")), zonal_templates::SCENE_SCHEMA);
}

#[test]
fn the_page_of_the_format_is_printed_from_the_schema() {
    let root = serde_json::to_value(schema()).expect("a schema is JSON");
    hold("docs/SCENE.md", "scene_format", &[("format", reference(&root))]);
}

/// Whether a validator takes a text of TOML.
fn keeps(text: &str) -> Result<(), String> {
    let instance: Value = toml::from_str(text).expect("the text is TOML");
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource("scene.json", written()).expect("the schema is a schema");
    let index = compiler.compile("scene.json", &mut schemas).expect("the schema compiles");
    schemas.validate(&instance, index).map_err(|error| error.to_string())
}

/// The scene that `zonal init` writes, with every optional line in use.
fn initial(all: bool) -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("init_{all}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("writable");
    printed(command().arg("init").arg(folder.join("lobby.toml")));
    let text = std::fs::read_to_string(folder.join("lobby.toml")).expect("it was written");
    std::fs::write(folder.join("mine.toml"), "name = \"mine\"\n").expect("writable");
    let again = command().arg("init").arg(folder.join("mine.toml")).output().expect("it starts");
    assert_eq!(again.status.code(), Some(1), "what zonal did not write is not replaced unasked");
    assert_eq!(std::fs::read_to_string(folder.join("mine.toml")).expect("is there"), "name = \"mine\"\n");
    let used = |line: &str| match line.strip_prefix('#').filter(|rest| all && !rest.starts_with([' ', ':'])) {
        Some(line) => format!("{line}\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(used).collect()
}

#[test]
fn init_writes_a_scene_that_holds_every_key_and_is_planned() {
    let (few, all) = (initial(false), initial(true));
    for text in [&few, &all] {
        keeps(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        Scene::parse("lobby.toml", text, Maps::Folder(PathBuf::new()))
            .unwrap_or_else(|error| panic!("{error}\n{text}"));
    }
    let scene = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("init_false/lobby.toml");
    let plan = printed(command().arg("plan").arg(scene));
    assert!(plan.contains("eval:3:rgb") && plan.contains("rotate:3:rgb"), "{plan}");
    // Every key of the schema is a key of the text.
    let got: Value = toml::from_str(&all).expect("TOML");
    let root = written();
    let mut missing = Vec::new();
    for (key, of) in root["properties"].as_object().expect("keys") {
        let (there, inner) = match of["items"].get("$ref").is_some() {
            true => (&got[key][0], followed(&root, &of["items"])),
            false => (&got[key], followed(&root, of["anyOf"].as_array().and_then(|any| any.first()).unwrap_or(of))),
        };
        if there.is_null() {
            missing.push(key.clone());
        }
        for inner in inner["properties"].as_object().into_iter().flatten().map(|(inner, _)| inner) {
            // A kind of reflectance has one of the three.
            if there[inner].is_null() && !["exponent", "file"].contains(&inner.as_str()) {
                missing.push(format!("{key}.{inner}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn scenes_keep_the_schema_and_what_is_no_scene_does_not() {
    let scenes = std::fs::read_dir(repository("scenes")).expect("there are scenes");
    let mut count = 0;
    for path in scenes.map(|entry| entry.expect("readable").path()) {
        if path.extension().is_some_and(|extension| extension == "toml") && !path.ends_with("Cargo.toml") {
            let text = std::fs::read_to_string(&path).expect("a text");
            keeps(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            count += 1;
        }
    }
    assert!(count >= 3, "{count}");
    // What the reader refuses by its types and ranges, the schema refuses.
    let rotation = "[[rotation]]\nkind = \"tilt\"\norder = 3\nmax_angle = 15\nmax_error = 0.1\n";
    let scene = |text: &str| format!("name = \"a\"\n{text}");
    assert_eq!(keeps(&scene(rotation)), Ok(()));
    for bad in [
        scene("colour = 1"),
        scene("targets = [\"hlsl\"]"),
        scene("arrays = \"vec3\""),
        scene("[environment]\nmap = \"a.hdr\"\nsignal = \"light\"\nbudget = 0.1"),
        scene("[environment]\nmap = \"a.hdr\"\nsignal = \"radiance\"\nbudget = 1.0"),
        scene("[environment]\nmap = \"a.hdr\"\nsignal = \"radiance\"\nbudget = 0.1\nconvention = \"x\""),
        scene(&rotation.replace("order = 3", "order = 17")),
        scene(&rotation.replace("order = 3", "order = \"all\"")),
        scene(&rotation.replace("max_angle = 15", "max_angle = 0")),
        scene(&rotation.replace("max_error = 0.1", "")),
        scene("[brdf]\nkind = \"phong\"\nexponent = 1001"),
        scene("[picture]\nmesh = \"sphere\"\nfield = 121"),
        "targets = [\"rust\"]".to_owned(),
    ] {
        assert!(keeps(&bad).is_err(), "{bad}");
        assert!(Scene::parse("bad.toml", &bad, Maps::Folder(PathBuf::new())).is_err(), "{bad}");
    }
}
