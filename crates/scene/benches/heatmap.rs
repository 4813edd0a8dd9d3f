//! Measures how fast a heatmap is drawn: `cargo bench --no-default-features --bench heatmap`.
//!
//! The heatmap has about 10⁵ cells of the paper's design II and includes edges and contours; it is drawn on one thread
//! and on two.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_model::mechanism::Design;
use kinefront_scene::{Field, Heatmap, HeatmapSettings};

fn heatmaps(criterion: &mut Criterion) {
    let model = Model::default();
    let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
        .parse()
        .expect("a design");
    let draw = |field| Heatmap::new(&model, &design, field, 0.5, HeatmapSettings { cells: 388 });
    let cells = draw(Field::DEXTERITY).cells;
    println!("{cells} cells");
    let mut group = criterion.benchmark_group("heatmap");
    group.sample_size(20).throughput(Throughput::Elements(cells as u64));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        for field in [
            Field::DEXTERITY,
            Field::Scalar(PoseScalar::StiffnessXy),
            Field::WorstMargin,
        ] {
            group.bench_function(BenchmarkId::new(field.key(), threads), |bencher| {
                bencher.iter(|| pool.install(|| draw(field)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, heatmaps);
criterion_main!(benches);
