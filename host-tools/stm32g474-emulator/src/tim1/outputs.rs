//! What the pins of the power stage carry.

use crate::device::{FieldPlace, RegisterFile};

/// Channels with pulses.
pub const CHANNELS: usize = 3;

/// Values of `OCxM`; the highest bit, which is none of these, is far from the others.
const FORCE_ACTIVE: u32 = 5;
const PWM_MODE_1: u32 = 6;
const PWM_MODE_2: u32 = 7;

/// What TIM1 puts on its pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PowerOutputs {
    /// The outputs are switched on (`MOE`) and the counter runs.
    pub on: bool,
    /// The top in use.
    pub top: u16,
    /// For how many of `top` counts the pin is high: with mode, polarity, enable, `MOE` and idle level taken into account;
    /// none for a pin that the timer leaves floating.
    pub high: [Option<u16>; CHANNELS],
}

/// Where the registers say it.
#[derive(Clone, Debug)]
pub struct OutputPlaces {
    switch: FieldPlace,
    idle_driven: FieldPlace,
    run_driven: FieldPlace,
    channels: [ChannelPlaces; CHANNELS],
}

#[derive(Clone, Copy, Debug)]
struct ChannelPlaces {
    mode: FieldPlace,
    enabled: FieldPlace,
    active_low: FieldPlace,
    idle_level: FieldPlace,
}

impl OutputPlaces {
    /// Finds them.
    #[must_use]
    pub fn new(file: &RegisterFile) -> Self {
        Self {
            switch: file.field("BDTR", "MOE"),
            idle_driven: file.field("BDTR", "OSSI"),
            run_driven: file.field("BDTR", "OSSR"),
            channels: [0, 1, 2].map(|n| ChannelPlaces {
                mode: file.field(&format!("CCMR{}", n / 2 + 1), &format!("OCM{}", n % 2)),
                enabled: file.field("CCER", &format!("CCE{n}")),
                active_low: file.field("CCER", &format!("CCP{n}")),
                idle_level: file.field("CR2", &format!("OIS{n}")),
            }),
        }
    }

    /// What the pins carry, by the registers and the values in use.
    #[must_use]
    pub fn outputs(
        &self,
        file: &RegisterFile,
        runs: bool,
        top: u32,
        compare: [u32; CHANNELS],
    ) -> PowerOutputs {
        let mut high = [None; CHANNELS];
        let values = compare.into_iter().zip(self.channels);
        for (high, (compare, channel)) in high.iter_mut().zip(values) {
            *high = self.pin(file, channel, compare, top).map(narrow);
        }
        PowerOutputs {
            on: file.is_set(self.switch) && runs,
            top: narrow(top),
            high,
        }
    }

    /// Counts of `top` in which a pin is high; none if it floats.
    fn pin(
        &self,
        file: &RegisterFile,
        channel: ChannelPlaces,
        compare: u32,
        top: u32,
    ) -> Option<u32> {
        let switched = file.is_set(self.switch);
        let invert = |active: u32| {
            if file.is_set(channel.active_low) {
                top.saturating_sub(active)
            } else {
                active
            }
        };
        let always = |level: bool| if level { top } else { 0 };
        match (switched, file.is_set(channel.enabled)) {
            (true, true) => Some(invert(active(file.value(channel.mode), compare, top))),
            (true, false) => file.is_set(self.run_driven).then(|| invert(0)),
            (false, _) => {
                let idle = always(file.is_set(channel.idle_level));
                file.is_set(self.idle_driven).then_some(idle)
            }
        }
    }
}

/// Counts of `top` in which a channel is active.
fn active(mode: u32, compare: u32, top: u32) -> u32 {
    match mode {
        PWM_MODE_1 => compare.min(top),
        PWM_MODE_2 => top - compare.min(top),
        FORCE_ACTIVE => top,
        _ => 0,
    }
}

fn narrow(value: u32) -> u16 {
    u16::try_from(value).unwrap_or(u16::MAX)
}
