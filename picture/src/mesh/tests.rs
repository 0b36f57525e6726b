//! Meshes that are made, read and refused.

use super::*;
use zonal_scenes as assets;

fn meshes() -> Vec<(&'static str, Mesh)> {
    let files = ["meshes/teapot.obj", "meshes/bunny.obj"]
        .map(|path| (path, Mesh::from_obj(path, assets::embedded(path).expect("embedded")).expect("a mesh")));
    [("sphere", Mesh::sphere()), ("plane", Mesh::plane())].into_iter().chain(files).collect()
}

fn wide<const N: usize>(v: [f32; N]) -> [f64; N] {
    v.map(f64::from)
}

#[test]
fn every_mesh_is_whole_and_lies_in_the_unit_sphere() {
    for (name, mesh) in meshes() {
        let count = mesh.positions.len();
        assert_eq!([mesh.normals.len(), mesh.tangents.len(), mesh.uvs.len()], [count; 3], "{name}");
        assert_eq!(mesh.indices.len() % 3, 0, "{name}");
        assert_eq!(mesh.interleaved().len(), count * STRIDE, "{name}");
        assert!(mesh.indices.iter().all(|&i| (i as usize) < count), "{name}");
        // Rounding bulges a surface beyond its own vertices by a little.
        let radius = mesh.positions.iter().map(|&p| length(wide(p))).fold(0.0, f64::max);
        assert!((0.97..1.03).contains(&radius), "{name}: {radius}");
        for i in 0..count {
            let (n, [x, y, z, w]) = (wide(mesh.normals[i]), wide(mesh.tangents[i]));
            let t = [x, y, z];
            assert!((length(n) - 1.0).abs() < 1e-6 && (length(t) - 1.0).abs() < 1e-6, "{name}: {n:?} {t:?}");
            assert!(dot(n, t).abs() < 1e-6 && w.abs() == 1.0, "{name}: {n:?} {t:?}");
        }
    }
}

#[test]
fn triangles_look_where_their_normals_do_and_texture_coordinates_grow_with_the_tangents() {
    for (name, mesh) in meshes() {
        let (mut right, mut all) = (0.0, 0.0);
        for corners in mesh.indices.as_chunks::<3>().0 {
            let p = corners.map(|i| wide(mesh.positions[i as usize]));
            let uv = corners.map(|i| wide(mesh.uvs[i as usize]));
            let area = cross(add(p[1], -1.0, p[0]), add(p[2], -1.0, p[0]));
            let (n, [x, y, z, w]) = (wide(mesh.normals[corners[0] as usize]), wide(mesh.tangents[corners[0] as usize]));
            let bitangent = cross(n, [x, y, z]).map(|b| b * w);
            // One step along each side, in the frame and in texture coordinates, agrees in sign on the whole.
            let agrees = [1, 2].iter().all(|&k| {
                let (e, d) = (add(p[k], -1.0, p[0]), [uv[k][0] - uv[0][0], uv[k][1] - uv[0][1]]);
                dot(e, [x, y, z]) * d[0] + dot(e, bitangent) * d[1] > 0.0
            });
            all += length(area);
            if agrees && dot(area, n) > 0.0 {
                right += length(area);
            }
        }
        assert!(right / all > 0.98, "{name}: only {right} of {all}");
    }
}

#[test]
fn a_sphere_and_a_plane_have_their_areas() {
    let area = |mesh: &Mesh| -> f64 {
        let p = |i: u32| wide(mesh.positions[i as usize]);
        let faces = mesh.indices.as_chunks::<3>().0.iter();
        faces.map(|&[a, b, c]| 0.5 * length(cross(add(p(b), -1.0, p(a)), add(p(c), -1.0, p(a))))).sum()
    };
    // An inscribed polyhedron of cells of 2.8 degrees misses about (2.8 degrees)² / 6 of the area.
    assert!((area(&Mesh::sphere()) / (4.0 * PI) - 1.0).abs() < 1e-3);
    assert!((area(&Mesh::plane()) - 2.0).abs() < 1e-6);
}

#[test]
fn rounding_a_coarse_sphere_brings_it_closer_to_the_sphere() {
    // An octahedron: its flat faces come within 1/√3 of the centre.
    let text = b"v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n\
        f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    let mesh = Mesh::from_obj("octahedron", text).expect("a mesh");
    let least = mesh.positions.iter().map(|&p| length(wide(p))).fold(f64::MAX, f64::min);
    assert_eq!(mesh.indices.len(), 3 * 8 * PARTS * PARTS);
    assert!(least > 0.75, "{least}");
}

#[test]
fn a_file_with_normals_and_coordinates_keeps_them() {
    let text = b"v 0 0 0\nv 2 0 0\nv 0 2 0\nvt 0 0\nvt 3 0\nvt 0 3\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\n";
    let mesh = Mesh::from_obj("triangle", text).expect("a mesh");
    assert_eq!(mesh.indices, [0, 1, 2]);
    // y up became z up.
    assert_eq!(mesh.normals, [[0.0, -1.0, 0.0]; 3]);
    assert_eq!(mesh.tangents, [[1.0, 0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.uvs, [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]]);
    // The same file mirrored: v grows to the other side.
    let text = b"v 0 0 0\nv 2 0 0\nv 0 2 0\nvt 0 0\nvt 3 0\nvt 0 -3\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\n";
    assert_eq!(Mesh::from_obj("triangle", text).expect("a mesh").tangents, [[1.0, 0.0, 0.0, -1.0]; 3]);
}

#[test]
fn what_is_no_mesh_is_refused_with_a_reason() {
    for (text, part) in [
        (&b""[..], "no triangle"),
        (b"v 0 0 0\n", "no triangle"),
        (b"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "no triangle"),
        (b"v 0 0 0\nf 1 2 3\n", "out of bounds"),
        (b"v 0 0 x\n", "position parse error"),
        (b"v 0 0 nan\nv 0 1 0\nv 1 0 0\nf 1 2 3\n", "not finite"),
        (b"\x89PNG\r\n\xff\xfe", "no Wavefront OBJ"),
    ] {
        let error = Mesh::from_obj("a.obj", text).expect_err("no mesh").to_string();
        assert!(error.starts_with("a.obj: ") && error.contains(part), "{error}");
    }
}

type Turn = fn([f32; 3]) -> [f32; 3];

#[test]
fn a_mesh_may_be_in_the_axes_of_a_program() {
    let text = assets::embedded("meshes/bunny.obj").expect("embedded");
    let plain = Mesh::from_obj("bunny", text).expect("a mesh");
    let of = |axes: &str| Mesh::in_axes("bunny", text, Some(axes.parse().expect("three axes"))).expect("a mesh");
    // Right-handed with y up, the map's centre along +x: what a file is without axes.
    assert_eq!(of("x,-z,y"), plain);
    let volume = |mesh: &Mesh| -> f64 {
        let at = |i: u32| mesh.positions[i as usize].map(f64::from);
        mesh.indices.chunks(3).map(|f| dot(cross(at(f[0]), at(f[1])), at(f[2]))).sum::<f64>() / 6.0
    };
    assert!(volume(&plain) > 0.1);
    // The map's centre along +z: turned by a quarter about z. Left-handed: mirrored, and still with its faces outwards.
    let turns: [(&str, Turn); 2] = [("z,x,y", |[x, y, z]| [-y, x, z]), ("x,z,y", |[x, y, z]| [x, -y, z])];
    for (axes, turn) in turns {
        let found = of(axes);
        assert!((volume(&found) / volume(&plain) - 1.0).abs() < 1e-3, "{axes}: {}", volume(&found));
        let corner = |mesh: &Mesh, turn: Turn| {
            let sums = mesh.positions.iter().map(|p| turn(*p));
            sums.fold([f32::MIN; 3], |most, p| std::array::from_fn(|i| most[i].max(p[i])))
        };
        let (wanted, got) = (corner(&plain, turn), corner(&found, |p| p));
        assert!((0..3).all(|i| (wanted[i] - got[i]).abs() < 1e-3), "{axes}: {wanted:?} {got:?}");
    }
}
