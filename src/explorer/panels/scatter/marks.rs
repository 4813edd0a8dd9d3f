//! Marks drawn over the cloud: the front, its knee, the references, and the selected design.

use crate::study::Column;
use egui::{Align2, Color32};
use egui_plot::{Line, LineStyle, MarkerShape, PlotPoint, PlotPoints, Points, Text};

use super::Scatter;
use crate::explorer::{Row, Session, theme};
use kinefront_optimize::knee;

impl Scatter {
    /// Returns the lines and marks of the front (a staircase), its designs, the knee, the references and the selected
    /// design.
    pub(super) fn front<'a>(&self, session: &Session, dark: bool) -> (Vec<Line<'a>>, Vec<(Points<'a>, Option<Text>)>) {
        let ink = if dark {
            Color32::from_gray(235)
        } else {
            Color32::from_gray(30)
        };
        let ground = theme::ground(dark);
        let prepare = session.document().filter.prepare(session.store());
        let (mut lines, mut marks) = (Vec::new(), Vec::new());
        let plain = self.axes.map(|axis| axis.quantity) == [Column::Mass, Column::WorkspaceRadius];
        let front = session.front();
        if plain && !front.is_empty() {
            let mut steps: Vec<[f64; 2]> = Vec::new();
            for entry in front {
                let [x, y] = self.place(&entry.row);
                let before = steps.last().map_or(0.0, |last| last[1]);
                steps.extend([[x, before], [x, y]]);
            }
            if let (Some(&[_, y]), Some(bounds)) = (steps.last(), self.transform) {
                steps.push([bounds.bounds().max()[0].max(steps[steps.len() - 1][0]), y]);
            }
            lines.push(
                Line::new("", PlotPoints::from(steps))
                    .color(ink)
                    .width(1.2)
                    .allow_hover(false),
            );
        }
        for architecture in &session.study().architectures {
            for passes_filter in [false, true] {
                let points: Vec<[f64; 2]> = front
                    .iter()
                    .filter(|entry| entry.row.design.architecture == *architecture)
                    .filter(|entry| prepare.passes(entry.id) == passes_filter)
                    .map(|entry| self.place(&entry.row))
                    .collect();
                let color = theme::architecture(*architecture, dark);
                let color = if passes_filter {
                    color
                } else {
                    theme::mix(color, ground, 0.3)
                };
                marks.push((
                    Points::new("", points)
                        .radius(4.0)
                        .color(color)
                        .shape(theme::mark(*architecture))
                        .allow_hover(false),
                    None,
                ));
            }
        }
        let objectives: Vec<[f64; 2]> = front.iter().map(|entry| entry.objectives()).collect();
        if let Some(place) = knee(&objectives) {
            let at = self.place(&front[place].row);
            let text = Text::new("", PlotPoint::new(at[0], at[1]), "knee\u{a0}\u{a0}\u{a0}")
                .color(ink)
                .anchor(Align2::RIGHT_BOTTOM);
            marks.push((ring(at, 6.0, ink), Some(text)));
        }
        for reference in session.references() {
            let at = self.place(&Row::new(0, &reference.evaluation));
            if let (Some([mass, radius]), true) = (reference.stated, plain) {
                let stated = [self.axes[0].place(mass), self.axes[1].place(radius)];
                let way = PlotPoints::from(vec![stated, at]);
                lines.push(
                    Line::new("", way)
                        .color(theme::mix(ink, ground, 0.6))
                        .style(LineStyle::dashed_dense())
                        .width(1.0)
                        .allow_hover(false),
                );
                marks.push((ring(stated, 4.0, theme::mix(ink, ground, 0.7)), None));
            }
            let text = Text::new(
                "",
                PlotPoint::new(at[0], at[1]),
                format!("\u{a0}\u{a0}\u{a0}\u{a0}\u{a0}\u{a0}{}", reference.name),
            )
            .color(ink)
            .anchor(Align2::LEFT_CENTER);
            let points = Points::new("", vec![at])
                .shape(MarkerShape::Asterisk)
                .radius(6.0)
                .color(ink)
                .allow_hover(false);
            marks.push((points, Some(text)));
        }
        if let Some(known) = session.known() {
            let at = self.place(&Row::new(0, &known.evaluation));
            let color = if session.is_modified() {
                theme::MODIFIED
            } else {
                theme::SELECTED
            };
            marks.push((ring(at, 8.0, color), None));
            marks.push((ring(at, 9.0, color), None));
        }
        (lines, marks)
    }
}

fn ring<'a>(at: [f64; 2], radius: f32, color: Color32) -> Points<'a> {
    Points::new("", vec![at])
        .radius(radius)
        .filled(false)
        .color(color)
        .shape(MarkerShape::Circle)
        .allow_hover(false)
}
