//! Proofs of workspaces, beside the evaluations on the fine grid that they complete.

use criterion::{BenchmarkId, Criterion, Throughput};
use kinefront_model::certify::Certificate;
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use kinefront_model::mechanism::Architecture;

/// Evaluations on the fine grid of designs spread over the best front known of an architecture.
fn front(model: &Model, architecture: Architecture) -> Vec<Evaluation> {
    const COUNT: usize = 40;
    let path = format!("assets/reference_fronts/{}.csv", architecture.name());
    let table = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let rows: Vec<&str> = table.lines().skip(1).collect();
    let evaluate = |row: &str| {
        let fields: Vec<&str> = row.split(',').collect();
        let [name, base, platform, link, leg, bar] = fields[..6] else {
            panic!("{path}: {row}")
        };
        let design = format!("{name} R={base} r={platform} Lb={link} rj={leg} rp={bar}");
        model.evaluate(&design.parse().expect("a design"), GridChoice::Fine)
    };
    rows.iter()
        .step_by(rows.len() / COUNT)
        .map(|row| evaluate(row))
        .collect()
}

fn certify(model: &Model, evaluation: &Evaluation) -> Certificate {
    let claim = model.claim(evaluation).expect("a workspace");
    model.certify(&evaluation.design, &claim).expect("a certificate")
}

pub fn proofs(criterion: &mut Criterion) {
    let model = Model::default();
    let mut group = criterion.benchmark_group("proof");
    group.sample_size(10);
    for &architecture in Architecture::PAPER {
        let found = front(&model, architecture);
        let mut boxes: Vec<usize> = found
            .iter()
            .map(|evaluation| certify(&model, evaluation).boxes)
            .collect();
        boxes.sort_unstable();
        println!(
            "{architecture}: {} boxes in the median, at most {}",
            boxes[boxes.len() / 2],
            boxes[boxes.len() - 1]
        );
        group.throughput(Throughput::Elements(found.len() as u64));
        group.bench_function(BenchmarkId::new("fine grid", architecture), |bencher| {
            bencher.iter(|| {
                let radii = found
                    .iter()
                    .map(|known| model.evaluate(&known.design, GridChoice::Fine).workspace_radius());
                radii.sum::<f64>()
            });
        });
        group.bench_function(BenchmarkId::new("proof", architecture), |bencher| {
            bencher.iter(|| found.iter().map(|known| certify(&model, known).lower).sum::<f64>());
        });
    }
    group.finish();
}
