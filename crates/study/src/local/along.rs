//! What drives the objective along a front.

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::Architecture;
use kinefront_optimum::ParameterKind;
use rayon::prelude::*;
use serde::Serialize;

use super::crossings::{Crossing, CrossingJson, Placed};
use super::{Drivers, DriversOptions};
use crate::DesignProblem;

/// Least price of a bound or a travel that is told \[% for 1 %\].
const TOLD: f64 = 0.05;

/// Factor between the largest price of a plot and the usual ones from which the plot leaves it out.
const BEYOND: f64 = 3.0;

/// What drives the first objective at designs of a front that have the same architecture.
#[derive(Debug, Clone)]
pub struct DriversAlong {
    /// The architecture of the designs.
    pub architecture: Architecture,
    /// The quantity along which the designs are ordered: the second objective, or the only one.
    pub along: Quantity,
    /// Each design that has prices: its index among the evaluations that were given, its value of that quantity, and its drivers.
    pub designs: Vec<(usize, f64, Drivers)>,
    /// Where other architectures take over from this one, this one from others, and one of its families from another, in the order of their
    /// places.
    pub crossings: Vec<Crossing>,
    /// Number of designs that have no prices.
    pub without: usize,
}

/// The price of a parameter along a front.
#[derive(Debug, Clone, PartialEq)]
pub struct PriceCurve {
    /// Name of the parameter.
    pub parameter: String,
    /// Name for a person.
    pub label: String,
    /// What the parameter is part of.
    pub kind: ParameterKind,
    /// Value of the quantity along the front, and the price there.
    pub points: Vec<[f64; 2]>,
}

/// A part of a front with the parameter that drives the objective there.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenPart {
    /// Name of the parameter for a person.
    pub label: String,
    /// Values of the quantity along the front at the first and the last design.
    pub range: [f64; 2],
    /// The price at each design.
    pub prices: Vec<f64>,
}

impl DesignProblem {
    /// Determines what drives the first objective at each design of a front that was evaluated on the fine grid, in parallel. There is one
    /// entry for each architecture.
    pub fn drivers_along(&self, evaluations: &[Evaluation]) -> Vec<DriversAlong> {
        let objectives = &self.model().settings().objectives;
        let Some(place) = objectives.len().checked_sub(1).map(|last| last.min(1)) else {
            return Vec::new();
        };
        let along = &objectives[place];
        let found: Vec<Option<(Placed<'_>, Drivers)>> = evaluations
            .par_iter()
            .map(|evaluation| {
                let local = self.local_of(evaluation, &[]).ok()?;
                // A design of a front has its optimum near its own home orientation; a search of all others would take a second.
                let optimum = local.optimum()?;
                let drivers = local.drivers_of(&local.problem, &optimum, DriversOptions::default());
                let placed = Placed {
                    at: along.value(evaluation.objectives[place]),
                    evaluation,
                    local,
                    optimum,
                };
                (!drivers.prices.is_empty()).then_some((placed, drivers))
            })
            .collect();
        let has_designs = |architecture: &&Architecture| {
            let mut designs = evaluations.iter().map(|evaluation| &evaluation.design);
            designs.any(|design| design.architecture() == **architecture)
        };
        let front = |architecture: &Architecture| DriversAlong {
            architecture: *architecture,
            along: along.quantity,
            designs: Vec::new(),
            crossings: Vec::new(),
            without: 0,
        };
        let mut fronts: Vec<DriversAlong> = Architecture::ALL.iter().filter(has_designs).map(front).collect();
        let crossings = self.crossings(found.iter().flatten().map(|(placed, _)| placed).collect());
        for (index, (evaluation, found)) in evaluations.iter().zip(found).enumerate() {
            let is_own = |front: &&mut DriversAlong| front.architecture == evaluation.design.architecture();
            let Some(front) = fronts.iter_mut().find(is_own) else {
                continue;
            };
            match found {
                Some((placed, drivers)) => front.designs.push((index, placed.at, drivers)),
                None => front.without += 1,
            }
        }
        for front in &mut fronts {
            front.designs.sort_by(|a, b| a.1.total_cmp(&b.1));
            let own = crossings.iter().filter(|crossing| crossing.is_of(front.architecture));
            front.crossings.extend(own);
        }
        fronts
    }
}

impl DriversAlong {
    /// Returns the price of each parameter of some kinds along the front, those with the largest prices first. A design at which a
    /// parameter has no price is a point at 0.
    pub fn curves(&self, kinds: &[ParameterKind]) -> Vec<PriceCurve> {
        let mut curves: Vec<PriceCurve> = Vec::new();
        for price in self.designs.iter().flat_map(|(_, _, drivers)| &drivers.prices) {
            if kinds.contains(&price.kind) && curves.iter().all(|curve| curve.parameter != price.parameter) {
                let points = self.designs.iter().map(|(_, at, drivers)| {
                    let own = drivers.prices.iter().find(|own| own.parameter == price.parameter);
                    [*at, own.map_or(0.0, |own| own.price)]
                });
                curves.push(PriceCurve {
                    parameter: price.parameter.clone(),
                    label: price.label.clone(),
                    kind: price.kind,
                    points: points.collect(),
                });
            }
        }
        curves.sort_by(|a, b| b.largest().total_cmp(&a.largest()));
        curves
    }

    /// Returns the parts of the front, in its order, in each of which one limit has the largest price. A single design between
    /// two parts of another limit belongs to them.
    pub fn leading(&self) -> Vec<DrivenPart> {
        let dearest = |drivers: &Drivers| {
            let limits = drivers
                .prices
                .iter()
                .filter(|price| price.kind == ParameterKind::Limit && price.price > TOLD);
            let dearest = limits.max_by(|a, b| a.price.total_cmp(&b.price))?;
            Some((dearest.label.clone(), dearest.price))
        };
        let mut parts: Vec<DrivenPart> = Vec::new();
        for (_, at, drivers) in &self.designs {
            let Some((label, price)) = dearest(drivers) else {
                continue;
            };
            match parts.last_mut().filter(|part| part.label == label) {
                Some(part) => part.grow(*at, price),
                None => parts.push(DrivenPart::new(label, *at, price)),
            }
            // A part of one design between two parts of one limit is within them.
            if let [.., before, odd, after] = parts.as_slice()
                && odd.prices.len() == 1
                && before.label == after.label
            {
                let joined = DrivenPart {
                    label: before.label.clone(),
                    range: [before.range[0], after.range[1]],
                    prices: [&*before.prices, &after.prices].concat(),
                };
                parts.truncate(parts.len() - 3);
                parts.push(joined);
            }
        }
        parts
    }

    /// Returns the bounds and the travels that have a price, each with the part of the front where it has one, the longest part first.
    pub fn in_the_way(&self) -> Vec<DrivenPart> {
        let curves = self.curves(&[ParameterKind::Bound, ParameterKind::Travel]);
        let of = |curve: PriceCurve| {
            let mut dear = curve.points.iter().filter(|[_, price]| price.abs() >= TOLD);
            let [at, price] = *dear.next()?;
            let mut part = DrivenPart::new(curve.label, at, price);
            dear.for_each(|[at, price]| part.grow(*at, *price));
            Some(part)
        };
        let mut parts: Vec<DrivenPart> = curves.into_iter().filter_map(of).collect();
        parts.sort_by_key(|part| std::cmp::Reverse(part.prices.len()));
        parts
    }

    /// Tells in sentences what drives the objective along the front.
    pub fn sentences(&self) -> Vec<String> {
        let objective = self
            .designs
            .first()
            .map_or("", |(_, _, drivers)| drivers.objective_name().0);
        let limits = self.leading().into_iter().map(|part| {
            let (place, price) = (self.place(&part), part.median());
            format!(
                "Among the limits, {} drives the {objective} {place}: an increase of the limit by 1 % changes the {objective} by {price:+.2} %.",
                part.label
            )
        });
        let bounds = self.in_the_way().into_iter().map(|part| {
            let (place, price) = (self.place(&part), part.median());
            format!(
                "The {} restricts the {objective} {place}: an increase of this value by 1 % changes the {objective} by {price:+.2} %.",
                part.label
            )
        });
        let crossings = self.crossings.iter().map(|crossing| {
            let entry = self.along.entry();
            let (change, [below, above]) = (crossing.change(), crossing.prices);
            format!(
                "{change} at {} {:.4} {}: an increase of this value by 1 % changes the {objective} by {below:+.2} % just below it and by {above:+.2} % \
                 just above it.",
                entry.short, crossing.at, entry.unit
            )
        });
        let without = match self.without {
            0 => None,
            1 => Some("1 design has no prices: no optimum was found near it.".to_owned()),
            count => Some(format!(
                "{count} designs have no prices: no optimum was found near them."
            )),
        };
        limits.chain(bounds).chain(crossings).chain(without).collect()
    }

    /// Returns where a part is, in words.
    fn place(&self, part: &DrivenPart) -> String {
        let entry = self.along.entry();
        let [from, to] = part.range;
        match part.prices.len() {
            count if count == self.designs.len() => "along the whole front".to_owned(),
            1 => format!("at {} {from:.3} {}", entry.short, entry.unit),
            _ => format!("for {} from {from:.3} to {to:.3} {}", entry.short, entry.unit),
        }
    }
}

/// Returns curves each of which is on top of those before it. Negative prices count as 0.
pub fn stacked(curves: &[PriceCurve]) -> Vec<PriceCurve> {
    let mut stacked: Vec<PriceCurve> = Vec::new();
    for curve in curves {
        let below = stacked.last().map(|below| &below.points);
        let points = curve.points.iter().enumerate().map(|(place, [at, price])| {
            let base = below.map_or(0.0, |below| below[place][1]);
            [*at, base + price.max(0.0)]
        });
        let points = points.collect();
        stacked.push(PriceCurve {
            points,
            ..curve.clone()
        });
    }
    stacked
}

/// Returns the range of a plot that shows the prices of most designs: at the end of a front, beyond which there is no design, prices grow
/// beyond any measure.
pub fn usual_range(curves: &[PriceCurve]) -> [f64; 2] {
    let designs = curves.first().map_or(0, |curve| curve.points.len());
    let extremes = |place: usize| {
        let prices = curves.iter().map(|curve| curve.points[place][1]);
        prices.fold([0.0_f64; 2], |[low, high], price| [low.min(price), high.max(price)])
    };
    let mut sides = [Vec::new(), Vec::new()];
    for [low, high] in (0..designs).map(extremes) {
        sides[0].push(-low);
        sides[1].push(high);
    }
    let [low, high] = sides.map(|mut side| {
        side.sort_by(f64::total_cmp);
        let most = side.last().copied().unwrap_or(0.0);
        let usual = side.get(side.len() * 9 / 10).copied().unwrap_or(0.0);
        if most > BEYOND * usual && usual > 0.0 {
            1.2 * usual
        } else {
            1.05 * most
        }
    });
    [-low, high]
}

/// What drives the first objective along the front of an architecture, as other programs read it.
#[derive(Debug, Clone, Serialize)]
pub struct AlongJson<'a> {
    /// Name of the architecture.
    pub architecture: String,
    /// Key of the quantity along which the designs are ordered.
    pub along: &'static str,
    /// What drives it, in sentences.
    pub sentences: Vec<String>,
    /// The designs in their order.
    pub designs: Vec<PricedDesignJson<'a>>,
    /// Number of designs that have no prices.
    pub without_prices: usize,
    /// Where the best architecture or the best family of designs changes.
    pub crossings: Vec<CrossingJson>,
}

/// A design with what drives its first objective.
#[derive(Debug, Clone, Serialize)]
pub struct PricedDesignJson<'a> {
    /// Id of the design.
    pub id: usize,
    /// Its value of the quantity along which the designs are ordered.
    pub at: f64,
    /// What drives its first objective.
    pub drivers: &'a Drivers,
}

impl DriversAlong {
    /// Returns what other programs read; `ids` are those of the designs that were given.
    pub fn to_json(&self, ids: &[usize]) -> AlongJson<'_> {
        let designs = self.designs.iter().map(|(index, at, drivers)| PricedDesignJson {
            id: ids.get(*index).copied().unwrap_or(*index),
            at: *at,
            drivers,
        });
        AlongJson {
            architecture: self.architecture.to_string(),
            along: self.along.entry().key,
            sentences: self.sentences(),
            designs: designs.collect(),
            without_prices: self.without,
            crossings: self.crossings.iter().map(|crossing| crossing.to_json()).collect(),
        }
    }
}

impl PriceCurve {
    /// Returns whether prices of at least `least` are usual: a tenth of the designs has them.
    pub fn is_usual(&self, least: f64) -> bool {
        let dear = self.points.iter().filter(|[_, price]| price.abs() >= least).count();
        10 * dear >= self.points.len()
    }

    /// Returns the largest absolute price.
    pub fn largest(&self) -> f64 {
        self.points.iter().fold(0.0, |most, [_, price]| most.max(price.abs()))
    }
}

impl DrivenPart {
    fn new(label: String, at: f64, price: f64) -> Self {
        Self {
            label,
            range: [at; 2],
            prices: vec![price],
        }
    }

    fn grow(&mut self, at: f64, price: f64) {
        self.range[1] = at;
        self.prices.push(price);
    }

    /// Returns the median of the prices.
    pub fn median(&self) -> f64 {
        let mut prices = self.prices.clone();
        prices.sort_by(f64::total_cmp);
        prices.get(prices.len() / 2).copied().unwrap_or(0.0)
    }
}
