//! The rigs that come with the tool: one for each kind of support.

use crate::support_name::SupportName;

/// A rig that comes with the tool.
#[derive(Clone, Copy, Debug)]
pub struct ReadyRig {
    /// What `--rig` takes.
    pub name: &'static str,
    /// Its support.
    pub support: SupportName,
    /// The parts of the paper's Fig. 2 that show the support; none shows the idealisation.
    pub figure_2: &'static str,
    /// What it is.
    pub words: &'static str,
    /// The same in two words at most.
    pub joint: &'static str,
    /// The rig file.
    pub text: &'static str,
}

macro_rules! ready_rigs {
    ($($name:literal $support:ident $figure_2:literal $words:literal $joint:literal;)*) => {
        [$(ReadyRig {
            name: $name,
            support: SupportName::$support,
            figure_2: $figure_2,
            words: $words,
            joint: $joint,
            text: include_str!(concat!("../../rigs/", $name, ".toml")),
        },)*]
    };
}

/// Every ready rig; the first is the default.
pub const READY_RIGS: [ReadyRig; 7] = ready_rigs! {
    "table1" TorsionFree "-" "idealised: tilts without torsion" "idealised";
    "spherical" Spherical "a" "ball joint" "ball joint";
    "universal" Universal "b" "rigid universal joint" "universal joint";
    "compliant_pivot" CompliantPivot "c" "one elastic rod" "compliant pivot";
    "elastic_rod_universal" ElasticRodUniversal "d, g" "universal joint of elastic rods" "elastic rods";
    "notch_universal" NotchUniversal "e, h" "universal joint of notch hinges" "notch hinges";
    "leaf_spring_universal" LeafSpringUniversal "f, i" "universal joint of leaf springs" "leaf springs";
};

/// The ready rig of a name.
#[must_use]
pub fn named(name: &str) -> Option<&'static ReadyRig> {
    READY_RIGS.iter().find(|rig| rig.name == name)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_firmware::settings::{Gains, Limits};

    #[test]
    fn every_support_of_fig_2_has_a_ready_rig_that_is_table_1_otherwise_or_leans_less() {
        let table_1 = RigFile::load(None).unwrap();
        for rig in READY_RIGS {
            let file = RigFile::parse(rig.name, rig.text).unwrap();
            assert_eq!(file.support_name, rig.support, "{}", rig.name);
            if rig.figure_2 == "-" {
                continue;
            }
            let same = RigFile {
                support_name: table_1.support_name,
                support: table_1.support,
                critical_n: table_1.critical_n,
                tilt_deg: table_1.tilt_deg,
                given_gains: table_1.given_gains,
                // The limit on what a push twists.
                gains: Gains {
                    limits: Limits {
                        residual_m: table_1.gains.limits.residual_m,
                        ..file.gains.limits
                    },
                    ..file.gains
                },
                ..file
            };
            assert_eq!(same, table_1, "{}", rig.name);
            assert!(file.tilt_deg <= table_1.tilt_deg, "{}", rig.name);
        }
    }

    /// No material of these rigs is superelastic: metals are linear to 2 % at the very most.
    #[test]
    fn ready_rigs_are_bent_within_the_linear_range_only() {
        for rig in READY_RIGS {
            let mut lines = rig.text.lines();
            let limit = lines.find_map(|line| line.strip_prefix("strain_max_percent = "));
            assert_eq!(limit.is_some(), rig.support.elastic(), "{}", rig.name);
            let percent: f64 = limit.map_or(0.0, |percent| percent.parse().unwrap());
            assert!(percent <= 2.0, "{}: {percent} %", rig.name);
        }
    }

    #[test]
    fn the_joints_of_ready_rigs_bear_the_tendons_pull() {
        for rig in READY_RIGS {
            let file = RigFile::parse(rig.name, rig.text).unwrap();
            assert_eq!(file.buckling().is_some(), rig.support.elastic());
            if let Some(buckling) = file.buckling() {
                assert!(buckling.at_pretension < 0.33, "{}: {buckling:?}", rig.name);
                assert!(buckling.at_f_max < 0.7, "{}: {buckling:?}", rig.name);
            }
        }
    }
}
