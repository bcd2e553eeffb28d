//! What has to hold while a chip runs, and how it is described where it does not.

use super::{Running, take_command};
use crate::chip::{expectations, hot, settings_page};
use leg_firmware::sensors::Sensors;
use leg_sim::link::LinkError;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::image::Image;

/// The tick after which the image has to have set up everything, its watchdog too: 1.5 ms.
const SET_UP_TICKS: u64 = 12;

/// The tick up to which a chip has to have reported of itself: it has been asked four times then.
const ANSWER_TICKS: u64 = 1000;

/// Ticks from one look at the memories to the next.
const MEMORY_TICKS: u64 = 64;

/// Where the image notes that it uses other settings than those that were kept.
const CORRUPT: &str = "leg_stm32g474::settings_task::CORRUPT";

impl Running {
    /// What the breaks have to do at the beginning of a tick.
    pub(super) fn check_breaks(
        &mut self,
        sensors: &Sensors,
        image: &Image,
    ) -> Result<(), LinkError> {
        let (twin, commanding) = (&mut self.twin, &mut self.commanding);
        let handler = self.handler;
        let mut unexpected = None;
        let mut pass = |chip: &mut Chip, cycles| {
            let end = chip.cycle() + cycles;
            chip.set_watching(!twin.pending.is_empty());
            while chip.cycle() < end && unexpected.is_none() {
                let step = if *commanding { chip.cycle() + 1 } else { end };
                let stop = chip.run(step);
                match stop {
                    Stop::Watched => *commanding |= chip.processor().pc() != handler,
                    Stop::Time => {}
                    _ => unexpected = Some(stop),
                }
                take_command(chip, twin, commanding);
            }
        };
        let wrong = self.breaks.begin(&mut self.chip, sensors, &mut pass);
        if let Some(stop) = unexpected {
            return Err(self.stuck(&described(stop), image));
        }
        self.require(wrong, image)
    }

    /// What has to hold after every tick.
    pub(super) fn check_tick(&mut self, image: &Image) -> Result<(), LinkError> {
        let idle = (!self.converted).then(|| {
            "ADC1 and ADC2 have ended no sequence from one update of TIM1 to the next".to_owned()
        });
        let unmet = || {
            let due = self.ticks == SET_UP_TICKS;
            due.then(|| expectations::unmet(&self.chip)).flatten()
        };
        let looked_at = self.ticks % MEMORY_TICKS == 1;
        let memory = || looked_at.then(|| self.wrong_memory(image)).flatten();
        let silent = || {
            (self.ticks == ANSWER_TICKS && self.reports.compared == 0)
                .then(|| "the chip has answered no question for its telemetry".to_owned())
        };
        self.require(idle.or_else(unmet).or_else(memory).or_else(silent), image)
    }

    /// What is wrong in RAM or CCM, as a sentence.
    fn wrong_memory(&self, image: &Image) -> Option<String> {
        let processor = self.chip.processor();
        let (_, stack_pointer) = self.chip.place();
        if self.stack.is_reached(processor, stack_pointer) {
            return Some("the stack has come down to the variables".into());
        }
        self.chip.check_protected();
        // The code of the CCM is compared once: the program cannot change it by chance and go on.
        let copied = self.ticks > 1 || !hot::differs(image, processor);
        (!copied).then(|| "the code of the CCM is not there: it was not copied".into())
    }

    /// # Errors
    /// [`LinkError::Chip`] with what is wrong, if anything is, and with what the chip found.
    pub(super) fn require(&self, wrong: Option<String>, image: &Image) -> Result<(), LinkError> {
        match wrong {
            None => Ok(()),
            Some(wrong) => Err(self.violation(&wrong, image)),
        }
    }

    /// What the chip does wrong in this tick, and its findings.
    pub(super) fn violation(&self, wrong: &str, image: &Image) -> LinkError {
        LinkError::Chip(format!(
            "at tick {}: {wrong}{}",
            self.ticks,
            self.described_findings(image)
        ))
    }

    /// Reads whether the program uses other settings than those that were kept. Once it does, only whole settings in the
    /// flash end that.
    pub(super) fn read_corrupt(&mut self, image: &Image) -> Result<(), LinkError> {
        let byte = image.variable(CORRUPT).and_then(|address| {
            let word = self.chip.processor().word(address & !3)?;
            Some((word >> (8 * (address & 3))) as u8)
        });
        let Some(byte) = byte else {
            return Err(LinkError::Chip(format!(
                "the image has no variable `{CORRUPT}`"
            )));
        };
        let corrupt = byte != 0;
        if corrupt == self.defects.settings_corrupt {
            return Ok(());
        }
        let peripherals = self.chip.peripherals();
        let bytes = peripherals.devices.flash.bytes(settings_page::PLACE);
        let whole = bytes.is_some_and(|bytes| settings_page::kept(bytes).is_some());
        drop(peripherals);
        if corrupt || !whole {
            return Err(LinkError::Chip(format!(
                "`{CORRUPT}` is {corrupt}, and the flash holds {} settings",
                if whole { "whole" } else { "no whole" }
            )));
        }
        self.defects.settings_corrupt = false;
        Ok(())
    }

    pub(super) fn stuck(&self, how: &str, image: &Image) -> LinkError {
        let (place, stack_pointer) = self.chip.place();
        let function = image.function_at(place.pc).unwrap_or("no function");
        let memory = self.wrong_memory(image);
        let mut memory = memory.map(|wrong| format!("; {wrong}")).unwrap_or_default();
        let interrupted = self.chip.processor().interrupted_at(stack_pointer);
        if let Some(pc) = interrupted.filter(|_| place.exception != 0) {
            let function = image.function_at(pc).unwrap_or("no function");
            memory = format!(", which came at {pc:#010x} in {function}{memory}");
        }
        let (refused, address) = self.chip.processor().refused();
        if refused > 0 {
            memory += &format!("; nothing answers at {address:#010x}, which it accessed");
        }
        LinkError::Chip(format!(
            "the emulated chip {how}: it is at {:#010x} in {function}, exception {}{memory}{}",
            place.pc,
            place.exception,
            self.described_findings(image)
        ))
    }

    /// # Errors
    /// [`LinkError::Chip`] if the image did something wrong up to now.
    pub(super) fn report_findings(&self, image: &Image) -> Result<(), LinkError> {
        let findings = self.described_findings(image);
        if findings.is_empty() {
            return Ok(());
        }
        Err(LinkError::Chip(format!(
            "the image does what the chip forbids, up to tick {}:{findings}",
            self.ticks
        )))
    }

    pub(super) fn described_findings(&self, image: &Image) -> String {
        let peripherals = self.chip.peripherals();
        let list = peripherals.findings.list().iter();
        list.map(|finding| {
            let function = image.function_at(finding.pc).unwrap_or("no function");
            format!("\n  {finding}, in {function}")
        })
        .collect()
    }
}

/// What a chip does when it stops.
pub(super) fn described(stop: Stop) -> String {
    match stop {
        Stop::Update => "comes to the next update of TIM1 too soon".into(),
        Stop::Converted => "has converted its sensors too soon".into(),
        Stop::Watched => "is at a watched function".into(),
        Stop::Time => "starts no tick".into(),
        Stop::LockedUp => "is locked up".into(),
        Stop::Reset(cause) => format!("was reset ({cause:?})"),
    }
}
