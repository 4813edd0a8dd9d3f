//! Exact hypervolume for one to three minimised objectives.

/// Computes the length, area or volume that is dominated by `points` and bounded by the point `reference`, with all objectives
/// minimised.
///
/// Points that are not smaller than the reference in every objective contribute nothing; order and duplicates do not
/// matter.
pub fn hypervolume<P: AsRef<[f64]>>(points: impl IntoIterator<Item = P>, reference: impl AsRef<[f64]>) -> f64 {
    let reference = reference.as_ref();
    let inside = points.into_iter().filter(|point| {
        let mut pairs = point.as_ref().iter().zip(reference);
        pairs.all(|(value, limit)| value < limit)
    });
    match *reference {
        [limit] => {
            let least = inside.map(|point| point.as_ref()[0]).fold(limit, f64::min);
            limit - least
        }
        [first, second] => area(inside.map(|point| two(point.as_ref())).collect(), [first, second]),
        [first, second, third] => {
            let points = inside.map(|point| (two(point.as_ref()), point.as_ref()[2])).collect();
            volume(points, [first, second], third)
        }
        _ => 0.0,
    }
}

fn two(point: &[f64]) -> [f64; 2] {
    [point[0], point[1]]
}

fn area(mut inside: Vec<[f64; 2]>, reference: [f64; 2]) -> f64 {
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

/// Sweeps over the third objective and keeps the area that the points so far dominate (Fonseca, Paquete and López-Ibáñez 2006).
fn volume(mut inside: Vec<([f64; 2], f64)>, reference: [f64; 2], last: f64) -> f64 {
    inside.sort_by(|(a, at_a), (b, at_b)| {
        at_a.total_cmp(at_b)
            .then(a[0].total_cmp(&b[0]))
            .then(a[1].total_cmp(&b[1]))
    });
    let mut staircase: Vec<[f64; 2]> = Vec::new();
    let (mut area, mut volume) = (0.0, 0.0);
    for (place, &(point, at)) in inside.iter().enumerate() {
        area += gain(&mut staircase, point, reference);
        let next = inside.get(place + 1).map_or(last, |(_, next)| *next);
        volume += area * (next - at);
    }
    volume
}

/// Adds a point to a staircase, in ascending order of the first objective, and returns the area that it adds.
fn gain(staircase: &mut Vec<[f64; 2]>, point: [f64; 2], reference: [f64; 2]) -> f64 {
    let place = staircase.partition_point(|step| step[0] <= point[0]);
    let mut upper = place.checked_sub(1).map_or(reference[1], |before| staircase[before][1]);
    if upper <= point[1] {
        return 0.0;
    }
    let (mut area, mut from) = (0.0, point[0]);
    let covered = staircase[place..].iter().take_while(|step| step[1] >= point[1]).count();
    for step in &staircase[place..place + covered] {
        area += (step[0] - from) * (upper - point[1]);
        (from, upper) = (step[0], step[1]);
    }
    let end = staircase.get(place + covered).map_or(reference[0], |step| step[0]);
    area += (end - from) * (upper - point[1]);
    // A step with the same first objective just before the point is covered, too.
    let start = match place.checked_sub(1) {
        Some(before) if staircase[before][0] == point[0] => before,
        _ => place,
    };
    staircase.splice(start..place + covered, [point]);
    area
}
