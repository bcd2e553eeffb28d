//! What the leg reports of itself.

use crate::supervisor::{FaultSet, State};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The leg after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct Telemetry<T> {
    /// Ticks since the start.
    pub tick: u32,
    /// What the leg may do.
    pub state: State,
    /// Faults that have not been cleared, or that limit now.
    pub faults: FaultSet,
    /// Whether the zero is known.
    pub homed: bool,
    /// Tendon at which homing failed the last time, from 1; 0 if it did not.
    pub failed_tendon: u8,
    /// Whether the trajectory moves, or waits for the pretension to come up.
    pub moving: bool,
    /// Where it was sent: the end of the last move, as horizontal components. After a hold, along a path and before the first move
    /// it is the target.
    pub commanded: [T; 2],
    /// Where the trajectory has the leg point now.
    pub target: [T; 2],
    /// Where it is estimated to point.
    pub pose: [T; 2],
    /// What forward kinematics leaves over, m.
    pub residual_m: T,
    /// Measured tensions, N.
    pub tensions_n: [T; 3],
    /// Tensions that the target asks for, N.
    pub target_tensions_n: [T; 3],
    /// How far each tendon is pulled in, m.
    pub pulled_m: [T; 3],
    /// How far each shall be, m.
    pub reference_m: [T; 3],
    /// Measured currents of the motors, A.
    pub motor_currents_a: [T; 3],
    /// Voltage at the drivers, V.
    pub supply_v: T,
    /// Temperature of the drivers, °C.
    pub temperature_c: T,
    /// Pretension that was commanded, N; none where a stiffness was.
    pub pretension_commanded_n: Option<T>,
    /// Bending stiffness that was commanded, N·m/rad; none where a pretension was.
    pub stiffness_commanded_nm_per_rad: Option<T>,
    /// Pretension of the target, N.
    pub pretension_n: T,
    /// Bending stiffness at that pretension, N·m/rad; where a stiffness is commanded, at the one that is found for it.
    pub stiffness_nm_per_rad: T,
    /// The load beyond the leg's own weight, as a horizontal moment, N·m.
    pub load_nm: [T; 2],
    /// The payload that this would be, kg.
    pub payload_kg: T,
    /// Lengths of the tendons without tension when the board started, m.
    pub unstretched_at_zero_m: [T; 3],
    /// Elongation of the tendons over that by the settings: found as the leg is tensioned after homing, 1 before and where the settings are right
    /// to 3 %.
    pub elongation_factor: T,
}

impl<T: Copy> Telemetry<T> {
    /// The same in another precision.
    pub fn map<U>(&self, number: impl Fn(T) -> U) -> Telemetry<U> {
        Telemetry {
            tick: self.tick,
            state: self.state,
            faults: self.faults,
            homed: self.homed,
            failed_tendon: self.failed_tendon,
            moving: self.moving,
            commanded: self.commanded.map(&number),
            target: self.target.map(&number),
            pose: self.pose.map(&number),
            residual_m: number(self.residual_m),
            tensions_n: self.tensions_n.map(&number),
            target_tensions_n: self.target_tensions_n.map(&number),
            pulled_m: self.pulled_m.map(&number),
            reference_m: self.reference_m.map(&number),
            motor_currents_a: self.motor_currents_a.map(&number),
            supply_v: number(self.supply_v),
            temperature_c: number(self.temperature_c),
            pretension_commanded_n: self.pretension_commanded_n.map(&number),
            stiffness_commanded_nm_per_rad: self.stiffness_commanded_nm_per_rad.map(&number),
            pretension_n: number(self.pretension_n),
            stiffness_nm_per_rad: number(self.stiffness_nm_per_rad),
            load_nm: self.load_nm.map(&number),
            payload_kg: number(self.payload_kg),
            unstretched_at_zero_m: self.unstretched_at_zero_m.map(&number),
            elongation_factor: number(self.elongation_factor),
        }
    }
}
