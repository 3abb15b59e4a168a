//! `ambray completions` and `ambray man`: what is generated from the command line's description.

use crate::{
    args::{self, CompletionsArgs},
    terminal,
};

/// Prints the completions for a shell.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut args::command(), "ambray", &mut script);
    terminal::print_bytes(&script)
}

/// Prints the manual page, the commands one after another.
pub fn man() -> anyhow::Result<()> {
    let mut pages = Vec::new();
    let mut command = args::command();
    command.build();
    clap_mangen::Man::new(command.clone()).render(&mut pages)?;
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set() && sub.get_name() != "help") {
        clap_mangen::Man::new(sub.clone()).title(format!("ambray-{}", sub.get_name())).render(&mut pages)?;
    }
    terminal::print_bytes(&pages)
}
