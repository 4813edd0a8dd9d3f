//! The command `kinefront manual`: the help of every command as manual pages.

use std::io::Write;
use std::path::PathBuf;

use clap::CommandFactory;
use clap_mangen::Man;
use kinefront_study::write_whole;
use miette::miette;

use super::{Ending, Failure, ProgramArguments, exists_already};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  kinefront manual ~/.local/share/man/man1 && man kinefront-optimize")]
pub struct ManualArguments {
    /// Folder for the pages kinefront.1, kinefront-optimize.1 and so on, none of which may exist.
    folder: PathBuf,
}

pub fn run(arguments: &ManualArguments) -> Result<Ending, Failure> {
    let mut program = ProgramArguments::command();
    program.build();
    let folder = arguments.folder.display();
    if arguments.folder.exists() && !arguments.folder.is_dir() {
        return Err(Failure::Input(miette!(
            "{folder} is not a folder; choose another path for the pages"
        )));
    }
    std::fs::create_dir_all(&arguments.folder)
        .map_err(|error| Failure::Runtime(miette!("cannot create the folder {folder}: {error}")))?;
    let mut pages = Vec::new();
    collect(&program, &mut pages)?;
    for (name, _) in &pages {
        let path = arguments.folder.join(name);
        if path.exists() {
            return Err(exists_already(&path));
        }
    }
    for (name, page) in &pages {
        write_whole(&arguments.folder.join(name), page).map_err(Failure::runtime)?;
    }
    writeln!(std::io::stdout(), "wrote {} pages into {folder}", pages.len())?;
    Ok(Ending::Done)
}

/// Appends the page of a command, and those of its commands.
fn collect(command: &clap::Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page)?;
    pages.push((man.get_filename(), page));
    let shown = command.get_subcommands().filter(|command| !command.is_hide_set());
    for subcommand in shown.filter(|command| command.get_name() != "help") {
        collect(subcommand, pages)?;
    }
    Ok(())
}
