//! `tyndall completions`.

use clap::Args;
use clap_complete::Shell;

/// Arguments of `tyndall completions`.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  bash   tyndall completions bash > ~/.local/share/bash-completion/completions/tyndall
  zsh    tyndall completions zsh > ~/.zfunc/_tyndall
  fish   tyndall completions fish > ~/.config/fish/completions/tyndall.fish")]
pub struct CompletionsArgs {
    /// The shell to complete in
    #[arg(value_enum)]
    pub shell: Shell,
}
