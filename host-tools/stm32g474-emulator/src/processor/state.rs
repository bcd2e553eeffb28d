//! The state of a processor, taken over from another.

use super::{MapError, Processor};
use rsemu::core::device::Device;
use rsemu::core::error::Error;
use rsemu::core::state::{MachineShape, Migrations, StateReader, StateWriter};
use rsemu::cpu::arm::v7m::{ArmV7m, CLASS};

/// The name of the core in a saved state.
const CORE: &str = "cpu";

impl Processor {
    /// Goes on from where another processor is, with what its memories hold.
    ///
    /// # Errors
    /// [`MapError`] if `rsemu` does not read its own state.
    pub fn continue_from(&mut self, other: &Self) -> Result<(), MapError> {
        for (to, from) in self.memories.iter().zip(&other.memories) {
            let mut bytes = vec![0; usize::try_from(from.len()).unwrap_or_default()];
            // Both are as long as the memory.
            let _ = from.read_at(0, &mut bytes);
            let _ = to.write_at(0, &bytes);
        }
        copy_core(&other.core, &self.core).map_err(|error| MapError(error.to_string()))?;
        self.wanted = other.wanted;
        self.given = other.given;
        self.nmi = other.nmi;
        self.settled = other.settled;
        self.may_sleep = other.may_sleep;
        Ok(())
    }
}

/// Copies a core's state, by the format in which `rsemu` saves machines.
fn copy_core(from: &ArmV7m, to: &ArmV7m) -> Result<(), Error> {
    let mut shape = MachineShape::new();
    shape.add_device(CORE, CLASS.name)?;
    let mut writer = StateWriter::new(shape);
    from.save(&mut writer.chunk(CORE, CLASS.name, CLASS.version)?)?;
    let bytes = writer.to_vec()?;
    let migrations = Migrations::new();
    let saved = StateReader::new(&bytes)?;
    let chunk = saved.load(CORE, CLASS.name, CLASS.version, &migrations)?;
    to.load(&mut chunk.reader())
}
