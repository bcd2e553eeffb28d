//! What raises each fault that the sensors and the axes show.

mod agreement;
mod axis;

use super::{Fault, FaultSet};
use crate::control::{AxisView, Debounce, Measured, ticks};
use crate::sensors::Sensors;
use crate::settings::Settings;
pub use agreement::{Agreement, ErrorGrowth, FAR_CYCLES, SETTLE_CYCLES};
use axis::AxisMonitor;
pub use axis::{AWAY_PART, JAMMED_PART};

use leg_model::Scalar;

/// Part of `jump_n` by which a tension may jump that lengths contradict: 7.5 N at the default. Without a fault no tension changed by more than
/// 6.2 N within a millisecond while the ready rigs were used for 1.2 h (`leg strikes --false-alarms`).
const CONTRADICTED_PART: f32 = 0.3;

/// What it means that a load cell shows too much tension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excess {
    /// Too much tension.
    Trusted,
    /// Sensors that disagree.
    Doubted,
    /// Nothing yet.
    Open,
}

/// What the monitors check.
#[derive(Clone, Copy, Debug)]
pub struct MonitorInput<'a, T> {
    /// What the sensors read.
    pub sensors: &'a Sensors,
    /// The same in SI.
    pub measured: &'a Measured<T>,
    /// Whether the drivers are on.
    pub driven: bool,
    /// Whether the motors follow where they are led; at rest, one that gives way to a tension does not.
    pub led: bool,
    /// Whether every tendon should pull.
    pub tensioned: bool,
    /// What forward kinematics leaves over, m; none while the pose is not needed.
    pub residual_m: Option<T>,
    /// Whether lengths and tensions are watched and agree; and while homing, where nothing compares them and the tendons are paid out
    /// anyway.
    pub cells_trusted: bool,
}

/// Watches sensors and axes.
#[derive(Clone, Copy, Debug)]
pub struct Monitors<T> {
    axes: [AxisMonitor<T>; 3],
    /// What each axis showed at its last turn: its faults are there until the next one.
    axis_faults: [FaultSet; 3],
    residual: Debounce,
    /// A jump of a tension, N: without and with lengths that contradict it.
    jump_n: [T; 2],
    residual_m: T,
    supply_v: [T; 2],
    temperature_c: T,
}

impl<T: Scalar> Monitors<T> {
    /// With the limits of the settings.
    pub fn new(settings: &Settings) -> Self {
        let limits = &settings.limits;
        let axis = |i: usize| (&settings.servos[i], settings.axes[i].m_per_count);
        let axes = [axis(0), axis(1), axis(2)];
        Self {
            axes: axes.map(|(servo, m_per_count)| AxisMonitor::new(settings, servo, m_per_count)),
            axis_faults: [FaultSet::NONE; 3],
            residual: Debounce::new(ticks(limits.residual_time_s)),
            jump_n: [limits.jump_n, CONTRADICTED_PART * limits.jump_n].map(T::from),
            residual_m: limits.residual_m.into(),
            supply_v: [limits.supply_min_v.into(), limits.supply_max_v.into()],
            temperature_c: limits.temperature_c.into(),
        }
    }

    /// Checks the load cells, once a cycle; `contradicted`: while lengths and tensions disagree; `excess`: what a tension above the
    /// maximum is then.
    // One after the other without a loop: there is little time left in their tick.
    #[inline(never)]
    pub fn watch_cells(&mut self, view: &MonitorInput<'_, T>, contradicted: bool, excess: Excess) {
        let [alone_n, contradicted_n] = self.jump_n;
        let jump_n = if contradicted {
            contradicted_n
        } else {
            alone_n
        };
        let [first, second, third] = &mut self.axes;
        let [a, b, c] = &mut self.axis_faults;
        *a = a.difference(FaultSet::OF_CELLS);
        first.watch_cell(0, view, jump_n, excess, a);
        *b = b.difference(FaultSet::OF_CELLS);
        second.watch_cell(1, view, jump_n, excess, b);
        *c = c.difference(FaultSet::OF_CELLS);
        third.watch_cell(2, view, jump_n, excess, c);
    }

    /// Checks the motor of an axis, from 0 to 2, and its encoder; each has its turn once a cycle.
    #[inline(never)]
    pub fn watch_motor(&mut self, axis: usize, view: &MonitorInput<'_, T>, shown: &AxisView<T>) {
        if let (Some(monitor), Some(faults)) =
            (self.axes.get_mut(axis), self.axis_faults.get_mut(axis))
        {
            *faults = faults.intersection(FaultSet::OF_CELLS);
            monitor.watch_motor::<false>(axis, view, shown, faults);
        }
    }

    /// The same while its current output is silent.
    #[cold]
    #[inline(never)]
    pub fn watch_silent_motor(
        &mut self,
        axis: usize,
        view: &MonitorInput<'_, T>,
        shown: &AxisView<T>,
    ) {
        if let (Some(monitor), Some(faults)) =
            (self.axes.get_mut(axis), self.axis_faults.get_mut(axis))
        {
            *faults = faults.intersection(FaultSet::OF_CELLS);
            monitor.watch_motor::<true>(axis, view, shown, faults);
        }
    }

    /// What the axes showed at their last turns.
    #[inline(always)]
    pub fn axis_faults(&self) -> FaultSet {
        let [first, second, third] = self.axis_faults;
        first.union(second).union(third)
    }

    /// Whether a tension has jumped and not come back since.
    pub fn stay_jumped(&self, tensions_n: &[T; 3]) -> bool {
        let mut axes = self.axes.iter().zip(tensions_n);
        axes.any(|(axis, &tension_n)| axis.stays_jumped(tension_n))
    }

    /// Whatever has jumped before is no matter any more.
    #[inline(never)]
    pub fn forget_jumps(&mut self) {
        self.axes.iter_mut().for_each(AxisMonitor::forget_jump);
    }

    /// The faults of a tick, but those of the axes.
    #[inline(always)]
    pub fn watch(&mut self, view: &MonitorInput<'_, T>) -> FaultSet {
        let (sensors, measured) = (view.sensors, view.measured);
        let mut faults = FaultSet::NONE;
        for fault in sensors.driver_fault {
            faults.add(Fault::DriverFault, fault);
        }
        let off = view
            .residual_m
            .is_some_and(|residual| !(residual <= self.residual_m));
        faults.add(Fault::Residual, self.residual.update(off));
        faults.add(
            Fault::SupplyLow,
            view.driven && !(measured.supply_v >= self.supply_v[0]),
        );
        faults.add(Fault::SupplyHigh, !(measured.supply_v <= self.supply_v[1]));
        faults.add(
            Fault::OverTemperature,
            !(measured.temperature_c <= self.temperature_c),
        );
        faults.add(Fault::LateTick, sensors.late);
        faults.add(Fault::EmergencyStop, sensors.emergency_stop);
        faults.add(Fault::SettingsCorrupt, sensors.settings_corrupt);
        faults
    }
}

#[cfg(test)]
mod tests;
