//! Taylor models against the functions that they enclose, and their rounding against fused operations.

use kinefront_model::enclosure::{Comparison, EnclosedNumber, Interval, TaylorModel};
use kinefront_model::lanes::Real;
use kinefront_testkit::numbers as random_numbers;

/// Numbers between −1 and 1 that look random.
struct Numbers<F>(F);

/// The numbers that follow from a seed.
fn numbers_from(seed: u64) -> Numbers<impl FnMut() -> f64> {
    Numbers(random_numbers(seed))
}

impl<F: FnMut() -> f64> Numbers<F> {
    fn next(&mut self) -> f64 {
        2.0 * (self.0)() - 1.0
    }

    fn three(&mut self) -> [f64; 3] {
        [(); 3].map(|()| self.next())
    }

    fn model(&mut self) -> TaylorModel {
        let mut terms = || self.three().map(|term| 0.2 * term);
        let (linear, square, mixed) = (terms(), terms(), terms());
        TaylorModel {
            constant: 2.0 + self.next(),
            linear,
            square,
            mixed,
            remainder: 0.01 * self.next().abs(),
        }
    }
}

/// A function that is enclosed by two models has its sum, product, reciprocal and root enclosed by theirs.
#[test]
fn operations_enclose_what_their_operands_enclose() {
    let mut numbers = numbers_from(1);
    for _ in 0..20_000 {
        let (a, b) = (numbers.model(), numbers.model());
        let at = numbers.three();
        // The function lies anywhere within the remainder, often at its end.
        let mut within =
            |model: &TaylorModel| model.value(at) + model.remainder * (3.0 * numbers.next()).clamp(-1.0, 1.0);
        let (x, y) = (within(&a), within(&b));
        for (result, expected) in [
            (a + b, x + y),
            (a - b, x - y),
            (a * b, x * y),
            (a.squared(), x * x),
            (a.times(0.7), 0.7 * x),
            (a.scaled(Interval::new(0.69, 0.71)), 0.7 * x),
            (a.reciprocal(), 1.0 / x),
            (a.sqrt(), x.sqrt()),
        ] {
            if result.constant.is_nan() {
                continue;
            }
            let error = (result.value(at) - expected).abs();
            assert!(error <= result.remainder + 1e-14, "{error} of {}", result.remainder);
            let [lower, upper] = result.range();
            assert!(lower <= expected + 1e-14 && expected <= upper + 1e-14);
        }
    }
}

/// A polynomial that is a square of several variables but for little is positive exactly where that little is, and none is called positive
/// that is not so at every point.
#[test]
fn valleys_across_several_variables_are_decided() {
    let mut numbers = numbers_from(7);
    let square_of = |slopes: [f64; 3], centre: f64, least: f64| {
        let line = TaylorModel {
            constant: centre,
            linear: slopes,
            ..TaylorModel::exactly(0.0)
        };
        line.squared().plus(Interval::exactly(least))
    };
    for _ in 0..2000 {
        let slopes = numbers.three();
        let reach = slopes[0].abs() + slopes[1].abs() + slopes[2].abs();
        // Within the box, the line passes through 0.
        let centre = 0.9 * reach * numbers.next();
        assert!(square_of(slopes, centre, 1e-9).is_positive(), "{slopes:?} {centre}");
        assert!(!square_of(slopes, centre, -1e-9).is_positive(), "{slopes:?} {centre}");
    }
    let mut positive = 0;
    for _ in 0..20_000 {
        let mut model = numbers.model();
        model.constant = 0.3 * (model.constant - 1.0);
        model.square = model.square.map(|term| 2.0 * term);
        if !model.is_positive() {
            continue;
        }
        positive += usize::from(model.range()[0] < 0.0);
        let points = (0..200).map(|_| numbers.three());
        let corners = (0..27).map(|index: usize| [index % 3, index / 3 % 3, index / 9].map(|part| part as f64 - 1.0));
        for point in points.collect::<Vec<_>>().into_iter().chain(corners) {
            assert!(model.value(point) > model.remainder, "{model:?} at {point:?}");
        }
    }
    // The range alone does not decide all of them.
    assert!(positive > 100, "{positive}");
}

/// The same of the numbers of the shared formulas, also where the box decides no comparison and where a root begins at 0.
#[test]
fn numbers_of_formulas_enclose_what_their_operands_enclose() {
    let mut numbers = numbers_from(3);
    let mut undecided = 0;
    for _ in 0..20_000 {
        let mut model = |middle: f64, size: f64| {
            let mut model = numbers.model();
            model.constant = middle + 0.3 * (model.constant - 2.0);
            for terms in [&mut model.linear, &mut model.square, &mut model.mixed] {
                *terms = terms.map(|term| size * term);
            }
            EnclosedNumber(model)
        };
        // Numbers about 0, and one that is well above it.
        let (a, b, c) = (model(0.0, 1.0), model(0.0, 1.0), model(2.2, 2.0));
        let at = numbers.three();
        let mut within =
            |number: &EnclosedNumber| number.0.value(at) + number.0.remainder * (3.0 * numbers.next()).clamp(-1.0, 1.0);
        let (x, y, z) = (within(&a), within(&b), within(&c));
        undecided += usize::from(a.exceeds(b) == Comparison::Unknown);
        for (result, expected) in [
            (a.larger(b), x.max(y)),
            (a.smaller(b), x.min(y)),
            (a.abs(), x.abs()),
            ((a * a).sqrt(), x.abs()),
            ((c * c).sqrt(), z.abs()),
            ((a * a + b * b).sqrt(), (x * x + y * y).sqrt()),
            (a / c, x / z),
            (b / -c, -y / z),
            (c.select(a.at_least(b), -c), if x >= y { z } else { -z }),
            (a * a.splat(0.1) + a.splat(0.0), 0.1 * x),
        ] {
            if result.0.constant.is_nan() {
                continue;
            }
            let error = (result.0.value(at) - expected).abs();
            assert!(error <= result.0.remainder + 1e-14, "{error} of {}", result.0.remainder);
        }
        // The slope is kept: the root of the square of a narrow number is narrow.
        let narrow = EnclosedNumber(TaylorModel {
            linear: c.0.linear.map(|term| 0.1 * term),
            square: [0.0; 3],
            mixed: [0.0; 3],
            ..c.0
        });
        assert!((narrow * narrow).sqrt().0.remainder < 0.05);
    }
    assert!((1000..20_000).contains(&undecided), "{undecided} comparisons");
}

/// What is not known stays so.
#[test]
fn nothing_follows_from_no_number() {
    let none = EnclosedNumber(TaylorModel::exactly(f64::NAN));
    let one = EnclosedNumber(TaylorModel::exactly(1.0));
    for found in [
        none.larger(one),
        one.larger(none),
        one.smaller(none),
        none.abs(),
        none.sqrt(),
        one / none,
        one / (one - one),
        one.select(none.exceeds(one), one - one),
    ] {
        assert!(!found.0.is_positive() && !found.0.is_negative(), "{found:?}");
    }
    assert_eq!(none.exceeds(one), Comparison::Unknown);
    assert_eq!(one.at_least(none) & one.exceeds(one + one), Comparison::Never);
    assert_eq!(one.at_least(none) & (one + one).exceeds(one), Comparison::Unknown);
}

/// The remainder of a result without width covers its rounding, which fused operations tell exactly.
#[test]
fn remainders_cover_rounding() {
    let mut numbers = numbers_from(2);
    for _ in 0..20_000 {
        let (x, y) = (1.5 + numbers.next(), 1.5 + numbers.next());
        let [a, b] = [x, y].map(TaylorModel::exactly);
        let product = a * b;
        assert!(x.mul_add(y, -product.constant).abs() <= product.remainder);
        assert!(product.remainder < 1e-13);
        let sum = (a + b).constant;
        let lost = (x - (sum - y)) + (y - (sum - (sum - y)));
        assert!(lost.abs() <= (a + b).remainder);
        let reciprocal = a.reciprocal();
        let error = x.mul_add(reciprocal.constant, -1.0) / x;
        assert!(error.abs() <= reciprocal.remainder && reciprocal.remainder < 1e-13);
        let root = a.sqrt();
        let error = root.constant.mul_add(root.constant, -x) / (2.0 * root.constant);
        assert!(error.abs() <= 1.01 * root.remainder && root.remainder < 1e-13);
    }
}

#[test]
fn what_has_no_value_is_never_proved() {
    let zero = TaylorModel::variable(0, 0.5, 1.0);
    for nothing in [
        zero.reciprocal(),
        zero.sqrt(),
        TaylorModel::exactly(-1.0).sqrt(),
        TaylorModel::exactly(f64::MAX).squared(),
    ] {
        let [lower, _] = nothing.range();
        let is_proved = lower > 0.0;
        assert!(!is_proved, "{nothing:?}");
    }
}

/// A double by its bits: reading the text of a number may change the last one.
fn double(bits: &serde_json::Value) -> f64 {
    f64::from_bits(bits.as_u64().expect("bits"))
}

/// A number to 32 digits, as the sum of two doubles.
fn is_enclosed(lower: f64, upper: f64, number: &serde_json::Value) -> bool {
    let part = |place: usize| double(&number[place]);
    let (high, low) = (part(0), part(1));
    // The differences of neighbouring doubles are exact, so that their sums have the right signs.
    (high - lower) + low >= 0.0 && (upper - high) - low >= 0.0
}

/// Without width, a model encloses the value to 50 digits, and little else.
#[test]
fn values_to_50_digits_are_enclosed() {
    let file: serde_json::Value = serde_json::from_str(include_str!("../fixtures/elementary.json")).expect("JSON");
    let cases = file["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 300);
    for case in cases {
        let exactly = |key: &str| TaylorModel::exactly(double(&case[key]));
        let (x, y, z) = (exactly("x"), exactly("y"), exactly("z"));
        let (sine, cosine) = TaylorModel::sine_and_cosine(0, x.constant, 0.0);
        let one = TaylorModel::exactly(1.0);
        let root = ((y * x + z).squared() + one).sqrt();
        let chain = root * (one + z.squared()).reciprocal() - x * x * x + z * y.reciprocal();
        for (key, found) in [
            ("sine", sine),
            ("cosine", cosine),
            ("root", y.sqrt()),
            ("reciprocal", y.reciprocal()),
            ("chain", chain),
        ] {
            let [lower, upper] = found.range();
            assert!(
                is_enclosed(lower, upper, &case[key]),
                "{key}: [{lower}, {upper}] for {case}"
            );
            let size = 1.0 + found.constant.abs() + (x.constant * y.constant).abs() + x.constant.abs().powi(3);
            assert!(upper - lower < 1e-11 * size, "{key}: [{lower}, {upper}]");
        }
        let (sine, cosine) = Interval::exactly(x.constant).sine_and_cosine();
        assert!(is_enclosed(sine.lower(), sine.upper(), &case["sine"]), "{case}");
        assert!(is_enclosed(cosine.lower(), cosine.upper(), &case["cosine"]), "{case}");
        let root = Interval::exactly(y.constant).sqrt();
        assert!(is_enclosed(root.lower(), root.upper(), &case["root"]), "{case}");
        let reciprocal = Interval::exactly(1.0) / Interval::exactly(y.constant);
        assert!(
            is_enclosed(reciprocal.lower(), reciprocal.upper(), &case["reciprocal"]),
            "{case}"
        );
    }
}
