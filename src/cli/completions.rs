//! The command `kinefront completions`: a script with which a shell completes commands and options.

use std::io::Write;

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use super::{Ending, Failure, ProgramArguments};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  kinefront completions bash > ~/.local/share/bash-completion/completions/kinefront
  kinefront completions zsh > ~/.zfunc/_kinefront
  kinefront completions fish > ~/.config/fish/completions/kinefront.fish")]
pub struct CompletionsArguments {
    /// Shell that reads the script.
    #[arg(value_enum)]
    shell: Shell,
}

pub fn run(arguments: &CompletionsArguments) -> Result<Ending, Failure> {
    let mut script = Vec::new();
    generate(
        arguments.shell,
        &mut ProgramArguments::command(),
        "kinefront",
        &mut script,
    );
    // Written here, because `generate` panics where the standard output is closed.
    std::io::stdout().write_all(&script)?;
    Ok(Ending::Done)
}
