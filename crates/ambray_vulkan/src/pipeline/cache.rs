//! Programs that have been compiled, kept for the next frame and the next scene.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Interface, Programs, TraceMode};
use crate::{Result, layout::Specialization, motion::MotionPrograms};

/// Programs of so many settings are kept.
const KEPT: usize = 64;

/// Compiled programs of a device. Compiling takes longer than many a frame, and nothing of it depends on the scene.
#[derive(Debug, Default)]
pub(crate) struct ProgramCache {
    /// The last used comes first.
    programs: Mutex<Vec<Entry>>,
    motion: Mutex<Option<Arc<MotionPrograms>>>,
}

type Entry = ((TraceMode, Specialization), Arc<Programs>);

impl ProgramCache {
    /// Programs for these constants; `mode` is resolved.
    pub(crate) fn get(
        &self,
        interface: &Arc<Interface>,
        mode: TraceMode,
        specialization: &Specialization,
    ) -> Result<Arc<Programs>> {
        let key = (mode, *specialization);
        // The list is always whole, so a panic of another thread does not matter.
        let mut kept = self.programs.lock().unwrap_or_else(PoisonError::into_inner);
        let entry = match kept.iter().position(|(other, _)| *other == key) {
            Some(index) => kept.remove(index),
            None => (key, Arc::new(Programs::new(interface, mode, specialization)?)),
        };
        let programs = Arc::clone(&entry.1);
        kept.insert(0, entry);
        kept.truncate(KEPT);
        Ok(programs)
    }

    /// Programs that move scenes.
    pub(crate) fn motion(&self, interface: &Arc<Interface>) -> Result<Arc<MotionPrograms>> {
        let mut kept = self.motion.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(programs) = &*kept {
            return Ok(Arc::clone(programs));
        }
        let programs = Arc::new(MotionPrograms::new(interface)?);
        *kept = Some(Arc::clone(&programs));
        Ok(programs)
    }
}
