//! Nothing is lost, nothing escapes: files that zonal did not write, links that lead elsewhere, files without an end.

use std::fs;
use std::path::Path;
use zonal_codegen::builder::Builder;
use zonal_codegen::files::{self, FileError, MARK, Replace};
use zonal_codegen::input;
use zonal_tests::command::{Folder, Run};
use zonal_tests::repository;

/// Runs what must fail with exit code 1, and returns what it says.
fn fails(folder: &Folder, arguments: &[&str]) -> String {
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(1), "{arguments:?}: {out}{err}");
    err
}

fn works(folder: &Folder, arguments: &[&str]) -> String {
    let Run { code, out, err } = folder.run(arguments);
    assert_eq!(code, Some(0), "{arguments:?}: {err}");
    out
}

/// Every file below a folder with its bytes, and links with where they lead.
fn state(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        let kind = path.symlink_metadata().expect("it is there").file_type();
        let name = path.display().to_string();
        if kind.is_symlink() {
            all.push((name, fs::read_link(&path).expect("a link").as_os_str().as_encoded_bytes().to_vec()));
        } else if kind.is_dir() {
            all.push((name, Vec::new()));
            all.extend(state(&path));
        } else {
            all.push((name, fs::read(&path).expect("readable")));
        }
    }
    all.sort();
    all
}

/// Runs what must be refused for a file that is in the way; nothing may change.
fn spares(folder: &Folder, arguments: &[&str], file: &str) {
    let before = state(&folder.path(""));
    let message = fails(folder, arguments);
    for part in [&format!("`{file}` was not written by zonal"), "move it away, write elsewhere", "`--force`"] {
        assert!(message.contains(part), "`{part}` is not in\n{message}");
    }
    assert!(state(&folder.path("")) == before, "{arguments:?} changed something");
}

const ROTATION: &str =
    "name = \"a\"\n[[rotation]]\nkind = \"quaternion\"\norder = 3\nmax_angle = 10\nmax_error = 0.01\n";

#[test]
fn a_file_that_zonal_did_not_write_is_replaced_by_force_alone() {
    let folder = Folder::new();
    fs::create_dir(folder.path("src")).expect("a folder");
    folder.put("src/lib.rs", "// By hand.\n");
    folder.put("s.toml", "name = \"lib\"\noutput = \"src\"\ntargets = [\"rust\"]\n[[kernel]]\nspec = \"eval:3\"\n");
    spares(&folder, &["generate", "s.toml"], "src/lib.rs");
    works(&folder, &["generate", "s.toml", "--force"]);
    let lib = fs::read_to_string(folder.path("src/lib.rs")).expect("written");
    assert!(lib.contains(MARK), "{lib}");
    // What zonal wrote may be replaced, changed or not.
    folder.put("src/lib.rs", lib.replace("pub fn", "pub  fn"));
    assert!(works(&folder, &["generate", "s.toml"]).contains(" 1 were new or changed"));
    assert_eq!(fs::read_to_string(folder.path("src/lib.rs")).expect("written"), lib);
    // A mark far below the head is no mark.
    folder.put("src/lib.rs", format!("{}{MARK}", "// By hand.\n".repeat(100)));
    spares(&folder, &["generate", "s.toml"], "src/lib.rs");
}

#[test]
fn a_build_script_may_force_it() {
    let folder = Folder::new();
    folder.put("a.wgsl", "by hand");
    folder.put("a.md", "by hand");
    let builder = Builder::new("a").spec("eval:3").target(zonal_codegen::emit::language::named("wgsl").expect("known"));
    let error = builder.write(folder.path("")).expect_err("it is in the way").to_string();
    assert!(error.contains("`Builder::force`") && error.contains("nor were 1 others in the way"), "{error}");
    assert_eq!(fs::read_to_string(folder.path("a.md")).expect("is there"), "by hand");
    assert_eq!(builder.clone().force().write(folder.path("")).expect("written"), 2);
    assert_eq!(builder.write(folder.path("")).expect("written"), 0);
}

#[test]
fn files_that_cannot_say_who_wrote_them_belong_to_one_that_can() {
    let folder = Folder::new();
    let write = |bytes: &'static [u8]| {
        let mark = format!("{{\"origin\": \"{MARK}\", \"length\": {}}}", bytes.len());
        files::write_below(&folder.path(""), &[("a.png", bytes), ("a.json", mark.as_bytes())], Replace::Own)
    };
    folder.put("a.png", "a photograph");
    let error = write(b"new").expect_err("it is in the way");
    assert!(matches!(&error, FileError::Foreign { path, others: 0 } if path.ends_with("a.png")), "{error}");
    assert_eq!(folder.names(), ["a.png"]);
    folder.put("a.png", b"new");
    assert_eq!(write(b"new").expect("the bytes are the same"), 1);
    assert_eq!(write(b"newer").expect("its figures say that zonal wrote it"), 2);
    folder.put("a.json", "{}");
    assert!(write(b"newest").is_err(), "neither says so");
}

#[test]
fn plots_pages_and_sets_spare_what_is_there() {
    let folder = Folder::new();
    folder.put("a.toml", ROTATION);
    folder.put("a.svg", "<svg/>");
    spares(&folder, &["plan", "a.toml", "--plot", "a.svg"], "./a.svg");
    works(&folder, &["plan", "a.toml", "--plot", "a.svg", "--force"]);
    works(&folder, &["plan", "a.toml", "--plot", "a.svg"]);
    folder.put("sets.toml", "# My own sets.\nset = []\n");
    let search = |option: &'static str, path: &'static str| {
        ["search-lobes", "--mode", "band", "--size", "3", "--tries", "1", option, path]
    };
    spares(&folder, &search("--out", "sets.toml"), "./sets.toml");
    folder.put("plans.toml", "# My own plans.\nplan = []\n");
    spares(&folder, &["search-products", "square:2", "--out", "plans.toml"], "./plans.toml");
    folder.put("directions.toml", "# My own directions.\nset = []\n");
    let arguments = ["search-directions", "--bands", "2", "--tries", "1", "--out", "directions.toml"];
    spares(&folder, &arguments, "./directions.toml");
    works(&folder, &search("--resume", "state.toml"));
    let state = fs::read_to_string(folder.path("state.toml")).expect("written");
    folder.put("state.toml", state.replace(MARK, "changed by hand"));
    spares(&folder, &search("--resume", "state.toml"), "./state.toml");
    fs::create_dir(folder.path("d")).expect("a folder");
    folder.put("d/index.html", "my page");
    spares(&folder, &["explore", "--no-serve", "--out", "d"], "d/index.html");
    works(&folder, &["explore", "--no-serve", "--out", "d", "--force"]);
    folder.put("d/style.css", "of an older version");
    assert!(works(&folder, &["explore", "--no-serve", "--out", "d"]).contains(" 1 were new or changed"));
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder() {
    use std::os::unix::fs::symlink;
    let (folder, other) = (Folder::new(), Folder::new());
    symlink(other.path(""), folder.path("lnk")).expect("linked");
    symlink("nowhere", folder.path("dangling")).expect("linked");
    fs::create_dir(folder.path("real")).expect("a folder");
    symlink("real", folder.path("inner")).expect("linked");
    let scene = |output: &str| {
        folder.put("s.toml", format!("name = \"a\"\noutput = \"{output}\"\n[[kernel]]\nspec = \"eval:3\"\n"));
    };
    for output in ["lnk", "lnk/x", "real/../lnk/x", "dangling/x"] {
        scene(output);
        for command in ["generate", "plan"] {
            let message = fails(&folder, &[command, "s.toml"]);
            assert!(message.contains("leads out of the folder") && message.contains("s.toml:2:10"), "{message}");
        }
    }
    assert_eq!(other.names(), Vec::<String>::new());
    scene("inner/x");
    works(&folder, &["generate", "s.toml"]);
    assert!(folder.path("real/x/a.wgsl").is_file());
    // What a person names on the command line may lead anywhere.
    scene("real");
    works(&folder, &["generate", "s.toml", "--out", "lnk/y"]);
    assert!(other.path("y/a.wgsl").is_file());
    // A link inside the output folder, on the way to a file.
    symlink(other.path(""), folder.path("real/shaders")).expect("linked");
    let write = |path: &str| files::write_below(&folder.path("real"), &[(path, MARK.as_bytes())], Replace::Any);
    assert!(matches!(write("shaders/a.wgsl"), Err(FileError::Outside(path)) if path == "shaders/a.wgsl"));
    // A file that is a link is replaced, and what it led to stays.
    let target = other.put("target", format!("{MARK}, long ago"));
    symlink(&target, folder.path("real/b.wgsl")).expect("linked");
    assert_eq!(write("b.wgsl").expect("written"), 1);
    assert!(folder.path("real/b.wgsl").symlink_metadata().expect("is there").is_file());
    assert_eq!(fs::read_to_string(&target).expect("is there"), format!("{MARK}, long ago"));
}

#[cfg(unix)]
#[test]
fn what_has_no_end_is_refused() {
    let folder = Folder::new();
    let made = std::process::Command::new("mkfifo").arg(folder.path("fifo")).status();
    assert!(made.expect("mkfifo runs").success());
    for file in ["/dev/zero", "fifo"] {
        folder.put(
            "s.toml",
            format!(
                "name = \"a\"\n[environment]\nmap = \"{file}\"\nsignal = \"radiance\"\nbudget = 0.1\n\
                 [[kernel]]\nspec = \"eval:environment\"\n"
            ),
        );
        for arguments in [
            &["generate", file][..],
            &["generate", "s.toml"],
            &["project", file],
            &["bands", file],
            &["vectors", "eval:3", "--inputs", file],
            &["search-lobes", "--tries", "1", "--out", file],
            &["search-lobes", "--tries", "1", "--resume", file],
            &["search-products", "square:2", "--tries", "1", "--out", file],
            &["search-directions", "--bands", "2", "--tries", "1", "--out", file],
        ] {
            let message = fails(&folder, arguments);
            assert!(message.contains("it is a device or a pipe, not a regular file"), "{arguments:?}: {message}");
        }
    }
    // Nor does a pipe in the place of an output hold up anything, or vanish.
    folder.put("s.toml", "name = \"fifo\"\noutput = \".\"\n[[kernel]]\nspec = \"eval:3\"\n");
    fs::rename(folder.path("fifo"), folder.path("fifo.wgsl")).expect("renamed");
    for force in [&[][..], &["--force"]] {
        let message = fails(&folder, &[&["generate", "s.toml"], force].concat());
        assert!(message.contains("fifo.wgsl") && message.contains("a device or a pipe"), "{message}");
    }
    assert_eq!(folder.names(), ["fifo.wgsl", "s.toml"]);
}

#[test]
fn files_are_read_up_to_a_limit() {
    let folder = Folder::new();
    let path = folder.put("a", [7; 100]);
    assert_eq!(input::read(&path, 100).expect("it is small enough"), [7; 100]);
    let error = input::read(&path, 99).expect_err("it is too large");
    assert_eq!(error.kind(), std::io::ErrorKind::FileTooLarge, "{error}");
    assert_eq!(input::read(&folder.path(""), 9).expect_err("a folder").kind(), std::io::ErrorKind::IsADirectory);
    assert!(input::read_text(&folder.put("b", b"a\xff"), 9).expect_err("no text").to_string().contains("byte 1"));
    // A file that only seems large takes no memory before it is refused.
    fs::File::create(folder.path("huge.hdr")).and_then(|file| file.set_len(1 << 40)).expect("a file with a hole");
    let message = fails(&folder, &["project", "huge.hdr"]);
    assert!(message.contains("huge.hdr: cannot be read (it is larger than 1073741824 bytes"), "{message}");
}

#[cfg(unix)]
#[test]
fn the_standard_input_is_read_and_bounded() {
    use std::process::{Command, Stdio};
    use zonal_tests::command::command;
    let plan = |input: Stdio| {
        let mut command = command();
        command.args(["plan", "/dev/stdin"]).stdin(input).output().expect("runs")
    };
    let scene = fs::File::open(repository("scenes/glossy.toml")).expect("a scene");
    // It names its map relative to itself, which here is beside /dev/stdin.
    assert!(String::from_utf8_lossy(&plan(scene.into()).stderr).contains("/dev/stdin:"));
    let mut echo = Command::new("printf")
        .arg("name = \"a\"\\n[[kernel]]\\nspec = \"eval:3\"\\n")
        .stdout(Stdio::piped())
        .spawn()
        .expect("runs");
    let output = plan(echo.stdout.take().expect("is piped").into());
    assert!(output.status.success() && echo.wait().expect("ends").success(), "{output:?}");
    let zeros = plan(fs::File::open("/dev/zero").expect("a device").into());
    assert!(String::from_utf8_lossy(&zeros.stderr).contains("larger than a scene may be"), "{zeros:?}");
}

#[test]
fn a_full_disk_is_called_so() {
    let error = |kind: std::io::ErrorKind| FileError::Io { what: "write", path: "a".into(), source: kind.into() };
    let full = error(std::io::ErrorKind::StorageFull).to_string();
    assert_eq!(full, "cannot write `a`: the disk is full; make room, then run it again");
    assert!(error(std::io::ErrorKind::PermissionDenied).to_string().contains("check that the folder exists"));
    let folder = Folder::new();
    folder.put("file", "in the way");
    let message = fails(&folder, &["generate", "--out", "file"]);
    assert!(
        message.contains("cannot create `file`: `file` is a file") && message.contains("name a folder"),
        "{message}"
    );
}

/// What `plan` says of a scene.
fn said(scene: &str) -> String {
    let folder = Folder::new();
    folder.put("s.toml", scene);
    fails(&folder, &["plan", "s.toml"])
}

#[test]
fn messages_say_what_there_is() {
    let environment = "name = \"a\"\n[environment]\nmap = \"a.hdr\"\n";
    let zero = said(&ROTATION.replace("0.01", "0"));
    assert!(zero.contains("help: write a number above 0\n") && zero.len() < 400, "{zero}");
    for (scene, part) in [
        (environment.to_owned(), "add it: `radiance` or `irradiance`"),
        (format!("{environment}signal = \"radiance\"\n"), "add it: a share of the whole, from 0 to below 1"),
        ("name = \"a\"\n[brdf]\nexponent = 2\n".to_owned(), "add it: `lambert`, `phong`, `ward`"),
        ("name = \"a\"\n[[rotation]]\norder = 2\n".to_owned(), "add it: `tilt`, `y`, "),
        (ROTATION.replace("order = 3\n", ""), "add it: a number from 2 to 16, or \"environment\""),
        (ROTATION.replace("max_error = 0.01\n", ""), "add it: a number above 0"),
        (ROTATION.replace("name = \"a\"\n", ""), "add it: the stem of the files"),
    ] {
        let message = said(&scene);
        assert!(message.contains(part), "`{part}` is not in\n{message}");
    }
    let folder = Folder::new();
    for (spec, part) in [
        ("evaluate:3", "did you mean `eval`?"),
        ("evl:3", "did you mean `eval`?"),
        ("eval:3:nope", "known are nested, once, rgb, f16, bands=0+1+2"),
        ("rotate:5:nope", "known are zyz, "),
        ("rotate:5:lopo", "did you mean `loop`?"),
    ] {
        let message = fails(&folder, &["show", spec]);
        assert!(message.contains(part), "`{part}` is not in\n{message}");
    }
}

#[test]
fn a_long_line_is_cut_around_the_fault() {
    for quote in ["", "\""] {
        let brackets = said(&format!("name = {quote}{}\n", "[".repeat(100_000)));
        assert!(brackets.len() < 1000, "{} bytes", brackets.len());
    }
    let long = "é".repeat(50_000);
    let message =
        said(&format!("# {long}\nname = \"a\" # {long}\nkernel = [{{ spec = \"eval:3\", nome = \"{long}\" }}]\n"));
    for part in
        ["s.toml:3:30\n", "3 | kernel = [{ spec = \"eval:3\", nome = \"", "é...\n", "^^^^", "unknown field `nome`"]
    {
        assert!(message.contains(part), "`{part}` is not in\n{message}");
    }
    assert!(message.len() < 1000, "{message}");
    // The column is that of the line as it was written.
    let message = said(&format!("name = \"a\"\nkernel = [{{ name = \"{long}\", nome = 1, spec = \"eval:3\" }}]\n"));
    assert!(message.contains(&format!("s.toml:2:{}\n", 20 + 50_000 + 4)), "{message}");
    assert!(message.contains("| ...é") && message.contains("nome = 1, spec") && message.len() < 1000, "{message}");
    let name = said(&format!("name = \"{long}\"\n[[kernel]]\nspec = \"eval:3\"\n"));
    assert!(name.contains("is no identifier") && name.len() < 2000, "{name}");
}

#[test]
fn vectors_tell_nan_from_infinities() {
    let folder = Folder::new();
    let f32_of = |spec: &str, inputs: &str| {
        folder.put("in.json", format!("[{inputs}]"));
        let text = works(&folder, &["vectors", spec, "--inputs", "in.json"]);
        let vectors: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        vectors["cases"][0]["f32"].to_string()
    };
    assert_eq!(f32_of("tilt:2", r#"{"n": [0, 0, -1], "c": [1, 2, 3, 4]}"#), r#"[1.0,"NaN",-3.0,"NaN"]"#);
    for (sign, infinity) in [("", "\"Infinity\""), ("-", "\"-Infinity\"")] {
        assert_eq!(f32_of("eval:2", &format!(r#"{{"dir": [0, 0, 1e20], "c": [0, 0, {sign}3e38, 0]}}"#)), infinity);
    }
    let Run { out, .. } = folder.run(["vectors", "--help"]);
    assert!(out.contains("\"NaN\", \"Infinity\""), "{out}");
}

#[test]
fn a_name_is_refused_where_its_language_is_asked_for() {
    let folder = Folder::new();
    let scene = |targets: &str| {
        let kernel = "[[kernel]]\nspec = \"eval:3\"\nname = \"light0\"\n";
        folder.put("s.toml", format!("name = \"a\"\ntargets = [{targets}]\n{kernel}"));
    };
    scene("\"rust\", \"wgsl\"");
    assert!(fails(&folder, &["generate", "s.toml"]).contains("naga renames such a function in WGSL"));
    scene("\"rust\"");
    works(&folder, &["generate", "s.toml", "--out", "out"]);
    assert!(fs::read_to_string(folder.path("out/a.rs")).expect("written").contains("fn light0"));
}

#[test]
fn no_input_makes_a_reader_panic() {
    for outcome in zonal_tests::fuzz::run(3000, 1) {
        assert!(outcome.panics.is_empty(), "{}: {:?}", outcome.kind, outcome.panics);
        // Changes go deep only where something is still read.
        let is_read = (1..outcome.count).contains(&outcome.accepted);
        assert!(is_read || outcome.kind == "dwa", "{}: {} accepted", outcome.kind, outcome.accepted);
    }
}
