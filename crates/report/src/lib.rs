//! Reports on runs: what was asked and found, fronts, trends, the comparison with the reference designs of the study, pictures, and
//! the sensitivity of the results to assumptions.
//!
//! [`Report::make`] collects the data and computes the results; [`Report::write`] writes a folder with `index.html`,
//! which is self-contained and loads nothing, the figures as separate SVG and PNG files, the pictures as PNG, and
//! `fronts.csv`.

mod assumptions;
mod chart;
mod error;
mod figures;
mod fits;
mod fronts;
mod motions;
mod nearby;
mod page;
mod picture;
mod question;
mod reference;
mod side_by_side;
mod source;
mod write;

use std::time::{Duration, Instant};

use rayon::prelude::*;

pub use assumptions::{ClearanceCost, Variation};
pub use error::ReportError;
pub use fits::{AT_BOUND, Fit, Trend, trends};
pub use fronts::{Front, Fronts, SearchFronts, best_intervals};
use motions::DesignMotion;
pub use nearby::Nearby;
pub use reference::EvaluatedReference;
pub use side_by_side::SideBySide;
pub use source::Source;
pub use write::free;

use question::Question;

use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::Architecture;
use kinefront_study::{AlgorithmName, DesignProblem, DriversAlong, Study};

/// Options of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Number of evaluations of each search under an alternative assumption; `None` omits these searches.
    pub sensitivity: Option<usize>,
    /// Width and height of the pictures of designs \[pixels\].
    pub picture: [u32; 2],
    /// Pixels of a figure's PNG per unit of its SVG.
    pub scale: f32,
    /// The command that made the report, as shown on the page.
    pub command: String,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            sensitivity: None,
            picture: [800, 600],
            scale: 2.0,
            command: String::new(),
        }
    }
}

/// What a figure is about, and so where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Topic {
    /// Fronts, or the progress of searches for one objective.
    Fronts,
    /// Lengths along a front.
    Lengths,
    /// Radii of the bars along a front.
    Bars,
    /// Active constraints along a front.
    Active,
    /// Prices along a front.
    Drivers,
    /// Fronts with and without a required clearance.
    Clearance,
    /// Fronts under alternative assumptions.
    Sensitivity,
}

/// A figure of a report.
#[derive(Debug, Clone, PartialEq)]
struct Figure {
    topic: Topic,
    /// File name without its extension.
    name: String,
    /// What the figure shows.
    caption: String,
    svg: String,
}

/// A picture of a design.
#[derive(Debug, Clone, PartialEq)]
struct DesignPicture {
    name: String,
    caption: String,
    evaluation: Evaluation,
    png: Vec<u8>,
}

/// A complete report.
#[derive(Debug, Clone)]
pub struct Report {
    study: Study,
    model: Model,
    options: Options,
    /// Summaries of the searches that the report covers, without their designs.
    sources: Vec<SearchSummary>,
    fronts: Fronts,
    /// Front of the search over all architectures together, if there was one.
    joint: Option<Front>,
    /// Fronts found by MOGA-II (reimplementation).
    moga2: Option<SearchFronts>,
    references: Vec<EvaluatedReference>,
    trends: Vec<(Architecture, Vec<Trend>)>,
    /// What drives the first objective along the front of each architecture.
    drivers: Vec<DriversAlong>,
    /// What alternative assumptions change at designs of the front of each architecture.
    nearby: Vec<Nearby>,
    variations: Vec<Variation>,
    /// What the motion of the study asks of designs of the fronts.
    motions: Vec<DesignMotion>,
    question: Question,
    figures: Vec<Figure>,
    pictures: Vec<DesignPicture>,
    /// Time taken to make the report, including the searches that it runs itself.
    duration: Duration,
}

/// Summary of a search that a report covers.
#[derive(Debug, Clone)]
struct SearchSummary {
    name: String,
    algorithm: AlgorithmName,
    architectures: String,
    seed: u64,
    evaluations: usize,
    feasible: usize,
    search_s: Option<f64>,
    verification_s: Option<f64>,
    version: String,
}

impl SearchSummary {
    fn new(source: &Source) -> Self {
        let names: Vec<&str> = source.study.architectures.iter().map(|found| found.name()).collect();
        Self {
            name: source.name.clone(),
            algorithm: source.study.optimizer.algorithm,
            architectures: names.join(", "),
            seed: source.study.optimizer.seed,
            evaluations: source.rows.len(),
            feasible: source.rows.iter().filter(|row| row.is_feasible()).count(),
            search_s: source.times.map(|times| times.search_s),
            verification_s: source.times.map(|times| times.verification_s),
            version: source.version.clone(),
        }
    }
}

impl Report {
    /// Makes a report on the runs in `sources`, whose studies must state the same problem; their architectures and
    /// search settings may differ. `tell` is called with a progress message at each step.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn make(sources: &[Source], options: Options, tell: &mut dyn FnMut(&str)) -> Result<Self, ReportError> {
        Self::make_with_moga2(sources, &[], options, tell, Instant::now())
    }

    /// Makes a report on a study from scratch: searches each architecture on its own and all architectures together, with the
    /// algorithm of the study and with MOGA-II (reimplementation), and evaluates the results.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn from_scratch(study: &Study, options: Options, tell: &mut dyn FnMut(&str)) -> Result<Self, ReportError> {
        let start = Instant::now();
        let mut searches = |algorithm: AlgorithmName| -> Result<Vec<Source>, ReportError> {
            let alone = study.architectures.iter().map(|&architecture| vec![architecture]);
            let all = std::iter::once(study.architectures.clone());
            alone
                .chain(all)
                .map(|architectures| {
                    let mut study = study.clone();
                    study.optimizer.algorithm = algorithm;
                    let name = match architectures[..] {
                        [architecture] => format!("{architecture} only"),
                        _ => "all architectures".to_owned(),
                    };
                    tell(&format!("searching {name} ({algorithm})"));
                    study.architectures = architectures;
                    Source::run(&name, study)
                })
                .collect()
        };
        let ours = searches(study.optimizer.algorithm)?;
        let theirs = searches(AlgorithmName::Moga2)?;
        Self::make_with_moga2(&ours, &theirs, options, tell, start)
    }

    fn make_with_moga2(
        sources: &[Source],
        moga2: &[Source],
        options: Options,
        tell: &mut dyn FnMut(&str),
        start: Instant,
    ) -> Result<Self, ReportError> {
        let study = common_study(sources)?;
        let problem = DesignProblem::new(&study)?;
        let question = Question::of(&study, &problem, sources);
        check_sensitivity(&options, &question, sources)?;
        let most = study.optimizer.front_designs;
        tell("verifying the fronts");
        let mut fronts = Fronts::new(sources, &problem, most).ok_or(ReportError::NothingFeasible)?;
        let joint = match sources {
            // The front of a single search is the one that has just been verified.
            [_] => Some(fronts.together.clone()),
            _ => fronts::joint(sources, &study, &problem),
        };
        let moga2_fronts = (!moga2.is_empty()).then(|| SearchFronts::new(moga2, &study, &problem));
        let model = problem.model().clone();
        if study.workspace.certify {
            tell("proving the workspaces");
            fronts.certify(&study, &problem);
        }
        let references = reference::all(&study, &model, &fronts);
        let trends = trends_along(&fronts, &question, &study);
        tell("determining prices along the fronts");
        let drivers = problem.drivers_along(&fronts.priced());
        let nearby = nearby::all(&study, &problem, &fronts, tell)?;
        let variations = match options.sensitivity {
            Some(evaluations) => assumptions::search_alternatives(&study, evaluations, tell)?,
            None => Vec::new(),
        };
        let motions = motions::all(&model, &question, &fronts);
        tell("drawing figures and pictures");
        let mut report = Self {
            study,
            model,
            options,
            sources: sources.iter().chain(moga2).map(SearchSummary::new).collect(),
            fronts,
            joint,
            moga2: moga2_fronts,
            references,
            trends,
            drivers,
            nearby,
            variations,
            motions,
            question,
            figures: Vec::new(),
            pictures: Vec::new(),
            duration: Duration::ZERO,
        };
        report.figures = figures::all(&report)?;
        report.pictures = report.draw_pictures()?;
        report.duration = start.elapsed();
        Ok(report)
    }

    fn draw_pictures(&self) -> Result<Vec<DesignPicture>, ReportError> {
        let model = &self.model;
        let marked = self.fronts.alone.iter().flat_map(|(architecture, front)| {
            front
                .marked(&self.question.objectives)
                .into_iter()
                .map(move |(mark, evaluation)| {
                    let name = format!("{}-{}", architecture.name().to_lowercase(), slug(&mark));
                    (name, format!("{architecture}, {mark}"), evaluation)
                })
        });
        let referred = self.references.iter().enumerate().map(|(index, reference)| {
            // The index keeps file names distinct where two names become the same slug.
            let name = &reference.stated.name;
            let file = format!("reference-{}-{}", index + 1, slug(name));
            (file, name.clone(), &reference.fine)
        });
        marked
            .chain(referred)
            .filter(|(.., evaluation)| evaluation.is_feasible())
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|(name, caption, evaluation)| {
                let [width, height] = self.options.picture;
                let range = self.study.workspace.rotation_range_deg;
                let png = picture::picture(model, evaluation, range, [width, height])
                    .and_then(|pixels| chart::pixels_to_png(width, height, &pixels))
                    .map_err(ReportError::of(&name))?;
                Ok(DesignPicture {
                    name,
                    caption,
                    evaluation: evaluation.clone(),
                    png,
                })
            })
            .collect()
    }
}

/// Refuses to vary assumptions where fronts are no curves that can be compared.
fn check_sensitivity(options: &Options, question: &Question, sources: &[Source]) -> Result<(), ReportError> {
    if let (false, Some(_), [first, ..]) = (question.is_of_two(), options.sensitivity, sources) {
        return Err(ReportError::Sensitivity {
            name: first.name.clone(),
            count: question.objectives.len(),
        });
    }
    Ok(())
}

/// Returns the trends along the front of each architecture; none for one objective, whose fronts are single designs.
fn trends_along(fronts: &Fronts, question: &Question, study: &Study) -> Vec<(Architecture, Vec<Trend>)> {
    let along = question.objectives[question.compared()].quantity;
    let curves = fronts.alone.iter().filter(|_| question.objectives.len() > 1);
    let of_each = curves.map(|(architecture, front)| (*architecture, trends(front, &study.bounds, along)));
    of_each.collect()
}

/// Returns the study that all sources have in common, with the architectures of all of them.
fn common_study(sources: &[Source]) -> Result<Study, ReportError> {
    let Some(first) = sources.first() else {
        return Err(ReportError::NothingFeasible);
    };
    let mut study = first.study.clone();
    for other in sources {
        let theirs = &other.study;
        if let Some(key) = study.differing_key(theirs) {
            return Err(ReportError::Differing {
                first: first.name.clone(),
                other: other.name.clone(),
                key,
            });
        }
        study.join(theirs);
    }
    Ok(study)
}

/// Converts a name to a file name: its alphanumeric parts in lower case, joined by hyphens; the mark of an actuated joint stays.
fn slug(name: &str) -> String {
    let parts = name
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-").to_lowercase()
}
