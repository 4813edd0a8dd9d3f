//! The command `kinefront certify`: proves bounds of the workspace radius.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex, PoisonError};

use kinefront_export::{CertificateJson, Claim};
use kinefront_model::certify::{CertifyError, CertifyOptions};
use kinefront_model::mechanism::{Design, TextError};
use kinefront_study::{PreparedStudy, Study};

use super::numbers::whole_number;
use super::stream::{InputLine, answer, next_line};
use super::subject::{DESIGN_OR_STREAM, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, load_study, print, tables};

#[derive(Debug, clap::Args)]
#[command(
    after_help = "\
The lower bound is the radius of a disc in which every pose is proved feasible over the whole rotation range; the upper
bound is the distance from the centre to a pose that is proved infeasible. The verdict on the claimed radius is proved, refuted or open.
If the study prescribes a region, the claim is that every pose of the region is feasible, unless --radius specifies a disc.",
    group = exactly_one_of(DESIGN_OR_STREAM)
)]
pub struct CertifyArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Read one design per line from standard input and write one JSON object per line.
    #[arg(long)]
    stdin: bool,
    /// Home orientation in degrees [default: the one that `evaluate --grid fine` reports].
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    phi_deg: Option<f64>,
    /// Claimed workspace radius in metres [default: the region that the study prescribes, or else the radius of the fine grid at its
    /// own home orientation].
    #[arg(long, value_name = "C", allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Relative tolerance of the claim, and gap between the bounds at which the proof ends.
    #[arg(long, value_name = "T", default_value_t = CertifyOptions::TOLERANCE, allow_negative_numbers = true)]
    tolerance: f64,
    /// Largest number of boxes.
    #[arg(long, value_name = "N", default_value_t = CertifyOptions::MAX_BOXES as u64, allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=1_000_000_000))]
    max_boxes: u64,
    /// Also bound the workspace radius over all home orientations.
    #[arg(long)]
    all_homes: bool,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &CertifyArguments) -> Result<Ending, Failure> {
    let prover = |study: Study| -> Result<Prover, Failure> {
        let study = PreparedStudy::new(study).map_err(Failure::runtime)?;
        Ok(Prover { study, arguments })
    };
    if arguments.stdin {
        let study = load_study(arguments.subject.study.as_deref()).map_err(Failure::Input)?;
        prover(study)?.serve()?;
        return Ok(Ending::Done);
    }
    let (study, design, _) = arguments.subject.read().map_err(Failure::Input)?;
    let found = prover(study)?.certify(&design).map_err(Failure::input)?;
    print(arguments.json.then_some(&found), || tables::certificate(&found))
}

/// Why a line has no certificate.
#[derive(Debug, thiserror::Error)]
enum LineError {
    #[error(transparent)]
    Text(#[from] TextError),
    #[error(transparent)]
    Certify(#[from] CertifyError),
}

struct Prover<'a> {
    study: PreparedStudy,
    arguments: &'a CertifyArguments,
}

impl Prover<'_> {
    /// Proves the design that a line of the stream states.
    fn certify_line(&self, text: &str) -> Result<CertificateJson, LineError> {
        let design = Design::parse(text, self.study.study().working_mode)?;
        Ok(self.certify(&design)?)
    }

    fn certify(&self, design: &Design) -> Result<CertificateJson, CertifyError> {
        let claim = Claim {
            phi_deg: self.arguments.phi_deg,
            radius: self.arguments.radius,
            tolerance: self.arguments.tolerance,
            max_boxes: self.arguments.max_boxes as usize,
            all_homes: self.arguments.all_homes,
        };
        CertificateJson::prove(&self.study, design, &claim)
    }

    /// Answers each line with one line, in order, on all cores.
    fn serve(&self) -> Result<(), Failure> {
        let workers = std::thread::available_parallelism().map_or(1, usize::from);
        let (to_workers, lines) = sync_channel::<(usize, InputLine)>(4 * workers);
        let (to_writer, answers) = sync_channel::<(usize, String)>(4 * workers);
        // The workers alone hold the receiver: when they end, the reader does, too.
        let lines = Arc::new(Mutex::new(lines));
        std::thread::scope(|scope| {
            for _ in 0..workers {
                let (lines, to_writer) = (Arc::clone(&lines), to_writer.clone());
                scope.spawn(move || {
                    loop {
                        let next = lines.lock().unwrap_or_else(PoisonError::into_inner).recv();
                        let Ok((number, line)) = next else { return };
                        if to_writer
                            .send((number, answer(line, |text| self.certify_line(text))))
                            .is_err()
                        {
                            return;
                        }
                    }
                });
            }
            drop((to_writer, lines));
            let reading = scope.spawn(move || -> std::io::Result<()> {
                let mut input = std::io::stdin().lock();
                for number in 0.. {
                    let Some(line) = next_line(&mut input)? else { break };
                    if to_workers.send((number, line)).is_err() {
                        break;
                    }
                }
                Ok(())
            });
            let mut out = std::io::stdout().lock();
            let (mut next, mut waiting) = (0, BTreeMap::new());
            for (number, answer) in answers {
                waiting.insert(number, answer);
                while let Some(answer) = waiting.remove(&next) {
                    writeln!(out, "{answer}")?;
                    out.flush()?;
                    next += 1;
                }
            }
            match reading.join() {
                Ok(read) => Ok(read?),
                Err(_) => Err(Failure::Runtime(miette::miette!(
                    "the thread that reads the designs panicked"
                ))),
            }
        })
    }
}
