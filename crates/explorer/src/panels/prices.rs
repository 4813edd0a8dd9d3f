//! The prices panel: what drives the first objective along the front.

use std::sync::Arc;

use egui::{Align, ComboBox, Layout, RichText, ScrollArea, Stroke, Ui, WidgetInfo, WidgetType};
use egui_plot::{FilledArea, Line, LineStyle, Plot, PlotBounds, PlotPoints, PlotUi, VLine};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::text;
use kinefront_study::{Column, DriversAlong, ParameterKind, PriceCurve, stacked, usual_range};

use crate::{Session, theme};

/// Least price that is drawn \[% for 1 %\].
const DRAWN: f64 = 0.02;

/// The answer of the session.
type Answer = Arc<Result<Vec<DriversAlong>, String>>;

/// The prices panel.
#[derive(Default)]
pub struct PricesPanel {
    /// The architecture whose front is shown; that of the selected design, or the first one, if `None`.
    architecture: Option<Architecture>,
    /// What was drawn last: it is the same from frame to frame.
    drawn: Option<Drawn>,
}

/// What is drawn of the front of an architecture.
struct Drawn {
    answer: Answer,
    architecture: Architecture,
    /// Prices of the limits, each on top of those before it.
    limits: Vec<PriceCurve>,
    /// Prices of the region, the travels and the bounds.
    others: Vec<PriceCurve>,
    sentences: Vec<String>,
}

impl Drawn {
    fn new(answer: &Answer, along: &DriversAlong) -> Self {
        let drawn = |kinds: &[ParameterKind]| {
            let mut curves = along.curves(kinds);
            curves.retain(|curve| curve.is_usual(DRAWN));
            curves
        };
        Self {
            answer: Arc::clone(answer),
            architecture: along.architecture,
            limits: stacked(&drawn(&[ParameterKind::Limit])),
            others: drawn(&[ParameterKind::Region, ParameterKind::Travel, ParameterKind::Bound]),
            sentences: along.sentences(),
        }
    }

    fn is_of(&self, answer: &Answer, along: &DriversAlong) -> bool {
        Arc::ptr_eq(&self.answer, answer) && self.architecture == along.architecture
    }
}

impl PricesPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if session.front().is_empty() || session.is_running() {
            ui.weak("This panel shows what drives the mass along the front once a run has ended or has been opened.");
            return;
        }
        let Some(answer) = session.drivers_along() else {
            ui.weak("Computing the prices of all designs of the front…");
            return;
        };
        match answer.as_ref() {
            Ok(all) => self.show(ui, session, all, &answer),
            Err(message) => {
                ui.colored_label(theme::bad(ui), message);
            }
        }
    }

    fn show(&mut self, ui: &mut Ui, session: &mut Session, all: &[DriversAlong], answer: &Answer) {
        let selected = session.document().selected_design();
        let wanted = self.architecture.or(selected.map(|design| design.architecture()));
        let has_prices = |along: &&DriversAlong| !along.designs.is_empty();
        let of_wanted = all
            .iter()
            .filter(has_prices)
            .find(|along| Some(along.architecture) == wanted);
        let Some(along) = of_wanted.or_else(|| all.iter().find(has_prices)) else {
            ui.weak("No design of the front has prices: no optimum was found near them.");
            return;
        };
        self.choose(ui, all, along);
        let known = self.drawn.take().filter(|drawn| drawn.is_of(answer, along));
        let drawn = self.drawn.insert(known.unwrap_or_else(|| Drawn::new(answer, along)));
        if along.designs.len() < 2 {
            sentences(ui, &drawn.sentences);
            return;
        }
        let height = (ui.available_height() - 4.0).max(120.0);
        ui.columns(3, |columns| {
            if let [limits, others, words] = columns {
                plots([limits, others], session, along, drawn, height);
                ScrollArea::vertical()
                    .id_salt("sentences")
                    .show(words, |ui| sentences(ui, &drawn.sentences));
            }
        });
    }

    /// Shows the choice of the architecture, if there are several.
    fn choose(&mut self, ui: &mut Ui, all: &[DriversAlong], along: &DriversAlong) {
        if all.len() < 2 {
            return;
        }
        ui.horizontal(|ui| {
            let label = ui.label("front of the");
            ComboBox::from_id_salt("architecture of prices")
                .selected_text(text::architecture(along.architecture))
                .show_ui(ui, |ui| {
                    for other in all.iter().filter(|other| !other.designs.is_empty()) {
                        let is_shown = other.architecture == along.architecture;
                        if ui
                            .selectable_label(is_shown, text::architecture(other.architecture))
                            .clicked()
                        {
                            self.architecture = Some(other.architecture);
                        }
                    }
                })
                .response
                .labelled_by(label.id);
        });
    }
}

fn sentences(ui: &mut Ui, sentences: &[String]) {
    ui.with_layout(Layout::top_down(Align::Min), |ui| {
        for sentence in sentences {
            ui.label(sentence);
        }
    });
}

/// Draws the prices of the limits as areas, and those of the region, the travels and the bounds as lines.
fn plots([limits, others]: [&mut Ui; 2], session: &mut Session, along: &DriversAlong, drawn: &Drawn, height: f32) {
    let place = place_of_selected(session, along);
    let mut clicked = None;
    for (ui, name, curves, is_stacked) in [
        (limits, "Prices of the limits", &drawn.limits, true),
        (
            others,
            "Prices of the region, the travels and the bounds",
            &drawn.others,
            false,
        ),
    ] {
        let top = ui.cursor().top();
        ui.with_layout(Layout::top_down(Align::Min), |ui| ui.label(name));
        legend(ui, curves);
        let plot = Plot::new(name)
            .height((height - (ui.cursor().top() - top)).max(80.0))
            .x_axis_label(Column::Quantity(along.along).title())
            .y_axis_label("% for 1 %")
            .allow_scroll(false)
            .allow_drag(false)
            .allow_zoom(false)
            .include_y(0.0);
        let [low, high] = usual_range(curves);
        let weak = ui.visuals().weak_text_color();
        let [first, last] = ends(along);
        let shown = plot.show(ui, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([first, low], [last, high.max(low + 1e-3)]));
            match is_stacked {
                true => areas(plot, curves),
                false => lines(plot, curves),
            }
            for crossing in &along.crossings {
                let line = VLine::new("", crossing.at).color(weak);
                plot.vline(line.style(LineStyle::dashed_loose()).allow_hover(false));
            }
            if let Some(at) = place {
                plot.vline(VLine::new("", at).color(theme::SELECTED).allow_hover(false));
            }
        });
        let response = shown.response;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, name));
        if response.clicked()
            && let Some(pointer) = response.interact_pointer_pos()
        {
            clicked = Some(shown.transform.value_from_position(pointer).x);
        }
    }
    if let Some(at) = clicked {
        select_nearest(session, along, at);
    }
}

/// Returns the places of the first and the last design along the front, or of the change of architecture before or after it.
fn ends(along: &DriversAlong) -> [f64; 2] {
    let designs = along.designs.iter().map(|(_, at, _)| *at);
    let crossings = along.crossings.iter().map(|crossing| crossing.at);
    super::range(designs.chain(crossings))
}

/// Names the curves in their colours.
fn legend(ui: &mut Ui, curves: &[PriceCurve]) {
    ui.horizontal_wrapped(|ui| {
        for (index, curve) in curves.iter().enumerate() {
            let words = format!("■ {}", curve.label).replace(' ', "\u{a0}");
            ui.label(RichText::new(words).color(theme::legible(theme::series(index), ui)));
        }
    });
}

/// Draws areas, each on top of those before it.
fn areas(plot: &mut PlotUi<'_>, curves: &[PriceCurve]) {
    let Some(first) = curves.first() else { return };
    let places: Vec<f64> = first.points.iter().map(|[at, _]| *at).collect();
    let mut below = vec![0.0; places.len()];
    for (index, curve) in curves.iter().enumerate() {
        let top: Vec<f64> = curve.points.iter().map(|[_, top]| *top).collect();
        let area = FilledArea::new(&curve.label, &places, &below, &top)
            .fill_color(theme::series(index).gamma_multiply(0.75))
            .stroke(Stroke::new(1.0, theme::series(index)));
        plot.add(area);
        below = top;
    }
}

fn lines(plot: &mut PlotUi<'_>, curves: &[PriceCurve]) {
    for (index, curve) in curves.iter().enumerate() {
        let line = Line::new(&curve.label, PlotPoints::from(curve.points.clone()));
        plot.line(line.color(theme::series(index)).width(1.6));
    }
}

/// Returns where the selected design of the run is along the front.
fn place_of_selected(session: &Session, along: &DriversAlong) -> Option<f64> {
    let document = session.document();
    let is_along = document.selected_design()?.architecture() == along.architecture;
    let id = document.selected_id().filter(|_| is_along)?;
    session.number(id, Column::Quantity(along.along))
}

/// Selects the design of the front that is nearest to a place along it.
fn select_nearest(session: &mut Session, along: &DriversAlong, at: f64) {
    let nearest = along
        .designs
        .iter()
        .min_by(|a, b| (a.1 - at).abs().total_cmp(&(b.1 - at).abs()));
    let id = nearest.and_then(|(index, _, _)| session.front().get(*index).map(|entry| entry.id));
    if let Some(id) = id {
        session.select(id);
    }
}
