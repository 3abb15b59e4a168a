//! Wavefront OBJ import.

use crate::Scene;
use crate::error::{Fault, Outcome};
use crate::files::Folder;
use crate::warnings::Warnings;

pub(crate) fn load(_bytes: &[u8], _folder: &mut Folder, _warnings: &mut Warnings) -> Outcome<Scene> {
    Err(Fault::unsupported("", "OBJ"))
}
