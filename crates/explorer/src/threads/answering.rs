//! A thread that answers the latest of its questions.

use std::sync::{Arc, Mutex};
use std::thread::Builder;
use std::time::Duration;

use super::mailbox::Mailbox;
use super::{Wake, lock};

/// What a thread is asked, with its answer.
pub trait Question: Clone + PartialEq + Send + 'static {
    /// What the thread answers.
    type Answer: Send + Sync + 'static;

    /// Name of the thread.
    const THREAD: &'static str;

    /// Time for which a question must be the latest one before it is answered: a slider passes through many.
    const RESTING: Duration;

    /// Returns the answer.
    fn answer(&self) -> Self::Answer;
}

/// A question that was answered, with its answer.
type Answered<Q> = (Q, Arc<<Q as Question>::Answer>);

struct Shared<Q: Question> {
    questions: Mailbox<Q>,
    answered: Mutex<Option<Answered<Q>>>,
    wake: Wake,
}

/// Answers questions on its own thread, which starts with the first one.
pub struct AnsweringThread<Q: Question> {
    shared: Arc<Shared<Q>>,
    asked: Option<Q>,
    is_started: bool,
}

impl<Q: Question> AnsweringThread<Q> {
    /// Prepares the thread.
    pub fn new(wake: Wake) -> Self {
        Self {
            shared: Arc::new(Shared {
                questions: Mailbox::new(),
                answered: Mutex::new(None),
                wake,
            }),
            asked: None,
            is_started: false,
        }
    }

    /// Asks a question, unless it was asked last; returns its answer once it is known.
    pub fn ask(&mut self, question: Q) -> Option<Arc<Q::Answer>> {
        if self.asked.as_ref() != Some(&question) {
            if !self.is_started {
                let shared = Arc::clone(&self.shared);
                let thread = Builder::new().name(Q::THREAD.to_owned());
                // Without a thread there is no answer; the next question tries again.
                thread.spawn(move || answer_questions(&shared)).ok()?;
                self.is_started = true;
            }
            self.asked = Some(question.clone());
            self.shared.questions.put(question);
        }
        self.answer()
    }

    /// Returns the answer to the question that was asked last, once it is known.
    pub fn answer(&self) -> Option<Arc<Q::Answer>> {
        let asked = self.asked.as_ref()?;
        self.last(|question| question == asked)
    }

    /// Returns the answer that was found last, if `accepts` accepts its question.
    pub fn last(&self, accepts: impl FnOnce(&Q) -> bool) -> Option<Arc<Q::Answer>> {
        let answered = lock(&self.shared.answered);
        let (question, answer) = answered.as_ref()?;
        accepts(question).then(|| Arc::clone(answer))
    }

    /// Returns whether the question that was asked last has no answer yet.
    pub fn is_waiting(&self) -> bool {
        self.asked.is_some() && self.answer().is_none()
    }

    /// Returns the question that was asked last.
    pub fn asked(&self) -> Option<&Q> {
        self.asked.as_ref()
    }

    /// Forgets the question that was asked last.
    pub fn forget(&mut self) {
        self.asked = None;
    }
}

impl<Q: Question> Drop for AnsweringThread<Q> {
    fn drop(&mut self) {
        self.shared.questions.close();
    }
}

fn answer_questions<Q: Question>(shared: &Shared<Q>) {
    while let Some(mut question) = shared.questions.take() {
        while let Some(newer) = shared.questions.wait(Q::RESTING) {
            question = newer;
        }
        let answer = Arc::new(question.answer());
        *lock(&shared.answered) = Some((question, answer));
        (shared.wake)();
    }
}
