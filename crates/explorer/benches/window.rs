//! Measures the window with a million designs: frame times of the panels, the time from a click to the scene, memory,
//! and how many designs per second can be received before the optimizer has to wait.
//!
//! `cargo bench --bench window` prints a table. Criterion is not used, because the slowest frame in a hundred matters,
//! and the behaviour while designs are received.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use kinefront_explorer::{Explorer, InitialContent, Session, StudyEditor};
use kinefront_model::evaluation::{Evaluation, GridChoice, Quantity};
use kinefront_optimize::{Archive, sobol};
use kinefront_recording::LiveScene;
use kinefront_study::{
    BUILTIN, Batch, DesignProblem, EndReason, Event, FrontMember, GenerationSummary, Row, RunSummary, RunTimes,
    Started, Study, Subscriber, TableRow,
};

const DESIGNS: usize = 1_000_000;
const GENERATION: usize = 500;

/// A stream of designs from a pool of evaluated ones, repeated with other masses and radii.
struct Stream {
    pool: Vec<Evaluation>,
    count: usize,
    /// Designs per second; as fast as they are received if `None`.
    rate: Option<f64>,
}

impl Stream {
    fn new(study: &Study, count: usize, rate: Option<f64>) -> Self {
        let problem = DesignProblem::new(study).expect("a valid study");
        let pool = sobol(&problem.variables(), 1500, 1)
            .iter()
            .filter_map(|x| problem.evaluation(x).ok())
            .collect();
        Self { pool, count, rate }
    }

    /// Returns design `id`: one of the pool with another mass and a smaller radius.
    fn evaluation(&self, id: usize) -> Evaluation {
        let mut evaluation = self.pool[id % self.pool.len()].clone();
        let chance = (id as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        let fraction = chance as f64 / f64::from(1 << 24);
        let scaled = |quantity: Quantity| {
            let factor = match quantity {
                Quantity::Mass => 0.7 + 0.6 * fraction,
                Quantity::WorkspaceRadius => 0.8 + 0.2 * fraction,
                _ => 1.0,
            };
            (
                quantity,
                evaluation.quantities.get(quantity).map(|value| factor * value),
            )
        };
        evaluation.quantities = Quantity::all().map(scaled).collect();
        evaluation.objectives = vec![evaluation.mass(), -evaluation.workspace_radius()];
        evaluation
    }

    /// Sends all designs to the subscribers; returns the time spent on sending.
    fn send(&self, study: Study, subscribers: &[Subscriber]) -> Duration {
        let tell = |event: Event| {
            let event = Arc::new(event);
            let since = Instant::now();
            for subscriber in subscribers {
                let _ = subscriber.send(Arc::clone(&event));
            }
            since.elapsed()
        };
        let mut waited = tell(Event::Started(Started {
            study: Arc::new(study),
            threads: 1,
        }));
        let mut sent = SentFront::default();
        let mut history = Vec::new();
        let began = Instant::now();
        for generation in 1..=self.count / GENERATION {
            if let Some(rate) = self.rate {
                let due = Duration::from_secs_f64((generation * GENERATION) as f64 / rate);
                std::thread::sleep(due.saturating_sub(began.elapsed()));
            }
            let first_id = (generation - 1) * GENERATION;
            let evaluations: Vec<Evaluation> = (first_id..first_id + GENERATION)
                .map(|id| self.evaluation(id))
                .collect();
            waited += tell(Event::Evaluated(Batch {
                generation,
                first_id,
                rows: evaluations
                    .iter()
                    .map(|evaluation| Row::new(generation, evaluation))
                    .collect(),
            }));
            if sent.add(generation, first_id, &evaluations) {
                let row = |member: &FrontMember| {
                    let row = Row::new(member.generation, &member.evaluation);
                    Arc::new(TableRow::new(member.id, row))
                };
                waited += tell(Event::Front(sent.members.iter().map(row).collect()));
            }
            let summary = GenerationSummary {
                generation,
                evaluations: first_id + GENERATION,
                feasible: first_id / 2,
                front_size: sent.archive.len(),
                hypervolume: generation as f64,
            };
            history.push(summary);
            waited += tell(Event::Generation(summary));
        }
        waited += tell(Event::Finished(RunSummary {
            outcome: EndReason::Completed,
            threads: 1,
            history,
            verified: sent.members.len(),
            front: sent.members,
            dropped: 0,
            verified_hypervolume: 0.0,
            proofs: None,
            times: RunTimes::default(),
        }));
        waited
    }
}

/// The front of the designs that were sent.
#[derive(Default)]
struct SentFront {
    archive: Archive,
    members: Vec<FrontMember>,
}

impl SentFront {
    /// Adds the designs of a generation; returns whether the front has changed.
    fn add(&mut self, generation: usize, first_id: usize, evaluations: &[Evaluation]) -> bool {
        let mut changed = false;
        for (id, evaluation) in (first_id..).zip(evaluations) {
            if self.archive.insert(id, &[], &DesignProblem::outcome(evaluation)) {
                changed = true;
                self.members.push(FrontMember {
                    id,
                    generation,
                    evaluation: evaluation.clone(),
                    reference_radius: evaluation.workspace_radius(),
                    certified: None,
                });
            }
        }
        if changed {
            self.members
                .retain(|member| self.archive.iter().any(|kept| kept.id == member.id));
            self.members
                .sort_by(|a, b| a.evaluation.mass().total_cmp(&b.evaluation.mass()));
        }
        changed
    }
}

fn study() -> Study {
    BUILTIN[0].study().expect("a valid study")
}

fn window() -> Harness<'static, Explorer> {
    Harness::builder()
        .with_size(egui::vec2(1600.0, 1000.0))
        .with_step_dt(1.0 / 60.0)
        .build_eframe(|cc| {
            let subject = InitialContent::Study {
                study: Box::new(study()),
                path: None,
                start: false,
            };
            Explorer::new(cc, subject, None, false).expect("a window")
        })
}

/// Returns the median and the 99th percentile as text, in milliseconds.
fn percentiles(times: &mut [f64]) -> String {
    times.sort_by(f64::total_cmp);
    let at = |fraction: f64| 1e3 * times[((times.len() - 1) as f64 * fraction) as usize];
    format!(
        "median {:.2} ms, 99th percentile {:.2} ms ({} frames)",
        at(0.5),
        at(0.99),
        times.len()
    )
}

/// Returns the memory of this process \[MB\], or NaN if the operating system does not report it.
fn memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kilobytes.unwrap_or(f64::NAN) / 1024.0
}

fn frame(window: &mut Harness<'static, Explorer>) -> f64 {
    let since = Instant::now();
    window.step();
    since.elapsed().as_secs_f64()
}

/// Streams `count` designs through the listeners that `keep` selects; returns the duration, the time spent on sending
/// and the frame times meanwhile, all in seconds.
fn stream(
    window: &mut Harness<'static, Explorer>,
    count: usize,
    rate: Option<f64>,
    keep: fn(Vec<Subscriber>) -> Vec<Subscriber>,
) -> (f64, f64, Vec<f64>) {
    let source = Stream::new(&study(), count, rate);
    let told = Arc::new(Mutex::new(None));
    let tells = Arc::clone(&told);
    window
        .state_mut()
        .session_mut()
        .start_from(move |study, _, subscribers| {
            std::thread::Builder::new().spawn(move || {
                let since = Instant::now();
                let waited = source.send(study, &keep(subscribers));
                *tells.lock().expect("a lock") = Some((since.elapsed(), waited));
            })
        });
    let mut times = Vec::new();
    while told.lock().expect("a lock").is_none() || window.state().session().is_running() {
        times.push(frame(window));
        // A screen shows 60 frames per second.
        let left = (1.0 / 60.0 - times[times.len() - 1]).max(0.0);
        std::thread::sleep(Duration::from_secs_f64(left));
    }
    let (took, waited) = told.lock().expect("a lock").take().expect("an end");
    (took.as_secs_f64(), waited.as_secs_f64(), times)
}

fn main() {
    // `cargo test --benches` and similar commands only check that the benchmark builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let mut window = window();
    window.run_steps(5);
    println!("memory before: {:.0} MB", memory());

    // The first subscriber writes the tables and passes the designs on to the window; the second writes the recording.
    let (took, waited, mut times) = stream(&mut window, DESIGNS, None, |subscribers| {
        subscribers.into_iter().take(1).collect()
    });
    println!(
        "{DESIGNS} designs to tables and window: {took:.1} s, of which {waited:.2} s sending: {:.0} designs/s",
        DESIGNS as f64 / took.max(1e-9)
    );
    println!("frames while designs arrive: {}", percentiles(&mut times));
    assert_eq!(window.state().session().store().len(), DESIGNS);
    for _ in 0..120 {
        frame(&mut window);
    }
    let mut times: Vec<f64> = (0..400).map(|_| frame(&mut window)).collect();
    println!("frames with {DESIGNS} designs, at rest: {}", percentiles(&mut times));
    let at = egui::pos2(240.0, 300.0);
    window.hover_at(at);
    let mut times: Vec<f64> = (0..400)
        .map(|k| {
            let zoom = if k % 2 == 0 { 1.02 } else { 1.0 / 1.02 };
            window.input_mut().events.push(egui::Event::Zoom(zoom));
            window
                .input_mut()
                .events
                .push(egui::Event::PointerMoved(at + egui::vec2((k % 50) as f32, 0.0)));
            frame(&mut window)
        })
        .collect();
    println!("frames with {DESIGNS} designs, zooming: {}", percentiles(&mut times));
    println!(
        "memory with {DESIGNS} designs: {:.0} MB, of which {:.0} MB for the designs",
        memory(),
        window.state().session().store().bytes() as f64 / 1048576.0
    );
    drop(window);

    let mut all = self::window();
    let (took, waited, mut times) = stream(&mut all, 100_000, None, |subscribers| subscribers);
    println!(
        "100000 designs to window, tables and recording: {took:.1} s, of which {waited:.1} s sending: {:.0} designs/s",
        1e5 / took.max(1e-9)
    );
    println!("frames meanwhile: {}", percentiles(&mut times));
    let (_, _, mut times) = stream(&mut all, 50_000, Some(5000.0), |subscribers| subscribers);
    println!(
        "frames while 5000 designs per second arrive: {}",
        percentiles(&mut times)
    );
    drop(all);
    clicks("of any size, for which the view is set up again", [0.5, 4.0]);
    clicks("of similar size", [2.8, 4.0]);
}

/// Measures the time from a click until the last row of the scene is sent to the viewer.
fn clicks(of: &str, base_radius: [f64; 2]) {
    let sent = Arc::new(AtomicU64::new(0));
    let counting = Arc::clone(&sent);
    let sink = rerun::sink::CallbackSink::new(move |messages| {
        counting.fetch_add(messages.len() as u64, Ordering::Relaxed);
    });
    let mut study = study();
    study.bounds.R_m = base_radius;
    let scene = LiveScene::new(Box::new(sink), &study).expect("a scene");
    let mut session =
        Session::new(StudyEditor::new(study.clone(), None), Some(scene), Arc::new(|| {})).expect("a session");
    let problem = DesignProblem::new(&study).expect("a valid study");
    let model = study.model().expect("a valid study");
    let mut times = Vec::new();
    for x in sobol(&problem.variables(), 150, 1) {
        let Ok(design) = problem.design(&x) else { continue };
        let feasible = model.evaluate(&design, GridChoice::Reference).is_feasible();
        if !feasible {
            continue;
        }
        let since = Instant::now();
        session.paste(&design.to_string());
        session.update();
        while !(session.is_drawn() && session.known().is_some()) {
            std::thread::sleep(Duration::from_micros(100));
            session.update();
        }
        times.push(since.elapsed().as_secs_f64());
        // A user looks at the design before clicking again; it is verified meanwhile.
        while !session.known().is_some_and(|known| known.verified) {
            std::thread::sleep(Duration::from_millis(5));
            session.update();
        }
    }
    println!(
        "from a click to the scene, designs {of} (evaluation, heatmap, workspace, layers; {} messages): {}",
        sent.load(Ordering::Relaxed) / times.len().max(1) as u64,
        percentiles(&mut times)
    );
}
