//! Converters and encoders.

use super::runs::moving;
use super::{Mistake, mistakes};

const fn converters(right: &'static str, wrong: &'static str, report: &'static str) -> Mistake {
    Mistake::new(
        "firmware/stm32g474/src/converters.rs",
        right,
        wrong,
        moving,
        report,
    )
}

const fn slow(right: &'static str, wrong: &'static str, report: &'static str) -> Mistake {
    Mistake::new(
        "firmware/stm32g474/src/slow_sensors.rs",
        right,
        wrong,
        moving,
        report,
    )
}

mistakes! {
    trigger_of_another_timer: converters(
        "FROM_TIMER_1: u8 = 8;",
        "FROM_TIMER_1: u8 = 2;",
        "ADC1 and ADC2 have ended no sequence from one update of TIM1 to the next",
    );
    cells_in_another_order: converters(
        "CELL_INPUTS: [u8; 3] = [6, 7, 8];",
        "CELL_INPUTS: [u8; 3] = [7, 6, 8];",
        "ADC1's code 1 is",
    );
    currents_in_another_order: converters(
        "CURRENT_INPUTS: [u8; 3] = [17, 3, 4];",
        "CURRENT_INPUTS: [u8; 3] = [3, 17, 4];",
        "ADC2's code 1 is ",
    );
    sampling_too_short: converters(
        "SampleTime::CYCLES47_5",
        "SampleTime::CYCLES2_5",
        "ns, too short for a source of",
    );
    sampling_too_long: converters(
        "SampleTime::CYCLES47_5",
        "SampleTime::CYCLES92_5",
        "the time of ADC1's sequence, cycles, is 20160, and has to be 11520",
    );
    calibration_omitted: converters(
        "    converter.cfgr().modify(|w| {\n",
        "    // Without its supply a converter forgets its calibration.
    converter.cr().modify(|w| w.set_addis(true));
    while converter.cr().read().aden() {}
    converter.cr().modify(|w| w.set_advregen(false));
    converter.cr().modify(|w| w.set_deeppwd(true));
    converter.cr().modify(|w| w.set_deeppwd(false));
    converter.cr().modify(|w| w.set_advregen(true));
    cortex_m::asm::delay(10_000);
    converter.isr().write(|w| w.set_adrdy(true));
    converter.cr().modify(|w| w.set_aden(true));
    while !converter.isr().read().adrdy() {}
    converter.cfgr().modify(|w| {\n",
        "converts without a calibration since its power-up",
    );
    own_voltage_not_switched_on: slow(
        "        pac::ADC345_COMMON.ccr().modify(|w| w.set_vrefen(true));\n",
        "",
        "ADC3 converts VREFINT, which VREFEN has not switched on",
    );
    own_voltage_sampled_too_short: slow(
        "(18, SampleTime::CYCLES247_5)",
        "(18, SampleTime::CYCLES92_5)",
        "ADC3 samples input 18 for 2176 ns, too short",
    );
    supply_and_temperature_interchanged: slow(
        "    (1, SampleTime::CYCLES47_5),\n    (12, SampleTime::CYCLES47_5),\n",
        "    (12, SampleTime::CYCLES47_5),\n    (1, SampleTime::CYCLES47_5),\n",
        "ADC3's code 1 is",
    );
    slow_codes_of_too_many_conversions: slow(
        "const EIGHT: u8 = 2;",
        "const EIGHT: u8 = 3;",
        "ADC3",
    );
    track_with_another_function: Mistake {
        file: "firmware/stm32g474/src/encoders.rs",
        right: "        encoders\n    }",
        wrong: "        pac::GPIOB.afr(0).modify(|w| w.set_afr(6, 10));\n        encoders\n    }",
        run: moving,
        report: "PB6 is not routed to TIM4_CH1",
    };
}
