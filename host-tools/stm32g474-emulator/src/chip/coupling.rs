//! The processor and what answers it.

use crate::bus::{Answers, Bus, BusShared};
use crate::image::Image;
use crate::memory_map::{DEBUG, PERIPHERALS, SECOND_BANK};
use crate::peripherals::Peripherals;
use crate::processor::{MapError, Processor};
use std::sync::{Arc, Mutex};

/// A processor with the image's first bank, its memories not set yet, and the peripherals that answer it.
pub(super) struct Coupled {
    pub processor: Processor,
    pub peripherals: Arc<Mutex<Peripherals>>,
    pub shared: Arc<BusShared>,
}

/// Couples an image's processor to peripherals.
///
/// # Errors
/// [`MapError`]: a fault of this program.
pub(super) fn couple(image: &Image, peripherals: Peripherals) -> Result<Coupled, MapError> {
    let peripherals = Arc::new(Mutex::new(peripherals));
    let shared = Arc::new(BusShared::default());
    let bus = |start, answers| {
        Arc::new(Bus {
            start,
            answers,
            peripherals: Arc::clone(&peripherals),
            shared: Arc::clone(&shared),
        })
    };
    let processor = Processor::new(
        &image.flash,
        bus(SECOND_BANK, Answers::Flash),
        bus(PERIPHERALS.start, Answers::Registers),
        bus(DEBUG.start, Answers::Registers),
    )?;
    Ok(Coupled {
        processor,
        peripherals,
        shared,
    })
}
