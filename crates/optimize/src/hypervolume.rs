//! Exact hypervolume for two minimised objectives.

/// Computes the area that is dominated by `points` and bounded by the point `reference`, with both objectives
/// minimised.
///
/// Points that are not smaller than the reference in both objectives contribute nothing; order and duplicates do not
/// matter.
pub fn hypervolume(points: impl IntoIterator<Item = [f64; 2]>, reference: [f64; 2]) -> f64 {
    let mut inside: Vec<[f64; 2]> = points
        .into_iter()
        .filter(|point| point[0] < reference[0] && point[1] < reference[1])
        .collect();
    inside.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut area = 0.0;
    let mut lowest = reference[1];
    for point in inside {
        if point[1] < lowest {
            area += (reference[0] - point[0]) * (lowest - point[1]);
            lowest = point[1];
        }
    }
    area
}
