//! The drivers panel: what each requirement, bound and property of the material costs at the selected design.

use egui::{Align2, Color32, FontId, Rect, ScrollArea, Sense, Ui, WidgetInfo, WidgetType, vec2};
use kinefront_model::spatial::Pose;
use kinefront_scene::text::{self, number};
use kinefront_study::{Drivers, PriceJson};

use super::range;
use crate::{Session, theme};

/// Prices below this \[% for 1 %\] are told as free.
const FREE: f64 = 0.01;

/// Height of a bar with its texts.
const ROW: f32 = 22.0;

/// The drivers panel.
#[derive(Default)]
pub struct DriversPanel;

impl DriversPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(name) = session.selected_name() else {
            ui.weak("Click a design in the scatter to see what each requirement costs it.");
            return;
        };
        let Some(answer) = session.drivers() else {
            ui.weak(format!("{name}: waiting for the fine grid and the prices…"));
            return;
        };
        match answer.as_ref() {
            Ok(drivers) => {
                let stepped = session.drivers_with_steps();
                let stepped = stepped.as_ref().and_then(|stepped| stepped.as_ref().as_ref().ok());
                ScrollArea::vertical()
                    .show(ui, |ui| show(ui, session, &name, stepped.unwrap_or(drivers)))
                    .inner
            }
            Err(message) => {
                ui.label(format!("{name} has no prices:"));
                ui.colored_label(theme::bad(ui), message);
            }
        }
    }
}

fn show(ui: &mut Ui, session: &mut Session, name: &str, drivers: &Drivers) {
    let (objective, unit) = drivers.objective_name();
    ui.strong(format!("{name}: change of the {objective} for +1 % of each"));
    let excess = 100.0 * drivers.excess;
    ui.weak(if excess.abs() < 0.005 {
        format!(
            "This design is a local optimum: {} {unit}.",
            number(drivers.polished_value)
        )
    } else {
        format!(
            "The prices are those of the best design near this one, with {} {unit}; this design is {excess:+.2} % off.",
            number(drivers.polished_value)
        )
    });
    let prices = drivers.dear(FREE);
    let largest = prices.iter().fold(0.0f64, |most, price| most.max(price.price.abs()));
    ui.add_space(4.0);
    for price in prices {
        if bar(ui, price, largest, drivers, (objective, unit))
            && let Some(pose) = critical_pose(drivers, price)
        {
            session.view_mut().pose = Some(pose);
        }
    }
    ui.add_space(6.0);
    ui.weak("Outlines show the prices if only the bars change, whiskers those of steps up to 20 %. Click a bar to see the pose that determines its price.");
    if !drivers.alternatives.is_empty() {
        ui.strong(format!("Change of the {objective} with the next entry of a list"));
    }
    for other in &drivers.alternatives {
        ui.label(match other.change {
            Some(change) => format!("{}: {:+.2} %", other.label, 100.0 * change),
            None => format!("{}: no design is feasible", other.label),
        });
    }
    let free = drivers.free(FREE);
    if !free.is_empty() {
        ui.label(format!("Practically free: {}.", free.join(", ")));
    }
    for inactive in &drivers.inactive {
        ui.weak(format!(
            "{}: may rise by {}",
            inactive.label,
            text::slack(inactive.slack)
        ));
    }
    for warning in &drivers.warnings {
        ui.colored_label(theme::bad(ui), warning);
    }
}

/// Draws a price as a bar, to the right if more costs mass, to the left if it saves mass; returns whether it was clicked.
fn bar(ui: &mut Ui, price: &PriceJson, largest: f64, drivers: &Drivers, (objective, unit): (&str, &str)) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let share = if price.kink {
        format!("{:+.2} … {:+.2} %", price.below, price.above)
    } else {
        format!("{:+.2} %", price.price)
    };
    let in_unit = format!("{:+.3} {unit}", 0.01 * price.price * drivers.polished_value);
    let words = format!("{}: {share} of the {objective} for +1 %, {in_unit}", price.label);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &words));
    if response.hovered() {
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 2.0, ui.visuals().widgets.hovered.weak_bg_fill);
    }
    paint_bar(ui, rect, price, largest, &share);
    let cannot = match price.bars_cannot_repair.as_slice() {
        [] => String::new(),
        ways => format!("\nThicker bars cannot offset a change {}.", ways.join(" or ")),
    };
    let value = price.value.map_or(String::new(), |value| {
        format!("\nIts value is {} {}.", number(value), price.unit)
    });
    let steps = steps_in_words(price);
    response
        .on_hover_text(format!("{words}{value}{cannot}{steps}"))
        .clicked()
}

/// Paints a price with its label and `share`, the bar as a part of the largest price. An outline is the price with the bars alone, a line the
/// range of finite steps.
fn paint_bar(ui: &Ui, rect: Rect, price: &PriceJson, largest: f64, share: &str) {
    let painter = ui.painter_at(rect);
    let ink = theme::ink(ui);
    let font = FontId::proportional(12.0);
    let label_width = 0.38 * rect.width();
    let text_width = 0.24 * rect.width();
    painter.text(
        rect.left_center() + vec2(2.0, 0.0),
        Align2::LEFT_CENTER,
        &price.label,
        font.clone(),
        ink,
    );
    painter.text(
        rect.right_center() - vec2(2.0, 0.0),
        Align2::RIGHT_CENTER,
        share,
        font,
        ink,
    );
    let area = Rect::from_min_max(
        rect.left_top() + vec2(label_width, 4.0),
        rect.right_bottom() - vec2(text_width, 4.0),
    );
    let middle = area.center().x;
    let reach = |value: f64| (0.5 * f64::from(area.width()) * value / largest.max(1e-12)) as f32;
    let from_middle = |value: f64| {
        let end = middle + reach(value);
        Rect::from_x_y_ranges(middle.min(end)..=middle.max(end), area.y_range())
    };
    let color: Color32 = if price.price >= 0.0 {
        theme::bad(ui)
    } else {
        theme::good(ui)
    };
    painter.rect_filled(from_middle(price.price), 1.0, color.gamma_multiply(0.8));
    if let Some(of_bars) = price.bars_only {
        let outline = from_middle(of_bars);
        painter.rect_stroke(outline, 1.0, egui::Stroke::new(1.0, ink), egui::StrokeKind::Inside);
    }
    if let Some([least, most]) = range_of_steps(price) {
        let [left, right] = [least, most].map(|value| (middle + reach(value)).clamp(area.left(), area.right()));
        let line = egui::Stroke::new(1.0, ink.gamma_multiply(0.8));
        painter.hline(left..=right, area.center().y, line);
        for end in [left, right] {
            painter.vline(end, area.center().y - 3.0..=area.center().y + 3.0, line);
        }
    }
    painter.vline(middle, area.y_range(), egui::Stroke::new(1.0, ink.gamma_multiply(0.5)));
}

/// Returns the least and the largest price that finite steps give: the change divided by the step.
fn range_of_steps(price: &PriceJson) -> Option<[f64; 2]> {
    let slopes = price.steps.iter().map(|[step, change]| change / step);
    let [least, most] = range(slopes);
    (least <= most).then_some([least, most])
}

/// Tells what finite steps change.
fn steps_in_words(price: &PriceJson) -> String {
    let percent = |log: f64| 100.0 * (libm::exp(log) - 1.0);
    let steps = price.steps.iter();
    let steps =
        steps.map(|[step, change]| format!("\n{:+.0} % changes it by {:+.2} %", percent(*step), percent(*change)));
    steps.collect()
}

/// Returns the pose at which a requirement is active: the one with the largest multiplier.
fn critical_pose(drivers: &Drivers, price: &PriceJson) -> Option<Pose> {
    let is_of =
        |constraint: &str| constraint == price.parameter || constraint.contains(&format!(":{}:", price.parameter));
    let own = drivers.active.iter().filter(|active| is_of(&active.constraint));
    // The size of the region and the rotation range are paid at the poses of all requirements.
    let of_region = ["workspace_radius", "width", "height", "rotation_range"].contains(&price.parameter.as_str());
    let all = drivers.active.iter().filter(|_| of_region);
    let dearest = own.chain(all).max_by(|a, b| a.multiplier.total_cmp(&b.multiplier))?;
    let [x, y, phi_deg] = dearest.pose;
    Some(Pose::new(x, y, phi_deg.to_radians()))
}
