//! Dimensions of the plan view: each is a dimension of CAD, with the lines and the text that it shows.

use ::dxf::entities::{DimensionBase, EntityType, Line, RotatedDimension, Solid, Text};
use ::dxf::enums::{AttachmentPoint, DimensionType, HorizontalTextJustification, VerticalTextJustification};
use ::dxf::tables::DimStyle;
use ::dxf::{Block, Point};
use glam::DVec2;

use super::{MM, Prepared, Sheet, entity, point};
use kinefront_model::mechanism::{AnyLeg, Manipulator};

const LAYER: &str = "DIMENSIONS";

/// Name of the style of all dimensions.
const STYLE: &str = "KINEFRONT";

/// Sizes as multiples of the height of the text: length and half of the width of an arrow, gap at the object and overhang of extension lines.
const ARROW: [f64; 2] = [1.0, 0.17];
const GAP: f64 = 0.4;
const OVERHANG: f64 = 0.6;

/// A length between two points, with the side and the distance at which it is written \[m\].
struct Dimension {
    from: DVec2,
    to: DVec2,
    offset: f64,
}

impl Sheet {
    /// Adds the distances of the joints: of the base joints, within leg 1 at the drawn pose, and from `P` to a platform joint; and the sides of
    /// a prescribed rectangle.
    pub(super) fn dimensions(&mut self, subject: &Prepared, height: f64) {
        self.drawing.add_dim_style(DimStyle {
            name: STYLE.to_owned(),
            dimensioning_text_height: MM * height,
            dimensioning_arrow_size: MM * height * ARROW[0],
            dimension_extension_line_offset: MM * height * GAP,
            dimension_extension_line_extension: MM * height * OVERHANG,
            dimension_line_gap: MM * height * GAP,
            text_above_dimension_line: true,
            dimension_text_inside_horizontal: false,
            dimension_text_outside_horizontal: false,
            ..DimStyle::default()
        });
        for (number, dimension) in dimensions(subject, height).iter().enumerate() {
            self.dimension(number, dimension, height);
        }
    }

    fn dimension(&mut self, number: usize, dimension: &Dimension, height: f64) {
        let Dimension { from, to, offset } = *dimension;
        let along = (to - from).normalize_or(DVec2::X);
        let side = along.perp() * offset.signum();
        let [start, end] = [from, to].map(|end| end + side * offset.abs());
        let words = format!("{:.1}", MM * from.distance(to));
        // Texts are read from below or from the right.
        let angle = libm::atan2(along.y, along.x).to_degrees();
        let readable = if angle > 90.0 || angle <= -90.0 {
            angle + 180.0
        } else {
            angle
        };
        let up = kinefront_model::spatial::unit((readable + 90.0).to_radians());
        let middle = 0.5 * (start + end) + up * (GAP + 0.5) * height;
        let name = format!("*D{number}");
        let block = Block {
            name: name.clone(),
            // Without a name of its own, as dimensions have it.
            flags: 1,
            entities: shown([from, to], [start, end], height)
                .chain([text(middle, readable, height, &words)])
                .map(|kind| entity(LAYER, kind))
                .collect(),
            ..Block::default()
        };
        self.drawing.add_block(block);
        let base = DimensionBase {
            block_name: name,
            definition_point_1: point(end),
            text_mid_point: point(middle),
            dimension_type: DimensionType::Aligned,
            attachment_point: AttachmentPoint::MiddleCenter,
            actual_measurement: MM * from.distance(to),
            // Empty, so that a CAD program writes what it measures; the block shows the same.
            text: String::new(),
            dimension_style_name: STYLE.to_owned(),
            ..DimensionBase::default()
        };
        self.add(
            LAYER,
            EntityType::RotatedDimension(RotatedDimension {
                dimension_base: base,
                definition_point_2: point(from),
                definition_point_3: point(to),
                rotation_angle: angle,
                ..RotatedDimension::default()
            }),
        );
    }
}

/// The extension lines, the dimension line and its arrows.
fn shown(ends: [DVec2; 2], on_line: [DVec2; 2], height: f64) -> impl Iterator<Item = EntityType> {
    let line = |from: DVec2, to: DVec2| EntityType::Line(Line::new(point(from), point(to)));
    let [start, end] = on_line;
    let along = (end - start).normalize_or(DVec2::X);
    let extension = move |at: DVec2, on_line: DVec2| {
        let away = (on_line - at).normalize_or_zero() * height;
        line(at + GAP * away, on_line + OVERHANG * away)
    };
    let arrow = move |tip: DVec2, inwards: DVec2| {
        let [length, half] = ARROW.map(|size| size * height);
        let corners = [half, -half].map(|half| point(tip + length * inwards + half * inwards.perp()));
        EntityType::Solid(Solid {
            first_corner: point(tip),
            second_corner: corners[0].clone(),
            third_corner: corners[1].clone(),
            fourth_corner: corners[1].clone(),
            ..Solid::default()
        })
    };
    [
        extension(ends[0], start),
        extension(ends[1], end),
        line(start, end),
        arrow(start, along),
        arrow(end, -along),
    ]
    .into_iter()
}

fn text(middle: DVec2, angle: f64, height: f64, words: &str) -> EntityType {
    let at: Point = point(middle);
    EntityType::Text(Text {
        location: at.clone(),
        second_alignment_point: at,
        horizontal_text_justification: HorizontalTextJustification::Center,
        vertical_text_justification: VerticalTextJustification::Middle,
        text_height: MM * height,
        rotation: angle,
        value: words.to_owned(),
        ..Text::default()
    })
}

/// Whether four corners are those of a rectangle, up to rounding: its diagonals are equally long and halve each other.
fn is_rectangle([a, b, c, d]: [DVec2; 4]) -> bool {
    let size = a.distance(c);
    (size - b.distance(d)).abs() <= 1e-9 * size && (a + c).distance(b + d) <= 1e-9 * size
}

fn dimensions(subject: &Prepared, height: f64) -> Vec<Dimension> {
    let design = &subject.evaluation.design;
    let manipulator = Manipulator::<AnyLeg>::new(design, &subject.model.settings().legs);
    let Ok(posture) = manipulator.posture(&subject.pose) else {
        return Vec::new();
    };
    let anchors = posture.legs.each_ref().map(|leg| leg.chain.a);
    let centre = subject.pose.position;
    // Away from the middle of what is dimensioned.
    let outwards = |from: DVec2, to: DVec2, middle: DVec2, distance: f64| {
        let side = (to - from).perp().dot(0.5 * (from + to) - middle);
        let offset = if side < 0.0 { -distance } else { distance };
        Dimension { from, to, offset }
    };
    let base = 0.5 * (anchors[0] + anchors[1]);
    let mut found = vec![outwards(anchors[0], anchors[1], anchors[2], 6.0 * height)];
    let chain = &posture.legs[0].chain;
    for (from, to, middle) in [(chain.a, chain.b, anchors[2]), (chain.b, chain.c, centre)] {
        if from.distance(to) > 4.0 * height {
            found.push(outwards(from, to, middle, 3.0 * height));
        }
    }
    if centre.distance(chain.c) > 4.0 * height {
        found.push(outwards(centre, chain.c, base, 3.0 * height));
    }
    if let Some([first, second, third, fourth]) = subject.corners.as_deref()
        && is_rectangle([*first, *second, *third, *fourth])
    {
        let middle = 0.5 * (*first + *third);
        found.push(outwards(*first, *second, middle, 2.5 * height));
        found.push(outwards(*second, *third, middle, 2.5 * height));
    }
    found
}
