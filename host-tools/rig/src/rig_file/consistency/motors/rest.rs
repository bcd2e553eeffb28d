//! Whether a motor comes to rest, and where.

use super::Motor;
use crate::number::{decimal, plain};
use crate::rig_file::derived::{two_digits, two_digits_above, two_digits_below};
use crate::toml_error::TomlError;
use leg_firmware::settings::SERVO;
use leg_model::Elasticity;

/// What the tip may be off by the dead band of the motors before it is worth a warning, m.
const TIP_M: f64 = 5e-5;

/// The speed at which a tendon may throw its rotor through the play of its gear, m/s. Drawn rigs that swung by their motors alone had 1.2 mm/s and more, and some with
/// up to 2.6 mm/s came to rest; half of the least, as they were few.
const THROWN_M_PER_S: f64 = 6e-4;

impl Motor<'_> {
    /// A motor comes to rest within the dead band only if its counts are fine enough.
    pub(super) fn check_counts(&mut self) -> Result<(), TomlError> {
        let (count_m, band_m) = (
            self.basis.m_per_count,
            decimal(self.gains.servo.dead_band_m),
        );
        let keys = [
            "control.servo.dead_band_m",
            "calibration.m_per_count",
            "actuator.counts_per_turn",
        ];
        let words = format!(
            "`control.servo.dead_band_m` ({}) is narrower than a count of the encoder, {} m",
            plain(band_m),
            plain(two_digits(count_m))
        );
        let help = format!(
            "give at least {}, or an encoder of more counts",
            plain(two_digits_above(1.8 * count_m))
        );
        // Half a count away from every count there is a place that none is nearer to.
        if band_m < 0.499 * count_m {
            return self.refuse(
                &keys,
                format!("{words}: the motor never comes to rest"),
                help,
            );
        }
        if band_m < 0.999 * count_m {
            self.warn(&keys, format!("{words}: {help}"));
        }
        let parameters = &self.file.parameters;
        let tip_m = parameters.joint_length_m + parameters.leg_length_m;
        let off_m = band_m * tip_m / self.basis.lever_m.max(1e-9);
        if off_m > TIP_M {
            let given = self.file.given_gains.has(SERVO, self.motor, "dead_band_m");
            let remedy = if given {
                let band_m = two_digits_below(band_m * TIP_M / off_m);
                format!("a band of {} would do", plain(band_m))
            } else {
                let counts = self.basis.actuator.counts_per_turn * off_m / TIP_M;
                format!(
                    "`counts_per_turn` of {} would do",
                    plain(two_digits_above(counts))
                )
            };
            let text = format!(
                "a motor rests anywhere within `control.servo.dead_band_m` ({}), which is {} mm at the tip: {remedy}",
                plain(band_m),
                plain(two_digits(off_m * 1000.0)),
            );
            self.warn(&keys, text);
        }
        Ok(())
    }

    /// A rotor that is free within its play is thrown to and fro by a stiff tendon through a coarse screw, and does not come to rest.
    pub(super) fn check_play(&mut self) {
        let actuator = &self.basis.actuator;
        let pretension_n = self.file.pretension_n;
        let tendons = self.file.tendons.iter();
        let stiffnesses = tendons.filter_map(|tendon| tendon.stiffness(pretension_n).ok());
        let stiffness_n_per_m = stiffnesses.fold(0.0, f64::max);
        // Of the rotor on the tendon.
        let pulled_per_s =
            actuator.m_per_rad() * (stiffness_n_per_m / actuator.inertia_kg_m2).sqrt();
        let play_m = actuator.play_m();
        let thrown_m_per_s = pulled_per_s * play_m;
        if thrown_m_per_s <= THROWN_M_PER_S {
            return;
        }
        let multiple = thrown_m_per_s / THROWN_M_PER_S;
        let keys = [
            "actuator.gear_ratio",
            "actuator.backlash_rad",
            "actuator.lead_m",
        ];
        let text = format!(
            "through `{}` ({}) and `{}` ({}) a tendon throws its rotor to and fro within a play of {} m, and the motor may not come to rest: a \
             `gear_ratio` of {}, or an `{}` of {}, would do",
            keys[0],
            plain(actuator.gear_ratio),
            keys[2],
            plain(actuator.lead_m),
            plain(two_digits(play_m)),
            plain(two_digits_above(actuator.gear_ratio * multiple)),
            keys[1],
            plain(two_digits_below(actuator.backlash_rad / multiple))
        );
        self.warn(&keys, text);
    }
}
