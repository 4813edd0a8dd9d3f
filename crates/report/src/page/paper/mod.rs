//! Comparison with the 2010 paper, in reports on its study: places of its figures and tables, differences of the numbers
//! and their causes, a check of its claims, and the points that it leaves open.

mod claims;

use maud::{Markup, html};

use super::references::active;
use super::{Section, change, percent};
use crate::reference::better;
use crate::{EvaluatedReference, Report, Variation};
use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design};
use kinefront_scene::text::number;
use kinefront_study::sensitivity::{LARGER_PLATFORM, LARGER_TORQUE, ONE_PLATFORM_BAR};
use kinefront_study::{Builtin, Study};

/// Returns the section, for a study that states the problem of the paper.
pub(super) fn section(report: &Report) -> Option<Section> {
    states_its_problem(&report.study).then(|| Section {
        id: "paper",
        title: "Comparison with the 2010 paper".into(),
        contents: html! {
            (guide(report))
            h3 { "Differences from the paper and their causes" }
            (differences(report))
            h3 { "Claims of the paper and results of this report" }
            (claims::claims(report))
            h3 { "Where the paper is silent or contradicts itself" }
            (silences())
            @if report.moga2.is_some() { (parameters(report)) }
        },
    })
}

/// Whether a study states the problem of the paper.
fn states_its_problem(study: &Study) -> bool {
    let paper = Builtin::find("paper").and_then(|paper| paper.study().ok());
    paper.is_some_and(|mut paper| {
        // The grids and the working mode are choices that the paper leaves open.
        paper.grid.clone_from(&study.grid);
        paper.working_mode = study.working_mode;
        study.differing_key(&paper).is_none()
    })
}

/// Lists where a reader of the paper finds each of its figures and tables on the page.
fn guide(report: &Report) -> Markup {
    let whole = report.moga2.is_some();
    let places = [
        ("Fig. 1, the manipulators", "pictures", "Pictures of designs"),
        (
            "Fig. 2 to 4, flexible models of the legs",
            "made",
            "How this report was made",
        ),
        ("Fig. 5, a regular workspace", "pictures", "Pictures of designs (green)"),
        (
            "Fig. 6, Pareto front",
            "fronts",
            "Designs found, all architectures together",
        ),
        ("Fig. 7, fronts of the three architectures", "fronts", "Designs found"),
        ("Fig. 8, CAD designs", "pictures", "Pictures of designs, ID-I to ID-III"),
        (
            "Fig. 9, R, r and L_b against R_w",
            "variables",
            "Design variables along the fronts",
        ),
        (
            "Fig. 10, r_j and r_p against R_w",
            "variables",
            "Design variables along the fronts",
        ),
        ("Tab. 1, bounds", "made", "How this report was made"),
        (
            "Tab. 2, the parameters of the algorithm",
            "paper",
            "Comparison with the 2010 paper",
        ),
        ("Tab. 3, three Pareto-optimal designs", "designs", "Reference designs"),
    ];
    // Only a report from scratch has the parameters of the paper's algorithm.
    let places = places.into_iter().filter(|(_, id, _)| whole || *id != "paper");
    html! {
        p {
            "Damien Chablat, Stéphane Caro, Raza Ur-Rehman and Philippe Wenger: "
            em { "Comparison of Planar Parallel Manipulator Architectures based on a Multi-objective Design Optimization Approach" }
            ", ASME IDETC/CIE 2010, DETC2010-28650. "
            @if whole { "The study of the paper was repeated from scratch. This page has each of its figures and tables, and explains " }
            @else { "The model, requirements and bounds of this run are those of the paper. This section explains " }
            "where and why the numbers differ."
        }
        details open {
            summary { "Where to find each figure and table of the paper" }
            table { tbody { @for (paper, id, here) in places { tr { td { (paper) } td { a href={ "#" (id) } { (here) } } } } } }
        }
    }
}

/// Tabulates the parameters that the paper gives for its algorithm, with the values used by MOGA-II (reimplementation).
fn parameters(report: &Report) -> Markup {
    let settings = &report.study.optimizer.moga2;
    let generations = report.study.optimizer.evaluations / settings.population.max(1);
    let rows: [(&str, String); 8] = [
        ("scheduler", "MOGA-II (reimplementation)".to_owned()),
        ("number of iterations", generations.to_string()),
        (
            "directional cross-over probability",
            settings.directional_crossover.to_string(),
        ),
        ("selection probability", settings.selection.to_string()),
        ("mutation probability", settings.mutation.to_string()),
        ("DNA string mutation ratio", settings.mutation_ratio.to_string()),
        (
            "DOE algorithm, number of designs",
            format!("Sobol, {}", settings.population),
        ),
        (
            "total number of iterations",
            report.study.optimizer.evaluations.to_string(),
        ),
    ];
    html! { div.scroll { table {
        caption {
            "Parameters of MOGA-II as tabulated in the paper, with the values used by the reimplementation. The "
            "parameters of the other algorithms are in the study below."
        }
        tbody { @for (name, value) in rows { tr { td { (name) } td.number { (value) } } } }
    } } }
}

/// What the paper says about alternative assumptions.
const REASONS: [(&str, &str); 3] = [
    (
        LARGER_PLATFORM,
        "the paper prints this bound, which excludes its own design I",
    ),
    (
        LARGER_TORQUE,
        "the text of the paper has this torque, and its inequality has 10 N·m",
    ),
    (ONE_PLATFORM_BAR, "the equation of the paper counts one bar"),
];

/// Finds the variation under which the `R_w` of a reference design is nearest, by ratio, to the stated one; returns it
/// with that `R_w` \[m\].
fn nearest(report: &Report, place: usize, stated: f64) -> Option<(&Variation, f64)> {
    let off = |radius: f64| libm::log(radius.max(f64::MIN_POSITIVE) / stated).abs();
    let radii = report
        .variations
        .iter()
        .filter_map(|variation| Some((variation, variation.references.get(place)?.workspace_radius())));
    radii.min_by(|(_, a), (_, b)| off(*a).total_cmp(&off(*b)))
}

/// Relative difference of `R_w` from the printed value up to which the page gives no explanation.
const NEAR: f64 = 0.05;

/// Returns the smallest and largest mass of a design whose bar radii round to the printed ones to the nearest millimetre \[kg\].
fn mass_range(model: &Model, design: &Design) -> [f64; 2] {
    [-0.0005, 0.0005].map(|more| {
        let mut values = design.values();
        for variable in DESIGN_VARIABLES.into_iter().filter(|variable| variable.may_be_zero()) {
            let value = &mut values[variable as usize];
            *value = (*value + more).max(0.0);
        }
        design.with_dimensions(values).map_or(0.0, |design| model.mass(&design))
    })
}

/// Explains where and why the numbers differ from those of the paper.
fn differences(report: &Report) -> Markup {
    html! {
        ol {
            li { strong { "Masses. " } (masses(report)) }
            @for (place, reference) in report.references.iter().enumerate() {
                @if let Some(stated) = reference.stated.workspace_radius_m {
                    li { strong { "Workspace of " (reference.stated.name) ". " } (workspace(report, place, reference, stated)) }
                }
            }
            @if report.references.iter().any(|reference| reference.better.is_some()) {
                li { strong { "Lighter designs exist. " } (lighter(report)) }
            }
            @for (name, reason) in REASONS {
                @if report.variations.iter().any(|variation| variation.name() == name) {
                    li { strong { "The alternative “" (name) "”. " } "It is tried because " (reason) "." }
                }
            }
        }
    }
}

fn masses(report: &Report) -> Markup {
    let ranges = report
        .references
        .iter()
        .map(|reference| (reference, mass_range(&report.model, &reference.fine.design)));
    let ranges: Vec<(&EvaluatedReference, [f64; 2])> = ranges.collect();
    let agree = ranges.iter().all(|(reference, [low, high])| {
        reference
            .stated
            .mass_kg
            .is_none_or(|mass| (*low..=*high).contains(&mass))
    });
    html! {
        @if agree { "Every printed mass lies in the range that follows from bar radii rounded to a millimetre: " }
        @else { "Not every printed mass lies in the range that follows from bar radii rounded to a millimetre: " }
        @for (place, (reference, [low, high])) in ranges.iter().enumerate() {
            @if place > 0 { "; " }
            (reference.stated.name) " "
            @if let Some(mass) = reference.stated.mass_kg { (number(mass)) " kg, range " }
            (number(*low)) " … " (number(*high)) " kg"
        }
        ". The mass of the platform is that of three bars: the printed equation has one, but the printed masses require three."
    }
}

fn workspace(report: &Report, place: usize, reference: &EvaluatedReference, stated: f64) -> Markup {
    let found = reference.fine.workspace_radius();
    let ratio = found / stated;
    html! {
        "The paper prints a radius of " (number(stated)) " m; this model gives " (number(found)) " m (" (change(ratio)) "); "
        "the workspace is limited by " (active(&reference.fine)) ". "
        @if (ratio - 1.0).abs() > NEAR {
            @if let Some((variation, radius)) = nearest(report, place, stated) {
                @if variation.alternative.is_none() { "None of the alternative assumptions tried below comes closer. " }
                @else {
                    "Of the alternative assumptions tried below, “" (variation.name()) "” comes closest by ratio, with "
                    (number(radius)) " m (" (change(radius / stated)) "). "
                }
            }
            "The cause of the difference is not known, and no constant of the model was adjusted to remove it. "
        }
    }
}

fn lighter(report: &Report) -> Markup {
    let question = &report.question;
    html! {
        @for reference in &report.references {
            @if let Some(found) = &reference.better {
                "With at least the workspace of " (reference.stated.name) ": " (number(found.mass())) " kg instead of "
                (number(reference.fine.mass())) " kg. "
            }
        }
        @if let Some(moga2_front) = report.moga2.as_ref().and_then(|moga2| moga2.joint.as_ref()) {
            "A reimplementation of MOGA-II, based on what is publicly known of it (grey in the figures), with the "
            "settings of the paper, all architectures together and the same number of evaluations per search, "
            "reaches " (percent(question.hypervolume(moga2_front) / question.hypervolume(&report.fronts.together)))
            " of the hypervolume of the front of all architectures found here. "
            @for reference in &report.references {
                @if let Some(found) = better(moga2_front, &reference.fine) {
                    "With at least the workspace of " (reference.stated.name) ", it finds a design of " (number(found.mass())) " kg. "
                }
            }
            "Under this model, therefore, the search of the paper had not converged, or the model of the paper had requirements "
            "that the paper does not state."
        }
    }
}

/// Points on which the paper is silent or contradicts itself, each with the choice made here.
const SILENCES: [(&str, &str); 11] = [
    (
        "The printed mass of the platform is that of one bar; the printed table of designs requires three.",
        "three bars",
    ),
    (
        "τ_z is 100 N·m in the text, but 10 N·m in the inequality and in g6.",
        "10 N·m",
    ),
    (
        "The table of bounds has r ≥ 0.5 m, but design I has r = 0.319 m.",
        "r ≥ 0.1 m",
    ),
    (
        "The stiffness of the actuators is not given.",
        "1e7 N/m and 1e7 N·m/rad, inferred: the printed R_w of designs II and III require 0.86e7 and 1.14e7",
    ),
    (
        "k_xy, k_z and k_φz are not defined.",
        "k_xy: smaller eigenvalue of the xy block of K; k_z and k_φz: diagonal entries of K",
    ),
    ("The characteristic length is not given.", "r"),
    (
        "The home orientation and the centre of the workspace are not given.",
        "the orientation that gives the largest workspace; centre O",
    ),
    ("G is not given.", "80 GPa"),
    (
        "The length of the beam that models a telescopic leg is not given.",
        "the current length of the leg",
    ),
    (
        "g2 has the travel of the 3-PRR for every architecture, but the text gives the 3-RPR its own range.",
        "for every architecture, the limits of its own legs",
    ),
    (
        "The grid on which poses are checked is not given.",
        "search on a reference grid, verification on a fine grid; both are settings of the study",
    ),
];

fn silences() -> Markup {
    html! { div.scroll { table {
        thead { tr { th.number { "#" } th { "paper" } th { "choice here" } } }
        tbody { @for (index, (paper, here)) in SILENCES.iter().enumerate() {
            tr { td.number { (index + 1) } td { (paper) } td { (here) } }
        } }
    } }
    p { "Every choice except the joint limits of the 3-PRR and 3-RRR is a setting of the study file." } }
}
