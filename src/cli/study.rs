//! `kinefront study`.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

use kinefront::study::{BUILTIN, Builtin, Study};
use miette::miette;

use super::{Ending, Failure, builtin_names, load_study};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// List the studies that come with the program.
    List,
    /// Print a study, comments and all.
    Show {
        /// Name of a study that comes with the program.
        #[arg(default_value = "paper")]
        name: String,
    },
    /// Write a commented study file to start from.
    New {
        /// The file; it must not exist.
        #[arg(default_value = "study.toml")]
        file: PathBuf,
        /// Study to start from.
        #[arg(long, default_value = "paper")]
        from: String,
    },
    /// Read a study file and say what is wrong with it.
    Check {
        /// The file.
        file: PathBuf,
    },
}

fn builtin(name: &str) -> Result<Builtin, Failure> {
    Builtin::find(name).ok_or_else(|| Failure::Input(miette!("no study `{name}`; there are: {}", builtin_names())))
}

pub fn run(arguments: &Arguments) -> Result<Ending, Failure> {
    let mut out = std::io::stdout().lock();
    match &arguments.command {
        Command::List => {
            for builtin in BUILTIN {
                let study = builtin.study().map_err(Failure::input)?;
                writeln!(out, "{:<28}{}", builtin.name, study.description)?;
            }
        }
        Command::Show { name } => write!(out, "{}", builtin(name)?.text)?,
        Command::New { file, from } => {
            let text = builtin(from)?.text;
            let mut target = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(file)
                .map_err(|error| Failure::Input(miette!("cannot write {}: {error}", file.display())))?;
            target.write_all(text.as_bytes())?;
            writeln!(out, "wrote {}", file.display())?;
        }
        Command::Check { file } => {
            let study: Study = load_study(file.to_str()).map_err(Failure::Input)?;
            writeln!(out, "{}: sound ({})", file.display(), study.name)?;
        }
    }
    Ok(Ending::Done)
}
