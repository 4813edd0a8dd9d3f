//! The legend of a field, for a two-dimensional view beside that of the manipulator.

use rerun::datatypes::Range2D;
use rerun::{Color, Image, LineStrips2D, Points2D, Radius};

use super::colors::{self, rgb};
use super::draw::Canvas;
use super::writer::RecordingError;
use kinefront_scene::palette;
use kinefront_scene::text::short;
use kinefront_scene::{ColorMap, FieldLegend};

/// Width and height of the colour bar, in the units of its view.
const BAR: [u32; 2] = [8, 64];

/// Part of the view that the legend needs.
pub(super) fn legend_bounds() -> Range2D {
    Range2D {
        x_range: [-4.0, 26.0].into(),
        y_range: [-8.0, 72.0].into(),
    }
}

/// Draws the colours of a field with ticks and the threshold below `root`.
pub(super) fn draw_legend(canvas: &Canvas<'_>, root: &str, legend: &FieldLegend) -> Result<(), RecordingError> {
    let FieldLegend { field, map, threshold } = *legend;
    let [width, height] = BAR;
    let row = |k: u32| ColorMap::at(1.0 - (f64::from(k) + 0.5) / f64::from(height));
    let pixels = (0..height).flat_map(|k| std::iter::repeat_n(row(k), width as usize).flatten());
    let bar = Image::from_rgb24(pixels.collect::<Vec<u8>>(), BAR);
    canvas.row(&format!("{root}/bar"), &bar)?;
    let (right, down) = (width as f32, |fraction: f64| {
        ((1.0 - fraction) * f64::from(height)) as f32
    });
    let factor = field.display_factor();
    let mut lines: Vec<([[f32; 2]; 2], Color)> = Vec::new();
    let mut words: Vec<([f32; 2], String, Color)> = Vec::new();
    for (value, fraction) in map.ticks() {
        let y = down(fraction);
        lines.push(([[right, y], [right + 1.5, y]], rgb(colors::TEXT)));
        words.push(([right + 7.0, y], short(value * factor), rgb(colors::TEXT)));
    }
    let text = format!("threshold {}", short(threshold * factor));
    if let Some(fraction) = map.place(threshold) {
        let y = down(fraction);
        lines.push(([[-1.5, y], [right + 1.5, y]], rgb(palette::THRESHOLD)));
    }
    words.push(([0.5 * right + 7.0, height as f32 + 4.0], text, rgb(palette::THRESHOLD)));
    let count = lines.len();
    let (strips, tints): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
    let lines = LineStrips2D::new(strips)
        .with_colors(tints)
        .with_radii(std::iter::repeat_n(Radius::new_ui_points(1.2), count));
    canvas.row(&format!("{root}/ticks"), &lines)?;
    let count = words.len();
    let points = Points2D::new(words.iter().map(|(at, ..)| *at))
        .with_colors(words.iter().map(|(.., color)| *color))
        .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.0), count))
        .with_labels(words.into_iter().map(|(_, text, _)| text))
        .with_show_labels(true);
    canvas.row(&format!("{root}/labels"), &points)
}
