//! Chores of the project that are not part of building it.

mod shaders;
#[path = "../../crates/ambray_vulkan/tests/common/source_hash.rs"]
mod source_hash;

use clap::{Parser, Subcommand};

/// Chores of the project.
#[derive(Debug, Parser)]
#[command(bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Write the GLSL of shared structures and compile all shaders of the Vulkan backend
    Shaders,
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().chore {
        Chore::Shaders => shaders::write(),
    }
}
