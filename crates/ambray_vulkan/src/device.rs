//! A device that several backends share.

use std::sync::Arc;

use crate::{Context, pipeline::ProgramCache};

/// A device with the programs that have been compiled for it. Clones are the same device.
///
/// Any number of backends may be made on it and used by as many threads at once: their submissions take turns on the queue,
/// and what one compiles the others need not.
#[derive(Clone, Debug)]
pub struct Device {
    context: Arc<Context>,
    programs: Arc<ProgramCache>,
}

impl Device {
    /// The device of `context`, with no programs yet.
    #[must_use]
    pub fn of(context: Arc<Context>) -> Self {
        Self { context, programs: Arc::default() }
    }

    /// The connection to it.
    #[must_use]
    pub const fn context(&self) -> &Arc<Context> {
        &self.context
    }

    pub(crate) const fn programs(&self) -> &Arc<ProgramCache> {
        &self.programs
    }
}
