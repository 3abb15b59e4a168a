//! Options of `ambray view`.

use std::path::PathBuf;

use clap::Args;

use super::{BackendArgs, SceneArgs, SettingsArgs, whole};

/// Arguments of `ambray view`.
#[derive(Clone, Debug, Args)]
pub struct ViewArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Number of threads of the CPU backend, 0 for all cores; the picture does not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = |text: &str| whole::<u16>(text, 0, 1024))]
    pub threads: u16,
    /// File where window, recent files and looks are remembered [default: view.toml in the user's folder for settings]
    #[arg(long, value_name = "FILE", conflicts_with = "no_memory")]
    pub memory: Option<PathBuf>,
    /// Remember nothing, and begin as on the first day
    #[arg(long)]
    pub no_memory: bool,
    /// Walk through the window by itself: a file with a step a line, listed below; nothing is remembered unless --memory says
    /// where
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// Who renders.
    #[command(flatten)]
    pub backend: BackendArgs,
    /// The look to begin with.
    #[command(flatten)]
    pub settings: SettingsArgs,
}
