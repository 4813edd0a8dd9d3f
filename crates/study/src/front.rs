//! The reported front of a run: its designs, each with what is proved about its workspace (docs/model.md, section 13.5).

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{CertifiedWorkspace, DesignProblem, Row, TableRow};
use kinefront_model::certify::{Certificate, CertifyOptions};
use kinefront_model::evaluation::{Evaluation, Objective};
use kinefront_optimize::Objectives;

/// A design of the verified front.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontMember {
    /// Id of its evaluation; a thickened design has an id after those of the search.
    pub id: usize,
    /// Generation of its evaluation; that of the design from which it was thickened.
    pub generation: usize,
    /// Evaluation of the design on the fine grid. Its `R_w` is the one that is reported: the lower bound of the certificate, if
    /// there is one.
    pub evaluation: Evaluation,
    /// `R_w` on the reference grid \[m\].
    pub reference_radius: f64,
    /// What is proved about `R_w`; `None` if the study asks for no proof, or none is possible.
    pub certified: Option<CertifiedWorkspace>,
}

/// What the certificates of a front found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FrontProofs {
    /// Relative tolerance of the certificates.
    pub tolerance: f64,
    /// Designs of `front.csv` whose radius is proved.
    pub proved: usize,
    /// Designs of `front.csv` whose proof is not complete.
    pub open: usize,
    /// Designs that were left out: nothing is proved about them, or with the proved radius another design of the front is
    /// lighter and has a larger workspace.
    pub dropped: usize,
    /// Hypervolume of `front.csv` in the product of the units of the objectives, whatever the key says.
    pub hypervolume_kg_m: f64,
    /// Designs for which a pose within the radius of the fine grid was proved infeasible.
    pub refuted: Vec<RefutedDesign>,
}

/// A design whose radius on the fine grid was refuted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RefutedDesign {
    /// Id of the design.
    pub id: usize,
    /// `R_w` on the fine grid \[m\].
    pub fine_radius_m: f64,
    /// Distance from the centre of the workspace of the infeasible pose \[m\].
    pub infeasible_at_m: f64,
    /// Constraint that the pose violates.
    pub constraint: String,
    /// Least margin of this constraint that was found within the radius of the fine grid.
    pub margin: f64,
    /// The design with thicker bars that is reported instead, if its workspace is restored.
    pub thickened: Option<ThickenedDesign>,
}

/// A design that is reported instead of a refuted one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ThickenedDesign {
    /// Id of the new design.
    pub id: usize,
    /// Relative increase of the radii of the bars.
    pub increase: f64,
}

impl FrontMember {
    /// A verified design without a run, whose id is its place.
    pub fn of(id: usize, evaluation: Evaluation) -> Self {
        Self {
            id,
            generation: 0,
            reference_radius: evaluation.workspace_radius(),
            evaluation,
            certified: None,
        }
    }

    /// Returns the objectives, as they are minimised.
    pub fn objectives(&self) -> Objectives {
        DesignProblem::outcome(&self.evaluation).objectives
    }

    /// Returns the row of `front.csv`.
    pub fn row(&self) -> TableRow {
        TableRow {
            id: self.id,
            row: Row::new(self.generation, &self.evaluation),
            reference_radius: Some(self.reference_radius),
            certified: self.certified,
            drive: self.evaluation.drive,
        }
    }

    /// Reports what is proved about a claim: a radius as `R_w`.
    pub(super) fn report(&mut self, certificate: &Certificate, claim: &CertifyOptions, objectives: &[Objective]) {
        let certified = CertifiedWorkspace::new(certificate, claim);
        if !claim.is_of_region {
            self.evaluation.set_workspace_radius(certified.lower, objectives);
        }
        self.certified = Some(certified);
    }

    pub(super) fn is_proved(&self) -> bool {
        self.certified.is_some_and(|certified| certified.is_proved)
    }

    /// Returns whether the proof was tried and not completed.
    pub(super) fn is_open(&self) -> bool {
        self.certified.is_some_and(|certified| !certified.is_proved)
    }

    /// Returns whether nothing of the workspace is proved.
    pub(super) fn is_empty(&self) -> bool {
        self.certified.is_some_and(|certified| certified.is_empty())
    }
}

impl fmt::Display for FrontProofs {
    /// Writes how many workspaces are proved, and what was found, in one or two sentences.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.proved + self.open;
        write!(f, "{} of {count} workspaces are proved", self.proved)?;
        if self.open > 0 {
            write!(
                f,
                "; the proofs of the others are open, and `kinefront certify TABLE#ID` with a larger --max-boxes may complete them"
            )?;
        }
        let thickened = self.refuted.iter().filter(|refuted| refuted.thickened.is_some());
        let refuted = match self.refuted.len() {
            0 => return write!(f, "."),
            1 => "1 design".to_owned(),
            count => format!("{count} designs"),
        };
        let thickened = thickened.count();
        let others = self.refuted.len() - thickened;
        write!(
            f,
            ". The proofs refuted {refuted} of the fine grid: {thickened} with thicker bars now, {others} with a smaller radius or left out."
        )
    }
}
