//! Draws scenes as Rerun entities below a root that the caller gives.

mod machine;
mod workspace;

use std::cell::RefCell;

use glam::DVec3;
use rerun::components::LineStrip3D;
use rerun::{Angle, Arrows3D, AsComponents, Color, LineStrips3D, Points3D, Radius, RotationAxisAngle};

pub(super) use self::machine::{BAR_AXES, GROUPS};
use super::colors::{self, rgb};
use super::stage::Rows;
use super::writer::{Moment, RecordingError, RecordingWriter};
use kinefront_scene::{Part, palette};

type DrawResult = Result<(), RecordingError>;

pub(super) fn point(p: DVec3) -> [f32; 3] {
    p.as_vec3().to_array()
}

fn strip(points: &[DVec3]) -> Vec<[f32; 3]> {
    points.iter().map(|&p| point(p)).collect()
}

/// Brightness of a part on a light background, as a fraction of that on a dark one.
const ON_LIGHT: f32 = 0.68;

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

    /// Returns the colour of the regular workspace.
    fn workspace(&self) -> [u8; 3] {
        if self.is_light() {
            colors::WORKSPACE_ON_LIGHT
        } else {
            colors::WORKSPACE
        }
    }

    /// Draws lines, each with its colour and its width \[points\].
    pub(super) fn lines<L: Into<LineStrip3D>>(
        &self,
        entity: &str,
        lines: impl IntoIterator<Item = (L, Color, f32)>,
    ) -> DrawResult {
        let (mut strips, mut colors, mut radii) = (Vec::new(), Vec::new(), Vec::new());
        for (points, color, width) in lines {
            strips.push(points);
            colors.push(color);
            radii.push(Radius::new_ui_points(width));
        }
        let lines = LineStrips3D::new(strips).with_colors(colors).with_radii(radii);
        self.row(entity, &lines)
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

pub(super) fn about_z(angle: f64) -> RotationAxisAngle {
    RotationAxisAngle::new([0.0, 0.0, 1.0], Angle::from_radians(angle as f32))
}
