//! What the colour of a design tells: its architecture, the value of a quantity, or how many designs overlap.

use egui::{Align2, Color32, ComboBox, FontId, Pos2, Rect, Ui, Vec2};

use crate::Store;
use kinefront_model::evaluation::QuantitySet;
use kinefront_scene::text::short;
use kinefront_study::Column;

/// What the colour of a design tells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Coloring {
    /// Its architecture.
    #[default]
    Architecture,
    /// How many feasible designs lie in the same place.
    Density,
    /// The value of a quantity.
    Quantity(Column),
}

impl Coloring {
    fn title(self) -> String {
        match self {
            Self::Architecture => "architecture".to_owned(),
            Self::Density => "number of designs".to_owned(),
            Self::Quantity(column) => column.title(),
        }
    }

    /// Returns what a name means: `architecture`, `density`, or the name of a quantity.
    pub fn find(name: &str) -> Option<Self> {
        match name {
            "architecture" => Some(Self::Architecture),
            "density" => Some(Self::Density),
            _ => Column::find_quantity(name).map(Self::Quantity),
        }
    }

    /// Shows a field to choose it.
    pub(super) fn ui(&mut self, ui: &mut Ui, named: QuantitySet) {
        let label = ui.label("colour");
        let others = Column::quantities(named).map(Self::Quantity);
        ComboBox::from_id_salt("coloring")
            .selected_text(self.title())
            .width(130.0)
            .show_ui(ui, |ui| {
                for other in [Self::Architecture, Self::Density].into_iter().chain(others) {
                    ui.selectable_value(self, other, other.title());
                }
            })
            .response
            .labelled_by(label.id);
    }
}

/// Colours of the values of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorScale {
    column: Column,
    range: [f64; 2],
}

impl ColorScale {
    /// Returns the colour of a value; none of a value that is not finite, such as a variable that a chain does not have.
    pub(super) fn color(&self, value: f64) -> Option<Color32> {
        let place = |value: f64| {
            if self.column.is_logarithmic() {
                libm::log(value.max(1e-12))
            } else {
                value
            }
        };
        let [low, high] = self.range.map(place);
        let fraction = (place(value) - low) / (high - low).max(f64::MIN_POSITIVE);
        value.is_finite().then(|| gradient(fraction))
    }
}

/// Range of a quantity among the feasible designs, updated with those that were added to the store.
#[derive(Default)]
pub(super) struct ColorRange {
    of: Option<(Column, u64)>,
    seen: usize,
    range: [f64; 2],
}

impl ColorRange {
    /// Returns the colours of a quantity. Their range grows in steps, because the designs are drawn anew with every other range.
    pub(super) fn update(&mut self, column: Column, era: u64, store: &Store) -> ColorScale {
        if self.of != Some((column, era)) || self.seen > store.len() {
            *self = Self {
                of: Some((column, era)),
                seen: 0,
                range: [f64::INFINITY, f64::NEG_INFINITY],
            };
        }
        let values = store.column(column);
        for id in self.seen..store.len() {
            if store.is_feasible(id) && values[id].is_finite() {
                self.range = [self.range[0].min(values[id]), self.range[1].max(values[id])];
            }
        }
        self.seen = store.len();
        let [low, high] = match column {
            // Margins have no upper bound, and those near 0 matter most.
            Column::Margin(_) => [self.range[0].min(0.0), self.range[1].clamp(0.1, 10.0)],
            _ => self.range,
        };
        let range = if low <= high {
            [two_digits(low, f64::floor), two_digits(high, f64::ceil)]
        } else {
            [0.0, 1.0]
        };
        ColorScale { column, range }
    }
}

/// Rounds a number to two significant digits in the given direction.
fn two_digits(value: f64, round: fn(f64) -> f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let unit = libm::pow(10.0, libm::floor(libm::log10(value.abs())) - 1.0);
    round(value / unit) * unit
}

/// Returns the colour of a fraction, from dark to light.
fn gradient(fraction: f64) -> Color32 {
    let color = colorous::VIRIDIS.eval_continuous(fraction.clamp(0.0, 1.0));
    Color32::from_rgb(color.r, color.g, color.b)
}

/// Returns the colour of a cell that holds `count` designs where the fullest cell holds `most`.
pub(super) fn density(count: u32, most: u32, dark: bool) -> Color32 {
    let fraction = libm::log1p(f64::from(count)) / libm::log1p(f64::from(most.max(1)));
    // The fullest cell stands out most from the ground.
    gradient(if dark {
        0.1 + 0.9 * fraction
    } else {
        0.95 - 0.95 * fraction
    })
}

/// What a legend tells: the ends of the colours, and the colour at a fraction between them.
pub(super) struct ColorLegend {
    title: String,
    ends: [String; 2],
    color: Box<dyn Fn(f64) -> Color32>,
}

impl ColorLegend {
    pub(super) fn of_scale(scale: &ColorScale) -> Self {
        Self {
            title: scale.column.title(),
            ends: scale.range.map(short),
            color: Box::new(gradient),
        }
    }

    pub(super) fn of_density(most: u32, dark: bool) -> Self {
        // The middle of the bar is the geometric mean, as in the picture.
        let count = move |fraction: f64| libm::expm1(fraction * libm::log1p(f64::from(most))) as u32;
        Self {
            title: "overlapping designs".to_owned(),
            ends: ["1".to_owned(), most.to_string()],
            color: Box::new(move |fraction| density(count(fraction), most, dark)),
        }
    }

    /// Draws the legend into the lower right corner of `frame`, where the front seldom is.
    pub(super) fn paint(&self, ui: &Ui, frame: Rect) {
        const BAR: Vec2 = Vec2::new(120.0, 8.0);
        const STEPS: u32 = 60;
        let corner = frame.right_bottom() - Vec2::new(BAR.x + 14.0, 32.0);
        let painter = ui.painter_at(frame);
        let around = Rect::from_min_max(corner - Vec2::new(6.0, 22.0), corner + BAR + Vec2::new(6.0, 20.0));
        painter.rect_filled(around, 3.0, ui.visuals().panel_fill.gamma_multiply(0.85));
        for step in 0..STEPS {
            let [from, to] = [step, step + 1].map(|step| f64::from(step) / f64::from(STEPS));
            let strip = Rect::from_min_max(
                corner + Vec2::new(from as f32 * BAR.x, 0.0),
                corner + Vec2::new(to as f32 * BAR.x + 0.5, BAR.y),
            );
            painter.rect_filled(strip, 0.0, (self.color)(0.5 * (from + to)));
        }
        let text = |at: Pos2, align: Align2, text: &str| {
            painter.text(at, align, text, FontId::proportional(12.0), ui.visuals().text_color());
        };
        text(
            corner + Vec2::new(0.5 * BAR.x, -3.0),
            Align2::CENTER_BOTTOM,
            &self.title,
        );
        text(corner + Vec2::new(0.0, BAR.y + 3.0), Align2::LEFT_TOP, &self.ends[0]);
        text(corner + BAR + Vec2::new(0.0, 3.0), Align2::RIGHT_TOP, &self.ends[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kinefront_model::evaluation::Quantity;

    #[test]
    fn ranges_are_rounded_outwards() {
        assert_eq!(two_digits(3.066, f64::floor), 3.0);
        assert_eq!(two_digits(0.1234, f64::ceil), 0.13);
        assert_eq!(two_digits(-0.0567, f64::floor), -0.057);
        assert_eq!(two_digits(0.0, f64::ceil), 0.0);
        assert!(two_digits(484.8, f64::ceil) >= 484.8);
    }

    #[test]
    fn a_scale_reaches_from_one_end_of_the_colours_to_the_other() {
        let mass = Column::Quantity(Quantity::Mass);
        let scale = ColorScale {
            column: mass,
            range: [1.0, 100.0],
        };
        assert!(mass.is_logarithmic());
        assert_eq!(scale.color(1.0), Some(gradient(0.0)));
        assert_eq!(scale.color(10.0), Some(gradient(0.5)));
        assert_eq!(scale.color(100.0), Some(gradient(1.0)));
        assert_eq!(scale.color(f64::NAN), None);
        for dark in [false, true] {
            assert_eq!(
                density(7, 7, dark),
                density(1, 1, dark),
                "the fullest cell has the same colour"
            );
            assert_ne!(density(1, 1000, dark), density(1000, 1000, dark));
        }
    }
}
