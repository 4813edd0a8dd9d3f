//! The thread that determines what drives the mass of the selected design.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Builder;
use std::time::Duration;

use kinefront_model::evaluation::Evaluation;
use kinefront_study::{DesignProblem, Drivers, DriversOptions, PreparedStudy};

use super::Wake;
use super::mailbox::Mailbox;

/// Time for which a design must stay selected: a slider passes through many designs.
const RESTING: Duration = Duration::from_millis(120);

/// What drives the mass of a design.
#[derive(Debug, Clone)]
pub struct DriversAnswer {
    /// The evaluation of the design.
    pub evaluation: Arc<Evaluation>,
    /// The prices, or why there are none.
    pub found: Result<Drivers, String>,
}

struct Shared {
    requests: Mailbox<(Arc<PreparedStudy>, Arc<Evaluation>)>,
    answer: Mutex<Option<Arc<DriversAnswer>>>,
    wake: Wake,
}

/// Determines prices on its own thread, which starts with the first request.
pub struct DriversThread {
    shared: Arc<Shared>,
    asked: Option<(Arc<PreparedStudy>, Arc<Evaluation>)>,
    is_started: bool,
}

impl DriversThread {
    /// Prepares the thread.
    pub fn new(wake: Wake) -> Self {
        Self {
            shared: Arc::new(Shared {
                requests: Mailbox::new(),
                answer: Mutex::new(None),
                wake,
            }),
            asked: None,
            is_started: false,
        }
    }

    /// Asks for the prices of a design, unless they were asked for last; returns them once they are known.
    pub fn ask(&mut self, study: &Arc<PreparedStudy>, evaluation: &Arc<Evaluation>) -> Option<Arc<DriversAnswer>> {
        let is_same =
            |(of, asked): &(Arc<PreparedStudy>, Arc<Evaluation>)| Arc::ptr_eq(of, study) && asked == evaluation;
        if !self.asked.as_ref().is_some_and(is_same) {
            if !self.is_started {
                let shared = Arc::clone(&self.shared);
                let thread = Builder::new().name("kinefront-drivers".to_owned());
                // Without a thread there are no prices; the next request tries again.
                thread.spawn(move || answer_requests(&shared)).ok()?;
                self.is_started = true;
            }
            *self.shared.answer.lock().unwrap_or_else(PoisonError::into_inner) = None;
            self.asked = Some((Arc::clone(study), Arc::clone(evaluation)));
            self.shared.requests.put((Arc::clone(study), Arc::clone(evaluation)));
        }
        let answer = self.shared.answer.lock().unwrap_or_else(PoisonError::into_inner);
        answer.clone().filter(|answer| answer.evaluation == *evaluation)
    }
}

impl Drop for DriversThread {
    fn drop(&mut self) {
        self.shared.requests.close();
    }
}

fn answer_requests(shared: &Shared) {
    while let Some(mut wanted) = shared.requests.take() {
        while let Some(newer) = shared.requests.wait(RESTING) {
            wanted = newer;
        }
        let (study, evaluation) = wanted;
        let found = drivers(&study, &evaluation);
        let answer = DriversAnswer { evaluation, found };
        *shared.answer.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(answer));
        (shared.wake)();
    }
}

fn drivers(study: &PreparedStudy, evaluation: &Evaluation) -> Result<Drivers, String> {
    let problem = DesignProblem::new(study.study()).map_err(|error| error.to_string())?;
    let local = problem.local_of(evaluation, None).map_err(|error| error.to_string())?;
    local
        .drivers(DriversOptions::default())
        .map_err(|error| error.to_string())
}
