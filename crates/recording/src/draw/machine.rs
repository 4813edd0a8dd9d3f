//! Draws the manipulator: its solids, its lines, its labels and its nearest pair of members.

use glam::DVec3;
use rerun::components::FillMode;
use rerun::{Boxes3D, Color, Cylinders3D, LineStrips3D, Quaternion, Radius};

use super::{Canvas, DrawResult, about_z, point, strip};
use crate::colors::{self, rgb};
use kinefront_scene::{BentBar, ColorMap, Nearest, Part, Scene, Solid, SolidShape, palette};

/// Half the width of the line along the axis of a bar \[points\].
const AXIS_WIDTH: f32 = 0.8;

/// Name of the entity of these lines below that of the bars.
pub(crate) const BAR_AXES: &str = "axes";

/// Entities of the solids of a manipulator below its root, each with the parts that it holds.
pub(crate) const GROUPS: [(&str, &[Part]); 6] = [
    ("legs", &[Part::Tube, Part::Rod, Part::Crank, Part::Link, Part::Guide]),
    ("platform", &[Part::PlatformBar]),
    ("joints/passive", &[Part::PassiveJoint]),
    ("joints/actuated", &[Part::ActuatedJoint]),
    ("joints/sliders", &[Part::Slider]),
    ("joints/carriages", &[Part::Carriage]),
];

impl Canvas<'_> {
    /// Returns the colour of a solid.
    fn solid(&self, solid: &Solid) -> Color {
        let of_value = |value: f64| rgb(ColorMap::at(value));
        solid.value.map_or_else(|| self.part(solid.part), of_value)
    }

    /// Draws the manipulator below `root`.
    pub(crate) fn manipulator(&self, root: &str, scene: &Scene) -> DrawResult {
        for (name, parts) in GROUPS {
            let solids: Vec<&Solid> = scene
                .solids
                .iter()
                .filter(|solid| parts.contains(&solid.part))
                .collect();
            let entity = format!("{root}/{name}");
            // Sliders and carriages are blocks, all other solids bars.
            if parts.contains(&Part::Slider) || parts.contains(&Part::Carriage) {
                self.blocks(&entity, &solids)?;
            } else {
                self.bars(&entity, &solids)?;
            }
        }
        for (name, parts, width) in [
            ("base", &[Part::Base, Part::Rail][..], 1.6),
            ("strokes", &[Part::Stroke], 0.8),
            ("surroundings", &[Part::Obstacle, Part::Room], 1.4),
            ("frames", &[Part::AxisX, Part::AxisY], 2.0),
        ] {
            let lines = scene.lines.iter().filter(|line| parts.contains(&line.part));
            let lines = lines.map(|line| (strip(&line.points), self.part(line.part), width));
            self.lines(&format!("{root}/{name}"), lines)?;
        }
        let labels = scene.labels.iter().map(|label| (label.at, label.text.clone()));
        self.labels(&format!("{root}/labels"), labels.collect(), rgb(colors::TEXT))?;
        self.nearest(&format!("{root}/clearance"), scene.nearest.as_ref())
    }

    /// Draws the pair of members with the smallest clearance below `root`, as a line labelled with the distance.
    fn nearest(&self, root: &str, nearest: Option<&Nearest>) -> DrawResult {
        let color = |nearest: &Nearest| rgb(palette::nearest(nearest.too_near));
        let line = nearest.map(|nearest| (nearest.line.map(point), color(nearest), 2.6));
        self.lines(&format!("{root}/line"), line)?;
        let label = nearest.map(|nearest| (nearest.line[1], nearest.text.clone()));
        let color = nearest.map_or(rgb(colors::TEXT), color);
        self.labels(&format!("{root}/distance"), label.into_iter().collect(), color)
    }

    fn bars(&self, entity: &str, solids: &[&Solid]) -> DrawResult {
        let bars: Vec<(DVec3, DVec3, f64, Color)> = solids
            .iter()
            .filter_map(|solid| match solid.shape {
                SolidShape::Bar { from, to, radius, .. } => Some((from, to, radius, self.solid(solid))),
                SolidShape::Block { .. } => None,
            })
            .collect();
        let lengths = bars.iter().map(|(from, to, ..)| from.distance(*to) as f32);
        let radii = bars.iter().map(|(_, _, radius, _)| *radius as f32);
        let cylinders = Cylinders3D::from_lengths_and_radii(lengths, radii)
            .with_centers(bars.iter().map(|(from, to, ..)| point(0.5 * (*from + *to))))
            .with_quaternions(bars.iter().map(|(from, to, ..)| along_z(*to - *from)))
            .with_colors(bars.iter().map(|(.., color)| *color))
            .with_fill_mode(FillMode::Solid);
        self.row(entity, &cylinders)?;
        // A bar that is thinner than a line on the screen is seen by its axis, which a thicker one hides.
        let axes = bars
            .iter()
            .map(|(from, to, _, color)| ([*from, *to].map(point), *color, AXIS_WIDTH));
        self.lines(&format!("{entity}/{BAR_AXES}"), axes)
    }

    fn blocks(&self, entity: &str, solids: &[&Solid]) -> DrawResult {
        let blocks: Vec<(DVec3, DVec3, f64, Color)> = solids
            .iter()
            .filter_map(|solid| match solid.shape {
                SolidShape::Block {
                    centre,
                    half_size,
                    angle,
                    ..
                } => Some((centre, half_size, angle, self.solid(solid))),
                SolidShape::Bar { .. } => None,
            })
            .collect();
        let boxes = Boxes3D::from_centers_and_half_sizes(
            blocks.iter().map(|(centre, ..)| point(*centre)),
            blocks.iter().map(|(_, half, ..)| point(*half)),
        )
        .with_rotation_axis_angles(blocks.iter().map(|(_, _, angle, _)| about_z(*angle)))
        .with_colors(blocks.iter().map(|(.., color)| *color))
        .with_fill_mode(FillMode::Solid);
        self.row(entity, &boxes)
    }

    /// Draws bars that are bent.
    pub(crate) fn bent_bars(&self, entity: &str, bars: &[BentBar]) -> DrawResult {
        let lines = LineStrips3D::new(bars.iter().map(|bar| strip(&bar.points)))
            .with_colors([rgb(palette::BENT)])
            .with_radii(bars.iter().map(|bar| Radius::new_scene_units(bar.radius as f32)));
        self.row(entity, &lines)
    }
}

/// Returns the rotation that turns z to `direction`.
fn along_z(direction: DVec3) -> Quaternion {
    let rotation = match direction.try_normalize() {
        Some(direction) => glam::DQuat::from_rotation_arc(DVec3::Z, direction),
        None => glam::DQuat::IDENTITY,
    };
    Quaternion::from_xyzw(rotation.as_quat().to_array())
}
