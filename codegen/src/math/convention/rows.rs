//! The conventions of programs and formats, a row each. A frame places a latitude-longitude map where the program's own
//! reader of such maps does, if it has one; else as Blender's exporter to glTF turns a scene that the map lights.

use super::axes::{Axes, Axis};
use super::record::{Convention, Holds, Places, Scale};

const fn axes(centre: Axis, left: Axis, up: Axis) -> Axes {
    match Axes::new(centre, left, up) {
        Some(axes) => axes,
        None => panic!("three different axes"),
    }
}

const X: Axis = Axis::X;
const Y: Axis = Axis::Y;
const Z: Axis = Axis::Z;

/// The most bands that are projected.
const ANY: usize = 64;

/// Right-handed, y up, a map's centre along +x.
const GLTF: Axes = axes(X, Z.minus(), Y);
/// Right-handed, y up, a map's centre along +z.
const CENTRE_Z: Axes = axes(Z, X, Y);
/// Left-handed, y up, a map's centre along +x.
const LEFT_HANDED: Axes = axes(X, Z, Y);

/// What zonal's kernels take (docs/MATH.md#conventions).
pub const ZONAL: Convention = Convention {
    name: "zonal",
    title: "zonal",
    source: "docs/MATH.md, Conventions",
    axes: axes(X, Y, Z),
    phase: true,
    scale: Scale::Orthonormal,
    over_pi: false,
    places: Places::Acn,
    holds: Holds::Any,
    max_order: ANY,
    there: "any kernel of zonal",
};

/// Every convention that is known by name, zonal's own first.
pub static ALL: [Convention; 15] = [
    ZONAL,
    Convention {
        name: "three_js",
        title: "three.js (`LightProbe`, `SphericalHarmonics3`)",
        source: "src/math/SphericalHarmonics3.js, getAt and getIrradianceAt; equirectUv for maps",
        axes: GLTF,
        phase: false,
        max_order: 3,
        there: "`probe.sh.fromArray(coefficients.flat())` with those of radiance: its shader multiplies the cosine factors",
        ..ZONAL
    },
    Convention {
        name: "babylon",
        title: "Babylon.js (`SphericalHarmonics`)",
        source: "sphericalPolynomial.ts, SH3ylmBasisConstants; harmonicsFunctions.fx",
        axes: LEFT_HANDED,
        max_order: 3,
        there: "`sh = SphericalHarmonics.FromArray(coefficients)` of radiance, then \
                `sh.convertIncidentRadianceToIrradiance()`, `sh.convertIrradianceToLambertianRadiance()` and \
                `texture.sphericalPolynomial = SphericalPolynomial.FromHarmonics(sh)`",
        ..ZONAL
    },
    Convention {
        name: "playcanvas",
        title: "PlayCanvas (`ambientSH`)",
        source: "shader chunk lit/frag/ambient.js; toSphericalUv for maps",
        axes: CENTRE_Z,
        phase: false,
        scale: Scale::Folded,
        over_pi: true,
        places: Places::ByPolynomial,
        holds: Holds::Irradiance,
        max_order: 3,
        there: "`material.ambientSH = new Float32Array(coefficients.flat())`",
    },
    Convention {
        name: "bevy",
        title: "Bevy",
        source: "right-handed, y up, as its documentation of coordinates has it; it has no harmonics of its own",
        axes: GLTF,
        there: "any kernel of zonal, with normals as they are",
        ..ZONAL
    },
    Convention {
        name: "wgpu",
        title: "a renderer of your own on wgpu, right-handed with y up",
        source: "none: the frame is a choice of the renderer",
        axes: GLTF,
        there: "any kernel of zonal, with normals as they are",
        ..ZONAL
    },
    Convention {
        name: "godot",
        title: "Godot (probes of `LightmapGI`)",
        source: "scene_forward_clustered.glsl, lightmap_captures; sky.glsl, panorama_coords for maps",
        axes: CENTRE_Z,
        phase: false,
        over_pi: true,
        max_order: 3,
        there: "nine colours a point of `LightmapGIData`, those of radiance: its shader multiplies the cosine factors",
        ..ZONAL
    },
    Convention {
        name: "unity",
        title: "Unity (`SphericalHarmonicsL2`)",
        source: "UnityCG.cginc, SHEvalLinearL0L1 and SHEvalLinearL2; Skybox/Panoramic, ToRadialCoords for maps",
        axes: LEFT_HANDED,
        phase: false,
        scale: Scale::Folded,
        over_pi: true,
        holds: Holds::Irradiance,
        max_order: 3,
        there: "`sh[channel, i] = coefficients[i][channel]; RenderSettings.ambientProbe = sh`",
        ..ZONAL
    },
    Convention {
        name: "unreal",
        title: "Unreal Engine (`FSHVectorRGB3`, `SHBasisFunction3`)",
        source: "SHCommon.ush, SHBasisFunction3; DirectionToLongitudeLatitudeUV for maps",
        axes: axes(X, Y.minus(), Z),
        max_order: 3,
        there: "`sh.R.V[i] = coefficients[i][0]` and so on for G and B, then `CalcDiffuseTransferSH3` for radiance",
        ..ZONAL
    },
    Convention {
        name: "filament",
        title: "Filament (`IndirectLight`)",
        source: "indirect_light.fs, Irradiance_SphericalHarmonics; CubemapUtils.cpp, mirrored as cmgen does, for maps",
        axes: CENTRE_Z,
        phase: false,
        scale: Scale::Folded,
        over_pi: true,
        holds: Holds::Irradiance,
        max_order: 3,
        there: "`IndirectLight::Builder().irradiance(3, coefficients)`",
        ..ZONAL
    },
    Convention {
        name: "directxmath",
        title: "DirectXMath (`XMSH…`) and D3DX, left-handed with y up",
        source: "DirectXSH.cpp, XMSHEvalDirection",
        axes: LEFT_HANDED,
        max_order: 6,
        there: "an array a channel; `XMSHEvalDirection` and the others take it as it is",
        ..ZONAL
    },
    Convention {
        name: "khr_gaussian_splatting",
        title: "glTF, `KHR_gaussian_splatting`",
        source: "the extension's README, spherical harmonics; colours are 0.5 more than the sum",
        axes: GLTF,
        max_order: 4,
        there: "an accessor a coefficient, `SH_DEGREE_l_COEF_n` with n = l + m",
        ..ZONAL
    },
    Convention {
        name: "ext_lights_image_based",
        title: "glTF, `EXT_lights_image_based`",
        source: "the extension's README, irradianceCoefficients; the signs are those of its reader in Babylon.js",
        axes: GLTF,
        holds: Holds::Irradiance,
        max_order: 3,
        there: "`irradianceCoefficients`, as `zonal project --json` prints them",
        ..ZONAL
    },
    Convention {
        name: "threedgs",
        title: "splats in .ply (3DGS, gsplat), x right, y down, z forward",
        source: "gaussian-splatting, utils/sh_utils.py, eval_sh; colours are 0.5 more than the sum",
        axes: axes(Z, X.minus(), Y.minus()),
        max_order: 4,
        there: "`f_dc_0` to `f_dc_2`, then all of red, of green, of blue in `f_rest`",
        ..ZONAL
    },
    Convention {
        name: "ambix",
        title: "ambisonics in AmbiX (ACN, SN3D), x front, y left, z up",
        source: "Nachbar, Zotter, Deleflie, Sontacchi 2011, AmbiX",
        phase: false,
        scale: Scale::Schmidt,
        there: "a channel a coefficient",
        ..ZONAL
    },
];
