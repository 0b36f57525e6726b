//! Crates of users, outside the workspace: with one order, no glam and no `std`; with an older glam and mint; and what
//! rustc tells whoever asks for what is not there.

use crate::fixture::USERS;
use std::fs;
use std::process::{Command, Output};
use zonal_tests::command::Folder;
use zonal_tests::repository;

/// A crate in a folder of its own, whose packages are those of the workspace, so that nothing is fetched.
struct User(Folder);

impl User {
    /// The crate of some dependencies; `zonal` says the features of zonal, without those that are on by default.
    fn new(name: &str, zonal: &[&str], others: &str, source: &str) -> Self {
        let folder = Folder::new();
        let path = repository("runtime").canonicalize().expect("it is there");
        let manifest = format!(
            "[package]\nname = \"zonal-{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n[dependencies]\n\
             zonal = {{ path = {path:?}, default-features = false, features = {zonal:?} }}\n{others}\n[workspace]\n"
        );
        folder.put("Cargo.toml", manifest);
        fs::copy(repository("Cargo.lock"), folder.path("Cargo.lock")).expect("the lock file is copied");
        fs::create_dir_all(folder.path("src/bin")).expect("a folder");
        folder.put("src/lib.rs", source);
        Self(folder)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO"));
        command.args(arguments).args(["--offline", "--quiet"]).current_dir(self.0.path(""));
        command.env("CARGO_TARGET_DIR", USERS).output().expect("cargo runs")
    }

    /// What cargo prints if it is content.
    fn cargo(&self, arguments: &[&str]) -> String {
        let run = self.run(arguments);
        assert!(run.status.success(), "{arguments:?}:\n{}", String::from_utf8_lossy(&run.stderr));
        String::from_utf8_lossy(&run.stdout).into_owned()
    }

    /// What rustc says of a program that it refuses.
    fn refused(&self, source: &str) -> String {
        self.0.put("src/bin/refused.rs", source);
        let run = self.run(&["check", "--bin", "refused"]);
        assert!(!run.status.success(), "it compiles: {source}");
        String::from_utf8_lossy(&run.stderr).into_owned()
    }

    /// The packages that the crate stands on, without itself.
    fn packages(&self) -> Vec<String> {
        let tree = self.cargo(&["tree", "--prefix=none", "--edges=normal"]);
        let names = tree.lines().skip(1).filter_map(|line| line.split(' ').next()).map(str::to_owned);
        let mut names: Vec<String> = names.collect();
        names.sort();
        names.dedup();
        names
    }
}

const BARE: &str = r#"
#![no_std]
#![deny(warnings)]
//! One order and nothing else.

use zonal::{Coefficients, Error};

/// Is generic over the order, and is called with the one that there is.
pub fn mixed<C: Coefficients<Element = [f32; 3], Scalar = f32>>(a: &C, b: &[[f32; 3]], t: f32) -> Result<C, Error> {
    Ok(zonal::lerp(a, &C::from_slice(b)?, t))
}

/// Looks up what a probe gives to a normal, in the frame of an object that is turned by a quaternion.
pub fn seen(q: [f32; 4], normal: [f32; 3], radiance: &[[f32; 3]; 9]) -> [f32; 3] {
    zonal::evaluate(normal, &zonal::rotate(q, &zonal::irradiance(radiance)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_works() {
        let radiance: [[f32; 3]; 9] = zonal::project::function(3, |dir: [f32; 3]| [1.0, 1.0 + dir[2], dir[0]]);
        let same = crate::mixed(&radiance, &radiance, 0.3).unwrap();
        let [r, g, b] = crate::seen([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0], &same);
        let pi = core::f32::consts::PI;
        assert!((r - pi).abs() < 1e-5 && (g - pi / 3.0).abs() < 1e-5 && b.abs() < 1e-5, "{r} {g} {b}");
        assert!(crate::mixed(&radiance, &radiance[1..], 0.3).is_err());
        let unity = zonal::to_convention(&radiance, &zonal::conventions::UNITY).unwrap();
        assert!((unity[0][0] - 1.0 / pi).abs() < 1e-6, "{unity:?}");
    }
}
"#;

#[test]
fn one_order_without_glam_and_std_compiles_nothing_else() {
    let user = User::new("bare", &["libm", "order3"], "", BARE);
    assert_eq!(user.packages(), ["libm", "zonal", "zonal-kernels"]);
    user.cargo(&["test"]);
    let with_std = User::new("bare", &["std", "order3"], "", BARE);
    assert_eq!(with_std.packages(), ["zonal", "zonal-kernels"]);
}

const OLDER: &str = r#"
#![deny(warnings)]
//! A glam that is not the newest, and mint.

use glam::{Quat, Vec3, Vec3A};

/// Vectors of that glam as directions, quaternions and coefficients.
pub fn seen(q: Quat, normal: Vec3A, radiance: &[Vec3; 4]) -> Vec3 {
    zonal::evaluate(normal, &zonal::rotate(q, radiance))
}

/// And those of mint.
pub fn of_mint(q: mint::Quaternion<f32>, radiance: &[mint::Vector3<f32>; 4]) -> [mint::Vector3<f32>; 4] {
    zonal::rotate(q, radiance)
}

#[test]
fn it_works() {
    let lobe: [f32; 4] = zonal::evaluate_basis(Vec3::Z);
    let q = Quat::from_rotation_x(0.5);
    let value = seen(q, (q * Vec3::Z).into(), &lobe.map(Vec3::splat));
    assert!((value - zonal::evaluate(Vec3::Z, &lobe)).abs().max_element() < 1e-6);
    let [x, y, z, w] = q.to_array();
    let turned = of_mint([x, y, z, w].into(), &lobe.map(|c| [c; 3].into()));
    assert_eq!(turned.map(|c| c.x), zonal::rotate(q, &lobe));
}
"#;

#[test]
fn another_glam_and_mint_are_taken() {
    let others = "glam = \"0.30\"\nmint = \"0.5\"\n";
    let user = User::new("older", &["std", "order2", "glam030", "mint"], others, OLDER);
    user.cargo(&["test"]);
    let tree = user.cargo(&["tree", "--prefix=none", "--edges=normal"]);
    assert!(tree.contains("glam v0.30.") && !tree.contains("glam v0.34."), "{tree}");
}

#[test]
fn what_is_not_there_is_said_with_what_to_do() {
    let user = User::new("asking", &["std", "order2", "order3"], "glam = \"0.30\"\n", "//! Nothing.\n");
    for (source, words) in [
        (
            "fn main() { let _ = zonal::scale(&[0.5_f32; 16], 2.0); }",
            &[
                "`[f32; 16]` is no array of coefficients of an order that zonal was compiled with",
                "`order2` to `order10`",
            ][..],
        ),
        (
            "fn main() { let c = vec![0.5_f32; 9]; let _ = zonal::scale(&c[..], 2.0); }",
            &["`[f32]` is no array of coefficients", "a slice becomes an array by `Coefficients::from_slice`"],
        ),
        (
            "fn main() { let _ = zonal::scale(&[glam::Vec3::ONE; 9], 2.0); }",
            &["is no coefficient that zonal knows", "the feature of zonal that names glam's version"],
        ),
        (
            "fn main() { let _ = zonal::rotate_zonal([0.0, 0.0, 1.0], &[0.5_f32; 7]); }",
            &["`[f32; 7]` is no zonal signal of an order that zonal was compiled with"],
        ),
        (
            "fn main() { let q = [0.0, 0.0, 0.0, 1.0]; \
             let _ = zonal::Rotation::<[f32; 9]>::new(q).apply(&[[0.5_f32; 3]; 4]); }",
            &["<[[f32; 3]; 4] as Coefficients>::Angles == Angles<3, ", "expected `3`, found `2`"],
        ),
        (
            "fn main() { let _ = zonal::sh4::basis::<f32>; }",
            &["could not find `sh4` in `zonal`", "gated behind the `order4` feature"],
        ),
    ] {
        let said = user.refused(source);
        assert!(words.iter().all(|words| said.contains(words)), "{source}\n{said}");
    }
}
