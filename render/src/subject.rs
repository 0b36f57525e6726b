//! What a picture shows, with every file read: the object, its normal map, its reflectance and the light around it. It
//! knows nothing of adapters.

use zonal_codegen::environment::{self, Map, Projection};
// Names a family: this is what a light is added by.
use zonal_codegen::families::lights::LIGHT_SPHERE;
// Names a family: a picture knows the tilt as two of its ways.
use zonal_codegen::families::tilt::TILT;
use zonal_codegen::families::{SmallAngle, Spec};
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::plan::Plan;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_codegen::scene::{Job, Light, Located, Maps, Order, Scene, SphereLight};
use zonal_picture::camera::Camera;
use zonal_picture::mesh::{self, Mesh};
use zonal_picture::method::Method;
use zonal_picture::normal_map::{self, NormalMap};
use zonal_picture::shade::Shading;

/// What a picture shows.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene's name.
    pub name: String,
    /// The object.
    pub mesh: Mesh,
    /// Its relief.
    pub normals: NormalMap,
    /// What the slopes of the relief are multiplied with.
    pub strength: f64,
    /// What it reflects.
    pub brdf: Brdf,
    /// The light around it.
    pub map: Map,
    /// The spheres that shine on it.
    pub lights: Vec<SphereLight>,
    /// The number of bands.
    pub order: usize,
    /// How coefficients get from a normal's frame to the surface's.
    pub method: Method,
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The width and the height in pixels.
    pub size: [usize; 2],
    /// How many stops it is brighter than by itself.
    pub exposure: f64,
}

/// What stands in for values of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instead {
    /// The number of bands.
    pub order: Option<usize>,
    /// How coefficients get from a normal's frame to the surface's.
    pub method: Option<Method>,
}

fn located<T>(file: &Located<String>, result: Result<T, impl Into<Fault>>) -> Result<T, Diagnostic> {
    result.map_err(|error| Diagnostic::of(&file.place, error))
}

impl Subject {
    /// Reads what a scene's picture shows.
    ///
    /// # Errors
    ///
    /// If the scene has no picture or no light, or a file is at fault.
    pub fn new(scene: &Scene, instead: Instead) -> Result<Self, Diagnostic> {
        let missing =
            |what: &str, help: &str| Diagnostic::at(&scene.name.place, format!("the scene has no {what}"), help);
        let picture = scene.picture.as_ref();
        let picture = picture.ok_or_else(|| missing("`[picture]`", "add the table with the `mesh` to draw"))?;
        let environment = scene.environment.as_ref();
        let environment =
            environment.ok_or_else(|| missing("`[environment]`", "add the table with a `map` of the light"))?;
        if environment.signal != Light::Radiance {
            let help = "write `signal = \"radiance\"`: the reflectance makes irradiance of it where that is wanted";
            return Err(Diagnostic::at(&environment.map.place, "a picture is drawn from the map's radiance", help));
        }
        let mesh = match picture.mesh.value.as_str() {
            "sphere" => Mesh::sphere(),
            "plane" => Mesh::plane(),
            name => {
                let bytes = scene.bytes(&picture.mesh, mesh::MAX_BYTES)?;
                located(&picture.mesh, Mesh::in_axes(name, &bytes, scene.axes()))?
            }
        };
        let normals = match &picture.normals {
            None => NormalMap::flat(),
            Some(file) => {
                located(file, NormalMap::from_bytes(&file.value, &scene.bytes(file, normal_map::MAX_BYTES)?))?
            }
        };
        let map = located(
            &environment.map,
            match &scene.maps {
                Maps::Folder(folder) => Map::read(&folder.join(&environment.map.value)),
                Maps::Embedded(_) => {
                    Map::from_bytes(&environment.map.value, &scene.bytes(&environment.map, environment::MAX_BYTES)?)
                }
            },
        )?;
        let number = match picture.order.as_ref().map(|order| order.value) {
            Some(Order::Number(number)) => Some(number),
            Some(Order::Environment) | None => None,
        };
        let (order, method) = match (instead.order.or(number), instead.method.or(picture.method)) {
            (Some(order), Some(method)) => (order, method),
            (order, method) => {
                let plan = Plan::new(scene)?;
                let found = plan.environment.as_ref().map(|environment| environment.order);
                let order = order.or(found).ok_or_else(|| missing("`order`", "write one in `[picture]`"))?;
                (order, method.unwrap_or_else(|| planned_method(scene, &plan)))
            }
        };
        let orders = method.orders();
        if !orders.contains(&order) {
            let message = format!("`{method}` has the orders {} to {}, not {order}", orders.start(), orders.end());
            return Err(Diagnostic::at(&scene.name.place, message, "take another order or another method"));
        }
        Ok(Self {
            name: scene.name.value.clone(),
            mesh,
            normals,
            strength: picture.strength,
            brdf: scene.brdf.clone().unwrap_or(Brdf::Lambert),
            map,
            lights: scene.lights.iter().map(|light| light.in_axes(scene.axes())).collect(),
            order,
            method,
            camera: picture.camera,
            size: picture.size,
            exposure: picture.exposure,
        })
    }

    /// The shader of an order and a method.
    pub fn shading(&self, order: usize, method: Method) -> Shading {
        Shading { order, method, isotropic: self.brdf.is_isotropic() }
    }

    /// The coefficients of the light: those of the map, and each sphere added by its kernel.
    pub fn light(&self, order: usize) -> Projection {
        let mut light = self.map.project(order);
        if self.lights.is_empty() {
            return light;
        }
        // Names a family: this is what a light is added by.
        let kernel = Program::<f64>::new(&Listing::new(&Spec::new(&LIGHT_SPHERE, order).kernel()));
        for sphere in &self.lights {
            let (dir, s) = (sphere.direction(), sphere.squared_sine());
            for (channel, radiance) in sphere.radiance.into_iter().enumerate() {
                let c: Vec<f64> = light.coefficients.iter().map(|c| c[channel]).collect();
                let sum = kernel.run(&[&dir, &[s], &[radiance], &c], Contraction::Separate);
                light.coefficients.iter_mut().zip(sum).for_each(|(c, sum)| c[channel] = sum);
            }
        }
        light
    }
}

/// How the scene's first rotation of the kind `tilt` was planned: only `tilt` and the exact kernel take a normal and no
/// angle. Exactly, if there is none.
fn planned_method(scene: &Scene, plan: &Plan) -> Method {
    // The plan lists the kernels that the scene names, then its rotations.
    let mut chosen = scene.rotations.iter().zip(&plan.kernels[scene.kernels.len()..]);
    let tilt = chosen.find(|(rotation, _)| rotation.kind == Job::Tilt);
    let spec: Option<Spec> = tilt.and_then(|(_, chosen)| chosen.row.spec.parse().ok());
    // Names a family: a picture knows the tilt as two of its ways.
    match spec {
        Some(spec) if *spec.family == TILT && spec.methods.contains(&SmallAngle::Lf5) => Method::Tilt5,
        Some(spec) if *spec.family == TILT => Method::Tilt,
        _ => Method::Exact,
    }
}
