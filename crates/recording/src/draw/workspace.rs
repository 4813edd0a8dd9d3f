//! Draws what belongs to the workspace: its outline and limits, fields, ellipsoids, paths, and the axes of the configuration space.

use glam::{DVec2, DVec3};
use rerun::components::FillMode;
use rerun::{Color, Cylinders3D, Ellipsoids3D, LineStrips3D, Mesh3D, Points3D, Radius};

use super::{Canvas, DrawResult, about_z, point};
use crate::colors::{self, rgb};
use kinefront_model::evaluation::{ConstraintResult, Evaluation};
use kinefront_model::spatial::{Pose, unit};
use kinefront_scene::text::short;
use kinefront_scene::{ColorMap, ConfigurationSpace, EllipsoidSet, Heatmap, MotionPath, RegularCylinder, palette};

/// Opacity of the volume of the regular workspace.
const TRANSLUCENT: u8 = 60;

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

impl Canvas<'_> {
    /// Draws the regular workspace below `root`, as a cylinder between two heights.
    pub(crate) fn cylinder(
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
    pub(crate) fn prism(&self, root: &str, corners: &[DVec2], heights: [f64; 2], label: &str) -> DrawResult {
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
        let color = rgb(self.workspace());
        let lines = strips.into_iter().enumerate();
        let lines = lines.map(|(k, strip)| (strip, color, if k < 2 { 1.6 } else { 0.7 }));
        self.lines(&format!("{root}/outline"), lines)?;
        self.word(&format!("{root}/label"), at, label, self.workspace())
    }

    /// Draws the volume of the regular workspace between two heights, so that one sees through it.
    pub(crate) fn volume(&self, root: &str, cylinder: &RegularCylinder, [low, high]: [f64; 2]) -> DrawResult {
        let [r, g, b] = self.workspace();
        let volume = Cylinders3D::from_lengths_and_radii([(high - low) as f32], [cylinder.radius as f32])
            .with_centers([point(cylinder.centre.extend(0.5 * (low + high)))])
            .with_colors([Color::from_unmultiplied_rgba(r, g, b, TRANSLUCENT)])
            .with_line_radii([Radius::new_ui_points(0.0)])
            .with_fill_mode(FillMode::TransparentFillMajorWireframe);
        self.row(&format!("{root}/volume"), &volume)
    }

    /// Draws a heatmap with its contours and edges below `root`; `place` maps its positions to points of the scene.
    pub(crate) fn heatmap(
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
    pub(crate) fn outlines(&self, root: &str, heatmap: &Heatmap, place: &impl Fn(DVec2) -> DVec3) -> DrawResult {
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
            let placed = |line: &Vec<DVec2>| line.iter().map(|&p| point(place(p))).collect::<Vec<_>>();
            let lines = lines
                .into_iter()
                .map(|(line, color, width)| (placed(line), color, width));
            self.lines(&format!("{root}/{name}"), lines)?;
        }
        Ok(())
    }

    /// Draws ellipsoids at height `z` below `root`, with a text that gives their scale at `note`.
    pub(crate) fn ellipsoids(&self, root: &str, set: &EllipsoidSet, z: f64, note: DVec3) -> DrawResult {
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
    pub(crate) fn limits(&self, root: &str, evaluation: &Evaluation, z: f64, away: f64) -> DrawResult {
        let active: Vec<(&ConstraintResult, DVec2)> = evaluation
            .constraints
            .iter()
            .filter(|report| report.active)
            .filter_map(|report| Some((report, report.pose?.position)))
            .collect();
        let color = rgb(colors::LIMIT);
        let points = Points3D::new(active.iter().map(|(_, at)| point(at.extend(z))))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(6.0), active.len()))
            .with_colors(std::iter::repeat_n(color, active.len()));
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
        let leaders = active.iter().zip(&names);
        let leaders = leaders.map(|((_, at), (name, _))| ([at.extend(z), *name].map(point), color, 0.9));
        self.lines(&format!("{root}/leaders"), leaders)?;
        self.labels(&format!("{root}/names"), names, color)
    }

    /// Draws the path of a motion, each piece in the colour of its beginning; `place` maps its poses to points of the scene.
    pub(crate) fn path(&self, entity: &str, path: &MotionPath, place: &impl Fn(&Pose) -> DVec3) -> DrawResult {
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

    /// Draws the axes of the configuration space below `root`; the φ axis extends by `span` \[rad\] on either side of
    /// the home orientation.
    pub(crate) fn configuration_axes(
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
            [at(-span), at(span)].map(point),
            [ground(foot), ground(far_x)].map(point),
            [ground(foot), ground(near_y)].map(point),
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
            strips.push([at(turn), at(turn) - DVec3::X * 0.04 * extent].map(point));
        }
        let lines = strips.into_iter().map(|strip| (strip, rgb(colors::TEXT), 0.8));
        self.lines(&format!("{root}/lines"), lines)?;
        self.labels(&format!("{root}/ticks"), labels, rgb(colors::TEXT))
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
