//! The timing of its bits, and whether it is that of the bus.

use super::frame::DataFrame;
use super::places::Timing;
use super::{CanBus, Fdcan};
use crate::clocks::Clocks;
use crate::device::Context;

/// How far the rates of two nodes may be apart, parts of a million. ISO 11898-1 allows oscillators 0.5 % and more only
/// with the widest jump width.
const TOLERANCE_PPM: u64 = 5_000;

/// The delay of a transceiver and back, ns: at most that by ISO 11898-2.
const TRANSCEIVER_NS: u64 = 255;

/// How long before the end of the bit in which the rate changes a receiver has to read it, ns: a period of an adapter's clock of 40 MHz.
const SWITCH_MARGIN_NS: u32 = 25;

/// The bits of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitTiming {
    /// Bits in a second.
    pub hz: u32,
    /// Where a bit is sampled, thousandths of it.
    pub sample_permille: u32,
    /// Periods of the block's clock in a bit.
    pub periods: u32,
}

impl BitTiming {
    /// From the begin of a bit to its sample point, ns.
    fn sample_ns(self) -> u32 {
        let sample = u64::from(self.sample_permille) * 1_000_000;
        sample.checked_div(self.hz.into()).unwrap_or_default() as u32
    }

    /// From there to its end, ns.
    fn rest_ns(self) -> u32 {
        1_000_000_000_u32
            .checked_div(self.hz)
            .unwrap_or_default()
            .saturating_sub(self.sample_ns())
    }
}

/// Whether two rates count as the same.
pub fn same_rate(one: u32, other: u32) -> bool {
    u64::from(one.abs_diff(other)) * 1_000_000 <= u64::from(other) * TOLERANCE_PPM
}

impl CanBus {
    /// Whether a frame has its rates.
    #[must_use]
    pub fn carries(&self, frame: &DataFrame) -> bool {
        same_rate(frame.nominal_hz, self.nominal_hz)
            && (!frame.bit_rate_switch || same_rate(frame.data_hz, self.data_hz))
    }
}

impl Fdcan {
    /// The bits of the nominal phase, as the registers and the clock give them; none without a clock.
    #[must_use]
    pub fn nominal_timing(&self, clocks: &Clocks) -> Option<BitTiming> {
        self.bit_timing(&self.settings.nominal, clocks)
    }

    /// The bits of the data phase.
    #[must_use]
    pub fn data_timing(&self, clocks: &Clocks) -> Option<BitTiming> {
        self.bit_timing(&self.settings.data, clocks)
    }

    fn bit_timing(&self, place: &Timing, clocks: &Clocks) -> Option<BitTiming> {
        let value = |field| self.registers.value(field);
        let before = 2 + value(place.segment_1);
        let quanta = before + 1 + value(place.segment_2);
        let periods = (value(place.prescaler) + 1) * quanta;
        let clock = self.clock(clocks);
        (clock > 0).then(|| BitTiming {
            hz: (clock + periods / 2) / periods,
            sample_permille: before * 1000 / quanta,
            periods,
        })
    }

    /// The clock after its divider: RM0440, FDCAN_CKDIV.
    fn clock(&self, clocks: &Clocks) -> u32 {
        let divider = self.registers.value(self.settings.clock_divider);
        clocks.fdcan / (2 * divider).max(1)
    }

    /// Cycles of a number of nominal bits.
    pub(super) fn bits(&self, count: u64, clocks: &Clocks) -> Option<u64> {
        let timing = self.nominal_timing(clocks)?;
        clocks.cycles(count * u64::from(timing.periods), self.clock(clocks))
    }

    /// Its own rates, nominal and for data, bit/s.
    pub(super) fn rates(&self, clocks: &Clocks) -> [u32; 2] {
        let timings = [self.nominal_timing(clocks), self.data_timing(clocks)];
        timings.map(|timing| timing.map_or(0, |timing| timing.hz))
    }

    /// Reports what makes a frame of its own fail.
    pub(super) fn check_own(&self, frame: &DataFrame, context: &mut Context<'_>) {
        if !self.bus.carries(frame) {
            self.report_rates([frame.nominal_hz, frame.data_hz], context);
        }
        if let Some(data) = self
            .data_timing(context.clocks)
            .filter(|_| frame.bit_rate_switch)
        {
            self.check_compensation(data, context);
            self.check_switch(data, context);
        }
    }

    /// A sender changes the rate at its sample point of a nominal bit, and ends that bit as one of data: ISO 11898-1. A receiver that samples nominal bits later
    /// may find the next bit there.
    fn check_switch(&self, data: BitTiming, context: &mut Context<'_>) {
        let Some(nominal) = self.nominal_timing(context.clocks) else {
            return;
        };
        let sample_permille = self.bus.sample_permille;
        let others = |own: BitTiming| BitTiming {
            sample_permille,
            ..own
        };
        let mut check = |reads: &str, changes: &str, sample_ns: u32, end_ns: u32| {
            if sample_ns + SWITCH_MARGIN_NS > end_ns {
                context.findings.add(format!(
                    "FDCAN2_NBTP: {reads} at {sample_ns} ns the bit in which {changes} the rate, and which ends at {end_ns} ns"
                ));
            }
        };
        let (others_nominal, others_data) = (others(nominal), others(data));
        let (own_end_ns, others_end_ns) = (
            nominal.sample_ns() + data.rest_ns(),
            others_nominal.sample_ns() + others_data.rest_ns(),
        );
        let [own_ns, others_ns] = [nominal, others_nominal].map(BitTiming::sample_ns);
        check("it samples", "others change", own_ns, others_end_ns);
        check("others sample", "it changes", others_ns, own_end_ns);
    }

    pub(super) fn report_rates(&self, [nominal, data]: [u32; 2], context: &mut Context<'_>) {
        let bus = &self.bus;
        context.findings.add(format!(
            "FDCAN2_NBTP and FDCAN2_DBTP give {nominal} and {data} bit/s, the bus has {} and {} bit/s",
            bus.nominal_hz, bus.data_hz
        ));
    }

    /// A transmitter whose transceiver delays more than its sample point reads its own bits too late, unless that is
    /// compensated: RM0440, FDCAN transceiver delay compensation.
    fn check_compensation(&self, data: BitTiming, context: &mut Context<'_>) {
        let s = &self.settings;
        let sample_ns = u64::from(data.sample_ns());
        if self.registers.is_set(s.delay_compensation) {
            let offset = self.registers.value(s.delay_offset);
            if offset == 0 || offset >= data.periods {
                context.findings.add(format!(
                    "FDCAN2_TDCR: the second sample point is {offset} periods into a bit of {}",
                    data.periods
                ));
            }
        } else if sample_ns < TRANSCEIVER_NS {
            context.findings.add(format!(
                "FDCAN2_DBTP: TDC is off, and data are sampled after {sample_ns} ns: a transceiver may take {TRANSCEIVER_NS} ns"
            ));
        }
    }

    /// The counter of time stamps.
    pub(super) fn stamp(&self, context: &Context<'_>) -> u16 {
        // RM0440, FDCAN_TSCC: 1 counts bits.
        if self.registers.value(self.settings.stamp_source) != 1 {
            return 0;
        }
        let bits = u64::from(self.registers.value(self.settings.stamp_prescaler)) + 1;
        let step = self.bits(bits, context.clocks).unwrap_or_default();
        let since = context.cycle.saturating_sub(self.stamp_from);
        (since.checked_div(step).unwrap_or_default() & 0xffff) as u16
    }
}
