//! The proofs of the workspaces of a front, and the stronger designs that replace refuted ones (docs/model.md, section 13.5).

use glam::DVec2;

use super::{DesignProblem, FrontMember, FrontProofs, RefutedDesign, ThickenedDesign};
use kinefront_model::certify::{Certificate, CertifyOptions, ProofObserver, Verdict, Violation};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model, PoseScalar};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_model::workers::{OneWorker, Workers};
use kinefront_model::workspace::Region;
use kinefront_optimize::{Archive, Objectives, hypervolume, subset};

/// Part of the verified `R_w` that the proved radius of a refuted design must have; otherwise a stronger design is looked for.
const RESTORED: f64 = 0.999;

/// Slack, as a logarithm or a share of `R`, that makes a proof easier of a design whose requirements hold with less.
pub(crate) const SLACK: f64 = 1e-4;

/// Number of boxes, a multiple of what most proofs take, after which a design with more slack is proved while a person waits.
const MAX_BOXES_AT_ONCE: usize = 30_000;

/// Ends a proof once a function returns false.
struct Until<'a>(&'a dyn Fn() -> bool);

impl ProofObserver for Until<'_> {
    fn goes_on(&mut self) -> bool {
        (self.0)()
    }
}

/// A member of the front after its proof.
#[derive(Debug)]
pub struct ProvedMember {
    member: FrontMember,
    refuted: Option<RefutedDesign>,
    /// The design that is reported instead, stronger or with more slack, and the increase; its id is not known yet.
    instead: Option<(FrontMember, f64)>,
    /// Whether the design does what the study requires, as far as it is known.
    holds: bool,
}

impl ProvedMember {
    /// A member of which nothing is to be proved.
    pub(super) fn unproved(member: FrontMember) -> Self {
        Self {
            member,
            refuted: None,
            instead: None,
            holds: true,
        }
    }

    /// Returns the member as it was verified, with what was proved of it.
    pub(super) fn member(&self) -> &FrontMember {
        &self.member
    }

    /// Returns the design that is reported: the member, or the one instead of it; `None` if neither does what the study requires.
    pub(super) fn reported(&self) -> Option<&FrontMember> {
        match &self.instead {
            Some((instead, _)) => Some(instead),
            None => Some(&self.member).filter(|_| self.holds),
        }
    }
}

/// A pose of the region at which the limit of a scalar has the least margin that was found.
#[derive(Clone, Copy)]
struct Pocket {
    pose: Pose,
    scalar: PoseScalar,
    margin: f64,
}

/// Proofs of the designs of a front.
pub struct FrontProver<'a> {
    problem: &'a DesignProblem,
    goes_on: &'a (dyn Fn() -> bool + Sync),
    /// Threads for each single proof.
    workers: &'a dyn Workers,
    /// Largest number of boxes before a design with more slack is proved instead.
    max_boxes: usize,
}

impl<'a> FrontProver<'a> {
    /// Prepares the proofs of designs of a problem. Once `goes_on` returns false, proofs end early, and the result is not to be used.
    pub fn new(problem: &'a DesignProblem, goes_on: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self {
            problem,
            goes_on,
            workers: &OneWorker,
            max_boxes: CertifyOptions::MAX_BOXES,
        }
    }

    /// Prepares the proof of one design that a person waits for, on several threads. A proof that takes long is given up early for one of a
    /// design with more slack.
    pub fn at_once(problem: &'a DesignProblem, workers: &'a dyn Workers) -> Self {
        Self {
            workers,
            max_boxes: MAX_BOXES_AT_ONCE,
            ..Self::new(problem, &|| true)
        }
    }

    fn model(&self) -> &Model {
        self.problem.model()
    }

    /// Proves the workspace of a design. If it stays open, one near it with more slack is proved instead, if possible.
    pub fn prove(&self, member: &FrontMember) -> ProvedMember {
        let mut proved = self.prove_one(member, self.max_boxes);
        if proved.reported().is_some_and(FrontMember::is_open) && (self.goes_on)() {
            proved.instead = self.proved_with_slack(member).map(|instead| (instead, 0.0));
        }
        proved
    }

    /// Returns a design near a member that keeps every requirement with more slack, if it is proved.
    fn proved_with_slack(&self, member: &FrontMember) -> Option<FrontMember> {
        let evaluation = self.problem.with_slack(&member.evaluation, SLACK, self.workers)?;
        let stronger = FrontMember {
            evaluation,
            ..member.clone()
        };
        let proved = self.prove_one(&stronger, CertifyOptions::MAX_BOXES);
        proved.reported().filter(|member| member.is_proved()).cloned()
    }

    fn prove_one(&self, member: &FrontMember, max_boxes: usize) -> ProvedMember {
        let mut proved = ProvedMember::unproved(member.clone());
        let evaluation = &member.evaluation;
        let Some(claim) = self.model().claim(evaluation) else {
            return proved;
        };
        let wanted = self.wanted_radius(claim.claimed_radius);
        let first = CertifyOptions {
            enough: wanted,
            max_boxes,
            ..claim
        };
        let Some(mut certificate) = self.certify(&evaluation.design, &first) else {
            return proved;
        };
        // A radius that is proved within the tolerance may still miss a limit of the study.
        let least = self.problem.least_radius().filter(|_| !claim.is_of_region);
        let misses_limit = least.is_some_and(|least| certificate.upper.is_some_and(|upper| upper < least));
        if let Some(violation) = certificate
            .violation
            .filter(|_| misses_limit || certificate.verdict == Verdict::Refuted)
        {
            let pocket = self.deepest(evaluation, violation);
            if claim.is_of_region || certificate.upper.is_some_and(|upper| upper < wanted) {
                proved.instead = self.strengthen(member, &pocket);
                if proved.instead.is_none()
                    && !claim.is_of_region
                    && let Some(whole) = self.certify(&evaluation.design, &claim)
                {
                    certificate = whole;
                }
            }
            proved.refuted = Some(RefutedDesign {
                id: member.id,
                fine_radius_m: claim.claimed_radius,
                infeasible_at_m: certificate.upper.unwrap_or_default(),
                constraint: violation.scalar.limit_id().to_owned(),
                margin: pocket.margin,
                thickened: None,
            });
        }
        proved.holds = if claim.is_of_region {
            certificate.verdict != Verdict::Refuted
        } else {
            self.problem
                .least_radius()
                .is_none_or(|least| certificate.lower >= least)
        };
        proved
            .member
            .report(&certificate, &claim, &self.model().settings().objectives);
        proved
    }

    /// Returns the radius that must be proved of a verified one, so that no stronger design is looked for \[m\].
    fn wanted_radius(&self, verified: f64) -> f64 {
        let restored = RESTORED * verified;
        self.problem
            .least_radius()
            .map_or(restored, |least| least.max(restored))
    }

    fn certify(&self, design: &Design, options: &CertifyOptions) -> Option<Certificate> {
        // Bars without a usable stiffness have no proof: such a design, of a study without stiffness, stays open.
        self.model()
            .certify_by(self.workers, design, options, &mut Until(self.goes_on))
            .ok()
    }

    /// Returns the deepest place of the pocket about an infeasible pose, within the region that was claimed, by a pattern search.
    fn deepest(&self, evaluation: &Evaluation, violation: Violation) -> Pocket {
        let (design, scalar) = (&evaluation.design, violation.scalar);
        let model = self.model();
        let workspace = &model.settings().workspace;
        let centre = workspace.centre;
        let contains = |position: DVec2| match &workspace.region {
            Region::Largest => (position - centre).length() <= evaluation.workspace_radius(),
            Region::Disc(radius) => (position - centre).length() <= *radius,
            Region::Polygon(polygon) => polygon.contains(position - centre),
        };
        let home = evaluation.home_phi_deg.unwrap_or_default().to_radians();
        let half = 0.5 * workspace.rotation_range_deg.to_radians();
        let mut pocket = Pocket {
            pose: violation.pose,
            scalar,
            margin: model.margin_at(design, &violation.pose, scalar),
        };
        let mut steps = [0.05 * evaluation.workspace_radius(), 0.2 * half];
        for _ in 0..12 {
            let mut has_moved = true;
            while has_moved {
                has_moved = false;
                for (along, sign) in (0..3).flat_map(|along| [(along, -1.0), (along, 1.0)]) {
                    let mut pose = pocket.pose;
                    match along {
                        0 => pose.position.x += sign * steps[0],
                        1 => pose.position.y += sign * steps[0],
                        _ => pose.phi = (pose.phi + sign * steps[1]).clamp(home - half, home + half),
                    }
                    let margin = model.margin_at(design, &pose, scalar);
                    if contains(pose.position) && margin < pocket.margin {
                        pocket = Pocket { pose, margin, ..pocket };
                        has_moved = true;
                    }
                }
            }
            steps = steps.map(|step| 0.5 * step);
        }
        pocket
    }

    /// Returns the least changed design that holds what the study requires where `member` does not, and the increase: with thicker
    /// bars or, for a prescribed region, larger.
    fn strengthen(&self, member: &FrontMember, pocket: &Pocket) -> Option<(FrontMember, f64)> {
        let model = self.model();
        let verified = &member.evaluation;
        let wanted = self.wanted_radius(verified.workspace_radius());
        self.problem
            .strengthened(&verified.design)
            .into_iter()
            .find_map(|(design, increase)| {
                // Where the pocket stays one, there is nothing to prove.
                if !(self.goes_on)() || model.margin_at(&design, &pocket.pose, pocket.scalar) < 0.0 {
                    return None;
                }
                let evaluation = model.evaluate(&design, GridChoice::Fine);
                let claim = CertifyOptions {
                    enough: wanted,
                    ..model.claim(&evaluation)?
                };
                if claim.is_of_region && !evaluation.is_feasible() {
                    return None;
                }
                let certificate = self.certify(&design, &claim)?;
                let is_restored = match claim.is_of_region {
                    true => certificate.verdict == Verdict::Proved,
                    false => certificate.lower >= wanted,
                };
                if !is_restored {
                    return None;
                }
                let mut instead = FrontMember {
                    evaluation,
                    reference_radius: model.evaluate(&design, GridChoice::Reference).workspace_radius(),
                    ..member.clone()
                };
                instead.report(&certificate, &claim, &model.settings().objectives);
                Some((instead, increase))
            })
    }
}

/// Returns the ids of the members of an archive that are reported: at most `most` that together cover the most.
pub(super) fn selected(archive: &Archive, reference: &Objectives, most: usize) -> Vec<usize> {
    let objectives: Vec<Objectives> = archive.iter().map(|member| member.objectives).collect();
    let kept = subset(&objectives, reference, most);
    kept.into_iter().map(|place| archive[place].id).collect()
}

/// Returns the front of designs that were proved, in the order of the first objective, and what was found. Stronger designs get the ids
/// from `next_id` on; at most `most` designs are kept, and `reference` is the reference point of the hypervolume.
pub fn proved_front(
    proved: Vec<ProvedMember>,
    mut next_id: usize,
    reference: Objectives,
    most: usize,
) -> (Vec<FrontMember>, FrontProofs) {
    let mut proofs = FrontProofs {
        tolerance: CertifyOptions::TOLERANCE,
        ..FrontProofs::default()
    };
    let mut members = Vec::new();
    let mut dropped = 0;
    for ProvedMember {
        member,
        refuted,
        instead,
        holds,
    } in proved
    {
        let thickened = instead.map(|(instead, increase)| {
            let id = next_id;
            next_id += 1;
            (FrontMember { id, ..instead }, ThickenedDesign { id, increase })
        });
        let (instead, thickened) = thickened.unzip();
        match instead {
            Some(instead) => members.push(instead),
            None if holds => members.push(member),
            None => dropped += 1,
        }
        proofs
            .refuted
            .extend(refuted.map(|refuted| RefutedDesign { thickened, ..refuted }));
    }
    let mut archive = Archive::default();
    for (place, member) in members.iter().enumerate() {
        if !member.is_empty() {
            archive.insert(place, &[], &DesignProblem::outcome(&member.evaluation));
        }
    }
    proofs.dropped = dropped + members.len() - archive.len();
    let kept = selected(&archive, &reference, most);
    let front: Vec<FrontMember> = kept.into_iter().map(|place| members[place].clone()).collect();
    proofs.proved = front.iter().filter(|member| member.is_proved()).count();
    proofs.open = front.len() - proofs.proved;
    proofs.hypervolume_kg_m = hypervolume(front.iter().map(FrontMember::objectives), reference);
    (front, proofs)
}
