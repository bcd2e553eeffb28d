//! How far the leg would sag without compensation.

use leg_firmware::settings::{Settings, TendonParameters};
use leg_firmware::telemetry::Telemetry;
use leg_model::{Query, RigParameters, StiffnessAt, Support, Tendon, evaluate};

/// The mechanism of a leg, to compute what its board does not report.
#[derive(Clone, Debug)]
pub(crate) struct SagModel {
    parameters: RigParameters<f64, 3>,
    tendons: [Tendon<f64>; 3],
    support: Support<f64>,
    bounds_n: [f64; 2],
}

impl SagModel {
    /// The mechanism of a board's settings; none if the model refuses them, which a board would have, too.
    pub fn new(settings: &Settings) -> Option<Self> {
        Some(Self {
            parameters: settings.rig.map(f64::from),
            tendons: TendonParameters::validated_all(&settings.tendons).ok()?,
            support: Support::new(settings.support, settings.joint.map(f64::from)).ok()?,
            bounds_n: [settings.f_min_n, settings.f_max_n].map(f64::from),
        })
    }

    /// The deviation of the tip under the leg's own weight and the payload, at the pose and the pretension that the board
    /// reports, m; none while it reports no pretension.
    pub fn sag_m(&self, telemetry: &Telemetry<f32>) -> Option<f64> {
        if telemetry.pretension_n <= 0.0 {
            return None;
        }
        let [x, y] = telemetry.pose.map(f64::from);
        let [f_min_n, f_max_n] = self.bounds_n;
        let mut tendons = self.tendons;
        for tendon in &mut tendons {
            tendon.scale(telemetry.elongation_factor.into());
        }
        let query = Query {
            azimuth_rad: y.atan2(x),
            tilt_rad: x.hypot(y).min(1.0).asin(),
            payload_kg: f64::from(telemetry.payload_kg),
            pretension_n: f64::from(telemetry.pretension_n),
            f_min_n,
            f_max_n,
            tendons,
            stiffness_at: StiffnessAt::Pretension,
            support: self.support,
            demand: None,
        };
        let evaluation = evaluate(&self.parameters, &query).ok()?;
        Some(evaluation.deviation_m)
    }
}
