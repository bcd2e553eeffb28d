//! The encoders: TIM2, TIM3 and TIM4 count every edge of both tracks.
//!
//! The counters wrap at 16 bits; the library accumulates their differences in integers.

use embassy_stm32::Peri;
use embassy_stm32::gpio::Pull;
use embassy_stm32::pac;
use embassy_stm32::pac::timer::regs::SrGp16;
use embassy_stm32::pac::timer::vals::FilterValue;
use embassy_stm32::peripherals::{PA0, PA1, PB4, PB5, PB6, PB7, TIM2, TIM3, TIM4};
use embassy_stm32::timer::qei::{Config, Qei};

/// A pulse shorter than 0.4 µs is noise: eight samples at an eighth of 170 MHz. At the fastest tendon of the built-in
/// settings, 0.03 m/s, a track changes every 7 µs.
const FILTER: FilterValue = FilterValue::FDTS_DIV8_N8;

/// Timers and pins.
pub struct EncoderParts {
    /// Of motor 1.
    pub timer_1: Peri<'static, TIM2>,
    /// Its tracks.
    pub tracks_1: (Peri<'static, PA0>, Peri<'static, PA1>),
    /// Of motor 2.
    pub timer_2: Peri<'static, TIM3>,
    /// Its tracks.
    pub tracks_2: (Peri<'static, PB4>, Peri<'static, PB5>),
    /// Of motor 3.
    pub timer_3: Peri<'static, TIM4>,
    /// Its tracks.
    pub tracks_3: (Peri<'static, PB6>, Peri<'static, PB7>),
}

/// The three encoders.
pub struct Encoders {
    motor_1: Qei<'static, TIM2>,
    motor_2: Qei<'static, TIM3>,
    motor_3: Qei<'static, TIM4>,
}

impl Encoders {
    /// Starts to count. The tracks are pulled up, for encoders with open collectors.
    pub fn new(parts: EncoderParts) -> Self {
        let config = Config {
            ch1_pull: Pull::Up,
            ch2_pull: Pull::Up,
            ..Config::default()
        };
        let encoders = Self {
            motor_1: Qei::new(parts.timer_1, parts.tracks_1.0, parts.tracks_1.1, config),
            motor_2: Qei::new(parts.timer_2, parts.tracks_2.0, parts.tracks_2.1, config),
            motor_3: Qei::new(parts.timer_3, parts.tracks_3.0, parts.tracks_3.1, config),
        };
        for track in 0..2 {
            pac::TIM2.ccmr_input(0).modify(|w| w.set_icf(track, FILTER));
            pac::TIM3.ccmr_input(0).modify(|w| w.set_icf(track, FILTER));
            pac::TIM4.ccmr_input(0).modify(|w| w.set_icf(track, FILTER));
        }
        encoders
    }

    /// Which of the timers have seen both tracks change at once since the last call: noise, or a motor that is too fast for the
    /// filter. The count is then off by two at most.
    pub fn take_errors() -> [bool; 3] {
        [pac::TIM2.sr(), pac::TIM3.sr(), pac::TIM4.sr()].map(|status| {
            let error = status.read().terrif();
            if error {
                // Zeros clear flags and ones leave them alone.
                let mut clear = SrGp16(u32::MAX);
                clear.set_terrif(false);
                status.write_value(clear);
            }
            error
        })
    }

    /// What the counters read.
    #[inline(always)]
    pub fn counts(&self) -> [u16; 3] {
        [
            self.motor_1.count(),
            self.motor_2.count(),
            self.motor_3.count(),
        ]
    }
}
