//! Pictures of designs, rendered by casting rays at the solids of the scene; this needs no graphics driver.

use crate::chart::extremes;
use crate::error::AnyError;
use glam::{DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::{Cuboid, Cylinder, SharedShape};
use rayon::prelude::*;

use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::unit;
use kinefront_model::workspace::Region;
use kinefront_scene::palette;
use kinefront_scene::{SolidShape, manipulator, region_corners, regular_workspace};

/// Colours of the ground and of the workspace.
const GROUND: DVec3 = DVec3::ONE;
const WORKSPACE: DVec3 = DVec3::new(0.18, 0.62, 0.34);
/// Direction towards the light.
const LIGHT: DVec3 = DVec3::new(0.35, -0.45, 0.82);
/// Elevation and azimuth of the camera and half of its field of view \[deg\].
const ELEVATION: f64 = 52.0;
const AZIMUTH: f64 = -70.0;
const HALF_VIEW: f64 = 13.0;
/// Ratio by which the view is larger than the scene.
const MARGIN: f64 = 1.04;
/// Number of rays along each side of a pixel that differs from one of its neighbours.
const FINE: u32 = 3;

/// Renders a design at its home pose with its regular workspace; returns red, green and blue, row by row.
///
/// # Errors
/// An error that says which leg does not reach the home pose.
pub(super) fn picture(
    model: &Model,
    evaluation: &Evaluation,
    rotation_range_deg: f64,
    [width, height]: [u32; 2],
) -> Result<Vec<[u8; 3]>, AnyError> {
    let stage = RenderScene::new(model, evaluation, rotation_range_deg)?;
    let camera = Camera::new(&stage.corners, [width, height]);
    let row = |y: u32| -> Vec<DVec3> {
        (0..width)
            .map(|x| stage.color(&camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5)))
            .collect()
    };
    let coarse: Vec<Vec<DVec3>> = (0..height).into_par_iter().map(row).collect();
    let pixel = |x: u32, y: u32| {
        let here = coarse[y as usize][x as usize];
        let differs = |dx: i64, dy: i64| {
            let (x, y) = (i64::from(x) + dx, i64::from(y) + dy);
            let there = usize::try_from(y)
                .ok()
                .and_then(|y| coarse.get(y))
                .and_then(|row| row.get(usize::try_from(x).ok()?));
            there.is_some_and(|there| (*there - here).abs().max_element() > 0.03)
        };
        if ![(1, 0), (-1, 0), (0, 1), (0, -1)]
            .into_iter()
            .any(|(dx, dy)| differs(dx, dy))
        {
            return here;
        }
        let mut sum = DVec3::ZERO;
        for k in 0..FINE * FINE {
            let at = |index: u32| (f64::from(index) + 0.5) / f64::from(FINE);
            sum += stage.color(&camera.ray(f64::from(x) + at(k % FINE), f64::from(y) + at(k / FINE)));
        }
        sum / f64::from(FINE * FINE)
    };
    let rows: Vec<Vec<[u8; 3]>> = (0..height)
        .into_par_iter()
        .map(|y| (0..width).map(|x| bytes(pixel(x, y))).collect())
        .collect();
    Ok(rows.into_iter().flatten().collect())
}

fn bytes(color: DVec3) -> [u8; 3] {
    color
        .clamp(DVec3::ZERO, DVec3::ONE)
        .to_array()
        .map(|value| (value * 255.0).round() as u8)
}

fn vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

struct Camera {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    size: [f64; 2],
}

impl Camera {
    /// Creates a camera that sees all corners from as near as possible.
    fn new(corners: &[DVec3], size: [u32; 2]) -> Self {
        let turn = |deg: f64| libm::sincos(deg.to_radians());
        let ((sin_e, cos_e), (sin_a, cos_a)) = (turn(ELEVATION), turn(AZIMUTH));
        let back = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
        let right = DVec3::Z.cross(back).normalize();
        let up = back.cross(right);
        let size = size.map(f64::from);
        let across = |axis: DVec3| extremes(corners.iter().map(|corner| corner.dot(axis)));
        let [x, y, z] = [right, up, back].map(across);
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let centre = right * middle(x) + up * middle(y) + back * middle(z);
        // The half extent that must fit, referred to the shorter side; half the depth is added to the distance because
        // parts in front of the centre look larger.
        let shorter = size[0].min(size[1]);
        let half = (0.5 * (x[1] - x[0]) / (size[0] / shorter)).max(0.5 * (y[1] - y[0]) / (size[1] / shorter));
        let distance = MARGIN * half / libm::tan(HALF_VIEW.to_radians()) + 0.5 * (z[1] - z[0]);
        Self {
            eye: centre + back * distance,
            forward: -back,
            right,
            up,
            size,
        }
    }

    fn ray(&self, x: f64, y: f64) -> Ray {
        let [width, height] = self.size;
        // Both directions have the same scale, and the shorter side spans the field of view.
        let scale = 2.0 * libm::tan(HALF_VIEW.to_radians()) / width.min(height);
        let direction =
            self.forward + self.right * ((x - 0.5 * width) * scale) - self.up * ((y - 0.5 * height) * scale);
        Ray::new(vector(self.eye), vector(direction.normalize()))
    }
}

/// A solid that rays can hit.
struct RenderSolid {
    shape: SharedShape,
    pose: Pose,
    /// Bounds in the solid's own axes, where they are tight because a bar lies along one of the axes.
    bounds: Aabb,
    color: DVec3,
}

impl RenderSolid {
    fn new(shape: &SolidShape, color: DVec3) -> Self {
        let (shape, pose) = match *shape {
            SolidShape::Bar { from, to, radius, .. } => {
                let along = (to - from).normalize_or(DVec3::Y);
                let turn = Rotation::from_rotation_arc(Vector::Y, vector(along));
                let cylinder = Cylinder::new(0.5 * from.distance(to), radius);
                let middle = vector(0.5 * (from + to));
                (SharedShape::new(cylinder), Pose::from_parts(middle, turn))
            }
            SolidShape::Block {
                centre,
                half_size,
                angle,
                ..
            } => {
                let turn = Rotation::from_rotation_z(angle);
                let cuboid = Cuboid::new(vector(half_size));
                (SharedShape::new(cuboid), Pose::from_parts(vector(centre), turn))
            }
        };
        Self {
            bounds: shape.compute_local_aabb(),
            shape,
            pose,
            color,
        }
    }

    /// Returns the distance along the ray to the solid and the normal there, if the distance is smaller than `most`.
    fn meet(&self, ray: &Ray, most: f64) -> Option<(f64, DVec3)> {
        let ray = ray.inverse_transform_by(&self.pose);
        let entered = self.bounds.cast_local_ray(&ray, f64::MAX, true)?;
        if entered >= most {
            return None;
        }
        let hit = self.shape.cast_local_ray_and_get_normal(&ray, most, true)?;
        let normal = self.pose.rotation * hit.normal;
        Some((hit.time_of_impact, DVec3::from_array(normal.to_array())))
    }
}

/// The workspace as it is marked below a design.
enum Marked {
    /// Centre and radius \[m\].
    Disc(DVec2, f64),
    /// A prescribed polygon with its corners relative to the centre, and the centre \[m\].
    Polygon(Polygon, DVec2),
}

impl Marked {
    /// Returns how strongly a point is tinted. The rim is stronger so that the edge is visible although the tint is weak.
    fn tint(&self, at: DVec2) -> Option<f64> {
        const RIM: f64 = 0.9;
        const INSIDE: f64 = 0.28;
        match self {
            Marked::Disc(centre, radius) => {
                let distance = at.distance(*centre);
                (distance < *radius).then_some(if distance > 0.985 * radius { RIM } else { INSIDE })
            }
            Marked::Polygon(polygon, centre) => {
                let at = at - *centre;
                let size = polygon
                    .corners()
                    .iter()
                    .fold(0.0f64, |size, corner| size.max(corner.length()));
                let is_rim = || polygon.distance_to_boundary(at) < 0.015 * size;
                polygon.contains(at).then(|| if is_rim() { RIM } else { INSIDE })
            }
        }
    }
}

/// Everything that rays can hit: bodies, workspace and ground.
struct RenderScene {
    bodies: Vec<RenderSolid>,
    /// Points that bound everything visible.
    corners: Vec<DVec3>,
    workspace: Option<Marked>,
    /// Heights of the workspace and of the ground below it.
    heights: [f64; 2],
    /// Offset from a surface at which a shadow ray starts.
    step: f64,
    light: DVec3,
}

impl RenderScene {
    fn new(model: &Model, evaluation: &Evaluation, rotation_range_deg: f64) -> Result<Self, AnyError> {
        let design = &evaluation.design;
        let home = model.home(evaluation);
        let scene = manipulator(model, design, &home)?;
        let base = scene.base_bars(design.base_radius(), model.rails_of(design));
        let (mut bodies, mut corners) = (Vec::new(), Vec::new());
        let solids = scene.solids.iter().chain(&base);
        for solid in solids.filter(|solid| solid.shape.has_volume()) {
            corners.extend(solid.shape.mesh().positions);
            let color = palette::part(solid.part).map(|value| f64::from(value) / 255.0);
            bodies.push(RenderSolid::new(&solid.shape, DVec3::from_array(color)));
        }
        let thickness = corners.iter().fold(0.0f64, |most, corner| most.max(corner.z.abs()));
        let heights = [-1.02 * thickness, -1.3 * thickness];
        let cylinder = regular_workspace(evaluation, rotation_range_deg);
        if let Some(cylinder) = cylinder {
            let around = (0..24).map(|k| unit(f64::from(k) * std::f64::consts::PI / 12.0) * cylinder.radius);
            corners.extend(around.map(|spoke| (cylinder.centre + spoke).extend(heights[0])));
            let prescribed = region_corners(model).into_iter().flatten();
            corners.extend(prescribed.map(|corner| corner.extend(heights[0])));
        }
        Ok(Self {
            bodies,
            corners,
            workspace: cylinder.map(|cylinder| match &model.settings().workspace.region {
                Region::Polygon(polygon) => Marked::Polygon(polygon.clone(), model.settings().workspace.centre),
                Region::Largest | Region::Disc(_) => Marked::Disc(cylinder.centre, cylinder.radius),
            }),
            heights,
            step: 1e-4 * design.base_radius(),
            light: LIGHT.normalize(),
        })
    }

    fn color(&self, ray: &Ray) -> DVec3 {
        let [origin, direction] = [ray.origin, ray.dir].map(|v| DVec3::from_array(v.to_array()));
        let mut nearest: Option<(f64, DVec3, &RenderSolid)> = None;
        for body in &self.bodies {
            let most = nearest.map_or(f64::MAX, |(distance, ..)| distance);
            if let Some((distance, normal)) = body.meet(ray, most)
                && distance < most
            {
                nearest = Some((distance, normal, body));
            }
        }
        if let Some((distance, normal, body)) = nearest {
            return self.shade(body, origin + direction * distance, normal, direction);
        }
        let meets = |height: f64| origin + direction * ((height - origin.z) / direction.z);
        let ground = meets(self.heights[1]);
        let mut color = GROUND * if self.is_shaded(ground) { 0.72 } else { 1.0 };
        let at = meets(self.heights[0]).truncate();
        if let Some(tint) = self.workspace.as_ref().and_then(|workspace| workspace.tint(at)) {
            color = color.lerp(WORKSPACE, tint);
        }
        color
    }

    /// Returns whether a body lies between a point and the light.
    fn is_shaded(&self, at: DVec3) -> bool {
        let ray = Ray::new(vector(at + self.light * self.step), vector(self.light));
        self.bodies.iter().any(|body| body.meet(&ray, f64::MAX).is_some())
    }

    fn shade(&self, body: &RenderSolid, at: DVec3, normal: DVec3, direction: DVec3) -> DVec3 {
        let mut facing = normal.dot(self.light).max(0.0);
        if facing > 0.0 && self.is_shaded(at + normal * self.step) {
            facing *= 0.25;
        }
        let halfway = (self.light - direction).normalize_or(self.light);
        let gloss = libm::pow(normal.dot(halfway).max(0.0), 40.0) * facing;
        let sky = 0.5 + 0.5 * normal.z;
        body.color * (0.32 + 0.18 * sky + 0.55 * facing) + DVec3::splat(0.22 * gloss)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kinefront_model::evaluation::GridChoice;

    const SIZE: [u32; 2] = [240, 180];

    fn fractions(design: &str) -> [f64; 4] {
        let model = Model::default();
        let design = design.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let pixels = picture(&model, &evaluation, 20.0, SIZE).expect("a picture");
        assert_eq!(pixels.len(), (SIZE[0] * SIZE[1]) as usize);
        let fraction = |is: fn([i32; 3]) -> bool| {
            let found = pixels.iter().filter(|pixel| is(pixel.map(i32::from))).count();
            found as f64 / pixels.len() as f64
        };
        [
            fraction(|[r, g, b]| r > 250 && g > 250 && b > 250),
            // The workspace, sliders, and the platform.
            fraction(|[r, g, b]| g > r + 15 && g > b + 10),
            fraction(|[r, g, b]| r > g + 60 && g > b),
            fraction(|[r, g, b]| b > r + 60 && b > g + 20),
        ]
    }

    /// A picture shows the ground, sliders, platform and workspace, and the size of the workspace follows `R_w`.
    #[test]
    fn a_picture_shows_the_design_and_its_workspace() {
        let [ground, workspace, driven, platform] = fractions("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
        assert!((0.4..0.95).contains(&ground), "{ground}");
        assert!((0.05..0.3).contains(&workspace), "{workspace}");
        assert!(driven > 0.002 && platform > 0.004, "{driven} {platform}");
        // Design I has a fifth of the radius, on a base half as large.
        let [_, smaller, ..] = fractions("3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023");
        assert!(smaller < 0.5 * workspace, "{smaller} {workspace}");
        let [_, none, ..] = fractions("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.001 rp=0.001");
        assert_eq!(none, 0.0);
    }
}
