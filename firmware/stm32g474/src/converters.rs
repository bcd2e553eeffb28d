//! Load cells and motor currents: ADC1 and ADC2, both started by TIM1's update.
//!
//! Each converts its three inputs one after the other, each input 16 times in a row, and adds up: that is what a code
//! is. The end of ADC1's sequence raises the control interrupt; ADC2, which runs in step, is then done as well.

use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, AdcConfig, Instance, Resolution};
use embassy_stm32::gpio::Flex;
use embassy_stm32::pac;
use embassy_stm32::pac::adc::vals::{Exten, SampleTime, Trovs};
use embassy_stm32::peripherals::{ADC1, ADC2, PA4, PA6, PA7, PC0, PC1, PC2};

/// Inputs of ADC1 on PC0, PC1, PC2.
const CELL_INPUTS: [u8; 3] = [6, 7, 8];
/// Inputs of ADC2 on PA4, PA6, PA7.
const CURRENT_INPUTS: [u8; 3] = [17, 3, 4];

/// TIM1_TRGO2 among the triggers of injected conversions.
const FROM_TIMER_1: u8 = 8;

/// `leg_firmware::board::timing` counts on it.
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES47_5;

/// 16 conversions make a code.
const SIXTEEN: u8 = 3;

/// Converters and pins.
pub struct ConverterParts {
    /// For the load cells.
    pub cells: Peri<'static, ADC1>,
    /// Load cell of tendon 1.
    pub cell_1: Peri<'static, PC0>,
    /// Load cell of tendon 2.
    pub cell_2: Peri<'static, PC1>,
    /// Load cell of tendon 3.
    pub cell_3: Peri<'static, PC2>,
    /// For the currents.
    pub currents: Peri<'static, ADC2>,
    /// Current of motor 1.
    pub current_1: Peri<'static, PA4>,
    /// Current of motor 2.
    pub current_2: Peri<'static, PA6>,
    /// Current of motor 3.
    pub current_3: Peri<'static, PA7>,
}

/// The codes of a tick.
pub struct Codes {
    /// Load cells.
    pub cells: [u16; 3],
    /// Motor currents.
    pub currents: [u16; 3],
    /// Whether both sequences have ended since the last call.
    pub fresh: bool,
}

/// The two converters, waiting for the timer.
pub struct Converters {
    _pins: [Flex<'static>; 6],
}

impl Converters {
    /// Calibrates both and lets them wait for TIM1, which must not run yet.
    pub fn new(parts: ConverterParts) -> Self {
        let pins = [
            analogue(Flex::new(parts.cell_1)),
            analogue(Flex::new(parts.cell_2)),
            analogue(Flex::new(parts.cell_3)),
            analogue(Flex::new(parts.current_1)),
            analogue(Flex::new(parts.current_2)),
            analogue(Flex::new(parts.current_3)),
        ];
        calibrate(parts.cells, SIXTEEN);
        calibrate(parts.currents, SIXTEEN);
        let sampled = |inputs: [u8; 3]| inputs.map(|input| (input, SAMPLE_TIME));
        wait_for_timer(pac::ADC2, sampled(CURRENT_INPUTS), false);
        wait_for_timer(pac::ADC1, sampled(CELL_INPUTS), true);
        Self { _pins: pins }
    }

    /// Takes the codes, and with them the interrupt's cause.
    #[inline(always)]
    pub fn take(&self) -> Codes {
        let (cells, currents) = (pac::ADC1, pac::ADC2);
        let done = cells.isr().read().jeos() && currents.isr().read().jeos();
        clear(cells);
        clear(currents);
        Codes {
            cells: codes(cells),
            currents: codes(currents),
            fresh: done,
        }
    }
}

/// Calibrates a converter and switches it on, at a quarter of 170 MHz.
pub fn calibrate<T: Instance<Regs = pac::adc::Adc>>(
    converter: Peri<'static, T>,
    oversampling_ratio: u8,
) {
    let config = AdcConfig {
        resolution: Some(Resolution::BITS12),
        oversampling_ratio: Some(oversampling_ratio),
        oversampling_shift: Some(0),
        ..AdcConfig::default()
    };
    let _ = Adc::new(converter, config);
}

/// Takes a pin for a converter.
pub fn analogue(mut pin: Flex<'static>) -> Flex<'static> {
    pin.set_as_analog();
    pin
}

/// Lets a converter take a sequence of inputs once, and waits for it: until then it has no codes.
pub fn convert_once(converter: pac::adc::Adc, inputs: [(u8, SampleTime); 3]) {
    set_up(converter, inputs, Exten::DISABLED, false);
    while !converter.isr().read().jeos() {}
    clear(converter);
}

/// Lets a converter take a sequence of inputs at each update of TIM1.
pub fn wait_for_timer(converter: pac::adc::Adc, inputs: [(u8, SampleTime); 3], interrupts: bool) {
    set_up(converter, inputs, Exten::RISING_EDGE, interrupts);
}

fn set_up(converter: pac::adc::Adc, inputs: [(u8, SampleTime); 3], edge: Exten, interrupts: bool) {
    converter.cfgr().modify(|w| {
        w.set_jqdis(true);
        w.set_jdiscen(false);
        w.set_jauto(false);
    });
    converter.cfgr2().modify(|w| {
        w.set_jovse(true);
        w.set_trovs(Trovs::AUTOMATIC);
    });
    for (input, time) in inputs {
        let input = usize::from(input);
        if input < 10 {
            converter.smpr().modify(|w| w.set_smp(input, time));
        } else {
            converter.smpr2().modify(|w| w.set_smp(input - 10, time));
        }
    }
    converter.jsqr().write(|w| {
        w.set_jextsel(FROM_TIMER_1);
        w.set_jexten(edge);
        // One less than there are.
        w.set_jl(2);
        for (rank, (input, _)) in inputs.into_iter().enumerate() {
            w.set_jsq(rank, input);
        }
    });
    converter.ier().write(|w| w.set_jeosie(interrupts));
    converter.cr().modify(|w| w.set_jadstart(true));
}

/// The codes of a sequence.
#[inline(always)]
pub fn codes(converter: pac::adc::Adc) -> [u16; 3] {
    [0, 1, 2].map(|rank| converter.jdr(rank).read().jdata())
}

/// Clears the flags of a finished sequence, which ones clear.
#[inline(always)]
pub fn clear(converter: pac::adc::Adc) {
    converter.isr().write(|w| {
        w.set_jeoc(true);
        w.set_jeos(true);
    });
}
