//! Colours and marks of the window: one per architecture, the same as in recordings.

use egui::{Color32, Context, Ui};
use egui_plot::MarkerShape;

use kinefront_model::mechanism::Architecture;
use crate::palette;
use crate::scene::Part;
pub use crate::text::number;

/// The design in the light.
pub const CHOSEN: Color32 = Color32::from_rgb(255, 70, 60);
/// What is changed by hand.
pub const WHAT_IF: Color32 = Color32::from_rgb(230, 110, 230);
/// A constraint that is broken.
pub const BROKEN: Color32 = Color32::from_rgb(230, 70, 60);
/// A constraint that is active.
pub const ACTIVE: Color32 = Color32::from_rgb(240, 160, 40);
/// Something that holds.
pub const SOUND: Color32 = Color32::from_rgb(90, 180, 110);

/// Fonts and colours, the embedded viewer's: one look for all.
pub fn dress(ctx: &Context) {
    re_viewer::external::re_ui::apply_style_and_install_loaders(ctx);
}

/// Colour of an architecture, dark enough to be read on a light ground.
pub fn architecture(architecture: Architecture, dark: bool) -> Color32 {
    readable(palette::architecture(architecture), dark)
}

/// Colour of a part, dark enough to be seen on a light ground.
pub fn part(part: Part, dark: bool) -> Color32 {
    readable(palette::part(part), dark)
}

/// Colour of the nearest pair of bodies.
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

/// Place of an architecture among all, which gives its mark.
pub fn index(architecture: Architecture) -> usize {
    Architecture::ALL
        .iter()
        .position(|&other| other == architecture)
        .unwrap_or(0)
}

/// Mark of an architecture in a plot.
pub fn mark(architecture: Architecture) -> MarkerShape {
    const MARKS: [MarkerShape; 4] = [
        MarkerShape::Circle,
        MarkerShape::Square,
        MarkerShape::Up,
        MarkerShape::Diamond,
    ];
    MARKS[index(architecture) % MARKS.len()]
}

/// The ground that designs are drawn on.
pub fn ground(dark: bool) -> Color32 {
    if dark {
        Color32::from_gray(16)
    } else {
        Color32::from_gray(250)
    }
}

/// Infeasible designs.
pub fn infeasible(dark: bool) -> Color32 {
    if dark {
        Color32::from_gray(88)
    } else {
        Color32::from_gray(178)
    }
}

/// Lines and words that stand out from the ground.
pub fn ink(ui: &Ui) -> Color32 {
    ui.visuals().strong_text_color()
}

/// `share` of a colour over the ground.
pub fn mix(color: Color32, ground: Color32, share: f32) -> Color32 {
    let part = |a: u8, b: u8| (f32::from(a) * share + f32::from(b) * (1.0 - share)) as u8;
    Color32::from_rgb(
        part(color.r(), ground.r()),
        part(color.g(), ground.g()),
        part(color.b(), ground.b()),
    )
}
