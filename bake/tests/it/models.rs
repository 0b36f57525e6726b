//! Meshes with two sets of texture coordinates, as OBJ and as glTF: what is read is what was written.

use base64::Engine;
use std::path::Path;
use zonal_bake::gltf;
use zonal_bake::quads::{Lie, Quad, model};
use zonal_codegen::fault::Fault;
use zonal_picture::mesh::Model;
use zonal_picture::vector::{add, cross, dot, length};

fn written() -> Model {
    let mut quads = Quad::sides([-0.5, -0.4, -0.3], [1.0, 0.8, 0.6], false);
    quads[2].is_mirrored = true;
    quads[3].is_mirrored = true;
    model(&quads, 3.0, 64, |i| Lie { quarters: i, is_mirrored: i == 4 }).expect("room")
}

/// What a glTF file holds: a name and the numbers of a vertex each.
struct Attribute {
    name: &'static str,
    kind: &'static str,
    numbers: Vec<f32>,
}

fn attribute<const N: usize>(name: &'static str, list: &[[f32; N]]) -> Attribute {
    Attribute { name, kind: ["", "", "VEC2", "VEC3", "VEC4"][N], numbers: list.as_flattened().to_vec() }
}

/// The attributes of a model in a file, y up, the second coordinates running down.
fn attributes(model: &Model) -> Vec<Attribute> {
    let back = |list: &[[f32; 3]]| -> Vec<[f32; 3]> { list.iter().map(|&[x, y, z]| [x, z, -y]).collect() };
    let down = |list: &[[f32; 2]]| -> Vec<[f32; 2]> { list.iter().map(|&[u, v]| [u, 1.0 - v]).collect() };
    let tangents: Vec<[f32; 4]> = model.mesh.tangents.iter().map(|&[x, y, z, w]| [x, z, -y, w]).collect();
    vec![
        attribute("POSITION", &model.places),
        attribute("NORMAL", &back(&model.mesh.normals)),
        attribute("TANGENT", &tangents),
        attribute("TEXCOORD_0", &down(&model.mesh.uvs)),
        attribute("TEXCOORD_1", &down(&model.lightmap)),
    ]
}

/// The text of a file with one node, whose lines are given, and the buffer in it.
fn text(attributes: &[Attribute], indices: &[u32], node: &str) -> String {
    let mut bytes = Vec::new();
    let (mut views, mut accessors, mut names) = (Vec::new(), Vec::new(), Vec::new());
    let view = |bytes: &mut Vec<u8>, added: Vec<u8>| {
        let text = format!("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", bytes.len(), added.len());
        bytes.extend(added);
        text
    };
    for (i, Attribute { name, kind, numbers }) in attributes.iter().enumerate() {
        views.push(view(&mut bytes, numbers.iter().flat_map(|x| x.to_le_bytes()).collect()));
        let width: usize = kind[3..].parse().expect("a vector");
        let bounds = match *name {
            "POSITION" => ",\"min\":[-9,-9,-9],\"max\":[9,9,9]",
            _ => "",
        };
        accessors.push(format!(
            "{{\"bufferView\":{i},\"componentType\":5126,\"count\":{},\"type\":\"{kind}\"{bounds}}}",
            numbers.len() / width
        ));
        names.push(format!("\"{name}\":{i}"));
    }
    let last = attributes.len();
    views.push(view(&mut bytes, indices.iter().flat_map(|i| i.to_le_bytes()).collect()));
    accessors.push(format!(
        "{{\"bufferView\":{last},\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}",
        indices.len()
    ));
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0{node}}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{{}}},\"indices\":{last}}}]}}],\
         \"accessors\":[{}],\"bufferViews\":[{}],\
         \"buffers\":[{{\"byteLength\":{},\"uri\":\"data:application/octet-stream;base64,{data}\"}}]}}",
        names.join(","),
        accessors.join(","),
        views.join(","),
        bytes.len()
    )
}

fn read(text: &str) -> Result<Model, Fault> {
    gltf::read("a.gltf", text.as_bytes(), Path::new("."))
}

/// Whether two lists of vectors are the same but for rounding, and one may be scaled.
fn close<const N: usize>(a: &[[f32; N]], b: &[[f32; N]], scale: f32) -> bool {
    a.len() == b.len() && a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (scale * a - b).abs() < 1e-5)
}

#[test]
fn gltf_gives_back_both_sets_and_the_tangents_with_their_hands() {
    let wanted = written();
    let radius = length([0.5, 0.4, 0.3]) as f32;
    let found = read(&text(&attributes(&wanted), &wanted.mesh.indices, "")).expect("a model");
    assert!(found.has_frames);
    assert!(close(&found.places, &wanted.places, 1.0) && close(&found.lightmap, &wanted.lightmap, 1.0));
    assert!(close(&found.mesh.positions, &wanted.mesh.positions, radius), "moved into the unit sphere");
    assert!(close(&found.mesh.normals, &wanted.mesh.normals, 1.0));
    assert!(close(&found.mesh.tangents, &wanted.mesh.tangents, 1.0));
    assert!(close(&found.mesh.uvs, &wanted.mesh.uvs, 1.0));
    assert_eq!(found.mesh.indices, wanted.mesh.indices);
    assert!(found.mesh.tangents.iter().any(|t| t[3] < 0.0));
    // Without tangents they follow the texture coordinates, mirrored where those are; without normals the faces are flat.
    let mut fewer = attributes(&wanted);
    fewer.retain(|attribute| !["NORMAL", "TANGENT"].contains(&attribute.name));
    let made = read(&text(&fewer, &wanted.mesh.indices, "")).expect("a model");
    assert!(made.has_frames && close(&made.mesh.normals, &wanted.mesh.normals, 1.0));
    assert!(close(&made.mesh.tangents, &wanted.mesh.tangents, 1.0));
    fewer.retain(|attribute| attribute.name == "POSITION");
    let bare = read(&text(&fewer, &wanted.mesh.indices, "")).expect("a model");
    assert!(!bare.has_frames && bare.lightmap.is_empty());
}

#[test]
fn a_node_that_mirrors_keeps_faces_outwards_and_tangents_on_the_surface() {
    let wanted = written();
    // x is mirrored and doubled; a normal is turned by the inverse transpose.
    let node = ",\"scale\":[-2,1,1]";
    let found = read(&text(&attributes(&wanted), &wanted.mesh.indices, node)).expect("a model");
    for corners in found.mesh.indices.as_chunks::<3>().0 {
        let i = corners.map(|i| i as usize);
        let [a, b, c] = i.map(|i| found.mesh.positions[i].map(f64::from));
        let normal = found.mesh.normals[i[0]].map(f64::from);
        let area = cross(add(b, -1.0, a), add(c, -1.0, a));
        assert!(dot(area, normal) > 0.0 && dot(a, normal) > 0.0, "outwards");
        let [x, y, z, w] = found.mesh.tangents[i[0]].map(f64::from);
        let bitangent = cross(normal, [x, y, z]).map(|v| v * w);
        // Texture coordinates still grow with both.
        let uv = i.map(|i| found.mesh.uvs[i].map(f64::from));
        for k in [1, 2] {
            let edge = add([a, b, c][k], -1.0, a);
            for (axis, step) in [([x, y, z], uv[k][0] - uv[0][0]), (bitangent, uv[k][1] - uv[0][1])] {
                assert!(dot(edge, axis) * step >= -1e-9, "{edge:?} {axis:?} {step}");
                assert_eq!(dot(edge, axis).abs() > 1e-6, step.abs() > 1e-6);
            }
        }
    }
}

#[test]
fn gltf_that_is_damaged_or_not_a_mesh_is_refused_with_a_reason() {
    let good = written();
    let with = |change: &dyn Fn(&mut Vec<Attribute>, &mut Vec<u32>)| {
        let (mut attributes, mut indices) = (attributes(&good), good.mesh.indices.clone());
        change(&mut attributes, &mut indices);
        read(&text(&attributes, &indices, "")).expect_err("refused").to_string()
    };
    let refused = |text: &str| read(text).expect_err("refused").to_string();
    assert!(with(&|all, _| all[0].numbers[4] = f32::NAN).contains("a coordinate that is not finite"));
    assert!(with(&|all, _| all[4].numbers[1] = f32::INFINITY).contains("a coordinate that is not finite"));
    assert!(with(&|_, indices| indices[7] = 99).contains("an index is 99, and there are 24 vertices"));
    assert!(with(&|_, indices| indices.truncate(2)).contains("no triangle of any size"));
    assert!(with(&|all, _| all[0].numbers.fill(1.0)).contains("no triangle of any size"));
    assert!(with(&|all, _| all[3].numbers.truncate(4)).contains("texture coordinates reach beyond"));
    let whole = text(&attributes(&good), &good.mesh.indices, "");
    assert!(refused(&whole.replace("\"version\":\"2.0\"", "\"version\":\"1.0\"")).contains("cannot be read"));
    assert!(
        refused(&whole.replace("data:application/octet-stream;base64,", "../a.bin?")).contains("not in its folder")
    );
    assert!(refused(&whole.replace("data:application/octet-stream;base64,", "data:;base64,*")).contains("no base64"));
    assert!(refused(&whole.replace("\"mesh\":0", "\"mesh\":0,\"children\":[0]")).contains("more than"));
    assert!(refused("{}").contains("a.gltf: cannot be read"));
    assert!(refused(&whole.replace("\"indices\":5", "\"indices\":5,\"mode\":5")).contains("a strip or a fan"));
    // Cut anywhere it is refused and nothing else.
    for at in (0..whole.len()).step_by(97) {
        refused(&whole[..at]);
    }
}

/// The text of an OBJ file of a model, with one of its sets of texture coordinates.
fn obj(model: &Model, uvs: &[[f32; 2]]) -> String {
    let mut text = String::new();
    for (i, ([x, y, z], [u, v])) in model.places.iter().zip(uvs).enumerate() {
        let [nx, ny, nz] = model.mesh.normals[i];
        text += &format!("v {x} {y} {z}\nvt {u} {v}\nvn {nx} {nz} {}\n", -ny);
    }
    for corners in model.mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = corners.map(|i| i + 1);
        text += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n");
    }
    text
}

#[test]
fn two_obj_files_are_two_sets() {
    let wanted = written();
    let (mesh, chart) = (obj(&wanted, &wanted.mesh.uvs), obj(&wanted, &wanted.lightmap));
    let read = |chart: &str| Model::from_obj("a.obj", mesh.as_bytes(), Some(("b.obj", chart.as_bytes())));
    let found = read(&chart).expect("a model");
    // A file of this format numbers no vertices: they are compared by their places.
    assert_eq!(found.places.len(), wanted.places.len());
    for i in 0..found.places.len() {
        let there = (0..wanted.places.len())
            .find(|&k| wanted.places[k] == found.places[i] && dot3(wanted.mesh.normals[k], found.mesh.normals[i]) > 0.9)
            .expect("the same vertex");
        assert_eq!((found.lightmap[i], found.mesh.uvs[i]), (wanted.lightmap[there], wanted.mesh.uvs[there]));
        let (a, b) = (found.mesh.tangents[i], wanted.mesh.tangents[there]);
        assert!((0..4).all(|k| (a[k] - b[k]).abs() < 1e-5), "{a:?} {b:?}");
    }
    let refused = |chart: &str| read(chart).expect_err("refused").to_string();
    let fewer = &chart[..chart.trim_end().rfind('\n').expect("lines")];
    assert!(refused(fewer).contains("b.obj: has 11 triangles, and a.obj has 12"));
    assert!(refused(&chart.replace("vt ", "# vt ").replace("/", "//")).contains("b.obj"));
    let moved = chart.replacen("v 0.5", "v 0.75", 1);
    assert!(refused(&moved).contains("elsewhere or in another order"));
}

fn dot3(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn a_texture_that_is_mirrored_at_a_seam_keeps_both_hands() {
    // Two squares in the plane y = 0 that meet along x, the texture mirrored there: the seam's vertices have one place and one
    // pair of coordinates, and a bitangent to each side.
    let text = "v 0 0 1\nv 1 0 1\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nv 1 0 -1\nvt 0 1\nvt 1 1\nvt 0 0\nvt 1 0\n\
                f 1/1 2/2 4/4\nf 1/1 4/4 3/3\nf 3/3 4/4 6/2\nf 3/3 6/2 5/1\n";
    let model = Model::from_obj("seam.obj", text.as_bytes(), None).expect("a model");
    assert_eq!(model.places.len(), 8, "six places, and the two of the seam once more");
    for (place, tangent) in model.places.iter().zip(&model.mesh.tangents) {
        assert!((tangent[0] - 1.0).abs() < 1e-6 && tangent[3].abs() == 1.0, "{tangent:?}");
        // v grows away from the seam: upwards in the picture beyond it, downwards before it.
        if place[2] != 0.0 {
            assert_eq!(tangent[3] > 0.0, place[2] < 0.0, "{place:?} {tangent:?}");
        }
    }
    let seam: f32 = model.places.iter().zip(&model.mesh.tangents).filter(|(p, _)| p[2] == 0.0).map(|(_, t)| t[3]).sum();
    assert_eq!(seam, 0.0, "one of each hand at either end");
}
