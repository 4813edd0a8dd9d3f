//! What the window draws over its 3-D view: the legend of the heatmap, the viewpoints, and what the pointer is over.

use egui::{Align2, Color32, ComboBox, FontId, Frame, Id, Pos2, Rect, Sense, Stroke, Ui, vec2};

use super::pointing::Description;
use super::{Session, theme};
use kinefront_recording::{Viewpoint, VisibleLayers};
use kinefront_scene::palette;
use kinefront_scene::text::{self, number, short};
use kinefront_scene::{ColorMap, Field, FieldLegend, StressLegend};

/// Width and height of the colour bar \[points\].
const BAR: egui::Vec2 = vec2(14.0, 150.0);

/// Width of the legend \[points\].
const LEGEND_WIDTH: f32 = 118.0;

/// Least width of a pane in which the legend hides nothing but the ground \[points\]. In a narrower one it is a row below the view.
const WIDE: f32 = 600.0;

/// Height of that row, and of the colour bar in it \[points\].
const ROW: f32 = 50.0;
const ROW_BAR: f32 = 12.0;

/// Width of the check box of the legend \[points\].
const LOCK: f32 = 96.0;

/// Least size of a pane over which there is anything \[points\].
const LEAST: egui::Vec2 = vec2(260.0, 240.0);

/// Distance of the overlays from the edges of the view \[points\].
const MARGIN: f32 = 10.0;

/// Height of the viewer's own row of tabs, below which the overlays begin \[points\].
const TABS: f32 = 26.0;

/// Height of the row of viewpoints with the gap below it \[points\].
const VIEWPOINTS: f32 = 40.0;

/// Returns the part of a pane that the 3-D view has: all of it, or what a row with the legend leaves of it.
pub fn view_in(pane: Rect, session: &Session) -> Rect {
    // Pinned designs have no heatmap.
    let has_legend = !session.view().comparing && session.legend().is_some();
    let has_row = has_legend && (LEAST.x..WIDE).contains(&pane.width()) && pane.height() >= LEAST.y + ROW;
    if has_row {
        pane.with_max_y(pane.bottom() - ROW)
    } else {
        pane
    }
}

/// Draws the overlays over the view, which is a part of `pane`.
pub fn ui(ui: &mut Ui, pane: Rect, view: Rect, session: &mut Session, pointed: Option<&Description>) {
    if view.width() < LEAST.x || view.height() < LEAST.y {
        return;
    }
    let below_tabs = view.with_min_y(view.top() + TABS).shrink(MARGIN);
    // Pinned designs have neither a heatmap nor a viewpoint of their own.
    if !session.view().comparing {
        viewpoints(ui, below_tabs, session);
        if let Some(legend) = session.legend().copied() {
            let fields = session.fields();
            let layers = &mut session.view_mut().layers;
            if view == pane {
                legend_over_view(ui, below_tabs, &legend, &fields, layers);
            } else {
                let row = pane.with_min_y(view.bottom()).shrink2(vec2(MARGIN, 4.0));
                legend_in_row(ui, row, &legend, &fields, layers);
            }
        }
    }
    if let Some(legend) = session.stress_legend().filter(|_| !session.view().comparing) {
        let below_viewpoints = below_tabs.with_min_y(below_tabs.top() + VIEWPOINTS);
        boxed(ui, "stress", Align2::LEFT_TOP, below_viewpoints, |ui| {
            ui.label(stress_words(&legend));
        });
    }
    if session.document().selected.is_none() {
        boxed(ui, "empty", Align2::CENTER_TOP, below_tabs, |ui| {
            ui.weak(
                "The selected design is shown here: click one in the scatter, or press K for the knee of the front.",
            );
        });
    }
    if let Some(reason) = session.stopped() {
        boxed(ui, "stopped", Align2::CENTER_BOTTOM, below_tabs, |ui| {
            ui.colored_label(theme::bad(ui), format!("stopped: {reason}"));
        });
    }
    if let Some(description) = pointed {
        describe(ui, below_tabs, description);
    }
}

/// Says what the colours of the bars stand for.
fn stress_words(legend: &StressLegend) -> String {
    let of_yield = legend.of_yield.map_or_else(String::new, |share| {
        format!(", {} % of the yield strength", number(100.0 * share))
    });
    format!(
        "stress: dark 0 to bright {} MPa in the {}{of_yield}",
        number(1e-6 * legend.largest),
        text::member(&legend.member)
    )
}

/// Draws a box in a corner of the view.
fn boxed<R>(ui: &mut Ui, id: &str, corner: Align2, area: Rect, content: impl FnOnce(&mut Ui) -> R) -> R {
    let shown = egui::Area::new(Id::new(("scene overlay", id)))
        .order(egui::Order::Middle)
        .pivot(corner)
        .fixed_pos(corner.pos_in_rect(&area))
        .constrain(false)
        .fade_in(false)
        .show(ui.ctx(), |ui| {
            Frame::popup(ui.style())
                .fill(ui.visuals().panel_fill.gamma_multiply(0.94))
                .inner_margin(6)
                .shadow(egui::Shadow::NONE)
                .show(ui, content)
                .inner
        });
    // The place follows from the size in the frame before.
    let is_in_place = corner
        .pos_in_rect(&shown.response.rect)
        .distance(corner.pos_in_rect(&area))
        < 0.5;
    if !is_in_place {
        ui.ctx().request_repaint();
    }
    shown.inner
}

/// Draws a button for each direction from which the manipulator can be seen.
fn viewpoints(ui: &mut Ui, area: Rect, session: &mut Session) {
    boxed(ui, "viewpoints", Align2::LEFT_TOP, area, |ui| {
        ui.horizontal(|ui| {
            for viewpoint in Viewpoint::ALL {
                let hint = "views the whole manipulator from this side";
                if ui.button(viewpoint.name()).on_hover_text(hint).clicked() {
                    session.look_from(viewpoint);
                }
            }
            if let Some(spacing) = session.grid_spacing() {
                ui.weak(format!("grid {} m", short(spacing)));
            }
        });
    });
}

/// Draws the legend of the heatmap over the view.
fn legend_over_view(ui: &mut Ui, area: Rect, legend: &FieldLegend, fields: &[Field], layers: &mut VisibleLayers) {
    boxed(ui, "legend", Align2::RIGHT_TOP, area, |ui| {
        ui.set_max_width(LEGEND_WIDTH);
        choose_field(ui, legend, fields, layers);
        ui.add_space(4.0);
        color_bar(ui, legend);
        lock_range(ui, legend, layers);
    });
}

/// Draws the legend of the heatmap as a row.
fn legend_in_row(ui: &mut Ui, row: Rect, legend: &FieldLegend, fields: &[Field], layers: &mut VisibleLayers) {
    ui.scope_builder(egui::UiBuilder::new().max_rect(row), |ui| {
        ui.horizontal(|ui| {
            choose_field(ui, legend, fields, layers);
            let width = ui.available_width() - LOCK - ui.spacing().item_spacing.x;
            color_row(ui, legend, width.max(60.0));
            lock_range(ui, legend, layers);
        });
    });
}

/// Lets the user choose the field of the heatmap, or none.
fn choose_field(ui: &mut Ui, legend: &FieldLegend, fields: &[Field], layers: &mut VisibleLayers) {
    ComboBox::from_id_salt("field of the heatmap")
        .selected_text(legend.field.title())
        .width(LEGEND_WIDTH)
        .truncate()
        .show_ui(ui, |ui| {
            for &other in fields {
                ui.selectable_value(&mut layers.heatmap, Some(other), other.title());
            }
            ui.selectable_value(&mut layers.heatmap, None, "no heatmap");
        });
}

/// Lets the user lock the range of the colours.
fn lock_range(ui: &mut Ui, legend: &FieldLegend, layers: &mut VisibleLayers) {
    let field = legend.field;
    let mut locked = layers.locked.is_some_and(|(of, _)| of == field);
    let hint = "keeps the colour scale, so that designs can be compared by colour";
    if ui.checkbox(&mut locked, "lock range").on_hover_text(hint).changed() {
        layers.locked = locked.then_some((field, legend.map.range()));
    }
}

/// Number of strips of one colour of which a colour bar consists.
const STEPS: u32 = 75;

/// Returns the colours of a bar, each with its range of places from 0 to 1.
fn strips() -> impl Iterator<Item = (Color32, [f64; 2])> {
    (0..STEPS).map(|step| {
        let [low, high] = [step, step + 1].map(|step| f64::from(step) / f64::from(STEPS));
        let [r, g, b] = ColorMap::at(0.5 * (low + high));
        (Color32::from_rgb(r, g, b), [low, high])
    })
}

/// Returns the stroke that marks the threshold.
fn threshold_mark() -> Stroke {
    let [r, g, b] = palette::THRESHOLD;
    Stroke::new(2.0, Color32::from_rgb(r, g, b))
}

/// Gives a colour bar its name for assistive technology.
fn name_colors(response: &egui::Response, legend: &FieldLegend) {
    let threshold = short(legend.threshold * legend.field.display_factor());
    let label = match legend.map.place(legend.threshold) {
        Some(_) => format!("threshold {threshold}"),
        None => format!("threshold {threshold}, outside the range"),
    };
    let title = format!("colours of {}, {label}", legend.field.title());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Image, true, &title));
}

/// Draws the colours of a field from the bottom to the top, with ticks and the threshold.
pub fn color_bar(ui: &mut Ui, legend: &FieldLegend) {
    let (rect, response) = ui.allocate_exact_size(vec2(LEGEND_WIDTH, BAR.y + 12.0), Sense::hover());
    let bar = Rect::from_min_size(rect.left_top() + vec2(0.0, 6.0), BAR);
    let at = |fraction: f64| bar.bottom() - fraction as f32 * bar.height();
    let painter = ui.painter();
    for (color, [low, high]) in strips() {
        let strip = Rect::from_min_max(Pos2::new(bar.left(), at(high)), Pos2::new(bar.right(), at(low) + 0.5));
        painter.rect_filled(strip, 0.0, color);
    }
    let (ink, font) = (ui.visuals().text_color(), FontId::proportional(12.0));
    let factor = legend.field.display_factor();
    let threshold = legend.map.place(legend.threshold);
    for (value, fraction) in legend.map.ticks() {
        let y = at(fraction);
        painter.hline(bar.right()..=bar.right() + 4.0, y, Stroke::new(1.0, ink));
        // The threshold has its own label, which must stay legible.
        if threshold.is_none_or(|place| (at(place) - y).abs() > 9.0) {
            let place = Pos2::new(bar.right() + 7.0, y);
            painter.text(place, Align2::LEFT_CENTER, short(value * factor), font.clone(), ink);
        }
    }
    if let Some(fraction) = threshold {
        let y = at(fraction);
        painter.hline(bar.left() - 3.0..=bar.right() + 5.0, y, threshold_mark());
        let text = format!("threshold {}", short(legend.threshold * factor));
        let place = Pos2::new(bar.right() + 7.0, y);
        painter.text(place, Align2::LEFT_CENTER, text, font, ink);
    }
    name_colors(&response, legend);
}

/// Draws the colours of a field from the left to the right, with ticks and the threshold.
fn color_row(ui: &mut Ui, legend: &FieldLegend, width: f32) {
    let (rect, response) = ui.allocate_exact_size(vec2(width, ROW - 10.0), Sense::hover());
    let bar = Rect::from_min_size(rect.left_top() + vec2(8.0, 4.0), vec2(width - 16.0, ROW_BAR));
    let at = |fraction: f64| bar.left() + fraction as f32 * bar.width();
    let painter = ui.painter();
    for (color, [low, high]) in strips() {
        let strip = Rect::from_min_max(Pos2::new(at(low), bar.top()), Pos2::new(at(high) + 0.5, bar.bottom()));
        painter.rect_filled(strip, 0.0, color);
    }
    let (ink, font) = (ui.visuals().text_color(), FontId::proportional(11.0));
    let factor = legend.field.display_factor();
    let mut free_from = f32::NEG_INFINITY;
    for (value, fraction) in legend.map.ticks() {
        let x = at(fraction);
        painter.vline(x, bar.bottom()..=bar.bottom() + 3.0, Stroke::new(1.0, ink));
        let galley = painter.layout_no_wrap(short(value * factor), font.clone(), ink);
        let left = x - 0.5 * galley.size().x;
        // Labels must not touch each other.
        if left > free_from {
            free_from = left + galley.size().x + 4.0;
            painter.galley(Pos2::new(left, bar.bottom() + 4.0), galley, ink);
        }
    }
    if let Some(fraction) = legend.map.place(legend.threshold) {
        painter.vline(at(fraction), bar.top() - 3.0..=bar.bottom() + 3.0, threshold_mark());
    }
    name_colors(&response, legend);
    let threshold = short(legend.threshold * factor);
    response.on_hover_text(format!("{}; threshold {threshold}", legend.field.title()));
}

/// Tells what the pointer is over.
fn describe(ui: &mut Ui, area: Rect, description: &Description) {
    boxed(ui, "pointed", Align2::LEFT_BOTTOM, area, |ui| {
        ui.set_max_width(330.0);
        ui.horizontal(|ui| {
            if let Some(passes) = description.passes {
                let (color, mark) = if passes {
                    (theme::good(ui), "✔")
                } else {
                    (theme::bad(ui), "✖")
                };
                ui.colored_label(color, mark);
            }
            ui.strong(&description.title);
        });
        for line in &description.lines {
            ui.label(line);
        }
    });
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use kinefront_model::evaluation::PoseScalar;

    #[test]
    fn the_legend_names_its_field_and_threshold() {
        let field = Field::Scalar(PoseScalar::Displacement);
        let legend = |range: [f64; 2]| FieldLegend {
            field,
            map: ColorMap::new(field.scale(), range, 1e-4),
            threshold: 1e-4,
        };
        let inside = Harness::new_ui(|ui| color_bar(ui, &legend([2e-5, 5e-4])));
        inside.get_by_label_contains("displacement under the in-plane force [mm], threshold 0.1");
        let outside = Harness::new_ui(|ui| color_bar(ui, &legend([2e-4, 5e-4])));
        outside.get_by_label_contains("threshold 0.1, outside the range");
    }
}
