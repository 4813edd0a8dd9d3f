//! Optima, prices and relaxations against an independent solver (`fixtures/prices_cases.json`: poses and home orientation continuous,
//! elasticities by multipliers, each confirmed by optimising again), and the identities that prices satisfy.

use glam::DVec2;
use kinefront_model::evaluation::{Better, ModelSettings, Objective, PoseScalar, Quantity};
use kinefront_model::mechanism::{
    Architecture, CrossSection, DESIGN_VARIABLES, Design, DesignVariable, Wall, WorkingMode,
};
use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::{Region, WorkspaceSpec};
use kinefront_optimum::{FreeVariable, LocalProblem, LocalQuestion, Parameter, Polished, Price, Prices, RelaxationOf};
use serde_json::Value;

/// Difference of a price from the independent solver that its stated uncertainty allows.
const PRICE: f64 = 5e-5;

fn case(id: &str) -> Value {
    let text = include_str!("fixtures/prices_cases.json");
    let all: Value = serde_json::from_str(text).expect("the fixture is JSON");
    let cases = all["cases"].as_array().expect("the fixture has cases").clone();
    let found = cases.into_iter().find(|case| case["id"] == id);
    found.expect("the fixture has the case")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The design of a case; it states its architecture itself, or `architecture` does.
fn design_of(case: &Value) -> Design {
    let name = case["architecture"].as_str().expect("an architecture");
    let architecture: Architecture = name.parse().expect("a known architecture");
    let values = DESIGN_VARIABLES.map(|variable: DesignVariable| number(&case["design"][variable.key()]));
    Design::new(architecture, WorkingMode::ALL_PLUS, values).expect("a design")
}

fn rectangle() -> Region {
    Region::Polygon(Polygon::rectangle(0.6, 0.4).expect("a rectangle"))
}

/// Minimises or maximises a quantity.
fn objective(quantity: Quantity, goal: Better) -> Objective {
    Objective { quantity, goal }
}

/// The paper's question about the mass, for a region.
fn question(region: Region) -> LocalQuestion {
    let bounds = [[0.5, 4.0], [0.1, 4.0], [0.5, 4.0], [0.0, 0.1], [0.0, 0.1]];
    let free = |(variable, range)| FreeVariable {
        variable,
        range,
        tied: Vec::new(),
    };
    LocalQuestion {
        settings: ModelSettings::default(),
        workspace: WorkspaceSpec {
            region,
            rotation_range_deg: 20.0,
            centre: DVec2::ZERO,
            home_phi_deg: None,
        },
        objective: objective(Quantity::Mass, Better::Lower),
        variables: DESIGN_VARIABLES.into_iter().zip(bounds).map(free).collect(),
        is_of_bars: false,
        slack: 0.0,
    }
}

/// The paper's problem about the mass of a design, for a region.
fn problem(region: Region, design: &Design) -> LocalProblem {
    LocalProblem::new(question(region), design).expect("a question")
}

/// A design that is not the optimum: with larger lengths and thicker bars.
fn displaced(design: &Design) -> Design {
    let mut moved = design.values();
    for (value, factor) in moved.iter_mut().zip([1.004, 1.003, 1.006, 1.02, 1.01]) {
        *value = (*value * factor).min(4.0);
    }
    design.with_dimensions(moved).expect("a design")
}

fn polished(problem: &LocalProblem, start: &Design) -> Polished {
    let found = problem.best(start, None).expect("an optimum");
    assert!(
        found.is_optimal(),
        "missed {:e}, residual {:e}",
        found.missed,
        found.multipliers.residual
    );
    found
}

fn price<'a>(problem: &LocalProblem, prices: &'a Prices, name: &str) -> &'a Price {
    let is_it = |price: &&Price| price.parameter.name(problem.question()) == name;
    let found = prices.prices.iter().find(is_it);
    found.unwrap_or_else(|| panic!("no price of {name}"))
}

#[track_caller]
fn assert_near(found: f64, expected: &Value, tolerance: f64, what: &str) {
    let off = (found - number(expected)).abs();
    assert!(off < tolerance, "{what}: {found}, expected {expected}");
}

/// Compares all prices of a case.
fn compare(problem: &LocalProblem, prices: &Prices, expected: &Value, tolerance: f64) {
    for (name, expected) in expected.as_object().expect("prices") {
        let expected = expected.get("price").unwrap_or(expected);
        assert_near(price(problem, prices, name).price, expected, tolerance, name);
    }
}

fn check(id: &str, region: Region) {
    let case = case(id);
    let design = design_of(&case);
    let problem = problem(region, &design);
    let found = polished(&problem, &displaced(&design));
    let mass = number(&case["mass_kg"]);
    assert!(
        (found.objective / mass - 1.0).abs() < 1e-8,
        "{id}: {} kg, expected {mass}",
        found.objective
    );
    let prices = problem.prices(&found, true);
    compare(&problem, &prices, &case["prices"], PRICE);
    let of_bars = &case["bars_only"]["prices"];
    for (name, expected) in of_bars.as_object().expect("prices of the bars alone") {
        let found = match name.strip_prefix("design.") {
            Some(key) => {
                let of = |(variable, _): &&(DesignVariable, f64)| variable.key() == key;
                prices.of_dimensions.iter().find(of).map(|(_, price)| *price)
            }
            None => price(&problem, &prices, name).bars_only,
        };
        let found = found.unwrap_or_else(|| panic!("{id}: no price of the bars for {name}"));
        assert_near(found, expected, 1e-4, &format!("{id}: bars alone, {name}"));
    }
    for (name, way) in case["bars_only"]["not_repairable_by_bars"].as_object().expect("ways") {
        let cannot = price(&problem, &prices, name).bars_cannot_repair;
        let place = usize::from(way == "up");
        assert!(
            cannot[place],
            "{id}: thicker bars are no remedy where {name} goes {way}"
        );
    }
}

#[test]
fn a_3_prr_on_a_disc_agrees_with_the_independent_solver() {
    check("b", Region::Disc(1.2));
}

#[test]
fn a_3_rpr_at_a_bound_agrees_with_the_independent_solver() {
    check("d", Region::Disc(0.9));
}

#[test]
fn a_3_prr_for_a_rectangle_agrees_with_the_independent_solver() {
    check("f", rectangle());
}

#[test]
fn tubes_agree_with_the_independent_solver_and_the_walls_with_the_identity_of_equal_walls() {
    let case = case("b-tube-0.2");
    let design = design_of(&case);
    let mut question = question(Region::Disc(1.2));
    question.settings.sections.legs = CrossSection::Tube(Wall::Ratio(0.2));
    question.settings.sections.platform = CrossSection::Tube(Wall::Ratio(0.2));
    let problem = LocalProblem::new(question, &design).expect("a question");
    let found = polished(&problem, &displaced(&design));
    assert!((found.objective / number(&case["mass_kg"]) - 1.0).abs() < 1e-8);
    let prices = problem.prices(&found, false);
    compare(&problem, &prices, &case["prices"], 1e-4);
    let walls = price(&problem, &prices, "wall_legs").price + price(&problem, &prices, "wall_platform").price;
    assert!((walls - 0.54012).abs() < 1e-4, "{walls}");
}

#[test]
fn two_architectures_have_their_own_prices_where_their_masses_meet() {
    let case = case("architectures-meet");
    let mass = number(&case["mass_kg"]);
    for side in ["smaller_radius", "larger_radius"] {
        let branch = &case[side];
        let design = design_of(branch);
        let problem = problem(Region::Disc(number(&case["workspace_radius_m"])), &design);
        let found = polished(&problem, &design);
        assert!(
            (found.objective / mass - 1.0).abs() < 1e-6,
            "{side}: {} kg",
            found.objective
        );
        let prices = problem.prices(&found, false);
        for (name, expected) in branch["prices"].as_object().expect("prices") {
            // Solid bars have no walls.
            if !name.starts_with("wall") {
                let found = price(&problem, &prices, name).price;
                assert_near(found, expected, 1e-3, &format!("{side}, {name}"));
            }
        }
    }
}

#[test]
fn a_convex_kink_has_two_prices() {
    let start: Design = "3-RPR R=0.52 r=0.1 Lb=0.56 rj=0.0065 rp=0.0085"
        .parse()
        .expect("a design");
    let problem = problem(Region::Disc(0.1303449), &start);
    let found = polished(&problem, &start);
    assert!((found.objective - 2.085360).abs() < 2e-6, "{}", found.objective);
    let prices = problem.prices(&found, false);
    let radius = price(&problem, &prices, "workspace_radius");
    assert!(radius.is_kink());
    let [below, above] = radius.one_sided;
    assert!(
        (below - 0.2153).abs() < 3e-3 && (above - 1.9889).abs() < 3e-3,
        "{below} … {above}"
    );
}

#[test]
fn a_wish_needs_the_relaxations_of_the_independent_solver() {
    for (id, of, region) in [("why-not-b", "b", Region::Disc(1.2)), ("why-not-f", "f", rectangle())] {
        let (wish, design) = (case(id), design_of(&case(of)));
        let problem = problem(region, &design);
        let found = polished(&problem, &design);
        let prices = problem.prices(&found, false);
        let relaxations = problem.relaxations(&found, &prices.prices, number(&wish["wished_mass_kg"]));
        for (name, expected) in wish["relaxation"].as_object().expect("relaxations") {
            let is_it = |of: &RelaxationOf| match of {
                RelaxationOf::Single(parameter) => parameter.name(problem.question()) == *name,
                RelaxationOf::AllThresholds => name == "all_thresholds",
                RelaxationOf::LeastNorm => name == "least_norm",
            };
            let found = relaxations.iter().find(|relaxation| is_it(&relaxation.of));
            let found = found.unwrap_or_else(|| panic!("{id}: no relaxation of {name}"));
            match expected["needed"].as_f64() {
                Some(needed) => {
                    let factor = found.needed.unwrap_or_else(|| panic!("{id}: {name} suffices"));
                    assert!(
                        (factor / needed - 1.0).abs() < 5e-4,
                        "{id}, {name}: {factor}, expected {needed}"
                    );
                }
                None => {
                    let (left, expected) = (found.objective, number(&expected["mass_left"]));
                    assert!(
                        found.needed.is_none() && (left / expected - 1.0).abs() < 1e-3,
                        "{id}, {name}: {left}"
                    );
                }
            }
        }
    }
}

#[test]
fn prices_predict_the_optimum_after_a_small_change() {
    let design = design_of(&case("b"));
    let problem = problem(Region::Disc(1.2), &design);
    let found = polished(&problem, &design);
    let prices = problem.prices(&found, false);
    for found_price in prices.prices.iter().filter(|price| price.price.abs() > 1e-3) {
        let steps = problem.steps(&found, found_price.parameter, &[-0.003, 0.003]);
        assert_eq!(steps.len(), 2, "{:?}", found_price.parameter);
        let slope = (steps[1].change - steps[0].change) / 0.006;
        // The rail end has a large third derivative.
        assert!(
            (slope - found_price.price).abs() < 2e-4,
            "{:?}: {slope}, {}",
            found_price.parameter,
            found_price.price
        );
    }
}

#[test]
fn forces_and_lengths_have_no_scale_of_their_own() {
    let mut question = question(Region::Disc(0.6));
    // A limit without a unit is part of neither identity.
    question.settings.thresholds.set(PoseScalar::Transmission, Some(0.3));
    for text in [
        "3-PRR R=1.95 r=0.36 Lb=1.29 rj=0.0145 rp=0.0204",
        "3-RRR R=0.87 r=0.12 Lb=0.68 rj=0.034 rp=0.02",
    ] {
        let start: Design = text.parse().expect("a design");
        let problem = LocalProblem::new(question.clone(), &start).expect("a question");
        let found = polished(&problem, &start);
        let prices = problem.prices(&found, true);
        let of = |name: &str| price(&problem, &prices, name).price;
        let stiffness: f64 = ["k_xy_min", "k_z_min", "k_phi_z_min"].into_iter().map(of).sum();
        let forces = of("E") + of("G") + of("K_act") + stiffness;
        assert!(forces.abs() < 1e-6, "{text}: {forces}");
        assert!((of("E_and_G") - of("E") - of("G")).abs() < 1e-8);
        let is_bound = |price: &&Price| matches!(price.parameter, Parameter::Bound(..));
        let bounds: f64 = prices.prices.iter().filter(is_bound).map(|price| price.price).sum();
        let times = if text.starts_with("3-RRR") { 3.0 } else { 1.0 };
        let lengths = times * of("K_act")
            + of("k_xy_min")
            + of("k_z_min")
            + 3.0 * of("k_phi_z_min")
            + of("workspace_radius")
            + bounds;
        assert!((lengths - 3.0).abs() < 1e-5, "{text}: {lengths}");
        assert!((of("density") - 1.0).abs() < 1e-9);
        for name in [
            "k_xy_min",
            "k_z_min",
            "k_phi_z_min",
            "inverse_condition_min",
            "workspace_radius",
            "rotation_range",
        ] {
            assert!(of(name) > -1e-7, "{text}: a requirement costs, {name} has {}", of(name));
        }
        assert!(of("E_and_G") > -1.0 - 1e-6 && of("E_and_G") < -0.5 + 1e-6);
    }
}

/// A design that keeps its requirements exactly is changed so that it keeps a slack besides, and by no more than that costs.
#[test]
fn an_optimum_keeps_the_slack_that_is_asked_for() {
    let case = case("b");
    let (design, mass) = (design_of(&case), number(&case["mass_kg"]));
    let problem = problem(Region::Disc(1.2), &design);
    let exact = polished(&problem, &displaced(&design));
    for slack in [2e-7, 1e-6, 1e-5] {
        let mut asked = problem.question().clone();
        asked.slack = slack;
        let found = problem.with_question(asked).expect("a question");
        let found = found.polish(&exact.design, exact.home).expect("a design");
        assert!(
            found.is_feasible(),
            "with a slack of {slack:e}, {:e} is missed",
            found.missed
        );
        assert!(
            (found.objective / mass - 1.0).abs() < 20.0 * slack,
            "{} kg",
            found.objective
        );
    }
}

#[test]
fn a_question_without_a_local_problem_says_so() {
    let start: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
        .parse()
        .expect("a design");
    let largest = LocalProblem::new(question(Region::Largest), &start).expect_err("the radius is not known");
    assert!(largest.to_string().contains("radius must be known"), "{largest}");
    let mut question = question(Region::Disc(1.0));
    question.objective.quantity = Quantity::DexterityMean;
    let mean = LocalProblem::new(question, &start).expect_err("a mean is none of poses");
    assert!(mean.to_string().contains("dexterity_mean"), "{mean}");
}

#[test]
fn the_largest_radius_is_an_objective_like_the_mass() {
    let design = design_of(&case("b"));
    let mut question = question(Region::Disc(1.0));
    let mass = objective(Quantity::Mass, Better::Lower);
    question.hold(mass, number(&case("b")["mass_kg"]));
    question.objective = objective(Quantity::WorkspaceRadius, Better::Higher);
    let problem = LocalProblem::new(question, &design).expect("a question");
    let found = polished(&problem, &design);
    assert!(
        (found.objective - 1.2).abs() < 1e-8,
        "the same design is the optimum of both: {}",
        found.objective
    );
    let prices = problem.prices(&found, false);
    let stiffness = price(&problem, &prices, "k_z_min").price;
    assert!(
        (stiffness + 0.16263).abs() < PRICE,
        "the radius price of k_z: {stiffness}"
    );
}
