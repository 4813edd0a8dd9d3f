//! Proofs about the regular workspace: that every pose of a disc is feasible, and that a pose beyond it is not
//! (docs/model.md, section 13).
//!
//! A grid misses what lies between its points. Here boxes of positions and orientations are enclosed as a whole
//! ([`enclosure`](crate::enclosure)), and divided until each constraint is proved on each of them or a pose is found that violates
//! one.

mod examiner;
mod forms;
mod homes;
mod motion;
mod patch;
mod pose_box;
mod search;

use forms::ProvedForms;
pub use motion::{MotionBounds, MotionCertificate, MotionClaim, MotionMoment, MotionVerdict};
pub use patch::Patch;

use crate::enclosure::{PoseEnclosure, TaylorModel, VARIABLES};
use crate::evaluation::{Evaluation, Model, PoseScalar};
use crate::mechanism::Design;
use crate::spatial::Pose;
use crate::workers::{OneWorker, Workers};

/// What to prove.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifyOptions {
    /// Home orientation `φ_c` \[deg\], the middle of the range of orientations.
    pub phi_deg: f64,
    /// Radius of the disc that is claimed \[m\].
    pub claimed_radius: f64,
    /// Relative gap between the bounds at which the search ends, in (0, 1).
    pub tolerance: f64,
    /// Largest number of boxes.
    pub max_boxes: usize,
    /// Distance from the centre \[m\]: the proof ends once a pose nearer than this is proved infeasible.
    pub enough: f64,
    /// Whether the claim is that every pose of the region is feasible which the study prescribes, instead of a radius.
    pub is_of_region: bool,
    /// Radius from which to prove without looking for infeasible poses, as a check of the proof itself: its lower bound must not
    /// pass an infeasible pose that is known otherwise.
    pub blind_radius: Option<f64>,
}

impl Default for CertifyOptions {
    fn default() -> Self {
        Self {
            phi_deg: 0.0,
            claimed_radius: 0.0,
            tolerance: Self::TOLERANCE,
            max_boxes: Self::MAX_BOXES,
            enough: 0.0,
            is_of_region: false,
            blind_radius: None,
        }
    }
}

impl CertifyOptions {
    /// Tolerance by default.
    pub const TOLERANCE: f64 = 1e-4;
    /// Number of boxes by default.
    pub const MAX_BOXES: usize = 200_000;
}

/// What is proved about a design at one home orientation.
///
/// Where the claim is a prescribed region, `lower` is the radius of the largest disc about its centre within it if the whole region
/// is proved, and 0 otherwise; `upper` is the distance of an infeasible pose of the region from the centre.
///
/// `R*` is the distance from the centre of the nearest pose that violates a constraint, over all orientations of the window.
/// Every statement is about real numbers: lengths, thresholds and the orientation in degrees are the doubles given, and `π`, `√3`
/// and all that follows from them are exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// Radius \[m\] of a disc in which every pose is proved feasible: `lower ≤ R*`.
    pub lower: f64,
    /// Distance \[m\] of a pose that is proved infeasible, `R* ≤ upper`; `None` if none was found.
    pub upper: Option<f64>,
    /// Verdict on the claimed radius.
    pub verdict: Verdict,
    /// The pose at `upper`, and the constraint that it violates.
    pub violation: Option<Violation>,
    /// Number of boxes that were examined.
    pub boxes: usize,
}

/// Verdict on a claimed radius `c` with the tolerance `t`, or on a prescribed region: that every pose of it is feasible, or that one is
/// not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// `lower ≥ (1 − t) c`.
    Proved,
    /// `upper < (1 − t) c`.
    Refuted,
    /// Neither, because the number of boxes was used up, or the proof was ended early.
    OpenBudget,
    /// Neither, because the least value of a constraint equals its threshold to the precision of a double.
    OpenPrecision,
}

/// A box that a proof has finished with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExaminedBox {
    /// Part of the region in which it lies.
    pub patch: Patch,
    /// Lower ends: the coordinates of the position in the patch, and the orientation \[rad\].
    pub lower: [f64; VARIABLES],
    /// Upper ends.
    pub upper: [f64; VARIABLES],
    /// What became of it.
    pub outcome: BoxOutcome,
    /// The scalar whose limit was proved last, or is not proved; where none is known, that which ends the proof.
    pub scalar: PoseScalar,
    /// Number of divisions that led to it.
    pub depth: u32,
}

/// What became of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoxOutcome {
    /// All its poses are feasible.
    Proved,
    /// A pose on it or nearer to the centre is infeasible, so that it is of no interest.
    Beyond,
    /// It could not be decided.
    Undecided,
}

/// Observer of a proof.
pub trait ProofObserver {
    /// Whether the proof goes on; asked every few boxes.
    fn goes_on(&mut self) -> bool {
        true
    }

    /// Whether it takes boxes.
    fn watches_boxes(&self) -> bool {
        false
    }

    /// Takes a box that the proof has finished with.
    fn examined(&mut self, _: &ExaminedBox) {}
}

/// Observes nothing.
impl ProofObserver for () {}

/// A pose at which a limit is violated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Violation {
    /// The pose, as three doubles.
    pub pose: Pose,
    /// The scalar whose limit it violates.
    pub scalar: PoseScalar,
}

/// Why nothing can be proved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CertifyError {
    /// A bar is so thin or so thick that its compliance has no usable value.
    #[error("a bar of the design is so thin or so thick that its stiffness has no usable value")]
    Degenerate,
    /// A scalar is limited at every pose for which there is no form; no study states such a limit.
    #[error("`{}` is limited at every pose, which proofs do not cover", .0.entry().quantity.key)]
    Uncovered(PoseScalar),
    /// An option is out of range.
    #[error("{name} is {value}; it must be {expected}")]
    Option {
        /// Name of the option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The values that are allowed.
        expected: &'static str,
    },
}

impl Certificate {
    /// Relative gap between the bounds; `None` without an upper bound. Two bounds of 0 have no gap.
    pub fn relative_gap(&self) -> Option<f64> {
        let upper = self.upper?;
        Some(if upper > 0.0 { (upper - self.lower) / upper } else { 0.0 })
    }

    /// Whether the bounds are as close as the tolerance asks.
    pub fn is_closed(&self, tolerance: f64) -> bool {
        self.relative_gap().is_some_and(|gap| gap <= tolerance)
    }
}

impl Model {
    /// Returns what is to be proved about an evaluated design: that the region which the study prescribes is feasible in its window, or
    /// its radius at its home orientation; `None` for a design without a workspace.
    pub fn claim(&self, evaluation: &Evaluation) -> Option<CertifyOptions> {
        Some(CertifyOptions {
            phi_deg: evaluation.home_phi_deg?,
            claimed_radius: evaluation.workspace_radius(),
            is_of_region: self.settings().workspace.region.is_prescribed(),
            ..CertifyOptions::default()
        })
    }

    /// Proves bounds of the radius of the disc about the centre in which every pose within the range of orientations about
    /// `phi_deg` is feasible.
    ///
    /// ```
    /// use kinefront_model::certify::{CertifyOptions, Verdict};
    /// use kinefront_model::evaluation::Model;
    ///
    /// let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
    /// let options = CertifyOptions {
    ///     phi_deg: 29.5,
    ///     claimed_radius: 1.221,
    ///     ..CertifyOptions::default()
    /// };
    /// let certificate = Model::default().certify(&design, &options)?;
    /// assert_eq!(certificate.verdict, Verdict::Proved);
    /// assert!(certificate.lower > 1.2209 && certificate.upper.is_some_and(|upper| upper < 1.2212));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CertifyError`]: bars without a usable stiffness, or an option out of range.
    pub fn certify(&self, design: &Design, options: &CertifyOptions) -> Result<Certificate, CertifyError> {
        self.certify_observed(design, options, &mut ())
    }

    /// Proves bounds like [`Model::certify`] with an observer, which may end the proof early; it is open then.
    ///
    /// # Errors
    /// As [`Model::certify`].
    pub fn certify_observed(
        &self,
        design: &Design,
        options: &CertifyOptions,
        observer: &mut dyn ProofObserver,
    ) -> Result<Certificate, CertifyError> {
        self.certify_by(&OneWorker, design, options, observer)
    }

    /// Proves bounds like [`Model::certify_observed`], on several threads where the claim is about a prescribed region, which changes no bit
    /// of the result.
    ///
    /// # Errors
    /// As [`Model::certify`].
    pub fn certify_by(
        &self,
        workers: &dyn Workers,
        design: &Design,
        options: &CertifyOptions,
        observer: &mut dyn ProofObserver,
    ) -> Result<Certificate, CertifyError> {
        if let Some(scalar) = forms::uncovered(&self.thresholds_of(design)) {
            return Err(CertifyError::Uncovered(scalar));
        }
        let is_radius = |value: f64| (0.0..=1e12).contains(&value);
        let CertifyOptions {
            phi_deg: phi,
            claimed_radius: claimed,
            tolerance,
            ..
        } = *options;
        let blind = options.blind_radius.unwrap_or(1.0);
        let checked = [
            ("the home orientation", phi, phi.abs() <= 3600.0, "within ±3600°"),
            ("the claimed radius", claimed, is_radius(claimed), "from 0 to 1e12 m"),
            ("the blind radius", blind, is_radius(blind), "from 0 to 1e12 m"),
            (
                "the tolerance",
                tolerance,
                (1e-12..1.0).contains(&tolerance),
                "from 1e-12 to below 1",
            ),
        ];
        if let Some((name, value, _, expected)) = checked.into_iter().find(|(_, _, is_valid, _)| !is_valid) {
            return Err(CertifyError::Option { name, value, expected });
        }
        search::certify(self, design, options, observer, workers)
    }

    /// Returns a distance that the workspace radius exceeds at no home orientation: with `Certificate::lower` it encloses `R_w`
    /// itself. `proved` is the lower bound; infeasible poses nearer than that are all alike.
    ///
    /// `None` if no bound was found, for a study with a prescribed home orientation, which is the only one, and for a window without
    /// width.
    ///
    /// # Errors
    /// [`CertifyError::Degenerate`]: bars without a usable stiffness.
    pub fn bound_of_homes(&self, design: &Design, proved: f64) -> Result<Option<f64>, CertifyError> {
        homes::upper_bound(self, design, proved)
    }

    /// Encloses the constraints of a design over a box of poses: a constraint holds strictly where all its values are positive, and
    /// but for g7 only there. One that is proved without a value has none. Where a leg may not reach a pose of the box, only the
    /// values of g2 are returned.
    ///
    /// # Errors
    /// [`CertifyError::Degenerate`]: bars without a usable stiffness.
    pub fn enclose(
        &self,
        design: &Design,
        pose: &PoseEnclosure,
    ) -> Result<Vec<(PoseScalar, TaylorModel)>, CertifyError> {
        let forms = forms::Forms::new(self, design)?;
        Ok(forms.enclose(pose, ProvedForms::default()).iter().copied().collect())
    }
}
