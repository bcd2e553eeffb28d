//! The board's lower half: what a tick reads and what it sets.

use crate::converters::Converters;
use crate::encoders::Encoders;
use crate::power::Power;
use crate::settings_task;
use crate::slow_sensors::SlowSensors;
use crate::tick_watchdog;
use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::board::{LowerHalf, PowerStage};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;

/// The NUCLEO-G474RE under a leg.
pub struct Nucleo {
    stage: PowerStage<Power>,
    encoders: Encoders,
    converters: Converters,
    slow_sensors: SlowSensors,
    /// Whether the tick under way is late, for [`LowerHalf::sense`].
    pub late: bool,
}

impl Nucleo {
    /// With the outputs off.
    pub fn new(
        power: Power,
        encoders: Encoders,
        converters: Converters,
        slow_sensors: SlowSensors,
    ) -> Self {
        Self {
            stage: PowerStage::new(power, PWM_TOP),
            encoders,
            converters,
            slow_sensors,
            late: false,
        }
    }
}

impl LowerHalf for Nucleo {
    #[inline(always)]
    fn sense(&mut self) -> Sensors {
        let codes = self.converters.take();
        let slow = self.slow_sensors.take();
        let lost = self.stage.lost();
        let faults = self.stage.pins().fault_lines(lost).faults();
        Sensors {
            encoder_counts: self.encoders.counts(),
            cell_codes: codes.cells,
            current_codes: codes.currents,
            supply_code: slow.supply,
            temperature_code: slow.temperature,
            // The converters run in step: where one stands still, no code is of this tick.
            cell_fresh: [codes.fresh && slow.fresh; 3],
            driver_fault: faults.drivers,
            emergency_stop: faults.stop,
            late: self.late,
            settings_corrupt: settings_task::corrupt(),
        }
    }

    #[inline(always)]
    fn drive(&mut self, drive: &Drive<f32>) {
        // Before the outputs come on, and in each tick: a debugger that attaches may have the watchdog rest in a halt. OpenOCD does.
        if drive.enabled {
            tick_watchdog::set_rest_in_halt(false);
        }
        self.stage.drive(drive);
    }

    fn cut(&mut self) {
        self.stage.cut();
    }
}
