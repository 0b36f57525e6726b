//! Kernels in pieces: their set-up and their bands do what the whole does, operation by operation.

use zonal_codegen::catalog::standard;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::language::{GLSL, RUST, WGSL};
use zonal_codegen::families::several::several;
use zonal_codegen::families::{Form, Spec};
use zonal_codegen::generate;
use zonal_codegen::ir::code::Code;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::{Cost, Listing};
use zonal_codegen::promise::samples;
use zonal_tests::spec;

fn listing(spec: &Spec) -> Listing {
    match spec.code() {
        Code::Straight(listing) => listing,
        _ => panic!("{spec} is straight lines"),
    }
}

/// Every kernel of the catalogue that has pieces, once a base, with them.
fn in_pieces() -> Vec<(Spec, Vec<Spec>)> {
    let bases = standard().into_iter().filter(|spec| !spec.rgb && spec.form == Form::Unrolled);
    bases.map(|spec| (spec.clone(), spec.in_pieces())).filter(|(_, pieces)| !pieces.is_empty()).collect()
}

/// Bit for bit, with products fused and not, and for as many operations of each price.
#[test]
fn pieces_together_are_the_whole() {
    let all = in_pieces();
    for name in ["rotate", "tilt", "rotate_small", "zhf", "rotate_matrix", "swap_yz"] {
        assert!(all.iter().any(|(spec, _)| spec.family.name == name || spec.family.stem == name), "{name}");
    }
    println!("{} kernels", all.len());
    for (spec, pieces) in &all {
        let whole = listing(spec);
        let listings: Vec<(Form, Listing)> = pieces.iter().map(|piece| (piece.form, listing(piece))).collect();
        let costs = listings.iter().map(|(_, listing)| listing.cost(1)).fold(Cost::default(), |a, b| a + b);
        assert_eq!(costs, whole.cost(1), "{spec}");
        let program = Program::<f32>::new(&whole);
        let programs: Vec<(Form, Program<f32>)> =
            listings.iter().map(|(form, listing)| (*form, Program::new(listing))).collect();
        for input in samples::inputs(&whole.params, 9, 12, None) {
            let input: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|&x| x as f32).collect()).collect();
            let rows: Vec<&[f32]> = input.iter().map(Vec::as_slice).collect();
            let (c, given) = rows.split_last().expect("a signal is last");
            for contraction in [Contraction::Separate, Contraction::Fused] {
                let want = program.run(&rows, contraction);
                let mut got = c.to_vec();
                let mut shared = vec![];
                for (form, program) in &programs {
                    match *form {
                        Form::SetUp => shared = program.run(given, contraction),
                        Form::Band(l) => {
                            let band = l * l..(l + 1) * (l + 1);
                            let mut taken: Vec<&[f32]> = match shared.is_empty() {
                                // Without a set-up a band takes those of the parameters that it uses.
                                true => rows[..given.len()]
                                    .iter()
                                    .zip(&whole.params)
                                    .filter(|(_, param)| taking(&listings, l).contains(&param.name))
                                    .map(|(row, _)| *row)
                                    .collect(),
                                false => vec![&shared],
                            };
                            taken.push(&c[band.clone()]);
                            got[band].copy_from_slice(&program.run(&taken, contraction));
                        }
                        other => panic!("{other:?} is no piece"),
                    }
                }
                let same = got.iter().zip(&want).all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
                assert!(same, "{spec} {contraction:?}: {got:?} is not {want:?}");
            }
        }
    }
}

/// The parameters of a band.
fn taking(listings: &[(Form, Listing)], l: usize) -> Vec<&'static str> {
    let (_, listing) = listings.iter().find(|(form, _)| *form == Form::Band(l)).expect("it was built");
    listing.params.iter().map(|param| param.name).collect()
}

/// What is given as numbers that several bands take is not copied by a set-up.
#[test]
fn where_nothing_is_made_for_several_bands_there_is_no_set_up() {
    for text in ["rotate:5:lifted", "rotate:5:angles"] {
        let pieces = spec(text).in_pieces();
        assert!(pieces.iter().all(|piece| matches!(piece.form, Form::Band(_))), "{pieces:?}");
        assert!(pieces.iter().all(|piece| piece.code().params()[0].name == "cs"), "{text} takes pairs");
    }
    // One band takes a quaternion as a set-up hands it on.
    for text in ["rotate:5", "rotate:2"] {
        assert_eq!(spec(text).in_pieces()[0].form, Form::SetUp);
    }
}

/// What lives at once besides the set-up's numbers is a band, not all of them.
#[test]
fn less_lives_at_once() {
    for text in ["rotate:5", "rotate:8", "tilt:8"] {
        let spec = spec(text);
        let whole = listing(&spec).footprint().live;
        let band = |piece: &Spec| listing(piece).footprint().live;
        let bands = spec.in_pieces().iter().filter(|piece| piece.form != Form::SetUp).map(band).max().unwrap_or(0);
        println!("{text}: {whole} live values, in pieces {bands} besides {}", shared(&spec));
        assert!(2 * bands < whole, "{text}: {bands} of {whole}");
    }
}

fn shared(spec: &Spec) -> usize {
    listing(&Spec { form: Form::SetUp, ..spec.clone() }).outputs.len()
}

#[test]
fn every_language_prints_them() {
    for text in [
        "rotate:5:pieces",
        "rotate:8:rgb:pieces",
        "rotate:4:angles:pieces:f16",
        "tilt:6:lf5:pieces",
        "swap_yz:4:pieces",
    ] {
        let specs = several(text).expect("it has pieces");
        let module = Module {
            name: "in_pieces".to_owned(),
            origin: format!("`{text}`"),
            functions: generate::build(&specs),
            ..Module::default()
        };
        for target in [&WGSL, &GLSL, &RUST] {
            if specs.iter().any(|spec| spec.half) && target != &WGSL {
                continue;
            }
            let file = generate::file(&module, target, "").unwrap_or_else(|error| panic!("{text}: {error}"));
            for spec in &specs {
                // Rust's functions are generic over the channels.
                let spec = if target == &RUST { spec.base() } else { spec.clone() };
                assert!(file.text.contains(&format!("`{spec}`")), "{spec} in {target}");
            }
        }
    }
}

#[test]
fn specs_are_read_and_refused() {
    for text in ["rotate:5:setup", "rotate:5:rgb:band=3", "rotate:5:zxzxz:band=2", "tilt:6:lf5:band=5"] {
        assert_eq!(spec(text).to_string(), text);
    }
    assert_eq!(spec("rotate:8:rgb:band=3").name(), "sh8_band_3_rotate_rgb");
    assert_eq!(spec("rotate:8:setup").name(), "sh8_rotate_setup");
    let names: Vec<String> =
        several("rotate:4:rgb:pieces").expect("it has pieces").iter().map(Spec::to_string).collect();
    assert_eq!(names, ["rotate:4:setup", "rotate:4:rgb:band=1", "rotate:4:rgb:band=2", "rotate:4:rgb:band=3"]);
    for (text, message) in [
        ("rotate:5:band=0", "band 0 is no piece of `rotate:5`"),
        ("rotate:5:band=5", "band 5 is no piece of `rotate:5`"),
        ("rotate:5:band=x", "`band=x` is no method of `rotate`"),
        ("rotate:5:rgb:setup", "the set-up has no signal that could be RGB"),
        ("swap_yz:5:setup", "it needs no set-up"),
        ("eval:5:band=1", "`eval:5` has no pieces"),
        ("product:3:setup", "`product:3` has no pieces"),
    ] {
        let error = text.parse::<Spec>().expect_err(text);
        assert!(error.message.contains(message), "{text}: {}", error.message);
    }
    for text in ["eval:5:pieces", "rotate:5:loop:pieces"] {
        let error = several(text).expect_err(text);
        assert!(error.message.contains("has no pieces") && &text[error.at] == "pieces", "{text}: {}", error.message);
    }
    let error = several("rotate:5:pieces:rgbb").expect_err("no option");
    assert_eq!((&"rotate:5:pieces:rgbb"[error.at]), "rgbb");
}
