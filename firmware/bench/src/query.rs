//! A query of the model as it crosses the bench's link.

use leg_firmware::settings::TendonParameters;
use leg_model::{
    Error, JointStiffness, Query, Scalar, StiffnessAt, StiffnessDemand, Support, SupportKind,
};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The numbers of a [`Query`], not yet validated. It is no [`Query`]: that holds tendons and a support which only validation makes,
/// in a form that may change without the link, and the numbers from which they are made are the firmware's
/// [`TendonParameters`], which the model does not know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(missing_docs, reason = "each field is documented at Query")]
pub struct QueryMessage {
    pub azimuth_rad: f32,
    pub tilt_rad: f32,
    pub payload_kg: f32,
    pub pretension_n: f32,
    pub f_min_n: f32,
    pub f_max_n: f32,
    pub tendons: [TendonParameters; 3],
    pub stiffness_at: StiffnessAt,
    pub support: SupportKind,
    pub joint: JointStiffness<f32>,
    pub demand: Option<StiffnessDemand<f32>>,
}

impl QueryMessage {
    /// The numbers of a query, each rounded by `round`.
    #[must_use]
    pub fn from_query<T: Scalar>(query: &Query<T>, round: fn(T) -> f32) -> Self {
        let tendon = |tendon| TendonParameters::from_tendon(tendon, round);
        Self {
            azimuth_rad: round(query.azimuth_rad),
            tilt_rad: round(query.tilt_rad),
            payload_kg: round(query.payload_kg),
            pretension_n: round(query.pretension_n),
            f_min_n: round(query.f_min_n),
            f_max_n: round(query.f_max_n),
            tendons: query.tendons.each_ref().map(tendon),
            stiffness_at: query.stiffness_at,
            support: query.support.kind(),
            joint: query.support.joint().map(round),
            demand: query.demand.map(|demand| demand.map(round)),
        }
    }

    /// The query, its tendons and its support validated.
    ///
    /// # Errors
    /// What [`Tendon`](leg_model::Tendon) and [`Support`] refuse.
    pub fn query<T: Scalar>(&self) -> Result<Query<T>, Error> {
        Ok(Query {
            azimuth_rad: self.azimuth_rad.into(),
            tilt_rad: self.tilt_rad.into(),
            payload_kg: self.payload_kg.into(),
            pretension_n: self.pretension_n.into(),
            f_min_n: self.f_min_n.into(),
            f_max_n: self.f_max_n.into(),
            tendons: TendonParameters::validated_all(&self.tendons)?,
            stiffness_at: self.stiffness_at,
            support: Support::new(self.support, self.joint.map(T::from))?,
            demand: self.demand.map(|demand| demand.map(T::from)),
        })
    }
}
