//! When a search for the best design near a start gives up.

/// Rounds without an improvement after which the search ends.
const PATIENCE: usize = 10;

/// The same for the designs of a front: many are looked for, and another one takes the place of one that does not exist.
const QUICK_PATIENCE: usize = 5;

/// Share of what was missed before that is missed again where critical poses contradict each other.
const CONTRADICTED: f64 = 0.9;

/// How long a search goes on that comes no nearer to keeping its requirements.
pub(crate) struct Patience {
    /// Whether the search is for a design of a front.
    is_quick: bool,
    /// The least amount that was missed, and the rounds since then.
    least: f64,
    since: usize,
    /// What the last round missed, and the rounds in which the poses that are known contradicted each other.
    last: f64,
    contradicted: usize,
}

impl Patience {
    pub fn new(is_quick: bool) -> Self {
        Self {
            is_quick,
            least: f64::INFINITY,
            since: 0,
            last: f64::INFINITY,
            contradicted: 0,
        }
    }

    /// Returns whether a search should end after a round that misses `missed`, of which `left` is missed at the poses that were known;
    /// `has_largest_weight` tells whether violations weigh as much as they can.
    pub fn is_spent(&mut self, missed: f64, left: f64, has_largest_weight: bool) -> bool {
        self.since += 1;
        if missed < 0.7 * self.least {
            (self.least, self.since) = (missed, 0);
        }
        // Poses that contradict each other, whatever their violations weigh, still do so when others are added.
        let contradicts = has_largest_weight && left > 0.5 * missed && missed > CONTRADICTED * self.last;
        self.contradicted = if contradicts { self.contradicted + 1 } else { 0 };
        self.last = missed;
        self.is_over()
    }

    /// Returns whether a search should end after a round that was taken back.
    pub fn is_spent_in_vain(&mut self) -> bool {
        self.since += 1;
        self.is_over()
    }

    fn is_over(&self) -> bool {
        match self.is_quick {
            true => self.since > QUICK_PATIENCE || self.contradicted >= 2,
            false => self.since > PATIENCE,
        }
    }
}
