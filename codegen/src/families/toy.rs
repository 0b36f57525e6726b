//! A toy family, for tests alone: a rotation about y by exchanging y and z, turning about z, and exchanging again. This file
//! and its row in `all.rs` are all that it takes to add a family.

use crate::families::family::{Does, Family, Job, Spec};
use crate::families::parts::bands::{constant_band, each_band, z_band};
use crate::families::parts::params::{rotated, signal};
use crate::families::parts::phases::{Phase, multiples};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::tables;

/// `exchanged_y`.
pub static EXCHANGED_Y: Family = Family {
    name: "exchanged_y",
    stem: "exchanged_y",
    what: |spec| format!("Rotates order {} about y by way of z: a toy.", spec.order),
    kernel: |spec| exchanged_y(spec.order),
    does: |_, _| vec![Does::job(Job::Y)],
    shown: |order| Spec::new(&EXCHANGED_Y, order).both(),
    ..Family::PLAIN
};

fn exchanged_y(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Domain::Phases, "(cos β, sin β)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let back = Phase { cos: cs[0], sin: g.neg(cs[1]) };
    let back = multiples(g, back, order - 1);
    let out = each_band(g, &c, order, |g, _, band| {
        let exchanged = constant_band(g, band, tables::swap_yz);
        let turned = z_band(g, &exchanged, &back);
        constant_band(g, &turned, tables::swap_yz)
    });
    rotated(builder, order, out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalog;
    use crate::emit::Module;
    use crate::emit::language;
    use crate::emit::validate::validate;
    use crate::families::text::family_names;
    use crate::generate;
    use crate::ir::eval::Contraction;
    use crate::plan::Plan;
    use crate::promise::samples;
    use crate::scene::{Maps, Scene};

    fn spec(text: &str) -> Spec {
        text.parse().unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn it_is_known_and_listed() {
        assert!(family_names().contains(&"exchanged_y"));
        let listed: Vec<String> = catalog::standard().iter().map(Spec::to_string).collect();
        assert!(listed.contains(&"exchanged_y:7:rgb".to_owned()));
        assert_eq!(spec("exchanged_y:5:rgb").name(), "sh5_exchanged_y_rgb");
        let error = "exchanged_y:17".parse::<Spec>().unwrap_err();
        assert_eq!(error.message, "order 17 is too long unrolled");
        assert_eq!("exchangedy:3".parse::<Spec>().unwrap_err().help, "did you mean `exchanged_y`?");
    }

    #[test]
    fn it_is_documented_proven_and_printed_in_every_language() {
        for text in ["exchanged_y:4", "exchanged_y:4:rgb"] {
            let functions = generate::build(&[spec(text)]);
            let accuracy = &functions[0].built.accuracy;
            assert!(accuracy.proven && accuracy.measured_f32 <= accuracy.rounding_f32, "{accuracy:?}");
            let module = Module { name: "toy".to_owned(), functions, ..Module::default() };
            for target in language::ALL {
                let printed = module.text(target).unwrap();
                assert!(printed.contains("Rotates order 4 about y by way of z: a toy."), "{target}");
                assert!(printed.contains("for every angle (proven for"), "{target}");
                validate(target, "toy", &printed).unwrap();
            }
        }
    }

    #[test]
    fn it_is_sampled_and_runs_on_the_interpreter() {
        let (toy, exact) = (spec("exchanged_y:6").code(), spec("rotate_y:6").code());
        let (toy_runner, exact_runner) = (toy.runner::<f64>(), exact.runner::<f64>());
        for input in samples::inputs(toy.params(), 3, 60, None) {
            let [cos, sin] = input[0][..] else { panic!("a pair has two numbers") };
            assert!((cos * cos + sin * sin - 1.0).abs() < 1e-6);
            let input: Vec<&[f64]> = input.iter().map(Vec::as_slice).collect();
            let [got, want] = [&toy_runner, &exact_runner].map(|runner| runner.run(&input, Contraction::Separate));
            // Pairs that were rounded to f32 are no units, and the two ways take that differently: by some l 2^-24.
            assert!(got.iter().zip(&want).all(|(a, b)| (a - b).abs() < 1e-6), "{got:?} {want:?}");
        }
    }

    #[test]
    fn it_is_planned_for() {
        let text = "name = \"turn\"\n[[rotation]]\nkind = \"y\"\norder = 4\nmax_angle = 20\nmax_error = 1e-4\n";
        let scene = Scene::parse("turn.toml", text, Maps::Embedded(&[])).unwrap();
        let plan = Plan::new(&scene).unwrap();
        let rivals: Vec<&str> = plan.kernels[0].rivals.iter().map(|rival| rival.spec.as_str()).collect();
        assert!(rivals.contains(&"exchanged_y:4") && rivals.contains(&"rotate_y:4"), "{rivals:?}");
    }
}
