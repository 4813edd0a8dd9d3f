//! The inspector: all results of the selected design, and sliders that modify its dimensions.

use egui::{Color32, Grid, RichText, ScrollArea, Sense, Slider, Ui, Vec2, WidgetInfo, WidgetType};
use kinefront_scene::text;

use super::{add_named, button, named, what_if};
use crate::{Known, Session, theme};
use kinefront_model::certify::Verdict;
use kinefront_model::evaluation::{ConstraintResult, Quantity};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable};
use kinefront_scene::Part;

/// The inspector panel.
#[derive(Default)]
pub struct Inspector;

impl Inspector {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(selected) = session.document().selected.clone() else {
            ui.weak("Click a design in the scatter, or step along the front with the arrow keys.");
            return;
        };
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            heading(ui, session);
            sliders(ui, session, &selected.design);
            ui.separator();
            match session.known().cloned() {
                Some(known) => {
                    what_if::verdict(ui, session, &known);
                    objectives(ui, session, &known);
                    proof(ui, session);
                    ui.separator();
                    constraints(ui, session, &known);
                }
                None => {
                    ui.weak("evaluating…");
                }
            }
        });
    }
}

fn heading(ui: &mut Ui, session: &mut Session) {
    let name = session.selected_name().unwrap_or_default();
    let Some(selected) = session.document().selected.clone() else {
        return;
    };
    ui.horizontal_wrapped(|ui| {
        ui.heading(format!("{} {name}", text::architecture(selected.design.architecture())));
        if session.is_modified() {
            ui.colored_label(theme::modified(ui.visuals().dark_mode), "modified design");
            if button(ui, "Keep", "adds the modified design to the kept designs") {
                session.keep();
            }
            what_if::back(ui, session);
        }
    });
    ui.horizontal_wrapped(|ui| {
        let pinned = session.document().pins.iter().any(|pin| pin.design == selected.design);
        let pin = ui.add(theme::toggle(pinned, "📌 Pin"));
        let hint = "pins this design for comparison, up to four designs (P)";
        if pin.on_hover_text(hint).clicked() {
            session.toggle_pin();
        }
        if button(ui, "Copy", "copies the design as text (Ctrl+C)") {
            ui.ctx().copy_text(selected.design.to_string());
        }
        if let crate::DesignOrigin::Evaluated(id) = selected.origin {
            let starred = session.document().stars.contains(&id);
            let star = ui.add(theme::toggle(starred, if starred { "★" } else { "☆" }));
            if named(star, "Star or unstar this design (S)").clicked() {
                session.toggle_star();
            }
            let mut note = session.document().notes.get(&id).cloned().unwrap_or_default();
            let field = egui::TextEdit::singleline(&mut note);
            if add_named(ui, field.hint_text("note").desired_width(140.0), "Note").changed() {
                session.drag("note", |document| {
                    if note.is_empty() {
                        document.notes.remove(&id);
                    } else {
                        document.notes.insert(id, note);
                    }
                });
            }
        }
    });
}

/// Range of a slider for a variable that has no bounds in the study.
fn usual_range(variable: DesignVariable) -> Option<[f64; 2]> {
    match variable {
        DesignVariable::RailAngle => Some([-90.0, 90.0]),
        DesignVariable::GuideAngle => Some([30.0, 150.0]),
        DesignVariable::PlatformGuideAngle => Some([-180.0, 180.0]),
        _ => None,
    }
}

fn sliders(ui: &mut Ui, session: &mut Session, design: &Design) {
    let study = session.study().clone();
    let original = what_if::original(session).map(|(_, row)| row.design);
    let further = design.architecture().further_variables().iter().copied();
    for variable in DESIGN_VARIABLES.into_iter().chain(further) {
        let [low, high] = match usual_range(variable) {
            Some(usual) if !study.bounds.further_variables().any(|bounded| bounded == variable) => usual,
            _ => study.range(variable),
        };
        let mut value = design.value(variable);
        // A design that does not come from the run may lie outside the study's bounds.
        let range = low.min(value)..=high.max(value);
        let thin = variable.may_be_zero();
        ui.horizontal(|ui| {
            ui.add_sized([34.0, 18.0], egui::Label::new(variable.symbol()));
            ui.spacing_mut().slider_width = (ui.available_width() - 90.0).max(60.0);
            let slider = Slider::new(&mut value, range)
                .custom_formatter(move |value, _| text::variable_value(variable, value))
                .custom_parser(move |text| {
                    let text = text.trim();
                    if variable.is_angle() {
                        return text.trim_end_matches('°').trim().parse().ok();
                    }
                    let (number, unit) = match text.strip_suffix("mm") {
                        Some(number) => (number, 1e-3),
                        None => (text.strip_suffix('m').unwrap_or(text), if thin { 1e-3 } else { 1.0 }),
                    };
                    Some(number.trim().parse::<f64>().ok()? * unit)
                });
            if add_named(ui, slider, variable.symbol()).changed() {
                session.modify(variable, value);
            }
        });
        what_if::change(ui, variable, value, original.as_ref());
    }
}

/// Quantities that the inspector shows elsewhere.
const HAVE_ROWS: [Quantity; 4] = [
    Quantity::Mass,
    Quantity::WorkspaceRadius,
    Quantity::LegsMass,
    Quantity::PlatformMass,
];

fn objectives(ui: &mut Ui, session: &Session, known: &Known) {
    let evaluation = &known.evaluation;
    let model = session.model();
    Grid::new("objectives").num_columns(2).show(ui, |ui| {
        ui.label("mass in motion");
        ui.strong(format!("{} kg", theme::number(evaluation.mass())));
        ui.end_row();
        let region = &model.settings().workspace.region;
        ui.label(if region.is_prescribed() { "region" } else { "R_w" });
        ui.horizontal(|ui| workspace(ui, session, known));
        ui.end_row();
        for [part, bar] in text::selected_parts(model, evaluation) {
            ui.label(part);
            ui.label(bar);
            ui.end_row();
        }
        for quantity in Quantity::all().filter(|quantity| !HAVE_ROWS.contains(quantity)) {
            let entry = quantity.entry();
            let known = evaluation.quantities.get(quantity);
            if let Some(value) = known.filter(|_| quantity.constraint().is_none()) {
                ui.label(entry.label).on_hover_text(entry.meaning);
                ui.label(format!("{} {}", theme::number(value), entry.unit));
                ui.end_row();
            }
        }
        if let Some(phi) = evaluation.home_phi_deg {
            ui.label("home orientation φ_c");
            ui.label(format!(
                "{phi}° ± {}°",
                0.5 * model.settings().workspace.rotation_range_deg
            ));
            ui.end_row();
        }
    });
    let design = &evaluation.design;
    masses(ui, [model.legs_mass(design), model.platform_mass(design)]);
}

/// Shows the workspace of the selected design, whether it is feasible, and how it was examined.
fn workspace(ui: &mut Ui, session: &Session, known: &Known) {
    let evaluation = &known.evaluation;
    let region = &session.model().settings().workspace.region;
    let certified = session.certified().filter(|_| known.verified);
    if evaluation.home.is_some() && region.is_prescribed() {
        ui.strong(text::region(region));
    } else if evaluation.home.is_some() {
        let proved = certified.filter(|certified| !certified.is_of_region);
        let radius = proved.map_or(evaluation.workspace_radius(), |certified| certified.lower);
        ui.strong(format!("{} m", theme::number(radius)));
    } else {
        ui.colored_label(theme::bad(ui), "infeasible: no regular workspace");
    }
    if let Some(limit) = evaluation.limits.iter().find(|limit| limit.margin < 0.0) {
        let entry = limit.limit.quantity.entry();
        ui.colored_label(theme::bad(ui), format!("infeasible: {} beyond its limit", entry.label));
    }
    ui.weak(match (certified, known.verified) {
        (Some(certified), _) => certified.state(),
        (None, true) => "fine grid",
        (None, false) => "reference grid, verifying…",
    });
}

/// Shows the masses of legs and platform \[kg\] as a bar in two colours.
fn masses(ui: &mut Ui, [legs, platform]: [f64; 2]) {
    let total = (legs + platform).max(f64::MIN_POSITIVE);
    let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 14.0), Sense::hover());
    let split = rect.left() + rect.width() * (legs / total) as f32;
    let painter = ui.painter_at(rect);
    let [of_legs, of_platform] = [Part::Crank, Part::PlatformBar].map(|part| theme::part(part, ui.visuals().dark_mode));
    painter.rect_filled(rect.with_max_x(split), 2.0, of_legs);
    painter.rect_filled(rect.with_min_x(split), 2.0, of_platform);
    ui.horizontal(|ui| {
        ui.colored_label(of_legs, format!("legs {} kg", theme::number(legs)));
        ui.colored_label(of_platform, format!("platform {} kg", theme::number(platform)));
    });
}

/// Shows what is proved about the workspace, and leads to the infeasible pose that ends it.
fn proof(ui: &mut Ui, session: &mut Session) {
    if !session.study().workspace.certify {
        return;
    }
    let Some(proof) = session.proof().cloned() else {
        if session.known().is_some_and(|known| known.evaluation.is_feasible()) {
            ui.weak("proving the workspace…");
        }
        return;
    };
    let certificate = &proof.certificate;
    let Some((color, verdict)) = what_if::proof_in_a_word(ui, session) else {
        return;
    };
    let mut has_asked = false;
    ui.horizontal_wrapped(|ui| {
        if proof.claim.is_of_region {
            ui.label("the region is")
                .on_hover_text("that every pose of it is feasible");
            ui.colored_label(color, RichText::new(verdict).strong());
        } else {
            ui.label("R_w is");
            ui.colored_label(color, RichText::new(verdict).strong());
            let upper = certificate.upper.map_or("∞".to_owned(), |upper| format!("{upper:.5}"));
            ui.label(format!("R* in [{:.5}, {upper}] m", certificate.lower))
                .on_hover_text("every pose closer to the centre than the first value is feasible; a pose at the second value is not");
        }
        if let Some(violation) = proof.certificate.violation {
            let hover = "moves the platform to the infeasible pose, and shows the boxes of the proof";
            // Beyond a region that is proved, nothing is violated that was asked for.
            let id = violation.scalar.limit_id();
            let words = match certificate.verdict {
                Verdict::Proved => format!("weakest pose for {id}"),
                _ => format!("pose that violates {id}"),
            };
            has_asked = ui.small_button(words).on_hover_text(hover).clicked();
        }
    });
    if has_asked {
        session.show_violation();
    }
}

fn constraints(ui: &mut Ui, session: &mut Session, known: &Known) {
    ui.label("constraints: worst value over the workspace, relative to the threshold");
    let mut worst = None;
    Grid::new("constraints")
        .num_columns(4)
        .spacing([8.0, 4.0])
        .show(ui, |ui| {
            for report in &known.evaluation.constraints {
                let name = report.constraint.name().replace('_', " ");
                if !report.required {
                    ui.weak(report.constraint.id());
                    ui.weak(format!("{name}, not required"));
                } else if report.active {
                    ui.colored_label(theme::active(ui), report.constraint.id());
                    ui.colored_label(theme::active(ui), format!("{name}, active"));
                } else {
                    ui.label(report.constraint.id());
                    ui.label(name);
                }
                margin_bar(ui, report);
                let hover = "moves the platform to the pose with the worst value";
                if report.pose.is_some() && ui.small_button("pose").on_hover_text(hover).clicked() {
                    worst = Some(report.constraint);
                }
                ui.end_row();
            }
        });
    if let Some(nearest) = &known.evaluation.nearest {
        let words = format!("nearest pair of members: {}", text::clearance(nearest));
        if nearest.distance < 0.0 {
            ui.colored_label(theme::bad(ui), words);
        } else {
            ui.weak(words);
        }
    }
    if let Some(constraint) = worst {
        session.show_worst(constraint);
    }
}

/// Draws a margin as a bar that begins at the threshold and extends to the right if the constraint is satisfied.
fn margin_bar(ui: &mut Ui, report: &ConstraintResult) {
    const WIDTH: f32 = 96.0;
    let (rect, response) = ui.allocate_exact_size(Vec2::new(WIDTH, 14.0), Sense::hover());
    let painter = ui.painter_at(rect);
    let middle = rect.left() + 0.3 * WIDTH;
    painter.rect_filled(rect, 2.0, Color32::from_gray(128).gamma_multiply(0.25));
    // Compresses the absolute margin into [0, 1): 1 takes half of the width, and large margins differ little.
    let fraction = |margin: f64| (margin.abs() / (1.0 + margin.abs())) as f32;
    let color = if !report.required {
        Color32::from_gray(128)
    } else if report.margin < 0.0 {
        theme::bad(ui)
    } else if report.active {
        theme::active(ui)
    } else {
        theme::good(ui)
    };
    let bar = if report.margin < 0.0 {
        rect.with_max_x(middle)
            .with_min_x(middle - fraction(report.margin) * 2.0 * 0.3 * WIDTH)
    } else {
        rect.with_min_x(middle)
            .with_max_x(middle + fraction(report.margin).max(0.01) * 0.7 * WIDTH)
    };
    painter.rect_filled(bar, 2.0, color);
    painter.vline(middle, rect.y_range(), (1.0, theme::ink(ui)));
    let unit = report.constraint.unit();
    let text = format!(
        "{}: worst value {} {unit}, threshold {} {unit}, margin {:+.1} %",
        report.constraint.id(),
        report.value.map_or_else(|| "none".to_owned(), theme::number),
        theme::number(report.threshold),
        100.0 * report.margin
    );
    let label = text.clone();
    response
        .on_hover_text(text)
        .widget_info(|| WidgetInfo::labeled(WidgetType::ProgressIndicator, true, label.clone()));
}
