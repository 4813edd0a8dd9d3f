//! The plan view for CAD, in millimetres, with dimensions and a title block, and one layer for each kind of object. The file is DXF release
//! 12, which every CAD program reads: for later releases the library omits table handles that some programs require.

mod dimension;
mod title;

use ::dxf::entities::{Circle, Entity, EntityType, Line, Polyline, Text, Vertex};
use ::dxf::enums::AcadVersion;
use ::dxf::tables::Layer;
use ::dxf::{Color, Drawing, Point};
use glam::{DVec2, DVec3};

use super::format::{AnyError, Contents, Format};
use super::prepared::Prepared;
use kinefront_scene::{Part, Scene, SolidShape};

pub(super) const FORMAT: Format = Format {
    key: "dxf",
    file: "design.dxf",
    name: "DXF",
    title: "DXF, plan view with dimensions",
    lost: Some("joints, actuators and heights; the file contains only the plan view"),
    contents: Contents::Text,
    write,
};

/// Millimetres per metre.
const MM: f64 = 1e3;

/// Height of texts as a share of `R`.
const TEXT_HEIGHT: f64 = 0.03;

/// Layers with their colours from the AutoCAD Color Index.
const LAYERS: [(&str, u8); 11] = [
    ("BASE", 8),
    ("RAILS", 9),
    ("SURROUNDINGS", 1),
    ("LEGS", 7),
    ("PLATFORM", 5),
    ("JOINTS", 30),
    ("CENTRE_LINES", 1),
    ("WORKSPACE", 3),
    ("TEXT", 2),
    ("DIMENSIONS", 2),
    ("TITLE_BLOCK", 7),
];

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let design = &subject.evaluation.design;
    let scene = &subject.scene;
    let mut sheet = Sheet::new();
    sheet.manipulator(scene);
    match (&subject.corners, subject.cylinder) {
        (Some(corners), _) => sheet.outline("WORKSPACE", corners),
        (None, Some(cylinder)) => sheet.circle("WORKSPACE", cylinder.centre, cylinder.radius),
        (None, None) => {}
    }
    let height = TEXT_HEIGHT * design.base_radius();
    for label in &scene.labels {
        sheet.text("TEXT", label.at.truncate(), height, &label.text);
    }
    sheet.dimensions(subject, height);
    sheet.title_block(subject, height);
    let mut bytes = Vec::new();
    sheet.drawing.save(&mut bytes)?;
    Ok(release_12(&String::from_utf8(bytes)?).into_bytes())
}

/// Removes what release 12 does not know: the library writes subclass markers and handles in tables and entities for
/// this release too. Also removes the times of the header, so that a design gives the same file at any time. A file consists of
/// pairs of lines, a group code and its value.
fn release_12(text: &str) -> String {
    const SUBCLASS: &str = "100";
    const HANDLE: &str = "5";
    const TIMES: [&str; 2] = ["$TDCREATE", "$TDUPDATE"];
    let mut lines = text.lines();
    let (mut kept, mut in_header) = (String::with_capacity(text.len()), true);
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        if TIMES.contains(&value) {
            // The pair after a name is the value of the variable.
            lines.nth(1);
            continue;
        }
        in_header &= value != "TABLES";
        if in_header || !matches!(code.trim(), SUBCLASS | HANDLE) {
            kept += &format!("{code}\r\n{value}\r\n");
        }
    }
    kept
}

struct Sheet {
    drawing: Drawing,
}

impl Sheet {
    fn new() -> Self {
        let mut drawing = Drawing::new();
        drawing.header.version = AcadVersion::R12;
        for (name, color) in LAYERS {
            drawing.add_layer(Layer {
                name: name.to_owned(),
                color: Color::from_index(color),
                ..Layer::default()
            });
        }
        Self { drawing }
    }

    fn add(&mut self, layer: &str, kind: EntityType) {
        self.drawing.add_entity(entity(layer, kind));
    }

    fn manipulator(&mut self, scene: &Scene) {
        for line in &scene.lines {
            let layer = match line.part {
                Part::Base => "BASE",
                Part::Rail | Part::Stroke => "RAILS",
                Part::Obstacle | Part::Room => "SURROUNDINGS",
                _ => "CENTRE_LINES",
            };
            for ends in line.points.windows(2) {
                self.line(layer, ends[0].truncate(), ends[1].truncate());
            }
        }
        for solid in scene.solids.iter().filter(|solid| solid.shape.has_volume()) {
            let layer = match solid.part {
                Part::PlatformBar => "PLATFORM",
                Part::ActuatedJoint | Part::PassiveJoint => "JOINTS",
                _ => "LEGS",
            };
            match solid.shape {
                // In plan view a pin is a circle.
                SolidShape::Bar { from, to, radius, .. } if from.truncate() == to.truncate() => {
                    self.circle(layer, from.truncate(), radius);
                }
                SolidShape::Bar { from, to, radius, .. } => {
                    self.bar(layer, from, to, radius);
                    self.line("CENTRE_LINES", from.truncate(), to.truncate());
                }
                SolidShape::Block {
                    centre,
                    half_size,
                    angle,
                    ..
                } => {
                    let along = kinefront_model::spatial::unit(angle) * half_size.x;
                    let (from, to) = (centre - along.extend(0.0), centre + along.extend(0.0));
                    self.bar(layer, from, to, half_size.y);
                }
            }
        }
    }

    /// Adds the outline of a bar in plan view.
    fn bar(&mut self, layer: &str, from: DVec3, to: DVec3, radius: f64) {
        let (from, to) = (from.truncate(), to.truncate());
        let side = (to - from).normalize_or(DVec2::X).perp() * radius;
        self.outline(layer, &[from + side, from - side, to - side, to + side]);
    }

    /// Adds a closed polygon.
    fn outline(&mut self, layer: &str, corners: &[DVec2]) {
        let mut outline = Polyline::default();
        for corner in corners {
            let vertex = Vertex {
                location: point(*corner),
                ..Vertex::default()
            };
            outline.add_vertex(&mut self.drawing, vertex);
        }
        outline.set_is_closed(true);
        self.add(layer, EntityType::Polyline(outline));
    }

    fn circle(&mut self, layer: &str, centre: DVec2, radius: f64) {
        self.add(layer, EntityType::Circle(Circle::new(point(centre), MM * radius)));
    }

    fn line(&mut self, layer: &str, from: DVec2, to: DVec2) {
        self.add(layer, EntityType::Line(Line::new(point(from), point(to))));
    }

    fn text(&mut self, layer: &str, at: DVec2, height: f64, words: &str) {
        let text = Text {
            location: point(at),
            text_height: MM * height,
            value: words.to_owned(),
            ..Text::default()
        };
        self.add(layer, EntityType::Text(text));
    }
}

fn entity(layer: &str, kind: EntityType) -> Entity {
    let mut entity = Entity::new(kind);
    layer.clone_into(&mut entity.common.layer);
    entity
}

fn point(at: DVec2) -> Point {
    Point::new(MM * at.x, MM * at.y, 0.0)
}
