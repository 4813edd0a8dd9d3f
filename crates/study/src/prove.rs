//! The proofs of the workspaces of a front, and the designs with thicker bars that replace refuted ones (docs/model.md,
//! section 13.5).

use rayon::prelude::*;

use super::{CertifiedRadius, DesignProblem, FrontMember, FrontProofs, RefutedDesign, ThickenedDesign};
use kinefront_model::certify::{Certificate, CertifyOptions, ProofObserver, Verdict, Violation};
use kinefront_model::evaluation::{Constraint, Evaluation, GridChoice, Model};
use kinefront_model::mechanism::{Design, DesignVariable};
use kinefront_model::spatial::Pose;
use kinefront_optimize::{Archive, Objectives, hypervolume};

/// Factors by which the bars of a refuted design are thickened, beyond 1; the first that restores its workspace is taken.
const THICKENINGS: [f64; 5] = [1e-4, 2e-4, 3e-4, 5e-4, 1e-3];

/// Part of the verified `R_w` that the proved radius of a refuted design must have; otherwise its bars are thickened.
const RESTORED: f64 = 0.999;

/// Radii of the bars, which are thickened.
const BARS: [DesignVariable; 2] = [DesignVariable::LegBarRadius, DesignVariable::PlatformBarRadius];

/// Ends a proof once a function returns false.
struct Until<'a>(&'a dyn Fn() -> bool);

impl ProofObserver for Until<'_> {
    fn goes_on(&mut self) -> bool {
        (self.0)()
    }
}

/// A member of the front after its proof.
struct ProvedMember {
    member: FrontMember,
    refuted: Option<RefutedDesign>,
    /// The thickened design that is reported instead, and the increase; its id is not known yet.
    instead: Option<(FrontMember, f64)>,
}

/// A pose within a disc at which a constraint has the least margin that was found.
#[derive(Clone, Copy)]
struct Pocket {
    pose: Pose,
    constraint: Constraint,
    margin: f64,
}

/// Proofs of the designs of a front.
pub struct FrontProver<'a> {
    model: &'a Model,
    /// Largest radii of the bars \[m\].
    thickest: [f64; 2],
    goes_on: &'a (dyn Fn() -> bool + Sync),
    proved: Vec<ProvedMember>,
}

impl<'a> FrontProver<'a> {
    /// Prepares the proofs; `thickest` are the upper bounds of the radii of the leg bars and of the platform bars \[m\]. Once
    /// `goes_on` returns false, proofs end early, and the result is not to be used.
    pub fn new(model: &'a Model, thickest: [f64; 2], goes_on: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self {
            model,
            thickest,
            goes_on,
            proved: Vec::new(),
        }
    }

    /// Proves the workspaces of some designs, on the threads of the pool in which it is called.
    pub fn prove(&mut self, members: &[FrontMember]) {
        let proved: Vec<ProvedMember> = members.par_iter().map(|member| self.prove_one(member)).collect();
        self.proved.extend(proved);
    }

    fn prove_one(&self, member: &FrontMember) -> ProvedMember {
        let mut proved = ProvedMember {
            member: member.clone(),
            refuted: None,
            instead: None,
        };
        let evaluation = &member.evaluation;
        let Some(claim) = CertifyOptions::of(evaluation) else {
            return proved;
        };
        let wanted = RESTORED * claim.claimed_radius;
        let first = CertifyOptions {
            enough: wanted,
            ..claim
        };
        let Some(mut certificate) = self.certify(&evaluation.design, &first) else {
            return proved;
        };
        if let Some(violation) = certificate
            .violation
            .filter(|_| certificate.verdict == Verdict::Refuted)
        {
            let pocket = self.deepest(evaluation, violation);
            if certificate.upper.is_some_and(|upper| upper < wanted) {
                proved.instead = self.thicken(member, &pocket);
                if proved.instead.is_none()
                    && let Some(whole) = self.certify(&evaluation.design, &claim)
                {
                    certificate = whole;
                }
            }
            proved.refuted = Some(RefutedDesign {
                id: member.id,
                fine_radius_m: claim.claimed_radius,
                infeasible_at_m: certificate.upper.unwrap_or_default(),
                constraint: violation.constraint.id().to_owned(),
                margin: pocket.margin,
                thickened: None,
            });
        }
        proved.member.report(
            CertifiedRadius::new(&certificate, claim.tolerance),
            &self.model.settings().objectives,
        );
        proved
    }

    fn certify(&self, design: &Design, options: &CertifyOptions) -> Option<Certificate> {
        // Bars without a usable stiffness have no proof: such a design, of a study without stiffness, stays open.
        self.model
            .certify_observed(design, options, &mut Until(self.goes_on))
            .ok()
    }

    /// Returns the deepest place of the pocket about an infeasible pose, within the radius that was claimed, by a pattern search.
    fn deepest(&self, evaluation: &Evaluation, violation: Violation) -> Pocket {
        let (design, constraint) = (&evaluation.design, violation.constraint);
        let centre = self.model.settings().workspace.centre;
        let home = evaluation.home_phi_deg.unwrap_or_default().to_radians();
        let half = 0.5 * self.model.settings().workspace.rotation_range_deg.to_radians();
        let mut pocket = Pocket {
            pose: violation.pose,
            constraint,
            margin: self.model.margin_at(design, &violation.pose, constraint),
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
                    let margin = self.model.margin_at(design, &pose, constraint);
                    if pose.position.distance(centre) <= evaluation.workspace_radius() && margin < pocket.margin {
                        pocket = Pocket { pose, margin, ..pocket };
                        has_moved = true;
                    }
                }
            }
            steps = steps.map(|step| 0.5 * step);
        }
        pocket
    }

    /// Returns the design with the least thickened bars whose proved radius is almost the verified one, and the increase.
    fn thicken(&self, member: &FrontMember, pocket: &Pocket) -> Option<(FrontMember, f64)> {
        let verified = &member.evaluation;
        let wanted = RESTORED * verified.workspace_radius();
        THICKENINGS.into_iter().find_map(|increase| {
            let design = self.thickened(&verified.design, increase)?;
            // Where the pocket stays one, there is nothing to prove.
            if self.model.margin_at(&design, &pocket.pose, pocket.constraint) < 0.0 {
                return None;
            }
            let evaluation = self.model.evaluate(&design, GridChoice::Fine);
            let claim = CertifyOptions {
                enough: wanted,
                ..CertifyOptions::of(&evaluation)?
            };
            let certificate = self.certify(&design, &claim)?;
            if certificate.lower < wanted {
                return None;
            }
            let mut instead = FrontMember {
                evaluation,
                reference_radius: self.model.evaluate(&design, GridChoice::Reference).workspace_radius(),
                ..member.clone()
            };
            instead.report(
                CertifiedRadius::new(&certificate, claim.tolerance),
                &self.model.settings().objectives,
            );
            Some((instead, increase))
        })
    }

    /// Returns a design with thicker bars, if the bounds allow it.
    fn thickened(&self, design: &Design, increase: f64) -> Option<Design> {
        // A bar of a catalogue cannot be a little thicker.
        let sections = &self.model.settings().sections;
        if sections.legs.catalogue().is_some() || sections.platform.catalogue().is_some() {
            return None;
        }
        let mut values = design.values();
        for (variable, most) in BARS.into_iter().zip(self.thickest) {
            let radius = &mut values[variable as usize];
            *radius *= 1.0 + increase;
            if *radius > most {
                return None;
            }
        }
        design.with_dimensions(values).ok()
    }

    /// Returns the front with the proved radii, in the order of the first objective, and what was found. Thickened designs get the ids from
    /// `next_id` on; `reference` is the reference point of the hypervolume.
    pub fn conclude(self, mut next_id: usize, reference: Objectives) -> (Vec<FrontMember>, FrontProofs) {
        let mut proofs = FrontProofs {
            tolerance: CertifyOptions::TOLERANCE,
            ..FrontProofs::default()
        };
        let mut members = Vec::new();
        for ProvedMember {
            member,
            refuted,
            instead,
        } in self.proved
        {
            let thickened = instead.map(|(instead, increase)| {
                let id = next_id;
                next_id += 1;
                (FrontMember { id, ..instead }, ThickenedDesign { id, increase })
            });
            let (instead, thickened) = thickened.unzip();
            members.push(instead.unwrap_or(member));
            proofs
                .refuted
                .extend(refuted.map(|refuted| RefutedDesign { thickened, ..refuted }));
        }
        let mut archive = Archive::default();
        for (place, member) in members.iter().enumerate() {
            if member.evaluation.workspace_radius() > 0.0 {
                archive.insert(place, &[], &DesignProblem::outcome(&member.evaluation));
            }
        }
        // On a front, the order by mass is also the order by R_w.
        let front: Vec<FrontMember> = archive.iter().map(|kept| members[kept.id].clone()).collect();
        proofs.dropped = members.len() - front.len();
        proofs.proved = front.iter().filter(|member| member.is_proved()).count();
        proofs.open = front.len() - proofs.proved;
        proofs.hypervolume_kg_m = hypervolume(front.iter().map(FrontMember::objectives), reference);
        (front, proofs)
    }
}
