//! Questions about designs that threads answer: what drives the mass, wishes, and why a point beyond the front cannot be had.

use std::sync::Arc;

use super::{Session, Subject};
use crate::data::{DesignOrigin, Selected, Wished};
use crate::threads::{
    AlongQuestion, AnsweringThread, DriversQuestion, HindrancesQuestion, MotionQuestion, StudyOfRun, Wake, WhyQuestion,
    WishQuestion,
};
use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::Design;
use kinefront_study::{Column, Drivers, DriversAlong, Hindrance, Wish, WishOutcome};

/// The threads that answer questions about designs.
pub(super) struct Asking {
    drivers: AnsweringThread<DriversQuestion>,
    /// The same with finite steps.
    steps: AnsweringThread<DriversQuestion>,
    along: AnsweringThread<AlongQuestion>,
    wish: AnsweringThread<WishQuestion>,
    why: AnsweringThread<WhyQuestion>,
    hindrances: AnsweringThread<HindrancesQuestion>,
    pub motion: AnsweringThread<MotionQuestion>,
    /// Number of wishes that were stated.
    wishes: u64,
    /// Whether the answer to the last wish has become a design.
    is_wish_taken: bool,
    /// The designs of a front, with its number.
    designs: Option<(u64, Arc<Vec<Design>>)>,
}

/// A point of the objectives of which the user asks why it cannot be had.
#[derive(Debug, Clone, PartialEq)]
pub struct WhyPoint {
    /// Value of the first objective.
    pub wished: f64,
    /// Values of other objectives.
    pub held: Vec<(Quantity, f64)>,
}

impl Asking {
    pub fn new(wake: &Wake) -> Self {
        Self {
            drivers: AnsweringThread::new(Arc::clone(wake)),
            steps: AnsweringThread::new(Arc::clone(wake)),
            along: AnsweringThread::new(Arc::clone(wake)),
            wish: AnsweringThread::new(Arc::clone(wake)),
            why: AnsweringThread::new(Arc::clone(wake)),
            hindrances: AnsweringThread::new(Arc::clone(wake)),
            motion: AnsweringThread::new(Arc::clone(wake)),
            wishes: 0,
            is_wish_taken: true,
            designs: None,
        }
    }

    fn is_waiting(&self) -> bool {
        self.drivers.is_waiting()
            || self.steps.is_waiting()
            || self.along.is_waiting()
            || self.wish.is_waiting()
            || self.why.is_waiting()
            || self.hindrances.is_waiting()
            || self.motion.is_waiting()
    }

    /// Forgets what was asked of an earlier run.
    pub fn forget(&mut self) {
        self.drivers.forget();
        self.steps.forget();
        self.along.forget();
        self.wish.forget();
        self.why.forget();
        self.hindrances.forget();
        self.motion.forget();
        self.is_wish_taken = true;
    }
}

impl Session {
    /// Returns what drives the first objective of the selected design, once that and its evaluation on the fine grid are known.
    pub fn drivers(&mut self) -> Option<Arc<Result<Drivers, String>>> {
        let known = self.known().filter(|known| known.verified)?;
        let evaluation = Arc::clone(&known.evaluation);
        let study = StudyOfRun(self.prepared());
        self.asking.drivers.ask(DriversQuestion {
            study,
            evaluation,
            steps: false,
        })
    }

    /// Returns the same with the changes after finite steps of each parameter, some time later.
    pub fn drivers_with_steps(&mut self) -> Option<Arc<Result<Drivers, String>>> {
        let asked = self.asking.drivers.asked()?.clone();
        self.asking.drivers.answer()?;
        self.asking.steps.ask(DriversQuestion { steps: true, ..asked })
    }

    /// Returns what drives the first objective along the front, once it is known; nothing is determined during a search.
    pub fn drivers_along(&mut self) -> Option<Arc<Result<Vec<DriversAlong>, String>>> {
        if self.is_running() || self.front.is_empty() {
            return None;
        }
        let question = AlongQuestion {
            study: StudyOfRun(self.prepared()),
            front: self.front_number,
            designs: self.designs_of_front(),
        };
        self.asking.along.ask(question)
    }

    /// Returns whether every question that was asked is answered.
    pub fn is_answered(&self) -> bool {
        !self.asking.is_waiting()
    }

    /// States a wish about the selected design.
    pub fn wish(&mut self, wish: Wish) {
        let Some(design) = self.document().selected_design() else {
            return;
        };
        self.asking.wishes += 1;
        self.asking.is_wish_taken = false;
        let question = WishQuestion {
            study: StudyOfRun(self.prepared()),
            number: self.asking.wishes,
            design,
            wish,
        };
        drop(self.asking.wish.ask(question));
    }

    /// Whether the answer to a wish is awaited.
    pub fn is_wishing(&self) -> bool {
        !self.asking.is_wish_taken
    }

    /// Returns the answer to the last wish, once it is known.
    pub fn wish_answer(&self) -> Option<Arc<Result<WishOutcome, String>>> {
        self.asking.wish.answer()
    }

    /// Makes the design that answers a wish one of the user's, and selects it; undo takes it back.
    pub(super) fn take_wish(&mut self) {
        if self.asking.is_wish_taken {
            return;
        }
        let Some(answer) = self.asking.wish.answer() else {
            return;
        };
        self.asking.is_wish_taken = true;
        let Ok(outcome) = answer.as_ref() else { return };
        if outcome.was_true {
            return;
        }
        let found = &outcome.found;
        let name = format!("wish {}", self.asking.wishes);
        let wished = Wished {
            name,
            evaluation: Arc::new(found.evaluation.clone()),
            certified: found.certified,
        };
        let design = wished.evaluation.design;
        self.following = false;
        self.view.pose = None;
        self.history.edit(|document| {
            document.wished.push(wished);
            let origin = DesignOrigin::Wished(document.wished.len() - 1);
            document.selected = Some(Selected { design, origin });
        });
    }

    /// Returns the evaluation of a design that answers a wish.
    pub(super) fn wished_evaluation(&self, design: &Design) -> Option<Arc<Evaluation>> {
        let wished = self.document().wished.iter();
        let mut own = wished.filter(|wished| wished.evaluation.design == *design);
        own.next().map(|wished| Arc::clone(&wished.evaluation))
    }

    /// Asks why a point cannot be had. It states values of objectives: of the first one, and of others; nothing is asked if it does
    /// not, or if there is no front.
    pub fn ask_why(&mut self, point: &[(Quantity, f64)]) {
        let objectives = self.study().objectives();
        let Some((first, others)) = objectives.split_first() else {
            return;
        };
        let of = |quantity: Quantity| {
            point
                .iter()
                .find(|(other, _)| *other == quantity)
                .map(|(_, value)| *value)
        };
        let Some(wished) = of(first.quantity).filter(|value| *value > 0.0) else {
            return;
        };
        let held: Vec<(Quantity, f64)> = others
            .iter()
            .filter_map(|objective| Some((objective.quantity, of(objective.quantity)?)))
            .collect();
        let is_point = held.len() == others.len().min(1) && held.iter().all(|(_, value)| *value > 0.0);
        if !is_point || self.is_running() || self.front.is_empty() {
            return;
        }
        let question = WhyQuestion {
            study: StudyOfRun(self.prepared()),
            front: self.front_number,
            designs: self.designs_of_front(),
            held,
            wished,
        };
        drop(self.asking.why.ask(question));
        self.turn_to(Subject::WhyNot);
    }

    /// Returns the point of which the user asked last why it cannot be had.
    pub fn why_point(&self) -> Option<WhyPoint> {
        self.asking.why.asked().map(|question| WhyPoint {
            wished: question.wished,
            held: question.held.clone(),
        })
    }

    /// Returns why that point cannot be had, once it is known.
    pub fn why(&self) -> Option<Arc<Result<Drivers, String>>> {
        self.asking.why.answer()
    }

    /// Withdraws the question.
    pub fn withdraw_why(&mut self) {
        self.asking.why.forget();
    }

    /// Returns whether the run has ended without any feasible design.
    pub fn is_hindered(&self) -> bool {
        !self.is_running()
            && !self.store.is_empty()
            && self.front.is_empty()
            && !(0..self.store.len()).any(|id| self.store.is_feasible(id))
    }

    /// Returns what stands in the way of a study of which no design is feasible, once it is known.
    pub fn hindrances(&mut self) -> Option<Arc<Result<Vec<Hindrance>, String>>> {
        let asked = self.asking.hindrances.asked();
        if asked.is_some_and(|asked| Arc::ptr_eq(&asked.study.0, &self.as_run)) {
            return self.asking.hindrances.answer();
        }
        let violations = self.store.column(Column::Violation);
        let designs = (0..self.store.len()).filter_map(|id| Some((*violations.get(id)?, self.store.design(id)?)));
        let mut designs: Vec<(f64, Design)> = designs.collect();
        designs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let question = HindrancesQuestion {
            study: StudyOfRun(self.prepared()),
            designs: Arc::new(designs),
        };
        self.asking.hindrances.ask(question)
    }

    fn designs_of_front(&mut self) -> Arc<Vec<Design>> {
        let front = self.front_number;
        let known = self.asking.designs.take().filter(|(of, _)| *of == front);
        let (_, designs) = self.asking.designs.insert(known.unwrap_or_else(|| {
            let designs = self.front.iter().map(|entry| entry.row.design);
            (front, Arc::new(designs.collect()))
        }));
        Arc::clone(designs)
    }
}
