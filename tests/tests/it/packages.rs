//! What would be published, as a user gets it: every package is packed by cargo, unpacked elsewhere, looked at, and built
//! from there by a crate that uses the kernels and the generator, and as the command.

use crate::fixture::USERS;
use serde_json::Value;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use zonal_tests::command::{Folder, metadata, printed};
use zonal_tests::repository;

/// What crates.io takes at most.
const LARGEST: u64 = 10 << 20;

/// What lies in a package besides its sources, and what cargo adds.
const BELONGS: [&str; 11] = [
    ".cargo_vcs_info.json",
    "Cargo.lock",
    "Cargo.toml",
    "Cargo.toml.orig",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "benches",
    "build.rs",
    "examples",
    "src",
];

/// What else lies in some of them.
const BESIDE: [(&str, &[&str]); 4] = [
    ("zonal-codegen", &["data"]),
    ("zonal-kernels", &["COSTS.md", "MANIFEST.tsv", "glsl", "rust", "wgsl"]),
    ("zonal-scenes", &["diffuse.toml", "glossy.toml", "lights.toml", "maps", "meshes", "normals", "teapot.toml"]),
    (
        "zonal-templates",
        &[
            "bands",
            "explorer",
            "glsl.tera",
            "picture",
            "real.rs.tera",
            "rust.tera",
            "scene.schema.json",
            "scene.toml.tera",
            "wgsl.tera",
        ],
    ),
];

/// The categories of crates.io that are used; it refuses names that it does not know.
const CATEGORIES: [&str; 7] = [
    "command-line-utilities",
    "development-tools::build-utils",
    "graphics",
    "mathematics",
    "no-std",
    "rendering",
    "visualization",
];

/// A package that may be published.
#[derive(Debug)]
struct Package {
    name: String,
    version: String,
    manifest: Value,
}

impl Package {
    /// The folder that it is unpacked to.
    fn folder(&self) -> String {
        format!("{}-{}", self.name, self.version)
    }
}

fn cargo(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(folder);
    command
}

/// The packages of the workspace that are not barred from being published.
fn publishable() -> Vec<Package> {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("a list of packages");
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    packages
        .iter()
        .filter(|package| package["publish"].is_null())
        .map(|package| Package {
            name: text(&package["name"]),
            version: text(&package["version"]),
            manifest: package.clone(),
        })
        .collect()
}

/// Packs all of them and unpacks them into a folder.
fn pack(packages: &[Package], into: &Folder) {
    let target = concat!(env!("CARGO_TARGET_TMPDIR"), "/packages");
    let names = packages.iter().flat_map(|package| ["--package", &package.name]);
    let options = ["package", "--quiet", "--offline", "--allow-dirty", "--no-verify", "--target-dir", target];
    printed(cargo(&repository("")).args(options).args(names));
    for package in packages {
        let file = PathBuf::from(target).join("package").join(format!("{}.crate", package.folder()));
        let size = fs::metadata(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).len();
        println!("{}: {size} bytes", package.name);
        assert!(size < LARGEST, "{} has {size} bytes, and {LARGEST} is the most", package.name);
        printed(Command::new("tar").arg("-xzf").arg(&file).arg("-C").arg(into.path("")));
    }
}

/// The files below a folder, by their paths from it.
fn files(folder: &Path) -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.expect("an entry can be read").path();
            let is_link = path.symlink_metadata().expect("it is there").is_symlink();
            assert!(!is_link, "{} is a symbolic link, which not every system unpacks", path.display());
            if path.is_dir() { walk(&path, found) } else { found.push(path) }
        }
    }
    let mut found = Vec::new();
    walk(folder, &mut found);
    found.iter().map(|path| path.strip_prefix(folder).expect("lies below").to_owned()).collect()
}

/// What a person finds on crates.io, and what may lie in a package.
fn look_at(package: &Package, folder: &Path) {
    let (name, manifest) = (&package.name, &package.manifest);
    let list = |key: &str| -> Vec<&str> {
        manifest[key].as_array().expect("a list").iter().map(|item| item.as_str().expect("a text")).collect()
    };
    assert!(manifest["description"].as_str().is_some_and(|text| text.len() > 20), "{name} has no description");
    assert_eq!(manifest["license"], "MIT OR Apache-2.0", "{name}");
    let keywords = list("keywords");
    assert!((1..=5).contains(&keywords.len()), "{name}: {keywords:?}");
    assert!(keywords.iter().all(|word| word.len() <= 20), "{name}: {keywords:?}");
    let categories = list("categories");
    assert!((1..=5).contains(&categories.len()), "{name}: {categories:?}");
    assert!(categories.iter().all(|category| CATEGORIES.contains(category)), "{name}: {categories:?}");
    for file in ["LICENSE-APACHE", "LICENSE-MIT", "README.md"] {
        let text = fs::read_to_string(folder.join(file)).unwrap_or_else(|error| panic!("{name} lacks {file}: {error}"));
        assert!(text.len() > 200, "{name}: {file} is nearly empty");
    }
    let beside = BESIDE.iter().find(|(package, _)| package == name).map_or(&[][..], |(_, beside)| beside);
    for file in files(folder) {
        let first = file.iter().next().expect("a path has parts").to_string_lossy();
        let belongs = BELONGS.iter().chain(beside).any(|known| *known == first);
        assert!(belongs, "{} does not belong into {name}", file.display());
    }
    let packed = fs::read_to_string(folder.join("Cargo.toml")).expect("cargo wrote it");
    let inside: Vec<&str> = packed.lines().filter(|line| line.starts_with("path = \"..")).collect();
    assert_eq!(inside, Vec::<&str>::new(), "{name} depends on what is not in it");
}

/// A folder outside the workspace that stays, so that what is built from it is built once.
fn elsewhere() -> PathBuf {
    let mut hasher = DefaultHasher::new();
    repository("").canonicalize().expect("it is there").hash(&mut hasher);
    std::env::temp_dir().join(format!("zonal-packages-{:016x}", hasher.finish()))
}

/// Makes a folder hold what another one does. What is the same is left alone, since packages have old times and cargo
/// would not see a change by them.
fn mirror(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("it can be created");
    let wanted = files(from);
    for old in files(to).into_iter().filter(|old| !wanted.contains(old)) {
        fs::remove_file(to.join(old)).expect("it can be removed");
    }
    for file in wanted {
        let (content, path) = (fs::read(from.join(&file)).expect("it can be read"), to.join(&file));
        put(&path, &content);
    }
}

/// Writes a file unless it is as it should be.
fn put(path: &Path, content: &[u8]) {
    if fs::read(path).is_ok_and(|old| old == content) {
        return;
    }
    fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("it can be created");
    fs::write(path, content).expect("it can be written");
}

const BUILD: &str = r#"
fn main() -> Result<(), zonal_codegen::builder::Error> {
    zonal_codegen::builder::Builder::new("kernels").spec("eval:3:rgb").named("turn", "rotate:3").write_to_out_dir()
}
"#;

const LIB: &str = r#"
#![deny(warnings)]

mod kernels {
    include!(concat!(env!("OUT_DIR"), "/kernels.rs"));
}

/// What the build script's rotation makes of it, less what the crate's makes.
pub fn difference(q: [f32; 4], c: &[f32; 9]) -> [f32; 9] {
    let [own, other] = [kernels::sh3::turn(q, c), zonal::sh3::rotate(q, c)];
    std::array::from_fn(|i| own[i] - other[i])
}

/// The shaders that came with both.
pub fn shaders() -> [&'static str; 2] {
    [include_str!(concat!(env!("OUT_DIR"), "/kernels.wgsl")), zonal::shaders::sh3::ROTATION.wgsl]
}

#[test]
fn both_are_the_same() {
    let c = [0.5, 1.0, -2.0, 3.0, 0.25, -0.75, 1.5, 2.5, -1.0];
    assert_eq!(difference([0.5, -0.5, 0.5, 0.5], &c), [0.0; 9]);
    assert!(shaders().iter().all(|text| text.contains("fn ")));
}
"#;

/// A workspace of the unpacked packages, of which nothing comes from elsewhere, and of a crate that uses them.
fn users(packages: &[Package], folder: &Path) {
    let members: Vec<String> = packages.iter().map(|package| format!("\"{}\"", package.folder())).collect();
    let patches: String =
        packages.iter().map(|package| format!("{} = {{ path = \"{}\" }}\n", package.name, package.folder())).collect();
    let root = format!(
        "[workspace]\nmembers = [\"user\", {}]\nresolver = \"3\"\n\n[patch.crates-io]\n{patches}",
        members.join(", ")
    );
    let of = |name: &str| &packages.iter().find(|package| package.name == name).expect("is published").version;
    let user = format!(
        "[package]\nname = \"user\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n[dependencies]\n\
         zonal = {{ version = \"{}\", features = [\"shaders\"] }}\n\n[build-dependencies]\nzonal-codegen = \"{}\"\n",
        of("zonal"),
        of("zonal-codegen")
    );
    put(&folder.join("Cargo.toml"), root.as_bytes());
    put(&folder.join("user/Cargo.toml"), user.as_bytes());
    put(&folder.join("user/build.rs"), BUILD.as_bytes());
    put(&folder.join("user/src/lib.rs"), LIB.as_bytes());
    // The versions of other packages are those of the workspace, so that nothing is fetched.
    fs::copy(repository("Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file is copied");
}

#[test]
fn what_is_published_is_whole_and_builds_elsewhere() {
    let packages = publishable();
    let names: Vec<&str> = packages.iter().map(|package| package.name.as_str()).collect();
    for name in ["zonal", "zonal-cli", "zonal-codegen", "zonal-kernels", "zonal-scenes", "zonal-templates"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let (unpacked, folder) = (Folder::new(), elsewhere());
    pack(&packages, &unpacked);
    for package in &packages {
        let from = unpacked.path(&package.folder());
        look_at(package, &from);
        mirror(&from, &folder.join(package.folder()));
    }
    users(&packages, &folder);
    let build = |arguments: &[&str]| printed(cargo(&folder).args(arguments).env("CARGO_TARGET_DIR", USERS));
    let report = build(&["test", "--quiet", "--offline", "--package", "user"]);
    assert!(report.contains("1 passed"), "{report}");
    build(&["check", "--quiet", "--offline", "--package", "zonal-cli"]);
}
