//! Whole numbers on the command line.

use std::ops::RangeInclusive;

/// Returns a parser of whole numbers of a range, whose error states what would be right.
pub fn whole_number<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number
            .and_then(|number| T::try_from(number).ok())
            .ok_or_else(|| refusal(text, &range))
    }
}

fn refusal(text: &str, range: &RangeInclusive<u64>) -> String {
    let told = format!(
        "it must be a whole number from {} to {}, written with digits alone",
        range.start(),
        range.end()
    );
    // Of a number such as 1e5, the digits are told.
    let meant = text.parse::<f64>().ok();
    let meant = meant.filter(|number| *number >= 0.0 && number.trunc() == *number);
    let meant = meant
        .map(|number| number as u64)
        .filter(|number| range.contains(number));
    match meant {
        Some(meant) => format!("{told}; did you mean `{meant}`?"),
        None => told,
    }
}
