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
    assert!(works(&folder, &["generate", "s.toml"]).contains("1 of them changed"));
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
    folder.put("sets.toml", "# my own sets\n");
    let search = ["search-lobes", "--mode", "band", "--size", "3", "--tries", "1"];
    for option in ["--out", "--resume"] {
        if option == "--resume" {
            folder.put("sets.toml", "search = []\n");
        }
        let message = fails(&folder, &[&search[..], &[option, "sets.toml"]].concat());
        assert!(message.contains("sets.toml"), "{message}");
    }
    spares(&folder, &[&search[..], &["--out", "a.toml"]].concat(), "./a.toml");
    fs::create_dir(folder.path("d")).expect("a folder");
    folder.put("d/index.html", "my page");
    spares(&folder, &["explore", "--no-serve", "--out", "d"], "d/index.html");
    works(&folder, &["explore", "--no-serve", "--out", "d", "--force"]);
    folder.put("d/style.css", "of an older version");
    assert!(works(&folder, &["explore", "--no-serve", "--out", "d"]).contains(" 1 of them changed"));
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
            &["vectors", "eval:3", "--inputs", file],
            &["search-lobes", "--tries", "1", "--out", file],
            &["search-lobes", "--tries", "1", "--resume", file],
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
    use zonal_tests::command::zonal;
    let plan = |input: Stdio| {
        let mut command = Command::new(zonal());
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
