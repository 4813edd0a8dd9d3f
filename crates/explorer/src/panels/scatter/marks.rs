//! Marks drawn over the cloud: the front, its knee, the references, and the selected design.

use egui::{Align2, Color32};
use egui_plot::{Line, LineStyle, MarkerShape, PlotPoint, PlotPoints, Points, Text};
use kinefront_study::Column;

use super::coloring::{ColorScale, Coloring};
use super::{Scatter, ScatterAxis};
use crate::{FrontEntry, Row, Session, Wished, theme};
use kinefront_model::evaluation::{Better, Objective};
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::{Objectives, knee};

/// A mark with the text beside it.
type LabelledPoints<'a> = (Points<'a>, Option<Text>);

/// Colours of the lines and texts of a theme, and of its background.
#[derive(Clone, Copy)]
struct Colors {
    ink: Color32,
    ground: Color32,
    dark: bool,
}

impl Scatter {
    /// Returns the lines and marks of the front (a staircase), its designs, the knee, the references and the selected
    /// design.
    pub(super) fn front<'a>(&self, session: &Session, dark: bool) -> (Vec<Line<'a>>, Vec<LabelledPoints<'a>>) {
        let colors = Colors {
            ink: if dark {
                Color32::from_gray(235)
            } else {
                Color32::from_gray(30)
            },
            ground: theme::ground(dark),
            dark,
        };
        let (mut lines, mut marks) = (Vec::new(), Vec::new());
        lines.extend(self.staircase(session, session.front(), colors.ink));
        marks.extend(self.designs(session, colors));
        self.add_beside(session, colors, &mut lines, &mut marks);
        marks.extend(self.knee(session, colors));
        self.add_references(session, colors, &mut lines, &mut marks);
        marks.extend(self.wished(session, colors));
        marks.extend(self.why(session, colors));
        if let Some(known) = session.known() {
            let at = self.place(&Row::new(0, &known.evaluation));
            let color = if session.is_modified() {
                theme::modified(dark)
            } else {
                theme::SELECTED
            };
            marks.extend([8.0, 9.0].map(|radius| (ring(at, radius, color), None)));
        }
        (lines, marks)
    }

    /// The front of the run beside that of the session: a dashed edge and hollow marks, with its name.
    fn add_beside<'a>(
        &self,
        session: &Session,
        colors: Colors,
        lines: &mut Vec<Line<'a>>,
        marks: &mut Vec<LabelledPoints<'a>>,
    ) {
        let Some(beside) = session.beside() else { return };
        let ink = theme::mix(colors.ink, colors.ground, 0.7);
        lines.extend(
            self.staircase(session, &beside.front, ink)
                .map(|line| line.style(LineStyle::dashed_loose())),
        );
        for &architecture in Architecture::ALL {
            let own = beside
                .front
                .iter()
                .filter(|entry| entry.row.design.architecture() == architecture);
            let places: Vec<[f64; 2]> = own.map(|entry| self.place(&entry.row)).collect();
            let color = theme::architecture(architecture, colors.dark);
            let points = Points::new("", places).radius(3.5).filled(false).color(color);
            marks.push((points.shape(theme::mark(architecture)).allow_hover(false), None));
        }
        // The last design of a front lies at its end, where there is room for a name.
        if let Some(last) = beside.front.last() {
            let [x, y] = self.place(&last.row);
            let name = format!("{}{}", beside.name, "\u{a0}".repeat(3));
            let text = Text::new("", PlotPoint::new(x, y), name).color(colors.ink);
            let end = Points::new("", vec![[x, y]]).radius(2.0).color(ink).allow_hover(false);
            marks.push((end, Some(text.anchor(Align2::RIGHT_BOTTOM))));
        }
    }

    /// The edge of the dominated region, if the axes are the two objectives: from the bad end of the second axis to that of the first
    /// one.
    fn staircase<'a>(&self, session: &Session, front: &[FrontEntry], color: Color32) -> Option<Line<'a>> {
        let objectives = session.study().objectives();
        let [first, second] = objectives.as_slice() else {
            return None;
        };
        let shown = self.axes.map(|axis| axis.quantity);
        if shown != [first, second].map(|objective| Column::Quantity(objective.quantity)) {
            return None;
        }
        let bounds = self.transform.map(|transform| *transform.bounds());
        let bounds = bounds.unwrap_or_else(|| self.extent.bounds());
        let worst = |objective: &Objective, k: usize| match objective.goal {
            Better::Lower => bounds.max()[k],
            Better::Higher => bounds.min()[k],
        };
        let mut steps: Vec<[f64; 2]> = Vec::new();
        // The front is in the order of the first objective.
        for entry in front {
            let [x, y] = self.place(&entry.row);
            let before = steps.last().map_or(worst(second, 1), |last| last[1]);
            steps.extend([[x, before], [x, y]]);
        }
        let &[_, y] = steps.last()?;
        steps.push([worst(first, 0), y]);
        let line = Line::new("", PlotPoints::from(steps));
        Some(line.color(color).width(1.2).allow_hover(false))
    }

    /// The designs of the front in the colours of a quantity.
    fn in_colors<'a>(&self, session: &Session, column: Column, scale: ColorScale) -> Vec<LabelledPoints<'a>> {
        let prepared = session.document().filter.prepare(session.store());
        let mark = |entry: &FrontEntry| {
            let color = scale.color(entry.row.number(column)?)?;
            let color = if prepared.passes_entry(entry) {
                color
            } else {
                color.gamma_multiply(0.3)
            };
            let points = Points::new("", vec![self.place(&entry.row)]).radius(4.0).color(color);
            let shape = theme::mark(entry.row.design.architecture());
            Some((points.shape(shape).allow_hover(false), None))
        };
        session.front().iter().filter_map(mark).collect()
    }

    /// The designs of the front by architecture, or in the colours of a quantity; those that do not pass the filter are dimmed.
    fn designs<'a>(&self, session: &Session, colors: Colors) -> Vec<LabelledPoints<'a>> {
        if let (Coloring::Quantity(column), Some(scale)) = (self.coloring, self.scale) {
            return self.in_colors(session, column, scale);
        }
        let prepared = session.document().filter.prepare(session.store());
        let of = |architecture: Architecture, passes: bool| {
            let points: Vec<[f64; 2]> = session
                .front()
                .iter()
                .filter(|entry| entry.row.design.architecture() == architecture)
                .filter(|entry| prepared.passes_entry(entry) == passes)
                .map(|entry| self.place(&entry.row))
                .collect();
            let color = theme::architecture(architecture, colors.dark);
            let color = if passes {
                color
            } else {
                theme::mix(color, colors.ground, 0.3)
            };
            let points = Points::new("", points).radius(4.0).color(color);
            (points.shape(theme::mark(architecture)).allow_hover(false), None)
        };
        let architectures = session.study().architectures.iter();
        architectures
            .flat_map(|&architecture| [of(architecture, false), of(architecture, true)])
            .chain(self.proofs(session, colors))
            .collect()
    }

    /// A ring about each design whose workspace was certified: closed if it is proved, of dots if it is open.
    fn proofs<'a>(&self, session: &Session, colors: Colors) -> Vec<LabelledPoints<'a>> {
        let ink = theme::mix(colors.ink, colors.ground, 0.6);
        let (mut proved, mut marks) = (Vec::new(), Vec::new());
        for entry in session.front() {
            let at = self.place(&entry.row);
            match entry.certified {
                Some(certified) if certified.is_proved => proved.push(at),
                Some(_) => {
                    let dots = Text::new("", PlotPoint::new(at[0], at[1]), "◌").color(ink);
                    marks.push((ring(at, 0.0, ink), Some(dots)));
                }
                None => {}
            }
        }
        let rings = Points::new("", proved).radius(5.5).filled(false).color(ink);
        marks.push((rings.shape(MarkerShape::Circle).allow_hover(false), None));
        marks
    }

    fn knee<'a>(&self, session: &Session, colors: Colors) -> Option<LabelledPoints<'a>> {
        // A front of one objective has no knee.
        if session.study().objectives.len() < 2 {
            return None;
        }
        let front = session.front();
        let objectives: Vec<Objectives> = front.iter().map(|entry| entry.objectives()).collect();
        let at = self.place(&front[knee(&objectives)?].row);
        let text = Text::new("", PlotPoint::new(at[0], at[1]), "knee\u{a0}\u{a0}\u{a0}");
        let text = text.color(colors.ink).anchor(Align2::RIGHT_BOTTOM);
        Some((ring(at, 6.0, colors.ink), Some(text)))
    }

    /// The designs that answer wishes, with their names.
    fn wished<'a>(&self, session: &Session, colors: Colors) -> Vec<LabelledPoints<'a>> {
        let mark = |wished: &Wished| {
            let at = self.place(&Row::new(0, &wished.evaluation));
            let color = theme::modified(colors.dark);
            let points = Points::new("", vec![at]).shape(MarkerShape::Diamond).radius(6.0);
            let name = format!("{}{}", "\u{a0}".repeat(5), wished.name);
            let text = Text::new("", PlotPoint::new(at[0], at[1]), name);
            let text = text.color(colors.ink).anchor(Align2::LEFT_CENTER);
            (points.color(color).allow_hover(false), Some(text))
        };
        session.document().wished.iter().map(mark).collect()
    }

    /// The point of which the user asks why it cannot be had, if it has a place on both axes.
    fn why<'a>(&self, session: &Session, colors: Colors) -> Option<LabelledPoints<'a>> {
        let point = session.why_point()?;
        let first = session
            .study()
            .objectives()
            .first()
            .map(|objective| objective.quantity)?;
        let place = |axis: ScatterAxis| {
            let Column::Quantity(quantity) = axis.quantity else {
                return None;
            };
            let held = point
                .held
                .iter()
                .find(|(other, _)| *other == quantity)
                .map(|(_, value)| *value);
            let value = held.or(Some(point.wished).filter(|_| quantity == first))?;
            Some(axis.place(value))
        };
        let [Some(x), Some(y)] = self.axes.map(place) else {
            return None;
        };
        let text = Text::new("", PlotPoint::new(x, y), format!("{}why not?", "\u{a0}".repeat(5)));
        let points = Points::new("", vec![[x, y]]).shape(MarkerShape::Cross).radius(6.0);
        Some((
            points.color(colors.ink).allow_hover(false),
            Some(text.color(colors.ink).anchor(Align2::LEFT_CENTER)),
        ))
    }

    /// The reference designs where this model places them (star), joined to where their source states them (ring).
    fn add_references<'a>(
        &self,
        session: &Session,
        colors: Colors,
        lines: &mut Vec<Line<'a>>,
        marks: &mut Vec<LabelledPoints<'a>>,
    ) {
        for reference in session.references() {
            let at = self.place(&Row::new(0, &reference.evaluation));
            let stated = |axis: ScatterAxis| {
                let mut stated = reference.stated.iter();
                let (_, value) = stated.find(|(quantity, _)| axis.quantity == Column::Quantity(*quantity))?;
                Some(axis.place(*value))
            };
            if let [Some(x), Some(y)] = self.axes.map(stated) {
                let stated = [x, y];
                let line = Line::new("", PlotPoints::from(vec![stated, at]))
                    .color(theme::mix(colors.ink, colors.ground, 0.6))
                    .style(LineStyle::dashed_dense())
                    .width(1.0)
                    .allow_hover(false);
                lines.push(line);
                marks.push((ring(stated, 4.0, theme::mix(colors.ink, colors.ground, 0.7)), None));
            }
            let name = format!("{}{}", "\u{a0}".repeat(6), reference.name);
            let text = Text::new("", PlotPoint::new(at[0], at[1]), name);
            let points = Points::new("", vec![at]).shape(MarkerShape::Asterisk).radius(6.0);
            marks.push((
                points.color(colors.ink).allow_hover(false),
                Some(text.color(colors.ink).anchor(Align2::LEFT_CENTER)),
            ));
        }
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
