//! The builder: the same files as the command line, pure until it writes, errors that say where.

use zonal_codegen::builder::{Builder, Error};
use zonal_codegen::emit::language::{ALL, GLSL, RUST, WGSL};
use zonal_codegen::emit::validate::validate;
use zonal_codegen::files::{Difference, File};
use zonal_tests::command::Folder;
use zonal_tests::repository;

fn message(builder: Builder) -> String {
    match builder.generate() {
        Ok(_) => panic!("it should fail"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn specs_become_files() {
    let builder = Builder::new("kernels").spec("eval:3:rgb").spec("eval:3").named("turn", "rotate:3:rgb");
    let files = builder.generate().expect("valid");
    let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths, ["kernels.wgsl", "kernels.glsl", "kernels.rs", "kernels.md"]);
    for (target, file) in ALL.into_iter().zip(&files) {
        validate(target, &file.path, &file.text).expect("valid");
    }
    assert!(files[0].text.contains("fn turn(") && files[0].text.contains("fn sh3_eval_rgb("));
    assert!(files[3].text.contains("| `rotate:3:rgb` | `turn`"), "{}", files[3].text);
    assert_eq!(files, builder.generate().expect("valid"), "twice the same bytes");
    let rust = builder.target(&RUST).generate().expect("valid");
    assert_eq!((rust.len(), &rust[0]), (2, &files[2]));
}

#[test]
fn forms_of_files() {
    let of = |form: &str| Builder::new("light").spec("eval:3").spec("rotate:2").target(&WGSL).form(form);
    let file = |builder: Builder| builder.generate().expect("valid").swap_remove(0);
    let plain = file(Builder::new("light").spec("eval:3").spec("rotate:2").target(&WGSL));
    let oil = file(of("naga_oil"));
    assert_eq!(oil.path, "light.wgsl");
    assert_eq!(oil.text.strip_prefix("#define_import_path zonal::light\n\n"), Some(plain.text.as_str()));
    assert_eq!(file(of("wesl")), File { path: "light.wesl".to_owned(), text: plain.text.clone() });
    let bare = file(of("bare"));
    assert!(bare.text.starts_with("fn ") && !bare.text.contains("//"), "{}", bare.text);
    validate(&WGSL, &bare.path, &bare.text).expect("valid");
    // Nothing in it says that zonal wrote it; the report beside it does.
    let folder = Folder::new();
    let out = folder.path("out");
    assert_eq!(of("bare").write(&out).expect("writable"), 2);
    assert_eq!(of("bare").spec("eval:4").write(&out).expect("writable"), 2);
    let every = Builder::new("light").spec("eval:3").form("wesl").generate().expect("WGSL has it");
    let paths: Vec<&str> = every.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths, ["light.wesl", "light.glsl", "light.rs", "light.md"]);
    let glsl = Builder::new("light").spec("eval:3").target(&GLSL);
    assert_eq!(
        message(glsl.clone().form("naga_oil")),
        "Builder::form:1:1: GLSL has no form `naga_oil`; leave it out, or write `targets = [\"wgsl\"]`"
    );
    assert!(message(glsl.form("naga")).contains("`naga` is no form of a file"));
}

#[test]
fn writing_and_checking() {
    let folder = Folder::new();
    let builder = Builder::scene(repository("scenes/diffuse.toml"));
    let out = folder.path("out");
    assert_eq!(builder.check(&out).expect("valid").len(), 4, "all are missing");
    assert_eq!(builder.write(&out).expect("writable"), 4);
    assert_eq!(builder.write(&out).expect("writable"), 0);
    folder.put("out/other.txt", "not zonal's");
    assert_eq!(builder.check(&out).expect("valid"), []);
    folder.put("out/diffuse.wgsl", "old");
    assert_eq!(builder.check(&out).expect("valid"), [Difference::Stale("diffuse.wgsl".to_owned())]);
    let command = folder.run(["generate", repository("scenes/diffuse.toml").to_str().expect("a path"), "--out", "cli"]);
    assert_eq!(command.code, Some(0), "{}", command.err);
    for file in builder.generate().expect("valid") {
        assert_eq!(std::fs::read_to_string(folder.path("cli").join(&file.path)).expect("a file"), file.text);
    }
}

#[test]
fn errors_say_where() {
    assert_eq!(
        message(Builder::new("a").spec("rotat:5")),
        "Builder::spec:1:1: `rotat` is no family of kernels; did you mean `rotate`?"
    );
    assert!(
        message(Builder::new("a").named("fn", "eval:3")).starts_with("Builder::named:1:1: `fn` is reserved in WGSL")
    );
    assert!(
        message(Builder::new("no name").spec("eval:3")).starts_with("Builder::new:1:1: `no name` is no identifier")
    );
    assert!(message(Builder::new("a")).contains("asks for nothing"));
    assert!(message(Builder::new("a").spec("eval:3").spec("eval:3")).contains("stands twice"));
    assert!(message(Builder::scene("no/such.toml")).starts_with("no/such.toml: cannot be read"));
    assert!(matches!(Builder::new("a").spec("eval:3").write_to_out_dir(), Err(Error::NoOutDir)));
}
