//! One evaluation and one proof on several threads.

use kinefront_model::certify::{CertifyOptions, ExaminedBox, ProofObserver, Verdict};
use kinefront_model::evaluation::{GridChoice, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::workers::OneWorker;
use kinefront_study::{Builtin, PoolWorkers, PreparedStudy};

use super::builtin;

/// A design of the front of the study `builders-cell`, with its home orientation \[deg\].
const OF_THE_CELL: (&str, f64) = (
    "3-PRR R=0.8538830401084929 r=0.3660083121953258 Lb=0.5867791700957081 rj=0.01345 rp=0.028275604142364453",
    14.0,
);

fn model(builtin: &Builtin) -> Model {
    let study = builtin.study().expect("a valid study");
    PreparedStudy::new(study).expect("grids that fit").model().clone()
}

fn on_threads<T: Send>(count: usize, of: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.expect("threads").install(of)
}

fn design(text: &str) -> Design {
    text.parse().expect("a design")
}

/// Feasible and infeasible designs, of a prescribed region with limits that take long and of the largest disc.
#[test]
fn an_evaluation_is_the_same_on_any_number_of_threads() {
    let (of_the_cell, _) = OF_THE_CELL;
    let [cell, paper] = ["builders-cell", "paper"].map(builtin);
    let cases = [
        (&cell, cell.design.to_owned()),
        (&cell, of_the_cell.to_owned()),
        (&cell, of_the_cell.replace("rj=0.01345", "rj=0.00675")),
        (&cell, of_the_cell.replace("Lb=0.58", "Lb=0.42")),
        (&paper, paper.design.to_owned()),
    ];
    let mut feasible = 0;
    for (study, text) in cases {
        let model = model(study).with_all_quantities();
        let alone = model.evaluate_by(&OneWorker, &design(&text), GridChoice::Reference);
        feasible += usize::from(alone.is_feasible());
        for count in [1, 2, 5] {
            let by_pool = || model.evaluate_by(&PoolWorkers, &design(&text), GridChoice::Reference);
            assert_eq!(on_threads(count, by_pool), alone, "{text}, {count} threads");
        }
    }
    assert_eq!(feasible, 2);
}

/// Keeps all boxes of a proof, in their order.
#[derive(Default)]
struct Boxes(Vec<ExaminedBox>);

impl ProofObserver for Boxes {
    fn watches_boxes(&self) -> bool {
        true
    }

    fn examined(&mut self, examined: &ExaminedBox) {
        self.0.push(*examined);
    }
}

/// A proof and a refutation have the same boxes in the same order.
#[test]
fn a_proof_is_the_same_on_any_number_of_threads() {
    let (text, phi_deg) = OF_THE_CELL;
    let options = CertifyOptions {
        phi_deg,
        claimed_radius: 0.2,
        is_of_region: true,
        ..CertifyOptions::default()
    };
    let model = model(&builtin("builders-cell"));
    let cases = [
        (text.to_owned(), Verdict::Proved),
        (text.replace("rp=0.028", "rp=0.0265"), Verdict::Refuted),
    ];
    for (text, verdict) in cases {
        let proof = |observer: &mut Boxes| model.certify_by(&PoolWorkers, &design(&text), &options, observer);
        let mut alone = Boxes::default();
        let expected = model
            .certify_observed(&design(&text), &options, &mut alone)
            .expect("a certificate");
        assert_eq!(expected.verdict, verdict, "{text}");
        for count in [1, 2, 5] {
            let mut boxes = Boxes::default();
            let found = on_threads(count, || proof(&mut boxes)).expect("a certificate");
            assert_eq!(found, expected, "{text}, {count} threads");
            assert!(boxes.0 == alone.0, "{text}, {count} threads: the boxes differ");
        }
    }
}
