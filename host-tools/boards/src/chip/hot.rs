//! Whether the code that runs from the CCM has been copied there.

use stm32g474_emulator::image::Image;
use stm32g474_emulator::processor::Processor;

/// Start and end of that code, and where it lies in the flash: `firmware/stm32g474/hot.x`.
const NAMES: [&str; 3] = ["__shot", "__ehot", "__sihot"];

/// Whether any of it differs from what the flash holds; false for an image without such code.
pub fn differs(image: &Image, processor: &Processor) -> bool {
    let [Some(start), Some(end), Some(source)] = NAMES.map(|name| image.symbol(name)) else {
        return false;
    };
    let mut offsets = (0..end.saturating_sub(start)).step_by(4);
    offsets.any(|at| processor.word(start + at) != processor.word(source + at))
}
