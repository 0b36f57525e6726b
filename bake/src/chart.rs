//! A lightmap as a raster: which point of the surface each texel's centre lies on, and values for the texels that lie on
//! none. It knows nothing of light.

use crate::point::Point;
use zonal_codegen::fault::Fault;
use zonal_picture::mesh::Model;

/// The largest side of a lightmap, in texels.
pub const LARGEST: usize = 4096;
/// How far texture coordinates may lie outside of the lightmap by rounding.
const SLACK: f32 = 1e-5;
/// How far beside a triangle a centre may lie by the rounding of its coordinates, as a share of the triangle.
const BESIDE: f64 = 1e-5;

/// The points of a lightmap's texels.
#[derive(Clone, Debug)]
pub struct Chart {
    /// How many texels it has along a side.
    pub size: usize,
    /// Row by row from the top, which is where the second texture coordinate is 1, each row from the left. A texel is
    /// the point at its centre.
    pub points: Vec<Option<Point>>,
    /// How many texels' centres lie inside of two triangles, of which the first counts.
    pub overlaps: usize,
}

impl Chart {
    /// Lays a model's triangles over so many texels along a side, by its second set of texture coordinates.
    ///
    /// # Errors
    ///
    /// If there is no second set, it leaves the range from 0 to 1, or no texel's centre lies on a triangle.
    pub fn new(name: &str, model: &Model, size: usize) -> Result<Self, Fault> {
        let fault = |message: &str, help: &str| Err(Fault::new(format!("{name}: {message}"), help));
        if model.lightmap.is_empty() {
            let help =
                "export glTF with TEXCOORD_1, or name an OBJ file that has the coordinates, `--lightmap-uv FILE.obj`";
            return fault("has no second set of texture coordinates", help);
        }
        let (low, high) =
            model.lightmap.iter().flatten().fold((0f32, 1f32), |(low, high), &x| (low.min(x), high.max(x)));
        if low < -SLACK || high > 1.0 + SLACK {
            let message = format!("has lightmap coordinates from {low} to {high}");
            return fault(&message, "lay its islands out within 0 to 1, none above another");
        }
        let mut chart = Self { size, points: vec![None; size * size], overlaps: 0 };
        let mut inside = vec![false; size * size];
        for (triangle, corners) in model.mesh.indices.as_chunks::<3>().0.iter().enumerate() {
            let places = corners.map(|i| {
                let [u, v] = model.lightmap[i as usize].map(f64::from);
                // In texels from the centre of the first.
                [u * size as f64 - 0.5, (1.0 - v) * size as f64 - 0.5]
            });
            for_each_centre(places, size, |place, weights| {
                // On the edge between two triangles a centre belongs to both.
                let is_inside = weights.iter().all(|&weight| weight > BESIDE);
                chart.overlaps += usize::from(is_inside && inside[place]);
                inside[place] |= is_inside;
                if chart.points[place].is_none() {
                    chart.points[place] = Some(Point::inside(&model.mesh, triangle, weights));
                }
            });
        }
        if chart.points.iter().all(Option::is_none) {
            return fault("has no triangle on the centre of a texel", "make the lightmap larger, or its islands");
        }
        Ok(chart)
    }

    /// Returns what all texels hold, where `found` has it for those with a point, in their order: the others get the mean of
    /// their neighbours, from the islands outwards.
    pub fn filled(&self, found: &[Vec<[f64; 3]>]) -> Vec<Vec<[f64; 3]>> {
        let mut values: Vec<Vec<[f64; 3]>> = vec![Vec::new(); self.points.len()];
        let known: Vec<usize> = (0..self.points.len()).filter(|&i| self.points[i].is_some()).collect();
        for (&place, value) in known.iter().zip(found) {
            values[place].clone_from(value);
        }
        let mut ring = known;
        while !ring.is_empty() {
            let mut next: Vec<usize> = ring.iter().flat_map(|&i| self.around(i)).collect();
            next.retain(|&i| values[i].is_empty());
            next.sort_unstable();
            next.dedup();
            let mean = |&place: &usize| {
                let near: Vec<&Vec<[f64; 3]>> =
                    self.around(place).map(|i| &values[i]).filter(|value| !value.is_empty()).collect();
                let sum = |layer: usize, channel: usize| near.iter().map(|value| value[layer][channel]).sum::<f64>();
                let count = near.len() as f64;
                (0..near[0].len()).map(|i| std::array::from_fn(|channel| sum(i, channel) / count)).collect()
            };
            let means: Vec<Vec<[f64; 3]>> = next.iter().map(mean).collect();
            next.iter().zip(means).for_each(|(&place, mean)| values[place] = mean);
            ring = next;
        }
        values
    }

    /// The up to eight texels around one.
    pub(crate) fn around(&self, place: usize) -> impl Iterator<Item = usize> {
        let size = self.size;
        let near = move |i: usize| i.saturating_sub(1)..=(i + 1).min(size - 1);
        let (x, y) = (place % size, place / size);
        near(y).flat_map(move |row| near(x).map(move |column| row * size + column)).filter(move |&i| i != place)
    }
}

/// Returns what a lightmap holds at a place, between the centres of texels: the mean of the four around it by how near they
/// are, as a GPU filters.
pub fn filtered(size: usize, values: &[Vec<[f64; 3]>], [u, v]: [f64; 2]) -> Vec<[f64; 3]> {
    let last = (size - 1) as f64;
    let [x, y] = [u, 1.0 - v].map(|x| (x * size as f64 - 0.5).clamp(0.0, last));
    let (left, top) = (x as usize, y as usize);
    let (right, bottom) = ((left + 1).min(size - 1), (top + 1).min(size - 1));
    let (across, down) = (x - left as f64, y - top as f64);
    let four = [
        (top * size + left, (1.0 - across) * (1.0 - down)),
        (top * size + right, across * (1.0 - down)),
        (bottom * size + left, (1.0 - across) * down),
        (bottom * size + right, across * down),
    ];
    let layer = |i: usize| std::array::from_fn(|k| four.iter().map(|(at, weight)| values[*at][i][k] * weight).sum());
    (0..values[four[0].0].len()).map(layer).collect()
}

/// Calls for each texel whose centre lies in a triangle, with what the corners weigh there.
fn for_each_centre(p: [[f64; 2]; 3], size: usize, mut call: impl FnMut(usize, [f64; 3])) {
    let twice = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let area = twice(p[0], p[1], p[2]);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let range = |axis: usize| {
        let (low, high) = p.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        (low.ceil().max(0.0) as usize, high.floor().min(size as f64 - 1.0))
    };
    let ((left, right), (top, bottom)) = (range(0), range(1));
    if right < 0.0 || bottom < 0.0 {
        return;
    }
    for (y, x) in (top..=bottom as usize).flat_map(|y| (left..=right as usize).map(move |x| (y, x))) {
        let at = [x as f64, y as f64];
        let weights = [(p[1], p[2]), (p[2], p[0]), (p[0], p[1])].map(|(a, b)| twice(a, b, at) / area);
        if weights.iter().all(|&weight| weight >= -BESIDE) {
            call(y * size + x, weights);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_picture::mesh::Mesh;

    /// The plane with a lightmap that covers this part of it, turned by quarters.
    fn model(low: f32, high: f32, quarters: usize) -> Model {
        let mesh = Mesh::plane();
        let place = |uv: &[f32; 2]| {
            let [u, v] = (0..quarters).fold(*uv, |[u, v], _| [v, 1.0 - u]);
            [u, v].map(|x| low + (high - low) * x)
        };
        let lightmap = mesh.uvs.iter().map(place).collect();
        Model { places: mesh.positions.clone(), lightmap, mesh, has_frames: true }
    }

    #[test]
    fn texels_lie_where_their_centres_do() {
        for quarters in 0..4 {
            let chart = Chart::new("a", &model(0.0, 1.0, quarters), 8).expect("a chart");
            assert_eq!(chart.overlaps, 0);
            for (i, point) in chart.points.iter().enumerate() {
                let mut uv = [(i % 8) as f64 + 0.5, 7.5 - (i / 8) as f64].map(|x| x / 8.0);
                for _ in 0..quarters {
                    uv = [1.0 - uv[1], uv[0]];
                }
                let point = point.expect("all are covered");
                for k in 0..2 {
                    assert!((point.position[k] - (2.0 * uv[k] - 1.0) * 0.5f64.sqrt()).abs() < 1e-6, "{i} {point:?}");
                }
                assert_eq!(point.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            }
        }
    }

    #[test]
    fn what_lies_on_no_triangle_is_filled_from_its_neighbours() {
        let chart = Chart::new("a", &model(0.25, 0.75, 0), 16).expect("a chart");
        let covered = chart.points.iter().flatten().count();
        assert_eq!(covered, 64);
        let ramp: Vec<Vec<[f64; 3]>> =
            (0..256).filter(|&i| chart.points[i].is_some()).map(|i| vec![[(i % 16) as f64, 7.0, 0.0]]).collect();
        let filled = chart.filled(&ramp);
        for (i, value) in filled.iter().enumerate() {
            let (x, covered) = (i % 16, chart.points[i].is_some());
            // Means of what is near lie within what is there, and a constant stays one.
            assert!((4.0..=11.0).contains(&value[0][0]) && value[0][1] == 7.0 && value[0][2] == 0.0, "{i} {value:?}");
            assert!(!covered || value[0][0] == x as f64);
        }
        assert!(filled[3 * 16 + 8][0][0] - 8.0 < 1e-12, "the ring around is the mean of three");
        assert!((filled[5 * 16][0][0] - 4.0).abs() < 1.5);
    }

    #[test]
    fn coordinates_that_make_no_lightmap_are_refused() {
        let text =
            |model: &Model, size| Chart::new("a.obj", model, size).map(|_| ()).expect_err("no chart").to_string();
        let bare = Model { lightmap: Vec::new(), ..model(0.0, 1.0, 0) };
        assert!(text(&bare, 8).contains("a.obj: has no second set of texture coordinates"));
        assert!(text(&model(-1.0, 1.0, 0), 8).contains("from -1 to 1"));
        assert!(text(&model(0.5, 0.5, 0), 8).contains("no triangle on the centre"));
        let twice = Model { lightmap: model(0.0, 1.0, 0).lightmap.iter().map(|[u, _]| [*u, *u]).collect(), ..bare };
        assert!(text(&twice, 8).contains("no triangle"), "triangles without an area");
    }
}
