//! Proofs of the designs that are reported.

use std::time::Instant;

use super::{Keep, ROUNDS, Settling};
use crate::prove::{FrontProver, ProvedMember};
use crate::{ConclusionPart, Event, FrontMember, RunTimes};
use kinefront_optimize::{Objectives, subset};

/// A design that holds on the fine grid.
pub(super) struct Held {
    /// Place of the candidate with which it began.
    pub place: usize,
    member: ProvedMember,
    keep: Keep,
    state: State,
}

/// How far the proof of a design has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Unproved,
    Settled,
    LeftOut,
}

impl Held {
    pub fn new(place: usize, member: FrontMember, keep: Keep) -> Self {
        Self {
            place,
            member: ProvedMember::unproved(member),
            keep,
            state: State::Unproved,
        }
    }

    /// Returns what is reported of the design, as far as it is known; `None` if it has fallen.
    pub fn reported(&self) -> Option<&FrontMember> {
        let is_empty = |member: &FrontMember| member.certified.is_some_and(|certified| certified.is_empty());
        let member = self.member.reported().filter(|member| !is_empty(member));
        member.filter(|_| self.state != State::LeftOut)
    }

    /// Returns the design with what is proved, unless it is left out.
    pub fn into_proved(self) -> Option<ProvedMember> {
        (self.state != State::LeftOut).then_some(self.member)
    }

    /// Takes what was proved.
    fn settle(&mut self, proved: ProvedMember) {
        let certified = proved.reported().and_then(|member| member.certified);
        let is_open = certified.is_some_and(|certified| !certified.is_proved);
        self.state = if is_open && self.keep == Keep::Proved {
            State::LeftOut
        } else {
            State::Settled
        };
        self.member = proved;
    }
}

impl Settling<'_> {
    /// Proves the designs that would be reported, and replaces those that fall, until all that are reported have been examined; `None` if the
    /// run was abandoned.
    pub(super) fn prove_reported(&mut self, times: &mut RunTimes, send: &mut dyn FnMut(Event)) -> Option<()> {
        if !self.search.study().workspace.certify {
            return Some(());
        }
        let mut examined = 0;
        for round in 0.. {
            let chosen = self.chosen();
            let is_unproved = |place: &usize| self.held[*place].state == State::Unproved;
            let unproved: Vec<usize> = chosen.iter().copied().filter(is_unproved).collect();
            if unproved.is_empty() {
                break;
            }
            self.prove(&unproved, examined, times, send)?;
            examined += unproved.len();
            if round < ROUNDS {
                self.replace_fallen(chosen.len(), round, times, send)?;
            }
        }
        Some(())
    }

    /// Returns the designs that would be reported, as places in `held`.
    fn chosen(&self) -> Vec<usize> {
        let standing = self.standing();
        let objectives: Vec<Objectives> = standing.iter().map(|member| member.objectives).collect();
        let chosen = subset(&objectives, &self.search.found.reference, self.most());
        chosen.into_iter().map(|place| standing[place].id).collect()
    }

    /// Proves some designs, as places in `held`, after others that were `examined`.
    fn prove(
        &mut self,
        unproved: &[usize],
        examined: usize,
        times: &mut RunTimes,
        send: &mut dyn FnMut(Event),
    ) -> Option<()> {
        let proving = Instant::now();
        let control = self.control;
        let goes_on = || !control.is_abandoned();
        let prover = FrontProver::new(&self.search.problem, &goes_on);
        let tell = |done| {
            send(Event::Concluding {
                part: ConclusionPart::Proofs,
                done: examined + done,
                total: examined + unproved.len(),
            });
        };
        let proved = self.each(unproved, |&place| prover.prove(self.held[place].member.member()), tell)?;
        for (&place, proved) in unproved.iter().zip(proved) {
            self.held[place].settle(proved);
            if self.held[place].state == State::LeftOut {
                self.in_vain += 1;
            }
        }
        times.certification_s += proving.elapsed().as_secs_f64();
        Some(())
    }

    /// Verifies other designs in place of those that fell, so that as many stand as were `wanted`, and fills the gaps that are left.
    fn replace_fallen(
        &mut self,
        wanted: usize,
        round: usize,
        times: &mut RunTimes,
        send: &mut dyn FnMut(Event),
    ) -> Option<()> {
        if !self.has_one_objective() {
            let replacements = self.replacements(wanted, round);
            self.settle(&replacements, times, send)?;
            return self.fill_gaps(times, send);
        }
        match self.standing().is_empty() {
            true => self.settle_best(times, send),
            false => Some(()),
        }
    }
}
