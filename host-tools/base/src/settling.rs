//! When a leg that was commanded has come to rest where it shall be.

use leg_firmware::sensors::TICK_HZ;
use leg_firmware::telemetry::Telemetry;

/// How long the leg has to be settled, in its own ticks: an emulated leg may be slower than the clock. 0.3 s.
const SETTLED_TICKS: u32 = 3 * TICK_HZ as u32 / 10;

/// Ticks from one telemetry to the next below which nothing can be said of a change: 10 ms.
const COMPARED_TICKS: u32 = TICK_HZ as u32 / 100;

/// Distance of every tension from its target below which a leg is settled, N.
const SETTLED_N: f32 = 2.0;

/// Change from one telemetry to the next below which pretension and stiffness are settled, as a part of each.
const SETTLED_PART: f32 = 1e-3;

/// Change of the pretension over the whole of that time below which it is settled, N: at the lowest rate that a setting gives it is 0.03 N. At rest it
/// does not change, but where a limit moves with the estimated load.
const RAMPED_N: f32 = 0.02;

/// Distance of two directions below which they are the same: 0.03°.
const SAME_DIRECTION: f32 = 5e-4;

/// Watches a leg until it is where it shall be, and stays so.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settling {
    last: Option<Telemetry<f32>>,
    /// Since when it is settled, and where it was then.
    since: Option<Telemetry<f32>>,
    /// Whether the leg leaves its load out: it does not come to its target, but to rest.
    uncompensated: bool,
}

impl Settling {
    /// The same of a leg whose compensation is off.
    #[must_use]
    pub fn uncompensated() -> Self {
        Self {
            uncompensated: true,
            ..Self::default()
        }
    }

    /// Takes telemetry; whether the leg has been settled for 0.3 s. Give it every 10 ms or more seldom: what comes earlier is
    /// left out.
    pub fn take(&mut self, telemetry: &Telemetry<f32>) -> bool {
        let tick = telemetry.tick;
        let before = self.last;
        if before.is_some_and(|before| tick.wrapping_sub(before.tick) < COMPARED_TICKS) {
            return false;
        }
        self.last = Some(*telemetry);
        let there = if self.uncompensated {
            let rests = |since: Telemetry<f32>| same_direction(&since.pose, &telemetry.pose);
            self.since.is_none_or(rests)
        } else {
            same_direction(&telemetry.pose, &telemetry.target)
                && taut(&telemetry.tensions_n, &telemetry.target_tensions_n)
        };
        let steady = before.is_some_and(|before| steady(&before, telemetry));
        let ramps = self.since.is_some_and(|since| ramps(&since, telemetry));
        if !there || !steady || ramps {
            self.since = None;
            return false;
        }
        let since = *self.since.get_or_insert(*telemetry);
        tick.wrapping_sub(since.tick) >= SETTLED_TICKS
    }
}

fn steady(before: &Telemetry<f32>, now: &Telemetry<f32>) -> bool {
    let steady = |value: fn(&Telemetry<f32>) -> f32| {
        (value(now) - value(before)).abs() <= SETTLED_PART * value(now).abs()
    };
    !now.moving
        && steady(|telemetry| telemetry.pretension_n)
        && steady(|telemetry| telemetry.stiffness_nm_per_rad)
}

/// Whether the pretension goes on to where it shall be, however slowly.
fn ramps(since: &Telemetry<f32>, now: &Telemetry<f32>) -> bool {
    !now.faults.limits().any() && (now.pretension_n - since.pretension_n).abs() > RAMPED_N
}

/// Whether two directions, as horizontal components, are the same.
#[must_use]
pub fn same_direction(a: &[f32; 2], b: &[f32; 2]) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| (a - b).abs() <= SAME_DIRECTION)
}

fn taut(measured_n: &[f32; 3], target_n: &[f32; 3]) -> bool {
    let mut pairs = measured_n.iter().zip(target_n);
    pairs.all(|(measured, target)| (measured - target).abs() <= SETTLED_N)
}
