//! Proofs of the designs that are reported.

use std::time::Instant;

use super::{Keep, ROUNDS, Settling, each};
use crate::prove::{FrontProver, ProvedMember, selected};
use crate::{ConclusionPart, Event, FrontMember};

/// A design that holds on the fine grid.
pub(super) struct Held {
    /// Place of the candidate with which it began.
    pub place: usize,
    proved: ProvedMember,
    keep: Keep,
    /// Whether its proof was tried.
    is_examined: bool,
}

impl Held {
    pub fn new(place: usize, member: FrontMember, keep: Keep) -> Self {
        Self {
            place,
            proved: ProvedMember::unproved(member),
            keep,
            is_examined: false,
        }
    }

    /// Returns what is reported of the design, as far as it is known; `None` if it has fallen.
    pub fn reported(&self) -> Option<&FrontMember> {
        let member = self.proved.reported().filter(|member| !member.is_empty());
        member.filter(|_| !self.is_left_out())
    }

    /// Returns the design with what is proved, unless it is left out.
    pub fn into_proved(self) -> Option<ProvedMember> {
        (!self.is_left_out()).then_some(self.proved)
    }

    fn is_left_out(&self) -> bool {
        self.keep == Keep::Proved && self.proved.reported().is_some_and(FrontMember::is_open)
    }
}

impl Settling<'_> {
    /// Proves the designs that would be reported, and replaces those that fall, until all that are reported have been examined; `None` if the
    /// run was abandoned.
    pub(super) fn prove_reported(&mut self) -> Option<()> {
        if !self.search.study().workspace.certify {
            return Some(());
        }
        let mut examined = 0;
        for round in 0.. {
            let chosen = self.chosen();
            let is_unproved = |place: &usize| !self.held[*place].is_examined;
            let unproved: Vec<usize> = chosen.iter().copied().filter(is_unproved).collect();
            if unproved.is_empty() {
                break;
            }
            self.prove(&unproved, examined)?;
            examined += unproved.len();
            if round < ROUNDS {
                self.replace_fallen(chosen.len(), round)?;
            }
        }
        Some(())
    }

    /// Returns the designs that would be reported, as places in `held`.
    fn chosen(&self) -> Vec<usize> {
        selected(&self.standing(), &self.search.found.reference, self.most())
    }

    /// Proves some designs, as places in `held`, after others that were `examined`.
    fn prove(&mut self, unproved: &[usize], examined: usize) -> Option<()> {
        let proving = Instant::now();
        let control = self.control;
        let goes_on = || !control.is_abandoned();
        let prover = FrontProver::new(&self.search.problem, &goes_on);
        let tell = |done| {
            (self.send)(Event::Concluding {
                part: ConclusionPart::Proofs,
                done: examined + done,
                total: examined + unproved.len(),
            });
        };
        let proved = each(
            self.search,
            control,
            unproved,
            |&place| prover.prove(self.held[place].proved.member()),
            tell,
        )?;
        for (&place, proved) in unproved.iter().zip(proved) {
            let held = &mut self.held[place];
            (held.proved, held.is_examined) = (proved, true);
            self.in_vain += usize::from(held.is_left_out());
        }
        self.times.certification_s += proving.elapsed().as_secs_f64();
        Some(())
    }

    /// Verifies other designs in place of those that fell, so that as many stand as were `wanted`, and fills the gaps that are left.
    fn replace_fallen(&mut self, wanted: usize, round: usize) -> Option<()> {
        if !self.has_one_objective() {
            let replacements = self.replacements(wanted, round);
            self.settle(&replacements)?;
            return self.fill_gaps();
        }
        match self.standing().is_empty() {
            true => self.settle_best(),
            false => Some(()),
        }
    }
}
