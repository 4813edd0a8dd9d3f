//! A certificate of a workspace radius, or of the region of a study.

use std::time::Instant;

use serde::Serialize;

use super::pose::PoseJson;
use super::wire::DesignJson;
use kinefront_model::certify::{Certificate, CertifyError, CertifyOptions, Verdict};
use kinefront_model::evaluation::{GridChoice, Model};
use kinefront_model::mechanism::Design;
use kinefront_study::PreparedStudy;

/// What is to be proved of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// Home orientation \[deg\]; by default that of the evaluation on the fine grid.
    pub phi_deg: Option<f64>,
    /// Radius that is claimed \[m\]; by default the region that the study prescribes, or else the radius of the fine grid.
    pub radius: Option<f64>,
    /// Relative tolerance of the claim, and gap between the bounds at which the proof ends.
    pub tolerance: f64,
    /// Largest number of boxes.
    pub max_boxes: usize,
    /// Whether the workspace radius is also bounded over all home orientations.
    pub all_homes: bool,
}

impl Default for Claim {
    fn default() -> Self {
        Self {
            phi_deg: None,
            radius: None,
            tolerance: CertifyOptions::TOLERANCE,
            max_boxes: CertifyOptions::MAX_BOXES,
            all_homes: false,
        }
    }
}

/// The output of `kinefront certify --json`.
#[derive(Debug, Serialize)]
pub struct CertificateJson {
    architecture: &'static str,
    design: DesignJson,
    working_mode: [i8; 3],
    /// The home pose.
    pub home: PoseJson,
    /// The radius that was claimed.
    pub claimed_radius_m: f64,
    /// Radius of a disc that is proved, rounded down.
    pub lower_m: f64,
    /// Distance of a pose that is proved infeasible, rounded up; `None` if none was found.
    pub upper_m: Option<f64>,
    relative_gap: Option<f64>,
    tolerance: f64,
    closed: bool,
    /// `proved`, `refuted` or `open`.
    verdict: &'static str,
    /// Why the verdict is open: `budget` or `precision`.
    why: Option<&'static str>,
    /// The verdict that these two keys state.
    #[serde(skip)]
    pub found: Verdict,
    /// The pose at `upper_m`.
    pub violation: Option<ViolationJson>,
    /// Number of boxes that were examined.
    pub boxes: usize,
    seconds: f64,
    /// Bound of the workspace radius over all home orientations, rounded up, if it was asked for and found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_all_homes_m: Option<Option<f64>>,
    /// What was claimed: `region`, that of the study, or `radius`.
    pub claim: &'static str,
}

/// A pose that is proved infeasible; `phi_rad` is the orientation of the proof.
#[derive(Debug, Serialize)]
pub struct ViolationJson {
    /// The pose.
    #[serde(flatten)]
    pub pose: PoseJson,
    phi_rad: f64,
    /// The constraint or limit that the pose misses.
    pub id: &'static str,
    /// Its margin.
    pub margin: f64,
}

impl CertificateJson {
    /// Proves a claim about a design under the requirements of a study.
    ///
    /// # Errors
    /// [`CertifyError`] if the claim is not one that can be proved.
    pub fn prove(study: &PreparedStudy, design: &Design, claim: &Claim) -> Result<Self, CertifyError> {
        let model = study.model();
        let since = Instant::now();
        let evaluation = model.evaluate(design, GridChoice::Fine);
        let home = model.home(&evaluation);
        let phi_deg = claim.phi_deg.or(evaluation.home_phi_deg);
        let options = CertifyOptions {
            // The constraints of an infeasible design are reported at an orientation of the grid.
            phi_deg: phi_deg.unwrap_or_else(|| (1e9 * home.phi.to_degrees()).round() / 1e9),
            claimed_radius: claim.radius.unwrap_or(evaluation.workspace_radius()),
            tolerance: claim.tolerance,
            max_boxes: claim.max_boxes,
            is_of_region: study.study().workspace.region.is_prescribed() && claim.radius.is_none(),
            ..CertifyOptions::default()
        };
        let certificate = model.certify(design, &options)?;
        let homes = match claim.all_homes {
            true => Some(model.bound_of_homes(design, certificate.lower)?),
            false => None,
        };
        let seconds = since.elapsed().as_secs_f64();
        Ok(Self::new(model, design, &options, &certificate, homes, seconds))
    }

    /// Creates the output for a certificate that took `seconds`.
    fn new(
        model: &Model,
        design: &Design,
        options: &CertifyOptions,
        certificate: &Certificate,
        homes: Option<Option<f64>>,
        seconds: f64,
    ) -> Self {
        let centre = model.settings().workspace.centre;
        let (verdict, why) = match certificate.verdict {
            Verdict::Proved => ("proved", None),
            Verdict::Refuted => ("refuted", None),
            Verdict::OpenBudget => ("open", Some("budget")),
            Verdict::OpenPrecision => ("open", Some("precision")),
        };
        // The decimal text of a double may lie on either side of it. The gap is that of the numbers as printed.
        let printed = Certificate {
            lower: certificate.lower.next_down().max(0.0),
            upper: certificate
                .upper
                .map(|upper| if upper > 0.0 { upper.next_up() } else { upper }),
            ..*certificate
        };
        Self {
            architecture: design.architecture().name(),
            design: design.into(),
            working_mode: design.working_mode().signs(),
            home: PoseJson {
                x_m: centre.x,
                y_m: centre.y,
                phi_deg: options.phi_deg,
            },
            claimed_radius_m: options.claimed_radius,
            lower_m: printed.lower,
            upper_m: printed.upper,
            relative_gap: printed.relative_gap(),
            tolerance: options.tolerance,
            closed: !options.is_of_region && printed.is_closed(options.tolerance),
            verdict,
            why,
            found: certificate.verdict,
            violation: certificate.violation.map(|violation| ViolationJson {
                pose: PoseJson::new(&violation.pose, violation.pose.phi.to_degrees()),
                phi_rad: violation.pose.phi,
                id: violation.scalar.limit_id(),
                margin: model.margin_at(design, &violation.pose, violation.scalar),
            }),
            boxes: certificate.boxes,
            seconds,
            upper_all_homes_m: homes.map(|bound| bound.map(f64::next_up)),
            claim: if options.is_of_region { "region" } else { "radius" },
        }
    }
}
