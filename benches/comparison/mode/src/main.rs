//! MODE of fcmaes-core, a comparable optimizer in Rust, on the evaluator of `kinefront evaluate --stdin`.
//!
//! ```text
//! mode KINEFRONT ARCHITECTURES EVALUATIONS SEED POPULATION
//! ```
//!
//! Prints each design as it is sent to the evaluator; `compare.py` evaluates the designs again. Several architectures
//! (`3-PRR,3-RPR,3-RRR`) are one more variable, whose range is divided into equal parts.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};

use fcmaes_core::{Fitness, Mode, ModeParams};

const LOWER: [f64; 5] = [0.5, 0.1, 0.5, 0.0, 0.0];
const UPPER: [f64; 5] = [4.0, 4.0, 4.0, 0.1, 0.1];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [program, architectures, evaluations, seed, population] = arguments.as_slice() else {
        eprintln!("usage: mode KINEFRONT ARCHITECTURES EVALUATIONS SEED POPULATION");
        std::process::exit(2);
    };
    let architectures: Vec<&str> = architectures.split(',').collect();
    let evaluations: usize = evaluations.parse().expect("a number");
    let several = architectures.len() > 1;
    let (mut lower, mut upper) = (LOWER.to_vec(), UPPER.to_vec());
    if several {
        lower.push(0.0);
        upper.push(1.0);
    }
    let mut evaluator = Command::new(program)
        .args(["evaluate", "--stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the evaluator starts");
    let fitness = Fitness::bounded(lower.len(), 3, &lower, &upper);
    let params = ModeParams {
        popsize: population.parse().expect("a number"),
        seed: seed.parse().expect("a number"),
        ..Default::default()
    };
    let mut mode = Mode::new(fitness, 2, 1, None, &params);
    let mut done = 0;
    while done < evaluations {
        let asked = mode.ask();
        let designs: Vec<String> = asked
            .iter()
            .map(|x| {
                let place = x.get(5).map_or(0.0, |fraction| fraction * architectures.len() as f64);
                let architecture = architectures[(place as usize).min(architectures.len() - 1)];
                format!("{architecture} R={} r={} Lb={} rj={} rp={}", x[0], x[1], x[2], x[3], x[4])
            })
            .collect();
        let outcomes = evaluate(&mut evaluator, &designs);
        for design in &designs {
            println!("{design}");
        }
        done += designs.len();
        mode.tell(&outcomes);
    }
}

/// Evaluates designs; returns the mass, −R_w and the violation of each.
fn evaluate(evaluator: &mut Child, designs: &[String]) -> Vec<Vec<f64>> {
    let mut input = evaluator.stdin.take().expect("piped");
    let lines = designs.join("\n") + "\n";
    // Answers arrive while designs are still being sent: a thread writes them, so that neither pipe fills up.
    let writer = std::thread::spawn(move || {
        input.write_all(lines.as_bytes()).expect("the evaluator reads");
        input.flush().expect("the evaluator reads");
        input
    });
    let output = evaluator.stdout.take().expect("piped");
    let mut reader = BufReader::new(output);
    let outcomes = designs
        .iter()
        .map(|_| {
            let mut line = String::new();
            reader.read_line(&mut line).expect("an answer");
            let number = |key: &str| -> f64 {
                let (_, rest) = line.split_once(&format!("\"{key}\":")).expect("the key");
                let end = rest.find([',', '}']).expect("an end");
                rest[..end].trim().parse().expect("a number")
            };
            vec![number("mass_kg"), -number("workspace_radius_m"), number("violation")]
        })
        .collect();
    evaluator.stdout = Some(reader.into_inner());
    evaluator.stdin = Some(writer.join().expect("the writer ends"));
    outcomes
}
