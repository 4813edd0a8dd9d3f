//! Draws scenes as Rerun entities below a root that the caller gives.

use std::cell::RefCell;

use glam::{DVec2, DVec3};
use rerun::components::FillMode;
use rerun::{
    Angle, Arrows3D, AsComponents, Boxes3D, Color, Cylinders3D, Ellipsoids3D, LineStrips3D, Mesh3D, Points3D,
    Quaternion, Radius, RotationAxisAngle,
};

use super::colors::{self, rgb};
use super::stage::Rows;
use super::writer::{Moment, RecordingError, RecordingWriter};
use kinefront_model::evaluation::{ConstraintResult, Evaluation};
use kinefront_model::spatial::{Pose, unit};
use kinefront_scene::palette;
use kinefront_scene::text::short;
use kinefront_scene::{
    BentBar, ColorMap, ConfigurationSpace, EllipsoidSet, Heatmap, MotionPath, Nearest, Part, RegularCylinder, Scene,
    Solid, SolidShape,
};

type DrawResult = Result<(), RecordingError>;

pub(super) fn point(p: DVec3) -> [f32; 3] {
    p.as_vec3().to_array()
}

/// Returns a circle about `centre` as a closed strip.
fn circle(centre: DVec3, radius: f64) -> Vec<[f32; 3]> {
    const CORNERS: u32 = 96;
    (0..=CORNERS)
        .map(|k| {
            let angle = 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(CORNERS);
            point(centre + (unit(angle) * radius).extend(0.0))
        })
        .collect()
}

/// Half the width of the line along the axis of a bar \[points\].
const AXIS_WIDTH: f32 = 0.8;

/// Name of the entity of these lines below that of the bars.
pub(super) const BAR_AXES: &str = "axes";

/// Brightness of a part on a light background, as a fraction of that on a dark one.
const ON_LIGHT: f32 = 0.68;

/// Opacity of the volume of the regular workspace.
const TRANSLUCENT: u8 = 60;

/// Draws scenes.
///
/// A group without members is written as an empty entity, because a viewer would otherwise show that of the previous
/// moment.
pub(super) struct Canvas<'a>(CanvasTarget<'a>);

enum CanvasTarget<'a> {
    /// Each row is written immediately, all at one moment.
    Written(&'a RecordingWriter, Moment<'a>),
    /// Rows are collected, to be shown together.
    Collected {
        rows: &'a RefCell<Rows>,
        /// Whether text is dark: a viewer with a light theme draws it on a light background.
        dark_words: bool,
    },
}

/// Entities of the solids of a manipulator below its root, each with the parts that it holds.
pub(super) const GROUPS: [(&str, &[Part]); 6] = [
    ("legs", &[Part::Tube, Part::Rod, Part::Crank, Part::Link, Part::Guide]),
    ("platform", &[Part::PlatformBar]),
    ("joints/passive", &[Part::PassiveJoint]),
    ("joints/actuated", &[Part::ActuatedJoint]),
    ("joints/sliders", &[Part::Slider]),
    ("joints/carriages", &[Part::Carriage]),
];

impl<'a> Canvas<'a> {
    /// Creates a canvas that writes at one moment.
    pub(super) fn at(writer: &'a RecordingWriter, moment: Moment<'a>) -> Self {
        Self(CanvasTarget::Written(writer, moment))
    }

    /// Creates a canvas that collects what is drawn in `rows`.
    pub(super) fn collecting(rows: &'a RefCell<Rows>, dark_words: bool) -> Self {
        Self(CanvasTarget::Collected { rows, dark_words })
    }

    pub(super) fn row(&self, entity: &str, archetype: &dyn AsComponents) -> DrawResult {
        match &self.0 {
            CanvasTarget::Written(writer, moment) => writer.row(entity, moment, archetype),
            CanvasTarget::Collected { rows, .. } => {
                rows.borrow_mut().push(entity, archetype);
                Ok(())
            }
        }
    }

    /// Whether the background is light.
    fn is_light(&self) -> bool {
        matches!(self.0, CanvasTarget::Collected { dark_words: true, .. })
    }

    /// Returns the colour of a part, darker on a light background.
    fn part(&self, part: Part) -> Color {
        if self.is_light() {
            rgb(palette::part(part).map(|level| (f32::from(level) * ON_LIGHT) as u8))
        } else {
            colors::part(part)
        }
    }

    /// Returns the colour of a solid.
    fn solid(&self, solid: &Solid) -> Color {
        let of_value = |value: f64| rgb(ColorMap::at(value));
        solid.value.map_or_else(|| self.part(solid.part), of_value)
    }

    /// Returns the colour of the regular workspace.
    fn workspace(&self) -> [u8; 3] {
        if self.is_light() {
            colors::WORKSPACE_ON_LIGHT
        } else {
            colors::WORKSPACE
        }
    }

    /// Draws the manipulator below `root`.
    pub(super) fn manipulator(&self, root: &str, scene: &Scene) -> DrawResult {
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
            let lines: Vec<_> = scene.lines.iter().filter(|line| parts.contains(&line.part)).collect();
            let strips = lines
                .iter()
                .map(|line| line.points.iter().map(|&p| point(p)).collect::<Vec<_>>());
            let strips = LineStrips3D::new(strips)
                .with_colors(lines.iter().map(|line| self.part(line.part)))
                .with_radii(std::iter::repeat_n(Radius::new_ui_points(width), lines.len()));
            self.row(&format!("{root}/{name}"), &strips)?;
        }
        let labels = scene.labels.iter().map(|label| (label.at, label.text.clone()));
        self.labels(&format!("{root}/labels"), labels.collect(), rgb(colors::TEXT))?;
        self.nearest(&format!("{root}/clearance"), scene.nearest.as_ref())
    }

    /// Draws the pair of members with the smallest clearance below `root`, as a line labelled with the distance.
    fn nearest(&self, root: &str, nearest: Option<&Nearest>) -> DrawResult {
        let color = nearest.map(|nearest| rgb(palette::nearest(nearest.too_near)));
        let strips = nearest.iter().map(|nearest| nearest.line.map(point));
        let line = LineStrips3D::new(strips)
            .with_colors(color)
            .with_radii(color.map(|_| Radius::new_ui_points(2.6)));
        self.row(&format!("{root}/line"), &line)?;
        let label = nearest.map(|nearest| (nearest.line[1], nearest.text.clone()));
        let color = color.unwrap_or_else(|| rgb(colors::TEXT));
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
        let axes = bars.iter().map(|(from, to, ..)| [point(*from), point(*to)]);
        let axes = LineStrips3D::new(axes)
            .with_colors(bars.iter().map(|(.., color)| *color))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(AXIS_WIDTH), bars.len()));
        self.row(&format!("{entity}/{BAR_AXES}"), &axes)
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

    /// Draws a text at a point.
    pub(super) fn word(&self, entity: &str, at: DVec3, text: &str, color: [u8; 3]) -> DrawResult {
        self.labels(entity, vec![(at, text.to_owned())], rgb(color))
    }

    /// Draws texts at points, without markers.
    fn labels(&self, entity: &str, labels: Vec<(DVec3, String)>, color: Color) -> DrawResult {
        let color = if self.is_light() { rgb(colors::INK) } else { color };
        let count = labels.len();
        let points = Points3D::new(labels.iter().map(|(at, _)| point(*at)))
            .with_labels(labels.into_iter().map(|(_, text)| text))
            .with_show_labels(true)
            .with_colors(std::iter::repeat_n(color, count))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.0), count));
        self.row(entity, &points)
    }

    /// Draws the regular workspace below `root`, as a cylinder between two heights.
    pub(super) fn cylinder(
        &self,
        root: &str,
        cylinder: &RegularCylinder,
        heights: [f64; 2],
        label: &str,
    ) -> DrawResult {
        let [low, high] = heights.map(|z| cylinder.centre.extend(z));
        let mut strips = vec![circle(low, cylinder.radius), circle(high, cylinder.radius)];
        for k in 0..12 {
            let offset = (unit(f64::from(k) * std::f64::consts::FRAC_PI_6) * cylinder.radius).extend(0.0);
            strips.push(vec![point(low + offset), point(high + offset)]);
        }
        // In front of the machine, where the fewest other labels are.
        let at = high - DVec3::new(cylinder.radius, cylinder.radius, 0.0) * 0.84;
        self.outlined(root, strips, at, label)
    }

    /// Draws a prescribed region that is a polygon, as a prism between two heights.
    pub(super) fn prism(&self, root: &str, corners: &[DVec2], heights: [f64; 2], label: &str) -> DrawResult {
        let closed = || corners.iter().chain(corners.first());
        let mut strips: Vec<Vec<_>> = heights
            .iter()
            .map(|&z| closed().map(|corner| point(corner.extend(z))).collect())
            .collect();
        let upright = |corner: &DVec2| heights.map(|z| point(corner.extend(z))).to_vec();
        strips.extend(corners.iter().map(upright));
        let left = corners
            .iter()
            .copied()
            .reduce(|a, b| if b.x - b.y < a.x - a.y { b } else { a });
        self.outlined(root, strips, left.unwrap_or_default().extend(heights[1]), label)
    }

    /// Draws the outline of the workspace, of which the first two strips are its faces, with a label.
    fn outlined(&self, root: &str, strips: Vec<Vec<[f32; 3]>>, at: DVec3, label: &str) -> DrawResult {
        let count = strips.len();
        let lines = LineStrips3D::new(strips)
            .with_colors(std::iter::repeat_n(rgb(self.workspace()), count))
            .with_radii((0..count).map(|k| Radius::new_ui_points(if k < 2 { 1.6 } else { 0.7 })));
        self.row(&format!("{root}/outline"), &lines)?;
        self.word(&format!("{root}/label"), at, label, self.workspace())
    }

    /// Draws the volume of the regular workspace between two heights, so that one sees through it.
    pub(super) fn volume(&self, root: &str, cylinder: &RegularCylinder, [low, high]: [f64; 2]) -> DrawResult {
        let [r, g, b] = self.workspace();
        let volume = Cylinders3D::from_lengths_and_radii([(high - low) as f32], [cylinder.radius as f32])
            .with_centers([point(cylinder.centre.extend(0.5 * (low + high)))])
            .with_colors([Color::from_unmultiplied_rgba(r, g, b, TRANSLUCENT)])
            .with_line_radii([Radius::new_ui_points(0.0)])
            .with_fill_mode(FillMode::TransparentFillMajorWireframe);
        self.row(&format!("{root}/volume"), &volume)
    }

    /// Draws a heatmap with its contours and edges below `root`; `place` maps its positions to points of the scene.
    pub(super) fn heatmap(
        &self,
        root: &str,
        heatmap: &Heatmap,
        map: &ColorMap,
        place: &impl Fn(DVec2) -> DVec3,
    ) -> DrawResult {
        if heatmap.triangles.is_empty() {
            return Ok(());
        }
        let mesh = Mesh3D::new(heatmap.vertices.iter().map(|&p| point(place(p))))
            .with_triangle_indices(heatmap.triangles.iter().copied())
            .with_vertex_colors(heatmap.values.iter().map(|&value| rgb(map.color(value))));
        self.row(&format!("{root}/field"), &mesh)?;
        self.outlines(root, heatmap, place)
    }

    /// Draws the contours and edges of a heatmap below `root`.
    pub(super) fn outlines(&self, root: &str, heatmap: &Heatmap, place: &impl Fn(DVec2) -> DVec3) -> DrawResult {
        let edges = heatmap
            .edges
            .iter()
            .map(|edge| (&edge.points, colors::edge(edge.reason), 1.0));
        let threshold = heatmap
            .threshold
            .iter()
            .map(|line| (line, rgb(palette::THRESHOLD), 1.6));
        let singular = heatmap.singular.iter().map(|line| (line, rgb(colors::SINGULAR), 1.6));
        for (name, lines) in [
            ("edge", edges.collect::<Vec<_>>()),
            ("threshold", threshold.collect()),
            ("singular", singular.collect()),
        ] {
            let strips = lines
                .iter()
                .map(|(line, ..)| line.iter().map(|&p| point(place(p))).collect::<Vec<_>>());
            let strips = LineStrips3D::new(strips)
                .with_colors(lines.iter().map(|(_, color, _)| *color))
                .with_radii(lines.iter().map(|(.., width)| Radius::new_ui_points(*width)));
            self.row(&format!("{root}/{name}"), &strips)?;
        }
        Ok(())
    }

    /// Draws ellipsoids at height `z` below `root`, with a text that gives their scale at `note`.
    pub(super) fn ellipsoids(&self, root: &str, set: &EllipsoidSet, z: f64, note: DVec3) -> DrawResult {
        let each = || set.ellipsoids.iter();
        let count = set.ellipsoids.len();
        let ellipsoids = Ellipsoids3D::from_centers_and_half_sizes(
            each().map(|e| point(e.pose.position.extend(z))),
            each().map(|e| point(e.values * set.scale)),
        )
        .with_rotation_axis_angles(each().map(|e| about_z(e.angle)))
        .with_colors(std::iter::repeat_n(rgb(colors::ELLIPSOID), count))
        .with_fill_mode(FillMode::Solid);
        self.row(&format!("{root}/bodies"), &ellipsoids)?;
        self.word(&format!("{root}/scale"), note, &set.scale_text(), colors::ELLIPSOID)
    }

    /// Draws below `root` the poses at which the active constraints limit the regular workspace, with the names of the
    /// constraints in a corner of a square at the distance `away` from the centre.
    pub(super) fn limits(&self, root: &str, evaluation: &Evaluation, z: f64, away: f64) -> DrawResult {
        let active: Vec<(&ConstraintResult, DVec2)> = evaluation
            .constraints
            .iter()
            .filter(|report| report.active)
            .filter_map(|report| Some((report, report.pose?.position)))
            .collect();
        let color = rgb(colors::LIMIT);
        let tints = || std::iter::repeat_n(color, active.len());
        let points = Points3D::new(active.iter().map(|(_, at)| point(at.extend(z))))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(6.0), active.len()))
            .with_colors(tints());
        self.row(&format!("{root}/poses"), &points)?;
        // In the corner beside A3 where neither the manipulator nor the legend of the window is; several names are stacked.
        let names: Vec<(DVec3, String)> = active
            .iter()
            .enumerate()
            .map(|(k, (report, _))| {
                let corner = DVec3::new(-0.85, 1.0 - 0.13 * k as f64, 0.0) * away;
                (corner + DVec3::Z * z, limit_text(report))
            })
            .collect();
        let leaders = LineStrips3D::new(
            active
                .iter()
                .zip(&names)
                .map(|((_, at), (name, _))| [point(at.extend(z)), point(*name)]),
        )
        .with_colors(tints())
        .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.9), active.len()));
        self.row(&format!("{root}/leaders"), &leaders)?;
        self.labels(&format!("{root}/names"), names, color)
    }

    /// Draws the path of a motion, each piece in the colour of its beginning; `place` maps its poses to points of the scene.
    pub(super) fn path(&self, entity: &str, path: &MotionPath, place: &impl Fn(&Pose) -> DVec3) -> DrawResult {
        let points: Vec<[f32; 3]> = path.poses.iter().map(|pose| point(place(pose))).collect();
        let lines = LineStrips3D::new(points.windows(2).map(|piece| piece.to_vec()))
            .with_colors(
                path.colors
                    .iter()
                    .map(|color| rgb(*color))
                    .take(points.len().saturating_sub(1)),
            )
            .with_radii([Radius::new_ui_points(2.2)]);
        self.row(entity, &lines)
    }

    /// Draws bars that are bent.
    pub(super) fn bent_bars(&self, entity: &str, bars: &[BentBar]) -> DrawResult {
        let points = |bar: &BentBar| bar.points.iter().map(|&at| point(at)).collect::<Vec<_>>();
        let lines = LineStrips3D::new(bars.iter().map(points))
            .with_colors([rgb(palette::BENT)])
            .with_radii(bars.iter().map(|bar| Radius::new_scene_units(bar.radius as f32)));
        self.row(entity, &lines)
    }

    /// Draws the axes of the configuration space below `root`; the φ axis extends by `span` \[rad\] on either side of
    /// the home orientation.
    pub(super) fn configuration_axes(
        &self,
        root: &str,
        space: &ConfigurationSpace,
        extent: f64,
        span: f64,
    ) -> DrawResult {
        // The far corner, so that the axes lie behind the data.
        let foot = DVec2::new(-extent, extent);
        let at = |turn: f64| space.place(foot, space.origin + turn);
        let ground = |p: DVec2| space.place(p, space.origin - span);
        let (far_x, near_y) = (DVec2::new(extent, extent), DVec2::new(-extent, -0.3 * extent));
        let mut strips = vec![
            vec![point(at(-span)), point(at(span))],
            vec![point(ground(foot)), point(ground(far_x))],
            vec![point(ground(foot)), point(ground(near_y))],
        ];
        let mut labels = vec![
            (ground(far_x * DVec2::new(1.1, 1.0)), "x".to_owned()),
            (ground(near_y - DVec2::Y * (0.1 * extent)), "y".to_owned()),
        ];
        for k in -2..=2 {
            let turn = 0.5 * span * f64::from(k);
            // Angles are shown in (−180°, 180°].
            let phi = 180.0
                - libm::fmod(
                    libm::fmod(180.0 - (space.origin + turn).to_degrees(), 360.0) + 360.0,
                    360.0,
                );
            labels.push((
                at(turn) - DVec3::X * 0.12 * extent,
                format!("φ = {}°", (phi * 10.0).round() / 10.0),
            ));
            strips.push(vec![point(at(turn)), point(at(turn) - DVec3::X * 0.04 * extent)]);
        }
        let count = strips.len();
        let lines = LineStrips3D::new(strips)
            .with_colors(std::iter::repeat_n(rgb(colors::TEXT), count))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.8), count));
        self.row(&format!("{root}/lines"), &lines)?;
        self.labels(&format!("{root}/ticks"), labels, rgb(colors::TEXT))
    }

    /// Draws an arrow with a text at its head.
    pub(super) fn arrow(&self, entity: &str, at: DVec3, vector: DVec3, text: &str, color: [u8; 3]) -> DrawResult {
        let width = 0.03 * vector.length() as f32;
        let arrows = Arrows3D::from_vectors([point(vector)])
            .with_origins([point(at)])
            .with_radii([Radius::new_scene_units(width)])
            .with_colors([rgb(color)]);
        self.row(entity, &arrows)?;
        self.word(&format!("{entity}/text"), at + vector * 1.06, text, colors::TEXT)
    }

    /// Draws a marker with a text.
    pub(super) fn mark(&self, entity: &str, at: DVec3, text: &str, color: [u8; 3]) -> DrawResult {
        let points = Points3D::new([point(at)])
            .with_radii([Radius::new_ui_points(5.0)])
            .with_colors([rgb(color)])
            .with_labels([text])
            .with_show_labels(true);
        self.row(entity, &points)
    }
}

/// Returns a text with a constraint's smallest value and the orientation at which it occurs.
fn limit_text(report: &ConstraintResult) -> String {
    let value = report.value.map(short).unwrap_or_default();
    let phi = report.pose.map_or(0.0, |pose| pose.phi.to_degrees());
    let unit = report.constraint.unit();
    format!(
        "{} {}: {value}{}{unit} at φ = {}°",
        report.constraint.id(),
        report.constraint.name().replace('_', " "),
        if unit.is_empty() { "" } else { " " },
        (phi * 10.0).round() / 10.0
    )
}

pub(super) fn about_z(angle: f64) -> RotationAxisAngle {
    RotationAxisAngle::new([0.0, 0.0, 1.0], Angle::from_radians(angle as f32))
}

/// Returns the rotation that turns z to `direction`.
fn along_z(direction: DVec3) -> Quaternion {
    let rotation = match direction.try_normalize() {
        Some(direction) => glam::DQuat::from_rotation_arc(DVec3::Z, direction),
        None => glam::DQuat::IDENTITY,
    };
    Quaternion::from_xyzw(rotation.as_quat().to_array())
}
