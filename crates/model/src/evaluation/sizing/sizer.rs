//! A geometry whose bars are sized: the poses at which they are, and the ratios of the stiffness to the limits there.

use glam::DVec2;

use super::SizingRanges;
use super::lightest::{BarMass, Ratios, SizingAccuracy, SizingProblem, StiffnessRatios};
use super::listed::lightest_listed;
use super::pose_columns::{PlacedPose, PoseColumns};
use crate::evaluation::{GridChoice, Model};
use crate::mechanism::{Design, Leg};
use crate::pose::{PoseChecker, PoseScalar};
use crate::spatial::{LEGS, Rotation, unit};
use crate::workspace::{OrientationGrid, ValueColumns};

/// How the poses of the region are laid out.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    /// On rings of a disc of this radius \[m\].
    Disc(f64),
    /// As the evaluation of a prescribed region examines them.
    Sampled,
}

pub(super) struct Sizer<'a, L> {
    pub model: &'a Model,
    pub design: Design,
    pub ranges: &'a SizingRanges,
    /// Checker of the design, with the thickest bars until a radius is determined.
    pub checker: PoseChecker<L>,
    /// Arms in every orientation, as on the reference grid.
    pub arms: Vec<[DVec2; LEGS]>,
    pub orientation_grid: OrientationGrid,
    pub sectors: usize,
    pub laid: PoseColumns,
    pub places: Vec<PlacedPose>,
    pub shape: Shape,
    /// Poses of `laid` that are selected for sizing.
    chosen: PoseColumns,
    values: ValueColumns,
}

impl<'a, L: Leg> Sizer<'a, L> {
    pub fn new(model: &'a Model, design: &Design, ranges: &'a SizingRanges, grid: GridChoice) -> Self {
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
            sectors: match model.is_symmetric_in(design, checker.bodies.stack().order) {
                true => 1,
                false => LEGS,
            },
            checker,
            arms,
            orientation_grid,
            laid: PoseColumns::default(),
            places: Vec::new(),
            shape: Shape::Disc(0.0),
            chosen: PoseColumns::default(),
            values: ValueColumns::default(),
        }
    }

    /// Returns the radii of the lightest bars for the poses that are laid out.
    pub fn lightest_bars(&mut self, accuracy: SizingAccuracy) -> Option<[f64; 2]> {
        let problem = SizingProblem {
            start: [self.design.leg_bar_radius(), self.design.platform_bar_radius()],
            ranges: [self.ranges.leg, self.ranges.platform],
            mass: self.bar_masses(),
            accuracy,
        };
        let listed = self.ranges.listed.each_ref().map(Option::as_deref);
        lightest_listed(&problem, listed, self)
    }

    fn bar_masses(&self) -> [BarMass; 2] {
        let unit = self.design.with_bars([1.0, 1.0]);
        let sections = &self.model.settings().sections;
        let squared = [self.model.leg_bars_mass(&unit), self.model.platform_mass(&unit)];
        let legs = LEGS as f64 * self.design.leg_bars_length();
        let mean = self.model.settings().legs.geometry.mean_platform_radius();
        let platform = f64::from(self.model.settings().platform_bars) * mean * self.design.platform_radius();
        let lengths = [legs, platform];
        [0, 1].map(|k| {
            let section = [&sections.legs, &sections.platform][k];
            if section.is_scaled_by_its_radius() {
                BarMass::Squared(squared[k])
            } else {
                BarMass::Of(section.clone(), self.model.settings().material.density, lengths[k])
            }
        })
    }

    /// Runs `look` without the requirement of a clearance: the stiffness ratios do not depend on it.
    fn without_clearance<T>(&mut self, look: impl FnOnce(&mut Self) -> T) -> T {
        let clearance = self.checker.thresholds.get(PoseScalar::Clearance);
        self.checker.set_threshold(PoseScalar::Clearance, None);
        let found = look(self);
        self.checker.set_threshold(PoseScalar::Clearance, clearance);
        found
    }

    pub fn set_bars(&mut self, bars: [f64; 2]) {
        let design = self.design.with_bars(bars);
        self.checker.stiffness = self.model.stiffness(&design);
        self.checker.strength = self.model.strength_if_asked(&design, self.checker.stiffness.as_ref());
        self.checker.dynamics = self.model.dynamics_if_asked(&design, self.checker.stiffness.as_ref());
    }

    pub fn position(&self, radius: f64, angle: f64) -> DVec2 {
        self.model.settings().workspace.centre + unit(angle) * radius
    }

    /// Returns the position of a place in the region.
    pub fn position_of(&self, [first, second]: [f64; 2]) -> DVec2 {
        match self.shape {
            Shape::Disc(_) => self.position(first, second),
            Shape::Sampled => self.model.settings().workspace.centre + DVec2::new(first, second),
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

    /// Lays out positions relative to the centre in the given orientations.
    pub fn lay_positions(&mut self, positions: &[DVec2], orientations: &[usize]) {
        let centre = self.model.settings().workspace.centre;
        let positions: Vec<DVec2> = positions.iter().map(|position| *position + centre).collect();
        self.lay(&positions, orientations);
    }

    /// Lays out positions in the base frame in the given orientations.
    pub fn lay(&mut self, positions: &[DVec2], orientations: &[usize]) {
        self.laid.clear();
        for &orientation in orientations {
            self.laid.extend(positions, &self.arms[orientation]);
        }
        self.laid.pad();
    }

    /// Returns the sign of `det A` for each orientation that is laid out with `count` poses; `None` if any of them is
    /// infeasible, and for every other orientation.
    pub fn signs_of_laid(&mut self, count: usize, orientations: &[usize]) -> Vec<Option<f64>> {
        self.laid.values(&self.checker, &mut self.values);
        let limits: Vec<(PoseScalar, f64)> = self.checker.thresholds.iter().collect();
        let mut signs = vec![None; self.arms.len()];
        for (&orientation, first) in orientations.iter().zip((0..).step_by(count)) {
            let mut sign = None;
            let good = (first..first + count).all(|index| self.values.keeps(index, &limits, &mut sign));
            signs[orientation] = sign.filter(|_| good);
        }
        signs
    }

    /// Returns the home orientations whose window has one sign throughout.
    pub fn homes(&self, signs: &[Option<f64>]) -> Vec<usize> {
        self.orientation_grid.homes_of_one_sign(|place| signs[place]).collect()
    }

    /// Returns the orientations in the windows of all home orientations.
    pub fn windows(&self, signs: &[Option<f64>]) -> Vec<usize> {
        let mut inside = vec![false; self.arms.len()];
        for home in self.homes(signs) {
            for k in self.orientation_grid.window(home) {
                inside[k] = true;
            }
        }
        (0..inside.len()).filter(|&k| inside[k]).collect()
    }

    /// Sorts home orientations by the ratios of their windows at the poses that are laid out, `count` for each of `orientations`: the
    /// one that is stiffest with the design's own bars comes first.
    pub fn stiffest_first(&mut self, homes: Vec<usize>, count: usize, orientations: &[usize]) -> Vec<usize> {
        let ratios = self.ratios_at_all([self.design.leg_bar_radius(), self.design.platform_bar_radius()]);
        let mut weakest = vec![f64::INFINITY; self.arms.len()];
        for (&orientation, first) in orientations.iter().zip((0..).step_by(count)) {
            let poses = ratios.iter().flat_map(|column| &column[first..first + count]);
            weakest[orientation] = poses.fold(weakest[orientation], |least, ratio| least.min(*ratio));
        }
        let of_window = |home: usize| {
            let window = self.orientation_grid.window(home);
            (home, window.fold(f64::INFINITY, |least, k| least.min(weakest[k])))
        };
        let mut homes: Vec<(usize, f64)> = homes.into_iter().map(of_window).collect();
        homes.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        homes.into_iter().map(|(home, _)| home).collect()
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
