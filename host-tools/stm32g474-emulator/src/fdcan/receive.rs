//! From the bus to the FIFOs.

use super::errors::Kind;
use super::frame::DataFrame;
use super::memory::{self, ELEMENT, FilterAction};
use super::timing::same_rate;
use super::{Fdcan, Reception};
use crate::device::Context;

/// Standard filters that the message RAM has room for: RM0440, FDCAN_RXGFC, LSS.
const FILTERS_MAX: u32 = 28;

impl Fdcan {
    /// A frame of another node ends on the bus: what this node says to it.
    pub fn bus_receive(&mut self, frame: &DataFrame, context: &mut Context<'_>) -> Reception {
        self.settle(context);
        if !self.takes_part() {
            return Reception::Absent;
        }
        let [nominal, data] = self.rates(context.clocks);
        let nominal_differs = !same_rate(frame.nominal_hz, nominal);
        let differs = nominal_differs || frame.bit_rate_switch && !same_rate(frame.data_hz, data);
        let unknown = frame.fd && !self.registers.is_set(self.settings.fd);
        if differs || unknown {
            self.report_refused(frame, unknown, context);
            self.receive_error(!unknown && !nominal_differs);
            return self.said(Reception::Error);
        }
        self.last_error = 0;
        if frame.fd {
            self.received_fd |= self.flags.received_fd.mask;
        }
        if frame.bit_rate_switch {
            self.received_fd |= self.flags.received_switch.mask;
            self.last_data_error = 0;
        }
        self.count_errors(|errors| errors.received());
        self.accept(frame, context);
        self.said(Reception::Acknowledged)
    }

    fn receive_error(&mut self, in_data: bool) {
        if in_data {
            self.last_data_error = Kind::Stuff as u32;
            self.raise(self.interrupts.data_error);
        } else {
            self.last_error = Kind::Stuff as u32;
            self.raise(self.interrupts.arbitration_error);
        }
        self.count_errors(|errors| errors.reception_failed());
    }

    /// Says why a frame cannot be understood.
    fn report_refused(&self, frame: &DataFrame, unknown: bool, context: &mut Context<'_>) {
        let own = self.rates(context.clocks);
        if unknown {
            context
                .findings
                .add("FDCAN2_CCCR: FDOE is not set, and a frame of CAN FD arrives");
        } else if self.bus.carries(frame) {
            self.report_rates(own, context);
        } else {
            context.findings.add(format!(
                "FDCAN2: a frame {:#x} of {} and {} bit/s is on the bus",
                frame.identifier, frame.nominal_hz, frame.data_hz
            ));
        }
    }

    /// A node that only listens says nothing.
    fn said(&self, reception: Reception) -> Reception {
        if self.registers.is_set(self.settings.monitoring) {
            Reception::Silent
        } else {
            reception
        }
    }

    /// Puts a frame where the filters say.
    fn accept(&mut self, frame: &DataFrame, context: &mut Context<'_>) {
        let count = self.registers.value(self.settings.standard_filters);
        if count > FILTERS_MAX {
            context.findings.add(format!(
                "FDCAN2_RXGFC: LSS is {count}, and there are {FILTERS_MAX} standard filters"
            ));
        }
        let start = self.parts.standard_filters;
        let end = start + count.min(FILTERS_MAX) as usize;
        let filters = self.memory.get(start..end).unwrap_or_default();
        let mut matching = filters.iter().enumerate().filter_map(|(number, word)| {
            let action = memory::filter(*word, frame.identifier)?;
            Some((Some(number), action))
        });
        let (number, action) = matching.next().unwrap_or((None, self.otherwise()));
        let stored = action
            .fifo
            .and_then(|fifo| self.put(fifo, frame, number, context));
        if action.priority {
            self.show_priority(number, action, stored);
        }
    }

    /// What happens to a frame that no filter matches: RM0440, FDCAN_RXGFC, ANFS.
    fn otherwise(&self) -> FilterAction {
        let fifo = match self.registers.value(self.settings.other_standard) {
            0 => Some(0),
            1 => Some(1),
            _ => None,
        };
        FilterAction {
            fifo,
            priority: false,
        }
    }

    /// Puts a frame into a FIFO; the element's number, unless it was full.
    fn put(
        &mut self,
        fifo: usize,
        frame: &DataFrame,
        filter: Option<usize>,
        context: &Context<'_>,
    ) -> Option<u32> {
        let overwrite = self.settings.overwrite.get(fifo)?;
        let overwrite = self.registers.is_set(*overwrite);
        let place = self.receive.get_mut(fifo)?.push(overwrite);
        let Some(place) = place else {
            self.raise(*self.interrupts.lost.get(fifo)?);
            return None;
        };
        let words = memory::received(frame, self.stamp(context), filter);
        let start = self.parts.receive.get(fifo)? + place as usize * ELEMENT;
        self.store(start, &words);
        self.raise(*self.interrupts.new.get(fifo)?);
        if self.receive.get(fifo)?.is_full() {
            self.raise(*self.interrupts.full.get(fifo)?);
        }
        Some(place)
    }

    /// HPMS.
    fn show_priority(&mut self, filter: Option<usize>, action: FilterAction, stored: Option<u32>) {
        let f = &self.flags;
        let storage = match (action.fifo, stored) {
            (None, _) => 0,
            (Some(_), None) => 1,
            (Some(fifo), Some(_)) => 2 + fifo as u32,
        };
        let word = f.priority_index.insert(0, stored.unwrap_or_default());
        let word = f.priority_storage.insert(word, storage);
        let number = filter.unwrap_or_default() as u32;
        let word = f.priority_filter.insert(word, number);
        self.registers.set(self.offsets.hpms, word);
        self.raise(self.interrupts.priority);
    }
}
