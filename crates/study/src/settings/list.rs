//! All settings of a study, in the order of the study file.

use kinefront_model::clearance::Stacking;
use kinefront_model::mechanism::Architecture;

use super::declare::{Check, Initial, Setting, settings};
use super::{
    ActuatorSection, AlgorithmName, AnywhereSection, Bounds, DriveSection, GeometrySection, HypervolumeSection,
    JointSection, LoadSection, MaterialSection, ModelSection, PayloadSection, RailSection, RegionKind,
    RequirementSection, StrengthSection, TaskSection, ToleranceSection, Variables, WHOLE_FRONT, WorkspaceSection,
};

const MOST: i64 = 100_000_000;
const PROBABILITY: Check = Check::Within(0.0, 1.0, "");
const LAYER: Check = Check::Within(-1e3, 1e3, " diameters of the thicker bar");
const PHI_STEP: Check = Check::Within(0.01, 120.0, "");

const SECTIONS: [&[Setting]; 33] = [
    settings!("" {
        name: Check::Name, "Short name, which appears in run folders and recordings.";
        description: Check::Any, "Description of the study in one or two sentences.";
        architectures: Check::Selection(architectures),
            "Architectures to search; with more than one, the architecture is a variable.";
        working_mode: Check::Any, "Working mode of every design: the sign of the inverse kinematics solution of each leg.";
        objectives: Check::Any, "Objectives, one to three: the quantities that are minimized or maximized.";
        quantities: Check::Any, "Quantities that are reported in addition to the objectives and the limited ones.";
        constraints: Check::Any, "Limits of quantities: the smallest or largest value allowed.";
    }),
    MaterialSection::SETTINGS,
    settings!("sections.legs" {
        kind: Check::Choice(&["round", "tube", "square_tube"]), "Cross-section of the bars of the legs.";
        wall_ratio: Check::Any, "Thickness of the wall as a fraction of the outer radius; 1 is a solid bar.";
        wall_m: Check::Any, "Thickness of the wall.";
        catalogue: Check::Any, "Catalogue that the bars are selected from: a built-in name, or the path of a CSV file.";
    }),
    settings!("sections.platform" {
        kind: Check::Choice(&["round", "tube", "square_tube"]), "Cross-section of the bars of the platform.";
        wall_ratio: Check::Any, "Thickness of the wall as a fraction of the outer radius; 1 is a solid bar.";
        wall_m: Check::Any, "Thickness of the wall.";
        catalogue: Check::Any, "Catalogue that the bars are selected from: a built-in name, or the path of a CSV file.";
    }),
    settings!("sections.rails" {
        kind: Check::Choice(&["round", "tube", "square_tube"]), "Cross-section of the rails, if they have a radius.";
        wall_ratio: Check::Any, "Thickness of the wall as a fraction of the outer radius; 1 is a solid rail.";
        wall_m: Check::Any, "Thickness of the wall.";
        catalogue: Check::Any, "Catalogue that the rails are selected from: a built-in name, or the path of a CSV file.";
    }),
    RailSection::SETTINGS,
    ActuatorSection::SETTINGS,
    JointSection::SETTINGS,
    RequirementSection::SETTINGS,
    StrengthSection::SETTINGS,
    PayloadSection::SETTINGS,
    DriveSection::SETTINGS,
    LoadSection::SETTINGS,
    TaskSection::SETTINGS,
    AnywhereSection::SETTINGS,
    ToleranceSection::SETTINGS,
    WorkspaceSection::SETTINGS,
    settings!("workspace.region" {
        kind: Check::Choice(RegionKind::NAMES), "Region of positions: the largest disc, or a prescribed one.";
        radius_m: Check::Any, "Radius of a disc.";
        width_m: Check::Any, "Width of a rectangle along `Ox`.";
        height_m: Check::Any, "Height of a rectangle along `Oy`.";
        corners_m: Check::Any, "Corners of a polygon, relative to the centre of the workspace.";
    }),
    ModelSection::SETTINGS,
    settings!("bodies" {
        slider_length: Check::Positive,
            "Length of a slider along its rail, including the rounded ends, as a multiple of `r_j`.";
        slider_half_width: Check::Positive,
            "Half the width of a slider as a multiple of `r_j`; at most half its length.";
        stacking: Check::Choice(&Stacking::NAMES),
            "Whether all legs share their layers, or may be in layers of their own where the required clearance asks for it.";
    }),
    settings!("bodies.layers" {
        platform: LAYER, "Layer of the platform bars, in diameters of the thicker bar.";
        link: LAYER, "Layer of the links.";
        telescopic_leg: LAYER, "Layer of the telescopic legs.";
        crank: LAYER, "Layer of the cranks.";
        turning_guide: LAYER, "Layer of the guides that turn about a base joint.";
        guide: LAYER, "Layer of the guides on the platform or on sliders.";
        slider: LAYER, "Layer of the sliders.";
    }),
    GeometrySection::SETTINGS,
    Bounds::SETTINGS,
    Variables::SETTINGS,
    settings!("grid.reference" {
        phi_step_deg: PHI_STEP, "Spacing of the orientations of the grid used in the search.";
        directions: Check::Count(3, 3600), "Number of directions over the full turn.";
        ray_steps: Check::Count(1, 10_000), "Number of steps of a ray per length `R`.";
        halvings: Check::Count(0, 40), "Number of halvings of the first failing step of a ray.";
    }),
    settings!("grid.fine" {
        phi_step_deg: PHI_STEP, "Spacing of the orientations of the grid on which reported designs are verified.";
        directions: Check::Count(3, 3600), "Number of directions over the full turn.";
        ray_steps: Check::Count(1, 10_000), "Number of steps of a ray per length `R`.";
        halvings: Check::Count(0, 40), "Number of halvings of the first failing step of a ray.";
    }),
    settings!("optimizer" {
        algorithm: Check::Choice(&AlgorithmName::NAMES), "Algorithm of the search.";
        evaluations: Check::Count(1, MOST), "Number of evaluations, the first sample included.";
        seed: Check::Count(0, i64::MAX), "Random seed, which determines every random draw.";
        time_limit_s: Check::Positive,
            "The search ends after the generation in which this time is reached; the result then depends on the machine.",
            Initial::Number(60.0);
        front_designs: Check::Count(3, WHOLE_FRONT as i64),
            "Number of designs that are reported: those that together cover the front best, including the ends and the knee.";
        threads: Check::Count(1, 1024),
            "Number of worker threads; all cores if omitted. The result does not depend on it.", Initial::Count(2);
    }),
    settings!("optimizer.stagnation" {
        evaluations: Check::Count(1, MOST), "Number of evaluations over which the gain is measured.";
        gain: Check::NonNegative, "Smallest relative gain of the hypervolume with which the search continues.";
    }),
    settings!("optimizer.front_de" {
        generation: Check::Count(2, 65_536), "Number of candidates of a generation.";
        population: Check::Count(4, 65_536), "Initial size of a population; three times as many with three objectives.";
        growth: Check::Count(1, MOST), "Number of evaluations after which a population grows by one member; three times as many with three objectives.";
        most: Check::Count(4, 65_536), "Largest size of a population.";
        neighbours: Check::Count(1, 65_536), "Number of neighbours on either side along the front.";
        scale: Check::Positive, "Scale factor of the differences.";
        crossover: PROBABILITY, "Probability that a variable takes part in a difference.";
        best: PROBABILITY, "Fraction of candidates that get the largest workspace that their geometry allows.";
        learned: PROBABILITY, "Fraction of candidates that a local model of the front proposes, where bars are sized.";
    }),
    settings!("optimizer.moga2" {
        population: Check::Count(2, 65_536), "Population size, which is also the size of the first sample.";
        directional_crossover: PROBABILITY, "Probability of directional crossover.";
        selection: PROBABILITY, "Probability of selection.";
        mutation: PROBABILITY, "Probability of mutation.";
        mutation_ratio: PROBABILITY, "Fraction of the bits that a mutation flips.";
        penalty: Check::NonNegative, "Penalty added to both objectives per unit of violation.";
    }),
    settings!("optimizer.nsga2" {
        population: Check::Count(2, 65_536), "Population size.";
        crossover: PROBABILITY, "Probability that a pair is crossed rather than copied.";
        crossover_index: Check::NonNegative,
            "Distribution index of the crossover: the larger it is, the closer the children are to their parents.";
        mutation: PROBABILITY,
            "Mutation probability of a variable; if omitted, the reciprocal of the number of variables.", Initial::Number(0.2);
        mutation_index: Check::NonNegative, "Distribution index of the mutation.";
    }),
    settings!("optimizer.cma_es" {
        sample: Check::Count(4, 65_536), "Number of candidates of the first sample for each architecture.";
        population: Check::Count(4, 65_536), "Number of candidates of a generation.";
        step: Check::Within(1e-6, 1.0, ""), "Initial step as a fraction of the range of a variable.";
    }),
    HypervolumeSection::SETTINGS,
];

/// Iterates over all settings in the order of the study file. The reference designs are data, not settings.
pub fn settings() -> impl Iterator<Item = &'static Setting> {
    SECTIONS.into_iter().flatten()
}

fn architectures() -> Vec<&'static str> {
    Architecture::ALL
        .iter()
        .map(|architecture| architecture.name())
        .collect()
}
