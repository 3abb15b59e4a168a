//! Programs that have been compiled, kept for the next frame and the next scene.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Interface, Programs, TraceMode};
use crate::{
    Result, display::DisplayPrograms, layout::Specialization, motion::MotionPrograms, reduce::SumProgram,
};

/// Programs of so many settings are kept.
const KEPT: usize = 64;

/// Compiled programs of a device. Compiling takes longer than many a frame, and nothing of it depends on the scene.
#[derive(Debug, Default)]
pub(crate) struct ProgramCache {
    passes: Kept<(TraceMode, Specialization), Programs>,
    motion: Kept<(), MotionPrograms>,
    sums: Kept<(), SumProgram>,
    display: Kept<Specialization, DisplayPrograms>,
}

impl ProgramCache {
    /// Programs for these constants; `mode` is resolved.
    pub(crate) fn get(
        &self,
        interface: &Arc<Interface>,
        mode: TraceMode,
        specialization: &Specialization,
    ) -> Result<Arc<Programs>> {
        self.passes.get((mode, *specialization), || Programs::new(interface, mode, specialization))
    }

    /// Programs that move scenes.
    pub(crate) fn motion(&self, interface: &Arc<Interface>) -> Result<Arc<MotionPrograms>> {
        self.motion.get((), || MotionPrograms::new(interface))
    }

    /// The program that counts rays.
    pub(crate) fn sums(&self, interface: &Arc<Interface>) -> Result<Arc<SumProgram>> {
        self.sums.get((), || SumProgram::new(interface))
    }

    /// Programs that show planes, for these constants.
    pub(crate) fn display(
        &self,
        interface: &Arc<Interface>,
        specialization: &Specialization,
    ) -> Result<Arc<DisplayPrograms>> {
        self.display.get(*specialization, || DisplayPrograms::new(interface, specialization))
    }
}

/// What was made for each of the last keys.
#[derive(Debug)]
struct Kept<K, T> {
    /// The last used comes first.
    entries: Mutex<Vec<(K, Slot<T>)>>,
}

/// Empty until it is made, and where that has failed.
type Slot<T> = Arc<Mutex<Option<Arc<T>>>>;

impl<K, T> Default for Kept<K, T> {
    fn default() -> Self {
        Self { entries: Mutex::default() }
    }
}

impl<K: PartialEq, T> Kept<K, T> {
    /// What was made for `key`, or is made now. Only those who want the same wait for that: one thread may compile for a scene
    /// that it opens while another one renders.
    fn get(&self, key: K, make: impl FnOnce() -> Result<T>) -> Result<Arc<T>> {
        let slot = self.slot(key);
        // A slot is full or empty, and the list always whole, so a panic of another thread does not matter.
        let mut content = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = &*content {
            return Ok(Arc::clone(made));
        }
        let made = Arc::new(make()?);
        *content = Some(Arc::clone(&made));
        Ok(made)
    }

    fn slot(&self, key: K) -> Slot<T> {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let entry = match entries.iter().position(|(other, _)| *other == key) {
            Some(index) => entries.remove(index),
            None => (key, Slot::default()),
        };
        let slot = Arc::clone(&entry.1);
        entries.insert(0, entry);
        entries.truncate(KEPT);
        slot
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::*;
    use crate::VulkanError;

    #[test]
    fn each_is_made_once_and_failures_are_tried_again() {
        let kept = Kept::default();
        assert_eq!(kept.get(1, || Err::<u32, _>(VulkanError::NoDriver)), Err(VulkanError::NoDriver));
        assert_eq!(*kept.get(1, || Ok(10)).expect("made"), 10);
        assert_eq!(*kept.get(1, || Ok(11)).expect("kept"), 10);
        for key in 2..2 + KEPT {
            kept.get(key, || Ok(20)).expect("made");
        }
        assert_eq!(*kept.get(1, || Ok(12)).expect("made again"), 12);
    }

    #[test]
    fn making_one_does_not_hold_up_another() {
        let (kept, both) = (Kept::default(), Barrier::new(2));
        let make = |key: u32| {
            kept.get(key, || {
                both.wait();
                Ok(key)
            })
        };
        std::thread::scope(|scope| {
            let other = scope.spawn(|| make(1).map(|made| *made));
            assert_eq!(make(2).map(|made| *made), Ok(2));
            assert_eq!(other.join().expect("no panic"), Ok(1));
        });
    }
}
