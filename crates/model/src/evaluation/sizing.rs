//! Sizing of the bars: determines how thin the bars of a geometry may be for a regular workspace of a given radius, and
//! so the lightest ones (docs/model.md, section 9).
//!
//! Mass and stiffness grow with both bar radii, and neither reach nor dexterity depends on them. For a given geometry
//! and workspace radius, finding the lightest pair of bar radii is therefore a problem of two variables. It is solved
//! on a few rings of the disc, with some hundred poses of which a few dozen matter, whereas an evaluation examines ten
//! thousand. A sized design is therefore only a proposal that must be evaluated.

use std::f64::consts::TAU;

use glam::DVec2;

use super::lightest::{BarMass, Ratios, SizingAccuracy, SizingProblem, StiffnessRatios};
use super::listed::lightest_listed;
use super::pose_columns::{PlacedPose, PoseColumns};
use super::{GridChoice, Model};
use crate::mechanism::{Design, Leg};
use crate::spatial::{LEGS, Rotation, unit};
use crate::workspace::{OrientationGrid, PoseChecker, ValueColumns};

/// Number of directions of a ring over a sector of 120°.
const DIRECTIONS: usize = 16;

/// Radii of the rings on which bars are sized, besides the centre, as fractions of the radius of the disc.
const RINGS: [f64; 4] = [1.0, 0.75, 0.5, 0.25];

/// Number of halvings in the search for the largest radius.
const HALVINGS: usize = 10;

/// What sizing may change.
#[derive(Debug, Clone, PartialEq)]
pub struct SizingRanges {
    /// Range of `r_j` \[m\].
    pub leg: [f64; 2],
    /// Range of `r_p` \[m\].
    pub platform: [f64; 2],
    /// Values of `r_j` and `r_p` within their ranges \[m\], if they are listed.
    pub listed: [Option<Vec<f64>>; 2],
    /// Whether bars for a prescribed region are sized to the last digits, not to 1/1000 of their mass.
    pub is_exact: bool,
    /// Smallest and largest factor by which `R`, `r` and `L_b` may be multiplied, if bars are sized exactly for a prescribed region;
    /// both are 1 if the lengths must stay as they are.
    pub scale: [f64; 2],
}

/// Workspace radius for which bars are sized.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WorkspaceTarget {
    /// A given radius \[m\].
    Radius(f64),
    /// Largest radius that the geometry allows with the thickest bars.
    Largest,
    /// The region that the study prescribes, as it is examined on one of the grids.
    Prescribed(GridChoice),
}

impl Model {
    /// Returns `design` with the lightest bars within `ranges` that provide the required stiffness on the disc of the
    /// workspace radius `target`. The design's own bars are the starting point. Returns `None` if the geometry or the
    /// ranges do not allow such bars.
    ///
    /// Exact sizing for a prescribed region, and nothing else, also multiplies `R`, `r` and `L_b` by a factor within `ranges`.
    ///
    /// The disc and the orientations are sampled, the latter as on the reference grid. The other constraints are
    /// checked only at the centre and on the rim, and the clearance with members as thick as the design's own bars. The
    /// home orientation is the one in which the design is stiffest before it is sized.
    pub fn sized(&self, design: &Design, ranges: &SizingRanges, target: WorkspaceTarget) -> Option<Design> {
        let assembly = self.assembly(design);
        if assembly.value < assembly.threshold {
            return None;
        }
        let grid = match target {
            WorkspaceTarget::Prescribed(grid) => grid,
            WorkspaceTarget::Radius(_) | WorkspaceTarget::Largest => GridChoice::Reference,
        };
        with_leg!(design.architecture, L => Sizer::<L>::new(self, design, ranges, grid).sized(target))
    }
}

/// How the poses of the region are laid out.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    /// On rings of a disc of this radius \[m\].
    Disc(f64),
    /// As the evaluation of a prescribed region examines them.
    Sampled,
}

pub(super) struct Sizer<'a, L> {
    pub(super) model: &'a Model,
    pub(super) design: Design,
    pub(super) ranges: &'a SizingRanges,
    /// Checker of the design, with the thickest bars until a radius is determined.
    checker: PoseChecker<L>,
    /// Arms in every orientation, as on the reference grid.
    pub(super) arms: Vec<[DVec2; LEGS]>,
    pub(super) orientation_grid: OrientationGrid,
    pub(super) sectors: usize,
    pub(super) laid: PoseColumns,
    places: Vec<PlacedPose>,
    pub(super) shape: Shape,
    /// Poses of `laid` that are selected for sizing.
    chosen: PoseColumns,
    values: ValueColumns,
}

impl<'a, L: Leg> Sizer<'a, L> {
    pub(super) fn new(model: &'a Model, design: &Design, ranges: &'a SizingRanges, grid: GridChoice) -> Self {
        let orientation_grid = *model.sampling(grid).orientation_grid();
        let checker = model.checker::<L>(design);
        let arms = (0..orientation_grid.count)
            .map(|k| {
                checker
                    .manipulator
                    .arms(&Rotation::new(orientation_grid.phi_deg(k).to_radians()))
            })
            .collect();
        Self {
            model,
            design: *design,
            ranges,
            checker,
            arms,
            orientation_grid,
            sectors: if model.is_symmetric(design) { 1 } else { LEGS },
            laid: PoseColumns::default(),
            places: Vec::new(),
            shape: Shape::Disc(0.0),
            chosen: PoseColumns::default(),
            values: ValueColumns::default(),
        }
    }

    fn sized(mut self, target: WorkspaceTarget) -> Option<Design> {
        self.set_bars([self.ranges.leg[1], self.ranges.platform[1]]);
        if let WorkspaceTarget::Prescribed(grid) = target {
            return if self.ranges.is_exact {
                self.sized_exactly(grid)
            } else {
                self.sized_prescribed(grid)
            };
        }
        // The candidates are the orientations with a feasible centre that belong to a whole window of such
        // orientations.
        let all: Vec<usize> = (0..self.arms.len()).collect();
        let centres = self.ring(0.0, &all);
        let candidates = self.windows(&centres);
        if candidates.is_empty() {
            return None;
        }
        let radius = match target {
            WorkspaceTarget::Radius(radius) => radius,
            WorkspaceTarget::Largest | WorkspaceTarget::Prescribed(_) => self.largest(&candidates)?,
        };
        let home = self.home(radius, &candidates)?;
        let window: Vec<usize> = self.orientation_grid.window(home).collect();
        self.lay_disc(radius, &window);
        let bars = self.lightest_bars(SizingAccuracy::COARSE)?;
        Some(self.with_bars(bars))
    }

    /// Returns the radii of the lightest bars for the poses that are laid out.
    pub(super) fn lightest_bars(&mut self, accuracy: SizingAccuracy) -> Option<[f64; 2]> {
        let problem = SizingProblem {
            start: [self.design.leg_bar_radius, self.design.platform_bar_radius],
            ranges: [self.ranges.leg, self.ranges.platform],
            mass: self.bar_masses(),
            accuracy,
        };
        let listed = self.ranges.listed.each_ref().map(Option::as_deref);
        lightest_listed(&problem, listed, self)
    }

    fn bar_masses(&self) -> [BarMass; 2] {
        let unit = self.with_bars([1.0, 1.0]);
        let sections = &self.model.sections;
        let squared = [self.model.leg_bars_mass(&unit), self.model.platform_mass(&unit)];
        let legs = LEGS as f64 * self.design.leg_bars_length();
        let mean = self.model.legs.geometry.mean_platform_radius();
        let platform = f64::from(self.model.platform_bars) * mean * self.design.platform_radius;
        let lengths = [legs, platform];
        [0, 1].map(|k| {
            let section = [&sections.legs, &sections.platform][k];
            if section.is_scaled_by_its_radius() {
                BarMass::Squared(squared[k])
            } else {
                BarMass::Of(section.clone(), self.model.material.density, lengths[k])
            }
        })
    }

    pub(super) fn with_bars(&self, [leg, platform]: [f64; 2]) -> Design {
        Design {
            leg_bar_radius: leg,
            platform_bar_radius: platform,
            ..self.design
        }
    }

    /// Runs `look` without the requirement of a clearance: the stiffness ratios do not depend on it.
    fn without_clearance<T>(&mut self, look: impl FnOnce(&mut Self) -> T) -> T {
        let clearance = self.checker.thresholds.clearance.take();
        let found = look(self);
        self.checker.thresholds.clearance = clearance;
        found
    }

    pub(super) fn set_bars(&mut self, bars: [f64; 2]) {
        let design = self.with_bars(bars);
        self.checker.stiffness = self.model.stiffness(&design);
    }

    /// Lays out the ring of a radius in the given orientations, and returns the number of poses in each orientation.
    fn lay_ring(&mut self, radius: f64, orientations: &[usize]) -> usize {
        let count = if radius > 0.0 { DIRECTIONS * self.sectors } else { 1 };
        let step = TAU / (LEGS * DIRECTIONS) as f64;
        let ring: Vec<DVec2> = (0..count).map(|k| self.position(radius, k as f64 * step)).collect();
        self.laid.clear();
        for &orientation in orientations {
            self.laid.extend(&ring, &self.arms[orientation]);
        }
        self.laid.pad();
        count
    }

    /// Lays out the disc of a radius, including its centre. Each ring is rotated by half a step relative to the one
    /// before, so that together they cover more directions.
    fn lay_disc(&mut self, radius: f64, orientations: &[usize]) {
        let step = TAU / (LEGS * DIRECTIONS) as f64;
        let spacing = [radius / RINGS.len() as f64, step];
        self.shape = Shape::Disc(radius);
        self.places.clear();
        for &orientation in orientations {
            self.places.push(PlacedPose {
                orientation,
                place: [0.0, 0.0],
                spacing,
                refined: false,
            });
            for (ring, fraction) in RINGS.iter().enumerate() {
                let offset = if ring % 2 == 0 { 0.0 } else { 0.5 };
                self.places.extend((0..DIRECTIONS * self.sectors).map(|k| PlacedPose {
                    orientation,
                    place: [fraction * radius, (k as f64 + offset) * step],
                    spacing,
                    refined: false,
                }));
            }
        }
        self.laid.clear();
        let of_one = 1 + RINGS.len() * DIRECTIONS * self.sectors;
        let disc: Vec<DVec2> = self.places[..of_one]
            .iter()
            .map(|pose| self.position_of(pose.place))
            .collect();
        for &orientation in orientations {
            self.laid.extend(&disc, &self.arms[orientation]);
        }
        self.laid.pad();
    }

    fn position(&self, radius: f64, angle: f64) -> DVec2 {
        self.model.workspace.centre + unit(angle) * radius
    }

    /// Returns the position of a place in the region.
    fn position_of(&self, [first, second]: [f64; 2]) -> DVec2 {
        match self.shape {
            Shape::Disc(_) => self.position(first, second),
            Shape::Sampled => self.model.workspace.centre + DVec2::new(first, second),
        }
    }

    /// Adds the neighbours of a pose at half its spacing, unless they have already been added. A region that is sampled as the
    /// evaluation does is not refined.
    fn refine(&mut self, pose: usize) {
        let Shape::Disc(disc_radius) = self.shape else {
            return;
        };
        let PlacedPose { place, refined, .. } = self.places[pose];
        if refined {
            return;
        }
        self.places[pose].refined = true;
        let spacing = self.places[pose].spacing.map(|spacing| 0.5 * spacing);
        for [out, round] in [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]] {
            let radius = place[0] + out * spacing[0];
            if radius > 0.0 && radius <= disc_radius {
                let angle = place[1] + round * spacing[1];
                self.places.push(PlacedPose {
                    place: [radius, angle],
                    spacing,
                    refined: false,
                    ..self.places[pose]
                });
            }
        }
    }

    /// Returns the sign of `det A` on the ring for each orientation; `None` if the orientation is not among the given
    /// ones or any pose of the ring is infeasible.
    fn ring(&mut self, radius: f64, orientations: &[usize]) -> Vec<Option<f64>> {
        let count = self.lay_ring(radius, orientations);
        self.signs_of_laid(count, orientations)
    }

    /// Lays out positions relative to the centre in the given orientations.
    pub(super) fn lay_positions(&mut self, positions: &[DVec2], orientations: &[usize]) {
        let centre = self.model.workspace.centre;
        let positions: Vec<DVec2> = positions.iter().map(|position| *position + centre).collect();
        self.laid.clear();
        for &orientation in orientations {
            self.laid.extend(&positions, &self.arms[orientation]);
        }
        self.laid.pad();
    }

    /// Returns the sign of `det A` for each orientation that is laid out with `count` poses; `None` if any of them is
    /// infeasible, and for every other orientation.
    pub(super) fn signs_of_laid(&mut self, count: usize, orientations: &[usize]) -> Vec<Option<f64>> {
        self.laid.values(&self.checker, &mut self.values);
        let mut signs = vec![None; self.arms.len()];
        for (&orientation, first) in orientations.iter().zip((0..).step_by(count)) {
            let mut sign = None;
            let good = (first..first + count).all(|index| {
                self.values.get(index).is_ok_and(|values| {
                    let own = values.determinant.signum();
                    values.determinant != 0.0
                        && *sign.get_or_insert(own) == own
                        && self.checker.thresholds.are_met_by(&values)
                })
            });
            signs[orientation] = sign.filter(|_| good);
        }
        signs
    }

    /// Returns the home orientations whose window has one sign throughout.
    pub(super) fn homes(&self, signs: &[Option<f64>]) -> Vec<usize> {
        self.orientation_grid.homes_of_one_sign(|place| signs[place]).collect()
    }

    /// Returns the orientations in the windows of all home orientations.
    pub(super) fn windows(&self, signs: &[Option<f64>]) -> Vec<usize> {
        let mut inside = vec![false; self.arms.len()];
        for home in self.homes(signs) {
            for k in self.orientation_grid.window(home) {
                inside[k] = true;
            }
        }
        (0..inside.len()).filter(|&k| inside[k]).collect()
    }

    /// Returns the largest radius whose ring is feasible over some window, found by doubling and halving; `None` if no
    /// ring is.
    fn largest(&mut self, candidates: &[usize]) -> Option<f64> {
        let mut candidates = candidates.to_vec();
        let (mut good, mut bad) = (0.0, None);
        let mut radius = self.design.base_radius / 8.0;
        let mut halvings = 0;
        while halvings < HALVINGS && !candidates.is_empty() {
            let signs = self.ring(radius, &candidates);
            let left = self.windows(&signs);
            if left.is_empty() {
                bad = Some(radius);
            } else {
                (good, candidates) = (radius, left);
            }
            radius = match bad {
                None => 2.0 * radius,
                Some(bad) => 0.5 * (good + bad),
            };
            halvings += usize::from(bad.is_some());
        }
        (good > 0.0).then_some(good)
    }

    /// Returns the home orientation in whose window the rim is stiffest with the design's own bars.
    fn home(&mut self, radius: f64, candidates: &[usize]) -> Option<usize> {
        let signs = self.ring(radius, candidates);
        let homes = self.homes(&signs);
        let orientations = self.windows(&signs);
        if homes.len() < 2 {
            return homes.first().copied();
        }
        let count = self.lay_ring(radius, &orientations);
        let ratios = self.ratios_at_all([self.design.leg_bar_radius, self.design.platform_bar_radius]);
        let mut weakest = vec![f64::INFINITY; self.arms.len()];
        for (&orientation, first) in orientations.iter().zip((0..).step_by(count)) {
            for index in first..first + count {
                weakest[orientation] = ratios
                    .iter()
                    .filter(|column| !column.is_empty())
                    .fold(weakest[orientation], |least, column| least.min(column[index]));
            }
        }
        let of_window = |home: usize| {
            self.orientation_grid
                .window(home)
                .fold(f64::INFINITY, |least, k| least.min(weakest[k]))
        };
        homes
            .into_iter()
            .map(|home| (home, of_window(home)))
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
            .map(|(home, _)| home)
    }
}

impl<L: Leg> StiffnessRatios for Sizer<'_, L> {
    fn ratios_at_all(&mut self, bars: [f64; 2]) -> Ratios {
        self.set_bars(bars);
        self.without_clearance(|sizer| sizer.laid.ratios(&sizer.checker, &mut sizer.values))
    }

    fn choose(&mut self, poses: &[usize], weakest: &[usize]) {
        let before = self.places.len();
        for &pose in weakest {
            self.refine(pose);
        }
        if before < self.places.len() {
            self.laid.unpad();
        }
        for place in before..self.places.len() {
            let PlacedPose { orientation, place, .. } = self.places[place];
            let position = self.position_of(place);
            self.laid.push(position, &self.arms[orientation]);
        }
        let poses: Vec<usize> = poses.iter().copied().chain(before..self.places.len()).collect();
        self.laid.pad();
        self.chosen = self.laid.chosen(&poses);
    }

    fn ratios_at_selected(&mut self, bars: [f64; 2]) -> Ratios {
        self.set_bars(bars);
        self.without_clearance(|sizer| sizer.chosen.ratios(&sizer.checker, &mut sizer.values))
    }
}
