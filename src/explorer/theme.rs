//! Colours and markers of the window: one per architecture, the same as in recordings.

use egui::{Color32, Context, Ui};
use egui_plot::MarkerShape;

use crate::palette;
use crate::scene::Part;
pub use crate::text::number;
use kinefront_model::mechanism::Architecture;

/// Colour of the selected design.
pub const SELECTED: Color32 = Color32::from_rgb(255, 70, 60);
/// Colour of a modified design.
pub const MODIFIED: Color32 = Color32::from_rgb(230, 110, 230);
/// Colour of a violated constraint and of an error.
pub const BAD: Color32 = Color32::from_rgb(230, 70, 60);
/// Colour of an active constraint.
pub const ACTIVE: Color32 = Color32::from_rgb(240, 160, 40);
/// Colour of a satisfied constraint and of a message that is not an error.
pub const GOOD: Color32 = Color32::from_rgb(90, 180, 110);

/// Applies the fonts and colours of the embedded viewer, so that the whole window has one style.
pub fn dress(ctx: &Context) {
    re_viewer::external::re_ui::apply_style_and_install_loaders(ctx);
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

fn readable([r, g, b]: [u8; 3], dark: bool) -> Color32 {
    if dark {
        Color32::from_rgb(r, g, b)
    } else {
        let darker = |value: u8| (f32::from(value) * 0.78) as u8;
        Color32::from_rgb(darker(r), darker(g), darker(b))
    }
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
    if dark {
        Color32::from_gray(16)
    } else {
        Color32::from_gray(250)
    }
}

/// Returns the colour of infeasible designs.
pub fn infeasible(dark: bool) -> Color32 {
    if dark {
        Color32::from_gray(88)
    } else {
        Color32::from_gray(178)
    }
}

/// Returns the colour of lines and text that contrast with the background.
pub fn ink(ui: &Ui) -> Color32 {
    ui.visuals().strong_text_color()
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
