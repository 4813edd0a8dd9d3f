//! The design variables along the fronts, with fits.

use maud::{Markup, html};

use super::{figures, percent};
use crate::{AT_BOUND, Fit, Report, Topic};
use kinefront_scene::text::number;

/// Formats a polynomial in a quantity.
fn polynomial(fit: &Fit, quantity: &str) -> String {
    let mut text = String::new();
    for (power, &value) in fit.coefficients.iter().enumerate() {
        let size = number(value.abs());
        match (power, value < 0.0) {
            (0, negative) => text += &format!("{}{size}", if negative { "−" } else { "" }),
            (_, negative) => {
                let sign = if negative { "−" } else { "+" };
                let square = if power == 1 { "" } else { "²" };
                text += &format!(" {sign} {size} {quantity}{square}");
            }
        }
    }
    text
}

/// Shows how the design variables change with the objective by which designs are compared.
pub(super) fn variables(report: &Report) -> Markup {
    let along = report.question.name(report.question.compared());
    html! {
        p {
            "Lengths and bar radii of the drawn designs, plotted against their " (along) ", with least-squares fits: "
            "straight lines, and a parabola for r_p. Designs at which a variable is within " (percent(AT_BOUND)) " of "
            "its range from one of its bounds are excluded from the fits of that variable, because the bound "
            "determines its value there. R² is the fraction of the variance that a fit explains; the rank correlation "
            "is 1 if a variable increases monotonically with the " (along) "."
        }
        (figures(report, Topic::Lengths))
        (figures(report, Topic::Bars))
        div.scroll { table {
            thead { tr {
                th { "architecture" } th { "variable [m]" }
                th.number { "designs not at a bound" } th { "straight line" } th.number { "R²" } th { "parabola" } th.number { "R²" }
                th.number { "rank correlation" }
            } }
            tbody { @for (architecture, trends) in &report.trends { @for trend in trends {
                tr {
                    td { (architecture) } td { (trend.variable.symbol()) }
                    td.number { (trend.free.len()) " of " (trend.points.len()) }
                    @for fit in [&trend.linear, &trend.quadratic] {
                        @match fit {
                            Some(fit) => { td.formula { (polynomial(fit, along)) } td.number { (format!("{:.3}", fit.r_squared)) } }
                            None => { td { "–" } td.number { "–" } }
                        }
                    }
                    td.number { (trend.rank_correlation.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}"))) }
                }
            } } }
        } }
    }
}
