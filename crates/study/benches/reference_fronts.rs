//! Computes reference fronts of the paper's study: the best known fronts, against which optimizers are measured.
//!
//! ```text
//! cargo bench --no-default-features --bench reference_fronts -- make [DIRECTORY]
//! ```
//!
//! Writes `3-PRR.csv`, `3-RPR.csv`, `3-RRR.csv` and `combined.csv` (default: `assets/reference_fronts`), with every
//! radius from the fine grid, by a search far beyond the budget of a usual run. The designs that a file already
//! contains are kept, so the command may be repeated. The search for each architecture consists of:
//!
//! 1. the program's own optimizer: two long runs on the reference grid and one on the fine grid;
//! 2. NSGA-II, which does not use the structure of the problem: a long run on the reference grid;
//! 3. a ladder of radii: at each radius, differential evolution minimises the mass over the geometry, with bars sized
//!    for the radius;
//! 4. the same ladder with an evolution strategy that varies all five lengths at once without sizing, starting from
//!    the best designs so far.

use std::fs;
use std::path::{Path, PathBuf};

use kinefront_model::evaluation::{Evaluation, GridChoice, Model, SizingRanges, WorkspaceTarget};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design};
use kinefront_optimize::{
    Archive, FrontDe, FrontDeSettings, Nsga2, Nsga2Settings, Objectives, Outcome, hypervolume, run, spread,
};
use kinefront_study::{BUILTIN, DesignProblem, Study};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Number of designs kept in a file; thinning a front to this number loses 0.03 % of the hypervolume.
const KEPT: usize = 2000;

/// Number of steps of the ladder of radii.
const LADDER: usize = 96;

/// Number of designs from which a step of the ladder starts, and number of its generations.
const STEP: [usize; 2] = [12, 14];

/// Number of trials of the evolution strategy at a step of the ladder.
const TRIALS: usize = 240;

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let usage = "takes half an hour: cargo bench --no-default-features --bench reference_fronts -- make [DIRECTORY]";
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let directory = match words[..] {
        [] => return println!("{usage}"),
        ["make"] => Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/reference_fronts"),
        ["make", directory] => PathBuf::from(directory),
        _ => {
            eprintln!("{usage}");
            std::process::exit(2);
        }
    };
    fs::create_dir_all(&directory).expect("the folder can be made");
    let study = BUILTIN[0].study().expect("the built-in study is valid");
    let mut combined = Front::default();
    for &architecture in Architecture::PAPER {
        let path = directory.join(format!("{architecture}.csv"));
        let mut front = Front::read(&path, &study);
        Search::new(&study, architecture).improve(&mut front, &path);
        combined.take_all(&front);
        combined.write(&directory.join("combined.csv"));
    }
}

/// Designs that no known design dominates, with values from the fine grid.
#[derive(Default, Clone)]
struct Front(Archive);

impl Front {
    fn take(&mut self, evaluation: &Evaluation) {
        let design = &evaluation.design;
        let mut x = vec![
            Architecture::PAPER
                .iter()
                .position(|known| *known == design.architecture())
                .unwrap_or(0) as f64,
        ];
        x.extend(design.values());
        self.0.insert(0, &x, &DesignProblem::outcome(evaluation));
    }

    fn take_all(&mut self, other: &Front) {
        for member in other.0.iter() {
            let outcome = Outcome {
                objectives: member.objectives,
                violation: 0.0,
            };
            self.0.insert(0, &member.x, &outcome);
        }
    }

    fn designs(&self, study: &Study) -> Vec<(Design, Objectives)> {
        self.0
            .iter()
            .map(|member| {
                let [architecture, lengths @ ..] = member.x.as_slice() else {
                    unreachable!("six values")
                };
                let lengths: [f64; 5] = lengths.try_into().expect("five lengths");
                let design = Design::new(Architecture::PAPER[*architecture as usize], study.working_mode, lengths);
                (design.expect("it was evaluated"), member.objectives)
            })
            .collect()
    }

    /// Reads the designs of a file and evaluates them again; returns an empty front if there is no file.
    fn read(path: &Path, study: &Study) -> Self {
        let mut front = Self::default();
        let Ok(mut reader) = csv::Reader::from_path(path) else {
            return front;
        };
        let designs = reader.records().map(|record| {
            let fields = record.expect("a row");
            let lengths = [1, 2, 3, 4, 5].map(|k| fields[k].parse().expect("a number"));
            Design::new(fields[0].parse().expect("an architecture"), study.working_mode, lengths).expect("a design")
        });
        let designs = designs.collect();
        front.evaluate(&study.model().expect("a valid study"), designs);
        front
    }

    fn evaluate(&mut self, model: &Model, designs: Vec<Design>) {
        let evaluations: Vec<Evaluation> = designs
            .par_iter()
            .map(|design| model.evaluate(design, GridChoice::Fine))
            .collect();
        evaluations.iter().for_each(|evaluation| self.take(evaluation));
    }

    fn write(&self, path: &Path) {
        let mut table = csv::Writer::from_writer(Vec::new());
        let mut row = |fields: Vec<String>| table.write_record(fields).expect("a row");
        let header = ["architecture"]
            .into_iter()
            .chain(DESIGN_VARIABLES.map(|variable| variable.key()));
        let objectives = ["mass_kg", "workspace_radius_m"];
        row(header.chain(objectives).map(str::to_owned).collect());
        let objectives: Vec<Objectives> = self.0.iter().map(|member| member.objectives).collect();
        for place in spread(&objectives, KEPT) {
            let member = &self.0[place];
            let [mass, negative_radius] = [member.objectives[0], member.objectives[1]];
            let numbers = member.x[1..].iter().copied().chain([mass, -negative_radius]);
            let architecture = Architecture::PAPER[member.x[0] as usize];
            row([architecture.to_string()]
                .into_iter()
                .chain(numbers.map(|number| number.to_string()))
                .collect());
        }
        let text = table.into_inner().expect("a table in memory");
        fs::write(path, text).expect("the file can be written");
    }

    fn report(&self, what: &str) {
        let volume = hypervolume(self.0.iter().map(|member| member.objectives), [2000.0, 0.0]);
        let logarithmic = self
            .0
            .iter()
            .map(|member| [member.objectives[0].ln(), member.objectives[1]]);
        println!(
            "{what:40} {:5} designs, {volume:9.3} kg m, {:.5} m ln kg",
            self.0.len(),
            hypervolume(logarithmic, [2000f64.ln(), 0.0])
        );
    }
}

struct Search {
    study: Study,
    architecture: Architecture,
    model: Model,
    ranges: [[f64; 2]; 5],
    bars: SizingRanges,
}

impl Search {
    fn new(study: &Study, architecture: Architecture) -> Self {
        let study = study.with_one_architecture(architecture);
        let ranges = DESIGN_VARIABLES.map(|variable| study.bounds.range(variable));
        Self {
            model: study.model().expect("a valid study"),
            ranges,
            bars: SizingRanges {
                leg: ranges[3],
                platform: ranges[4],
                listed: [None, None],
                is_exact: false,
                scale: [1.0; 2],
            },
            architecture,
            study,
        }
    }

    /// Improves a front step by step, and writes it to a file after each step.
    fn improve(&self, front: &mut Front, path: &Path) {
        let name = self.architecture;
        let keep = |front: &Front, what: &str| {
            front.write(path);
            front.report(&format!("{name}: {what}"));
        };
        keep(front, "at first");
        self.long_runs(front);
        keep(front, "after long runs");
        for round in 0..2 {
            self.ladder(front, round, |known, level, seed| self.step(known, level, seed));
            keep(front, "after the ladder");
            self.ladder(front, round, |known, level, seed| self.shrink(known, level, seed));
            keep(front, "after the evolution strategy");
        }
    }

    fn long_runs(&self, front: &mut Front) {
        let coarse = DesignProblem::new(&self.study).expect("a valid study");
        let fine = DesignProblem::new(&Study {
            grid: kinefront_study::Grids {
                reference: self.study.grid.fine.clone(),
                ..self.study.grid.clone()
            },
            ..self.study.clone()
        })
        .expect("a valid study");
        let settings = FrontDeSettings {
            most: 300,
            ..FrontDeSettings::default()
        };
        let own = |problem: &DesignProblem, evaluations: usize, seed: u64| {
            run(
                problem,
                &mut FrontDe::new(problem.variables(), settings, seed),
                evaluations,
            )
        };
        let plain = Nsga2Settings {
            population: 200,
            ..Nsga2Settings::default()
        };
        let runs: Vec<Archive> = (0..4u64)
            .into_par_iter()
            .map(|run| match run {
                0 => own(&fine, 8000, 101),
                3 => kinefront_optimize::run(&coarse, &mut Nsga2::new(coarse.variables(), plain, 101), 100_000),
                seed => own(&coarse, 30_000, 100 + seed),
            })
            .collect();
        for archive in runs {
            let designs = archive
                .iter()
                .map(|member| coarse.design(&member.x).expect("it was evaluated"));
            front.evaluate(&self.model, designs.collect());
        }
    }

    /// Returns the radii at which the mass is minimised: spread over those of the front and slightly beyond.
    fn levels(&self, front: &Front, round: usize) -> Vec<f64> {
        let radii: Vec<f64> = front.0.iter().map(|member| -member.objectives[1]).collect();
        let (Some(least), Some(most)) = (radii.first(), radii.last()) else {
            return Vec::new();
        };
        let shift = 0.5 * round as f64;
        (0..LADDER)
            .map(|k| least + (most - least) * (k as f64 + shift) / (LADDER as f64 - 1.0))
            .collect()
    }

    /// Minimises the mass at each radius, in parallel, by a function of the known designs, the radius and a random seed.
    fn ladder(
        &self,
        front: &mut Front,
        round: usize,
        minimise: impl Fn(&[(Design, Objectives)], f64, u64) -> Vec<Evaluation> + Sync,
    ) {
        let known = front.designs(&self.study);
        let found: Vec<Vec<Evaluation>> = self
            .levels(front, round)
            .into_par_iter()
            .enumerate()
            .map(|(k, level)| minimise(&known, level, (round * LADDER + k) as u64))
            .collect();
        found.iter().flatten().for_each(|evaluation| front.take(evaluation));
    }

    /// Minimises the mass at one radius by differential evolution of the geometry; returns every evaluation on the
    /// fine grid.
    fn step(&self, known: &[(Design, Objectives)], level: f64, seed: u64) -> Vec<Evaluation> {
        let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
        let mut near = known.to_vec();
        near.sort_by(|a, b| (a.1[1] + level).abs().total_cmp(&(b.1[1] + level).abs()));
        near.truncate(STEP[0]);
        let mut met = Vec::new();
        let mut members: Vec<(Design, f64)> = Vec::new();
        for (design, _) in near {
            members.push((design, self.sized_mass(&design, level, &mut met)));
        }
        for _ in 0..STEP[1] {
            for k in 0..members.len() {
                let best = (0..members.len())
                    .min_by(|&a, &b| members[a].1.total_cmp(&members[b].1))
                    .unwrap_or(k);
                let [a, b] = [0, 1].map(|_| (uniform(&mut random) * members.len() as f64) as usize);
                let mut next = members[k].0.values();
                for j in 0..3 {
                    let at = |i: usize| members[i].0.values()[j];
                    let moved = next[j] + 0.5 * (at(best) - next[j]) + 0.7 * (at(a) - at(b));
                    // A little noise lets members of the population that have become equal separate again.
                    next[j] = (moved * (1.0 + 2e-3 * (uniform(&mut random) - 0.5)))
                        .clamp(self.ranges[j][0], self.ranges[j][1]);
                }
                let Ok(design) = Design::new(self.architecture, self.study.working_mode, next) else {
                    continue;
                };
                let mass = self.sized_mass(&design, level, &mut met);
                if mass <= members[k].1 {
                    members[k] = (design, mass);
                }
            }
        }
        met
    }

    /// Returns the mass of a geometry with bars sized for a radius; it is infinite if the fine grid confirms less than
    /// 90 % of that radius.
    fn sized_mass(&self, design: &Design, level: f64, met: &mut Vec<Evaluation>) -> f64 {
        let sized = self.model.sized(design, &self.bars, WorkspaceTarget::Radius(level));
        let Some(sized) = sized else { return f64::INFINITY };
        let evaluation = self.model.evaluate(&sized, GridChoice::Fine);
        let radius = evaluation.workspace_radius();
        let mass = if radius >= 0.9 * level {
            // A radius that is too small is penalised as if the mass grew with the cube of the radius.
            evaluation.mass() * (level / radius.min(level)).powi(3)
        } else {
            f64::INFINITY
        };
        met.push(evaluation);
        mass
    }

    /// Minimises the mass at one radius by a (1+1) evolution strategy with Rechenberg's one-fifth rule on all five
    /// lengths.
    fn shrink(&self, known: &[(Design, Objectives)], level: f64, seed: u64) -> Vec<Evaluation> {
        let start = known.iter().find(|(_, objectives)| -objectives[1] >= level);
        let Some((mut design, mut mass)) = start.map(|(design, objectives)| (*design, objectives[0])) else {
            return Vec::new();
        };
        let mut random = ChaCha8Rng::seed_from_u64(9000 + seed);
        let mut met = Vec::new();
        let mut width = 0.01;
        for _ in 0..TRIALS {
            let mut next = design.values();
            for (value, range) in next.iter_mut().zip(self.ranges) {
                *value = (*value * (1.0 + width * gauss(&mut random))).clamp(range[0], range[1]);
            }
            let Ok(candidate) = Design::new(self.architecture, self.study.working_mode, next) else {
                continue;
            };
            let lighter = self.model.mass(&candidate) < mass;
            let evaluation = lighter.then(|| self.model.evaluate(&candidate, GridChoice::Fine));
            match evaluation {
                Some(evaluation) if evaluation.workspace_radius() >= level => {
                    (design, mass) = (candidate, evaluation.mass());
                    met.push(evaluation);
                    width *= 1.5;
                }
                _ => width = (width * 0.9).max(1e-6),
            }
        }
        met
    }
}

fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn gauss(random: &mut ChaCha8Rng) -> f64 {
    let radius = libm::sqrt(-2.0 * libm::log(uniform(random).max(f64::MIN_POSITIVE)));
    radius * libm::cos(std::f64::consts::TAU * uniform(random))
}
