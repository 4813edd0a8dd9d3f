//! Colours and markers of the window: one per architecture, the same as in recordings.

use egui::{Button, Color32, Context, IntoAtoms, Response, Stroke, Ui};
use egui_plot::MarkerShape;

use kinefront_model::mechanism::Architecture;
use kinefront_scene::Part;
use kinefront_scene::palette;
pub use kinefront_scene::text::number;

/// Colour of the selected design.
pub const SELECTED: Color32 = Color32::from_rgb(255, 70, 60);
/// Ground of the button of the main action of a panel, whose text is white.
pub const PRIMARY: Color32 = Color32::from_rgb(20, 92, 190);

/// Makes the button of the main action of a panel.
pub fn primary(text: &str) -> Button<'_> {
    Button::new(egui::RichText::new(text).color(Color32::WHITE).strong()).fill(PRIMARY)
}

/// Smallest contrast of text with its background, as the WCAG requires at level AA.
const LEGIBLE: f64 = 4.5;

/// Returns a text with its first letter in upper case, as on a button.
pub fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns the colour of a modified design.
pub fn modified(dark: bool) -> Color32 {
    of_theme(dark, [230, 110, 230], [150, 30, 150])
}

/// Returns the colour of a violated constraint and of an error.
pub fn bad(ui: &Ui) -> Color32 {
    of_theme(ui.visuals().dark_mode, [240, 90, 80], [176, 32, 24])
}

/// Returns the colour of an active constraint.
pub fn active(ui: &Ui) -> Color32 {
    of_theme(ui.visuals().dark_mode, [240, 160, 40], [136, 78, 0])
}

/// Returns the colour of a satisfied constraint and of a message that is not an error.
pub fn good(ui: &Ui) -> Color32 {
    of_theme(ui.visuals().dark_mode, [90, 180, 110], [20, 106, 48])
}

fn of_theme(is_dark: bool, dark: [u8; 3], light: [u8; 3]) -> Color32 {
    let [r, g, b] = if is_dark { dark } else { light };
    Color32::from_rgb(r, g, b)
}

/// Applies the fonts and colours of the embedded viewer, so that the whole window has one style, and refines them.
pub fn dress(ctx: &Context) {
    re_viewer::external::re_ui::apply_style_and_install_loaders(ctx);
    refine(ctx);
}

/// Gives what can be clicked a frame, and text a size of at least 12 points and a legible colour: the viewer's style has flat buttons,
/// which look like text, and pale text on a light ground.
pub fn refine(ctx: &Context) {
    ctx.all_styles_mut(|style| {
        for font in style.text_styles.values_mut() {
            font.size = font.size.max(12.0);
        }
        style.spacing.button_padding = egui::vec2(5.0, 2.0);
        let dark = style.visuals.dark_mode;
        let shade = |dark_level: u8, light_level: u8| Color32::from_gray(if dark { dark_level } else { light_level });
        let widgets = &mut style.visuals.widgets;
        for (widget, fill, line) in [
            (&mut widgets.inactive, shade(44, 232), shade(92, 160)),
            (&mut widgets.hovered, shade(62, 216), shade(150, 110)),
            (&mut widgets.active, shade(80, 200), shade(200, 60)),
            (&mut widgets.open, shade(52, 224), shade(120, 130)),
        ] {
            widget.weak_bg_fill = fill;
            widget.bg_stroke = Stroke::new(1.0, line);
        }
        if !dark {
            widgets.noninteractive.fg_stroke.color = Color32::from_gray(64);
            widgets.inactive.fg_stroke.color = Color32::from_gray(40);
        }
        style.visuals.weak_text_color = Some(shade(158, 96));
    });
}

/// Returns the colour of an architecture, darkened on a light background to be legible.
pub fn architecture(architecture: Architecture, dark: bool) -> Color32 {
    readable(palette::architecture(architecture), dark)
}

/// Returns the colour of a part, darkened on a light background to be visible.
pub fn part(part: Part, dark: bool) -> Color32 {
    readable(palette::part(part), dark)
}

/// Returns the colour of the nearest pair of members.
pub fn nearest(too_near: bool, dark: bool) -> Color32 {
    readable(palette::nearest(too_near), dark)
}

/// Returns the colour of a series of a chart.
pub fn series(index: usize) -> Color32 {
    let [r, g, b] = palette::SERIES[index % palette::SERIES.len()];
    Color32::from_rgb(r, g, b)
}

/// Returns a colour that is legible as text.
pub fn legible(color: Color32, ui: &Ui) -> Color32 {
    let [r, g, b, _] = color.to_array();
    readable([r, g, b], ui.visuals().dark_mode)
}

/// Returns a colour, made darker or lighter until it is legible as text on the ground of designs.
fn readable([r, g, b]: [u8; 3], dark: bool) -> Color32 {
    let (color, ground) = (Color32::from_rgb(r, g, b), ground(dark));
    let towards = if dark { Color32::WHITE } else { Color32::BLACK };
    let steps = (0..=20).map(|step| mix(towards, color, 0.05 * step as f32));
    let legible = |color: &Color32| contrast(*color, ground) >= LEGIBLE;
    steps.clone().find(legible).unwrap_or(towards)
}

/// Returns the contrast of two colours as the WCAG defines it, from 1 to 21.
fn contrast(a: Color32, b: Color32) -> f64 {
    let linear = |value: u8| {
        let value = f64::from(value) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            libm::pow((value + 0.055) / 1.055, 2.4)
        }
    };
    let luminance = |c: Color32| 0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b());
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

/// Returns the index of an architecture in [`Architecture::ALL`], which determines its marker.
pub fn index(architecture: Architecture) -> usize {
    Architecture::ALL
        .iter()
        .position(|&other| other == architecture)
        .unwrap_or(0)
}

/// Returns the marker of an architecture in a plot.
pub fn mark(architecture: Architecture) -> MarkerShape {
    const MARKS: [MarkerShape; 4] = [
        MarkerShape::Circle,
        MarkerShape::Square,
        MarkerShape::Up,
        MarkerShape::Diamond,
    ];
    MARKS[index(architecture) % MARKS.len()]
}

/// Returns the background colour on which designs are drawn.
pub fn ground(dark: bool) -> Color32 {
    of_theme(dark, [16; 3], [250; 3])
}

/// Returns the colour of infeasible designs.
pub fn infeasible(dark: bool) -> Color32 {
    of_theme(dark, [88; 3], [178; 3])
}

/// Returns the colour of lines and text that contrast with the background.
pub fn ink(ui: &Ui) -> Color32 {
    ui.visuals().strong_text_color()
}

/// Returns a button that is on or off; its frame is visible either way.
pub fn toggle<'a>(is_on: bool, text: impl IntoAtoms<'a>) -> Button<'a> {
    Button::selectable(is_on, text).frame_when_inactive(true)
}

/// Shows a button that sets `current` to `value`, and is on while they are equal.
pub fn choice<'a, T: PartialEq>(ui: &mut Ui, current: &mut T, value: T, text: impl IntoAtoms<'a>) -> Response {
    let mut response = ui.add(toggle(*current == value, text));
    if response.clicked() && *current != value {
        *current = value;
        response.mark_changed();
    }
    response
}

/// Blends a colour over the background; `fraction` is the fraction of the colour.
pub fn mix(color: Color32, ground: Color32, fraction: f32) -> Color32 {
    let part = |a: u8, b: u8| (f32::from(a) * fraction + f32::from(b) * (1.0 - fraction)) as u8;
    Color32::from_rgb(
        part(color.r(), ground.r()),
        part(color.g(), ground.g()),
        part(color.b(), ground.b()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Text is legible on the panels in both themes: the colours of states, of architectures, and of plain text.
    #[test]
    fn colours_of_text_have_the_contrast_that_the_wcag_requires() {
        let ctx = Context::default();
        dress(&ctx);
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            ctx.set_theme(theme);
            let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
                let dark = ui.visuals().dark_mode;
                assert_eq!(dark, theme == egui::Theme::Dark);
                let panel = ui.visuals().panel_fill;
                let mut colors = vec![
                    ("modified", modified(dark), panel),
                    ("bad", bad(ui), panel),
                    ("active", active(ui), panel),
                    ("good", good(ui), panel),
                    ("main action", Color32::WHITE, PRIMARY),
                    ("text", ui.visuals().text_color(), panel),
                    ("strong text", ink(ui), panel),
                    ("weak text", ui.visuals().weak_text_color(), panel),
                    (
                        "text of a button",
                        ui.visuals().widgets.inactive.text_color(),
                        ui.visuals().widgets.inactive.weak_bg_fill,
                    ),
                ];
                for found in Architecture::ALL {
                    colors.push((found.name(), architecture(*found, dark), ground(dark)));
                }
                for (name, color, ground) in colors {
                    let found = contrast(color, ground);
                    assert!(
                        found >= LEGIBLE,
                        "{name} {color:?} on {ground:?} ({theme:?}): {found:.2}"
                    );
                }
            });
        }
    }
}
