//! The command `kinefront study`.

use std::io::Write;
use std::path::{Path, PathBuf};

use kinefront_study::{BUILTIN, Builtin, Study, write_whole};
use miette::miette;

use super::{Ending, Failure, exists_already, load_study, question, study_keys};

#[derive(Debug, clap::Args)]
pub struct StudyArguments {
    #[command(subcommand)]
    command: StudyCommand,
}

#[derive(Debug, clap::Subcommand)]
enum StudyCommand {
    /// List the built-in studies.
    List,
    /// Print a built-in study with its comments.
    Show {
        /// Name of the built-in study.
        #[arg(default_value = "paper")]
        name: String,
    },
    /// Write a new study file with comments.
    New {
        /// File to write, which must not exist; `-` writes to standard output.
        #[arg(default_value = "study.toml")]
        file: PathBuf,
        /// Built-in study to copy [default: the paper's with a clearance between members, in layers chosen for each design].
        #[arg(long)]
        from: Option<String>,
        /// Ask questions on the terminal and write the study from the answers, instead of copying one.
        #[arg(long, conflicts_with = "from")]
        question: bool,
    },
    /// Print the reference of all keys of a study and of all quantities, in Markdown.
    Keys {
        /// Part of a key or section, as in `requirements` or `clearance`.
        part: Option<String>,
    },
    /// Check a study file, and report its errors or the requirements that it leaves open.
    Check {
        /// Study file to check.
        file: PathBuf,
    },
}

fn builtin(name: &str) -> Result<Builtin, Failure> {
    Builtin::find(name)
        .ok_or_else(|| Failure::Input(miette!("no study `{name}`; expected one of {}", Builtin::names())))
}

/// Returns the text of a study with the requirement of a clearance that it has as a comment, and with layers that are chosen for each design:
/// members of a machine do not collide.
fn with_clearance(text: &str) -> String {
    let required = text.replace("# clearance_min_m =", "clearance_min_m =");
    required.replace("stacking = \"common\"", "stacking = \"chosen\"")
}

pub fn run(arguments: &StudyArguments) -> Result<Ending, Failure> {
    let mut out = std::io::stdout().lock();
    match &arguments.command {
        StudyCommand::List => {
            for builtin in BUILTIN {
                let study = builtin.study().map_err(|error| Failure::Input(error.into()))?;
                writeln!(out, "{:<28}{}", builtin.name, study.description)?;
            }
        }
        StudyCommand::Show { name } => write!(out, "{}", builtin(name)?.text)?,
        StudyCommand::New { file, from, question } => {
            if file != Path::new("-") && file.exists() {
                return Err(exists_already(file));
            }
            let text = if *question {
                // With the study on standard output, the questions go to standard error.
                let answers = &mut std::io::stdin().lock();
                let asked = if file == Path::new("-") {
                    question::ask(answers, &mut std::io::stderr().lock())
                } else {
                    question::ask(answers, &mut out)
                };
                asked.map_err(|error| Failure::Input(miette!("no study was written: {error}")))?
            } else {
                match from {
                    Some(name) => builtin(name)?.text.to_owned(),
                    None => with_clearance(builtin("paper")?.text),
                }
            };
            if file == Path::new("-") {
                write!(out, "{text}")?;
                return Ok(Ending::Done);
            }
            write_whole(file, text.as_bytes()).map_err(Failure::runtime)?;
            writeln!(out, "wrote {}", file.display())?;
        }
        StudyCommand::Keys { part } => {
            let reference = study_keys::reference(part.as_deref()).map_err(Failure::Input)?;
            write!(out, "{reference}")?;
        }
        StudyCommand::Check { file } => {
            let study: Study = load_study(Some(file.as_os_str())).map_err(Failure::Input)?;
            writeln!(out, "{}: valid ({})", file.display(), study.name)?;
            for point in study.open_points() {
                writeln!(out, "left open: {point}")?;
            }
        }
    }
    Ok(Ending::Done)
}
