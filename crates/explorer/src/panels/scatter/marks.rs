//! Marks drawn over the cloud: the front, its knee, the references, and the selected design.

use egui::{Align2, Color32};
use egui_plot::{Line, LineStyle, MarkerShape, PlotPoints, Points, Text};
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
            let places = own.map(|entry| self.place(&entry.row)).collect();
            let color = theme::architecture(architecture, colors.dark);
            let points = points(places, theme::mark(architecture), 3.5, color);
            marks.push((points.filled(false), None));
        }
        // The last design of a front lies at its end, where there is room for a name.
        if let Some(last) = beside.front.last() {
            let at = self.place(&last.row);
            let end = points(vec![at], MarkerShape::Circle, 2.0, ink);
            marks.push((end, Some(text_before(at, &beside.name, colors.ink))));
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
            let shape = theme::mark(entry.row.design.architecture());
            Some((points(vec![self.place(&entry.row)], shape, 4.0, color), None))
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
            let places = session
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
            (points(places, theme::mark(architecture), 4.0, color), None)
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
                    let dots = Text::new("", at.into(), "◌").color(ink);
                    marks.push((ring(at, 0.0, ink), Some(dots)));
                }
                None => {}
            }
        }
        let rings = points(proved, MarkerShape::Circle, 5.5, ink);
        marks.push((rings.filled(false), None));
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
        Some((ring(at, 6.0, colors.ink), Some(text_before(at, "knee", colors.ink))))
    }

    /// The designs that answer wishes, with their names.
    fn wished<'a>(&self, session: &Session, colors: Colors) -> Vec<LabelledPoints<'a>> {
        let mark = |wished: &Wished| {
            let at = self.place(&Row::new(0, &wished.evaluation));
            let diamond = points(vec![at], MarkerShape::Diamond, 6.0, theme::modified(colors.dark));
            (diamond, Some(text_after(at, 5, &wished.name, colors.ink)))
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
        let [x, y] = self.axes.map(place);
        let at = [x?, y?];
        let cross = points(vec![at], MarkerShape::Cross, 6.0, colors.ink);
        Some((cross, Some(text_after(at, 5, "why not?", colors.ink))))
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
            let star = points(vec![at], MarkerShape::Asterisk, 6.0, colors.ink);
            marks.push((star, Some(text_after(at, 6, &reference.name, colors.ink))));
        }
    }
}

fn points<'a>(at: Vec<[f64; 2]>, shape: MarkerShape, radius: f32, color: Color32) -> Points<'a> {
    let points = Points::new("", at).shape(shape).radius(radius);
    points.color(color).allow_hover(false)
}

fn ring<'a>(at: [f64; 2], radius: f32, color: Color32) -> Points<'a> {
    points(vec![at], MarkerShape::Circle, radius, color).filled(false)
}

/// Writes a text above a mark and before it.
fn text_before(at: [f64; 2], text: &str, color: Color32) -> Text {
    let text = Text::new("", at.into(), format!("{text}\u{a0}\u{a0}\u{a0}"));
    text.color(color).anchor(Align2::RIGHT_BOTTOM)
}

/// Writes a text after a mark, from which `spaces` keep it away.
fn text_after(at: [f64; 2], spaces: usize, text: &str, color: Color32) -> Text {
    let text = Text::new("", at.into(), format!("{}{text}", "\u{a0}".repeat(spaces)));
    text.color(color).anchor(Align2::LEFT_CENTER)
}
